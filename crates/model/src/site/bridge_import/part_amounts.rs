//! Estimates the quantities of an imported bridge from the bounding boxes of its parts. An element's parts that lie along each other, such as
//! the flanges and the web of a girder, count once. Lengths are along the road or across it, as inspection reports measure them.

use crate::elements::{Element, ElementGroup, ElementUnit};

/// Distance within which parts lie along each other, m (estimate: more than a gap between plates, less than one between members).
const BESIDE_M: f64 = 0.1;

/// A part's element and its bounding box, m: x along the deck, z up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PartBox {
    pub element: Element,
    pub low_m: [f64; 3],
    pub size_m: [f64; 3],
}

/// Returns each part's share of its element's quantity: an area in m², a length in m or 1.
pub(super) fn amounts(parts: &[PartBox]) -> Vec<f64> {
    let mut amounts = vec![0.0; parts.len()];
    let mut elements: Vec<Element> = parts.iter().map(|part| part.element).collect();
    elements.sort_unstable();
    elements.dedup();
    for element in elements {
        let own: Vec<usize> = (0..parts.len()).filter(|k| parts[*k].element == element).collect();
        match element.unit() {
            Some(ElementUnit::SquareFeet) => add_areas(parts, own, &mut amounts),
            Some(ElementUnit::Feet) => add_lengths(element, parts, own, &mut amounts),
            Some(ElementUnit::Each) | None => own.into_iter().for_each(|k| amounts[k] = 1.0),
        }
    }
    amounts
}

impl PartBox {
    /// Returns the lowest and highest coordinate along an axis.
    fn interval(&self, axis: usize) -> (f64, f64) {
        (self.low_m[axis], self.low_m[axis] + self.size_m[axis])
    }

    /// Returns the horizontal axis along which the part is longer.
    fn axis(&self) -> usize {
        usize::from(self.size_m[1] > self.size_m[0])
    }
}

/// Adds the area that each part covers in plan, and that no wider part covers.
fn add_areas(parts: &[PartBox], mut own: Vec<usize>, amounts: &mut [f64]) {
    let width_m = |k: &usize| parts[*k].size_m[0].min(parts[*k].size_m[1]);
    own.sort_by(|a, b| width_m(b).total_cmp(&width_m(a)));
    for (rank, k) in own.iter().enumerate() {
        let common_m2 = |other: &usize| -> f64 {
            (0..2).map(|axis| common_m(parts[*k].interval(axis), parts[*other].interval(axis))).product()
        };
        let covered_m2: f64 = own[..rank].iter().filter(|other| amounts[**other] > 0.0).map(common_m2).sum();
        amounts[*k] = (parts[*k].size_m[0] * parts[*k].size_m[1] - covered_m2).max(0.0);
    }
}

/// Returns the length that two intervals share.
fn common_m(a: (f64, f64), b: (f64, f64)) -> f64 {
    (a.1.min(b.1) - a.0.max(b.0)).max(0.0)
}

/// Adds the length that each part covers, and that no longer part beside it covers.
fn add_lengths(element: Element, parts: &[PartBox], own: Vec<usize>, amounts: &mut [f64]) {
    if element.group() == ElementGroup::Cable {
        // Stays of one plane are above each other, and each of them counts.
        own.into_iter().for_each(|k| amounts[k] = parts[k].size_m[parts[k].axis()]);
        return;
    }
    if element == Element::SteelTower {
        own.into_iter().for_each(|k| amounts[k] = parts[k].size_m[2]);
        return;
    }
    for axis in 0..2 {
        // Cross-frames and stiffeners of a girder have its element, but its length is along the road.
        if axis == 1 && is_along_road(element) {
            return;
        }
        // Segments of a box can be wider than long.
        let is_along = |k: &usize| parts[*k].axis() == axis || is_box_girder(element);
        let along: Vec<usize> = own.iter().copied().filter(|k| is_along(k) && !is_on_another(*k, parts, &own)).collect();
        for line in lines(parts, axis, along) {
            add_line(parts, axis, line, amounts);
        }
    }
}

/// Returns the parts of each line: those that lie along each other, directly or with others between them.
fn lines(parts: &[PartBox], axis: usize, mut along: Vec<usize>) -> Vec<Vec<usize>> {
    let across = |k: usize| parts[k].interval(1 - axis);
    along.sort_by(|a, b| across(*a).0.total_cmp(&across(*b).0));
    let mut lines: Vec<(f64, Vec<usize>)> = Vec::new();
    for k in along {
        let (low, high) = across(k);
        match lines.last_mut().filter(|(end, _)| low <= *end + BESIDE_M) {
            Some((end, line)) => {
                *end = end.max(high);
                line.push(k);
            }
            None => lines.push((high, vec![k])),
        }
    }
    lines.into_iter().map(|(_, line)| line).collect()
}

/// Adds the length of a line, each piece of which goes to the longest part there.
fn add_line(parts: &[PartBox], axis: usize, mut line: Vec<usize>, amounts: &mut [f64]) {
    line.sort_by(|a, b| parts[*b].size_m[axis].total_cmp(&parts[*a].size_m[axis]));
    let mut covered: Vec<(f64, f64)> = Vec::new();
    for k in line {
        let whole = parts[k].interval(axis);
        amounts[k] = uncovered_m(whole, &covered);
        covered.push(whole);
    }
}

/// Returns whether inspection reports state an element's length along the road.
fn is_along_road(element: Element) -> bool {
    let is_floor_beam = matches!(element, Element::SteelFloorBeam | Element::PscFloorBeam | Element::RcFloorBeam);
    matches!(element.group(), ElementGroup::Superstructure | ElementGroup::Railing) && !is_floor_beam
}

fn is_box_girder(element: Element) -> bool {
    matches!(element, Element::SteelBoxGirder | Element::PscBoxGirder | Element::RcBoxGirder)
}

/// Returns whether a part is within a longer one in plan, such as a pedestal on a cap.
fn is_on_another(k: usize, parts: &[PartBox], own: &[usize]) -> bool {
    let part = &parts[k];
    let is_within = |other: &PartBox| {
        (0..2).all(|axis| {
            let (inner, outer) = (part.interval(axis), other.interval(axis));
            inner.0 >= outer.0 - BESIDE_M && inner.1 <= outer.1 + BESIDE_M
        })
    };
    let length_m = |part: &PartBox| part.size_m[part.axis()];
    own.iter().any(|other| length_m(&parts[*other]) > length_m(part) + BESIDE_M && is_within(&parts[*other]))
}

/// Returns the length of an interval that no other interval covers.
fn uncovered_m(whole: (f64, f64), covered: &[(f64, f64)]) -> f64 {
    let mut free = vec![whole];
    for (low, high) in covered {
        free = free.into_iter().flat_map(|(a, b)| [(a, b.min(*low)), (a.max(*high), b)]).filter(|(a, b)| b > a).collect();
    }
    free.into_iter().map(|(a, b)| b - a).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance for sums of a few lengths, m: rounding only.
    const ROUNDING_M: f64 = 1e-9;

    fn part(element: Element, x: (f64, f64), y: (f64, f64), z: (f64, f64)) -> PartBox {
        PartBox { element, low_m: [x.0, y.0, z.0], size_m: [x.1 - x.0, y.1 - y.0, z.1 - z.0] }
    }

    fn total(parts: &[PartBox]) -> f64 {
        amounts(parts).iter().sum()
    }

    #[test]
    fn exact_flanges_webs_and_cross_frames_of_a_girder_count_once() {
        let girder = |y: f64| {
            let plate = |from: f64, to: f64, half_m: f64, z: (f64, f64)| {
                part(Element::SteelGirder, (from, to), (y - half_m, y + half_m), z)
            };
            // The top flange is spliced where the web is not.
            [
                plate(0.0, 12.0, 0.2, (1.9, 2.0)),
                plate(12.0, 30.0, 0.25, (1.9, 2.0)),
                plate(0.0, 30.0, 0.01, (0.1, 1.9)),
                plate(0.0, 30.0, 0.2, (0.0, 0.1)),
            ]
        };
        let mut parts = [girder(-2.0), girder(2.0)].concat();
        assert!((total(&parts) - 60.0).abs() < ROUNDING_M, "{:?}", amounts(&parts));
        parts.push(part(Element::SteelGirder, (9.9, 10.1), (-1.8, 1.8), (0.2, 1.8)));
        parts.push(part(Element::SteelGirder, (5.0, 5.02), (-2.1, -1.9), (0.1, 1.9)));
        assert!((total(&parts) - 60.0).abs() < ROUNDING_M, "a cross-frame and a stiffener: {:?}", amounts(&parts));
    }

    #[test]
    fn exact_webs_and_slab_of_a_box_are_one_line() {
        let wall = |y: f64| part(Element::PscBoxGirder, (0.0, 40.0), (y - 0.2, y + 0.2), (0.0, 2.0));
        let slab = |x: f64| part(Element::PscBoxGirder, (x, x + 4.0), (-3.0, 3.0), (0.0, 0.2));
        let parts = [wall(-3.2), wall(0.0), wall(3.2), slab(0.0), slab(4.0), slab(36.0)];
        assert!((total(&parts) - 40.0).abs() < ROUNDING_M, "{:?}", amounts(&parts));
    }

    #[test]
    fn exact_abutment_is_its_stem_and_wings() {
        let abutment = |x: (f64, f64), y: (f64, f64), z: (f64, f64)| part(Element::RcAbutment, x, y, z);
        let parts = [
            abutment((0.0, 1.4), (-6.0, 6.0), (0.0, 8.0)),
            abutment((0.0, 0.5), (-6.0, 6.0), (8.0, 10.0)),
            abutment((-6.0, 0.0), (5.6, 6.0), (0.0, 10.0)),
            abutment((-6.0, 0.0), (-6.0, -5.6), (0.0, 10.0)),
            abutment((0.4, 1.1), (-2.3, -1.7), (8.0, 8.3)),
        ];
        assert_eq!(amounts(&parts), [12.0, 0.0, 6.0, 6.0, 0.0]);
    }

    #[test]
    fn exact_area_is_that_in_plan() {
        let deck = |x: (f64, f64), y: (f64, f64), z: (f64, f64)| part(Element::RcDeck, x, y, z);
        let parts = [
            deck((0.0, 20.0), (-0.3, 0.3), (-0.4, -0.2)),
            deck((0.0, 10.0), (-5.0, 5.0), (-0.2, 0.0)),
            deck((10.0, 20.0), (-5.0, 5.0), (-0.2, 0.0)),
        ];
        assert!((total(&parts) - 200.0).abs() < ROUNDING_M, "{:?}", amounts(&parts));
    }

    #[test]
    fn exact_stays_and_counted_elements_count_each() {
        let stay = |to: f64| part(Element::MainCable, (0.0, to), (-0.1, 0.1), (0.0, 20.0));
        assert_eq!(amounts(&[stay(30.0), stay(20.0)]), [30.0, 20.0]);
        let column = part(Element::RcColumn, (0.0, 1.0), (0.0, 1.0), (0.0, 9.0));
        assert_eq!(amounts(&[column, column]), [1.0, 1.0]);
        assert_eq!(amounts(&[part(Element::SteelTower, (0.0, 3.0), (0.0, 3.0), (0.0, 40.0))]), [40.0]);
    }
}
