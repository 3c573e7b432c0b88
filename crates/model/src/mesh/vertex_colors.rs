//! Colors of vertices: red, green and blue from 0 to 255, linear in the light. Files with colors for screens are decoded (sRGB).

use super::vectors::Point;
use crate::math;

/// Color of a vertex.
pub type Color = [u8; 3];

/// Returns the linear share of the light for a value of an sRGB picture from 0 to 1 (IEC 61966-2-1).
fn linear(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { math::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// Returns a color from linear shares of the light; values outside of 0 to 1 are clamped.
#[must_use]
pub fn of_linear(shares: [f64; 3]) -> Color {
    shares.map(|share| (255.0 * share.clamp(0.0, 1.0)).round() as u8)
}

/// Returns a color from sRGB values from 0 to 1; values outside are clamped.
#[must_use]
pub fn of_srgb(encoded: [f64; 3]) -> Color {
    of_linear(encoded.map(|value| linear(value.clamp(0.0, 1.0))))
}

/// Finds the color of a vertex by its place.
#[derive(Debug)]
pub struct ColorsByPlace(Vec<([u64; 3], Color)>);

impl ColorsByPlace {
    /// Creates the table. Of several vertices at a place, the first one counts.
    #[must_use]
    pub fn new(vertices_m: &[Point], colors: &[Color]) -> Self {
        let mut table: Vec<([u64; 3], Color)> =
            vertices_m.iter().zip(colors).map(|(vertex, color)| (place(*vertex), *color)).collect();
        table.sort_by_key(|(place, _)| *place);
        table.dedup_by_key(|(place, _)| *place);
        Self(table)
    }

    /// Returns the colors of vertices; empty if one of them is unknown.
    #[must_use]
    pub fn colors(&self, vertices_m: &[Point]) -> Vec<Color> {
        let find = |vertex: &Point| self.0.binary_search_by_key(&place(*vertex), |(place, _)| *place).ok().map(|k| self.0[k].1);
        vertices_m.iter().map(find).collect::<Option<Vec<Color>>>().unwrap_or_default()
    }
}

fn place(vertex: Point) -> [u64; 3] {
    // Adding zero turns a negative zero into a positive one.
    vertex.map(|value| (value + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_srgb_values_are_decoded() {
        // Mid gray on a screen, 188 of 255, is half of the light.
        assert_eq!(of_srgb([188.0 / 255.0, 0.0, 1.0]), [128, 0, 255]);
        assert_eq!(of_srgb([-1.0, 2.0, f64::NAN]), [0, 255, 0]);
    }

    #[test]
    fn exact_colors_are_found_by_place() {
        let table = ColorsByPlace::new(&[[0.0, 1.0, 2.0], [-0.0, 1.0, 2.0], [3.0; 3]], &[[1; 3], [2; 3], [3; 3]]);
        assert_eq!(table.colors(&[[3.0; 3], [0.0, 1.0, 2.0]]), [[3; 3], [1; 3]]);
        assert_eq!(table.colors(&[[3.0; 3], [4.0; 3]]), Vec::<Color>::new());
    }
}
