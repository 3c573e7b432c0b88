//! Defects as patches on the faces of members.

use super::bake::LightBaker;
use super::bridges;
use spandrel_model::defect_codes;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{PlacedDefect, StainSubstance};
use spandrel_model::site::Site;

/// Number of rays used to compute the light on a patch; the same as for scoring.
const RAYS_PER_PATCH: usize = 64;
/// Codes of drawings that are not defect codes: stains that belong to a defect, and patterns of cracks (the same values as in
/// shaders/defect.wgsl).
const LIME_STAIN: u32 = 1;
const RUST_STAIN: u32 = 2;
const MAP_CRACKS: u32 = 3;
/// Codes of all stains. They are drawn first, so that the defects are on top of them, and are not labeled.
pub const STAIN_CODES: [u32; 2] = [LIME_STAIN, RUST_STAIN];

/// Returns the codes of all drawings of defects, without stains.
pub fn defect_drawings() -> impl Iterator<Item = u32> {
    std::iter::once(MAP_CRACKS).chain(defect_codes::ALL.iter().copied())
}

/// Margin around a line for leakage stains, m (the face extends at least this far, `site::defects`).
const LEAKAGE_MARGIN_M: f64 = 0.03;
/// Share of an area's half extent behind which its stain begins.
const HIDDEN_STAIN_SHARE: f64 = 0.6;
/// Size factor of an area, which leaves space for its ragged edge.
const EDGE_FACTOR: f64 = 1.06;

/// Instance data of a defect for the `defect` shader.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct DefectPatch {
    /// Center, m; AASHTO code.
    pub center: [f32; 4],
    /// Outward normal; a random number in 0..1.
    pub normal: [f32; 4],
    /// Direction of the longest extent; length, m.
    pub along: [f32; 4],
    /// Width, m; condition state; downward direction along and across.
    pub size: [f32; 4],
    /// Indirect light (fractions of sky and sun); half sizes of the patch, m.
    pub light: [f32; 4],
    /// Paint on steel, linear; defect ID.
    pub tint: [f32; 4],
}

/// Returns the patches for all of a site's defects.
pub fn patches(site: &Site, sun: Vec3<Enu>) -> Vec<DefectPatch> {
    let bake = LightBaker::new(site, sun, RAYS_PER_PATCH);
    let of_defect = |defect: &PlacedDefect| {
        let stain = defect.stain_patch().and_then(|at| stain_patch(defect, bake.at(at.center_m, defect.normal)));
        [stain, Some(patch(defect, bake.at(defect.position_m, defect.normal)))].into_iter().flatten()
    };
    site.defects().iter().flat_map(of_defect).collect()
}

/// Returns the code used to draw a defect. Resolved files may contain kinds that no seed generates; these are drawn as
/// a crack or exposed aggregate, because scored defects must be visible.
fn drawn_kind(defect: &PlacedDefect) -> u32 {
    match (defect_codes::ALL.contains(&defect.kind), defect.line) {
        (true, false) if matches!(defect.kind, defect_codes::CRACK | defect_codes::PSC_CRACK) => MAP_CRACKS,
        (true, _) => defect.kind,
        (false, true) => defect_codes::CRACK,
        (false, false) => defect_codes::ABRASION,
    }
}

/// Returns the patch of a defect's stain for the given indirect light; `None` if it has none.
#[must_use]
pub fn stain_patch(defect: &PlacedDefect, light: [f32; 2]) -> Option<DefectPatch> {
    let (stain, at) = (defect.stain?, defect.stain_patch()?);
    let code = match stain.substance {
        StainSubstance::Lime => LIME_STAIN,
        StainSubstance::Rust => RUST_STAIN,
    };
    // Below an area, the stain is drawn from behind its ragged edge. A seam along a crack stays as it is.
    let hidden_m = if defect.line {
        0.0
    } else {
        HIDDEN_STAIN_SHARE * (defect.position_m - at.center_m).norm().min(defect.half_extent_m(at.along))
    };
    // White lime is what the shader draws in a fair state.
    let area = PlacedDefect {
        position_m: at.center_m - at.along * (0.5 * hidden_m),
        along: at.along,
        length_m: at.length_m + hidden_m,
        width_m: at.width_m,
        line: false,
        condition_state: 2,
        ..defect.clone()
    };
    let mut patch = patch(&area, light);
    patch.center[3] = code as f32;
    // A seam of lime follows the course of its crack.
    patch.normal[3] = own_number(defect);
    Some(patch)
}

/// Returns a pseudorandom number that differs between defects but is constant for each one.
fn own_number(defect: &PlacedDefect) -> f32 {
    (f64::from(defect.id) * 0.618_034 + defect.length_m * 7.13).fract() as f32
}

/// Returns the patch of a defect for the given indirect light.
#[must_use]
pub fn patch(defect: &PlacedDefect, [sky, sun]: [f32; 2]) -> DefectPatch {
    let four = |v: Vec3<Enu>, last: f64| {
        let [x, y, z] = v.array();
        [x as f32, y as f32, z as f32, last as f32]
    };
    let across = defect.normal.cross(defect.along);
    let half = if defect.line {
        (0.5 * defect.length_m + LEAKAGE_MARGIN_M, 0.5 * defect.width_m + LEAKAGE_MARGIN_M)
    } else {
        (0.5 * EDGE_FACTOR * defect.length_m, 0.5 * EDGE_FACTOR * defect.width_m)
    };
    let [r, g, b] = bridges::material_and_paint(defect.element).1.map(|c| f32::from(c) / 255.0);
    DefectPatch {
        center: four(defect.position_m, f64::from(drawn_kind(defect))),
        normal: four(defect.normal, f64::from(own_number(defect))),
        along: four(defect.along, defect.length_m),
        size: [defect.width_m as f32, f32::from(defect.condition_state), -defect.along.up() as f32, -across.up() as f32],
        light: [sky, sun, half.0 as f32, half.1 as f32],
        tint: [r, g, b, defect.id as f32],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario::Stain;

    /// Returns a crack that runs straight down.
    fn vertical_crack() -> PlacedDefect {
        PlacedDefect {
            id: 3,
            element: spandrel_model::elements::Element::RcArch,
            member: "arch/rib-left/07".into(),
            kind: 1130,
            condition_state: 3,
            position_m: Vec3::new(1.0, 2.0, 3.0),
            normal: Vec3::new(0.0, -1.0, 0.0),
            along: Vec3::new(0.0, 0.0, -1.0),
            length_m: 1.0,
            width_m: 0.002,
            line: true,
            cause: None,
            stain: None,
        }
    }

    #[test]
    fn exact_patches_include_leakage_and_edge_margins() {
        let defect = vertical_crack();
        let line = patch(&defect, [0.2, 0.1]);
        assert_eq!(line.light[2..], [0.53, 0.031]);
        assert_eq!((line.center[3], line.size[2]), (1130.0, 1.0), "the crack must run straight down");
        let area = patch(&PlacedDefect { line: false, width_m: 0.5, ..defect }, [0.2, 0.1]);
        assert_eq!(area.light[2..], [0.53, 0.265]);
    }

    #[test]
    fn exact_unsupported_kinds_are_drawn_as_crack_or_abrasion() {
        let decay = PlacedDefect { kind: 1140, line: false, ..vertical_crack() };
        assert_eq!(patch(&decay, [0.2, 0.1]).center[3], 1190.0);
        assert_eq!(patch(&PlacedDefect { line: true, ..decay }, [0.2, 0.1]).center[3], 1130.0);
    }

    #[test]
    fn exact_patterns_of_cracks_and_stains_have_drawings_of_their_own() {
        let pattern = PlacedDefect { kind: 1130, line: false, width_m: 0.6, ..vertical_crack() };
        assert_eq!(patch(&pattern, [0.2, 0.1]).center[3], MAP_CRACKS as f32);
        assert_eq!(stain_patch(&pattern, [0.2, 0.1]), None);
        for (substance, code) in [(StainSubstance::Lime, LIME_STAIN), (StainSubstance::Rust, RUST_STAIN)] {
            let stained = PlacedDefect { stain: Some(Stain { substance, length_m: 0.4 }), ..vertical_crack() };
            let stain = stain_patch(&stained, [0.2, 0.1]).unwrap();
            let crack = patch(&stained, [0.2, 0.1]);
            assert_eq!((stain.center[3], stain.normal[3], stain.tint[3]), (code as f32, crack.normal[3], crack.tint[3]));
            // The crack ends 0.5 m below its center; the middle of the stain is 0.2 m lower.
            assert!((crack.center[2] - stain.center[2] - 0.7).abs() < 1e-6, "{stain:?}");
        }
        assert!(defect_drawings().all(|code| !STAIN_CODES.contains(&code)));
    }
}
