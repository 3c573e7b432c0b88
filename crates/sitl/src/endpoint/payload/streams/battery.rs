//! Builder for the battery's state.

use super::super::snapshot::PayloadSnapshot;
use crate::physics::BatteryState;
use spandrel_mavlink::dialect::{
    BATTERY_STATUS_DATA, MavBatteryChargeState, MavBatteryFault, MavBatteryFunction, MavBatteryMode, MavBatteryType, MavMessage,
};
use spandrel_model::vehicle::BatterySpec;

/// Returns the remaining charge in whole percent, rounded up so that only an empty battery reads 0.
pub(crate) fn percent(battery: &BatteryState) -> i8 {
    battery.remaining_pct().ceil().clamp(0.0, 100.0) as i8
}

/// Builds the state of the pack. Failed cells read 0 mV.
pub(crate) fn status(spec: &BatterySpec, battery: &BatteryState, charge_state: MavBatteryChargeState) -> MavMessage {
    let cells = spec.cells.clamp(1, 10);
    let mut voltages = [u16::MAX; 10];
    let live = battery.working_cells(cells).max(1);
    voltages[..cells as usize].fill((battery.voltage_v / f64::from(live) * 1000.0).round() as u16);
    voltages
        .iter_mut()
        .take(cells as usize)
        .enumerate()
        .filter(|(cell, _)| battery.cell_failed(*cell))
        .for_each(|(_, mv)| *mv = 0);
    MavMessage::BATTERY_STATUS(BATTERY_STATUS_DATA {
        current_consumed: (spec.capacity_ah * 1000.0 * (1.0 - battery.charge)).round() as i32,
        energy_consumed: (battery.energy_j / 100.0).round() as i32,
        temperature: i16::MAX,
        voltages,
        current_battery: (battery.current_a * 100.0).round() as i16,
        id: 0,
        battery_function: MavBatteryFunction::MAV_BATTERY_FUNCTION_ALL,
        mavtype: MavBatteryType::MAV_BATTERY_TYPE_LIPO,
        battery_remaining: percent(battery),
        time_remaining: 0,
        charge_state,
        voltages_ext: [0; 4],
        mode: MavBatteryMode::DEFAULT,
        fault_bitmask: MavBatteryFault::empty(),
    })
}

/// Builds the measurement of the power module. An external autopilot applies its own thresholds.
pub(crate) fn power_module(v: &PayloadSnapshot) -> Option<MavMessage> {
    let undefined = MavBatteryChargeState::MAV_BATTERY_CHARGE_STATE_UNDEFINED;
    Some(status(&v.input.vehicle.battery, v.input.battery, undefined))
}
