//! Everything that one picture needs besides the scene: plain data, made from telemetry and the scenario.

use super::camera::PinholeCamera;
use super::exposure::Exposure;
use super::scene::{Instance, MoverModel};
use super::sky::Sky;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::CameraPose;
use spandrel_model::vehicle::Lamp;

/// Noise of a camera at its lowest sensitivity, as a share of white (estimate: consumer sensors, about 40 dB).
const NOISE_AT_100: f64 = 0.006;
/// Corners come out darker by half of this share, places between by the square of their distance from the middle (estimate: small wide lenses).
const VIGNETTE: f64 = 0.45;

/// A lamp's beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampBeam {
    /// Where, m.
    pub position_m: Vec3<Enu>,
    /// Unit vector of its axis.
    pub forward: Vec3<Enu>,
    /// Unit vector to its right.
    pub right: Vec3<Enu>,
    /// Half of the beam's angle, rad.
    pub half_rad: f64,
    /// Intensity within it, cd.
    pub candela: f64,
}

impl LampBeam {
    /// The aircraft's lamp; `None` when it is off or there is none. Its intensity is the one of `site::look`.
    #[must_use]
    pub fn of(lamp: &Lamp, pose: &CameraPose) -> Option<Self> {
        let half_rad = 0.5 * lamp.beam_rad;
        (pose.lamp_on && lamp.flux_lm > 0.0).then(|| Self {
            position_m: pose.position_m,
            forward: pose.forward,
            right: pose.right,
            half_rad,
            candela: lamp.flux_lm / (math::TAU * (1.0 - math::cos(half_rad))),
        })
    }
}

/// How the sensor or the eye turns light into a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilmResponse {
    /// Exposure.
    pub exposure: Exposure,
    /// Noise at mid grey, as a share of white.
    pub noise: f64,
    /// Darkening of the corners.
    pub vignette: f64,
    /// Where the eye was when the shutter opened, if that was elsewhere.
    pub before: Option<PinholeCamera>,
}

impl FilmResponse {
    /// The aircraft's camera. `moved` is the eye at the shutter's opening.
    #[must_use]
    pub fn camera(exposure: Exposure, moved: Option<PinholeCamera>) -> Self {
        Self { exposure, noise: NOISE_AT_100 * (exposure.iso / 100.0).sqrt(), vignette: VIGNETTE, before: moved }
    }

    /// A sensor makes noise, a lens dark corners: eyes have neither.
    #[must_use]
    pub fn is_camera(&self) -> bool {
        self.noise > 0.0 || self.vignette > 0.0
    }

    /// A person's eyes: no noise, no blur.
    #[must_use]
    pub fn eyes(exposure: Exposure) -> Self {
        Self { exposure, noise: 0.0, vignette: 0.0, before: None }
    }
}

/// One picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    /// From where.
    pub eye: PinholeCamera,
    /// Size, px.
    pub size_px: (u32, u32),
    /// Sun and sky.
    pub sky: Sky,
    /// The lamp, when it is on.
    pub beam: Option<LampBeam>,
    /// Sensor or eye.
    pub finish: FilmResponse,
    /// Simulation time, s: waves, clouds.
    pub time_s: f64,
    /// The wind over the water blows towards here: east and north, m/s.
    pub wind_m_s: (f64, f64),
    /// What moves.
    pub moving: Vec<(MoverModel, Instance)>,
}

impl Shot {
    /// Width over height.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        f64::from(self.size_px.0) / f64::from(self.size_px.1.max(1))
    }
}

/// Where the mean wind blows at 20 ft, from a scenario: east and north, m/s.
#[must_use]
pub fn wind(scenario: &spandrel_model::scenario::Scenario) -> (f64, f64) {
    let (s, c) = math::sin_cos(scenario.wind.from_deg.to_radians());
    (-s * scenario.wind.speed_m_s, -c * scenario.wind.speed_m_s)
}
