//! The mean air around a bridge that was flown, in two planes: level at the height of the flight, and upright across the deck.

use super::Review;
use super::plots::air_section::{AirPlane, AirSection};
use super::plots::map::is_near_bridge;
use super::plots::speed_scale::SpeedScale;
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Bridge;
use spandrel_model::site::mean_air::MeanAir;
use spandrel_model::site::wind::MeanWind;

/// Shortest time near a bridge for which its air is drawn, s.
const MIN_TIME_S: f64 = 10.0;
/// Distance of the upright plane from the ends of the deck, m.
const END_MARGIN_M: f64 = 2.0;

/// The mean air around a bridge.
#[derive(Debug, Clone, PartialEq)]
pub struct BridgeAir<'a> {
    /// The bridge.
    pub bridge: &'a Bridge,
    /// Mean wind in the middle of the time near the bridge.
    pub wind: MeanWind,
    /// The level plane.
    pub level: AirSection,
    /// The upright plane.
    pub across: AirSection,
    /// Distance of the upright plane from the middle of the bridge in its heading, m.
    pub along_m: f64,
    /// Scale of the speeds in both planes.
    pub speeds: SpeedScale,
}

impl<'a> BridgeAir<'a> {
    /// Computes the air around a bridge; `None` if it does not disturb the wind, without wind, or if the drone was hardly near it.
    #[must_use]
    pub fn of(review: &'a Review, bridge: &'a Bridge) -> Option<Self> {
        let is_near = is_near_bridge(bridge);
        let near: Vec<&Frame> = review.frames.iter().filter(|frame| is_near(frame)).collect();
        let frame_s = 1.0 / review.scenario.scoring.frame_rate_hz;
        if (near.len() as f64) * frame_s < MIN_TIME_S {
            return None;
        }
        let mut air = MeanAir::at(&review.scenario, &review.site, near[near.len() / 2].time)?;
        let flown_m: Vec<Vec3<Enu>> = near.iter().map(|frame| frame.position_m).collect();
        let up_m = median(flown_m.iter().map(|at| at.up()).collect())?;
        let along_m = station_m(review, bridge, &flown_m)?;
        let level = AirSection::new(AirPlane::Level, up_m, bridge, &flown_m, &mut air);
        let across = AirSection::new(AirPlane::Across, along_m, bridge, &flown_m, &mut air);
        let speeds = SpeedScale::up_to(level.speed_range_m_s().1.max(across.speed_range_m_s().1));
        Some(Self { bridge, wind: air.wind(), level, across, along_m, speeds })
    }
}

/// Returns where the air was disturbed most along a bridge, or else where the flight was, m from its middle in its heading.
fn station_m(review: &Review, bridge: &Bridge, flown_m: &[Vec3<Enu>]) -> Option<f64> {
    let along_m = |at: Vec3<Enu>| bridge.placement().local(at)[0];
    let is_here = |zone: usize| review.scenario.bridges.get(zone).is_some_and(|own| own.name == bridge.name);
    let strongest = review.air.places.iter().find(|place| place.zone.is_some_and(|zone| is_here(zone.bridge)));
    let flown = || median(flown_m.iter().map(|at| along_m(*at)).collect());
    let most_m = (0.5 * bridge.deck_length_m() - END_MARGIN_M).max(0.0);
    strongest.map(|place| along_m(place.position_m)).or_else(flown).map(|at_m| at_m.clamp(-most_m, most_m))
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
