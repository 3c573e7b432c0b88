//! Deletes old flight logs to make room for new ones.

use cap_std::fs::Dir;
use std::collections::BTreeMap;

/// File extensions of a flight's logs.
const LOG_EXTENSIONS: [&str; 2] = [".ulg", ".mcap"];

/// Deletes the logs of the oldest flights until the remaining logs use at most `most` bytes. `folder` contains one
/// folder per day, with two files per flight, named by time of day. Other files are neither counted nor deleted.
/// Returns the number of flights deleted.
///
/// # Errors
/// Returns an error if a folder cannot be read or a file cannot be deleted.
pub fn delete_oldest_logs(root: &Dir, folder: &str, most: u64) -> std::io::Result<usize> {
    let flights = flights(root, folder)?;
    let mut total: u64 = flights.values().map(|flight| flight.bytes).sum();
    let mut deleted = 0;
    for flight in flights.values() {
        if total <= most {
            break;
        }
        flight.files.iter().try_for_each(|file| root.remove_file(file))?;
        total -= flight.bytes;
        deleted += 1;
        // Also remove the day's folder if it has no logs left. Removal fails if the folder contains other files, which
        // is fine.
        let _ = root.remove_dir(&flight.day);
    }
    Ok(deleted)
}

#[derive(Debug, Default)]
struct LoggedFlight {
    day: String,
    files: Vec<String>,
    bytes: u64,
}

/// Returns the flights in order of day and time, oldest first. File names sort by time; a second flight in the same
/// second has the suffix `-1`.
fn flights(root: &Dir, folder: &str) -> std::io::Result<BTreeMap<(String, String, u32), LoggedFlight>> {
    let mut flights: BTreeMap<(String, String, u32), LoggedFlight> = BTreeMap::new();
    for day in root.read_dir(folder)? {
        let day = day?;
        let Ok(date) = day.file_name().into_string() else { continue };
        if !day.file_type()?.is_dir() {
            continue;
        }
        let path = format!("{folder}/{date}");
        for file in root.read_dir(&path)? {
            let file = file?;
            let Ok(name) = file.file_name().into_string() else { continue };
            let Some(stem) = LOG_EXTENSIONS.iter().find_map(|ending| name.strip_suffix(ending)) else { continue };
            let (time, number) = stem.split_once('-').map_or((stem, 0), |(time, number)| (time, number.parse().unwrap_or(0)));
            let flight = flights.entry((date.clone(), time.to_owned(), number)).or_default();
            flight.day.clone_from(&path);
            flight.bytes += file.metadata()?.len();
            flight.files.push(format!("{path}/{name}"));
        }
    }
    Ok(flights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cap_std::ambient_authority;

    #[test]
    fn regress_only_the_oldest_logs_are_deleted() {
        let temp_dir = tempfile::tempdir().unwrap();
        let root = Dir::open_ambient_dir(temp_dir.path(), ambient_authority()).unwrap();
        for day in ["2026-09-20", "2026-09-21"] {
            root.create_dir_all(format!("log/{day}")).unwrap();
        }
        let files = [
            ("2026-09-20/23_00_00.ulg", 100),
            ("2026-09-20/23_00_00.mcap", 50),
            ("2026-09-21/01_00_00.ulg", 100),
            ("2026-09-21/01_00_00-2.ulg", 100),
            ("2026-09-21/01_00_00-10.ulg", 100),
            ("2026-09-21/notes.txt", 10_000),
        ];
        for (name, bytes) in files {
            std::fs::write(temp_dir.path().join("log").join(name), vec![0; bytes]).unwrap();
        }
        let there = || files.iter().filter(|(name, _)| temp_dir.path().join("log").join(name).is_file()).map(|(name, _)| *name);
        assert_eq!(delete_oldest_logs(&root, "log", 450).unwrap(), 0);
        assert_eq!(there().count(), files.len(), "all of them fit");
        assert_eq!(delete_oldest_logs(&root, "log", 250).unwrap(), 2);
        let left = ["2026-09-21/01_00_00-2.ulg", "2026-09-21/01_00_00-10.ulg", "2026-09-21/notes.txt"];
        assert_eq!(there().collect::<Vec<_>>(), left, "the oldest flights were deleted with both files");
        assert!(!temp_dir.path().join("log/2026-09-20").exists(), "folders of days without logs are removed");
        assert_eq!(delete_oldest_logs(&root, "log", 0).unwrap(), 2);
        assert_eq!(there().collect::<Vec<_>>(), ["2026-09-21/notes.txt"]);
    }
}
