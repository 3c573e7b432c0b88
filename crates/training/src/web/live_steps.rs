//! The next step of a flight in progress, in all languages.

use serde_json::{Map, Value};
use spandrel_mavlink::contract::guidance::{Detour, DetourKind, Guidance, GuidanceStep, TurnTo, WayTo};
use spandrel_text::{Language, text};

/// Returns the step in each language, by the language's tag.
pub(super) fn step_texts(guidance: &Guidance) -> Value {
    let texts = Language::ALL.map(|language| (language.tag().to_owned(), step_text(language, guidance).into()));
    Value::Object(Map::from_iter(texts))
}

fn step_text(language: Language, guidance: &Guidance) -> String {
    let way = match &guidance.detour {
        Some(detour) => Some(detour_text(language, detour)),
        None => guidance.way.map(|way| way_text(language, &way)),
    };
    let of_task = |step: String| match guidance.task {
        Some(task) => text!(language, "live-step-of-task", task = task, step = step),
        None => step,
    };
    match (guidance.step, way) {
        (GuidanceStep::TakeOff, _) => text!(language, "live-step-take-off"),
        (GuidanceStep::FlyToTask, Some(way)) if guidance.is_return() && guidance.detour.is_none() => match guidance.task {
            Some(task) => text!(language, "flight-message-return", task = task, words = way),
            None => way,
        },
        (GuidanceStep::FlyToTask, Some(way)) => of_task(way),
        (GuidanceStep::FlyToTask, None) => of_task(text!(language, "live-step-fly-to-path")),
        (GuidanceStep::FollowPath, _) => of_task(text!(language, "live-step-follow-path")),
        (GuidanceStep::FlyHome, Some(way)) => text!(language, "live-step-fly-home-way", way = way),
        (GuidanceStep::FlyHome, None) => text!(language, "live-step-fly-home"),
        (GuidanceStep::Land, _) => text!(language, "live-step-land"),
        (GuidanceStep::Over, _) => text!(language, "live-step-over"),
        (GuidanceStep::HoldPosition, _) => of_task(text!(language, "live-step-hold")),
    }
}

/// Returns what leads around an obstacle, and the way there.
fn detour_text(language: Language, detour: &Detour) -> String {
    let first = match detour.kind {
        DetourKind::OutFromUnder => text!(language, "flight-message-out-from-under"),
        DetourKind::Climb => text!(language, "flight-message-climb"),
        DetourKind::Descend => text!(language, "flight-message-descend"),
        DetourKind::Around => text!(language, "flight-message-around"),
    };
    text!(language, "live-step-first-way", first = first, way = way_text(language, &detour.way))
}

fn way_text(language: Language, way: &WayTo) -> String {
    let distance = format!("{:.0}", way.distance_m);
    let angle = |turn_deg: f64| format!("{turn_deg:.0}");
    let horizontal = match way.turn() {
        TurnTo::Ahead => text!(language, "live-way-ahead", distance = distance),
        TurnTo::Behind => text!(language, "live-way-behind", distance = distance),
        TurnTo::Left(turn_deg) => text!(language, "live-way-left", distance = distance, angle = angle(turn_deg)),
        TurnTo::Right(turn_deg) => text!(language, "live-way-right", distance = distance, angle = angle(turn_deg)),
    };
    let Some(up_m) = way.height_m() else { return horizontal };
    let height = format!("{:.0}", up_m.abs());
    if up_m < 0.0 {
        text!(language, "live-way-down", way = horizontal, height = height)
    } else {
        text!(language, "live-way-up", way = horizontal, height = height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEPS: [GuidanceStep; 7] = [
        GuidanceStep::TakeOff,
        GuidanceStep::FlyToTask,
        GuidanceStep::FollowPath,
        GuidanceStep::FlyHome,
        GuidanceStep::Land,
        GuidanceStep::Over,
        GuidanceStep::HoldPosition,
    ];

    fn guidance() -> Guidance {
        Guidance {
            step: GuidanceStep::FlyToTask,
            task: Some(2),
            way: Some(WayTo { distance_m: 140.4, bearing_rad: 0.0, up_m: 0.0 }),
            progress: Some(0.0),
            tasks_done: 1,
            tasks: 4,
            deviation: None,
            stand_off: None,
            flown_s: 75.0,
            needed_s: 480.0,
            detour: None,
        }
    }

    #[test]
    fn regress_the_step_leads_around_an_obstacle_first() {
        for kind in DetourKind::ALL {
            let way = WayTo { distance_m: 12.0, bearing_rad: 0.5, up_m: 3.0 };
            let blocked = Guidance { detour: Some(Detour { kind, way }), ..guidance() };
            assert_eq!(step_text(Language::English, &blocked), format!("{}: {}", blocked.words(), way.words()));
            assert_ne!(step_text(Language::German, &blocked), step_text(Language::English, &blocked));
            let home = Guidance { step: GuidanceStep::FlyHome, task: None, ..blocked };
            assert_eq!(step_text(Language::English, &home), format!("{}: {}", home.words(), way.words()));
        }
    }

    #[test]
    fn exact_english_steps_are_those_of_the_text_messages() {
        let way = |bearing_rad, up_m| Some(WayTo { distance_m: 140.4, bearing_rad, up_m });
        let ways = [None, way(0.01, 0.5), way(-0.5, 12.0), way(0.5, -12.0), way(3.1, 0.0)];
        for (step, way) in STEPS.into_iter().flat_map(|step| ways.map(|way| (step, way))) {
            for (task, progress) in [(None, None), (Some(2), Some(0.0)), (Some(2), Some(0.4))] {
                let guidance = Guidance { step, task, way, progress, ..guidance() };
                assert_eq!(step_text(Language::English, &guidance), guidance.words());
                let german = step_text(Language::German, &guidance);
                assert_ne!(german, guidance.words());
                assert_eq!(step_texts(&guidance)["de"], german);
            }
        }
    }
}
