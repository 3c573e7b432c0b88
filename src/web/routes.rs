//! The one table of what may be asked: path, who may, what is done. Whoever asks for something that is not in it finds nothing.

use super::answer::Answered;
use super::asked::Asked;
use super::state::State;
use super::{assets, live, people, questions, scenarios, sessions, settings, uploads};
use spandrel_training::web::access::Needs;

/// Does what was asked.
pub type Handler = fn(&State, &Asked) -> Answered;

/// Largest form without a file, bytes.
pub const FORM_MOST: usize = 64 * 1024;
/// Largest uploaded scenario, bytes: the shipped ones have some ten thousand.
pub const SCENARIO_MOST: usize = 256 * 1024;
/// Largest uploaded recording, bytes: an hour of telemetry is about a third of it.
pub const RECORDING_MOST: usize = 96 * 1024 * 1024;

/// How something is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum How {
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

impl How {
    /// Changes nothing.
    pub fn only_looks(self) -> bool {
        matches!(self, Self::File | Self::Show | Self::Compute)
    }
}

/// One row.
#[derive(Debug, Clone, Copy)]
pub struct Route {
    /// Path; parts in braces are named.
    pub path: &'static str,
    /// How.
    pub how: How,
    /// Who may.
    pub needs: Needs,
    /// What is done.
    pub handler: Handler,
}

const fn show(path: &'static str, needs: Needs, handler: Handler) -> Route {
    Route { path, how: How::Show, needs, handler }
}

const fn compute(path: &'static str, needs: Needs, handler: Handler) -> Route {
    Route { path, how: How::Compute, needs, handler }
}

const fn change(path: &'static str, needs: Needs, handler: Handler) -> Route {
    Route { path, how: How::Change, needs, handler }
}

const fn upload(path: &'static str, most: usize, needs: Needs, handler: Handler) -> Route {
    Route { path, how: How::Upload(most), needs, handler }
}

/// Where live values stream from; not in the table, because it does not end.
pub const STREAM: &str = "/live/stream";

/// The table. What belongs to one trainee is judged by its handler, which knows whose it is.
pub const ROUTES: &[Route] = &[
    show("/", Needs::Nothing, sessions::start),
    Route { path: "/assets/{name}", how: How::File, needs: Needs::Nothing, handler: assets::file },
    show("/login", Needs::Nothing, settings::login_page),
    change("/login", Needs::Nothing, settings::log_in),
    change("/logout", Needs::Nothing, settings::log_out),
    show("/account", Needs::Login, settings::account_page),
    change("/account", Needs::Login, settings::change_password),
    show("/sessions", Needs::Login, sessions::list),
    show("/sessions/{id}", Needs::Login, sessions::one),
    show("/sessions/{id}/report", Needs::Login, sessions::report),
    show("/sessions/{id}/frames.csv", Needs::Login, sessions::frames),
    show("/sessions/{id}/telemetry.tlog", Needs::Login, sessions::telemetry),
    show("/sessions/{id}/questions", Needs::Login, questions::page),
    change("/sessions/{id}/questions", Needs::Login, questions::save),
    show("/compare", Needs::Login, sessions::compare),
    show("/trainees", Needs::Instructor, people::list),
    show("/trainees/{name}", Needs::Login, people::one),
    show("/trainees/{name}/export.json", Needs::Login, people::export),
    change("/trainees/{name}/details", Needs::Login, people::details),
    change("/trainees/{name}/erase", Needs::Administrator, people::erase),
    compute("/cohort", Needs::Instructor, people::cohort_page),
    compute("/cohort/report.html", Needs::Instructor, people::cohort_report),
    compute("/cohort/tables/{name}", Needs::Instructor, people::cohort_table),
    show("/scenarios", Needs::Login, scenarios::list),
    show("/scenarios/{name}", Needs::Login, scenarios::one),
    upload("/scenarios", SCENARIO_MOST, Needs::Instructor, scenarios::upload),
    change("/scenarios/{name}/remove", Needs::Instructor, scenarios::remove),
    show("/upload", Needs::Instructor, uploads::page),
    upload("/upload", RECORDING_MOST, Needs::Instructor, uploads::recording),
    show("/live", Needs::Instructor, live::page),
    show("/live/camera.jpg", Needs::Instructor, live::camera),
    change("/live/act", Needs::Instructor, live::act),
    show("/flight", Needs::Login, live::own_page),
    show("/flight/now.json", Needs::Login, live::own_now),
    show("/flight/camera.jpg", Needs::Login, live::own_camera),
    show("/settings", Needs::Administrator, settings::page),
    change("/settings/login", Needs::Administrator, settings::set_login),
    change("/settings/no-login", Needs::Administrator, settings::drop_login),
    change("/settings/retention", Needs::Administrator, settings::retention),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_strangers_reach_the_login_and_nothing_else() {
        let open: Vec<&str> = ROUTES.iter().filter(|route| route.needs == Needs::Nothing).map(|route| route.path).collect();
        assert_eq!(open, ["/", "/assets/{name}", "/login", "/login", "/logout"]);
    }

    #[test]
    fn exact_no_row_stands_twice() {
        for (k, a) in ROUTES.iter().enumerate() {
            let shows = |route: &Route| route.how.only_looks();
            assert!(!ROUTES[..k].iter().any(|b| a.path == b.path && shows(a) == shows(b)), "{}", a.path);
        }
    }
}
