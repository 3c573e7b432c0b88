//! The journal of a study: one line of JSON for each finished flight, in the order in which they finished. It survives a
//! kill of the program: an incomplete last line is removed, and its flight is flown again.

use super::plan::{FlightId, StudyPlan};
use super::row::FlightRow;
use crate::errors::AppError;
use crate::io::append_file::{AppendFile, complete_lines_len};
use std::collections::BTreeMap;
use std::path::Path;

/// File name in the study's folder.
const JOURNAL: &str = "flights.jsonl";
/// Message if another process has locked the journal.
const CONFLICT: &str = "another process is flying this study: wait for it, stop it, or use another --out";

/// The journal, open for appending.
#[derive(Debug)]
pub struct Journal {
    file: AppendFile,
    flown: BTreeMap<(String, FlightId), FlightRow>,
}

impl Journal {
    /// Opens or creates the journal in a study's folder.
    ///
    /// # Errors
    /// Returns an error if the folder or the file cannot be written, if another process uses it, or if a line is not valid
    /// or belongs to a flight of this plan with other inputs.
    pub fn open(folder: &Path, plan: &StudyPlan) -> Result<Self, AppError> {
        let cannot = |error: std::io::Error| AppError::failed(format!("{}: cannot create the folder: {error}", folder.display()));
        std::fs::create_dir_all(folder).map_err(cannot)?;
        let path = folder.join(JOURNAL);
        let mut file = AppendFile::open(path.clone(), complete_lines_len)?;
        file.lock(CONFLICT)?;
        let text = std::fs::read(&path).map_err(|error| AppError::failed(format!("{}: cannot read: {error}", path.display())))?;
        let complete = complete_lines_len(&text);
        file.truncate(complete as u64)?;
        let flown = read_rows(&path, &text[..complete], plan)?;
        Ok(Self { file, flown })
    }

    /// Returns the row of a flight, if it was flown.
    pub fn row(&self, vehicle: &str, id: &FlightId) -> Option<&FlightRow> {
        self.flown.get(&(vehicle.to_owned(), id.clone()))
    }

    /// Adds a row and writes it to disk.
    ///
    /// # Errors
    /// Returns an error if the disk cannot be written.
    pub fn add(&mut self, row: FlightRow) -> Result<(), AppError> {
        self.file.push((line(&row)? + "\n").as_bytes());
        self.file.flush()?;
        self.flown.insert(key(&row), row);
        Ok(())
    }
}

/// Returns a row as one line of JSON, without the newline.
///
/// # Errors
/// Returns an error if the row cannot be written as JSON (not expected in practice).
pub fn line(row: &FlightRow) -> Result<String, AppError> {
    serde_json::to_string(row).map_err(|error| AppError::failed(error.to_string()))
}

fn key(row: &FlightRow) -> (String, FlightId) {
    let id = FlightId { scenario: row.scenario.clone(), pilot: row.pilot.clone(), seed: row.seed };
    (row.vehicle.clone(), id)
}

fn read_rows(path: &Path, text: &[u8], plan: &StudyPlan) -> Result<BTreeMap<(String, FlightId), FlightRow>, AppError> {
    let planned: BTreeMap<(&str, &FlightId), &str> =
        plan.flights.iter().map(|flight| ((plan.vehicle.as_str(), &flight.id), flight.fingerprint.as_str())).collect();
    let mut flown = BTreeMap::new();
    for (k, line) in text.split(|byte| *byte == b'\n').enumerate().filter(|(_, line)| !line.is_empty()) {
        let wrong = |message: String| AppError::invalid(format!("{}:{}: {message}", path.display(), k + 1));
        let row: FlightRow = serde_json::from_slice(line).map_err(|error| wrong(format!("not a flight of a study: {error}")))?;
        let key = key(&row);
        if planned.get(&(key.0.as_str(), &key.1)).is_some_and(|fingerprint| *fingerprint != row.fingerprint) {
            let id = &key.1;
            return Err(wrong(format!(
                "the flight '{id}' was flown with another scenario, aircraft, pilot or program version: use another --out"
            )));
        }
        flown.insert(key, row);
    }
    Ok(flown)
}

#[cfg(test)]
mod tests {
    use super::super::flight::FlightError;
    use super::super::plan::SeedRange;
    use super::*;

    fn plan(pilot: &str) -> StudyPlan {
        let pilots = [pilot.parse().unwrap()];
        StudyPlan::read(&["drill-hover".to_owned()], "phantom2", &pilots, SeedRange { first: 1, last: 3 }).unwrap()
    }

    fn failed(plan: &StudyPlan, k: usize) -> FlightRow {
        FlightRow::of(&plan.flights[k], &plan.vehicle, Err(FlightError::Failed(format!("problem {k}")))).unwrap()
    }

    #[test]
    fn exact_incomplete_last_line_is_removed_and_flown_again() {
        let folder = tempfile::tempdir().unwrap();
        let plan = plan("novice");
        let mut journal = Journal::open(folder.path(), &plan).unwrap();
        journal.add(failed(&plan, 0)).unwrap();
        journal.add(failed(&plan, 1)).unwrap();
        drop(journal);
        let path = folder.path().join(JOURNAL);
        let whole = std::fs::read(&path).unwrap();
        // Killed anywhere within the second line, the first flight remains.
        let first_end = complete_lines_len(&whole[..whole.len() - 1]);
        for cut in [first_end, first_end + 1, whole.len() - 1] {
            std::fs::write(&path, &whole[..cut]).unwrap();
            let mut journal = Journal::open(folder.path(), &plan).unwrap();
            assert_eq!(journal.row("phantom2", &plan.flights[0].id), Some(&failed(&plan, 0)));
            assert_eq!(journal.row("phantom2", &plan.flights[1].id), None);
            journal.add(failed(&plan, 1)).unwrap();
            drop(journal);
            assert_eq!(std::fs::read(&path).unwrap(), whole, "cut at {cut}");
        }
    }

    #[test]
    fn exact_journal_rejects_other_inputs_damage_and_a_second_process() {
        let folder = tempfile::tempdir().unwrap();
        let plan = plan("novice");
        let mut journal = Journal::open(folder.path(), &plan).unwrap();
        journal.add(failed(&plan, 0)).unwrap();
        let error = Journal::open(folder.path(), &plan).unwrap_err();
        assert!(error.to_string().contains("another process is flying this study"), "{error}");
        drop(journal);
        let mut other = plan.clone();
        other.flights[0].fingerprint = "0".into();
        let error = Journal::open(folder.path(), &other).unwrap_err();
        assert!(error.to_string().contains("flights.jsonl:1: the flight 'drill-hover, novice, seed 1' was flown"), "{error}");
        std::fs::write(folder.path().join(JOURNAL), "{}\n").unwrap();
        let error = Journal::open(folder.path(), &plan).unwrap_err();
        assert!(error.to_string().contains("flights.jsonl:1: not a flight of a study"), "{error}");
    }
}
