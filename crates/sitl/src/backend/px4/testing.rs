//! Shared parts of this backend's tests.

use crate::backend::interface::{IMU_COUNT, StepInput};
use crate::backend::launch::LaunchSettings;
use crate::physics::{PhysicsState, RigidState};
use crate::sensors::{BatteryReading, ImuReading, Readings};
use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::frames::Vec3;
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::math::GRAVITY_M_S2;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{self, Vehicle};

/// The four shipped aircraft.
pub(super) fn shipped() -> [Vehicle; 4] {
    [
        ("phantom2.toml", include_str!("../../../../../vehicle-params/phantom2.toml")),
        ("f450.toml", include_str!("../../../../../vehicle-params/f450.toml")),
        ("m30.toml", include_str!("../../../../../vehicle-params/m30.toml")),
        ("elios3.toml", include_str!("../../../../../vehicle-params/elios3.toml")),
    ]
    .map(|(file, text)| vehicle::read(file, text).unwrap())
}

pub(super) const HOME: Geo = Geo { latitude_deg: 47.0, longitude_deg: 8.0, altitude_m: 400.0 };

pub(super) fn settings() -> LaunchSettings {
    LaunchSettings {
        instance: 2,
        simulator_port: 4562,
        mavlink_port: 15_000,
        autopilot_port: 15_100,
        client_speed_factor: 1.0,
        rate_hz: 250.0,
        home: HOME,
        home_heading_deg: 90.0,
        battery_thresholds_pct: (30.0, 15.0),
    }
}

/// Owner of everything that a [`StepInput`] borrows: an aircraft that stands level on its pad.
pub(super) struct Bench {
    pub imus: [ImuReading; IMU_COUNT],
    pub fresh: Readings,
    pub rigid: RigidState,
    plane: LocalPlane,
}

impl Bench {
    pub fn new() -> Self {
        let still = ImuReading { specific_force_m_s2: Vec3::new(0.0, 0.0, -GRAVITY_M_S2), rates_rad_s: Vec3::zero() };
        Self {
            imus: [still; IMU_COUNT],
            fresh: Readings { imu: Some(still), ..Readings::default() },
            rigid: PhysicsState::at_rest(Vec3::zero(), 0.0).rigid,
            plane: LocalPlane::new(HOME),
        }
    }

    pub fn step(&self, now: SimTime) -> StepInput<'_> {
        StepInput {
            now,
            imus: &self.imus,
            fresh: &self.fresh,
            latest: &self.fresh,
            battery: BatteryReading { voltage_v: 12.0, current_a: 1.0, remaining_pct: 90.0 },
            truth: &self.rigid,
            wind_m_s: Vec3::zero(),
            pad_m: Vec3::zero(),
            plane: &self.plane,
            start_unix_s: 1_700_000_000,
        }
    }
}

/// Returns the messages in a write.
pub(super) fn decoded(bytes: &[u8]) -> Vec<MavMessage> {
    let frames = Decoder::new().push(bytes);
    assert_eq!(frames.iter().map(|frame| frame.bytes.len()).sum::<usize>(), bytes.len(), "incomplete frames");
    frames.into_iter().map(|frame| frame.message.expect("in the dialect")).collect()
}

/// Encodes PX4's answer to the readings of a time.
pub(super) fn answer(px4: &mut Encoder, time: SimTime, armed: bool, controls: &[f32]) -> Vec<u8> {
    let mut payload = [0; 81];
    payload[..8].copy_from_slice(&time.us().to_le_bytes());
    payload[8] = 1;
    for (bytes, control) in payload[16..80].chunks_exact_mut(4).zip(controls) {
        bytes.copy_from_slice(&control.to_le_bytes());
    }
    payload[80] = if armed { 129 } else { 1 };
    px4.encode_payload(93, &payload)
}
