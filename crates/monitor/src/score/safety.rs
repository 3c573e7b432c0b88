//! Safety (P_S in the TASBID paper): crashes by kind of object.

use super::Score;

/// Points lost if a person or vehicle was hit.
const PERSON_OR_VEHICLE_CRASH_LOSS: f64 = 100.0;
/// Points lost for any other crash.
const OTHER_CRASH_LOSS: f64 = 3.0;

/// Computes the safety score. `others` is the number of contacts with anything except people and vehicles.
#[must_use]
pub fn score(person: bool, vehicle: bool, others: usize) -> Score {
    let traffic = f64::from(u8::from(person)) + f64::from(u8::from(vehicle));
    Score::clamped_to_scale(-PERSON_OR_VEHICLE_CRASH_LOSS * traffic - OTHER_CRASH_LOSS * others as f64, -100.0, 0.0)
}
