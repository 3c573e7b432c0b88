//! The interface that every bridge type implements. All other code reaches a bridge through it.

use super::dimensions::Inconsistency;
use super::path::{LocalPath, PathPlace, TaskKind};
use super::quantity::ElementQuantity;
use super::solid::{Footing, MemberBuilder};

/// Share of the deck width between the deck's centerline and a walkway, unless a type has its own (estimate).
const WALKWAY_SHARE: f64 = 0.43;

/// Geometry of a bridge type, in bridge axes: x along the deck, y left, z up, origin on the deck's upper surface in the middle.
pub trait BridgeShape {
    /// Returns the type's name in messages, such as "an arch".
    fn type_in_words(&self) -> &'static str;

    /// Returns the kinds of tasks that follow the bridge's shape.
    fn task_kinds(&self) -> &'static [TaskKind];

    /// Returns all inconsistent dimensions. If there are any, the bridge cannot be built.
    fn inconsistencies(&self) -> Vec<Inconsistency>;

    /// Adds all the bridge's members to a builder.
    fn build(&self, b: &mut MemberBuilder);

    /// Returns the deck length in meters.
    fn deck_length_m(&self) -> f64;

    /// Returns the deck width in meters.
    fn deck_width_m(&self) -> f64;

    /// Returns the distance of the walkways from the deck's centerline in meters; `None` for a bridge without roadway.
    fn walkway_y_m(&self) -> Option<f64> {
        Some(WALKWAY_SHARE * self.deck_width_m())
    }

    /// Returns the heights of the lower and upper edge of the closed side that the deck and its girders show to the wind, m. Railings and
    /// the gaps between floorbeams are open.
    fn fascia_z_m(&self) -> (f64, f64);

    /// Returns half the length, in meters, of the opening under the bridge, which must stay free of terrain.
    fn opening_half_length_m(&self) -> f64;

    /// Returns the depth of the bridge's underside below its deck at the ends of the opening, in meters; `None` for a bridge that stands
    /// on the ground as it is, without earthworks.
    fn underside_depth_m(&self) -> Option<f64>;

    /// Returns all parts of the bridge that rest on the ground.
    fn footings(&self) -> Vec<Footing>;

    /// Returns the total quantities of the bridge's elements, ordered by element number.
    fn quantities(&self) -> Vec<ElementQuantity>;

    /// Returns the reference path of one of the [`Self::task_kinds`], at a stand-off distance in meters.
    ///
    /// # Errors
    /// Returns as text what the path requires if it does not fit, or the supported kinds if the type has no such path.
    fn task_path(&self, kind: TaskKind, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String>;

    /// Returns the supported kinds of tasks as text.
    fn supported_kinds(&self) -> String {
        let keys: Vec<&str> = self.task_kinds().iter().map(|kind| kind.key()).collect();
        format!("for {}: {}", self.type_in_words(), keys.join(", "))
    }
}
