//! Tasks and defects in a session record.

use super::crashes::Crashes;
use super::technique::TaskTechnique;
use crate::terms::defect_title;
use serde::{Deserialize, Serialize};
use spandrel_model::defect_codes::defect_name;
use spandrel_model::elements::Element;
use spandrel_monitor::score::completion::TaskState;
use spandrel_text::Language;

/// One task's results and the causes of its score.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TaskRecord {
    /// Task number in the scenario.
    pub id: u32,
    /// Task name in the scenario.
    pub name: String,
    /// Kind of task: the value of `kind` in the scenario, such as `slab_side`.
    pub kind: String,
    /// Whether the drone entered the task's path.
    pub attempted: bool,
    /// Whether the task is done, partly flown or not attempted; absent in format 1 records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<TaskState>,
    /// Fraction of the task's path that was flown, 0 to 1; absent in format 1 records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub covered: Option<f64>,
    /// Time from the first to the last on-path frame, s.
    pub seconds: f64,
    /// Fraction of that time spent on the path, 0 to 1.
    pub on_path: f64,
    /// Speeding loss, as defined in the TASBID paper.
    pub speeding: f64,
    /// Time above the speed limit within the window, s.
    pub speeding_s: f64,
    /// Maximum speed within the window, m/s.
    pub fastest_m_s: f64,
    /// Time off the path but within 8 m of it, s.
    pub off_path_s: f64,
    /// Mean horizontal distance from the path while off it, m; `None` if the drone was never off the path.
    pub off_sideways_m: Option<f64>,
    /// Mean vertical distance from the path while off it, m; `None` if the drone was never off the path.
    pub off_height_m: Option<f64>,
    /// Crashes within the task's window.
    pub crashes: Crashes,
    /// Number of defects nearest to this path.
    pub defects_placed: usize,
    /// Number of these defects that were found.
    pub defects_found: usize,
    /// How the task was flown; absent in records before format 4.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub technique: Option<TaskTechnique>,
}

impl TaskRecord {
    /// Returns the crash counts with contacts less than a second apart merged; the counts before merging for records before
    /// format 4.
    #[must_use]
    pub fn contacts(&self) -> Crashes {
        self.technique.map_or(self.crashes, |technique| technique.contacts)
    }
}

/// One of a session's defects.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DefectRecord {
    /// Defect number, from 1.
    pub id: u32,
    /// Defect code (AASHTO MBEI).
    pub kind: u32,
    /// Defect type in plain English. [`Self::kind_title`] returns it in the language of a page.
    pub kind_name: String,
    /// Number of the element with the defect (AASHTO MBEI).
    pub element: Element,
    /// Condition state, 1 to 4 (AASHTO MBEI).
    pub condition_state: u8,
    /// Number of the task with the nearest path; `None` for a job without tasks.
    pub task: Option<u32>,
    /// Whether any snapshot shows the defect.
    pub found: bool,
    /// Reasons why the best picture of a missed defect did not count; empty if there was no picture.
    pub lacked: Vec<String>,
    /// Time during which a picture would have shown the missed defect, s. Computed only for session reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub in_view_s: Option<f64>,
    /// Whether the defect is a crack or another line. False in records before format 4.
    #[serde(default)]
    pub line: bool,
    /// Whether the defect faces away from the viewing direction at the nearest point of its task's path. False in records
    /// before format 4.
    #[serde(default)]
    pub hidden: bool,
    /// Reasons why no picture of a found defect has sufficient quality for the certification. Empty if one has, if the
    /// camera can't reach that quality, and in records before format 4.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shortfalls: Vec<String>,
}

impl DefectRecord {
    /// Returns the defect type; the recorded words if they are not those of the defect's code.
    #[must_use]
    pub fn kind_title(&self, language: Language) -> String {
        if self.kind_name == defect_name(self.kind) { defect_title(self.kind, language) } else { self.kind_name.clone() }
    }
}
