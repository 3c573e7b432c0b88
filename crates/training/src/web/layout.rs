//! Elements shared by all pages: document head, navigation, tables, and forms with their CSRF token.

use super::access::{AccessLevel, Visitor};
use super::assets;
use crate::trainee::Role;
use maud::{DOCTYPE, Markup, html};
use spandrel_text::{Language, text};

/// URL of the trainee's own flight page; instructors use the live page.
const OWN_FLIGHT_URL: &str = "/flight";
/// URL of the page with the training stations, which instructors see only on a server that accepts stations.
pub(super) const STATIONS_URL: &str = "/stations";
/// Stands in a message for an element, such as a link, that [`with_element`] inserts.
pub const ELEMENT: &str = "\u{fffc}";

/// Returns the navigation entries: URL, label, required access.
fn navigation_entries(language: Language) -> [(&'static str, String, AccessLevel); 10] {
    [
        ("/sessions", text!(language, "web-nav-sessions"), AccessLevel::Login),
        (OWN_FLIGHT_URL, text!(language, "web-nav-flight"), AccessLevel::Login),
        ("/live", text!(language, "web-nav-live"), AccessLevel::Instructor),
        ("/trainees", text!(language, "web-nav-trainees"), AccessLevel::Instructor),
        (STATIONS_URL, text!(language, "stations-title"), AccessLevel::Instructor),
        ("/classes", text!(language, "web-nav-classes"), AccessLevel::Instructor),
        ("/cohort", text!(language, "web-nav-cohort"), AccessLevel::Instructor),
        ("/scenarios", text!(language, "web-nav-scenarios"), AccessLevel::Login),
        ("/settings", text!(language, "web-nav-settings"), AccessLevel::Administrator),
        ("/account", text!(language, "web-nav-account"), AccessLevel::Login),
    ]
}

/// Renders a page. `at` is the URL of its navigation entry.
#[must_use]
pub fn page(visitor: &Visitor, at: &str, title: &str, body: &Markup) -> Markup {
    page_with_script(visitor, at, title, None, body)
}

/// Renders a page that loads one of the scripts in [`assets`].
#[must_use]
pub fn page_with_script(visitor: &Visitor, at: &str, title: &str, script: Option<&str>, body: &Markup) -> Markup {
    page_in_language(visitor, at, title, (visitor.language.tag(), script), body)
}

/// Renders a page whose title and body are in the language with this tag. The rest is in the visitor's language, and has its own
/// `lang` attribute if that is another one.
#[must_use]
pub fn page_in_language(
    visitor: &Visitor,
    at: &str,
    title: &str,
    (language, script): (&str, Option<&str>),
    body: &Markup,
) -> Markup {
    let own_language = Some(visitor.language.tag()).filter(|tag| *tag != language);
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
                a.skip href="#main" lang=[own_language] { (text!(visitor.language, "web-skip")) }
                header.bar lang=[own_language] { (navigation_bar(visitor, at)) }
                main id="main" { h1 { (title) } (body) }
                // A form without a token would be refused.
                @if !visitor.token.is_empty() { footer.site lang=[own_language] { (language_form(visitor, at)) } }
            }
        }
    }
}

fn navigation_bar(visitor: &Visitor, at: &str) -> Markup {
    let language = visitor.language;
    let is_shown = |address: &str, needs: AccessLevel| {
        let without_account = visitor.open && address == "/account";
        let flies_elsewhere = visitor.satisfies(AccessLevel::Instructor) && address == OWN_FLIGHT_URL;
        let without_stations = !visitor.has_stations && address == STATIONS_URL;
        visitor.satisfies(needs) && !without_account && !flies_elsewhere && !without_stations
    };
    html! {
        a.brand href="/" { "Spandrel" }
        nav aria-label=(text!(language, "web-nav")) {
            @for (address, label, needs) in navigation_entries(language) {
                @if is_shown(address, needs) { a href=(address) aria-current=[(address == at).then_some("page")] { (label) } }
            }
        }
        @if let Some(name) = &visitor.name {
            form.who method="post" action="/logout" {
                (token(visitor))
                span { (name_and_role(language, name, visitor.role)) }
                button type="submit" { (text!(language, "web-log-out")) }
            }
        } @else if visitor.open {
            p.who { (text!(language, "web-open")) }
        }
    }
}

/// Renders the buttons that select the language of the pages, each with the language's own name.
fn language_form(visitor: &Visitor, at: &str) -> Markup {
    let back = if visitor.address.is_empty() { at } else { &visitor.address };
    html! {
        form method="post" action="/language" {
            (token(visitor))
            input type="hidden" name="back" value=(back);
            div role="group" aria-labelledby="language-choice" {
                span id="language-choice" { (text!(visitor.language, "web-language")) }
                @for one in Language::ALL {
                    button type="submit" name="language" value=(one.tag()) lang=(one.tag()) aria-current=[(one == visitor.language).then_some("true")] { (one.name()) }
                }
            }
        }
    }
}

/// Returns a user's pseudonym and role.
pub(super) fn name_and_role(language: Language, name: &str, role: Role) -> String {
    text!(language, "web-who", name = name, role = role_text(language, role))
}

/// Returns the name of a role.
#[must_use]
pub fn role_text(language: Language, role: Role) -> String {
    match role {
        Role::Trainee => text!(language, "web-role-trainee"),
        Role::Instructor => text!(language, "web-role-instructor"),
        Role::Administrator => text!(language, "web-role-administrator"),
    }
}

/// Renders a message with an element in place of [`ELEMENT`].
#[must_use]
pub fn with_element(message: &str, element: &Markup) -> Markup {
    let (before, after) = message.split_once(ELEMENT).unwrap_or((message, ""));
    html! { (before) (element) (after) }
}

/// Returns the value of the `data-texts` attribute, from which a page's script takes the texts that it shows.
#[must_use]
pub fn script_texts<const N: usize>(texts: [(&str, String); N]) -> String {
    let texts: serde_json::Map<String, serde_json::Value> =
        texts.into_iter().map(|(name, text)| (name.to_owned(), text.into())).collect();
    serde_json::Value::Object(texts).to_string()
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

/// Largest number of details that are not folded.
const MAX_OPEN_DETAILS: usize = 3;

/// Result of a change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Notice<'a> {
    /// CSS class: `good`, `warn` or `bad`.
    pub kind: &'a str,
    /// Text in the visitor's language.
    pub text: &'a str,
    /// Error messages about a file, one per line, in English; empty if there are none.
    pub details: &'a str,
}

impl<'a> Notice<'a> {
    /// Returns the notice of a success.
    #[must_use]
    pub fn good(text: &'a str) -> Self {
        Self { kind: "good", text, details: "" }
    }

    /// Returns the notice of a refusal without details.
    #[must_use]
    pub fn bad(text: &'a str) -> Self {
        Self { kind: "bad", text, details: "" }
    }

    /// Renders the details. Many lines fold into the first one, which tells how many there are.
    fn detail_lines(&self) -> Markup {
        let lines: Vec<&str> = self.details.lines().collect();
        let paragraphs = |lines: &[&str]| html! { @for line in lines { p { (line) } } };
        match lines.split_first() {
            Some((first, rest)) if lines.len() > MAX_OPEN_DETAILS => {
                html! { details { summary { (first) " (+" (rest.len()) ")" } (paragraphs(rest)) } }
            }
            _ => paragraphs(&lines),
        }
    }

    /// Renders a message box with one paragraph per line.
    #[must_use]
    pub fn render(&self) -> Markup {
        html! {
            div class={ "message " (self.kind) } role="status" {
                @for line in self.text.lines() { p { (line) } }
                @if !self.details.is_empty() { div lang="en" { (self.detail_lines()) } }
            }
        }
    }
}

/// Renders the form that edits a TOML file; `action` receives the text in a field with the given label and name.
#[must_use]
pub fn toml_editor(visitor: &Visitor, action: &str, (label, name): (&str, &str), text: &str) -> Markup {
    html! {
        p { (text!(visitor.language, "web-toml-note")) }
        form.stacked method="post" action=(action) {
            (token(visitor))
            // A browser drops the first line break in the field.
            label { (label) textarea.code name=(name) rows="30" spellcheck="false" required { "\n" (text) } }
            button type="submit" { (text!(visitor.language, "web-validate-and-save")) }
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
pub fn table(caption: &str, heads: &[(String, bool)], rows: &Markup) -> Markup {
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

/// Renders page navigation for a list; page numbers start at 1.
#[must_use]
pub fn page_navigation(language: Language, address: &str, at: u32, last: u32) -> Markup {
    let link = |page: u32, text: String, here: bool| {
        html! { @if here { a href={ (address) "page=" (page) } { (text) } } @else { span.off { (text) } } }
    };
    html! {
        @if last > 1 {
            nav.pages aria-label=(text!(language, "web-pages")) {
                (link(1, text!(language, "web-pages-newest"), at > 1))
                (link(at.saturating_sub(1), text!(language, "web-pages-newer"), at > 1))
                span { (text!(language, "web-pages-at", page = at, last = last)) }
                (link(at + 1, text!(language, "web-pages-older"), at < last))
                (link(last, text!(language, "web-pages-oldest"), at < last))
            }
        }
    }
}

/// Renders an error page.
#[must_use]
pub fn refusal(visitor: &Visitor, title: &str, text: &str) -> Markup {
    let body = html! { section { @for line in text.lines() { p { (line) } } p { a href="/" { (text!(visitor.language, "web-home")) } } } };
    page(visitor, "", title, &body)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A name that attempts script injection.
    pub(crate) const HOSTILE_NAME: &str = "<script>alert(1)</script>\"'&";

    pub(crate) fn administrator() -> Visitor {
        Visitor {
            name: Some(HOSTILE_NAME.into()),
            role: Role::Administrator,
            open: false,
            token: "t0ken".into(),
            language: Language::English,
            has_stations: false,
            address: String::new(),
        }
    }

    #[test]
    fn exact_many_details_of_a_notice_fold_into_one_line_that_opens() {
        let shown = |details: &str| Notice { kind: "bad", text: "Not saved.", details }.render().into_string();
        assert!(!shown("one\ntwo\nthree").contains("<details>"), "a few lines stay visible");
        let folded = shown("one\ntwo\nthree\nfour");
        assert!(folded.contains("<details><summary>one (+3)</summary><p>two</p><p>three</p><p>four</p></details>"), "{folded}");
    }

    /// Panics if texts of a page are not in the catalogs: with the pseudo language, all letters of the catalogs have accents.
    /// Elements with a `lang` attribute and `code` elements are not checked, nor are the given words, which are names or units.
    pub(crate) fn check_translated(page: &str, names: &[&str]) {
        let body = page.split_once("<main").map_or(page, |(_, body)| body);
        let texts = visible_texts(body);
        for text in texts {
            let words = text.split(|c: char| !c.is_alphanumeric() && c != '-' && c != '_');
            for word in words.filter(|word| word.len() > 2 && word.chars().all(|c| c.is_ascii_alphabetic())) {
                assert!(names.contains(&word), "{word:?} in {text:?} is not translated");
            }
        }
    }

    /// Returns the texts between tags and the labels, except for those in another language and in code.
    fn visible_texts(body: &str) -> Vec<String> {
        let (mut texts, mut hidden) = (Vec::new(), Vec::<String>::new());
        for part in body.split('<').skip(1) {
            let (tag, text) = part.split_once('>').unwrap_or((part, ""));
            let name = tag.trim_start_matches('/').split_whitespace().next().unwrap_or_default().to_owned();
            let skips = tag.contains(" lang=") || ["code", "svg", "textarea"].contains(&name.as_str());
            match (tag.starts_with('/'), hidden.last()) {
                (true, Some(open)) if *open == name => drop(hidden.pop()),
                (false, Some(open)) if *open == name => hidden.push(name),
                (false, None) if skips => hidden.push(name),
                (_, Some(_)) => {}
                (_, None) => {
                    let labels = [" aria-label=\"", " alt=\"", " title=\"", " placeholder=\""];
                    let label = |start: &str| Some(tag.split_once(start)?.1.split('"').next()?.to_owned());
                    texts.extend(labels.into_iter().filter_map(label));
                }
            }
            if hidden.is_empty() {
                texts.push(text.to_owned());
            }
        }
        texts
    }

    /// Returns a visitor with another language.
    pub(crate) fn administrator_with(language: Language) -> Visitor {
        Visitor { language, ..administrator() }
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
        for (has_stations, visitor) in [(false, administrator()), (true, administrator()), (true, trainee)] {
            let shows = has_stations && visitor.satisfies(AccessLevel::Instructor);
            let text = page(&Visitor { has_stations, ..visitor }, "", "x", &html! {}).into_string();
            assert_eq!(text.contains("href=\"/stations\""), shows, "{text}");
        }
        let stranger = Visitor { name: None, ..administrator() };
        let text = page(&stranger, "", "x", &html! {}).into_string();
        assert!(!text.contains("\"/sessions\"") && !text.contains("Log out"));
    }

    #[test]
    fn exact_single_page_list_has_no_links() {
        assert_eq!(page_navigation(Language::English, "/x?", 1, 1).into_string(), "");
        let text = page_navigation(Language::English, "/x?trainee=a&", 2, 3).into_string();
        assert!(text.contains("/x?trainee=a&amp;page=1") && text.contains("page=3") && text.contains("page 2 of 3"), "{text}");
    }

    #[test]
    fn exact_every_page_offers_all_languages_and_returns_to_its_address() {
        let visitor = Visitor { address: "/sessions?page=2&a=\"b".into(), ..administrator_with(Language::German) };
        let text = page(&visitor, "/sessions", "x", &html! {}).into_string();
        check(&text);
        assert!(text.contains("<html lang=\"de\">") && text.contains("<header class=\"bar\">"), "{text}");
        assert!(
            text.contains(">Zum Inhalt springen<") && text.contains(">Sitzungen</a>") && text.contains(">Abmelden<"),
            "{text}"
        );
        assert!(text.contains("name=\"back\" value=\"/sessions?page=2&amp;a=&quot;b\""), "{text}");
        assert!(text.contains("value=\"de\" lang=\"de\" aria-current=\"true\">Deutsch<"), "{text}");
        assert!(
            text.contains("value=\"es\" lang=\"es\">Español<") && text.contains("value=\"en\" lang=\"en\">English<"),
            "{text}"
        );
        let after_change = page(&administrator(), "/sessions", "x", &html! {}).into_string();
        assert!(after_change.contains("name=\"back\" value=\"/sessions\""), "{after_change}");
        let without_session = Visitor { token: String::new(), name: None, ..administrator() };
        assert!(!page(&without_session, "", "x", &html! {}).into_string().contains("/language"));
    }

    #[test]
    fn exact_the_bar_has_its_own_language_if_the_page_has_another() {
        let text = page_in_language(&administrator(), "", "x", ("de", None), &html! {}).into_string();
        assert!(text.contains("<html lang=\"de\">") && text.contains("<header class=\"bar\" lang=\"en\">"), "{text}");
    }

    #[test]
    fn exact_layout_is_translated() {
        let visitor = administrator_with(Language::Pseudo);
        let text = page(&visitor, "", "", &page_navigation(visitor.language, "/x?", 1, 2)).into_string();
        check_translated(&text, &[]);
        let bar = text.split_once("<main").unwrap().0.replace("Spandrel", "").replace(HOSTILE_NAME, "");
        assert!(!bar.contains("Sessions") && !bar.contains("Log out") && bar.contains("Šééšš"), "{bar}");
        check_translated(&refusal(&visitor, "", "").into_string(), &[]);
        check_translated(&toml_editor(&visitor, "/x", ("", ""), "").into_string(), &[]);
    }

    #[test]
    fn exact_elements_are_inserted_into_messages() {
        let link = html! { a href="/x" { "x" } };
        assert_eq!(
            with_element(&format!("<before {ELEMENT} after"), &link).into_string(),
            "&lt;before <a href=\"/x\">x</a> after"
        );
        assert_eq!(script_texts([("a", "\"</script>".to_owned())]), "{\"a\":\"\\\"</script>\"}");
    }
}
