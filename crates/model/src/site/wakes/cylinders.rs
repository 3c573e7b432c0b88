//! Drag and vortex shedding of cylinders across the wind, from measurements: square and rectangular sections with sharp edges, and
//! smooth round ones, whose shedding depends on the Reynolds number.

use crate::math;

/// Kinematic viscosity of air at 15 °C, m²/s (ISO 2533: 1.461e-5).
pub(super) const AIR_VISCOSITY_M2_S: f64 = 1.461e-5;
/// Ratio of a rectangle's length along the wind to its width across it, Strouhal number by the width, and drag coefficient. Square: Lyn
/// et al. 1995 (0.132 ± 0.004, 2.1). 5:1: BARC (ERCOFTAC UFR 2-15: about 0.111 and 1.03). The others: Okajima (Journal of Fluid
/// Mechanics 123, 1982) and Norberg (Journal of Wind Engineering 49, 1993), rounded; constants not confirmed.
const RECTANGLES: [[f64; 3]; 6] =
    [[0.2, 0.145, 2.2], [0.6, 0.136, 2.7], [1.0, 0.132, 2.1], [2.0, 0.09, 1.6], [3.0, 0.16, 1.3], [5.0, 0.111, 1.03]];
/// Decimal logarithm of the Reynolds number of a smooth round cylinder, Strouhal number, drag coefficient, and share of the vortices
/// that are shed regularly. Up to 2e5: 0.2 and 1.2 (Roshko, Journal of Fluid Mechanics 10, 1961, and his sources). From 3.5e6: 0.27 and
/// 0.7 (measured by Roshko 1961). Between 5e5 and 2e6: no single peak; drag coefficient between 0.2 and 0.4 (collected by Roshko
/// 1961). The transitions are linear in the logarithm, and the Strouhal numbers in them interpolated (estimates).
const ROUND: [[f64; 4]; 4] =
    [[5.301, 0.2, 1.2, 1.0], [5.699, 0.216, 0.3, 0.0], [6.301, 0.251, 0.45, 0.0], [6.544, 0.27, 0.7, 1.0]];

/// Shape of a cylinder's section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Section {
    /// Square or rectangular, with sharp edges, at which the flow separates at any speed.
    Sharp,
    /// Round and smooth.
    Round,
}

/// Drag and vortex shedding of a cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shedding {
    /// Frequency of the vortices times the width across the wind, relative to the wind speed.
    pub(super) strouhal: f64,
    /// Drag coefficient by the width across the wind.
    pub(super) drag: f64,
    /// Share of the vortices that are shed regularly, 0 to 1. The others are irregular.
    pub(super) regularity: f64,
}

/// Treatment of the vortices that a body sheds regularly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Vortices {
    /// They make the air sway.
    Passing,
    /// The air is the mean over their passage, and they add to the turbulence.
    Averaged,
}

impl Vortices {
    /// Returns the shedding of a body with these vortices.
    pub(super) fn of(self, shedding: Shedding) -> Shedding {
        match self {
            Self::Passing => shedding,
            Self::Averaged => Shedding { regularity: 0.0, ..shedding },
        }
    }
}

impl Shedding {
    /// Returns the values of a section with a length along the wind, a width across it (m), and a wind speed (m/s).
    pub(super) fn of(section: Section, length_m: f64, width_m: f64, speed_m_s: f64) -> Self {
        match section {
            Section::Sharp => {
                let [_, strouhal, drag] = interpolate(&RECTANGLES, length_m / width_m);
                Self { strouhal, drag, regularity: 1.0 }
            }
            Section::Round => {
                let [_, strouhal, drag, regularity] =
                    interpolate(&ROUND, math::log10((speed_m_s * width_m / AIR_VISCOSITY_M2_S).max(1.0)));
                Self { strouhal, drag, regularity }
            }
        }
    }
}

/// Returns the row of a table, ordered by its first column, at a value of that column. Beyond the ends, the outermost row holds.
fn interpolate<const N: usize>(rows: &[[f64; N]], at: f64) -> [f64; N] {
    let after = rows.iter().position(|row| row[0] > at).unwrap_or(rows.len());
    let (low, high) = (rows[after.saturating_sub(1)], rows[after.min(rows.len() - 1)]);
    let share = if high[0] > low[0] { (at - low[0]) / (high[0] - low[0]) } else { 0.0 };
    std::array::from_fn(|k| math::lerp(low[k], high[k], share))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the shedding of a round column of 1 m at a Reynolds number.
    fn round_at(reynolds: f64) -> Shedding {
        Shedding::of(Section::Round, 1.0, 1.0, reynolds * AIR_VISCOSITY_M2_S)
    }

    #[test]
    fn val_round_cylinders_shed_as_roshko_measured() {
        // Roshko 1961 prints two digits.
        const DIGITS: f64 = 0.005;
        for (reynolds, strouhal, drag) in [(1e4, 0.2, 1.2), (1e5, 0.2, 1.2), (3.6e6, 0.27, 0.7), (8e6, 0.27, 0.7)] {
            let shedding = round_at(reynolds);
            assert!((shedding.strouhal - strouhal).abs() < DIGITS, "{reynolds}: {shedding:?}");
            assert!((shedding.drag - drag).abs() < DIGITS && shedding.regularity > 0.99, "{reynolds}: {shedding:?}");
        }
        // Drag coefficients between 0.2 and 0.4 after the drop, and no peak in the spectrum.
        for reynolds in [5.1e5, 7e5, 1e6] {
            let shedding = round_at(reynolds);
            assert!((0.2..=0.4).contains(&shedding.drag) && shedding.regularity < 1e-9, "{reynolds}: {shedding:?}");
        }
    }

    #[test]
    fn val_square_cylinder_sheds_as_lyn_measured() {
        // The uncertainty that the ERCOFTAC Classic Collection, case 043, states for the data.
        const UNCERTAINTY: f64 = 0.004;
        let shedding = Shedding::of(Section::Sharp, 2.0, 2.0, 5.0);
        assert!((shedding.strouhal - 0.132).abs() < UNCERTAINTY && (shedding.drag - 2.1).abs() < 0.05, "{shedding:?}");
    }

    #[test]
    fn prop_shedding_changes_continuously_with_the_reynolds_number_and_the_side_ratio() {
        // Within a hundredth of a decade or of a side ratio, no value changes by more than a tenth.
        const CHANGE: f64 = 0.1;
        let is_near = |a: Shedding, b: Shedding| {
            (a.strouhal - b.strouhal).abs() < CHANGE * a.strouhal
                && (a.drag - b.drag).abs() < CHANGE * a.drag
                && (a.regularity - b.regularity).abs() < CHANGE
        };
        for k in 0..500 {
            let reynolds = |k: i32| math::pow(10.0, 3.0 + 0.01 * f64::from(k));
            assert!(is_near(round_at(reynolds(k)), round_at(reynolds(k + 1))), "{}", reynolds(k));
            let sharp = |k: i32| Shedding::of(Section::Sharp, 0.1 + 0.015 * f64::from(k), 1.0, 5.0);
            assert!(is_near(sharp(k), sharp(k + 1)), "{k}: {:?}", sharp(k));
        }
    }
}
