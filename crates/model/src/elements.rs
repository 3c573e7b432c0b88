//! Bridge elements of the AASHTO *Manual for Bridge Element Inspection* (MBEI) with their numbers, names, materials, units of
//! quantity and permitted defects. The sources are listed in docs/src/reference/domain.md, "Elements" and "Defects".

use crate::defect_codes::{
    ABRASION, CONNECTION, CORROSION, CRACK, EFFLORESCENCE, FATIGUE, MORTAR, PSC_CRACK, REBAR, SPALL, SPLIT_STONE,
};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// Material of an element. It determines the defects that are permitted on the element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ElementMaterial {
    /// Reinforced concrete.
    ReinforcedConcrete,
    /// Prestressed concrete.
    PrestressedConcrete,
    /// Steel or another metal.
    Steel,
    /// Timber.
    Timber,
    /// Masonry.
    Masonry,
    /// Any other material, or several materials.
    Other,
}

/// Part of the bridge that an element belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ElementGroup {
    /// Decks, top flanges and slabs, which carry the road.
    Deck,
    /// Girders, stringers, floor beams, trusses and arches.
    Superstructure,
    /// Main and secondary cables.
    Cable,
    /// Columns, towers, walls, abutments, footings, piles and caps.
    Substructure,
    /// Deck joints.
    Joint,
    /// Bearings.
    Bearing,
    /// Approach slabs.
    ApproachSlab,
    /// Railings.
    Railing,
    /// Wearing surfaces and protective systems.
    Protection,
    /// Elements that are not in the table.
    Unlisted,
}

/// Unit of an element's quantity in an inspection report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ElementUnit {
    /// Square feet.
    SquareFeet,
    /// Linear feet.
    Feet,
    /// Count.
    Each,
}

/// Defines the enum [`Element`] and its properties from one table: variant, number, name, group, material, unit.
macro_rules! elements {
    ($($variant:ident $number:literal $name:literal $group:ident $material:ident $unit:ident;)+) => {
        /// A bridge element. Elements are ordered by number and serialized as their number.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(from = "u16", into = "u16")]
        pub enum Element {
            $(#[doc = concat!("Element ", $number, ": ", $name, ".")] $variant,)+
            /// A number that is not in the table, such as an agency-defined element; created by [`Element::from_number`]. No
            /// defects are permitted on it.
            Unlisted(u16),
        }

        impl Element {
            /// All elements in the table, in ascending order of their numbers.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Returns the element with this number.
            #[must_use]
            pub const fn from_number(number: u16) -> Self {
                match number {
                    $($number => Self::$variant,)+
                    _ => Self::Unlisted(number),
                }
            }

            /// Returns the element number.
            #[must_use]
            pub const fn number(self) -> u16 {
                match self {
                    $(Self::$variant => $number,)+
                    Self::Unlisted(number) => number,
                }
            }

            /// Returns the display name: the part, then its material.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)+
                    Self::DECK_DRAIN => "deck drain",
                    Self::FILL => "fill of an arch",
                    Self::Unlisted(_) => "agency-defined element",
                }
            }

            /// Returns the part of the bridge that the element belongs to.
            #[must_use]
            pub const fn group(self) -> ElementGroup {
                match self {
                    $(Self::$variant => ElementGroup::$group,)+
                    Self::Unlisted(_) => ElementGroup::Unlisted,
                }
            }

            /// Returns the material.
            #[must_use]
            pub const fn material(self) -> ElementMaterial {
                match self {
                    $(Self::$variant => ElementMaterial::$material,)+
                    Self::Unlisted(_) => ElementMaterial::Other,
                }
            }

            /// Returns the unit of the element's quantity; `None` for an element outside the table.
            #[must_use]
            pub const fn unit(self) -> Option<ElementUnit> {
                match self {
                    $(Self::$variant => Some(ElementUnit::$unit),)+
                    Self::Unlisted(_) => None,
                }
            }
        }
    };
}

elements! {
    RcDeck 12 "deck, reinforced concrete" Deck ReinforcedConcrete SquareFeet;
    PscDeck 13 "deck, prestressed concrete" Deck PrestressedConcrete SquareFeet;
    PscTopFlange 15 "top flange, prestressed concrete" Deck PrestressedConcrete SquareFeet;
    RcTopFlange 16 "top flange, reinforced concrete" Deck ReinforcedConcrete SquareFeet;
    SteelOpenGridDeck 28 "open grid deck, steel" Deck Steel SquareFeet;
    SteelFilledGridDeck 29 "concrete-filled grid deck, steel" Deck Steel SquareFeet;
    SteelOrthotropicDeck 30 "orthotropic deck, steel" Deck Steel SquareFeet;
    TimberDeck 31 "deck, timber" Deck Timber SquareFeet;
    RcSlab 38 "slab, reinforced concrete" Deck ReinforcedConcrete SquareFeet;
    PscSlab 39 "slab, prestressed concrete" Deck PrestressedConcrete SquareFeet;
    SteelBoxGirder 102 "box girder, steel" Superstructure Steel Feet;
    PscBoxGirder 104 "box girder, prestressed concrete" Superstructure PrestressedConcrete Feet;
    RcBoxGirder 105 "box girder, reinforced concrete" Superstructure ReinforcedConcrete Feet;
    SteelGirder 107 "girder, steel" Superstructure Steel Feet;
    PscGirder 109 "girder, prestressed concrete" Superstructure PrestressedConcrete Feet;
    RcGirder 110 "girder, reinforced concrete" Superstructure ReinforcedConcrete Feet;
    SteelStringer 113 "stringer, steel" Superstructure Steel Feet;
    PscStringer 115 "stringer, prestressed concrete" Superstructure PrestressedConcrete Feet;
    RcStringer 116 "stringer, reinforced concrete" Superstructure ReinforcedConcrete Feet;
    SteelTruss 120 "truss, steel" Superstructure Steel Feet;
    SteelArch 141 "arch, steel" Superstructure Steel Feet;
    OtherArch 142 "arch, other" Superstructure Other Feet;
    PscArch 143 "arch, prestressed concrete" Superstructure PrestressedConcrete Feet;
    RcArch 144 "arch, reinforced concrete" Superstructure ReinforcedConcrete Feet;
    MasonryArch 145 "arch, masonry" Superstructure Masonry Feet;
    MainCable 147 "main cable, steel" Cable Steel Feet;
    Hanger 148 "hanger, steel" Cable Steel Each;
    OtherSecondaryCable 149 "secondary cable, other" Cable Steel Each;
    SteelFloorBeam 152 "floor beam, steel" Superstructure Steel Feet;
    PscFloorBeam 154 "floor beam, prestressed concrete" Superstructure PrestressedConcrete Feet;
    RcFloorBeam 155 "floor beam, reinforced concrete" Superstructure ReinforcedConcrete Feet;
    Pin 161 "pin or pin and hanger, steel" Superstructure Steel Each;
    GussetPlate 162 "gusset plate, steel" Superstructure Steel Each;
    SteelColumn 202 "column, steel" Substructure Steel Each;
    PscColumn 204 "column, prestressed concrete" Substructure PrestressedConcrete Each;
    RcColumn 205 "column, reinforced concrete" Substructure ReinforcedConcrete Each;
    SteelTower 207 "tower, steel" Substructure Steel Feet;
    RcPierWall 210 "pier wall, reinforced concrete" Substructure ReinforcedConcrete Feet;
    MasonryPierWall 213 "pier wall, masonry" Substructure Masonry Feet;
    RcAbutment 215 "abutment, reinforced concrete" Substructure ReinforcedConcrete Feet;
    MasonryAbutment 217 "abutment, masonry" Substructure Masonry Feet;
    RcFooting 220 "footing, reinforced concrete" Substructure ReinforcedConcrete Feet;
    SteelPile 225 "pile, steel" Substructure Steel Each;
    PscPile 226 "pile, prestressed concrete" Substructure PrestressedConcrete Each;
    RcPile 227 "pile, reinforced concrete" Substructure ReinforcedConcrete Each;
    SteelPierCap 231 "pier cap, steel" Substructure Steel Feet;
    PscPierCap 233 "pier cap, prestressed concrete" Substructure PrestressedConcrete Feet;
    RcPierCap 234 "pier cap, reinforced concrete" Substructure ReinforcedConcrete Feet;
    StripSealJoint 300 "strip seal joint" Joint Other Feet;
    PourableJoint 301 "pourable joint seal" Joint Other Feet;
    CompressionJoint 302 "compression joint seal" Joint Other Feet;
    SealedAssemblyJoint 303 "assembly joint with seal" Joint Other Feet;
    OpenJoint 304 "open joint" Joint Other Feet;
    UnsealedAssemblyJoint 305 "assembly joint without seal" Joint Other Feet;
    OtherJoint 306 "joint, other" Joint Other Feet;
    ElastomericBearing 310 "elastomeric bearing" Bearing Steel Each;
    MovableBearing 311 "movable bearing" Bearing Steel Each;
    EnclosedBearing 312 "enclosed bearing" Bearing Steel Each;
    FixedBearing 313 "fixed bearing" Bearing Steel Each;
    PotBearing 314 "pot bearing" Bearing Steel Each;
    DiskBearing 315 "disk bearing" Bearing Steel Each;
    OtherBearing 316 "bearing, other" Bearing Steel Each;
    PscApproachSlab 320 "approach slab, prestressed concrete" ApproachSlab PrestressedConcrete SquareFeet;
    RcApproachSlab 321 "approach slab, reinforced concrete" ApproachSlab ReinforcedConcrete SquareFeet;
    MetalRailing 330 "railing, metal" Railing Steel Feet;
    RcRailing 331 "railing, reinforced concrete" Railing ReinforcedConcrete Feet;
    TimberRailing 332 "railing, timber" Railing Timber Feet;
    OtherRailing 333 "railing, other" Railing Other Feet;
    MasonryRailing 334 "railing, masonry" Railing Masonry Feet;
    WearingSurface 510 "wearing surface" Protection Other SquareFeet;
    SteelCoating 515 "protective coating of steel" Protection Other SquareFeet;
    RebarProtection 520 "protective system of reinforcing steel" Protection Other SquareFeet;
    ConcreteCoating 521 "protective coating of concrete" Protection Other SquareFeet;
}

impl Element {
    /// A deck drain. The MBEI leaves drains to the agencies, which number their own elements from 800 on (the number is an estimate).
    pub const DECK_DRAIN: Self = Self::Unlisted(850);

    /// Fill between the spandrel walls of a masonry arch: earth or rubble, which the MBEI does not list (the number is an estimate).
    pub const FILL: Self = Self::Unlisted(851);

    /// Returns the defect codes permitted on the element; empty if the simulator has no defects for its material.
    #[must_use]
    pub const fn permitted_defects(self) -> &'static [u32] {
        match self.material() {
            ElementMaterial::ReinforcedConcrete => &[SPALL, REBAR, EFFLORESCENCE, CRACK, ABRASION],
            ElementMaterial::PrestressedConcrete => &[SPALL, REBAR, PSC_CRACK, EFFLORESCENCE, ABRASION],
            ElementMaterial::Steel => &[CORROSION, FATIGUE, CONNECTION],
            ElementMaterial::Masonry => &[EFFLORESCENCE, MORTAR, SPLIT_STONE],
            ElementMaterial::Timber | ElementMaterial::Other => &[],
        }
    }
}

impl From<u16> for Element {
    fn from(number: u16) -> Self {
        Self::from_number(number)
    }
}

impl From<Element> for u16 {
    fn from(element: Element) -> Self {
        element.number()
    }
}

impl Ord for Element {
    fn cmp(&self, other: &Self) -> Ordering {
        self.number().cmp(&other.number())
    }
}

impl PartialOrd for Element {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
