//! Tests without ArduPilot.

mod frames;
mod messages;
mod parser;
mod protocol;
mod table;
mod transcript;

use super::ArduPilotInterface;
use crate::backend::interface::{IMU_COUNT, StepInput};
use crate::backend::launch::LaunchSettings;
use crate::physics::{PhysicsState, RigidState};
use crate::sensors::{BatteryReading, ImuReading, Readings};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::math::GRAVITY_M_S2;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_model::{shipped, vehicle};

const HOME: Geo = Geo { latitude_deg: 47.397_742, longitude_deg: 8.545_594, altitude_m: 488.0 };
/// 2026-01-01 00:00:00 UTC.
const START_UNIX_S: i64 = 1_767_225_600;

/// Returns a shipped aircraft.
fn aircraft(id: &str) -> Vehicle {
    let (_, text) = shipped::VEHICLES.iter().find(|(stem, _)| *stem == id).expect("shipped");
    vehicle::read(&format!("{id}.toml"), text).expect("valid")
}

fn settings() -> LaunchSettings {
    LaunchSettings {
        instance: 2,
        simulator_port: 9022,
        mavlink_port: 14_571,
        autopilot_port: 14_572,
        client_speed_factor: 1.0,
        rate_hz: 500.0,
        home: HOME,
        home_heading_deg: 90.0,
        battery_thresholds_pct: (25.0, 10.0),
    }
}

fn interface() -> ArduPilotInterface {
    ArduPilotInterface::new(&aircraft("phantom2"), &settings())
}

/// Everything that a step needs, for tests to change.
struct Scene {
    now: SimTime,
    imus: [ImuReading; IMU_COUNT],
    fresh: Readings,
    latest: Readings,
    battery: BatteryReading,
    truth: RigidState,
    wind_m_s: Vec3<Ned>,
    pad_m: Vec3<Ned>,
    plane: LocalPlane,
}

impl Scene {
    /// An aircraft at rest on the pad.
    fn at_rest() -> Self {
        let still = ImuReading { specific_force_m_s2: Vec3::new(0.0, 0.0, -GRAVITY_M_S2), rates_rad_s: Vec3::new(0.0, 0.0, 0.0) };
        Self {
            now: SimTime::from_ms(7000),
            imus: [still; IMU_COUNT],
            fresh: Readings::default(),
            latest: Readings::default(),
            battery: BatteryReading { voltage_v: 12.25, current_a: 3.5, remaining_pct: 90.0 },
            truth: PhysicsState::at_rest(Vec3::new(10.0, 20.0, -30.0), 0.5).rigid,
            wind_m_s: Vec3::new(1.0, -2.0, 0.25),
            pad_m: Vec3::new(9.0, 22.0, -29.875),
            plane: LocalPlane::new(HOME),
        }
    }

    fn step(&self) -> StepInput<'_> {
        StepInput {
            now: self.now,
            imus: &self.imus,
            fresh: &self.fresh,
            latest: &self.latest,
            battery: self.battery,
            truth: &self.truth,
            wind_m_s: self.wind_m_s,
            pad_m: self.pad_m,
            plane: &self.plane,
            start_unix_s: START_UNIX_S,
        }
    }
}

/// Encodes a packet with 16 channels.
fn packet(frame_count: u32, motors_us: [u16; 4]) -> Vec<u8> {
    let mut out = 18_458_u16.to_le_bytes().to_vec();
    out.extend(500_u16.to_le_bytes());
    out.extend(frame_count.to_le_bytes());
    out.extend(motors_us.into_iter().chain([1000; 12]).flat_map(u16::to_le_bytes));
    out
}
