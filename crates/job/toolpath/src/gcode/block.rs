//! Sorts the words of one line of a program by their purpose.

use super::meaning::{self, Meaning, SLOTS, Slot};
use super::remarks::{self, Remarks};
use super::words::Word;
use crate::Error;

/// The words of a line that affect the tip's line, by purpose.
pub(super) struct Block<'w> {
    slots: [Option<&'w Word>; SLOTS],
    words: &'w [Word],
}

impl<'w> Block<'w> {
    /// Sorts words, and notes those without an effect. Returns `None` if a word is refused, or moves the tip to a position of the
    /// machine.
    ///
    /// # Errors
    /// If words contradict each other, or if a word has no number.
    pub fn new(words: &'w [Word], remarks: &mut Remarks) -> Result<Option<Self>, Error> {
        let meanings: Vec<Meaning> = words.iter().map(|word| meaning::of(word, words)).collect();
        let is_homing = meanings.contains(&Meaning::Follow(Slot::Home));
        if refuse(words, &meanings, remarks) {
            return Ok(None);
        }
        let mut slots = [None; SLOTS];
        for (index, (word, meaning)) in words.iter().zip(&meanings).enumerate() {
            if word.value.is_none() && !is_homing {
                let message = format!("the letter {} has no number", word.letter);
                let hint = "write a number after it, such as X12.5";
                return Err(Error::new(word.source.line, word.source.column, message, hint));
            }
            match meaning {
                Meaning::Follow(slot) => fill(&mut slots[*slot as usize], *slot, word)?,
                Meaning::Number if index > 0 => {
                    return Err(word.error("is not at the start of its line", "put it first, or remove it"));
                }
                _ => {}
            }
        }
        let block = Self { slots, words };
        let is_time = |word: &&Word| block.get(Slot::Dwell).is_some() && "PSU".contains(word.letter);
        let is_listed =
            |meaning: &Meaning| matches!(meaning, Meaning::Listed | Meaning::Follow(Slot::Home | Slot::System));
        let listed = words.iter().zip(&meanings).filter(|(word, meaning)| is_listed(meaning) && !is_time(word));
        listed.for_each(|(word, _)| remarks.list(remarks::name(word)));
        Ok(Some(block))
    }

    pub fn get(&self, slot: Slot) -> Option<&'w Word> {
        self.slots[slot as usize]
    }

    /// Returns the number of the word for a purpose.
    pub fn value(&self, slot: Slot) -> Option<f64> {
        self.get(slot)?.value
    }

    /// Returns the words with one of these letters.
    pub fn with_letters(&self, letters: &'static str) -> impl Iterator<Item = &'w Word> {
        self.words.iter().filter(move |word| letters.contains(word.letter))
    }
}

/// Records the words that cplan cannot follow, and moves to positions of the machine. Returns true if there are any.
fn refuse(words: &[Word], meanings: &[Meaning], remarks: &mut Remarks) -> bool {
    let refused = words.iter().zip(meanings).filter(|(_, meaning)| matches!(meaning, Meaning::Refused(_)));
    // The other words of a line with a refused command are parameters of the command.
    let is_command = |word: &Word| "GM".contains(word.letter);
    let has_command = refused.clone().any(|(word, _)| is_command(word));
    for (word, meaning) in refused.clone().filter(|(word, _)| is_command(word) || !has_command) {
        if let Meaning::Refused(reason) = meaning {
            remarks.refuse(remarks::name(word), *reason, word.source);
        }
    }
    let home = words
        .iter()
        .zip(meanings)
        .find(|(word, meaning)| **meaning == Meaning::Follow(Slot::Home) && leaves_place(word, words));
    if let Some((word, _)) = home {
        remarks.add_home(word);
    }
    home.is_some() || refused.count() > 0
}

/// Returns true if a word for a position of the machine (G28, G30, G53) moves the tip in the plane, not only in height.
fn leaves_place(word: &Word, words: &[Word]) -> bool {
    let has = |letters: &str| words.iter().any(|other| letters.contains(other.letter));
    has("XY") || !(has("Z") || word.is('G', &[53.0]))
}

fn fill<'w>(place: &mut Option<&'w Word>, slot: Slot, word: &'w Word) -> Result<(), Error> {
    match *place {
        Some(known) if known.value != word.value || slot as usize >= Slot::F as usize => {
            let message = format!("and {} contradict each other on this line", known.text);
            Err(word.error(&message, "keep one of the two"))
        }
        _ => {
            *place = Some(word);
            Ok(())
        }
    }
}
