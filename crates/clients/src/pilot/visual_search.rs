//! Visual search: models what the pilot notices in the camera picture. Detection of a defect depends on its size in the
//! picture and the pilot's probability-of-detection curve; noise causes false alarms at stains and shadows (signal
//! detection theory).

use super::skill::Skill;
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::site::{CameraPose, DefectView, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use std::collections::BTreeMap;

/// Interval between fixations, s (estimate from eye movements).
const GLIMPSE_INTERVAL_S: f64 = 0.25;
/// Spread of the lognormal detection curve (Campbell et al. 2020: 50% at 26 mm, 90% at 113 mm).
const POD_SIGMA_LN: f64 = 1.147;
/// Minimum extent of a clearly visible object, px (estimate).
const CLEAR_EXTENT_PX: f64 = 40.0;
/// Minimum extent for detection, px (a tenth of the pixels in a clear picture; estimate).
const MIN_EXTENT_PX: f64 = 6.0;
/// Maximum incidence angle for detection, rad (60 degrees; inspection practice rejects more oblique pictures).
const MAX_INCIDENCE_RAD: f64 = 1.05;
/// Surface noise at which a surface looks like a defect, as a multiple of a trained pilot's standard deviation
/// (estimate).
const FALSE_ALARM_SIGMAS: f64 = 4.6;

/// Result of a glimpse.
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
    next_glimpse: SimTime,
    /// Detection threshold of each defect on this flight: uniform in [0, 1], drawn when the defect first comes into
    /// view.
    notice_threshold: BTreeMap<u32, f64>,
    /// Time at which the pilot stops ignoring each defect.
    ignored_until: BTreeMap<u32, SimTime>,
}

impl VisualSearch {
    /// Creates the visual search from a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let random = RandomStream::new(seed, "pilot eye");
        Self { random, next_glimpse: SimTime::ZERO, notice_threshold: BTreeMap::new(), ignored_until: BTreeMap::new() }
    }

    /// Examines the picture if a fixation is due. `surface_in_view`: whether a nearby surface fills the picture, which
    /// makes a false alarm possible.
    pub fn glimpse(
        &mut self,
        views: impl FnOnce() -> Vec<DefectView>,
        site: &Site,
        skill: &Skill,
        now: SimTime,
        surface_in_view: bool,
    ) -> Glimpse {
        if now < self.next_glimpse {
            return Glimpse::Nothing;
        }
        self.next_glimpse = now + SimTime::from_s(GLIMPSE_INTERVAL_S);
        let deceived = self.random.normal() * skill.noise > FALSE_ALARM_SIGMAS;
        for view in views() {
            // The pilot cannot notice a defect that is edge-on, too small, or in the dark, but it may become detectable
            // later.
            let lit = view.illuminance_lux >= view.required_illuminance_lux;
            let plain = lit && view.unoccluded && view.extent_px >= MIN_EXTENT_PX && view.incidence_rad < MAX_INCIDENCE_RAD;
            if self.ignored_until.get(&view.defect_id).is_some_and(|until| now < *until) || !plain {
                continue;
            }
            let random = &mut self.random;
            let luck = *self.notice_threshold.entry(view.defect_id).or_insert_with(|| random.uniform());
            if luck < probability(&view, site, skill) {
                self.ignored_until.insert(view.defect_id, SimTime::NEVER);
                return Glimpse::Defect { id: view.defect_id, judgment_error: self.random.normal() };
            }
        }
        if deceived && surface_in_view { Glimpse::Distractor } else { Glimpse::Nothing }
    }

    /// Ignores a noticed defect until this time, because it is poorly visible from here.
    pub fn ignore_until(&mut self, defect: u32, until: SimTime) {
        self.ignored_until.insert(defect, until);
    }
}

/// Returns the probability that this pilot detects a defect in this view.
fn probability(view: &DefectView, site: &Site, skill: &Skill) -> f64 {
    let Some(defect) = site.defects().iter().find(|d| d.id == view.defect_id) else { return 0.0 };
    let contrast = if defect.line { view.width_px.min(1.0) } else { 1.0 };
    let plain_mm = defect.length_m * 1000.0 * contrast * (view.extent_px / CLEAR_EXTENT_PX).min(1.0);
    normal_cdf((math::ln(plain_mm.max(1e-6)) - math::ln(skill.median_length_mm())) / POD_SIGMA_LN)
}

fn normal_cdf(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
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
