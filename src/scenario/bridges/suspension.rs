//! Suspension bridge.

/// The numbers of a suspension bridge (defaults in scenarios/README.md).
#[derive(Debug, Clone, PartialEq)]
pub struct Suspension {}
