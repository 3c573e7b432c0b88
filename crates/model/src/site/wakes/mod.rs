//! Wakes of a site: behind piers, towers and columns the mean wind is weaker and partly flows backward, vortices that the body sheds
//! make the air sway across the wind, and the air is turbulent. Around decks, the wind across the bridge separates, and speeds up below
//! them.
//!
//! The flow ahead of piers is missing.

mod air;
mod body;
mod cylinders;
mod deck;
mod gusts;
mod plane_wake;

use crate::frames::{Enu, Ned, Vec3};
use crate::math;
use crate::random::RandomStream;
use crate::scenario::bridges::{Bridge, Member};
use crate::time::SimTime;
pub use air::LocalAir;
use air::Stream;
use body::BluffBody;
use cylinders::Vortices;
use deck::{Deck, DeckAir};
pub use gusts::WakeGusts;
use plane_wake::squared;

/// Largest deficit where wakes overlap, relative to the wind (Lyn et al. 1995: backward flow of a fifth of the wind).
const MAX_DEFICIT: f64 = 1.2;
/// Length of the eddies that carry the turbulence, in widths of the body or depths of the deck (estimate).
const EDDY_WIDTHS: f64 = 0.5;
/// Distance that exceeds the rounding errors of positions, m.
const ROUNDING_M: f64 = 1e-3;

/// Wakes of a site in the present wind, with the phase of the vortices that each body sheds.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeField {
    bodies: Vec<BluffBody>,
    decks: Vec<Deck>,
    vortices: Vortices,
    wind: Option<Stream>,
}

/// Turbulence of several sources: variance, and lengths of the eddies weighted by it.
#[derive(Debug, Clone, Copy, Default)]
struct TurbulenceSum {
    variance: f64,
    weighted_length: f64,
}

impl TurbulenceSum {
    fn add(&mut self, deviation_m_s: f64, width_m: f64) {
        let variance = squared(deviation_m_s);
        self.variance += variance;
        self.weighted_length += variance * EDDY_WIDTHS * width_m;
    }

    /// Returns the standard deviation, m/s, and the length of the eddies, m.
    fn total(self) -> (f64, f64) {
        if self.variance > 0.0 { (self.variance.sqrt(), self.weighted_length / self.variance) } else { (0.0, 0.0) }
    }
}

impl WakeField {
    /// Collects the bodies and decks. The seed determines the phases at the start.
    #[must_use]
    pub fn new(members: &[Member], bridges: &[Bridge], seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "wind.wakes");
        let mut phase_rad = || stream.uniform() * math::TAU;
        let bodies = members.iter().filter_map(BluffBody::of).map(|body| body.with_phase(phase_rad())).collect();
        let decks = bridges.iter().map(|bridge| Deck::of(bridge, phase_rad())).collect();
        Self { bodies, decks, vortices: Vortices::Passing, wind: None }
    }

    /// Collects the bodies and decks for the mean over the passage of the vortices. Regular vortices add to the turbulence.
    #[must_use]
    pub fn averaged(members: &[Member], bridges: &[Bridge]) -> Self {
        /// The mean does not depend on the phases.
        const ANY_SEED: u64 = 0;
        Self { vortices: Vortices::Averaged, ..Self::new(members, bridges, ANY_SEED) }
    }

    /// Turns the wakes into a wind, and advances their vortices by one time step.
    pub fn advance(&mut self, wind_m_s: Vec3<Ned>, step: SimTime) {
        self.wind = Stream::of(wind_m_s);
        let Some(wind) = &self.wind else { return };
        for body in &mut self.bodies {
            body.advance(wind, self.vortices, step);
        }
        for deck in &mut self.decks {
            deck.advance(wind, self.vortices, step);
        }
    }

    /// Returns the air at a position in the wind of the last [`Self::advance`], with the height of the water or ground below it.
    #[must_use]
    pub fn air(&self, position_m: Vec3<Enu>, surface_up_m: f64) -> LocalAir {
        self.near(position_m, 0.0).air(position_m, surface_up_m)
    }

    /// Returns the wakes that can reach positions within a radius of another one, for queries of several positions.
    #[must_use]
    pub fn near(&self, center_m: Vec3<Enu>, radius_m: f64) -> NearbyWakes<'_> {
        let Some(wind) = &self.wind else { return NearbyWakes { wind: None, bodies: Vec::new(), decks: Vec::new() } };
        let radius_m = radius_m + ROUNDING_M;
        NearbyWakes {
            wind: Some(wind),
            bodies: self.bodies.iter().filter(|body| body.may_reach(center_m, radius_m, wind)).collect(),
            decks: self.decks.iter().filter(|deck| deck.may_reach(center_m, radius_m)).collect(),
        }
    }
}

/// Wakes that can reach a region.
#[derive(Debug, Clone)]
pub struct NearbyWakes<'a> {
    wind: Option<&'a Stream>,
    bodies: Vec<&'a BluffBody>,
    decks: Vec<&'a Deck>,
}

impl NearbyWakes<'_> {
    /// Returns the air at a position in the region, with the height of the water or ground below it.
    #[must_use]
    pub fn air(&self, position_m: Vec3<Enu>, surface_up_m: f64) -> LocalAir {
        let Some(wind) = self.wind else { return LocalAir::default() };
        let mut turbulence = TurbulenceSum::default();
        // Overlapping deficits add as the root of the sum of squares, as wakes of wind turbines (Katic et al. 1986).
        let (mut squares, mut sway) = (0.0, 0.0);
        for body in &self.bodies {
            let Some(wake) = body.at(position_m, wind) else { continue };
            squares += squared(wake.deficit);
            sway += wake.sway;
            turbulence.add(wake.turbulence * wind.speed_m_s, body.width_m());
        }
        let mut added_m_s = (wind.along * -squares.sqrt().min(MAX_DEFICIT) + wind.left * sway) * wind.speed_m_s;
        for deck in &self.decks {
            let Some(DeckAir { added_m_s: by_deck, turbulence_m_s, depth_m }) = deck.at(position_m, surface_up_m) else {
                continue;
            };
            added_m_s += by_deck;
            turbulence.add(turbulence_m_s, depth_m);
        }
        let (turbulence_m_s, eddy_m) = turbulence.total();
        LocalAir { velocity_m_s: added_m_s.ned(), turbulence_m_s, eddy_m }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::Element;
    use crate::scenario::bridges::BridgeShape;
    use crate::scenario::bridges::girder::Girder;
    use crate::scenario::bridges::solid::{MemberBuilder, Placement};
    use cylinders::Section;

    const WIND_M_S: f64 = 6.0;
    const WIDTH_M: f64 = 3.0;
    /// Strouhal number of a square cylinder (Lyn et al. 1995).
    const SQUARE_STROUHAL: f64 = 0.132;

    /// Returns a square pier of 3 m and 20 m height at the origin in a wind, beside a slab that has no wake.
    fn pier(wind_m_s: Vec3<Ned>) -> WakeField {
        let mut builder = MemberBuilder::new("test", Placement::new(Vec3::zero(), 90.0));
        builder.add_box("pier", Element::RcPierWall, [-1.5, -1.5, 0.0], [1.5, 1.5, 20.0]);
        builder.add_box("deck", Element::RcDeck, [-50.0, -5.0, 21.0], [50.0, 5.0, 22.0]);
        let mut field = WakeField::new(&builder.finish(), &[], 1);
        field.advance(wind_m_s, SimTime::ZERO);
        field
    }

    /// The wind blows toward the east.
    fn wind() -> Vec3<Ned> {
        Vec3::new(0.0, WIND_M_S, 0.0)
    }

    #[test]
    fn exact_wind_recovers_behind_a_pier_and_is_unchanged_beside_before_and_above_it() {
        let field = pier(wind());
        let along = |east_m: f64, north_m: f64, up_m: f64| {
            field.air(Vec3::new(east_m, north_m, up_m), 0.0).velocity_m_s.east() / WIND_M_S
        };
        let deficits = [3.0, 6.0, 15.0, 60.0].map(|east_m| -along(east_m, 0.0, 10.0));
        assert!(deficits.windows(2).all(|pair| pair[0] > pair[1]), "{deficits:?}");
        assert!(deficits[0] > 1.0 && deficits[3] < 0.4, "{deficits:?}");
        for (place, at) in [("ahead", [-6.0, 0.0, 10.0]), ("beside", [6.0, 15.0, 10.0]), ("above", [6.0, 0.0, 24.0])] {
            assert_eq!(field.air(Vec3::new(at[0], at[1], at[2]), 0.0), LocalAir::default(), "{place}");
        }
    }

    #[test]
    fn prop_wakes_near_a_position_include_all_that_reach_its_surroundings() {
        const RADIUS_M: f64 = 0.5;
        const EVERYWHERE_M: f64 = 1e6;
        let bridge = Bridge {
            name: "test".into(),
            center_m: Vec3::new(0.0, 0.0, 20.0),
            heading_deg: 70.0,
            kind: crate::scenario::bridges::BridgeKind::Girder(Girder::default()),
        };
        let mut random = RandomStream::new(4, "positions");
        let (mut few, mut disturbed) = (0, 0);
        for k in 0..40 {
            let (s, c) = math::sin_cos(0.4 * f64::from(k));
            let mut field = WakeField::new(&bridge.members(), std::slice::from_ref(&bridge), 1);
            field.advance(Vec3::new(7.0 * s, 7.0 * c, 0.0), SimTime::ZERO);
            let all = field.near(Vec3::zero(), EVERYWHERE_M);
            for _ in 0..500 {
                let center = Vec3::<Enu>::new(random.range(-90.0, 90.0), random.range(-60.0, 60.0), random.range(0.0, 30.0));
                let offset = Vec3::new(random.normal(), random.normal(), random.normal()).unit() * RADIUS_M;
                let near = field.near(center, RADIUS_M);
                few += usize::from(near.bodies.len() < all.bodies.len());
                let air = near.air(center + offset, 0.0);
                disturbed += usize::from(air != LocalAir::default());
                assert_eq!(air, all.air(center + offset, 0.0), "{center:?} {offset:?}");
            }
        }
        assert!(few > 10_000 && disturbed > 1_000, "{few} {disturbed}");
    }

    #[test]
    fn val_air_behind_a_pier_sways_at_the_strouhal_frequency() {
        const STEP: SimTime = SimTime::from_ms(10);
        let mut field = pier(wind());
        let mut crossings = Vec::new();
        let mut before = 0.0;
        for k in 0..60_000 {
            field.advance(wind(), STEP);
            let sway = field.air(Vec3::new(7.0, 0.0, 10.0), 0.0).velocity_m_s.north();
            if before < 0.0 && sway >= 0.0 {
                crossings.push(f64::from(k) * STEP.s());
            }
            before = sway;
        }
        let periods = (crossings.len() - 1) as f64;
        let frequency_hz = periods / (crossings[crossings.len() - 1] - crossings[0]);
        // The issue of a shedding frequency is its peak within 5%; a sampled cosine is exact to the step.
        let strouhal = frequency_hz * WIDTH_M / WIND_M_S;
        assert!((strouhal / SQUARE_STROUHAL - 1.0).abs() < 0.05, "{strouhal}");
    }

    #[test]
    fn prop_velocity_in_wakes_is_finite_continuous_and_hardly_backward() {
        // Within a millimeter, the velocity changes by less than the largest gradient allows: the wind over a tenth of the width.
        const STEP_M: f64 = 1e-3;
        let largest = WIND_M_S / (0.1 * WIDTH_M) * STEP_M * 4.0;
        for k in 0..400 {
            let (s, c) = math::sin_cos(f64::from(k) * 0.37);
            let wind = Vec3::new(WIND_M_S * s, WIND_M_S * c, 0.0);
            let field = pier(wind);
            let distance_m = 2.2 + f64::from(k % 50) * 4.0;
            let at = Vec3::new(distance_m * c, distance_m * s, 5.0);
            let velocity = |at: Vec3<Enu>| field.air(at, 0.0).velocity_m_s;
            for shift in [Vec3::new(STEP_M, 0.0, 0.0), Vec3::new(0.0, STEP_M, 0.0), Vec3::new(0.0, 0.0, STEP_M)] {
                let (here, there) = (velocity(at), velocity(at + shift));
                assert!((here - there).norm() < largest, "{here:?} {there:?} at {at:?}");
                let along = (wind + here).dot(wind) / (WIND_M_S * WIND_M_S);
                assert!(along >= 1.0 - MAX_DEFICIT - 1e-9, "{here:?} at {at:?}");
            }
        }
    }

    #[test]
    fn exact_averaged_field_is_the_mean_over_the_vortices_and_keeps_their_energy() {
        // Steps of a thousandth of the period: the mean of a sampled cosine is exact.
        const STEPS: usize = 1000;
        let period_s = WIDTH_M / (SQUARE_STROUHAL * WIND_M_S);
        let step = SimTime::from_s(period_s / STEPS as f64);
        let places = [(4.0, 0.5), (7.0, -1.0), (20.0, 2.0)].map(|(east_m, north_m)| Vec3::new(east_m, north_m, 10.0));
        let mut field = pier(wind());
        let (mut sums, mut squares) = ([Vec3::<Ned>::zero(); 3], [0.0; 3]);
        for _ in 0..STEPS {
            field.advance(wind(), step);
            for (k, place) in places.iter().enumerate() {
                let velocity = field.air(*place, 0.0).velocity_m_s;
                sums[k] += velocity;
                squares[k] += squared(velocity.north());
            }
        }
        let averaged = {
            let mut averaged = WakeField { vortices: Vortices::Averaged, ..field.clone() };
            // A change of the direction makes the bodies determine their wakes anew.
            averaged.advance(Vec3::new(WIND_M_S, 0.0, 0.0), SimTime::ZERO);
            averaged.advance(wind(), SimTime::ZERO);
            averaged
        };
        for (k, place) in places.iter().enumerate() {
            let (passing, mean) = (field.air(*place, 0.0), averaged.air(*place, 0.0));
            let error_m_s = (sums[k] / STEPS as f64 - mean.velocity_m_s).norm();
            assert!(error_m_s < 1e-3 * WIND_M_S && mean.velocity_m_s.north().abs() < 1e-12, "{place:?}: {error_m_s}");
            let variance = squared(passing.turbulence_m_s) + squares[k] / STEPS as f64;
            assert!((mean.turbulence_m_s / variance.sqrt() - 1.0).abs() < 1e-3, "{place:?}: {mean:?} {variance}");
            assert!(mean.turbulence_m_s > passing.turbulence_m_s, "{place:?}");
        }
    }

    /// Returns the columns of a girder bridge in a wind.
    fn columns(girder: &Girder, wind_m_s: f64) -> WakeField {
        let mut builder = MemberBuilder::new("test", Placement::new(Vec3::zero(), 90.0));
        girder.build(&mut builder);
        let mut field = WakeField::new(&builder.finish(), &[], 1);
        field.advance(Vec3::new(wind_m_s, 0.0, 0.0), SimTime::ZERO);
        field
    }

    #[test]
    fn exact_columns_of_a_girder_bridge_have_wakes_and_its_caps_and_drains_do_not() {
        let field = columns(&Girder::default(), WIND_M_S);
        // Two piers of three columns.
        assert_eq!(field.bodies.len(), 6);
        assert!(field.bodies.iter().all(|body| (body.top_up_m - body.base_up_m - 12.0).abs() < 1e-9));
        assert!(field.bodies.iter().all(|body| body.section == Section::Sharp));
    }

    #[test]
    fn exact_round_columns_shed_regularly_in_light_wind_and_irregularly_in_strong_wind() {
        // 1.1 m in 2 m/s is a Reynolds number of 1.5e5; in 8 m/s, 6e5.
        let girder = Girder { round_columns: 1.0, ..Girder::default() };
        let behind = |field: &WakeField| {
            let first = Vec3::<Enu>::new(-0.5 * girder.span_m, 0.0, -9.0);
            field.air(first + Vec3::new(0.0, 3.0, 0.0), -20.0)
        };
        let (light, strong) = (columns(&girder, 2.0), columns(&girder, 8.0));
        assert!(light.bodies.iter().all(|body| body.section == Section::Round));
        let (light, strong) = (behind(&light), behind(&strong));
        assert!(light.velocity_m_s.east() != 0.0 && strong.velocity_m_s.east() == 0.0, "{light:?} {strong:?}");
        assert!(strong.turbulence_m_s / 8.0 > light.turbulence_m_s / 2.0, "{light:?} {strong:?}");
    }
}
