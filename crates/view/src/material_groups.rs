//! Groups of materials and defects that share a pipeline. Software renderers execute both sides of every branch, so a
//! shader that switches on the material computes all materials at each pixel. With one pipeline per group, it computes
//! only the materials in its group.

use super::mesh::Material;

/// Materials drawn by one pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u32)]
pub enum MaterialGroup {
    /// Cast concrete.
    Concrete = 0,
    /// Bridge deck.
    Deck = 1,
    /// Painted steel.
    Steel = 2,
    /// Other inexpensive materials.
    Simple = 3,
    /// Ground.
    Ground = 4,
}

impl MaterialGroup {
    /// All groups in drawing order. The ground is last because other objects usually hide it.
    pub const ALL: [Self; 5] = [Self::Concrete, Self::Deck, Self::Steel, Self::Simple, Self::Ground];

    /// Checks whether the group's materials have specular reflection.
    #[must_use]
    pub const fn has_specular(self) -> bool {
        matches!(self, Self::Steel | Self::Simple)
    }

    /// Returns the group of a vertex's material (its lowest eight bits).
    #[must_use]
    pub const fn of(material: u32) -> Self {
        const CONCRETE: u32 = Material::Concrete as u32;
        const DECK: u32 = Material::Deck as u32;
        const STEEL: u32 = Material::Steel as u32;
        const GROUND: u32 = Material::Ground as u32;
        match material & 0xFF {
            CONCRETE => Self::Concrete,
            DECK => Self::Deck,
            STEEL => Self::Steel,
            GROUND => Self::Ground,
            _ => Self::Simple,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_material_groups_have_materials_and_shader_constants() {
        let shader = super::super::shaders::source("surface");
        for look in MaterialGroup::ALL {
            assert!((0..16).any(|material| MaterialGroup::of(material) == look), "{look:?}");
            assert!(shader.contains(&format!("LOOK == {}u", look as u32)), "{look:?}");
        }
    }
}
