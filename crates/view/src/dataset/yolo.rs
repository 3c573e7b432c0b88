//! Writes boxes in the text format of YOLO detectors: for each box the class, the center and the size, as fractions of the picture. Classes
//! are the defect codes in ascending order, numbered from 0.

use super::annotations::Annotation;
use super::scenes::Split;
use spandrel_model::defect_codes;
use std::fmt::Write;

/// Returns a picture's label file; empty if it shows no defect.
#[must_use]
pub fn labels(annotations: &[Annotation], (width_px, height_px): (u32, u32)) -> String {
    let mut text = String::new();
    let (width, height) = (f64::from(width_px), f64::from(height_px));
    for found in annotations {
        // A code without a class can't be placed: placement draws from the same list.
        let Some(class) = defect_codes::ALL.iter().position(|kind| *kind == found.kind) else { continue };
        let [left, top, w, h] = found.box_px.map(f64::from);
        let (x, y) = ((left + 0.5 * w) / width, (top + 0.5 * h) / height);
        let _ = writeln!(text, "{class} {x} {y} {} {}", w / width, h / height);
    }
    text
}

/// Returns `data.yaml`, which lists the folders of the pictures and the classes. Its folders are relative to the file.
#[must_use]
pub fn data_yaml() -> String {
    let mut text = String::new();
    for split in Split::ALL {
        let _ = writeln!(text, "{0}: images/{0}", split.name());
    }
    text.push_str("names:\n");
    for (class, kind) in defect_codes::ALL.iter().enumerate() {
        let _ = writeln!(text, "  {class}: {}", defect_codes::defect_name(*kind));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::annotations::annotations;
    use super::super::annotations::tests::random_mask;
    use super::*;
    use crate::masks::tests::placed;
    use spandrel_model::random::RandomStream;

    /// Rounding error of a coordinate, px.
    const ROUNDING_PX: f64 = 1e-9;

    #[test]
    fn prop_yolo_boxes_equal_the_exact_boxes() {
        let defects: Vec<_> = (1..=6).map(|id| placed(id, defect_codes::ALL[id as usize])).collect();
        let mut stream = RandomStream::new(7, "view.dataset.yolo");
        for _ in 0..50 {
            let size = (10 + stream.below(90) as u32, 10 + stream.below(90) as u32);
            let found = annotations(&random_mask(&mut stream, size), &defects);
            let text = labels(&found, size);
            assert_eq!(text.lines().count(), found.len());
            for (line, annotation) in text.lines().zip(&found) {
                let numbers: Vec<f64> = line.split(' ').map(|number| number.parse().unwrap()).collect();
                let [class, x, y, w, h] = numbers[..] else { panic!("{line}") };
                assert_eq!(defect_codes::ALL[class as usize], annotation.kind);
                let (width, height) = (f64::from(size.0), f64::from(size.1));
                let back = [(x - 0.5 * w) * width, (y - 0.5 * h) * height, w * width, h * height];
                for (back, exact) in back.iter().zip(annotation.box_px) {
                    assert!((back - f64::from(exact)).abs() < ROUNDING_PX, "{line}: {annotation:?}");
                }
            }
        }
    }
}
