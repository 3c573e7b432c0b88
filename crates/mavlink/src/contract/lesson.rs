//! The current step of a lesson, for displays and ground stations.
//!
//! DEBUG_FLOAT_ARRAY with the name `lesson`. NaN stands for a value that does not exist in this step. The layout only grows at
//! its end.

use super::float_array::{self, FloatArray, optional};
use super::guidance::WayTo;
use crate::dialect::MavMessage;
use spandrel_model::math;
use spandrel_model::time::SimTime;

/// Name in the message.
pub const NAME: &str = "lesson";
/// Age at which a step that was not repeated is out of date; the monitor repeats it at 5 Hz.
pub const TIMEOUT: SimTime = SimTime::from_ms(1_500);
/// Words at the start of each text about a lesson.
pub const TEXT_PREFIX: &str = "Lesson: ";

/// The action that a step of a lesson requires.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LessonTask {
    /// Arm the motors.
    Arm,
    /// Climb.
    TakeOff,
    /// Stay in a ring.
    Hover,
    /// Turn around the vertical axis.
    Turn,
    /// Fly the path of a task.
    FlyPath,
    /// Fly to a place and stop there.
    StopAt,
    /// Tilt the camera.
    TiltCamera,
    /// Turn the lamp on.
    Lamp,
    /// Take a picture that shows a defect.
    Photograph,
    /// Fly back to the pad.
    FlyHome,
    /// Land on the pad.
    Land,
    /// All steps are done.
    Done,
}

impl LessonTask {
    /// All tasks, in the order of their codes.
    pub const ALL: [Self; 12] = [
        Self::Arm,
        Self::TakeOff,
        Self::Hover,
        Self::Turn,
        Self::FlyPath,
        Self::StopAt,
        Self::TiltCamera,
        Self::Lamp,
        Self::Photograph,
        Self::FlyHome,
        Self::Land,
        Self::Done,
    ];

    fn code(self) -> f32 {
        match self {
            Self::Arm => 0.0,
            Self::TakeOff => 1.0,
            Self::Hover => 2.0,
            Self::Turn => 3.0,
            Self::FlyPath => 4.0,
            Self::StopAt => 5.0,
            Self::TiltCamera => 6.0,
            Self::Lamp => 7.0,
            Self::Photograph => 8.0,
            Self::FlyHome => 9.0,
            Self::Land => 10.0,
            Self::Done => 11.0,
        }
    }

    fn from_code(code: f32) -> Option<Self> {
        Self::ALL.into_iter().find(|task| task.code().to_bits() == code.to_bits())
    }
}

/// The current step of a lesson.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LessonStatus {
    /// Required action.
    pub task: LessonTask,
    /// Number of the step, from 1; greater than the number of steps once all are done.
    pub step: u32,
    /// Number of steps.
    pub steps: u32,
    /// How much of the step is done, 0 to 1.
    pub progress: f64,
    /// The way to the place of the step, if it has one.
    pub way: Option<WayTo>,
    /// Distance from the place at which the aircraft counts as being there, m.
    pub radius_m: Option<f64>,
    /// Target value: height, m; duration, s; angle, rad.
    pub target: Option<f64>,
}

impl LessonStatus {
    /// Encodes the message. `time_us` is the simulation time, µs.
    #[must_use]
    pub fn message(&self, time_us: u64) -> MavMessage {
        let values = [
            self.task.code(),
            self.step as f32,
            self.steps as f32,
            self.progress as f32,
            optional(self.way.map(|way| way.distance_m)),
            optional(self.way.map(|way| way.bearing_rad)),
            optional(self.way.map(|way| way.up_m)),
            optional(self.radius_m),
            optional(self.target),
        ];
        float_array::message(NAME, time_us, values)
    }

    /// Decodes a message; `None` for other messages and for values that are out of range.
    #[must_use]
    pub fn from_message(message: &MavMessage) -> Option<Self> {
        let array = FloatArray::named(NAME, message)?;
        Some(Self {
            task: LessonTask::from_code(array.raw(0))?,
            step: array.count(1)?,
            steps: array.count(2)?,
            progress: array.finite(3)?.clamp(0.0, 1.0),
            way: array.triple(4).map(WayTo::from_values),
            radius_m: array.finite(7),
            target: array.finite(8),
        })
    }

    /// Returns whether all steps are done.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.task == LessonTask::Done
    }

    /// Returns what the trainee does in this step, such as "take off to 2 m".
    #[must_use]
    pub fn instruction(&self) -> String {
        let target = self.target.unwrap_or_default();
        match self.task {
            LessonTask::Arm => "arm the motors".to_owned(),
            LessonTask::TakeOff => format!("take off to {target:.0} m"),
            LessonTask::Hover => format!("hover in the ring for {target:.0} s"),
            LessonTask::Turn => format!("turn by {:.0} deg", target.to_degrees()),
            LessonTask::FlyPath => "fly along the path".to_owned(),
            LessonTask::StopAt => format!("stop in the ring for {target:.0} s"),
            LessonTask::TiltCamera if target < 0.0 => format!("tilt the camera down {:.0} deg", -target.to_degrees()),
            LessonTask::TiltCamera => format!("tilt the camera up {:.0} deg", target.to_degrees()),
            LessonTask::Lamp => "turn the lamp on".to_owned(),
            LessonTask::Photograph => "photograph a defect".to_owned(),
            LessonTask::FlyHome => "fly back to the pad".to_owned(),
            LessonTask::Land => "land on the pad".to_owned(),
            LessonTask::Done => "all steps done".to_owned(),
        }
    }

    /// Returns the step in words for a STATUSTEXT message (at most 50 characters), such as
    /// "Lesson: 2/11 take off to 2 m".
    #[must_use]
    pub fn words(&self) -> String {
        self.numbered(&self.instruction())
    }

    /// Returns the way to the place of the step in words for a STATUSTEXT message (at most 50 characters), such as
    /// "Lesson: 3/11 12 m, 30 deg left, 3 m up"; `None` without such a place, or within its radius.
    #[must_use]
    pub fn way_words(&self) -> Option<String> {
        let is_there = |way: &WayTo| math::hypot(way.distance_m, way.up_m) <= self.radius_m.unwrap_or_default();
        self.way.filter(|way| !is_there(way)).map(|way| self.numbered(&way.words()))
    }

    fn numbered(&self, words: &str) -> String {
        let number = if self.is_done() { String::new() } else { format!("{}/{} ", self.step, self.steps) };
        format!("{TEXT_PREFIX}{number}{words}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::{Decoder, Encoder};
    use crate::contract::guidance::Guidance;

    fn status(task: LessonTask) -> LessonStatus {
        let way = Some(WayTo { distance_m: 12.5, bearing_rad: -0.25, up_m: 3.0 });
        LessonStatus { task, step: 3, steps: 11, progress: 0.5, way, radius_m: Some(2.0), target: Some(10.0) }
    }

    #[test]
    fn wire_lesson_survives_the_link() {
        for task in LessonTask::ALL {
            for sent in [status(task), LessonStatus { way: None, radius_m: None, target: None, ..status(task) }] {
                let bytes = Encoder::new(1, 191).encode(&sent.message(5_000_000));
                let received = Decoder::new().datagram(&bytes).remove(0).message.unwrap();
                assert_eq!(LessonStatus::from_message(&received), Some(sent));
                assert_eq!(Guidance::of(&received), None);
                assert!(sent.words().len() <= 50, "{}", sent.words());
            }
        }
    }

    #[test]
    fn exact_values_out_of_range_are_no_lesson() {
        let MavMessage::DEBUG_FLOAT_ARRAY(array) = status(LessonTask::Turn).message(0) else { panic!("another message") };
        for (index, value) in [(0, 12.0), (0, 0.5), (0, f32::NAN), (1, -1.0), (2, f32::INFINITY), (3, f32::NAN)] {
            let mut bad = array.clone();
            bad.data[index] = value;
            assert_eq!(LessonStatus::from_message(&MavMessage::DEBUG_FLOAT_ARRAY(bad)), None, "{index}: {value}");
        }
    }

    #[test]
    fn exact_texts_name_step_and_goal() {
        let words = |task, target: f64| LessonStatus { target: Some(target), ..status(task) }.words();
        assert_eq!(words(LessonTask::TakeOff, 2.0), "Lesson: 3/11 take off to 2 m");
        assert_eq!(words(LessonTask::Turn, std::f64::consts::FRAC_PI_2), "Lesson: 3/11 turn by 90 deg");
        assert_eq!(words(LessonTask::TiltCamera, -0.5), "Lesson: 3/11 tilt the camera down 29 deg");
        assert_eq!(words(LessonTask::Done, 0.0), "Lesson: all steps done");
        assert_eq!(status(LessonTask::Hover).way_words().as_deref(), Some("Lesson: 3/11 12 m, 14 deg left, 3 m up"));
        assert_eq!(LessonStatus { radius_m: Some(13.0), ..status(LessonTask::Hover) }.way_words(), None, "it is there");
        let far = WayTo { distance_m: 9_999.0, bearing_rad: 3.0, up_m: -999.0 };
        let longest = LessonStatus { way: Some(far), step: 99, steps: 99, ..status(LessonTask::StopAt) }.way_words().unwrap();
        assert!(longest.len() <= 50, "{longest}");
    }
}
