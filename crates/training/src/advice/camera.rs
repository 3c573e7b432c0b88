//! Sentences on the camera and the lamp.

use super::flight_scan::FlightScan;
use super::wording::{Place, Sentence, surface, when};
use spandrel_monitor::measures::attention;
use spandrel_monitor::measures::image_quality::angle_rad;
use spandrel_monitor::score::certification::precision::FRAMING_TOLERANCE_DEG;
use spandrel_text::text;

pub(super) fn framing(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let (tasks, evidence) = (scan.task_indices(ids), scan.evidence);
    let angle_deg = |frame: usize| {
        let view = scan.near(frame, &tasks)?.view(&evidence.scenario.tasks)?;
        let pose = attention::pose(evidence.flight, scan.frames()[frame].time, evidence.vehicle)?;
        Some(angle_rad(pose.forward, view).to_degrees()).filter(|angle_deg| *angle_deg > FRAMING_TOLERANCE_DEG)
    };
    let angles: Vec<Option<f64>> = (0..scan.frames().len()).map(angle_deg).collect();
    let stretches = scan.stretches(|frame| angles[frame].is_some())?;
    let most = format!("{:.0}", angles.iter().flatten().copied().fold(0.0, f64::max));
    let (surface, when) = (surface(scan, &tasks), when(scan, Place::of(scan, ids), &stretches));
    let words = text!(scan.language, "advice-framing", most = most, surface = surface, when = when);
    Some((words, stretches.longest))
}

pub(super) fn lamp_off(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let stretches = scan.stretches(|frame| scan.near(frame, &tasks).is_some() && !scan.frames()[frame].light)?;
    let when = when(scan, Place::of(scan, ids), &stretches);
    Some((text!(scan.language, "advice-lamp-off", when = when), stretches.longest))
}
