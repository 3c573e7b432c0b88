//! Logging in, and one's own account.

use super::access::Visitor;
use super::frame::{message, page, section, token};
use maud::{Markup, html};

/// Characters of a password.
pub const PASSWORD_LENGTHS: std::ops::RangeInclusive<usize> = 12..=256;

/// The login, with what was wrong before.
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
                    label { "Password" input type="password" name="password" required maxlength=(PASSWORD_LENGTHS.end()) autocomplete="current-password"; }
                    button type="submit" { "Log in" }
                }
            }
        },
    )
}

/// One's own account, with how a change went.
#[must_use]
pub fn account(visitor: &Visitor, told: Option<(&str, &str)>) -> Markup {
    let name = visitor.name.as_deref().unwrap_or_default();
    let change = html! {
        @if let Some((kind, words)) = told { (message(kind, words)) }
        form.stacked method="post" action="/account" {
            (token(visitor))
            label { "Present password" input type="password" name="present" required maxlength=(PASSWORD_LENGTHS.end()) autocomplete="current-password"; }
            label { "New password, at least " (PASSWORD_LENGTHS.start()) " characters" input type="password" name="new" required minlength=(PASSWORD_LENGTHS.start()) maxlength=(PASSWORD_LENGTHS.end()) autocomplete="new-password"; }
            button type="submit" { "Change" }
        }
    };
    page(
        visitor,
        "/account",
        "Account",
        &html! {
            p.lead { (name) ", " (visitor.role.word()) }
            (section("password", "Change the password", &change))
            (section("data", "My data", &html! {
                p { a href={ "/trainees/" (name) } { "My progress and plan" } }
                p { a href={ "/trainees/" (name) "/export.json" } { "Download everything that is kept of me" } }
            }))
        },
    )
}

/// Why a new password is refused.
///
/// # Errors
/// What is wrong with it; the message never shows it.
pub fn check(password: &str, name: &str) -> Result<(), String> {
    let length = password.chars().count();
    let (least, most) = (PASSWORD_LENGTHS.start(), PASSWORD_LENGTHS.end());
    if !PASSWORD_LENGTHS.contains(&length) || password.len() > 4 * most {
        return Err(format!("the password has {length} characters (allowed: {least} to {most})"));
    }
    if password.chars().all(|c| password.starts_with(c)) {
        return Err("the password is one character again and again".into());
    }
    if password.to_lowercase().contains(&name.to_lowercase()) && length < least + name.len() {
        return Err("the password is little more than the name".into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::frame::tests::{EVIL, administrator};
    use super::*;

    #[test]
    fn exact_the_login_shows_the_name_again_and_never_the_password() {
        let stranger = Visitor { name: None, ..administrator() };
        let text = login(&stranger, EVIL, Some(EVIL)).into_string();
        assert!(!text.contains("<script>") && text.contains("&lt;script&gt;"), "{text}");
        assert!(account(&administrator(), None).into_string().contains("name=\"present\""));
    }

    #[test]
    fn exact_passwords_are_long_and_not_the_name() {
        assert_eq!(check("twelve-chars", "anna"), Ok(()));
        for bad in ["short", "aaaaaaaaaaaaaaaa", &"x".repeat(257), "annemarie1234"] {
            let told = check(bad, "annemarie").unwrap_err();
            assert!(!told.contains(bad), "{told}");
        }
    }
}
