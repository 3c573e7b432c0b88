//! Paths of one satellite's signal to the receiver: the direct one, and those over reflecting surfaces.

use super::Sky;
use super::antenna::relative_amplitude;
use crate::sensors::dilution::BLOCKING_RANGE_M;
use crate::sensors::surroundings::Surroundings;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::reflectors::{Reflection, Wall};
use spandrel_model::time::SimTime;

/// Relative amplitude below which a reflection is ignored; it causes an error of at most 0.3 m.
const MIN_AMPLITUDE: f64 = 0.02;
/// Distance from a reflecting surface at which rays toward it end and rays from it begin, m.
const SURFACE_MARGIN_M: f64 = 0.02;

/// A reflected signal that reaches the receiver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Echo {
    /// Where the signal is reflected.
    pub(super) reflection: Reflection,
    /// Amplitude divided by that of the direct signal.
    pub(super) amplitude: f64,
}

/// The signals of one satellite that reach the receiver.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Signals {
    /// Whether the direct signal does.
    pub(super) direct: bool,
    /// Reflected signals.
    pub(super) echoes: Vec<Echo>,
}

impl Signals {
    /// Returns the strongest reflection.
    pub(super) fn strongest(&self) -> Option<&Echo> {
        self.echoes.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
    }
}

/// A receiver at a place and time, with the walls near it.
pub(super) struct Reception<'a, S> {
    pub(super) sky: &'a Sky,
    pub(super) walls: Vec<&'a Wall>,
    pub(super) site: &'a S,
    pub(super) position_m: Vec3<Enu>,
    pub(super) now: SimTime,
}

impl<S: Surroundings> Reception<'_, S> {
    /// Returns the signals from a satellite in this direction.
    pub(super) fn signals(&self, satellite: Vec3<Enu>) -> Signals {
        let walls = self.walls.iter().filter_map(|wall| wall.reflection(self.position_m, satellite));
        let mirrors = self.sky.reflectors.water(self.position_m, satellite).into_iter().chain(walls);
        let amplitude = |reflection: &Reflection| relative_amplitude(reflection, satellite) * self.sky.reflected_factor;
        let echoes = mirrors.map(|reflection| Echo { reflection, amplitude: amplitude(&reflection) });
        let strong = echoes.filter(|echo| echo.amplitude >= MIN_AMPLITUDE);
        Signals {
            direct: self.is_open(self.position_m, satellite, BLOCKING_RANGE_M),
            echoes: strong.filter(|echo| self.is_unobstructed(&echo.reflection, satellite)).collect(),
        }
    }

    fn is_unobstructed(&self, reflection: &Reflection, satellite: Vec3<Enu>) -> bool {
        let point_m = reflection.point_m + reflection.normal * SURFACE_MARGIN_M;
        let path = point_m - self.position_m;
        self.is_open(self.position_m, path.unit(), path.norm()) && self.is_open(point_m, satellite, BLOCKING_RANGE_M)
    }

    fn is_open(&self, from_m: Vec3<Enu>, direction: Vec3<Enu>, range_m: f64) -> bool {
        self.site.ray_m(from_m, direction, range_m, self.now).is_none()
    }
}
