//! Measures how long it takes to process a cohort of 10,000 sessions, from parsing the records to computing the last
//! statistic. The sessions are renamed copies of the example study, most of whose sessions are incomplete.

#[path = "support/best.rs"]
mod best;

use best::best;
use spandrel_training::cohort::{Selection, cohort};
use spandrel_training::record::IncompletePolicy;
use spandrel_training::record::SessionRecord;
use std::time::Duration;

const RECORDS: &str = include_str!("../examples/cohort/records.jsonl");
const SESSION_COUNT: usize = 10_000;
/// Maximum processing time (requirement).
const MAX_PROCESSING_TIME: Duration = Duration::from_secs(2);
const ROUNDS: usize = 5;

fn main() {
    let originals: Vec<SessionRecord> = RECORDS.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    let renamed = |k: usize| {
        let mut record = originals[k % originals.len()].clone();
        record.trainee = format!("{}-{}", record.trainee, k / originals.len());
        record.id = format!("{}-{k}", record.id);
        serde_json::to_string(&record).unwrap_or_default()
    };
    let lines: Vec<String> = (0..SESSION_COUNT).map(renamed).collect();
    let took = best(ROUNDS, || {
        let records: Vec<SessionRecord> = lines.iter().filter_map(|line| serde_json::from_str(line).ok()).collect();
        cohort(&records, &Selection { scenarios: Vec::new(), repetitions: 3, incomplete: IncompletePolicy::Include })
    });
    println!("cohort of {SESSION_COUNT} sessions: {:.2} s (limit {} s)", took.as_secs_f64(), MAX_PROCESSING_TIME.as_secs());
    assert!(took < MAX_PROCESSING_TIME, "limit exceeded");
}
