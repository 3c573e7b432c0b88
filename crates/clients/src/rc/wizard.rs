//! Interactive calibration of center, range, axis assignment and direction, and buttons. A window and a terminal use
//! the same steps.

use super::axis::{AxisCalibration, MIN_ENDPOINT_DISTANCE};
use super::profile::{ControllerProfile, DEFAULT_DEAD_BAND, DEFAULT_EXPO, STICK_AXES, StickMode, StickMotion};
use super::{ControllerAction, Device, DeviceEvent, RawInput};
use spandrel_model::time::SimTime;
use spandrel_text::{Language, text};
use std::collections::{BTreeMap, BTreeSet};

/// Duration of the rest measurement (center and noise), s (estimate).
const REST_MEASUREMENT_DURATION_S: f64 = 1.5;
/// Minimum travel of a stick axis, in raw units (full range: 2; estimate).
const MIN_STICK_TRAVEL: f64 = 0.6;
/// Minimum deflection of a pushed stick, and maximum deflection of a released one, as fractions of the travel; in
/// between, it counts as neither (estimates).
const MIN_PUSH_DEFLECTION: f64 = 0.8;
const MAX_RELEASED_DEFLECTION: f64 = 0.3;
/// Minimum duration of a push, s, to ignore brief touches (estimate).
const MIN_PUSH_DURATION_S: f64 = 0.3;
/// Minimum movement since the prompt, as a fraction of the travel, to ignore an axis that was already at an end.
const MIN_DISPLACEMENT: f64 = 0.5;
/// Maximum movement of an axis that counts as still, in raw units (full range: 2; estimate: above the noise of a worn
/// stick).
const STILL_TOLERANCE: f64 = 0.2;
/// Time that sticks must be still at the center, s. An axis that stays elsewhere for [`NON_RETURNING_TIMEOUT_S`] counts as a
/// trigger, switch, or knob that does not return (estimates).
const STILL_DURATION_S: f64 = 0.2;
const NON_RETURNING_TIMEOUT_S: f64 = 1.0;
/// Dead band as a multiple of the noise at rest. It is at least the default and at most [`MAX_DEAD_BAND`].
const NOISE_FACTOR: f64 = 2.0;
const MAX_DEAD_BAND: f64 = 0.2;
/// Maximum distance between a spring-centered rest position and the middle, as a fraction of the range. A throttle
/// without a spring may rest farther out.
const MAX_CENTER_OFFSET: f64 = 0.25;

/// A step of the calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum WizardStep {
    /// Waiting for the user to release all controls and confirm.
    Release,
    /// Measuring the axes at rest.
    Rest,
    /// Waiting for the user to move both sticks through their full range and confirm.
    Range,
    /// Waiting for the sticks to return to the center.
    Center(usize),
    /// Waiting for a push in the given direction.
    Push(usize),
    /// Waiting for the button for the given action, or for Enter to skip it.
    Button(usize),
    /// Calibration is complete.
    Done,
}

/// Actions that the wizard assigns to buttons.
const BUTTON_ACTIONS: [ControllerAction; 7] = [
    ControllerAction::Lamp,
    ControllerAction::Snapshot,
    ControllerAction::Arm,
    ControllerAction::TakeOff,
    ControllerAction::Land,
    ControllerAction::GimbalUp,
    ControllerAction::GimbalDown,
];

/// A remark about what the user did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum WizardNote {
    ButtonTaken,
    Disconnected,
    FewAxes,
    PartialRange,
    AxisTaken,
}

impl WizardNote {
    fn words(self, language: Language) -> String {
        match self {
            Self::ButtonTaken => text!(language, "keys-wizard-note-button-taken"),
            Self::Disconnected => text!(language, "keys-wizard-note-disconnected"),
            Self::FewAxes => text!(language, "keys-wizard-note-few-axes"),
            Self::PartialRange => text!(language, "keys-wizard-note-range"),
            Self::AxisTaken => text!(language, "keys-wizard-note-axis-taken"),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct AxisStatistics {
    /// Sum and count of the readings at rest, used to compute their mean.
    sum: f64,
    count: u32,
    /// Minimum and maximum at rest.
    rest_range: (f64, f64),
    /// Whether the rest position was measured with the axis untouched, not just between two pushes.
    rest_measured: bool,
    /// Minimum and maximum overall.
    overall_range: (f64, f64),
    /// Steady value, and the time at which the axis reached it.
    steady: (f64, SimTime),
}

impl AxisStatistics {
    fn at(value: f64, now: SimTime) -> Self {
        let one = (value, value);
        Self { sum: 0.0, count: 0, rest_range: one, rest_measured: false, overall_range: one, steady: (value, now) }
    }

    fn take(&mut self, value: f64, now: SimTime) {
        self.overall_range = (self.overall_range.0.min(value), self.overall_range.1.max(value));
        if (value - self.steady.0).abs() > STILL_TOLERANCE {
            self.steady = (value, now);
        }
    }

    fn measure(&mut self, value: f64) {
        let quiet = if self.count == 0 { (value, value) } else { self.rest_range };
        self.rest_range = (quiet.0.min(value), quiet.1.max(value));
        (self.sum, self.count) = (self.sum + value, self.count + 1);
    }

    fn is_still(&self, seconds: f64, now: SimTime) -> bool {
        (now - self.steady.1).s() >= seconds
    }
}

/// The calibration wizard.
#[derive(Debug, Clone)]
pub struct CalibrationWizard {
    device: Device,
    mode: StickMode,
    step: WizardStep,
    raw: RawInput,
    since: SimTime,
    statistics: BTreeMap<u32, AxisStatistics>,
    /// Axes that have been moved through their full range.
    fully_moved_axes: BTreeSet<u32>,
    /// Axis values when the push was requested.
    push_start_values: BTreeMap<u32, f64>,
    pushed: Option<(u32, bool)>,
    found: BTreeMap<StickMotion, (u32, bool)>,
    buttons: BTreeMap<u32, ControllerAction>,
    note: Option<WizardNote>,
}

impl CalibrationWizard {
    /// Creates a wizard for a device and a stick mode.
    #[must_use]
    pub fn new(device: Device, mode: StickMode) -> Self {
        Self {
            device,
            mode,
            step: WizardStep::Release,
            raw: RawInput::default(),
            since: SimTime::ZERO,
            statistics: BTreeMap::new(),
            fully_moved_axes: BTreeSet::new(),
            push_start_values: BTreeMap::new(),
            pushed: None,
            found: BTreeMap::new(),
            buttons: BTreeMap::new(),
            note: None,
        }
    }

    /// Returns the current instruction to the user.
    #[must_use]
    pub fn prompt(&self, language: Language) -> String {
        let asked = match self.step {
            WizardStep::Release => text!(language, "keys-wizard-release"),
            WizardStep::Rest => text!(language, "keys-wizard-rest"),
            WizardStep::Range => {
                let found = self.statistics.values().filter(|seen| is_fully_moved(seen)).count();
                text!(language, "keys-wizard-range", found = found, needed = STICK_AXES.len())
            }
            WizardStep::Center(_) => text!(language, "keys-wizard-center"),
            WizardStep::Push(k) => push_prompt(STICK_AXES[k].1, language),
            WizardStep::Button(k) => button_prompt(BUTTON_ACTIONS[k], language),
            WizardStep::Done => text!(language, "keys-wizard-done"),
        };
        match self.note {
            Some(note) => format!("{} {asked}", note.words(language)),
            None => asked,
        }
    }

    /// Checks whether the device is disconnected.
    #[must_use]
    pub fn lost(&self) -> bool {
        self.raw.lost
    }

    /// Returns the position of each axis for display: number, reading, minimum, and maximum.
    pub fn axes(&self) -> impl Iterator<Item = (u32, f64, (f64, f64))> + '_ {
        self.raw.axes.iter().filter_map(|(axis, value)| Some((*axis, *value, self.statistics.get(axis)?.overall_range)))
    }

    /// Processes a device event.
    pub fn handle(&mut self, event: DeviceEvent, now: SimTime) {
        self.raw.apply(event);
        if let DeviceEvent::Axis { axis, .. } = event
            && let Some(value) = self.raw.axes.get(&axis).copied()
        {
            self.statistics.entry(axis).or_insert_with(|| AxisStatistics::at(value, now)).take(value, now);
            self.push_start_values.entry(axis).or_insert(value);
        }
        if let (WizardStep::Button(k), DeviceEvent::Button { button, pressed: true }) = (self.step, event) {
            if let std::collections::btree_map::Entry::Vacant(free) = self.buttons.entry(button) {
                free.insert(BUTTON_ACTIONS[k]);
                self.next_button(k);
            } else {
                self.note = Some(WizardNote::ButtonTaken);
            }
        }
        if event == DeviceEvent::Lost {
            self.note = Some(WizardNote::Disconnected);
            self.start_step(WizardStep::Release, now);
        }
    }

    /// Handles the Enter key.
    pub fn confirm(&mut self, now: SimTime) {
        self.note = None;
        match self.step {
            WizardStep::Release => {
                // The position of an axis without a reading is unknown; it is measured when the axis returns to its
                // center.
                self.statistics = self.raw.axes.iter().map(|(axis, value)| (*axis, AxisStatistics::at(*value, now))).collect();
                self.buttons.clear();
                self.start_step(WizardStep::Rest, now);
            }
            WizardStep::Range => self.end_range(now),
            WizardStep::Button(k) => self.next_button(k),
            WizardStep::Rest | WizardStep::Center(_) | WizardStep::Push(_) | WizardStep::Done => {}
        }
    }

    fn end_range(&mut self, now: SimTime) {
        self.fully_moved_axes = self.statistics.iter().filter(|(_, seen)| is_fully_moved(seen)).map(|(axis, _)| *axis).collect();
        self.found.clear();
        if self.fully_moved_axes.len() < STICK_AXES.len() {
            self.note = Some(WizardNote::FewAxes);
        } else {
            self.start_step(WizardStep::Center(0), now);
        }
    }

    fn start_step(&mut self, step: WizardStep, now: SimTime) {
        (self.step, self.since, self.pushed) = (step, now, None);
    }

    fn next_button(&mut self, k: usize) {
        self.note = None;
        self.step = if k + 1 < BUTTON_ACTIONS.len() { WizardStep::Button(k + 1) } else { WizardStep::Done };
    }

    /// Advances time; call it every few milliseconds.
    pub fn handle_timeout(&mut self, now: SimTime) {
        match self.step {
            WizardStep::Rest => self.measure_rest(now),
            WizardStep::Center(k) if self.is_centered(now) => {
                self.measure_center();
                self.push_start_values.clone_from(&self.raw.axes);
                self.start_step(WizardStep::Push(k), now);
            }
            WizardStep::Push(k) => self.push(k, now),
            WizardStep::Release | WizardStep::Range | WizardStep::Center(_) | WizardStep::Button(_) | WizardStep::Done => {}
        }
    }

    fn measure_rest(&mut self, now: SimTime) {
        for (axis, seen) in &mut self.statistics {
            if let Some(value) = self.raw.axes.get(axis) {
                seen.measure(*value);
                seen.rest_measured = true;
            }
        }
        if (now - self.since).s() >= REST_MEASUREMENT_DURATION_S {
            self.start_step(WizardStep::Range, now);
        }
    }

    /// Returns the reading of an axis and its deflection from the center, -1 to 1 of its range.
    fn deflection(&self, axis: u32) -> Option<(f64, f64)> {
        let (value, seen) = (*self.raw.axes.get(&axis)?, self.statistics.get(&axis)?);
        let centre = rest_position(seen);
        let way = if value >= centre { seen.overall_range.1 - centre } else { centre - seen.overall_range.0 };
        Some((value, if way == 0.0 { 0.0 } else { (value - centre) / way }))
    }

    fn is_known(&self, axis: u32) -> bool {
        self.found.values().any(|(known, _)| *known == axis)
    }

    fn is_centered(&self, now: SimTime) -> bool {
        let still = |axis: u32, seconds: f64| self.statistics.get(&axis).is_none_or(|seen| seen.is_still(seconds, now));
        self.fully_moved_axes.iter().all(|axis| match self.deflection(*axis) {
            Some((_, part)) if part.abs() < MAX_RELEASED_DEFLECTION => still(*axis, STILL_DURATION_S),
            Some(_) => !self.is_known(*axis) && still(*axis, NON_RETURNING_TIMEOUT_S),
            None => true,
        })
    }

    /// Measures the center of each axis that has just returned to it. Some systems do not report an axis before it
    /// moves.
    fn measure_center(&mut self) {
        for axis in self.fully_moved_axes.clone() {
            let Some((value, part)) = self.deflection(axis) else { continue };
            if let Some(seen) =
                self.statistics.get_mut(&axis).filter(|seen| !seen.rest_measured && part.abs() < MAX_RELEASED_DEFLECTION)
            {
                seen.measure(value);
            }
        }
    }

    fn push(&mut self, k: usize, now: SimTime) {
        self.track_released_sticks(now);
        let now_pushed = self.single_pushed_axis();
        if now_pushed != self.pushed {
            (self.pushed, self.since) = (now_pushed, now);
        }
        let Some((axis, up)) = self.pushed.filter(|_| (now - self.since).s() >= MIN_PUSH_DURATION_S) else { return };
        if !self.fully_moved_axes.contains(&axis) {
            self.note = Some(WizardNote::PartialRange);
            return self.start_step(WizardStep::Range, now);
        }
        if self.is_known(axis) {
            self.note = Some(WizardNote::AxisTaken);
            return self.start_step(WizardStep::Center(k), now);
        }
        self.note = None;
        self.found.insert(STICK_AXES[k].1, (axis, up));
        if k + 1 < STICK_AXES.len() {
            self.start_step(WizardStep::Center(k + 1), now);
        } else {
            self.start_step(WizardStep::Button(0), now);
        }
    }

    /// Resets the start of the push for sticks that have been released since the prompt.
    fn track_released_sticks(&mut self, now: SimTime) {
        for axis in &self.fully_moved_axes {
            let Some((value, part)) = self.deflection(*axis) else { continue };
            if part.abs() < MAX_RELEASED_DEFLECTION
                && self.statistics.get(axis).is_some_and(|seen| seen.is_still(MIN_PUSH_DURATION_S, now))
            {
                self.push_start_values.insert(*axis, value);
            }
        }
    }

    /// Returns the distance that an axis has moved since the push was requested, in raw units (full range: 2).
    fn displacement(&self, axis: u32) -> f64 {
        let ends = self.push_start_values.get(&axis).zip(self.raw.axes.get(&axis));
        ends.map_or(0.0, |(from, value)| (value - from).abs())
    }

    /// Returns the axis that has reached an end since the push was requested, and whether it is the upper end. Returns
    /// `None` if there is more than one.
    fn single_pushed_axis(&self) -> Option<(u32, bool)> {
        let pushed = |axis: &u32| {
            let ends = self.statistics.get(axis)?.overall_range;
            let (_, part) = self.deflection(*axis)?;
            (part.abs() >= MIN_PUSH_DEFLECTION && self.displacement(*axis) >= MIN_DISPLACEMENT * (ends.1 - ends.0) / 2.0)
                .then_some((*axis, part > 0.0))
        };
        let sticks: Vec<(u32, bool)> = self.fully_moved_axes.iter().filter_map(pushed).collect();
        let mut others = self
            .statistics
            .keys()
            .filter(|axis| !self.fully_moved_axes.contains(axis) && self.displacement(**axis) >= MIN_STICK_TRAVEL);
        match sticks.as_slice() {
            [] => others.next().map(|axis| (*axis, true)),
            [one] => Some(*one),
            _ => None,
        }
    }

    /// Returns the profile once the calibration is complete.
    #[must_use]
    pub fn profile(&self) -> Option<ControllerProfile> {
        if self.step != WizardStep::Done {
            return None;
        }
        let ways = self
            .found
            .iter()
            .filter_map(|(way, (axis, up))| Some((*way, axis_calibration(*axis, *up, self.statistics.get(axis)?))))
            .collect();
        Some(ControllerProfile { device: self.device.clone(), mode: self.mode, axes: ways, buttons: self.buttons.clone() })
    }
}

fn push_prompt(motion: StickMotion, language: Language) -> String {
    match motion {
        StickMotion::LeftVertical => text!(language, "keys-wizard-push-left-vertical"),
        StickMotion::LeftHorizontal => text!(language, "keys-wizard-push-left-horizontal"),
        StickMotion::RightVertical => text!(language, "keys-wizard-push-right-vertical"),
        StickMotion::RightHorizontal => text!(language, "keys-wizard-push-right-horizontal"),
    }
}

/// Returns the request for a button. The wizard assigns only the [`BUTTON_ACTIONS`].
fn button_prompt(action: ControllerAction, language: Language) -> String {
    match action {
        ControllerAction::Lamp => text!(language, "keys-wizard-button-lamp"),
        ControllerAction::Snapshot => text!(language, "keys-wizard-button-snapshot"),
        ControllerAction::Arm => text!(language, "keys-wizard-button-arm"),
        ControllerAction::TakeOff => text!(language, "keys-wizard-button-take-off"),
        ControllerAction::Land => text!(language, "keys-wizard-button-land"),
        ControllerAction::GimbalUp => text!(language, "keys-wizard-button-gimbal-up"),
        ControllerAction::GimbalDown => text!(language, "keys-wizard-button-gimbal-down"),
        ControllerAction::Disarm
        | ControllerAction::Return
        | ControllerAction::Hold
        | ControllerAction::Position
        | ControllerAction::CameraZoomIn
        | ControllerAction::CameraZoomOut
        | ControllerAction::Freeze
        | ControllerAction::Rewind
        | ControllerAction::StickResponse => action.title(language),
    }
}

fn is_fully_moved(seen: &AxisStatistics) -> bool {
    seen.overall_range.1 - seen.overall_range.0 >= MIN_STICK_TRAVEL
}

/// Returns the stick's rest position: the measured one, or the middle of the range if the stick rests near an end, like
/// a throttle without a spring.
fn rest_position(seen: &AxisStatistics) -> f64 {
    let middle = f64::midpoint(seen.overall_range.0, seen.overall_range.1);
    let rest = if seen.count > 0 { seen.sum / f64::from(seen.count) } else { middle };
    let off = (rest - middle).abs() > MAX_CENTER_OFFSET * (seen.overall_range.1 - seen.overall_range.0) / 2.0;
    if off { middle } else { rest }
}

fn axis_calibration(axis: u32, up: bool, seen: &AxisStatistics) -> AxisCalibration {
    let centre = rest_position(seen);
    let way = (seen.overall_range.1 - centre).min(centre - seen.overall_range.0).max(MIN_ENDPOINT_DISTANCE);
    let noise = (seen.rest_range.1 - seen.rest_range.0) / 2.0 / way;
    let (low, high) = if up { seen.overall_range } else { (seen.overall_range.1, seen.overall_range.0) };
    AxisCalibration {
        axis,
        low,
        centre,
        high,
        dead_band: (NOISE_FACTOR * noise).clamp(DEFAULT_DEAD_BAND, MAX_DEAD_BAND),
        expo: DEFAULT_EXPO,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rc::input_recording;

    /// A simulated user with a transmitter: axes 0 roll, 1 pitch (reversed), 2 throttle (no spring), 3 yaw; 5 is a
    /// knob.
    struct SimulatedUser {
        wizard: CalibrationWizard,
        now: SimTime,
    }

    impl SimulatedUser {
        fn new() -> Self {
            let device = Device { name: "Transmitter".into(), id: "1:2".into() };
            let mut person = Self { wizard: CalibrationWizard::new(device, StickMode::Two), now: SimTime::ZERO };
            for axis in [0, 1, 2, 3, 5] {
                person.axis(axis, 0.01);
            }
            person.axis(2, -0.9);
            person
        }

        fn axis(&mut self, axis: u32, value: f64) {
            self.wizard.handle(DeviceEvent::Axis { axis, value }, self.now);
            self.wait(0.01);
        }

        fn wait(&mut self, seconds: f64) {
            let end = self.now + SimTime::from_s(seconds);
            while self.now < end {
                self.now += SimTime::from_s(0.005);
                self.wizard.handle_timeout(self.now);
            }
        }

        fn confirm(&mut self) {
            self.wizard.confirm(self.now);
        }

        fn jitter_axes(&mut self) {
            self.confirm();
            self.wait(2.0);
            for (axis, low, high) in [(0, -0.9, 0.95), (1, -1.0, 1.0), (2, -0.9, 0.9), (3, -0.7, 0.8)] {
                for value in [low, high, 0.01] {
                    self.axis(axis, value);
                }
            }
        }

        fn hold(&mut self, axis: u32, value: f64) {
            self.axis(axis, value);
            self.wait(0.5);
            self.axis(axis, 0.01);
            self.wait(0.4);
        }
    }

    #[test]
    fn exact_wizard_finds_axes_endpoints_and_directions() {
        let mut person = SimulatedUser::new();
        person.jitter_axes();
        person.confirm();
        person.wait(0.4);
        // Left vertical: throttle; left horizontal: yaw; right vertical: pitch (reversed); right horizontal: roll.
        for (axis, value) in [(2, 0.9), (3, 0.8), (1, -1.0), (0, 0.95)] {
            person.hold(axis, value);
        }
        person.wizard.handle(DeviceEvent::Button { button: 4, pressed: true }, person.now);
        person.wizard.handle(DeviceEvent::Button { button: 4, pressed: true }, person.now);
        assert!(
            person.wizard.prompt(Language::English).starts_with("That button is already assigned."),
            "{}",
            person.wizard.prompt(Language::English)
        );
        for _ in 1..BUTTON_ACTIONS.len() {
            assert_eq!(person.wizard.profile(), None);
            person.confirm();
        }
        let profile = person.wizard.profile().expect("the calibration must be complete");
        let axis = |way| profile.axes[&way];
        assert_eq!(axis(StickMotion::LeftVertical).axis, 2);
        assert!(
            axis(StickMotion::LeftVertical).centre.abs() < 1e-12,
            "a throttle without a spring must use the middle of its range"
        );
        assert_eq!((axis(StickMotion::RightVertical).low, axis(StickMotion::RightVertical).high), (1.0, -1.0));
        assert_eq!((axis(StickMotion::LeftHorizontal).low, axis(StickMotion::LeftHorizontal).high), (-0.7, 0.8));
        assert_eq!(axis(StickMotion::RightHorizontal).axis, 0);
        assert_eq!(profile.buttons, [(4, ControllerAction::Lamp)].into());
        let again = ControllerProfile::read("p", &profile.write()).unwrap();
        assert_eq!(again, profile);
    }

    #[test]
    fn exact_wrong_input_is_reported_and_requested_again() {
        let mut person = SimulatedUser::new();
        person.confirm();
        person.wait(2.0);
        person.confirm();
        assert!(person.wizard.prompt(Language::English).starts_with("Fewer than four axes moved."));
        let mut person = SimulatedUser::new();
        person.jitter_axes();
        person.confirm();
        person.wait(0.4);
        person.hold(2, 0.9);
        person.hold(2, 0.9);
        assert!(
            person.wizard.prompt(Language::English).contains("axis is already assigned"),
            "{}",
            person.wizard.prompt(Language::English)
        );
        person.wizard.handle(DeviceEvent::Lost, person.now);
        assert!(person.wizard.prompt(Language::English).contains("Reconnect it"));
    }

    /// Gamepad events as Linux reports them: no readings before something moves; triggers start at -1. Sticks 0, 1 and
    /// 3, 4 (up is -1), triggers 2 and 5, hat 16. Time in s, axis, value.
    const GAMEPAD_EVENTS: [(f64, u32, f64); 38] = [
        // Both triggers and the hat move before any stick; the right trigger does not return all the way.
        (2.2, 2, -0.9),
        (2.3, 2, 1.0),
        (2.4, 2, -1.0),
        (2.5, 5, 0.8),
        (2.6, 5, -0.95),
        (2.7, 16, 1.0),
        (2.8, 16, -1.0),
        (2.9, 16, 0.0),
        // The sticks move through their full range; their rest position is not the center of the range.
        (3.0, 0, -1.0),
        (3.1, 0, 1.0),
        (3.2, 0, 0.06),
        (3.3, 1, -1.0),
        (3.4, 1, 0.9),
        (3.5, 1, -0.02),
        (3.6, 3, 0.95),
        (3.7, 3, -0.95),
        (3.8, 3, 0.04),
        (3.9, 4, 1.0),
        (4.0, 4, -1.0),
        (4.1, 4, 0.0),
        // Push the left stick up, passing through left; at the same time, squeeze and release the trigger.
        (6.0, 0, -0.5),
        (6.05, 1, -1.0),
        (6.1, 0, 0.0),
        (6.2, 2, 1.0),
        (6.3, 2, -1.0),
        (7.0, 1, 0.02),
        (7.05, 0, 0.06),
        // Push the left stick right, the right stick up, and the right stick right.
        (9.0, 0, 1.0),
        (9.5, 0, 0.08),
        (11.0, 4, -0.7),
        (11.1, 4, -1.0),
        (11.6, 4, 0.0),
        (13.0, 3, 0.9),
        (13.6, 3, 0.05),
        // During the button steps, a trigger has no effect.
        (14.0, 2, 0.2),
        (14.1, 2, 1.0),
        (14.5, 2, 0.0),
        (14.6, 2, -1.0),
    ];

    /// Returns the number of axes in the prompt; `None` if the prompt contains no number.
    fn axes_found(prompt: &str) -> Option<usize> {
        prompt.split_once("Axes found: ")?.1.split(' ').next()?.parse().ok()
    }

    #[test]
    fn exact_triggers_are_not_sticks_and_late_axes_are_measured_at_their_center() {
        let device = Device { name: "Pad".into(), id: "1:2".into() };
        let lines =
            GAMEPAD_EVENTS.map(|(s, axis, value)| input_recording::line(SimTime::from_s(s), DeviceEvent::Axis { axis, value }));
        let text: Vec<String> = std::iter::once(input_recording::head(&device)).chain(lines).collect();
        let mut record = input_recording::InputRecording::read("pad.jsonl", &text.join("\n")).unwrap();
        let mut wizard = CalibrationWizard::new(device, StickMode::Two);
        let enters = [0.4, 4.3].map(SimTime::from_s).into_iter().chain((0..7).map(|k| SimTime::from_s(f64::from(k) + 20.0)));
        let mut enters = enters.peekable();
        let (mut now, mut most_axes) = (SimTime::ZERO, None);
        while wizard.profile().is_none() && now < SimTime::from_s(30.0) {
            std::iter::from_fn(|| record.due(now)).for_each(|event| wizard.handle(event, now));
            most_axes = most_axes.max(axes_found(&wizard.prompt(Language::English)));
            if enters.next_if(|at| *at <= now).is_some() {
                wizard.confirm(now);
            }
            wizard.handle_timeout(now);
            now += SimTime::from_ms(5);
        }
        let profile = wizard.profile().unwrap_or_else(|| panic!("calibration incomplete: {}", wizard.prompt(Language::English)));
        assert_eq!(most_axes, Some(7), "the prompt must count the sticks, both triggers and the hat");
        let ways =
            [StickMotion::LeftVertical, StickMotion::LeftHorizontal, StickMotion::RightVertical, StickMotion::RightHorizontal];
        assert_eq!(ways.map(|way| profile.axes[&way].axis), [1, 0, 4, 3]);
        let across = profile.axes[&StickMotion::LeftHorizontal];
        assert!((across.centre - 0.065).abs() < 0.006, "{across:?}: the center must not be the middle of the range");
        assert!(across.low < across.high && profile.axes[&StickMotion::LeftVertical].low > 0.0, "up must be the lower reading");
        assert_eq!(ControllerProfile::read("p", &profile.write()).unwrap(), profile);
    }

    #[test]
    fn exact_unmoved_stick_returns_to_the_range_step() {
        let mut person = SimulatedUser::new();
        person.jitter_axes();
        person.confirm();
        person.wait(0.4);
        person.axis(5, 1.0);
        person.wait(0.5);
        let told = person.wizard.prompt(Language::English);
        assert!(told.starts_with("You did not move that stick through its full range. Move both sticks"), "{told}");
        for value in [-1.0, 0.0] {
            person.axis(5, value);
        }
        person.confirm();
        person.wait(0.4);
        person.hold(2, 0.9);
        assert!(
            person.wizard.prompt(Language::English).contains("LEFT stick fully to the RIGHT"),
            "{}",
            person.wizard.prompt(Language::English)
        );
    }
}
