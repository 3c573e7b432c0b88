//! Crash analysis: pad touchdowns, lost contact messages, contact onsets, and assignment of crashes to tasks.

use super::on_path::OnPath;
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::telemetry::{Flight, Frame};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::GroundTeam;

/// Maximum vertical speed at which contact with the pad is not a crash, m/s (docs/src/reference/assessment.md, "Crashes").
const MAX_SOFT_CONTACT_M_S: f64 = 1.0;
/// Maximum height above the pad at which a contact may be with the ground around the pad, m (estimate: height of the
/// center of any tilted aircraft).
const MAX_PAD_CONTACT_HEIGHT_M: f64 = 1.0;
/// Number of preceding frames searched for the impact speed, because the drone may already have stopped when the
/// contact is reported.
const LOOK_BACK_FRAMES: usize = 2;

/// Start of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crash {
    /// Index of the contact's first frame, from 0.
    pub frame: usize,
    /// Index of the contact's last frame, from 0.
    pub last: usize,
    /// Kind of object hit.
    pub with: ContactKind,
    /// Maximum speed around the time of first contact, m/s.
    pub speed_m_s: f64,
    /// Index of the task whose window contains the crash, if any.
    pub task: Option<usize>,
}

/// Restores contacts whose messages were lost, then removes pad touchdowns and lift-offs. Changes only the `contact`
/// field of the frames.
pub fn clean_up_contacts(frames: &mut [Frame], flight: &Flight, team: &GroundTeam) {
    for time in flight.missed_contacts() {
        let i = frames.partition_point(|frame| frame.time < time);
        let free = |k: usize| frames.get(k).is_none_or(|frame| frame.contact == ContactKind::None);
        if i < frames.len() && !frames[i].missing && free(i) && (i == 0 || free(i - 1)) && free(i + 1) {
            frames[i].contact = ContactKind::Other;
        }
    }
    let mut run: Option<bool> = None;
    for i in 0..frames.len() {
        if !matches!(frames[i].contact, ContactKind::Terrain | ContactKind::Other) {
            run = None;
            continue;
        }
        let soft = *run.get_or_insert_with(|| is_soft_contact(frames, i, team));
        if soft && (frames[i].position_m - team.pad_m).horizontal_norm() <= team.home_radius_m {
            frames[i].contact = ContactKind::None;
        }
    }
}

fn is_soft_contact(frames: &[Frame], onset: usize, team: &GroundTeam) -> bool {
    let vertical = frames[onset.saturating_sub(LOOK_BACK_FRAMES)..=onset].iter().map(|frame| frame.velocity_m_s.up().abs());
    is_soft_pad_contact(frames[onset].position_m, vertical.fold(0.0, f64::max), team)
}

/// Returns whether ground or pad contact at this position and vertical speed is a touchdown or lift-off rather than a
/// crash.
#[must_use]
pub fn is_soft_pad_contact(position_m: Vec3<Enu>, vertical_m_s: f64, team: &GroundTeam) -> bool {
    let from_pad = position_m - team.pad_m;
    from_pad.horizontal_norm() <= team.home_radius_m
        && from_pad.up() < MAX_PAD_CONTACT_HEIGHT_M
        && vertical_m_s.abs() < MAX_SOFT_CONTACT_M_S
}

/// Returns all crashes. A crash is a frame in which a contact starts or escalates to a vehicle or person.
#[must_use]
pub fn crashes(frames: &[Frame], on_path: &OnPath) -> Vec<Crash> {
    let mut found: Vec<Crash> = Vec::new();
    let mut before = ContactKind::None;
    for (i, frame) in frames.iter().enumerate() {
        let worse = matches!(frame.contact, ContactKind::Person | ContactKind::Vehicle) && before != frame.contact;
        if frame.contact != ContactKind::None && (before == ContactKind::None || worse) {
            let around = &frames[i.saturating_sub(LOOK_BACK_FRAMES)..=i];
            let speed_m_s = around.iter().map(Frame::speed_m_s).fold(0.0, f64::max);
            found.push(Crash { frame: i, last: i, with: frame.contact, speed_m_s, task: task_at_frame(i, on_path) });
        } else if frame.contact != ContactKind::None
            && let Some(crash) = found.last_mut()
        {
            crash.last = i;
        }
        before = frame.contact;
    }
    found
}

/// Returns the task whose window contains frame `i`. If several windows contain it, prefers the task being flown, then
/// the last one flown, then the one with the lowest index.
fn task_at_frame(i: usize, on_path: &OnPath) -> Option<usize> {
    let holds = |task: usize| on_path.windows[task].is_some_and(|window| window.contains(i));
    let open: Vec<usize> = (0..on_path.windows.len()).filter(|task| holds(*task)).collect();
    if open.len() < 2 {
        return open.first().copied();
    }
    let flown = on_path.task[..=i].iter().rev().find_map(|on| on.map(|(task, _)| task));
    flown.filter(|task| open.contains(task)).or(open.first().copied())
}

/// Merges crashes that are less than `apart_frames` frames apart, as the certification profile requires.
#[must_use]
pub fn merge_crashes(crashes: &[Crash], apart_frames: f64) -> Vec<Crash> {
    let mut merged: Vec<Crash> = Vec::new();
    for crash in crashes {
        match merged.last_mut() {
            Some(last) if ((crash.frame - last.last) as f64) < apart_frames => {
                last.last = crash.last;
                last.speed_m_s = last.speed_m_s.max(crash.speed_m_s);
                last.with = last.with.more_severe(crash.with);
            }
            Some(_) | None => merged.push(*crash),
        }
    }
    merged
}
