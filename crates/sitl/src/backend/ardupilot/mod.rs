//! ArduPilot's JSON simulator interface over UDP.
