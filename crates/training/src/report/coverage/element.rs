//! Surface area by element and outcome, and average picture quality.

use super::outcome::SurfaceOutcome;
use spandrel_model::elements::Element;
use spandrel_model::math;
use std::collections::BTreeMap;

/// Surface coverage of a session.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceCoverage {
    /// Coverage by element.
    pub elements: BTreeMap<Element, ElementSurface>,
}

/// Surface coverage of one or all elements.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ElementSurface {
    /// Surface that can be inspected from the reference paths, m².
    pub inspectable_m2: f64,
    /// Inspectable surface by outcome, m².
    pub area_by_outcome_m2: BTreeMap<SurfaceOutcome, f64>,
    /// Area-weighted sums over the best pictures that meet the required pixel size and angle.
    pub(crate) sums: PictureSums,
}

/// Area-weighted sums of best-picture properties.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PictureSums {
    area_m2: f64,
    incidence_rad: f64,
    gsd_m: f64,
    blur_px: f64,
    ln_lux: f64,
}

/// Area-weighted average over the pictures that show a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AveragePicture {
    /// Incidence angle from the surface normal, rad.
    pub incidence_rad: f64,
    /// Ground sampling distance: size of a pixel on the surface, m.
    pub gsd_m: f64,
    /// Motion blur, px.
    pub blur_px: f64,
    /// Illuminance including lamp light, lx (geometric mean, because perceived brightness depends on ratios).
    pub lux: f64,
}

/// The best picture of a patch so far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BestPicture {
    pub outcome: SurfaceOutcome,
    pub incidence_rad: f64,
    pub gsd_m: f64,
    pub blur_px: f64,
    pub lux: f64,
}

impl ElementSurface {
    /// Adds a surface patch's area with its outcome and best picture.
    pub(super) fn add(&mut self, area_m2: f64, outcome: SurfaceOutcome, best: Option<&BestPicture>) {
        self.inspectable_m2 += area_m2;
        *self.area_by_outcome_m2.entry(outcome).or_default() += area_m2;
        let Some(best) = best.filter(|best| best.outcome > SurfaceOutcome::TooOblique) else { return };
        self.sums.area_m2 += area_m2;
        self.sums.incidence_rad += area_m2 * best.incidence_rad;
        self.sums.gsd_m += area_m2 * best.gsd_m;
        self.sums.blur_px += area_m2 * best.blur_px;
        self.sums.ln_lux += area_m2 * math::ln(best.lux.max(f64::MIN_POSITIVE));
    }

    fn merge(&mut self, other: &Self) {
        self.inspectable_m2 += other.inspectable_m2;
        for (surface_outcome, area_m2) in &other.area_by_outcome_m2 {
            *self.area_by_outcome_m2.entry(*surface_outcome).or_default() += area_m2;
        }
        let (sums, more) = (&mut self.sums, &other.sums);
        sums.area_m2 += more.area_m2;
        sums.incidence_rad += more.incidence_rad;
        sums.gsd_m += more.gsd_m;
        sums.blur_px += more.blur_px;
        sums.ln_lux += more.ln_lux;
    }

    /// Returns the area with this outcome in m².
    #[must_use]
    pub fn area_m2(&self, outcome: SurfaceOutcome) -> f64 {
        self.area_by_outcome_m2.get(&outcome).copied().unwrap_or_default()
    }

    /// Returns the area with this outcome or a better one in m².
    #[must_use]
    pub fn at_least_m2(&self, outcome: SurfaceOutcome) -> f64 {
        self.area_by_outcome_m2.range(outcome..).map(|(_, area_m2)| area_m2).sum()
    }

    /// Returns the area in m² that was photographed at the required pixel size and angle.
    #[must_use]
    pub fn pictured_m2(&self) -> f64 {
        self.at_least_m2(SurfaceOutcome::DarkLampOff)
    }

    /// Returns the average of the pictures that meet the required pixel size and angle; `None` if there are none.
    #[must_use]
    pub fn average_picture(&self) -> Option<AveragePicture> {
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
    /// Returns the total over all elements.
    #[must_use]
    pub fn total(&self) -> ElementSurface {
        let mut total = ElementSurface::default();
        self.elements.values().for_each(|one| total.merge(one));
        total
    }
}
