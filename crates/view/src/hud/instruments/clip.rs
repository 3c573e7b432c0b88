//! Clips drawings to the rectangle of an instrument.

use super::area::Area;

type Point = (f64, f64);

/// Returns the part of a convex polygon inside a rectangle (Sutherland and Hodgman); empty if there is none.
pub(super) fn clip_polygon(polygon: &[Point], area: Area) -> Vec<Point> {
    let (right, bottom) = area.corner();
    let inside: [&dyn Fn(Point) -> f64; 4] = [&|p| p.0 - area.x, &|p| right - p.0, &|p| p.1 - area.y, &|p| bottom - p.1];
    inside.into_iter().fold(polygon.to_vec(), |polygon, depth| clip_at(&polygon, depth))
}

/// Returns the part of a convex polygon where `depth` is not negative.
pub(super) fn clip_at(polygon: &[Point], depth: &dyn Fn(Point) -> f64) -> Vec<Point> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, to) in polygon.iter().enumerate() {
        let from = polygon[(k + polygon.len() - 1) % polygon.len()];
        let (a, b) = (depth(from), depth(*to));
        if (a < 0.0) != (b < 0.0) {
            let share = a / (a - b);
            kept.push((from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1)));
        }
        if b >= 0.0 {
            kept.push(*to);
        }
    }
    kept
}

/// Returns the nearest position inside a rectangle.
pub(super) fn clamp_point((x, y): Point, area: Area) -> Point {
    let (right, bottom) = area.corner();
    (x.clamp(area.x, right), y.clamp(area.y, bottom))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_polygons_are_cut_at_the_edges() {
        let area = Area { x: 0.0, y: 0.0, width: 10.0, height: 10.0 };
        let cut = clip_polygon(&[(-5.0, 2.0), (5.0, 2.0), (5.0, 4.0), (-5.0, 4.0)], area);
        let (low, high) = cut.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.0), high.max(p.0)));
        assert_eq!((cut.len(), low, high), (4, 0.0, 5.0));
        assert!(clip_polygon(&[(-5.0, 2.0), (-1.0, 2.0), (-1.0, 4.0)], area).is_empty());
        let whole = [(1.0, 1.0), (2.0, 1.0), (2.0, 2.0)];
        assert_eq!(clip_polygon(&whole, area), whole);
        assert_eq!(clamp_point((-3.0, 4.0), area), (0.0, 4.0));
    }
}
