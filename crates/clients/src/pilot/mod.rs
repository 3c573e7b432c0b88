//! A synthetic trainee that flies over MAVLink like a person at a ground station. It uses only MANUAL_CONTROL and the
//! lamp, gimbal, and camera commands. It has the job's data (scenario, reference paths, lines of sight) and perceives
//! the aircraft with delay and error. Its errors arise from noise; none are scripted. Sans-IO: it consumes and produces
//! datagrams, and takes the time from the vehicle.

mod config;
pub mod goals;
pub mod hand_motion;
pub mod perception;
pub mod route_search;
pub mod skill;
pub mod track;
pub mod vehicle_link;
pub mod visual_search;

pub mod flight_plan;
mod guidance;
mod guidance_state;
pub mod hold;
pub mod orientation;
pub mod photo_spot;
mod photography;
pub mod setbacks;
pub mod skill_file;
mod stick_command;

pub use config::PilotConfig;
pub use skill::{Skill, SkillFactor};

use goals::FlightGoal;
use guidance_state::Guidance;
use hand_motion::HandMotion;
use orientation::Orientation;
use perception::{MAX_JUDGED_DISTANCE_M, MotionState, NearSurface, Perception};
use spandrel_mavlink::dialect::MavCmd;
use spandrel_model::random::RandomStream;
use spandrel_model::site::Site;
use spandrel_model::time::{Schedule, SimTime};
use std::collections::VecDeque;
use std::sync::Arc;
use track::TrackCommand;
use vehicle_link::{VehicleLink, VehicleUpdate};
use visual_search::VisualSearch;

/// Retry interval for a command that has not taken effect, s.
const RETRY_INTERVAL_S: f64 = 1.5;
/// Maximum horizontal distance from the pad's center at which the pilot descends, m (estimate: within reach of the last
/// correction).
const MAX_PAD_OFFSET_M: f64 = 2.5;
/// Minimum height during the approach to the pad, m (estimate: clears the truck).
const MIN_APPROACH_HEIGHT_M: f64 = 5.0;
/// Time after a respawn at which the pilot checks whether the aircraft stands on the ground and must take off again, s of
/// simulation time. The built-in autopilot respawns in the air, and an external one on the landing pad.
const RESPAWN_CHECK_DELAY_S: f64 = 3.0;
/// Timeout for the vehicle to become ready, and for the aircraft to climb, s of simulation time.
const START_TIMEOUT_S: f64 = 60.0;

/// End-of-flight report from the pilot's point of view.
#[derive(Debug, Clone, PartialEq)]
pub struct PilotReport {
    /// Reason for the end of the flight.
    pub reason: String,
    /// Simulation time at the end.
    pub at: SimTime,
    /// Number of tasks flown to completion.
    pub tasks_flown: usize,
    /// Number of pictures taken.
    pub pictures: u32,
    /// Time in which the pilot moved sticks the wrong way.
    pub lost: SimTime,
}

/// Phase of the flight.
#[derive(Debug, Clone, PartialEq)]
enum PilotPhase {
    /// Waits until the vehicle is ready, then arms.
    Prepare,
    /// Takes off from the pad.
    Climb,
    /// Flies the job.
    Fly,
    /// Lands on the pad.
    Descend,
    /// The flight has ended.
    Done,
}

/// The synthetic trainee.
#[derive(Debug)]
pub struct Pilot {
    config: PilotConfig,
    site: Option<Arc<Site>>,
    link: VehicleLink,
    perception: Perception,
    hand_motion: HandMotion,
    visual_search: VisualSearch,
    orientation: Orientation,
    /// Random choices that are neither perception nor motor noise.
    choices: RandomStream,
    goals: VecDeque<FlightGoal>,
    guidance: Guidance,
    phase: PilotPhase,
    now: SimTime,
    /// Time of the first data from the vehicle, which may have been running for long.
    connected_at: Option<SimTime>,
    heartbeat: Schedule,
    last_attempt: SimTime,
    phase_since: SimTime,
    respawns: i32,
    respawned_at: Option<SimTime>,
    lamp: bool,
    gimbal_rad: f64,
    gimbal_sent: SimTime,
    report: Option<PilotReport>,
    tasks_flown: usize,
    pictures: u32,
}

impl Pilot {
    /// Creates a pilot for a job, an aircraft, and a skill.
    #[must_use]
    pub fn new(config: PilotConfig) -> Self {
        let jobs = (0..config.scenario.tasks.len()).map(FlightGoal::Task).chain([FlightGoal::Home]).collect();
        Self {
            site: None,
            link: VehicleLink::new(),
            perception: Perception::new(config.seed),
            hand_motion: HandMotion::new(config.seed),
            visual_search: VisualSearch::new(config.seed),
            orientation: Orientation::new(config.seed),
            choices: RandomStream::new(config.seed, "pilot choices"),
            goals: jobs,
            guidance: Guidance::new(),
            phase: PilotPhase::Prepare,
            now: SimTime::ZERO,
            connected_at: None,
            heartbeat: Schedule::new(SimTime::ZERO, 1.0),
            last_attempt: SimTime::ZERO,
            phase_since: SimTime::ZERO,
            respawns: 0,
            respawned_at: None,
            lamp: false,
            gimbal_rad: 0.0,
            gimbal_sent: SimTime::ZERO,
            report: None,
            tasks_flown: 0,
            pictures: 0,
            config,
        }
    }

    /// Processes a datagram and queues the responses.
    pub fn handle_datagram(&mut self, bytes: &[u8]) {
        let plane = spandrel_model::geodesy::LocalPlane::new(self.config.scenario.origin);
        for news in self.link.receive(bytes, &plane) {
            match news {
                VehicleUpdate::Truth(motion) => self.observe(motion),
                VehicleUpdate::Timesync(token) => {
                    self.send_heartbeat(SimTime::from_ns(token));
                    self.link.respond_to_timesync(token, self.now);
                }
            }
        }
        if self.site.is_none()
            && let Some(seed) = self.link.status.seed
        {
            self.site = Some(Arc::new(Site::build(&self.config.scenario, seed)));
        }
    }

    /// Advances the pilot's clock until the first datagram arrives, and sends heartbeats so that a vehicle waiting for
    /// a connection can find the pilot.
    pub fn handle_timeout(&mut self, now: SimTime) {
        if self.now == SimTime::ZERO {
            self.send_heartbeat(now);
        }
    }

    /// Returns the next datagram to send.
    pub fn poll_transmit(&mut self) -> Option<Vec<u8>> {
        self.link.poll_transmit()
    }

    /// Returns the report once the flight has ended.
    #[must_use]
    pub fn finished(&self) -> Option<&PilotReport> {
        self.report.as_ref()
    }

    /// Returns a progress text, such as "in transit".
    #[must_use]
    pub fn status_text(&self) -> String {
        match (&self.phase, self.guidance.task()) {
            (PilotPhase::Prepare, _) => "preparing".into(),
            (PilotPhase::Climb, _) => "taking off".into(),
            (PilotPhase::Fly, Some(task)) => format!("task {}", self.config.scenario.tasks[task].id),
            (PilotPhase::Fly, None) => "in transit".into(),
            (PilotPhase::Descend, _) => "landing".into(),
            (PilotPhase::Done, _) => "done".into(),
        }
    }

    fn send_heartbeat(&mut self, now: SimTime) {
        if self.heartbeat.fire(now) {
            self.link.send_heartbeat();
        }
    }

    /// Processes a motion sample (50 Hz).
    fn observe(&mut self, motion: MotionState) {
        let put_back = self.link.status.respawns != self.respawns;
        if motion.time <= self.now || (self.phase == PilotPhase::Done && !(put_back && self.landed())) {
            return;
        }
        let dt_s = (motion.time - self.now).s().min(0.1);
        self.now = motion.time;
        self.connected_at.get_or_insert(self.now);
        self.send_heartbeat(motion.time);
        if put_back {
            self.respawns = self.link.status.respawns;
            if self.phase == PilotPhase::Done {
                // The aircraft landed outside the home circle and was respawned in the air.
                self.report = None;
                self.enter(PilotPhase::Descend);
            }
            self.perception.reset();
            self.hand_motion.release();
            self.orientation.reset();
            self.guidance.replan();
            self.respawned_at = Some(self.now);
        }
        self.take_off_after_respawn();
        self.perception.observe(motion);
        let skill = self.config.skill;
        let surface = self.near_surface(&motion);
        let cued = self.now < self.guidance.cued_until;
        let Some(belief) = self.perception.estimate(&skill, (surface, cued), dt_s) else { return };
        let axes = self.fly_phase(&belief);
        let axes = match self.phase {
            PilotPhase::Fly => {
                self.orientation.look_at_panel(self.link.status.guided_distance_m, &skill, self.now);
                self.orientation.step(axes, &skill, self.faces_pilot(&motion), self.now, dt_s)
            }
            PilotPhase::Prepare | PilotPhase::Climb | PilotPhase::Descend | PilotPhase::Done => axes,
        };
        let axes = stick_command::deflections(axes, &self.config.vehicle.limits, self.link.status.stick_response());
        let axes = self.hand_motion.step(axes, &skill, self.now, dt_s);
        self.link.send_sticks(axes);
    }

    /// Returns the surface whose distance the pilot judges; `None` in open air and near the landing pad.
    fn near_surface(&self, motion: &MotionState) -> Option<NearSurface> {
        let site = self.site.as_ref().filter(|_| self.phase == PilotPhase::Fly)?;
        let near = site.nearest(motion.position_m, MAX_JUDGED_DISTANCE_M, self.now)?;
        Some(NearSurface { distance_m: near.distance_m, normal: near.normal })
    }

    /// Prepares another takeoff if the aircraft was put back on the ground with its motors off.
    fn take_off_after_respawn(&mut self) {
        let is_due = self.respawned_at.is_some_and(|at| (self.now - at).s() > RESPAWN_CHECK_DELAY_S);
        if !is_due {
            return;
        }
        self.respawned_at = None;
        let stands = self.link.status.on_ground && !self.link.status.armed;
        if stands && matches!(self.phase, PilotPhase::Fly | PilotPhase::Descend) {
            self.enter(PilotPhase::Prepare);
        }
    }

    fn enter(&mut self, phase: PilotPhase) {
        self.phase = phase;
        self.phase_since = self.now;
    }

    fn phase_time_s(&self) -> f64 {
        (self.now - self.phase_since).s()
    }

    fn fly_phase(&mut self, belief: &MotionState) -> hand_motion::StickAxes {
        match self.phase {
            PilotPhase::Prepare => self.prepare(),
            PilotPhase::Climb => self.climb(belief),
            PilotPhase::Fly => self.fly(belief),
            PilotPhase::Descend => self.descend(belief),
            PilotPhase::Done => [0.0; 4],
        }
    }

    /// Checks whether enough time has passed to resend a command.
    fn may_retry(&mut self) -> bool {
        let may = (self.now - self.last_attempt).s() > RETRY_INTERVAL_S;
        if may {
            self.last_attempt = self.now;
        }
        may
    }

    fn arm(&mut self) {
        if self.may_retry() {
            self.link.set_position_mode();
            self.link.send_command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        }
    }

    fn prepare(&mut self) -> hand_motion::StickAxes {
        if self.link.status.armed && self.site.is_some() {
            self.enter(PilotPhase::Climb);
        } else if self.link.status.ready && self.site.is_some() && self.phase_time_s() > 1.0 {
            self.arm();
        }
        if (self.now - self.connected_at.unwrap_or(self.now)).s() > START_TIMEOUT_S {
            self.finish("the vehicle never became ready");
        }
        [0.0; 4]
    }

    fn climb(&mut self, belief: &MotionState) -> hand_motion::StickAxes {
        let up = goals::hover_point_over_pad(&self.config.scenario).up();
        if !self.link.status.armed && self.phase_time_s() > 2.0 {
            self.arm();
        }
        if belief.position_m.up() > up - 1.0 {
            self.enter(PilotPhase::Fly);
        } else if self.phase_time_s() > START_TIMEOUT_S {
            self.finish("the aircraft did not climb");
        }
        let rate = if belief.position_m.up() > up - 3.0 { 0.8 } else { 1.8 };
        [0.0, 0.0, rate / self.config.vehicle.limits.climb_m_s, 0.0]
    }

    /// Descends manually: centers over the pad, slows near the ground, then holds the stick down until the vehicle
    /// reports a landing. Takes off again if it landed outside the home circle.
    fn descend(&mut self, belief: &MotionState) -> hand_motion::StickAxes {
        let team = &self.config.scenario.ground_team;
        let off = team.pad_m - belief.position_m;
        let level = spandrel_model::frames::Vec3::new(off.east(), off.north(), 0.0);
        let (height_m, aside_m) = (-off.up(), level.norm());
        if self.link.status.on_ground && self.phase_time_s() > 2.0 {
            let home = aside_m <= team.home_radius_m;
            match (home, self.link.status.armed) {
                (true, false) => self.finish("landed"),
                (true, true) if self.may_retry() => {
                    self.link.send_command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [0.0; 7]);
                }
                (false, false) => self.arm(),
                _ => {}
            }
            return [0.0, 0.0, if home || !self.link.status.armed { -1.0 } else { 0.5 }, 0.0];
        }
        let rate = match (aside_m > MAX_PAD_OFFSET_M, height_m) {
            (true, ..MIN_APPROACH_HEIGHT_M) => -0.8,
            (true, _) => 0.0,
            (false, ..=3.0) => 0.5,
            (false, _) => 1.2,
        };
        let speed_m_s = if aside_m > MAX_PAD_OFFSET_M { 2.0 } else { 1.0 };
        let wish =
            (level * (0.6 * self.config.skill.gain)).limited(speed_m_s) + spandrel_model::frames::Vec3::new(0.0, 0.0, -rate);
        let mut axes = stick_command::sticks(&TrackCommand::velocity(wish), belief, &self.config);
        if height_m < 0.5 && aside_m <= MAX_PAD_OFFSET_M {
            axes[2] = -1.0_f64.min(0.5 / self.config.vehicle.limits.descend_m_s).abs();
        }
        axes
    }

    fn landed(&self) -> bool {
        self.report.as_ref().is_some_and(|report| report.reason == "landed")
    }

    fn finish(&mut self, reason: &str) {
        self.report = Some(PilotReport {
            reason: reason.into(),
            at: self.now,
            tasks_flown: self.tasks_flown,
            pictures: self.pictures,
            lost: self.orientation.lost(),
        });
        self.enter(PilotPhase::Done);
    }
}
