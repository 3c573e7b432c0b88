//! Input events, pages, and requests of the window.

use super::pipe::{FlightStarted, FromWindow};
use super::settings::SettingChange;
use spandrel_text::{Language, text};
use std::path::PathBuf;

/// A change to a setting of a controller profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ProfileChange {
    /// Stick mode, 1 to 4.
    Mode(i64),
    /// Dead band of every axis as a fraction of the axis travel, 0 to 0.5.
    DeadBand(f64),
    /// Expo of every axis, 0 to 1.
    Expo(f64),
}

/// A key press or click.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeyPress {
    /// Move the focus up one row.
    Up,
    /// Move the focus down one row.
    Down,
    /// Select the previous value.
    Left,
    /// Select the next value.
    Right,
    /// Activate the row.
    Enter,
    /// Go back or continue, whichever is harmless.
    Escape,
    /// Delete the last character.
    Backspace,
    /// A character was typed.
    Char(char),
    /// A row was clicked.
    Row(usize),
    /// An arrow next to a row's value was clicked: `false` selects the previous value, `true` the next.
    Step(usize, bool),
}

/// Pages of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Page {
    /// Waiting for the first message.
    Opening,
    /// Selection of trainee, job, aircraft, and purpose.
    Start,
    /// Controller check.
    Controls,
    /// Controller calibration.
    Calibrating,
    /// Tutorial: current page number, and whether a flight follows.
    Tutorial(usize, bool),
    /// Settings.
    Settings {
        /// Whether a flight is paused behind it.
        in_flight: bool,
    },
    /// List of keys.
    Keys {
        /// Whether a flight is paused behind it.
        in_flight: bool,
    },
    /// Tasks, hazards and site check before the flight.
    Briefing,
    /// The simulator is starting.
    Waiting,
    /// Flight in progress.
    Flight,
    /// The flight is paused.
    Paused,
    /// Confirmation to end an assessment. The flight continues in the background.
    ConfirmEnd,
    /// The scores after the flight.
    Results,
    /// The defect school.
    School,
}

/// Operation that the window waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PendingOperation {
    /// The simulator starts.
    Simulator,
    /// The flight is scored.
    Scoring,
    /// The pictures of the defect school are rendered.
    Pictures,
}

impl PendingOperation {
    /// Returns the title of the waiting page.
    pub(super) fn title(self, language: Language) -> String {
        match self {
            Self::Simulator => text!(language, "window-waiting-simulator"),
            Self::Scoring => text!(language, "window-waiting-scoring"),
            Self::Pictures => text!(language, "window-waiting-pictures"),
        }
    }
}

/// A request to the program that hosts the window.
#[derive(Debug, Clone, PartialEq)]
pub enum WindowRequest {
    /// Send this message to `spandrel train`.
    Send(FromWindow),
    /// Connect to this flight and show it.
    ShowFlight(Box<FlightStarted>),
    /// Read this telemetry log for the ghost.
    LoadGhost(PathBuf),
    /// Disconnect from the flight.
    LeaveFlight,
    /// Search for a controller.
    FindController,
    /// Start the calibration.
    Calibrate,
    /// Confirm the current wizard step.
    Confirm,
    /// Cancel the wizard.
    Cancel,
    /// Apply and save this change to the controller profile.
    ChangeProfile(ProfileChange),
    /// Open an address in a browser.
    Open(String),
    /// Turn sound on or off.
    Sound(bool),
    /// Apply and save this change to the settings.
    ChangeSetting(SettingChange),
    /// Close the window.
    Close,
}
