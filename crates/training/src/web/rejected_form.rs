//! A form that the server rejected. The page shows it again with what was entered and the problem at its field.

use maud::{Markup, html};

/// A submitted form with its problem.
#[derive(Debug, Clone, Copy)]
pub struct RejectedForm<'a> {
    /// Submitted fields as name and value.
    pub entered: &'a [(String, String)],
    /// Name of the field with the problem.
    pub field: &'a str,
    /// Problem in the visitor's language.
    pub problem: &'a str,
}

/// A field of a form: what it contains, and its problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FormField<'a> {
    name: &'a str,
    /// Entered value; `None` if the form is new.
    pub value: Option<&'a str>,
    problem: Option<&'a str>,
}

impl<'a> FormField<'a> {
    /// Returns a field of a form, which is new without a rejected form.
    #[must_use]
    pub fn of(form: Option<&RejectedForm<'a>>, name: &'a str) -> Self {
        let entered = |form: &RejectedForm<'a>| form.entered.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str());
        let problem = form.filter(|form| form.field == name).map(|form| form.problem);
        Self { name, value: form.and_then(entered), problem }
    }

    /// Returns the value of the input's `aria-invalid` attribute.
    #[must_use]
    pub fn invalid(&self) -> Option<&'static str> {
        self.problem.map(|_| "true")
    }

    /// Returns the value of the input's `aria-describedby` attribute: its problem and the element with `note`, if there are any.
    #[must_use]
    pub fn described_by(&self, note: Option<&str>) -> Option<String> {
        let problem = self.problem.map(|_| self.problem_id());
        let ids: Vec<String> = problem.into_iter().chain(note.map(str::to_owned)).collect();
        (!ids.is_empty()).then(|| ids.join(" "))
    }

    /// Renders the problem below its input; nothing without a problem.
    #[must_use]
    pub fn problem(&self) -> Markup {
        html! { @if let Some(problem) = self.problem { p.field-problem id=(self.problem_id()) role="alert" { (problem) } } }
    }

    fn problem_id(&self) -> String {
        format!("{}-problem", self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_the_problem_is_at_its_field_and_the_others_keep_their_values() {
        let entered = [("name".to_owned(), "a b".to_owned()), ("due".to_owned(), "soon".to_owned())];
        let form = RejectedForm { entered: &entered, field: "due", problem: "invalid <date>" };
        let (name, due) = (FormField::of(Some(&form), "name"), FormField::of(Some(&form), "due"));
        assert_eq!((name.value, name.invalid(), name.described_by(None)), (Some("a b"), None, None));
        assert_eq!(name.problem().into_string(), "");
        assert_eq!((due.value, due.invalid()), (Some("soon"), Some("true")));
        assert_eq!(due.described_by(Some("due-note")).as_deref(), Some("due-problem due-note"));
        assert_eq!(
            due.problem().into_string(),
            "<p class=\"field-problem\" id=\"due-problem\" role=\"alert\">invalid &lt;date&gt;</p>"
        );
        let new = FormField::of(None, "name");
        assert_eq!((new.value, new.invalid(), new.described_by(Some("n"))), (None, None, Some("n".to_owned())));
    }
}
