//! Scenes of a data set. The pictures of a scene share defects, traffic, date, clouds and wind, because a change of the sun needs a new
//! calculation of the light. All pictures of a scene are in the same split, so that no defect is in both.

use spandrel_model::geodesy::Geo;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::sun;

/// Largest number of pictures of a scene, unless there are fewer than [`MIN_SCENES`] scenes then (estimate: variety against the seconds
/// that a scene needs to load).
const PICTURES_PER_SCENE: u32 = 20;
/// Minimum number of scenes if there are enough pictures, so that a fifth of them is a scene.
const MIN_SCENES: u32 = 5;
/// Share of the scenes for validation.
const VALIDATION_SHARE: f64 = 0.2;
/// Lowest sun, rad: 8 degrees. In the 10 minutes that a scene lasts, the sun sinks by at most 2.5 degrees.
const MIN_SUN_ELEVATION_RAD: f64 = 8.0 * spandrel_model::math::PI / 180.0;
/// Attempts to draw a time with enough sun. Even at 85 degrees of latitude, more than a quarter of all times has it.
const MAX_TIME_ATTEMPTS: u32 = 1000;
/// Largest mean wind speed, m/s (estimate: a common limit for inspection flights). It shows on water and trees.
const MAX_WIND_M_S: f64 = 10.0;
const DAY_S: i64 = 86_400;
const DAYS_PER_YEAR: usize = 365;
/// Largest seed of a session.
const MAX_SEED: u64 = 0x7FFF_FFFF;

/// Part of a data set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Split {
    /// For training.
    Train,
    /// For validation.
    Validation,
}

impl Split {
    /// Both splits.
    pub const ALL: [Self; 2] = [Self::Train, Self::Validation];

    /// Returns the name in file names.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Train => "train",
            Self::Validation => "val",
        }
    }
}

/// A scene of a data set.
#[derive(Debug, Clone, PartialEq)]
pub struct DatasetScene {
    /// Number, from 1.
    pub number: u32,
    /// Seed of defects, traffic and viewpoints.
    pub seed: u64,
    /// Time at the start, seconds since the Unix epoch.
    pub start_unix_s: i64,
    /// Share of the sky covered by clouds, 0 to 1.
    pub cloud_cover: f64,
    /// Mean wind speed, m/s.
    pub wind_m_s: f64,
    /// Direction that the wind blows from, degrees clockwise from north.
    pub wind_from_deg: f64,
    /// Split of all its pictures.
    pub split: Split,
    /// Number of pictures.
    pub pictures: u32,
}

impl DatasetScene {
    /// Returns the scenario with the scene's light and wind, and with defects that depend on the scene's seed alone.
    #[must_use]
    pub fn scenario(&self, base: &Scenario) -> Scenario {
        let mut scenario = base.clone();
        scenario.light.start_unix_s = self.start_unix_s;
        scenario.light.cloud_cover = self.cloud_cover;
        scenario.wind.speed_m_s = self.wind_m_s;
        scenario.wind.from_deg = self.wind_from_deg;
        scenario.defects.seed = None;
        scenario
    }
}

/// Returns the scenes of a data set with this number of pictures.
#[must_use]
pub fn plan(base: &Scenario, seed: u64, pictures: u32) -> Vec<DatasetScene> {
    let count = pictures.div_ceil(PICTURES_PER_SCENE).max(MIN_SCENES).min(pictures);
    let mut stream = RandomStream::new(seed, "view.dataset.scenes");
    let validation = validation_scenes(count, &mut stream);
    (0..count)
        .map(|k| DatasetScene {
            number: k + 1,
            seed: stream.bits() & MAX_SEED,
            start_unix_s: start_unix_s(base, &mut stream),
            cloud_cover: stream.uniform(),
            wind_m_s: stream.range(0.0, MAX_WIND_M_S),
            wind_from_deg: stream.range(0.0, 360.0),
            split: if validation.contains(&k) { Split::Validation } else { Split::Train },
            pictures: pictures / count + u32::from(k < pictures % count),
        })
        .collect()
}

/// Draws the scenes for validation: a fifth of them, and at least one if there are two or more.
fn validation_scenes(count: u32, stream: &mut RandomStream) -> Vec<u32> {
    let wanted = (VALIDATION_SHARE * f64::from(count)).round().max(1.0) as usize;
    let mut left: Vec<u32> = (0..count).collect();
    let mut out = Vec::new();
    while out.len() < wanted && left.len() > 1 {
        out.push(left.swap_remove(stream.below(left.len())));
    }
    out
}

/// Draws a time in the year after the scenario's start with enough sun; the scenario's start if there is none.
fn start_unix_s(base: &Scenario, stream: &mut RandomStream) -> i64 {
    let place: Geo = base.origin;
    let midnight = base.light.start_unix_s - base.light.start_unix_s.rem_euclid(DAY_S);
    (0..MAX_TIME_ATTEMPTS)
        .map(|_| midnight + DAY_S * stream.below(DAYS_PER_YEAR) as i64 + stream.below(DAY_S as usize) as i64)
        .find(|unix_s| sun::elevation_rad(sun::direction(*unix_s as f64, place)) >= MIN_SUN_ELEVATION_RAD)
        .unwrap_or(base.light.start_unix_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn base() -> Scenario {
        spandrel_model::scenario::read("girder.toml", spandrel_model::shipped::GIRDER, &|_| Err("none".into())).unwrap()
    }

    #[test]
    fn prop_scenes_hold_all_pictures_and_both_splits_from_two_pictures_on() {
        for pictures in [1, 2, 3, 4, 5, 6, 19, 99, 100, 101, 1000] {
            for seed in 0..20 {
                let scenes = plan(&base(), seed, pictures);
                assert_eq!(scenes.iter().map(|scene| scene.pictures).sum::<u32>(), pictures);
                assert!(scenes.iter().all(|scene| (1..=PICTURES_PER_SCENE).contains(&scene.pictures)), "{pictures}");
                let validation = scenes.iter().filter(|scene| scene.split == Split::Validation).count();
                let share = validation as f64 / scenes.len() as f64;
                assert_eq!(validation > 0, pictures > 1, "{pictures}");
                // The nearest whole number of scenes: a half of a scene from the share at most, or the one scene of a few.
                assert!((share - VALIDATION_SHARE).abs() <= 0.5 / scenes.len() as f64 || validation <= 1, "{pictures}: {share}");
            }
        }
    }

    #[test]
    fn prop_every_scene_has_daylight_and_its_own_seed() {
        // The highest latitude of a scenario has the fewest hours with enough sun.
        for latitude_deg in [-85.0, 0.0, 41.0, 85.0] {
            let mut base = base();
            base.origin.latitude_deg = latitude_deg;
            let scenes = plan(&base, 5, 2000);
            for scene in &scenes {
                let day = sun::direction(scene.start_unix_s as f64, base.origin);
                assert!(sun::elevation_rad(day) >= MIN_SUN_ELEVATION_RAD, "{latitude_deg}: {scene:?}");
                assert!((0.0..1.0).contains(&scene.cloud_cover) && (0.0..MAX_WIND_M_S).contains(&scene.wind_m_s), "{scene:?}");
            }
            let seeds: std::collections::BTreeSet<u64> = scenes.iter().map(|scene| scene.seed).collect();
            assert_eq!(seeds.len(), scenes.len());
            assert_eq!(scenes, plan(&base, 5, 2000));
            assert_ne!(scenes, plan(&base, 6, 2000));
        }
    }
}
