//! The words of the questionnaire, from a TOML file.

use super::{Aspect, Item, Overall, Phase, Tlx};
use crate::base::toml::{Problems, Reader, Section};

/// The shipped wording.
pub const ENGLISH: &str = include_str!("en.toml");

/// Format of the file.
const FORMAT: i64 = 1;
/// Places for a task's number and name.
const NUMBER: &str = "{number}";
const NAME: &str = "{name}";

/// The questionnaire in one language.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wording {
    /// Language, for records.
    pub language: String,
    /// Title.
    pub title: String,
    /// Said before the first question.
    pub introduction: String,
    /// The five answers, from strongly agree to strongly disagree.
    pub scale: [String; 5],
    /// Heading of the questions on the whole.
    pub overall_heading: String,
    overall: [String; 3],
    aspects: [String; 3],
    calibration: String,
    taking_off: String,
    task: String,
    landing: String,
    /// Title of NASA-TLX.
    pub tlx_title: String,
    /// Said before its first scale.
    pub tlx_introduction: String,
    tlx: [String; 6],
    tlx_ends: [String; 4],
}

/// Reads a wording.
///
/// # Errors
/// Everything that is wrong with it.
pub fn read_wording(file: &str, text: &str) -> Result<Wording, Problems> {
    let mut reader = Reader::new(file, text);
    let wording = reader.parse().map(|document| {
        let mut root = reader.root(&document);
        read(&mut reader, &mut root)
    });
    match wording {
        Some(wording) if reader.problems.is_empty() => Ok(wording),
        Some(_) | None => Err(Problems(reader.problems)),
    }
}

fn read(reader: &mut Reader<'_>, root: &mut Section<'_>) -> Wording {
    reader.whole(root, "format", (FORMAT, FORMAT), None);
    let [language, title, introduction] = texts(reader, root, ["language", "title", "introduction"]);
    let mut scale = reader.section(root, "scale");
    let answers = texts(reader, &mut scale, ["strongly_agree", "agree", "neutral", "disagree", "strongly_disagree"]);
    let mut overall = reader.section(root, "overall");
    let [overall_heading] = texts(reader, &mut overall, ["heading"]);
    let statements = texts(reader, &mut overall, Overall::ALL.map(Overall::key));
    let mut by_phase = reader.section(root, "by_phase");
    let aspects = texts(reader, &mut by_phase, Aspect::ALL.map(Aspect::key));
    let mut phases = reader.section(root, "phases");
    let [calibration, taking_off, task, landing] = texts(reader, &mut phases, ["calibration", "taking_off", "task", "landing"]);
    if phases.has("task") && !task.contains(NUMBER) {
        reader.complain(&phases, "task", &task, "text with {number}, and {name} if you like", "tasks would look alike");
    }
    let mut tlx = reader.section(root, "tlx");
    let [tlx_title, tlx_introduction] = texts(reader, &mut tlx, ["title", "introduction"]);
    let scales = texts(reader, &mut tlx, Tlx::ALL.map(Tlx::key));
    let tlx_ends = texts(reader, &mut tlx, ["low", "high", "best", "worst"]);
    for section in [&scale, &overall, &by_phase, &phases, &tlx, root] {
        reader.finish(section);
    }
    Wording {
        language,
        title,
        introduction,
        scale: answers,
        overall_heading,
        overall: statements,
        aspects,
        calibration,
        taking_off,
        task,
        landing,
        tlx_title,
        tlx_introduction,
        tlx: scales,
        tlx_ends,
    }
}

fn texts<const N: usize>(reader: &mut Reader<'_>, section: &mut Section<'_>, keys: [&'static str; N]) -> [String; N] {
    keys.map(|key| reader.text(section, key, None))
}

impl Wording {
    /// The statement of a question.
    #[must_use]
    pub fn statement(&self, item: Item) -> &str {
        match item {
            Item::Overall(Overall::TimePressure) => &self.overall[0],
            Item::Overall(Overall::Frustration) => &self.overall[1],
            Item::Overall(Overall::Feedback) => &self.overall[2],
            Item::Phase(_, Aspect::Performance) => &self.aspects[0],
            Item::Phase(_, Aspect::MentalDemand) => &self.aspects[1],
            Item::Phase(_, Aspect::PhysicalDemand) => &self.aspects[2],
        }
    }

    /// What a question is about: the whole, or its phase. `name` tells a task's name by its number.
    pub fn heading(&self, item: Item, name: impl Fn(u32) -> String) -> String {
        match item {
            Item::Overall(_) => self.overall_heading.clone(),
            Item::Phase(phase, _) => self.phase(phase, name),
        }
    }

    /// A phase in words. `name` tells a task's name by its number.
    pub fn phase(&self, phase: Phase, name: impl Fn(u32) -> String) -> String {
        match phase {
            Phase::Calibration => self.calibration.clone(),
            Phase::TakingOff => self.taking_off.clone(),
            Phase::Task(id) => self.task.replace(NUMBER, &id.to_string()).replace(NAME, &name(id)),
            Phase::Landing => self.landing.clone(),
        }
    }

    /// A NASA-TLX scale: question, words at 0, words at 100.
    #[must_use]
    pub fn tlx(&self, scale: Tlx) -> (&str, &str, &str) {
        let [low, high, best, worst] = &self.tlx_ends;
        match scale {
            Tlx::MentalDemand => (&self.tlx[0], low, high),
            Tlx::PhysicalDemand => (&self.tlx[1], low, high),
            Tlx::TemporalDemand => (&self.tlx[2], low, high),
            Tlx::Performance => (&self.tlx[3], best, worst),
            Tlx::Effort => (&self.tlx[4], low, high),
            Tlx::Frustration => (&self.tlx[5], low, high),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_shipped_wording_is_whole_and_no_two_questions_read_alike() {
        let wording = read_wording("en.toml", ENGLISH).unwrap();
        let name = |id: u32| format!("no. {id}");
        let mut seen: Vec<String> =
            Item::all(&[1, 2, 3, 4]).into_iter().map(|item| wording.heading(item, name) + wording.statement(item)).collect();
        seen.sort();
        seen.dedup();
        assert_eq!(seen.len(), 24);
        assert_eq!(wording.phase(Phase::Task(3), name), "Task 3: no. 3");
        assert_eq!(wording.tlx(Tlx::Performance).1, "perfectly");
    }

    #[test]
    fn exact_a_translation_that_leaves_a_text_out_is_refused_by_line_and_key() {
        let half = ENGLISH.replace("agree = \"agree\"\n", "").replace("task = \"Task {number}: {name}\"", "task = \"Aufgabe\"");
        let problems = read_wording("de.toml", &half).unwrap_err().to_string();
        assert!(problems.contains("scale.agree: missing"), "{problems}");
        assert!(problems.contains("phases.task = ") && problems.contains("{number}"), "{problems}");
        assert!(read_wording("x.toml", "format = 2").is_err());
        assert!(read_wording("x.toml", "format = ").is_err());
    }
}
