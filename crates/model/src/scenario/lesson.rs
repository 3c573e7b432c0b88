//! A lesson: a list of steps that are done one after the other. Reads the steps from a scenario file.

use super::point::point;
use crate::frames::{Enu, Vec3};
use crate::time::SimTime;
use crate::toml::{Reader, Section};

/// Maximum number of steps (estimate: more take longer than one battery).
const MAX_STEPS: usize = 60;
/// Default distance from a place at which the aircraft counts as being there, m (estimate: a beginner's position error).
const DEFAULT_RADIUS_M: f64 = 2.0;

/// What a trainee does in a step of a lesson.
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
    /// Tilt the camera up.
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

#[derive(Clone, Copy)]
enum StepKind {
    Arm,
    TakeOff,
    Hover,
    Turn,
    FlyPath,
    StopAt,
    TiltCamera,
    Lamp,
    Photograph,
    FlyHome,
    Land,
}

const STEP_KINDS: [(&str, StepKind); 11] = [
    ("arm", StepKind::Arm),
    ("take_off", StepKind::TakeOff),
    ("hover", StepKind::Hover),
    ("turn", StepKind::Turn),
    ("fly_path", StepKind::FlyPath),
    ("stop_at", StepKind::StopAt),
    ("tilt_camera", StepKind::TiltCamera),
    ("lamp", StepKind::Lamp),
    ("photograph", StepKind::Photograph),
    ("fly_home", StepKind::FlyHome),
    ("land", StepKind::Land),
];

/// Number of tasks of a job, and the largest number that a job may have.
pub(super) type TaskCount = (usize, usize);

/// Reads the steps of a job; empty if the job is not a lesson.
pub(super) fn read(r: &mut Reader, root: &mut Section, tasks: TaskCount, has_defects: bool) -> Vec<LessonStep> {
    let mut steps = Vec::new();
    for mut s in r.sections(root, "lesson") {
        let kind = r.keyword(&mut s, "step", &STEP_KINDS, None);
        steps.push(read_step(r, &mut s, kind, tasks));
        if matches!(kind, StepKind::Photograph) && !has_defects {
            r.add_problem(&s, "step", "photograph", "a job with defects", "nothing to photograph");
        }
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

fn read_step(r: &mut Reader, s: &mut Section, kind: StepKind, (tasks, most): TaskCount) -> LessonStep {
    match kind {
        StepKind::Arm => LessonStep::Arm,
        StepKind::TakeOff => LessonStep::TakeOff { height_m: r.number(s, "height_m", (0.5, 100.0), Some(2.0)) },
        StepKind::Hover => LessonStep::Hover(read_place(r, s, 10.0)),
        StepKind::Turn => LessonStep::Turn { angle_rad: r.number(s, "angle_deg", (10.0, 180.0), Some(90.0)).to_radians() },
        StepKind::FlyPath => {
            let task = r.integer(s, "task", (1, i64::try_from(most).unwrap_or(i64::MAX)), Some(1)) as u32;
            if task as usize > tasks.max(1) {
                r.add_problem(s, "task", &task.to_string(), &format!("at most {tasks}, the number of tasks"), "no such task");
            }
            LessonStep::FlyPath { task }
        }
        StepKind::StopAt => LessonStep::StopAt(read_place(r, s, 3.0)),
        StepKind::TiltCamera => {
            LessonStep::TiltCamera { pitch_rad: r.number(s, "pitch_deg", (-80.0, 80.0), Some(20.0)).to_radians() }
        }
        StepKind::Lamp => LessonStep::Lamp,
        StepKind::Photograph => LessonStep::Photograph,
        StepKind::FlyHome => LessonStep::FlyHome,
        StepKind::Land => LessonStep::Land,
    }
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
