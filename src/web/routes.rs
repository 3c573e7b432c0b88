//! The one table of what may be asked: path, who may, what is done. Whoever asks for something that is not in it finds nothing.

use super::request::WebRequest;
use super::response::HandlerResult;
use super::state::ServerState;
use super::{assets, live, questions, scenarios, sessions, settings, trainees, uploads};
use spandrel_training::web::access::AccessLevel;

/// Does what was asked.
pub type Handler = fn(&ServerState, &WebRequest) -> HandlerResult;

/// Largest form without a file, bytes.
pub const FORM_MOST: usize = 64 * 1024;
/// Largest uploaded scenario, bytes: the shipped ones have some ten thousand.
pub const SCENARIO_MOST: usize = 256 * 1024;
/// Largest uploaded recording, bytes: an hour of telemetry is about a third of it.
pub const RECORDING_MOST: usize = 96 * 1024 * 1024;

/// How something is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RouteKind {
    /// A file of ours, the same for everybody.
    File,
    /// Looking changes nothing.
    Show,
    /// As `Show`, but it may take seconds to work out: one at a time.
    Compute,
    /// A form changes something; it must carry the visitor's token.
    Change,
    /// A form with one file of at most so many bytes.
    Upload(usize),
}

impl RouteKind {
    /// Changes nothing.
    pub fn is_read_only(self) -> bool {
        matches!(self, Self::File | Self::Show | Self::Compute)
    }
}

/// One row.
#[derive(Debug, Clone, Copy)]
pub struct Route {
    /// Path; parts in braces are named.
    pub path: &'static str,
    /// How.
    pub how: RouteKind,
    /// Who may.
    pub needs: AccessLevel,
    /// What is done.
    pub handler: Handler,
}

const fn show(path: &'static str, needs: AccessLevel, handler: Handler) -> Route {
    Route { path, how: RouteKind::Show, needs, handler }
}

const fn compute(path: &'static str, needs: AccessLevel, handler: Handler) -> Route {
    Route { path, how: RouteKind::Compute, needs, handler }
}

const fn change(path: &'static str, needs: AccessLevel, handler: Handler) -> Route {
    Route { path, how: RouteKind::Change, needs, handler }
}

const fn upload(path: &'static str, most: usize, needs: AccessLevel, handler: Handler) -> Route {
    Route { path, how: RouteKind::Upload(most), needs, handler }
}

/// Where live values stream from; not in the table, because it does not end.
pub const STREAM: &str = "/live/stream";

/// The table. What belongs to one trainee is judged by its handler, which knows whose it is.
pub const ROUTES: &[Route] = &[
    show("/", AccessLevel::Nothing, sessions::start),
    Route { path: "/assets/{name}", how: RouteKind::File, needs: AccessLevel::Nothing, handler: assets::file },
    show("/login", AccessLevel::Nothing, settings::login_page),
    change("/login", AccessLevel::Nothing, settings::log_in),
    change("/logout", AccessLevel::Nothing, settings::log_out),
    show("/account", AccessLevel::Login, settings::account_page),
    change("/account", AccessLevel::Login, settings::change_password),
    show("/sessions", AccessLevel::Login, sessions::session_list),
    show("/sessions/{id}", AccessLevel::Login, sessions::session_page),
    show("/sessions/{id}/report", AccessLevel::Login, sessions::report),
    show("/sessions/{id}/frames.csv", AccessLevel::Login, sessions::frames),
    show("/sessions/{id}/telemetry.tlog", AccessLevel::Login, sessions::telemetry),
    show("/sessions/{id}/questions", AccessLevel::Login, questions::page),
    change("/sessions/{id}/questions", AccessLevel::Login, questions::save),
    show("/compare", AccessLevel::Login, sessions::compare),
    show("/trainees", AccessLevel::Instructor, trainees::trainee_list),
    show("/trainees/{name}", AccessLevel::Login, trainees::trainee_page),
    show("/trainees/{name}/export.json", AccessLevel::Login, trainees::export),
    change("/trainees/{name}/details", AccessLevel::Login, trainees::details),
    change("/trainees/{name}/erase", AccessLevel::Administrator, trainees::erase),
    compute("/cohort", AccessLevel::Instructor, trainees::cohort_page),
    compute("/cohort/report.html", AccessLevel::Instructor, trainees::cohort_report),
    compute("/cohort/tables/{name}", AccessLevel::Instructor, trainees::cohort_table),
    show("/scenarios", AccessLevel::Login, scenarios::scenario_list),
    show("/scenarios/{name}", AccessLevel::Login, scenarios::scenario_page),
    upload("/scenarios", SCENARIO_MOST, AccessLevel::Instructor, scenarios::upload),
    change("/scenarios/{name}/remove", AccessLevel::Instructor, scenarios::remove),
    show("/upload", AccessLevel::Instructor, uploads::page),
    upload("/upload", RECORDING_MOST, AccessLevel::Instructor, uploads::recording),
    show("/live", AccessLevel::Instructor, live::page),
    show("/live/camera.jpg", AccessLevel::Instructor, live::camera),
    change("/live/act", AccessLevel::Instructor, live::run_action),
    show("/flight", AccessLevel::Login, live::own_page),
    show("/flight/now.json", AccessLevel::Login, live::own_now),
    show("/flight/camera.jpg", AccessLevel::Login, live::own_camera),
    show("/settings", AccessLevel::Administrator, settings::page),
    change("/settings/login", AccessLevel::Administrator, settings::set_login),
    change("/settings/no-login", AccessLevel::Administrator, settings::drop_login),
    change("/settings/retention", AccessLevel::Administrator, settings::retention),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_strangers_reach_the_login_and_nothing_else() {
        let open: Vec<&str> = ROUTES.iter().filter(|route| route.needs == AccessLevel::Nothing).map(|route| route.path).collect();
        assert_eq!(open, ["/", "/assets/{name}", "/login", "/login", "/logout"]);
    }

    #[test]
    fn exact_every_route_is_unique() {
        for (k, a) in ROUTES.iter().enumerate() {
            let shows = |route: &Route| route.how.is_read_only();
            assert!(!ROUTES[..k].iter().any(|b| a.path == b.path && shows(a) == shows(b)), "{}", a.path);
        }
    }
}
