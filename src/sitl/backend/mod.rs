//! Who flies: the built-in autopilot now; PX4 and ArduPilot over their simulator interfaces later.
