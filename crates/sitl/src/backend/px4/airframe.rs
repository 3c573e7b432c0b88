//! PX4's parameters for an aircraft: rotor layout, motors and everything derived from the vehicle file.

use super::param_table::ParamTable;
use super::{airframe_limits, equipment};
use crate::backend::launch::{LaunchParam, LaunchSettings};
use spandrel_model::math::GRAVITY_M_S2;
use spandrel_model::vehicle::Vehicle;

/// PX4's code for a multirotor.
const MULTIROTOR: f64 = 0.0;
/// First of PX4's output functions for motors.
const FIRST_MOTOR_FUNCTION: usize = 101;
/// Thrust coefficient of each rotor. Only ratios matter to the control allocation, and all rotors are equal. PX4's default.
const THRUST_COEFFICIENT: f64 = 6.5;

/// Returns all parameters that depend on the vehicle file or the settings, sorted by name. Each value is limited to PX4's range.
#[must_use]
pub fn parameters(vehicle: &Vehicle, settings: &LaunchSettings) -> Vec<LaunchParam> {
    let mut table = ParamTable::default();
    rotors(&mut table, vehicle);
    thrust(&mut table, &vehicle.at_altitude(settings.home.altitude_m));
    airframe_limits::add(&mut table, &vehicle.limits);
    equipment::add(&mut table, vehicle, settings);
    table.into_rows()
}

/// Rotor positions and directions. PX4's positive moment coefficient is a counterclockwise rotor, as here.
fn rotors(table: &mut ParamTable, vehicle: &Vehicle) {
    let (count, model) = (vehicle.rotors.len(), &vehicle.rotor);
    let moment_ratio_m = model.torque_coefficient_n_m_s2 / model.thrust_coefficient_n_s2;
    table.integer("CA_AIRFRAME", MULTIROTOR, (0.0, 15.0));
    table.integer("CA_ROTOR_COUNT", count as f64, (0.0, 12.0));
    for (index, rotor) in vehicle.rotors.iter().enumerate() {
        let prefix = format!("CA_ROTOR{index}_");
        let place = rotor.position_m;
        table.real(format!("{prefix}PX"), place.forward(), (-100.0, 100.0));
        table.real(format!("{prefix}PY"), place.right(), (-100.0, 100.0));
        table.real(format!("{prefix}PZ"), place.down(), (-100.0, 100.0));
        table.real(format!("{prefix}KM"), rotor.spin * moment_ratio_m, (-1.0, 1.0));
        table.real(format!("{prefix}CT"), THRUST_COEFFICIENT, (0.0, 100.0));
        let function = (FIRST_MOTOR_FUNCTION + index) as f64;
        table.integer(format!("PWM_MAIN_FUNC{}", index + 1), function, (0.0, 2000.0));
    }
}

/// Thrust as a function of the motor command. A command is a share of the speed range from idle to maximum, and thrust is
/// proportional to the speed squared, so above idle it is exactly PX4's curve: factor · x² + (1 - factor) · x.
fn thrust(table: &mut ParamTable, vehicle: &Vehicle) {
    let model = &vehicle.rotor;
    let idle = model.idle_speed_rad_s / model.max_speed_rad_s;
    table.real("THR_MDL_FAC", (1.0 - idle) / (1.0 + idle), (0.0, 1.0));
    let per_rotor_n = vehicle.mass_kg * GRAVITY_M_S2 / vehicle.rotors.len() as f64;
    let hover_squared = per_rotor_n / model.thrust_coefficient_n_s2;
    let (idle_squared, max_squared) =
        (model.idle_speed_rad_s * model.idle_speed_rad_s, model.max_speed_rad_s * model.max_speed_rad_s);
    table.real("MPC_THR_HOVER", (hover_squared - idle_squared) / (max_squared - idle_squared), (0.1, 0.8));
}
