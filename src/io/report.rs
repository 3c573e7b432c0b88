//! Builds a session's report from the contents of its folder.

use super::clock;
use super::marks::valid_marks;
use super::replace::replace;
use super::session_folder::StoredSession;
use super::standing::{ReliabilityLookup, standing_when_flown};
use crate::errors::AppError;
use spandrel_monitor::AssessError;
use spandrel_monitor::export::json_text;
use spandrel_monitor::folder::{ADVICE, REPORT, SMALL_SNAPSHOTS, SNAPSHOTS, VIDEO, sha256_hex};
use spandrel_text::Language;
use spandrel_training::advice::SessionAdvice;
use spandrel_training::cohort::MeasureReliability;
use spandrel_training::record::SessionLevel;
use spandrel_training::report::{Jpeg, Review, SessionMetadata, page, scorm};
use std::path::{Path, PathBuf};

/// Maximum size of a photograph on the page, bytes; larger photographs are replaced by sketches.
const MAX_PICTURE_BYTES: u64 = 400_000;
/// Maximum total size of the photographs on a page, bytes; keeps the page under 10 MB.
const MAX_PICTURES_BYTES: u64 = 4_000_000;

/// Writes the report and the advice into a session folder, then removes the report's translations, which are outdated, and
/// returns the advice.
///
/// # Errors
/// Returns an error if files are invalid, the session has no data to report, or a file cannot be written.
pub fn write(session: &Path, language: Language, reliability: ReliabilityLookup<'_>) -> Result<SessionAdvice, AppError> {
    let review = review(session, language, reliability)?;
    // The report comes last: a session with a report is complete.
    replace(&session.join(ADVICE), json_text(&review.advice).as_bytes())?;
    replace(&session.join(REPORT), page::session(&review).as_bytes())?;
    remove_translations(session);
    Ok(review.advice)
}

/// Removes the report's translations.
fn remove_translations(session: &Path) {
    for language in Language::ALL.into_iter().chain([Language::Pseudo]) {
        // Most sessions have no translations.
        std::fs::remove_file(translation_path(session, language)).ok();
    }
}

/// Writes the report in another language beside the session's report, and returns the page. The file may be removed at any time.
///
/// # Errors
/// Returns an error if files are invalid, the session has no data to report, or the file cannot be written.
pub fn write_translation(session: &Path, language: Language, reliability: ReliabilityLookup<'_>) -> Result<Vec<u8>, AppError> {
    let page = page::session(&review(session, language, reliability)?).into_bytes();
    replace(&translation_path(session, language), &page)?;
    Ok(page)
}

/// Returns the path of a session's report in another language than `report.html`.
pub fn translation_path(session: &Path, language: Language) -> PathBuf {
    session.join(REPORT).with_extension(format!("{}.html", language.tag()))
}

/// Returns the advice that was written with a session's report; `None` if there is none, or if another version wrote it.
pub fn saved_advice(session: &Path) -> Option<SessionAdvice> {
    serde_json::from_slice(&std::fs::read(session.join(ADVICE)).ok()?).ok()
}

/// Returns the names and contents of the files in a session's SCORM package.
///
/// # Errors
/// Returns an error if files are invalid, the session has no data to report, or the page cannot be written.
pub fn package(
    session: &Path,
    language: Language,
    reliability: ReliabilityLookup<'_>,
) -> Result<Vec<(&'static str, String)>, AppError> {
    let mut review = review(session, language, reliability)?;
    // The package contains no video.
    review.metadata.video = None;
    Ok(scorm::files(&review, &page::session(&review)))
}

/// Returns the page that compares two sessions. `reliability` returns the reliability of the measures on the job with the
/// given scenario name and level; empty if unknown.
///
/// # Errors
/// Returns an error if files are invalid, the session has no data to report, or the page cannot be written.
pub fn comparison_page(
    first: &Path,
    second: &Path,
    language: Language,
    reliability: impl FnOnce(&str) -> Result<Vec<MeasureReliability>, AppError>,
) -> Result<String, AppError> {
    // This page does not show how the sessions stood among earlier ones.
    let (first, second) = (review(first, language, &|_| Vec::new())?, review(second, language, &|_| Vec::new())?);
    let level = first.scenario.difficulty.as_ref().map(SessionLevel::of);
    let reliability = reliability(&SessionLevel::named(&first.scenario.name, level))?;
    Ok(page::comparison(&first, &second, &reliability))
}

/// Returns a session's pictures with their assessments.
///
/// # Errors
/// Returns an error if files are invalid, the session has no data to report, or the page cannot be written.
#[cfg(feature = "view")]
pub fn pictures(session: &Path) -> Result<Vec<spandrel_training::report::pictures::ReviewedPicture>, AppError> {
    // No photographs are included, because the caller is about to render them. The pictures have no texts.
    Ok(review_with_pictures(session, Language::default(), Vec::new(), &|_| Vec::new())?.pictures)
}

/// Returns the maximum size of each photograph in bytes for a page with `count` photographs.
#[cfg(feature = "view")]
pub fn max_picture_bytes(count: usize) -> usize {
    let share = MAX_PICTURES_BYTES / (count.max(1) as u64);
    share.min(MAX_PICTURE_BYTES) as usize
}

/// Returns a file's URL for a browser.
pub fn address(path: &Path) -> String {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let mut address = String::from("file://");
    for byte in whole.to_string_lossy().bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte) {
            address.push(char::from(byte));
        } else {
            address.push_str(&format!("%{byte:02X}"));
        }
    }
    address
}

/// Returns everything to show on a session's page. The change since the last session is labeled if the reliability on the job is known.
///
/// # Errors
/// Returns an error if files are invalid, or the session has no data to report.
pub fn review(session: &Path, language: Language, reliability: ReliabilityLookup<'_>) -> Result<Review, AppError> {
    review_with_pictures(session, language, photographs(&session.join(SNAPSHOTS)), reliability)
}

fn review_with_pictures(
    session: &Path,
    language: Language,
    pictures: Vec<(u32, Jpeg)>,
    reliability: ReliabilityLookup<'_>,
) -> Result<Review, AppError> {
    let stored = StoredSession::read(session)?;
    let about = SessionMetadata { language, pictures, ..session_facts(session, &stored, reliability)? };
    let review = Review::of(&stored.log, &stored.scenario.scenario, &stored.vehicle.vehicle, about);
    review.map_err(|error| review_error(&error))
}

fn review_error(error: &AssessError) -> AppError {
    match error {
        AssessError::OtherScenario { .. } | AssessError::OtherSeed { .. } => AppError::invalid(error.to_string()),
        AssessError::NeverFlown
        | AssessError::NotTelemetry
        | AssessError::NoTruth
        | AssessError::NoSeed
        | AssessError::Unreadable(_) => AppError::failed(error.to_string()),
    }
}

fn session_facts(
    session: &Path,
    stored: &StoredSession,
    reliability: ReliabilityLookup<'_>,
) -> Result<SessionMetadata, AppError> {
    let name =
        std::path::absolute(session).ok().and_then(|path| path.file_name().map(|name| name.to_string_lossy().into_owned()));
    Ok(SessionMetadata {
        language: Language::default(),
        trainee: stored.trainee.clone(),
        started_unix_us: stored.started_unix_us,
        purpose: stored.purpose.clone(),
        started_utc: clock::utc(stored.started_unix_us).0,
        folder: name.unwrap_or_default(),
        scenario_sha256: sha256_hex(stored.scenario.text.as_bytes()),
        vehicle_sha256: sha256_hex(stored.vehicle.text.as_bytes()),
        telemetry_sha256: stored.log.sha256()?,
        pictures: Vec::new(),
        marks: valid_marks(session),
        video: Some(VIDEO).filter(|video| session.join(video).is_file()),
        standing: standing_when_flown(session, reliability),
    })
}

/// Returns the photographs that fit on the page, keyed by the number at the end of their file names. Uses the small
/// copy of a photograph if one exists.
fn photographs(folder: &Path) -> Vec<(u32, Jpeg)> {
    let files = numbered_photographs(folder);
    let (mut left, mut found) = (MAX_PICTURES_BYTES, Vec::new());
    for (number, path) in &files {
        let size = path.metadata().map_or(u64::MAX, |about| about.len());
        if size <= MAX_PICTURE_BYTES.min(left)
            && let Ok(bytes) = std::fs::read(path)
        {
            left -= size;
            found.push((*number, Jpeg { bytes }));
        }
    }
    let sketched = files.len() - found.len();
    if sketched > 0 {
        tracing::warn!(
            "{}: {sketched} of {} photographs are shown as sketches in the report, because the limit is {} kB each and {} kB in total: `spandrel render \
             SESSION --snapshots` creates copies that fit",
            folder.display(),
            files.len(),
            MAX_PICTURE_BYTES / 1000,
            MAX_PICTURES_BYTES / 1000
        );
    }
    found
}

/// Returns the numbers of a session's photographs.
pub fn photograph_numbers(folder: &Path) -> Vec<u32> {
    numbered_photographs(folder).into_iter().map(|(number, _)| number).collect()
}

/// Returns the path of a photograph or its small copy.
pub fn photograph_path(folder: &Path, number: u32) -> Option<PathBuf> {
    numbered_photographs(folder).into_iter().find(|(one, _)| *one == number).map(|(_, path)| path)
}

/// Returns the photographs or their copies, keyed by the number at the end of their names.
fn numbered_photographs(folder: &Path) -> Vec<(u32, PathBuf)> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut names: Vec<_> = entries.flatten().map(|entry| entry.file_name()).collect();
    names.sort();
    let small = |name| Some(folder.join(SMALL_SNAPSHOTS).join(name)).filter(|copy| copy.is_file());
    let file = |name| small(name).unwrap_or_else(|| folder.join(name));
    names.iter().filter_map(|name| Some((photograph_number(Path::new(name))?, file(name)))).collect()
}

/// Returns the number at the end of a JPEG file's name.
fn photograph_number(path: &Path) -> Option<u32> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    let stem = path.file_stem()?.to_str()?;
    let digits = stem.len() - stem.bytes().rev().take_while(u8::is_ascii_digit).count();
    if matches!(ending.as_str(), "jpg" | "jpeg") { stem[digits..].parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_photographs_are_numbered_by_their_file_names() {
        for (name, number) in
            [("0007.jpg", Some(7)), ("snap-12.JPEG", Some(12)), ("snap.jpg", None), ("7.png", None), ("7", None)]
        {
            assert_eq!(photograph_number(Path::new(name)), number, "{name}");
        }
    }

    #[test]
    fn exact_page_uses_small_copies_and_skips_large_photographs() {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str, bytes: u64| std::fs::write(folder.path().join(name), vec![0; bytes as usize]).unwrap();
        std::fs::create_dir(folder.path().join(SMALL_SNAPSHOTS)).unwrap();
        put("0001.jpg", 3 * MAX_PICTURE_BYTES);
        put("small/0001.jpg", 70);
        put("0002.jpg", MAX_PICTURE_BYTES + 1);
        (3..14).for_each(|k| put(&format!("{k:04}.jpg"), MAX_PICTURE_BYTES));
        let found: Vec<(u32, u64)> = photographs(folder.path()).iter().map(|(k, file)| (*k, file.bytes.len() as u64)).collect();
        let whole = (3..=11).map(|k| (k, MAX_PICTURE_BYTES));
        assert_eq!(
            found,
            [(1, 70)].into_iter().chain(whole).collect::<Vec<_>>(),
            "ten times the limit of one, less the small copy"
        );
    }

    #[test]
    #[cfg(feature = "view")]
    fn exact_photographs_share_the_size_limit() {
        assert_eq!([0, 1, 10, 100].map(max_picture_bytes), [400_000, 400_000, 400_000, 40_000]);
    }

    #[test]
    fn exact_translations_lie_beside_the_report() {
        assert_eq!(translation_path(Path::new("a.b"), Language::German), Path::new("a.b/report.de.html"));
    }

    #[test]
    fn exact_all_translations_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let paths = [Language::German, Language::Pseudo].map(|language| translation_path(folder.path(), language));
        paths.iter().for_each(|path| std::fs::write(path, "").unwrap());
        remove_translations(folder.path());
        assert!(paths.iter().all(|path| !path.exists()), "{paths:?}");
    }

    #[test]
    fn exact_address_is_percent_encoded() {
        assert_eq!(address(Path::new("/a b/ü.html")), "file:///a%20b/%C3%BC.html");
    }
}
