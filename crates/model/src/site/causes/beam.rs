//! Bending moments and shear forces of a continuous beam on supports of equal height, under a uniform load of 1 N/m.

/// A beam with one or more supports; its ends may cantilever.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ContinuousBeam {
    ends_m: (f64, f64),
    supports_m: Vec<f64>,
    /// Moments at the supports, Nm.
    support_moments: Vec<f64>,
}

/// Largest sagging and hogging moment, Nm, and largest shear force, N; all at least 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Peaks {
    pub(super) sagging: f64,
    pub(super) hogging: f64,
    pub(super) shear: f64,
}

/// Minimum ratio of the smaller to the larger of the two peaks. A smaller one, such as that of a short overhang, leaves the concrete
/// uncracked (estimate).
const MIN_PEAK_RATIO: f64 = 0.2;

impl Peaks {
    /// Returns a moment as a share of the largest moment of the same sign, 0 to 1; 0 if that one is small.
    pub(super) fn share(&self, moment: f64) -> f64 {
        let (own, other) = if moment > 0.0 { (self.sagging, self.hogging) } else { (self.hogging, self.sagging) };
        if own <= MIN_PEAK_RATIO * other { 0.0 } else { moment.abs() / own }
    }
}

/// Minimum distance of a contraflexure from the supports, as a share of the span. A short overhang has one right beside its support,
/// which is no place for a splice (estimate).
const MIN_CONTRAFLEXURE_SHARE: f64 = 0.05;

/// Number of positions at which the peaks are searched for.
const PEAK_STEPS: i32 = 400;

impl ContinuousBeam {
    /// Creates a beam. `supports_m` must be in ascending order within the ends. `None` if the beam has no supports.
    pub(super) fn new(ends_m: (f64, f64), supports_m: Vec<f64>) -> Option<Self> {
        let (first, last) = (*supports_m.first()?, *supports_m.last()?);
        let cantilever = |length_m: f64| -0.5 * length_m * length_m;
        let (start, end) = (cantilever(first - ends_m.0), cantilever(ends_m.1 - last));
        let support_moments = if supports_m.len() == 1 { vec![start.min(end)] } else { three_moments(&supports_m, start, end) };
        Some(Self { ends_m, supports_m, support_moments })
    }

    /// Returns the span that contains a position: number, start and length.
    fn span(&self, x_m: f64) -> Option<(usize, f64, f64)> {
        let k = self.supports_m.windows(2).position(|pair| (pair[0]..=pair[1]).contains(&x_m))?;
        Some((k, self.supports_m[k], self.supports_m[k + 1] - self.supports_m[k]))
    }

    /// Returns the bending moment, Nm; positive if the lower side is in tension.
    pub(super) fn moment(&self, x_m: f64) -> f64 {
        let Some((k, start_m, length_m)) = self.span(x_m) else {
            let free_m = if x_m < self.supports_m[0] { x_m - self.ends_m.0 } else { self.ends_m.1 - x_m };
            return -0.5 * free_m * free_m;
        };
        let t = (x_m - start_m) / length_m;
        let ends = self.support_moments[k] * (1.0 - t) + self.support_moments[k + 1] * t;
        ends + 0.5 * length_m * length_m * t * (1.0 - t)
    }

    /// Returns the shear force, N: the derivative of the moment.
    pub(super) fn shear(&self, x_m: f64) -> f64 {
        let Some((k, start_m, length_m)) = self.span(x_m) else {
            return if x_m < self.supports_m[0] { self.ends_m.0 - x_m } else { self.ends_m.1 - x_m };
        };
        let t = (x_m - start_m) / length_m;
        (self.support_moments[k + 1] - self.support_moments[k]) / length_m + length_m * (0.5 - t)
    }

    /// Returns the distance to the nearest support, m.
    pub(super) fn to_support_m(&self, x_m: f64) -> f64 {
        self.supports_m.iter().map(|support| (x_m - support).abs()).fold(f64::INFINITY, f64::min)
    }

    /// Returns the largest moments and the largest shear force.
    pub(super) fn peaks(&self) -> Peaks {
        let at = |k: i32| self.ends_m.0 + (self.ends_m.1 - self.ends_m.0) * f64::from(k) / f64::from(PEAK_STEPS);
        let mut peaks = Peaks::default();
        for x_m in (0..=PEAK_STEPS).map(at).chain(self.supports_m.iter().copied()) {
            peaks.sagging = peaks.sagging.max(self.moment(x_m));
            peaks.hogging = peaks.hogging.max(-self.moment(x_m));
            peaks.shear = peaks.shear.max(self.shear(x_m).abs());
        }
        peaks
    }

    /// Returns the positions in the spans where the moment changes its sign, except right beside the supports.
    pub(super) fn contraflexures_m(&self) -> Vec<f64> {
        let mut out = Vec::new();
        for (k, pair) in self.supports_m.windows(2).enumerate() {
            let (length_m, a, b) = (pair[1] - pair[0], self.support_moments[k], self.support_moments[k + 1]);
            // a (1 - t) + b t + L²/2 t (1 - t) = 0.
            let half_square = 0.5 * length_m * length_m;
            let linear = b - a + half_square;
            let square = linear * linear + 4.0 * half_square * a;
            // A short span between long ones hogs throughout.
            if square <= 0.0 {
                continue;
            }
            let root = square.sqrt();
            let zeros = [-1.0, 1.0].map(|sign| (linear + sign * root) / (2.0 * half_square));
            let is_inside = |t: &f64| (MIN_CONTRAFLEXURE_SHARE..=1.0 - MIN_CONTRAFLEXURE_SHARE).contains(t);
            out.extend(zeros.into_iter().filter(is_inside).map(|t| pair[0] + t * length_m));
        }
        out
    }

    /// Returns the start and the length of each span, m.
    pub(super) fn spans_m(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.supports_m.windows(2).map(|pair| (pair[0], pair[1] - pair[0]))
    }
}

/// Solves Clapeyron's equation of three moments: M₋ L₁ + 2 M (L₁ + L₂) + M₊ L₂ = -(L₁³ + L₂³)/4.
fn three_moments(supports_m: &[f64], start: f64, end: f64) -> Vec<f64> {
    let lengths: Vec<f64> = supports_m.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let inner = lengths.len() - 1;
    // Elimination of a tridiagonal system: each row as (factor of the next moment, right side).
    let mut rows: Vec<(f64, f64)> = Vec::with_capacity(inner);
    for k in 0..inner {
        let (l1, l2) = (lengths[k], lengths[k + 1]);
        let mut right = -0.25 * (l1 * l1 * l1 + l2 * l2 * l2);
        right -= if k + 1 == inner { end * l2 } else { 0.0 };
        let (before_factor, before_right) = rows.last().copied().unwrap_or((0.0, start));
        let diagonal = 2.0 * (l1 + l2) - l1 * before_factor;
        let next = if k + 1 == inner { 0.0 } else { l2 / diagonal };
        rows.push((next, (right - l1 * before_right) / diagonal));
    }
    let mut out = vec![end];
    for (next, right) in rows.into_iter().rev() {
        out.push(right - next * out[out.len() - 1]);
    }
    out.push(start);
    out.reverse();
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tolerance of moments and forces for rounding, Nm and N.
    const ROUNDING: f64 = 1e-9;

    fn close(got: f64, expected: f64) {
        assert!((got - expected).abs() < ROUNDING, "{got}, expected {expected}");
    }

    #[test]
    fn val_moments_match_the_tables_for_equal_spans() {
        // AISC Steel Construction Manual, table 3-22c (moments in w l²): two spans: -0.125 at the support, 0.0703 in the span; three
        // spans: -0.1, 0.08 in the end spans and 0.025 in the middle.
        let two = ContinuousBeam::new((0.0, 20.0), vec![0.0, 10.0, 20.0]).unwrap();
        close(two.moment(10.0), -12.5);
        close(two.moment(3.75), 100.0 * 9.0 / 128.0);
        let three = ContinuousBeam::new((0.0, 30.0), vec![0.0, 10.0, 20.0, 30.0]).unwrap();
        close(three.moment(10.0), -10.0);
        close(three.moment(4.0), 8.0);
        close(three.moment(15.0), 2.5);
        close(three.shear(0.0), 4.0);
    }

    #[test]
    fn exact_simple_beams_and_cantilevers() {
        let simple = ContinuousBeam::new((0.0, 8.0), vec![0.0, 8.0]).unwrap();
        close(simple.moment(4.0), 8.0);
        close(simple.shear(8.0), -4.0);
        assert_eq!(simple.contraflexures_m(), Vec::<f64>::new());
        let hammerhead = ContinuousBeam::new((-3.0, 3.0), vec![0.0]).unwrap();
        close(hammerhead.moment(0.0), -4.5);
        close(hammerhead.shear(-1.0), -2.0);
        let overhang = ContinuousBeam::new((-2.0, 12.0), vec![0.0, 10.0]).unwrap();
        close(overhang.moment(0.0), -2.0);
        close(overhang.moment(5.0), 12.5 - 2.0);
        assert_eq!(ContinuousBeam::new((0.0, 1.0), vec![]), None);
    }

    #[test]
    fn regress_a_short_span_that_hogs_throughout_has_no_contraflexure() {
        let beam = ContinuousBeam::new((0.0, 70.0), vec![0.0, 30.0, 40.0, 70.0]).unwrap();
        assert!(beam.moment(35.0) < 0.0);
        let zeros = beam.contraflexures_m();
        assert_eq!(zeros.len(), 2, "{zeros:?}");
        assert!(zeros.iter().all(|x_m| beam.moment(*x_m).abs() < 1e-6 && !(30.0..40.0).contains(x_m)), "{zeros:?}");
    }

    #[test]
    fn prop_shear_is_the_slope_of_the_moment_and_contraflexures_have_none() {
        const STEP_M: f64 = 1e-4;
        /// Tolerance for the difference quotient of a parabola, N.
        const QUOTIENT: f64 = 1e-6;
        let beam = ContinuousBeam::new((-1.0, 47.0), vec![0.0, 12.0, 30.0, 45.0]).unwrap();
        for k in 0..96 {
            let x = -0.9 + 0.5 * f64::from(k);
            let slope = (beam.moment(x + STEP_M) - beam.moment(x - STEP_M)) / (2.0 * STEP_M);
            assert!((slope - beam.shear(x)).abs() < QUOTIENT, "{x}");
        }
        let zeros = beam.contraflexures_m();
        assert!(zeros.len() >= 4, "{zeros:?}");
        for x in zeros {
            close(beam.moment(x), 0.0);
        }
    }
}
