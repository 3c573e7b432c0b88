//! A round of questions.

use super::card::{Card, Subject};
use super::gallery::SchoolPicture;
use super::record::SchoolRecord;
use crate::terms::{defect_title, element_title};
use spandrel_model::defect_codes;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::PlacedDefect;
use spandrel_text::terms::capitalized;
use spandrel_text::{Language, text};
use std::collections::VecDeque;

/// Number of cards in a round (estimate: about five minutes).
pub const CARDS_PER_ROUND: usize = 10;
/// Number of other questions before a missed card is asked again in the same round.
const REPEAT_AFTER: usize = 3;
/// Maximum number of repetitions of a card in a round (estimate): whoever misses everything still sees every card.
const MAX_REPETITIONS: u8 = 2;
/// Millimeters in a meter.
const MM_PER_M: f64 = 1000.0;
/// Number of defects for each sound surface among the cards.
const OTHERS_PER_SOUND: usize = 3;

/// A question: one picture and the possible answers.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// The picture.
    pub picture: SchoolPicture,
    /// Possible answers.
    pub answers: Vec<Answer>,
    /// Number of times that the card was missed earlier in this round.
    pub misses: u8,
}

/// A possible answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// A defect with this AASHTO MBEI code.
    Defect(u32),
    /// No defect can be seen from this distance.
    Nothing,
}

/// Response to an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Verdict {
    /// Whether the answer was right.
    pub right: bool,
    /// The right answer, and how to recognize it.
    pub words: Vec<String>,
}

/// Result of a round.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RoundSummary {
    /// Number of cards that were answered.
    pub asked: usize,
    /// Number of cards whose first answer was right.
    pub right: usize,
    /// Cards whose first answer was wrong, as text.
    pub missed: Vec<String>,
}

/// A round in progress.
#[derive(Debug, Clone)]
pub struct Round {
    /// Cards to ask, and how often each was asked before in this round.
    waiting: VecDeque<(Card, u8)>,
    pictures: Vec<SchoolPicture>,
    stream: RandomStream,
    current: Option<Question>,
    first_answers: Vec<(Card, bool)>,
    total: usize,
}

impl Answer {
    /// Returns the words for a list of answers.
    #[must_use]
    pub fn words(self, language: Language) -> String {
        match self {
            Self::Defect(code) => capitalized(&defect_title(code, language)),
            Self::Nothing => text!(language, "school-nothing"),
        }
    }
}

impl Question {
    fn new(picture: SchoolPicture, misses: u8) -> Self {
        let defects = picture.element.permitted_defects().iter().map(|code| Answer::Defect(*code));
        Self { answers: defects.chain([Answer::Nothing]).collect(), picture, misses }
    }

    /// Returns the right answer.
    #[must_use]
    pub fn right_answer(&self) -> Answer {
        match self.picture.card.subject {
            Subject::Defect(code) if self.picture.visible => Answer::Defect(code),
            Subject::Defect(_) | Subject::Sound => Answer::Nothing,
        }
    }

    /// Returns the question as text.
    #[must_use]
    pub fn words(&self, language: Language) -> String {
        let Self { picture: SchoolPicture { element, card, .. }, .. } = self;
        let (number, distance) = (element.number().to_string(), card.distance.m().to_string());
        let element = capitalized(&element_title(*element, language));
        text!(language, "school-question", element = element, number = number, distance = distance)
    }

    fn verdict(&self, given: Answer, language: Language) -> Verdict {
        let right_answer = self.right_answer();
        let right = given == right_answer;
        let first = match (right, given) {
            (true, _) => text!(language, "school-right"),
            (false, Answer::Defect(code)) => text!(language, "school-wrong", defect = defect_title(code, language)),
            (false, Answer::Nothing) => text!(language, "school-wrong-nothing"),
        };
        let rest = match (&self.picture.defect, right_answer) {
            (Some(defect), Answer::Defect(code)) => vec![appearance(code, language), size_words(defect, language)],
            (Some(defect), Answer::Nothing) => vec![self.hidden_words(defect, language)],
            (None, _) => vec![text!(language, "school-sound-surface")],
        };
        Verdict { right, words: std::iter::once(first).chain(rest).collect() }
    }

    /// Explains why a defect cannot be seen.
    fn hidden_words(&self, defect: &PlacedDefect, language: Language) -> String {
        text!(
            language,
            "school-hidden",
            defect = defect_title(defect.kind, language),
            distance = self.picture.card.distance.m().to_string(),
            pixel = format!("{:.1}", MM_PER_M * self.picture.pixel_m),
            size = size_words(defect, language)
        )
    }
}

impl Round {
    /// Starts a round with the cards that the record says to ask. `seed` selects the pictures.
    #[must_use]
    pub fn new(record: &SchoolRecord, pictures: Vec<SchoolPicture>, seed: u64, now_unix_s: u64) -> Self {
        let is_sound = |card: &Card| card.subject == Subject::Sound;
        let cards: Vec<Card> = pictures.iter().map(|picture| picture.card).collect();
        let (sound, defects): (Vec<Card>, Vec<Card>) = cards.into_iter().partition(is_sound);
        let sound_count = CARDS_PER_ROUND / (OTHERS_PER_SOUND + 1);
        let mut chosen = record.choose(&defects, CARDS_PER_ROUND - sound_count, now_unix_s);
        chosen.extend(record.choose(&sound, sound_count, now_unix_s));
        let mut stream = RandomStream::new(seed, "school.round");
        let mut waiting = VecDeque::new();
        while !chosen.is_empty() {
            waiting.push_back((chosen.swap_remove(stream.below(chosen.len())), 0));
        }
        let total = waiting.len();
        let mut round = Self { waiting, pictures, stream, current: None, first_answers: Vec::new(), total };
        round.advance();
        round
    }

    /// Returns the current question; `None` at the end of the round.
    #[must_use]
    pub fn question(&self) -> Option<&Question> {
        self.current.as_ref()
    }

    /// Returns the number of the current card and the number of cards, such as (3, 10). A repetition keeps the number.
    #[must_use]
    pub fn position(&self) -> (usize, usize) {
        let current = self.current.as_ref().is_some_and(|question| question.misses == 0);
        (self.first_answers.len() + usize::from(current), self.total)
    }

    /// Answers the current question with one of its answers, and records it. `None` if there is no question or no such answer.
    pub fn answer(&mut self, number: usize, record: &mut SchoolRecord, now_unix_s: u64, language: Language) -> Option<Verdict> {
        let question = self.current.take()?;
        let Some(given) = question.answers.get(number) else {
            self.current = Some(question);
            return None;
        };
        let verdict = question.verdict(*given, language);
        let card = question.picture.card;
        // A repetition in the same round says little about tomorrow.
        if question.misses == 0 {
            record.answer(card, verdict.right, now_unix_s);
            self.first_answers.push((card, verdict.right));
        }
        if !verdict.right && question.misses < MAX_REPETITIONS {
            self.waiting.insert(REPEAT_AFTER.min(self.waiting.len()), (card, question.misses + 1));
        }
        Some(verdict)
    }

    /// Continues with the next question once the current one is answered.
    pub fn advance(&mut self) {
        if self.current.is_some() {
            return;
        }
        self.current = self.waiting.pop_front().and_then(|(card, misses)| {
            let same: Vec<&SchoolPicture> = self.pictures.iter().filter(|picture| picture.card == card).collect();
            let picture = *same.get(self.stream.below(same.len().max(1)))?;
            Some(Question::new(picture.clone(), misses))
        });
    }

    /// Returns the result so far.
    #[must_use]
    pub fn summary(&self, language: Language) -> RoundSummary {
        let missed = self.first_answers.iter().filter(|(_, right)| !right).map(|(card, _)| card_words(*card, language)).collect();
        let right = self.first_answers.iter().filter(|(_, right)| *right).count();
        RoundSummary { asked: self.first_answers.len(), right, missed }
    }
}

/// Returns a card as text, such as "cracking from 3 m".
fn card_words(card: Card, language: Language) -> String {
    let subject = match card.subject {
        Subject::Sound => text!(language, "school-sound"),
        Subject::Defect(code) => defect_title(code, language),
    };
    text!(language, "school-card", subject = subject, distance = card.distance.m().to_string())
}

/// Returns how to recognize a defect in a picture (docs/src/reference/domain.md, "Defects").
fn appearance(code: u32, language: Language) -> String {
    match code {
        defect_codes::CORROSION => text!(language, "school-corrosion"),
        defect_codes::FATIGUE => text!(language, "school-fatigue"),
        defect_codes::CONNECTION => text!(language, "school-connection"),
        defect_codes::SPALL => text!(language, "school-spall"),
        defect_codes::REBAR => text!(language, "school-rebar"),
        defect_codes::EFFLORESCENCE => text!(language, "school-efflorescence"),
        defect_codes::ABRASION => text!(language, "school-abrasion"),
        defect_codes::MORTAR => text!(language, "school-mortar"),
        defect_codes::SPLIT_STONE => text!(language, "school-split-stone"),
        defect_codes::CRACK | defect_codes::PSC_CRACK => text!(language, "school-crack"),
        _ => text!(language, "school-defect"),
    }
}

/// Returns the size of a defect as a sentence.
fn size_words(defect: &PlacedDefect, language: Language) -> String {
    let (length, width_mm) = (format!("{:.0}", MM_PER_M * defect.length_m), MM_PER_M * defect.width_m);
    if defect.line {
        text!(language, "school-size-line", width = format!("{width_mm:.2}"), length = length)
    } else {
        text!(language, "school-size-area", length = length, width = format!("{width_mm:.0}"))
    }
}
