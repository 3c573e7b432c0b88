//! Parameters: the names that ground stations look for, our own group, ranges, and the byte-wise encoding of PX4.

use crate::sitl::autopilot::{FenceAction, LinkLoss, Tuning};
use std::collections::BTreeMap;

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

/// One parameter: name, default, allowed range.
#[derive(Debug, Clone, Copy)]
struct Row(&'static str, Value, f64, f64);

use Value::{Int, Real};

/// Names from QGroundControl's and MAVSDK's sources (mavlink.md 1.4), with PX4's defaults where they have a meaning here.
const ROWS: &[Row] = &[
    Row("BAT1_N_CELLS", Int(3), 1.0, 16.0),
    Row("BAT1_SOURCE", Int(-1), -1.0, 2.0),
    Row("BAT1_V_CHARGED", Real(4.2), 3.0, 5.0),
    Row("BAT1_V_EMPTY", Real(3.5), 2.5, 4.5),
    Row("BAT_CRIT_THR", Real(0.07), 0.0, 0.5),
    Row("BAT_EMERGEN_THR", Real(0.05), 0.0, 0.5),
    Row("BAT_LOW_THR", Real(0.15), 0.0, 0.9),
    Row("CAL_ACC0_ID", Int(1_310_988), 0.0, 2e9),
    Row("CAL_GYRO0_ID", Int(1_310_988), 0.0, 2e9),
    Row("CAL_MAG0_ID", Int(197_388), 0.0, 2e9),
    Row("CAL_MAG0_ROT", Int(0), -1.0, 40.0),
    Row("COM_DISARM_LAND", Real(2.0), -1.0, 60.0),
    Row("COM_DISARM_PRFLT", Real(10.0), -1.0, 600.0),
    Row("COM_DL_LOSS_T", Int(10), 1.0, 300.0),
    Row("COM_FLTMODE1", Int(-1), -1.0, 20.0),
    Row("COM_FLTMODE2", Int(-1), -1.0, 20.0),
    Row("COM_FLTMODE3", Int(-1), -1.0, 20.0),
    Row("COM_FLTMODE4", Int(-1), -1.0, 20.0),
    Row("COM_FLTMODE5", Int(-1), -1.0, 20.0),
    Row("COM_FLTMODE6", Int(-1), -1.0, 20.0),
    Row("COM_OF_LOSS_T", Real(1.0), 0.1, 60.0),
    Row("COM_RC_IN_MODE", Int(1), 0.0, 5.0),
    Row("COM_RC_LOSS_T", Real(0.5), 0.1, 35.0),
    Row("CP_DIST", Real(-1.0), -1.0, 15.0),
    Row("GF_ACTION", Int(2), 0.0, 5.0),
    Row("GF_MAX_HOR_DIST", Real(0.0), 0.0, 1e4),
    Row("GF_MAX_VER_DIST", Real(0.0), 0.0, 1e4),
    Row("LND_FLIGHT_T_HI", Int(0), 0.0, 2e9),
    Row("LND_FLIGHT_T_LO", Int(0), -2e9, 2e9),
    Row("MAV_COMP_ID", Int(1), 1.0, 250.0),
    Row("MAV_SYS_ID", Int(1), 1.0, 250.0),
    Row("MAV_TYPE", Int(2), 0.0, 50.0),
    Row("MIS_TAKEOFF_ALT", Real(2.5), 0.5, 80.0),
    Row("MPC_LAND_SPEED", Real(0.7), 0.3, 3.0),
    Row("MPC_MAN_TILT_MAX", Real(35.0), 5.0, 60.0),
    Row("MPC_TKO_SPEED", Real(1.5), 0.5, 5.0),
    Row("MPC_XY_CRUISE", Real(5.0), 0.5, 20.0),
    Row("MPC_XY_VEL_MAX", Real(12.0), 0.5, 30.0),
    Row("MPC_Z_VEL_MAX_DN", Real(1.5), 0.3, 10.0),
    Row("MPC_Z_VEL_MAX_UP", Real(3.0), 0.3, 15.0),
    Row("NAV_ACC_RAD", Real(2.0), 0.2, 200.0),
    Row("NAV_DLL_ACT", Int(0), 0.0, 3.0),
    Row("NAV_RCL_ACT", Int(1), 1.0, 3.0),
    Row("RC_CHAN_CNT", Int(0), 0.0, 18.0),
    Row("RC_MAP_FLTMODE", Int(0), 0.0, 18.0),
    Row("RC_MAP_MODE_SW", Int(0), 0.0, 18.0),
    Row("RC_MAP_PITCH", Int(0), 0.0, 18.0),
    Row("RC_MAP_ROLL", Int(0), 0.0, 18.0),
    Row("RC_MAP_THROTTLE", Int(0), 0.0, 18.0),
    Row("RC_MAP_YAW", Int(0), 0.0, 18.0),
    Row("RTL_DESCEND_ALT", Real(10.0), 2.0, 100.0),
    Row("RTL_LAND_DELAY", Real(0.0), -1.0, 300.0),
    Row("RTL_RETURN_ALT", Real(30.0), 2.0, 150.0),
    Row("SENS_BOARD_ROT", Int(0), 0.0, 40.0),
    Row("SENS_DPRES_OFF", Real(0.0), -1e3, 1e3),
    Row("SPAN_FLAVOUR", Int(0), 0.0, 2.0),
    Row("SYS_AUTOCONFIG", Int(0), 0.0, 2.0),
    Row("SYS_AUTOSTART", Int(4001), 0.0, 1e6),
    Row("SYS_HAS_MAG", Int(1), 0.0, 3.0),
    Row("SYS_HAS_NUM_ASPD", Int(0), 0.0, 1.0),
    Row("SYS_HITL", Int(0), 0.0, 2.0),
];

/// PX4's name for the checksum over all parameters.
pub const HASH: &str = "_HASH_CHECK";
/// Parameters that change by themselves and are left out of it.
const VOLATILE: [&str; 2] = ["LND_FLIGHT_T_HI", "LND_FLIGHT_T_LO"];

/// Parameters that describe the vehicle and cannot be set.
const READ_ONLY: [&str; 4] = ["MAV_SYS_ID", "MAV_COMP_ID", "SPAN_FLAVOUR", "MAV_TYPE"];

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

/// The parameter table: present values by name, in the order of their names.
#[derive(Debug, Clone, PartialEq)]
pub struct Params {
    values: BTreeMap<&'static str, Value>,
}

impl Params {
    /// Defaults for a vehicle.
    #[must_use]
    pub fn new(system_id: u8, cells: u32, battery: Thresholds) -> Self {
        let mut values: BTreeMap<&'static str, Value> = ROWS.iter().map(|r| (r.0, r.1)).collect();
        values.insert("MAV_SYS_ID", Int(i32::from(system_id)));
        values.insert("BAT1_N_CELLS", Int(cells.cast_signed()));
        values.insert("BAT_LOW_THR", Real((battery.low_pct / 100.0) as f32));
        values.insert("BAT_CRIT_THR", Real((battery.critical_pct / 100.0) as f32));
        Self { values }
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
        for (name, value) in self.values.iter().filter(|(name, _)| !VOLATILE.contains(name)) {
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
        let row = ROWS.iter().find(|r| r.0 == name).ok_or(Refusal::Unknown)?;
        let value = match row.1 {
            Int(_) if !real => Int(wire.to_bits().cast_signed()),
            Real(_) if real => Real(wire),
            Int(_) | Real(_) => return Err(Refusal::Type),
        };
        if READ_ONLY.contains(&name) {
            return Err(Refusal::ReadOnly);
        }
        let number = value.number();
        if number.is_nan() || number < row.2 || number > row.3 {
            return Err(Refusal::OutOfRange);
        }
        self.values.insert(row.0, value);
        Ok(())
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
        for (name, value) in params.values.iter().filter(|(name, _)| !VOLATILE.contains(name)) {
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
