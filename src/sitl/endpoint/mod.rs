//! The vehicle's MAVLink face.
