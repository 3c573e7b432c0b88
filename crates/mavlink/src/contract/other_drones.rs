//! The other vehicles of the simulator at the same site, for displays.
//!
//! DEBUG_FLOAT_ARRAY with the name `drones`, up to seven times eight values: the system ID, negative while the motors are disarmed, the
//! position relative to the sender (north, east, down), m, and the attitude as a quaternion (w, x, y, z). The first 0 in the place of a
//! system ID ends the list.

use super::float_array::{self, FloatArray};
use crate::dialect::MavMessage;
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};

/// Name in the message.
pub const NAME: &str = "drones";
/// Largest number of other vehicles in a message.
pub const MAX_OTHERS: usize = 7;
/// Number of values of each vehicle.
const VALUES: usize = 8;

/// Another vehicle, as seen from the sender.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OtherDrone {
    /// MAVLink system ID.
    pub system_id: u8,
    /// Whether its motors are armed.
    pub armed: bool,
    /// Position relative to the sender, m.
    pub offset_m: Vec3<Ned>,
    /// Attitude.
    pub attitude: Rotation<Frd, Ned>,
}

/// Encodes the message. `time_us` is the simulation time, µs.
#[must_use]
pub fn message(others: &[OtherDrone], time_us: u64) -> MavMessage {
    let mut values = [0.0; MAX_OTHERS * VALUES];
    for (slot, other) in values.chunks_exact_mut(VALUES).zip(others) {
        let id = f64::from(other.system_id) * if other.armed { 1.0 } else { -1.0 };
        let numbers = [id].into_iter().chain(other.offset_m.array()).chain(other.attitude.wxyz());
        for (value, number) in slot.iter_mut().zip(numbers) {
            *value = number as f32;
        }
    }
    float_array::message(NAME, time_us, values)
}

/// Decodes a message; `None` for other messages. Vehicles without a valid position and attitude are omitted.
#[must_use]
pub fn of(message: &MavMessage) -> Option<Vec<OtherDrone>> {
    let array = FloatArray::named(NAME, message)?;
    let ids = (0..MAX_OTHERS).map(|k| (k * VALUES, f64::from(array.raw(k * VALUES)))).take_while(|(_, id)| *id != 0.0);
    let one = |(at, id): (usize, f64)| {
        let system_id = Some(id.abs()).filter(|id| (1.0..=255.0).contains(id))? as u8;
        let offset_m = array.triple(at + 1).map(|[north, east, down]| Vec3::new(north, east, down))?;
        let [x, y, z] = array.triple(at + 5)?;
        let attitude = Rotation::from_wxyz([array.finite(at + 4)?, x, y, z])?;
        Some(OtherDrone { system_id, armed: id > 0.0, offset_m, attitude })
    };
    Some(ids.filter_map(one).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::{Decoder, Encoder};

    fn received(others: &[OtherDrone]) -> Option<Vec<OtherDrone>> {
        let bytes = Encoder::new(1, 1).encode(&message(others, 5_000_000));
        of(&Decoder::new().datagram(&bytes).remove(0).message.unwrap())
    }

    #[test]
    fn wire_other_drones_survive_the_link() {
        let drone = |system_id: u8| OtherDrone {
            system_id,
            armed: system_id.is_multiple_of(2),
            offset_m: Vec3::new(0.5 * f64::from(system_id), -2.25, 1.5),
            attitude: Rotation::identity(),
        };
        for count in 0..=MAX_OTHERS as u8 {
            let all: Vec<OtherDrone> = (2..2 + count).map(drone).collect();
            assert_eq!(received(&all), Some(all));
        }
        let turned = OtherDrone { attitude: Rotation::from_euler(0.3, -0.2, 2.0), ..drone(4) };
        let read = received(&[turned]).unwrap()[0];
        assert!(read.attitude.wxyz().iter().zip(turned.attitude.wxyz()).all(|(a, b)| (a - b).abs() < 1e-6), "{read:?}");
    }

    #[test]
    fn wire_invalid_vehicles_are_omitted() {
        let drone =
            OtherDrone { system_id: 2, armed: true, offset_m: Vec3::new(f64::NAN, 0.0, 0.0), attitude: Rotation::identity() };
        let valid = OtherDrone { system_id: 3, offset_m: Vec3::zero(), ..drone };
        assert_eq!(received(&[drone, valid]), Some(vec![valid]));
        assert_eq!(of(&super::super::hazards::HazardReport::default().message(1)), None);
    }
}
