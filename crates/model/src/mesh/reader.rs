//! Reads a model in any of the formats that can be imported.

use super::mesh_file::{BufferLoader, MeshFile};
use super::{gltf_reader, obj_reader, ply_reader};

/// Format of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelFormat {
    /// glTF 2.0, text or binary.
    Gltf,
    /// Wavefront OBJ.
    Obj,
    /// PLY, text or binary.
    Ply,
}

impl ModelFormat {
    /// Names of the formats for messages.
    pub const NAMES: &'static str = ".glb, .gltf, .obj, .ply";

    /// Returns the format of a file by the end of its name; `None` for any other file.
    #[must_use]
    pub fn of_file(name: &str) -> Option<Self> {
        match name.rsplit_once('.')?.1.to_ascii_lowercase().as_str() {
            "glb" | "gltf" => Some(Self::Gltf),
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            _ => None,
        }
    }
}

/// Reads a model. `file` is its name in messages; `load` loads the other files of a text glTF or OBJ file.
///
/// # Errors
/// Returns what is wrong, with the file, the value and what is allowed.
pub fn read(format: ModelFormat, file: &str, bytes: &[u8], load: BufferLoader) -> Result<MeshFile, String> {
    match format {
        ModelFormat::Gltf => gltf_reader::read(file, bytes, load),
        ModelFormat::Obj => obj_reader::read(file, bytes, load),
        ModelFormat::Ply => ply_reader::read(file, bytes),
    }
}
