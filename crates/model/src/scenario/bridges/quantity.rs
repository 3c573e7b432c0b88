//! Total quantities of a bridge's elements, as in an inspection report. The AASHTO *Manual for Bridge Element Inspection* defines what
//! is measured: decks by area, girders, arches, cables and railings by length along the road, caps, walls and joints by length across
//! it, towers by height, and hangers, columns and bearings by number.

use crate::elements::{Element, ElementUnit};

/// Length of a foot, m.
const FOOT_M: f64 = 0.3048;

/// Total quantity of an element of a bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementQuantity {
    /// The element.
    pub element: Element,
    /// Area in m², length in m or number, depending on the element's unit.
    pub amount: f64,
}

impl ElementQuantity {
    /// Creates a list from elements and amounts. Omits elements that the bridge does not have.
    pub(super) fn list(amounts: &[(Element, f64)]) -> Vec<Self> {
        let present = amounts.iter().filter(|(_, amount)| *amount > 0.0);
        present.map(|(element, amount)| Self { element: *element, amount: *amount }).collect()
    }

    /// Returns the amount in the unit of inspection reports: ft², ft or a number.
    #[must_use]
    pub fn reported(&self) -> f64 {
        match self.element.unit() {
            Some(ElementUnit::SquareFeet) => self.amount / (FOOT_M * FOOT_M),
            Some(ElementUnit::Feet) => self.amount / FOOT_M,
            Some(ElementUnit::Each) | None => self.amount,
        }
    }

    /// Returns the quantity with its unit, in inspection reports and in SI, such as "1828 ft (557.2 m)".
    #[must_use]
    pub fn text(&self) -> String {
        let reported = self.reported();
        match self.element.unit() {
            Some(ElementUnit::SquareFeet) => format!("{reported:.0} sq ft ({:.1} m2)", self.amount),
            Some(ElementUnit::Feet) => format!("{reported:.0} ft ({:.1} m)", self.amount),
            Some(ElementUnit::Each) | None => format!("{reported:.0} each"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_quantities_have_the_units_of_inspection_reports() {
        let text = |element, amount| ElementQuantity { element, amount }.text();
        assert_eq!(text(Element::RcDeck, 929.0304), "10000 sq ft (929.0 m2)");
        assert_eq!(text(Element::SteelGirder, 304.8), "1000 ft (304.8 m)");
        assert_eq!(text(Element::RcColumn, 6.0), "6 each");
    }
}
