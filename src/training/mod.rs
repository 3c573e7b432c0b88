//! Across sessions: what is kept of them, what trainees say of them, what they add up to, and what to fly next. Pure: the shells in
//! `app` read folders and keep the database.

pub mod cohort;
pub mod plan;
pub mod questionnaire;
pub mod record;
pub mod statistics;
pub mod trainee;
pub mod xapi;

#[cfg(test)]
pub mod testing;
