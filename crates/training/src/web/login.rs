//! Login page and account page.

use super::access::Visitor;
use super::layout::{message, page, section, token};
use maud::{Markup, html};

/// Allowed password length, characters.
pub const PASSWORD_LENGTH_RANGE: std::ops::RangeInclusive<usize> = 12..=256;

/// Minimum strength of a new password: more than 10^8 guesses as estimated by zxcvbn, which considers this safe against
/// offline attacks on a slow hash.
const MIN_PASSWORD_STRENGTH: zxcvbn::Score = zxcvbn::Score::Three;

/// Renders the login page with the error from the previous attempt, if any.
#[must_use]
pub fn login(visitor: &Visitor, name: &str, wrong: Option<&str>) -> Markup {
    page(
        visitor,
        "",
        "Log in",
        &html! {
            section.narrow {
                @if let Some(wrong) = wrong { (message("bad", wrong)) }
                form.stacked method="post" action="/login" {
                    (token(visitor))
                    label { "Name" input name="name" value=(name) required maxlength="32" autocomplete="username" autocapitalize="none"; }
                    label { "Password" input type="password" name="password" required maxlength=(PASSWORD_LENGTH_RANGE.end()) autocomplete="current-password"; }
                    button type="submit" { "Log in" }
                }
            }
        },
    )
}

/// Renders the user's account page with the result of a change, if any.
#[must_use]
pub fn account(visitor: &Visitor, told: Option<(&str, &str)>) -> Markup {
    let name = visitor.name.as_deref().unwrap_or_default();
    let change = html! {
        @if let Some((kind, words)) = told { (message(kind, words)) }
        form.stacked method="post" action="/account" {
            (token(visitor))
            label { "Current password" input type="password" name="present" required maxlength=(PASSWORD_LENGTH_RANGE.end()) autocomplete="current-password"; }
            label { "New password, at least " (PASSWORD_LENGTH_RANGE.start()) " characters" input type="password" name="new" required minlength=(PASSWORD_LENGTH_RANGE.start()) maxlength=(PASSWORD_LENGTH_RANGE.end()) autocomplete="new-password"; }
            button type="submit" { "Change password" }
        }
    };
    page(
        visitor,
        "/account",
        "Account",
        &html! {
            p.lead { (name) ", " (visitor.role.word()) }
            (section("password", "Change password", &change))
            (section("data", "My data", &html! {
                p { a href={ "/trainees/" (name) } { "My progress and plan" } }
                p { a href={ "/trainees/" (name) "/export.json" } { "Download all my data" } }
            }))
        },
    )
}

/// Checks a new password.
///
/// # Errors
/// Returns the problem as text that never includes the password.
pub fn check(password: &str, name: &str) -> Result<(), String> {
    let length = password.chars().count();
    let (least, most) = (PASSWORD_LENGTH_RANGE.start(), PASSWORD_LENGTH_RANGE.end());
    if !PASSWORD_LENGTH_RANGE.contains(&length) || password.len() > 4 * most {
        return Err(format!("the password has {length} characters (allowed: {least} to {most})"));
    }
    // Detects common passwords, names, keyboard patterns, repeated characters and dates, including slight variations.
    let estimate = zxcvbn::zxcvbn(password, &[name, "spandrel"]);
    if estimate.score() < MIN_PASSWORD_STRENGTH {
        let why = estimate.feedback().and_then(|feedback| feedback.warning()).map(|warning| format!(" ({warning})"));
        let why = why.unwrap_or_default();
        return Err(format!("the password is too easy to guess{why}; use several unrelated words"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator};
    use super::*;

    #[test]
    fn exact_login_page_repeats_name_but_not_password() {
        let stranger = Visitor { name: None, ..administrator() };
        let text = login(&stranger, HOSTILE_NAME, Some(HOSTILE_NAME)).into_string();
        assert!(!text.contains("<script>") && text.contains("&lt;script&gt;"), "{text}");
        assert!(account(&administrator(), None).into_string().contains("name=\"present\""));
    }

    #[test]
    fn exact_weak_passwords_are_rejected() {
        for good in ["twelve-chars", "correct horse battery", "quite another one", "Zugspitze 2962 m?"] {
            assert_eq!(check(good, "anna"), Ok(()), "{good}");
        }
        for bad in [
            "short",
            "aaaaaaaaaaaaaaaa",
            &"x".repeat(257),
            "annemarie1234",
            "password1234",
            "123456789012",
            "qwertyuiop123",
            "spandrelspandrel",
        ] {
            let told = check(bad, "annemarie").unwrap_err();
            assert!(!told.contains(bad), "{told}");
        }
    }
}
