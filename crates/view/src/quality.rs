//! Rendering quality presets.

/// Settings of a preset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// Name on the command line.
    pub name: &'static str,
    /// Multisampling: 1 or 4 samples per pixel.
    pub samples: u32,
    /// Number of sun shadow maps: 1 covers the whole site and is drawn once; more follow the camera and are drawn for
    /// every picture.
    pub cascades: u32,
    /// Side of each shadow map, px.
    pub shadow_px: u32,
    /// Shadow filter size per side, texels: 1, 2, or 3.
    pub shadow_taps: u32,
    /// Whether the edges of the sun's shadows are as wide as its disk makes them; `shadow_taps` are then only those of the lamp.
    pub penumbra: bool,
    /// Whether the lamp casts shadows.
    pub lamp_shadow: bool,
    /// Directions per pixel of the ambient occlusion in corners and gaps; 0 for none.
    pub occlusion_directions: u32,
    /// Size of the water reflection relative to the picture; 0 reflects only the sky.
    pub reflection: f64,
    /// Draws the ground and the lake with fewer triangles where the difference is invisible, and omits the lake bed in
    /// deep water. The reflection omits boulders, hangers, railings, and distant trees, and uses simplified bridges and
    /// mountains.
    pub sparse: bool,
    /// Spacing of baked light samples on the bridges, m.
    pub light_cell_m: f64,
    /// Rays per baked light sample.
    pub light_rays: usize,
    /// Maximum number of vertices of a bridge member; a scan with more is drawn coarser.
    pub surface_vertices: usize,
    /// Maximum number of trees.
    pub trees: usize,
    /// Branches per whorl of a tree; also sets the detail of boulders.
    pub branches_per_whorl: u32,
    /// Whether to interpolate between two mip levels of noise; using only the nearest level halves the cost.
    pub smooth_noise: bool,
    /// Computes light and haze per vertex, takes slow patterns from precomputed tiles, and omits highlights, which cuts
    /// the cost per pixel to a third. Uses one shadow map for the sun.
    pub lean: bool,
    /// Motion blur samples per pixel; 1 disables motion blur.
    pub blur_taps: u32,
}

/// Presets from cheapest to most expensive.
pub const PRESETS: &[Quality] = &[
    Quality {
        name: "low",
        samples: 1,
        cascades: 1,
        shadow_px: 4096,
        shadow_taps: 1,
        penumbra: false,
        lamp_shadow: false,
        occlusion_directions: 0,
        reflection: 0.25,
        sparse: true,
        light_cell_m: 2.5,
        light_rays: 24,
        surface_vertices: 20_000,
        trees: 1000,
        branches_per_whorl: 5,
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
        penumbra: false,
        lamp_shadow: true,
        occlusion_directions: 0,
        reflection: 0.5,
        sparse: false,
        light_cell_m: 2.0,
        light_rays: 32,
        surface_vertices: 100_000,
        trees: 1500,
        branches_per_whorl: 9,
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
        penumbra: false,
        lamp_shadow: true,
        occlusion_directions: 4,
        reflection: 0.5,
        sparse: false,
        light_cell_m: 1.5,
        light_rays: 48,
        surface_vertices: 300_000,
        trees: 3000,
        branches_per_whorl: 11,
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
        penumbra: true,
        lamp_shadow: true,
        occlusion_directions: 8,
        reflection: 1.0,
        sparse: false,
        light_cell_m: 1.0,
        light_rays: 64,
        surface_vertices: 1_000_000,
        trees: 6000,
        branches_per_whorl: 11,
        smooth_noise: true,
        lean: false,
        blur_taps: 12,
    },
];

impl Quality {
    /// Returns the preset with the given name, if it exists.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        PRESETS.iter().find(|preset| preset.name == name).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_every_setting_increases_with_the_preset() {
        for pair in PRESETS.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            assert!(a.samples <= b.samples && a.cascades <= b.cascades && a.shadow_taps <= b.shadow_taps, "{}", b.name);
            assert!(a.light_cell_m >= b.light_cell_m && a.light_rays <= b.light_rays && a.trees < b.trees, "{}", b.name);
            assert!(a.surface_vertices < b.surface_vertices, "{}", b.name);
            assert!(a.penumbra <= b.penumbra && a.occlusion_directions <= b.occlusion_directions, "{}", b.name);
            assert!(
                a.reflection <= b.reflection && a.blur_taps <= b.blur_taps && a.branches_per_whorl <= b.branches_per_whorl,
                "{}",
                b.name
            );
        }
        assert!(PRESETS.iter().all(|preset| !preset.lean || (preset.cascades == 1 && preset.shadow_taps == 1)));
        assert_eq!(Quality::by_name("low").map(|q| q.samples), Some(1));
        assert!(Quality::by_name("best").is_none());
    }
}
