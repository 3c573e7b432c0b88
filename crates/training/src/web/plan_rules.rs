//! Page for the rules of the training plans.

use super::access::Visitor;
use super::layout::{Notice, page, section, token, toml_editor};
use crate::plan::PlanRules;
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// Contents of the page.
#[derive(Debug, Clone, Copy)]
pub struct PlanRulesPage<'a> {
    /// Text in the editor.
    pub text: &'a str,
    /// Whether this server uses its own rules instead of the shipped ones.
    pub own: bool,
    /// Rules in use; `None` if they are invalid.
    pub rules: Option<&'a PlanRules>,
    /// Result of the last change.
    pub notice: Option<Notice<'a>>,
}

/// Describes how difficulty adapts.
fn staircase_words(language: Language, rules: &PlanRules) -> String {
    match rules.staircase {
        Some(rule) => text!(language, "editor-rules-staircase", up = rule.up, down = rule.down),
        None => text!(language, "editor-rules-no-staircase"),
    }
}

/// Describes the number of rules and criteria, and when a drill is done.
fn summary(language: Language, rules: &PlanRules) -> String {
    let (count, drills) = (rules.rules.len(), rules.drills.len());
    let (needed, of) = (rules.mastery_needed, rules.mastery_of);
    text!(language, "editor-rules-summary", rules = count, drills = drills, needed = needed, of = of)
}

/// Renders the page.
#[must_use]
pub fn plan_rules_page(visitor: &Visitor, about: &PlanRulesPage<'_>) -> Markup {
    let language = visitor.language;
    let label = text!(language, "editor-rules-toml");
    let body = html! {
        @if let Some(notice) = about.notice { (notice.render()) }
        p { @if about.own { (text!(language, "editor-rules-own")) } @else { (text!(language, "editor-rules-shipped")) } }
        @if let Some(rules) = about.rules {
            p.note { (summary(language, rules)) " " (staircase_words(language, rules)) }
        }
        (section("edit", &text!(language, "editor-edit"), &toml_editor(visitor, "/plan-rules", (&label, "rules"), about.text)))
        (section("upload", &text!(language, "editor-rules-upload"), &upload(visitor)))
        @if about.own { (section("reset", &text!(language, "editor-rules-reset"), &html! {
            form method="post" action="/plan-rules/reset" { (token(visitor)) button.danger type="submit" { (text!(language, "editor-rules-delete")) } }
        })) }
    };
    page(visitor, "/trainees", &text!(language, "editor-rules-title"), &body)
}

fn upload(visitor: &Visitor) -> Markup {
    html! {
        form.stacked method="post" action="/plan-rules/upload" enctype="multipart/form-data" {
            (token(visitor))
            label { (text!(visitor.language, "editor-file")) input type="file" name="file" accept=".toml" required; }
            button type="submit" { (text!(visitor.language, "editor-rules-upload-button")) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{DEFAULT_RULES, read_rules};
    use crate::web::layout::tests::{administrator, administrator_with, check_translated};

    #[test]
    fn exact_page_escapes_the_rules_and_shows_the_errors() {
        let rules = read_rules("rules.toml", DEFAULT_RULES).unwrap();
        let about =
            PlanRulesPage { text: "# </textarea><b>", own: true, rules: Some(&rules), notice: Some(Notice::bad("one\ntwo")) };
        let text = plan_rules_page(&administrator(), &about).into_string();
        assert!(text.contains("# &lt;/textarea&gt;&lt;b&gt;") && !text.contains("</textarea><b>"));
        assert!(text.contains("<p>one</p><p>two</p>") && text.contains("Delete own rules"));
        assert!(text.contains("done after 2 of 3 sessions"));
        for own in [true, false] {
            let about = PlanRulesPage { text: "", own, notice: None, ..about };
            check_translated(&plan_rules_page(&administrator_with(Language::Pseudo), &about).into_string(), &["TOML"]);
            let german = plan_rules_page(&administrator_with(Language::German), &about).into_string();
            assert!(german.contains("wenn 2 von 3 Sitzungen ihr Kriterium erfüllen"), "{german}");
        }
        let shipped = plan_rules_page(&administrator(), &PlanRulesPage { own: false, rules: None, notice: None, ..about });
        assert!(!shipped.into_string().contains("Delete own rules"));
    }
}
