//! The path that the aircraft has flown, for the large map.

use spandrel_model::frames::{Enu, Vec3};

/// Smallest distance between two points at first, m: finer than a pixel of the large map.
const FIRST_SPACING_M: f64 = 1.0;
/// Distance between two samples, m, from which the aircraft has not flown there: a respawn or a rewind. Samples arrive at 50 Hz, so
/// that even a flight at 30 m/s with a loss of 10 samples stays below it.
const JUMP_M: f64 = 6.0;
/// Largest number of points. When it is reached, every second point goes.
const MAX_POINTS: usize = 2_000;

/// The path that the aircraft has flown.
#[derive(Debug, Clone, PartialEq)]
pub struct FlownPath {
    /// Parts without a jump, in the order of the flight. Each has at least one point.
    parts: Vec<Vec<Vec3<Enu>>>,
    last_m: Option<Vec3<Enu>>,
    spacing_m: f64,
}

impl Default for FlownPath {
    fn default() -> Self {
        Self { parts: Vec::new(), last_m: None, spacing_m: FIRST_SPACING_M }
    }
}

impl FlownPath {
    /// Adds a position.
    pub fn push(&mut self, position_m: Vec3<Enu>) {
        let jumped = self.last_m.replace(position_m).is_none_or(|last_m| (position_m - last_m).norm() > JUMP_M);
        match self.parts.last_mut().filter(|_| !jumped) {
            Some(part) => {
                if part.last().is_none_or(|last_m| (position_m - *last_m).norm() >= self.spacing_m) {
                    part.push(position_m);
                }
            }
            None => self.parts.push(vec![position_m]),
        }
        if self.count() > MAX_POINTS {
            self.thin_out();
        }
    }

    /// Returns the parts of the path without a jump, in the order of the flight, up to the latest position.
    pub fn parts(&self) -> impl Iterator<Item = Vec<Vec3<Enu>>> {
        let newest = self.parts.len().saturating_sub(1);
        self.parts
            .iter()
            .enumerate()
            .map(move |(k, part)| part.iter().copied().chain(self.last_m.filter(|_| k == newest)).collect())
    }

    fn count(&self) -> usize {
        self.parts.iter().map(Vec::len).sum()
    }

    /// Drops the oldest parts if there are only jumps, otherwise every second point.
    fn thin_out(&mut self) {
        self.spacing_m *= 2.0;
        for part in &mut self.parts {
            *part = part.iter().copied().step_by(2).collect();
        }
        let surplus = self.parts.len().saturating_sub(MAX_POINTS / 2);
        self.parts.drain(..surplus);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(path: &mut FlownPath, from_m: f64, to_m: f64) {
        let steps = ((to_m - from_m).abs() / 0.2).round();
        for k in 0..=steps as u32 {
            path.push(Vec3::new(from_m + (to_m - from_m) * f64::from(k) / steps, 0.0, 10.0));
        }
    }

    #[test]
    fn exact_a_jump_begins_a_new_part_and_the_path_ends_at_the_aircraft() {
        let mut path = FlownPath::default();
        along(&mut path, 0.0, 50.3);
        along(&mut path, 20.0, 30.0);
        let parts: Vec<_> = path.parts().collect();
        let ends: Vec<(f64, f64)> = parts.iter().map(|part| (part[0].east(), part[part.len() - 1].east())).collect();
        assert_eq!((ends.len(), ends[0].0, ends[1]), (2, 0.0, (20.0, 30.0)));
        assert!(50.3 - ends[0].1 < FIRST_SPACING_M, "{ends:?}");
        assert_eq!(FlownPath::default().parts().count(), 0);
    }

    #[test]
    fn prop_a_long_flight_has_few_points_that_are_nowhere_far_apart() {
        let mut path = FlownPath::default();
        for _ in 0..30 {
            along(&mut path, 0.0, 400.0);
            along(&mut path, 400.0, 0.0);
        }
        let parts: Vec<_> = path.parts().collect();
        assert_eq!(parts.len(), 1);
        assert!((MAX_POINTS / 3..=MAX_POINTS + 1).contains(&parts[0].len()), "{}", parts[0].len());
        let widest_m = parts[0].windows(2).map(|pair| (pair[1] - pair[0]).norm()).fold(0.0, f64::max);
        // 24 km in 2,000 points are 12 m each; the spacing is a power of two above it, and each turn and thinning may add one.
        assert!(widest_m < 40.0, "{widest_m} m");
    }

    #[test]
    fn prop_many_jumps_do_not_fill_the_memory() {
        let mut path = FlownPath::default();
        for k in 0..10 * MAX_POINTS {
            path.push(Vec3::new(100.0 * (k % 2) as f64, 0.0, 0.0));
        }
        assert!(path.parts().count() <= MAX_POINTS, "{}", path.parts().count());
    }
}
