//! Types for the content of a scenario file. Angles and percentages state their units; all other values are in SI units.
//! Positions are in the local frame [`Enu`] at the scenario origin (x east, y north, z up; up = 0 at the origin's altitude).

use super::bridges::Bridge;
use super::bridges::path::TaskKind;
use super::briefing_pictures::BriefingPicture;
use super::certification::CertificationParams;
use super::defect_cause::{DefectCause, DefectPlacement, Stain};
use super::lesson::LessonStep;
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::geodesy::Geo;
use crate::raster::ground_photo::GroundPhoto;
use crate::satellites::Almanac;
use crate::speed_unit::SpeedUnit;
use crate::stick_response::StickResponse;
use crate::time::SimTime;
use std::sync::Arc;

/// Maximum number of defects of a job (estimate: more than anybody finds in one flight).
pub const MAX_DEFECTS: usize = 200;

/// A job: the content of a scenario file, parsed and validated.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Machine-readable name, `[a-z0-9-]+`, used in session folder names.
    pub name: String,
    /// One-line display title.
    pub title: String,
    /// The instructor's own words at the start of the briefing, one paragraph each.
    pub briefing: Vec<String>,
    /// The instructor's pictures for the briefing, in file order.
    pub briefing_pictures: Vec<BriefingPicture>,
    /// Seed for all random content (defects, traffic, turbulence, sensors); `None` if each session draws a new seed.
    pub seed: Option<u64>,
    /// Geographic position of the local frame's origin.
    pub origin: Geo,
    /// Heights of ground and water.
    pub terrain: TerrainSpec,
    /// Positions of inspector, truck and landing pad.
    pub ground_team: GroundTeam,
    /// The bridges, in file order.
    pub bridges: Vec<Bridge>,
    /// The tasks, in file order; the index is t in the scoring formulas.
    pub tasks: Vec<Task>,
    /// Defect number, size and types.
    pub defects: DefectSpec,
    /// The selected form; `None` if the job has no forms.
    pub form: Option<SelectedForm>,
    /// Difficulty levels and the selected one; `None` if the job has no levels.
    pub difficulty: Option<Difficulty>,
    /// Steps of a lesson; empty if the job is not one.
    pub lesson: Vec<LessonStep>,
    /// Number of vehicles and pedestrians, and vehicle speed.
    pub traffic: TrafficSpec,
    /// Drones beside the trainee's, in file order.
    pub drones: Vec<DroneSpec>,
    /// Ropes and cables at the site, in file order.
    pub ropes: Vec<RopeSpec>,
    /// Wind model, mean wind and gusts.
    pub wind: WindSpec,
    /// Sun, cloud cover and surface reflection.
    pub light: LightSpec,
    /// Fog, rain and snow in the pictures.
    pub weather: WeatherSpec,
    /// Session rules for crashes, battery and GNSS.
    pub rules: SessionRules,
    /// Effects of the bridges on the vehicle.
    pub hazards: HazardSpec,
    /// Thresholds for in-flight feedback.
    pub feedback: FeedbackThresholds,
    /// Scoring parameters.
    pub scoring: ScoringParams,
    /// Requirements of the certification profile.
    pub certification: CertificationParams,
    /// CRC-32 (IEEE) of the file without seed, placed defects and pictures of the briefing, of the elevation model, and of the models and
    /// elements files of imported bridges; sent as `scn_crc`.
    pub crc: u32,
}

impl Scenario {
    /// Returns the name, followed by `@` and the form or a level other than the standard one, if the job has forms or levels.
    /// It distinguishes the results of different forms and levels.
    #[must_use]
    pub fn name_with_form(&self) -> String {
        let form = self.form.as_ref().map(|form| form.name.clone());
        let level = || self.difficulty.as_ref().filter(|one| one.level != one.standard).map(|one| one.level.to_string());
        form.or_else(level).map_or_else(|| self.name.clone(), |variant| format!("{}@{variant}", self.name))
    }

    /// Returns whether the bridges disturb the wind.
    #[must_use]
    pub fn has_wakes(&self) -> bool {
        self.hazards.wakes && self.wind.model == WindModel::Physical
    }
}

/// Height grid and water level settings.
#[derive(Debug, Clone, PartialEq)]
pub struct TerrainSpec {
    /// Side length of the square terrain, centered on the origin, m.
    pub size_m: f64,
    /// Grid spacing, m.
    pub spacing_m: f64,
    /// Water level above the origin, m.
    pub water_level_m: f64,
    /// Height source.
    pub source: TerrainSource,
    /// Aerial photograph that colors the ground. It has no effect on a flight.
    pub photo: Option<GroundPhoto>,
}

/// Source of the terrain heights.
#[derive(Debug, Clone, PartialEq)]
pub enum TerrainSource {
    /// Level ground at one height.
    Flat {
        /// Ground height above the origin, m.
        height_m: f64,
    },
    /// A valley with a lake between mountains, generated from a separate seed, so that every session has the same terrain.
    Valley {
        /// Terrain seed.
        seed: u64,
        /// Lake width, m.
        lake_width_m: f64,
        /// Direction of the valley axis, degrees clockwise from north.
        axis_deg: f64,
        /// Mountain height above the water, m.
        mountain_height_m: f64,
        /// Maximum depth of the lake, m.
        lake_depth_m: f64,
    },
    /// Heights from a file in the scenario's folder: comma-separated heights above the origin, with rows from south to north and columns
    /// from west to east, or an elevation model in a GeoTIFF file.
    File {
        /// Row-major heights above the origin, m: `heights_m[row][column]`.
        heights_m: Vec<Vec<f64>>,
    },
}

/// Positions of the ground crew and of the level landing pad, where the drone takes off and lands.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundTeam {
    /// Center of the landing pad's upper surface, m.
    pub pad_m: Vec3<Enu>,
    /// Initial heading of the drone on the pad, degrees clockwise from north.
    pub pad_heading_deg: f64,
    /// Half the side length of the square pad, m.
    pub pad_half_m: f64,
    /// Position of the inspector's feet at the start, m (contact type: person). It is the inspector's place 1.
    pub inspector_m: Vec3<Enu>,
    /// Further places to which the inspector can walk, from place 2, positions of the feet, m.
    pub places_m: Vec<Vec3<Enu>>,
    /// Center of the truck's footprint on the ground, m (contact type: vehicle).
    pub truck_m: Vec3<Enu>,
    /// Truck heading, degrees clockwise from north.
    pub truck_heading_deg: f64,
    /// Maximum horizontal distance from the pad's center at which the drone counts as landed at home, m.
    pub home_radius_m: f64,
}

/// Eye height of the inspector above the ground, m (estimate).
pub const INSPECTOR_EYE_HEIGHT_M: f64 = 1.65;

impl GroundTeam {
    /// Returns all places of the inspector's feet in the order of their numbers, m. There is at least one.
    pub fn inspector_places_m(&self) -> impl Iterator<Item = Vec3<Enu>> + Clone + '_ {
        std::iter::once(self.inspector_m).chain(self.places_m.iter().copied())
    }

    /// Returns whether there is another place than the first one.
    #[must_use]
    pub fn can_walk(&self) -> bool {
        !self.places_m.is_empty()
    }
}

/// An inspection task with its reference path.
#[derive(Debug, Clone, PartialEq)]
pub struct Task {
    /// Task number for display and export, from 1 in file order.
    pub id: u32,
    /// Display name.
    pub name: String,
    /// Index into [`Scenario::bridges`], or `None` for a free path (drills).
    pub bridge: Option<usize>,
    /// Path type.
    pub kind: TaskKind,
    /// On-path threshold, m; less than 8.
    pub threshold_m: f64,
    /// True if the path returns to its start.
    pub closed: bool,
    /// Reference points, resampled to at most 1 m spacing, m. A closed path does not repeat its first point.
    pub path_m: Vec<Vec3<Enu>>,
    /// Viewing directions: for each path point, a unit vector toward the inspected surface.
    pub viewing_directions: Vec<Vec3<Enu>>,
    /// True if the viewing directions point at a surface. False for a free path without a target, whose viewing
    /// directions point along the path.
    pub inspects_surface: bool,
    /// Recommended distance from the inspected surface; `None` if the path has no single surface at a fixed distance.
    pub stand_off: Option<StandOff>,
    /// Too-close threshold of this task, m; `None` to use the job's threshold.
    pub too_close_m: Option<f64>,
    /// True if the lamp is recommended in this task. Used in briefings and by the synthetic trainee.
    pub dark: bool,
}

/// Largest length of the path of a hold position, relative to the task's threshold: from the middle, all of it is on the path.
const HOLD_LENGTH_THRESHOLDS: f64 = 2.0;
/// Time for which a hold position is held without leaving it (estimate: an exercise of a beginner's lesson).
pub const HOLD_DURATION: SimTime = SimTime::from_ms(10_000);

impl Task {
    /// Returns the segments of the path. A closed path includes the one from its last point to its first; an open path ends with
    /// a segment of length 0, so that a path of a single point has one.
    pub fn segments(&self) -> impl Iterator<Item = (Vec3<Enu>, Vec3<Enu>)> {
        let end = if self.closed { self.path_m.first() } else { self.path_m.last() };
        self.path_m.iter().copied().zip(self.path_m.iter().skip(1).chain(end).copied())
    }

    /// Returns the length of the path, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.segments().map(|(from, to)| (to - from).norm()).sum()
    }

    /// Returns whether the path is so short that the task is to hold position.
    #[must_use]
    pub fn is_hold_position(&self) -> bool {
        !self.closed && self.length_m() < HOLD_LENGTH_THRESHOLDS * self.threshold_m
    }
}

/// The selected form of a job. Forms are sets of defects of known difficulty, such as equivalent ones for repeated sessions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SelectedForm {
    /// Name of the selected form.
    pub name: String,
    /// Names of all forms, in file order.
    pub available: Vec<String>,
}

/// Difficulty levels of a job. Level 1 is the easiest.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difficulty {
    /// Selected level, from 1.
    pub level: u8,
    /// Standard level, at which the file's own values apply.
    pub standard: u8,
    /// Values at each level as text, from the easiest, such as "wind 2.73 m/s, on path within 1.33 m".
    pub settings: Vec<String>,
}

impl Difficulty {
    /// Returns the number of levels.
    #[must_use]
    pub fn levels(&self) -> u8 {
        u8::try_from(self.settings.len()).unwrap_or(u8::MAX)
    }

    /// Returns the values at a level as text; empty if the level does not exist.
    #[must_use]
    pub fn settings_at(&self, level: u8) -> &str {
        usize::from(level).checked_sub(1).and_then(|index| self.settings.get(index)).map_or("", String::as_str)
    }
}

/// Recommended distance from the inspected surface.
#[derive(Debug, Clone, PartialEq)]
pub struct StandOff {
    /// Distance between the path and the surface, m.
    pub recommended_m: f64,
    /// Deviation from the recommended distance at which the cue appears, m.
    pub tolerance_m: f64,
    /// For each path point, a unit vector toward the surface, perpendicular to it.
    pub toward_surface: Vec<Vec3<Enu>>,
}

/// Settings for random defects, or the defects that the file places.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DefectSpec {
    /// Number of defects to place.
    pub count: usize,
    /// Rule by which they are placed.
    pub placement: DefectPlacement,
    /// Scale factor for the sizes in [`crate::defect_codes`]; smaller defects are harder to find.
    pub size_factor: f64,
    /// Bridge elements that may have defects; if empty, all elements may.
    pub elements: Vec<Element>,
    /// Defect codes (AASHTO MBEI) to draw from; if empty, all codes permitted on the element.
    pub kinds: Vec<u32>,
    /// Seed of the defects; `None` to use the session's seed.
    pub seed: Option<u64>,
    /// Mean predicted detection of the defects, 0 to 1 ([`crate::site::detection`]). If set, it determines the sizes, and
    /// [`Self::size_factor`] has no effect.
    pub mean_detection: Option<f64>,
    /// Number of cracks and other lines among the defects; `None` to leave it to chance.
    pub line_count: Option<usize>,
    /// Defects that the file places: those of a session in its resolved file, or those that an instructor chose. If set, no random
    /// defects are drawn.
    pub placed: Option<Vec<PlacedDefect>>,
}

impl DefectSpec {
    /// Returns the number of defects to find: those that the file places, or the number to place at random.
    #[must_use]
    pub fn number(&self) -> usize {
        self.placed.as_ref().map_or(self.count, Vec::len)
    }
}

/// One defect on a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedDefect {
    /// Defect ID, from 1 in placement order.
    pub id: u32,
    /// Bridge element with the defect.
    pub element: Element,
    /// Name of the member with the defect.
    pub member: String,
    /// AASHTO MBEI defect code (1130 cracking, 1080 spall, …).
    pub kind: u32,
    /// Condition state: 2 or 3, with [`DefectPlacement::Causes`] also 4.
    pub condition_state: u8,
    /// Center on the surface, m.
    pub position_m: Vec3<Enu>,
    /// Outward unit normal of the surface.
    pub normal: Vec3<Enu>,
    /// Unit vector in the surface along the longest dimension.
    pub along: Vec3<Enu>,
    /// Length along the longest dimension, m.
    pub length_m: f64,
    /// Width perpendicular to the longest dimension, m; for a crack, the crack width.
    pub width_m: f64,
    /// True for a crack or other line defect, whose width must be resolved in a photo.
    pub line: bool,
    /// Cause; `None` if the defect was placed anywhere.
    pub cause: Option<DefectCause>,
    /// Stain that belongs to the defect, if it has one.
    pub stain: Option<Stain>,
}

/// Bridge traffic settings.
#[derive(Debug, Clone, PartialEq)]
pub struct TrafficSpec {
    /// Total number of cars on all bridges.
    pub cars: usize,
    /// Total number of trucks on all bridges.
    pub trucks: usize,
    /// Total number of pedestrians on all walkways.
    pub pedestrians: usize,
    /// Mean speed of cars and trucks, m/s.
    pub car_speed_m_s: f64,
}

/// A drone that flies along a path.
#[derive(Debug, Clone, PartialEq)]
pub struct DroneSpec {
    /// Machine-readable name, unique in the job.
    pub name: String,
    /// ID of the shipped aircraft with its hull and its looks.
    pub vehicle: &'static str,
    /// Points of the path of the center of mass, m. There is at least one.
    pub points_m: Vec<Vec3<Enu>>,
    /// Speed between the points, m/s.
    pub speed_m_s: f64,
    /// Heading along the whole path, degrees clockwise from north.
    pub heading_deg: f64,
    /// Simulation time at which it leaves the first point, s.
    pub at_s: f64,
    /// The seed adds 0 to this time to [`Self::at_s`], s.
    pub spread_s: f64,
    /// Time at each point before it flies on, s.
    pub wait_s: f64,
    /// Whether it flies from the last point to the first one and repeats the path.
    pub repeat: bool,
}

/// A rope or cable that hangs at the site.
#[derive(Debug, Clone, PartialEq)]
pub struct RopeSpec {
    /// Machine-readable name, unique in the job.
    pub name: String,
    /// The point from which it hangs, or the two points between which it does, m.
    pub points_m: Vec<Vec3<Enu>>,
    /// Length, m.
    pub length_m: f64,
    /// Diameter, m.
    pub diameter_m: f64,
    /// Mass per length, kg/m. The wind moves a light rope more.
    pub mass_kg_m: f64,
}

/// A job's wind settings.
#[derive(Debug, Clone, PartialEq)]
pub struct WindSpec {
    /// Wind model: a constant force or a velocity field.
    pub model: WindModel,
    /// Mean wind speed at 20 ft (6.096 m) above the water, m/s. The levels are light (2.2 mph), gentle (11 mph) and
    /// medium (22 mph).
    pub speed_m_s: f64,
    /// Constant force in the `paper` model, N.
    pub paper_force_n: f64,
    /// Direction that the wind blows from, degrees clockwise from north.
    pub from_deg: f64,
    /// Vertical wind component, m/s, positive up.
    pub up_m_s: f64,
    /// Scale factor for the Dryden turbulence intensity; 1 is the intensity of MIL-F-8785C.
    pub turbulence: f64,
    /// Wind events, sorted by time.
    pub events: Vec<WindEvent>,
}

/// Model of the wind's effect on the vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WindModel {
    /// The constant force at the center of mass that the TASBID paper uses.
    Paper,
    /// A velocity field with turbulence, which acts through the vehicle's drag.
    Physical,
}

/// A gust or a change in the mean wind.
#[derive(Debug, Clone, PartialEq)]
pub enum WindEvent {
    /// A 1-cosine gust (MIL-F-8785C) that is added to the mean wind.
    Gust {
        /// Start time of the gust.
        at: SimTime,
        /// Duration of the gust.
        duration: SimTime,
        /// Peak speed, m/s.
        peak_speed_m_s: f64,
        /// Direction that the gust blows from, degrees clockwise from north.
        from_deg: f64,
    },
    /// A linear change in the mean wind.
    Change {
        /// Start time of the change.
        at: SimTime,
        /// Duration of the change.
        over: SimTime,
        /// New mean wind speed at 20 ft, m/s.
        speed_m_s: f64,
        /// New direction that the wind blows from, degrees clockwise from north.
        from_deg: f64,
    },
}

/// A job's daylight settings.
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

/// A job's fog, rain and snow. They appear only in the pictures: the scores, the light model, the physics and the sensors ignore them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeatherSpec {
    /// Visual range in fog or haze, without rain and snow, m.
    pub visibility_m: f64,
    /// Rain, mm/h.
    pub rain_mm_h: f64,
    /// Snowfall as water, mm/h.
    pub snow_mm_h: f64,
}

impl Default for WeatherSpec {
    fn default() -> Self {
        Self { visibility_m: Self::CLEAR_VISIBILITY_M, rain_mm_h: 0.0, snow_mm_h: 0.0 }
    }
}

impl WeatherSpec {
    /// Visual range without fog, m (estimate: a slightly hazy day).
    pub const CLEAR_VISIBILITY_M: f64 = 12_000.0;
}

/// Session rules for crashes, battery and GNSS.
#[derive(Debug, Clone, PartialEq)]
pub struct SessionRules {
    /// Action after a survivable crash.
    pub after_crash: AfterCrash,
    /// Battery model for the session.
    pub battery: BatteryModel,
    /// True if the vehicle returns to launch at low battery. False in the TASBID paper's job.
    pub low_battery_return: bool,
    /// Low battery level, %, that triggers the warning and, if enabled, the return to launch.
    pub low_battery_pct: f64,
    /// Critical battery level, %, that triggers a landing if `low_battery_return` is true.
    pub critical_battery_pct: f64,
    /// Temperature of the battery, °C.
    pub battery_temperature_c: f64,
    /// True if structures block GNSS satellites; the fraction of open sky determines the number of visible satellites.
    pub gnss_shadow: bool,
    /// Simulation time before a crashed drone is respawned.
    pub respawn_after: SimTime,
    /// Response to the sticks in position mode at the start.
    pub stick_response: StickResponse,
}

/// Battery temperature below which a battery counts as cold, °C (makers of batteries recommend to warm them up below 15 °C).
const COLD_BATTERY_C: f64 = 15.0;

impl SessionRules {
    /// Returns whether the battery is so cold that its voltage sags notably. In the paper's model, the temperature has no effect.
    #[must_use]
    pub fn has_cold_battery(&self) -> bool {
        self.battery == BatteryModel::Physical && self.battery_temperature_c < COLD_BATTERY_C
    }
}

/// Effects of the bridges on the vehicle that a job can switch on.
#[derive(Debug, Clone, PartialEq)]
pub struct HazardSpec {
    /// True if steel members distort the magnetic field at the compass.
    pub compass: bool,
    /// True if the wind has wakes behind piers, towers and columns, and separates at decks.
    pub wakes: bool,
    /// True if optical flow and the range finder that looks down fail over water.
    pub water: bool,
    /// True if the GNSS receiver sees the satellites of an almanac, and their signals' reflections off water and walls.
    pub sky: bool,
    /// The almanac that the job states; `None` for the nominal orbits.
    pub almanac: Option<Arc<Almanac>>,
    /// True if the bridges attenuate the control and video radio.
    pub radio: bool,
    /// Factor for compass errors and for the amplitude of reflected satellite signals; the radio signal is weaker by its square.
    pub severity: f64,
}

impl HazardSpec {
    /// Range of the severity. Errors and losses beyond the double are not plausible for real bridges (estimate).
    pub(super) const SEVERITY_RANGE: (f64, f64) = (0.5, 2.0);
}

impl Default for HazardSpec {
    fn default() -> Self {
        Self { compass: false, wakes: false, water: false, sky: false, almanac: None, radio: false, severity: 1.0 }
    }
}

/// Action after a crash into a bridge, the terrain or the water.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AfterCrash {
    /// The flight continues if possible; the drone is never respawned.
    Continue,
    /// The drone is respawned at the last safe hover position once it is at rest or touches water.
    Respawn,
    /// The session ends.
    End,
}

/// Battery model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BatteryModel {
    /// Discharges linearly from 100% at lift-off to 0% over the aircraft's `paper_endurance_s`.
    Paper,
    /// Computed from open-circuit voltage, internal resistance and power consumption.
    Physical,
}

/// Feedback thresholds (docs/src/reference/assessment.md, "Feedback during the flight").
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackThresholds {
    /// Minimum distance from the drone's center to any surface, m.
    pub too_close_m: f64,
    /// Distance at which the too-close warning clears, m.
    pub too_close_clear_m: f64,
    /// Outer limit of the off-path band, m.
    pub off_path_max_m: f64,
    /// Time off the path before the cue appears.
    pub off_path_delay: SimTime,
    /// Minimum time that the cue stays visible.
    pub off_path_hold_time: SimTime,
    /// Time that the drone must move away from a task before it has left the task and the cue turns off.
    pub leave_delay: SimTime,
    /// Time on the path of a task after which the drone visits that task, if the task is already done or another task is
    /// being flown.
    pub visit_delay: SimTime,
    /// Excess over the speed limit at which the speeding cue appears, as a fraction of the limit.
    pub speeding_margin: f64,
    /// Minimum time that the speeding cue stays visible.
    pub speeding_hold_time: SimTime,
    /// Minimum battery level displayed in green, %.
    pub battery_green_pct: f64,
    /// Minimum battery level displayed in yellow, %; lower levels are red.
    pub battery_yellow_pct: f64,
    /// Minimum interval between two text messages from the same rule.
    pub text_interval: SimTime,
    /// Flights with guidance.
    pub guidance: GuidancePolicy,
}

/// Flights in which the monitor tells the pilot the next step and the way to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GuidancePolicy {
    /// All flights.
    Always,
    /// All flights except assessments.
    Practice,
    /// None.
    Never,
}

/// Scoring parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct ScoringParams {
    /// Frame rate f of the scoring formulas, Hz.
    pub frame_rate_hz: f64,
    /// Speed limit during inspection, m/s.
    pub speed_limit_m_s: f64,
    /// Unit of the speed limit in the scenario file.
    pub speed_limit_unit: SpeedUnit,
    /// Maximum speed of the scoring scale, m/s (30 mph in the TASBID paper).
    pub max_speed_m_s: f64,
    /// Maximum flight time with an efficiency score of 100%, s.
    pub time_best_s: f64,
    /// Flight time limit, s.
    pub time_max_s: f64,
    /// Beta of the F-measure; `f64::INFINITY` yields the recall.
    pub beta: f64,
    /// True to measure the exact distance to the polyline instead of applying the paper's nearest-point rule.
    pub exact_path: bool,
    /// Clearance below which the certification profile accumulates exposure time, m.
    pub clearance_m: f64,
    /// Fraction of a task's path that must be flown to complete the task, 0 to 1.
    pub task_completion_fraction: f64,
}
