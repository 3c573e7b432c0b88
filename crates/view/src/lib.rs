//! Rendering of the inspector's view and the sound of a flight, from the scenario and telemetry only.
//!
//! Everything except `gpu` (feature `gpu`, wgpu) is plain data and pure functions. [`scene`] converts a
//! [`Site`](spandrel_model::site::Site) into static meshes and per-picture instances; [`camera`] defines the
//! projection; [`hud`] lays out the head-up display; [`flow`] is the state machine of the window's pages, from the
//! start page to the scores; [`live`] tracks a live flight for drawing; [`sound`] synthesizes its sound; [`shaders`]
//! contains the shader sources.
//!
//! ```
//! use spandrel_model::frames::Vec3;
//! use spandrel_view::camera::PinholeCamera;
//!
//! // The inspector, with eyes 1.7 m above the ground, looks at a bearing 30 m away and 10 m up.
//! let eye = PinholeCamera::at(Vec3::new(0.0, 0.0, 1.7), Vec3::new(0.0, 30.0, 10.0), 50_f64.to_radians(), 16.0 / 9.0);
//! assert!(eye.up().up() > 0.9);
//! ```

pub mod arrange;
pub mod camera;
pub mod cells;
#[cfg(feature = "gpu")]
pub mod dataset;
pub mod exposure;
pub mod feed;
pub mod flow;
pub mod flown_path;
pub mod ghost;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod ground_photo;
pub mod hud;
pub mod inspector_camera;
pub mod job_picture;
pub mod live;
pub mod masks;
pub mod material_groups;
pub mod matrix;
pub mod mesh;
pub mod noise;
pub mod path_guide;
#[cfg(feature = "gpu")]
pub mod photo;
pub mod picture;
pub mod quality;
pub mod scene;
pub mod shaders;
pub mod shadows;
pub mod shot;
pub mod site_map;
pub mod sky;
pub mod sound;
pub mod stage;
pub mod tiles;
#[cfg(feature = "gpu")]
pub mod video;
pub mod video_link;
pub mod visible_weather;
pub mod visible_wind;
