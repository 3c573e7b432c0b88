//! Converts a flight received over MAVLink to a Foxglove recording with the drone and camera coordinate frames,
//! battery, scoring data and log messages.

use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::telemetry::Flight;
use spandrel_model::foxglove::{self, ChannelMessage, FramePose};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};

/// Minimum interval between coordinate frame updates.
const POSE_INTERVAL: SimTime = SimTime::from_ms(40);
/// Interval at which all other data is recorded, frames.
const FRAMES_PER_SLOW_SAMPLE: usize = 25;
/// MAVLink severity levels used for log messages.
const SEVERITY_CRITICAL: u8 = 2;
const SEVERITY_INFO: u8 = 6;

/// Returns all of the recording's messages in chronological order.
#[must_use]
pub fn messages(flight: &Flight, scenario: &Scenario, vehicle: &Vehicle) -> Vec<ChannelMessage> {
    let unix_ns = |time: SimTime| (scenario.light.start_unix_s * 1_000_000_000 + time.ns()).max(0).cast_unsigned();
    let mut out = status_texts(flight, unix_ns);
    let mut due = SimTime::ZERO;
    let mut frames = 0;
    for truth in &flight.truths {
        if frames > 0 && truth.time < due {
            continue;
        }
        due = truth.time + POSE_INTERVAL;
        let (at, now) = (unix_ns(truth.time), truth.time);
        let here: Vec3<Ned> = truth.motion.position_m.ned();
        let pitch_rad = flight.gimbal.at(now).unwrap_or(0.0);
        let camera = FramePose::camera(here, truth.motion.ned_from_frd, vehicle.camera.position_m, pitch_rad);
        out.push(foxglove::transforms(
            at,
            &[(foxglove::DRONE, FramePose::drone(here, truth.motion.ned_from_frd)), (foxglove::CAMERA, camera)],
        ));
        out.push(foxglove::scoring(
            at,
            &foxglove::ScoringSignals {
                clearance_m: flight.clearance.at(now).unwrap_or(f64::INFINITY),
                lux: None,
                contact: flight.contact.at(now).unwrap_or_default().label(),
                hits: flight.hits.at(now).unwrap_or(0),
                respawns: flight.respawns.at(now).unwrap_or(0),
                lamp_on: flight.light.at(now).unwrap_or(false),
                speed_m_s: truth.motion.velocity_m_s.norm(),
            },
        ));
        if frames % FRAMES_PER_SLOW_SAMPLE == 0 {
            let wide = vehicle.camera;
            let lens = Camera { hfov_rad: flight.field_of_view.at(now).unwrap_or(wide.hfov_rad), ..wide };
            out.push(foxglove::camera(at, lens.focal_px(), (lens.width_px, lens.height_px)));
            out.extend(flight.battery.at(now).map(|pct| foxglove::battery(at, None, pct)));
        }
        frames += 1;
    }
    out.sort_by_key(|message| message.unix_ns);
    out
}

fn status_texts(flight: &Flight, unix_ns: impl Fn(SimTime) -> u64) -> Vec<ChannelMessage> {
    let mut out = Vec::new();
    let mut touched = ContactKind::None;
    for (time, _, contact) in flight.contact.all() {
        if *contact != touched && *contact != ContactKind::None {
            out.push(foxglove::log(unix_ns(*time), SEVERITY_CRITICAL, &format!("contact: {}", contact.label())));
        }
        touched = *contact;
    }
    for (number, (time, _, _)) in flight.snapshots.all().iter().enumerate() {
        out.push(foxglove::log(unix_ns(*time), SEVERITY_INFO, &format!("picture {}", number + 1)));
    }
    let mut hand = None;
    for (time, _, by) in flight.flown_by.all() {
        if hand != Some(*by) {
            out.push(foxglove::log(unix_ns(*time), SEVERITY_INFO, &format!("control: {}", by.label())));
        }
        hand = Some(*by);
    }
    out
}
