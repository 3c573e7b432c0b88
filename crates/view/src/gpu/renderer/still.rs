//! What stands still, on the device.

use crate::cells::{self, Bounds};
use crate::gpu::device::Gpu;
use crate::gpu::pass::{Copies, Solid};
use crate::scene::{Instance, Scene, Seen};
use std::sync::Arc;

/// What stands in one cell.
pub struct Fixed {
    /// What.
    pub solid: Arc<Solid>,
    /// Where.
    pub copies: Copies,
    /// It throws shadows.
    pub casts: bool,
    /// From how far it shows.
    pub seen: Seen,
    /// Where it may show.
    pub bounds: Bounds,
}

/// Everything that stands still, cell by cell.
pub fn fixed(gpu: &Gpu, scene: &Scene) -> Vec<Fixed> {
    let mut all = Vec::new();
    for part in &scene.parts {
        let mut add = |solid: Arc<Solid>, instances: &[Instance], bounds: Bounds| {
            all.extend(Copies::new(gpu, instances).map(|copies| Fixed {
                solid,
                copies,
                casts: part.casts,
                seen: part.seen,
                bounds,
            }));
        };
        if part.instances == [Instance::HERE] {
            for cell in cells::cut(&part.mesh, part.backdrop) {
                if let Some(solid) = Solid::new(gpu, &cell) {
                    add(Arc::new(solid), &part.instances, Bounds::of(&cell));
                }
            }
        } else if let Some(solid) = Solid::new(gpu, &part.mesh).map(Arc::new) {
            for (instances, ball) in cells::grouped(&part.mesh, &part.instances) {
                add(Arc::clone(&solid), &instances, ball.into());
            }
        }
    }
    all
}
