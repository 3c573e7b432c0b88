//! Reads and writes `answers.json`, which stores a trainee's answers so far.

use super::language_tag::is_language_tag;
use super::{QuestionnaireItem, STRONGLY_AGREE, STRONGLY_DISAGREE, TLX_MAX, TLX_STEP, TlxScale};
use serde::de::Error as _;
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use spandrel_model::toml::{Problem, Problems};
use std::collections::BTreeMap;

/// File name within the session folder.
pub const ANSWERS: &str = "answers.json";

/// File format version.
const FORMAT_VERSION: u64 = 1;
/// Maximum file size, bytes; far more than 24 answers need.
const MAX_FILE_BYTES: usize = 64 * 1024;

/// A session's answers, possibly incomplete.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Answers {
    /// Questionnaire language used for the answers.
    pub language: String,
    /// Answers from 1 (strongly agree) to 5 (strongly disagree).
    pub given: BTreeMap<QuestionnaireItem, u8>,
    /// NASA-TLX ratings, 0 to 100 in steps of 5; empty if the trainee skipped this part.
    pub tlx: BTreeMap<TlxScale, u8>,
}

impl Answers {
    /// Returns the unanswered questions in questionnaire order.
    #[must_use]
    pub fn open(&self, tasks: &[u32]) -> Vec<QuestionnaireItem> {
        QuestionnaireItem::all(tasks).into_iter().filter(|item| !self.given.contains_key(item)).collect()
    }

    /// Returns whether all questions for a job with these tasks are answered.
    #[must_use]
    pub fn complete(&self, tasks: &[u32]) -> bool {
        self.open(tasks).is_empty()
    }
}

impl Serialize for Answers {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let words = |pairs: Vec<(String, u8)>| pairs.into_iter().map(|(key, value)| (key, value.into())).collect();
        let given: serde_json::Map<String, Value> = words(self.given.iter().map(|(item, a)| (item.to_string(), *a)).collect());
        let tlx: serde_json::Map<String, Value> = words(self.tlx.iter().map(|(scale, a)| (scale.key().to_owned(), *a)).collect());
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("format", &FORMAT_VERSION)?;
        map.serialize_entry("language", &self.language)?;
        map.serialize_entry("answers", &given)?;
        if !tlx.is_empty() {
            map.serialize_entry("tlx", &tlx)?;
        }
        map.end()
    }
}

/// Answers as stored in session records. They were validated when they were first read, so only unknown questions are rejected
/// here.
#[derive(Deserialize)]
struct StoredAnswers {
    language: String,
    #[serde(default)]
    answers: BTreeMap<String, u8>,
    #[serde(default)]
    tlx: BTreeMap<String, u8>,
}

impl<'de> Deserialize<'de> for Answers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let kept = StoredAnswers::deserialize(deserializer)?;
        let unknown = |key: &str| D::Error::custom(format!("unknown question {key}"));
        let item = |(key, value): (&String, &u8)| {
            QuestionnaireItem::from_key(key).map(|item| (item, *value)).ok_or_else(|| unknown(key))
        };
        let scale =
            |(key, value): (&String, &u8)| TlxScale::from_key(key).map(|scale| (scale, *value)).ok_or_else(|| unknown(key));
        Ok(Self {
            given: kept.answers.iter().map(item).collect::<Result<_, _>>()?,
            tlx: kept.tlx.iter().map(scale).collect::<Result<_, _>>()?,
            language: kept.language,
        })
    }
}

/// Reads `answers.json` for a job with these tasks. Answers may be missing, but those present must be valid.
///
/// # Errors
/// Returns all errors in the file, each with file, line, key, value and allowed values.
pub fn read_answers(file: &str, text: &str, tasks: &[u32]) -> Result<Answers, Problems> {
    let mut reading = AnswerReader { file, text, problems: Vec::new() };
    if text.len() > MAX_FILE_BYTES {
        reading.invalid_answer("", &format!("{} bytes", text.len()), &format!("at most {MAX_FILE_BYTES} bytes"), "too large");
        return Err(Problems(reading.problems));
    }
    let answers = match serde_json::from_str::<Value>(text) {
        Ok(Value::Object(map)) => reading.answers(&map, tasks),
        Ok(other) => {
            reading.invalid_answer("", &json_text(&other), "a JSON object", "not an object");
            Answers::default()
        }
        Err(error) => {
            let message = error.to_string();
            reading.add_problem_at(error.line(), "syntax", "", "JSON", &message);
            Answers::default()
        }
    };
    if reading.problems.is_empty() { Ok(answers) } else { Err(Problems(reading.problems)) }
}

struct AnswerReader<'a> {
    file: &'a str,
    text: &'a str,
    problems: Vec<Problem>,
}

impl AnswerReader<'_> {
    fn answers(&mut self, map: &serde_json::Map<String, Value>, tasks: &[u32]) -> Answers {
        let keys = "format, language, answers, tlx";
        for (key, value) in map.iter().filter(|(key, _)| !keys.split(", ").any(|known| known == *key)) {
            self.invalid_answer(key, &json_text(value), keys, "unknown key");
        }
        match map.get("format").map(|value| (value.as_u64(), value)) {
            Some((Some(FORMAT_VERSION), _)) => {}
            Some((_, value)) => {
                self.invalid_answer("format", &json_text(value), &FORMAT_VERSION.to_string(), "unsupported format version")
            }
            None => self.invalid_answer("format", "", &FORMAT_VERSION.to_string(), "missing"),
        }
        let language = map.get("language").and_then(Value::as_str).filter(|tag| is_language_tag(tag));
        if language.is_none() {
            let value = map.get("language").map(json_text).unwrap_or_default();
            self.invalid_answer("language", &value, "a language tag such as en", "missing or invalid");
        }
        let known = QuestionnaireItem::all(tasks);
        let allowed_keys = known.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        let item = |key: &str| QuestionnaireItem::from_key(key).filter(|item| known.contains(item));
        let likert = |value: u8| (STRONGLY_AGREE..=STRONGLY_DISAGREE).contains(&value);
        let tlx = |value: u8| value <= TLX_MAX && value.is_multiple_of(TLX_STEP);
        let tlx_keys = TlxScale::ALL.map(TlxScale::key).join(", ");
        let to_five = format!("whole number {STRONGLY_AGREE} to {STRONGLY_DISAGREE}");
        let to_hundred = format!("0 to {TLX_MAX} in steps of {TLX_STEP}");
        Answers {
            language: language.unwrap_or_default().to_owned(),
            given: self.table(map, "answers", (&allowed_keys, &to_five), item, likert),
            tlx: self.table(map, "tlx", (&tlx_keys, &to_hundred), TlxScale::from_key, tlx),
        }
    }

    fn table<K: Ord>(
        &mut self,
        map: &serde_json::Map<String, Value>,
        name: &str,
        (allowed_keys, allowed): (&str, &str),
        known: impl Fn(&str) -> Option<K>,
        fits: impl Fn(u8) -> bool,
    ) -> BTreeMap<K, u8> {
        let mut found = BTreeMap::new();
        let table = match map.get(name) {
            None => return found,
            Some(Value::Object(table)) => table,
            Some(other) => {
                self.invalid_answer(name, &json_text(other), "a JSON object", "not an object");
                return found;
            }
        };
        for (key, value) in table {
            let number = value.as_u64().and_then(|number| u8::try_from(number).ok()).filter(|number| fits(*number));
            match (known(key), number) {
                (Some(key), Some(number)) => {
                    found.insert(key, number);
                }
                (None, _) => self.invalid_answer(key, &json_text(value), allowed_keys, &format!("unknown key in {name}")),
                (Some(_), None) => self.invalid_answer(key, &json_text(value), allowed, "invalid answer"),
            }
        }
        found
    }

    fn invalid_answer(&mut self, key: &str, value: &str, allowed: &str, message: &str) {
        let quoted = Value::from(key).to_string();
        let offset = if key.is_empty() { Some(0) } else { self.text.find(&quoted) };
        let line = offset.map_or(1, |offset| 1 + self.text[..offset].matches('\n').count());
        self.add_problem_at(line, key, value, allowed, message);
    }

    fn add_problem_at(&mut self, line: usize, key: &str, value: &str, allowed: &str, message: &str) {
        let short = |text: &str| text.chars().filter(|c| !c.is_control()).take(60).collect::<String>();
        self.problems.push(Problem {
            file: self.file.to_owned(),
            line,
            key: short(key),
            location: short(key),
            value: short(value),
            allowed: allowed.to_owned(),
            message: message.to_owned(),
        });
    }
}

fn json_text(value: &Value) -> String {
    value.to_string()
}

#[cfg(test)]
mod tests {
    use super::super::{InspectionPhase, OverallItem, PhaseAspect};
    use super::*;

    const TASKS: [u32; 4] = [1, 2, 3, 4];

    fn problems(text: &str) -> String {
        read_answers("answers.json", text, &TASKS).unwrap_err().to_string()
    }

    #[test]
    fn exact_answers_round_trip() {
        let mut answers = Answers { language: "en".into(), ..Answers::default() };
        answers.given.insert(QuestionnaireItem::Overall(OverallItem::Feedback), 1);
        answers.given.insert(QuestionnaireItem::Phase(InspectionPhase::Task(3), PhaseAspect::MentalDemand), 5);
        answers.tlx.insert(TlxScale::Effort, 65);
        let text = serde_json::to_string_pretty(&answers).unwrap();
        assert_eq!(read_answers("answers.json", &text, &TASKS), Ok(answers.clone()));
        assert_eq!(serde_json::from_str::<Answers>(&text).unwrap(), answers);
        assert_eq!(answers.open(&TASKS).len(), 22);
        assert!(!answers.complete(&TASKS));
    }

    #[test]
    fn exact_errors_name_file_line_key_value_and_range() {
        let told = problems("{\"format\": 1, \"language\": \"en\",\n\"answers\": {\n\"frustration\": 6}}");
        assert_eq!(told, "answers.json:3: frustration = 6: invalid answer (allowed: whole number 1 to 5)");
        for (text, expected) in [
            ("[]", "not an object"),
            ("{\"format\": 1,", "syntax"),
            ("{\"language\": \"en\"}", "format: missing (allowed: 1)"),
            ("{\"format\": 2, \"language\": \"en\"}", "format = 2: unsupported format version (allowed: 1)"),
            ("{\"format\": 1}", "language"),
            ("{\"format\": 1, \"language\": \"<b>\"}", "language"),
            ("{\"format\": 1, \"language\": \"en\", \"scores\": {}}", "scores = {}: unknown key"),
            ("{\"format\": 1, \"language\": \"en\", \"answers\": 3}", "answers = 3: not an object"),
            ("{\"format\": 1, \"language\": \"en\", \"answers\": {\"task_5.performance\": 1}}", "unknown key in answers"),
            ("{\"format\": 1, \"language\": \"en\", \"answers\": {\"feedback\": 2.5}}", "feedback = 2.5"),
            ("{\"format\": 1, \"language\": \"en\", \"answers\": {\"feedback\": -1}}", "feedback = -1"),
            ("{\"format\": 1, \"language\": \"en\", \"tlx\": {\"effort\": 7}}", "0 to 100 in steps of 5"),
        ] {
            assert!(problems(text).contains(expected), "{text}: {}", problems(text));
        }
        let large = format!("{{\"format\": 1, \"language\": \"{}\"}}", "x".repeat(MAX_FILE_BYTES));
        assert!(problems(&large).contains("too large"));
    }
}
