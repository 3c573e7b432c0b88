//! Inputs of the head-up display.

use super::instruments::SiteOutline;
use super::style::DisplayStyle;
use crate::flown_path::FlownPath;
use spandrel_mavlink::contract::cue::CueTexts;
use spandrel_mavlink::contract::guidance::Guidance;
use spandrel_mavlink::contract::hazards::RadioMargins;
use spandrel_mavlink::contract::lesson::LessonStatus;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::pose::Pose;
use spandrel_model::scenario::{GroundTeam, Scenario, Task};
use spandrel_model::shipped;
use spandrel_text::Language;
use spandrel_text::terms::shipped_task_title;
use std::sync::Arc;

/// Name of the flight mode before it has been received.
pub const UNKNOWN_MODE: &str = "no mode";

/// GNSS fix and satellite count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GnssStatus {
    /// Whether there is a 3D fix.
    pub has_fix: bool,
    /// Number of satellites as received; see [`Self::known`].
    pub satellites: u8,
}

impl GnssStatus {
    /// Value of GPS_RAW_INT.satellites_visible if the count is unknown.
    const UNKNOWN: u8 = 255;

    /// Returns the number of satellites, if it is known.
    #[must_use]
    pub fn known(self) -> Option<u8> {
        (self.satellites != Self::UNKNOWN).then_some(self.satellites)
    }
}

/// Reference path of a task for the map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPath {
    /// Display number of the task.
    pub id: u32,
    /// Points, ENU, m.
    pub path_m: Vec<Vec3<Enu>>,
    /// Whether the path is closed.
    pub closed: bool,
}

/// Distances of obstacles around the aircraft.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacles {
    /// Distance in each of equal sectors, clockwise, m. The middle of the first sector is at the nose. Infinite: nothing within
    /// the range; NaN: unknown.
    pub sectors_m: Vec<f64>,
    /// Distance to the nearest surface in any direction, above and below included, m; `None` if it is unknown. The too-close cue
    /// uses it.
    pub nearest_m: Option<f64>,
    /// Largest distance that can be measured, m.
    pub range_m: f64,
    /// Distance at which the too-close cue begins, m.
    pub too_close_m: f64,
}

/// The current step of a lesson.
#[derive(Debug, Clone, PartialEq)]
pub struct LessonDisplay {
    /// The step.
    pub status: LessonStatus,
    /// How it is done.
    pub how: String,
    /// Remark about a mistake.
    pub remark: Option<String>,
}

/// Direction back to the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayBack {
    /// Direction in the picture, rad clockwise from the top.
    pub direction_rad: f64,
}

/// The inspector on the map.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectorMarks {
    /// Position of the feet, ENU, m.
    pub position_m: Vec3<Enu>,
    /// Places to which the inspector can walk, in the order of their numbers, ENU, m.
    pub places_m: Vec<Vec3<Enu>>,
}

impl InspectorMarks {
    /// Returns the marks for an inspector at a position; `None` if the job has only one place.
    #[must_use]
    pub fn new(team: &GroundTeam, position_m: Vec3<Enu>) -> Option<Self> {
        team.can_walk().then(|| Self { position_m, places_m: team.inspector_places_m().collect() })
    }
}

impl MapPath {
    /// Returns the paths of a job's tasks.
    #[must_use]
    pub fn all(scenario: &Scenario) -> Vec<Self> {
        let path = |task: &Task| Self { id: task.id, path_m: task.path_m.clone(), closed: task.closed };
        scenario.tasks.iter().filter(|task| !task.path_m.is_empty()).map(path).collect()
    }
}

/// Names of a job's tasks.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TaskNames {
    /// Number and name of each task, as in the job's file.
    names: Vec<(u32, String)>,
    is_shipped: bool,
}

impl TaskNames {
    /// Returns the names of a job's tasks.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        let names = scenario.tasks.iter().map(|task| (task.id, task.name.clone())).collect();
        Self { names, is_shipped: shipped::SCENARIOS.iter().any(|(name, _)| *name == scenario.name) }
    }

    /// Returns the name of a task in a language. Names in files other than the shipped ones are the user's and stay as they are.
    #[must_use]
    pub fn title(&self, task: u32, language: Language) -> Option<String> {
        let (_, name) = self.names.iter().find(|(id, _)| *id == task)?;
        Some(if self.is_shipped { shipped_task_title(name, language) } else { name.clone() })
    }
}

/// Inputs of the HUD as plain data.
#[derive(Debug, Clone, PartialEq)]
pub struct Hud {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Speed limit, m/s.
    pub limit_m_s: f64,
    /// Battery level, %.
    pub battery_pct: Option<f64>,
    /// Minimum battery level for a green display, %.
    pub min_green_pct: f64,
    /// Minimum battery level for a yellow display, %.
    pub min_yellow_pct: f64,
    /// Mask of active cues, encoded as in `cues` (docs/src/reference/wire.md, "The monitor").
    pub cues: i32,
    /// The monitor's texts for the active cues.
    pub cue_texts: CueTexts,
    /// Height above the pad, m.
    pub height_m: f64,
    /// Horizontal distance from the pad, m.
    pub home_distance_m: f64,
    /// Name of the flight mode, or [`UNKNOWN_MODE`].
    pub mode: String,
    /// Satellite navigation status.
    pub gnss: Option<GnssStatus>,
    /// Margins of the radio links; `None` if the job does not simulate them.
    pub radio: Option<RadioMargins>,
    /// Age of the latest telemetry, s.
    pub telemetry_age_s: f64,
    /// Whether the flight is frozen.
    pub is_frozen: bool,
    /// Gimbal pitch, rad, up positive.
    pub gimbal_rad: f64,
    /// Zoom factor, 1 at the wide end.
    pub zoom: f64,
    /// Whether the lamp is on.
    pub lamp: bool,
    /// Remaining flight time, s.
    pub remaining_s: f64,
    /// Number of pictures taken.
    pub pictures: usize,
    /// Whether a picture has just been taken.
    pub shutter: bool,
    /// Time base of blinking elements, s. It never pauses; in a live flight, it is wall-clock time.
    pub time_s: f64,
    /// Position of the drone, ENU, m.
    pub position_m: Vec3<Enu>,
    /// Heading, rad clockwise from north.
    pub heading_rad: f64,
    /// Roll, rad, right wing down positive.
    pub roll_rad: f64,
    /// Pitch, rad, nose up positive.
    pub pitch_rad: f64,
    /// Obstacles around the aircraft; `None` without range finders or without their telemetry.
    pub obstacles: Option<Obstacles>,
    /// Direction back to the path while the off-path cue is active.
    pub way_back: Option<WayBack>,
    /// Position of the pad, ENU, m.
    pub pad_m: Vec3<Enu>,
    /// The inspector and the numbered places; `None` if the job has only one place.
    pub inspector: Option<InspectorMarks>,
    /// The next step of the job; `None` if the monitor does not guide the pilot.
    pub guidance: Option<Guidance>,
    /// How the next step is done with keys; empty if that needs no words.
    pub guidance_how: String,
    /// Names of the job's tasks.
    pub tasks: TaskNames,
    /// The current step of a lesson.
    pub lesson: Option<LessonDisplay>,
    /// Ghost of an earlier flight, on the maps.
    pub ghost: Option<Pose<Enu>>,
    /// Path flown so far, on the large map.
    pub flown: FlownPath,
    /// Paths on the map; if empty, the map is hidden.
    pub tracks: Vec<MapPath>,
    /// Bridges and shore on the map.
    pub site: Arc<SiteOutline>,
    /// Units and text size.
    pub style: DisplayStyle,
}
