//! Pictures of the briefings of uploaded scenarios. Each scenario has a folder with its name for them beside its file, and refers
//! to them as `NAME/FILE`, which is also their path for programs that read the scenario from its file.

use super::safe_names::is_safe_file_name;
use super::scenario_library::{StoredScenario, read, upload_path};
use crate::errors::AppError;
use crate::io::files;
use crate::io::picture_file::{PictureFile, PictureFormat};
use crate::io::replace::replace;
use spandrel_model::scenario::edit::{Edit, apply};
use spandrel_model::scenario::{BriefingPicture, Scenario, is_picture_name};
use std::path::{Path, PathBuf};

/// Maximum length of a file name without its extension, characters (estimate: enough to recognize the file).
const MAX_STEM_CHARS: usize = 60;
/// Name of a file whose own name has no usable character.
const DEFAULT_STEM: &str = "picture";

/// Returns the path of a scenario's picture; `None` if the picture is not in the scenario's own folder.
pub fn picture_path(folder: &Path, scenario: &str, picture: &str) -> Option<PathBuf> {
    let (owner, file) = split(picture)?;
    (owner == scenario).then(|| folder.join(owner).join(file))
}

/// Splits `NAME/FILE`; `None` for any other name.
fn split(picture: &str) -> Option<(&str, &str)> {
    let parts = picture.split_once('/')?;
    (is_safe_file_name(parts.0) && is_safe_file_name(parts.1) && is_picture_name(parts.1)).then_some(parts)
}

/// Returns the addresses of the pictures of a scenario's briefing; `None` for a missing file.
pub fn addresses(folder: &Path, job: &StoredScenario) -> Vec<Option<String>> {
    let name = &job.named.name;
    let address = |picture: &BriefingPicture| {
        let path = picture_path(folder, name, &picture.file).filter(|path| job.named.uploaded && path.is_file())?;
        Some(format!("/scenarios/{name}/pictures/{}", path.file_name()?.to_str()?))
    };
    job.scenario.briefing_pictures.iter().map(address).collect()
}

/// Returns a safe name for a file that a browser sent, in a scenario's folder: `NAME/FILE`. No other file has it, and the scenario
/// does not refer to it, not even if that file is missing.
fn free_name(folder: &Path, scenario: &Scenario, sent: &str, format: PictureFormat) -> String {
    let stem = stem(sent);
    let numbered = (2..).map(|k: u32| format!("{stem}-{k}"));
    let name = |stem: String| format!("{}/{stem}.{}", scenario.name, format.extension());
    let is_listed = |name: &str| scenario.briefing_pictures.iter().any(|picture| picture.file == name);
    let mut names = std::iter::once(stem.clone()).chain(numbered).map(name);
    names.find(|name| !folder.join(name).exists() && !is_listed(name)).unwrap_or_default()
}

/// Returns the safe part of a file name without its folders and its extension.
fn stem(sent: &str) -> String {
    let file = sent.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    let safe = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' };
    let safe: String = stem.chars().take(MAX_STEM_CHARS).map(safe).collect();
    let safe = safe.trim_matches('-');
    if safe.is_empty() { DEFAULT_STEM.to_owned() } else { safe.to_owned() }
}

/// Saves a file in a scenario's folder under a free name. Returns the name by which the scenario refers to it.
///
/// # Errors
/// Returns an error if the folder or the file cannot be written.
pub fn save_picture(folder: &Path, scenario: &Scenario, (sent, picture): (&str, &PictureFile)) -> Result<String, AppError> {
    let own = folder.join(&scenario.name);
    std::fs::create_dir_all(&own)
        .map_err(|error| AppError::failed(format!("{}: cannot create the folder: {error}", own.display())))?;
    let file = free_name(folder, scenario, sent, picture.info.format);
    replace(&folder.join(&file), &picture.bytes)?;
    Ok(file)
}

/// Copies the pictures that a scenario has in common with another uploaded one, from which it was copied, into its own folder.
/// Returns the text that refers to the copies.
///
/// # Errors
/// Returns an error if a copy cannot be written.
pub fn adopt(folder: &Path, scenario: &Scenario, text: &str) -> Result<String, AppError> {
    let mut edits = Vec::new();
    for (k, picture) in scenario.briefing_pictures.iter().enumerate() {
        if let Some(found) = others_picture(folder, &scenario.name, &picture.file) {
            let text = save_picture(folder, scenario, (&picture.file, &found))?;
            edits.push(Edit::Set { location: format!("briefing_pictures[{k}].file"), text });
        }
    }
    apply(text, &edits).map_err(AppError::failed)
}

/// Returns a picture of another uploaded scenario; `None` if that scenario does not show it.
fn others_picture(folder: &Path, scenario: &str, picture: &str) -> Option<PictureFile> {
    let (owner, _) = split(picture).filter(|(owner, _)| *owner != scenario)?;
    let text = files::read(&upload_path(folder, owner)).ok()?;
    let other = read(folder, owner, &text).ok()?;
    let is_shown = other.briefing_pictures.iter().any(|shown| shown.file == picture);
    PictureFile::read(&picture_path(folder, owner, picture).filter(|_| is_shown)?).ok()
}

/// Removes the pictures in a scenario's folder that are not among these, and the folder if it is empty then. Leaves other files,
/// and those that cannot be removed, in place.
pub fn remove_unlisted(folder: &Path, scenario: &str, listed: &[BriefingPicture]) {
    let own = folder.join(scenario);
    let entries = std::fs::read_dir(&own).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().into_string().ok()).filter(|name| is_picture_name(name));
    for name in names.filter(|name| !listed.iter().any(|picture| picture.file == format!("{scenario}/{name}"))) {
        let path = own.join(name);
        if let Err(error) = std::fs::remove_file(&path) {
            tracing::warn!("{}: cannot remove: {error}", path.display());
        }
    }
    // Fails if the folder has other files or does not exist.
    std::fs::remove_dir(&own).ok();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::png::png;
    use spandrel_model::scenario::edit::{with_briefing_picture, with_name};
    use spandrel_model::shipped::PRACTICE;
    use spandrel_view::picture::Picture;

    fn picture() -> PictureFile {
        PictureFile::new(png(&Picture { width: 1, height: 1, rgba: vec![9; 4] }).unwrap()).unwrap()
    }

    fn scenario(text: &str) -> Scenario {
        read(Path::new(""), "job.toml", text).unwrap()
    }

    fn entry(file: &str) -> BriefingPicture {
        BriefingPicture { file: file.into(), caption: "The gate".into() }
    }

    /// Returns the scenario `job` with these pictures.
    fn job(pictures: &[&str]) -> Scenario {
        let add = |text: String, file: &&str| with_briefing_picture(&text, &entry(file)).unwrap();
        scenario(&pictures.iter().fold(with_name(PRACTICE, "job"), add))
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut names: Vec<String> = entries.map(|entry| entry.file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn exact_only_pictures_in_the_own_folder_have_a_path() {
        let folder = Path::new("scenarios");
        assert_eq!(picture_path(folder, "job", "job/a.png"), Some(folder.join("job").join("a.png")));
        for other in ["a.png", "other/a.png", "job/../a.png", "job/a/b.png", "job/.png", "/job/a.png", "job/rules.toml", "job/"] {
            assert_eq!(picture_path(folder, "job", other), None, "{other}");
        }
    }

    #[test]
    fn exact_names_of_browsers_become_safe_and_free() {
        let folder = tempfile::tempdir().unwrap();
        for (sent, expected) in [
            ("gate.png", "gate.png"),
            ("../../etc/passwd", "passwd.png"),
            ("C:\\Users\\ida\\Lageplan Süd.PNG", "Lageplan-S-d.png"),
            (".htaccess", "picture.png"),
            ("", "picture.png"),
            ("a.php\0.png", "a-php.png"),
            ("photo.jpeg", "photo.png"),
        ] {
            let name = free_name(folder.path(), &job(&[]), sent, PictureFormat::Png);
            assert_eq!(name, format!("job/{expected}"), "{sent}");
            assert!(picture_path(folder.path(), "job", &name).is_some(), "{name}");
        }
        let long = free_name(folder.path(), &job(&[]), &"x".repeat(500), PictureFormat::Jpeg);
        assert_eq!(long, format!("job/{}.jpg", "x".repeat(MAX_STEM_CHARS)));
        let missing = job(&["job/gate-2.png"]);
        for expected in ["job/gate.png", "job/gate-3.png", "job/gate-4.png"] {
            assert_eq!(save_picture(folder.path(), &missing, ("gate.png", &picture())).as_deref(), Ok(expected));
        }
    }

    #[test]
    fn exact_unlisted_pictures_are_removed_and_other_files_remain() {
        let folder = tempfile::tempdir().unwrap();
        for _ in 0..3 {
            save_picture(folder.path(), &job(&[]), ("gate.png", &picture())).unwrap();
        }
        let rules = folder.path().join("job/rules.toml");
        std::fs::write(&rules, "a = 1").unwrap();
        remove_unlisted(folder.path(), "job", &[entry("job/gate-2.png"), entry("other/gate.png")]);
        assert_eq!(names(&folder.path().join("job")), ["gate-2.png", "rules.toml"]);
        remove_unlisted(folder.path(), "job", &[]);
        assert_eq!(names(&folder.path().join("job")), ["rules.toml"]);
        std::fs::remove_file(rules).unwrap();
        remove_unlisted(folder.path(), "job", &[]);
        assert_eq!(names(folder.path()), Vec::<String>::new());
    }

    #[test]
    fn exact_a_copy_gets_pictures_of_its_own_but_only_those_that_the_other_scenario_shows() {
        let folder = tempfile::tempdir().unwrap();
        let shown = save_picture(folder.path(), &job(&[]), ("gate.png", &picture())).unwrap();
        let hidden = save_picture(folder.path(), &job(&[]), ("hidden.png", &picture())).unwrap();
        let text = with_briefing_picture(&with_name(PRACTICE, "job"), &entry(&shown)).unwrap();
        std::fs::write(upload_path(folder.path(), "job"), &text).unwrap();
        let adopted = adopt(folder.path(), &scenario(&text), &text).unwrap();
        assert_eq!(adopted, text, "its own pictures stay");
        let copy = with_name(&text, "copy");
        let copy = [hidden.as_str(), "none/a.png", "a.png"]
            .iter()
            .fold(copy, |text, file| with_briefing_picture(&text, &entry(file)).unwrap());
        let adopted = adopt(folder.path(), &scenario(&copy), &copy).unwrap();
        assert_eq!(adopted, copy.replace("job/gate.png", "copy/gate.png"));
        assert_eq!(names(&folder.path().join("copy")), ["gate.png"]);
        assert_eq!(names(&folder.path().join("job")), ["gate.png", "hidden.png"]);
    }
}
