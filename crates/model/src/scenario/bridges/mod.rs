//! Bridge geometry: each bridge type converts its dimensions to members, quantities and task paths. To add a type, add a file here with
//! a table of its dimensions and an implementation of [`BridgeShape`] or, for a deck on parallel beams, of
//! [`BeamBridge`](beam_bridge::BeamBridge), and a row in `bridge_types!` below.

pub mod arch;
pub mod beam_bridge;
pub mod beam_layout;
mod beam_members;
mod beam_path;
pub mod box_girder;
pub mod cable_stayed;
pub mod dimensions;
pub mod element_map;
pub mod girder;
pub mod masonry_arch;
pub mod model;
pub mod paint_box;
pub mod path;
mod plan_polygon;
pub mod prestressed;
pub mod quantity;
mod railing;
pub mod shape;
pub mod solid;
pub mod suspension;
pub mod task_kind;
pub mod truss;

use crate::frames::{Enu, Vec3};
use arch::Arch;
use box_girder::BoxGirder;
use cable_stayed::CableStayed;
use girder::Girder;
use masonry_arch::MasonryArch;
use model::Model;
use path::{PathPlace, TaskKind};
use prestressed::Prestressed;
use solid::{MemberBuilder, Placement};
use suspension::Suspension;
use truss::Truss;

pub use dimensions::{BridgeField, Inconsistency};
pub use path::TaskPath;
pub use quantity::ElementQuantity;
pub use shape::BridgeShape;
pub use solid::{Footing, Member, Solid, SolidSurface};

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

/// Defines [`BridgeKind`] from the types whose dimensions are in the scenario file.
macro_rules! bridge_types {
    ($($(#[$doc:meta])* $kind:ident;)+) => {
        /// Type and dimensions of a bridge. Each type has its own file in `bridges/`.
        #[derive(Debug, Clone, PartialEq)]
        pub enum BridgeKind {
            $($(#[$doc])* $kind($kind),)+
            /// A bridge imported from a 3D model.
            Model(Model),
        }

        impl BridgeKind {
            /// All bridge types that are defined by dimensions.
            pub const TYPES: &'static [BridgeType] = &[$(BridgeType {
                name: $kind::TYPE,
                fields: $kind::FIELDS,
                create: |values| Self::$kind($kind::from_values(values)),
            }),+];

            /// Returns the bridge's geometry.
            #[must_use]
            pub fn shape(&self) -> &dyn BridgeShape {
                match self {
                    $(Self::$kind(shape) => shape,)+
                    Self::Model(shape) => shape,
                }
            }
        }
    };
}

bridge_types! {
    /// An open-spandrel deck arch bridge.
    Arch;
    /// A suspension bridge.
    Suspension;
    /// A steel girder bridge.
    Girder;
    /// A prestressed concrete girder bridge.
    Prestressed;
    /// A steel through truss bridge.
    Truss;
    /// A prestressed concrete box girder bridge.
    BoxGirder;
    /// A masonry arch bridge.
    MasonryArch;
    /// A cable-stayed bridge.
    CableStayed;
}

impl BridgeKind {
    /// Returns all inconsistent dimensions. If there are any, the bridge cannot be built.
    #[must_use]
    pub fn inconsistencies(&self) -> Vec<Inconsistency> {
        self.shape().inconsistencies()
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
        self.kind.shape().build(&mut builder);
        builder.finish()
    }

    /// Returns the deck length in meters.
    #[must_use]
    pub fn deck_length_m(&self) -> f64 {
        self.kind.shape().deck_length_m()
    }

    /// Returns the deck width in meters.
    #[must_use]
    pub fn deck_width_m(&self) -> f64 {
        self.kind.shape().deck_width_m()
    }

    /// Returns the heights, in bridge axes, of the lower and upper edge of the closed side that the deck and its girders show to the wind,
    /// m. Railings and the gaps between floorbeams are open.
    #[must_use]
    pub fn fascia_z_m(&self) -> (f64, f64) {
        self.kind.shape().fascia_z_m()
    }

    /// Returns half the length, in meters, of the opening under the bridge, which must stay free of terrain.
    #[must_use]
    pub fn opening_half_length_m(&self) -> f64 {
        self.kind.shape().opening_half_length_m()
    }

    /// Returns the depth of the bridge's underside below its deck at the ends of its opening, in meters; `None` for an imported bridge,
    /// which stands on the ground as it is.
    #[must_use]
    pub fn underside_depth_m(&self) -> Option<f64> {
        self.kind.shape().underside_depth_m()
    }

    /// Returns all parts of the bridge that rest on the ground.
    #[must_use]
    pub fn footings(&self) -> Vec<Footing> {
        self.kind.shape().footings()
    }

    /// Returns the total quantities of the bridge's elements, ordered by element number.
    #[must_use]
    pub fn quantities(&self) -> Vec<ElementQuantity> {
        self.kind.shape().quantities()
    }

    /// Returns the bridge's two lanes and two walkways; none for an imported bridge, whose road is unknown. `index` is the bridge's index
    /// in the scenario.
    #[must_use]
    pub fn lanes(&self, index: usize) -> Vec<Lane> {
        let Some(walkway) = self.kind.shape().walkway_y_m() else { return Vec::new() };
        let placement = self.placement();
        let half = 0.5 * self.deck_length_m();
        let width = self.deck_width_m();
        let lane = |y: f64, walkway: bool| {
            let ends = if y < 0.0 { [-half, half] } else { [half, -half] };
            Lane { bridge: index, points_m: ends.map(|x| placement.point([x, y, 0.0])).to_vec(), walkway }
        };
        // Traffic keeps to the right: vehicles traveling in +x use y < 0. Walkways are inside the railings.
        vec![lane(-0.19 * width, false), lane(0.19 * width, false), lane(-walkway, true), lane(walkway, true)]
    }

    /// Returns the reference path of a task kind at a stand-off distance in meters, in the default place.
    ///
    /// # Errors
    /// Returns the supported path kinds as text if the bridge type has no such path.
    pub fn task_path(&self, kind: TaskKind, stand_off_m: f64) -> Result<TaskPath, String> {
        self.task_path_at(kind, stand_off_m, &PathPlace::default())
    }

    /// Returns the reference path of a task kind at a stand-off distance in meters, at a span or support of the bridge.
    ///
    /// # Errors
    /// Returns as text the supported path kinds if the bridge type has no such path, or what the path requires if it does not fit.
    pub fn task_path_at(&self, kind: TaskKind, stand_off_m: f64, place: &PathPlace) -> Result<TaskPath, String> {
        Ok(self.kind.shape().task_path(kind, stand_off_m, place)?.to_site(&self.placement()))
    }
}
