//! Many flights on all cores, and the file that keeps their records.

use crate::flight::{flight_id, fly};
use crate::weaknesses::Weakness;
use spandrel_training::record::SessionRecord;
use std::io::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Environment variable with the file for the flights' records, to inspect them or to continue after an interruption.
const KEPT_RECORDS: &str = "SPANDREL_PLANTED_RECORDS";

/// Flies a job with every weakness and seed and returns the records in the same order.
pub fn fly_all(job: &str, flights: &[(&Weakness, u64)]) -> Vec<SessionRecord> {
    let known = kept_records();
    let next = AtomicUsize::new(0);
    let flown: Mutex<Vec<Option<SessionRecord>>> = Mutex::new(flights.iter().map(|_| None).collect());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some((weakness, seed)) = flights.get(index) else { break };
                    let id = flight_id(job, weakness, *seed);
                    let kept = known.iter().find(|record| record.id == id).cloned();
                    let is_new = kept.is_none();
                    let record = kept.unwrap_or_else(|| fly(job, weakness, *seed));
                    let mut flown = flown.lock().unwrap();
                    if is_new {
                        keep(&record);
                    }
                    flown[index] = Some(record);
                }
            });
        }
    });
    flown.into_inner().unwrap().into_iter().map(Option::unwrap).collect()
}

/// Returns the records in the file in `SPANDREL_PLANTED_RECORDS`. These flights are not flown again.
fn kept_records() -> Vec<SessionRecord> {
    let text = std::env::var(KEPT_RECORDS).ok().and_then(|path| std::fs::read_to_string(path).ok()).unwrap_or_default();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Appends a record to that file.
fn keep(record: &SessionRecord) {
    let Ok(path) = std::env::var(KEPT_RECORDS) else { return };
    let mut file = std::fs::OpenOptions::new().create(true).append(true).open(path).unwrap();
    writeln!(file, "{}", serde_json::to_string(record).unwrap()).unwrap();
}
