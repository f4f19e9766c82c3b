//! Reads DXF files, as text or binary: the entities in the plane of model space.

mod binary;
mod document;
mod entity;
mod tags;
mod unit;

use crate::map::Map;
use crate::sheet::{Origin, Sheet};
use crate::{Drawing, Error, Frame, Settings, Unit};
use document::{Document, Entity};
use std::collections::HashMap;
use tags::Tag;

/// Greatest depth of nested insertions. CAD programs allow less.
const MAX_INSERTION_DEPTH: usize = 64;
/// Greatest number of entities after all blocks are inserted.
const MAX_ENTITIES: usize = 1 << 20;

/// Reads a DXF.
///
/// # Errors
/// If the text is not a DXF or is incomplete, if the text of a number is not a number, or if a block contains itself.
pub(crate) fn read(bytes: &[u8], settings: &Settings) -> Result<Drawing, Error> {
    let binary = binary::as_text(bytes)?;
    let text = tags::decoded(binary.as_deref().unwrap_or(bytes))?;
    let (tags, surplus) = tags::tags(&text)?;
    let records = tags::records(&tags);
    let document = Document::read(&records)?;
    let mut sheet = Sheet::new(settings);
    if surplus.is_some() {
        sheet.notes.add("text after EOF: left out", surplus);
    }
    let unit = settings.unit.or(document.unit).unwrap_or_else(|| {
        match document.unread_unit {
            Some(Tag { value, line, .. }) => {
                sheet.notes.add(format!("$INSUNITS {value} is not a known unit: read as mm"), Some(line));
            }
            None => sheet.notes.add("the drawing does not state its unit: read as mm", None),
        }
        Unit::MILLIMETER
    });
    let mut reader = Reader { document: &document, sheet, groups: HashMap::new(), instances: 0, entities: 0 };
    let scale = unit.metres() * settings.scale;
    let place = BlockPlacement { map: Map::scaling(scale, scale), up: [scale, 0.0], ..BlockPlacement::default() };
    reader.read_entities(&document.entities, &place, &mut Vec::new())?;
    Ok(reader.sheet.finish())
}

/// Placement of a block's entities, accumulated from its insertions.
#[derive(Debug, Clone)]
struct BlockPlacement<'a> {
    map: Map,
    /// Factor and offset that convert heights in the block to heights in the drawing.
    up: [f64; 2],
    /// Name of the outermost inserted block. `None` if the name is generated.
    name: Option<&'a str>,
    /// Layer of the insertion. Within the block, it replaces layer 0.
    layer: Option<&'a str>,
    /// Number of the insertion. Entities of one insertion are joined only with each other.
    instance: usize,
    /// The frozen layer of an insertion. It hides the whole insertion, whereas a layer that is off hides only entities
    /// on that layer.
    frozen: Option<&'a str>,
    /// Place and orientation of the outermost insertion.
    frame: Option<Frame>,
}

impl Default for BlockPlacement<'_> {
    fn default() -> Self {
        Self { map: Map::IDENTITY, up: [1.0, 0.0], name: None, layer: None, instance: 0, frozen: None, frame: None }
    }
}

struct Reader<'d, 'a> {
    document: &'d Document<'a>,
    sheet: Sheet,
    /// Group number of curves that may be joined, by insertion and layer.
    groups: HashMap<(usize, String), usize>,
    instances: usize,
    entities: usize,
}

impl<'d, 'a> Reader<'d, 'a> {
    /// Reads entities with a placement. `within` lists the blocks that contain the entities.
    fn read_entities(
        &mut self,
        entities: &'d [Entity<'a>],
        place: &BlockPlacement<'a>,
        within: &mut Vec<String>,
    ) -> Result<(), Error> {
        for entity in entities {
            self.entities += 1;
            let record = entity.record;
            if self.entities > MAX_ENTITIES {
                let message =
                    format!("the drawing has more than {MAX_ENTITIES} entities, with the copies that INSERT makes");
                return Err(Error::new(record.line, message, "remove parts that the arm cannot reach"));
            }
            if record.integer_or(67, 0)? == 1 {
                let origin = self.origin(entity, place)?;
                self.sheet.leave_out("entities in paper space", &origin);
            } else if record.integer_or(60, 0)? == 1 {
                let origin = self.origin(entity, place)?;
                self.sheet.leave_out("invisible entities", &origin);
            } else if record.kind == "INSERT" {
                self.insert(entity, place, within)?;
            } else {
                let origin = self.origin(entity, place)?;
                self.entity(entity, place, &origin)?;
            }
        }
        Ok(())
    }

    fn origin(&self, entity: &Entity<'a>, place: &BlockPlacement<'a>) -> Result<Origin, Error> {
        let record = entity.record;
        let layer = layer(entity, place);
        let thickness = record.number_or(39, 0.0)?;
        let elevation = if record.kind == "LWPOLYLINE" { record.number(38)? } else { record.number(30)? };
        let foot = elevation.unwrap_or(0.0);
        let height = [foot, foot + thickness].map(|z| place.up[0] * z * upwards(entity) + place.up[1]);
        let [low, high] = [height[0].min(height[1]), height[0].max(height[1])];
        Ok(Origin {
            name: place.name.map(str::to_owned),
            layer: Some(layer.to_owned()),
            height: (low < high).then_some([low, high]),
            hidden_by: place.frozen.or_else(|| self.document.hides(layer).then_some(layer)).map(str::to_owned),
            kind: record.kind.to_owned(),
            line: Some(record.line),
            frame: place.frame,
        })
    }

    /// Returns the group number of curves that may be joined with entities of a layer.
    fn group(&mut self, place: &BlockPlacement, origin: &Origin) -> usize {
        let next = self.groups.len();
        let layer = origin.layer.clone().unwrap_or_default();
        *self.groups.entry((place.instance, layer)).or_insert(next)
    }

    /// Inserts a block, once or in rows and columns.
    fn insert(
        &mut self,
        entity: &Entity<'a>,
        place: &BlockPlacement<'a>,
        within: &mut Vec<String>,
    ) -> Result<(), Error> {
        let record = entity.record;
        if !entity.parts.is_empty() {
            let origin = Origin { line: Some(entity.parts[0].line), ..self.origin(entity, place)? };
            self.sheet.leave_out("ATTRIB", &origin);
        }
        if self.document.clips(record) {
            let origin = self.origin(entity, place)?;
            self.sheet.note("INSERT with a clipping boundary (XCLIP): the boundary is ignored", &origin);
        }
        let name = record.text(2).unwrap_or_default();
        let key = name.to_uppercase();
        let Some(block) = self.document.blocks.get(&key) else {
            let message = format!("INSERT of block \"{name}\", which the file does not contain: left out");
            self.sheet.notes.add(message, Some(record.line));
            return Ok(());
        };
        if within.contains(&key) || within.len() == MAX_INSERTION_DEPTH {
            let what = if within.contains(&key) { "contains itself" } else { "is nested too deeply" };
            let message = format!("block \"{name}\" {what}");
            return Err(Error::new(record.line, message, "explode the block, or remove the insertion from the block"));
        }
        let scale = [record.number_or(41, 1.0)?, record.number_or(42, 1.0)?];
        let map = place.map.compose(&oriented(entity)?);
        let at = Map::moving(record.point(10)?).compose(&Map::turning(record.number_or(50, 0.0)?.to_radians()));
        let own = Map::scaling(scale[0], scale[1]).compose(&Map::moving(block.base.map(|x| -x)));
        if !map.compose(&at).compose(&own).is_regular() {
            let message =
                format!("INSERT of block \"{name}\": the scale {} by {} flattens the block", scale[0], scale[1]);
            return Err(Error::new(record.line, message, "give it a scale that is not 0"));
        }
        let up_scale = place.up[0] * upwards(entity);
        let up = [up_scale * record.number_or(43, 1.0)?, up_scale * record.number_or(30, 0.0)? + place.up[1]];
        let counts = [record.integer_or(70, 1)?.max(1), record.integer_or(71, 1)?.max(1)];
        let spacing = [record.number_or(44, 0.0)?, record.number_or(45, 0.0)?];
        let layer = layer(entity, place);
        let frozen = place.frozen.or_else(|| self.document.freezes(layer).then_some(layer));
        // Generated names of blocks begin with a star.
        let name = place.name.or(Some(block.name).filter(|name| !name.starts_with('*')));
        within.push(key);
        for row in 0..counts[1] {
            for column in 0..counts[0] {
                self.instances += 1;
                // Count the insertion itself, because even an empty block takes time.
                self.entities += 1;
                if self.entities > MAX_ENTITIES {
                    let message =
                        format!("the drawing has more than {MAX_ENTITIES} entities, with the copies that INSERT makes");
                    return Err(Error::new(record.line, message, "remove parts that the arm cannot reach"));
                }
                let shift = Map::moving([column as f64 * spacing[0], row as f64 * spacing[1]]);
                let here = map.compose(&at).compose(&shift);
                let frame = place.frame.or(Some(here.frame()));
                let map = here.compose(&own);
                let inner =
                    BlockPlacement { map, up, name, layer: Some(layer), instance: self.instances, frozen, frame };
                self.read_entities(&block.entities, &inner, within)?;
            }
        }
        within.pop();
        Ok(())
    }
}

/// Returns the layer of an entity. Layer 0 of a block means the layer of the insertion.
fn layer<'a>(entity: &Entity<'a>, place: &BlockPlacement<'a>) -> &'a str {
    let own = entity.record.text(8).unwrap_or("0");
    if own == "0" { place.layer.unwrap_or(own) } else { own }
}

/// Returns 1 if the z axis of an entity points up, and -1 if it points down.
fn upwards(entity: &Entity) -> f64 {
    let down = entity.record.number(230).ok().flatten().is_some_and(|z| z < 0.0);
    if down { -1.0 } else { 1.0 }
}

/// Returns the map from an entity's own coordinates to those of the drawing. It mirrors x if the entity's z axis points
/// down.
fn oriented(entity: &Entity) -> Result<Map, Error> {
    Ok(if upwards(entity) < 0.0 { Map::scaling(-1.0, 1.0) } else { Map::IDENTITY })
}
