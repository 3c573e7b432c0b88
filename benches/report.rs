//! Measures how long it takes to generate the report of a 25-minute session (read the log, score it, and write the
//! page). Also measures the page size. Checks both against their limits.

use spandrel_testkit::inspection;
use spandrel_training::report::{Review, SessionMetadata, page};
use std::process::ExitCode;
use std::time::Duration;

/// Limits for the report time and the page size (requirements).
const MAX_REPORT_TIME: Duration = Duration::from_secs(2);
const MAX_PAGE_BYTES: usize = 10_000_000;
const FLIGHT_DURATION_S: f64 = 1480.0;
const ROUNDS: usize = 3;

#[expect(clippy::disallowed_methods, reason = "benchmarks measure wall time")]
fn main() -> ExitCode {
    let (scenario, vehicle) = (inspection::two_bridges(), inspection::phantom());
    let log = inspection::record_inspection(&scenario, FLIGHT_DURATION_S, 17).log(0);
    let mut best = (Duration::MAX, Duration::MAX, 0, 0);
    for _ in 0..ROUNDS {
        let start = std::time::Instant::now();
        let review =
            Review::of(&log, &scenario, &vehicle, SessionMetadata::default()).expect("reviewing the generated flight must work");
        let worked_out = start.elapsed();
        let page = page::session(&review);
        if start.elapsed() < best.1 {
            best = (worked_out, start.elapsed(), page.len(), review.pictures.len());
        }
    }
    let (worked_out, whole, size, pictures) = best;
    let kept = |holds: bool| if holds { "ok" } else { "EXCEEDED" };
    println!("log: {:.1} MB, {pictures} pictures", log.len() as f64 / 1e6);
    println!(
        "report: {:.2} s (including {:.2} s to read and score the log); limit {:.0} s: {}",
        whole.as_secs_f64(),
        worked_out.as_secs_f64(),
        MAX_REPORT_TIME.as_secs_f64(),
        kept(whole <= MAX_REPORT_TIME)
    );
    println!("page: {:.2} MB; limit 10 MB: {}", size as f64 / 1e6, kept(size <= MAX_PAGE_BYTES));
    ExitCode::from(u8::from(whole > MAX_REPORT_TIME || size > MAX_PAGE_BYTES))
}
