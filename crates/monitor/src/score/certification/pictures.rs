//! Accuracy: a picture counts only if its quality is sufficient for the defect that it shows.

use super::inputs::CertificationInputs;
use crate::measures::attention::{DefectSighting, Snapshot, found_defects};
use crate::measures::image_quality::{ImageQuality, best_gsd_mm};
use crate::score::accuracy::DetectionTally;
use serde::Serialize;
use spandrel_model::elements::Element;
use spandrel_model::numbers::{format_limit, format_with_limit};
use spandrel_model::scenario::{CertificationParams, PlacedDefect, Scenario};
use spandrel_model::vehicle::Camera;
use spandrel_text::{Language, text};
use std::collections::BTreeMap;

/// Millimeters per meter.
const MM_PER_M: f64 = 1_000.0;

/// Image quality required for one defect.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DefectGrade {
    /// Defect number.
    pub defect: u32,
    /// Largest ground sampling distance of a picture that counts, mm per pixel.
    pub gsd_limit_mm: f64,
    /// Smallest ground sampling distance that this aircraft's camera reaches at the clearance limit, mm per pixel.
    pub best_gsd_mm: f64,
    /// Whether the camera can reach the required quality. If not, the defect does not count, and neither do pictures of it.
    pub gradable: bool,
    /// Frame of the first picture that shows the defect with sufficient quality.
    pub found_in_frame: Option<u32>,
}

/// Evaluation of one picture.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GradedPicture {
    /// Frame number of the picture.
    pub frame: u32,
    /// Whether the picture counts as taken. False if it shows nothing but defects that are too fine for the camera.
    pub counted: bool,
    /// Whether the picture is the first to show a defect with sufficient quality.
    pub hit: bool,
    /// Numbers of the defects first shown with sufficient quality.
    pub found: Vec<u32>,
    /// Unmet conditions of every defect that the picture shows, as text.
    pub fails: Vec<String>,
}

/// Pictures and defects, with the counts from which the accuracy is computed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Accuracy {
    /// Number of pictures that count.
    pub taken: usize,
    /// Number of pictures that show a new defect with sufficient quality.
    pub hits: usize,
    /// Number of gradable defects found.
    pub found: usize,
    /// Number of gradable defects placed.
    pub placed: usize,
    /// Precision: `hits` / `taken`.
    pub precision: f64,
    /// Recall: `found` / `placed`; absent if no defect is gradable.
    pub recall: Option<f64>,
    /// Required and reached quality of each placed defect.
    pub defects: Vec<DefectGrade>,
    /// Evaluation of each picture, in order.
    pub pictures: Vec<GradedPicture>,
}

/// Number of defects found and placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct DetectionCounts {
    /// Number of defects found.
    pub found: usize,
    /// Number of defects placed in the scene.
    pub placed: usize,
}

/// Number of defects found and placed under the paper's conditions, by element, kind and condition state.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Detection {
    /// Always true: only detection is graded, because trainees cannot yet report a defect's kind and condition state.
    pub detection_only: bool,
    /// Counts by AASHTO MBEI element number.
    pub by_element: BTreeMap<Element, DetectionCounts>,
    /// Counts by AASHTO MBEI defect code.
    pub by_kind: BTreeMap<u32, DetectionCounts>,
    /// Counts by condition state, 1 to 4.
    pub by_condition_state: BTreeMap<u8, DetectionCounts>,
}

/// Returns the largest ground sampling distance at which a picture of this defect counts, mm per pixel.
#[must_use]
pub fn gsd_limit_mm(defect: &PlacedDefect, params: &CertificationParams) -> f64 {
    let by_width = if defect.line { params.gsd_per_line_width * defect.width_m * MM_PER_M } else { f64::INFINITY };
    params.max_gsd_mm.min(by_width)
}

/// Returns the shortest distance in meters at which a picture can be taken without going below a clearance limit.
#[must_use]
pub fn shortest_stand_off_m(scenario: &Scenario) -> f64 {
    scenario.tasks.iter().filter_map(|task| task.too_close_m).fold(scenario.scoring.clearance_m, f64::min)
}

/// Returns whether a camera can photograph a defect with sufficient resolution, and its smallest ground sampling
/// distance, mm per pixel.
#[must_use]
pub fn is_gradable(defect: &PlacedDefect, scenario: &Scenario, camera: &Camera) -> (bool, f64) {
    let best_mm = best_gsd_mm(camera, shortest_stand_off_m(scenario));
    (best_mm <= gsd_limit_mm(defect, &scenario.certification), best_mm)
}

/// Returns the quality conditions that a view fails, as English text; [`crate::stored_text`] translates it.
fn quality_fails(quality: &ImageQuality, gsd_limit_mm: f64, params: &CertificationParams) -> Vec<String> {
    type Words = fn(String, String) -> String;
    let resolution: Words =
        |value, limit| text!(Language::English, "certification-picture-resolution", value = value, limit = limit);
    let blur: Words = |value, limit| text!(Language::English, "certification-picture-motion-blur", value = value, limit = limit);
    let incidence: Words =
        |value, limit| text!(Language::English, "certification-picture-incidence", value = value, limit = limit);
    let limits = [
        (resolution, quality.gsd_mm, gsd_limit_mm, 2),
        (blur, quality.smear_px, params.max_smear_px, 1),
        (incidence, quality.incidence_deg, params.max_incidence_deg, 0),
    ];
    let over = limits.iter().filter(|(_, value, limit, _)| value > limit);
    over.map(|(words, value, limit, digits)| words(format_with_limit(*value, *limit, *digits), format_limit(*limit))).collect()
}

impl Accuracy {
    /// Evaluates all pictures.
    #[must_use]
    pub fn grade(inputs: &CertificationInputs<'_>) -> Self {
        let params = &inputs.scenario.certification;
        let mut defects: Vec<DefectGrade> = inputs
            .defects
            .iter()
            .map(|defect| {
                let (gradable, best_gsd_mm) = is_gradable(defect, inputs.scenario, &inputs.vehicle.camera);
                let gsd_limit_mm = gsd_limit_mm(defect, params);
                DefectGrade { defect: defect.id, gsd_limit_mm, best_gsd_mm, gradable, found_in_frame: None }
            })
            .collect();
        let pictures: Vec<GradedPicture> =
            inputs.pictures.iter().map(|picture| grade_picture(picture, &mut defects, params)).collect();
        let tally = DetectionTally {
            taken: pictures.iter().filter(|picture| picture.counted).count(),
            hits: pictures.iter().filter(|picture| picture.hit).count(),
            found: defects.iter().filter(|defect| defect.found_in_frame.is_some()).count(),
            placed: defects.iter().filter(|defect| defect.gradable).count(),
        };
        let (precision, recall) = (tally.precision(), tally.recall());
        let DetectionTally { taken, hits, found, placed } = tally;
        Self { taken, hits, found, placed, precision, recall, defects, pictures }
    }

    /// Returns the accuracy, 0 to 100: 100 times the F-measure; `None` if no defect is gradable.
    #[must_use]
    pub fn score(&self, beta: f64) -> Option<f64> {
        let tally = DetectionTally { taken: self.taken, hits: self.hits, found: self.found, placed: self.placed };
        tally.score(beta).map(|score| score.pct)
    }
}

/// Evaluates one picture and notes the defects that it is the first to show with sufficient quality.
fn grade_picture(picture: &Snapshot, defects: &mut [DefectGrade], params: &CertificationParams) -> GradedPicture {
    let mut found = Vec::new();
    let mut fails = Vec::new();
    let mut too_fine = false;
    for view in picture.views.iter().filter(|view| view.shown) {
        let Some(defect) = defects.iter_mut().find(|defect| defect.defect == view.defect) else { continue };
        too_fine |= !defect.gradable;
        let reasons = view_fails(view, defect, params);
        if reasons.is_empty() && defect.found_in_frame.is_none() {
            defect.found_in_frame = Some(picture.frame);
            found.push(view.defect);
        }
        fails.extend(
            reasons
                .into_iter()
                .map(|reason| text!(Language::English, "terms-picture-of-defect", defect = view.defect, reason = reason)),
        );
    }
    GradedPicture { frame: picture.frame, counted: !found.is_empty() || !too_fine, hit: !found.is_empty(), found, fails }
}

fn view_fails(view: &DefectSighting, defect: &DefectGrade, params: &CertificationParams) -> Vec<String> {
    if !defect.gradable {
        return vec![text!(Language::English, "certification-picture-too-fine")];
    }
    quality_fails(&view.quality, defect.gsd_limit_mm, params)
}

/// Counts the defects found under the paper's conditions.
#[must_use]
pub fn detection(inputs: &CertificationInputs<'_>) -> Detection {
    let ids = found_defects(inputs.pictures);
    let mut detection = Detection {
        detection_only: true,
        by_element: BTreeMap::new(),
        by_kind: BTreeMap::new(),
        by_condition_state: BTreeMap::new(),
    };
    for defect in inputs.defects {
        let found = usize::from(ids.contains(&defect.id));
        let add = |entry: &mut DetectionCounts| {
            entry.placed += 1;
            entry.found += found;
        };
        add(detection.by_element.entry(defect.element).or_default());
        add(detection.by_kind.entry(defect.kind).or_default());
        add(detection.by_condition_state.entry(defect.condition_state).or_default());
    }
    detection
}
