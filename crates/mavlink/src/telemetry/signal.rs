//! A value that changes at instants and holds in between.

use spandrel_model::time::SimTime;

/// Changes in time order; the sender's order decides among equal times.
#[derive(Debug, Clone, PartialEq)]
pub struct Signal<T> {
    points: Vec<(SimTime, i64, T)>,
}

impl<T> Default for Signal<T> {
    fn default() -> Self {
        Self { points: Vec::new() }
    }
}

impl<T: Copy> Signal<T> {
    /// Adds a change; order does not matter until [`Signal::sort`].
    pub fn push(&mut self, time: SimTime, order: i64, value: T) {
        self.points.push((time, order, value));
    }

    /// Brings the changes into time order.
    pub fn sort(&mut self) {
        self.points.sort_by_key(|(time, order, _)| (*time, *order));
    }

    /// The value at `time`: that of the last change at or before it.
    #[must_use]
    pub fn at(&self, time: SimTime) -> Option<T> {
        let after = self.points.partition_point(|point| point.0 <= time);
        after.checked_sub(1).map(|k| self.points[k].2)
    }

    /// Changes with `from < time <= to`.
    #[must_use]
    pub fn between(&self, from: SimTime, to: SimTime) -> &[(SimTime, i64, T)] {
        let start = self.points.partition_point(|point| point.0 <= from);
        let end = self.points.partition_point(|point| point.0 <= to);
        &self.points[start..end.max(start)]
    }

    /// All changes.
    #[must_use]
    pub fn all(&self) -> &[(SimTime, i64, T)] {
        &self.points
    }

    /// Mutable changes, for setting times that become known later.
    pub(super) fn all_mut(&mut self) -> &mut [(SimTime, i64, T)] {
        &mut self.points
    }
}
