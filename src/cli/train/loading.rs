//! What the window shows while a flight starts and while it is scored.

use spandrel_text::{Language, text};
use spandrel_view::flow::pipe::ToWindow;

/// A step of starting or scoring a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlightStep {
    /// Reading the job, and its expert's flight.
    Job,
    /// Starting the monitor, which builds the site.
    Monitor,
    /// Starting the simulator.
    Simulator,
    /// Scoring the telemetry.
    Scores,
    /// Importing the session's record.
    Record,
    /// Choosing the next flights.
    NextFlights,
}

impl FlightStep {
    /// Returns how much of the work is done before this step, % (estimates: the site takes most of the start, the telemetry most of the scoring).
    fn progress_pct(self) -> u32 {
        match self {
            Self::Job | Self::Scores => 0,
            Self::Monitor => 5,
            Self::Simulator => 50,
            Self::Record => 60,
            Self::NextFlights => 80,
        }
    }

    fn words(self, language: Language) -> String {
        let pct = self.progress_pct();
        match self {
            Self::Job => text!(language, "window-loading-job", pct = pct),
            Self::Monitor => text!(language, "window-loading-monitor", pct = pct),
            Self::Simulator => text!(language, "window-loading-simulator", pct = pct),
            Self::Scores => text!(language, "window-loading-scores", pct = pct),
            Self::Record => text!(language, "window-loading-record", pct = pct),
            Self::NextFlights => text!(language, "window-loading-next-flights", pct = pct),
        }
    }

    /// Returns the message for the window.
    pub fn message(self, language: Language) -> ToWindow {
        ToWindow::Loading { words: self.words(language) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_steps_are_named_with_a_rising_percentage_in_every_language() {
        for steps in [
            [FlightStep::Job, FlightStep::Monitor, FlightStep::Simulator],
            [FlightStep::Scores, FlightStep::Record, FlightStep::NextFlights],
        ] {
            assert!(steps.windows(2).all(|pair| pair[0].progress_pct() < pair[1].progress_pct()));
            for step in steps {
                let [english, german, spanish] = Language::ALL.map(|language| step.words(language));
                assert!(english != german && german != spanish && english != spanish, "{english}, {german}, {spanish}");
            }
        }
        assert_eq!(
            FlightStep::Simulator.message(Language::English),
            ToWindow::Loading { words: "Starting simulator ... 50%".into() }
        );
    }
}
