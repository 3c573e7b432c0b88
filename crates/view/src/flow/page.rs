//! What a person does, what is shown, and what the window is told to do.

use super::pipe::{FlightStarted, FromWindow};

/// What changes of a controller's profile; all else stays as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ProfileChange {
    /// Which stick does what, 1 to 4.
    Mode(i64),
    /// Dead band of every way, a part of it, 0 to 0.5.
    DeadBand(f64),
    /// Expo of every way, 0 to 1.
    Expo(f64),
}

/// What a person did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeyPress {
    /// One row up.
    Up,
    /// One row down.
    Down,
    /// The value before.
    Left,
    /// The next value.
    Right,
    /// Do it.
    Enter,
    /// Back, or on, whatever is harmless.
    Escape,
    /// Without the last sign.
    Backspace,
    /// A sign was typed.
    Sign(char),
    /// A row was clicked.
    Row(usize),
    /// An arrow beside a row's value was clicked: back, or on.
    Step(usize, bool),
}

/// What is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Page {
    /// Nothing is known yet.
    Opening,
    /// Who flies what.
    Start,
    /// The controller is tried.
    Controls,
    /// And calibrated.
    Calibrating,
    /// So many pages of the tutorial have been turned; whether a flight follows.
    Tutorial(usize, bool),
    /// The simulator starts.
    Waiting,
    /// The flight itself.
    Flight,
    /// It stands still.
    Paused,
    /// An assessment flies on while its pilot is asked whether it is to end.
    Leaving,
    /// Scores.
    Over,
}

/// What the window is to do.
#[derive(Debug, Clone, PartialEq)]
pub enum WindowRequest {
    /// Say this to `train`.
    Tell(FromWindow),
    /// Show this flight.
    Fly(Box<FlightStarted>),
    /// Let go of the flight.
    Land,
    /// Look for a controller again.
    Look,
    /// Begin to calibrate.
    Calibrate,
    /// The wizard's Enter.
    Confirm,
    /// Leave the wizard.
    Cancel,
    /// Change this of the controller's profile, and keep it.
    Tune(ProfileChange),
    /// Show an address in a browser.
    Open(String),
    /// Sound on or off.
    Sound(bool),
    /// Close the window.
    Close,
}
