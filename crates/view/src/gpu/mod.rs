//! GPU rendering: uploads a scene, draws shots, and reads pictures back. The rest of the crate does not use a GPU.

mod device;
mod lru_cache;
mod occlusion;
mod overlay;
mod painter;
mod pass;
mod picture;
mod pipelines;
mod renderer;
mod targets;
mod uniforms;

pub use device::{Gpu, GpuError};
pub use overlay::{Overlay, PageImage, PageTextures, decode_jpeg, paint, paint_sheet};
pub use painter::{PaintArea, Painter, PanePicture};
pub use picture::{fill, picture_texture, read};
pub use renderer::{DrawCounts, Renderer};
