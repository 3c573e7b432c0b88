//! Route table: path, required access level and handler. For any other path, the server responds with "not found".

use super::request::WebRequest;
use super::response::HandlerResult;
use super::scenario_library::MAX_SCENARIO_BYTES;
use super::state::ServerState;
use super::{
    assets, assignments, classes, languages, live, map_tiles, marks, plan_rules, questions, rubric, scenario_editor,
    scenario_pictures, scenarios, session_media, sessions, settings, stations, trainees, uploads,
};
use crate::io::picture_file::MAX_PICTURE_BYTES;
use spandrel_training::web::access::AccessLevel;

/// Function that handles a request.
pub type Handler = fn(&ServerState, &WebRequest) -> HandlerResult;

/// Maximum size of a form without a file, bytes.
pub const MAX_FORM_BYTES: usize = 64 * 1024;
/// Maximum size of an uploaded file with training plan rules, bytes; the shipped rules are about thirty thousand bytes long.
pub const MAX_PLAN_RULES_BYTES: usize = 64 * 1024;
/// Maximum size of an uploaded recording, bytes; an hour of telemetry is about one-third of this.
pub const MAX_RECORDING_BYTES: usize = 96 * 1024 * 1024;

/// What a route does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RouteKind {
    /// A file that doesn't depend on who sent the request: a static asset, or a file whose address contains a key.
    File,
    /// A page or download that changes nothing.
    Show,
    /// Like `Show`, but may take seconds to compute, so only one request runs at a time.
    Compute,
    /// A form that changes data; it must contain the visitor's token.
    Change,
    /// A form with a text of at most this many bytes; it must contain the visitor's token. The text is checked like an uploaded
    /// file, so only one request runs at a time.
    Text(usize),
    /// A message from a training station (JSON). It contains the stations' key instead of the token.
    StationMessage,
    /// A form that uploads one file of at most this many bytes.
    Upload(usize),
}

impl RouteKind {
    /// Returns true if the route changes nothing.
    pub fn is_read_only(self) -> bool {
        matches!(self, Self::File | Self::Show | Self::Compute)
    }
}

/// A row in the route table.
#[derive(Debug, Clone, Copy)]
pub struct Route {
    /// Path, with parameters in braces.
    pub path: &'static str,
    /// What the route does.
    pub kind: RouteKind,
    /// Access level required for the route.
    pub required_access: AccessLevel,
    /// Request handler.
    pub handler: Handler,
}

const fn file(path: &'static str, handler: Handler) -> Route {
    Route { path, kind: RouteKind::File, required_access: AccessLevel::Public, handler }
}

const fn show(path: &'static str, required_access: AccessLevel, handler: Handler) -> Route {
    Route { path, kind: RouteKind::Show, required_access, handler }
}

const fn compute(path: &'static str, required_access: AccessLevel, handler: Handler) -> Route {
    Route { path, kind: RouteKind::Compute, required_access, handler }
}

const fn change(path: &'static str, required_access: AccessLevel, handler: Handler) -> Route {
    Route { path, kind: RouteKind::Change, required_access, handler }
}

const fn text(path: &'static str, most: usize, required_access: AccessLevel, handler: Handler) -> Route {
    Route { path, kind: RouteKind::Text(most), required_access, handler }
}

const fn upload(path: &'static str, most: usize, required_access: AccessLevel, handler: Handler) -> Route {
    Route { path, kind: RouteKind::Upload(most), required_access, handler }
}

/// Path of the live value stream. It is not in the table, because its response does not end.
pub const STREAM_PATH: &str = "/live/stream";

/// All routes except the stream. Handlers for a trainee's data also check whether the visitor may access that trainee.
pub const ROUTES: &[Route] = &[
    show("/", AccessLevel::Public, sessions::start),
    file("/assets/{name}", assets::file),
    show("/login", AccessLevel::Public, settings::login_page),
    change("/login", AccessLevel::Public, settings::log_in),
    change("/logout", AccessLevel::Public, settings::log_out),
    change("/language", AccessLevel::Public, languages::select),
    show("/account", AccessLevel::Login, settings::account_page),
    change("/account", AccessLevel::Login, settings::change_password),
    show("/sessions", AccessLevel::Login, sessions::session_list),
    show("/sessions/{id}", AccessLevel::Login, sessions::session_page),
    show("/sessions/{id}/report", AccessLevel::Login, sessions::report),
    file("/sessions/{id}/report/{key}/video.mp4", session_media::report_video),
    show("/sessions/{id}/frames.csv", AccessLevel::Login, sessions::frames),
    show("/sessions/{id}/telemetry.tlog", AccessLevel::Login, sessions::telemetry),
    show("/sessions/{id}/video.mp4", AccessLevel::Login, session_media::video),
    show("/sessions/{id}/video.vtt", AccessLevel::Login, session_media::chapters),
    show("/sessions/{id}/pictures/{name}", AccessLevel::Login, session_media::photograph),
    show("/sessions/{id}/questions", AccessLevel::Login, questions::page),
    change("/sessions/{id}/questions", AccessLevel::Login, questions::save),
    change("/sessions/{id}/marks", AccessLevel::Instructor, marks::add),
    change("/sessions/{id}/marks/remove", AccessLevel::Instructor, marks::remove),
    show("/compare", AccessLevel::Login, sessions::compare),
    show("/trainees", AccessLevel::Instructor, trainees::trainee_list),
    show("/trainees/{name}", AccessLevel::Login, trainees::trainee_page),
    show("/trainees/{name}/export.json", AccessLevel::Login, trainees::export),
    change("/trainees/{name}/details", AccessLevel::Login, trainees::details),
    show("/trainees/{name}/rubric", AccessLevel::Login, rubric::page),
    change("/trainees/{name}/rubric", AccessLevel::Instructor, rubric::sign),
    change("/trainees/{name}/erase", AccessLevel::Administrator, trainees::erase),
    show("/classes", AccessLevel::Instructor, classes::class_list),
    change("/classes", AccessLevel::Instructor, classes::create),
    compute("/classes/{name}", AccessLevel::Instructor, classes::class_page),
    change("/classes/{name}/members", AccessLevel::Instructor, classes::add_members),
    change("/classes/{name}/members/remove", AccessLevel::Instructor, classes::remove_member),
    change("/classes/{name}/remove", AccessLevel::Instructor, classes::remove),
    show("/assign", AccessLevel::Instructor, assignments::page),
    change("/assign", AccessLevel::Instructor, assignments::assign),
    change("/assignments/{id}/remove", AccessLevel::Instructor, assignments::remove),
    compute("/cohort", AccessLevel::Instructor, trainees::cohort_page),
    compute("/cohort/report.html", AccessLevel::Instructor, trainees::cohort_report),
    compute("/cohort/tables/{name}", AccessLevel::Instructor, trainees::cohort_table),
    show("/scenarios", AccessLevel::Login, scenarios::scenario_list),
    show("/scenarios/new", AccessLevel::Instructor, scenario_editor::new),
    show("/scenarios/{name}", AccessLevel::Login, scenarios::scenario_page),
    show("/scenarios/{name}/edit", AccessLevel::Instructor, scenario_editor::edit),
    text("/scenario-editor/check", MAX_SCENARIO_BYTES, AccessLevel::Instructor, scenario_editor::check),
    text("/scenario-editor/save", MAX_SCENARIO_BYTES, AccessLevel::Instructor, scenario_editor::save),
    text("/scenario-editor/download", MAX_SCENARIO_BYTES, AccessLevel::Instructor, scenario_editor::download),
    show("/tiles/{name}/{z}/{x}/{y}", AccessLevel::Public, map_tiles::tile),
    show("/tiles/{name}/WMTSCapabilities.xml", AccessLevel::Public, map_tiles::capabilities),
    show("/scenarios/{name}/briefing", AccessLevel::Login, scenarios::briefing_page),
    show("/scenarios/{name}/pictures/{file}", AccessLevel::Login, scenario_pictures::show),
    upload("/scenarios/{name}/pictures", MAX_PICTURE_BYTES, AccessLevel::Instructor, scenario_pictures::add),
    change("/scenarios/{name}/pictures/remove", AccessLevel::Instructor, scenario_pictures::remove),
    upload("/scenarios", MAX_SCENARIO_BYTES, AccessLevel::Instructor, scenarios::upload),
    change("/scenarios/{name}/remove", AccessLevel::Instructor, scenarios::remove),
    show("/plan-rules", AccessLevel::Instructor, plan_rules::page),
    change("/plan-rules", AccessLevel::Instructor, plan_rules::save),
    upload("/plan-rules/upload", MAX_PLAN_RULES_BYTES, AccessLevel::Instructor, plan_rules::upload),
    change("/plan-rules/reset", AccessLevel::Instructor, plan_rules::reset),
    show("/rubric", AccessLevel::Instructor, rubric::editor),
    change("/rubric", AccessLevel::Instructor, rubric::save),
    change("/rubric/reset", AccessLevel::Instructor, rubric::reset),
    show("/upload", AccessLevel::Instructor, uploads::page),
    upload("/upload", MAX_RECORDING_BYTES, AccessLevel::Instructor, uploads::recording),
    show("/stations", AccessLevel::Instructor, stations::page),
    show("/stations/now", AccessLevel::Instructor, stations::now),
    change("/stations", AccessLevel::Instructor, stations::order),
    Route {
        path: "/stations/check-in",
        kind: RouteKind::StationMessage,
        required_access: AccessLevel::Public,
        handler: stations::check_in,
    },
    show("/stations/pictures/{name}/{file}", AccessLevel::Public, stations::picture),
    show("/live", AccessLevel::Instructor, live::page),
    show("/live/all", AccessLevel::Instructor, live::all_page),
    show("/live/all.json", AccessLevel::Instructor, live::all_now),
    show("/live/camera.jpg", AccessLevel::Instructor, live::camera),
    change("/live/act", AccessLevel::Instructor, live::run_action),
    show("/flight", AccessLevel::Login, live::own_page),
    show("/flight/now.json", AccessLevel::Login, live::own_now),
    show("/flight/camera.jpg", AccessLevel::Login, live::own_camera),
    show("/settings", AccessLevel::Administrator, settings::page),
    change("/settings/login", AccessLevel::Administrator, settings::set_login),
    change("/settings/no-login", AccessLevel::Administrator, settings::remove_login),
    change("/settings/retention", AccessLevel::Administrator, settings::retention),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_anonymous_visitors_reach_only_public_pages_and_what_has_its_own_key() {
        let open: Vec<&str> =
            ROUTES.iter().filter(|route| route.required_access == AccessLevel::Public).map(|route| route.path).collect();
        // Ground stations cannot log in, and map tiles show no defects. Training stations and reports with a video send a key.
        assert_eq!(
            open,
            [
                "/",
                "/assets/{name}",
                "/login",
                "/login",
                "/logout",
                "/language",
                "/sessions/{id}/report/{key}/video.mp4",
                "/tiles/{name}/{z}/{x}/{y}",
                "/tiles/{name}/WMTSCapabilities.xml",
                "/stations/check-in",
                "/stations/pictures/{name}/{file}"
            ]
        );
    }

    #[test]
    fn exact_every_route_is_unique() {
        for (k, a) in ROUTES.iter().enumerate() {
            let shows = |route: &Route| route.kind.is_read_only();
            assert!(!ROUTES[..k].iter().any(|b| a.path == b.path && shows(a) == shows(b)), "{}", a.path);
        }
    }
}
