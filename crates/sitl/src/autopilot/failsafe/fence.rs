//! Geofence: zones, and the state for telemetry.

use spandrel_model::time::SimTime;

/// Outline of a zone, north and east relative to the origin, m.
#[derive(Debug, Clone, PartialEq)]
pub enum FenceOutline {
    /// Corners in order; the last connects to the first.
    Polygon(Vec<(f64, f64)>),
    /// A circle.
    Circle {
        /// Center, north and east, m.
        center_m: (f64, f64),
        /// Radius, m.
        radius_m: f64,
    },
}

impl FenceOutline {
    /// Returns true if a point is inside the outline.
    #[must_use]
    pub fn contains(&self, (n, e): (f64, f64)) -> bool {
        match self {
            Self::Circle { center_m, radius_m } => {
                let (dn, de) = (n - center_m.0, e - center_m.1);
                dn * dn + de * de <= radius_m * radius_m
            }
            // From a point inside, a ray to the east crosses the outline an odd number of times.
            Self::Polygon(corners) => {
                let last = corners.len().saturating_sub(1);
                let sides = corners.iter().enumerate().map(|(k, to)| (corners[if k == 0 { last } else { k - 1 }], *to));
                sides.filter(|(a, b)| (a.0 > n) != (b.0 > n) && e < (b.1 - a.1) * (n - a.0) / (b.0 - a.0) + a.1).count() % 2 == 1
            }
        }
    }

    /// Intersections of a straight path with the outline, as fractions of the path length.
    fn crossings(&self, from: (f64, f64), to: (f64, f64)) -> Vec<f64> {
        let path = (to.0 - from.0, to.1 - from.1);
        match self {
            Self::Circle { center_m, radius_m } => {
                let off = (from.0 - center_m.0, from.1 - center_m.1);
                let (a, b) = (path.0 * path.0 + path.1 * path.1, off.0 * path.0 + off.1 * path.1);
                let root = b * b - a * (off.0 * off.0 + off.1 * off.1 - radius_m * radius_m);
                if a > 0.0 && root > 0.0 { vec![(-b - root.sqrt()) / a, (-b + root.sqrt()) / a] } else { Vec::new() }
            }
            Self::Polygon(corners) => {
                let last = corners.len().saturating_sub(1);
                let sides = corners.iter().enumerate().map(|(k, end)| (corners[if k == 0 { last } else { k - 1 }], *end));
                let cross = |a: (f64, f64), b: (f64, f64)| a.0 * b.1 - a.1 * b.0;
                let meet = |(start, end): ((f64, f64), (f64, f64))| {
                    let (side, gap) = ((end.0 - start.0, end.1 - start.1), (start.0 - from.0, start.1 - from.1));
                    let d = cross(path, side);
                    // A side parallel to the path has no single intersection; the midpoint of the section along it is tested
                    // instead.
                    let share = cross(gap, path) / d;
                    (d != 0.0 && (0.0..=1.0).contains(&share)).then(|| cross(gap, side) / d)
                };
                sides.filter_map(meet).collect()
            }
        }
    }
}

/// One zone of the geofence.
#[derive(Debug, Clone, PartialEq)]
pub struct FenceZone {
    /// Outline of the zone.
    pub outline: FenceOutline,
    /// Inclusion or exclusion zone. Flight is allowed inside at least one inclusion zone, if there are any, and outside all
    /// exclusion zones.
    pub inclusion: bool,
}

/// Breached limit, with the values of MAVLink's FENCE_BREACH enum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breach {
    /// Minimum height above home (1).
    Floor,
    /// Maximum height above home (2).
    Height,
    /// Zone boundary or maximum distance from home (3).
    Boundary,
}

/// Geofence state for telemetry.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FenceState {
    /// Whether any limit is active.
    pub set: bool,
    /// The current breach.
    pub breach: Option<Breach>,
    /// Number of breaches so far.
    pub count: u16,
    /// Number of breaches that changed the mode.
    pub taken: u16,
    /// Start time of the last breach.
    pub at: SimTime,
}

/// Geofence zones.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fence {
    zones: Vec<FenceZone>,
}

impl Fence {
    /// Replaces the zones.
    pub fn set_zones(&mut self, zones: Vec<FenceZone>) {
        self.zones = zones;
    }

    /// Returns true if there are no zones.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.zones.is_empty()
    }

    /// Returns true if all zones allow a position.
    #[must_use]
    pub fn allows(&self, position_m: (f64, f64)) -> bool {
        let mut inclusions = self.zones.iter().filter(|zone| zone.inclusion).peekable();
        let within = inclusions.peek().is_none() || inclusions.any(|zone| zone.outline.contains(position_m));
        within && !self.zones.iter().any(|zone| !zone.inclusion && zone.outline.contains(position_m))
    }

    /// Returns true if all zones allow an entire straight path.
    #[must_use]
    pub fn allows_path(&self, from_m: (f64, f64), to_m: (f64, f64)) -> bool {
        let mut cuts: Vec<f64> = self.zones.iter().flat_map(|zone| zone.outline.crossings(from_m, to_m)).collect();
        cuts.retain(|cut| (0.0..1.0).contains(cut));
        cuts.extend([0.0, 1.0]);
        cuts.sort_by(f64::total_cmp);
        // Between two intersections, a path is entirely inside or outside.
        cuts.windows(2).filter(|pair| pair[1] - pair[0] > 1e-9).all(|pair| {
            let middle = 0.5 * (pair[0] + pair[1]);
            let at = |a: f64, b: f64| a + middle * (b - a);
            self.allows((at(from_m.0, to_m.0), at(from_m.1, to_m.1)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(half: f64) -> FenceOutline {
        FenceOutline::Polygon(vec![(-half, -half), (-half, half), (half, half), (half, -half)])
    }

    #[test]
    fn exact_zones_contain_interior_points() {
        let notched = FenceOutline::Polygon(vec![(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (5.0, 5.0), (0.0, 10.0)]);
        for (place, within) in
            [((2.0, 2.0), true), ((5.0, 4.0), true), ((5.0, 6.0), false), ((-1.0, 5.0), false), ((11.0, 1.0), false)]
        {
            assert_eq!(notched.contains(place), within, "{place:?}");
        }
        let circle = FenceOutline::Circle { center_m: (3.0, 4.0), radius_m: 5.0 };
        assert!(circle.contains((0.0, 0.0)) && !circle.contains((-0.01, 0.0)));
    }

    #[test]
    fn exact_path_is_allowed_only_if_entirely_inside() {
        let zone = |outline, inclusion| FenceZone { outline, inclusion };
        let circle = |n, radius_m| FenceOutline::Circle { center_m: (n, 0.0), radius_m };
        let fence = Fence {
            // Two overlapping zones, a hole in one of them, and a separate third zone.
            zones: vec![
                zone(square(10.0), true),
                zone(circle(15.0, 8.0), true),
                zone(circle(60.0, 5.0), true),
                zone(circle(0.0, 2.0), false),
            ],
        };
        for (from, to, allowed) in [
            ((-5.0, 5.0), (5.0, 5.0), true),
            ((-5.0, 0.0), (5.0, 0.0), false),
            ((-5.0, 2.5), (20.0, 1.0), true),
            ((20.0, 0.0), (60.0, 0.0), false),
            ((9.0, 9.5), (15.0, 7.5), false),
            ((5.0, 5.0), (5.0, 5.0), true),
            ((0.0, 0.0), (0.0, 0.0), false),
        ] {
            assert_eq!(fence.allows_path(from, to), allowed, "{from:?} to {to:?}");
        }
        assert!(Fence::default().allows_path((0.0, 0.0), (1e6, 0.0)));
    }

    #[test]
    fn exact_flight_requires_inclusion_zone_and_no_exclusion_zone() {
        let zone = |outline, inclusion| FenceZone { outline, inclusion };
        let circle = |n, radius_m| FenceOutline::Circle { center_m: (n, 0.0), radius_m };
        let fence =
            Fence { zones: vec![zone(square(10.0), true), zone(circle(100.0, 5.0), true), zone(circle(0.0, 2.0), false)] };
        for (place, allowed) in [((5.0, 5.0), true), ((0.0, 0.0), false), ((50.0, 0.0), false), ((100.0, 0.0), true)] {
            assert_eq!(fence.allows(place), allowed, "{place:?}");
        }
        assert!(Fence::default().allows((1e6, 0.0)), "every position is allowed without zones");
    }
}
