//! The pages of `spandrel serve` and their access control: pure functions from data to HTML, and the tables of login sessions and
//! failed logins. Callers pass the time. User-provided text is escaped by maud. Scripts and style sheets are separate files,
//! because the content security policy blocks inline code.

pub mod access;
pub mod assets;
pub mod devices;
pub mod form;
pub mod frame;
pub mod group;
pub mod job;
pub mod live;
pub mod live_state;
pub mod login;
pub mod sessions;
pub mod settings;
pub mod throttle;
pub mod trainees;
pub mod visits;
