//! Elements shared by all pages: document head, navigation, tables, and forms with their CSRF token.

use super::access::{AccessLevel, Visitor};
use super::assets;
use maud::{DOCTYPE, Markup, html};

/// URL of the trainee's own flight page; instructors use the live page.
const OWN_FLIGHT_URL: &str = "/flight";
/// Navigation entries: URL, label, required access.
const NAVIGATION_ENTRIES: [(&str, &str, AccessLevel); 10] = [
    ("/sessions", "Sessions", AccessLevel::Login),
    (OWN_FLIGHT_URL, "My flight", AccessLevel::Login),
    ("/live", "Live", AccessLevel::Instructor),
    ("/trainees", "Trainees", AccessLevel::Instructor),
    ("/stations", "Stations", AccessLevel::Instructor),
    ("/classes", "Classes", AccessLevel::Instructor),
    ("/cohort", "Cohort", AccessLevel::Instructor),
    ("/scenarios", "Scenarios", AccessLevel::Login),
    ("/settings", "Settings", AccessLevel::Administrator),
    ("/account", "Account", AccessLevel::Login),
];

/// Renders a page. `at` is the URL of its navigation entry.
#[must_use]
pub fn page(visitor: &Visitor, at: &str, title: &str, body: &Markup) -> Markup {
    page_with_script(visitor, at, title, None, body)
}

/// Renders a page that loads one of the scripts in [`assets`].
#[must_use]
pub fn page_with_script(visitor: &Visitor, at: &str, title: &str, script: Option<&str>, body: &Markup) -> Markup {
    page_in_language(visitor, at, title, ("en", script), body)
}

/// Renders a page whose body is in another language. The navigation stays in English and has its own `lang` attribute.
#[must_use]
pub fn page_in_language(
    visitor: &Visitor,
    at: &str,
    title: &str,
    (language, script): (&str, Option<&str>),
    body: &Markup,
) -> Markup {
    html! {
        (DOCTYPE)
        html lang=(language) {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) " · Spandrel" }
                link rel="icon" href="data:,";
                link rel="stylesheet" href=(assets::asset_url(assets::STYLE_NAME));
                @if let Some(script) = script { script src=(assets::asset_url(script)) defer {} }
            }
            body.web {
                a.skip href="#main" lang="en" { "Skip to content" }
                (navigation_bar(visitor, at))
                main id="main" { h1 { (title) } (body) }
            }
        }
    }
}

fn navigation_bar(visitor: &Visitor, at: &str) -> Markup {
    html! {
        header.bar lang="en" {
            a.brand href="/" { "Spandrel" }
            nav aria-label="Main" {
                @for (address, text, needs) in NAVIGATION_ENTRIES {
                    @if visitor.satisfies(needs) && !(visitor.open && address == "/account") && !(visitor.satisfies(AccessLevel::Instructor) && address == OWN_FLIGHT_URL) {
                        a href=(address) aria-current=[(address == at).then_some("page")] { (text) }
                    }
                }
            }
            @if let Some(name) = &visitor.name {
                form.who method="post" action="/logout" {
                    (token(visitor))
                    span { (name) ", " (visitor.role.word()) }
                    button type="submit" { "Log out" }
                }
            } @else if visitor.open {
                p.who { "Local access, no login" }
            }
        }
    }
}

/// Renders the hidden field with the CSRF token.
#[must_use]
pub fn token(visitor: &Visitor) -> Markup {
    html! { input type="hidden" name="token" value=(visitor.token); }
}

/// Renders a message box; `kind` is its CSS class.
#[must_use]
pub fn message(kind: &str, text: &str) -> Markup {
    html! { p class={ "message " (kind) } role="status" { (text) } }
}

/// Renders a message box with one paragraph per line; `kind` is its CSS class.
#[must_use]
pub fn message_lines(kind: &str, text: &str) -> Markup {
    html! { div class={ "message " (kind) } role="status" { @for line in text.lines() { p { (line) } } } }
}

/// Renders the form that edits a TOML file; `action` receives the text in a field with the given label and name.
#[must_use]
pub fn toml_editor(visitor: &Visitor, action: &str, (label, name): (&str, &str), text: &str) -> Markup {
    html! {
        p { "The file is validated before it is saved, and all errors are listed with line and key. The comments at its beginning explain the format." }
        form.stacked method="post" action=(action) {
            (token(visitor))
            // A browser drops the first line break in the field.
            label { (label) textarea.code name=(name) rows="30" spellcheck="false" required { "\n" (text) } }
            button type="submit" { "Validate and save" }
        }
    }
}

/// Renders a section with its heading.
#[must_use]
pub fn section(id: &str, heading: &str, body: &Markup) -> Markup {
    html! { section aria-labelledby={ (id) "-head" } id=(id) { h2 id={ (id) "-head" } { (heading) } (body) } }
}

/// Renders a table that scrolls horizontally if necessary.
#[must_use]
pub fn table(caption: &str, heads: &[(&str, bool)], rows: &Markup) -> Markup {
    html! {
        div.scroll tabindex="0" role="region" aria-label=(caption) {
            table.list {
                caption { (caption) }
                thead { tr { @for (head, number) in heads { th scope="col" .number[*number] { (head) } } } }
                tbody { (rows) }
            }
        }
    }
}

/// Returns a number with its noun, such as "1 class" or "2 classes".
#[must_use]
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// Renders page navigation for a list; page numbers start at 1.
#[must_use]
pub fn page_navigation(address: &str, at: u32, last: u32) -> Markup {
    let link = |page: u32, text: &str, here: bool| {
        html! { @if here { a href={ (address) "page=" (page) } { (text) } } @else { span.off { (text) } } }
    };
    html! {
        @if last > 1 {
            nav.pages aria-label="Pages" {
                (link(1, "newest", at > 1))
                (link(at.saturating_sub(1), "newer", at > 1))
                span { "page " (at) " of " (last) }
                (link(at + 1, "older", at < last))
                (link(last, "oldest", at < last))
            }
        }
    }
}

/// Renders an error page.
#[must_use]
pub fn refusal(visitor: &Visitor, title: &str, text: &str) -> Markup {
    page(
        visitor,
        "",
        title,
        &html! { section { @for line in text.lines() { p { (line) } } p { a href="/" { "Back to the home page" } } } },
    )
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::trainee::Role;
    use spandrel_text::Language;

    /// A name that attempts script injection.
    pub(crate) const HOSTILE_NAME: &str = "<script>alert(1)</script>\"'&";

    pub(crate) fn administrator() -> Visitor {
        Visitor {
            name: Some(HOSTILE_NAME.into()),
            role: Role::Administrator,
            open: false,
            token: "t0ken".into(),
            language: Language::English,
        }
    }

    /// Panics if the page contains unescaped text or anything blocked by the content security policy.
    pub(crate) fn check(page: &str) {
        assert!(!page.contains("<script>") && !page.contains(" style=") && !page.contains(" onclick="), "{page}");
        for form in page.split("<form").skip(1) {
            let form = form.split("</form>").next().unwrap_or_default();
            let posts = form.contains("method=\"post\"");
            assert_eq!(posts, form.contains("name=\"token\""), "POST forms contain the token, other forms do not: {form}");
        }
    }

    #[test]
    fn exact_names_are_escaped_and_forms_contain_token() {
        let text = page(&administrator(), "/sessions", HOSTILE_NAME, &html! { p { (HOSTILE_NAME) } }).into_string();
        check(&text);
        assert!(text.contains("href=\"/sessions\" aria-current=\"page\""), "{text}");
    }

    #[test]
    fn exact_navigation_shows_only_accessible_pages() {
        let trainee = Visitor { role: Role::Trainee, ..administrator() };
        let text = page(&trainee, "", "x", &html! {}).into_string();
        assert!(text.contains("/sessions") && !text.contains("\"/trainees\"") && !text.contains("\"/settings\""));
        let stranger = Visitor { name: None, ..administrator() };
        let text = page(&stranger, "", "x", &html! {}).into_string();
        assert!(!text.contains("\"/sessions\"") && !text.contains("Log out"));
    }

    #[test]
    fn exact_single_page_list_has_no_links() {
        assert_eq!(page_navigation("/x?", 1, 1).into_string(), "");
        let text = page_navigation("/x?trainee=a&", 2, 3).into_string();
        assert!(text.contains("/x?trainee=a&amp;page=1") && text.contains("page=3") && text.contains("page 2 of 3"), "{text}");
    }
}
