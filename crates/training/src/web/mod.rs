//! The pages of `spandrel serve` and their access control: pure functions from data to HTML, plus the tables of login
//! sessions and failed logins. Callers pass the time. maud escapes user-provided text. Scripts and style sheets are
//! separate files because the content security policy blocks inline code.

pub mod access;
pub mod assets;
pub mod assignments;
pub mod browser_sessions;
pub mod classes;
pub mod cohort_page;
mod dimension_words;
mod key_texts;
pub mod known_browsers;
pub mod layout;
pub mod live;
mod live_hazards;
pub mod live_state;
pub mod login;
pub mod login_throttle;
pub mod map_capabilities;
pub mod placed_defects;
pub mod plan_rules;
pub mod problem_words;
pub mod questionnaire_form;
pub mod rejected_form;
pub mod rubric;
pub mod scenario_check_result;
pub mod scenario_editor;
pub mod scenario_fields;
pub mod scenario_form;
mod scenario_labels;
pub mod scenarios;
pub mod served_report;
pub mod sessions;
pub mod settings;
pub mod stations;
pub mod tiles;
pub mod trainees;
