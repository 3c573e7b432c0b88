//! Annotations of a picture: for each visible defect its exact outline as run lengths, its bounding box and its area.

use crate::masks::LabelMask;
use spandrel_model::scenario::PlacedDefect;
use std::collections::BTreeMap;

/// A visible defect in a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Annotation {
    /// Number of the defect in its scene.
    pub defect_id: u32,
    /// AASHTO MBEI defect code.
    pub kind: u32,
    /// AASHTO element number.
    pub element: u16,
    /// Condition state.
    pub condition_state: u8,
    /// Left, top, width and height of the bounding box, px.
    pub box_px: [u32; 4],
    /// Number of pixels.
    pub area_px: u64,
    /// Lengths of the alternating runs of other pixels and the defect's pixels, column by column from the upper left, as in COCO's
    /// uncompressed run-length encoding. The first run may be 0.
    pub runs_px: Vec<u64>,
}

/// Runs and extent of a label.
#[derive(Debug, Default)]
struct Outline {
    runs_px: Vec<u64>,
    end: u64,
    low: (u32, u32),
    high: (u32, u32),
}

impl Outline {
    fn at(x: u32, y: u32) -> Self {
        Self { low: (x, y), high: (x, y), ..Self::default() }
    }

    /// Adds a pixel, whose index in column order must be larger than that of the pixel before.
    fn add(&mut self, index: u64, (x, y): (u32, u32)) {
        match self.runs_px.last_mut() {
            Some(run) if index == self.end => *run += 1,
            _ => self.runs_px.extend([index - self.end, 1]),
        }
        self.end = index + 1;
        self.low = (self.low.0.min(x), self.low.1.min(y));
        self.high = (self.high.0.max(x), self.high.1.max(y));
    }
}

/// Returns the annotations of all defects that a picture's labels contain, by defect number. Labels without a placed defect are ignored.
#[must_use]
pub fn annotations(masks: &LabelMask, placed: &[PlacedDefect]) -> Vec<Annotation> {
    let mut outlines: BTreeMap<u16, Outline> = BTreeMap::new();
    for x in 0..masks.width {
        for y in 0..masks.height {
            let label = masks.defects[(y * masks.width + x) as usize];
            if label != 0 {
                let index = u64::from(x) * u64::from(masks.height) + u64::from(y);
                outlines.entry(label).or_insert_with(|| Outline::at(x, y)).add(index, (x, y));
            }
        }
    }
    let pixels = u64::from(masks.width) * u64::from(masks.height);
    outlines.into_iter().filter_map(|(label, outline)| annotation(placed, label, outline, pixels)).collect()
}

fn annotation(placed: &[PlacedDefect], label: u16, mut outline: Outline, pixels: u64) -> Option<Annotation> {
    let defect = placed.iter().find(|defect| defect.id == u32::from(label))?;
    let (low, high) = (outline.low, outline.high);
    let area_px = outline.runs_px.iter().skip(1).step_by(2).sum();
    if outline.end < pixels {
        outline.runs_px.push(pixels - outline.end);
    }
    Some(Annotation {
        defect_id: defect.id,
        kind: defect.kind,
        element: defect.element.number(),
        condition_state: defect.condition_state,
        box_px: [low.0, low.1, high.0 - low.0 + 1, high.1 - low.1 + 1],
        area_px,
        runs_px: outline.runs_px,
    })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::masks::tests::placed;
    use spandrel_model::defect_codes;
    use spandrel_model::random::RandomStream;

    /// Returns a picture with random patches of several defects.
    pub fn random_mask(stream: &mut RandomStream, (width, height): (u32, u32)) -> LabelMask {
        let mut defects = vec![0; (width * height) as usize];
        for id in 1..=6 {
            let (left, top) = (stream.below(width as usize), stream.below(height as usize));
            let (right, bottom) =
                ((left + stream.below(9)).min(width as usize - 1), (top + stream.below(9)).min(height as usize - 1));
            for k in (top..=bottom).flat_map(|y| (left..=right).map(move |x| y * width as usize + x)) {
                if stream.uniform() < 0.7 {
                    defects[k] = id;
                }
            }
        }
        LabelMask { width, height, elements: vec![144; defects.len()], defects }
    }

    #[test]
    fn exact_runs_of_a_small_picture() {
        // Columns from the left: (7, 0, 0), (7, 7, 0), (0, 0, 5), (0, 0, 5).
        let masks = LabelMask { width: 4, height: 3, elements: vec![0; 12], defects: vec![7, 7, 0, 0, 0, 7, 0, 0, 0, 0, 5, 5] };
        let found = annotations(&masks, &[placed(7, defect_codes::CRACK), placed(5, defect_codes::SPALL)]);
        let of = |k: usize| (found[k].defect_id, found[k].kind, found[k].box_px, found[k].area_px, found[k].runs_px.clone());
        assert_eq!(found.len(), 2);
        assert_eq!(of(0), (5, 1080, [2, 2, 2, 1], 2, vec![8, 1, 2, 1]), "the last pixel ends the runs");
        assert_eq!(of(1), (7, 1130, [0, 0, 2, 2], 3, vec![0, 1, 2, 2, 7]), "the first run is empty");
        assert_eq!((found[0].element, found[0].condition_state), (144, 3));
    }

    #[test]
    fn prop_runs_restore_the_labels_and_boxes_match_the_legend() {
        let defects: Vec<PlacedDefect> = (1..=6).map(|id| placed(id, defect_codes::ALL[id as usize])).collect();
        let mut stream = RandomStream::new(7, "view.dataset.annotations");
        for _ in 0..200 {
            let size = (1 + stream.below(30) as u32, 1 + stream.below(30) as u32);
            let masks = random_mask(&mut stream, size);
            let mut restored = vec![0; masks.defects.len()];
            let found = annotations(&masks, &defects);
            for annotation in &found {
                let mut index = 0;
                for (k, run) in annotation.runs_px.iter().enumerate() {
                    for index in (index..index + run).filter(|_| k % 2 == 1) {
                        let (x, y) = (index / u64::from(size.1), index % u64::from(size.1));
                        restored[(y * u64::from(size.0) + x) as usize] = annotation.defect_id as u16;
                    }
                    index += run;
                }
                assert_eq!(index, u64::from(size.0) * u64::from(size.1));
                assert!(annotation.runs_px.iter().skip(1).all(|run| *run > 0), "{annotation:?}");
            }
            assert_eq!(restored, masks.defects);
            // The legend derives the same boxes row by row.
            let legend = masks.legend(&defects);
            let expected: Vec<_> = legend["defects"].as_array().unwrap().iter().collect();
            assert_eq!(found.len(), expected.len());
            for (annotation, entry) in found.iter().zip(expected) {
                assert_eq!(entry["id"], annotation.defect_id);
                assert_eq!(entry["box_px"], serde_json::json!(annotation.box_px));
                assert_eq!(entry["pixels"], annotation.area_px);
            }
        }
    }
}
