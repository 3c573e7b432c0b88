//! What bridge types with a deck on parallel beams implement: their layout, and the members above the bearings. Everything else follows
//! from the layout.

use super::beam_layout::BeamLayout;
use super::beam_path;
use super::dimensions::{Inconsistency, InconsistencyList};
use super::path::{LocalPath, PathPlace, TaskKind};
use super::quantity::{Amounts, ElementQuantity};
use super::shape::BridgeShape;
use super::solid::{Footing, MemberBuilder};

/// A bridge type with a deck on parallel beams.
pub trait BeamBridge {
    /// Name of the type in messages, such as "a girder bridge".
    const IN_WORDS: &'static str;
    /// Kinds of tasks that follow the bridge's shape.
    const TASK_KINDS: &'static [TaskKind] =
        &[TaskKind::SlabSide, TaskKind::GirderSoffit, TaskKind::BearingLine, TaskKind::PierCap];

    /// Returns the layout of spans, beams, deck, bearings and supports.
    fn layout(&self) -> BeamLayout;

    /// Collects inconsistent dimensions.
    fn require(&self, layout: &BeamLayout, m: &mut InconsistencyList);

    /// Adds the members between the deck and the bearings.
    fn add_beams(&self, layout: &BeamLayout, b: &mut MemberBuilder);

    /// Adds the quantities of these members.
    fn add_beam_amounts(&self, layout: &BeamLayout, amounts: &mut Amounts);

    /// Returns the reference path of a task kind.
    ///
    /// # Errors
    /// Returns as text what the path requires if it does not fit.
    fn beam_path(
        &self,
        layout: &BeamLayout,
        kind: TaskKind,
        stand_off_m: f64,
        place: &PathPlace,
    ) -> Option<Result<LocalPath, String>> {
        beam_path::of_kind(layout, kind, stand_off_m, place)
    }
}

impl<T: BeamBridge> BridgeShape for T {
    fn type_in_words(&self) -> &'static str {
        T::IN_WORDS
    }

    fn task_kinds(&self) -> &'static [TaskKind] {
        T::TASK_KINDS
    }

    fn inconsistencies(&self) -> Vec<Inconsistency> {
        let mut m = InconsistencyList::default();
        self.require(&self.layout(), &mut m);
        m.0
    }

    fn build(&self, b: &mut MemberBuilder) {
        let layout = self.layout();
        layout.add_deck(b);
        layout.add_railings(b);
        self.add_beams(&layout, b);
        layout.add_supports(b);
    }

    fn deck_length_m(&self) -> f64 {
        self.layout().deck_length_m()
    }

    fn deck_width_m(&self) -> f64 {
        self.layout().deck.width_m
    }

    fn walkway_y_m(&self) -> Option<f64> {
        Some(self.layout().walkway_y_m())
    }

    fn fascia_z_m(&self) -> (f64, f64) {
        let layout = self.layout();
        (layout.lines.bottom_z_m, if layout.has_barriers() { layout.deck.railing_m } else { 0.0 })
    }

    fn opening_half_length_m(&self) -> f64 {
        self.layout().backwall_back_x_m()
    }

    fn underside_depth_m(&self) -> Option<f64> {
        Some(-self.layout().seat_z_m(0))
    }

    fn footings(&self) -> Vec<Footing> {
        self.layout().footings()
    }

    fn quantities(&self) -> Vec<ElementQuantity> {
        let layout = self.layout();
        let mut amounts = layout.amounts();
        self.add_beam_amounts(&layout, &mut amounts);
        amounts.list()
    }

    fn task_path(&self, kind: TaskKind, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String> {
        let path = T::TASK_KINDS.contains(&kind).then(|| self.beam_path(&self.layout(), kind, stand_off_m, place));
        path.flatten().unwrap_or_else(|| Err(self.supported_kinds()))
    }
}
