//! Validity of the cues: compares the cues of a flight with what the scored frames show. It counts false alarms, cues that
//! are too short to read, and deviations that no cue reported.

use super::coverage::FlownPath;
use super::on_path::{OnPath, ReferencePaths};
use serde::{Deserialize, Serialize};
use spandrel_mavlink::contract::cue;
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;

/// Cues shorter than this cannot be read, s (estimate: reading time of three words).
const SHORT_CUE_S: f64 = 1.0;
/// A deviation from the path must raise a cue if it lasts longer than this, s (estimate: the delay of the cue plus the time
/// that a pilot needs to correct a deviation without help).
const MIN_DEVIATION_S: f64 = 3.0;
/// On-path intervals closer together than this belong to the same visit, s (as in the certification profile).
const VISIT_MERGE_GAP_S: f64 = 10.0;

/// Cues and texts of a flight, collected from the monitor's events.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CueLog {
    /// Times at which the cue mask changed, and the new masks.
    changes: Vec<(SimTime, i32)>,
    /// Times of the texts that belong to a cue.
    texts: Vec<SimTime>,
}

impl CueLog {
    /// Adds one of the monitor's events (a line of `events.jsonl`). Events other than cues and their texts are ignored.
    pub fn add_event(&mut self, event: &serde_json::Value) {
        let Some(time) = event["t_s"].as_f64().map(SimTime::from_s) else { return };
        if let Some(mask) = event["cues"].as_i64().and_then(|mask| i32::try_from(mask).ok()) {
            self.changes.push((time, mask));
        }
        if event["event"] == "text" && event["text"].as_str().is_some_and(|text| cue::of_text(text).is_some()) {
            self.texts.push(time);
        }
    }

    /// Returns the intervals during which any of the bits was set, up to `end`.
    fn intervals(&self, bits: i32, end: SimTime) -> Vec<(SimTime, SimTime)> {
        let mut out = Vec::new();
        let mut since = None;
        for (time, mask) in self.changes.iter().copied().take_while(|(time, _)| *time <= end).chain([(end, 0)]) {
            match (since, mask & bits != 0) {
                (None, true) => since = Some(time),
                (Some(from), false) => {
                    out.push((from, time));
                    since = None;
                }
                (None, false) | (Some(_), true) => {}
            }
        }
        out
    }
}

/// Number of cues of one flight, and of those that were wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct CueValidity {
    /// Texts that belong to a cue.
    pub texts: usize,
    /// Off-path cues.
    pub off_path: usize,
    /// Off-path cues that started while no task was being flown.
    pub off_path_outside: usize,
    /// Speeding cues.
    pub speeding: usize,
    /// Speeding cues of less than one second.
    pub speeding_short: usize,
    /// Stand-off cues.
    pub stand_off: usize,
    /// Too-close cues.
    pub too_close: usize,
    /// Deviations from the path of the task that is being flown, with more than three seconds near the path.
    pub deviations: usize,
    /// Deviations during which neither the off-path cue nor the stand-off cue was on.
    pub deviations_missed: usize,
}

impl CueValidity {
    /// Compares the cues with the frames of the session.
    #[must_use]
    pub fn measure(log: &CueLog, frames: &[Frame], scenario: &Scenario) -> Self {
        let (Some(first), Some(last)) = (frames.first(), frames.last()) else { return Self::default() };
        let flight = FlownTasks::new(frames, scenario);
        let off_path = log.intervals(cue::OFF_PATH, last.time);
        let speeding = log.intervals(cue::SPEEDING, last.time);
        let reported = log.intervals(cue::OFF_PATH | cue::STAND_OFF, last.time);
        let deviations = flight.deviations(scenario.feedback.off_path_max_m);
        let missed = |(from, to): &&(SimTime, SimTime)| !reported.iter().any(|(on, off)| on <= to && off >= from);
        Self {
            texts: log.texts.iter().filter(|time| (first.time..=last.time).contains(*time)).count(),
            off_path: off_path.len(),
            off_path_outside: off_path.iter().filter(|(on, _)| !flight.is_in_task(*on)).count(),
            speeding: speeding.len(),
            speeding_short: speeding.iter().filter(|(on, off)| (*off - *on).s() < SHORT_CUE_S).count(),
            stand_off: log.intervals(cue::STAND_OFF, last.time).len(),
            too_close: log.intervals(cue::TOO_CLOSE, last.time).len(),
            deviations: deviations.len(),
            deviations_missed: deviations.iter().filter(missed).count(),
        }
    }
}

/// For each frame, the task that was being flown. It is known only after the flight.
struct FlownTasks<'a> {
    frames: &'a [Frame],
    paths: ReferencePaths,
    on_path: OnPath,
    /// For each frame, the last task entered.
    entered: Vec<Option<usize>>,
    /// For each task, the last frame of the last visit that covered new parts of its path.
    last_useful: Vec<Option<usize>>,
}

impl<'a> FlownTasks<'a> {
    fn new(frames: &'a [Frame], scenario: &Scenario) -> Self {
        let paths = ReferencePaths::new(scenario);
        let on_path = OnPath::measure(&paths, frames.iter().map(|frame| frame.position_m));
        let mut last = None;
        let entered = on_path.task.iter().map(|on| {
            last = on.map(|(task, _)| task).or(last);
            last
        });
        let entered = entered.collect();
        let gap = (VISIT_MERGE_GAP_S * scenario.scoring.frame_rate_hz) as usize;
        let last_useful = (0..paths.len()).map(|task| last_useful_frame(&paths, &on_path, task, gap)).collect();
        Self { frames, paths, on_path, entered, last_useful }
    }

    /// Returns whether the last task entered was still being flown: the drone later covers more of its path, or is in
    /// the last visit that did.
    fn is_flown(&self, i: usize) -> bool {
        self.entered[i].is_some_and(|task| self.last_useful[task].is_some_and(|last| i <= last))
    }

    fn is_in_task(&self, time: SimTime) -> bool {
        let i = self.frames.partition_point(|frame| frame.time < time).min(self.frames.len() - 1);
        self.is_flown(i)
    }

    /// Returns the deviations from the path of the task that was being flown: the intervals from leaving the path to
    /// returning to a path, in which the drone was within `max_m` of it for more than three seconds in total.
    fn deviations(&self, max_m: f64) -> Vec<(SimTime, SimTime)> {
        let is_near = |i: usize, task: usize| {
            self.paths.nearest(task, self.frames[i].position_m).is_some_and(|near| near.distance_m <= max_m)
        };
        let mut out = Vec::new();
        // First frame off the path, and time near it.
        let mut since: Option<(usize, SimTime)> = None;
        for i in 0..self.frames.len() {
            let flown = self.entered[i].filter(|_| self.on_path.task[i].is_none() && self.is_flown(i));
            if let Some(task) = flown {
                let (_, near) = since.get_or_insert((i, SimTime::ZERO));
                if is_near(i, task) {
                    let next = self.frames.get(i + 1).unwrap_or(&self.frames[i]);
                    *near += next.time - self.frames[i].time;
                }
            } else if let Some((from, _)) = since.take().filter(|(_, near)| near.s() > MIN_DEVIATION_S) {
                out.push((self.frames[from].time, self.frames[i].time));
            }
        }
        out
    }
}

/// Returns the last frame of the last visit that covered new parts of the path. On-path intervals less than `gap` frames
/// apart are one visit.
fn last_useful_frame(paths: &ReferencePaths, on_path: &OnPath, task: usize, gap: usize) -> Option<usize> {
    let mut flown = FlownPath::of_task(paths, task);
    let (mut covered, mut last, mut useful) = (0, None, None);
    for (i, on) in on_path.task.iter().enumerate() {
        let point = on.and_then(|(t, point)| (t == task).then_some(point));
        flown.add_frame(point, paths.frame_duration(i));
        if point.is_none() {
            continue;
        }
        let now = flown.points().iter().filter(|covered| **covered).count();
        let same_visit = last.is_some_and(|last| i - last < gap) && useful == last;
        if now > covered || same_visit {
            useful = Some(i);
        }
        (covered, last) = (now, Some(i));
    }
    useful
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn exact_intervals_and_texts_come_from_the_events() {
        let mut log = CueLog::default();
        for event in [
            json!({ "t_s": 1.0, "event": "cues", "cues": cue::OFF_PATH }),
            json!({ "t_s": 1.0, "event": "text", "text": "Off path 3.4 m: left and up" }),
            json!({ "t_s": 2.0, "event": "cues", "cues": cue::OFF_PATH | cue::CRASH }),
            json!({ "t_s": 3.0, "event": "cues", "cues": cue::CRASH }),
            json!({ "t_s": 4.0, "event": "note", "text": "Crash: only a note" }),
            json!({ "t_s": 5.0, "event": "text", "text": "Session over: 300 points, certified" }),
            json!({ "t_s": 6.0, "event": "cues", "cues": cue::OFF_PATH }),
        ] {
            log.add_event(&event);
        }
        let at = SimTime::from_s;
        assert_eq!(log.intervals(cue::OFF_PATH, at(8.0)), [(at(1.0), at(3.0)), (at(6.0), at(8.0))]);
        assert_eq!(log.intervals(cue::OFF_PATH, at(2.5)), [(at(1.0), at(2.5))]);
        assert_eq!(log.intervals(cue::OFF_PATH | cue::CRASH, at(8.0)), [(at(1.0), at(8.0))]);
        assert_eq!(log.texts, [at(1.0)]);
    }
}
