//! Bridge geometry: each bridge type converts its dimensions to members, lanes and task paths. To add a type, add a
//! file here with a table of its dimensions, and a variant of [`BridgeKind`].

pub mod arch;
pub mod dimensions;
pub mod element_map;
pub mod girder;
mod girder_path;
pub mod model;
pub mod path;
pub mod quantity;
pub mod solid;
pub mod suspension;

use crate::frames::{Enu, Vec3};
use arch::Arch;
use girder::Girder;
use model::Model;
use path::{PathPlace, TaskKind};
use solid::{MemberBuilder, Placement};
use suspension::Suspension;

pub use dimensions::{BridgeField, Inconsistency};
pub use path::TaskPath;
pub use quantity::ElementQuantity;
pub use solid::{Footing, Member, Solid};

/// A bridge of any type, with its position and heading.
#[derive(Debug, Clone, PartialEq)]
pub struct Bridge {
    /// Bridge name, used in tasks and exports.
    pub name: String,
    /// Center of the deck's upper surface at midspan, m.
    pub center_m: Vec3<Enu>,
    /// Direction of the bridge's x axis (along the deck), degrees clockwise from north.
    pub heading_deg: f64,
    /// Bridge type and dimensions.
    pub kind: BridgeKind,
}

/// Type and dimensions of a bridge. Each type has its own file in `bridges/`.
#[derive(Debug, Clone, PartialEq)]
pub enum BridgeKind {
    /// An open-spandrel deck arch bridge.
    Arch(Arch),
    /// A suspension bridge.
    Suspension(Suspension),
    /// A steel girder bridge.
    Girder(Girder),
    /// A bridge imported from a 3D model.
    Model(Model),
}

/// A traffic lane or walkway: a polyline on the deck's upper surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Lane {
    /// The bridge's index in the scenario.
    pub bridge: usize,
    /// Points in the direction of travel, m.
    pub points_m: Vec<Vec3<Enu>>,
    /// True for a walkway, false for a traffic lane.
    pub walkway: bool,
}

/// Representation in scenario files of a bridge type that is defined by its dimensions.
#[derive(Debug, Clone, Copy)]
pub struct BridgeType {
    /// Value of the `type` key, and name of the dimensions table.
    pub name: &'static str,
    /// Keys in the dimensions table.
    pub fields: &'static [BridgeField],
    /// Function that creates a bridge from values in the order of the keys.
    pub create: fn(&[f64]) -> BridgeKind,
}

impl BridgeKind {
    /// All bridge types that are defined by dimensions.
    pub const TYPES: [BridgeType; 3] = [
        BridgeType { name: Arch::TYPE, fields: Arch::FIELDS, create: |values| Self::Arch(Arch::from_values(values)) },
        BridgeType {
            name: Suspension::TYPE,
            fields: Suspension::FIELDS,
            create: |values| Self::Suspension(Suspension::from_values(values)),
        },
        BridgeType { name: Girder::TYPE, fields: Girder::FIELDS, create: |values| Self::Girder(Girder::from_values(values)) },
    ];

    /// Returns all inconsistent dimensions. If there are any, the bridge cannot be built.
    #[must_use]
    pub fn inconsistencies(&self) -> Vec<Inconsistency> {
        match self {
            Self::Arch(arch) => arch.inconsistencies(),
            Self::Suspension(suspension) => suspension.inconsistencies(),
            Self::Girder(girder) => girder.inconsistencies(),
            Self::Model(_) => Vec::new(),
        }
    }
}

impl Bridge {
    /// Returns the position and heading of the bridge axes.
    #[must_use]
    pub fn placement(&self) -> Placement {
        Placement::new(self.center_m, self.heading_deg)
    }

    /// Returns all the bridge's members.
    #[must_use]
    pub fn members(&self) -> Vec<Member> {
        let mut builder = MemberBuilder::new(&self.name, self.placement());
        match &self.kind {
            BridgeKind::Arch(arch) => arch.build(&mut builder),
            BridgeKind::Suspension(suspension) => suspension.build(&mut builder),
            BridgeKind::Girder(girder) => girder.build(&mut builder),
            BridgeKind::Model(model) => model.build(&mut builder),
        }
        builder.finish()
    }

    /// Returns the deck length in meters.
    #[must_use]
    pub fn deck_length_m(&self) -> f64 {
        match &self.kind {
            BridgeKind::Arch(arch) => arch.deck_length_m(),
            BridgeKind::Suspension(suspension) => suspension.deck_length_m(),
            BridgeKind::Girder(girder) => girder.deck_length_m(),
            BridgeKind::Model(model) => model.deck_length_m(),
        }
    }

    /// Returns the deck width in meters.
    #[must_use]
    pub fn deck_width_m(&self) -> f64 {
        match &self.kind {
            BridgeKind::Arch(arch) => arch.deck_width_m,
            BridgeKind::Suspension(suspension) => suspension.deck_width_m,
            BridgeKind::Girder(girder) => girder.deck_width_m(),
            BridgeKind::Model(model) => model.deck_width_m(),
        }
    }

    /// Returns the heights, in bridge axes, of the lower and upper edge of the closed side that the deck and its girders show to the wind,
    /// m. Railings and the gaps between floorbeams are open.
    #[must_use]
    pub fn fascia_z_m(&self) -> (f64, f64) {
        match &self.kind {
            BridgeKind::Arch(arch) => (-arch.slab_m - arch.stringer_depth_m, 0.0),
            BridgeKind::Suspension(suspension) => (suspension.girder_bottom_z_m(), 0.0),
            BridgeKind::Girder(girder) => (girder.girder_bottom_z_m(), girder.barrier_m),
            BridgeKind::Model(model) => model.fascia_z_m(),
        }
    }

    /// Returns half the length, in meters, of the opening under the bridge, which must stay free of terrain.
    #[must_use]
    pub fn opening_half_length_m(&self) -> f64 {
        match &self.kind {
            BridgeKind::Arch(arch) => 0.5 * arch.span_m,
            BridgeKind::Suspension(suspension) => 0.5 * suspension.deck_length_m() - suspension.anchorage_m,
            BridgeKind::Girder(girder) => girder.backwall_back_x_m(),
            BridgeKind::Model(model) => 0.5 * model.deck_length_m(),
        }
    }

    /// Returns all parts of the bridge that rest on the ground.
    #[must_use]
    pub fn footings(&self) -> Vec<Footing> {
        match &self.kind {
            BridgeKind::Arch(arch) => arch.footings(),
            BridgeKind::Suspension(suspension) => suspension.footings(),
            BridgeKind::Girder(girder) => girder.footings(),
            BridgeKind::Model(_) => Vec::new(),
        }
    }

    /// Returns the total quantities of the bridge's elements, ordered by element number.
    #[must_use]
    pub fn quantities(&self) -> Vec<ElementQuantity> {
        match &self.kind {
            BridgeKind::Arch(arch) => arch.quantities(),
            BridgeKind::Suspension(suspension) => suspension.quantities(),
            BridgeKind::Girder(girder) => girder.quantities(),
            BridgeKind::Model(model) => model.quantities(),
        }
    }

    /// Returns the distance of the walkways from the deck's centerline, in meters.
    fn walkway_y_m(&self) -> f64 {
        match &self.kind {
            BridgeKind::Arch(_) | BridgeKind::Suspension(_) | BridgeKind::Model(_) => 0.43 * self.deck_width_m(),
            BridgeKind::Girder(girder) => girder.walkway_y_m(),
        }
    }

    /// Returns the bridge's two lanes and two walkways; none for an imported bridge, whose road is unknown. `index` is the bridge's index
    /// in the scenario.
    #[must_use]
    pub fn lanes(&self, index: usize) -> Vec<Lane> {
        if matches!(self.kind, BridgeKind::Model(_)) {
            return Vec::new();
        }
        let placement = self.placement();
        let half = 0.5 * self.deck_length_m();
        let width = self.deck_width_m();
        let lane = |y: f64, walkway: bool| {
            let ends = if y < 0.0 { [-half, half] } else { [half, -half] };
            Lane { bridge: index, points_m: ends.map(|x| placement.point([x, y, 0.0])).to_vec(), walkway }
        };
        // Traffic keeps to the right: vehicles traveling in +x use y < 0. Walkways are inside the railings.
        let walkway = self.walkway_y_m();
        vec![lane(-0.19 * width, false), lane(0.19 * width, false), lane(-walkway, true), lane(walkway, true)]
    }

    /// Returns the reference path of a task kind at a stand-off distance in meters, in the default place.
    ///
    /// # Errors
    /// Returns the supported path kinds as text if the bridge type has no such path.
    pub fn task_path(&self, kind: TaskKind, stand_off_m: f64) -> Result<TaskPath, String> {
        self.task_path_at(kind, stand_off_m, &PathPlace::default())
    }

    /// Returns the reference path of a task kind at a stand-off distance in meters, at a span or support of a girder bridge.
    ///
    /// # Errors
    /// Returns as text the supported path kinds if the bridge type has no such path, or what the path requires if it does not fit.
    pub fn task_path_at(&self, kind: TaskKind, stand_off_m: f64, place: &PathPlace) -> Result<TaskPath, String> {
        let placement = self.placement();
        let drawn = match (&self.kind, kind) {
            (BridgeKind::Arch(arch), TaskKind::SlabSide) => path::slab_side(arch, stand_off_m),
            (BridgeKind::Arch(arch), TaskKind::ArchBottom) => path::arch_bottom(arch, stand_off_m),
            (BridgeKind::Arch(arch), TaskKind::Interlayer) => path::interlayer(arch),
            (BridgeKind::Suspension(suspension), TaskKind::PierCircle) => path::pier_circle(suspension, stand_off_m)?,
            (BridgeKind::Girder(girder), TaskKind::SlabSide) => girder_path::slab_side(girder, stand_off_m)?,
            (BridgeKind::Girder(girder), TaskKind::GirderSoffit) => girder_path::girder_soffit(girder, stand_off_m, place)?,
            (BridgeKind::Girder(girder), TaskKind::BearingLine) => girder_path::bearing_line(girder, stand_off_m, place)?,
            (BridgeKind::Girder(girder), TaskKind::PierCap) => girder_path::pier_cap(girder, stand_off_m, place)?,
            (BridgeKind::Arch(_), _) => return Err("for an arch: slab_side, arch_bottom, interlayer".into()),
            (BridgeKind::Suspension(_), _) => return Err("for a suspension bridge: pier_circle".into()),
            (BridgeKind::Girder(_), _) => {
                return Err("for a girder bridge: slab_side, girder_soffit, bearing_line, pier_cap".into());
            }
            (BridgeKind::Model(_), _) => return Err("for an imported bridge: free".into()),
        };
        Ok(drawn.to_site(&placement))
    }
}
