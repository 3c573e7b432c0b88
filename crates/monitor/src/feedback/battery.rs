//! Battery: green, yellow, red. A text only when the colour gets worse.

use super::{FeedbackInput, PilotText};
use spandrel_mavlink::contract::cue;
use spandrel_model::scenario::FeedbackThresholds;

/// Colour of the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum BatteryColor {
    /// From `battery_green_pct`.
    #[default]
    Green,
    /// From `battery_yellow_pct`.
    Yellow,
    /// Below; flashes.
    Red,
}

/// Colour of a charge, %.
#[must_use]
pub fn color(battery_pct: f64, limits: &FeedbackThresholds) -> BatteryColor {
    if battery_pct >= limits.battery_green_pct {
        BatteryColor::Green
    } else if battery_pct >= limits.battery_yellow_pct {
        BatteryColor::Yellow
    } else {
        BatteryColor::Red
    }
}

/// The rule. It never goes back to a better colour within a session: batteries do not charge in the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BatteryCue {
    worst: BatteryColor,
}

impl BatteryCue {
    /// Cue and text at one instant.
    pub fn update(&mut self, moment: &FeedbackInput, limits: &FeedbackThresholds) -> (i32, Option<PilotText>) {
        let now = moment.battery_pct.map_or(BatteryColor::Green, |pct| color(pct, limits));
        let worse = now > self.worst;
        self.worst = self.worst.max(now);
        let bit = match self.worst {
            BatteryColor::Green => 0,
            BatteryColor::Yellow => cue::BATTERY_YELLOW,
            BatteryColor::Red => cue::BATTERY_RED,
        };
        let text =
            worse.then(|| PilotText { cue: bit, text: format!("Battery {:.0} %", moment.battery_pct.unwrap_or_default()) });
        (bit, text)
    }
}
