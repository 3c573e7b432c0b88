//! Session pages: the session list, a single session with its report and files, and the comparison of two sessions.

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::state::ServerState;
use crate::io::marks::valid_marks;
use crate::io::report;
use crate::io::scoring;
use crate::io::session_folder::StoredSession;
use crate::io::trainee_id::TraineeId;
use spandrel_monitor::export;
use spandrel_monitor::folder::{REPORT, SNAPSHOTS, TELEMETRY, VIDEO};
use spandrel_text::{Language, text};
use spandrel_training::marks::marks_key;
use spandrel_training::record::{IncompletePolicy, SessionRecord};
use spandrel_training::report::assets;
use spandrel_training::report::page::MARKS_META_NAME;
use spandrel_training::standing::standing;
use spandrel_training::web::browser_sessions::file_key;
use spandrel_training::web::served_report::{ParentPage, with_back_links, with_video_address};
use spandrel_training::web::sessions as pages;
use std::path::{Path, PathBuf};

/// Number of sessions on each list page.
const SESSIONS_PER_PAGE: u32 = 50;
/// Maximum number of other sessions offered for comparison.
const MAX_COMPARISONS: u32 = 50;

/// Redirects from the start page to the sessions or the login page.
pub fn start(_: &ServerState, request: &WebRequest) -> HandlerResult {
    Ok(WebResponse::redirect(if request.visitor.is_known() { "/sessions" } else { "/login" }))
}

/// Responds with a list of the sessions of all trainees or one trainee.
pub fn session_list(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let wanted = request.query_param("trainee");
    let trainee = request.visitor.restricted_to().or(wanted);
    let count = state.database.count(trainee)?;
    let last = u32::try_from(count.div_ceil(u64::from(SESSIONS_PER_PAGE))).unwrap_or(u32::MAX).max(1);
    let page = request.query_param("page").and_then(|page| page.parse().ok()).unwrap_or(1).clamp(1, last);
    let lines = state.database.list(trainee, SESSIONS_PER_PAGE, (page - 1).saturating_mul(SESSIONS_PER_PAGE))?;
    // Links contain the name, so an invalid name is replaced by an empty one.
    let trainee = wanted.filter(|name| request.visitor.restricted_to().is_none() && name.parse::<TraineeId>().is_ok());
    let listing = pages::SessionList { lines: &lines, trainee, page, last, count };
    Ok(WebResponse::page(pages::list(&request.visitor, &listing)))
}

/// Returns a session's record, if the visitor may see it.
///
/// # Errors
/// Returns an error if there is no such session, or the visitor has no access to it.
pub fn record(state: &ServerState, request: &WebRequest, id: &str) -> Result<SessionRecord, WebError> {
    let record = state.database.record(id)?.ok_or(WebError::NotFound)?;
    request.check_access(&record.trainee)?;
    Ok(record)
}

/// Returns a session's folder, if the visitor may see it.
///
/// # Errors
/// Returns an error if the folder is not on this machine, or the visitor has no access to it.
pub fn folder(state: &ServerState, request: &WebRequest, id: &str) -> Result<PathBuf, WebError> {
    record(state, request, id)?;
    state.folder(id).ok_or(WebError::NotFound)
}

/// Responds with a session's page.
pub fn session_page(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let record = record(state, request, request.path_param("id"))?;
    let mut others = state.database.list(Some(&record.trainee), MAX_COMPARISONS, 0)?;
    others.retain(|other| other.id != record.id && state.folder(&other.id).is_some());
    let folder = state.folder(&record.id);
    let advice = folder.as_deref().and_then(report::saved_advice);
    let standing = match standing(&record, &state.database.records(Some(&record.trainee))?) {
        Some(found) if found.change.is_some() => {
            Some(found.labeled(&state.figures.reliability(&record.scenario_with_level(), IncompletePolicy::Exclude)?))
        }
        found => found,
    };
    let marks = folder.as_deref().map(valid_marks).unwrap_or_default();
    let pictures = folder.as_deref().map(|folder| report::photograph_numbers(&folder.join(SNAPSHOTS))).unwrap_or_default();
    let has_folder = folder.is_some();
    let video = folder.is_some_and(|folder| folder.join(VIDEO).is_file());
    let about = pages::SessionPageData {
        folder: has_folder,
        others: &others,
        advice: advice.as_ref(),
        standing: standing.as_ref(),
        marks: &marks,
        pictures: &pictures,
        video,
    };
    Ok(WebResponse::page(pages::session(&request.visitor, &record, &about)))
}

/// Responds with a session's report in the visitor's language, under the report's own policy. Creates the report again if it is
/// missing, another version wrote it, or the instructor's marks have changed. `report.html` keeps its language.
pub fn report(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let id = request.path_param("id");
    let folder = folder(state, request, id)?;
    let policy = assets::page_policy();
    let (path, marks) = (folder.join(REPORT), marks_key(&valid_marks(&folder)));
    let is_current = |page: &[u8]| is_current(page, &policy, marks.as_deref());
    let language = request.visitor.language;
    let written = std::fs::read(&path).ok();
    let written_language = written.as_deref().and_then(page_language).unwrap_or(language);
    let page = match written.filter(|page| is_current(page)) {
        Some(page) => page,
        None => {
            report::write(&folder, written_language, &|job| state.figures.reliability_if_known(job))?;
            bytes(&path)?
        }
    };
    let page = if written_language == language { page } else { translated_report(state, &folder, language, is_current)? };
    let page = with_video_address(page, &report_video_address(request, id));
    let served = with_back_links(page, &[ParentPage::Session(id), ParentPage::Sessions], language);
    Ok(WebResponse::sandboxed_page(served, &policy))
}

/// Returns the address of a session's video for its report, which is sandboxed and therefore cannot send the visitor's cookie.
fn report_video_address(request: &WebRequest, id: &str) -> String {
    let key = file_key(request.cookie.as_deref().unwrap_or_default(), &request.visitor.token, id);
    format!("/sessions/{id}/report/{key}/{VIDEO}")
}

/// Returns a session's report in another language than `report.html`.
fn translated_report(
    state: &ServerState,
    folder: &Path,
    language: Language,
    is_current: impl Fn(&[u8]) -> bool,
) -> Result<Vec<u8>, WebError> {
    let path = report::translation_path(folder, language);
    if let Some(page) = std::fs::read(&path).ok().filter(|page| is_current(page)) {
        return Ok(page);
    }
    Ok(report::write_translation(folder, language, &|job| state.figures.reliability_if_known(job))?)
}

/// Returns the first part of a page, which contains its `head` element.
fn head(page: &[u8]) -> String {
    String::from_utf8_lossy(&page[..page.len().min(2_000)]).into_owned()
}

/// Returns the language of a page.
fn page_language(page: &[u8]) -> Option<Language> {
    let head = head(page);
    let (_, rest) = head.split_once("<html lang=\"")?;
    Language::from_tag(rest.split('"').next()?)
}

/// Returns true if the page's `head` element contains this version's policy and the key of these marks.
fn is_current(page: &[u8], policy: &str, marks: Option<&str>) -> bool {
    let head = head(page);
    let escaped = maud::html! { (policy) }.into_string();
    let has_marks = match marks {
        Some(key) => head.contains(&format!("name=\"{MARKS_META_NAME}\" content=\"{key}\"")),
        None => !head.contains(MARKS_META_NAME),
    };
    head.contains(&escaped) && has_marks
}

/// Responds with a comparison of two sessions.
pub fn compare(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let folder = |word: &str| {
        let missing = || WebError::BadRequest(text!(request.visitor.language, "sessions-compare-missing", field = word));
        let id = request.query_param(word).ok_or_else(missing)?;
        folder(state, request, id)
    };
    let reliability = |scenario: &str| state.figures.reliability(scenario, IncompletePolicy::Exclude);
    let language = request.visitor.language;
    let page = report::comparison_page(&folder("first")?, &folder("second")?, language, reliability)?;
    let served = with_back_links(page.into_bytes(), &[ParentPage::Sessions], language);
    Ok(WebResponse::sandboxed_page(served, &assets::page_policy()))
}

/// Responds with the frames as CSV.
pub fn frames(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let id = request.path_param("id");
    let stored = StoredSession::read(&folder(state, request, id)?)?;
    let csv = export::frames_csv(&scoring::frame_rows(&stored)?);
    Ok(WebResponse::download(&format!("{id}-frames.csv"), "text/csv; charset=utf-8", csv.into_bytes()))
}

/// Responds with the unmodified telemetry log.
pub fn telemetry(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let id = request.path_param("id");
    let path = folder(state, request, id)?.join(TELEMETRY);
    Ok(WebResponse::download(&format!("{id}.tlog"), "application/octet-stream", bytes(&path)?))
}

fn bytes(path: &Path) -> Result<Vec<u8>, WebError> {
    std::fs::read(path).map_err(|error| WebError::Failed(format!("{}: cannot read: {error}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_reports_of_other_versions_or_marks_are_outdated() {
        let policy = "script-src 'sha256-abc'";
        let bare: &[u8] = b"<meta content=\"script-src 'sha256-abc'\">";
        let marked: &[u8] = b"<meta content=\"script-src 'sha256-abc'\"><meta name=\"spandrel-marks\" content=\"12ab\">";
        assert!(is_current(bare, policy, None) && is_current(marked, policy, Some("12ab")));
        assert!(!is_current(b"<meta content=\"script-src 'sha256-xyz'\">", policy, None));
        assert!(!is_current(b"", policy, None));
        assert!(!is_current(bare, policy, Some("12ab")) && !is_current(marked, policy, Some("12cd")));
        assert!(!is_current(marked, policy, None), "all marks were removed");
    }

    #[test]
    fn exact_language_of_a_report_is_read_from_the_page() {
        assert_eq!(page_language(b"<!DOCTYPE html><html lang=\"de\"><head>"), Some(Language::German));
        assert_eq!(page_language(b"<!DOCTYPE html><html lang=\"fr\">"), None);
        assert_eq!(page_language(b""), None);
    }
}
