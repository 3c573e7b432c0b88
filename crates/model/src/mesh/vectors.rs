//! Vector arithmetic on points of a mesh.

/// A point or a vector, m.
pub type Point = [f64; 3];

/// Maximum distance of a vertex from the origin of the file, in units of the file.
const MAX_COORDINATE: f64 = 1e7;

/// Returns a - b.
#[must_use]
pub fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Returns a + b * share.
#[must_use]
pub fn add_scaled(a: Point, b: Point, share: f64) -> Point {
    [a[0] + b[0] * share, a[1] + b[1] * share, a[2] + b[2] * share]
}

/// Returns the dot product.
#[must_use]
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the cross product.
#[must_use]
pub fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the length.
#[must_use]
pub fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// Returns the unit vector; `None` for a vector without a direction.
#[must_use]
pub fn unit(a: Point) -> Option<Point> {
    let length = norm(a);
    (length > 0.0 && length.is_finite()).then(|| a.map(|value| value / length))
}

/// Returns two unit vectors across an axis (a unit vector) and each other, so that a counterclockwise turn about the axis goes from the first
/// to the second.
#[must_use]
pub fn across(axis: Point) -> [Point; 2] {
    let helper = if axis[0].abs() > 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
    // The helper is never parallel to a unit vector.
    let u = unit(cross(helper, axis)).unwrap_or([0.0, 0.0, 1.0]);
    [u, cross(axis, u)]
}

/// Returns the corners of the bounding box of points; `None` if there are none.
#[must_use]
pub fn bounds(points: impl Iterator<Item = Point>) -> Option<(Point, Point)> {
    points.fold(None, |so_far, p| {
        let (low, high) = so_far.unwrap_or((p, p));
        Some(([0, 1, 2].map(|k: usize| low[k].min(p[k])), [0, 1, 2].map(|k: usize| high[k].max(p[k]))))
    })
}

/// Returns the mean of points.
#[must_use]
pub fn middle(points: &[Point]) -> Point {
    let sum = points.iter().fold([0.0; 3], |sum, p| add_scaled(sum, *p, 1.0));
    sum.map(|value| value / points.len().max(1) as f64)
}

/// Returns the normal of a planar polygon, twice as long as its area.
#[must_use]
pub fn polygon_area_vector(corners: &[Point]) -> Point {
    (2..corners.len())
        .fold([0.0; 3], |sum, k| add_scaled(sum, cross(sub(corners[k - 1], corners[0]), sub(corners[k], corners[0])), 1.0))
}

/// Checks the coordinates of a vertex.
///
/// # Errors
/// Returns the vertex and the allowed coordinates if one is too large or no number.
pub(super) fn check_vertex(number: usize, vertex: Point) -> Result<(), String> {
    if vertex.iter().all(|value| value.abs() <= MAX_COORDINATE) {
        Ok(())
    } else {
        Err(format!("position {number} = {vertex:?} (allowed: numbers of at most {MAX_COORDINATE:.0})"))
    }
}
