//! Where a place is, relative to the bridges, in words.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{Bridge, Scenario};
use spandrel_text::{Language, text};

/// Side of a bridge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BridgeSide {
    /// Below the deck.
    Under,
    /// Above the deck.
    Above,
    /// Beside the deck, or beyond its ends.
    Beside,
}

/// Place relative to the nearest bridge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BridgeZone {
    /// Index of the bridge.
    pub bridge: usize,
    /// Side of the bridge.
    pub side: BridgeSide,
}

impl BridgeZone {
    /// Returns the zone of a position; `None` in a job without bridges.
    #[must_use]
    pub fn of(scenario: &Scenario, position_m: Vec3<Enu>) -> Option<Self> {
        let distances_m = scenario.bridges.iter().map(|bridge| distance_m(bridge, position_m)).enumerate();
        let (bridge, away_m) = distances_m.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let own = &scenario.bridges[bridge];
        let (low_m, high_m) = own.fascia_z_m();
        let up_m = position_m.up() - own.center_m.up();
        let side = match away_m {
            away_m if away_m > 0.0 => BridgeSide::Beside,
            _ if up_m < 0.5 * (low_m + high_m) => BridgeSide::Under,
            _ => BridgeSide::Above,
        };
        Some(Self { bridge, side })
    }

    /// Returns the zone in words, such as "under the deck of bridge 'arch'".
    #[must_use]
    pub fn words(self, scenario: &Scenario, language: Language) -> String {
        let bridge = scenario.bridges.get(self.bridge).map_or("", |bridge| bridge.name.as_str());
        match self.side {
            BridgeSide::Under => text!(language, "report-place-under", bridge = bridge),
            BridgeSide::Above => text!(language, "report-place-above", bridge = bridge),
            BridgeSide::Beside => text!(language, "report-place-beside", bridge = bridge),
        }
    }
}

/// Returns the horizontal distance from a bridge's deck, m.
fn distance_m(bridge: &Bridge, position_m: Vec3<Enu>) -> f64 {
    let [along_m, left_m, _] = bridge.placement().local(position_m);
    let beyond = |at_m: f64, size_m: f64| (at_m.abs() - 0.5 * size_m).max(0.0);
    spandrel_model::math::hypot(beyond(along_m, bridge.deck_length_m()), beyond(left_m, bridge.deck_width_m()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{scenario, shipped};

    #[test]
    fn exact_zones_are_under_above_and_beside_the_nearest_deck() {
        let job = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &|_| Err("none".into())).unwrap();
        for (k, bridge) in job.bridges.iter().enumerate() {
            let (low_m, high_m) = bridge.fascia_z_m();
            let half_m = 0.5 * bridge.deck_width_m();
            for (local, side, words) in [
                ([3.0, 0.0, low_m - 1.0], BridgeSide::Under, "under the deck"),
                ([3.0, 0.0, high_m + 1.0], BridgeSide::Above, "above the deck"),
                ([3.0, half_m + 2.0, high_m], BridgeSide::Beside, "beside bridge"),
                ([0.5 * bridge.deck_length_m() + 2.0, 0.0, low_m], BridgeSide::Beside, "beside bridge"),
            ] {
                let zone = BridgeZone::of(&job, bridge.placement().point(local)).unwrap();
                assert_eq!(zone, BridgeZone { bridge: k, side }, "{local:?}");
                let text = zone.words(&job, Language::English);
                assert!(text.contains(words) && text.contains(&bridge.name), "{text}");
            }
        }
    }
}
