//! The vehicle's state as exposed to Python.

use pyo3::prelude::*;
use spandrel_sitl::testing::Vehicle;

/// True state of the vehicle at an instant.
#[pyclass(frozen, get_all, module = "spandrel")]
#[derive(Debug, Clone)]
pub struct State {
    /// Simulation time, s.
    time_s: f64,
    /// True if the motors are armed.
    armed: bool,
    /// Position in the scenario's frame: east, north, up, m.
    position_enu_m: (f64, f64, f64),
    /// Height above the pad, m.
    height_m: f64,
    /// Velocity over ground: east, north, up, m/s.
    velocity_enu_m_s: (f64, f64, f64),
    /// Roll, right side down positive, rad.
    roll_rad: f64,
    /// Pitch, nose up positive, rad.
    pitch_rad: f64,
    /// Heading, clockwise from north, -pi to pi, rad.
    heading_rad: f64,
    /// Angular velocity of the body: forward, right, down axes, rad/s.
    rates_frd_rad_s: (f64, f64, f64),
    /// Remaining battery, %.
    battery_pct: f64,
    /// Gimbal pitch above the horizon, up positive, rad.
    gimbal_pitch_rad: f64,
    /// True if the lamp is on.
    lamp_on: bool,
    /// Number of photos taken.
    pictures: usize,
    /// Number of contacts so far, excluding soft contacts with the pad and the surrounding ground.
    hits: i32,
    /// Reason why the flight ended; `None` while it is in progress.
    ended: Option<String>,
    /// Latest status text from the vehicle; empty if there has been none.
    text: String,
}

impl State {
    /// Returns the current state of a vehicle.
    pub fn of(vehicle: &Vehicle) -> Self {
        let sim = &vehicle.sim;
        let (truth, payload) = (sim.truth(), sim.payload());
        let (roll_rad, pitch_rad, heading_rad) = truth.rigid.attitude.euler();
        Self {
            time_s: sim.now().s(),
            armed: sim.armed(),
            position_enu_m: vehicle.position_m().array().into(),
            height_m: vehicle.height_m(),
            velocity_enu_m_s: truth.rigid.velocity_m_s.enu().array().into(),
            roll_rad,
            pitch_rad,
            heading_rad,
            rates_frd_rad_s: truth.rigid.rates_rad_s.array().into(),
            battery_pct: truth.battery.remaining_pct(),
            gimbal_pitch_rad: payload.gimbal.pitch_rad,
            lamp_on: payload.lamp.on,
            pictures: payload.camera.summary(sim.now()).pictures,
            hits: sim.hits(),
            ended: sim.ended().map(str::to_owned),
            text: vehicle.status_texts(),
        }
    }
}

#[pymethods]
impl State {
    fn __repr__(&self) -> String {
        let (east, north, up) = self.position_enu_m;
        let armed = if self.armed { "armed" } else { "disarmed" };
        format!("State(time_s={:.3}, {armed}, position_enu_m=({east:.2}, {north:.2}, {up:.2}))", self.time_s)
    }
}
