//! Safety (the paper's P_S): what was hit.

use super::Score;

/// Loss for a person or a vehicle.
const TRAFFIC_LOSS: f64 = 100.0;
/// Loss for each other crash.
const OTHER_LOSS: f64 = 3.0;

/// `others` counts the onsets of contact with bridge, terrain, water or anything else.
#[must_use]
pub fn score(person: bool, vehicle: bool, others: usize) -> Score {
    let traffic = f64::from(u8::from(person)) + f64::from(u8::from(vehicle));
    Score::on_scale(-TRAFFIC_LOSS * traffic - OTHER_LOSS * others as f64, -100.0, 0.0)
}
