//! A piecewise constant signal.

use spandrel_model::time::SimTime;

/// Changes of a value, sorted by time. Changes at the same time are in the order of the sender's sequence numbers.
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
    /// Adds a change. Before [`Signal::sort`], changes can be added in any order.
    pub fn push(&mut self, time: SimTime, order: i64, value: T) {
        self.points.push((time, order, value));
    }

    /// Sorts the changes by time.
    pub fn sort(&mut self) {
        self.points.sort_by_key(|(time, order, _)| (*time, *order));
    }

    /// Returns the value at `time`: that of the last change at or before `time`. `None` before the first change.
    #[must_use]
    pub fn at(&self, time: SimTime) -> Option<T> {
        let after = self.points.partition_point(|point| point.0 <= time);
        after.checked_sub(1).map(|k| self.points[k].2)
    }

    /// Returns the changes after `from`, up to and including `to`.
    #[must_use]
    pub fn between(&self, from: SimTime, to: SimTime) -> &[(SimTime, i64, T)] {
        let start = self.points.partition_point(|point| point.0 <= from);
        let end = self.points.partition_point(|point| point.0 <= to);
        &self.points[start..end.max(start)]
    }

    /// Returns all changes in their current order.
    #[must_use]
    pub fn all(&self) -> &[(SimTime, i64, T)] {
        &self.points
    }

    /// Returns all changes as a mutable slice, because some times are not known until later.
    pub(super) fn all_mut(&mut self) -> &mut [(SimTime, i64, T)] {
        &mut self.points
    }
}
