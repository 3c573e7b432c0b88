//! Database of sessions, trainees and answers. The session folders are the source of truth; the database can be rebuilt
//! from them at any time, except for data that people entered: trainee details, classes, assignments, sign-offs and logins.

mod accounts;
mod address;
mod assignments;
mod batch_import;
mod classes;
mod database;
mod erasure;
mod erasure_marks;
mod import;
mod json_lines;
mod known_reliability;
mod location;
mod migrate;
mod people;
pub mod push;
mod sessions;
mod sign_offs;
#[cfg(test)]
mod tests;
mod trainees;

pub use accounts::Account;
pub use batch_import::{ImportCounts, import_into};
pub use database::Database;
pub use import::{id as session_id, is_erased, read as read_session, session_folders};
pub use json_lines::{lines, read_json_lines};
pub use known_reliability::reliability_beside;
pub use location::RecordsLocation;
pub use people::{erase_older_than, erase_trainee, find, folders_of_trainee, folders_older_than, trainee_data};
