//! The job: one TOML file per job in `scenarios/`, read into validated types. Everything here is plain data in SI units and,
//! where a position, in the local frame [`Enu`] about the scenario origin (x east, y north, z up; up = 0 at the origin's altitude).
//! scenarios/README.md documents every key; a test checks it against this code.

pub mod bridges;
mod read;
mod resolve;
pub mod tasks;
mod weather;

pub use read::{FORMAT, SiblingLoader, read, read_asked};
pub use resolve::resolve;

use crate::frames::{Enu, Vec3};
use crate::geodesy::Geo;
use crate::time::SimTime;

/// A validated job.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Machine name, `[a-z0-9-]+`, used in session folder names.
    pub name: String,
    /// One line for people.
    pub title: String,
    /// Seed for everything random (defects, traffic, gusts, sensors); `None`: another one every session.
    pub seed: Option<u64>,
    /// Where the local frame sits on the earth.
    pub origin: Geo,
    /// Ground and water.
    pub terrain: TerrainSpec,
    /// Inspector, truck and pad.
    pub ground_team: GroundTeam,
    /// The bridges, in file order.
    pub bridges: Vec<Bridge>,
    /// The tasks, in file order; their index is the scorer's t.
    pub tasks: Vec<Task>,
    /// Defects to place.
    pub defects: DefectSpec,
    /// Cars, trucks, pedestrians.
    pub traffic: TrafficSpec,
    /// Wind.
    pub wind: WindSpec,
    /// Sun, sky and water light.
    pub light: LightSpec,
    /// Session rules.
    pub rules: SessionRules,
    /// Feedback thresholds.
    pub feedback: FeedbackThresholds,
    /// Scoring parameters.
    pub scoring: ScoringParams,
    /// CRC-32 (IEEE) of the file's bytes without the seed and placed defects: the wire's `scn_crc`.
    pub crc: u32,
}

/// Height field and water level.
#[derive(Debug, Clone, PartialEq)]
pub struct TerrainSpec {
    /// Side length of the square field centred on the origin, m.
    pub size_m: f64,
    /// Grid spacing, m.
    pub spacing_m: f64,
    /// Water surface, m up.
    pub water_level_m: f64,
    /// Where heights come from.
    pub source: TerrainSource,
}

/// Where the height field comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum TerrainSource {
    /// Flat ground at one height, m up.
    Flat {
        /// Height, m up.
        height_m: f64,
    },
    /// A lake valley between mountains, from a seed of its own (the site is the same in every session).
    Valley {
        /// Terrain seed.
        seed: u64,
        /// Width of the lake, m.
        lake_width_m: f64,
        /// Direction of the valley's axis, degrees clockwise from north.
        axis_deg: f64,
        /// Height of the mountains over the water, m.
        relief_m: f64,
        /// Deepest point of the lake under the water level, m.
        lake_depth_m: f64,
    },
    /// Heights read from a file beside the scenario (rows south to north, columns west to east, metres up, comma separated).
    File {
        /// Row-major heights, m up: `heights_m[row][column]`.
        heights_m: Vec<Vec<f64>>,
    },
}

/// The crew's place. The pad is level ground at `pad_m`; take-off and landing happen there.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundTeam {
    /// Centre of the pad's upper surface, m.
    pub pad_m: Vec3<Enu>,
    /// Heading of the drone on the pad, degrees clockwise from north.
    pub pad_heading_deg: f64,
    /// Half side of the level square pad, m.
    pub pad_half_m: f64,
    /// Feet of the inspector, m (counts as a person).
    pub inspector_m: Vec3<Enu>,
    /// Truck: centre of its footprint on the ground, m (counts as a vehicle).
    pub truck_m: Vec3<Enu>,
    /// Truck heading, degrees clockwise from north.
    pub truck_heading_deg: f64,
    /// A landing within this horizontal distance of the pad's centre is at home, m.
    pub home_radius_m: f64,
}

/// A bridge of any type and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Bridge {
    /// Name used by tasks and exports.
    pub name: String,
    /// Middle of the deck's upper surface in plan; its height is the deck's level at midspan, m.
    pub centre_m: Vec3<Enu>,
    /// Direction of the bridge's x axis (along the deck), degrees clockwise from north.
    pub heading_deg: f64,
    /// Type and numbers.
    pub kind: BridgeKind,
}

/// One variant per bridge type; each type's numbers, geometry and task paths live in one file (`bridges/`).
#[derive(Debug, Clone, PartialEq)]
pub enum BridgeKind {
    /// Open-spandrel deck arch.
    Arch(bridges::arch::Arch),
    /// Suspension bridge.
    Suspension(bridges::suspension::Suspension),
}

/// An inspection task with its reference path derived from a bridge.
#[derive(Debug, Clone, PartialEq)]
pub struct Task {
    /// Number shown to people and written to exports, from 1 in file order.
    pub id: u32,
    /// Name.
    pub name: String,
    /// Index into [`Scenario::bridges`], or `None` for a free path (drills).
    pub bridge: Option<usize>,
    /// Which part of the bridge: `slab_side`, `arch_bottom`, `interlayer`, `pier_circle`, or `free`.
    pub kind: TaskKind,
    /// On-path threshold, m (< 8).
    pub threshold_m: f64,
    /// The path returns to its start.
    pub closed: bool,
    /// Reference points, resampled to at most 1 m spacing, m. A closed path does not repeat its first point.
    pub path_m: Vec<Vec3<Enu>>,
    /// Where a camera on the path would look, one unit vector per path point (towards the inspected surface).
    pub look: Vec<Vec3<Enu>>,
    /// Overrides the too-close distance, m.
    pub too_close_m: Option<f64>,
    /// Suggested lamp state, for briefings and the synthetic trainee.
    pub dark: bool,
}

/// The kinds of task paths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TaskKind {
    /// Straight line along one side of the deck slab.
    SlabSide,
    /// Curve under the arch.
    ArchBottom,
    /// Through the space between deck and arch.
    Interlayer,
    /// Closed loop around a pier near the water.
    PierCircle,
    /// Points written in the scenario.
    Free,
}

/// How many defects of what size, or where they are (a resolved file).
#[derive(Debug, Clone, PartialEq)]
pub struct DefectSpec {
    /// How many to place.
    pub count: usize,
    /// Factor on the catalogue's sizes (smaller is harder).
    pub size_factor: f64,
    /// Bridge elements (AASHTO MBEI numbers) that may carry one; empty: all legal ones.
    pub elements: Vec<u32>,
    /// Defect codes (AASHTO MBEI) to draw from; empty: all legal ones.
    pub kinds: Vec<u32>,
    /// Already placed, in a resolved file; then nothing is drawn.
    pub placed: Option<Vec<PlacedDefect>>,
}

/// One defect on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedDefect {
    /// 1, 2, … in placing order.
    pub id: u32,
    /// AASHTO MBEI element number.
    pub element: u32,
    /// Name of the member that carries it.
    pub member: String,
    /// AASHTO MBEI defect code (1130 cracking, 1080 spall, …).
    pub kind: u32,
    /// Condition state 2 or 3.
    pub condition_state: u8,
    /// Centre on the surface, m.
    pub position_m: Vec3<Enu>,
    /// Outward surface normal, unit.
    pub normal: Vec3<Enu>,
    /// Unit vector in the surface along the longest extent.
    pub along: Vec3<Enu>,
    /// Longest extent, m.
    pub length_m: f64,
    /// Width across it; for a crack the crack's width, m.
    pub width_m: f64,
    /// A crack or another line, whose width must be resolved.
    pub line: bool,
}

/// Traffic on the decks.
#[derive(Debug, Clone, PartialEq)]
pub struct TrafficSpec {
    /// Cars on all bridges together.
    pub cars: usize,
    /// Trucks.
    pub trucks: usize,
    /// Pedestrians on the walkways.
    pub pedestrians: usize,
    /// Mean speed of cars, m/s.
    pub car_speed_m_s: f64,
}

/// Wind.
#[derive(Debug, Clone, PartialEq)]
pub struct WindSpec {
    /// Force or field.
    pub model: WindModel,
    /// Mean speed at 20 ft (6.096 m) over the water, m/s. Levels: light 2.2 mph, gentle 11 mph, medium 22 mph.
    pub speed_m_s: f64,
    /// Constant force of the `paper` model, N.
    pub paper_force_n: f64,
    /// The wind comes from here, degrees clockwise from north.
    pub from_deg: f64,
    /// Vertical component, m/s up (any direction).
    pub up_m_s: f64,
    /// Turbulence intensity factor on the Dryden standard, 1 = MIL-F-8785C.
    pub turbulence: f64,
    /// Events, in time order.
    pub events: Vec<WindEvent>,
}

/// How wind acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WindModel {
    /// The paper's constant force at the centre of mass.
    Paper,
    /// A velocity field with turbulence through the vehicle's own drag.
    Physical,
}

/// A gust or a change of weather.
#[derive(Debug, Clone, PartialEq)]
pub enum WindEvent {
    /// 1-cosine gust (MIL-F-8785C) on top of the mean.
    Gust {
        /// Start.
        at: SimTime,
        /// Length in time.
        duration: SimTime,
        /// Peak, m/s.
        peak_m_s: f64,
        /// Comes from, degrees clockwise from north.
        from_deg: f64,
    },
    /// The mean moves linearly to new values.
    Change {
        /// Start.
        at: SimTime,
        /// Ramp.
        over: SimTime,
        /// New speed at 20 ft, m/s.
        speed_m_s: f64,
        /// New direction, degrees clockwise from north.
        from_deg: f64,
    },
}

/// Sun and sky.
#[derive(Debug, Clone, PartialEq)]
pub struct LightSpec {
    /// UTC date and time at simulation start, seconds since the Unix epoch.
    pub start_unix_s: i64,
    /// Share of the sky under cloud, 0..1.
    pub cloud_cover: f64,
    /// Share of downward light that the water throws up, 0..1.
    pub water_albedo: f64,
    /// Share that ground and concrete throw back, 0..1.
    pub ground_albedo: f64,
}

/// Session rules.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionRules {
    /// What a survivable crash leads to.
    pub after_crash: AfterCrash,
    /// Which battery model flies.
    pub battery: BatteryModel,
    /// Return when the battery is low (off in the paper's job).
    pub low_battery_return: bool,
    /// Battery share at which the low warning and, if on, the return start, %.
    pub low_battery_pct: f64,
    /// Battery share at which the vehicle lands, if `low_battery_return`, %.
    pub critical_battery_pct: f64,
    /// GNSS is shadowed by the structures (sky view decides the satellites).
    pub gnss_shadow: bool,
    /// Wait before a lying drone is put back, of simulation time.
    pub respawn_after: SimTime,
}

/// What a crash into bridge, terrain or water leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AfterCrash {
    /// Fly on if it can; never put back.
    Continue,
    /// Put back at the last safe hover when it lies still or touches water.
    Respawn,
    /// The session ends.
    End,
}

/// Battery models.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BatteryModel {
    /// Linear from 100 % to 0 over the aircraft's paper endurance, from lift-off.
    Paper,
    /// Open-circuit voltage, internal resistance, power drawn.
    Physical,
}

/// Feedback thresholds (docs/src/reference/assessment.md, "Feedback during the flight").
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackThresholds {
    /// Anything nearer than this to the drone's centre, m.
    pub too_close_m: f64,
    /// The warning clears beyond this, m.
    pub too_close_clear_m: f64,
    /// Outer end of the off-path band, m.
    pub off_path_max_m: f64,
    /// Off path for this long before the cue shows.
    pub off_path_after: SimTime,
    /// The cue stays at least this long.
    pub off_path_hold: SimTime,
    /// Battery is green from here, %.
    pub battery_green_pct: f64,
    /// Battery is yellow from here, red below, %.
    pub battery_yellow_pct: f64,
    /// Shortest time between two texts of one rule.
    pub text_interval: SimTime,
}

/// Scoring parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct ScoringParams {
    /// Frame rate f, Hz.
    pub frame_rate_hz: f64,
    /// Speed limit during inspection, m/s.
    pub speed_limit_m_s: f64,
    /// Maximum speed of the scale, m/s (30 mph in the paper).
    pub max_speed_m_s: f64,
    /// Full efficiency up to here, s.
    pub time_best_s: f64,
    /// Flight time limit, s.
    pub time_max_s: f64,
    /// F-measure's beta; `f64::INFINITY` is recall.
    pub beta: f64,
    /// Distance to the polyline instead of the paper's nearest point rule.
    pub exact_path: bool,
    /// Clearance below which the certification profile counts exposure, m.
    pub clearance_m: f64,
    /// Share of its path from which on a task is done, 0 to 1.
    pub task_done_share: f64,
}
