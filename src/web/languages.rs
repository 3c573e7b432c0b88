//! Selection of the pages' language.

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::state::ServerState;
use spandrel_text::Language;

/// Sets the cookie with the selected language and returns to the page.
pub fn select(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let tag = request.required_field("language")?;
    let known = || Language::ALL.map(Language::tag).join(", ");
    let language = Language::ALL.into_iter().find(|language| language.tag() == tag);
    let language = language.ok_or_else(|| WebError::unknown(request.visitor.language, "language", &known()))?;
    let back = request.form_field("back").filter(|address| is_local(address)).unwrap_or("/");
    let mut answer = WebResponse::redirect(back);
    answer.cookies = vec![state.auth.language_cookie(language)];
    Ok(answer)
}

/// Returns true for a path on this server. Browsers read two slashes, or a slash and a backslash, as the beginning of a host name.
fn is_local(address: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_graphic() && c != '\\';
    address.starts_with('/') && !address.starts_with("//") && address.chars().all(is_plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_only_paths_on_this_server_are_followed() {
        for local in ["/", "/sessions?page=2&trainee=a", "/trainees/anna?incomplete=1", "/x//y"] {
            assert!(is_local(local), "{local}");
        }
        let others = [
            "",
            "sessions",
            "//evil.example",
            "/\\evil.example",
            "\\\\evil.example",
            "https://evil.example",
            "/\t/evil.example",
            "/a\r\nb",
            "/ä",
            " /",
        ];
        for other in others {
            assert!(!is_local(other), "{other:?}");
        }
    }
}
