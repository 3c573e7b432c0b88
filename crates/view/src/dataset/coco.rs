//! Writes annotations in COCO's object detection format (cocodataset.org, "Data format"). Segmentations are uncompressed run lengths, which
//! are as exact as the label masks.

use super::annotations::Annotation;
use super::origin::{DatasetOrigin, LICENSE};
use super::picture::DatasetPicture;
use super::viewpoints::Aim;
use serde_json::{Value, json};
use spandrel_model::calendar;
use spandrel_model::defect_codes;

/// Collects the pictures and annotations of a split.
#[derive(Debug, Clone, Default)]
pub struct CocoFile {
    images: Vec<Value>,
    annotations: Vec<Value>,
}

impl CocoFile {
    /// Adds a picture with its annotations.
    pub fn add(&mut self, picture: &DatasetPicture, annotations: &[Annotation]) {
        self.images.push(image(picture));
        for found in annotations {
            let id = self.annotations.len() + 1;
            self.annotations.push(json!({
                "id": id,
                "image_id": picture.number,
                "category_id": found.kind,
                "bbox": found.box_px,
                "area": found.area_px,
                "segmentation": { "size": [picture.size_px.1, picture.size_px.0], "counts": found.runs_px },
                "iscrowd": 0,
                "defect": found.defect_id,
                "element": found.element,
                "condition_state": found.condition_state,
            }));
        }
    }

    /// Returns the number of pictures.
    #[must_use]
    pub fn image_count(&self) -> usize {
        self.images.len()
    }

    /// Returns the number of annotations.
    #[must_use]
    pub fn annotation_count(&self) -> usize {
        self.annotations.len()
    }

    /// Returns the file's content. It has no date of creation, so that equal data sets have equal files.
    #[must_use]
    pub fn content(&self, origin: &DatasetOrigin) -> Value {
        json!({
            "info": {
                "description": format!("Spandrel pictures of scenario {}", origin.scenario),
                "version": origin.version,
                "scenario": origin.scenario,
                "seed": origin.seed,
                "quality": origin.quality,
                "renderer": origin.renderer,
            },
            "licenses": [{ "id": 1, "name": LICENSE, "url": "" }],
            "categories": categories(),
            "images": self.images,
            "annotations": self.annotations,
        })
    }
}

/// Returns the categories, which are the same in all data sets: the defect codes in ascending order.
fn categories() -> Vec<Value> {
    let category = |kind: &u32| json!({ "id": kind, "name": defect_codes::defect_name(*kind), "supercategory": "defect" });
    defect_codes::ALL.iter().map(category).collect()
}

fn image(picture: &DatasetPicture) -> Value {
    let unix_us = (picture.unix_s() * 1e6) as u64;
    let (task, defect) = match picture.viewpoint.aim {
        Aim::Task(id) => (Some(id), None),
        Aim::Defect(id) => (None, Some(id)),
    };
    json!({
        "id": picture.number,
        "file_name": picture.file_name(),
        "width": picture.size_px.0,
        "height": picture.size_px.1,
        "license": 1,
        "date_captured": calendar::utc(unix_us).0,
        "scene": picture.scene.number,
        "gsd_mm_px": picture.gsd_mm(),
        "task": task,
        "aimed_at_defect": defect,
    })
}
