//! Flight recording for Foxglove: drone and camera poses, true and estimated state, battery, scoring inputs and all text
//! messages.

use super::super::endpoint::snapshot::VehicleSnapshot;
use spandrel_model::foxglove::{self, ChannelMessage, FramePose};
use spandrel_model::time::{Schedule, SimTime};
use std::collections::VecDeque;

/// Message rates in simulation time, Hz: frames, position fixes, scoring, slowly changing data.
const RATES_HZ: [f64; 4] = [25.0, 5.0, 10.0, 1.0];

/// Schedules of the recorded channels.
#[derive(Debug, Clone)]
pub struct FoxgloveScene {
    due: [Schedule; 4],
    start_unix_s: i64,
}

impl FoxgloveScene {
    /// Starts a recording at the time of this snapshot.
    pub fn begin(view: &VehicleSnapshot) -> Self {
        Self { due: RATES_HZ.map(|rate| Schedule::new(view.clock.now, rate)), start_unix_s: view.clock.start_unix_s }
    }

    fn unix_ns(&self, now: SimTime) -> u64 {
        (self.start_unix_s * 1_000_000_000 + now.ns()).max(0).cast_unsigned()
    }

    /// Returns a log message with a MAVLink severity.
    pub fn text(&self, severity: u8, now: SimTime, text: &str) -> ChannelMessage {
        foxglove::log(self.unix_ns(now), severity, text)
    }

    /// Returns the messages that are due at this snapshot.
    pub fn observe(&mut self, view: &VehicleSnapshot) -> VecDeque<ChannelMessage> {
        let at = self.unix_ns(view.clock.now);
        let [frames, fixes, scoring, slow] = self.due.each_mut().map(|due| due.fire(view.clock.now));
        let mut out = VecDeque::new();
        if frames {
            out.push_back(transforms(view, at));
        }
        if fixes && view.estimate.position_valid {
            out.push_back(foxglove::fix(at, view.geo(), view.estimate.horizontal_m, view.estimate.vertical_m));
        }
        if scoring {
            let s = view.scoring;
            let values = foxglove::ScoringSignals {
                clearance_m: s.clearance_m,
                lux: Some(s.lux),
                contact: s.contact.label(),
                hits: s.hits,
                respawns: s.respawns,
                lamp_on: view.lamp.on,
                speed_m_s: view.truth.velocity_m_s.norm(),
            };
            out.push_back(foxglove::scoring(at, &values));
        }
        if slow {
            let lens = view.camera_now();
            out.push_back(foxglove::camera(at, lens.focal_px(), (lens.width_px, lens.height_px)));
            let battery = view.readings.battery.as_ref();
            out.extend(battery.map(|b| foxglove::battery(at, Some((b.voltage_v, b.current_a)), b.remaining_pct)));
        }
        out
    }
}

fn transforms(view: &VehicleSnapshot, at: u64) -> ChannelMessage {
    let (truth, believed) = (view.truth, view.estimate);
    let camera = FramePose::camera(truth.position_m, truth.attitude, view.vehicle.camera.position_m, view.gimbal.pitch_rad);
    let frames = [
        (foxglove::DRONE, FramePose::drone(truth.position_m, truth.attitude)),
        (foxglove::DRONE_ESTIMATE, FramePose::drone(believed.position_m, believed.attitude)),
        (foxglove::CAMERA, camera),
    ];
    foxglove::transforms(at, &frames)
}
