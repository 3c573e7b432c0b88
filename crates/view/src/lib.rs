//! What an inspector sees and hears in flight, drawn from the scenario and from telemetry alone.
//!
//! Everything up to the graphics card is plain data and pure functions; only `gpu` (feature `gpu`, wgpu) knows a device. [`scene`] turns a
//! [`Site`](spandrel_model::site::Site) into meshes once and into what moves for every picture; [`camera`] says from where and how bright;
//! [`hud`] lays the head-up display out; [`flow`] leads from a choice to a flight and its scores; [`live`] hears a flight and says what to draw
//! now; [`sound`] is what is heard of it; [`shaders`] holds the sources of the shaders.
//!
//! ```
//! use spandrel_model::frames::Vec3;
//! use spandrel_view::camera::Eye;
//!
//! // An inspector's eyes, 1.7 m over the ground, look at a bearing 30 m away and 10 m up.
//! let eye = Eye::at(Vec3::new(0.0, 0.0, 1.7), Vec3::new(0.0, 30.0, 10.0), 50_f64.to_radians(), 16.0 / 9.0);
//! assert!(eye.up().up() > 0.9);
//! ```

pub mod arrange;
pub mod camera;
pub mod cells;
pub mod exposure;
pub mod feed;
pub mod flow;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod hud;
pub mod inspector_camera;
pub mod live;
pub mod looks;
pub mod masks;
pub mod matrix;
pub mod mesh;
pub mod noise;
#[cfg(feature = "gpu")]
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
#[cfg(feature = "gpu")]
pub mod video;
