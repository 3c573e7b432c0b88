//! The kinds of tasks, and the rules that depend only on the kind, from one table. To add a kind, add a row.

use std::fmt::Write as _;

/// Part of a bridge that a task can name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlaceKey {
    /// The path is determined by the bridge.
    None,
    /// A span: `span_number`.
    Span,
    /// A pier or abutment: `support_number`.
    Support,
}

/// Direction from a path toward the inspected surface, perpendicular to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceSide {
    /// There is no single surface at the stand-off distance.
    None,
    /// The viewing direction.
    InView,
    /// Up, and perpendicular to the path.
    Above,
    /// The horizontal part of the viewing direction.
    Beside,
}

/// Rules for the tasks of one kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskRules {
    /// Value of `kind` in scenario files.
    pub key: &'static str,
    /// Default on-path threshold, m (docs/src/reference/assessment.md, "On path"; the TASBID paper specifies none).
    pub threshold_m: f64,
    /// True for paths below a deck, which need the lamp by default.
    pub is_dark: bool,
    /// Part of the bridge that the task can name.
    pub place: PlaceKey,
    /// Side of the inspected surface.
    pub surface: SurfaceSide,
}

/// Defines the enum [`TaskKind`] and its rules: variant, key, default threshold in meters, whether the path is dark, the part of the
/// bridge that the task can name, and the side of the inspected surface.
macro_rules! task_kinds {
    ($($(#[$doc:meta])* $kind:ident $key:literal $threshold_m:literal $dark:literal $place:ident $surface:ident;)+) => {
        /// Type of task path.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum TaskKind {
            $($(#[$doc])* $kind,)+
        }

        impl TaskKind {
            /// All kinds, in the order of the documentation.
            pub const ALL: &'static [Self] = &[$(Self::$kind),+];

            /// Returns the rules for tasks of this kind.
            #[must_use]
            pub const fn rules(self) -> TaskRules {
                match self {
                    $(Self::$kind => TaskRules {
                        key: $key,
                        threshold_m: $threshold_m,
                        is_dark: $dark,
                        place: PlaceKey::$place,
                        surface: SurfaceSide::$surface,
                    },)+
                }
            }
        }
    };
}

task_kinds! {
    /// A straight line along one side of the deck slab.
    SlabSide "slab_side" 3.0 false None InView;
    /// A curve below the arch.
    ArchBottom "arch_bottom" 3.0 true None Above;
    /// A straight line through the space between the deck and the arch.
    Interlayer "interlayer" 1.75 true None None;
    /// A closed loop around a pier near the water.
    PierCircle "pier_circle" 2.0 false None InView;
    /// A line under the girders of a span, out and back if the bridge is wide.
    GirderSoffit "girder_soffit" 3.0 true Span Above;
    /// A straight line along the bearings on a pier or abutment.
    BearingLine "bearing_line" 2.0 true Support None;
    /// A closed loop around a pier cap.
    PierCap "pier_cap" 2.0 false Support Beside;
    /// A line along the outside of a truss, out and back at two heights.
    TrussPanel "truss_panel" 2.0 false Span Beside;
    /// A line under the floorbeams and stringers of a span, out and back.
    FloorSystem "floor_system" 3.0 true Span Above;
    /// A curve below the barrel of a masonry arch.
    BarrelSoffit "barrel_soffit" 3.0 true Span Above;
    /// A curve along the face of the ring of a masonry arch.
    ArchRing "arch_ring" 2.0 false Span Beside;
    /// A line along a stay of a cable-stayed bridge, from the deck up.
    StayCable "stay_cable" 2.0 false None Beside;
    /// A path through points listed in the scenario.
    Free "free" 2.0 false None None;
}

impl TaskKind {
    /// Returns the value of `kind` in scenario files.
    #[must_use]
    pub const fn key(self) -> &'static str {
        self.rules().key
    }

    /// Returns the keys of the kinds that meet a condition, such as "arch_bottom and interlayer".
    #[must_use]
    pub fn keys_in_words(is_wanted: impl Fn(&TaskRules) -> bool) -> String {
        let keys: Vec<&str> = Self::ALL.iter().map(|kind| kind.rules()).filter(|rules| is_wanted(rules)).map(|r| r.key).collect();
        match keys.split_last() {
            Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
            Some((last, _)) => (*last).to_owned(),
            None => String::new(),
        }
    }

    /// Returns the default thresholds of all kinds as text, such as "3, 1.75".
    #[must_use]
    pub fn thresholds_in_words() -> String {
        let mut text = String::new();
        for (k, kind) in Self::ALL.iter().enumerate() {
            let _ = write!(text, "{}{}", if k > 0 { ", " } else { "" }, kind.rules().threshold_m);
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_kinds_are_listed_in_words() {
        assert_eq!(TaskKind::keys_in_words(|rules| rules.threshold_m < 2.0), "interlayer");
        assert_eq!(
            TaskKind::keys_in_words(|rules| rules.surface == SurfaceSide::Beside),
            "pier_cap, truss_panel, arch_ring and stay_cable"
        );
        assert_eq!(TaskKind::keys_in_words(|rules| rules.key.starts_with("pier")), "pier_circle and pier_cap");
        assert_eq!(TaskKind::keys_in_words(|_| false), "");
        assert!(TaskKind::thresholds_in_words().starts_with("3, 3, 1.75, 2"));
    }
}
