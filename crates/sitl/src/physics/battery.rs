//! Battery model: open-circuit voltage as a function of charge, internal resistance and power draw; or the fixed
//! endurance given in the TASBID paper.

use super::{AirframeModel, PhysicsState as Physics, PowerLoad};
use spandrel_model::math;
use spandrel_model::scenario::BatteryModel;

/// Cell voltage below which the pack counts as empty, V (estimate; usual LiPo practice).
const EMPTY_CELL_V: f64 = 3.2;

/// State of charge and terminal readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BatteryState {
    /// State of charge, 0 to 1.
    pub charge: f64,
    /// Terminal voltage, V; 0 until the first step.
    pub voltage_v: f64,
    /// Current, A.
    pub current_a: f64,
    /// Energy drawn, J.
    pub energy_j: f64,
    /// Fraction of the maximum rotor speed available at the current voltage.
    pub speed_factor: f64,
    /// Failed cells that deliver no voltage, as a bit mask; bit 0 is the first cell.
    pub dead_cells: u16,
}

impl BatteryState {
    /// A fully charged pack.
    pub const FULL: Self = Self { charge: 1.0, voltage_v: 0.0, current_a: 0.0, energy_j: 0.0, speed_factor: 1.0, dead_cells: 0 };

    /// Returns true if the pack has no charge left.
    #[must_use]
    pub fn empty(&self) -> bool {
        self.charge <= 0.0
    }

    /// Returns true if the cell with this zero-based index has failed.
    #[must_use]
    pub fn is_empty(&self, cell: usize) -> bool {
        cell < 16 && self.dead_cells & (1 << cell) != 0
    }

    /// Sets or clears the failure of one cell.
    pub fn fail_cell(&mut self, cell: usize, dead: bool) {
        let bit = if cell < 16 { 1 << cell } else { 0 };
        self.dead_cells = if dead { self.dead_cells | bit } else { self.dead_cells & !bit };
    }

    /// Returns the number of working cells in a pack of `cells` cells.
    #[must_use]
    pub fn live_cells(&self, cells: u32) -> u32 {
        cells.saturating_sub(self.dead_cells.count_ones())
    }

    /// Returns the remaining charge, %.
    #[must_use]
    pub fn remaining_pct(&self) -> f64 {
        self.charge * 100.0
    }
}

/// Returns the open-circuit voltage of the pack at a state of charge, V. Interpolates linearly between the eleven
/// points of the vehicle file.
#[must_use]
pub fn open_circuit_v(battery: &spandrel_model::vehicle::BatterySpec, charge: f64) -> f64 {
    let x = charge.clamp(0.0, 1.0) * 10.0;
    let low = (x.floor() as usize).min(9);
    f64::from(battery.cells) * math::lerp(battery.ocv_cell_v[low], battery.ocv_cell_v[low + 1], x - low as f64)
}

/// Returns the total electrical power draw, W.
fn power_w(model: &AirframeModel, physics: &Physics, load: PowerLoad) -> f64 {
    let rotor = &model.rotor;
    let shaft: f64 = physics.rigid.rotor_rad_s.iter().map(|w| rotor.torque_coefficient_n_m_s2 * w * w * w).sum();
    let lamp = if load.lamp_on && model.lamp.flux_lm > 0.0 { model.battery.lamp_w } else { 0.0 };
    shaft / rotor.efficiency + model.battery.avionics_w + lamp
}

/// Advances charge, voltage and voltage sag by one step.
pub fn advance(model: &AirframeModel, physics: &mut Physics, load: PowerLoad, dt_s: f64) {
    let battery = &model.battery;
    let power = power_w(model, physics, load);
    let state = &mut physics.battery;
    let whole = open_circuit_v(battery, state.charge);
    let live = state.live_cells(battery.cells);
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
            if state.voltage_v < EMPTY_CELL_V * f64::from(live) {
                state.charge = 0.0;
            }
        }
    }
}
