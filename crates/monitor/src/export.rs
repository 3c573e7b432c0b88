//! Exports with fixed names: frames as CSV and the scored part of a scenario as JSON. Numbers are written with the fewest digits
//! that read back to the same bits.

use serde::Serialize;
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::scenario::{PlacedDefect, Scenario};
use std::fmt::Write;

/// Columns of the frames export.
pub const FRAME_COLUMNS: &str = "frame,t_s,fb,rl,ud,rt,light,snapshot,east_m,north_m,up_m,speed_m_s,battery_pct,contact,missing";

/// Frames as CSV; `t_s` counts from lift-off.
#[must_use]
pub fn frames_csv(frames: &[Frame]) -> String {
    let mut csv = String::with_capacity(frames.len() * 120 + FRAME_COLUMNS.len() + 1);
    csv.push_str(FRAME_COLUMNS);
    csv.push('\n');
    let Some(first) = frames.first() else { return csv };
    for frame in frames {
        let [fb, rl, ud, rt] = frame.sticks;
        let [east, north, up] = frame.position_m.array();
        // Divided, not multiplied by 1e-9: the nearest number to a decimal one, so that it is written short.
        let t_s = (frame.time - first.time).ns() as f64 / 1e9;
        let (light, snapshot, missing) = (u8::from(frame.light), u8::from(frame.snapshot), u8::from(frame.missing));
        // Writing to a string cannot fail.
        let _ = writeln!(
            csv,
            "{},{t_s},{fb},{rl},{ud},{rt},{light},{snapshot},{east},{north},{up},{},{},{},{missing}",
            frame.index,
            frame.speed_m_s(),
            frame.battery_pct,
            frame.contact.word(),
        );
    }
    csv
}

/// A task in the scenario export.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TaskExport {
    id: u32,
    name: String,
    threshold_m: f64,
    closed: bool,
    path_enu_m: Vec<[f64; 3]>,
}

/// A defect in the scenario export.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DefectExport {
    id: u32,
    element: u32,
    kind: u32,
    position_enu_m: [f64; 3],
    normal_enu: [f64; 3],
    size_m: f64,
}

/// What a scorer needs of a scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScenarioExport {
    name: String,
    frame_rate_hz: f64,
    speed_limit_m_s: f64,
    max_speed_m_s: f64,
    time_best_s: f64,
    time_max_s: f64,
    /// A number, or the word `inf`, which JSON has no number for.
    beta: serde_json::Value,
    tasks: Vec<TaskExport>,
    defects: Vec<DefectExport>,
}

impl ScenarioExport {
    /// From a scenario and the session's defects.
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

/// JSON text of any export, indented, with a newline at the end.
#[must_use]
pub fn json_text(value: &impl Serialize) -> String {
    // Maps have string keys and no value here fails to serialise; an empty text would show at once.
    serde_json::to_string_pretty(value).map(|text| text + "\n").unwrap_or_default()
}
