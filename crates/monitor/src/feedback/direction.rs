//! Words for a direction relative to the aircraft's heading.

use super::input::HeadingOffset;

/// Smallest component that is named, as a fraction of the distance: sin 22.5 deg, so that in each plane, the words name the
/// nearest of eight directions.
const MIN_NAMED_FRACTION: f64 = 0.382_683_432_365_089_8;

/// Returns a direction in words, such as "left and up" or "forward, right and down"; empty if the displacement is zero.
#[must_use]
pub fn direction_words(offset: HeadingOffset) -> String {
    let axes = [(offset.forward_m, "forward", "back"), (offset.right_m, "right", "left"), (offset.up_m, "up", "down")];
    let least_m = MIN_NAMED_FRACTION * offset.length_m();
    let named = axes.into_iter().filter(|(along_m, ..)| *along_m != 0.0 && along_m.abs() >= least_m);
    let words: Vec<&str> = named.map(|(along_m, ahead, behind)| if along_m > 0.0 { ahead } else { behind }).collect();
    match words.as_slice() {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::frames::Vec3;
    use spandrel_model::math;

    #[test]
    fn exact_words_name_the_components_that_matter() {
        let words = |forward_m, right_m, up_m| direction_words(HeadingOffset { forward_m, right_m, up_m });
        assert_eq!(words(5.0, 0.0, 0.0), "forward");
        assert_eq!(words(-5.0, 0.5, 0.0), "back");
        assert_eq!(words(0.0, -3.0, 3.0), "left and up");
        assert_eq!(words(1.0, 1.0, -1.0), "forward, right and down");
        assert_eq!(words(0.0, 0.0, 0.0), "");
    }

    #[test]
    fn exact_words_change_halfway_between_eight_directions() {
        // (bearing relative to the heading, deg; words). The boundaries are 22.5 and 67.5 degrees.
        let bearings = [
            (0.0, "forward"),
            (22.4, "forward"),
            (22.6, "forward and right"),
            (67.4, "forward and right"),
            (67.6, "right"),
            (112.6, "back and right"),
            (180.0, "back"),
            (-90.0, "left"),
            (-157.4, "back and left"),
        ];
        for heading_deg in [0.0, 137.0, 300.0] {
            for (bearing_deg, words) in bearings {
                let (sin, cos) = math::sin_cos(f64::to_radians(heading_deg + bearing_deg));
                let offset = HeadingOffset::new(Vec3::new(4.0 * sin, 4.0 * cos, 0.0), f64::to_radians(heading_deg));
                assert_eq!(direction_words(offset), words, "heading {heading_deg}, bearing {bearing_deg}");
            }
        }
    }
}
