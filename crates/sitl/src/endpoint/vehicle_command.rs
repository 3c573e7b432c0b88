//! Common representation of commands from COMMAND_LONG, COMMAND_INT and mission items.

use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::dialect::MISSION_ITEM_INT_DATA;

/// Coordinates that mean "not set", in degrees E7; none is a valid position.
const UNSET_COORDINATES: [i32; 3] = [i32::MAX, i32::MIN, 0x7ff8_0000];

/// A command from COMMAND_LONG, COMMAND_INT or a mission item.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleCommand {
    /// MAV_CMD number.
    pub number: u16,
    /// Parameters 1 to 7. Parameters 5 and 6 are in degrees or meters, regardless of the message.
    pub p: [f64; 7],
    /// MAV_FRAME number. COMMAND_LONG is treated as global with an altitude above mean sea level.
    pub frame: u8,
    /// Target component ID.
    pub component: u8,
    /// Target system ID.
    pub system: u8,
    /// The sender's system and component ID.
    pub from: (u8, u8),
    /// Whether parameters 5 and 6 were received as scaled integers.
    pub whole: bool,
    /// Whether the vehicle issued the command itself (mission item). Such commands always have gimbal control.
    pub own: bool,
}

const COMMAND_LONG_ID: u32 = 76;
const COMMAND_INT_ID: u32 = 75;

impl VehicleCommand {
    /// Reads a command from a received frame; `None` for other messages. Parses the raw bytes so that unknown command
    /// numbers are accepted.
    #[must_use]
    pub fn of(frame: &ReceivedFrame) -> Option<Self> {
        let from = (frame.system_id, frame.component_id);
        let b = match frame.message_id {
            COMMAND_LONG_ID => frame.payload(33),
            COMMAND_INT_ID => frame.payload(35),
            _ => return None,
        };
        let four = |at: usize| [b[at], b[at + 1], b[at + 2], b[at + 3]];
        let real = |at: usize| f64::from(f32::from_le_bytes(four(at)));
        let number = u16::from_le_bytes([b[28], b[29]]);
        let mut p = [real(0), real(4), real(8), real(12), real(16), real(20), real(24)];
        if frame.message_id == COMMAND_LONG_ID {
            return Some(Self { number, p, frame: 0, component: b[31], system: b[30], from, whole: false, own: false });
        }
        let scaled = |at: usize| {
            let whole = i32::from_le_bytes(four(at));
            // INT32_MAX means "not set" (MAVLink: COMMAND_INT); the other values result from clients that convert NaN
            // to an integer.
            if UNSET_COORDINATES.contains(&whole) { f64::NAN } else { f64::from(whole) * 1e-7 }
        };
        (p[4], p[5]) = (scaled(16), scaled(20));
        Some(Self { number, p, frame: b[32], component: b[31], system: b[30], from, whole: true, own: false })
    }

    /// Creates a command from a mission item, as issued by the vehicle itself.
    #[must_use]
    pub fn from_item(item: &MISSION_ITEM_INT_DATA, from: (u8, u8)) -> Self {
        let [x, y] = [item.x, item.y].map(|scaled| if scaled == i32::MAX { f64::NAN } else { f64::from(scaled) * 1e-7 });
        let p = [item.param1, item.param2, item.param3, item.param4].map(f64::from);
        let p = [p[0], p[1], p[2], p[3], x, y, f64::from(item.z)];
        let (number, frame, (system, component)) = (item.command as u16, item.frame as u8, from);
        Self { number, p, frame, component, system, from, whole: true, own: true }
    }

    /// Returns whether the altitude is relative to home, or `None` for a frame without a global position.
    #[must_use]
    pub fn is_home_relative(&self) -> Option<bool> {
        match self.frame {
            0 | 5 => Some(false),
            3 | 6 | 10 | 11 => Some(true),
            _ => None,
        }
    }

    /// Checks whether a parameter is 1.
    #[must_use]
    pub fn is_one(&self, k: usize) -> bool {
        (self.p[k] - 1.0).abs() < 1e-6
    }

    /// Returns a parameter if it is finite.
    #[must_use]
    pub fn finite_param(&self, k: usize) -> Option<f64> {
        Some(self.p[k]).filter(|v| v.is_finite())
    }

    /// Checks for latitude 0 and longitude 0, which clients send to clear the region of interest. A mission item may
    /// also leave the coordinates unset.
    #[must_use]
    pub fn clears_region_of_interest(&self) -> bool {
        [4, 5].iter().all(|k| self.p[*k] == 0.0 || (self.own && self.p[*k].is_nan()))
    }

    /// Returns a small integer parameter, if it is set. Parameters 5 and 6 of COMMAND_INT and mission items should not
    /// be scaled in this case, but some ground stations scale them anyway.
    #[must_use]
    pub fn small_integer(&self, k: usize) -> Option<f64> {
        let value = self.finite_param(k)?;
        if !(self.whole && matches!(k, 4 | 5)) || (value != 0.0 && value.fract() == 0.0) {
            return Some(value);
        }
        Some((value * 1e7).round())
    }
}
