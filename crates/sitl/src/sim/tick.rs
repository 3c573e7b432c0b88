//! Runs one simulation tick, in the order documented in docs/src/reference/wire.md, "One simulation step".

use super::{STEP, Sim};
use crate::autopilot::CONTROL_HZ;
use crate::physics::{Actuators, PowerLoad};
use crate::sensors::{BatteryReading, SensorInputs};
use sha2::Digest;
use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;
use std::sync::Arc;

impl Sim {
    pub(super) fn tick(&mut self) {
        let start = self.now;
        self.apply_instructor_inputs();
        self.endpoint.vehicle.accepts_sticks = self.faults.passes_manual_control(start);
        self.step_wind(start);
        if self.control_due.fire(start) {
            self.step_control(start);
        }
        let load = PowerLoad { lamp_on: self.endpoint.payload.equipment.lamp.on, airborne: self.has_lifted_off };
        let site = Arc::clone(&self.site);
        let model = Arc::clone(&self.model);
        model.advance(&mut self.state, &self.actuators, &self.air, site.as_ref(), load, start, STEP);
        self.sensors.integrate_imu(&self.state.rigid, self.state.specific_force_m_s2, STEP);
        self.now += STEP;
        self.handle_crash_and_respawn();
        self.update_clearance_and_light();
        self.publish();
        self.update_digest();
    }

    fn step_wind(&mut self, now: SimTime) {
        if self.wind_due.fire(now) {
            let up = -self.state.rigid.position_m.down();
            let here = self.state.rigid.position_m.enu();
            let water_up_m = self.config.scenario.terrain.water_level_m;
            let ground_up_m = self.site.ground_up_m(here.east(), here.north());
            self.wind.set_over_ground(ground_up_m > water_up_m);
            let height_m = (up - ground_up_m.max(water_up_m)).max(0.3);
            self.wind.update(now, height_m, self.state.rigid.velocity_m_s);
        }
        self.air.velocity_m_s = self.wind.air_velocity(now);
        self.air.force_n = if self.has_lifted_off { self.wind.paper_force_n() } else { Vec3::zero() };
    }

    fn step_control(&mut self, now: SimTime) {
        let b = &self.state.battery;
        let battery = BatteryReading { voltage_v: b.voltage_v, current_a: b.current_a, remaining_pct: b.remaining_pct() };
        let truth = SensorInputs { rigid: &self.state.rigid, battery, lamp_on: self.endpoint.payload.equipment.lamp.on };
        let mut fresh = self.sensors.sample(&truth, self.site.as_ref(), now);
        self.faults.corrupt_readings(&mut fresh, now);
        self.actuators = self.backend.step(&fresh, now);
        self.faults.stop_motors(&mut self.actuators);
        if self.end_reason.is_some() {
            self.actuators = Actuators::default();
        }
        self.readings.update_latest(&fresh);
        let camera = self.config.vehicle.camera;
        let position = self.state.rigid.position_m.enu();
        self.endpoint.payload.equipment.step(&camera, position, now, 1.0 / CONTROL_HZ);
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
