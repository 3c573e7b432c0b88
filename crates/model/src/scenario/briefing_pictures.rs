//! Pictures of the briefing: reads the names of their files and their captions. The program loads the files.

use crate::toml::{Problem, Reader, Section};
use serde::Serialize;

/// Name of the repeated table.
pub(super) const TABLE: &str = "briefing_pictures";
/// Key of the file's name.
const FILE: &str = "file";
/// Maximum number of pictures (estimate: they fit on two printed pages).
pub const MAX_BRIEFING_PICTURES: usize = 6;
/// Maximum length of a caption, characters (estimate: two lines below a picture).
pub const MAX_CAPTION_CHARS: usize = 200;
/// Maximum length of a file's name with its folders, characters (estimate: file systems allow about 250 bytes a part).
const MAX_FILE_CHARS: usize = 200;
/// Ends of the files' names.
const EXTENSIONS: [&str; 3] = ["png", "jpg", "jpeg"];
/// Allowed names, for messages.
const ALLOWED_FILES: &str = "a .png, .jpg or .jpeg file in the scenario's folder or below, with / between folders, without ..";

/// A picture of the briefing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct BriefingPicture {
    /// Name of the file in the scenario's folder or below, with `/` between folders and file.
    pub file: String,
    /// Caption, one line.
    pub caption: String,
}

/// Reads the pictures, in file order.
pub(super) fn read(r: &mut Reader, root: &mut Section) -> Vec<BriefingPicture> {
    let mut pictures: Vec<BriefingPicture> = Vec::new();
    for mut s in r.sections(root, TABLE) {
        let picture = BriefingPicture { file: read_file(r, &mut s), caption: read_caption(r, &mut s) };
        if !picture.file.is_empty() && pictures.iter().any(|other| other.file == picture.file) {
            r.add_problem(&s, FILE, &picture.file, "a file of its own for each picture", "duplicate file");
        }
        r.finish(&s);
        pictures.push(picture);
    }
    if pictures.len() > MAX_BRIEFING_PICTURES {
        let allowed = format!("at most {MAX_BRIEFING_PICTURES} [[{TABLE}]]");
        r.add_problem(root, TABLE, &pictures.len().to_string(), &allowed, "too many");
    }
    pictures
}

fn read_file(r: &mut Reader, s: &mut Section) -> String {
    let before = r.problems.len();
    let file = r.text(s, FILE, None);
    if !is_picture_name(&file) && r.problems.len() == before {
        r.add_problem(s, FILE, &file, ALLOWED_FILES, "invalid file name");
    }
    file
}

fn read_caption(r: &mut Reader, s: &mut Section) -> String {
    let before = r.problems.len();
    let caption = r.text(s, "caption", None);
    if !is_caption(&caption) && r.problems.len() == before {
        let given = format!("{} characters", caption.chars().count());
        let allowed = format!("1 to {MAX_CAPTION_CHARS} characters on one line");
        r.add_problem(s, "caption", &given, &allowed, "invalid caption");
    }
    caption
}

fn is_caption(text: &str) -> bool {
    !text.trim().is_empty() && text.chars().count() <= MAX_CAPTION_CHARS && !text.chars().any(char::is_control)
}

/// Returns whether a briefing may have a picture with this file name: a relative path that stays inside its folder on every
/// operating system, and that ends like a PNG or JPEG file.
#[must_use]
pub fn is_picture_name(name: &str) -> bool {
    let is_plain = |c: char| !c.is_control() && c != '\\' && c != ':';
    let has_extension = |(_, end): (&str, &str)| EXTENSIONS.iter().any(|one| end.eq_ignore_ascii_case(one));
    name.chars().count() <= MAX_FILE_CHARS
        && name.chars().all(is_plain)
        && name.split('/').all(|part| !["", ".", ".."].contains(&part))
        && name.rsplit_once('.').is_some_and(has_extension)
}

/// Checks the files of a scenario's pictures. `check` loads the file with a name, or returns why it can't be used. Returns a
/// problem for each file that can't be used; `allowed` describes the files that can.
#[must_use]
pub fn check_picture_files(file: &str, text: &str, allowed: &str, check: &dyn Fn(&str) -> Result<(), String>) -> Vec<Problem> {
    let mut reader = Reader::new(file, text);
    if let Some(document) = reader.parse() {
        let mut root = reader.root(&document);
        for mut section in reader.sections(&mut root, TABLE) {
            let name = reader.text(&mut section, FILE, None);
            if let Err(message) = check(&name) {
                reader.add_problem(&section, FILE, &name, allowed, &message);
            }
        }
    }
    reader.problems
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::resolve::crc;
    use crate::scenario::{Scenario, read as read_scenario};
    use crate::shipped::PRACTICE;
    use crate::toml::Problems;

    fn with_pictures(tables: &str) -> String {
        PRACTICE.replacen("\n[origin]", &format!("\n{tables}\n[origin]"), 1)
    }

    fn parsed(tables: &str) -> Result<Scenario, Problems> {
        read_scenario("job.toml", &with_pictures(tables), &|_| Err(String::new()))
    }

    fn table(file: &str, caption: &str) -> String {
        format!("[[briefing_pictures]]\nfile = \"{file}\"\ncaption = \"{caption}\"\n")
    }

    /// Returns key, value and message of each problem.
    fn problems(tables: &str) -> Vec<(String, String, String)> {
        let problems = parsed(tables).unwrap_err().0;
        problems.into_iter().map(|problem| (problem.location, problem.value, problem.message)).collect()
    }

    #[test]
    fn exact_pictures_are_read_in_order() {
        let scenario = parsed(&(table("gate.png", "The gate") + &table("site/from above.JPG", "From above"))).unwrap();
        let picture = |file: &str, caption: &str| BriefingPicture { file: file.into(), caption: caption.into() };
        assert_eq!(scenario.briefing_pictures, [picture("gate.png", "The gate"), picture("site/from above.JPG", "From above")]);
        assert_eq!(parsed("").unwrap().briefing_pictures, []);
    }

    #[test]
    fn exact_pictures_do_not_change_the_checksum() {
        let text = with_pictures(&table("gate.png", "The gate"));
        assert_ne!(text, PRACTICE);
        assert_eq!(crc(&text), crc(PRACTICE));
        assert_eq!(parsed(&table("gate.png", "The gate")).unwrap().crc, crc(PRACTICE));
    }

    #[test]
    fn exact_names_that_leave_the_folder_or_are_no_pictures_are_refused() {
        let long = format!("{}.png", "x".repeat(MAX_FILE_CHARS - 4));
        for good in ["a.png", "a/b.jpeg", "Lageplan Süd.jpg", "a..b.PNG", "..a.png", &long] {
            assert!(is_picture_name(good), "{good}");
        }
        let bad = ["", "png", "a.gif", "a.png.svg", "/a.png", "../a.png", "a/../b.png", "./a.png", "a//b.png", "a/b.png/"];
        let elsewhere = ["C:a.png", "C:/a.png", "a\\b.png", "\\\\host\\a.png", "a\n.png", "a\0.png", &format!("x{long}")];
        for bad in bad.into_iter().chain(elsewhere) {
            assert!(!is_picture_name(bad), "{bad}");
        }
        let found = problems(&table("../gate.png", "The gate"));
        assert_eq!(found, [("briefing_pictures[0].file".into(), "../gate.png".into(), "invalid file name".into())]);
    }

    #[test]
    fn exact_captions_have_1_to_200_characters_on_one_line() {
        assert!(parsed(&table("a.png", &"ü".repeat(MAX_CAPTION_CHARS))).is_ok());
        for (caption, characters) in [("", 0), (" ", 1), ("a\\nb", 3), (&*"ü".repeat(MAX_CAPTION_CHARS + 1), 201)] {
            let expected = ("briefing_pictures[0].caption".into(), format!("{characters} characters"), "invalid caption".into());
            assert_eq!(problems(&table("a.png", caption)), [expected]);
        }
    }

    #[test]
    fn exact_missing_unknown_and_repeated_values_are_reported_once() {
        let found = problems("[[briefing_pictures]]\nfile = 3\nwidth = 2\n");
        let messages: Vec<&str> = found.iter().map(|(.., message)| message.as_str()).collect();
        assert_eq!(messages, ["not a string", "missing", "unknown key"]);
        let twice = problems(&table("a.png", "one").repeat(2));
        assert_eq!(twice, [("briefing_pictures[1].file".into(), "a.png".into(), "duplicate file".into())]);
        let many: String = (0..=MAX_BRIEFING_PICTURES).map(|k| table(&format!("{k}.png"), "one")).collect();
        assert_eq!(problems(&many), [("briefing_pictures".into(), "7".into(), "too many".into())]);
    }

    #[test]
    fn exact_problems_of_files_have_line_key_value_and_allowed() {
        let text = with_pictures(&(table("good.png", "one") + &table("bad.png", "two")));
        let check = |name: &str| if name == "good.png" { Ok(()) } else { Err("not found".to_owned()) };
        let problems = check_picture_files("job.toml", &text, "a file", &check);
        let line = 1 + text.lines().position(|line| line.contains("bad.png")).unwrap();
        let shown: Vec<String> = problems.iter().map(ToString::to_string).collect();
        assert_eq!(shown, [format!("job.toml:{line}: briefing_pictures[].file = bad.png: not found (allowed: a file)")]);
    }
}
