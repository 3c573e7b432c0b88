//! Types of moving objects on the decks, with their sizes and the boxes that represent them.

use super::boxes::OrientedBox;
use super::query_types::Surface;
use crate::frames::{Enu, Vec3};

/// Type of a moving object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MoverKind {
    /// A car of 4.5 x 1.8 x 1.5 m: body and cabin.
    Car,
    /// A truck of 10 x 2.5 x 3.5 m: cab and cargo box.
    Truck,
    /// A pedestrian, 1.75 m tall.
    Pedestrian,
}

/// One box of an object: position of its center relative to the object's position on the road (along, up), and half dimensions,
/// m.
struct MoverPart {
    along_m: f64,
    up_m: f64,
    half_m: [f64; 3],
}

const CAR_PARTS: &[MoverPart] = &[
    MoverPart { along_m: 0.0, up_m: 0.5, half_m: [2.25, 0.9, 0.5] },
    MoverPart { along_m: -0.3, up_m: 1.25, half_m: [1.2, 0.8, 0.25] },
];
const TRUCK_PARTS: &[MoverPart] = &[
    MoverPart { along_m: 3.9, up_m: 1.4, half_m: [1.1, 1.2, 1.4] },
    MoverPart { along_m: -1.2, up_m: 1.75, half_m: [3.8, 1.25, 1.75] },
];
const PEDESTRIAN_PARTS: &[MoverPart] = &[MoverPart { along_m: 0.0, up_m: 0.875, half_m: [0.15, 0.25, 0.875] }];

impl MoverKind {
    /// All types of moving objects.
    pub(super) const ALL: [Self; 3] = [Self::Car, Self::Truck, Self::Pedestrian];
    /// Maximum over all types of the bounding radius plus half the length, m.
    pub(super) const MAX_MOVER_EXTENT_M: f64 = 6.3 + 5.0;

    fn parts(self) -> &'static [MoverPart] {
        match self {
            Self::Car => CAR_PARTS,
            Self::Truck => TRUCK_PARTS,
            Self::Pedestrian => PEDESTRIAN_PARTS,
        }
    }

    /// Returns half the object's length in meters.
    #[must_use]
    pub fn half_length_m(self) -> f64 {
        match self {
            Self::Car => 2.25,
            Self::Truck => 5.0,
            Self::Pedestrian => 0.25,
        }
    }

    /// Returns the radius of the bounding sphere about the object's position on the road, in meters.
    pub(super) fn reach_m(self) -> f64 {
        match self {
            Self::Car => 2.9,
            Self::Truck => 6.3,
            Self::Pedestrian => 1.8,
        }
    }

    pub(super) fn surface(self) -> Surface {
        match self {
            Self::Car | Self::Truck => Surface::Vehicle,
            Self::Pedestrian => Surface::Person,
        }
    }
}

/// Position and motion of an object at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoverPlacement {
    /// Position on the road, m.
    pub position_m: Vec3<Enu>,
    /// Unit vector in the direction of travel.
    pub forward: Vec3<Enu>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Enu>,
}

/// Returns the boxes that represent an object at its placement.
pub(super) fn boxes(kind: MoverKind, placed: MoverPlacement) -> impl Iterator<Item = OrientedBox> {
    kind.parts().iter().map(move |part| part_box(&placed, part))
}

fn part_box(placed: &MoverPlacement, part: &MoverPart) -> OrientedBox {
    let left = Vec3::new(0.0, 0.0, 1.0).cross(placed.forward).unit();
    let up = placed.forward.cross(left);
    OrientedBox {
        center_m: placed.position_m + placed.forward * part.along_m + up * part.up_m,
        axes: [placed.forward, left, up],
        half_m: part.half_m,
    }
}
