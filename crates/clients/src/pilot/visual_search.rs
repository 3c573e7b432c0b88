//! What the pilot notices in the camera's picture. A defect is noticed by its size in the picture against the pilot's own
//! probability-of-detection curve; stains and shadows are mistaken for one by noise (signal detection).

use super::skill::Skill;
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::site::{CameraPose, DefectView, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use std::collections::BTreeMap;

/// Time between two fixations, s (eye movement, estimate).
const GLIMPSE_S: f64 = 0.25;
/// Spread of the lognormal detection curve (Campbell et al. 2020: 26 mm and 113 mm for 50 % and 90 %).
const POD_SIGMA_LN: f64 = 1.147;
/// A picture shows a thing whole from this many pixels on (estimate).
const CLEAR_PX: f64 = 40.0;
/// Smaller than this a thing is not taken for anything, px (a tenth of a clear picture of it; estimate).
const LEAST_PX: f64 = 6.0;
/// More oblique than this a surface is a streak, rad (60 degrees, where inspection practice rejects pictures).
const LEAST_SQUARE_RAD: f64 = 1.05;
/// Surface noise must exceed this, in standard deviations of the trained pilot, to look like a defect (estimate).
const CRITERION: f64 = 4.6;

/// What a glimpse told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Glimpse {
    /// Nothing new.
    Nothing,
    /// Something that is a defect.
    Defect {
        /// Its number.
        id: u32,
        /// How far the pilot misjudges how it shows, in standard deviations of the trained pilot.
        misjudged: f64,
    },
    /// Something that is none.
    Distractor,
}

/// The eye's memory.
#[derive(Debug, Clone, PartialEq)]
pub struct VisualSearch {
    random: RandomStream,
    next_glimpse: SimTime,
    /// How plain a defect must be to be noticed on this flight, per defect: uniform, drawn at first sight.
    notice_threshold: BTreeMap<u32, f64>,
    /// Until when a defect is not looked for again.
    ignored_until: BTreeMap<u32, SimTime>,
}

impl VisualSearch {
    /// A pilot's eye.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let random = RandomStream::new(seed, "pilot eye");
        Self { random, next_glimpse: SimTime::ZERO, notice_threshold: BTreeMap::new(), ignored_until: BTreeMap::new() }
    }

    /// Looks at the picture, if a fixation is due. `surface_in_view`: something near fills the picture, so that it can deceive.
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
        self.next_glimpse = now + SimTime::from_s(GLIMPSE_S);
        let deceived = self.random.normal() * skill.noise > CRITERION;
        for view in views() {
            // Seen from the edge, as a speck or in the dark it says nothing yet; it will be seen better farther on.
            let lit = view.illuminance_lux >= view.needed_lux;
            let plain = lit && view.unoccluded && view.extent_px >= LEAST_PX && view.incidence_rad < LEAST_SQUARE_RAD;
            if self.ignored_until.get(&view.defect_id).is_some_and(|until| now < *until) || !plain {
                continue;
            }
            let random = &mut self.random;
            let luck = *self.notice_threshold.entry(view.defect_id).or_insert_with(|| random.uniform());
            if luck < probability(&view, site, skill) {
                self.ignored_until.insert(view.defect_id, SimTime::NEVER);
                return Glimpse::Defect { id: view.defect_id, misjudged: self.random.normal() };
            }
        }
        if deceived && surface_in_view { Glimpse::Distractor } else { Glimpse::Nothing }
    }

    /// Leaves a defect alone for now: it was noticed, but would not show well from here.
    pub fn ignore_until(&mut self, defect: u32, until: SimTime) {
        self.ignored_until.insert(defect, until);
    }
}

/// Probability that this pilot ever notices a defect that shows like this.
fn probability(view: &DefectView, site: &Site, skill: &Skill) -> f64 {
    let Some(defect) = site.defects().iter().find(|d| d.id == view.defect_id) else { return 0.0 };
    let contrast = if defect.line { view.width_px.min(1.0) } else { 1.0 };
    let plain_mm = defect.length_m * 1000.0 * contrast * (view.extent_px / CLEAR_PX).min(1.0);
    normal_cdf((math::ln(plain_mm.max(1e-6)) - math::ln(skill.median_length_mm())) / POD_SIGMA_LN)
}

fn normal_cdf(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}

/// The camera's pose for an aircraft at `position` with heading and gimbal pitch (the gimbal keeps the horizon).
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
