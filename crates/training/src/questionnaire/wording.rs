//! Wording of the questionnaire in one language, read from a TOML file.

use super::language_tag::is_language_tag;
use super::{
    InspectionPhase, OverallItem, PhaseAspect, QuestionnaireItem, STRONGLY_AGREE, STRONGLY_DISAGREE, TLX_MAX, TLX_STEP, TlxScale,
};
use spandrel_model::toml::{Problems, Reader, Section};

/// File format version.
const FORMAT_VERSION: i64 = 1;
/// Placeholder for a task number; the next one is for the task name.
const NUMBER_PLACEHOLDER: &str = "{number}";
const NAME_PLACEHOLDER: &str = "{name}";
/// The questionnaire in one language.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wording {
    /// Language tag (BCP 47), for records and browsers.
    pub language: String,
    /// Native name of the language.
    pub language_name: String,
    /// Title of the questionnaire.
    pub title: String,
    /// Introduction shown before the first question.
    pub introduction: String,
    /// The five answers, from strongly agree to strongly disagree.
    pub scale: [String; 5],
    /// Heading above the questions about the whole inspection.
    pub overall_heading: String,
    overall: [String; 3],
    aspects: [String; 3],
    calibration: String,
    taking_off: String,
    task: String,
    landing: String,
    /// Title of the NASA-TLX section.
    pub tlx_title: String,
    /// Introduction shown before the first NASA-TLX scale.
    pub tlx_introduction: String,
    tlx: [String; 6],
    tlx_ends: [String; 4],
    /// Text of the form's controls and messages.
    pub form: FormWording,
}

/// Text of the form's controls and messages, including those of the terminal version.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FormWording {
    /// Progress text with the placeholders `{answered}` and `{all}`.
    pub answered: String,
    /// Note that answers are saved immediately.
    pub at_once: String,
    /// Message after a successful save.
    pub saved: String,
    /// Message after a failed save.
    pub not_saved: String,
    /// Label of the save button.
    pub save: String,
    /// Label of the link back to the session.
    pub back: String,
    /// Label of the language selection.
    pub choose_language: String,
    /// Label of the button that changes the language.
    pub change_language: String,
    /// Key help for the terminal version.
    pub keys: String,
    please_whole: String,
    please_steps: String,
    /// Instructions for continuing later in the terminal version.
    pub later: String,
}

/// Reads a wording from a TOML file.
///
/// # Errors
/// Returns all errors in the file.
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
    reader.integer(root, "format", (FORMAT_VERSION, FORMAT_VERSION), None);
    let [language, language_name, title, introduction] =
        read_texts(reader, root, ["language", "language_name", "title", "introduction"]);
    if root.has("language") && !is_language_tag(&language) {
        reader.add_problem(root, "language", &language, "a language tag such as de or pt-BR", "not a language tag");
    }
    let mut scale = reader.section(root, "scale");
    let answers = read_texts(reader, &mut scale, ["strongly_agree", "agree", "neutral", "disagree", "strongly_disagree"]);
    let mut overall = reader.section(root, "overall");
    let [overall_heading] = read_texts(reader, &mut overall, ["heading"]);
    let statements = read_texts(reader, &mut overall, OverallItem::ALL.map(OverallItem::key));
    let mut by_phase = reader.section(root, "by_phase");
    let aspects = read_texts(reader, &mut by_phase, PhaseAspect::ALL.map(PhaseAspect::key));
    let mut phases = reader.section(root, "phases");
    let [calibration, taking_off, task, landing] =
        read_texts(reader, &mut phases, ["calibration", "taking_off", "task", "landing"]);
    if phases.has("task") && !task.contains(NUMBER_PLACEHOLDER) {
        reader.add_problem(&phases, "task", &task, "text that contains {number} and optionally {name}", "missing {number}");
    }
    let mut tlx = reader.section(root, "tlx");
    let [tlx_title, tlx_introduction] = read_texts(reader, &mut tlx, ["title", "introduction"]);
    let scales = read_texts(reader, &mut tlx, TlxScale::ALL.map(TlxScale::key));
    let tlx_ends = read_texts(reader, &mut tlx, ["low", "high", "best", "worst"]);
    let mut around = reader.section(root, "form");
    let form = form(reader, &mut around);
    for section in [&scale, &overall, &by_phase, &phases, &tlx, &around, root] {
        reader.finish(section);
    }
    Wording {
        language,
        language_name,
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
        form,
    }
}

/// Reads the texts of the form and checks that each contains its placeholders.
fn form(reader: &mut Reader<'_>, section: &mut Section<'_>) -> FormWording {
    let mut text = |key: &'static str, filled_in: &[&str]| {
        let text = reader.text(section, key, None);
        let is_missing = filled_in.iter().any(|word| !text.contains(word));
        if section.has(key) && is_missing {
            reader.add_problem(
                section,
                key,
                &text,
                &format!("text that contains {}", filled_in.join(" and ")),
                "missing placeholder",
            );
        }
        text
    };
    FormWording {
        answered: text("answered", &["{answered}", "{all}"]),
        at_once: text("at_once", &[]),
        saved: text("saved", &[]),
        not_saved: text("not_saved", &[]),
        save: text("save", &[]),
        back: text("back", &[]),
        choose_language: text("choose_language", &[]),
        change_language: text("change_language", &[]),
        keys: text("keys", &[]),
        please_whole: text("please_whole", &["{from}", "{to}"]),
        please_steps: text("please_steps", &["{from}", "{to}", "{step}"]),
        later: text("later", &[]),
    }
}

impl FormWording {
    /// Returns the progress text for `answered` out of `all` questions.
    #[must_use]
    pub fn answered(&self, answered: usize, all: usize) -> String {
        self.answered.replace("{answered}", &answered.to_string()).replace("{all}", &all.to_string())
    }

    /// Returns the input prompt for a statement in the terminal version.
    #[must_use]
    pub fn integer_instruction(&self) -> String {
        self.please_whole.replace("{from}", &STRONGLY_AGREE.to_string()).replace("{to}", &STRONGLY_DISAGREE.to_string())
    }

    /// Returns the input prompt for a NASA-TLX scale in the terminal version.
    #[must_use]
    pub fn step_instruction(&self) -> String {
        let text = self.please_steps.replace("{from}", "0").replace("{to}", &TLX_MAX.to_string());
        text.replace("{step}", &TLX_STEP.to_string())
    }
}

fn read_texts<const N: usize>(reader: &mut Reader<'_>, section: &mut Section<'_>, keys: [&'static str; N]) -> [String; N] {
    keys.map(|key| reader.text(section, key, None))
}

impl Wording {
    /// Returns the statement of a question.
    #[must_use]
    pub fn statement(&self, item: QuestionnaireItem) -> &str {
        match item {
            QuestionnaireItem::Overall(OverallItem::TimePressure) => &self.overall[0],
            QuestionnaireItem::Overall(OverallItem::Frustration) => &self.overall[1],
            QuestionnaireItem::Overall(OverallItem::Feedback) => &self.overall[2],
            QuestionnaireItem::Phase(_, PhaseAspect::Performance) => &self.aspects[0],
            QuestionnaireItem::Phase(_, PhaseAspect::MentalDemand) => &self.aspects[1],
            QuestionnaireItem::Phase(_, PhaseAspect::PhysicalDemand) => &self.aspects[2],
        }
    }

    /// Returns the heading above a question: the whole inspection or its phase. `name` maps a task number to its name.
    pub fn heading(&self, item: QuestionnaireItem, name: impl Fn(u32) -> String) -> String {
        match item {
            QuestionnaireItem::Overall(_) => self.overall_heading.clone(),
            QuestionnaireItem::Phase(phase, _) => self.phase(phase, name),
        }
    }

    /// Returns the name of a phase. `name` maps a task number to its name.
    pub fn phase(&self, phase: InspectionPhase, name: impl Fn(u32) -> String) -> String {
        match phase {
            InspectionPhase::Calibration => self.calibration.clone(),
            InspectionPhase::TakingOff => self.taking_off.clone(),
            InspectionPhase::Task(id) => {
                self.task.replace(NUMBER_PLACEHOLDER, &id.to_string()).replace(NAME_PLACEHOLDER, &name(id))
            }
            InspectionPhase::Landing => self.landing.clone(),
        }
    }

    /// Returns a NASA-TLX scale's question and its labels at 0 and 100.
    #[must_use]
    pub fn tlx(&self, scale: TlxScale) -> (&str, &str, &str) {
        let [low, high, best, worst] = &self.tlx_ends;
        match scale {
            TlxScale::MentalDemand => (&self.tlx[0], low, high),
            TlxScale::PhysicalDemand => (&self.tlx[1], low, high),
            TlxScale::TemporalDemand => (&self.tlx[2], low, high),
            TlxScale::Performance => (&self.tlx[3], best, worst),
            TlxScale::Effort => (&self.tlx[4], low, high),
            TlxScale::Frustration => (&self.tlx[5], low, high),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::language::SHIPPED;
    use super::*;

    const ENGLISH: &str = SHIPPED[0].1;

    #[test]
    fn exact_shipped_wordings_are_complete_and_distinct() {
        for (file, text) in SHIPPED {
            let wording = read_wording(file, text).unwrap();
            let name = |id: u32| format!("no. {id}");
            let mut seen: Vec<String> = QuestionnaireItem::all(&[1, 2, 3, 4])
                .into_iter()
                .map(|item| wording.heading(item, name) + wording.statement(item))
                .collect();
            seen.extend(TlxScale::ALL.map(|scale| wording.tlx(scale).0.to_owned()));
            seen.extend(wording.scale.clone());
            seen.sort();
            seen.dedup();
            assert_eq!(seen.len(), 24 + 6 + 5, "{file}");
            assert!(wording.phase(InspectionPhase::Task(3), name).contains("3: no. 3"), "{file}");
            assert_eq!(file, format!("{}.toml", wording.language));
        }
        let wording = read_wording("en.toml", ENGLISH).unwrap();
        assert_eq!(wording.tlx(TlxScale::Performance).1, "perfect");
        assert_eq!(wording.form.answered(3, 24), "3 of 24 answered");
        assert_eq!(wording.form.step_instruction(), "Please enter a number from 0 to 100 in steps of 5, b or q, or press Enter.");
    }

    #[test]
    fn exact_translations_contain_no_english_text() {
        let texts = |text: &str| -> Vec<String> {
            let lines = text.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once(" = "));
            lines.filter(|(key, _)| !matches!(*key, "format" | "neutral")).map(|(_, value)| value.to_owned()).collect()
        };
        let english = texts(ENGLISH);
        for (file, text) in &SHIPPED[1..] {
            let left: Vec<String> = texts(text).into_iter().filter(|value| english.contains(value)).collect();
            assert!(left.is_empty(), "{file}: {left:?}");
        }
    }

    #[test]
    fn exact_incomplete_translation_is_rejected_with_line_and_key() {
        let half = ENGLISH.replace("agree = \"agree\"\n", "").replace("task = \"Task {number}: {name}\"", "task = \"Aufgabe\"");
        let half = half.replace("{answered} of {all} answered", "{answered} beantwortet").replace("\"en\"", "\"Deutsch!\"");
        let problems = read_wording("de.toml", &half).unwrap_err().to_string();
        assert!(problems.contains("scale.agree: missing"), "{problems}");
        assert!(problems.contains("phases.task = ") && problems.contains("{number}"), "{problems}");
        assert!(problems.contains("form.answered = ") && problems.contains("{answered} and {all}"), "{problems}");
        let line = 1 + half.lines().position(|line| line.starts_with("language = ")).unwrap();
        assert!(problems.contains(&format!("de.toml:{line}: language = ")), "{problems}");
        assert!(read_wording("x.toml", "format = 2").is_err());
        assert!(read_wording("x.toml", "format = ").is_err());
    }
}
