//! `spandrel report`: the page of a session, from what its folder holds.

use super::clock;
use super::errors::{AppError, EXIT_CODES};
use super::files;
use super::progress::Progress;
use super::session_folder::{Stored, replace};
use crate::monitor::AssessError;
use crate::monitor::folder::{REPORT, SNAPSHOTS, sha256_hex};
use crate::report::{About, Jpeg, Review, page, scorm};
use std::path::{Path, PathBuf};

/// A photograph larger than this is left beside the page, bytes.
const PICTURE_MOST: u64 = 400_000;
/// All photographs in a page together, bytes: with the rest it stays below 10 MB.
const PICTURES_MOST: u64 = 4_000_000;

/// Write the report of a session
///
/// One page that opens in any browser, offline, and prints: scores, tasks, the flight on the site, pictures and what was missed, feedback and
/// reactions, surface coverage. Made from the telemetry and the two files of the session folder; live sessions end by writing it too. With two
/// sessions it compares them.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel report sessions/20260801T...                      writes report.html into the session folder
  spandrel report sessions/20260801T... --out anna.html      writes it elsewhere, '-' for standard output
  spandrel report sessions/first sessions/second --out c.html    compares two sessions

{EXIT_CODES}"))]
pub struct Args {
    /// Session folder
    #[arg(value_name = "SESSION")]
    session: PathBuf,
    /// A second session folder, to compare with the first
    #[arg(value_name = "SESSION", requires = "out")]
    other: Option<PathBuf>,
    /// Write the page here, '-' for standard output [default: report.html in the session folder]
    #[arg(long, value_name = "FILE")]
    out: Option<String>,
}

/// Runs the subcommand.
///
/// # Errors
/// When files are wrong, there is nothing to report, or the page cannot be written.
pub fn run(args: &Args) -> Result<(), AppError> {
    let progress = Progress::start("writing the report");
    let text = match &args.other {
        Some(other) => compared(&args.session, other)?,
        None => page::session(&review(&args.session)?),
    };
    progress.end();
    match &args.out {
        Some(target) => files::write(target, text.as_bytes()),
        None => {
            let path = args.session.join(REPORT);
            replace(&path, text.as_bytes())?;
            println!("report        {}", address(&path));
            Ok(())
        }
    }
}

/// Writes the report into a session folder.
///
/// # Errors
/// As [`run`].
pub fn write(session: &Path) -> Result<(), AppError> {
    replace(&session.join(REPORT), page::session(&review(session)?).as_bytes())
}

/// Names and contents of a session's SCORM package.
///
/// # Errors
/// As [`run`].
pub fn package(session: &Path) -> Result<Vec<(&'static str, String)>, AppError> {
    let review = review(session)?;
    Ok(scorm::files(&review, &page::session(&review)))
}

/// The page that compares two sessions.
///
/// # Errors
/// As [`run`].
pub fn compared(first: &Path, second: &Path) -> Result<String, AppError> {
    Ok(page::comparison(&review(first)?, &review(second)?))
}

/// A session's pictures with their verdicts.
///
/// # Errors
/// As [`run`].
#[cfg(feature = "view")]
pub fn pictures(session: &Path) -> Result<Vec<crate::report::pictures::Picture>, AppError> {
    Ok(review(session)?.pictures)
}

/// A file's address for a browser.
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

fn review(session: &Path) -> Result<Review, AppError> {
    let stored = Stored::read(session)?;
    let about = about(session, &stored);
    Review::of(&stored.log, &stored.scenario.scenario, &stored.vehicle.vehicle, about).map_err(|error| match error {
        AssessError::OtherScenario { .. } | AssessError::OtherSeed { .. } => AppError::wrong(error.to_string()),
        _ => AppError::failed(error.to_string()),
    })
}

fn about(session: &Path, stored: &Stored) -> About {
    let name =
        std::path::absolute(session).ok().and_then(|path| path.file_name().map(|name| name.to_string_lossy().into_owned()));
    About {
        trainee: stored.trainee.clone(),
        started_unix_us: stored.started_unix_us,
        purpose: stored.purpose.clone(),
        started_utc: clock::utc(stored.started_unix_us).0,
        folder: name.unwrap_or_default(),
        scenario_sha256: sha256_hex(stored.scenario.text.as_bytes()),
        vehicle_sha256: sha256_hex(stored.vehicle.text.as_bytes()),
        telemetry_sha256: sha256_hex(&stored.log),
        pictures: photographs(&session.join(SNAPSHOTS)),
    }
}

/// The photographs of a session that are small enough, by the number that ends their names.
fn photographs(folder: &Path) -> Vec<(u32, Jpeg)> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    let mut left = PICTURES_MOST;
    let mut found = Vec::new();
    for path in paths {
        let Some(number) = number_of(&path) else { continue };
        let size = path.metadata().map_or(u64::MAX, |about| about.len());
        if size > PICTURE_MOST.min(left) {
            tracing::debug!("{}: too large for the page, drawn instead", path.display());
            continue;
        }
        if let Ok(bytes) = std::fs::read(&path) {
            left -= size;
            found.push((number, Jpeg { bytes }));
        }
    }
    found
}

/// The number that ends the name of a JPEG file.
fn number_of(path: &Path) -> Option<u32> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    let stem = path.file_stem()?.to_str()?;
    let digits = stem.len() - stem.bytes().rev().take_while(u8::is_ascii_digit).count();
    if matches!(ending.as_str(), "jpg" | "jpeg") { stem[digits..].parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_photographs_are_known_by_the_number_that_ends_their_name() {
        for (name, number) in
            [("0007.jpg", Some(7)), ("snap-12.JPEG", Some(12)), ("snap.jpg", None), ("7.png", None), ("7", None)]
        {
            assert_eq!(number_of(Path::new(name)), number, "{name}");
        }
    }

    #[test]
    fn exact_an_address_is_percent_encoded() {
        assert_eq!(address(Path::new("/a b/ü.html")), "file:///a%20b/%C3%BC.html");
    }
}
