//! A rendered picture.

/// Pixels in row-major order from the upper left, 8-bit sRGB with alpha.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Width, px.
    pub width: u32,
    /// Height, px.
    pub height: u32,
    /// Four bytes per pixel.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// Returns the red, green, and blue values of a pixel; black outside the picture.
    #[must_use]
    pub fn at(&self, x: u32, y: u32) -> [u8; 3] {
        let k = 4 * (y as usize * self.width as usize + x as usize);
        match self.rgba.get(k..k + 3) {
            Some(&[r, g, b]) if x < self.width => [r, g, b],
            _ => [0; 3],
        }
    }

    /// Returns the mean luma (0..255) of a rectangle, clipped to the picture.
    #[must_use]
    pub fn luma(&self, (left, top): (u32, u32), (right, bottom): (u32, u32)) -> f64 {
        let mut sum = 0.0;
        let mut count = 0.0;
        for y in top..bottom.min(self.height) {
            for x in left..right.min(self.width) {
                let [r, g, b] = self.at(x, y).map(f64::from);
                sum += 0.2126 * r + 0.7152 * g + 0.0722 * b;
                count += 1.0;
            }
        }
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// Scales the picture down to a width of at most `most_px` by averaging. Returns smaller pictures unchanged.
    #[must_use]
    pub fn scaled_to_width(&self, most_px: u32) -> Self {
        if self.width <= most_px {
            return self.clone();
        }
        let part = |k: u32, of: u32, whole: u32| (u64::from(whole) * u64::from(k) / u64::from(of)) as u32;
        let width = most_px.max(1);
        let height = part(width, self.width, self.height).max(1);
        let corner = |x: u32, y: u32| (part(x, width, self.width), part(y, height, self.height));
        let rgba = (0..height).flat_map(|y| (0..width).flat_map(move |x| self.mean(corner(x, y), corner(x + 1, y + 1))));
        Self { width, height, rgba: rgba.collect() }
    }

    /// Turns and mirrors the stored pixels of a photograph upright. `orientation` is its EXIF orientation, 1 to 8 (EXIF 2.32,
    /// section 4.6.4); any other number is treated as 1.
    #[must_use]
    pub fn upright(self, orientation: u16) -> Self {
        let (right, bottom) = (self.width.saturating_sub(1), self.height.saturating_sub(1));
        let from = move |x: u32, y: u32| match orientation {
            2 => (right - x, y),
            3 => (right - x, bottom - y),
            4 => (x, bottom - y),
            5 => (y, x),
            6 => (y, bottom - x),
            7 => (right - y, bottom - x),
            8 => (right - y, x),
            _ => (x, y),
        };
        if !(2..=8).contains(&orientation) {
            return self;
        }
        let (width, height) = if orientation > 4 { (self.height, self.width) } else { (self.width, self.height) };
        let pixel = |(x, y): (u32, u32)| {
            let at = 4 * (y as usize * self.width as usize + x as usize);
            self.rgba.get(at..at + 4).unwrap_or(&[0; 4])
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let rgba = pixels.flat_map(|(x, y)| pixel(from(x, y))).copied().collect();
        Self { width, height, rgba }
    }

    /// Returns the mean color of a rectangle.
    fn mean(&self, (left, top): (u32, u32), (right, bottom): (u32, u32)) -> [u8; 4] {
        let (mut sums, mut count) = ([0_u32; 3], 0);
        for (x, y) in (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y))) {
            let pixel = self.at(x, y);
            sums.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += u32::from(value));
            count += 1;
        }
        let [r, g, b] = sums.map(|sum| ((sum + count / 2) / count.max(1)) as u8);
        [r, g, b, u8::MAX]
    }

    /// Returns the mean absolute difference per channel (0..255), or `None` if the sizes differ.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<f64> {
        if (self.width, self.height) != (other.width, other.height) || self.rgba.is_empty() {
            return None;
        }
        let sum: f64 = self.rgba.iter().zip(&other.rgba).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
        // The alpha channel is constant.
        Some(sum / (0.75 * self.rgba.len() as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_difference_and_luma_are_averages() {
        let grey = |v: u8| Picture { width: 2, height: 1, rgba: vec![v, v, v, 255, v, v, v, 255] };
        assert_eq!(grey(10).difference(&grey(13)), Some(3.0));
        assert_eq!(grey(10).difference(&Picture { width: 1, height: 1, rgba: vec![0; 4] }), None);
        assert!((grey(40).luma((0, 0), (9, 9)) - 40.0).abs() < 1e-9);
        assert_eq!(grey(7).at(1, 0), [7, 7, 7]);
        assert_eq!(grey(7).at(2, 0), [0, 0, 0]);
    }

    #[test]
    fn exact_photographs_are_turned_upright() {
        let picture = |width: u32, values: &[u8]| Picture {
            width,
            height: values.len() as u32 / width,
            rgba: values.iter().flat_map(|value| [*value; 4]).collect(),
        };
        // The picture of the EXIF standard: its first row and first column, for each orientation.
        let upright = picture(2, &[1, 2, 3, 4, 5, 6]);
        for (orientation, width, stored) in [
            (1, 2, [1, 2, 3, 4, 5, 6]),
            (2, 2, [2, 1, 4, 3, 6, 5]),
            (3, 2, [6, 5, 4, 3, 2, 1]),
            (4, 2, [5, 6, 3, 4, 1, 2]),
            (5, 3, [1, 3, 5, 2, 4, 6]),
            (6, 3, [2, 4, 6, 1, 3, 5]),
            (7, 3, [6, 4, 2, 5, 3, 1]),
            (8, 3, [5, 3, 1, 6, 4, 2]),
            (9, 2, [1, 2, 3, 4, 5, 6]),
        ] {
            assert_eq!(picture(width, &stored).upright(orientation), upright, "orientation {orientation}");
        }
    }

    #[test]
    fn exact_downscaling_averages_pixels() {
        let value = |k: u32| 10 * k as u8;
        let rgba = (0..20).flat_map(|k| [value(k), 0, 200, 255]).collect();
        let wide = Picture { width: 5, height: 4, rgba };
        assert_eq!(wide.scaled_to_width(5), wide);
        let small = wide.scaled_to_width(2);
        // Averages columns 0 and 1, then columns 2 to 4; merges the four rows into one.
        assert_eq!((small.width, small.height), (2, 1));
        assert_eq!([small.at(0, 0), small.at(1, 0)], [[80, 0, 200], [105, 0, 200]]);
        assert_eq!(wide.scaled_to_width(0).rgba.len(), 4);
    }
}
