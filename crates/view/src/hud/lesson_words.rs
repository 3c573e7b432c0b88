//! The steps of a lesson, and of a job, in words.

use super::style::DisplayUnits;
use spandrel_mavlink::contract::guidance::GuidanceStep;
use spandrel_mavlink::contract::lesson::{LessonStatus, LessonTask};
use spandrel_text::{Language, message_id, text};

/// Returns how a step is done. `key` returns the name of a binding's key.
#[must_use]
pub fn how_to(task: LessonTask, language: Language, key: &dyn Fn(&str) -> String) -> String {
    let id = match task {
        LessonTask::Arm => message_id!("flight-how-arm"),
        LessonTask::TakeOff => message_id!("flight-how-take-off"),
        LessonTask::Hover => message_id!("flight-how-hover"),
        LessonTask::Turn => message_id!("flight-how-turn"),
        LessonTask::FlyPath => message_id!("flight-how-fly-path"),
        LessonTask::StopAt => message_id!("flight-how-stop-at"),
        LessonTask::TiltCamera => message_id!("flight-how-tilt-camera"),
        LessonTask::Lamp => message_id!("flight-how-lamp"),
        LessonTask::Photograph => message_id!("flight-how-photograph"),
        LessonTask::FlyHome => message_id!("flight-how-fly-home"),
        LessonTask::Land => message_id!("flight-how-land"),
        LessonTask::Done => message_id!("flight-how-done"),
    };
    id.fill(language, key)
}

/// Returns how a step of a job is done, where it isn't flying; otherwise empty. `key` returns the name of a binding's key.
#[must_use]
pub fn step_how_to(step: GuidanceStep, language: Language, key: &dyn Fn(&str) -> String) -> String {
    match step {
        GuidanceStep::TakeOff => message_id!("flight-how-start").fill(language, key),
        GuidanceStep::Land => message_id!("flight-how-land").fill(language, key),
        GuidanceStep::FlyToTask
        | GuidanceStep::FollowPath
        | GuidanceStep::HoldPosition
        | GuidanceStep::FlyHome
        | GuidanceStep::Over => String::new(),
    }
}

/// Returns what the trainee does in a step.
#[must_use]
pub fn instruction(status: &LessonStatus, units: DisplayUnits, language: Language) -> String {
    let target = status.target.unwrap_or_default();
    let height = || units.length(target.round(), 0);
    let time = || format!("{target:.0} s");
    let angle = || format!("{:.0}°", target.abs().to_degrees());
    match status.task {
        LessonTask::Arm => text!(language, "flight-lesson-arm"),
        LessonTask::TakeOff => text!(language, "flight-lesson-take-off", height = height()),
        LessonTask::Hover => text!(language, "flight-lesson-hover", time = time()),
        LessonTask::Turn => text!(language, "flight-lesson-turn", angle = angle()),
        LessonTask::FlyPath => text!(language, "flight-lesson-fly-path"),
        LessonTask::StopAt => text!(language, "flight-lesson-stop-at", time = time()),
        LessonTask::TiltCamera if target < 0.0 => text!(language, "flight-lesson-tilt-down", angle = angle()),
        LessonTask::TiltCamera => text!(language, "flight-lesson-tilt-up", angle = angle()),
        LessonTask::Lamp => text!(language, "flight-lesson-lamp"),
        LessonTask::Photograph => text!(language, "flight-lesson-photograph"),
        LessonTask::FlyHome => text!(language, "flight-lesson-fly-home"),
        LessonTask::Land => text!(language, "flight-lesson-land"),
        LessonTask::Done => text!(language, "flight-lesson-done"),
    }
}

/// Returns the number of the step.
pub(super) fn title(status: &LessonStatus, language: Language) -> String {
    if status.is_done() {
        text!(language, "flight-lesson-complete")
    } else {
        text!(language, "flight-lesson-step", step = status.step, steps = status.steps)
    }
}
