//! Static geometry on the GPU.

use crate::cells::{self, CellBounds};
use crate::gpu::device::Gpu;
use crate::gpu::pass::{GpuMesh, MeshInstances};
use crate::scene::{Instance, Scene, VisibleRange};
use std::sync::Arc;

/// Static objects of one cell.
pub struct StaticCell {
    /// The objects' mesh.
    pub solid: Arc<GpuMesh>,
    /// Instances of the mesh in this cell.
    pub copies: MeshInstances,
    /// Whether the objects are drawn into shadow maps.
    pub casts_shadows: bool,
    /// Visibility range in the direct view and in the reflection.
    pub visible_range: VisibleRange,
    /// Bounds for culling.
    pub bounds: CellBounds,
}

/// Uploads all static objects, one entry per cell.
pub fn fixed(gpu: &Gpu, scene: &Scene) -> Vec<StaticCell> {
    let mut all = Vec::new();
    for part in &scene.parts {
        let mut add = |solid: Arc<GpuMesh>, instances: &[Instance], bounds: CellBounds| {
            all.extend(MeshInstances::new(gpu, instances).map(|copies| StaticCell {
                solid,
                copies,
                casts_shadows: part.casts_shadows,
                visible_range: part.visible_range,
                bounds,
            }));
        };
        if part.instances == [Instance::IDENTITY] {
            for cell in cells::split_into_cells(&part.mesh, part.backdrop) {
                if let Some(solid) = GpuMesh::new(gpu, &cell) {
                    add(Arc::new(solid), &part.instances, CellBounds::of(&cell));
                }
            }
        } else if let Some(solid) = GpuMesh::new(gpu, &part.mesh).map(Arc::new) {
            for (instances, ball) in cells::group_instances(&part.mesh, &part.instances) {
                add(Arc::clone(&solid), &instances, ball.into());
            }
        }
    }
    all
}
