//! Flies the missing flights on several threads. The order in which flights finish does not affect any result.

use super::flight::fly;
use super::plan::PlannedFlight;
use super::row::FlightRow;
use crate::errors::AppError;
use crate::io::clock::Stopwatch;
use crate::io::stop::StopRequest;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::time::Duration;

/// A flight that takes this many times the median is reported.
const SLOW_FACTOR: u32 = 5;
/// Number of flights before slow ones are reported.
const MIN_FLIGHTS_FOR_MEDIAN: usize = 8;

/// Flies the flights on `jobs` threads and passes each row to `done`, in the order in which they finish.
///
/// # Errors
/// Returns the first error of `done`, after the running flights have been stopped.
pub fn fly_all(
    flights: &[&PlannedFlight],
    vehicle: &str,
    jobs: usize,
    stop: &StopRequest,
    mut done: impl FnMut(FlightRow) -> Result<(), AppError>,
) -> Result<(), AppError> {
    let next = AtomicUsize::new(0);
    let (sender, rows) = channel();
    std::thread::scope(|scope| {
        for _ in 0..jobs.min(flights.len()) {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                while let Some(flight) = flights.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let watch = Stopwatch::start();
                    let Some(row) = FlightRow::of(flight, vehicle, fly(&flight.inputs, stop)) else { return };
                    if sender.send((flight, row, watch.elapsed())).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let mut durations = Vec::new();
        for (flight, row, took) in rows {
            warn_if_slow(flight, took, &mut durations);
            if let Err(error) = done(row) {
                stop.request();
                return Err(error);
            }
        }
        Ok(())
    })
}

/// Logs a flight that took much longer than the others: it can point to a fault in the program.
fn warn_if_slow(flight: &PlannedFlight, took: Duration, durations: &mut Vec<Duration>) {
    if durations.len() >= MIN_FLIGHTS_FOR_MEDIAN {
        let median = durations[durations.len() / 2];
        if took > median * SLOW_FACTOR {
            let (took, median) = (took.as_secs_f64(), median.as_secs_f64());
            tracing::warn!("slow flight: '{}' took {took:.1} s; the median is {median:.1} s", flight.id);
        }
    }
    let at = durations.partition_point(|one| *one < took);
    durations.insert(at, took);
}
