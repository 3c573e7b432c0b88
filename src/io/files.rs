//! Loads scenario and vehicle files from a path, from a session folder, or from the program itself.

use super::picture_file::{ALLOWED_PICTURES, PictureFile, PictureInfo};
use crate::errors::AppError;
use spandrel_clients::pilot::{Skill, skill_file};
use spandrel_model::scenario::bridges::model::MAX_MODEL_BYTES;
use spandrel_model::scenario::{self, Scenario};
use spandrel_model::shipped;
use spandrel_model::site::Site;
use spandrel_model::toml::{Problem, Problems};
use spandrel_model::vehicle::{self, Vehicle};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// A scenario with its source text.
#[derive(Debug, Clone)]
pub struct ScenarioFile {
    /// Scenario source text (TOML).
    pub text: String,
    /// Files that the scenario refers to (height fields, almanacs, models of bridges), by their names in the scenario.
    pub referenced_files: BTreeMap<String, Vec<u8>>,
    /// Scenario parsed from the text.
    pub scenario: Scenario,
    /// File name to use in messages.
    file: String,
    folder: SourceFolder,
}

impl ScenarioFile {
    /// Returns the form or difficulty level of this scenario with this CRC; `None` if it has none.
    #[must_use]
    pub fn variant_with_crc(&self, crc: u32) -> Option<Self> {
        let referenced = |name: &str| self.referenced_files.get(name).cloned().ok_or_else(|| format!("{name}: not loaded"));
        let text = scenario::variant_with_crc(&self.text, &referenced, crc)?;
        let scenario = scenario::read(&self.scenario.name, &text, &referenced).ok()?;
        Some(Self { text, scenario, ..self.clone() })
    }

    /// Loads the pictures of the briefing, in their order. Nothing but the briefing needs them.
    ///
    /// # Errors
    /// Returns an error if a picture cannot be used; all problems are listed.
    pub fn load_pictures(&self) -> Result<Vec<PictureFile>, AppError> {
        let (pictures, problems) = load_pictures(&self.file, &self.text, &self.folder);
        if problems.is_empty() { Ok(pictures) } else { Err(Problems(problems).into()) }
    }

    /// Finds one picture of the briefing. Returns its absolute path, and its type and size from the head of the file.
    ///
    /// # Errors
    /// Returns a message if it cannot be used.
    pub fn find_picture(&self, name: &str) -> Result<(PathBuf, PictureInfo), String> {
        let path = std::path::absolute(self.folder.path_of(name)?).map_err(|error| error.to_string())?;
        let info = PictureFile::read_info(&path).map_err(|error| error.to_string())?;
        Ok((path, info))
    }
}

/// A vehicle with its source text.
#[derive(Debug, Clone)]
pub struct VehicleFile {
    /// Vehicle source text (TOML).
    pub text: String,
    /// Vehicle parsed from the text.
    pub vehicle: Vehicle,
}

/// A file's text and location.
pub struct SourceFile {
    /// File name to use in messages.
    pub file: String,
    /// File contents.
    pub text: String,
    folder: SourceFolder,
}

/// Folder that contains a scenario or vehicle file; `None` for a shipped file.
#[derive(Debug, Clone)]
struct SourceFolder(Option<PathBuf>);

impl SourceFolder {
    /// Returns the path of a file in the folder or below; an error for any other file.
    fn path_of(&self, name: &str) -> Result<PathBuf, String> {
        let Some(folder) = &self.0 else { return Err("a shipped scenario cannot refer to other files".into()) };
        if !Path::new(name).components().all(|part| matches!(part, Component::Normal(_))) {
            return Err("only files in the same folder or below are allowed".into());
        }
        Ok(folder.join(name))
    }

    fn read_picture(&self, name: &str) -> Result<PictureFile, String> {
        PictureFile::read(&self.path_of(name)?).map_err(|error| error.to_string())
    }
}

/// Loads the pictures of a scenario's briefing. Returns the problems of those that cannot be used.
fn load_pictures(file: &str, text: &str, folder: &SourceFolder) -> (Vec<PictureFile>, Vec<Problem>) {
    let pictures = RefCell::new(Vec::new());
    let load = |name: &str| -> Result<(), String> {
        let picture = folder.read_picture(name)?;
        pictures.borrow_mut().push(picture);
        Ok(())
    };
    let problems = scenario::check_picture_files(file, text, ALLOWED_PICTURES, &load);
    (pictures.into_inner(), problems)
}

/// Returns the names of the shipped scenarios.
pub fn scenario_names() -> Vec<&'static str> {
    shipped::SCENARIOS.iter().map(|(name, _)| *name).collect()
}

/// Returns the names of the shipped vehicles.
pub fn vehicle_names() -> Vec<&'static str> {
    shipped::VEHICLES.iter().map(|(name, _)| *name).collect()
}

/// Loads and validates a scenario.
///
/// # Errors
/// Returns an error if it cannot be read or is invalid; all problems are listed.
pub fn scenario(argument: &str) -> Result<ScenarioFile, AppError> {
    scenario_from(find_source(argument, "scenario", shipped::SCENARIOS)?)
}

/// Loads and validates a vehicle.
///
/// # Errors
/// Returns an error if it cannot be read or is invalid; all problems are listed.
pub fn vehicle(argument: &str) -> Result<VehicleFile, AppError> {
    let source = find_source(argument, "vehicle", shipped::VEHICLES)?;
    let vehicle = vehicle::read(&source.file, &source.text)?;
    Ok(VehicleFile { text: source.text, vehicle })
}

/// Loads and validates a pilot file for the synthetic trainee.
///
/// # Errors
/// Returns an error if it cannot be read or is invalid; all problems are listed.
pub fn pilot(argument: &str) -> Result<Skill, AppError> {
    Ok(skill_file::read(argument, &read(Path::new(argument))?)?)
}

/// Loads a vehicle whose ID differs from its file name (a session's `vehicle.toml`).
///
/// # Errors
/// See [`vehicle`].
pub fn vehicle_with_id(path: &Path, id: &str) -> Result<VehicleFile, AppError> {
    let text = read(path)?;
    let mut vehicle = vehicle::read(&path.display().to_string(), &text)?;
    vehicle.id = id.to_owned();
    Ok(VehicleFile { text, vehicle })
}

/// Validates a scenario's text; reads the files that the scenario refers to from its folder.
///
/// # Errors
/// Returns an error if it is invalid; all problems are listed.
pub fn scenario_from(source: SourceFile) -> Result<ScenarioFile, AppError> {
    let seen = RefCell::new(BTreeMap::new());
    let read_referenced_file = |name: &str| {
        let bytes = source.read_referenced_file(name)?;
        seen.borrow_mut().insert(name.to_owned(), bytes.clone());
        Ok(bytes)
    };
    let scenario = scenario::read(&source.file, &source.text, &read_referenced_file)?;
    let SourceFile { file, text, folder } = source;
    Ok(ScenarioFile { text, referenced_files: seen.into_inner(), scenario, file, folder })
}

/// Separates a scenario from one of its forms or difficulty levels in an argument, as in `pilot-study@B` or `drill-gap@6`.
pub const FORM_SEPARATOR: char = '@';

/// Returns the argument for a form or a difficulty level of a scenario. A scenario has at most one of the two.
pub fn with_variant(scenario: &str, form: Option<&str>, level: Option<u8>) -> String {
    let variant = form.map(str::to_owned).or_else(|| level.map(|level| level.to_string()));
    variant.map_or_else(|| scenario.to_owned(), |variant| format!("{scenario}{FORM_SEPARATOR}{variant}"))
}

/// Finds the file for an argument: a path, or a name in `library`, and the form or the difficulty level after an `@`.
///
/// # Errors
/// Returns an error if there is no such file, name, form or level.
pub fn find_source(argument: &str, what: &str, library: &[(&'static str, &'static str)]) -> Result<SourceFile, AppError> {
    match argument.rsplit_once(FORM_SEPARATOR) {
        Some((scenario, variant)) if !variant.contains(['/', '\\', '.']) && !Path::new(argument).is_file() => {
            let mut source = find_file(scenario, what, library)?;
            source.text = select_variant(&source, variant)?;
            Ok(source)
        }
        _ => find_file(argument, what, library),
    }
}

/// Selects a form or a difficulty level of a scenario.
fn select_variant(source: &SourceFile, variant: &str) -> Result<String, AppError> {
    scenario::select_variant(&source.text, variant).ok_or_else(|| unknown_variant(source, variant))
}

/// Returns the error for a form or a difficulty level that a scenario does not have.
fn unknown_variant(source: &SourceFile, variant: &str) -> AppError {
    let file = &source.file;
    let forms = scenario::form_names(&source.text);
    let shipped_with = |has: fn(&str) -> bool| {
        let names: Vec<&str> = shipped::SCENARIOS.iter().filter(|(_, text)| has(text)).map(|(name, _)| *name).collect();
        names.join(", ")
    };
    AppError::invalid(if !forms.is_empty() {
        format!("{file} has no form '{variant}' (allowed: {})", forms.join(", "))
    } else if let Some(levels) = scenario::level_count(&source.text) {
        format!("{file} has no difficulty level '{variant}' (allowed: 1 to {levels})")
    } else if variant.parse::<u8>().is_ok() {
        let others = shipped_with(|text| scenario::level_count(text).is_some());
        format!(
            "{file} has no difficulty levels, so --level {variant} does not apply to it (shipped scenarios with levels: {others})"
        )
    } else {
        let others = shipped_with(|text| !scenario::form_names(text).is_empty());
        format!("{file} has no forms, so --form {variant} does not apply to it (shipped scenarios with forms: {others})")
    })
}

fn find_file(argument: &str, what: &str, library: &[(&'static str, &'static str)]) -> Result<SourceFile, AppError> {
    let path = Path::new(argument);
    let looks_like_a_path = argument.contains(['/', '\\']) || path.extension().is_some_and(|end| end == "toml");
    if looks_like_a_path || path.is_file() {
        let folder = SourceFolder(path.parent().map(Path::to_path_buf));
        return Ok(SourceFile { file: argument.to_owned(), text: read(path)?, folder });
    }
    let names: Vec<&str> = library.iter().map(|(name, _)| *name).collect();
    let (name, text) = library.iter().find(|(name, _)| *name == argument).ok_or_else(|| {
        AppError::invalid(format!("there is no {what} '{argument}': specify a file or one of {}", names.join(", ")))
    })?;
    Ok(SourceFile { file: format!("{name}.toml"), text: (*text).to_owned(), folder: SourceFolder(None) })
}

/// Finds a file for `check`: a path, or the name of a shipped scenario or vehicle.
///
/// # Errors
/// Returns an error if there is no such file or name.
pub fn any_source(argument: &str) -> Result<SourceFile, AppError> {
    let library: Vec<_> = shipped::SCENARIOS.iter().chain(shipped::VEHICLES).copied().collect();
    find_source(argument, "scenario or vehicle", &library)
}

/// Reads a text file (UTF-8).
///
/// # Errors
/// Returns an error if it cannot be read.
pub fn read(path: &Path) -> Result<String, AppError> {
    let bytes = std::fs::read(path).map_err(|error| AppError::invalid(format!("{}: cannot read: {error}", path.display())))?;
    String::from_utf8(bytes).map_err(|error| {
        AppError::invalid(format!("{}: not UTF-8 text (byte {})", path.display(), error.utf8_error().valid_up_to()))
    })
}

/// Writes a result to a file, or to standard output for `-`. Replaces the file atomically: if the disk is full or the
/// process is killed, the old file remains.
///
/// # Errors
/// Returns an error if it cannot be written.
pub fn write(target: &str, bytes: &[u8]) -> Result<(), AppError> {
    use std::io::Write;
    let path = Path::new(target);
    // Symbolic links are resolved first. Pipes and devices cannot be replaced.
    let real = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let done = match target {
        "-" => std::io::stdout().lock().write_all(bytes),
        _ if real.exists() && !real.is_file() => std::fs::write(&real, bytes),
        _ => return super::replace::replace(&real, bytes),
    };
    done.map_err(|error| AppError::failed(format!("{target}: cannot write: {error}")))
}

impl SourceFile {
    /// Reads a file that another file refers to. Only files in the same folder or below are allowed.
    pub fn read_referenced_file(&self, name: &str) -> Result<Vec<u8>, String> {
        read_limited(&self.folder.path_of(name)?, MAX_MODEL_BYTES)
    }

    /// Returns the problems of the pictures of the briefing. The scenario must be valid.
    pub fn picture_problems(&self) -> Vec<Problem> {
        load_pictures(&self.file, &self.text, &self.folder).1
    }
}

/// Reads a file in a folder or below, as scenarios in the folder may.
///
/// # Errors
/// Returns a message if the file is elsewhere or cannot be read.
pub fn read_from_folder(folder: &Path, name: &str) -> Result<Vec<u8>, String> {
    read_limited(&path_in_folder(folder, name)?, MAX_MODEL_BYTES)
}

/// Returns the path of a file in a folder or below.
///
/// # Errors
/// Returns a message if the file is elsewhere.
pub fn path_in_folder(folder: &Path, name: &str) -> Result<PathBuf, String> {
    SourceFolder(Some(folder.to_path_buf())).path_of(name)
}

/// Reads a file of at most this size, bytes.
///
/// # Errors
/// Returns a message if the file is larger or cannot be read.
pub fn read_limited(path: &Path, max_bytes: usize) -> Result<Vec<u8>, String> {
    let length = std::fs::metadata(path).map_err(|error| error.to_string())?.len();
    if length > max_bytes as u64 {
        return Err(format!("{length} bytes, but at most {max_bytes} are allowed"));
    }
    std::fs::read(path).map_err(|error| error.to_string())
}

/// Returns the site as a binary glTF file.
pub fn site_model(site: &Site) -> Result<Vec<u8>, AppError> {
    spandrel_model::site::gltf::glb(site).map_err(|error| AppError::failed(format!("cannot write the site as glTF: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario::BriefingPicture;
    use spandrel_model::scenario::edit::with_briefing_picture;
    use spandrel_view::picture::Picture;

    #[test]
    fn exact_every_shipped_file_is_valid() {
        for name in scenario_names() {
            assert_eq!(scenario(name).map(|file| file.scenario.name), Ok(name.to_owned()));
        }
        for name in vehicle_names() {
            assert_eq!(vehicle(name).map(|file| file.vehicle.id), Ok(name.to_owned()));
        }
    }

    #[test]
    fn exact_form_is_selected_by_name_and_by_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("copy@work.toml");
        std::fs::write(&path, shipped::PILOT_STUDY).unwrap();
        let path = path.display().to_string();
        let load = |argument: &str, form| scenario(&with_variant(argument, form, None)).unwrap().scenario;
        for argument in ["pilot-study", &path] {
            let selected = |form| load(argument, form).form.unwrap().name;
            assert_eq!((selected(None), selected(Some("B"))), ("A".to_owned(), "B".to_owned()));
            assert_eq!(load(argument, None).crc, load(argument, Some("A")).crc, "the first form is the default");
            assert_ne!(load(argument, Some("A")).crc, load(argument, Some("B")).crc);
        }
    }

    #[test]
    fn exact_unknown_form_is_reported_with_the_existing_ones() {
        let message = |argument: &str| scenario(argument).map(|_| ()).unwrap_err().to_string();
        assert_eq!(message("pilot-study@X"), "pilot-study.toml has no form 'X' (allowed: A, B, C, H)");
        let none = "two-bridges.toml has no forms, so --form A does not apply to it (shipped scenarios with forms: certification, pilot-study)";
        assert_eq!(message("two-bridges@A"), none);
    }

    #[test]
    fn exact_level_is_selected_and_unknown_ones_are_reported() {
        let message = |argument: &str| scenario(argument).map(|_| ()).unwrap_err().to_string();
        let selected = |level| scenario(&with_variant("drill-hover", None, level)).unwrap().scenario.difficulty.unwrap().level;
        assert_eq!((selected(None), selected(Some(7))), (5, 7));
        assert_eq!(message("drill-hover@10"), "drill-hover.toml has no difficulty level '10' (allowed: 1 to 9)");
        assert_eq!(message("drill-hover@A"), "drill-hover.toml has no difficulty level 'A' (allowed: 1 to 9)");
        let none = message("two-bridges@3");
        assert!(none.starts_with("two-bridges.toml has no difficulty levels, so --level 3 does not apply to it"), "{none}");
        assert!(message("pilot-study@3").contains("has no form '3'"));
    }

    #[test]
    fn exact_unknown_name_is_reported() {
        let Err(error) = vehicle("no-such-drone") else { panic!("found it") };
        assert!(matches!(&error, AppError::Wrong(message) if message.contains("no-such-drone")), "{error}");
    }

    #[test]
    fn exact_referenced_files_outside_the_scenario_folder_are_rejected() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("heights.csv"), "1,2").unwrap();
        let source_folder = SourceFolder(Some(folder.path().into()));
        let source = SourceFile { file: "s.toml".into(), text: String::new(), folder: source_folder };
        assert_eq!(source.read_referenced_file("heights.csv"), Ok(b"1,2".to_vec()));
        for bad in ["../heights.csv", "/etc/hostname"] {
            assert!(source.read_referenced_file(bad).is_err(), "{bad}");
        }
    }

    /// Saves a scenario with one picture of its briefing.
    fn with_picture(folder: &Path, name: &str) -> String {
        let picture = BriefingPicture { file: name.into(), caption: "The gate".into() };
        let path = folder.join("job.toml");
        std::fs::write(&path, with_briefing_picture(shipped::PRACTICE, &picture).unwrap()).unwrap();
        path.display().to_string()
    }

    #[test]
    fn exact_pictures_are_loaded_from_the_folder_of_the_scenario() {
        let folder = tempfile::tempdir().unwrap();
        let job = with_picture(folder.path(), "site/gate.png");
        let bytes = crate::io::png::png(&Picture { width: 2, height: 1, rgba: vec![9; 8] }).unwrap();
        std::fs::create_dir(folder.path().join("site")).unwrap();
        std::fs::write(folder.path().join("site/gate.png"), &bytes).unwrap();
        let scenario = scenario(&job).unwrap();
        assert_eq!(scenario.load_pictures().unwrap().into_iter().map(|picture| picture.bytes).collect::<Vec<_>>(), [bytes]);
        let (path, info) = scenario.find_picture("site/gate.png").unwrap();
        assert!(path.is_absolute() && path.is_file() && info.size_px() == (2, 1), "{}", path.display());
        assert_eq!(any_source(&job).unwrap().picture_problems(), []);
    }

    #[test]
    fn exact_a_scenario_is_valid_without_its_pictures_and_each_problem_has_its_line() {
        let folder = tempfile::tempdir().unwrap();
        let job = with_picture(folder.path(), "gate.png");
        let line = 2 + shipped::PRACTICE.lines().count() + 1;
        let scenario = scenario(&job).unwrap();
        let expected = |message: &str| {
            let allowed = "a PNG or JPEG file of at most 4 MiB and 8192 x 8192 px";
            format!("{job}:{line}: briefing_pictures[].file = gate.png: {message} (allowed: {allowed})")
        };
        let missing = scenario.load_pictures().unwrap_err().to_string();
        assert_eq!(missing, expected("cannot read: No such file or directory (os error 2)"));
        std::fs::write(folder.path().join("gate.png"), "GIF89a").unwrap();
        assert_eq!(scenario.load_pictures().unwrap_err().to_string(), expected("neither a PNG nor a JPEG file"));
        let shipped = SourceFile { folder: SourceFolder(None), ..any_source(&job).unwrap() };
        assert_eq!(shipped.picture_problems()[0].message, "a shipped scenario cannot refer to other files");
    }
}
