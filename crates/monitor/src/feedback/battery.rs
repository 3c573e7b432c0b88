//! Battery: green, yellow, red. A text only when the colour gets worse.

use super::{Moment, Text};
use spandrel_mavlink::contract::cue;
use spandrel_model::scenario::Feedback;

/// Colour of the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Colour {
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
pub fn colour(battery_pct: f64, limits: &Feedback) -> Colour {
    if battery_pct >= limits.battery_green_pct {
        Colour::Green
    } else if battery_pct >= limits.battery_yellow_pct {
        Colour::Yellow
    } else {
        Colour::Red
    }
}

/// The rule. It never goes back to a better colour within a session: batteries do not charge in the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Battery {
    worst: Colour,
}

impl Battery {
    /// Cue and text at one instant.
    pub fn see(&mut self, moment: &Moment, limits: &Feedback) -> (i32, Option<Text>) {
        let now = moment.battery_pct.map_or(Colour::Green, |pct| colour(pct, limits));
        let worse = now > self.worst;
        self.worst = self.worst.max(now);
        let bit = match self.worst {
            Colour::Green => 0,
            Colour::Yellow => cue::BATTERY_YELLOW,
            Colour::Red => cue::BATTERY_RED,
        };
        let text = worse.then(|| Text { cue: bit, words: format!("Battery {:.0} %", moment.battery_pct.unwrap_or_default()) });
        (bit, text)
    }
}
