//! Feeds datagrams to a vehicle and checks invariants that must never be violated.

use super::mutate;
use spandrel_mavlink::codec::{Decoder, Encoder, ReceivedFrame};
use spandrel_mavlink::dialect::*;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::files::job::{DirectoryEntry, FileAction, FileError, FileJobResult};
use spandrel_sitl::endpoint::flavor::{ardupilot, px4};
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::Sim;
use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};

pub const STATION: LinkId = LinkId(1);
const SIDECAR: LinkId = LinkId(2);
/// Maximum number of responses and copies caused by one frame, in addition to all of a flavor's modes: an
/// acknowledgment, and a copy to the other link.
const EXTRA_RESPONSES: usize = 2;
/// Maximum number of unsolicited frames in five ticks: streams at their fastest, named values and full text queues, on
/// two links.
const MAX_FRAMES_PER_RUN: usize = 800;

/// A vehicle under test, or one with a planted fault.
pub trait TestVehicle {
    fn receive(&mut self, bytes: &[u8]);
    /// Processes received datagrams without advancing a tick.
    fn look(&mut self);
    /// Advances by some ticks.
    fn tick(&mut self);
    fn drain(&mut self) -> Vec<Vec<u8>>;
    fn all_finite(&self) -> bool;
}

/// A vehicle without planted faults.
pub struct Vehicle(pub Sim);

impl Vehicle {
    pub fn new(mut sim: Sim) -> Self {
        sim.open_link(SIDECAR, LinkKind::Payload, false);
        sim.enable_file_jobs();
        Self(sim)
    }

    /// Answers file jobs as if every file existed, with extreme or unusual contents.
    fn do_jobs(&mut self) {
        while let Some(job) = self.0.poll_file_job() {
            let outcome = match (job.ticket % 5, job.action) {
                (0, _) => Err(FileError::Other),
                (_, FileAction::List(_)) => Ok(FileJobResult::Entries(vec![
                    DirectoryEntry::Directory("d".repeat(300)),
                    DirectoryEntry::File("\u{fffd}\t\0".into(), u64::MAX),
                    DirectoryEntry::File(String::new(), 0),
                ])),
                (_, FileAction::Read(_, _, most)) => Ok(FileJobResult::Bytes(vec![7; most.min(40_000) as usize])),
                (_, FileAction::Size(_)) => Ok(FileJobResult::Size(u32::MAX)),
                (_, FileAction::Checksum { from, .. }) => Ok(FileJobResult::Checksum { sum: u32::MAX, bytes: from ^ u32::MAX }),
                _ => Ok(FileJobResult::Nothing),
            };
            self.0.finish_file_job(job.ticket, outcome);
        }
    }
}

impl TestVehicle for Vehicle {
    fn receive(&mut self, bytes: &[u8]) {
        self.0.handle_datagram(STATION, bytes);
    }

    fn look(&mut self) {
        let now = self.0.now();
        self.0.handle_timeout(now);
        self.do_jobs();
    }

    fn tick(&mut self) {
        let until = self.0.now() + SimTime::from_ms(5);
        self.0.handle_timeout(until);
    }

    fn drain(&mut self) -> Vec<Vec<u8>> {
        std::iter::from_fn(|| self.0.poll_transmit()).map(|t| t.bytes).collect()
    }

    fn all_finite(&self) -> bool {
        let truth = &self.0.truth().rigid;
        let all = truth.position_m.array().into_iter().chain(truth.velocity_m_s.array()).chain(truth.rates_rad_s.array());
        all.chain(truth.attitude.wxyz()).chain(truth.rotor_rad_s).all(f64::is_finite)
    }
}

/// A violated invariant.
#[derive(Debug)]
pub struct Finding {
    pub what: String,
    pub datagram: Vec<u8>,
}

/// Coverage of a run: counts of vehicle reactions.
#[derive(Debug, Default)]
pub struct Coverage {
    pub datagrams: usize,
    pub commands_accepted: BTreeSet<u16>,
    pub plans_accepted: usize,
    pub parameter_values: usize,
    pub file_data: usize,
    pub refusals: usize,
    pub modes: BTreeSet<u32>,
    pub answers: BTreeMap<u32, usize>,
}

pub struct Driver<'a> {
    pub stream: RandomStream,
    /// Numbers of the handled commands.
    pub numbers: &'a [u16],
    pub coverage: Coverage,
}

impl Driver<'_> {
    /// Sends `count` datagrams with some ticks after every second one, and finally checks whether the vehicle still
    /// responds.
    pub fn send_datagrams(&mut self, subject: &mut dyn TestVehicle, count: usize) -> Result<(), Finding> {
        let mut queue: Vec<Vec<u8>> = Vec::new();
        for k in 0..count {
            if queue.is_empty() {
                queue = if self.stream.below(8) == 0 {
                    mutate::upload(&mut self.stream)
                } else {
                    vec![mutate::datagram(self.numbers, &mut self.stream)]
                };
            }
            let datagram = queue.remove(0);
            self.coverage.datagrams += 1;
            let done = catch_unwind(AssertUnwindSafe(|| self.send_one(subject, &datagram, k % 2 == 0)));
            let result = done.unwrap_or_else(|panic| {
                let text = panic.downcast_ref::<String>().cloned();
                Err(format!("panic: {}", text.unwrap_or_else(|| panic.downcast_ref::<&str>().unwrap_or(&"?").to_string())))
            });
            result.map_err(|what| Finding { what, datagram })?;
        }
        self.still_answers(subject).map_err(|what| Finding { what, datagram: Vec::new() })
    }

    fn send_one(&mut self, subject: &mut dyn TestVehicle, datagram: &[u8], tick: bool) -> Result<(), String> {
        let frames = Decoder::new().datagram(datagram).len();
        subject.receive(datagram);
        subject.look();
        let answers = self.listen(subject)?;
        if answers > (max_mode_count() + EXTRA_RESPONSES) * frames {
            return Err(format!("{answers} responses to {frames} frames"));
        }
        if tick {
            subject.tick();
            let said = self.listen(subject)?;
            if said > MAX_FRAMES_PER_RUN {
                return Err(format!("{said} frames in five ticks"));
            }
        }
        if subject.all_finite() { Ok(()) } else { Err("the state contains NaN or infinity".into()) }
    }

    /// Returns the number of outgoing frames. Checks that each is complete and contains only finite numbers.
    fn listen(&mut self, subject: &mut dyn TestVehicle) -> Result<usize, String> {
        let mut count = 0;
        for bytes in subject.drain() {
            let mut decoder = Decoder::new();
            let frames = decoder.datagram(&bytes);
            if decoder.bad_bytes() > 0 {
                return Err("a datagram with incomplete frames".into());
            }
            count += frames.len();
            for frame in frames.iter().filter(|f| f.system_id == 1 && matches!(f.component_id, 1 | 100)) {
                self.record_coverage(frame);
                if !frame.message.as_ref().is_none_or(finite) {
                    return Err(format!("NaN or infinity in {:?}", frame.message));
                }
            }
        }
        Ok(count)
    }

    fn record_coverage(&mut self, frame: &ReceivedFrame) {
        let coverage = &mut self.coverage;
        *coverage.answers.entry(frame.message_id).or_default() += 1;
        match &frame.message {
            Some(MavMessage::COMMAND_ACK(ack)) if ack.result == MavResult::MAV_RESULT_ACCEPTED => {
                coverage.commands_accepted.insert(ack.command as u16);
            }
            Some(MavMessage::COMMAND_ACK(_)) => coverage.refusals += 1,
            Some(MavMessage::MISSION_ACK(ack)) if ack.mavtype == MavMissionResult::MAV_MISSION_ACCEPTED => {
                coverage.plans_accepted += 1;
            }
            Some(MavMessage::MISSION_ACK(_)) => coverage.refusals += 1,
            Some(MavMessage::FILE_TRANSFER_PROTOCOL(f)) if f.payload[3] == 128 && f.payload[4] > 0 => coverage.file_data += 1,
            Some(MavMessage::PARAM_VALUE(_)) => coverage.parameter_values += 1,
            Some(MavMessage::CURRENT_MODE(mode)) => {
                coverage.modes.insert(mode.custom_mode);
            }
            _ => {}
        }
    }

    fn still_answers(&mut self, subject: &mut dyn TestVehicle) -> Result<(), String> {
        let mut encoder = Encoder::new(255, 190);
        let read = PARAM_REQUEST_READ_DATA { target_system: 1, target_component: 1, ..Default::default() };
        let beat = COMMAND_LONG_DATA {
            command: MavCmd::MAV_CMD_REQUEST_MESSAGE,
            target_system: 1,
            target_component: 1,
            ..Default::default()
        };
        let mut heard = BTreeSet::new();
        for question in [MavMessage::PARAM_REQUEST_READ(read), MavMessage::COMMAND_LONG(beat)] {
            subject.receive(&encoder.encode(&question));
        }
        subject.look();
        for bytes in subject.drain() {
            heard.extend(Decoder::new().datagram(&bytes).iter().map(|f| f.message_id));
        }
        let missing: Vec<&u32> = [0, 22, 77].iter().filter(|id| !heard.contains(id)).collect();
        if missing.is_empty() { Ok(()) } else { Err(format!("no more responses: missing {missing:?}")) }
    }
}

/// Returns the maximum number of modes in any flavor; AVAILABLE_MODES can request all of a flavor's modes at once.
fn max_mode_count() -> usize {
    px4::FLAVOR.modes.len().max(ardupilot::FLAVOR.modes.len())
}

/// Checks that all fields of a state message are finite numbers.
fn finite(message: &MavMessage) -> bool {
    let all = |values: &[f32]| values.iter().all(|v| v.is_finite());
    match message {
        MavMessage::ATTITUDE_QUATERNION(a) => all(&[a.q1, a.q2, a.q3, a.q4, a.rollspeed, a.pitchspeed, a.yawspeed]),
        MavMessage::ATTITUDE_TARGET(a) => all(&a.q) && a.thrust.is_finite(),
        MavMessage::LOCAL_POSITION_NED(p) => all(&[p.x, p.y, p.z, p.vx, p.vy, p.vz]),
        MavMessage::POSITION_TARGET_LOCAL_NED(p) => all(&[p.x, p.y, p.z, p.vx, p.vy, p.vz, p.afx, p.afy, p.afz]),
        MavMessage::POSITION_TARGET_GLOBAL_INT(p) => p.alt.is_finite(),
        MavMessage::HIL_STATE_QUATERNION(h) => all(&h.attitude_quaternion),
        MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(g) => all(&g.q) && g.angular_velocity_y.is_finite(),
        MavMessage::CAMERA_IMAGE_CAPTURED(c) => all(&c.q),
        MavMessage::ILLUMINATOR_STATUS(l) => l.brightness.is_finite(),
        MavMessage::VFR_HUD(h) => all(&[h.alt, h.climb, h.groundspeed]),
        MavMessage::PARAM_VALUE(p) if p.param_type == MavParamType::MAV_PARAM_TYPE_REAL32 => p.param_value.is_finite(),
        _ => true,
    }
}
