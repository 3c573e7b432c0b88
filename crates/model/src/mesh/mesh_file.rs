//! The content of a file with meshes, whatever its format.

use super::Mesh;
use super::point_cloud::PointCloud;

pub(super) use super::vectors::check_vertex;

/// Maximum size of a file or buffer, bytes (estimate: ten million triangles).
pub const MAX_FILE_BYTES: usize = 512 * 1024 * 1024;
/// Maximum number of triangles, and of vertices, of all nodes together.
pub const MAX_TRIANGLES: usize = 5_000_000;
/// Maximum number of nodes with a mesh.
pub const MAX_NODES: usize = 50_000;
/// Maximum length of a part's name, characters.
pub const MAX_NAME_CHARS: usize = 100;

/// Function that loads another file by its name in a model.
pub type BufferLoader<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, String>;

/// The triangles of one node.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshNode {
    /// Name of the node, of its mesh or of the node above it.
    pub name: String,
    /// Element number from the `extras` of the node or of a node above it, or from the properties or the class of a product.
    pub element: Option<u16>,
    /// Whether the node's triangles collide as they are, by its `extras`.
    pub is_surface: bool,
    /// Triangles in the file's axes and units.
    pub mesh: Mesh,
    /// Color of each vertex, linear; empty if the file has none.
    pub colors: Vec<[u8; 3]>,
    /// Number of points and lines, which are ignored.
    pub ignored_primitives: usize,
}

/// Content of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MeshFile {
    /// Nodes with triangles, in file order.
    pub nodes: Vec<MeshNode>,
    /// Left out because they are not part of a bridge: names of nodes (ground, water and landing pad of an exported site), or how many
    /// products of which class.
    pub skipped: Vec<String>,
    /// Problems with single parts, one line per problem.
    pub notes: Vec<String>,
    /// Points without triangles; a file with them has no nodes.
    pub cloud: Option<PointCloud>,
}

/// Checks the size of a file.
///
/// # Errors
/// Returns the size and the allowed one if it is too large.
pub(super) fn check_file_size(bytes: &[u8]) -> Result<(), String> {
    if bytes.len() <= MAX_FILE_BYTES { Ok(()) } else { Err(format!("{} bytes (allowed: at most {MAX_FILE_BYTES})", bytes.len())) }
}

/// Returns a name that fits in one line of a report and has no characters with a meaning in patterns of names. `index` is for a node
/// without a name.
pub(super) fn clean_name(name: &str, index: usize) -> String {
    let allowed = |c: char| if c.is_control() || matches!(c, '*' | '?') { '-' } else { c };
    let clean: String = name.trim().chars().map(allowed).take(MAX_NAME_CHARS).collect();
    if clean.is_empty() { format!("node-{index}") } else { clean }
}
