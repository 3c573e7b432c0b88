//! Writes a data set's README.md: its files, how to create it again, and its license.

use super::origin::{DatasetOrigin, LICENSE};
use super::poses::COLUMNS;

/// Returns the text. `counts` are the numbers of pictures and annotations for training and validation.
#[must_use]
pub fn text(origin: &DatasetOrigin, command: &str, counts: [(usize, usize); 2]) -> String {
    let [(train, train_boxes), (validation, validation_boxes)] = counts;
    let DatasetOrigin { version, scenario, seed, quality, renderer } = origin;
    format!(
        "# Pictures of scenario {scenario} for training defect detectors

Spandrel {version} rendered these pictures and their labels. They show simulated bridges and defects; no photograph is among them.

| | pictures | labeled defects |
|---|---|---|
| training | {train} | {train_boxes} |
| validation | {validation} | {validation_boxes} |

| file | content |
|---|---|
| `images/train/`, `images/val/` | pictures |
| `annotations/instances_train.json`, `annotations/instances_val.json` | COCO annotations; `file_name` is relative to the split's folder of pictures |
| `labels/train/`, `labels/val/`, `data.yaml` | YOLO boxes and classes |
| `poses.csv` | position, attitude, ground sampling distance, weather and seed of each picture |

The category IDs are the defect codes of the AASHTO Manual for Bridge Element Inspection. Segmentations are exact, as uncompressed run
lengths (`counts`). Each annotation also has the number of the defect in its scene, the element number and the condition state. Stains that
belong to a defect are not labeled.

The pictures of a scene share defects, date, clouds and wind. All pictures of a scene are in the same split.

Columns of `poses.csv`: {columns}. Positions are in m from the scenario's origin. Angles are in degrees, yaw clockwise from north, pitch above
the horizon. `task` or `defect` is the number of the object at which the picture aims. `distance_m` and `gsd_mm_px` apply to the center of the picture.

## Create it again

    {command}

Seed {seed}, quality {quality}, renderer: {renderer}. The same version, scenario and options yield the same files on the same renderer. On
another renderer, poses are the same, but pixels differ slightly, and outlines with them.

## License

{LICENSE}.
",
        columns = COLUMNS.replace(',', ", "),
    )
}
