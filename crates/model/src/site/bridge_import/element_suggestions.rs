//! Suggests elements for parts by words in their names.

use super::part_report::{name_stem, quoted};
use crate::elements::Element;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Words in the names of parts, and the element that they suggest. The first word that occurs counts.
const WORDS: [(&str, Element); 24] = [
    ("approach", Element::RcApproachSlab),
    ("abutment", Element::RcAbutment),
    ("bearing", Element::ElastomericBearing),
    ("joint", Element::OpenJoint),
    ("cap", Element::RcPierCap),
    ("column", Element::RcColumn),
    ("footing", Element::RcFooting),
    ("foundation", Element::RcFooting),
    ("pile", Element::RcPile),
    ("pier", Element::RcPierWall),
    ("tower", Element::SteelTower),
    ("pylon", Element::SteelTower),
    ("hanger", Element::Hanger),
    ("cable", Element::MainCable),
    ("gusset", Element::GussetPlate),
    ("truss", Element::SteelTruss),
    ("arch", Element::RcArch),
    ("floor", Element::SteelFloorBeam),
    ("stringer", Element::SteelStringer),
    ("girder", Element::SteelGirder),
    ("beam", Element::SteelGirder),
    ("rail", Element::MetalRailing),
    ("parapet", Element::RcRailing),
    ("barrier", Element::RcRailing),
];
/// Words for decks, which may also occur in the names of other members.
const DECK_WORDS: [&str; 3] = ["deck", "slab", "road"];

/// Returns an elements file for parts without an element: one row for all parts whose names differ in numbers only.
pub(super) fn elements_toml(parts: &[String]) -> String {
    let mut text = String::from(
        "# Elements by the names of parts: * stands for any characters, ? for one. The first pattern that matches counts.\n\
         # The numbers are AASHTO MBEI element numbers. Those below are guesses by the names: check them, replace each 0, save the file,\n\
         # and import again with --elements FILE.\nformat = 1\n",
    );
    let mut groups: BTreeMap<String, usize> = BTreeMap::new();
    for name in parts {
        let stem = name_stem(name);
        *groups.entry(if stem.is_empty() { name.clone() } else { format!("{stem}*") }).or_default() += 1;
    }
    for (pattern, count) in groups {
        let (number, name) = suggestion(&pattern).map_or((0, "unknown"), |element| (element.number(), element.name()));
        let count = if count == 1 { "1 part".to_owned() } else { format!("{count} parts") };
        let _ = write!(text, "\n[[elements]]\nparts = {} # {count}\nelement = {number} # {name}\n", quoted(&pattern));
    }
    text
}

fn suggestion(name: &str) -> Option<Element> {
    let lower = name.to_lowercase();
    let by_word = WORDS.iter().find(|(word, _)| lower.contains(word)).map(|(_, element)| *element);
    by_word.or_else(|| DECK_WORDS.iter().any(|word| lower.contains(word)).then_some(Element::RcDeck))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::bridges::element_map::ElementMap;

    #[test]
    fn exact_names_that_differ_in_numbers_share_a_row() {
        let parts = ["Girder_1", "Girder_2", "deck", "3", "Thing"].map(str::to_owned);
        let text = elements_toml(&parts);
        let rows: Vec<&str> = text.lines().filter(|line| line.starts_with("parts") || line.starts_with("element")).collect();
        let expected = [
            "parts = \"3\" # 1 part",
            "element = 0 # unknown",
            "parts = \"Girder_*\" # 2 parts",
            "element = 107 # girder, steel",
            "parts = \"Thing*\" # 1 part",
            "element = 0 # unknown",
            "parts = \"deck*\" # 1 part",
            "element = 12 # deck, reinforced concrete",
        ];
        assert_eq!(rows, expected);
        let map = ElementMap::read("elements.toml", &text.replace("element = 0", "element = 850")).unwrap();
        assert!(parts.iter().all(|part| map.element_of(part).is_some()));
    }
}
