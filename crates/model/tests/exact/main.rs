//! Geometry against closed forms.

mod bridges;
mod geometry;
mod ground;
mod site;
