//! One environment for reinforcement learning: a vehicle that flies by velocity setpoints, and a task that observes and rewards.
//!
//! Axes are forward, left, up. "Heading axes" turn with the heading and stay level; "body axes" turn with the body.

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

/// The link that setpoints come over. It gets answers and no streams: nobody reads them.
const LINK: LinkId = LinkId(9);
/// MAVLink ids of a companion computer, which fly by setpoints.
const COMPANION: (u8, u8) = (1, 191);
/// PX4's number of the mode Offboard.
const OFFBOARD: f32 = 6.0;
/// An aircraft that is not ready after this has a fault.
const READY: SimTime = SimTime::from_ms(60_000);
/// Distance from the height of an episode's start, m (estimate: what a take-off keeps in light wind).
const AT_HEIGHT_M: f64 = 0.3;
/// Values of an observation that are the same for every task: see [`Episode::motion`].
pub const MOTION: usize = 10;

/// Which task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Hold a point.
    Hover,
    /// Fly the paths of the job and photograph its defects.
    Inspect,
}

impl Kind {
    /// Time between two steps.
    pub fn step(self) -> SimTime {
        match self {
            Self::Hover => SimTime::from_ms(20),
            Self::Inspect => SimTime::from_ms(100),
        }
    }

    /// Length of an action.
    pub fn actions(self) -> usize {
        match self {
            Self::Hover => 4,
            Self::Inspect => 7,
        }
    }

    /// Length of an observation.
    pub fn observations(self) -> usize {
        match self {
            Self::Hover => Hover::OBSERVATIONS,
            Self::Inspect => Inspect::OBSERVATIONS,
        }
    }
}

/// What all episodes of an environment share.
#[derive(Debug)]
pub struct World {
    /// Which task.
    pub kind: Kind,
    /// The job.
    pub job: Scenario,
    /// The aircraft.
    pub aircraft: Aircraft,
}

impl World {
    /// Largest velocity setpoint in any direction, m/s: the job's speed limit.
    pub fn speed_m_s(&self) -> f64 {
        self.job.scoring.speed_limit_m_s
    }

    /// Lowest and highest value of each part of an action.
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

/// Setpoints of one step.
#[derive(Debug, Clone, Copy)]
struct Setpoint {
    forward_m_s: f64,
    left_m_s: f64,
    up_m_s: f64,
    /// Counterclockwise from above.
    yaw_rate_rad_s: f64,
}

/// What a step brought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Reward.
    pub reward: f64,
    /// The episode is over: a crash, an empty battery, or everything done.
    pub terminated: bool,
    /// Two measures of the task, for `info`.
    pub measures: [f64; 2],
}

#[derive(Debug, Clone)]
enum Task {
    Hover(Hover),
    Inspect(Box<Inspect>),
}

/// One flight from its start to its end.
#[derive(Debug, Clone)]
pub struct Episode {
    world: Arc<World>,
    sim: Sim,
    encoder: Encoder,
    task: Task,
}

impl Episode {
    /// A vehicle in the air over the pad, in mode Offboard.
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
        // Answers alone: what nobody reads would take half of a reset's time.
        vehicle.sim.await_heartbeat(STATION);
        vehicle.arm(READY)?;
        vehicle.take_off(height_m)?;
        vehicle.run_until(|v| (v.height_m() - height_m).abs() < AT_HEIGHT_M, READY)?;
        // A setpoint comes first: without one, Offboard is refused.
        let mut encoder = Encoder::new(COMPANION.0, COMPANION.1);
        let hold = encoder.encode(&message(Setpoint { forward_m_s: 0.0, left_m_s: 0.0, up_m_s: 0.0, yaw_rate_rad_s: 0.0 }));
        vehicle.sim.open_link(LINK, LinkKind::Sdk, false);
        vehicle.sim.await_heartbeat(LINK);
        vehicle.sim.handle_datagram(LINK, &hold);
        vehicle.run(world.kind.step());
        vehicle.command(MavCmd::MAV_CMD_DO_SET_MODE, &[1.0, OFFBOARD])?;
        Ok(Self { world: Arc::clone(world), sim: vehicle.into_sim(), encoder, task })
    }

    /// Runs one step. The action is one of [`World::action_limits`] and is held to it.
    pub fn step(&mut self, action: &[f32]) -> Outcome {
        let limits = self.world.action_limits();
        let held = |k: usize| {
            let (low, high) = limits[k];
            action.get(k).map_or(0.0, |value| f64::from(*value).clamp(low, high))
        };
        let setpoint = Setpoint { forward_m_s: held(0), left_m_s: held(1), up_m_s: held(2), yaw_rate_rad_s: held(3) };
        self.send(&message(setpoint));
        if self.world.kind == Kind::Inspect {
            self.work(held(4), held(5) > 0.5, held(6) > 0.5);
        }
        let until = self.sim.now() + self.world.kind.step();
        self.sim.handle_timeout(until);
        while self.sim.poll_transmit().is_some() {}
        while self.sim.poll_event().is_some() {}
        let over = self.sim.hits() > 0 || self.sim.ended().is_some();
        match &mut self.task {
            Task::Hover(hover) => hover.judge(&self.sim, over),
            Task::Inspect(inspect) => inspect.judge(&self.sim, over),
        }
    }

    /// Gimbal, lamp and shutter.
    fn work(&mut self, gimbal_rad: f64, lamp_on: bool, snapshot: bool) {
        let skip = f32::NAN;
        let pitch_deg = gimbal_rad.to_degrees() as f32;
        self.send(&commands::long(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, &[pitch_deg, skip, skip, skip, 0.0, 0.0, 0.0]));
        if lamp_on != self.sim.payload().lamp.on {
            self.send(&commands::long(MavCmd::MAV_CMD_DO_SET_RELAY, &[0.0, f32::from(u8::from(lamp_on))]));
        }
        if snapshot {
            self.send(&commands::long(MavCmd::MAV_CMD_IMAGE_START_CAPTURE, &[0.0, 0.0, 1.0, 0.0]));
            // The picture is taken in the first tick: it is judged where it was taken.
            let before = self.pictures();
            self.sim.handle_timeout(self.sim.poll_timeout());
            if self.pictures() > before
                && let Task::Inspect(inspect) = &mut self.task
            {
                inspect.judge_picture(&self.sim, &self.world.aircraft);
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

    /// SHA-256 over every tick's state.
    pub fn digest(&self) -> [u8; 32] {
        self.sim.digest()
    }

    /// Simulation time, s.
    pub fn time_s(&self) -> f64 {
        self.sim.now().s()
    }
}

/// A vector in heading axes.
pub fn in_heading(vector: Vec3<Enu>, attitude: Rotation<Frd, Ned>) -> [f64; 3] {
    let (sin, cos) = math::sin_cos(attitude.yaw_rad());
    [vector.east() * sin + vector.north() * cos, vector.north() * sin - vector.east() * cos, vector.up()]
}

/// Velocity in heading axes (3, m/s), the direction of up in body axes (3), angular velocity in body axes (3, rad/s), battery (0 to 1).
pub fn motion(sim: &Sim) -> [f64; MOTION] {
    let truth = sim.truth();
    let rigid = &truth.rigid;
    let v = in_heading(rigid.velocity_m_s.enu(), rigid.attitude);
    let up = rigid.attitude.inverse() * Vec3::<Ned>::new(0.0, 0.0, -1.0);
    let w = rigid.rates_rad_s;
    let battery = truth.battery.remaining_pct() / 100.0;
    [v[0], v[1], v[2], up.forward(), -up.right(), -up.down(), w.forward(), -w.right(), -w.down(), battery]
}

/// Appends numbers as an observation holds them.
pub fn append(out: &mut Vec<f32>, values: &[f64]) {
    out.extend(values.iter().map(|value| *value as f32));
}

/// A velocity about the heading, as MAVLink says it: forward, right, down.
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
