//! How much a picture may cost: presets as plain data.

/// What a preset decides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// Name on the command line.
    pub name: &'static str,
    /// Samples per pixel at edges: 1 or 4.
    pub samples: u32,
    /// Shadow maps of the sun: 1 covers the whole site and is drawn once; more follow the eye and are drawn for every picture.
    pub cascades: u32,
    /// Side of each shadow map, px.
    pub shadow_px: u32,
    /// Texels a side of the filter over a shadow map: 1, 2 or 3.
    pub shadow_taps: u32,
    /// The lamp casts shadows.
    pub lamp_shadow: bool,
    /// Size of the reflection on the water as a share of the picture; 0: the sky alone is reflected.
    pub reflection: f64,
    /// Ground and lake are drawn by fewer triangles where nobody sees the difference, and no bed in deep water; the lake mirrors no boulders,
    /// hangers and railings, trees only where they are near, and simpler bridges and mountains.
    pub sparse: bool,
    /// Spacing at which light is worked out on the bridges, m.
    pub light_cell_m: f64,
    /// Rays for each place at which light is worked out.
    pub light_rays: usize,
    /// Trees that are planted, where there is room.
    pub trees: usize,
    /// Boughs around a tree's trunk in each whorl; boulders are as fine.
    pub boughs: u32,
    /// Between two sizes of noise the mean is taken; without it the nearer one, at half the cost.
    pub smooth_noise: bool,
    /// Light and haze are worked out at corners, slow patterns come from ready tiles, highlights are left out: a third of the cost of a pixel. The
    /// sun has one map.
    pub lean: bool,
    /// Samples along the path of a pixel that moves while the shutter is open; 1: no motion blur.
    pub blur_taps: u32,
}

/// From cheap to costly.
pub const PRESETS: &[Quality] = &[
    Quality {
        name: "low",
        samples: 1,
        cascades: 1,
        shadow_px: 4096,
        shadow_taps: 1,
        lamp_shadow: false,
        reflection: 0.25,
        sparse: true,
        light_cell_m: 2.5,
        light_rays: 24,
        trees: 1000,
        boughs: 5,
        smooth_noise: false,
        lean: true,
        blur_taps: 1,
    },
    Quality {
        name: "medium",
        samples: 4,
        cascades: 3,
        shadow_px: 2048,
        shadow_taps: 3,
        lamp_shadow: true,
        reflection: 0.5,
        sparse: false,
        light_cell_m: 2.0,
        light_rays: 32,
        trees: 1500,
        boughs: 9,
        smooth_noise: true,
        lean: false,
        blur_taps: 4,
    },
    Quality {
        name: "high",
        samples: 4,
        cascades: 4,
        shadow_px: 2048,
        shadow_taps: 3,
        lamp_shadow: true,
        reflection: 0.5,
        sparse: false,
        light_cell_m: 1.5,
        light_rays: 48,
        trees: 3000,
        boughs: 11,
        smooth_noise: true,
        lean: false,
        blur_taps: 8,
    },
    Quality {
        name: "ultra",
        samples: 4,
        cascades: 4,
        shadow_px: 4096,
        shadow_taps: 3,
        lamp_shadow: true,
        reflection: 1.0,
        sparse: false,
        light_cell_m: 1.0,
        light_rays: 64,
        trees: 6000,
        boughs: 11,
        smooth_noise: true,
        lean: false,
        blur_taps: 12,
    },
];

impl Quality {
    /// The preset of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        PRESETS.iter().find(|preset| preset.name == name).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_presets_grow_in_every_number() {
        for pair in PRESETS.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            assert!(a.samples <= b.samples && a.cascades <= b.cascades && a.shadow_taps <= b.shadow_taps, "{}", b.name);
            assert!(a.light_cell_m >= b.light_cell_m && a.light_rays <= b.light_rays && a.trees < b.trees, "{}", b.name);
            assert!(a.reflection <= b.reflection && a.blur_taps <= b.blur_taps && a.boughs <= b.boughs, "{}", b.name);
        }
        assert!(PRESETS.iter().all(|preset| !preset.lean || (preset.cascades == 1 && preset.shadow_taps == 1)));
        assert_eq!(Quality::named("low").map(|q| q.samples), Some(1));
        assert!(Quality::named("best").is_none());
    }
}
