//! Before and after the flight, as pure functions: the briefing ([`briefing`]), session records ([`record`]), statistics
//! ([`statistics`]), training plans ([`plan`]), things to do better ([`advice`]), the defect school ([`school`]), checks of
//! scenarios ([`scenario_check`]), cohort analysis ([`cohort`]), questionnaires ([`questionnaire`]), statements for learning record
//! stores ([`xapi`]), session reports ([`report`]) and web pages ([`web`]). The application reads the session folders, maintains
//! the database and serves the pages.
//!
//! ```
//! use spandrel_training::statistics::paired_t;
//!
//! // Scores of the same six trainees in their first and second session.
//! let (first, second) = ([212.0, 250.5, 198.0, 301.0, 240.0, 222.5], [260.0, 255.0, 240.5, 310.0, 281.0, 263.0]);
//! let change = paired_t(&first, &second).expect("the pairs differ");
//! assert!(change.mean_difference > 0.0);
//! ```

pub mod advice;
pub mod assignment;
pub mod briefing;
pub mod cohort;
pub mod marks;
pub mod path_overlap;
pub mod plan;
pub mod questionnaire;
pub mod record;
pub mod report;
pub mod rubric;
pub mod scenario_check;
pub mod school;
pub mod standing;
pub mod stations;
pub mod statistics;
pub mod terms;
mod time_text;
pub mod trainee;
pub mod training_class;
pub mod web;
pub mod xapi;

pub mod testing;
