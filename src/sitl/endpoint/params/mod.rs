//! Parameters: the names that ground stations look for, our own group, ranges, and the byte-wise encoding of PX4.

pub mod metadata;
mod table;
pub mod text;

use crate::base::time::SimTime;
use crate::sitl::autopilot::{FenceAction, LinkLoss, Tuning};
use Value::{Int, Real};
use std::collections::BTreeMap;
use table::{ROWS, Row};

/// A value with its type.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// INT32.
    Int(i32),
    /// REAL32.
    Real(f32),
}

impl Value {
    /// Byte-wise into the wire's float field.
    #[must_use]
    pub fn to_wire(self) -> f32 {
        match self {
            Self::Int(i) => f32::from_bits(i.cast_unsigned()),
            Self::Real(r) => r,
        }
    }

    fn number(self) -> f64 {
        match self {
            Self::Int(i) => f64::from(i),
            Self::Real(r) => f64::from(r),
        }
    }
}

/// PX4's name for the checksum over all parameters.
pub const HASH: &str = "_HASH_CHECK";
/// Why a parameter was not set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// No such name.
    Unknown,
    /// Outside its range, or not a number.
    OutOfRange,
    /// Another type than the parameter's.
    Type,
    /// Cannot be changed.
    ReadOnly,
}

/// When the battery counts as low and as critical; the job's rules say so until an operator does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds {
    /// Low, %.
    pub low_pct: f64,
    /// Critical, %.
    pub critical_pct: f64,
}

/// What an instructor can make of the world by parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct World {
    /// Mean wind at 20 ft, m/s, and where it comes from, degrees; `None`: the scenario's.
    pub wind: Option<(f64, f64)>,
    /// Share of datagrams that is lost, each way.
    pub loss: f64,
    /// How late the others are, each way.
    pub delay: SimTime,
}

/// What happens when a second sender moves sticks while the first is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Policy {
    /// Who has the sticks keeps them until he falls silent or lets go.
    FirstKeeps,
    /// Who moves a stick off its middle takes them.
    LatestTakes,
}

/// The parameter table: present values by name, in the order of their names.
#[derive(Debug, Clone, PartialEq)]
pub struct Params {
    values: BTreeMap<&'static str, Value>,
    changes: u64,
}

impl Params {
    /// Defaults for a vehicle.
    #[must_use]
    pub fn new(system_id: u8, cells: u32, battery: Thresholds) -> Self {
        let mut values: BTreeMap<&'static str, Value> = ROWS.iter().map(|row| (row.name, row.default)).collect();
        values.insert("MAV_SYS_ID", Int(i32::from(system_id)));
        values.insert("BAT1_N_CELLS", Int(cells.cast_signed()));
        values.insert("BAT_LOW_THR", Real((battery.low_pct / 100.0) as f32));
        values.insert("BAT_CRIT_THR", Real((battery.critical_pct / 100.0) as f32));
        Self { values, changes: 0 }
    }

    /// Back to the defaults of the vehicle.
    pub fn reset(&mut self, defaults: &Self) {
        if self.values != defaults.values {
            self.values.clone_from(&defaults.values);
            self.changes += 1;
        }
    }

    /// Changes so far.
    #[must_use]
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Allowed range of a parameter.
    #[must_use]
    pub fn range(&self, name: &str) -> Option<(f64, f64)> {
        find(name).map(|row| (row.low, row.high))
    }

    /// How many.
    #[must_use]
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// PX4's checksum: CRC-32 without pre- and post-inversion over name and value of each, in the order of their names.
    #[must_use]
    pub fn hash(&self) -> u32 {
        // The crate inverts the register at both ends: inverting around it leaves the plain polynomial.
        let mut crc = crc32fast::Hasher::new_with_initial(u32::MAX);
        for (name, value) in self.values.iter().filter(|(name, _)| !is_volatile(name)) {
            crc.update(name.as_bytes());
            crc.update(&value.to_wire().to_bits().to_le_bytes());
        }
        !crc.finalize()
    }

    /// By place in the list.
    #[must_use]
    pub fn at(&self, index: usize) -> Option<(&'static str, Value)> {
        self.values.iter().nth(index).map(|(n, v)| (*n, *v))
    }

    /// By name, with its place.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<(usize, &'static str, Value)> {
        self.values.iter().enumerate().find(|(_, (n, _))| **n == name).map(|(k, (n, v))| (k, *n, *v))
    }

    /// Sets a value from the wire's float field, whose bits are an integer for integer parameters.
    ///
    /// # Errors
    /// [`Refusal`], and nothing is changed.
    pub fn set(&mut self, name: &str, wire: f32, real: bool) -> Result<(), Refusal> {
        let row = find(name).ok_or(Refusal::Unknown)?;
        let value = match row.default {
            Int(_) if !real => Int(wire.to_bits().cast_signed()),
            Real(_) if real => Real(wire),
            Int(_) | Real(_) => return Err(Refusal::Type),
        };
        if row.read_only {
            return Err(Refusal::ReadOnly);
        }
        let number = value.number();
        if number.is_nan() || number < row.low || number > row.high {
            return Err(Refusal::OutOfRange);
        }
        if self.values.insert(row.name, value) != Some(value) {
            self.changes += 1;
        }
        Ok(())
    }

    /// The value of a whole-number parameter.
    #[must_use]
    pub fn whole(&self, name: &str) -> Option<i32> {
        self.values.get(name).and_then(|value| if let Int(whole) = value { Some(*whole) } else { None })
    }

    /// Who of several senders has the sticks.
    #[must_use]
    pub fn stick_policy(&self) -> Policy {
        if self.whole("SPAN_STICKS") == Some(1) { Policy::LatestTakes } else { Policy::FirstKeeps }
    }

    /// Speed of missions, returns and go-to, m/s.
    #[must_use]
    pub fn cruise_m_s(&self) -> f64 {
        self.number("MPC_XY_CRUISE")
    }

    /// What an instructor has made of the world.
    #[must_use]
    pub fn world(&self) -> World {
        let wind_m_s = Some(self.number("SIM_WIND_SPD")).filter(|speed| *speed >= 0.0);
        World {
            wind: wind_m_s.map(|speed| (speed, self.number("SIM_WIND_DIR"))),
            loss: self.number("SIM_LINK_LOSS") / 100.0,
            delay: SimTime::from_ms(self.number("SIM_LINK_DELAY") as i64),
        }
    }

    fn number(&self, name: &str) -> f64 {
        self.values.get(name).map_or(0.0, |v| v.number())
    }

    /// Carries the values into the autopilot's settings.
    pub fn apply(&self, tuning: &mut Tuning) {
        tuning.takeoff_height_m = self.number("MIS_TAKEOFF_ALT");
        tuning.takeoff_speed_m_s = self.number("MPC_TKO_SPEED");
        tuning.land_speed_m_s = self.number("MPC_LAND_SPEED");
        tuning.cruise_m_s = self.number("MPC_XY_CRUISE");
        tuning.horizontal_speed_max_m_s = self.number("MPC_XY_VEL_MAX");
        tuning.climb_m_s = self.number("MPC_Z_VEL_MAX_UP");
        tuning.descend_m_s = self.number("MPC_Z_VEL_MAX_DN");
        tuning.return_height_m = self.number("RTL_RETURN_ALT");
        tuning.accept_radius_m = self.number("NAV_ACC_RAD");
        tuning.manual_loss_s = self.number("COM_RC_LOSS_T");
        tuning.data_link_loss_s = self.number("COM_DL_LOSS_T");
        tuning.offboard_loss_s = self.number("COM_OF_LOSS_T");
        tuning.battery_low_pct = 100.0 * self.number("BAT_LOW_THR");
        tuning.battery_critical_pct = 100.0 * self.number("BAT_CRIT_THR");
        tuning.disarm_after_landing_s = self.number("COM_DISARM_LAND");
        tuning.disarm_before_flight_s = self.number("COM_DISARM_PRFLT");
        tuning.fence_action = FenceAction::from_number(self.number("GF_ACTION") as i32).unwrap_or(FenceAction::Hold);
        tuning.fence_distance_m = self.number("GF_MAX_HOR_DIST");
        tuning.fence_height_m = self.number("GF_MAX_VER_DIST");
        tuning.manual_loss = LinkLoss::from_number(self.number("NAV_RCL_ACT") as i32).unwrap_or(LinkLoss::Hold);
        tuning.data_link_loss = LinkLoss::from_number(self.number("NAV_DLL_ACT") as i32).unwrap_or(LinkLoss::Ignore);
    }
}

fn find(name: &str) -> Option<&'static Row> {
    ROWS.iter().find(|row| row.name == name)
}

fn is_volatile(name: &str) -> bool {
    find(name).is_some_and(|row| row.volatile)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_integers_travel_byte_wise_and_bad_values_change_nothing() {
        let mut params = Params::new(1, 3, Thresholds { low_pct: 30.0, critical_pct: 10.0 });
        let before = params.clone();
        assert_eq!(params.set("MIS_TAKEOFF_ALT", f32::NAN, true), Err(Refusal::OutOfRange));
        assert_eq!(params.set("MIS_TAKEOFF_ALT", 1e6, true), Err(Refusal::OutOfRange));
        assert_eq!(params.set("NAV_RCL_ACT", 2.0, true), Err(Refusal::Type));
        assert_eq!(params.set("NO_SUCH", 2.0, true), Err(Refusal::Unknown));
        assert_eq!(params, before);
        assert_eq!(params.set("NAV_RCL_ACT", Int(2).to_wire(), false), Ok(()));
        assert_eq!(params.find("NAV_RCL_ACT").map(|p| p.2), Some(Int(2)));
    }

    /// The checksum by hand, bit by bit: polynomial 0xEDB88320, register from zero, nothing inverted.
    #[test]
    fn exact_the_checksum_is_the_plain_polynomial_and_changes_with_every_value() {
        let mut params = Params::new(1, 3, Thresholds { low_pct: 30.0, critical_pct: 10.0 });
        let mut register = 0u32;
        for (name, value) in params.values.iter().filter(|(name, _)| !is_volatile(name)) {
            for byte in name.bytes().chain(value.to_wire().to_bits().to_le_bytes()) {
                register ^= u32::from(byte);
                for _ in 0..8 {
                    register = register >> 1 ^ if register & 1 == 1 { 0xEDB8_8320 } else { 0 };
                }
            }
        }
        assert_eq!(params.hash(), register);
        params.set("MIS_TAKEOFF_ALT", 3.0, true).unwrap();
        assert_ne!(params.hash(), register);
    }
}
