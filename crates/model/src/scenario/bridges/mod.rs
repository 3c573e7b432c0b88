//! Bridge geometry: each bridge type converts its dimensions to members, lanes and task paths. A new type takes one new file here,
//! with the table of its dimensions, and one variant of [`BridgeKind`].

pub mod arch;
pub mod dimensions;
pub mod path;
pub mod solid;
pub mod suspension;

use super::{Bridge, BridgeKind, TaskKind};
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use arch::Arch;
use solid::{MemberBuilder, Placement};
use suspension::Suspension;

pub use dimensions::{BridgeField, Inconsistency};

/// One structural member. Collision, rendering, defects and export all use the same solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Member name, unique within the site, such as `arch/rib-left/07`.
    pub name: String,
    /// Element to which the member belongs.
    pub element: Element,
    /// Solid of the member, in site coordinates.
    pub solid: Solid,
}

/// A closed convex polyhedron.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Vertices, m.
    pub vertices_m: Vec<Vec3<Enu>>,
    /// Planar faces: three or more vertex indices each, counterclockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
}

impl Solid {
    /// Returns the faces as triangle fans from each face's first vertex.
    #[must_use]
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let fan = |face: &Vec<u32>| (2..face.len()).map(|k| [face[0], face[k - 1], face[k]]).collect::<Vec<_>>();
        self.faces.iter().flat_map(fan).collect()
    }
}

/// A traffic lane or walkway: a polyline on the deck's upper surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// Index of the bridge.
    pub bridge: usize,
    /// Points in the direction of travel, m.
    pub points_m: Vec<Vec3<Enu>>,
    /// True for a walkway, false for a traffic lane.
    pub walkway: bool,
}

/// A bridge type as scenario files name it.
#[derive(Debug, Clone, Copy)]
pub struct BridgeType {
    /// Value of `type`, and name of the table with the dimensions.
    pub name: &'static str,
    /// Keys of that table.
    pub fields: &'static [BridgeField],
    /// Creates a bridge from values in the order of the keys.
    pub create: fn(&[f64]) -> BridgeKind,
}

impl BridgeKind {
    /// All bridge types.
    pub const TYPES: [BridgeType; 2] = [
        BridgeType { name: Arch::TYPE, fields: Arch::FIELDS, create: |values| Self::Arch(Arch::from_values(values)) },
        BridgeType {
            name: Suspension::TYPE,
            fields: Suspension::FIELDS,
            create: |values| Self::Suspension(Suspension::from_values(values)),
        },
    ];

    /// Returns all inconsistent dimensions; if there are any, the bridge cannot be built.
    #[must_use]
    pub fn misfits(&self) -> Vec<Inconsistency> {
        match self {
            Self::Arch(arch) => arch.misfits(),
            Self::Suspension(suspension) => suspension.misfits(),
        }
    }
}

/// A part of a bridge that rests on the ground, in bridge axes, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footing {
    /// Start and end along the bridge.
    pub x_m: (f64, f64),
    /// Start and end across the bridge.
    pub y_m: (f64, f64),
    /// Height of its underside.
    pub up_m: f64,
}

/// Reference path of a task, with a viewing direction at each point.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskPath {
    /// Points, at most 1 m apart, m. A closed path does not repeat its first point.
    pub path_m: Vec<Vec3<Enu>>,
    /// Unit vectors toward the inspected surface.
    pub look: Vec<Vec3<Enu>>,
    /// The path returns to its start.
    pub closed: bool,
}

impl Bridge {
    /// Returns the position and heading of the bridge axes.
    #[must_use]
    pub fn placement(&self) -> Placement {
        Placement::new(self.centre_m, self.heading_deg)
    }

    /// Returns all members.
    #[must_use]
    pub fn members(&self) -> Vec<Member> {
        let mut builder = MemberBuilder::new(&self.name, self.placement());
        match &self.kind {
            BridgeKind::Arch(arch) => arch.build(&mut builder),
            BridgeKind::Suspension(suspension) => suspension.build(&mut builder),
        }
        builder.finish()
    }

    /// Returns the length of the deck, m.
    #[must_use]
    pub fn deck_length_m(&self) -> f64 {
        match &self.kind {
            BridgeKind::Arch(arch) => arch.deck_length_m(),
            BridgeKind::Suspension(suspension) => suspension.deck_length_m(),
        }
    }

    /// Returns the width of the deck, m.
    #[must_use]
    pub fn deck_width_m(&self) -> f64 {
        match &self.kind {
            BridgeKind::Arch(arch) => arch.deck_width_m,
            BridgeKind::Suspension(suspension) => suspension.deck_width_m,
        }
    }

    /// Returns half the length of the opening under the bridge that terrain must not fill, m.
    #[must_use]
    pub fn opening_half_m(&self) -> f64 {
        match &self.kind {
            BridgeKind::Arch(arch) => 0.5 * arch.span_m,
            BridgeKind::Suspension(suspension) => 0.5 * suspension.deck_length_m() - suspension.anchorage_m,
        }
    }

    /// Returns everything that rests on the ground.
    #[must_use]
    pub fn footings(&self) -> Vec<Footing> {
        match &self.kind {
            BridgeKind::Arch(arch) => arch.footings(),
            BridgeKind::Suspension(suspension) => suspension.footings(),
        }
    }

    /// Returns two lanes and two walkways; `index` is the index of this bridge in the scenario.
    #[must_use]
    pub fn lanes(&self, index: usize) -> Vec<Lane> {
        let placement = self.placement();
        let half = 0.5 * self.deck_length_m();
        let width = self.deck_width_m();
        let lane = |y: f64, walkway: bool| {
            let ends = if y < 0.0 { [-half, half] } else { [half, -half] };
            Lane { bridge: index, points_m: ends.map(|x| placement.point([x, y, 0.0])).to_vec(), walkway }
        };
        // Right-hand traffic: vehicles traveling in +x use the right side, y < 0. Walkways are inside the railings.
        vec![lane(-0.19 * width, false), lane(0.19 * width, false), lane(-0.43 * width, true), lane(0.43 * width, true)]
    }

    /// Returns the reference path of a task kind at a stand-off distance, m.
    ///
    /// # Errors
    /// If this bridge type has no such path; describes the supported paths.
    pub fn task_path(&self, kind: TaskKind, stand_off_m: f64) -> Result<TaskPath, String> {
        let placement = self.placement();
        let drawn = match (&self.kind, kind) {
            (BridgeKind::Arch(arch), TaskKind::SlabSide) => path::slab_side(arch, stand_off_m),
            (BridgeKind::Arch(arch), TaskKind::ArchBottom) => path::arch_bottom(arch, stand_off_m),
            (BridgeKind::Arch(arch), TaskKind::Interlayer) => path::interlayer(arch),
            (BridgeKind::Suspension(suspension), TaskKind::PierCircle) => path::pier_circle(suspension, stand_off_m)?,
            (BridgeKind::Arch(_), _) => return Err("for an arch: slab_side, arch_bottom, interlayer".into()),
            (BridgeKind::Suspension(_), _) => return Err("for a suspension bridge: pier_circle".into()),
        };
        Ok(drawn.placed(&placement))
    }
}
