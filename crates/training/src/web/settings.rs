//! The administrators' settings page: login accounts and session retention.

use super::access::Visitor;
use super::layout::{message, page, role_text, section, table, token};
use super::login::PASSWORD_LENGTH_RANGE;
use crate::trainee::{Role, Trainee};
use maud::{Markup, html};
use spandrel_text::text;

/// Contents of the settings page.
#[derive(Debug, Clone, Copy)]
pub struct SettingsPage<'a> {
    /// All users, with or without a password.
    pub users: &'a [Trainee],
    /// Users who may log in.
    pub with_password: &'a [String],
    /// Location of the database, without a password.
    pub database: &'a str,
    /// Folders that contain session folders.
    pub folders: &'a [String],
    /// CSS class and text of the message after a change.
    pub notice: Option<(&'a str, &'a str)>,
}

/// Renders the settings page.
#[must_use]
pub fn settings(visitor: &Visitor, settings: &SettingsPage<'_>) -> Markup {
    let language = visitor.language;
    let body = html! {
        @if let Some((kind, words)) = settings.notice { (message(kind, words)) }
        (section("logins", &text!(language, "web-settings-logins"), &logins(visitor, settings)))
        (section("add", &text!(language, "web-settings-add"), &add(visitor)))
        (section("retention", &text!(language, "web-settings-retention"), &retention(visitor)))
        (section("place", &text!(language, "web-settings-storage"), &html! {
            dl {
                dt { (text!(language, "web-settings-database")) } dd { (settings.database) }
                dt { (text!(language, "web-settings-folders")) } dd { @for folder in settings.folders { (folder) " " } }
                dt { (text!(language, "web-settings-version")) } dd { "spandrel " (env!("CARGO_PKG_VERSION")) }
            }
        }))
    };
    page(visitor, "/settings", &text!(language, "web-settings"), &body)
}

fn logins(visitor: &Visitor, settings: &SettingsPage<'_>) -> Markup {
    let language = visitor.language;
    let role = |name: &String| settings.users.iter().find(|one| one.pseudonym == *name).map(|one| role_text(language, one.role));
    let heads = [
        (text!(language, "web-settings-name"), false),
        (text!(language, "web-settings-role"), false),
        (text!(language, "web-settings-action"), false),
    ];
    html! {
        @if visitor.open { (message("warn", &text!(language, "web-settings-open"))) }
        @if !settings.with_password.is_empty() {
            (table(&text!(language, "web-settings-users"), &heads, &html! {
                @for name in settings.with_password {
                    tr {
                        th scope="row" { (name) }
                        td { (role(name).unwrap_or_default()) }
                        td {
                            @if visitor.name.as_ref() != Some(name) {
                                form method="post" action="/settings/no-login" {
                                    (token(visitor))
                                    input type="hidden" name="name" value=(name);
                                    button type="submit" aria-label=(text!(language, "web-settings-disable-for", name = name.as_str())) { (text!(language, "web-settings-disable")) }
                                }
                            }
                        }
                    }
                }
            }))
        }
    }
}

fn add(visitor: &Visitor) -> Markup {
    let language = visitor.language;
    html! {
        form.stacked method="post" action="/settings/login" {
            (token(visitor))
            label { (text!(language, "web-settings-pseudonym")) input name="name" required maxlength="32" pattern="[A-Za-z0-9][A-Za-z0-9_\\-]*" autocomplete="off" autocapitalize="none"; }
            label { (text!(language, "web-settings-role")) select name="role" { @for role in Role::ALL { option value=(role.word()) { (role_text(language, role)) } } } }
            label { (text!(language, "web-settings-password", least = *PASSWORD_LENGTH_RANGE.start())) input type="password" name="password" required minlength=(PASSWORD_LENGTH_RANGE.start()) maxlength=(PASSWORD_LENGTH_RANGE.end()) autocomplete="new-password"; }
            button type="submit" { (text!(language, "web-settings-save")) }
        }
    }
}

fn retention(visitor: &Visitor) -> Markup {
    let language = visitor.language;
    html! {
        form.stacked method="post" action="/settings/retention" {
            (token(visitor))
            label { (text!(language, "web-settings-erase-days")) input type="number" name="days" required min="1" max="36525"; }
            label { input type="checkbox" name="sure" value="yes" required; " " (text!(language, "web-settings-erase-sure")) }
            button.danger type="submit" { (text!(language, "web-settings-erase")) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, administrator_with, check, check_translated};
    use super::*;
    use spandrel_text::Language;

    #[test]
    fn exact_own_login_cannot_be_disabled() {
        let names = [HOSTILE_NAME.to_owned(), "ben".to_owned()];
        let people = [Trainee::new(HOSTILE_NAME), Trainee::new("ben")];
        let shown = SettingsPage {
            users: &people,
            with_password: &names,
            database: HOSTILE_NAME,
            folders: &names,
            notice: Some(("good", HOSTILE_NAME)),
        };
        let text = settings(&administrator(), &shown).into_string();
        check(&text);
        assert_eq!(text.matches("/settings/no-login").count(), 1, "only the other user's login can be removed");
        assert!(!text.contains("No passwords are set"));
        let open = Visitor { open: true, name: None, ..administrator() };
        assert!(settings(&open, &shown).into_string().contains("No passwords are set"));
    }

    #[test]
    fn exact_settings_are_translated() {
        let (names, people) = (["7".to_owned()], [Trainee::new("7")]);
        let shown = SettingsPage { users: &people, with_password: &names, database: "7", folders: &names, notice: None };
        let visitor = Visitor { open: true, ..administrator_with(Language::Pseudo) };
        check_translated(&settings(&visitor, &shown).into_string(), &["spandrel"]);
        assert!(settings(&administrator_with(Language::German), &shown).into_string().contains("Anmeldung sperren"));
    }
}
