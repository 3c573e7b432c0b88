//! Ground truth and counters for scoring.

use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_model::site::inspector_walks::MAX_TURNS;

/// Scoring data other than the motion (docs/src/reference/wire.md, "Scoring data").
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ScoringTruth {
    /// Kind of contact.
    pub contact: ContactKind,
    /// Number of contacts so far.
    pub hits: i32,
    /// Number of respawns.
    pub respawns: i32,
    /// Number of freezes, without those after a rewind.
    pub freezes: i32,
    /// Number of rewinds.
    pub rewinds: i32,
    /// Whether the flight is frozen.
    pub is_frozen: bool,
    /// The last two traffic changes, encoded as on the wire; 0 if there was no change.
    pub traffic: [i32; 2],
    /// The inspector's last walk and its turns, encoded as on the wire; 0 if there are fewer.
    pub walks: [i32; MAX_TURNS],
    /// The session's seed.
    pub seed: i32,
    /// CRC of the scenario.
    pub scenario_crc: u32,
    /// Distance from the drone's center to the nearest surface, m.
    pub clearance_m: f64,
    /// Ambient light at the drone, lux.
    pub lux: f64,
}
