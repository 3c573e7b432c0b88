//! What stands still, on the device.

use crate::cells::{self, CellBounds};
use crate::gpu::device::Gpu;
use crate::gpu::pass::{GpuMesh, MeshInstances};
use crate::scene::{Instance, Scene, VisibleRange};
use std::sync::Arc;

/// What stands in one cell.
pub struct StaticCell {
    /// What.
    pub solid: Arc<GpuMesh>,
    /// Where.
    pub copies: MeshInstances,
    /// It throws shadows.
    pub casts: bool,
    /// From how far it shows.
    pub visible_range: VisibleRange,
    /// Where it may show.
    pub bounds: CellBounds,
}

/// Everything that stands still, cell by cell.
pub fn fixed(gpu: &Gpu, scene: &Scene) -> Vec<StaticCell> {
    let mut all = Vec::new();
    for part in &scene.parts {
        let mut add = |solid: Arc<GpuMesh>, instances: &[Instance], bounds: CellBounds| {
            all.extend(MeshInstances::new(gpu, instances).map(|copies| StaticCell {
                solid,
                copies,
                casts: part.casts,
                visible_range: part.visible_range,
                bounds,
            }));
        };
        if part.instances == [Instance::HERE] {
            for cell in cells::cut(&part.mesh, part.backdrop) {
                if let Some(solid) = GpuMesh::new(gpu, &cell) {
                    add(Arc::new(solid), &part.instances, CellBounds::of(&cell));
                }
            }
        } else if let Some(solid) = GpuMesh::new(gpu, &part.mesh).map(Arc::new) {
            for (instances, ball) in cells::grouped(&part.mesh, &part.instances) {
                add(Arc::clone(&solid), &instances, ball.into());
            }
        }
    }
    all
}
