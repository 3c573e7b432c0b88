//! Safety (the paper's P_S): crashes by what was hit.

use super::Score;

/// Points lost for hitting a person, and for hitting a vehicle.
const TRAFFIC_LOSS: f64 = 100.0;
/// Points lost per other crash.
const OTHER_LOSS: f64 = 3.0;

/// Computes safety. `others` is the number of contact onsets with bridge, terrain, water or anything else.
#[must_use]
pub fn score(person: bool, vehicle: bool, others: usize) -> Score {
    let traffic = f64::from(u8::from(person)) + f64::from(u8::from(vehicle));
    Score::on_scale(-TRAFFIC_LOSS * traffic - OTHER_LOSS * others as f64, -100.0, 0.0)
}
