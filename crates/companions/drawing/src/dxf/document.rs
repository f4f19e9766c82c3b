//! Sections of a DXF: the unit, layers, blocks and entities.

use super::tags::{Record, Tag};
use crate::{Error, Point, Unit};
use std::collections::{HashMap, HashSet};

/// An entity, with the records that belong to it: vertices of a polyline, attributes of an insertion.
#[derive(Debug)]
pub(super) struct Entity<'a> {
    pub record: Record<'a>,
    pub parts: Vec<Record<'a>>,
}

#[derive(Debug)]
pub(super) struct Block<'a> {
    pub name: &'a str,
    pub base: Point,
    pub entities: Vec<Entity<'a>>,
}

#[derive(Debug, Default)]
pub(super) struct Document<'a> {
    /// The unit, if the file states one that cplan knows.
    pub unit: Option<Unit>,
    /// The tag of the stated unit, if cplan does not know it.
    pub unread_unit: Option<Tag<'a>>,
    /// Hidden layers, with names in capitals, because names are not case-sensitive.
    hidden: HashMap<String, HiddenReason>,
    /// Blocks by name in capitals.
    pub blocks: HashMap<String, Block<'a>>,
    pub entities: Vec<Entity<'a>>,
    /// Handles of dictionary entries, by the dictionary's handle and the entry's name.
    entries: HashMap<(&'a str, &'a str), &'a str>,
    /// Handles of the clips that are switched on.
    clips: HashSet<&'a str>,
}

/// The reason why a layer is hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum HiddenReason {
    /// The layer is off or never printed. This hides entities on the layer.
    Off,
    /// The layer is frozen. This hides entities and insertions on the layer.
    Frozen,
}

/// The layer that CAD programs use for definition points of dimensions. It is never printed.
const UNPRINTED_LAYER: &str = "DEFPOINTS";

impl<'a> Document<'a> {
    /// Reads the sections that matter in the plane.
    pub fn read(records: &[Record<'a>]) -> Result<Self, Error> {
        let mut document = Self::default();
        let mut rest = records.iter().copied().peekable();
        let mut has_entities = false;
        while let Some(record) = rest.next() {
            if record.kind != "SECTION" {
                continue;
            }
            let mut inside = Vec::new();
            while let Some(next) = rest.next_if(|next| !["ENDSEC", "SECTION", "EOF"].contains(&next.kind)) {
                inside.push(next);
            }
            if rest.peek().is_none_or(|next| next.kind != "ENDSEC") {
                let message = "this section does not end, so shapes may be missing";
                return Err(Error::new(record.line, message, "copy or export the drawing again"));
            }
            match record.text(2) {
                Some("HEADER") => (document.unit, document.unread_unit) = unit(record.tags)?,
                Some("TABLES") => document.hidden = hidden_layers(&inside)?,
                Some("BLOCKS") => document.blocks = blocks(&inside)?,
                Some("ENTITIES") => {
                    document.entities = entities(&inside);
                    has_entities = true;
                }
                Some("OBJECTS") => document.objects(&inside)?,
                _ => {}
            }
        }
        if !has_entities {
            let message = "this DXF has no section ENTITIES";
            return Err(Error::new(None, message, "export the drawing again, as an ASCII DXF"));
        }
        Ok(document)
    }

    /// Reads the section OBJECTS. Stores the entries of dictionaries, and the handles of the spatial filters (clips)
    /// that are switched on.
    fn objects(&mut self, records: &[Record<'a>]) -> Result<(), Error> {
        for record in records {
            let Some(handle) = record.text(5) else { continue };
            match record.kind {
                "SPATIAL_FILTER" if record.integer_or(71, 1)? != 0 => _ = self.clips.insert(handle),
                "DICTIONARY" => {
                    // Each entry has a name and the handle of its object.
                    let pairs =
                        record.tags.windows(2).filter(|pair| pair[0].code == 3 && [350, 360].contains(&pair[1].code));
                    self.entries.extend(pairs.map(|pair| ((handle, pair[0].value), pair[1].value)));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Returns true if an insertion is clipped, that is, if its own dictionary refers to an active clip.
    pub fn clips(&self, insertion: Record<'a>) -> bool {
        let entry = |dictionary, name| self.entries.get(&(dictionary, name)).copied();
        let filters = insertion.text(360).and_then(|own| entry(own, "ACAD_FILTER"));
        filters.and_then(|filters| entry(filters, "SPATIAL")).is_some_and(|clip| self.clips.contains(clip))
    }

    /// Returns true if entities on a layer are hidden.
    pub fn hides(&self, layer: &str) -> bool {
        self.hidden.contains_key(&layer.to_uppercase())
    }

    /// Returns true if a layer is frozen, so that insertions on it are also hidden.
    pub fn freezes(&self, layer: &str) -> bool {
        self.hidden.get(&layer.to_uppercase()) == Some(&HiddenReason::Frozen)
    }
}

/// Reads `$INSUNITS`. Returns the unit, or else the tag of a unit that cplan does not know.
fn unit<'a>(header: &[Tag<'a>]) -> Result<(Option<Unit>, Option<Tag<'a>>), Error> {
    let at = header.iter().position(|tag| tag.code == 9 && tag.value == "$INSUNITS");
    let value = at.and_then(|at| header[at + 1..].iter().find(|tag| tag.code == 70));
    let code = value.map(Tag::number).transpose()?.unwrap_or(0.0);
    let unit = super::unit::of_code(code as i64);
    Ok((unit, value.copied().filter(|_| unit.is_none() && code != 0.0)))
}

fn hidden_layers(tables: &[Record]) -> Result<HashMap<String, HiddenReason>, Error> {
    let mut hidden = HashMap::from([(UNPRINTED_LAYER.to_owned(), HiddenReason::Off)]);
    for layer in tables.iter().filter(|record| record.kind == "LAYER") {
        let why = match (layer.flag(1)?, layer.integer_or(62, 7)? < 0) {
            (true, _) => HiddenReason::Frozen,
            (false, true) => HiddenReason::Off,
            (false, false) => continue,
        };
        hidden.extend(layer.text(2).map(|name| (name.to_uppercase(), why)));
    }
    Ok(hidden)
}

fn blocks<'a>(records: &[Record<'a>]) -> Result<HashMap<String, Block<'a>>, Error> {
    let mut blocks = HashMap::new();
    let mut rest = records.iter().copied().peekable();
    while let Some(head) = rest.next() {
        if head.kind != "BLOCK" {
            continue;
        }
        let mut inside = Vec::new();
        while let Some(next) = rest.next_if(|next| !["BLOCK", "ENDBLK"].contains(&next.kind)) {
            inside.push(next);
        }
        let name = head.text(2).unwrap_or_default();
        let base = [head.number_or(10, 0.0)?, head.number_or(20, 0.0)?];
        blocks.insert(name.to_uppercase(), Block { name, base, entities: entities(&inside) });
    }
    Ok(blocks)
}

/// Returns the entities, each with the records after it that belong to it.
fn entities<'a>(records: &[Record<'a>]) -> Vec<Entity<'a>> {
    let mut entities: Vec<Entity> = Vec::new();
    for &record in records {
        match (record.kind, entities.last_mut()) {
            ("SEQEND", _) => {}
            ("VERTEX" | "ATTRIB", Some(entity)) => entity.parts.push(record),
            _ => entities.push(Entity { record, parts: Vec::new() }),
        }
    }
    entities
}
