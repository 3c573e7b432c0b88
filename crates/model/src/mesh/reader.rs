//! Reads a model in any of the formats that can be imported.

use super::mesh_file::{BufferLoader, MeshFile};
use super::{cloud_reader, gltf_reader, ifc_reader, obj_reader, ply_reader};

/// Format of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelFormat {
    /// glTF 2.0, text or binary.
    Gltf,
    /// IFC 2x3 to 4.3, in the STEP format.
    Ifc,
    /// Wavefront OBJ.
    Obj,
    /// PLY, text or binary: a mesh, or a point cloud.
    Ply,
    /// Point cloud in the ASPRS format, compressed or not.
    Las,
    /// Point cloud as text.
    PointText,
}

impl ModelFormat {
    /// Names of the formats for messages.
    pub const NAMES: &'static str = ".glb, .gltf, .ifc, .obj, .ply, .las, .laz, .xyz, .pts";

    /// Returns the format of a file by the end of its name; `None` for any other file.
    #[must_use]
    pub fn of_file(name: &str) -> Option<Self> {
        match name.rsplit_once('.')?.1.to_ascii_lowercase().as_str() {
            "glb" | "gltf" => Some(Self::Gltf),
            "ifc" => Some(Self::Ifc),
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "las" | "laz" => Some(Self::Las),
            "xyz" | "pts" => Some(Self::PointText),
            _ => None,
        }
    }

    /// Returns whether z points up in files of this format, as in IFC and in all coordinates of maps.
    #[must_use]
    pub const fn is_z_up(self) -> bool {
        match self {
            Self::Ifc | Self::Las | Self::PointText => true,
            Self::Gltf | Self::Obj | Self::Ply => false,
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
        ModelFormat::Ifc => ifc_reader::read(file, bytes),
        ModelFormat::Obj => obj_reader::read(file, bytes, load),
        ModelFormat::Ply => ply_reader::read(file, bytes),
        ModelFormat::Las => cloud_reader::read_las(file, bytes),
        ModelFormat::PointText => cloud_reader::read_text(file, bytes),
    }
}
