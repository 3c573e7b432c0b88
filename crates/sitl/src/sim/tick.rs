//! Runs one simulation tick, in the order documented in docs/src/reference/wire.md, "One simulation step".

use super::controller::Controller;
use super::{STEP, Sim};
use crate::autopilot::CONTROL_HZ;
use crate::physics::{Actuators, PowerLoad};
use crate::sensors::{BatteryReading, Readings, SensorInputs};
use sha2::Digest;
use spandrel_model::frames::Vec3;
use spandrel_model::site::mean_air::MIN_AIR_HEIGHT_M;
use spandrel_model::time::SimTime;
use std::sync::Arc;

impl Sim {
    pub(super) fn tick(&mut self) {
        let start = self.now;
        self.apply_instructor_inputs();
        self.apply_walk_request();
        self.update_hazards(start);
        self.controller.set_accepts_sticks(self.faults.passes_manual_control(start) && !self.is_radio_silent());
        self.step_wind(start);
        if self.control_due.fire(start) {
            self.step_control(start);
        }
        let load = PowerLoad { lamp_on: self.controller.payload().equipment.lamp.on, airborne: self.has_lifted_off };
        let site = Arc::clone(&self.site);
        let model = Arc::clone(&self.model);
        model.advance(&mut self.state, &self.actuators, &self.air, site.as_ref(), load, start, STEP);
        self.integrate_imus(STEP);
        self.now += STEP;
        self.handle_crash_and_respawn();
        self.update_clearance_and_light();
        self.keep_state();
        self.publish();
        self.update_digest();
    }

    /// Updates the radio links and the hazards that the vehicle reports.
    fn update_hazards(&mut self, now: SimTime) {
        let position_m = self.state.rigid.position_m;
        if let Some(shadow) = &mut self.radio_shadow
            && shadow.update(&self.site, position_m.enu(), now)
        {
            self.hazards.radio = Some(shadow.truth());
            self.set_radio_loss();
        }
        if self.hazards_due.fire(now) {
            let compass = self.config.scenario.hazards.compass;
            self.hazards.compass_rad = compass.then(|| self.sensors.compass_error_rad(position_m));
            self.hazards.water = self.sensors.over_water();
        }
    }

    pub(super) fn step_wind(&mut self, now: SimTime) {
        if self.wind_due.fire(now) {
            let up = -self.state.rigid.position_m.down();
            let here = self.state.rigid.position_m.enu();
            let water_up_m = self.config.scenario.terrain.water_level_m;
            let ground_up_m = self.site.ground_up_m(here.east(), here.north());
            self.wind.set_over_ground(ground_up_m > water_up_m);
            self.air.density_kg_m3 = self.model.air_density_kg_m3(self.config.scenario.origin.altitude_m + up);
            let surface_up_m = ground_up_m.max(water_up_m);
            let height_m = (up - surface_up_m).max(MIN_AIR_HEIGHT_M);
            self.wind.update(now, height_m, self.state.rigid.velocity_m_s);
            if let Some(wakes) = &mut self.wakes {
                wakes.sample(&self.state.rigid, self.wind.mean_velocity(now, height_m), surface_up_m, now);
                self.hazards.wake_m_s = Some(wakes.strongest_m_s());
            }
        }
        self.air.velocity_m_s = self.wind.air_velocity(now);
        if let Some(wakes) = &self.wakes {
            let added = wakes.at(now);
            self.air.velocity_m_s += added.center_m_s;
            self.air.rotors_m_s = Some(added.rotors_m_s);
        }
        self.air.force_n = if self.has_lifted_off { self.wind.paper_force_n() } else { Vec3::zero() };
    }

    /// Runs the built-in autopilot, and the equipment. An external autopilot runs between ticks.
    fn step_control(&mut self, now: SimTime) {
        if self.controller.builtin().is_some() {
            let fresh = self.sample_sensors(now, now);
            if let Controller::Builtin(own) = &mut self.controller {
                self.actuators = own.autopilot.step(&fresh, now);
            }
            self.apply_motor_failures();
            self.readings.update_latest(&fresh);
        }
        let camera = self.config.vehicle.camera;
        let position = self.state.rigid.position_m.enu();
        self.controller.payload_mut().equipment.step(&camera, position, now, 1.0 / CONTROL_HZ);
    }

    /// Samples the sensors that are due on their clock and applies the injected failures.
    pub(super) fn sample_sensors(&mut self, now: SimTime, sensor_clock: SimTime) -> Readings {
        let truth = SensorInputs {
            rigid: &self.state.rigid,
            air_velocity_m_s: self.state.rigid.velocity_m_s - self.air.velocity_m_s,
            battery: self.battery_reading(),
            lamp_on: self.controller.payload().equipment.lamp.on,
        };
        let mut fresh = self.sensors.sample(&truth, self.site.as_ref(), sensor_clock);
        self.faults.corrupt_readings(&mut fresh, now);
        fresh
    }

    /// Returns the terminal values of the battery.
    pub(super) fn battery_reading(&self) -> BatteryReading {
        let b = &self.state.battery;
        BatteryReading { voltage_v: b.voltage_v, current_a: b.current_a, remaining_pct: b.remaining_pct() }
    }

    /// Stops the motors that have failed, and all motors after the end of the session.
    pub(super) fn apply_motor_failures(&mut self) {
        self.faults.stop_motors(&mut self.actuators);
        if self.end_reason.is_some() {
            self.actuators = Actuators::default();
        }
    }

    /// Adds the exact bits of this tick's state to the digest.
    fn update_digest(&mut self) {
        let r = &self.state.rigid;
        let mut bits = [0u8; 8 * 13];
        let values =
            r.position_m.array().into_iter().chain(r.velocity_m_s.array()).chain(r.attitude.wxyz()).chain(r.rates_rad_s.array());
        for (slot, value) in bits.chunks_exact_mut(8).zip(values) {
            slot.copy_from_slice(&value.to_bits().to_le_bytes());
        }
        self.digest.update(bits);
    }
}
