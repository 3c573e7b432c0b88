//! Feedback given during the session, reconstructed by replaying the telemetry log through the monitor, and the trainee's stick
//! reactions.

use super::context::ReviewContext;
use super::task_proximity::TaskProximityStep;
use spandrel_mavlink::contract::cue;
use spandrel_mavlink::telemetry::log_stream::TelemetryLog;
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::sidecar::build_site;
use spandrel_monitor::{Monitor, MonitorConfig, SessionOutput};
use spandrel_text::{Language, text};
use std::ops::ControlFlow;

/// Minimum stick movement after the cue that counts as a reaction, full travel = 1 (estimate: larger than hand tremor,
/// smaller than any deliberate correction).
const MIN_STICK_CHANGE: f64 = 0.1;
/// Maximum reaction time, s. Later movements do not count as a reaction to the cue (estimate).
const MAX_REACTION_S: f64 = 5.0;

/// The cues in display order.
pub const KINDS: [CueKind; 7] = [
    CueKind { bit: cue::CRASH, name: "crash", expects_reaction: true },
    CueKind { bit: cue::TOO_CLOSE, name: "too close", expects_reaction: true },
    CueKind { bit: cue::SPEEDING, name: "speeding", expects_reaction: true },
    CueKind { bit: cue::STAND_OFF, name: "stand-off", expects_reaction: true },
    CueKind { bit: cue::OFF_PATH, name: "off path", expects_reaction: true },
    CueKind { bit: cue::BATTERY_YELLOW, name: "battery yellow", expects_reaction: false },
    CueKind { bit: cue::BATTERY_RED, name: "battery red", expects_reaction: false },
];

/// A kind of cue that the monitor raises.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CueKind {
    /// The cue's bit in the `cues` value.
    pub bit: i32,
    /// Name that identifies the kind.
    pub name: &'static str,
    /// Whether a stick reaction is expected.
    pub expects_reaction: bool,
}

impl CueKind {
    /// Returns the name shown in the report.
    #[must_use]
    pub fn label(&self, language: Language) -> String {
        match self.bit {
            cue::CRASH => text!(language, "report-cue-crash"),
            cue::TOO_CLOSE => text!(language, "report-cue-too-close"),
            cue::SPEEDING => text!(language, "report-cue-speeding"),
            cue::STAND_OFF => text!(language, "report-cue-stand-off"),
            cue::OFF_PATH => text!(language, "report-cue-off-path"),
            cue::BATTERY_YELLOW => text!(language, "report-cue-battery-yellow"),
            cue::BATTERY_RED => text!(language, "report-cue-battery-red"),
            _ => self.name.to_owned(),
        }
    }
}

/// An interval during which a cue was on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CueEpisode {
    /// Index into [`KINDS`].
    pub kind: usize,
    /// Start, s since lift-off.
    pub from_s: f64,
    /// End, s since lift-off.
    pub to_s: f64,
    /// Time from cue onset to the first stick movement, s; `None` without a timely reaction.
    pub reaction_s: Option<f64>,
    /// Index of the task being flown.
    pub task: Option<usize>,
}

/// Feedback given during a session.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SessionFeedback {
    /// Cues in order of onset.
    pub episodes: Vec<CueEpisode>,
    /// Messages and their times, s since lift-off.
    pub texts: Vec<(f64, String)>,
    /// The instructor's notes and their times, s since lift-off; negative before lift-off. Trainees don't see them in
    /// flight.
    pub notes: Vec<(f64, String)>,
}

/// Collects the feedback from the monitor's events.
#[must_use]
pub fn collect_feedback(events: Vec<TimedEvent>, scene: &ReviewContext<'_>, track: &[TaskProximityStep]) -> SessionFeedback {
    let (Some(first), Some(last)) = (scene.frames.first(), scene.frames.last()) else { return SessionFeedback::default() };
    let end_s = (last.time - first.time).s();
    let mut said = SessionFeedback::default();
    let mut open: [Option<f64>; KINDS.len()] = [None; KINDS.len()];
    for (time_s, event) in events {
        let t_s = time_s - first.time.s();
        if let Some(note) = event["text"].as_str().filter(|_| event["event"] == "note") {
            said.notes.push((t_s, note.to_owned()));
            continue;
        }
        if !(0.0..=end_s).contains(&t_s) {
            continue;
        }
        if let Some(text) = event["text"].as_str() {
            said.texts.push((t_s, text.to_owned()));
        }
        let Some(mask) = event["cues"].as_i64() else { continue };
        for (kind, since) in open.iter_mut().enumerate() {
            let on = mask & i64::from(KINDS[kind].bit) != 0;
            match *since {
                None if on => *since = Some(t_s),
                Some(from_s) if !on => {
                    said.episodes.push(episode(kind, (from_s, t_s), scene, track));
                    *since = None;
                }
                None | Some(_) => {}
            }
        }
    }
    for (kind, since) in open.iter().enumerate() {
        said.episodes.extend(since.map(|from_s| episode(kind, (from_s, end_s), scene, track)));
    }
    said.episodes.sort_by(|a, b| a.from_s.total_cmp(&b.from_s).then(a.kind.cmp(&b.kind)));
    said
}

/// Simulation time, s, and content of one `events.jsonl` line.
pub type TimedEvent = (f64, serde_json::Value);

/// Replays a log through the monitor and returns its events.
///
/// # Errors
/// Fails if the log cannot be read.
pub fn events(log: &(impl TelemetryLog + ?Sized), scenario: &Scenario, vehicle: &Vehicle) -> std::io::Result<Vec<TimedEvent>> {
    let mut monitor = Monitor::new(MonitorConfig {
        scenario: scenario.clone(),
        vehicle: vehicle.clone(),
        trainee: String::new(),
        purpose: None,
        started_unix_us: 0,
        system_id: 1,
        seed: None,
        survey_builder: build_site,
    });
    let mut events = Vec::new();
    log.for_each_record(&mut |record| {
        monitor.handle_datagram(record.frame);
        while monitor.poll_transmit().is_some() {}
        while let Some(record) = monitor.poll_record() {
            if let SessionOutput::Event(line) = record
                && let Ok(event) = serde_json::from_str::<serde_json::Value>(&line)
                && let Some(t_s) = event["t_s"].as_f64()
            {
                events.push((t_s, event));
            }
        }
        if monitor.finished().is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    Ok(events)
}

fn episode(kind: usize, (from_s, to_s): (f64, f64), scene: &ReviewContext<'_>, track: &[TaskProximityStep]) -> CueEpisode {
    let first = scene.frames[0].time;
    let onset = first + SimTime::from_s(from_s);
    let at = scene.frames.partition_point(|frame| frame.time < onset).min(scene.frames.len() - 1);
    let before = scene.frames[at].sticks;
    let until = onset + SimTime::from_s(MAX_REACTION_S);
    let moved = |sticks: [f64; 4]| sticks.iter().zip(before).any(|(now, then)| (now - then).abs() >= MIN_STICK_CHANGE);
    let answer = scene.frames[at..].iter().take_while(|frame| frame.time <= until).find(|frame| moved(frame.sticks));
    CueEpisode {
        kind,
        from_s,
        to_s,
        reaction_s: answer.filter(|_| KINDS[kind].expects_reaction).map(|frame| (frame.time - onset).s().max(0.0)),
        task: track.get(at).filter(|step| step.inside).and_then(|step| step.task),
    }
}

/// Returns the median of a list; `None` if it is empty.
#[must_use]
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = *values.get(middle)?;
    Some(if values.len() % 2 == 1 { upper } else { 0.5 * (values[middle - 1] + upper) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_every_kind_has_a_label() {
        for kind in KINDS {
            assert_eq!(kind.label(Language::English), kind.name);
            assert_ne!(kind.label(Language::German), kind.name);
        }
    }

    #[test]
    fn exact_median_handles_odd_even_and_empty_lists() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(Vec::new()), None);
    }
}
