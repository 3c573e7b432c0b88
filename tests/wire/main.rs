//! The program as a user meets it: processes, sockets, files, exit codes.

mod answers;
mod camera;
mod camera_settings;
mod circles;
mod failures;
mod fence;
mod flavours;
mod flights;
mod honest;
mod impaired;
mod inspection;
mod items;
mod lasting;
mod manual;
mod mount;
mod network;
mod noise;
mod offboard;
mod payload;
mod plans;
mod program;
mod ranges;
mod signing;
mod station;
mod vehicle;
