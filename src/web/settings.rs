//! Logins, accounts, retention.

use super::answer::{Answer, Answered, Refusal};
use super::asked::Asked;
use super::state::State;
use crate::args::TraineeId;
use crate::clock;
use crate::records::{Account, forget_older};
use spandrel_training::trainee::{Role, Trainee};
use spandrel_training::web::{login, settings as pages};

/// µs in a day.
const DAY_US: u64 = 86_400_000_000;

/// The login.
pub fn login_page(_: &State, asked: &Asked) -> Answered {
    if asked.visitor.is_known() {
        return Ok(Answer::to("/sessions"));
    }
    Ok(Answer::page(login::login(&asked.visitor, "", None)))
}

/// Logs in.
pub fn log_in(state: &State, asked: &Asked) -> Answered {
    let name = asked.field("name").unwrap_or_default().trim();
    let password = asked.field("password").unwrap_or_default();
    match state.guard.log_in(&state.database, (name, password), asked.cookie.as_deref(), &asked.client()) {
        Ok((cookie, device)) => {
            let mut answer = Answer::to("/sessions");
            answer.cookies = vec![state.guard.cookie(&cookie), state.guard.device_cookie(&device)];
            Ok(answer)
        }
        Err(refusal @ (Refusal::Forbidden(_) | Refusal::Later(_) | Refusal::Busy(_))) => {
            let (status, _, words) = refusal.told();
            let page = Answer::page(login::login(&asked.visitor, name, Some(&words)));
            Ok(page.with_status(status).retry_after(refusal.retry_after_s()))
        }
        Err(other) => Err(other),
    }
}

/// Logs out.
pub fn log_out(state: &State, asked: &Asked) -> Answered {
    state.guard.log_out(asked.cookie.as_deref());
    Ok(Answer::to("/login"))
}

/// One's own account.
pub fn account_page(_: &State, asked: &Asked) -> Answered {
    if asked.visitor.name.is_none() {
        return Ok(Answer::to("/settings"));
    }
    Ok(Answer::page(login::account(&asked.visitor, None)))
}

/// Changes one's own password; all other visits of that person end.
pub fn change_password(state: &State, asked: &Asked) -> Answered {
    let name = asked.visitor.name.as_deref().ok_or(Refusal::NotFound)?;
    let told = match change(state, asked, name) {
        Ok(()) => ("good", "The password is changed. Wherever else you were logged in, you are so no more.".to_owned()),
        Err(refusal @ (Refusal::Forbidden(_) | Refusal::Wrong(_) | Refusal::Later(_) | Refusal::Busy(_))) => {
            ("bad", refusal.told().2)
        }
        Err(other) => return Err(other),
    };
    Ok(Answer::page(login::account(&asked.visitor, Some((told.0, &told.1)))))
}

fn change(state: &State, asked: &Asked, name: &str) -> Result<(), Refusal> {
    let mut account = state.guard.check(&state.database, name, asked.needed("present")?, &asked.client())?;
    let new = asked.needed("new")?;
    login::check(new, name).map_err(Refusal::Wrong)?;
    let before = account.hash.replace(state.guard.hashing.enter()?.hash(new)?).unwrap_or_default();
    if !state.database.change_password(name, &before, account.hash.as_deref().unwrap_or_default())? {
        return Err(Refusal::Wrong("somebody has changed your password meanwhile: log in with that one".into()));
    }
    state.guard.put_out(name, asked.cookie.as_deref());
    state.guard.renew(asked.cookie.as_deref(), &account);
    Ok(())
}

/// The administrator's page.
pub fn page(state: &State, asked: &Asked) -> Answered {
    shown(state, asked, None)
}

fn shown(state: &State, asked: &Asked, told: Option<(&str, &str)>) -> Answered {
    let (people, with_password) = (state.database.trainees()?, state.database.with_password()?);
    let folders: Vec<String> = state.place.sessions.iter().map(|folder| folder.display().to_string()).collect();
    let database = state.database.name();
    let settings = pages::Settings { people: &people, with_password: &with_password, database, folders: &folders, told };
    Ok(Answer::page(pages::settings(&asked.visitor, &settings)))
}

/// Sets a person's password and role.
pub fn set_login(state: &State, asked: &Asked) -> Answered {
    let name: TraineeId = asked.needed("name")?.parse().map_err(|wrong| Refusal::Wrong(format!("name: {wrong}")))?;
    let name = name.as_str();
    let role = asked.needed("role")?;
    let role = Role::from_word(role)
        .ok_or_else(|| Refusal::Wrong("role: unknown (allowed: trainee, instructor, administrator)".into()))?;
    let password = asked.needed("password")?;
    login::check(password, name).map_err(Refusal::Wrong)?;
    if asked.visitor.open && role != Role::Administrator {
        let words =
            "the first password must be an administrator's: with it everybody has to log in, and nobody else could set more";
        return Err(Refusal::Wrong(words.into()));
    }
    let own = asked.visitor.name.as_deref() == Some(name);
    if own && role != Role::Administrator {
        return Err(Refusal::Wrong("you would shut yourself out: let another administrator change your role".into()));
    }
    let hash = state.guard.hashing.enter()?.hash(password)?;
    state.database.set_login(name, role, &hash)?;
    state.guard.put_out(name, asked.cookie.as_deref());
    if own {
        let person = Trainee { role, ..Trainee::new(name) };
        state.guard.renew(asked.cookie.as_deref(), &Account { person, hash: Some(hash) });
    }
    if asked.visitor.open {
        state.guard.close();
        return Ok(Answer::to("/login"));
    }
    shown(state, asked, Some(("good", &format!("{name} may log in as {}.", role.word()))))
}

/// Takes a login away.
pub fn drop_login(state: &State, asked: &Asked) -> Answered {
    let name = asked.needed("name")?;
    if asked.visitor.name.as_deref() == Some(name) {
        return Err(Refusal::Wrong("you would shut yourself out".into()));
    }
    let had = state.database.drop_password(name)?;
    state.guard.put_out(name, None);
    if had { Ok(Answer::to("/settings")) } else { Err(Refusal::Wrong("this person has no password".into())) }
}

/// Erases what is older than so many days.
pub fn retention(state: &State, asked: &Asked) -> Answered {
    let days: u64 = asked
        .needed("days")?
        .parse()
        .ok()
        .filter(|days| (1..=36_525).contains(days))
        .ok_or_else(|| Refusal::Wrong("days: no such number (allowed: 1 to 36525)".into()))?;
    if asked.needed("sure")? != "yes" {
        return Err(Refusal::Wrong("sure: not said (allowed: yes)".into()));
    }
    let limit_us = clock::unix_us().saturating_sub(days * DAY_US);
    let (deleted, folders) = forget_older(&state.database, &state.place, limit_us)?;
    shown(state, asked, Some(("good", &format!("{deleted} sessions and {folders} folders are erased."))))
}
