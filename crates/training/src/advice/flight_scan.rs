//! The flight, prepared for finding the moments that show a mistake.

use crate::record::{NearPath, SessionRecord, near_frames};
use spandrel_mavlink::telemetry::{Flight, Frame};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;
use spandrel_monitor::AssessedSession;
use spandrel_monitor::measures::on_path::{OnPath, ReferencePaths};
use spandrel_text::Language;

/// Gaps shorter than this don't split a stretch, s (estimate: a trainee perceives both parts as one mistake).
const MERGE_GAP_S: f64 = 1.0;

/// A session, from which advice is computed.
#[derive(Debug, Clone, Copy)]
pub struct FlightEvidence<'a> {
    /// The session's scenario.
    pub scenario: &'a Scenario,
    /// Aircraft flown in the session.
    pub vehicle: &'a Vehicle,
    /// The flight's telemetry.
    pub flight: &'a Flight,
    /// The session's assessment and frames.
    pub assessed_session: &'a AssessedSession,
    /// The session's record.
    pub record: &'a SessionRecord,
    /// How close the flight came to each missed defect.
    pub missed: &'a [MissedDefect],
}

/// How close the flight came to a picture of a missed defect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MissedDefect {
    /// Defect number, from 1.
    pub id: u32,
    /// Time of the best view or else of the closest approach, s since lift-off.
    pub t_s: f64,
    /// Time during which a picture would have shown it, s.
    pub in_view_s: f64,
    /// Minimum distance between drone and defect, m.
    pub nearest_m: f64,
}

/// Frames in which a mistake was made.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretches {
    /// Number of frames.
    pub frames: usize,
    /// Their total time, s.
    pub total_s: f64,
    /// Number of stretches.
    pub count: usize,
    /// Index of the first frame of the longest stretch.
    pub longest: usize,
}

/// The flight with its position relative to the paths.
pub(super) struct FlightScan<'a> {
    pub evidence: &'a FlightEvidence<'a>,
    pub paths: ReferencePaths,
    pub on_path: OnPath,
    /// Path that each frame counts for.
    pub near: Vec<Option<NearPath>>,
    /// Language of the sentences.
    pub language: Language,
}

impl<'a> FlightScan<'a> {
    /// Prepares a flight for sentences in English.
    pub(super) fn new(evidence: &'a FlightEvidence<'a>) -> Self {
        let (scenario, frames) = (evidence.scenario, &evidence.assessed_session.frames);
        let paths = ReferencePaths::new(scenario);
        let on_path = OnPath::measure(&paths, frames.iter().map(|frame| frame.position_m));
        let near = near_frames(scenario, frames, &paths, &on_path);
        Self { evidence, paths, on_path, near, language: Language::English }
    }

    pub(super) fn frames(&self) -> &'a [Frame] {
        &self.evidence.assessed_session.frames
    }

    pub(super) fn last_frame(&self) -> usize {
        self.frames().len().saturating_sub(1)
    }

    /// Returns a frame's time since lift-off, s.
    pub(super) fn t_s(&self, frame: usize) -> f64 {
        let frames = self.frames();
        frames.first().zip(frames.get(frame)).map_or(0.0, |(first, frame)| (frame.time - first.time).s())
    }

    /// Returns the index of the frame at a time since lift-off in seconds.
    pub(super) fn frame_at(&self, t_s: f64) -> usize {
        let frame = t_s.max(0.0) * self.rate_hz();
        (frame.round() as usize).min(self.last_frame())
    }

    pub(super) fn rate_hz(&self) -> f64 {
        self.evidence.scenario.scoring.frame_rate_hz
    }

    /// Returns the index in the scenario of each task with one of the given numbers.
    pub(super) fn task_indices(&self, ids: &[u32]) -> Vec<usize> {
        let tasks = self.evidence.scenario.tasks.iter().enumerate();
        tasks.filter(|(_, task)| ids.contains(&task.id)).map(|(index, _)| index).collect()
    }

    /// Returns the path that a frame counts for, if it is that of one of the tasks.
    pub(super) fn near(&self, frame: usize, tasks: &[usize]) -> Option<NearPath> {
        self.near[frame].filter(|near| tasks.contains(&near.task))
    }

    /// Returns the vector from a task's path to the drone in meters if the frame is in the task's window, but not on a path.
    pub(super) fn off_path_m(&self, frame: usize, tasks: &[usize]) -> Option<Vec3<Enu>> {
        let is_inside = |task: &usize| self.on_path.windows[*task].is_some_and(|window| window.contains(frame));
        let task = tasks.iter().copied().find(is_inside).filter(|_| self.on_path.task[frame].is_none())?;
        let position_m = self.frames()[frame].position_m;
        self.paths.path(task).closest_position(position_m).map(|foot_m| position_m - foot_m)
    }

    /// Returns the stretches of frames that satisfy a condition; `None` if no frame does.
    pub(super) fn stretches(&self, holds: impl Fn(usize) -> bool) -> Option<Stretches> {
        let gap = (MERGE_GAP_S * self.rate_hz()) as usize;
        let (mut frames, mut count) = (0, 0);
        let (mut open, mut longest): (Option<(usize, usize)>, (usize, usize)) = (None, (0, 0));
        for frame in (0..self.frames().len()).filter(|frame| holds(*frame)) {
            let from = open.filter(|(_, last)| frame - last <= gap).map(|(from, _)| from);
            count += usize::from(from.is_none());
            frames += 1;
            let from = from.unwrap_or(frame);
            open = Some((from, frame));
            if frames == 1 || frame - from > longest.1 {
                longest = (from, frame - from);
            }
        }
        (frames > 0).then(|| Stretches { frames, total_s: frames as f64 / self.rate_hz(), count, longest: longest.0 })
    }
}
