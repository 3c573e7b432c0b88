//! Time during which a bridge or the ground hid the drone from the inspector, who may walk. In the U.S., the pilot or an observer
//! must be able to see the drone throughout the flight (14 CFR 107.31).

use super::formatting;
use super::interval_total::IntervalTotal;
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::Site;
use spandrel_model::site::inspector_walks::Walk;
use spandrel_model::time::SimTime;
use spandrel_text::{Language, text};

/// Time between two checks, s.
const CHECK_INTERVAL_S: f64 = 0.5;
/// Objects this near in front of the drone do not count as hiding it, m (about its size).
const DRONE_CLEARANCE_M: f64 = 0.5;
/// Shortest time that is worth mentioning, s.
const MIN_SHOWN_S: f64 = 1.0;

/// Returns the time during which the drone was out of the inspector's sight, on a site with the walks of the flight.
#[must_use]
pub fn out_of_sight(site: &Site, frames: &[Frame]) -> IntervalTotal {
    let Some(first) = frames.first() else { return IntervalTotal::default() };
    let mut checks: Vec<(f64, bool)> = Vec::new();
    for frame in frames {
        let t_s = (frame.time - first.time).s();
        if checks.last().is_none_or(|(last_s, _)| t_s - last_s >= CHECK_INTERVAL_S) {
            let eye_m = site.inspector().at(frame.time).eye_m();
            checks.push((t_s, is_hidden(site, eye_m, frame.position_m)));
        }
    }
    of_checks(&checks)
}

/// Sums checks: the time of each, s since lift-off, and whether the drone was hidden until the next one.
fn of_checks(checks: &[(f64, bool)]) -> IntervalTotal {
    IntervalTotal::of(checks.windows(2).map(|pair| (pair[0].0, pair[1].0, pair[0].1)))
}

/// Returns the time out of sight as a sentence; `None` if the drone was always in sight.
#[must_use]
pub fn out_of_sight_sentence(hidden: IntervalTotal, language: Language) -> Option<String> {
    (hidden.total_s >= MIN_SHOWN_S).then(|| {
        text!(
            language,
            "report-out-of-sight",
            total = formatting::duration(hidden.total_s),
            longest = formatting::duration(hidden.longest_s),
            from = formatting::clock(hidden.longest_from_s)
        )
    })
}

/// Returns the walks of the inspector that begin before the end of a flight, each with its ends: from, to, m.
pub fn flown_walks<'s>(site: &'s Site, frames: &[Frame]) -> impl Iterator<Item = (&'s Walk, Vec3<Enu>, Vec3<Enu>)> {
    let last = frames.last().map(|frame| frame.time);
    site.inspector().ways_m().filter(move |(walk, ..)| Some(walk.at) < last)
}

/// Returns the walks of the inspector up to the end of a flight as a sentence; `None` if the inspector stayed.
#[must_use]
pub fn walks_sentence(site: &Site, frames: &[Frame], language: Language) -> Option<String> {
    let lift_off = frames.first()?.time;
    let words: Vec<String> = flown_walks(site, frames).map(|(walk, ..)| walk_words(*walk, lift_off, language)).collect();
    (!words.is_empty()).then(|| text!(language, "report-walks", walks = words.join(", ")))
}

fn walk_words(walk: Walk, lift_off: SimTime, language: Language) -> String {
    if walk.at < lift_off {
        text!(language, "report-walk-before", place = walk.to)
    } else {
        text!(language, "report-walk", place = walk.to, moment = formatting::clock((walk.at - lift_off).s()))
    }
}

fn is_hidden(site: &Site, eye_m: Vec3<Enu>, drone_m: Vec3<Enu>) -> bool {
    site.geometry().hides(eye_m, drone_m, DRONE_CLEARANCE_M)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hovering_frame;
    use spandrel_model::scenario::INSPECTOR_EYE_HEIGHT_M;
    use spandrel_model::site::changes::SiteChanges;
    use spandrel_model::site::inspector_walks::InspectorWalks;
    use spandrel_model::{scenario, shipped};

    #[test]
    fn exact_hidden_times_are_summed_and_the_longest_is_found() {
        let checks = [(0.0, false), (1.0, true), (2.0, true), (3.0, false), (4.0, true), (7.0, true), (9.0, false)];
        let found = of_checks(&checks);
        assert_eq!(found, IntervalTotal { total_s: 7.0, longest_s: 5.0, longest_from_s: 4.0 });
        assert_eq!(
            out_of_sight_sentence(found, Language::English).as_deref(),
            Some("Out of the inspector's sight for 7 s; longest for 5 s, from 0:04.")
        );
        assert_eq!(out_of_sight_sentence(of_checks(&[(0.0, true)]), Language::English), None);
    }

    #[test]
    fn exact_ground_and_deck_hide_a_drone_but_nothing_is_above_the_pad() {
        let job = scenario::read("job.toml", shipped::TWO_BRIDGES, &|file| Err(file.to_owned())).unwrap();
        let site = Site::without_defects(&job);
        let (eye_m, pad_m) = (site.inspector().at(SimTime::ZERO).eye_m(), job.ground_team.pad_m);
        assert!(!is_hidden(&site, eye_m, pad_m + Vec3::new(0.0, 0.0, 5.0)));
        assert!(is_hidden(&site, eye_m, pad_m - Vec3::new(0.0, 0.0, 5.0)), "below the ground");
        // The inspector looks at the arch bridge from below, so that its deck hides what is just above it.
        let deck_m = job.bridges[0].center_m;
        assert!(is_hidden(&site, eye_m, deck_m + Vec3::new(0.0, 0.0, 0.7)), "behind the deck");
    }

    /// Returns frames of a drone that stays at a point for 60 s, from 10 s after the start of the simulation on.
    fn hovering(position_m: Vec3<Enu>) -> Vec<Frame> {
        let frame =
            |k: i64| Frame { index: 1 + k as u32, time: SimTime::from_ms(10_000 + 100 * k), ..hovering_frame(position_m) };
        (0..=600).map(frame).collect()
    }

    #[test]
    fn exact_walk_brings_a_hidden_drone_into_sight() {
        let job = scenario::read("job.toml", shipped::TWO_BRIDGES, &|file| Err(file.to_owned())).unwrap();
        let still = Site::without_defects(&job);
        let hidden_from = |number: u8, point_m: Vec3<Enu>| {
            let eye_m = still.inspector().place_m(number).unwrap() + Vec3::new(0.0, 0.0, INSPECTOR_EYE_HEIGHT_M);
            is_hidden(&still, eye_m, point_m)
        };
        let mut points = job.tasks.iter().flat_map(|task| task.path_m.iter().copied());
        let drone_m = points.find(|point| hidden_from(1, *point) && !hidden_from(2, *point)).expect("a hidden part of a path");
        let frames = hovering(drone_m);
        // The checks are up to 0.6 s apart, because frames come every 0.1 s.
        assert!(out_of_sight(&still, &frames).total_s > 59.0);
        assert_eq!(walks_sentence(&still, &frames, Language::English), None);
        // The walk begins at 25 s, 15 s after lift-off, and takes 24 s.
        let walks = InspectorWalks::from_codes([250_012]);
        let site = still.with_changes(SiteChanges { walks, ..SiteChanges::default() });
        let found = out_of_sight(&site, &frames);
        assert!((14.4..=39.6).contains(&found.total_s), "hidden at least until the walk, at most until its end: {found:?}");
        let words = walks_sentence(&site, &frames, Language::English).unwrap();
        assert_eq!(words, "Walks of the inspector: to place 2 at 0:15.");
        assert_eq!(
            walks_sentence(&site, &frames[400..], Language::English).unwrap(),
            "Walks of the inspector: to place 2 before lift-off."
        );
    }
}
