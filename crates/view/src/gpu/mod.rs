//! GPU rendering: uploads a scene, draws shots, and reads pictures back. The rest of the crate does not use a GPU.

mod device;
mod overlay;
mod pass;
mod picture;
mod pipelines;
mod recent;
mod renderer;
mod targets;
mod uniforms;

pub use device::{Gpu, GpuError};
pub use overlay::{Overlay, PageTextures, paint, paint_sheet};
pub use picture::{fill, picture_texture, read};
pub use renderer::{DrawCounts, Renderer};
