//! Per-pixel labels for training detectors: the AASHTO element number and the session's defect ID.

use serde_json::{Value, json};
use spandrel_model::defect_codes;
use spandrel_model::scenario::PlacedDefect;
use std::collections::BTreeMap;

/// Labels of a picture in row-major order from the upper left; 0 means no label.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelMask {
    /// Width, px.
    pub width: u32,
    /// Height, px.
    pub height: u32,
    /// AASHTO element numbers.
    pub elements: Vec<u16>,
    /// Defect IDs in the session.
    pub defects: Vec<u16>,
}

/// Bounding box of a label.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct LabelBounds {
    pixels: u64,
    low: (u32, u32),
    high: (u32, u32),
}

impl LabelMask {
    /// Converts a half-precision float (IEEE 754 binary16, nonnegative) to an integer.
    #[must_use]
    pub fn half_float_to_integer(half: u16) -> u16 {
        let (exponent, fraction) = (i32::from((half >> 10) & 0x1F), f64::from(half & 0x3FF));
        if exponent == 0 {
            return 0;
        }
        ((1.0 + fraction / 1024.0) * spandrel_model::math::pow(2.0, f64::from(exponent - 15))).round() as u16
    }

    /// Returns the legend of the labels as JSON: elements with their pixel counts; defects with kind, condition state,
    /// pixel count, and bounding box (left, top, width, height, px).
    #[must_use]
    pub fn legend(&self, placed: &[PlacedDefect]) -> Value {
        let elements: Vec<Value> = self
            .label_bounds(&self.elements)
            .into_iter()
            .map(|(element, extent)| json!({ "element": element, "pixels": extent.pixels }))
            .collect();
        let defects: Vec<Value> =
            self.label_bounds(&self.defects).into_iter().filter_map(|(id, extent)| defect(placed, id, extent)).collect();
        json!({ "format": 1, "width": self.width, "height": self.height, "elements": elements, "defects": defects })
    }

    fn label_bounds(&self, labels: &[u16]) -> BTreeMap<u16, LabelBounds> {
        let mut all: BTreeMap<u16, LabelBounds> = BTreeMap::new();
        for (k, label) in labels.iter().enumerate().filter(|(_, label)| **label != 0) {
            let at = (k as u32 % self.width, k as u32 / self.width);
            let extent = all.entry(*label).or_insert(LabelBounds { pixels: 0, low: at, high: at });
            extent.pixels += 1;
            extent.low = (extent.low.0.min(at.0), extent.low.1.min(at.1));
            extent.high = (extent.high.0.max(at.0), extent.high.1.max(at.1));
        }
        all
    }
}

fn defect(placed: &[PlacedDefect], id: u16, extent: LabelBounds) -> Option<Value> {
    let defect = placed.iter().find(|defect| defect.id == u32::from(id))?;
    let (low, high) = (extent.low, extent.high);
    Some(json!({
        "id": id,
        "element": defect.element,
        "member": defect.member,
        "kind": defect.kind,
        "name": defect_codes::defect_name(defect.kind),
        "condition_state": defect.condition_state,
        "pixels": extent.pixels,
        "box_px": [low.0, low.1, high.0 - low.0 + 1, high.1 - low.1 + 1],
    }))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use spandrel_model::frames::Vec3;

    /// Returns a placed defect with a number and a kind.
    pub fn placed(id: u32, kind: u32) -> PlacedDefect {
        PlacedDefect {
            id,
            element: spandrel_model::elements::Element::RcArch,
            member: "arch/rib-left/07".into(),
            kind,
            condition_state: 3,
            position_m: Vec3::zero(),
            normal: Vec3::new(0.0, 0.0, 1.0),
            along: Vec3::new(1.0, 0.0, 0.0),
            length_m: 1.0,
            width_m: 0.002,
            line: true,
            cause: None,
            stain: None,
        }
    }

    #[test]
    fn exact_half_floats_convert_to_integers() {
        // IEEE 754-2019, binary16.
        for (half, whole) in
            [(0x0000, 0), (0x3C00, 1), (0x4000, 2), (0x4200, 3), (0x4A00, 12), (0x5880, 144), (0x5D2C, 331), (0x6800, 2048)]
        {
            assert_eq!(LabelMask::half_float_to_integer(half), whole, "{half:#06x}");
        }
    }

    #[test]
    fn exact_legend_lists_labels_and_bounding_boxes() {
        let placed = placed(7, defect_codes::CRACK);
        let masks = LabelMask {
            width: 4,
            height: 3,
            elements: vec![0, 144, 144, 0, 0, 144, 144, 0, 0, 0, 12, 0],
            defects: vec![0, 7, 0, 0, 0, 0, 7, 0, 0, 0, 0, 0],
        };
        let legend = masks.legend(&[placed]);
        assert_eq!(legend["elements"], json!([{ "element": 12, "pixels": 1 }, { "element": 144, "pixels": 4 }]));
        assert_eq!(legend["defects"][0]["box_px"], json!([1, 0, 2, 2]));
        assert_eq!((&legend["defects"][0]["kind"], &legend["defects"][0]["pixels"]), (&json!(1130), &json!(2)));
    }
}
