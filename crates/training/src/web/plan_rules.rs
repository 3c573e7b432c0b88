//! Page for the rules of the training plans.

use super::access::Visitor;
use super::layout::{message_lines, page, section, token, toml_editor};
use crate::plan::PlanRules;
use maud::{Markup, html};

/// Contents of the page.
#[derive(Debug, Clone, Copy)]
pub struct PlanRulesPage<'a> {
    /// Text in the editor.
    pub text: &'a str,
    /// Whether this server uses its own rules instead of the shipped ones.
    pub own: bool,
    /// Rules in use; `None` if they are invalid.
    pub rules: Option<&'a PlanRules>,
    /// Result of the last change: `good` or `bad`, and the text, one message per line.
    pub notice: Option<(&'a str, &'a str)>,
}

/// Describes how difficulty adapts.
fn staircase_words(rules: &PlanRules) -> String {
    rules.staircase.map_or_else(
        || "Difficulty does not adapt.".to_owned(),
        |rule| {
            format!(
                "Difficulty adapts: {} harder after a session that met the criterion, {} easier after any other.",
                rule.up, rule.down
            )
        },
    )
}

/// Renders the page.
#[must_use]
pub fn plan_rules_page(visitor: &Visitor, about: &PlanRulesPage<'_>) -> Markup {
    let body = html! {
        @if let Some((kind, words)) = about.notice { (message_lines(kind, words)) }
        p { "The rules determine which scenarios the training plans on this server recommend. " @if about.own { "This server uses its own rules." } @else { "This server uses the shipped rules." } }
        @if let Some(rules) = about.rules {
            p.note { (rules.rules.len()) " rules, criteria for " (rules.drills.len()) " drills. A drill is done after " (rules.mastery_needed) " of " (rules.mastery_of) " sessions at its criterion. " (staircase_words(rules)) }
        }
        (section("edit", "Edit", &toml_editor(visitor, "/plan-rules", ("Rules (TOML)", "rules"), about.text)))
        (section("upload", "Upload", &upload(visitor)))
        @if about.own { (section("reset", "Shipped rules", &html! {
            form method="post" action="/plan-rules/reset" { (token(visitor)) button.danger type="submit" { "Delete own rules" } }
        })) }
    };
    page(visitor, "/trainees", "Training plan rules", &body)
}

fn upload(visitor: &Visitor) -> Markup {
    html! {
        form.stacked method="post" action="/plan-rules/upload" enctype="multipart/form-data" {
            (token(visitor))
            label { "File" input type="file" name="file" accept=".toml" required; }
            button type="submit" { "Validate and save file" }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{DEFAULT_RULES, read_rules};
    use crate::web::layout::tests::administrator;

    #[test]
    fn exact_page_escapes_the_rules_and_shows_the_errors() {
        let rules = read_rules("rules.toml", DEFAULT_RULES).unwrap();
        let about = PlanRulesPage { text: "# </textarea><b>", own: true, rules: Some(&rules), notice: Some(("bad", "one\ntwo")) };
        let text = plan_rules_page(&administrator(), &about).into_string();
        assert!(text.contains("# &lt;/textarea&gt;&lt;b&gt;") && !text.contains("</textarea><b>"));
        assert!(text.contains("<p>one</p><p>two</p>") && text.contains("Delete own rules"));
        assert!(text.contains("done after 2 of 3 sessions"));
        let shipped = plan_rules_page(&administrator(), &PlanRulesPage { own: false, rules: None, notice: None, ..about });
        assert!(!shipped.into_string().contains("Delete own rules"));
    }
}
