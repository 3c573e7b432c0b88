//! Live flights. Each vehicle has a thread that subscribes to the vehicle's payload port, streams values to the pages
//! and sends the instructor's commands.

mod camera_picture;
mod command_queue;
mod flight_owner;
mod instructor_actions;
mod instructor_command;
mod own_flight;
mod page;
mod picture;
mod stream;
mod telemetry_listener;
mod tiles;
mod vehicle;
mod vehicle_choice;

pub use camera_picture::show as camera;
pub use instructor_actions::run_action;
pub use own_flight::{camera as own_camera, current as own_now, page as own_page};
pub use page::page;
pub use stream::stream;
pub use tiles::{current as all_now, page as all_page};
pub use vehicle::{LiveVehicle, WatchedVehicle};
pub use vehicle_choice::select_vehicle;
