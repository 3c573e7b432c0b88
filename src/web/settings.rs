//! Pages for the login, the account and the server settings.

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::state::ServerState;
use crate::io::clock;
use crate::records::{Account, erase_older_than};
use spandrel_text::text;
use spandrel_training::trainee::{Role, Trainee};
use spandrel_training::web::layout::role_text;
use spandrel_training::web::{login, settings as pages};

/// Microseconds per day.
const US_PER_DAY: u64 = 86_400_000_000;

/// Longest retention, days: a hundred years.
const MAX_RETENTION_DAYS: u32 = 36_525;

/// Responds with the login form.
pub fn login_page(_: &ServerState, request: &WebRequest) -> HandlerResult {
    if request.visitor.is_known() {
        return Ok(WebResponse::redirect("/sessions"));
    }
    Ok(WebResponse::page(login::login(&request.visitor, "", None)))
}

/// Logs in with the submitted name and password.
pub fn log_in(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let name = request.form_field("name").unwrap_or_default().trim();
    let password = request.form_field("password").unwrap_or_default();
    match state.auth.log_in(&state.database, (name, password), request.cookie.as_deref(), &request.client()) {
        Ok((cookie, device)) => {
            let mut answer = WebResponse::redirect("/sessions");
            answer.cookies = vec![state.auth.cookie(&cookie), state.auth.browser_cookie(&device)];
            Ok(answer)
        }
        Err(refusal @ (WebError::Forbidden(_) | WebError::RateLimited(_) | WebError::Busy(_))) => {
            let (status, _, words) = refusal.status_and_text(request.visitor.language);
            let page = WebResponse::page(login::login(&request.visitor, name, Some(&words)));
            Ok(page.with_status(status).retry_after(refusal.retry_after_s()))
        }
        Err(other) => Err(other),
    }
}

/// Ends the visitor's browser session.
pub fn log_out(state: &ServerState, request: &WebRequest) -> HandlerResult {
    state.auth.log_out(request.cookie.as_deref());
    Ok(WebResponse::redirect("/login"))
}

/// Responds with the visitor's account page.
pub fn account_page(_: &ServerState, request: &WebRequest) -> HandlerResult {
    if request.visitor.name.is_none() {
        return Ok(WebResponse::redirect("/settings"));
    }
    Ok(WebResponse::page(login::account(&request.visitor, None)))
}

/// Changes the visitor's password and ends all their other browser sessions.
pub fn change_password(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let name = request.visitor.name.as_deref().ok_or(WebError::NotFound)?;
    let language = request.visitor.language;
    let told = match change(state, request, name) {
        Ok(()) => ("good", text!(language, "web-account-changed")),
        Err(refusal @ (WebError::Forbidden(_) | WebError::BadRequest(_) | WebError::RateLimited(_) | WebError::Busy(_))) => {
            ("bad", refusal.status_and_text(language).2)
        }
        Err(other) => return Err(other),
    };
    Ok(WebResponse::page(login::account(&request.visitor, Some((told.0, &told.1)))))
}

fn change(state: &ServerState, request: &WebRequest, name: &str) -> Result<(), WebError> {
    let mut account = state.auth.check(&state.database, name, request.required_field("present")?, &request.client())?;
    let (language, new) = (request.visitor.language, request.required_field("new")?);
    login::check(new, name, language).map_err(WebError::BadRequest)?;
    let before = account.hash.replace(state.auth.hashing.acquire()?.hash(new)?).unwrap_or_default();
    if !state.database.change_password(name, &before, account.hash.as_deref().unwrap_or_default())? {
        return Err(WebError::BadRequest(text!(language, "web-account-changed-elsewhere")));
    }
    state.auth.end_other_sessions(name, request.cookie.as_deref());
    state.auth.update_credential(request.cookie.as_deref(), &account);
    Ok(())
}

/// Responds with the administrator's settings page.
pub fn page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    render_settings(state, request, None)
}

fn render_settings(state: &ServerState, request: &WebRequest, told: Option<(&str, &str)>) -> HandlerResult {
    let (people, names_with_password) = (state.database.trainees()?, state.database.names_with_password()?);
    let folders: Vec<String> = state.records_location.sessions.iter().map(|folder| folder.display().to_string()).collect();
    let database = state.database.name();
    let settings =
        pages::SettingsPage { users: &people, with_password: &names_with_password, database, folders: &folders, notice: told };
    Ok(WebResponse::page(pages::settings(&request.visitor, &settings)))
}

/// Sets a person's password and role.
pub fn set_login(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let language = request.visitor.language;
    let name = request.trainee_field("name")?;
    let name = name.as_str();
    let role = Role::from_word(request.required_field("role")?);
    let role = role.ok_or_else(|| WebError::unknown(language, "role", "trainee, instructor, administrator"))?;
    let password = request.required_field("password")?;
    login::check(password, name, language).map_err(WebError::BadRequest)?;
    if request.visitor.open && role != Role::Administrator {
        return Err(WebError::BadRequest(text!(language, "web-settings-first-administrator")));
    }
    let own = request.visitor.name.as_deref() == Some(name);
    if own && role != Role::Administrator {
        return Err(WebError::BadRequest(text!(language, "web-settings-lock-out-role")));
    }
    let hash = state.auth.hashing.acquire()?.hash(password)?;
    state.database.set_login(name, role, &hash)?;
    state.auth.end_other_sessions(name, request.cookie.as_deref());
    if own {
        let person = Trainee { role, ..Trainee::new(name) };
        state.auth.update_credential(request.cookie.as_deref(), &Account { person, hash: Some(hash) });
    }
    if request.visitor.open {
        state.auth.require_login();
        return Ok(WebResponse::redirect("/login"));
    }
    let words = text!(language, "web-settings-can-log-in", name = name, role = role_text(language, role));
    render_settings(state, request, Some(("good", &words)))
}

/// Removes a person's password.
pub fn remove_login(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (language, name) = (request.visitor.language, request.required_field("name")?);
    if request.visitor.name.as_deref() == Some(name) {
        return Err(WebError::BadRequest(text!(language, "web-settings-lock-out")));
    }
    let had = state.database.remove_password(name)?;
    state.auth.end_other_sessions(name, None);
    if had {
        Ok(WebResponse::redirect("/settings"))
    } else {
        Err(WebError::BadRequest(text!(language, "web-settings-no-password")))
    }
}

/// Erases all sessions older than the specified number of days.
pub fn retention(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let language = request.visitor.language;
    let days = request.required_field("days")?.parse().ok().filter(|days| (1..=u64::from(MAX_RETENTION_DAYS)).contains(days));
    let days = days.ok_or_else(|| WebError::not_in_range(language, "days", 1, MAX_RETENTION_DAYS))?;
    if request.required_field("sure")? != "yes" {
        return Err(WebError::BadRequest(text!(language, "web-error-not-confirmed")));
    }
    let limit_us = clock::unix_us().saturating_sub(days * US_PER_DAY);
    let (deleted, folders) = erase_older_than(&state.database, &state.records_location, limit_us)?;
    let words = text!(language, "web-settings-erased", sessions = deleted, folders = folders);
    render_settings(state, request, Some(("good", &words)))
}
