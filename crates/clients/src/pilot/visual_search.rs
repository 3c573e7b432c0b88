//! Visual search by fixations: each fixation examines a part of the camera picture. Whether a fixated defect is recognized
//! depends on its size in the picture and the pilot's probability-of-detection curve.

use super::skill::Skill;
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::site::detection::{CLEAR_EXTENT_PX, probability_with_median};
use spandrel_model::site::{CameraPose, DefectView, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use std::collections::BTreeMap;

/// Minimum extent for detection, px (a tenth of the pixels in a clear picture; estimate).
const MIN_EXTENT_PX: f64 = 6.0;
/// Maximum incidence angle for detection, rad (70 degrees; more oblique surfaces are foreshortened to a third; estimate).
const MAX_INCIDENCE_RAD: f64 = 1.22;
/// Largest distance at which the pilot searches a surface, m (estimate: three times a usual stand-off). Pilots see more
/// distant surfaces, too, but inspect one at a time.
pub const MAX_SEARCH_DISTANCE_M: f64 = 14.0;
/// Ratio of illuminance to the camera's minimum above which the picture has full contrast (estimate).
const FULL_CONTRAST_RATIO: f64 = 2.0;

/// Result of a fixation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Glimpse {
    /// The pilot noticed nothing new.
    Nothing,
    /// The pilot noticed a real defect.
    Defect {
        /// ID of the defect.
        id: u32,
        /// Judgment error for this defect, as a multiple of a trained pilot's standard deviation.
        judgment_error: f64,
    },
    /// The pilot mistook something else for a defect.
    Distractor,
}

/// State of the visual search.
#[derive(Debug, Clone, PartialEq)]
pub struct VisualSearch {
    random: RandomStream,
    next_fixation: SimTime,
    /// Detection threshold of each defect on this flight: uniform in [0, 1], drawn when the defect is first fixated.
    notice_threshold: BTreeMap<u32, f64>,
    /// Time at which the pilot stops ignoring each defect.
    ignored_until: BTreeMap<u32, SimTime>,
}

impl VisualSearch {
    /// Creates the visual search from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let random = RandomStream::new(seed, "pilot eye");
        Self { random, next_fixation: SimTime::ZERO, notice_threshold: BTreeMap::new(), ignored_until: BTreeMap::new() }
    }

    /// Checks whether the next fixation is due.
    #[must_use]
    pub fn is_due(&self, now: SimTime) -> bool {
        now >= self.next_fixation
    }

    /// Checks whether the pilot may still notice a defect.
    #[must_use]
    pub fn is_open(&self, defect: u32, now: SimTime) -> bool {
        self.ignored_until.get(&defect).is_none_or(|until| now >= *until)
    }

    /// Examines the picture with one fixation, if it is due.
    pub fn fixate(&mut self, views: impl Iterator<Item = DefectView>, site: &Site, skill: &Skill, now: SimTime) -> Glimpse {
        if !self.is_due(now) {
            return Glimpse::Nothing;
        }
        self.next_fixation = now + SimTime::from_s(skill.fixation_s);
        let deceived = self.random.uniform() < skill.false_alarms_per_min / 60.0 * skill.fixation_s;
        for view in views {
            if !self.is_open(view.defect_id, now) || !is_recognizable(&view) || self.random.uniform() >= skill.fixation_area {
                continue;
            }
            let random = &mut self.random;
            let luck = *self.notice_threshold.entry(view.defect_id).or_insert_with(|| random.uniform());
            if luck < probability(&view, site, skill) {
                self.ignored_until.insert(view.defect_id, SimTime::NEVER);
                return Glimpse::Defect { id: view.defect_id, judgment_error: self.random.normal() };
            }
        }
        if deceived { Glimpse::Distractor } else { Glimpse::Nothing }
    }

    /// Draws whether the pilot doubts a good picture.
    pub fn doubts(&mut self, skill: &Skill) -> bool {
        self.random.uniform() < skill.doubt
    }

    /// Ignores a noticed defect until this time, because it can't be photographed from here.
    pub fn ignore_until(&mut self, defect: u32, until: SimTime) {
        self.ignored_until.insert(defect, until);
    }
}

/// Checks whether a defect can be recognized in this view. If it is edge-on, too small, or in the dark, it may become
/// recognizable later.
fn is_recognizable(view: &DefectView) -> bool {
    view.in_frame
        && view.unoccluded
        && view.illuminance_lux >= view.required_illuminance_lux
        && view.extent_px >= MIN_EXTENT_PX
        && view.incidence_rad < MAX_INCIDENCE_RAD
        && view.distance_m <= MAX_SEARCH_DISTANCE_M
}

/// Returns the probability that this pilot detects a fixated defect, from its size in the picture and its contrast.
fn probability(view: &DefectView, site: &Site, skill: &Skill) -> f64 {
    let Some(defect) = site.defects().iter().find(|d| d.id == view.defect_id) else { return 0.0 };
    detection_probability(view, defect.length_m, defect.line, skill)
}

fn detection_probability(view: &DefectView, length_m: f64, line: bool, skill: &Skill) -> f64 {
    // A line narrower than a pixel has proportionally less contrast.
    let line_contrast = if line { view.width_px.min(1.0) } else { 1.0 };
    let light_contrast = (view.illuminance_lux / (FULL_CONTRAST_RATIO * view.required_illuminance_lux)).min(1.0);
    let size_share = (view.extent_px / CLEAR_EXTENT_PX).min(1.0);
    let effective_mm = length_m * 1000.0 * size_share * line_contrast * light_contrast;
    probability_with_median(effective_mm, skill.median_length_mm)
}

/// Returns the camera pose for an aircraft at `position` with its heading and gimbal pitch (the gimbal keeps the
/// horizon level).
#[must_use]
pub fn camera_pose(
    motion: &super::perception::MotionState,
    gimbal_pitch_rad: f64,
    lamp_on: bool,
    vehicle: &Vehicle,
) -> CameraPose {
    use spandrel_model::frames::Vec3;
    let (sy, cy) = math::sin_cos(motion.yaw_rad);
    let (sp, cp) = math::sin_cos(gimbal_pitch_rad);
    let offset = vehicle.camera.position_m;
    let east = offset.forward() * sy + offset.right() * cy;
    let north = offset.forward() * cy - offset.right() * sy;
    CameraPose {
        position_m: motion.position_m + Vec3::new(east, north, -offset.down()),
        forward: Vec3::new(cp * sy, cp * cy, sp),
        right: Vec3::new(cy, -sy, 0.0),
        lamp_on,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(extent_px: f64, illuminance_lux: f64) -> DefectView {
        DefectView {
            defect_id: 1,
            in_frame: true,
            unoccluded: true,
            incidence_rad: 0.0,
            extent_px,
            width_px: 0.5,
            illuminance_lux,
            required_illuminance_lux: 100.0,
            distance_m: 4.0,
            line: false,
            lamp_on: false,
            hit: false,
        }
    }

    /// Rounding of the published sizes: half a millimeter of 26 mm changes the probability by this much.
    const CURVE_TOLERANCE: f64 = 0.01;

    #[test]
    fn val_trained_pilot_detects_as_campbell_measured() {
        for (length_m, expected) in [(0.026, 0.5), (0.113, 0.9)] {
            let found = detection_probability(&view(100.0, 1000.0), length_m, false, &Skill::TRAINED);
            assert!((found - expected).abs() < CURVE_TOLERANCE, "{length_m}: {found}");
        }
    }

    #[test]
    fn exact_small_dim_and_thin_defects_are_detected_less_often() {
        let at = |v: &DefectView, line| detection_probability(v, 0.1, line, &Skill::TRAINED);
        let clear = at(&view(100.0, 1000.0), false);
        assert!(at(&view(20.0, 1000.0), false) < clear);
        assert!(at(&view(100.0, 110.0), false) < clear);
        assert!(at(&view(100.0, 1000.0), true) < clear);
    }

    #[test]
    fn exact_distant_oblique_hidden_and_dark_defects_are_not_recognized() {
        assert!(is_recognizable(&view(100.0, 1000.0)));
        let wrong = [
            DefectView { distance_m: 15.0, ..view(100.0, 1000.0) },
            DefectView { incidence_rad: 1.3, ..view(100.0, 1000.0) },
            DefectView { unoccluded: false, ..view(100.0, 1000.0) },
            view(100.0, 99.0),
            view(5.0, 1000.0),
        ];
        assert!(wrong.iter().all(|view| !is_recognizable(view)));
    }
}
