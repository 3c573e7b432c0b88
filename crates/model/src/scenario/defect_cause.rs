//! Causes of defects, and the stains that water carries out of them.

/// Rule by which defects are placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DefectPlacement {
    /// Anywhere on the surfaces that lines of sight from the paths hit.
    #[default]
    Anywhere,
    /// Where a cause produces them ([`DefectCause`]).
    Causes,
}

impl DefectPlacement {
    /// Keywords in scenario files; the first one is the default.
    pub(super) const WORDS: [(&'static str, Self); 2] = [("anywhere", Self::Anywhere), ("causes", Self::Causes)];
}

/// Cause of a defect, which determines where it is, how it runs and what stains it has. docs/src/reference/defects.md describes all of
/// them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum DefectCause {
    /// Tension from bending.
    Bending,
    /// Diagonal tension from shear.
    Shear,
    /// Shrinkage of a deck that its girders restrain.
    Shrinkage,
    /// Concrete that swells: alkali-silica reaction or frost.
    Swelling,
    /// Water that runs through a deck joint.
    LeakingJoint,
    /// Water that runs out of or beside a deck drain.
    Drain,
    /// Reinforcement that rusts and bursts the cover.
    Reinforcement,
    /// Concrete that breaks off at edges and below bearings.
    Edge,
    /// Ice, debris and sand at the water line.
    WaterLine,
    /// Stress concentration at the end of a weld.
    Weld,
    /// Fasteners of a splice.
    Fasteners,
    /// Water that collects in the lowest part of a cable.
    Cable,
    /// Water that seeps through the fill of a masonry arch.
    Seepage,
    /// Frost in wet stones.
    Frost,
}

impl DefectCause {
    /// All causes with their keywords in resolved files.
    pub const ALL: [(&'static str, Self); 14] = [
        ("bending", Self::Bending),
        ("shear", Self::Shear),
        ("shrinkage", Self::Shrinkage),
        ("swelling", Self::Swelling),
        ("leaking_joint", Self::LeakingJoint),
        ("drain", Self::Drain),
        ("reinforcement", Self::Reinforcement),
        ("edge", Self::Edge),
        ("water_line", Self::WaterLine),
        ("weld", Self::Weld),
        ("fasteners", Self::Fasteners),
        ("cable", Self::Cable),
        ("seepage", Self::Seepage),
        ("frost", Self::Frost),
    ];

    /// Returns the keyword in resolved files.
    #[must_use]
    pub fn keyword(self) -> &'static str {
        Self::ALL.iter().find(|(_, cause)| *cause == self).map_or("none", |(word, _)| word)
    }

    /// Returns the keywords of resolved files, starting with that of a defect without a cause.
    pub(super) fn words() -> Vec<(&'static str, Option<Self>)> {
        std::iter::once(("none", None)).chain(Self::ALL.map(|(word, cause)| (word, Some(cause)))).collect()
    }
}

/// Substance that water carries out of a defect and leaves below it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StainSubstance {
    /// White lime.
    Lime,
    /// Brown rust.
    Rust,
}

impl StainSubstance {
    /// Keywords in resolved files, starting with that of a defect without a stain.
    pub(super) const WORDS: [(&'static str, Option<Self>); 3] =
        [("none", None), ("lime", Some(Self::Lime)), ("rust", Some(Self::Rust))];

    /// Returns the keyword in resolved files.
    #[must_use]
    pub const fn keyword(self) -> &'static str {
        match self {
            Self::Lime => "lime",
            Self::Rust => "rust",
        }
    }
}

/// Stain that belongs to a defect. It is drawn with it, but it is neither counted nor labeled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stain {
    /// Substance.
    pub substance: StainSubstance,
    /// Length, m: down from the defect on a wall, along the defect on an underside.
    pub length_m: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_keywords_are_unique_and_complete() {
        let words: std::collections::BTreeSet<&str> = DefectCause::words().into_iter().map(|(word, _)| word).collect();
        assert_eq!(words.len(), DefectCause::ALL.len() + 1);
        assert!(DefectCause::ALL.iter().all(|(word, cause)| cause.keyword() == *word));
        assert!(StainSubstance::WORDS.iter().all(|(word, stain)| stain.is_none_or(|stain| stain.keyword() == *word)));
    }
}
