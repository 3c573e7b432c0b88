//! Sentences on defects and pictures.

use super::flight_scan::{FlightScan, MissedDefect};
use super::wording::{Place, Sentence};
use crate::plan::MIN_SEVERE_CONDITION_STATE;
use crate::record::{DefectRecord, is_drifting, is_in_motion, is_turning};
use crate::time_text::clock;
use spandrel_mavlink::telemetry::Frame;
use spandrel_monitor::measures::attention::Snapshot;
use spandrel_text::text;

/// Returns whether a defect is in a severe condition state.
pub(super) fn is_severe(defect: &DefectRecord) -> bool {
    defect.condition_state >= MIN_SEVERE_CONDITION_STATE
}

/// Missed defects of a kind: `all`, `severe`, `hidden` or `cracks`. The moment is the best chance to photograph one of them.
pub(super) fn missed(scan: &FlightScan<'_>, kind: &str, about: fn(&DefectRecord) -> bool) -> Option<Sentence> {
    let (missed, all) = counts(scan, about);
    let chance = best_chance(scan, |id| missed.contains(&id))?;
    let (missed, all) = (missed.len().to_string(), all.to_string());
    let (defect, at) = (chance.id.to_string(), clock(chance.t_s));
    let words = if chance.in_view_s > 0.0 {
        text!(scan.language, "advice-missed-in-view", missed = missed, all = all, kind = kind, defect = defect, at = at)
    } else {
        text!(scan.language, "advice-missed-nearest", missed = missed, all = all, kind = kind, defect = defect, at = at)
    };
    Some((words, scan.frame_at(chance.t_s)))
}

/// Defects that were in clear view.
pub(super) fn missed_in_view(scan: &FlightScan<'_>) -> Option<Sentence> {
    let count = scan.evidence.missed.iter().filter(|defect| defect.in_view_s > 0.0).count();
    let chance = best_chance(scan, |_| true)?;
    let (seconds, at) = (format!("{:.1}", chance.in_view_s), clock(chance.t_s));
    let words = text!(scan.language, "advice-passed-in-view", count = count, seconds = seconds, at = at);
    Some((words, scan.frame_at(chance.t_s)))
}

/// Defects whose pictures failed for a reason.
pub(super) fn failed(scan: &FlightScan<'_>, lacked: &str) -> Option<Sentence> {
    let failed = |id: u32| {
        let record = scan.evidence.record.defects.iter().find(|defect| defect.id == id);
        record.is_some_and(|defect| !defect.found && defect.lacked.iter().any(|text| text.starts_with(lacked)))
    };
    let shows = |picture: &&Snapshot| {
        let mut fails = picture.views.iter().filter(|view| failed(view.defect)).flat_map(|view| &view.fails);
        fails.any(|text| text.starts_with(lacked))
    };
    let count = scan.evidence.record.defects.iter().filter(|defect| failed(defect.id)).count();
    let picture = scan.evidence.assessed_session.assessment.snapshots.each.iter().find(shows)?;
    let why = match lacked {
        "too dark" => "dark",
        "too oblique" => "oblique",
        "too small" => "small",
        "line too thin" => "thin",
        _ => "other",
    };
    let at = clock(picture.t_s);
    let words = text!(scan.language, "advice-picture-failed", count = count, why = why, reason = lacked, at = at);
    Some((words, index(picture.frame)))
}

/// Found defects without a picture of sufficient quality.
pub(super) fn poor(scan: &FlightScan<'_>, lacked: &str) -> Option<Sentence> {
    let record = scan.evidence.record;
    let poor =
        record.defects.iter().filter(|defect| defect.found && defect.shortfalls.iter().any(|text| text.starts_with(lacked)));
    let (count, found) = (poor.count(), record.defects.iter().filter(|defect| defect.found).count());
    let accuracy = &scan.evidence.assessed_session.assessment.certification.accuracy;
    let fails = |text: &String| text.split_once(": ").is_some_and(|(_, reason)| reason.starts_with(lacked));
    let frame = index(accuracy.pictures.iter().find(|picture| picture.fails.iter().any(fails))?.frame);
    let why = match lacked {
        "motion blur" => "blur",
        "resolution" => "coarse",
        "incidence" => "oblique",
        _ => "other",
    };
    let at = clock(scan.t_s(frame));
    Some((text!(scan.language, "advice-picture-poor", count = count, found = found, why = why, at = at), frame))
}

pub(super) fn none_taken(scan: &FlightScan<'_>) -> Option<Sentence> {
    let (missed, _) = counts(scan, |_| true);
    let chance = best_chance(scan, |_| true)?;
    let (count, at) = (missed.len(), clock(chance.t_s));
    let words = text!(scan.language, "advice-no-pictures", count = count, at = at);
    Some((words, scan.frame_at(chance.t_s)))
}

/// Tasks of which no defect was found.
pub(super) fn none_found(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let at_task = |defect: &&DefectRecord| defect.task.is_some_and(|task| ids.contains(&task));
    let missed: Vec<u32> = scan.evidence.record.defects.iter().filter(at_task).map(|defect| defect.id).collect();
    let chance = best_chance(scan, |id| missed.contains(&id))?;
    let Place { kind, tasks } = Place::of(scan, ids);
    let (all, defect, at) = (missed.len(), chance.id.to_string(), clock(chance.t_s));
    let words = text!(scan.language, "advice-none-found", all = all, place = kind, tasks = tasks, defect = defect, at = at);
    Some((words, scan.frame_at(chance.t_s)))
}

/// Pictures taken in motion.
pub(super) fn in_motion(scan: &FlightScan<'_>) -> Option<Sentence> {
    of_those_taken(scan, is_in_motion, |count, taken, at| {
        text!(scan.language, "advice-moving-pictures", count = count, taken = taken, at = at)
    })
}

/// Pictures taken while the drone drifted.
pub(super) fn while_drifting(scan: &FlightScan<'_>) -> Option<Sentence> {
    of_those_taken(scan, is_drifting, |count, taken, at| {
        text!(scan.language, "advice-drifting-pictures", count = count, taken = taken, at = at)
    })
}

/// Pictures taken while the pilot turned the drone.
pub(super) fn while_turning(scan: &FlightScan<'_>) -> Option<Sentence> {
    of_those_taken(scan, is_turning, |count, taken, at| {
        text!(scan.language, "advice-turning-pictures", count = count, taken = taken, at = at)
    })
}

/// Returns the sentence on the pictures in such frames, composed from their number, that of all pictures, and the time of the first.
fn of_those_taken(
    scan: &FlightScan<'_>,
    is_meant: fn(&Frame) -> bool,
    compose: impl Fn(usize, usize, String) -> String,
) -> Option<Sentence> {
    let (first, count, taken) = pictures_in(scan, |_, frame| is_meant(frame))?;
    Some((compose(count, taken, clock(scan.t_s(first))), first))
}

/// Pictures in the dark with the lamp off.
pub(super) fn unlit(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let (first, count, _) = pictures_in(scan, |index, frame| !frame.light && scan.near(index, &tasks).is_some())?;
    let (Place { kind, tasks }, at) = (Place::of(scan, ids), clock(scan.t_s(first)));
    Some((text!(scan.language, "advice-unlit-pictures", count = count, place = kind, tasks = tasks, at = at), first))
}

/// Returns the first of the pictures in such frames, and the numbers of these and of all pictures; `None` if there is no such picture.
fn pictures_in(scan: &FlightScan<'_>, is_meant: impl Fn(usize, &Frame) -> bool) -> Option<(usize, usize, usize)> {
    let taken = || scan.frames().iter().enumerate().filter(|(_, frame)| frame.snapshot);
    let meant = || taken().filter(|(index, frame)| is_meant(*index, frame));
    let (first, _) = meant().next()?;
    Some((first, meant().count(), taken().count()))
}

/// Pictures without a new defect.
pub(super) fn without_defect(scan: &FlightScan<'_>) -> Option<Sentence> {
    let pictures = &scan.evidence.assessed_session.assessment.snapshots;
    let first = pictures.each.iter().find(|picture| !picture.hit)?;
    let count = pictures.each.iter().filter(|picture| !picture.hit).count();
    let (count, taken, at) = (count.to_string(), pictures.taken.to_string(), clock(first.t_s));
    let words = text!(scan.language, "advice-pictures-of-nothing", count = count, taken = taken, at = at);
    Some((words, index(first.frame)))
}

/// Returns the numbers of the missed defects of a kind, and how many of the kind there are.
fn counts(scan: &FlightScan<'_>, about: fn(&DefectRecord) -> bool) -> (Vec<u32>, usize) {
    let all: Vec<&DefectRecord> = scan.evidence.record.defects.iter().filter(|defect| about(defect)).collect();
    (all.iter().filter(|defect| !defect.found).map(|defect| defect.id).collect(), all.len())
}

/// Returns the missed defect that was in view longest or else came nearest.
fn best_chance<'a>(scan: &FlightScan<'a>, about: impl Fn(u32) -> bool) -> Option<&'a MissedDefect> {
    let missed = scan.evidence.missed.iter().filter(|defect| about(defect.id));
    missed.min_by(|a, b| b.in_view_s.total_cmp(&a.in_view_s).then(a.nearest_m.total_cmp(&b.nearest_m)))
}

/// Converts a frame number to an index.
fn index(frame: u32) -> usize {
    (frame as usize).saturating_sub(1)
}
