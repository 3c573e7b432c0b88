//! Bridge geometry: a bridge type turns its numbers into members, lanes and task paths. A new type is one new file here plus one
//! variant of [`BridgeKind`].

pub mod arch;
pub mod path;
pub mod solid;
pub mod suspension;

use super::{Bridge, BridgeKind, TaskKind};
use crate::frames::{Enu, Vec3};
use solid::{MemberBuilder, Placement};

/// One structural member. What collides, what is drawn, what carries defects and what is exported is this solid and nothing else.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Unique within the site, e.g. `arch/rib-left/07`.
    pub name: String,
    /// AASHTO MBEI element number.
    pub element: u32,
    /// The member's solid, in site coordinates.
    pub solid: Solid,
}

/// A closed convex polyhedron.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Corners, m.
    pub vertices_m: Vec<Vec3<Enu>>,
    /// Planar faces: corner indices counter-clockwise seen from outside, three or more each.
    pub faces: Vec<Vec<u32>>,
}

impl Solid {
    /// The faces as triangles, fanned from each face's first corner.
    #[must_use]
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let fan = |face: &Vec<u32>| (2..face.len()).map(|k| [face[0], face[k - 1], face[k]]).collect::<Vec<_>>();
        self.faces.iter().flat_map(fan).collect()
    }
}

/// A lane or walkway along which traffic moves: a polyline on the deck's upper surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// Which bridge.
    pub bridge: usize,
    /// Points in the direction of travel, m.
    pub points_m: Vec<Vec3<Enu>>,
    /// Vehicles or pedestrians.
    pub walkway: bool,
}

/// A number of a bridge type as scenario files write it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BridgeField {
    /// Key, with its unit.
    pub key: &'static str,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
    /// Value when the key is left out.
    pub default: f64,
    /// Meaning, with its source.
    pub doc: &'static str,
}

/// Numbers of a bridge that are legal one by one but not together.
#[derive(Debug, Clone, PartialEq)]
pub struct Inconsistency {
    /// Key to change.
    pub key: &'static str,
    /// Its value.
    pub value: f64,
    /// What the other numbers allow.
    pub allowed: String,
}

/// Collects misfits while a type's numbers are compared.
#[derive(Debug, Default)]
struct InconsistencyList(Vec<Inconsistency>);

impl InconsistencyList {
    fn integer_field(&mut self, key: &'static str, value: f64) {
        if value.fract() != 0.0 {
            self.0.push(Inconsistency { key, value, allowed: "a whole number".into() });
        }
    }

    fn at_least(&mut self, key: &'static str, value: f64, low: f64, why: &str) {
        if value < low {
            self.0.push(Inconsistency { key, value, allowed: format!("{why}: at least {low:.2}") });
        }
    }

    fn at_most(&mut self, key: &'static str, value: f64, high: f64, why: &str) {
        if value > high {
            self.0.push(Inconsistency { key, value, allowed: format!("{why}: at most {high:.2}") });
        }
    }
}

impl BridgeKind {
    /// Numbers that do not fit together: none, or the bridge cannot be built.
    #[must_use]
    pub fn misfits(&self) -> Vec<Inconsistency> {
        match self {
            Self::Arch(arch) => arch.misfits(),
            Self::Suspension(suspension) => suspension.misfits(),
        }
    }
}

/// Where a bridge stands on the ground, in its own axes, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footing {
    /// From and to along the bridge.
    pub x_m: (f64, f64),
    /// From and to across.
    pub y_m: (f64, f64),
    /// Its underside.
    pub up_m: f64,
}

/// A task's reference path with the line of sight at each point.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskPath {
    /// Points, at most 1 m apart, m. A closed path does not repeat its first point.
    pub path_m: Vec<Vec3<Enu>>,
    /// Unit vectors towards the inspected surface.
    pub look: Vec<Vec3<Enu>>,
    /// The path returns to its start.
    pub closed: bool,
}

impl Bridge {
    /// Where the bridge's own axes stand.
    #[must_use]
    pub fn placement(&self) -> Placement {
        Placement::new(self.centre_m, self.heading_deg)
    }

    /// All members.
    #[must_use]
    pub fn members(&self) -> Vec<Member> {
        let mut builder = MemberBuilder::new(&self.name, self.placement());
        match &self.kind {
            BridgeKind::Arch(arch) => arch.build(&mut builder),
            BridgeKind::Suspension(suspension) => suspension.build(&mut builder),
        }
        builder.finish()
    }

    /// Length of the deck, m.
    #[must_use]
    pub fn deck_length_m(&self) -> f64 {
        match &self.kind {
            BridgeKind::Arch(arch) => arch.deck_length_m(),
            BridgeKind::Suspension(suspension) => suspension.deck_length_m(),
        }
    }

    /// Width of the deck, m.
    #[must_use]
    pub fn deck_width_m(&self) -> f64 {
        match &self.kind {
            BridgeKind::Arch(arch) => arch.deck_width_m,
            BridgeKind::Suspension(suspension) => suspension.deck_width_m,
        }
    }

    /// Half length of the opening that the ground must leave free, m.
    #[must_use]
    pub fn opening_half_m(&self) -> f64 {
        match &self.kind {
            BridgeKind::Arch(arch) => 0.5 * arch.span_m,
            BridgeKind::Suspension(suspension) => 0.5 * suspension.deck_length_m() - suspension.anchorage_m,
        }
    }

    /// Everything that stands on the ground.
    #[must_use]
    pub fn footings(&self) -> Vec<Footing> {
        match &self.kind {
            BridgeKind::Arch(arch) => arch.footings(),
            BridgeKind::Suspension(suspension) => suspension.footings(),
        }
    }

    /// Two lanes and two walkways; `index` is this bridge's place in the scenario.
    #[must_use]
    pub fn lanes(&self, index: usize) -> Vec<Lane> {
        let placement = self.placement();
        let half = 0.5 * self.deck_length_m();
        let width = self.deck_width_m();
        let lane = |y: f64, walkway: bool| {
            let ends = if y < 0.0 { [-half, half] } else { [half, -half] };
            Lane { bridge: index, points_m: ends.map(|x| placement.point([x, y, 0.0])).to_vec(), walkway }
        };
        // Right-hand traffic: who drives along +x keeps to the right, y < 0. Walkways run inside the railings.
        vec![lane(-0.19 * width, false), lane(0.19 * width, false), lane(-0.43 * width, true), lane(0.43 * width, true)]
    }

    /// The reference path of a task kind at a stand-off.
    ///
    /// # Errors
    /// When this bridge type has no such path, in words.
    pub fn task_path(&self, kind: TaskKind, stand_off_m: f64) -> Result<TaskPath, String> {
        let placement = self.placement();
        let drawn = match (&self.kind, kind) {
            (BridgeKind::Arch(arch), TaskKind::SlabSide) => path::slab_side(arch, stand_off_m),
            (BridgeKind::Arch(arch), TaskKind::ArchBottom) => path::arch_bottom(arch, stand_off_m),
            (BridgeKind::Arch(arch), TaskKind::Interlayer) => path::interlayer(arch),
            (BridgeKind::Suspension(suspension), TaskKind::PierCircle) => path::pier_circle(suspension, stand_off_m)?,
            (BridgeKind::Arch(_), _) => return Err("an arch has slab_side, arch_bottom and interlayer".into()),
            (BridgeKind::Suspension(_), _) => return Err("a suspension bridge has pier_circle".into()),
        };
        Ok(drawn.placed(&placement))
    }
}
