//! Sums over surface: by element, by fate, and what the pictures are like.

use super::outcome::SurfaceOutcome;
use spandrel_model::math;
use std::collections::BTreeMap;

/// What was seen.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceCoverage {
    /// By element, in the order of their numbers.
    pub elements: Vec<ElementSurface>,
}

/// One element's surface.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ElementSurface {
    /// AASHTO MBEI number; 0 for all together.
    pub element: u32,
    /// What could be seen well from the reference paths, m².
    pub inspectable_m2: f64,
    /// Of it, by what became of it, m².
    pub by_fate_m2: BTreeMap<SurfaceOutcome, f64>,
    /// Of what was photographed at the required size and angle, the best pictures: areas times values.
    pub(in crate::report) sums: PictureSums,
}

/// Sums over area of what the best pictures are like.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::report) struct PictureSums {
    area_m2: f64,
    incidence_rad: f64,
    gsd_m: f64,
    blur_px: f64,
    ln_lux: f64,
}

/// What the pictures of a surface are like on average over its area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AveragePicture {
    /// Angle off square, rad.
    pub incidence_rad: f64,
    /// Size of a pixel on the surface, m.
    pub gsd_m: f64,
    /// Smear by the drone's motion, px.
    pub blur_px: f64,
    /// Light on it, lamp included, lx (geometric mean: light goes by factors).
    pub lux: f64,
}

/// The best picture of a patch so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BestPicture {
    pub fate: SurfaceOutcome,
    pub incidence_rad: f64,
    pub gsd_m: f64,
    pub blur_px: f64,
    pub lux: f64,
}

impl ElementSurface {
    /// Takes a piece of surface in, with its fate and its best picture.
    pub(super) fn add(&mut self, area_m2: f64, fate: SurfaceOutcome, best: Option<&BestPicture>) {
        self.inspectable_m2 += area_m2;
        *self.by_fate_m2.entry(fate).or_default() += area_m2;
        let Some(best) = best.filter(|best| best.fate > SurfaceOutcome::TooOblique) else { return };
        self.sums.area_m2 += area_m2;
        self.sums.incidence_rad += area_m2 * best.incidence_rad;
        self.sums.gsd_m += area_m2 * best.gsd_m;
        self.sums.blur_px += area_m2 * best.blur_px;
        self.sums.ln_lux += area_m2 * math::ln(best.lux.max(f64::MIN_POSITIVE));
    }

    fn merge(&mut self, other: &Self) {
        self.inspectable_m2 += other.inspectable_m2;
        for (fate, area_m2) in &other.by_fate_m2 {
            *self.by_fate_m2.entry(*fate).or_default() += area_m2;
        }
        let (sums, more) = (&mut self.sums, &other.sums);
        sums.area_m2 += more.area_m2;
        sums.incidence_rad += more.incidence_rad;
        sums.gsd_m += more.gsd_m;
        sums.blur_px += more.blur_px;
        sums.ln_lux += more.ln_lux;
    }

    /// What became so, m².
    #[must_use]
    pub fn area_m2(&self, fate: SurfaceOutcome) -> f64 {
        self.by_fate_m2.get(&fate).copied().unwrap_or_default()
    }

    /// What became so or better, m².
    #[must_use]
    pub fn at_least_m2(&self, fate: SurfaceOutcome) -> f64 {
        self.by_fate_m2.range(fate..).map(|(_, area_m2)| area_m2).sum()
    }

    /// What pictures show at the required size of a pixel and angle, m².
    #[must_use]
    pub fn pictured_m2(&self) -> f64 {
        self.at_least_m2(SurfaceOutcome::DarkLampOff)
    }

    /// What the pictures at that size and angle are like; `None` without any.
    #[must_use]
    pub fn typical(&self) -> Option<AveragePicture> {
        let PictureSums { area_m2, incidence_rad, gsd_m, blur_px, ln_lux } = self.sums;
        (area_m2 > 0.0).then(|| AveragePicture {
            incidence_rad: incidence_rad / area_m2,
            gsd_m: gsd_m / area_m2,
            blur_px: blur_px / area_m2,
            lux: math::exp(ln_lux / area_m2),
        })
    }
}

impl SurfaceCoverage {
    /// All elements together.
    #[must_use]
    pub fn total(&self) -> ElementSurface {
        let mut total = ElementSurface::default();
        self.elements.iter().for_each(|one| total.merge(one));
        total
    }
}
