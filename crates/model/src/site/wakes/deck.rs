//! The wind around a deck with its girders, as around a rectangular cylinder: the part of the wind across the bridge separates at the
//! edges of the windward fascia, flows backward along deck and soffit up to the point where it reattaches, and leaves a wake behind the
//! leeward fascia. Between the soffit and the water or ground, it speeds up.
//!
//! Outside the separated air, the flow is the potential flow of a source at the windward fascia, where the wind stagnates, and of a sink
//! where the separated air becomes thinner, with their mirror images below the water: no air flows through the water, and what the deck
//! displaces speeds up in the channel (continuity). Reattachment and shedding are those of BARC, the benchmark of a 5:1 rectangular
//! cylinder (ERCOFTAC UFR 2-15). The wind along the bridge is not affected.

use super::air::{MIN_WIND_M_S, Stream};
use super::cylinders::{Section, Shedding, Vortices};
use super::plane_wake::{LENGTH_WIDTHS, PlaneWake, WakeAir, smooth, squared};
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::bridges::Bridge;
use crate::scenario::bridges::solid::Placement;
use crate::time::SimTime;

/// Distance from the windward edge to the mean reattachment, in depths (BARC: near the leeward edge, 4.5 to 5).
pub(super) const REATTACHMENT: f64 = 4.7;
/// Source at the windward fascia: distance behind it and strength, in depths and times the wind speed (estimates: the wind stagnates on
/// the fascia, and leaves its edges at about 35°).
const SOURCE: (f64, f64) = (0.28, 2.4);
/// Distance of the sink behind the windward fascia, in depths, and the largest in deck widths (estimate).
const SINK: (f64, f64) = (3.5, 0.7);
/// Square of the radius within which source and sink are spread, in squared depths (estimate).
const CORE: f64 = 0.02;
/// Largest height of the middle of the shear layer above the deck, in depths (estimate).
const BUBBLE_HEIGHT: f64 = 0.45;
/// Thickness of the shear layer at the windward edge, in depths, and its growth with distance (estimates; mixing layers grow by 0.1 to
/// 0.17).
const SHEAR_LAYER: (f64, f64) = (0.15, 0.12);
/// Largest speed of the air that flows backward along deck and soffit, relative to the wind (estimate).
const BACKFLOW: f64 = 0.3;
/// Speed of the air along the deck far behind the reattachment, relative to the wind (estimate).
const RECOVERED: f64 = 0.7;
/// Standard deviations of the turbulence in the separated air, and in addition in the middle of the shear layer, relative to the wind
/// (estimates).
const TURBULENCE: (f64, f64) = (0.15, 0.1);
/// Lengths over which the separated air begins at the windward edge and ends behind the leeward edge, in depths (estimates).
const EDGES: (f64, f64) = (0.25, 0.5);
/// Distance from the deck up to which the air is disturbed, and over which the disturbance ends, in depths (estimate: it is then below a
/// fiftieth).
const REACH: (f64, f64) = (8.0, 2.0);

/// The section of a deck and its girders, and the flow around it in the present wind.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Deck {
    placement: Placement,
    half_length_m: f64,
    half_width_m: f64,
    depth_m: f64,
    /// Height of the section's middle in bridge axes, and in the site, m.
    middle_z_m: f64,
    middle_up_m: f64,
    phase_rad: f64,
    crossing: Option<Crossing>,
}

/// The wind across a bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Crossing {
    /// Direction of the wind across the bridge, relative to the bridge's y axis, and as a vector.
    sign: f64,
    along: Vec3<Enu>,
    speed_m_s: f64,
    wake: PlaneWake,
}

/// Air that a deck disturbs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DeckAir {
    /// Added velocity, m/s.
    pub(super) added_m_s: Vec3<Enu>,
    /// Standard deviation of the turbulence in each direction, m/s.
    pub(super) turbulence_m_s: f64,
    /// Depth of the deck, m.
    pub(super) depth_m: f64,
}

impl Deck {
    /// Returns the deck of a bridge with a phase of its vortices at the start.
    pub(super) fn of(bridge: &Bridge, phase_rad: f64) -> Self {
        let (low, high) = bridge.fascia_z_m();
        let middle_z_m = 0.5 * (low + high);
        Self {
            placement: bridge.placement(),
            half_length_m: 0.5 * bridge.deck_length_m(),
            half_width_m: 0.5 * bridge.deck_width_m(),
            depth_m: high - low,
            middle_z_m,
            middle_up_m: bridge.center_m.up() + middle_z_m,
            phase_rad,
            crossing: None,
        }
    }

    /// Turns the flow into a wind, and advances the vortices of the wake by one time step.
    pub(super) fn advance(&mut self, wind: &Stream, vortices: Vortices, step: SimTime) {
        let left = self.placement.direction([0.0, 1.0, 0.0]);
        let component = wind.along.dot(left) * wind.speed_m_s;
        let (sign, speed_m_s) = (component.signum(), component.abs());
        let shedding = vortices.of(Shedding::of(Section::Sharp, 2.0 * self.half_width_m, self.depth_m, speed_m_s));
        let wake = PlaneWake { width_m: self.depth_m, shedding };
        self.phase_rad = wake.next_phase_rad(self.phase_rad, speed_m_s, step);
        self.crossing = (speed_m_s >= MIN_WIND_M_S).then_some(Crossing { sign, along: left * sign, speed_m_s, wake });
    }

    /// Returns false only if the deck does not disturb the air at any position within a radius.
    pub(super) fn may_reach(&self, center_m: Vec3<Enu>, radius_m: f64) -> bool {
        let Some(crossing) = &self.crossing else { return false };
        let [x, y, z] = self.placement.local(center_m);
        let behind_m = self.half_width_m + crossing.sign * y;
        let (above_m, reach_m) = ((z - self.middle_z_m).abs(), REACH.0 * self.depth_m);
        x.abs() < self.half_length_m + radius_m
            && above_m < 0.5 * self.depth_m + reach_m + radius_m
            && behind_m > -reach_m - radius_m
            && behind_m < 2.0 * self.half_width_m + LENGTH_WIDTHS.0 * self.depth_m + radius_m
    }

    /// Returns the air at a position, with the height of the water or ground below it; `None` where the deck does not disturb it.
    pub(super) fn at(&self, position_m: Vec3<Enu>, surface_up_m: f64) -> Option<DeckAir> {
        let crossing = self.crossing.as_ref()?;
        let [x, y, z] = self.placement.local(position_m);
        let depth_m = self.depth_m;
        let inside_m = self.half_length_m - x.abs();
        let section = DeckSection {
            width: 2.0 * self.half_width_m / depth_m,
            surface: (surface_up_m - self.middle_up_m) / depth_m,
            drag: crossing.wake.shedding.drag,
        };
        // The flow ends within a depth at the ends of the deck, and where the ground is close below it (estimates).
        let share = smooth(inside_m / depth_m) * smooth(-0.5 - section.surface);
        let behind = (self.half_width_m + crossing.sign * y) / depth_m;
        let above = (z - self.middle_z_m) / depth_m;
        if share <= 0.0 || !section.reaches(behind, above) {
            return None;
        }
        let flow = section.flow(behind, above);
        let wake = crossing.wake.at((behind - section.width) * depth_m, above * depth_m, self.phase_rad);
        let WakeAir { deficit, sway, turbulence } = wake.unwrap_or(WakeAir { deficit: 0.0, sway: 0.0, turbulence: 0.0 });
        let scale_m_s = crossing.speed_m_s * share;
        let up = Vec3::new(0.0, 0.0, (flow.up + sway) * scale_m_s);
        Some(DeckAir {
            added_m_s: crossing.along * ((flow.along - deficit) * scale_m_s) + up,
            turbulence_m_s: math::hypot(flow.turbulence, turbulence) * scale_m_s,
            depth_m,
        })
    }
}

/// A deck's section, in depths: its width, and the height of the water or ground below it, relative to its middle; and its drag
/// coefficient by the depth.
#[derive(Debug, Clone, Copy, PartialEq)]
struct DeckSection {
    width: f64,
    surface: f64,
    drag: f64,
}

/// Flow around a section without the wake, relative to the wind across the bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Flow {
    /// Added velocity in the direction of the wind.
    along: f64,
    /// Added velocity upward.
    up: f64,
    /// Standard deviation of the turbulence.
    turbulence: f64,
}

impl DeckSection {
    /// Returns whether the air at a position may be disturbed: `behind` the windward fascia and `above` the middle, in depths.
    fn reaches(self, behind: f64, above: f64) -> bool {
        above.abs() < 0.5 + REACH.0 && behind > -REACH.0 && behind < self.width + LENGTH_WIDTHS.0
    }

    fn flow(self, behind: f64, above: f64) -> Flow {
        let (outer_along, outer_up) = self.outer_flow(behind, above.max(self.surface));
        let outward = above.abs() - 0.5;
        let beside = (-behind).max(behind - self.width).max(0.0);
        let distance = (squared(beside) + squared(outward.max(0.0))).sqrt();
        let within = smooth((REACH.0 - distance) / REACH.1);
        let separated = Self::separated(behind, outward) * self.over_deck(behind);
        let inner_along = inner_speed(behind) - 1.0;
        let (common, shear) = TURBULENCE;
        Flow {
            along: math::lerp(outer_along * within, inner_along, separated),
            up: outer_up * within * (1.0 - separated),
            turbulence: separated * (common + 4.0 * shear * (1.0 - separated)),
        }
    }

    /// Returns the added velocity of the potential flow: source and sink, and their images.
    fn outer_flow(self, behind: f64, above: f64) -> (f64, f64) {
        let (source_at, source) = SOURCE;
        // Far behind, the wake displaces as much air as the momentum that it lacks.
        let sink = source - 0.5 * self.drag;
        let sink_at = SINK.0.min(SINK.1 * self.width);
        let image = above - 2.0 * self.surface;
        let add = |(along, up): (f64, f64), (at, strength): (f64, f64)| {
            let (x, strength) = (behind - at, strength / math::TAU);
            let squared_x = squared(x) + CORE;
            let (own, mirrored) = (strength / (squared_x + squared(above)), strength / (squared_x + squared(image)));
            (along + x * (own + mirrored), up + above * own + image * mirrored)
        };
        add(add((0.0, 0.0), (source_at, source)), (sink_at, -sink))
    }

    /// Returns the share of separated air at a distance behind the windward edge and outward from deck or soffit, 1 at the surface.
    fn separated(behind: f64, outward: f64) -> f64 {
        let share = (behind / REATTACHMENT).clamp(0.0, 1.0);
        let foot = 4.0 * BUBBLE_HEIGHT * share * (1.0 - share);
        let thickness = SHEAR_LAYER.0 + SHEAR_LAYER.1 * behind.max(0.0);
        1.0 - smooth((outward - foot) / thickness)
    }

    /// Returns 1 along the deck, and 0 ahead of and behind it.
    fn over_deck(self, behind: f64) -> f64 {
        smooth(behind / EDGES.0) * (1.0 - smooth((behind - self.width) / EDGES.1))
    }
}

/// Returns the speed of the air at deck and soffit, relative to the wind: backward up to the reattachment, then forward.
fn inner_speed(behind: f64) -> f64 {
    let share = behind / REATTACHMENT - 1.0;
    let slope = 4.0 * BACKFLOW;
    if share <= 0.0 { slope * (share + 1.0).max(0.0) * share } else { slope * share / (1.0 + slope * share / RECOVERED) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::bridges::BridgeKind;
    use crate::scenario::bridges::arch::Arch;
    use crate::scenario::bridges::girder::Girder;
    use crate::scenario::bridges::suspension::Suspension;

    /// The section of BARC, far above the ground.
    const BARC: DeckSection = DeckSection { width: 5.0, surface: -1e3, drag: 1.03 };
    const WIND_M_S: f64 = 8.0;

    /// Returns a bridge along the east axis, and its deck in a wind toward the north.
    fn deck_of(kind: BridgeKind) -> (Bridge, Deck) {
        let center_m = Vec3::new(0.0, 0.0, 20.0);
        let bridge = Bridge { name: "test".into(), center_m, heading_deg: 90.0, kind };
        let mut deck = Deck::of(&bridge, 0.0);
        deck.advance(&north_wind(), Vortices::Passing, SimTime::ZERO);
        (bridge, deck)
    }

    fn girder_deck() -> (Bridge, Deck) {
        deck_of(BridgeKind::Girder(Girder::default()))
    }

    fn north_wind() -> Stream {
        Stream { along: Vec3::new(0.0, 1.0, 0.0), left: Vec3::new(-1.0, 0.0, 0.0), speed_m_s: WIND_M_S }
    }

    #[test]
    fn val_flow_reattaches_near_the_leeward_edge_as_in_barc() {
        // ERCOFTAC UFR 2-15: the mean reattachment is between 4.5 and 5 depths from the windward edge.
        for side in [0.52, -0.52] {
            let speed = |k: i32| 1.0 + BARC.flow(0.01 * f64::from(k), side).along;
            let reattached = (100..500).find(|k| speed(*k) >= 0.0).map(|k| 0.01 * f64::from(k)).unwrap();
            assert!((4.5..=5.0).contains(&reattached), "{reattached}");
            let most = (30..450).map(speed).fold(f64::INFINITY, f64::min);
            assert!((-0.4..=-0.2).contains(&most), "{most}");
        }
    }

    #[test]
    fn val_wake_sheds_at_barcs_strouhal_number() {
        // ERCOFTAC UFR 2-15: about 0.111 by the depth; the issue of a shedding frequency is its peak within 5%.
        let shedding = Shedding::of(Section::Sharp, 5.0, 1.0, WIND_M_S);
        assert!((shedding.strouhal / 0.111 - 1.0).abs() < 0.05 && (shedding.drag - 1.03).abs() < 0.05, "{shedding:?}");
    }

    #[test]
    fn exact_wind_stagnates_on_the_fascia_and_leaves_its_edges_outward() {
        // The constants have two digits.
        const TOLERANCE: f64 = 0.02;
        let face = BARC.flow(0.0, 0.0);
        assert!((1.0 + face.along).abs() < TOLERANCE && face.up.abs() < TOLERANCE, "{face:?}");
        let (top, bottom) = (BARC.flow(-0.01, 0.5), BARC.flow(-0.01, -0.5));
        assert!(top.up > 0.3 && (top.up + bottom.up).abs() < TOLERANCE, "{top:?} {bottom:?}");
    }

    #[test]
    fn exact_no_air_flows_through_the_water_or_arises_in_the_channel() {
        // The divergence by central differences, relative to the wind over a depth.
        const TOLERANCE: f64 = 1e-3;
        let section = DeckSection { width: 4.0, surface: -4.0, drag: 1.2 };
        for k in 0..40 {
            let behind = -4.0 + 0.3 * f64::from(k);
            assert!(section.outer_flow(behind, section.surface).1.abs() < 1e-12, "{behind}");
            let h = 1e-4;
            let d_along = section.outer_flow(behind + h, -2.0).0 - section.outer_flow(behind - h, -2.0).0;
            let d_up = section.outer_flow(behind, -2.0 + h).1 - section.outer_flow(behind, -2.0 - h).1;
            // Source and sink are spread over a core, whose edge is a hundredth here.
            assert!(((d_along + d_up) / (2.0 * h)).abs() < 10.0 * TOLERANCE, "{behind}: {d_along} {d_up}");
        }
    }

    #[test]
    fn exact_wind_is_faster_in_a_lower_channel() {
        // If no air rose over the deck, the air below the middle would flow through the gap less the separated air, at least 0.3 depths.
        let by_continuity = |gap: f64| (gap + 0.5) / (gap - 0.3);
        let speed = |gap: f64| {
            let surface = -0.5 - gap;
            1.0 + DeckSection { width: 4.0, surface, drag: 1.2 }.flow(1.5, 0.5 * (surface - 1.3)).along
        };
        let gaps = [2.5, 4.0, 8.0, 100.0];
        let speeds = gaps.map(speed);
        assert!(speeds.windows(2).all(|pair| pair[0] > pair[1]), "{speeds:?}");
        assert!(speeds[0] > 1.15 && speeds[3] < 1.01, "{speeds:?}");
        assert!(gaps.iter().all(|gap| speed(*gap) <= by_continuity(*gap)), "{speeds:?}");
    }

    #[test]
    fn exact_air_in_the_channel_comes_from_upstream() {
        // Flux through a line from the water up, relative to the wind over a depth: the same at two stations, with what leaves upward
        // between them. Source and sink are spread, and half a percent of them lies beyond.
        const TOLERANCE: f64 = 5e-3;
        const STEP: f64 = 0.01;
        let section = DeckSection { width: 4.0, surface: -4.0, drag: 1.2 };
        let trapezoids = |count: i32, value: &dyn Fn(f64) -> f64| -> f64 {
            (0..count).map(|k| 0.5 * STEP * (value(STEP * f64::from(k)) + value(STEP * f64::from(k + 1)))).sum()
        };
        let through = |behind: f64| trapezoids(250, &|height| 1.0 + section.outer_flow(behind, section.surface + height).0);
        let upward = trapezoids(500, &|ahead| section.outer_flow(-3.0 + ahead, -1.5).1);
        let lost = through(-3.0) - through(2.0) - upward;
        assert!(lost.abs() < TOLERANCE, "{lost}");
    }

    #[test]
    fn exact_a_drone_that_rises_past_the_leeward_fascia_leaves_the_wake() {
        let (bridge, deck) = girder_deck();
        let (low, high) = bridge.fascia_z_m();
        let north_m = 0.5 * bridge.deck_width_m() + 2.0;
        let along = |z: f64| {
            deck.at(Vec3::new(0.0, north_m, bridge.center_m.up() + z), 0.0).map_or(0.0, |air| air.added_m_s.north()) / WIND_M_S
        };
        let (behind, over) = (along(0.5 * (low + high)), along(high + 4.0));
        assert!(behind < -0.8 && over > -0.1, "{behind} {over}");
    }

    #[test]
    fn exact_wind_along_the_bridge_and_far_air_are_unchanged() {
        let (bridge, mut deck) = girder_deck();
        for (north_m, up_m) in [(-60.0, 20.0), (0.0, 60.0), (250.0, 20.0)] {
            let air = deck.at(Vec3::new(0.0, north_m, up_m), 0.0);
            assert!(air.is_none_or(|air| air.added_m_s.norm() < 1e-12), "{air:?}");
        }
        let beyond_m = 0.5 * bridge.deck_length_m() + 0.1;
        assert_eq!(deck.at(Vec3::new(beyond_m, 0.0, 22.0), 0.0), None);
        let along = Stream { along: Vec3::new(1.0, 0.0, 0.0), left: Vec3::new(0.0, 1.0, 0.0), speed_m_s: WIND_M_S };
        deck.advance(&along, Vortices::Passing, SimTime::ZERO);
        assert_eq!(deck.at(Vec3::new(0.0, 0.0, 22.0), 0.0), None);
    }

    #[test]
    fn prop_flow_around_decks_is_bounded_and_continuous() {
        // Within a millimeter, the velocity changes by less than the wind over a twentieth of the depth.
        const STEP_M: f64 = 1e-3;
        const LARGEST: f64 = 1.6;
        for kind in [
            BridgeKind::Girder(Girder::default()),
            BridgeKind::Arch(Arch::default()),
            BridgeKind::Suspension(Suspension::default()),
        ] {
            let (bridge, deck) = deck_of(kind);
            let at = |position_m: Vec3<Enu>| deck.at(position_m, 0.0).map_or(Vec3::zero(), |air| air.added_m_s);
            let largest_step_m_s = WIND_M_S / (0.05 * deck.depth_m) * STEP_M;
            for k in 0..3000 {
                let across_m = deck.depth_m * (0.01 * f64::from(k) - 10.0);
                let up_m = bridge.center_m.up() + deck.middle_z_m + deck.depth_m * (0.0037 * f64::from(k % 1409) - 2.6);
                let position_m = Vec3::new(0.0, across_m, up_m);
                let here = at(position_m);
                assert!(here.is_finite() && here.norm() < LARGEST * WIND_M_S, "{here:?} at {position_m:?}");
                for step in [Vec3::new(0.0, STEP_M, 0.0), Vec3::new(0.0, 0.0, STEP_M)] {
                    let there = at(position_m + step);
                    assert!((there - here).norm() < largest_step_m_s, "{here:?} {there:?} at {position_m:?}");
                }
            }
        }
    }
}
