//! What a trainee sees, drawn from the scenario and from telemetry alone: never from the simulator's insides. Everything up to the graphics
//! card is plain data and pure functions; only `gpu` (feature `view`) knows a device.
//!
//! [`scene`] turns a [`Site`](crate::site::Site) into meshes once and into what moves for every picture; [`camera`] says from where and how
//! bright; [`hud`] lays the head-up display out; [`flow`] leads from a choice to a flight and its scores; [`live`] hears a flight and says what to draw now; [`sound`] is what is heard of it; [`shaders`] holds the sources of the shaders.

pub mod arrange;
pub mod camera;
pub mod cells;
pub mod exposure;
pub mod feed;
pub mod flow;
pub mod gaze;
#[cfg(feature = "view")]
pub mod gpu;
pub mod hud;
pub mod live;
pub mod looks;
pub mod masks;
pub mod matrix;
pub mod mesh;
pub mod noise;
#[cfg(feature = "view")]
pub mod photo;
pub mod picture;
pub mod quality;
pub mod scene;
pub mod shaders;
pub mod shadows;
pub mod shot;
pub mod sky;
pub mod sound;
pub mod stage;
pub mod tiles;
#[cfg(feature = "view")]
pub mod video;
