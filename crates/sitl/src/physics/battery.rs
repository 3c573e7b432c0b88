//! Battery model: open-circuit voltage as a function of charge, internal resistance and power draw; alternatively, the
//! fixed endurance from the TASBID paper.

use super::airframe::AirframeModel;
use super::state::{AirState, PhysicsState as Physics, PowerLoad};
use spandrel_model::math;
use spandrel_model::scenario::BatteryModel;

/// Cell voltage below which the pack counts as empty, V (estimate; usual LiPo practice).
const EMPTY_CELL_VOLTAGE_V: f64 = 3.2;

/// Returns the pack's open-circuit voltage at a state of charge, in V. Interpolates linearly between the eleven points
/// in the vehicle file.
#[must_use]
pub fn open_circuit_v(battery: &spandrel_model::vehicle::BatterySpec, charge: f64) -> f64 {
    let x = charge.clamp(0.0, 1.0) * 10.0;
    let low = (x.floor() as usize).min(9);
    f64::from(battery.cells) * math::lerp(battery.ocv_cell_v[low], battery.ocv_cell_v[low + 1], x - low as f64)
}

/// Returns the total electrical power draw, in W.
fn power_w(model: &AirframeModel, physics: &Physics, air: &AirState, load: PowerLoad) -> f64 {
    let rotor = &model.rotor;
    let shaft: f64 = physics.rigid.rotor_rad_s.iter().map(|w| rotor.torque_coefficient_n_m_s2 * w * w * w).sum();
    let lamp = if load.lamp_on && model.lamp.luminous_flux_lm > 0.0 { model.battery.lamp_power_w } else { 0.0 };
    shaft * air.density_ratio() / rotor.efficiency + model.battery.avionics_power_w + lamp
}

/// Advances charge, voltage and voltage sag by one step.
pub fn advance(model: &AirframeModel, physics: &mut Physics, air: &AirState, load: PowerLoad, dt_s: f64) {
    let battery = &model.battery;
    let power = power_w(model, physics, air, load);
    let state = &mut physics.battery;
    let whole = open_circuit_v(battery, state.charge);
    let live = state.working_cells(battery.cells);
    let open = if live < battery.cells { whole * f64::from(live) / f64::from(battery.cells) } else { whole };
    let r = battery.internal_resistance_ohm;
    // P = (OCV - I R) I has no real solution above the maximum power of the pack; the pack then delivers that maximum.
    let discriminant = (open * open - 4.0 * r * power).max(0.0);
    state.current_a = if r > 0.0 {
        (open - discriminant.sqrt()) / (2.0 * r)
    } else if open > 0.0 {
        power / open
    } else {
        0.0
    };
    state.voltage_v = open - state.current_a * r;
    state.energy_j += power * dt_s;
    match model.battery_model {
        BatteryModel::Paper => {
            if load.airborne {
                state.charge = (state.charge - dt_s / battery.paper_endurance_s).max(0.0);
            }
        }
        BatteryModel::Physical => {
            state.charge = (state.charge - state.current_a * dt_s / (battery.capacity_ah * 3600.0)).max(0.0);
            let full = open_circuit_v(battery, 1.0);
            state.speed_factor = (state.voltage_v / full).clamp(0.0, 1.0);
            if state.voltage_v < EMPTY_CELL_VOLTAGE_V * f64::from(live) {
                state.charge = 0.0;
            }
        }
    }
}
