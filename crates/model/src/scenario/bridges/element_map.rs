//! Elements of an imported bridge: a TOML file that assigns an element number to each part by its name, and states the total quantities.
//! At an import, boxes can also divide parts.

use super::paint_box::PaintBox;
use super::quantity::ElementQuantity;
use crate::elements::{Element, ElementUnit};
use crate::mesh::mesh_file::MAX_NAME_CHARS;
use crate::toml::{Problems, Reader, Section};

/// Latest supported format version.
const FORMAT: i64 = 1;
/// Maximum total quantity, m², m or a number (estimate: more than any bridge has).
const MAX_TOTAL: f64 = 1e7;
/// Maximum number of rows.
const MAX_ROWS: usize = 1_000;

/// Assigns elements to the parts of an imported bridge.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ElementMap {
    rows: Vec<ElementRow>,
}

/// Parts of one element.
#[derive(Debug, Clone, PartialEq)]
pub struct ElementRow {
    pattern: String,
    paint_box: Option<PaintBox>,
    name: Option<String>,
    quantity: ElementQuantity,
}

impl ElementRow {
    /// Returns the element.
    #[must_use]
    pub const fn element(&self) -> Element {
        self.quantity.element
    }

    /// Returns the box to which the row is limited.
    #[must_use]
    pub const fn paint_box(&self) -> Option<&PaintBox> {
        self.paint_box.as_ref()
    }

    /// Returns the name of the pieces that the box cuts off.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }
}

/// Where a file is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Use {
    /// In a job: its parts are divided already.
    Job,
    /// At an import.
    Import,
}

impl ElementMap {
    /// Parses the file of a job, which has no boxes. `file` is its name in messages.
    ///
    /// # Errors
    /// Returns all problems in the file, each with line, key, value and allowed range.
    pub fn read(file: &str, text: &str) -> Result<Self, Problems> {
        Self::read_for(Use::Job, file, text)
    }

    /// Parses a file for an import, whose rows can be limited to boxes; otherwise like [`Self::read`].
    ///
    /// # Errors
    /// See [`Self::read`].
    pub fn read_for_import(file: &str, text: &str) -> Result<Self, Problems> {
        Self::read_for(Use::Import, file, text)
    }

    fn read_for(purpose: Use, file: &str, text: &str) -> Result<Self, Problems> {
        let mut r = Reader::new(file, text);
        let mut rows = Vec::new();
        if let Some(document) = r.parse() {
            let mut root = r.root(&document);
            r.integer(&mut root, "format", (1, FORMAT), None);
            let tables = r.sections(&mut root, "elements");
            if tables.len() > MAX_ROWS {
                r.add_problem(&root, "elements", &tables.len().to_string(), "at most 1000 [[elements]]", "too many");
            }
            for mut s in tables.into_iter().take(MAX_ROWS) {
                rows.push(read_row(&mut r, &mut s, purpose));
                r.finish(&s);
            }
            r.finish(&root);
        }
        if r.problems.is_empty() { Ok(Self { rows }) } else { Err(Problems(r.problems)) }
    }

    /// Returns the element of a part: that of the first pattern without a box that matches its name; `None` if there is none.
    #[must_use]
    pub fn element_of(&self, part: &str) -> Option<Element> {
        self.rows.iter().find(|row| row.paint_box.is_none() && matches(&row.pattern, part)).map(ElementRow::element)
    }

    /// Returns all rows.
    #[must_use]
    pub fn rows(&self) -> &[ElementRow] {
        &self.rows
    }

    /// Returns whether a row is limited to a box.
    #[must_use]
    pub fn has_boxes(&self) -> bool {
        self.rows.iter().any(|row| row.paint_box.is_some())
    }

    /// Returns the numbers of the rows that can hold triangles of a part, in the order in which they count: those whose pattern matches
    /// its name, up to the first one without a box.
    #[must_use]
    pub fn rows_of(&self, part: &str) -> Vec<usize> {
        let matching: Vec<usize> = (0..self.rows.len()).filter(|k| matches(&self.rows[*k].pattern, part)).collect();
        let boxes = matching.iter().take_while(|k| self.rows[**k].paint_box.is_some()).count();
        matching.into_iter().take(boxes + 1).collect()
    }

    /// Returns the total quantities that the file states, ordered by element number.
    #[must_use]
    pub fn quantities(&self) -> Vec<ElementQuantity> {
        let mut totals: Vec<ElementQuantity> = Vec::new();
        for ElementRow { quantity, .. } in self.rows.iter().filter(|row| row.quantity.amount > 0.0) {
            match totals.iter_mut().find(|total| total.element == quantity.element) {
                Some(total) => total.amount += quantity.amount,
                None => totals.push(*quantity),
            }
        }
        totals.sort_by_key(|total| total.element);
        totals
    }
}

/// Returns the key of an element's total quantity.
#[must_use]
pub fn total_key(element: Element) -> &'static str {
    match element.unit() {
        Some(ElementUnit::SquareFeet) => "total_m2",
        Some(ElementUnit::Feet) => "total_m",
        Some(ElementUnit::Each) | None => "total_each",
    }
}

fn read_row(r: &mut Reader, s: &mut Section, purpose: Use) -> ElementRow {
    let is_boxed = s.has("box_m");
    let pattern = r.text(s, "parts", is_boxed.then_some("*"));
    let paint_box = PaintBox::read(r, s);
    let name = r.text(s, "name", Some(""));
    if purpose == Use::Job && is_boxed {
        r.add_problem(s, "box_m", "a box", "only in a file for `spandrel import --elements`", "the parts are divided already");
    }
    if !is_boxed && !name.is_empty() {
        r.add_problem(s, "name", &name, "only with box_m", "no box");
    }
    if name != name.trim()
        || name.chars().count() > MAX_NAME_CHARS
        || name.contains(|c: char| c.is_control() || matches!(c, '*' | '?'))
    {
        r.add_problem(s, "name", &name, &format!("at most {MAX_NAME_CHARS} characters, without * and ?"), "not a name of a part");
    }
    let element = Element::from_number(r.integer(s, "element", (1, 999), None) as u16);
    let own = total_key(element);
    let mut amount = 0.0;
    for key in ["total_m2", "total_m", "total_each"] {
        let Some(total) = r.optional_number(s, key, (0.0, MAX_TOTAL)) else { continue };
        amount = total;
        if key != own {
            r.add_problem(s, key, &total.to_string(), &format!("{own} for element {}", element.number()), "another unit");
        }
    }
    let name = Some(name).filter(|name| !name.is_empty());
    ElementRow { pattern, paint_box, name, quantity: ElementQuantity { element, amount } }
}

/// Returns the characters of a name in lower case. Each is converted alone, so that the start of a name is the same in a pattern.
pub(crate) fn lower_case(name: &str) -> impl Iterator<Item = char> + '_ {
    name.chars().flat_map(char::to_lowercase)
}

/// Returns whether a name matches a pattern: `*` stands for any characters, `?` for one. Upper and lower case are the same.
#[must_use]
pub fn matches(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) = (lower_case(pattern).collect(), lower_case(name).collect());
    let (mut at, mut of_name) = (0, 0);
    // Position after the last star, and the position in the name up to which it stands.
    let mut star: Option<(usize, usize)> = None;
    while of_name < name.len() {
        match pattern.get(at) {
            Some('*') => {
                star = Some((at + 1, of_name));
                at += 1;
            }
            Some(c) if *c == '?' || *c == name[of_name] => (at, of_name) = (at + 1, of_name + 1),
            Some(_) | None => match star {
                Some((after, until)) => {
                    star = Some((after, until + 1));
                    (at, of_name) = (after, until + 1);
                }
                None => return false,
            },
        }
    }
    pattern[at..].iter().all(|c| *c == '*')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_patterns_match_whole_names() {
        for (pattern, name) in
            [("girder*", "Girder-3/top"), ("*rail*", "left rail"), ("pier-?", "pier-2"), ("*", ""), ("a*b*c", "aXbYbc")]
        {
            assert!(matches(pattern, name), "{pattern} {name}");
        }
        for (pattern, name) in [("girder", "girder-3"), ("pier-?", "pier-12"), ("", "a"), ("a*b*c", "aXbY"), ("?", "")] {
            assert!(!matches(pattern, name), "{pattern} {name}");
        }
    }

    #[test]
    fn exact_first_pattern_wins_and_totals_add_up() {
        let text = "format = 1\n[[elements]]\nparts = \"girder-x*\"\nelement = 109\n[[elements]]\nparts = \"girder*\"\nelement = 107\ntotal_m = 30\n[[elements]]\nparts = \"beam*\"\nelement = 107\ntotal_m = 12.5\n";
        let map = ElementMap::read("elements.toml", text).unwrap();
        assert_eq!(map.element_of("girder-x2"), Some(Element::PscGirder));
        assert_eq!(map.element_of("girder-2"), Some(Element::SteelGirder));
        assert_eq!(map.element_of("deck"), None);
        assert_eq!(map.quantities(), [ElementQuantity { element: Element::SteelGirder, amount: 42.5 }]);
    }

    #[test]
    fn regress_problems_name_line_key_value_and_allowed() {
        let text = "format = 1\n[[elements]]\nparts = \"deck\"\nelement = 12\ntotal_m = 3\n[[elements]]\nelement = 1000\n";
        let shown: Vec<String> = ElementMap::read("e.toml", text).unwrap_err().0.iter().map(ToString::to_string).collect();
        assert_eq!(shown[0], "e.toml:5: elements[].total_m = 3: another unit (allowed: total_m2 for element 12)");
        assert!(shown[1].contains("elements[].parts") && shown[1].contains("missing"), "{shown:?}");
        assert!(shown[2].contains("e.toml:7: elements[].element = 1000"), "{shown:?}");
    }

    #[test]
    fn exact_rows_of_a_part_end_with_the_first_one_without_a_box() {
        let row = |keys: &str| format!("[[elements]]\nelement = 12\n{keys}\n");
        let square = "box_m = [[0, 0, 0], [1, 1, 1]]";
        let rows = [square.to_owned(), format!("parts = \"pier*\"\n{square}"), "parts = \"p*\"".into(), square.to_owned()];
        let text = format!("format = 1\n{}", rows.map(|keys| row(&keys)).concat());
        let map = ElementMap::read_for_import("e.toml", &text).unwrap();
        assert_eq!((map.rows_of("pier-1"), map.rows_of("pylon"), map.rows_of("deck")), (vec![0, 1, 2], vec![0, 2], vec![0, 3]));
        assert_eq!((map.element_of("pier-1"), map.element_of("deck")), (Some(Element::RcDeck), None));
    }

    #[test]
    fn regress_wrong_boxes_name_line_key_value_and_allowed() {
        let problem = |keys: &str| {
            let text = format!("format = 1\n[[elements]]\nelement = 12\n{keys}\n");
            ElementMap::read_for_import("e.toml", &text).unwrap_err().0[0].to_string()
        };
        let corners = "(allowed: two opposite corners [x, y, z], at least 0.01 m apart along each axis)";
        assert_eq!(
            problem("box_m = [[0, 0, 0], [1, 1, 0]]"),
            format!("e.toml:4: elements[].box_m = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]]: not a box {corners}")
        );
        assert!(problem("box_m = [[0, 0, 0]]").ends_with(corners));
        assert!(problem("box_m = []").ends_with(corners), "no box is not a row for all parts");
        let name = problem("box_m = [[0, 0, 0], [1, 1, 1]]\nname = \"pier*\"");
        assert!(name.contains("elements[].name = pier*: not a name of a part"), "{name}");
        assert!(problem("box_m = [[0, 0, 0], [1, 1, 6000]]").contains("each -5000 to 5000"));
        assert!(
            problem("parts = \"*\"\nbox_turn_deg = 3").contains("elements[].box_turn_deg = 3: no box (allowed: only with box_m)")
        );
        assert!(problem("parts = \"*\"\nname = \"deck\"").contains("elements[].name = deck: no box (allowed: only with box_m)"));
        let job = ElementMap::read("e.toml", "format = 1\n[[elements]]\nelement = 12\nbox_m = [[0, 0, 0], [1, 1, 1]]\n");
        let job = job.unwrap_err().0[0].to_string();
        assert!(
            job.starts_with("e.toml:4: elements[].box_m = a box") && job.contains("only in a file for `spandrel import"),
            "{job}"
        );
    }
}
