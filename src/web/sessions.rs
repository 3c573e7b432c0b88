//! Sessions: lists, one with its report and files, two beside each other.

use super::answer::{Answer, Answered, Refusal};
use super::asked::Asked;
use super::state::State;
use crate::args::TraineeId;
use crate::session_folder::Stored;
use crate::{assess, report};
use spandrel_monitor::export;
use spandrel_monitor::folder::{REPORT, TELEMETRY};
use spandrel_training::record::Record;
use spandrel_training::report::assets;
use spandrel_training::web::sessions as pages;
use std::path::{Path, PathBuf};

/// Sessions on a page.
const PAGE: u32 = 50;
/// Other sessions that one can be compared with.
const OTHERS: u32 = 50;

/// The first page: sessions, or the login.
pub fn start(_: &State, asked: &Asked) -> Answered {
    Ok(Answer::to(if asked.visitor.is_known() { "/sessions" } else { "/login" }))
}

/// A list of sessions: all, or one trainee's.
pub fn list(state: &State, asked: &Asked) -> Answered {
    let wanted = asked.word("trainee");
    let trainee = asked.visitor.limited_to().or(wanted);
    let count = state.database.count(trainee)?;
    let last = u32::try_from(count.div_ceil(u64::from(PAGE))).unwrap_or(u32::MAX).max(1);
    let page = asked.word("page").and_then(|page| page.parse().ok()).unwrap_or(1).clamp(1, last);
    let lines = state.database.list(trainee, PAGE, (page - 1).saturating_mul(PAGE))?;
    // A name goes on into links; what can be none is shown empty.
    let trainee = wanted.filter(|name| asked.visitor.limited_to().is_none() && name.parse::<TraineeId>().is_ok());
    let listing = pages::Listing { lines: &lines, trainee, page, last, count };
    Ok(Answer::page(pages::list(&asked.visitor, &listing)))
}

/// A session's record, if the visitor may see it.
///
/// # Errors
/// When there is none, or it is not his.
pub fn record(state: &State, asked: &Asked, id: &str) -> Result<Record, Refusal> {
    let record = state.database.record(id)?.ok_or(Refusal::NotFound)?;
    asked.must_see(&record.trainee)?;
    Ok(record)
}

/// A session's folder, if the visitor may see it.
///
/// # Errors
/// When it is not here, or not his.
pub fn folder(state: &State, asked: &Asked, id: &str) -> Result<PathBuf, Refusal> {
    record(state, asked, id)?;
    state.folder(id).ok_or(Refusal::NotFound)
}

/// One session.
pub fn one(state: &State, asked: &Asked) -> Answered {
    let record = record(state, asked, asked.part("id"))?;
    let mut others = state.database.list(Some(&record.trainee), OTHERS, 0)?;
    others.retain(|other| other.id != record.id && state.folder(&other.id).is_some());
    let folder = state.folder(&record.id).is_some();
    Ok(Answer::page(pages::session(&asked.visitor, &record, &pages::Beside { folder, others: &others })))
}

/// A session's report, under its own policy. One that another version wrote, or that is missing, is made again.
pub fn report(state: &State, asked: &Asked) -> Answered {
    let folder = folder(state, asked, asked.part("id"))?;
    let policy = assets::page_policy();
    let path = folder.join(REPORT);
    let found = std::fs::read(&path).ok().filter(|page| begins_with_policy(page, &policy));
    let page = match found {
        Some(page) => page,
        None => {
            report::write(&folder)?;
            std::fs::read(&path).map_err(|error| Refusal::Failed(format!("{}: {error}", path.display())))?
        }
    };
    Ok(Answer::boxed(page, &policy))
}

/// A page of this version names the same policy in its head.
fn begins_with_policy(page: &[u8], policy: &str) -> bool {
    let head = &page[..page.len().min(2_000)];
    let escaped = maud::html! { (policy) }.into_string();
    String::from_utf8_lossy(head).contains(&escaped)
}

/// Two sessions beside each other.
pub fn compare(state: &State, asked: &Asked) -> Answered {
    let folder = |word: &str| {
        let id = asked.word(word).ok_or_else(|| Refusal::Wrong(format!("{word}: missing (allowed: a session)")))?;
        folder(state, asked, id)
    };
    let page = report::compared(&folder("first")?, &folder("second")?)?;
    Ok(Answer::boxed(page.into_bytes(), &assets::page_policy()))
}

/// Frames as CSV.
pub fn frames(state: &State, asked: &Asked) -> Answered {
    let id = asked.part("id");
    let stored = Stored::read(&folder(state, asked, id)?)?;
    let csv = export::frames_csv(&assess::frame_rows(&stored)?);
    Ok(Answer::download(&format!("{id}-frames.csv"), "text/csv; charset=utf-8", csv.into_bytes()))
}

/// The telemetry as it came.
pub fn telemetry(state: &State, asked: &Asked) -> Answered {
    let id = asked.part("id");
    let path = folder(state, asked, id)?.join(TELEMETRY);
    Ok(Answer::download(&format!("{id}.tlog"), "application/octet-stream", bytes(&path)?))
}

fn bytes(path: &Path) -> Result<Vec<u8>, Refusal> {
    std::fs::read(path).map_err(|error| Refusal::Failed(format!("{}: cannot be read: {error}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_report_of_another_version_is_known_by_its_policy() {
        let policy = "script-src 'sha256-abc'";
        assert!(begins_with_policy(b"<meta content=\"script-src 'sha256-abc'\">", policy));
        assert!(!begins_with_policy(b"<meta content=\"script-src 'sha256-xyz'\">", policy));
        assert!(!begins_with_policy(b"", policy));
    }
}
