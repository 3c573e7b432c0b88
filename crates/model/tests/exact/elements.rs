//! Tests of the bridge element table against the AASHTO manual, and of the defects on elements and in shipped jobs.

use spandrel_model::defect_codes;
use spandrel_model::elements::{Element, ElementMaterial};
use spandrel_model::scenario::Scenario;
use spandrel_model::shipped;
use spandrel_model::site::Site;

/// Element numbers by material (docs/src/reference/domain.md, "Elements"). Bearings and cables have steel defects.
const REINFORCED_CONCRETE: [u16; 16] = [12, 16, 38, 105, 110, 116, 144, 155, 205, 210, 215, 220, 227, 234, 321, 331];
const PRESTRESSED_CONCRETE: [u16; 12] = [13, 15, 39, 104, 109, 115, 143, 154, 204, 226, 233, 320];
const MASONRY: [u16; 4] = [145, 213, 217, 334];
const STEEL: [u16; 26] = [
    28, 29, 30, 102, 107, 113, 120, 141, 147, 148, 149, 152, 161, 162, 202, 207, 225, 231, 310, 311, 312, 313, 314, 315, 316, 330,
];

#[test]
fn exact_numbers_map_to_elements_with_the_documented_material() {
    assert!(Element::ALL.is_sorted_by(|a, b| a.number() < b.number()));
    for number in 1..=999 {
        let element = Element::from_number(number);
        assert_eq!(element.number(), number);
        assert_eq!(Element::ALL.contains(&element), element != Element::Unlisted(number));
        assert_eq!(element.unit().is_some(), element != Element::Unlisted(number));
        let material = element.material();
        assert_eq!(material == ElementMaterial::ReinforcedConcrete, REINFORCED_CONCRETE.contains(&number), "{number}");
        assert_eq!(material == ElementMaterial::PrestressedConcrete, PRESTRESSED_CONCRETE.contains(&number), "{number}");
        assert_eq!(material == ElementMaterial::Masonry, MASONRY.contains(&number), "{number}");
        assert_eq!(material == ElementMaterial::Steel, STEEL.contains(&number), "{number}");
    }
}

#[test]
fn exact_elements_are_serialized_as_numbers() {
    for element in Element::ALL.iter().copied().chain([Element::Unlisted(850)]) {
        let text = serde_json::to_string(&element).unwrap();
        assert_eq!(text, element.number().to_string());
        assert_eq!(serde_json::from_str::<Element>(&text).unwrap(), element);
        let keyed = std::collections::BTreeMap::from([(element, 1)]);
        assert_eq!(serde_json::to_string(&keyed).unwrap(), format!("{{\"{}\":1}}", element.number()));
    }
}

#[test]
fn exact_permitted_defects_match_the_material() {
    for element in Element::ALL {
        let permitted = element.permitted_defects();
        assert!(permitted.is_sorted(), "{element:?}");
        for code in permitted {
            assert!(defect_codes::ALL.contains(code), "{element:?} has the unknown code {code}");
            // In the MBEI, codes 1000 to 1020 are for metal, 1080 to 1190 for concrete and 1610 to 1640 for masonry; 1110 and 1130 are
            // each for one type of concrete, and 1120 is for masonry, too.
            let legal = match code {
                1000..=1020 => element.material() == ElementMaterial::Steel,
                1110 => element.material() == ElementMaterial::PrestressedConcrete,
                1130 => element.material() == ElementMaterial::ReinforcedConcrete,
                1610..=1640 => element.material() == ElementMaterial::Masonry,
                1120 if element.material() == ElementMaterial::Masonry => true,
                _ => matches!(element.material(), ElementMaterial::ReinforcedConcrete | ElementMaterial::PrestressedConcrete),
            };
            assert!(legal, "{code} is not permitted on {element:?}");
        }
    }
    assert!(Element::Unlisted(850).permitted_defects().is_empty());
}

fn jobs() -> Vec<Scenario> {
    let read = |(name, text): (&str, &str)| {
        spandrel_model::scenario::read(name, text, &|f| Err(format!("no file {f}")))
            .unwrap_or_else(|problems| panic!("{problems}"))
    };
    shipped::SCENARIOS.iter().copied().map(read).collect()
}

#[test]
fn exact_shipped_jobs_have_only_permitted_defects() {
    let mut placed = 0;
    for job in jobs() {
        for element in &job.defects.elements {
            assert!(!element.permitted_defects().is_empty(), "{}: no defect is permitted on {element:?}", job.name);
        }
        for kind in &job.defects.kinds {
            let some = job.defects.elements.iter().any(|element| element.permitted_defects().contains(kind));
            assert!(some || job.defects.elements.is_empty(), "{}: {kind} is not permitted on any of its elements", job.name);
        }
        let site = Site::build(&job, 7);
        for defect in site.defects() {
            let member = site.members().iter().find(|member| member.name == defect.member).unwrap();
            assert_eq!(member.element, defect.element, "{}: {defect:?}", job.name);
            assert!(defect.element.permitted_defects().contains(&defect.kind), "{}: {defect:?}", job.name);
            placed += 1;
        }
        for member in site.members() {
            let unlisted = [Element::DECK_DRAIN, Element::FILL];
            let is_known = Element::ALL.contains(&member.element) || unlisted.contains(&member.element);
            assert!(is_known, "{}: {}", job.name, member.name);
        }
    }
    assert!(placed >= 10, "{placed}");
}
