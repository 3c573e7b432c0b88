//! Dryden turbulence at low altitude: length scales, intensities over land (MIL-F-8785C) and over open water, and the filters that
//! shape white noise.

use crate::math;
use crate::random::RandomStream;

/// Length of one foot, m.
const M_PER_FT: f64 = 0.3048;
/// Height range of the low-altitude model in MIL-F-8785C, section 3.7.3.4, ft.
const DRYDEN_HEIGHT_FT: (f64, f64) = (10.0, 1000.0);
/// Height of the wind speed in MIL-F-8785C, m (20 ft).
pub(super) const REFERENCE_HEIGHT_M: f64 = 20.0 * M_PER_FT;
/// Roughness length of open water, m (estimate; typical order of magnitude for calm to moderate sea, see
/// docs/src/reference/domain.md, "Wind and turbulence").
pub(super) const WATER_ROUGHNESS_M: f64 = 0.0003;
/// Standard deviations across the mean wind and vertically, relative to the one along it (Solari and Piccardo, "Probabilistic 3-D
/// turbulence modeling for gust buffeting of structures", Probabilistic Engineering Mechanics 16, 2001).
const WATER_ACROSS: f64 = 0.75;
const WATER_VERTICAL: f64 = 0.5;

/// Standard deviations (m/s) and length scales (m) of the Dryden model at one height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dryden {
    /// Standard deviation along the mean wind, m/s.
    pub sigma_along_m_s: f64,
    /// Horizontal standard deviation across the mean wind, m/s.
    pub sigma_across_m_s: f64,
    /// Vertical standard deviation, m/s.
    pub sigma_vertical_m_s: f64,
    /// Length scale along and across the mean wind, m.
    pub horizontal_length_scale_m: f64,
    /// Vertical length scale, m.
    pub vertical_length_scale_m: f64,
}

impl Dryden {
    /// Returns the low-altitude model of MIL-F-8785C at a height above land, for a mean wind speed at 20 ft.
    #[must_use]
    pub fn over_land(height_m: f64, wind_20ft_m_s: f64) -> Self {
        let h_ft = (height_m / M_PER_FT).clamp(DRYDEN_HEIGHT_FT.0, DRYDEN_HEIGHT_FT.1);
        let shape = 0.177 + 0.000_823 * h_ft;
        let sigma_vertical_m_s = 0.1 * wind_20ft_m_s;
        let sigma_horizontal_m_s = sigma_vertical_m_s / math::pow(shape, 0.4);
        Self {
            sigma_along_m_s: sigma_horizontal_m_s,
            sigma_across_m_s: sigma_horizontal_m_s,
            sigma_vertical_m_s,
            horizontal_length_scale_m: h_ft / math::pow(shape, 1.2) * M_PER_FT,
            vertical_length_scale_m: h_ft * M_PER_FT,
        }
    }

    /// Returns the model at a height above open water, for a mean wind speed at 20 ft. Along the wind, the standard deviation is the
    /// mean speed divided by ln(z/z0) at each height z, and so the same at all (EN 1991-1-4, 4.4). The length scales are those over
    /// land (estimate).
    #[must_use]
    pub fn over_water(height_m: f64, wind_20ft_m_s: f64) -> Self {
        Self::over_land(height_m, wind_20ft_m_s).with_intensities_of_water(wind_20ft_m_s)
    }

    fn with_intensities_of_water(self, wind_20ft_m_s: f64) -> Self {
        let sigma_along_m_s = wind_20ft_m_s / math::ln(REFERENCE_HEIGHT_M / WATER_ROUGHNESS_M);
        Self {
            sigma_along_m_s,
            sigma_across_m_s: WATER_ACROSS * sigma_along_m_s,
            sigma_vertical_m_s: WATER_VERTICAL * sigma_along_m_s,
            ..self
        }
    }

    /// Returns the model near a shore, from open water (share of land 0) to land (1).
    pub(super) fn near_shore(height_m: f64, wind_20ft_m_s: f64, share_of_land: f64) -> Self {
        let land = Self::over_land(height_m, wind_20ft_m_s);
        let water = land.with_intensities_of_water(wind_20ft_m_s);
        Self {
            sigma_along_m_s: math::lerp(water.sigma_along_m_s, land.sigma_along_m_s, share_of_land),
            sigma_across_m_s: math::lerp(water.sigma_across_m_s, land.sigma_across_m_s, share_of_land),
            sigma_vertical_m_s: math::lerp(water.sigma_vertical_m_s, land.sigma_vertical_m_s, share_of_land),
            ..land
        }
    }
}

/// First-order Dryden filter with unit variance (longitudinal spectrum), discretized exactly.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct FirstOrderFilter {
    x: f64,
}

impl FirstOrderFilter {
    pub(super) fn start(stream: &mut RandomStream) -> Self {
        Self { x: stream.normal() }
    }

    pub(super) fn step(&mut self, dt_over_t: f64, stream: &mut RandomStream) -> f64 {
        let a = math::exp(-dt_over_t);
        self.x = a * self.x + (1.0 - a * a).max(0.0).sqrt() * stream.normal();
        self.x
    }
}

/// Second-order Dryden filter with unit variance, (1 + √3 T s)/(1 + T s)² (lateral and vertical spectra). With x1' = (n - x1)/T
/// and x2' = (x1 - x2)/T the output is √3 x1 + (1 - √3) x2, and the stationary covariance of the states for unit output variance
/// is [[1/2, 1/4], [1/4, 1/4]]; each step adds exactly the covariance lost to decay.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct SecondOrderFilter {
    x1: f64,
    x2: f64,
}

impl SecondOrderFilter {
    const P11: f64 = 0.5;
    const P12: f64 = 0.25;
    const P22: f64 = 0.25;

    pub(super) fn start(stream: &mut RandomStream) -> Self {
        let (l11, l21, l22) = cholesky_2x2(Self::P11, Self::P12, Self::P22);
        let (n1, n2) = (stream.normal(), stream.normal());
        Self { x1: l11 * n1, x2: l21 * n1 + l22 * n2 }
    }

    pub(super) fn step(&mut self, dt_over_t: f64, stream: &mut RandomStream) -> f64 {
        let a = math::exp(-dt_over_t);
        let b = a * dt_over_t;
        let q11 = Self::P11 - a * a * Self::P11;
        let q12 = Self::P12 - a * (b * Self::P11 + a * Self::P12);
        let q22 = Self::P22 - (b * b * Self::P11 + 2.0 * a * b * Self::P12 + a * a * Self::P22);
        let (l11, l21, l22) = cholesky_2x2(q11, q12, q22);
        let (n1, n2) = (stream.normal(), stream.normal());
        let x1 = a * self.x1 + l11 * n1;
        self.x2 = b * self.x1 + a * self.x2 + l21 * n1 + l22 * n2;
        self.x1 = x1;
        let root3 = 3.0_f64.sqrt();
        root3 * self.x1 + (1.0 - root3) * self.x2
    }
}

/// Returns the lower Cholesky factor of a 2x2 covariance matrix. If rounding makes the last pivot slightly negative, it
/// is set to zero.
fn cholesky_2x2(q11: f64, q12: f64, q22: f64) -> (f64, f64, f64) {
    let l11 = q11.max(0.0).sqrt();
    let l21 = if l11 > 0.0 { q12 / l11 } else { 0.0 };
    (l11, l21, (q22 - l21 * l21).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_turbulence_over_land_matches_the_table_at_10_m() {
        // MIL-F-8785C low-altitude Dryden model (docs/src/reference/domain.md, "Wind and turbulence"): W20 11 mph, 10 m: L_u 67
        // m, sigma_u 0.93, sigma_w 0.49 m/s; tolerance half a unit of the last printed digit.
        let d = Dryden::over_land(10.0, 11.0 * math::M_S_PER_MPH);
        assert!((d.horizontal_length_scale_m - 67.0).abs() < 0.5, "{}", d.horizontal_length_scale_m);
        assert!((d.sigma_along_m_s - 0.93).abs() < 0.005, "{}", d.sigma_along_m_s);
        assert!((d.sigma_vertical_m_s - 0.49).abs() < 0.005);
    }
    #[test]
    fn val_turbulence_over_open_water_has_the_published_intensity_at_10_m() {
        // Intensity 1/ln(10 m/0.0003 m) along the wind (EN 1991-1-4, 4.4); 75% and 50% of it across and vertically (Solari and Piccardo
        // 2001). Tolerance: half a unit of the last digit of 9.6%.
        const TOLERANCE: f64 = 5e-4;
        let d = Dryden::over_water(10.0, 11.0 * math::M_S_PER_MPH);
        let mean_m_s = 11.0 * math::M_S_PER_MPH * super::super::wind::profile(10.0);
        assert!((d.sigma_along_m_s / mean_m_s - 0.096).abs() < TOLERANCE, "{}", d.sigma_along_m_s / mean_m_s);
        assert!((d.sigma_across_m_s / mean_m_s - 0.072).abs() < TOLERANCE);
        assert!((d.sigma_vertical_m_s / mean_m_s - 0.048).abs() < TOLERANCE);
        assert_eq!(Dryden::near_shore(10.0, 5.0, 0.0), Dryden::over_water(10.0, 5.0));
        let (shore, land) = (Dryden::near_shore(10.0, 5.0, 1.0), Dryden::over_land(10.0, 5.0));
        assert!(
            (shore.sigma_along_m_s - land.sigma_along_m_s).abs() < 1e-12
                && (shore.sigma_across_m_s - land.sigma_across_m_s).abs() < 1e-12
        );
    }
}
