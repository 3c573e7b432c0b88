//! Exports for external tools: the frames as a table, and the parts of a scenario that affect scoring as JSON. Column
//! names and keys are stable. Numbers use the fewest digits that represent the value exactly.

pub mod columns;
pub mod fields;
pub mod frame_row;

pub use columns::{COLUMNS, Column, frames_csv};
pub use frame_row::{FrameRow, frame_rows};

use serde::Serialize;
use spandrel_model::elements::Element;
use spandrel_model::scenario::{PlacedDefect, Scenario};

/// Task in the scenario export.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TaskExport {
    id: u32,
    name: String,
    threshold_m: f64,
    closed: bool,
    path_enu_m: Vec<[f64; 3]>,
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
        };
        let defect = |defect: &PlacedDefect| DefectExport {
            id: defect.id,
            element: defect.element,
            kind: defect.kind,
            position_enu_m: defect.position_m.array(),
            normal_enu: defect.normal.array(),
            size_m: defect.length_m,
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
        }
    }
}

/// Serializes an export as indented JSON with a trailing newline.
#[must_use]
pub fn json_text(value: &impl Serialize) -> String {
    // Serialization cannot fail because all map keys are strings.
    serde_json::to_string_pretty(value).map(|text| text + "\n").unwrap_or_default()
}
