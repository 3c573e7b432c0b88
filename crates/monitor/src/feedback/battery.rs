//! Battery cue: green, yellow or red. Sends a text only when the color gets worse.

use super::input::FeedbackInput;
use super::pilot_text::PilotText;
use spandrel_mavlink::contract::cue;
use spandrel_model::scenario::FeedbackThresholds;

/// Battery display color. The scenario sets the limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum BatteryColor {
    /// At or above `battery_green_pct`.
    #[default]
    Green,
    /// At or above `battery_yellow_pct`.
    Yellow,
    /// Below `battery_yellow_pct`; the display flashes.
    Red,
}

/// Returns the display color for a battery charge in percent.
#[must_use]
pub fn battery_color(battery_pct: f64, limits: &FeedbackThresholds) -> BatteryColor {
    if battery_pct >= limits.battery_green_pct {
        BatteryColor::Green
    } else if battery_pct >= limits.battery_yellow_pct {
        BatteryColor::Yellow
    } else {
        BatteryColor::Red
    }
}

/// Battery rule. The color never improves during a session because the battery cannot charge in flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct BatteryCue {
    worst_color: BatteryColor,
}

impl BatteryCue {
    /// Updates the rule and returns the cue bits and any text to send.
    pub fn update(&mut self, input: &FeedbackInput, limits: &FeedbackThresholds) -> (i32, Option<PilotText>) {
        let now = input.battery_pct.map_or(BatteryColor::Green, |pct| battery_color(pct, limits));
        let worse = now > self.worst_color;
        self.worst_color = self.worst_color.max(now);
        let bit = match self.worst_color {
            BatteryColor::Green => 0,
            BatteryColor::Yellow => cue::BATTERY_YELLOW,
            BatteryColor::Red => cue::BATTERY_RED,
        };
        let text = worse.then(|| PilotText { cue: bit, text: format!("Battery {:.0}%", input.battery_pct.unwrap_or_default()) });
        (bit, text)
    }
}
