//! Safety: contacts by speed, and time spent too close to a surface.

use super::inputs::CertificationInputs;
use crate::measures::crash;
use serde::Serialize;
use spandrel_mavlink::contract::contact::ContactKind;

/// Contacts closer together than this count as one crash, s (estimate: a bounce and the contact that follows it).
const CRASH_MERGE_GAP_S: f64 = 1.0;
/// Minimum loss per crash, points (equal to TASBID's fixed loss per crash).
const MIN_CRASH_LOSS: f64 = 3.0;
/// Speed at which a crash costs twice the minimum loss, m/s (estimate). Energy increases with the square of the speed,
/// so at twice this speed the loss is five times the minimum.
const CRASH_REFERENCE_SPEED_M_S: f64 = 2.0;
/// Maximum loss per crash, points (estimate).
const MAX_CRASH_LOSS: f64 = 30.0;
/// Points lost per second below the minimum clearance (estimate: one minute costs as much as two minimum-loss crashes).
const LOW_CLEARANCE_LOSS_PER_S: f64 = 0.1;
/// Maximum loss for low clearance, points (estimate).
const MAX_LOW_CLEARANCE_LOSS: f64 = 50.0;

/// A crash. Contacts close together in time are merged into one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MergedCrash {
    /// Number of the first frame.
    pub frame: u32,
    /// Time since lift-off, s.
    pub t_s: f64,
    /// Most severe object hit.
    pub with: ContactKind,
    /// Maximum speed around the time of first contact, m/s.
    pub speed_m_s: f64,
    /// Points lost by this crash.
    pub loss: f64,
    /// Number of the task whose window contains the crash, if any.
    pub task: Option<u32>,
}

/// Merges the session's contacts.
#[must_use]
pub fn merge(inputs: &CertificationInputs<'_>) -> Vec<MergedCrash> {
    let rate = inputs.frame_rate_hz();
    crash::merge_crashes(inputs.crashes, CRASH_MERGE_GAP_S * rate)
        .iter()
        .map(|crash| MergedCrash {
            frame: inputs.session.frames[crash.frame].index,
            t_s: crash.frame as f64 / rate,
            with: crash.with,
            speed_m_s: crash.speed_m_s,
            loss: crash_loss(crash.speed_m_s),
            task: crash.task.map(|task| inputs.scenario.tasks[task].id),
        })
        .collect()
}

fn crash_loss(speed_m_s: f64) -> f64 {
    let ratio = speed_m_s / CRASH_REFERENCE_SPEED_M_S;
    (MIN_CRASH_LOSS * (1.0 + ratio * ratio)).min(MAX_CRASH_LOSS)
}

/// Returns the time spent below the minimum clearance in seconds, outside the home radius. The limit is that of the last
/// task entered.
#[must_use]
pub fn exposure_s(inputs: &CertificationInputs<'_>) -> f64 {
    let mut current: Option<usize> = None;
    let mut frames = 0usize;
    for (frame, on) in inputs.session.frames.iter().zip(&inputs.on_path.task) {
        current = on.map(|(task, _)| task).or(current);
        let limit_m = inputs.clearance_limit_m(current.map(|task| &inputs.scenario.tasks[task]));
        frames += usize::from(inputs.is_too_close(frame, limit_m));
    }
    frames as f64 / inputs.frame_rate_hz()
}

/// Returns the safety score, 0 to 100; 0 if a person or vehicle was hit.
#[must_use]
pub fn safety(person_or_vehicle_hit: bool, crashes: &[MergedCrash], exposure_s: f64) -> f64 {
    if person_or_vehicle_hit {
        return 0.0;
    }
    let lost = crashes.iter().fold(0.0, |sum, crash| sum + crash.loss);
    let closeness = (LOW_CLEARANCE_LOSS_PER_S * exposure_s).min(MAX_LOW_CLEARANCE_LOSS);
    (100.0 - lost - closeness).clamp(0.0, 100.0)
}
