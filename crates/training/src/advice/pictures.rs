//! Sentences on defects and pictures.

use super::flight_scan::{FlightScan, MissedDefect};
use super::wording::Sentence;
use crate::plan::MIN_SEVERE_CONDITION_STATE;
use crate::record::DefectRecord;
use crate::time_text::clock;
use spandrel_monitor::measures::attention::Snapshot;

/// Returns whether a defect is in a severe condition state.
pub(super) fn is_severe(defect: &DefectRecord) -> bool {
    defect.condition_state >= MIN_SEVERE_CONDITION_STATE
}

/// Missed defects of a kind. The moment is the best chance to photograph one of them.
pub(super) fn missed(scan: &FlightScan<'_>, kind: &str, about: fn(&DefectRecord) -> bool) -> Option<Sentence> {
    let (missed, all) = counts(scan, about);
    let chance = best_chance(scan, |id| missed.contains(&id))?;
    let frame = scan.frame_at(chance.t_s);
    let (id, at) = (chance.id, clock(chance.t_s));
    let hint = if chance.in_view_s > 0.0 {
        format!("defect {id} was in clear view at {at}: stop and take a picture")
    } else {
        format!("at {at} you were nearest to a view of defect {id}: search slowly there")
    };
    Some((format!("You missed {} of {all} {kind}; {hint}.", missed.len()), frame))
}

/// Defects that were in clear view.
pub(super) fn missed_in_view(scan: &FlightScan<'_>) -> Option<Sentence> {
    let seen: Vec<&MissedDefect> = scan.evidence.missed.iter().filter(|defect| defect.in_view_s > 0.0).collect();
    let chance = best_chance(scan, |_| true)?;
    let (count, at, seconds) = (seen.len(), clock(chance.t_s), chance.in_view_s);
    let subject = if count == 1 { "a defect".to_owned() } else { format!("{count} defects") };
    let words = format!(
        "You passed {subject} in clear view without a picture, the longest for {seconds:.1} s at {at}: fly slower or closer there."
    );
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
    let (what, remedy) = match lacked {
        "too dark" => ("too dark", "switch on the lamp"),
        "too oblique" => ("taken at too flat an angle", "point the nose straight at the surface"),
        "too small" => ("taken from too far away", "move closer"),
        "line too thin" => ("taken from too far for a fine crack", "move closer"),
        other => (other, "correct this before the picture"),
    };
    let subject = if count == 1 { "picture of a defect was".to_owned() } else { format!("pictures of {count} defects were") };
    Some((format!("Your {subject} {what}, first at {}: {remedy}.", clock(picture.t_s)), index(picture.frame)))
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
    let (what, remedy) = match lacked {
        "motion blur" => ("blurred by motion", "stop before the picture"),
        "resolution" => ("too coarse", "move closer"),
        "incidence" => ("taken at too flat an angle", "point the nose straight at the surface"),
        _ => ("not good enough", "check what the report says about each one"),
    };
    let at = clock(scan.t_s(frame));
    Some((format!("Your pictures of {count} of the {found} defects that you found are {what}, first at {at}: {remedy}."), frame))
}

pub(super) fn none_taken(scan: &FlightScan<'_>) -> Option<Sentence> {
    let (missed, _) = counts(scan, |_| true);
    let chance = best_chance(scan, |_| true)?;
    let (count, at) = (missed.len(), clock(chance.t_s));
    let words = format!("You took no picture of the {count} defects; your best chance was at {at}: photograph every defect.");
    Some((words, scan.frame_at(chance.t_s)))
}

/// Pictures without a new defect.
pub(super) fn without_defect(scan: &FlightScan<'_>) -> Option<Sentence> {
    let pictures = &scan.evidence.assessed_session.assessment.snapshots;
    let first = pictures.each.iter().find(|picture| !picture.hit)?;
    let count = pictures.each.iter().filter(|picture| !picture.hit).count();
    let (taken, at) = (pictures.taken, clock(first.t_s));
    let words = format!("{count} of your {taken} pictures show no new defect, first at {at}: look first, then take the picture.");
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
