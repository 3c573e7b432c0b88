//! Manual control: converts MANUAL_CONTROL and RC_CHANNELS_OVERRIDE to stick input and arbitrates between senders.
//! Reports every change of control.

use super::buttons::ButtonState;
use super::params::StickPolicy;
use crate::autopilot::Sticks;
use crate::endpoint::link::LinkId;
use spandrel_mavlink::dialect::{MANUAL_CONTROL_DATA, RC_CHANNELS_OVERRIDE_DATA};
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Field value that means "not used".
const UNUSED_VALUE: i16 = i16::MAX;
/// Interval between reports about an ignored sender, s.
const REPORT_INTERVAL_S: f64 = 5.0;
/// Range of valid channel pulses, microseconds; other values are ignored (ArduPilot passes them on).
pub const VALID_PULSES_US: std::ops::RangeInclusive<u16> = 800..=2200;
const CENTER_PULSE_US: u16 = 1500;
/// Number of channels other than the sticks.
pub const AUX_CHANNEL_COUNT: usize = 12;
/// Number of these channels that a value of 0 releases: channels 5 to 8.
const LOW_AUX_CHANNEL_COUNT: usize = 4;
/// Default values of channels 5 to 16, microseconds (ArduPilot's SITL: SIM RC defaults).
const DEFAULT_AUX_PULSES_US: [u16; AUX_CHANNEL_COUNT] = [1800, 1000, 1000, 1800, 1500, 1500, 1500, 1500, 1500, 1500, 1500, 1500];
/// Value that releases channels 9 and up; 0 releases channels 1 to 8 (MAVLink common).
const HIGH_CHANNEL_RELEASE_VALUE: u16 = 65_534;
/// Maximum number of remembered senders with a signed throttle, to limit memory use.
const MAX_SIGNED_THROTTLE_SENDERS: usize = 64;
/// Minimum gimbal axis change that has an effect, as a fraction of full deflection.
const MIN_GIMBAL_AXIS_CHANGE: f64 = 0.01;
/// Extension bits in `enabled_extensions`.
const HAS_PITCH: u8 = 1;

/// A sender: its link, system ID and component ID.
type StickSender = (LinkId, (u8, u8));

/// State of manual control.
#[derive(Debug, Clone, PartialEq)]
pub struct ManualControl {
    /// Timeout after which a silent sender loses control, s.
    pub release_timeout_s: f64,
    /// Arbitration policy for multiple senders.
    pub policy: StickPolicy,
    controlling_sender: Option<StickSender>,
    last_input: SimTime,
    sticks: Sticks,
    pulses_us: [u16; 4],
    aux_pulses_us: [u16; AUX_CHANNEL_COUNT],
    /// Senders with a throttle range of -1000 to 1000.
    signed_throttle_senders: Vec<StickSender>,
    gimbal: Option<f64>,
    last_report: Option<(StickSender, SimTime)>,
    texts: VecDeque<String>,
    /// Button state of the sender in control.
    pub button_state: ButtonState,
}

impl Default for ManualControl {
    fn default() -> Self {
        Self {
            release_timeout_s: crate::autopilot::Tuning::default().manual_timeout_s(),
            policy: StickPolicy::FirstSenderKeeps,
            controlling_sender: None,
            last_input: SimTime::ZERO,
            sticks: Sticks::default(),
            pulses_us: [CENTER_PULSE_US; 4],
            aux_pulses_us: DEFAULT_AUX_PULSES_US,
            signed_throttle_senders: Vec::new(),
            gimbal: None,
            last_report: None,
            texts: VecDeque::new(),
            button_state: ButtonState::default(),
        }
    }
}

impl ManualControl {
    /// Returns the stick positions, or `None` after the timeout.
    #[must_use]
    pub fn fresh(&self, now: SimTime) -> Option<Sticks> {
        self.has_controlling_sender(now).then_some(self.sticks)
    }

    /// Returns the stick positions as transmitter pulse widths in microseconds, or `None` after the timeout.
    #[must_use]
    pub fn pulses_us(&self, now: SimTime) -> Option<[u16; 4]> {
        self.has_controlling_sender(now).then_some(self.pulses_us)
    }

    /// Returns channels 5 to 16 in microseconds.
    #[must_use]
    pub fn aux_us(&self) -> [u16; AUX_CHANNEL_COUNT] {
        self.aux_pulses_us
    }

    /// Applies channels 5 to 16 of an override if this sender may take control.
    pub fn apply_aux_channels(&mut self, from: StickSender, c: &RC_CHANNELS_OVERRIDE_DATA, now: SimTime) {
        if self.policy == StickPolicy::FirstSenderKeeps
            && self.controlling_sender.is_some_and(|holder| holder != from)
            && self.has_controlling_sender(now)
        {
            return;
        }
        for (k, us) in aux_channels(c).into_iter().enumerate() {
            let released = if k < LOW_AUX_CHANNEL_COUNT { us == 0 } else { us == HIGH_CHANNEL_RELEASE_VALUE };
            if released {
                self.aux_pulses_us[k] = DEFAULT_AUX_PULSES_US[k];
            } else if VALID_PULSES_US.contains(&us) {
                self.aux_pulses_us[k] = us;
            }
        }
    }

    /// Releases the state of a closed link, because the link ID may be reused.
    pub fn forget(&mut self, link: LinkId) {
        self.signed_throttle_senders.retain(|(known, _)| *known != link);
    }

    fn has_controlling_sender(&self, now: SimTime) -> bool {
        self.controlling_sender.is_some() && (now - self.last_input).s() <= self.release_timeout_s
    }

    /// Removes and returns the next text to broadcast.
    pub fn poll_text(&mut self) -> Option<String> {
        self.texts.pop_front()
    }

    fn take(&mut self, from: StickSender, sticks: Sticks, pulses_us: [u16; 4], now: SimTime) -> Option<Sticks> {
        let another = self.controlling_sender.filter(|holder| *holder != from && self.has_controlling_sender(now));
        if let Some(holder) = another {
            let moved = [sticks.forward, sticks.right, sticks.up, sticks.yaw].iter().any(|axis| axis.abs() > 0.1);
            if self.policy == StickPolicy::FirstSenderKeeps || !moved {
                self.report_ignored_sender(from, holder, now);
                return None;
            }
        }
        if self.controlling_sender != Some(from) {
            if self.controlling_sender.is_some() {
                self.texts.push_back(format!("{} took control of the sticks", sender_name(from)));
            }
            self.button_state = ButtonState::default();
            self.gimbal = None;
        }
        (self.controlling_sender, self.last_input, self.sticks, self.pulses_us) = (Some(from), now, sticks, pulses_us);
        Some(sticks)
    }

    fn report_ignored_sender(&mut self, from: StickSender, controlling_sender: StickSender, now: SimTime) {
        if self.last_report.is_none_or(|(known, at)| known != from || (now - at).s() >= REPORT_INTERVAL_S) {
            self.last_report = Some((from, now));
            self.texts.push_back(format!("{} sticks ignored: {} in control", sender_name(from), sender_name(controlling_sender)));
        }
    }

    /// Applies MANUAL_CONTROL: x (forward), y (right) and r (clockwise) range from -1000 to 1000. z (throttle) ranges
    /// from 0 to 1000 with its center at 500, or from -1000 to 1000 for a sender that has ever sent a negative value.
    /// Out-of-range and unused values count as centered.
    pub fn manual_control(&mut self, from: StickSender, m: &MANUAL_CONTROL_DATA, now: SimTime) -> Option<Sticks> {
        let zero = |value: Option<f64>| value.unwrap_or(0.0);
        let up = match axis(m.z) {
            Some(z) if self.has_signed_throttle(from, z) => z,
            Some(z) if z >= 0.0 => 2.0 * z - 1.0,
            _ => 0.0,
        };
        let sticks = Sticks { forward: zero(axis(m.x)), right: zero(axis(m.y)), up, yaw: zero(axis(m.r)) };
        self.take(from, sticks, pulses_of(&sticks), now)
    }

    /// Checks whether a sender uses a signed throttle. Reports it once when first detected.
    fn has_signed_throttle(&mut self, from: StickSender, z: f64) -> bool {
        let known = self.signed_throttle_senders.contains(&from);
        if !known && z < 0.0 && self.signed_throttle_senders.len() < MAX_SIGNED_THROTTLE_SENDERS {
            self.signed_throttle_senders.push(from);
            self.texts.push_back(format!("{} uses throttle range -1000 to 1000", sender_name(from)));
            return true;
        }
        known
    }

    /// Returns the gimbal axis of MANUAL_CONTROL (extension `s`), from -1 (down) to 1 (up), when the sender in control
    /// moves it. Extension `t` (roll in MAVLink, yaw in QGroundControl) is ignored because the gimbal has neither axis.
    pub fn gimbal(&mut self, from: StickSender, m: &MANUAL_CONTROL_DATA) -> Option<f64> {
        let pitch =
            (m.enabled_extensions & HAS_PITCH != 0 && self.controlling_sender == Some(from)).then(|| axis(m.s)).flatten()?;
        let before = self.gimbal.replace(pitch);
        // Ignore the initial position: a command may have set the gimbal's angle.
        before.is_some_and(|before| (before - pitch).abs() > MIN_GIMBAL_AXIS_CHANGE).then_some(pitch)
    }

    /// Checks whether a sender has control.
    #[must_use]
    pub fn is_controlling_sender(&self, from: StickSender) -> bool {
        self.controlling_sender == Some(from)
    }

    /// Applies RC_CHANNELS_OVERRIDE: channels 1 to 4 are roll, pitch, throttle and yaw in microseconds. 65535 and
    /// values outside the valid range leave a channel unchanged, and 0 centers it; zeros in all four release control.
    /// Pitch is reversed as on a transmitter: stick forward is below center.
    pub fn channels(&mut self, from: StickSender, c: &RC_CHANNELS_OVERRIDE_DATA, now: SimTime) -> Option<Sticks> {
        let all = [c.chan1_raw, c.chan2_raw, c.chan3_raw, c.chan4_raw];
        if all.iter().all(|us| *us == 0) {
            if self.controlling_sender == Some(from) {
                self.controlling_sender = None;
            }
            return None;
        }
        // A message without a valid pulse does not take control.
        if !all.iter().any(|us| VALID_PULSES_US.contains(us)) {
            return None;
        }
        let own = self.controlling_sender == Some(from) && self.has_controlling_sender(now);
        let (before, pulses) = if own { (self.sticks, self.pulses_us) } else { (Sticks::default(), [CENTER_PULSE_US; 4]) };
        let axis = |us: u16, before: f64| match us {
            0 => 0.0,
            us if VALID_PULSES_US.contains(&us) => ((f64::from(us) - 1500.0) / 500.0).clamp(-1.0, 1.0),
            _ => before,
        };
        let sticks = Sticks {
            right: axis(all[0], before.right),
            forward: -axis(all[1], -before.forward),
            up: axis(all[2], before.up),
            yaw: axis(all[3], before.yaw),
        };
        let pulse = |k: usize| match all[k] {
            0 => CENTER_PULSE_US,
            us if VALID_PULSES_US.contains(&us) => us,
            _ => pulses[k],
        };
        self.take(from, sticks, [pulse(0), pulse(1), pulse(2), pulse(3)], now)
    }
}

/// Returns channels 5 to 16 of an override in microseconds.
pub fn aux_channels(c: &RC_CHANNELS_OVERRIDE_DATA) -> [u16; AUX_CHANNEL_COUNT] {
    [
        c.chan5_raw,
        c.chan6_raw,
        c.chan7_raw,
        c.chan8_raw,
        c.chan9_raw,
        c.chan10_raw,
        c.chan11_raw,
        c.chan12_raw,
        c.chan13_raw,
        c.chan14_raw,
        c.chan15_raw,
        c.chan16_raw,
    ]
}

/// Converts stick positions to transmitter pulse widths in microseconds: roll, pitch, throttle and yaw, with stick
/// forward below center.
fn pulses_of(s: &Sticks) -> [u16; 4] {
    [s.right, -s.forward, s.up, s.yaw].map(|axis| (1500.0 + 500.0 * axis).round() as u16)
}

fn axis(value: i16) -> Option<f64> {
    (value != UNUSED_VALUE && (-1000..=1000).contains(&value)).then(|| f64::from(value) / 1000.0)
}

/// Returns `system/component@link`, which is short enough for a 50-byte text.
fn sender_name((link, (system, component)): StickSender) -> String {
    format!("{system}/{component}@{}", link.0)
}
