//! Manual control: MANUAL_CONTROL and RC_CHANNELS_OVERRIDE as stick intents. The first sender keeps the sticks until it falls silent.

use crate::base::time::SimTime;
use crate::mav::dialect::{MANUAL_CONTROL_DATA, RC_CHANNELS_OVERRIDE_DATA};
use crate::sitl::autopilot::Sticks;

/// The field's "not used".
const UNUSED: i16 = i16::MAX;

/// Who holds the sticks, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Manual {
    /// A sender that is silent this long has let go of the sticks, s.
    pub let_go_s: f64,
    holder: Option<(u8, u8)>,
    heard: SimTime,
    sticks: Sticks,
}

impl Default for Manual {
    fn default() -> Self {
        let let_go_s = crate::sitl::autopilot::Tuning::default().manual_patience_s();
        Self { let_go_s, holder: None, heard: SimTime::ZERO, sticks: Sticks::default() }
    }
}

impl Manual {
    /// The sticks, while they are fresh.
    #[must_use]
    pub fn fresh(&self, now: SimTime) -> Option<Sticks> {
        (self.holder.is_some() && (now - self.heard).s() <= self.let_go_s).then_some(self.sticks)
    }

    fn take(&mut self, from: (u8, u8), sticks: Sticks, now: SimTime) -> Option<Sticks> {
        let other = self.holder.is_some_and(|holder| holder != from) && (now - self.heard).s() <= self.let_go_s;
        if other {
            return None;
        }
        (self.holder, self.heard, self.sticks) = (Some(from), now, sticks);
        Some(sticks)
    }

    /// MANUAL_CONTROL: x forward, y right, r clockwise in -1000..1000; z is throttle in 0..1000 with 500 as its middle. Anything out of
    /// range or not used counts as centred.
    pub fn manual_control(&mut self, from: (u8, u8), m: &MANUAL_CONTROL_DATA, now: SimTime) -> Option<Sticks> {
        let axis = |v: i16| if v == UNUSED || !(-1000..=1000).contains(&v) { 0.0 } else { f64::from(v) / 1000.0 };
        let up = if (0..=1000).contains(&m.z) { f64::from(m.z) / 500.0 - 1.0 } else { 0.0 };
        self.take(from, Sticks { forward: axis(m.x), right: axis(m.y), up, yaw: axis(m.r) }, now)
    }

    /// RC_CHANNELS_OVERRIDE: channels 1 to 4 roll, pitch, throttle, yaw in microseconds; 0 and 65535 leave a channel centred. Pitch is
    /// reversed as on a transmitter: stick forward is below the middle.
    pub fn channels(&mut self, from: (u8, u8), c: &RC_CHANNELS_OVERRIDE_DATA, now: SimTime) -> Option<Sticks> {
        let axis = |us: u16| if (800..=2200).contains(&us) { ((f64::from(us) - 1500.0) / 500.0).clamp(-1.0, 1.0) } else { 0.0 };
        let all = [c.chan1_raw, c.chan2_raw, c.chan3_raw, c.chan4_raw];
        if all.iter().all(|us| *us == 0 || *us == u16::MAX) {
            return None;
        }
        let sticks = Sticks { right: axis(all[0]), forward: -axis(all[1]), up: axis(all[2]), yaw: axis(all[3]) };
        self.take(from, sticks, now)
    }
}
