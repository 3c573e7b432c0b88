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

/// Collects the quantities of a bridge.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Amounts(Vec<ElementQuantity>);

impl Amounts {
    /// Adds an amount of an element: an area in m², a length in m or a number.
    pub fn add(&mut self, element: Element, amount: f64) {
        match self.0.iter_mut().find(|quantity| quantity.element == element) {
            Some(quantity) => quantity.amount += amount,
            None => self.0.push(ElementQuantity { element, amount }),
        }
    }

    /// Returns the quantities ordered by element number. Omits elements that the bridge does not have.
    #[must_use]
    pub fn list(mut self) -> Vec<ElementQuantity> {
        self.0.retain(|quantity| quantity.amount > 0.0);
        self.0.sort_by_key(|quantity| quantity.element);
        self.0
    }
}

impl FromIterator<(Element, f64)> for Amounts {
    fn from_iter<I: IntoIterator<Item = (Element, f64)>>(rows: I) -> Self {
        let mut amounts = Self::default();
        for (element, amount) in rows {
            amounts.add(element, amount);
        }
        amounts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_amounts_of_one_element_add_up_in_the_order_of_the_numbers() {
        let rows = [(Element::RcRailing, 8.0), (Element::RcDeck, 2.0), (Element::RcColumn, 0.0), (Element::RcDeck, 3.0)];
        let list = rows.into_iter().collect::<Amounts>().list();
        let expected = [(Element::RcDeck, 5.0), (Element::RcRailing, 8.0)];
        assert_eq!(list, expected.map(|(element, amount)| ElementQuantity { element, amount }));
    }

    #[test]
    fn exact_quantities_have_the_units_of_inspection_reports() {
        let text = |element, amount| ElementQuantity { element, amount }.text();
        assert_eq!(text(Element::RcDeck, 929.0304), "10000 sq ft (929.0 m2)");
        assert_eq!(text(Element::SteelGirder, 304.8), "1000 ft (304.8 m)");
        assert_eq!(text(Element::RcColumn, 6.0), "6 each");
    }
}
