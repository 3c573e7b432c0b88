//! Inputs for one picture, except the scene, as plain data from telemetry and the scenario.

use super::camera::PinholeCamera;
use super::exposure::Exposure;
use super::scene::{Instance, MoverModel};
use super::sky::Sky;
use super::visible_weather::VisibleWeather;
use super::visible_wind::VisibleWind;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::site::CameraPose;
use spandrel_model::vehicle::Lamp;

/// Camera noise at the lowest sensitivity, as a fraction of white (estimate: consumer sensors, about 40 dB).
const NOISE_AT_ISO_100: f64 = 0.006;
/// Vignetting strength: the corners are darkened by half of this fraction. The darkening grows with the square of the
/// distance from the center (estimate: small wide-angle lenses).
const VIGNETTE_STRENGTH: f64 = 0.45;

/// Beam of a lamp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LampBeam {
    /// Position, ENU, m.
    pub position_m: Vec3<Enu>,
    /// Unit vector of the beam axis.
    pub forward: Vec3<Enu>,
    /// Unit vector to the right.
    pub right: Vec3<Enu>,
    /// Half beam angle, rad.
    pub half_angle_rad: f64,
    /// Luminous intensity within the beam, cd.
    pub intensity_cd: f64,
}

impl LampBeam {
    /// Returns the beam of the aircraft's lamp, or `None` if it is off or absent. Uses the same intensity as
    /// `site::visibility`.
    #[must_use]
    pub fn of(lamp: &Lamp, pose: &CameraPose) -> Option<Self> {
        let half_rad = 0.5 * lamp.beam_angle_rad;
        (pose.lamp_on && lamp.luminous_flux_lm > 0.0).then(|| Self {
            position_m: pose.position_m,
            forward: pose.forward,
            right: pose.right,
            half_angle_rad: half_rad,
            intensity_cd: lamp.luminous_flux_lm / (math::TAU * (1.0 - math::cos(half_rad))),
        })
    }
}

/// Response of a sensor or an eye that converts light to a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorResponse {
    /// Exposure of the picture.
    pub exposure: Exposure,
    /// Noise at mid-gray, as a fraction of white.
    pub noise: f64,
    /// Corner darkening (vignetting).
    pub vignette: f64,
    /// Camera when the shutter opened, if it has moved since.
    pub before: Option<PinholeCamera>,
    /// Share of the picture's blocks that a video link has lost, 0 to 1.
    pub lost_blocks: f64,
}

impl SensorResponse {
    /// Returns the response of the aircraft's camera. `moved` is the camera when the shutter opened.
    #[must_use]
    pub fn camera(exposure: Exposure, moved: Option<PinholeCamera>) -> Self {
        let noise = NOISE_AT_ISO_100 * (exposure.iso / 100.0).sqrt();
        Self { exposure, noise, vignette: VIGNETTE_STRENGTH, before: moved, lost_blocks: 0.0 }
    }

    /// Checks whether this is a camera, with sensor noise and vignetting, rather than an eye.
    #[must_use]
    pub fn is_camera(&self) -> bool {
        self.noise > 0.0 || self.vignette > 0.0
    }

    /// Checks whether this is a camera over a video link that loses blocks.
    #[must_use]
    pub fn has_lost_blocks(&self) -> bool {
        self.is_camera() && self.lost_blocks > 0.0
    }

    /// Returns the response of a person's eyes: no noise, no blur.
    #[must_use]
    pub fn eyes(exposure: Exposure) -> Self {
        Self { exposure, noise: 0.0, vignette: 0.0, before: None, lost_blocks: 0.0 }
    }
}

/// Inputs for one picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    /// Camera that takes the picture.
    pub eye: PinholeCamera,
    /// Picture size, px.
    pub size_px: (u32, u32),
    /// Sun and sky.
    pub sky: Sky,
    /// The lamp's beam, if it is on.
    pub beam: Option<LampBeam>,
    /// Sensor or eye response.
    pub finish: SensorResponse,
    /// Simulation time, s; animates waves and clouds.
    pub time_s: f64,
    /// Wind over the lake.
    pub wind: VisibleWind,
    /// Fog, rain and snow.
    pub weather: VisibleWeather,
    /// Models and instances of the moving objects.
    pub moving: Vec<(MoverModel, Instance)>,
}

impl Shot {
    /// Returns the shot as it arrives over a video link that loses a share of its blocks.
    #[must_use]
    pub fn with_lost_blocks(self, lost_blocks: f64) -> Self {
        Self { finish: SensorResponse { lost_blocks, ..self.finish }, ..self }
    }

    /// Returns width over height.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        f64::from(self.size_px.0) / f64::from(self.size_px.1.max(1))
    }
}
