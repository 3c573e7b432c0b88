//! The planted weaknesses. Each one changes the pilot's idea of the job (where to fly, where to look), what its hands do
//! (sticks and commands) or numbers of its skill, and nothing else.

use crate::bumps::{BumpPlan, Bumps, bump};
use spandrel_clients::pilot::Skill;
use spandrel_mavlink::dialect::{COMMAND_LONG_DATA, MANUAL_CONTROL_DATA, MavCmd, MavMessage};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::{Scenario, Task, TaskKind};
use spandrel_model::site::Site;
use spandrel_model::vehicle::FlightLimits;
use std::collections::VecDeque;
use std::sync::Arc;

/// Changes a message from the pilot to the vehicle; an empty list drops it.
pub type Tamper = fn(&mut Hands, MavMessage) -> Vec<MavMessage>;

/// A pilot with one named fault.
pub struct Weakness {
    pub name: &'static str,
    /// Drills that train this weakness.
    pub drills: &'static [&'static str],
    /// Other scenarios that are no mistake, because they train what the fault leads to.
    pub also: &'static [&'static str],
    pub skill: Skill,
    pub belief: fn(&mut Scenario),
    pub tamper: Tamper,
}

/// Full stick deflection in MANUAL_CONTROL.
pub const FULL_STICK: f64 = 1000.0;
/// Stick messages between two changes of the planted stick noise: 0.3 s at 50 Hz.
const NOISE_PERIOD: u64 = 15;
/// Deadband of the sticks in position mode, as a fraction of full deflection.
pub const STICK_DEADBAND: f64 = 0.03;
/// Standard deviation of the planted noise, as a fraction of full deflection.
const NOISE: f64 = 0.25;
/// Stick messages between two pictures of a pilot who photographs at random: 2 s at 50 Hz.
const RANDOM_PICTURE_PERIOD: u64 = 100;
/// Only every fourth picture is taken by a pilot who overlooks defects.
const OVERLOOKED: u64 = 4;

/// A pilot whose nose never rests adds this multiple of the planted noise to the yaw stick: a standard deviation of 30 degrees/s.
const MODERATE_YAW_NOISE: f64 = 1.2;
/// A pilot who bumps into the bridge touches it three times every 18 s at 50 Hz in the interlayer, and 22 times in all. There, a contact
/// takes the drone less than the threshold away from the path, so that the precision suffers little.
const BUMPS: BumpPlan = BumpPlan { condition: |hands| hands.flies_task(3), period: 900, touches: 3, total: 22 };

/// Motion of the drone, which some hands react to.
#[derive(Debug, Clone, Copy)]
pub struct DroneState {
    pub position_m: Vec3<Enu>,
    pub heading_rad: f64,
    pub touching: bool,
}

/// State of the pilot's hands.
pub struct Hands {
    status: String,
    /// Number of the task that the pilot flies or has flown last; 0 before the first.
    latest_task: u32,
    pub last_task_flown: bool,
    random: RandomStream,
    noise: [f64; 4],
    pub stick_messages: u64,
    pictures: u64,
    /// Messages that the hands still owe, each with the count of stick messages at which it goes out.
    pub owed: VecDeque<(u64, MavMessage)>,
    /// Stick positions that the hands have not followed yet.
    pub late_sticks: VecDeque<[f64; 4]>,
    pub drone: DroneState,
    pub site: Arc<Site>,
    /// Position of the pilot.
    pub pilot_m: Vec3<Enu>,
    limits: FlightLimits,
    pub bumps: Bumps,
}

impl Hands {
    pub fn new(seed: u64, site: Arc<Site>, pilot_m: Vec3<Enu>, limits: FlightLimits) -> Self {
        Self {
            status: String::new(),
            latest_task: 0,
            last_task_flown: false,
            random: RandomStream::new(seed, "planted weakness"),
            noise: [0.0; 4],
            stick_messages: 0,
            pictures: 0,
            owed: VecDeque::new(),
            late_sticks: VecDeque::new(),
            drone: DroneState { position_m: Vec3::zero(), heading_rad: 0.0, touching: false },
            site,
            pilot_m,
            limits,
            bumps: Bumps::default(),
        }
    }

    /// Takes note of what the pilot does and how the drone moves.
    pub fn observe(&mut self, status: &str, drone: DroneState) {
        self.last_task_flown |= self.status == "task 4" && status != "task 4";
        if let Some(task) = status.strip_prefix("task ").and_then(|id| id.parse().ok()) {
            self.latest_task = task;
        }
        status.clone_into(&mut self.status);
        self.drone = drone;
    }

    /// Returns whether the pilot has begun the task with this number or a later one.
    pub fn has_begun_task(&self, id: u32) -> bool {
        self.latest_task >= id
    }

    /// Returns the stick positions for a velocity over the ground: the drone responds in proportion to the sticks beyond the deadband.
    pub fn sticks_for(&self, velocity_m_s: Vec3<Enu>) -> [f64; 3] {
        let (sin, cos) = math::sin_cos(self.drone.heading_rad);
        let forward_m_s = velocity_m_s.east() * sin + velocity_m_s.north() * cos;
        let right_m_s = velocity_m_s.east() * cos - velocity_m_s.north() * sin;
        let vertical_m_s = if velocity_m_s.up() > 0.0 { self.limits.climb_m_s } else { self.limits.descend_m_s };
        let fractions =
            [forward_m_s / self.limits.forward_m_s, right_m_s / self.limits.sideways_speed_m_s, velocity_m_s.up() / vertical_m_s];
        fractions.map(|fraction| (STICK_DEADBAND + (1.0 - STICK_DEADBAND) * fraction.abs()).copysign(fraction))
    }

    /// Returns whether the pilot flies the task with this number.
    pub fn flies_task(&self, id: u32) -> bool {
        self.status == format!("task {id}")
    }

    /// Returns whether the pilot lands.
    pub fn lands(&self) -> bool {
        self.status == "landing"
    }

    /// Returns whether the pilot flies between the tasks, to the first one or home.
    pub fn in_transit(&self) -> bool {
        self.status == "in transit"
    }

    /// Returns the height above the ground beside the landing pad, m.
    pub fn height_m(&self) -> f64 {
        self.drone.position_m.up() - self.pilot_m.up()
    }

    /// Returns whether the pilot flies any task.
    pub fn in_task(&self) -> bool {
        self.status.starts_with("task ")
    }

    /// Returns the planted noise of the four axes.
    fn noise(&mut self) -> [f64; 4] {
        if self.stick_messages.is_multiple_of(NOISE_PERIOD) {
            self.noise = std::array::from_fn(|_| NOISE * self.random.normal());
        }
        self.noise
    }
}

pub fn as_intended(_: &mut Scenario) {}

pub fn untouched(_: &mut Hands, message: MavMessage) -> Vec<MavMessage> {
    vec![message]
}

/// Changes the sticks while the pilot flies a task.
pub fn with_sticks(hands: &mut Hands, message: MavMessage, change: fn(&mut Hands, [f64; 4]) -> [f64; 4]) -> Vec<MavMessage> {
    with_sticks_while(hands, message, Hands::in_task, change)
}

/// Changes the sticks while a condition holds.
pub fn with_sticks_while(
    hands: &mut Hands,
    message: MavMessage,
    condition: fn(&Hands) -> bool,
    change: fn(&mut Hands, [f64; 4]) -> [f64; 4],
) -> Vec<MavMessage> {
    let MavMessage::MANUAL_CONTROL(sticks) = message else { return vec![message] };
    hands.stick_messages += 1;
    if !condition(hands) {
        return vec![MavMessage::MANUAL_CONTROL(sticks)];
    }
    let axes = [sticks.x, sticks.y, 2 * (sticks.z - 500), sticks.r].map(|axis| f64::from(axis) / FULL_STICK);
    let [x, y, z, r] = change(hands, axes).map(|axis| (FULL_STICK * axis.clamp(-1.0, 1.0)).round() as i16);
    vec![MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { x, y, z: 500 + z / 2, r, ..sticks })]
}

/// Returns the command in a message, if it is one.
pub fn command(message: &MavMessage) -> Option<MavCmd> {
    match message {
        MavMessage::COMMAND_LONG(COMMAND_LONG_DATA { command, .. }) => Some(*command),
        _ => None,
    }
}

/// Returns the command to take a picture.
pub fn picture() -> MavMessage {
    let one = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    MavMessage::COMMAND_LONG(spandrel_mavlink::station::command(1, 100, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, one))
}

fn without(message: MavMessage, unwanted: MavCmd) -> Vec<MavMessage> {
    if command(&message) == Some(unwanted) { Vec::new() } else { vec![message] }
}

pub fn faster([x, y, z, r]: [f64; 4], factor: f64) -> [f64; 4] {
    [factor * x, factor * y, z, r]
}

/// Moves the paths at surfaces, except in the narrow interlayer, away from the surface, m (toward it if negative).
fn move_away(job: &mut Scenario, away_m: f64) {
    let wide = |task: &&mut Task| task.inspects_surface && task.kind != TaskKind::Interlayer;
    for task in job.tasks.iter_mut().filter(wide) {
        for (point, view) in task.path_m.iter_mut().zip(&task.viewing_directions) {
            *point -= *view * away_m;
        }
    }
}

/// Shortens every path to its first points.
fn shorten_paths(job: &mut Scenario, points: fn(&[Vec3<Enu>]) -> usize) {
    for task in &mut job.tasks {
        let kept = points(&task.path_m);
        task.path_m.truncate(kept);
        task.viewing_directions.truncate(kept);
        task.closed = false;
    }
}

/// Returns the number of points up to 49% of the path's length.
fn points_to_49_percent(path_m: &[Vec3<Enu>]) -> usize {
    let lengths_m: Vec<f64> = path_m.windows(2).map(|ends| (ends[1] - ends[0]).norm()).collect();
    let limit_m = 0.49 * lengths_m.iter().sum::<f64>();
    let flown_m = lengths_m.iter().scan(0.0, |sum_m, length_m| {
        *sum_m += length_m;
        Some(*sum_m)
    });
    1 + flown_m.take_while(|flown_m| *flown_m <= limit_m).count()
}

fn lower_paths(job: &mut Scenario) {
    for task in job.tasks.iter_mut().filter(|task| matches!(task.kind, TaskKind::SlabSide | TaskKind::PierCircle)) {
        task.path_m.iter_mut().for_each(|point| *point -= Vec3::new(0.0, 0.0, 2.5));
    }
}

fn look_aside(job: &mut Scenario) {
    let (sin, cos) = math::sin_cos(80.0_f64.to_radians());
    let aside =
        |view: Vec3<Enu>| Vec3::new(cos * view.east() + sin * view.north(), cos * view.north() - sin * view.east(), view.up());
    for task in &mut job.tasks {
        task.viewing_directions.iter_mut().for_each(|view| *view = aside(*view));
    }
}

/// The planted weaknesses, with the drill that each calls for.
pub const WEAKNESSES: &[Weakness] = &[
    Weakness {
        name: "half of every path",
        drills: &["practice"],
        also: &[],
        belief: |job| shorten_paths(job, |path_m| path_m.len().div_ceil(2)),
        ..NO_WEAKNESS
    },
    Weakness {
        name: "only the first task",
        drills: &["practice"],
        also: &[],
        belief: |job| job.tasks.truncate(1),
        ..NO_WEAKNESS
    },
    Weakness {
        name: "skips the arch",
        drills: &["drill-curve-under-arch"],
        also: &[],
        belief: |job| job.tasks.retain(|task| task.kind != TaskKind::ArchBottom),
        ..NO_WEAKNESS
    },
    Weakness {
        name: "skips the pier",
        drills: &["drill-orbit"],
        also: &[],
        belief: |job| job.tasks.retain(|task| task.kind != TaskKind::PierCircle),
        ..NO_WEAKNESS
    },
    Weakness {
        name: "4 m off throughout",
        drills: &["drill-stand-off"],
        also: &[],
        belief: |job| move_away(job, 4.0),
        ..NO_WEAKNESS
    },
    Weakness { name: "too close", drills: &["drill-stand-off"], also: &[], belief: |job| move_away(job, -1.5), ..NO_WEAKNESS },
    Weakness { name: "climbs too little", drills: &["drill-hover"], also: &[], belief: lower_paths, ..NO_WEAKNESS },
    Weakness {
        name: "too fast everywhere",
        drills: &["drill-straight-line"],
        also: &[],
        tamper: |hands, message| with_sticks(hands, message, |_, axes| faster(axes, 8.0)),
        ..NO_WEAKNESS
    },
    Weakness {
        name: "too fast around the pier",
        drills: &["drill-orbit"],
        also: &[],
        tamper: |hands, message| {
            with_sticks(hands, message, |hands, axes| if hands.status == "task 4" { faster(axes, 6.0) } else { axes })
        },
        ..NO_WEAKNESS
    },
    Weakness {
        name: "too fast in the interlayer",
        drills: &["drill-gap"],
        also: &[],
        tamper: |hands, message| {
            with_sticks(hands, message, |hands, axes| if hands.status == "task 3" { faster(axes, 4.5) } else { axes })
        },
        ..NO_WEAKNESS
    },
    Weakness {
        name: "unsteady sticks",
        drills: &["drill-hover"],
        also: &[],
        tamper: |hands, message| {
            with_sticks(hands, message, |hands, [x, y, z, r]| {
                let noise = hands.noise();
                [x + noise[0], y + noise[1], z + noise[2], r]
            })
        },
        ..NO_WEAKNESS
    },
    Weakness {
        name: "yaw noise",
        drills: &["drill-framing"],
        also: &[],
        tamper: |hands, message| with_sticks(hands, message, |hands, [x, y, z, r]| [x, y, z, r + 2.8 * hands.noise()[3]]),
        ..NO_WEAKNESS
    },
    Weakness { name: "looks aside", drills: &["drill-framing"], also: &["drill-search"], belief: look_aside, ..NO_WEAKNESS },
    Weakness {
        name: "gimbal never tilted",
        drills: &["drill-framing"],
        also: &["drill-search"],
        tamper: |_, message| without(message, MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW),
        ..NO_WEAKNESS
    },
    Weakness {
        name: "lamp never on",
        drills: &["drill-lamp"],
        also: &["drill-search"],
        tamper: |_, message| without(message, MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF),
        ..NO_WEAKNESS
    },
    Weakness {
        name: "no pictures",
        drills: &["drill-search"],
        also: &[],
        tamper: |_, message| without(message, MavCmd::MAV_CMD_IMAGE_START_CAPTURE),
        ..NO_WEAKNESS
    },
    Weakness {
        name: "overlooks defects",
        drills: &["drill-search"],
        also: &[],
        tamper: |hands, message| {
            if command(&message) != Some(MavCmd::MAV_CMD_IMAGE_START_CAPTURE) {
                return vec![message];
            }
            hands.pictures += 1;
            if hands.pictures.is_multiple_of(OVERLOOKED) { vec![message] } else { Vec::new() }
        },
        ..NO_WEAKNESS
    },
    Weakness {
        name: "pictures at random",
        drills: &["drill-search"],
        also: &["drill-framing"],
        tamper: |hands, message| {
            if command(&message) == Some(MavCmd::MAV_CMD_IMAGE_START_CAPTURE) {
                return Vec::new();
            }
            let due = hands.in_task() && hands.stick_messages % RANDOM_PICTURE_PERIOD == 1;
            let is_stick = matches!(message, MavMessage::MANUAL_CONTROL(_));
            hands.stick_messages += u64::from(is_stick);
            if due && is_stick { vec![message, picture()] } else { vec![message] }
        },
        ..NO_WEAKNESS
    },
    Weakness {
        name: "ignores the battery",
        drills: &["drill-landing"],
        also: &[],
        tamper: |hands, message| match message {
            MavMessage::MANUAL_CONTROL(sticks) if hands.last_task_flown => {
                vec![MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { x: 0, y: 0, z: 500, r: 0, ..sticks })]
            }
            other => vec![other],
        },
        ..NO_WEAKNESS
    },
    Weakness {
        name: "lands outside the home circle",
        drills: &["drill-landing"],
        also: &[],
        belief: |job| job.ground_team.pad_m += Vec3::new(0.0, -9.0, 0.0),
        ..NO_WEAKNESS
    },
];

/// Further weaknesses, which must prevent the certification. The tests of the plans leave them out.
pub const GRAVE_FAULTS: &[Weakness] = &[
    Weakness {
        name: "49% of every path",
        drills: &[],
        also: &[],
        belief: |job| shorten_paths(job, points_to_49_percent),
        ..NO_WEAKNESS
    },
    Weakness {
        name: "bumps into the bridge 22 times",
        drills: &[],
        also: &[],
        tamper: |hands, message| with_sticks(hands, message, |hands, axes| bump(hands, axes, &BUMPS)),
        ..NO_WEAKNESS
    },
    Weakness {
        name: "nose never rests",
        drills: &[],
        also: &[],
        // The pilot photographs nevertheless. Otherwise, waiting for a steady picture would take the time for the last task.
        skill: Skill { photo_turn_deg_s: 90.0, steady_s: 0.2, framing_deg: 15.0, ..Skill::EXPERT },
        tamper: |hands, message| {
            with_sticks(hands, message, |hands, [x, y, z, r]| [x, y, z, r + MODERATE_YAW_NOISE * hands.noise()[3]])
        },
        ..NO_WEAKNESS
    },
];

/// The same pilot without a fault.
pub const NO_WEAKNESS: Weakness =
    Weakness { name: "none", drills: &["two-bridges"], also: &[], skill: Skill::EXPERT, belief: as_intended, tamper: untouched };
