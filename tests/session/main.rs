//! Both wings on one flight: what the vehicle sends and what the monitor makes of it.

mod exported_plan;
mod zoom;
