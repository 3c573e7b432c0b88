//! A trainee's progress in the school: a Leitner box for each card.

use super::card::Card;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Format number of the file.
const FORMAT: u32 = 1;
/// Number of boxes.
pub const BOX_COUNT: u8 = 5;
/// Days until a card in each box is asked again (Leitner 1972 has expanding intervals; the numbers are estimates).
const INTERVALS_DAYS: [u64; BOX_COUNT as usize] = [0, 1, 3, 7, 21];
/// Seconds in a day.
const DAY_S: u64 = 86_400;

/// Progress with one card.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CardProgress {
    /// Box, from 1 (missed last time) to [`BOX_COUNT`].
    #[serde(rename = "box")]
    pub number: u8,
    /// Time from which the card is asked again, s since the Unix epoch.
    pub due_unix_s: u64,
    /// How often it was asked.
    pub asked: u32,
    /// How often the answer was right.
    pub right: u32,
}

/// A trainee's record. The default is that of a trainee who has not answered any question.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
#[serde(into = "StoredRecord")]
pub struct SchoolRecord {
    /// Number of rounds that the trainee has begun.
    pub rounds: u32,
    last_unix_s: u64,
    cards: BTreeMap<Card, CardProgress>,
}

/// The record as it is stored.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredRecord {
    format: u32,
    rounds: u32,
    last_unix_s: u64,
    cards: BTreeMap<String, CardProgress>,
}

impl From<SchoolRecord> for StoredRecord {
    fn from(record: SchoolRecord) -> Self {
        let cards = record.cards.into_iter().map(|(card, progress)| (card.name(), progress)).collect();
        Self { format: FORMAT, rounds: record.rounds, last_unix_s: record.last_unix_s, cards }
    }
}

/// A record that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SchoolRecordError {
    /// It is not valid JSON, or a key is missing or unknown.
    #[error("{0}")]
    Syntax(String),
    /// Another version of the program wrote it.
    #[error("format {0}: unknown (allowed: {FORMAT})")]
    Format(u32),
    /// A card does not exist.
    #[error("cards.{0}: unknown (allowed: a defect code or 0, '@', and 1m, 3m or 8m, for example 1130@3m)")]
    Card(String),
    /// A value is out of range.
    #[error("cards.{card}.{key} {value}: out of range (allowed: {allowed})")]
    Value {
        /// Name of the card.
        card: String,
        /// Key of the value.
        key: &'static str,
        /// The value.
        value: u64,
        /// Allowed values.
        allowed: String,
    },
}

impl SchoolRecord {
    /// Reads a stored record (JSON).
    ///
    /// # Errors
    /// Returns an error that names the line, or the key, its value and the allowed values.
    pub fn read(text: &str) -> Result<Self, SchoolRecordError> {
        let stored: StoredRecord = serde_json::from_str(text).map_err(|error| SchoolRecordError::Syntax(error.to_string()))?;
        if stored.format != FORMAT {
            return Err(SchoolRecordError::Format(stored.format));
        }
        let card = |(name, progress): (String, CardProgress)| {
            let card = Card::from_name(&name).ok_or_else(|| SchoolRecordError::Card(name.clone()))?;
            check(&name, &progress)?;
            Ok((card, progress))
        };
        let cards = stored.cards.into_iter().map(card).collect::<Result<_, _>>()?;
        Ok(Self { rounds: stored.rounds, last_unix_s: stored.last_unix_s, cards })
    }

    /// Returns the record as JSON.
    #[must_use]
    pub fn text(&self) -> String {
        // Serializing plain data with string keys cannot fail.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// Returns the progress with a card; `None` if it was never asked.
    #[must_use]
    pub fn progress(&self, card: Card) -> Option<CardProgress> {
        self.cards.get(&card).copied()
    }

    /// Records an answer: a right one moves the card up one box, a wrong one into the first box.
    pub fn answer(&mut self, card: Card, right: bool, now_unix_s: u64) {
        let before = self.progress(card);
        let number = if right { before.map_or(2, |progress| (progress.number + 1).min(BOX_COUNT)) } else { 1 };
        let days = INTERVALS_DAYS[usize::from(number) - 1];
        let (asked, rights) = before.map_or((0, 0), |progress| (progress.asked, progress.right));
        let progress = CardProgress {
            number,
            due_unix_s: now_unix_s.saturating_add(days * DAY_S),
            asked: asked.saturating_add(1),
            right: rights.saturating_add(u32::from(right)),
        };
        self.cards.insert(card, progress);
        self.last_unix_s = now_unix_s;
    }

    /// Returns up to `count` of the available cards in the order in which to ask them: due cards from the lowest box up, then new
    /// cards, nearest first, then the others, soonest due first.
    #[must_use]
    pub fn choose(&self, available: &[Card], count: usize, now_unix_s: u64) -> Vec<Card> {
        let rank = |card: &Card| match self.progress(*card) {
            Some(progress) if progress.due_unix_s <= now_unix_s => (0, u64::from(progress.number), progress.due_unix_s),
            None => (1, 0, 0),
            Some(progress) => (2, progress.due_unix_s, 0),
        };
        let mut cards: Vec<Card> = available.to_vec();
        cards.sort_unstable();
        cards.dedup();
        cards.sort_by_key(rank);
        cards.truncate(count);
        cards
    }

    /// Returns the time of the last answer, s since the Unix epoch; 0 before the first one.
    #[must_use]
    pub fn last_unix_s(&self) -> u64 {
        self.last_unix_s
    }

    /// Returns the number of cards in the last box, which the trainee knows well.
    #[must_use]
    pub fn mastered(&self) -> usize {
        self.cards.values().filter(|progress| progress.number == BOX_COUNT).count()
    }
}

/// Checks the values of a stored card.
fn check(card: &str, progress: &CardProgress) -> Result<(), SchoolRecordError> {
    let wrong = |key, value, allowed| Err(SchoolRecordError::Value { card: card.to_owned(), key, value, allowed });
    if !(1..=BOX_COUNT).contains(&progress.number) {
        return wrong("box", progress.number.into(), format!("1 to {BOX_COUNT}"));
    }
    if progress.right > progress.asked {
        return wrong("right", progress.right.into(), format!("0 to {}, the value of asked", progress.asked));
    }
    Ok(())
}
