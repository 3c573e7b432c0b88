//! A reinforcement learning environment: a vehicle controlled by velocity setpoints, and a task that defines observations and
//! rewards.
//!
//! Axes are forward, left, up. Heading axes rotate with the heading and stay level; body axes rotate with the body.

use crate::commands;
use crate::hover::Hover;
use crate::inspect::Inspect;
use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::dialect::{MavCmd, MavFrame, MavMessage, PositionTargetTypemask, SET_POSITION_TARGET_LOCAL_NED_DATA};
use spandrel_model::frames::{Enu, Frd, Ned, Rotation, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{AfterCrash, Scenario};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle as Aircraft;
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::Sim;
use spandrel_sitl::testing::{MissedExpectation, STATION, Vehicle};
use std::sync::Arc;

/// Link for setpoints. It receives replies but no telemetry streams, which would be unused.
const LINK: LinkId = LinkId(9);
/// MAVLink system and component ID of a companion computer, which controls the vehicle with setpoints.
const COMPANION_ID: (u8, u8) = (1, 191);
/// PX4's mode number for Offboard.
const OFFBOARD: f32 = 6.0;
/// Timeout for the aircraft to become ready; exceeding it indicates a fault.
const READY_TIMEOUT: SimTime = SimTime::from_ms(60_000);
/// Height tolerance at the start of an episode, m (estimate: accuracy of a takeoff in light wind).
const HEIGHT_TOLERANCE_M: f64 = 0.3;
/// Number of observation values common to all tasks; see [`Episode::motion`].
pub const MOTION_LEN: usize = 10;

/// Kind of task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Hold a position.
    Hover,
    /// Fly the job's paths and photograph the defects.
    Inspect,
}

impl Kind {
    /// Returns the time between two steps.
    pub fn step(self) -> SimTime {
        match self {
            Self::Hover => SimTime::from_ms(20),
            Self::Inspect => SimTime::from_ms(100),
        }
    }

    /// Returns the action length.
    pub fn actions(self) -> usize {
        match self {
            Self::Hover => 4,
            Self::Inspect => 7,
        }
    }

    /// Returns the observation length.
    pub fn observations(self) -> usize {
        match self {
            Self::Hover => Hover::OBSERVATION_LEN,
            Self::Inspect => Inspect::OBSERVATION_LEN,
        }
    }
}

/// Data shared by all episodes of an environment.
#[derive(Debug)]
pub struct World {
    /// Kind of task.
    pub kind: Kind,
    /// Scenario that defines the job.
    pub job: Scenario,
    /// Vehicle to fly.
    pub aircraft: Aircraft,
}

impl World {
    /// Returns the maximum velocity setpoint in any direction, in m/s: the job's speed limit.
    pub fn speed_m_s(&self) -> f64 {
        self.job.scoring.speed_limit_m_s
    }

    /// Returns the minimum and maximum of each action component.
    pub fn action_limits(&self) -> Vec<(f64, f64)> {
        let (speed, turn) = (self.speed_m_s(), self.aircraft.limits.yaw_rate_rad_s);
        let camera = &self.aircraft.camera;
        let mut limits = vec![(-speed, speed), (-speed, speed), (-speed, speed), (-turn, turn)];
        if self.kind == Kind::Inspect {
            limits.extend([(camera.gimbal_pitch_min_rad, camera.gimbal_pitch_max_rad), (0.0, 1.0), (0.0, 1.0)]);
        }
        limits
    }
}

/// Setpoints for one step.
#[derive(Debug, Clone, Copy)]
struct Setpoint {
    forward_m_s: f64,
    left_m_s: f64,
    up_m_s: f64,
    /// Yaw rate, counterclockwise from above.
    yaw_rate_rad_s: f64,
}

/// Outcome of one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Reward for the step.
    pub reward: f64,
    /// Whether the episode is over: a crash, an empty battery, or a completed task.
    pub terminated: bool,
    /// Two task-specific measures, for `info`.
    pub measures: [f64; 2],
}

#[derive(Debug, Clone)]
enum Task {
    Hover(Hover),
    Inspect(Box<Inspect>),
}

/// An episode: one flight from start to end.
#[derive(Debug, Clone)]
pub struct Episode {
    world: Arc<World>,
    sim: Sim,
    encoder: Encoder,
    task: Task,
}

impl Episode {
    /// Starts an episode with the vehicle in flight above the pad, in Offboard mode.
    pub fn start(world: &Arc<World>, seed: u64) -> Result<Self, MissedExpectation> {
        let builder = Vehicle::builder().seed(seed).after_crash(AfterCrash::End);
        let mut vehicle = builder.build_from(world.job.clone(), world.aircraft.clone());
        let (task, height_m) = match world.kind {
            Kind::Hover => {
                let hover = Hover::new(&world.job);
                (Task::Hover(hover), hover.point_m().up() - world.job.ground_team.pad_m.up())
            }
            Kind::Inspect => (Task::Inspect(Box::new(Inspect::new(&world.job))), Inspect::START_HEIGHT_M),
        };
        // Subscribes only to replies, because unused telemetry streams would take half of the reset time.
        vehicle.sim.await_heartbeat(STATION);
        vehicle.arm(READY_TIMEOUT)?;
        vehicle.take_off(height_m)?;
        vehicle.run_until(|v| (v.height_m() - height_m).abs() < HEIGHT_TOLERANCE_M, READY_TIMEOUT)?;
        // Offboard is rejected unless a setpoint was received before.
        let mut encoder = Encoder::new(COMPANION_ID.0, COMPANION_ID.1);
        let hold = encoder.encode(&message(Setpoint { forward_m_s: 0.0, left_m_s: 0.0, up_m_s: 0.0, yaw_rate_rad_s: 0.0 }));
        vehicle.sim.open_link(LINK, LinkKind::Sdk, false);
        vehicle.sim.await_heartbeat(LINK);
        vehicle.sim.handle_datagram(LINK, &hold);
        vehicle.run(world.kind.step());
        vehicle.command(MavCmd::MAV_CMD_DO_SET_MODE, &[1.0, OFFBOARD])?;
        Ok(Self { world: Arc::clone(world), sim: vehicle.into_sim(), encoder, task })
    }

    /// Runs one step. The action is clamped to [`World::action_limits`].
    pub fn step(&mut self, action: &[f32]) -> Outcome {
        let limits = self.world.action_limits();
        let held = |k: usize| {
            let (low, high) = limits[k];
            action.get(k).map_or(0.0, |value| f64::from(*value).clamp(low, high))
        };
        let setpoint = Setpoint { forward_m_s: held(0), left_m_s: held(1), up_m_s: held(2), yaw_rate_rad_s: held(3) };
        self.send(&message(setpoint));
        if self.world.kind == Kind::Inspect {
            self.command_payload(held(4), held(5) > 0.5, held(6) > 0.5);
        }
        let until = self.sim.now() + self.world.kind.step();
        self.sim.handle_timeout(until);
        while self.sim.poll_transmit().is_some() {}
        while self.sim.poll_event().is_some() {}
        let over = self.sim.hits() > 0 || self.sim.ended().is_some();
        match &mut self.task {
            Task::Hover(hover) => hover.evaluate(&self.sim, over),
            Task::Inspect(inspect) => inspect.evaluate(&self.sim, over),
        }
    }

    /// Commands gimbal, lamp and shutter.
    fn command_payload(&mut self, gimbal_rad: f64, lamp_on: bool, snapshot: bool) {
        let skip = f32::NAN;
        let pitch_deg = gimbal_rad.to_degrees() as f32;
        self.send(&commands::long(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, &[pitch_deg, skip, skip, skip, 0.0, 0.0, 0.0]));
        if lamp_on != self.sim.payload().lamp.on {
            self.send(&commands::long(MavCmd::MAV_CMD_DO_SET_RELAY, &[0.0, f32::from(u8::from(lamp_on))]));
        }
        if snapshot {
            self.send(&commands::long(MavCmd::MAV_CMD_IMAGE_START_CAPTURE, &[0.0, 0.0, 1.0, 0.0]));
            // The photo is taken in the first tick, so it is evaluated at that position.
            let before = self.pictures();
            self.sim.handle_timeout(self.sim.poll_timeout());
            if self.pictures() > before
                && let Task::Inspect(inspect) = &mut self.task
            {
                inspect.evaluate_photo(&self.sim, &self.world.aircraft);
            }
        }
    }

    fn pictures(&self) -> usize {
        self.sim.payload().camera.summary(self.sim.now()).pictures
    }

    fn send(&mut self, message: &MavMessage) {
        let bytes = self.encoder.encode(message);
        self.sim.handle_datagram(LINK, &bytes);
    }

    /// Appends the observation.
    pub fn observe(&self, out: &mut Vec<f32>) {
        match &self.task {
            Task::Hover(hover) => hover.observe(&self.sim, out),
            Task::Inspect(inspect) => inspect.observe(&self.sim, out),
        }
    }

    /// Returns the SHA-256 of the state at every tick.
    pub fn digest(&self) -> [u8; 32] {
        self.sim.digest()
    }

    /// Returns the simulation time in seconds.
    pub fn time_s(&self) -> f64 {
        self.sim.now().s()
    }
}

/// Transforms a vector into heading axes.
pub fn to_heading_axes(vector: Vec3<Enu>, attitude: Rotation<Frd, Ned>) -> [f64; 3] {
    let (sin, cos) = math::sin_cos(attitude.yaw_rad());
    [vector.east() * sin + vector.north() * cos, vector.north() * sin - vector.east() * cos, vector.up()]
}

/// Returns velocity in heading axes (3, m/s), the up direction in body axes (3), angular velocity in body axes (3, rad/s) and
/// battery (0 to 1).
pub fn motion(sim: &Sim) -> [f64; MOTION_LEN] {
    let truth = sim.truth();
    let rigid = &truth.rigid;
    let v = to_heading_axes(rigid.velocity_m_s.enu(), rigid.attitude);
    let up = rigid.attitude.inverse() * Vec3::<Ned>::new(0.0, 0.0, -1.0);
    let w = rigid.rates_rad_s;
    let battery = truth.battery.remaining_pct() / 100.0;
    [v[0], v[1], v[2], up.forward(), -up.right(), -up.down(), w.forward(), -w.right(), -w.down(), battery]
}

/// Appends values as 32-bit floats.
pub fn append(out: &mut Vec<f32>, values: &[f64]) {
    out.extend(values.iter().map(|value| *value as f32));
}

/// Creates the setpoint message with a velocity in MAVLink's heading-aligned axes: forward, right, down.
fn message(setpoint: Setpoint) -> MavMessage {
    use PositionTargetTypemask as Ignore;
    MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        coordinate_frame: MavFrame::MAV_FRAME_BODY_FRD,
        type_mask: Ignore::POSITION_TARGET_TYPEMASK_X_IGNORE
            | Ignore::POSITION_TARGET_TYPEMASK_Y_IGNORE
            | Ignore::POSITION_TARGET_TYPEMASK_Z_IGNORE
            | Ignore::POSITION_TARGET_TYPEMASK_AX_IGNORE
            | Ignore::POSITION_TARGET_TYPEMASK_AY_IGNORE
            | Ignore::POSITION_TARGET_TYPEMASK_AZ_IGNORE
            | Ignore::POSITION_TARGET_TYPEMASK_YAW_IGNORE,
        vx: setpoint.forward_m_s as f32,
        vy: -setpoint.left_m_s as f32,
        vz: -setpoint.up_m_s as f32,
        yaw_rate: -setpoint.yaw_rate_rad_s as f32,
        target_system: 1,
        target_component: 1,
        ..SET_POSITION_TARGET_LOCAL_NED_DATA::default()
    })
}
