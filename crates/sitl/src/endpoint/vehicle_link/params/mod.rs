//! Parameters: names that ground stations expect, this software's own group, ranges, and each flavor's view. Values are
//! stored under one set of names; other flavors' names convert them to their own units.

mod behavior;
mod copter;
mod copter_behavior;
mod derived_rows;
mod follow_rule;
pub mod metadata;
pub mod packed;
mod param_value;
pub mod param_view;
mod row;
mod rules;
mod stored;
mod table;
pub mod text;
mod wire_types;

use crate::autopilot::operator_rules::FlightEnvelope;
use crate::autopilot::{FenceAction, LinkLossAction, Tuning};
pub use param_value::ParamValue;
use param_value::ParamValue::{Int, Real};
pub use param_view::ParamView;
use row::{ParamSource, Row};
use spandrel_mavlink::contract::stick_request;
use spandrel_mavlink::dialect::MavParamType;
use spandrel_model::stick_response::StickResponse;
use spandrel_model::time::SimTime;
use std::collections::BTreeMap;

/// PX4's name for the checksum of all parameters.
pub const HASH_NAME: &str = "_HASH_CHECK";
/// Name of the parameter that enables the geofence, for flavors that have one.
pub const FENCE_ENABLE_NAME: &str = "FENCE_ENABLE";
/// The reason a parameter was not set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParamRefusal {
    /// No parameter has this name.
    Unknown,
    /// The value is out of range or NaN.
    OutOfRange,
    /// The value has the wrong type.
    Type,
    /// The parameter is read-only.
    ReadOnly,
}

/// Battery thresholds; the job's rules apply until an operator changes them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BatteryThresholds {
    /// Low battery threshold, %.
    pub low_charge_pct: f64,
    /// Critical battery threshold, %.
    pub critical_charge_pct: f64,
}

/// Aircraft properties that parameters report.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AircraftValues {
    /// Number of cells in series.
    pub cells: u32,
    /// Battery capacity, mAh.
    pub capacity_mah: f64,
    /// Battery thresholds.
    pub thresholds: BatteryThresholds,
    /// Whether the job's rules return the vehicle when the battery is low.
    pub returns_on_low_battery: bool,
    /// The job's response to the sticks.
    pub stick_response: StickResponse,
    /// Limits of the airframe.
    pub frame: FlightEnvelope,
}

impl AircraftValues {
    /// A small aircraft for tests that do not depend on the aircraft.
    pub const SMALL_AIRCRAFT: Self = Self {
        cells: 3,
        capacity_mah: 5_200.0,
        thresholds: BatteryThresholds { low_charge_pct: 30.0, critical_charge_pct: 10.0 },
        returns_on_low_battery: false,
        stick_response: StickResponse::Position,
        frame: FlightEnvelope {
            manual_speed_m_s: 15.0,
            manual_climb_rate_m_s: 6.0,
            manual_descent_rate_m_s: 2.0,
            manual_yaw_rate_rad_s: 2.0,
            manual_tilt_rad: 0.6,
            acceleration_m_s2: 4.0,
            climb_acceleration_m_s2: 3.0,
            landing_descent_rate_m_s: 2.0,
        },
    };
}

/// A parameter as sent to clients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutgoingParam {
    /// Parameter name.
    pub name: &'static str,
    /// Value of the message's float field.
    pub wire: f32,
    /// Type of the parameter.
    pub kind: MavParamType,
}

/// Environment settings that an instructor can change by parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InstructorSettings {
    /// Mean wind speed at 20 ft, m/s, and the direction that the wind comes from, degrees; `None`: the scenario's wind.
    pub wind: Option<(f64, f64)>,
    /// Fraction of datagrams lost, each way.
    pub loss: f64,
    /// Delay of the datagrams that are not lost, each way.
    pub delay: SimTime,
    /// Whether the bridges are open to traffic.
    pub open: bool,
}

/// Policy for a second sender that moves the sticks while another has control.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StickPolicy {
    /// The sender in control keeps it until it times out or releases the sticks.
    FirstSenderKeeps,
    /// Any sender that deflects a stick takes control.
    LastMoverTakes,
}

/// The parameter table: current values by name.
#[derive(Debug, Clone, PartialEq)]
pub struct Params {
    values: BTreeMap<&'static str, ParamValue>,
    changes: u64,
    view: &'static ParamView,
    capacity_mah: f64,
    /// Defaults that depend on the airframe.
    frame: BTreeMap<&'static str, ParamValue>,
}

impl Params {
    /// Creates the defaults for a vehicle and a flavor.
    #[must_use]
    pub fn new(system_id: u8, pack: AircraftValues, view: &'static ParamView) -> Self {
        let own = view.rows().iter().filter(|row| row.source == ParamSource::Own);
        // Names shared by two flavors may differ in type and default: the flavor's own row applies.
        let mut values: BTreeMap<&'static str, ParamValue> =
            table::rows().iter().chain(own).map(|row| (row.name, row.default)).collect();
        values.extend(view.defaults.iter().copied());
        values.insert("SPAN_FLAVOUR", Int(view.number));
        values.insert("MAV_SYS_ID", Int(i32::from(system_id)));
        values.insert("BAT1_N_CELLS", Int(pack.cells.cast_signed()));
        values.insert(stick_request::PARAMETER, Int(pack.stick_response.number()));
        values.insert("BAT_LOW_THR", Real((pack.thresholds.low_charge_pct / 100.0) as f32));
        values.insert("BAT_CRIT_THR", Real((pack.thresholds.critical_charge_pct / 100.0) as f32));
        let frame: BTreeMap<_, _> =
            behavior::frame_defaults(&pack.frame).into_iter().filter(|(name, _)| values.contains_key(name)).collect();
        values.extend(frame.iter().map(|(name, value)| (*name, *value)));
        if pack.returns_on_low_battery {
            values.insert("COM_LOW_BAT_ACT", Int(1));
        }
        if view.cast {
            if pack.returns_on_low_battery {
                values.extend([("BATT_FS_LOW_ACT", Int(2)), ("BATT_FS_CRT_ACT", Int(1))]);
            }
            values.insert("BATT_CAPACITY", Int(pack.capacity_mah.round() as i32));
        }
        Self { values, changes: 0, view, capacity_mah: pack.capacity_mah, frame }
    }

    /// Creates only the parameters that control the simulation, for a simulator beside an external autopilot.
    #[must_use]
    pub fn simulation(view: &'static ParamView) -> Self {
        let rows = table::rows().iter().filter(|row| row.group == table::SIMULATION);
        let values = rows.map(|row| (row.name, row.default)).collect();
        Self { values, changes: 0, view, capacity_mah: 0.0, frame: BTreeMap::new() }
    }

    /// Returns whether there is a parameter with this name.
    #[must_use]
    pub fn contains(&self, name: &str) -> bool {
        self.values.contains_key(name)
    }

    /// Restores the vehicle's defaults. Returns whether this changed anything.
    pub fn reset(&mut self, defaults: &Self) -> bool {
        let differs = self.values != defaults.values;
        if differs {
            self.values.clone_from(&defaults.values);
            self.changes += 1;
        }
        differs
    }

    /// Returns the number of changes so far.
    #[must_use]
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Returns the flavor's view of the parameters.
    #[must_use]
    pub fn param_view(&self) -> &'static ParamView {
        self.view
    }

    /// Returns a parameter's allowed range.
    #[must_use]
    pub fn range(&self, name: &str) -> Option<(f64, f64)> {
        self.row(name).map(|(_, row)| self.span(row))
    }

    /// Returns the number of parameters shown to clients.
    #[must_use]
    pub fn count(&self) -> usize {
        self.view.rows().len()
    }

    /// Returns PX4's checksum: CRC-32 without pre- and post-inversion over the name and value of each parameter, sorted
    /// by name.
    #[must_use]
    pub fn hash(&self) -> u32 {
        // The crate inverts the register at both ends; inverting before and after yields the plain polynomial.
        let mut crc = crc32fast::Hasher::new_with_initial(u32::MAX);
        for row in self.view.rows().iter().filter(|row| !row.volatile) {
            crc.update(row.name.as_bytes());
            crc.update(&self.shown(row).to_wire().to_bits().to_le_bytes());
        }
        !crc.finalize()
    }

    /// Returns the name and value at a list index.
    #[must_use]
    pub fn at(&self, index: usize) -> Option<(&'static str, ParamValue)> {
        self.view.rows().get(index).map(|row| (row.name, self.shown(row)))
    }

    /// Returns the list index, name and value of a parameter.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<(usize, &'static str, ParamValue)> {
        self.row(name).map(|(index, row)| (index, row.name, self.shown(row)))
    }

    /// Returns the parameter at a list index as sent to clients.
    #[must_use]
    pub fn outgoing(&self, index: usize) -> Option<OutgoingParam> {
        let row = self.view.rows().get(index)?;
        let value = self.shown(row);
        Some(OutgoingParam { name: row.name, wire: if self.view.cast { value.cast() } else { value.to_wire() }, kind: row.wire })
    }

    fn row(&self, name: &str) -> Option<(usize, &'static Row)> {
        let rows = self.view.rows();
        let index = rows.binary_search_by(|row| row.name.cmp(name)).ok()?;
        Some((index, &rows[index]))
    }

    /// Returns the parameter that a row is derived from, and the factor.
    fn source_value(&self, row: &Row) -> Option<(&'static str, f64)> {
        match row.source {
            ParamSource::Own | ParamSource::Mapped(..) => None,
            ParamSource::Scaled(name, factor) => Some((name, factor)),
            ParamSource::Capacity(name) => Some((name, self.capacity_mah)),
        }
    }

    fn span(&self, row: &Row) -> (f64, f64) {
        match self.source_value(row).and_then(|(name, factor)| Some((find(name)?, factor))) {
            Some((other, factor)) => (other.low * factor, other.high * factor),
            None => (row.low, row.high),
        }
    }

    fn shown(&self, row: &Row) -> ParamValue {
        if let Some((name, factor)) = self.source_value(row) {
            return row.default.with_number(self.number(name) * factor);
        }
        let ParamSource::Mapped(name, pairs) = row.source else {
            return self.values.get(row.name).copied().unwrap_or(row.default);
        };
        let other = self.whole(name);
        pairs.iter().find(|(_, theirs)| Some(*theirs) == other).map_or(row.default, |(own, _)| Int(*own))
    }

    /// Sets a value from the wire: bytewise, where integer parameters require an integer type, or cast, where the type
    /// is ignored.
    ///
    /// # Errors
    /// Returns a [`ParamRefusal`] and changes nothing.
    pub fn set(&mut self, name: &str, wire: f32, kind: MavParamType) -> Result<(), ParamRefusal> {
        let (_, row) = self.row(name).ok_or(ParamRefusal::Unknown)?;
        let real = kind == MavParamType::MAV_PARAM_TYPE_REAL32;
        let value = match row.default {
            Int(_) if self.view.cast && wire.is_nan() => return Err(ParamRefusal::OutOfRange),
            // ArduPilot truncates the fraction.
            Int(_) if self.view.cast => Int(wire as i32),
            Int(_) if !real => Int(wire.to_bits().cast_signed()),
            Real(_) if real || self.view.cast => Real(wire),
            Int(_) | Real(_) => return Err(ParamRefusal::Type),
        };
        self.put(row, value)
    }

    /// Sets a value by the flavor's name.
    ///
    /// # Errors
    /// Returns a [`ParamRefusal`] and changes nothing.
    pub fn set_value(&mut self, name: &str, value: ParamValue) -> Result<(), ParamRefusal> {
        let (_, row) = self.row(name).ok_or(ParamRefusal::Unknown)?;
        match (row.default, value) {
            (Int(_), Int(_)) | (Real(_), Real(_)) => self.put(row, value),
            _ => Err(ParamRefusal::Type),
        }
    }

    fn put(&mut self, row: &'static Row, value: ParamValue) -> Result<(), ParamRefusal> {
        if row.read_only {
            return Err(ParamRefusal::ReadOnly);
        }
        let (number, (low, high)) = (value.number(), self.span(row));
        // Tolerance of one unit in the last place of the wire format, so that a displayed limit can be set.
        let whole = row.source == ParamSource::Own && matches!(value, Int(_));
        let slack = if whole { 0.0 } else { f64::from(f32::EPSILON) * high.abs().max(low.abs()) };
        if number.is_nan() || number < low - slack || number > high + slack {
            return Err(ParamRefusal::OutOfRange);
        }
        let (name, value) = match row.source {
            ParamSource::Own => (row.name, value),
            ParamSource::Mapped(name, pairs) => {
                let (_, theirs) = pairs.iter().find(|(own, _)| Int(*own) == value).ok_or(ParamRefusal::OutOfRange)?;
                (name, Int(*theirs))
            }
            ParamSource::Scaled(..) | ParamSource::Capacity(_) => {
                let (name, factor) = self.source_value(row).ok_or(ParamRefusal::Unknown)?;
                let other = find(name).ok_or(ParamRefusal::Unknown)?;
                (name, other.default.with_number((number / factor).clamp(other.low, other.high)))
            }
        };
        if self.values.insert(name, value) != Some(value) {
            self.changes += 1;
        }
        Ok(())
    }

    /// Returns an integer parameter's value.
    #[must_use]
    pub fn whole(&self, name: &str) -> Option<i32> {
        self.values.get(name).and_then(|value| if let Int(whole) = value { Some(*whole) } else { None })
    }

    /// Returns the arbitration policy for multiple stick senders.
    #[must_use]
    pub fn stick_policy(&self) -> StickPolicy {
        if self.whole("SPAN_STICKS") == Some(1) { StickPolicy::LastMoverTakes } else { StickPolicy::FirstSenderKeeps }
    }

    /// Checks whether the camera component sends heartbeats.
    #[must_use]
    pub fn camera_announced(&self) -> bool {
        self.whole("SPAN_CAMERA") != Some(0)
    }

    /// Returns the speed for missions, returns and go-to commands in m/s.
    #[must_use]
    pub fn cruise_m_s(&self) -> f64 {
        self.number("MPC_XY_CRUISE")
    }

    /// Returns the instructor's environment settings.
    #[must_use]
    pub fn instructor_settings(&self) -> InstructorSettings {
        let wind_m_s = Some(self.number("SIM_WIND_SPD")).filter(|speed| *speed >= 0.0);
        InstructorSettings {
            wind: wind_m_s.map(|speed| (speed, self.number("SIM_WIND_DIR"))),
            loss: self.number("SIM_LINK_LOSS") / 100.0,
            delay: SimTime::from_ms(self.number("SIM_LINK_DELAY") as i64),
            open: self.whole("SIM_TRAFFIC") != Some(0),
        }
    }

    /// Returns the response to the sticks in position mode.
    #[must_use]
    pub fn stick_response(&self) -> StickResponse {
        self.whole(stick_request::PARAMETER).and_then(StickResponse::from_number).unwrap_or_default()
    }

    /// Returns whether the geofence is enabled, if a parameter controls it.
    #[must_use]
    pub fn fence_enabled(&self) -> Option<bool> {
        self.whole(FENCE_ENABLE_NAME).map(|value| value != 0)
    }

    /// Returns the system ID of the ground station that may send stick input; `None`: any.
    #[must_use]
    pub fn ground_station(&self) -> Option<u8> {
        self.whole("SYSID_MYGCS").and_then(|id| u8::try_from(id).ok()).filter(|id| *id > 0)
    }

    /// Returns the throttle pulse width, in microseconds, below which the transmitter counts as lost.
    #[must_use]
    pub fn throttle_loss_pulse_us(&self) -> Option<u16> {
        self.whole("FS_THR_VALUE").and_then(|us| u16::try_from(us).ok())
    }

    /// Returns the function of the switch on a channel (`RCn_OPTION`), for flavors with switches.
    #[must_use]
    pub fn switch_function(&self, channel: usize) -> Option<u16> {
        self.whole(&format!("RC{channel}_OPTION")).and_then(|function| u16::try_from(function).ok())
    }

    /// Checks whether a reboot deletes the mission (bit 0 of `MIS_OPTIONS`).
    #[must_use]
    pub fn clears_mission_at_boot(&self) -> bool {
        self.whole("MIS_OPTIONS").is_some_and(|bits| bits & 1 != 0)
    }

    /// Checks whether arming is allowed in AUTO.
    #[must_use]
    pub fn can_arm_in_auto(&self) -> bool {
        self.whole("AUTO_OPTIONS").is_some_and(|bits| bits & 1 != 0)
    }

    /// Updates the parameters that report the number of mission, fence and rally items.
    pub fn update_plan_counts(&mut self, items: [u16; 3]) {
        for (name, count) in ["MIS_TOTAL", "FENCE_TOTAL", "RALLY_TOTAL"].into_iter().zip(items) {
            if let Some(value) = self.values.get_mut(name) {
                *value = Int(i32::from(count));
            }
        }
    }

    /// Returns a value that only some flavors have.
    fn real(&self, name: &str) -> Option<f64> {
        self.values.get(name).map(|value| value.number())
    }

    fn number(&self, name: &str) -> f64 {
        self.values.get(name).map_or(0.0, |v| v.number())
    }

    /// Applies the values to the autopilot's settings.
    pub fn apply(&self, tuning: &mut Tuning) {
        tuning.takeoff_height_m = self.number("MIS_TAKEOFF_ALT");
        tuning.takeoff_speed_m_s = self.number("MPC_TKO_SPEED");
        tuning.land_speed_m_s = self.number("MPC_LAND_SPEED");
        tuning.cruise_speed_m_s = self.number("MPC_XY_CRUISE");
        tuning.horizontal_speed_max_m_s = self.number("MPC_XY_VEL_MAX");
        tuning.climb_m_s = self.number("MPC_Z_VEL_MAX_UP");
        tuning.descend_m_s = self.number("MPC_Z_VEL_MAX_DN");
        if !self.view.cast {
            tuning.climb_m_s = tuning.climb_m_s.min(self.number("MPC_Z_V_AUTO_UP"));
            tuning.descend_m_s = tuning.descend_m_s.min(self.number("MPC_Z_V_AUTO_DN"));
        }
        tuning.slow_landing_height_m = self.number("MPC_LAND_ALT2");
        tuning.failsafe_delay_s = self.number("COM_FAIL_ACT_T");
        tuning.stick_takeover = self.whole("COM_RC_OVERRIDE").is_none_or(|bits| bits & 1 != 0);
        self.apply_rules(&mut tuning.rules);
        tuning.return_height_m = self.number("RTL_RETURN_ALT");
        tuning.default_acceptance_radius_m = self.number("NAV_ACC_RAD");
        tuning.manual_loss_timeout_s = self.number("COM_RC_LOSS_T");
        tuning.data_link_loss_timeout_s = self.number("COM_DL_LOSS_T");
        tuning.offboard_loss_timeout_s = self.real("GUID_TIMEOUT").unwrap_or_else(|| self.number("COM_OF_LOSS_T"));
        tuning.battery_low_pct = 100.0 * self.number("BAT_LOW_THR");
        tuning.battery_critical_pct = 100.0 * self.number("BAT_CRIT_THR");
        tuning.disarm_after_landing_s = self.number("COM_DISARM_LAND");
        tuning.disarm_before_flight_s = self.number("COM_DISARM_PRFLT");
        tuning.fence_action = FenceAction::from_number(self.number("GF_ACTION") as i32).unwrap_or(FenceAction::Hold);
        tuning.fence_enabled = self.fence_enabled().unwrap_or(tuning.fence_enabled);
        tuning.fence_distance_m = self.number("GF_MAX_HOR_DIST");
        tuning.fence_height_m = self.number("GF_MAX_VER_DIST");
        tuning.manual_loss = LinkLossAction::from_number(self.number("NAV_RCL_ACT") as i32).unwrap_or(LinkLossAction::Hold);
        tuning.stick_response = self.stick_response();
        tuning.follow = self.follow_rule();
        if let Some(rate_deg_s) = self.real("CIRCLE_RATE") {
            tuning.circle_rate_rad_s = rate_deg_s.to_radians();
        }
        tuning.data_link_loss = LinkLossAction::from_number(self.number("NAV_DLL_ACT") as i32).unwrap_or(LinkLossAction::Ignore);
    }
}

fn find(name: &str) -> Option<&'static Row> {
    let rows = table::rows();
    let found = |rows: &'static [Row]| rows.binary_search_by(|row| row.name.cmp(name)).ok().map(|index| &rows[index]);
    found(rows).or_else(|| found(copter::rows()))
}

#[cfg(test)]
pub(super) mod tests;
