//! Flight mode and landed state.

/// Flight modes. The endpoint maps them to the MAVLink numbers of each emulated autopilot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FlightMode {
    /// Sticks control roll, pitch, yaw rate and thrust.
    Stabilized,
    /// Like stabilized, but with height hold.
    Altitude,
    /// Sticks control velocity. With sticks centered, the vehicle stops and holds position.
    Position,
    /// Hold position.
    Hold,
    /// Automatic takeoff, then hold.
    Takeoff,
    /// Land at the current position.
    Land,
    /// Return to home and land.
    Return,
    /// Fly the uploaded mission.
    Mission,
    /// Track external setpoints.
    Offboard,
    /// Circle a point.
    Orbit,
    /// Sticks control body rates and thrust.
    Acro,
    /// Return to the takeoff point along the recorded path, and land.
    SmartReturn,
    /// Follow a moving target.
    Follow,
}

impl FlightMode {
    /// Returns true if the sticks control the vehicle.
    #[must_use]
    pub fn is_manual(self) -> bool {
        matches!(self, Self::Stabilized | Self::Altitude | Self::Position | Self::Acro)
    }

    /// Returns true if the mode requires a horizontal position.
    #[must_use]
    pub fn needs_position(self) -> bool {
        !matches!(self, Self::Stabilized | Self::Altitude | Self::Acro | Self::Land | Self::Offboard)
    }
}

/// Landed state, as in EXTENDED_SYS_STATE.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LandedState {
    /// On the ground.
    OnGround,
    /// Climbing in takeoff mode.
    TakingOff,
    /// Flying.
    InAir,
    /// Descending to land.
    Landing,
}
