//! Exports for external tools: the frames as a table, and the parts of a scenario that affect scoring as JSON. Column
//! names and keys are stable. Numbers use the fewest digits that represent the value exactly.

pub mod columns;
pub mod fields;
pub mod frame_row;

pub use columns::{COLUMNS, Column, frames_csv};
pub use frame_row::{FrameRow, frame_rows};

use serde::Serialize;
use spandrel_model::elements::Element;
use spandrel_model::scenario::{CertificationParams, PlacedDefect, Scenario};

/// Task in the scenario export.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TaskExport {
    id: u32,
    name: String,
    threshold_m: f64,
    closed: bool,
    path_enu_m: Vec<[f64; 3]>,
    /// Unit vectors from each path point toward the inspected surface; empty if the task inspects none.
    viewing_directions_enu: Vec<[f64; 3]>,
    /// Clearance below which time counts as exposure in this task, m.
    clearance_m: f64,
}

/// Defect in the scenario export.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DefectExport {
    id: u32,
    element: Element,
    kind: u32,
    position_enu_m: [f64; 3],
    normal_enu: [f64; 3],
    size_m: f64,
    width_m: f64,
    line: bool,
}

/// Values of a scenario that the certification profile uses, in the units of the scenario file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CertificationExport {
    task_done_share: f64,
    clearance_m: f64,
    home_enu_m: [f64; 3],
    home_radius_m: f64,
    #[serde(flatten)]
    params: CertificationParams,
}

impl CertificationExport {
    fn new(scenario: &Scenario) -> Self {
        let team = &scenario.ground_team;
        Self {
            task_done_share: scenario.scoring.task_completion_fraction,
            clearance_m: scenario.scoring.clearance_m,
            home_enu_m: team.pad_m.array(),
            home_radius_m: team.home_radius_m,
            params: scenario.certification,
        }
    }
}

/// The parts of a scenario that affect scoring.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScenarioExport {
    name: String,
    frame_rate_hz: f64,
    speed_limit_m_s: f64,
    max_speed_m_s: f64,
    time_best_s: f64,
    time_max_s: f64,
    /// Weight of recall: a number or, because JSON cannot represent infinity, the string `inf`.
    beta: serde_json::Value,
    tasks: Vec<TaskExport>,
    defects: Vec<DefectExport>,
    certification: CertificationExport,
}

impl ScenarioExport {
    /// Creates the export from a scenario and the session's defects.
    #[must_use]
    pub fn new(scenario: &Scenario, defects: &[PlacedDefect]) -> Self {
        let scoring = &scenario.scoring;
        let beta = serde_json::Number::from_f64(scoring.beta).map_or_else(|| "inf".into(), serde_json::Value::Number);
        let task = |task: &spandrel_model::scenario::Task| TaskExport {
            id: task.id,
            name: task.name.clone(),
            threshold_m: task.threshold_m,
            closed: task.closed,
            path_enu_m: task.path_m.iter().map(|point| point.array()).collect(),
            viewing_directions_enu: if task.inspects_surface {
                task.viewing_directions.iter().map(|direction| direction.array()).collect()
            } else {
                Vec::new()
            },
            clearance_m: task.too_close_m.unwrap_or(f64::INFINITY).min(scoring.clearance_m),
        };
        let defect = |defect: &PlacedDefect| DefectExport {
            id: defect.id,
            element: defect.element,
            kind: defect.kind,
            position_enu_m: defect.position_m.array(),
            normal_enu: defect.normal.array(),
            size_m: defect.length_m,
            width_m: defect.width_m,
            line: defect.line,
        };
        Self {
            name: scenario.name.clone(),
            frame_rate_hz: scoring.frame_rate_hz,
            speed_limit_m_s: scoring.speed_limit_m_s,
            max_speed_m_s: scoring.max_speed_m_s,
            time_best_s: scoring.time_best_s,
            time_max_s: scoring.time_max_s,
            beta,
            tasks: scenario.tasks.iter().map(task).collect(),
            defects: defects.iter().map(defect).collect(),
            certification: CertificationExport::new(scenario),
        }
    }
}

/// Serializes an export as indented JSON with a trailing newline.
#[must_use]
pub fn json_text(value: &impl Serialize) -> String {
    // Serialization cannot fail because all map keys are strings.
    serde_json::to_string_pretty(value).map(|text| text + "\n").unwrap_or_default()
}
