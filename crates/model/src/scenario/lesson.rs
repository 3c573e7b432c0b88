//! A lesson: a list of steps that are done one after the other. Reads the steps from a scenario file.

use super::point::point;
use crate::frames::{Enu, Vec3};
use crate::time::SimTime;
use crate::toml::{Reader, Section};

/// Maximum number of steps (estimate: more take longer than one battery).
const MAX_STEPS: usize = 60;
/// Default distance from a place at which the aircraft counts as being there, m (estimate: a beginner's position error).
const DEFAULT_RADIUS_M: f64 = 2.0;

/// A step of a lesson.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LessonStep {
    /// Arm the motors.
    Arm,
    /// Climb to a height above the pad.
    TakeOff {
        /// Height above the pad, m.
        height_m: f64,
    },
    /// Stay near a place for some time.
    Hover(LessonPlace),
    /// Turn around the vertical axis.
    Turn {
        /// Angle from the heading at the beginning of the step, rad.
        angle_rad: f64,
    },
    /// Fly the path of a task.
    FlyPath {
        /// Number of the task.
        task: u32,
    },
    /// Fly to a place and stop there.
    StopAt(LessonPlace),
    /// Tilt the camera.
    TiltCamera {
        /// Pitch of the camera, rad, up positive.
        pitch_rad: f64,
    },
    /// Turn the lamp on.
    Lamp,
    /// Take a picture that shows a defect.
    Photograph,
    /// Fly back to the pad.
    FlyHome,
    /// Land on the pad.
    Land,
}

/// A place, and how long the aircraft must stay there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LessonPlace {
    /// Position, ENU, m.
    pub position_m: Vec3<Enu>,
    /// Distance at which the aircraft counts as being there, m.
    pub radius_m: f64,
    /// Time for which it must stay.
    pub duration: SimTime,
}

impl LessonStep {
    /// Returns the place of the step, if it has one.
    #[must_use]
    pub fn place(&self) -> Option<&LessonPlace> {
        match self {
            Self::Hover(place) | Self::StopAt(place) => Some(place),
            Self::Arm
            | Self::TakeOff { .. }
            | Self::Turn { .. }
            | Self::FlyPath { .. }
            | Self::TiltCamera { .. }
            | Self::Lamp
            | Self::Photograph
            | Self::FlyHome
            | Self::Land => None,
        }
    }
}

/// Number of tasks of a job, and the largest number that a job may have.
pub(super) type TaskCount = (usize, usize);

/// Reads the other keys of a step.
type StepReader = fn(&mut Reader, &mut Section, TaskCount) -> LessonStep;

const STEP_KINDS: [(&str, StepReader); 11] = [
    ("arm", |_, _, _| LessonStep::Arm),
    ("take_off", |r, s, _| LessonStep::TakeOff { height_m: r.number(s, "height_m", (0.5, 100.0), Some(2.0)) }),
    ("hover", |r, s, _| LessonStep::Hover(read_place(r, s, 10.0))),
    ("turn", |r, s, _| LessonStep::Turn { angle_rad: r.number(s, "angle_deg", (10.0, 180.0), Some(90.0)).to_radians() }),
    ("fly_path", read_path),
    ("stop_at", |r, s, _| LessonStep::StopAt(read_place(r, s, 3.0))),
    ("tilt_camera", |r, s, _| LessonStep::TiltCamera {
        pitch_rad: r.number(s, "pitch_deg", (-80.0, 80.0), Some(20.0)).to_radians(),
    }),
    ("lamp", |_, _, _| LessonStep::Lamp),
    ("photograph", |_, _, _| LessonStep::Photograph),
    ("fly_home", |_, _, _| LessonStep::FlyHome),
    ("land", |_, _, _| LessonStep::Land),
];

/// Reads the steps of a job; empty if the job is not a lesson.
pub(super) fn read(r: &mut Reader, root: &mut Section, tasks: TaskCount, has_defects: bool) -> Vec<LessonStep> {
    let mut steps = Vec::new();
    for mut s in r.sections(root, "lesson") {
        let read = r.keyword(&mut s, "step", &STEP_KINDS, None);
        let step = read(r, &mut s, tasks);
        if step == LessonStep::Photograph && !has_defects {
            r.add_problem(&s, "step", "photograph", "a job with defects", "nothing to photograph");
        }
        steps.push(step);
        r.finish(&s);
    }
    // A landing on the pad ends the session.
    if let Some(early) = steps.iter().rev().skip(1).position(|step| *step == LessonStep::Land) {
        let number = steps.len() - 1 - early;
        r.add_problem(root, "lesson", &format!("step {number}: land"), "land as the last step only", "steps after the landing");
    }
    if steps.len() > MAX_STEPS {
        r.add_problem(root, "lesson", &steps.len().to_string(), "at most 60 [[lesson]]", "too many");
    }
    steps
}

fn read_path(r: &mut Reader, s: &mut Section, (tasks, most): TaskCount) -> LessonStep {
    let task = r.integer(s, "task", (1, i64::try_from(most).unwrap_or(i64::MAX)), Some(1)) as u32;
    if task as usize > tasks.max(1) {
        r.add_problem(s, "task", &task.to_string(), &format!("at most {tasks}, the number of tasks"), "no such task");
    }
    LessonStep::FlyPath { task }
}

fn read_place(r: &mut Reader, s: &mut Section, duration_s: f64) -> LessonPlace {
    let duration_s = r.number(s, "duration_s", (0.0, 120.0), Some(duration_s));
    r.describe_default(s, "duration_s", "10; for stop_at, 3");
    LessonPlace {
        position_m: point(r, s, "position_m", None),
        radius_m: r.number(s, "radius_m", (0.5, 20.0), Some(DEFAULT_RADIUS_M)),
        duration: SimTime::from_ms((1_000.0 * duration_s).round() as i64),
    }
}
