//! Measurement of a stream's picture rate.

use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Wall time period for averaging the rate.
const AVERAGING_WINDOW: SimTime = SimTime::from_ms(2_000);

/// Picture rate from the times of recent pictures.
#[derive(Debug, Clone, Default)]
pub struct PictureRate(VecDeque<SimTime>);

impl PictureRate {
    /// Records a picture sent at the given wall time.
    pub fn count(&mut self, wall: SimTime) {
        self.0.push_back(wall);
        while self.0.len() > 2 && self.0.front().is_some_and(|first| wall.saturating_sub(*first) > AVERAGING_WINDOW) {
            self.0.pop_front();
        }
    }

    /// Returns the picture rate in Hz, or `None` before the second picture.
    #[must_use]
    pub fn hz(&self) -> Option<f64> {
        let (first, last) = (self.0.front()?, self.0.back()?);
        (last > first).then(|| (self.0.len() - 1) as f64 / (*last - *first).s())
    }
}
