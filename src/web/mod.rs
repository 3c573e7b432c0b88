//! The web server: records, reports, questionnaires and live flights in a browser. A route table defines the access
//! rules. `spandrel_training::web` renders the pages and does no I/O.

mod assets;
mod assignments;
mod auth;
mod body;
mod classes;
mod editor_edits;
mod figures;
mod hashing;
mod languages;
mod listening;
mod live;
mod lock;
mod map_tiles;
mod marks;
mod own_file;
pub mod passwords;
mod person;
mod plan_rules;
mod questions;
mod request;
mod request_pipeline;
mod response;
mod routes;
mod rubric;
mod safe_names;
mod scenario_editor;
pub mod scenario_library;
mod scenario_store;
mod scenarios;
mod server;
mod session_importer;
mod session_media;
mod sessions;
mod settings;
mod spool;
mod state;
mod temp_files;
mod tls;
mod trainees;
mod uploads;

pub use auth::is_host_name;
pub use listening::ListenConfig;
pub use live::WatchedVehicle;
pub use server::WebServer;
pub use state::ServerSetup;
