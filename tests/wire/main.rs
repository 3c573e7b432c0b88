//! The program as a user meets it: processes, sockets, files, exit codes.

mod flights;
mod program;
mod station;
mod vehicle;
