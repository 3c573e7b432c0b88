//! Sentences on what was left undone, and on the end of the flight.

use super::flight_scan::FlightScan;
use super::wording::{Place, Sentence, listed};
use crate::plan::BATTERY_RESERVE_PCT;
use crate::record::{TaskRecord, last_approach};
use crate::time_text::{clock, duration};
use spandrel_monitor::session::EndReason;
use spandrel_text::text;

fn end(scan: &FlightScan<'_>) -> (usize, String) {
    let last = scan.last_frame();
    (last, clock(scan.t_s(last)))
}

pub(super) fn not_attempted(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let (last, at) = end(scan);
    let Place { kind, tasks } = Place::of(scan, ids);
    Some((text!(scan.language, "advice-not-attempted", place = kind, tasks = tasks, at = at), last))
}

pub(super) fn not_covered(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let records: Vec<&TaskRecord> = scan.evidence.record.tasks.iter().filter(|task| ids.contains(&task.id)).collect();
    let covered = |task: &TaskRecord| task.covered.unwrap_or(0.0);
    let least = records.iter().copied().min_by(|a, b| covered(a).total_cmp(&covered(b)))?;
    let window = scan.task_indices(&[least.id]).first().and_then(|task| scan.on_path.windows[*task]);
    let frame = window.map_or_else(|| scan.last_frame(), |window| window.last);
    let shares: Vec<String> = records.iter().map(|task| format!("{:.0}%", 100.0 * covered(task))).collect();
    let (shares, at) = (listed(&shares, scan.language), clock(scan.t_s(frame)));
    let (Place { kind, tasks }, least) = (Place::of(scan, ids), least.id.to_string());
    let words = text!(scan.language, "advice-not-covered", shares = shares, place = kind, tasks = tasks, least = least, at = at);
    Some((words, frame))
}

pub(super) fn overtime(scan: &FlightScan<'_>) -> Option<Sentence> {
    let best_s = scan.evidence.scenario.scoring.time_best_s;
    let flown_s = scan.evidence.assessed_session.assessment.end.seconds;
    let (flown, over, at) = (duration(flown_s), duration((flown_s - best_s).max(0.0)), clock(best_s));
    Some((text!(scan.language, "advice-overtime", flown = flown, over = over, at = at), scan.frame_at(best_s)))
}

/// Longer than the job needs. The moment is when that time was over.
pub(super) fn slow(scan: &FlightScan<'_>) -> Option<Sentence> {
    let time = &scan.evidence.assessed_session.assessment.certification.time;
    let (flown, needed, at) = (duration(time.flown_s), duration(time.needed_s), clock(time.needed_s));
    let words = text!(scan.language, "advice-slow", flown = flown, needed = needed, at = at);
    Some((words, scan.frame_at(time.needed_s)))
}

/// Time at the landing pad. The moment is the last approach.
pub(super) fn landing(scan: &FlightScan<'_>) -> Option<Sentence> {
    let away = last_approach(scan.evidence.scenario, scan.frames())?;
    let (last, _) = end(scan);
    let took = duration(scan.t_s(last) - scan.t_s(away));
    Some((text!(scan.language, "advice-landing", took = took, at = clock(scan.t_s(away))), away))
}

pub(super) fn not_landed(scan: &FlightScan<'_>) -> Option<Sentence> {
    let (last, at) = end(scan);
    let away = pad_distance(scan, last)?;
    Some((text!(scan.language, "advice-not-landed", at = at, away = away), last))
}

/// Returns the horizontal distance from the pad as text, m.
fn pad_distance(scan: &FlightScan<'_>, frame: usize) -> Option<String> {
    let away_m = (scan.frames().get(frame)?.position_m - scan.evidence.scenario.ground_team.pad_m).horizontal_norm();
    Some(format!("{away_m:.0}"))
}

pub(super) fn battery_low(scan: &FlightScan<'_>) -> Option<Sentence> {
    let frame = scan.frames().iter().position(|frame| frame.battery_pct < BATTERY_RESERVE_PCT)?;
    let left = format!("{:.0}", scan.evidence.record.battery_at_end_pct);
    let (reserve, at) = (format!("{BATTERY_RESERVE_PCT:.0}"), clock(scan.t_s(frame)));
    Some((text!(scan.language, "advice-battery-low", left = left, reserve = reserve, at = at), frame))
}

pub(super) fn battery_failed(scan: &FlightScan<'_>) -> Option<Sentence> {
    let (last, at) = end(scan);
    let away = pad_distance(scan, last)?;
    let words = match scan.evidence.assessed_session.assessment.end.reason {
        EndReason::TimeLimit => text!(scan.language, "advice-time-up", at = at, away = away),
        EndReason::Landed
        | EndReason::Battery
        | EndReason::Person
        | EndReason::Vehicle
        | EndReason::Crash
        | EndReason::Abort
        | EndReason::Restart => text!(scan.language, "advice-battery-empty", at = at, away = away),
    };
    Some((words, last))
}
