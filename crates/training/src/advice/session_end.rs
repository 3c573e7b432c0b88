//! Sentences on what was left undone, and on the end of the flight.

use super::flight_scan::FlightScan;
use super::wording::{Sentence, listed, tasks};
use crate::plan::BATTERY_RESERVE_PCT;
use crate::record::TaskRecord;
use crate::time_text::{clock, duration};
use spandrel_monitor::session::EndReason;

fn end(scan: &FlightScan<'_>) -> (usize, String) {
    let last = scan.last_frame();
    (last, clock(scan.t_s(last)))
}

pub(super) fn not_attempted(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let (last, at) = end(scan);
    let what = if scan.evidence.scenario.tasks.len() == 1 { "the task".to_owned() } else { tasks(ids) };
    Some((format!("You did not fly {what}: the flight ended at {at}."), last))
}

pub(super) fn not_covered(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let records: Vec<&TaskRecord> = scan.evidence.record.tasks.iter().filter(|task| ids.contains(&task.id)).collect();
    let covered = |task: &TaskRecord| task.covered.unwrap_or(0.0);
    let least = records.iter().copied().min_by(|a, b| covered(a).total_cmp(&covered(b)))?;
    let window = scan.task_indices(&[least.id]).first().and_then(|task| scan.on_path.windows[*task]);
    let frame = window.map_or_else(|| scan.last_frame(), |window| window.last);
    let shares: Vec<String> = records.iter().map(|task| format!("{:.0}%", 100.0 * covered(task))).collect();
    let of = if scan.evidence.scenario.tasks.len() == 1 { "the path".to_owned() } else { format!("the path of {}", tasks(ids)) };
    let of = if records.len() > 1 { of.replacen("path", "paths", 1) } else { of };
    let (shares, at) = (listed(&shares), clock(scan.t_s(frame)));
    let left = if records.len() > 1 { format!("task {} at {at}", least.id) } else { format!("it at {at}") };
    Some((format!("You flew only {shares} of {of} and left {left}: fly each path to its end."), frame))
}

pub(super) fn overtime(scan: &FlightScan<'_>) -> Option<Sentence> {
    let best_s = scan.evidence.scenario.scoring.time_best_s;
    let flown_s = scan.evidence.assessed_session.assessment.end.seconds;
    let (flown, over, at) = (duration(flown_s), duration((flown_s - best_s).max(0.0)), clock(best_s));
    let words = format!(
        "You flew for {flown}, {over} longer than full points allow; the time was up at {at}: plan the order of the tasks."
    );
    Some((words, scan.frame_at(best_s)))
}

pub(super) fn not_landed(scan: &FlightScan<'_>) -> Option<Sentence> {
    let (last, at) = end(scan);
    let away_m = (scan.frames().get(last)?.position_m - scan.evidence.scenario.ground_team.pad_m).horizontal_norm();
    Some((format!("Your flight ended at {at}, {away_m:.0} m from the pad: fly back and land on it."), last))
}

pub(super) fn battery_low(scan: &FlightScan<'_>) -> Option<Sentence> {
    let frame = scan.frames().iter().position(|frame| frame.battery_pct < BATTERY_RESERVE_PCT)?;
    let (left, at) = (scan.evidence.record.battery_at_end_pct, clock(scan.t_s(frame)));
    let words = format!(
        "You ended with {left:.0}% battery; the {BATTERY_RESERVE_PCT:.0}% reserve was reached at {at}: turn back earlier."
    );
    Some((words, frame))
}

pub(super) fn battery_failed(scan: &FlightScan<'_>) -> Option<Sentence> {
    let (last, at) = end(scan);
    let away_m = (scan.frames().get(last)?.position_m - scan.evidence.scenario.ground_team.pad_m).horizontal_norm();
    let what = match scan.evidence.assessed_session.assessment.end.reason {
        EndReason::TimeLimit => "Your time was up",
        EndReason::Landed
        | EndReason::Battery
        | EndReason::Person
        | EndReason::Vehicle
        | EndReason::Crash
        | EndReason::Abort
        | EndReason::Restart => "Your battery was empty",
    };
    Some((format!("{what} at {at}, {away_m:.0} m from the pad: turn back earlier."), last))
}
