//! What a person sees of the wind: gusts that roughen the lake, breaking waves, and trees that sway. A pure function of simulation time
//! and the scenario's wind, so that a picture of the same moment is always the same. It changes nothing that is measured: collision
//! geometry, light and visibility of defects don't know it.

use spandrel_model::math;
use spandrel_model::scenario::WindSpec;
use spandrel_model::site::wind;
use spandrel_model::time::SimTime;

/// Height to which the wind speeds of the formulas for waves refer, m.
const STANDARD_HEIGHT_M: f64 = 10.0;
/// Share of the surface that foam covers at 1 m/s, and the exponent of the wind speed (Monahan and O'Muircheartaigh 1980, Optimal
/// power-law description of oceanic whitecap coverage dependence on wind speed: W = 3.84e-6 U10^3.41).
const WHITECAP_COVERAGE: f64 = 3.84e-6;
const WHITECAP_EXPONENT: f64 = 3.41;
/// Wind speeds at 10 m between which waves begin to break, m/s (estimate: Beaufort 4, 5.5 to 7.9 m/s, has "fairly frequent white
/// horses"; below, the formula gives a few for each hectare).
const WHITECAP_ONSET_M_S: (f64, f64) = (6.0, 7.0);
/// Wind speed at 10 m up to which the formula is used, m/s (estimate: its data end near 20 m/s).
const MAX_WHITECAP_WIND_M_S: f64 = 20.0;
/// Largest radius of a breaking wave's foam in cells of the noise tile; also in water.wgsl.
pub const WHITECAP_RADIUS: f64 = 0.28;
/// Mean displacement of a tree's top per square of the wind speed, m/(m/s)² (estimate: 0.2 m at 10 m/s for a conifer of about 10 m;
/// drag grows with the square of the speed).
const TREE_BEND_M_PER_M2_S2: f64 = 0.002;
/// Largest mean displacement of a tree's top, m (estimate).
const MAX_TREE_BEND_M: f64 = 0.6;
/// Frequency at which trees sway, Hz (estimate for conifers of about 10 m).
const TREE_SWAY_HZ: f64 = 0.4;

/// The wind at one time, as pictures show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibleWind {
    /// Air velocity at 20 ft toward the east and north, m/s, with gusts of the scenario.
    pub velocity_m_s: (f64, f64),
    /// Direction in which the waves travel: unit vector (east, north) of the scenario's first wind. Waves turn more slowly than the
    /// wind (estimate: not at all during a flight).
    pub waves_toward: (f64, f64),
    /// Displacement of the air at 20 ft since the simulation's start, east and north, m.
    pub drift_m: (f64, f64),
    /// Standard deviation of the wind speed relative to its mean.
    pub gust_intensity: f64,
}

impl VisibleWind {
    /// Returns the wind of a scenario at a time.
    #[must_use]
    pub fn at(spec: &WindSpec, at: SimTime) -> Self {
        let waves = wind::direction_toward(spec.from_deg.to_radians());
        let (velocity, drift) = (wind::velocity_at(spec, at), wind::drift_m(spec, at));
        Self {
            velocity_m_s: (velocity.east(), velocity.north()),
            waves_toward: (waves.east(), waves.north()),
            drift_m: (drift.east(), drift.north()),
            gust_intensity: wind::gust_intensity(spec),
        }
    }

    /// Returns the speed at 20 ft, m/s.
    #[must_use]
    pub fn speed_m_s(&self) -> f64 {
        math::hypot(self.velocity_m_s.0, self.velocity_m_s.1)
    }

    /// Returns the share of the lake that the foam of breaking waves covers, 0 to 1.
    #[must_use]
    pub fn whitecap_coverage(&self) -> f64 {
        let speed_m_s = (self.speed_m_s() * wind::profile(STANDARD_HEIGHT_M)).min(MAX_WHITECAP_WIND_M_S);
        let (from, to) = WHITECAP_ONSET_M_S;
        let begun = ((speed_m_s - from) / (to - from)).clamp(0.0, 1.0);
        begun * WHITECAP_COVERAGE * math::pow(speed_m_s, WHITECAP_EXPONENT)
    }

    /// Returns the share of the noise tile's cells in which a wave breaks. A cell has the area 1, and its foam grows and shrinks so that
    /// its mean area is two thirds of the largest one.
    #[must_use]
    pub fn breaking_share(&self) -> f64 {
        let mean_area = 2.0 / 3.0 * math::PI * WHITECAP_RADIUS * WHITECAP_RADIUS;
        (self.whitecap_coverage() / mean_area).min(1.0)
    }

    /// Returns the mean displacement of a tree's top, east and north, m.
    #[must_use]
    pub fn tree_bend_m(&self) -> (f64, f64) {
        let speed_m_s = self.speed_m_s();
        if speed_m_s <= 0.0 {
            return (0.0, 0.0);
        }
        let bend_m = (TREE_BEND_M_PER_M2_S2 * speed_m_s * speed_m_s).min(MAX_TREE_BEND_M);
        (bend_m * self.velocity_m_s.0 / speed_m_s, bend_m * self.velocity_m_s.1 / speed_m_s)
    }
}

/// Returns the phase of swaying trees at a simulation time, rad, 0 to 2 π.
#[must_use]
pub fn tree_phase_rad(time_s: f64) -> f64 {
    math::TAU * (TREE_SWAY_HZ * time_s).rem_euclid(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario::{WindEvent, WindModel};

    /// Relative tolerance for the formula's printed digits.
    const FORMULA_TOLERANCE: f64 = 1e-3;

    fn spec(speed_m_s: f64, from_deg: f64) -> WindSpec {
        WindSpec {
            model: WindModel::Physical,
            speed_m_s,
            paper_force_n: 0.0,
            from_deg,
            up_m_s: 0.0,
            turbulence: 1.0,
            events: Vec::new(),
        }
    }

    fn seen(speed_m_s: f64) -> VisibleWind {
        VisibleWind::at(&spec(speed_m_s, 270.0), SimTime::from_s(100.0))
    }

    #[test]
    fn val_whitecaps_cover_the_published_share() {
        // Monahan and O'Muircheartaigh (1980): W = 3.84e-6 U10^3.41, calculated independently.
        for (speed_m_s, share) in [(8.0, 0.004_613), (10.0, 0.009_871), (15.0, 0.039_35)] {
            let coverage = seen(speed_m_s / wind::profile(10.0)).whitecap_coverage();
            assert!((coverage / share - 1.0).abs() < FORMULA_TOLERANCE, "{speed_m_s} m/s: {coverage}");
        }
        let at_10_m = |speed_m_s: f64| seen(speed_m_s / wind::profile(10.0)).whitecap_coverage();
        assert_eq!((at_10_m(0.0), at_10_m(5.9)), (0.0, 0.0));
        assert!((at_10_m(40.0) - at_10_m(20.0)).abs() < 1e-12, "beyond the data");
        assert!((0.0..=1.0).contains(&seen(100.0).breaking_share()));
    }

    #[test]
    fn exact_nothing_moves_in_calm_air() {
        let calm = seen(0.0);
        assert_eq!((calm.velocity_m_s, calm.drift_m, calm.tree_bend_m()), ((0.0, 0.0), (0.0, 0.0), (0.0, 0.0)));
        assert_eq!((calm.whitecap_coverage(), calm.breaking_share()), (0.0, 0.0));
    }

    #[test]
    fn exact_gusts_travel_with_the_wind_and_trees_bend_downwind() {
        /// Tolerance for rounding errors, m.
        const ROUNDING_M: f64 = 1e-9;
        let west = seen(5.0);
        assert!((west.drift_m.0 - 500.0).abs() < ROUNDING_M && west.drift_m.1.abs() < ROUNDING_M, "{:?}", west.drift_m);
        assert!((west.waves_toward.0 - 1.0).abs() < ROUNDING_M);
        let bend = west.tree_bend_m();
        assert!((bend.0 - 0.05).abs() < ROUNDING_M && bend.1.abs() < ROUNDING_M, "{bend:?}");
        assert!((seen(10.0).tree_bend_m().0 - 0.2).abs() < ROUNDING_M, "four times as far at twice the speed");
        assert!((seen(50.0).tree_bend_m().0 - MAX_TREE_BEND_M).abs() < ROUNDING_M);
    }

    #[test]
    fn exact_waves_keep_their_direction_when_the_wind_turns() {
        let change = WindEvent::Change { at: SimTime::ZERO, over: SimTime::ZERO, speed_m_s: 8.0, from_deg: 0.0 };
        let turned = VisibleWind::at(&WindSpec { events: vec![change], ..spec(5.0, 270.0) }, SimTime::from_s(10.0));
        assert!((turned.velocity_m_s.1 + 8.0).abs() < 1e-9 && (turned.drift_m.1 + 80.0).abs() < 1e-9, "{turned:?}");
        assert_eq!(turned.waves_toward, seen(5.0).waves_toward);
    }
}
