//! Login page and account page.

use super::access::Visitor;
use super::layout::{message, name_and_role, page, section, token};
use maud::{Markup, html};
use spandrel_text::{Language, text};
use zxcvbn::feedback::Warning;

/// Allowed password length, characters.
pub const PASSWORD_LENGTH_RANGE: std::ops::RangeInclusive<usize> = 12..=256;

/// Minimum strength of a new password: more than 10^8 guesses as estimated by zxcvbn, which considers this safe against
/// offline attacks on a slow hash.
const MIN_PASSWORD_STRENGTH: zxcvbn::Score = zxcvbn::Score::Three;

/// Renders the login page with the error from the previous attempt, if any.
#[must_use]
pub fn login(visitor: &Visitor, name: &str, wrong: Option<&str>) -> Markup {
    let language = visitor.language;
    page(
        visitor,
        "",
        &text!(language, "web-login"),
        &html! {
            section.narrow {
                @if let Some(wrong) = wrong { (message("bad", wrong)) }
                form.stacked method="post" action="/login" {
                    (token(visitor))
                    label { (text!(language, "web-login-name")) input name="name" value=(name) required maxlength="32" autocomplete="username" autocapitalize="none"; }
                    label { (text!(language, "web-login-password")) input type="password" name="password" required maxlength=(PASSWORD_LENGTH_RANGE.end()) autocomplete="current-password"; }
                    button type="submit" { (text!(language, "web-login")) }
                }
            }
        },
    )
}

/// Renders the user's account page with the result of a change, if any.
#[must_use]
pub fn account(visitor: &Visitor, told: Option<(&str, &str)>) -> Markup {
    let (language, name) = (visitor.language, visitor.name.as_deref().unwrap_or_default());
    let change = html! {
        @if let Some((kind, words)) = told { (message(kind, words)) }
        form.stacked method="post" action="/account" {
            (token(visitor))
            label { (text!(language, "web-account-current")) input type="password" name="present" required maxlength=(PASSWORD_LENGTH_RANGE.end()) autocomplete="current-password"; }
            label { (text!(language, "web-account-new", least = *PASSWORD_LENGTH_RANGE.start())) input type="password" name="new" required minlength=(PASSWORD_LENGTH_RANGE.start()) maxlength=(PASSWORD_LENGTH_RANGE.end()) autocomplete="new-password"; }
            button type="submit" { (text!(language, "web-account-change")) }
        }
    };
    page(
        visitor,
        "/account",
        &text!(language, "web-account"),
        &html! {
            p.lead { (name_and_role(language, name, visitor.role)) }
            (section("password", &text!(language, "web-account-change"), &change))
            (section("data", &text!(language, "web-account-data"), &html! {
                p { a href={ "/trainees/" (name) } { (text!(language, "web-account-progress")) } }
                p { a href={ "/trainees/" (name) "/export.json" } { (text!(language, "web-account-download")) } }
            }))
        },
    )
}

/// Checks a new password.
///
/// # Errors
/// Returns the problem as text that never includes the password.
pub fn check(password: &str, name: &str, language: Language) -> Result<(), String> {
    let length = password.chars().count();
    let (least, most) = (*PASSWORD_LENGTH_RANGE.start(), *PASSWORD_LENGTH_RANGE.end());
    if !PASSWORD_LENGTH_RANGE.contains(&length) || password.len() > 4 * most {
        return Err(text!(language, "web-password-length", length = length, least = least, most = most));
    }
    // Detects common passwords, names, keyboard patterns, repeated characters and dates, including slight variations.
    let estimate = zxcvbn::zxcvbn(password, &[name, "spandrel"]);
    if estimate.score() < MIN_PASSWORD_STRENGTH {
        return Err(match estimate.feedback().and_then(|feedback| feedback.warning()) {
            Some(warning) => text!(language, "web-password-weak-because", reason = warning_text(language, warning)),
            None => text!(language, "web-password-weak"),
        });
    }
    Ok(())
}

/// Returns the reason why a password is easy to guess.
fn warning_text(language: Language, warning: Warning) -> String {
    match warning {
        Warning::StraightRowsOfKeysAreEasyToGuess => text!(language, "web-password-rows"),
        Warning::ShortKeyboardPatternsAreEasyToGuess => text!(language, "web-password-keyboard"),
        Warning::RepeatsLikeAaaAreEasyToGuess => text!(language, "web-password-repeats"),
        Warning::RepeatsLikeAbcAbcAreOnlySlightlyHarderToGuess => text!(language, "web-password-repeated-words"),
        Warning::ThisIsATop10Password => text!(language, "web-password-top-10"),
        Warning::ThisIsATop100Password => text!(language, "web-password-top-100"),
        Warning::ThisIsACommonPassword => text!(language, "web-password-common"),
        Warning::ThisIsSimilarToACommonlyUsedPassword => text!(language, "web-password-similar"),
        Warning::SequencesLikeAbcAreEasyToGuess => text!(language, "web-password-sequences"),
        Warning::RecentYearsAreEasyToGuess => text!(language, "web-password-years"),
        Warning::AWordByItselfIsEasyToGuess => text!(language, "web-password-word"),
        Warning::DatesAreOftenEasyToGuess => text!(language, "web-password-dates"),
        Warning::NamesAndSurnamesByThemselvesAreEasyToGuess => text!(language, "web-password-names"),
        Warning::CommonNamesAndSurnamesAreEasyToGuess => text!(language, "web-password-common-names"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check_translated};
    use super::*;

    #[test]
    fn exact_login_page_repeats_name_but_not_password() {
        let stranger = Visitor { name: None, ..administrator() };
        let text = login(&stranger, HOSTILE_NAME, Some(HOSTILE_NAME)).into_string();
        assert!(!text.contains("<script>") && text.contains("&lt;script&gt;"), "{text}");
        assert!(account(&administrator(), None).into_string().contains("name=\"present\""));
    }

    #[test]
    fn exact_login_and_account_are_translated() {
        let visitor = Visitor { name: Some("7".into()), ..administrator_with(Language::Pseudo) };
        check_translated(&login(&visitor, "", None).into_string(), &[]);
        check_translated(&account(&visitor, None).into_string(), &[]);
        let german = login(&administrator_with(Language::German), "", None).into_string();
        assert!(german.contains("<h1>Anmelden</h1>") && german.contains("Passwort"), "{german}");
        let told = check("password1234", "anna", Language::German).unwrap_err();
        assert!(told.starts_with("Das Passwort ist zu leicht zu erraten (Dies "), "{told}");
    }

    #[test]
    fn exact_weak_passwords_are_rejected() {
        for good in ["twelve-chars", "correct horse battery", "quite another one", "Zugspitze 2962 m?"] {
            assert_eq!(check(good, "anna", Language::English), Ok(()), "{good}");
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
            let told = check(bad, "annemarie", Language::English).unwrap_err();
            assert!(!told.contains(bad), "{told}");
            check_translated(&format!("<p>{}</p>", check(bad, "annemarie", Language::Pseudo).unwrap_err()), &[]);
        }
    }
}
