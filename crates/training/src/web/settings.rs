//! The administrators' settings page: login accounts and session retention.

use super::access::Visitor;
use super::layout::{message, page, section, table, token};
use super::login::PASSWORD_LENGTH_RANGE;
use crate::trainee::{Role, Trainee};
use maud::{Markup, html};

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
    let body = html! {
        @if let Some((kind, words)) = settings.notice { (message(kind, words)) }
        (section("logins", "Login accounts", &logins(visitor, settings)))
        (section("add", "Add or update a user", &add(visitor)))
        (section("retention", "Retention", &retention(visitor)))
        (section("place", "Storage", &html! {
            dl {
                dt { "Database" } dd { (settings.database) }
                dt { "Session folders" } dd { @for folder in settings.folders { (folder) " " } }
                dt { "Version" } dd { "spandrel " (env!("CARGO_PKG_VERSION")) }
            }
        }))
    };
    page(visitor, "/settings", "Settings", &body)
}

fn logins(visitor: &Visitor, settings: &SettingsPage<'_>) -> Markup {
    let role = |name: &String| settings.users.iter().find(|one| one.pseudonym == *name).map_or("", |one| one.role.word());
    html! {
        @if visitor.open { (message("warn", "No passwords are set: anyone on this machine has full access, and the server accepts connections only from this machine. After the first password is set, everyone must log in, so set an administrator's password first.")) }
        @if !settings.with_password.is_empty() {
            (table("Users with a password", &[("Name", false), ("Role", false), ("Action", false)], &html! {
                @for name in settings.with_password {
                    tr {
                        th scope="row" { (name) }
                        td { (role(name)) }
                        td {
                            @if visitor.name.as_ref() != Some(name) {
                                form method="post" action="/settings/no-login" {
                                    (token(visitor))
                                    input type="hidden" name="name" value=(name);
                                    button type="submit" aria-label={ "Disable login for " (name) } { "Disable login" }
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
    html! {
        form.stacked method="post" action="/settings/login" {
            (token(visitor))
            label { "Pseudonym" input name="name" required maxlength="32" pattern="[A-Za-z0-9][A-Za-z0-9_\\-]*" autocomplete="off" autocapitalize="none"; }
            label { "Role" select name="role" { @for role in Role::ALL { option value=(role.word()) { (role.word()) } } } }
            label { "Password, at least " (PASSWORD_LENGTH_RANGE.start()) " characters" input type="password" name="password" required minlength=(PASSWORD_LENGTH_RANGE.start()) maxlength=(PASSWORD_LENGTH_RANGE.end()) autocomplete="new-password"; }
            button type="submit" { "Save" }
        }
    }
}

fn retention(visitor: &Visitor) -> Markup {
    html! {
        form.stacked method="post" action="/settings/retention" {
            (token(visitor))
            label { "Erase sessions and session folders older than this (days)" input type="number" name="days" required min="1" max="36525"; }
            label { input type="checkbox" name="sure" value="yes" required; " I understand that this cannot be undone" }
            button.danger type="submit" { "Erase" }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
    use super::*;

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
}
