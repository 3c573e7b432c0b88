//! Marks that an instructor puts on the timeline of a finished session. They are in a file of their own and change neither the
//! recording nor the scores.

use serde::{Deserialize, Serialize};
use spandrel_monitor::folder::sha256_hex;

/// File in a session folder with the instructor's marks.
pub const MARKS: &str = "marks.json";
/// File format version.
const FORMAT_VERSION: u32 = 1;
/// Maximum number of marks in a session (estimate: more than can be told apart on the timeline).
pub const MAX_MARKS: usize = 100;
/// Maximum length of a mark's text, characters.
pub const MAX_TEXT_LEN: usize = 200;

/// A mark.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TimelineMark {
    /// Moment of the flight, s since lift-off.
    pub t_s: f64,
    /// The instructor's text.
    pub text: String,
    /// Name of the instructor; empty if they were erased.
    pub by: String,
    /// Time when the mark was added, µs since the Unix epoch. It identifies the mark in its session.
    pub added_unix_us: u64,
}

/// Contents of the file.
#[derive(Debug, Serialize, Deserialize)]
struct MarksFile {
    format: u32,
    marks: Vec<TimelineMark>,
}

/// Reads the file's contents. Returns the marks by moment.
///
/// # Errors
/// Returns what is wrong, with the key, its value and the allowed range.
pub fn read_marks(json: &str) -> Result<Vec<TimelineMark>, String> {
    let file: MarksFile = serde_json::from_str(json).map_err(|error| error.to_string())?;
    if file.format != FORMAT_VERSION {
        return Err(format!("format = {} (allowed: {FORMAT_VERSION})", file.format));
    }
    if file.marks.len() > MAX_MARKS {
        return Err(format!("marks: {} marks (allowed: at most {MAX_MARKS})", file.marks.len()));
    }
    for mark in &file.marks {
        let count = mark.text.chars().count();
        if !(1..=MAX_TEXT_LEN).contains(&count) {
            return Err(format!("marks.text: {count} characters (allowed: 1 to {MAX_TEXT_LEN})"));
        }
        if mark.t_s < 0.0 {
            return Err(format!("marks.t_s = {} (allowed: 0 or more)", mark.t_s));
        }
    }
    Ok(by_moment(file.marks))
}

/// Returns the file's contents with these marks.
///
/// # Errors
/// Returns an error if the marks cannot be serialized as JSON (not expected in practice).
pub fn marks_json(marks: Vec<TimelineMark>) -> Result<String, serde_json::Error> {
    let file = MarksFile { format: FORMAT_VERSION, marks: by_moment(marks) };
    serde_json::to_string_pretty(&file).map(|text| text + "\n")
}

fn by_moment(mut marks: Vec<TimelineMark>) -> Vec<TimelineMark> {
    marks.sort_by(|a, b| a.t_s.total_cmp(&b.t_s).then(a.added_unix_us.cmp(&b.added_unix_us)));
    marks
}

/// Returns a key that changes with the marks, hexadecimal; `None` without marks. A report contains the key of the marks that
/// it shows, so that the server creates the report again when the marks change.
#[must_use]
pub fn marks_key(marks: &[TimelineMark]) -> Option<String> {
    let text: String =
        marks.iter().map(|mark| format!("{} {} {} {}\n", mark.t_s, mark.added_unix_us, mark.by, mark.text)).collect();
    (!marks.is_empty()).then(|| sha256_hex(text.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(t_s: f64, added_unix_us: u64) -> TimelineMark {
        TimelineMark { t_s, text: "too high \"here\"".into(), by: "ida".into(), added_unix_us }
    }

    #[test]
    fn exact_marks_round_trip_in_order_of_their_moments() {
        let marks = vec![mark(9.5, 2), mark(0.25, 3), mark(9.5, 1)];
        let read = read_marks(&marks_json(marks).unwrap()).unwrap();
        assert_eq!(read, [mark(0.25, 3), mark(9.5, 1), mark(9.5, 2)]);
        assert_eq!(marks_key(&[]), None);
        let keys = [marks_key(&read), marks_key(&read[1..]), marks_key(&[mark(0.5, 3), mark(9.5, 1), mark(9.5, 2)])];
        assert!(keys[0] != keys[1] && keys[0] != keys[2] && keys[1] != keys[2], "{keys:?}");
    }

    #[test]
    fn exact_invalid_files_are_rejected() {
        let one =
            |change: &str, with: &str| read_marks(&marks_json(vec![mark(1.0, 1)]).unwrap().replace(change, with)).unwrap_err();
        assert_eq!(one("\"format\": 1", "\"format\": 2"), "format = 2 (allowed: 1)");
        assert_eq!(one("1.0", "-1.0"), "marks.t_s = -1 (allowed: 0 or more)");
        assert_eq!(one("too high \\\"here\\\"", ""), "marks.text: 0 characters (allowed: 1 to 200)");
        assert!(one("\"by\"", "\"bye\"").contains("missing field `by`"));
        let many = marks_json((0..=MAX_MARKS as u64).map(|k| mark(1.0, k)).collect()).unwrap();
        assert_eq!(read_marks(&many).unwrap_err(), "marks: 101 marks (allowed: at most 100)");
    }
}
