//! Open-spandrel deck arch.

/// The numbers of an open-spandrel deck arch (shared names of the field; defaults in scenarios/README.md).
#[derive(Debug, Clone, PartialEq)]
pub struct Arch {}
