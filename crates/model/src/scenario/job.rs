//! The content of a scenario file, parsed and validated. All values are in SI units; positions are in the local frame [`Enu`] at
//! the scenario origin (x east, y north, z up; up = 0 at the origin's altitude).

use super::bridges::Bridge;
use super::bridges::path::TaskKind;
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::geodesy::Geo;
use crate::time::SimTime;

/// A job, parsed and validated.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Machine-readable name, `[a-z0-9-]+`, used in session folder names.
    pub name: String,
    /// One-line display title.
    pub title: String,
    /// Seed for everything random (defects, traffic, gusts, sensors); `None`: a new seed for each session.
    pub seed: Option<u64>,
    /// Geographic position of the local frame's origin.
    pub origin: Geo,
    /// Ground and water.
    pub terrain: TerrainSpec,
    /// Inspector, truck and landing pad.
    pub ground_team: GroundTeam,
    /// The bridges, in file order.
    pub bridges: Vec<Bridge>,
    /// The tasks, in file order; the index is t in the scoring formulas.
    pub tasks: Vec<Task>,
    /// Defect settings.
    pub defects: DefectSpec,
    /// Traffic settings.
    pub traffic: TrafficSpec,
    /// Wind settings.
    pub wind: WindSpec,
    /// Sun, cloud cover and surface reflection.
    pub light: LightSpec,
    /// Session rules.
    pub rules: SessionRules,
    /// Feedback thresholds.
    pub feedback: FeedbackThresholds,
    /// Scoring parameters.
    pub scoring: ScoringParams,
    /// CRC-32 (IEEE) of the file without seed and placed defects, sent as `scn_crc`.
    pub crc: u32,
}

/// Height grid and water level.
#[derive(Debug, Clone, PartialEq)]
pub struct TerrainSpec {
    /// Side length of the square terrain, centered on the origin, m.
    pub size_m: f64,
    /// Grid spacing, m.
    pub spacing_m: f64,
    /// Water level, m up.
    pub water_level_m: f64,
    /// Source of the heights.
    pub source: TerrainSource,
}

/// Source of the terrain heights.
#[derive(Debug, Clone, PartialEq)]
pub enum TerrainSource {
    /// Level ground at one height.
    Flat {
        /// Height, m up.
        height_m: f64,
    },
    /// A lake valley between mountains, generated from a separate seed (the terrain is the same in every session).
    Valley {
        /// Terrain seed.
        seed: u64,
        /// Width of the lake, m.
        lake_width_m: f64,
        /// Direction of the valley's axis, degrees clockwise from north.
        axis_deg: f64,
        /// Height of the mountains above the water, m.
        relief_m: f64,
        /// Depth of the lake at its deepest point, m.
        lake_depth_m: f64,
    },
    /// Heights read from a file next to the scenario (rows south to north, columns west to east, meters up, comma-separated).
    File {
        /// Row-major heights, m up: `heights_m[row][column]`.
        heights_m: Vec<Vec<f64>>,
    },
}

/// Positions of the ground crew. The landing pad is level at `pad_m`; takeoff and landing take place there.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundTeam {
    /// Center of the landing pad's upper surface, m.
    pub pad_m: Vec3<Enu>,
    /// Initial heading of the drone on the pad, degrees clockwise from north.
    pub pad_heading_deg: f64,
    /// Half side length of the square pad, m.
    pub pad_half_m: f64,
    /// Position of the inspector's feet, m (contact type: person).
    pub inspector_m: Vec3<Enu>,
    /// Center of the truck's footprint on the ground, m (contact type: vehicle).
    pub truck_m: Vec3<Enu>,
    /// Truck heading, degrees clockwise from north.
    pub truck_heading_deg: f64,
    /// Maximum horizontal distance from the pad's center for a landing at home, m.
    pub home_radius_m: f64,
}

/// An inspection task with the reference path derived from a bridge.
#[derive(Debug, Clone, PartialEq)]
pub struct Task {
    /// Task number for display and export, from 1 in file order.
    pub id: u32,
    /// Task name.
    pub name: String,
    /// Index into [`Scenario::bridges`], or `None` for a free path (drills).
    pub bridge: Option<usize>,
    /// Path type: `slab_side`, `arch_bottom`, `interlayer`, `pier_circle`, or `free`.
    pub kind: TaskKind,
    /// On-path threshold, m (< 8).
    pub threshold_m: f64,
    /// The path returns to its start.
    pub closed: bool,
    /// Reference points, resampled to at most 1 m spacing, m. A closed path does not repeat its first point.
    pub path_m: Vec<Vec3<Enu>>,
    /// Viewing directions: one unit vector per path point, toward the inspected surface.
    pub look: Vec<Vec3<Enu>>,
    /// Overrides the minimum surface distance of the job, m.
    pub too_close_m: Option<f64>,
    /// Suggested lamp state, for briefings and the synthetic trainee.
    pub dark: bool,
}

/// Number and size of the defects, or their positions (in a resolved file).
#[derive(Debug, Clone, PartialEq)]
pub struct DefectSpec {
    /// Number of defects to place.
    pub count: usize,
    /// Scale factor on the sizes of [`crate::defect_codes`] (smaller is harder).
    pub size_factor: f64,
    /// Bridge elements that may have defects; empty: all permitted elements.
    pub elements: Vec<Element>,
    /// Defect codes (AASHTO MBEI) to draw from; empty: all permitted codes.
    pub kinds: Vec<u32>,
    /// Placed defects of a resolved file; if set, none are drawn.
    pub placed: Option<Vec<PlacedDefect>>,
}

/// One defect on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedDefect {
    /// Defect ID, from 1 in placement order.
    pub id: u32,
    /// Element with the defect.
    pub element: Element,
    /// Name of the member with the defect.
    pub member: String,
    /// AASHTO MBEI defect code (1130 cracking, 1080 spall, …).
    pub kind: u32,
    /// Condition state 2 or 3.
    pub condition_state: u8,
    /// Center on the surface, m.
    pub position_m: Vec3<Enu>,
    /// Outward unit normal of the surface.
    pub normal: Vec3<Enu>,
    /// Unit vector in the surface along the longest dimension.
    pub along: Vec3<Enu>,
    /// Length along the longest dimension, m.
    pub length_m: f64,
    /// Width perpendicular to it, m; for a crack the crack width.
    pub width_m: f64,
    /// A crack or other line defect, whose width must be resolved in a photo.
    pub line: bool,
}

/// Traffic on the bridges.
#[derive(Debug, Clone, PartialEq)]
pub struct TrafficSpec {
    /// Number of cars on all bridges together.
    pub cars: usize,
    /// Number of trucks.
    pub trucks: usize,
    /// Number of pedestrians on the walkways.
    pub pedestrians: usize,
    /// Mean speed of cars, m/s.
    pub car_speed_m_s: f64,
}

/// Wind of a job.
#[derive(Debug, Clone, PartialEq)]
pub struct WindSpec {
    /// Wind model: force or velocity field.
    pub model: WindModel,
    /// Mean wind speed at 20 ft (6.096 m) above the water, m/s. Levels: light 2.2 mph, gentle 11 mph, medium 22 mph.
    pub speed_m_s: f64,
    /// Constant force of the `paper` model, N.
    pub paper_force_n: f64,
    /// Direction from which the wind blows, degrees clockwise from north.
    pub from_deg: f64,
    /// Vertical wind component, m/s up (any wind direction).
    pub up_m_s: f64,
    /// Scale factor on the Dryden turbulence intensity; 1 = MIL-F-8785C.
    pub turbulence: f64,
    /// Wind events, sorted by time.
    pub events: Vec<WindEvent>,
}

/// Wind models.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WindModel {
    /// The paper's constant force at the center of mass.
    Paper,
    /// A velocity field with turbulence, which acts through the vehicle's drag.
    Physical,
}

/// A gust or a change of the mean wind.
#[derive(Debug, Clone, PartialEq)]
pub enum WindEvent {
    /// 1-cosine gust (MIL-F-8785C) added to the mean wind.
    Gust {
        /// Start time.
        at: SimTime,
        /// Duration.
        duration: SimTime,
        /// Peak speed, m/s.
        peak_m_s: f64,
        /// Direction from which it blows, degrees clockwise from north.
        from_deg: f64,
    },
    /// Linear change of the mean wind.
    Change {
        /// Start time.
        at: SimTime,
        /// Duration of the change.
        over: SimTime,
        /// New speed at 20 ft, m/s.
        speed_m_s: f64,
        /// New direction from which it blows, degrees clockwise from north.
        from_deg: f64,
    },
}

/// Sun and sky of a job.
#[derive(Debug, Clone, PartialEq)]
pub struct LightSpec {
    /// UTC date and time of simulation start, seconds since the Unix epoch.
    pub start_unix_s: i64,
    /// Fraction of the sky covered by clouds, 0 to 1.
    pub cloud_cover: f64,
    /// Fraction of downward light reflected by the water, 0 to 1.
    pub water_albedo: f64,
    /// Fraction of downward light reflected by ground and concrete, 0 to 1.
    pub ground_albedo: f64,
}

/// Rules of a session.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionRules {
    /// Consequence of a survivable crash.
    pub after_crash: AfterCrash,
    /// Battery model in use.
    pub battery: BatteryModel,
    /// Return to launch at low battery (disabled in the paper's job).
    pub low_battery_return: bool,
    /// Low battery level, at which the warning and, if enabled, the return to launch start, %.
    pub low_battery_pct: f64,
    /// Critical battery level, at which the vehicle lands if `low_battery_return` is set, %.
    pub critical_battery_pct: f64,
    /// Structures block GNSS satellites (the sky view determines how many are visible).
    pub gnss_shadow: bool,
    /// Simulation time before a crashed drone is respawned.
    pub respawn_after: SimTime,
}

/// Consequences of a crash into bridge, terrain or water.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AfterCrash {
    /// Continue to fly if possible; never respawn.
    Continue,
    /// Respawn at the last safe hover position once the drone rests or touches water.
    Respawn,
    /// The session ends.
    End,
}

/// Battery models.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BatteryModel {
    /// Linear from 100 % to 0 % over the aircraft's paper endurance, starting at lift-off.
    Paper,
    /// Open-circuit voltage, internal resistance and power consumption.
    Physical,
}

/// Feedback thresholds (docs/src/reference/assessment.md, "Feedback during the flight").
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackThresholds {
    /// Minimum distance from the center of the drone to any surface, m.
    pub too_close_m: f64,
    /// Distance at which the too-close warning clears, m.
    pub too_close_clear_m: f64,
    /// Outer limit of the off-path band, m.
    pub off_path_max_m: f64,
    /// Time off path before the cue is shown.
    pub off_path_after: SimTime,
    /// Minimum time for which the cue is shown.
    pub off_path_hold: SimTime,
    /// Minimum battery level shown in green, %.
    pub battery_green_pct: f64,
    /// Minimum battery level shown in yellow; red below, %.
    pub battery_yellow_pct: f64,
    /// Minimum interval between two texts of the same rule.
    pub text_interval: SimTime,
}

/// Parameters of the scoring formulas.
#[derive(Debug, Clone, PartialEq)]
pub struct ScoringParams {
    /// Frame rate f, Hz.
    pub frame_rate_hz: f64,
    /// Speed limit during inspection, m/s.
    pub speed_limit_m_s: f64,
    /// Maximum speed of the scoring scale, m/s (30 mph in the paper).
    pub max_speed_m_s: f64,
    /// Maximum flight time for full efficiency, s.
    pub time_best_s: f64,
    /// Flight time limit, s.
    pub time_max_s: f64,
    /// Beta of the F-measure; `f64::INFINITY` yields the recall.
    pub beta: f64,
    /// Use the distance to the polyline instead of the paper's nearest-point rule.
    pub exact_path: bool,
    /// Clearance below which the certification profile counts exposure time, m.
    pub clearance_m: f64,
    /// Fraction of its path that completes a task, 0 to 1.
    pub task_done_share: f64,
}
