//! Bridge elements of IFC products, where the class, the predefined type, the part of the bridge and the material leave no doubt.

use crate::elements::Element;
use ifc_lite_core::IfcType;

/// Stands for an undefined type in the table.
const NO_KIND: &str = "-";

/// Family of materials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Material {
    /// Structural steel.
    Steel,
    /// Concrete, without a word on its reinforcement.
    Concrete,
    /// Reinforced concrete.
    Reinforced,
    /// Prestressed concrete.
    Prestressed,
    /// Timber.
    Timber,
    /// Stones or bricks.
    Masonry,
}

/// Part of the bridge that a product belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Location {
    /// The deck.
    Deck,
    /// An abutment.
    Abutment,
    /// A pier.
    Pier,
}

/// Properties of a product that decide its element.
#[derive(Debug, Clone)]
pub(super) struct Traits {
    /// Class of the product.
    pub(super) class: IfcType,
    /// Predefined type; `None` if it is not defined.
    pub(super) kind: Option<String>,
    /// The nearest part of the bridge around it.
    pub(super) location: Option<Location>,
    /// Its material, if it is known and the only one.
    pub(super) material: Option<Material>,
    /// Whether the file has girders. Without them, the slab of a deck is a slab bridge.
    pub(super) has_girders: bool,
}

/// One row of the table of elements.
struct Rule {
    /// Class, with its subclasses.
    class: IfcType,
    /// Predefined types; empty for any. [`NO_KIND`] stands for none.
    kinds: &'static [&'static str],
    /// Required part of the bridge; `None` for any.
    location: Option<Location>,
    /// Whether the row requires girders in the file.
    needs_girders: bool,
    element: Choice,
}

/// How a row determines the element.
#[derive(Clone, Copy)]
enum Choice {
    /// This element, whatever the material.
    Fixed(Element),
    /// By the material. Reinforced concrete is concrete, too.
    ByMaterial(&'static [(Material, Element)]),
}

use Choice::{ByMaterial, Fixed};
use Material::{Concrete, Masonry, Prestressed, Reinforced, Steel, Timber};

const DECKS: Choice = ByMaterial(&[(Concrete, Element::RcDeck), (Prestressed, Element::PscDeck), (Timber, Element::TimberDeck)]);
const APPROACH_SLABS: Choice = ByMaterial(&[(Concrete, Element::RcApproachSlab), (Prestressed, Element::PscApproachSlab)]);
const RAILINGS: Choice = ByMaterial(&[
    (Steel, Element::MetalRailing),
    (Concrete, Element::RcRailing),
    (Timber, Element::TimberRailing),
    (Masonry, Element::MasonryRailing),
]);
const COLUMNS: Choice =
    ByMaterial(&[(Steel, Element::SteelColumn), (Concrete, Element::RcColumn), (Prestressed, Element::PscColumn)]);
const PILES: Choice = ByMaterial(&[(Steel, Element::SteelPile), (Concrete, Element::RcPile), (Prestressed, Element::PscPile)]);
const PIER_CAPS: Choice =
    ByMaterial(&[(Steel, Element::SteelPierCap), (Concrete, Element::RcPierCap), (Prestressed, Element::PscPierCap)]);
// Girders of concrete are often prestressed, so `Concrete` alone leaves a doubt.
const T_BEAMS: Choice = ByMaterial(&[(Reinforced, Element::RcGirder), (Prestressed, Element::PscGirder)]);
const ARCHES: Choice = ByMaterial(&[
    (Steel, Element::SteelArch),
    (Concrete, Element::RcArch),
    (Prestressed, Element::PscArch),
    (Masonry, Element::MasonryArch),
]);
const ABUTMENTS: Choice = ByMaterial(&[(Concrete, Element::RcAbutment), (Masonry, Element::MasonryAbutment)]);
const PIER_WALLS: Choice = ByMaterial(&[(Concrete, Element::RcPierWall), (Masonry, Element::MasonryPierWall)]);

const FOOTINGS: [&str; 5] = ["FOOTING_BEAM", "PAD_FOOTING", "PILE_CAP", "STRIP_FOOTING", "-"];

/// The table of elements: the first row that fits counts. docs/src/how-to/import.md lists it.
static RULES: [Rule; 23] = [
    rule(IfcType::IfcBearing, &["ELASTOMERIC"], None, Fixed(Element::ElastomericBearing)),
    rule(IfcType::IfcBearing, &["ROLLER", "ROCKER"], None, Fixed(Element::MovableBearing)),
    rule(IfcType::IfcBearing, &["POT"], None, Fixed(Element::PotBearing)),
    rule(IfcType::IfcBearing, &["DISK"], None, Fixed(Element::DiskBearing)),
    rule(IfcType::IfcBearing, &["CYLINDRICAL", "SPHERICAL", "GUIDE"], None, Fixed(Element::OtherBearing)),
    rule(IfcType::IfcRailing, &["HANDRAIL", "GUARDRAIL", "BALUSTRADE", "-"], None, RAILINGS),
    rule(IfcType::IfcWall, &["PARAPET"], None, RAILINGS),
    rule(IfcType::IfcWall, &[], Some(Location::Abutment), ABUTMENTS),
    rule(IfcType::IfcWall, &[], Some(Location::Pier), PIER_WALLS),
    rule(IfcType::IfcSlab, &["APPROACH_SLAB"], None, APPROACH_SLABS),
    rule(IfcType::IfcSlab, &["WEARING"], None, Fixed(Element::WearingSurface)),
    rule(IfcType::IfcSlab, &["FLOOR", "USERDEFINED", "-"], Some(Location::Deck), DECKS).on_girders(),
    rule(IfcType::IfcCourse, &["PAVEMENT"], Some(Location::Deck), Fixed(Element::WearingSurface)),
    rule(IfcType::IfcPavement, &[], Some(Location::Deck), Fixed(Element::WearingSurface)),
    rule(IfcType::IfcColumn, &["COLUMN", "STANDCOLUMN", "-"], None, COLUMNS),
    rule(IfcType::IfcFooting, &FOOTINGS, None, ByMaterial(&[(Concrete, Element::RcFooting)])),
    rule(IfcType::IfcPile, &["BORED", "DRIVEN", "COHESION", "FRICTION", "SUPPORT", "-"], None, PILES),
    rule(IfcType::IfcBeam, &["PIERCAP"], None, PIER_CAPS),
    rule(IfcType::IfcBeam, &["T_BEAM"], None, T_BEAMS),
    rule(IfcType::IfcMember, &["ARCH_SEGMENT"], None, ARCHES),
    rule(IfcType::IfcMember, &["CHORD"], None, ByMaterial(&[(Steel, Element::SteelTruss)])),
    rule(IfcType::IfcMember, &["SUSPENSION_CABLE", "STAY_CABLE"], None, Fixed(Element::MainCable)),
    rule(IfcType::IfcMember, &["SUSPENDER"], None, Fixed(Element::Hanger)),
];

const fn rule(class: IfcType, kinds: &'static [&'static str], location: Option<Location>, element: Choice) -> Rule {
    Rule { class, kinds, location, needs_girders: false, element }
}

impl Rule {
    /// Returns the row for files with girders.
    const fn on_girders(mut self) -> Self {
        self.needs_girders = true;
        self
    }
}

/// Returns the element of a product; `None` if there is a doubt.
pub(super) fn element_of(traits: &Traits) -> Option<Element> {
    let kind = traits.kind.as_deref().unwrap_or(NO_KIND);
    let fits = |rule: &&Rule| {
        traits.class.is_subtype_of(rule.class.clone())
            && (rule.kinds.is_empty() || rule.kinds.contains(&kind))
            && (rule.location.is_none() || rule.location == traits.location)
            && (traits.has_girders || !rule.needs_girders)
    };
    match RULES.iter().find(fits)?.element {
        Fixed(element) => Some(element),
        ByMaterial(list) => {
            let by = |material: Material| list.iter().find(|(own, _)| *own == material).map(|(_, element)| *element);
            let material = traits.material?;
            by(material).or_else(|| if material == Reinforced { by(Concrete) } else { None })
        }
    }
}

/// Returns the part of the bridge that the predefined type of an `IfcBridgePart` or an assembly names.
pub(super) fn location(kind: &str) -> Option<Location> {
    match kind {
        "DECK" | "DECK_SEGMENT" => Some(Location::Deck),
        "ABUTMENT" => Some(Location::Abutment),
        "PIER" | "PIER_SEGMENT" => Some(Location::Pier),
        _ => None,
    }
}

/// Parts of words for materials in English, German and Spanish.
const CONCRETE_WORDS: [&str; 4] = ["concrete", "beton", "hormig", "concreto"];
const STEEL_WORDS: [&str; 3] = ["steel", "stahl", "acero"];
const TIMBER_WORDS: [&str; 5] = ["timber", "wood", "glulam", "holz", "madera"];
const MASONRY_WORDS: [&str; 10] =
    ["masonry", "brick", "stone", "mauerwerk", "ziegel", "naturstein", "bruchstein", "mamposter", "ladrillo", "piedra"];
const PRESTRESSED_WORDS: [&str; 13] = [
    "prestressed",
    "pre-stressed",
    "pretension",
    "pre-tension",
    "posttension",
    "post-tension",
    "spannbeton",
    "vorgespannt",
    "pretensad",
    "pretesad",
    "postesad",
    "postensad",
    "presforzad",
];
const REINFORCED_WORDS: [&str; 4] = ["reinforced", "stahlbeton", "armado", "reforzado"];
/// Words of materials that are none of these families, although they contain such words.
const OTHER_WORDS: [&str; 10] = [
    "asphalt",
    "asfált",
    "asfalt",
    "bitum",
    "unreinforced",
    "unbewehrt",
    "sin armar",
    "reinforcing steel",
    "bewehrungsstahl",
    "betonstahl",
];
/// Grades of structural steel (EN 10025).
const STEEL_GRADES: [&str; 6] = ["s235", "s275", "s355", "s420", "s460", "s690"];

/// Returns the family of a material by its name and category; `None` if they name none, or several.
pub(super) fn material(name: &str, category: &str) -> Option<Material> {
    let text = format!("{name} {category}").to_lowercase();
    let has = |words: &[&str]| words.iter().any(|word| text.contains(word));
    if has(&OTHER_WORDS) {
        return None;
    }
    let mut grades = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '/'));
    let has_grade = |is_grade: fn(&str) -> bool| grades.clone().any(is_grade);
    let is_concrete = has(&CONCRETE_WORDS) || has_grade(is_concrete_grade);
    // The German word for reinforced concrete contains the one for steel.
    let plain = text.replace("stahlbeton", "");
    let is_steel = STEEL_WORDS.iter().any(|word| plain.contains(word))
        || grades.any(|word| STEEL_GRADES.iter().any(|grade| word.starts_with(grade)));
    match [is_concrete, is_steel, has(&TIMBER_WORDS), has(&MASONRY_WORDS)] {
        [true, false, false, false] if has(&PRESTRESSED_WORDS) => Some(Prestressed),
        [true, false, false, false] if has(&REINFORCED_WORDS) => Some(Reinforced),
        [true, false, false, false] => Some(Concrete),
        [false, true, false, false] => Some(Steel),
        [false, false, true, false] => Some(Timber),
        [false, false, false, true] => Some(Masonry),
        _ => None,
    }
}

/// Returns whether a word is a grade of concrete (EN 1992): `C`, the strength of cylinders, a slash, the strength of cubes.
fn is_concrete_grade(word: &str) -> bool {
    let is_strength = |text: &str| (2..=3).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
    word.strip_prefix('c').and_then(|rest| rest.split_once('/')).is_some_and(|(a, b)| is_strength(a) && is_strength(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(class: IfcType, kind: &str, location: Option<Location>, material: Option<Material>) -> Option<u16> {
        let kind = (!kind.is_empty()).then(|| kind.to_owned());
        element_of(&Traits { class, kind, location, material, has_girders: true }).map(Element::number)
    }

    #[test]
    fn exact_classes_types_places_and_materials_determine_elements() {
        assert_eq!(number(IfcType::IfcBearing, "ELASTOMERIC", None, None), Some(310));
        assert_eq!(number(IfcType::IfcBearing, "POT", None, Some(Steel)), Some(314));
        assert_eq!(number(IfcType::IfcColumn, "COLUMN", None, Some(Reinforced)), Some(205));
        assert_eq!(number(IfcType::IfcColumn, "", None, Some(Steel)), Some(202));
        assert_eq!(number(IfcType::IfcSlab, "", Some(Location::Deck), Some(Concrete)), Some(12));
        assert_eq!(number(IfcType::IfcWallStandardCase, "STANDARD", Some(Location::Abutment), Some(Concrete)), Some(215));
        assert_eq!(number(IfcType::IfcWall, "PARAPET", Some(Location::Deck), Some(Concrete)), Some(331));
        assert_eq!(number(IfcType::IfcMember, "SUSPENDER", None, None), Some(148));
        assert_eq!(number(IfcType::IfcBeam, "T_BEAM", None, Some(Prestressed)), Some(109));
    }

    #[test]
    fn exact_doubt_leaves_products_without_an_element() {
        assert_eq!(number(IfcType::IfcBearing, "", None, Some(Steel)), None, "its type is not defined");
        assert_eq!(number(IfcType::IfcColumn, "", None, None), None, "its material is unknown");
        assert_eq!(number(IfcType::IfcColumn, "", None, Some(Timber)), None, "no such element");
        assert_eq!(number(IfcType::IfcSlab, "FLOOR", None, Some(Concrete)), None, "in no deck");
        assert_eq!(number(IfcType::IfcBeam, "T_BEAM", None, Some(Concrete)), None, "reinforced or prestressed");
        assert_eq!(number(IfcType::IfcBeam, "GIRDER_SEGMENT", None, Some(Steel)), None, "an open girder or a box");
        assert_eq!(number(IfcType::IfcRailing, "FENCE", None, Some(Steel)), None);
        assert_eq!(number(IfcType::IfcColumn, "PIERSTEM", None, Some(Concrete)), None, "a column or a wall");
        assert_eq!(number(IfcType::IfcPile, "JETGROUTING", None, Some(Concrete)), None, "soil");
    }

    #[test]
    fn exact_materials_are_read_from_words_and_grades() {
        let found = |name: &str| material(name, "");
        assert_eq!(found("S355J2+N"), Some(Steel));
        assert_eq!(found("Baustahl"), Some(Steel));
        assert_eq!(found("C30/37"), Some(Concrete));
        assert_eq!(found("Stahlbeton C40/50"), Some(Reinforced));
        assert_eq!(found("Hormig\u{f3}n pretensado"), Some(Prestressed));
        for prestressed in ["Post-tensioned concrete", "Beton C40/50, vorgespannt", "Concreto presforzado", "Hormigón postesado"]
        {
            assert_eq!(found(prestressed), Some(Prestressed), "{prestressed}");
        }
        assert_eq!(found("Concreto reforzado"), Some(Reinforced));
        assert_eq!(found("Glulam GL24h"), Some(Timber));
        assert_eq!([found("Natursteinquader"), found("Piedra natural")], [Some(Masonry); 2]);
        assert_eq!(found("Natural stone"), Some(Masonry));
        assert_eq!(material("Type 7", "concrete"), Some(Concrete));
        let none = [
            "Asphalt concrete",
            "Asphaltbeton",
            "Hormigón asfáltico",
            "Reinforcing steel",
            "Bewehrungsstahl",
            "Unreinforced concrete",
        ];
        for doubt in ["", "Default", "Steel and concrete", "Betonstahl B500", "S1234", "C3/4 paint", "fiber reinforced polymer"]
            .iter()
            .chain(&none)
        {
            assert_eq!(found(doubt), None, "{doubt}");
        }
    }

    #[test]
    fn exact_locations_are_those_of_bridge_parts() {
        let found = ["DECK_SEGMENT", "ABUTMENT", "PIER", "SUPERSTRUCTURE"].map(location);
        assert_eq!(found, [Some(Location::Deck), Some(Location::Abutment), Some(Location::Pier), None]);
    }
}
