//! Calibration by asking: centre, range, which stick is which axis and which way round, buttons. The same steps serve a window and a terminal.

use super::axis::{Axis, LEAST_WAY};
use super::profile::{DEAD_BAND, EXPO, Profile, StickMode, WAYS, Way};
use super::{Action, Device, Event, Raw};
use crate::base::time::SimTime;
use std::collections::BTreeMap;

/// Sticks are left alone for this long, s, while their centre and its noise are measured (estimate).
const REST_S: f64 = 1.5;
/// An axis that moves by less than this of the raw range of 2 is none of the sticks (estimate).
const MOVED: f64 = 0.6;
/// A stick counts as pushed from this part of its way on, and as let go below [`LET_GO`]; in between nobody knows (estimates).
const PUSHED: f64 = 0.8;
const LET_GO: f64 = 0.3;
/// It must stay pushed for this long, s, so that a stick in passing is not taken (estimate).
const PUSHED_S: f64 = 0.3;
/// The dead band is this many times the noise at rest, at least the usual one, at most [`MOST_DEAD`].
const NOISES: f64 = 2.0;
const MOST_DEAD: f64 = 0.2;
/// A rest beyond this part of the range from its middle is no spring's centre: a throttle that stays where it is put.
const OFF_CENTRE: f64 = 0.25;

/// What a person is asked to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// Let go of everything, and say so.
    LetGo,
    /// Measuring at rest.
    Rest,
    /// Move both sticks along their ends, and say when done.
    Range,
    /// Back to the middle.
    Middle(usize),
    /// Push this way.
    Push(usize),
    /// A button for this action, or none.
    Button(usize),
    /// All is known.
    Done,
}

/// Buttons that are asked for.
const BUTTONS: [(Action, &str); 7] = [
    (Action::Lamp, "the lamp"),
    (Action::Snapshot, "a snapshot"),
    (Action::Arm, "arming"),
    (Action::TakeOff, "take-off"),
    (Action::Land, "landing"),
    (Action::GimbalUp, "the camera up"),
    (Action::GimbalDown, "the camera down"),
];

#[derive(Debug, Clone, Copy, PartialEq)]
struct Seen {
    /// Reading at rest: sum and count, then their mean.
    sum: f64,
    count: u32,
    /// At rest.
    quiet: (f64, f64),
    /// Over everything.
    ends: (f64, f64),
}

/// The wizard.
#[derive(Debug, Clone)]
pub struct Wizard {
    device: Device,
    mode: StickMode,
    step: Step,
    raw: Raw,
    since: SimTime,
    seen: BTreeMap<u32, Seen>,
    pushed: Option<(u32, bool)>,
    found: BTreeMap<Way, (u32, bool)>,
    buttons: BTreeMap<u32, Action>,
    note: Option<&'static str>,
}

impl Wizard {
    /// Asks for a device, for a person who flies in this stick mode.
    #[must_use]
    pub fn new(device: Device, mode: StickMode) -> Self {
        Self {
            device,
            mode,
            step: Step::LetGo,
            raw: Raw::default(),
            since: SimTime::ZERO,
            seen: BTreeMap::new(),
            pushed: None,
            found: BTreeMap::new(),
            buttons: BTreeMap::new(),
            note: None,
        }
    }

    /// What to do now, in words.
    #[must_use]
    pub fn prompt(&self) -> String {
        let asked = match self.step {
            Step::LetGo => {
                "Let go of both sticks (a throttle that stays where it is put: into its middle), then press Enter.".to_owned()
            }
            Step::Rest => "Leave the sticks alone ...".to_owned(),
            Step::Range => format!(
                "Move both sticks along their ends, all the way round, then press Enter. Axes found: {} of 4.",
                self.seen.values().filter(|seen| moved(seen)).count().min(4)
            ),
            Step::Middle(_) => "Back to the middle ...".to_owned(),
            Step::Push(k) => format!("Push {} and hold it there.", WAYS[k].2),
            Step::Button(k) => format!("Press the button for {}, or Enter for none.", BUTTONS[k].1),
            Step::Done => "Done.".to_owned(),
        };
        match self.note {
            Some(note) => format!("{note} {asked}"),
            None => asked,
        }
    }

    /// How far each axis stands, for a display: number, reading, ends.
    pub fn axes(&self) -> impl Iterator<Item = (u32, f64, (f64, f64))> + '_ {
        self.raw.axes.iter().filter_map(|(axis, value)| Some((*axis, *value, self.seen.get(axis)?.ends)))
    }

    /// The device reported something.
    pub fn handle(&mut self, event: Event, now: SimTime) {
        self.raw.take(event);
        if let Event::Axis { axis, .. } = event
            && let Some(value) = self.raw.axes.get(&axis).copied()
        {
            let fresh = Seen { sum: 0.0, count: 0, quiet: (value, value), ends: (value, value) };
            let seen = self.seen.entry(axis).or_insert(fresh);
            seen.ends = (seen.ends.0.min(value), seen.ends.1.max(value));
        }
        if let (Step::Button(k), Event::Button { button, pressed: true }) = (self.step, event) {
            if let std::collections::btree_map::Entry::Vacant(free) = self.buttons.entry(button) {
                free.insert(BUTTONS[k].0);
                self.next_button(k);
            } else {
                self.note = Some("That button is taken.");
            }
        }
        if event == Event::Lost {
            self.note = Some("The device was lost; plug it in again.");
            self.begin(Step::LetGo, now);
        }
    }

    /// The person pressed Enter.
    pub fn confirm(&mut self, now: SimTime) {
        self.note = None;
        match self.step {
            Step::LetGo => {
                for (axis, seen) in &mut self.seen {
                    let value = self.raw.axes.get(axis).copied().unwrap_or(0.0);
                    *seen = Seen { sum: 0.0, count: 0, quiet: (value, value), ends: (value, value) };
                }
                self.found.clear();
                self.buttons.clear();
                self.begin(Step::Rest, now);
            }
            Step::Range if self.seen.values().filter(|seen| moved(seen)).count() < 4 => {
                self.note = Some("Fewer than four axes have moved.");
            }
            Step::Range => self.begin(Step::Middle(0), now),
            Step::Button(k) => self.next_button(k),
            Step::Rest | Step::Middle(_) | Step::Push(_) | Step::Done => {}
        }
    }

    fn begin(&mut self, step: Step, now: SimTime) {
        (self.step, self.since, self.pushed) = (step, now, None);
    }

    fn next_button(&mut self, k: usize) {
        self.note = None;
        self.step = if k + 1 < BUTTONS.len() { Step::Button(k + 1) } else { Step::Done };
    }

    /// Time passes: call it every few milliseconds.
    pub fn handle_timeout(&mut self, now: SimTime) {
        match self.step {
            Step::Rest => self.rest(now),
            Step::Middle(k) if self.deflections().all(|(_, part)| part.abs() < LET_GO) => self.begin(Step::Push(k), now),
            Step::Push(k) => self.push(k, now),
            _ => {}
        }
    }

    fn rest(&mut self, now: SimTime) {
        for (axis, seen) in &mut self.seen {
            let value = self.raw.axes.get(axis).copied().unwrap_or(0.0);
            (seen.sum, seen.count) = (seen.sum + value, seen.count + 1);
            seen.quiet = (seen.quiet.0.min(value), seen.quiet.1.max(value));
        }
        if (now - self.since).s() >= REST_S {
            self.begin(Step::Range, now);
        }
    }

    /// Axes of the sticks and how far they are out, -1 to 1 of their ends.
    fn deflections(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        self.seen.iter().filter(|(_, seen)| moved(seen)).map(|(axis, seen)| {
            let value = self.raw.axes.get(axis).copied().unwrap_or(0.0);
            let centre = centre(seen);
            let end = if value >= centre { seen.ends.1 } else { seen.ends.0 };
            (*axis, if end == centre { 0.0 } else { (value - centre).abs() / (end - centre).abs() * (value - centre).signum() })
        })
    }

    fn push(&mut self, k: usize, now: SimTime) {
        let most = self.deflections().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let second =
            self.deflections().filter(|(axis, _)| most.is_none_or(|(first, _)| first != *axis)).map(|(_, part)| part.abs());
        let alone = second.fold(0.0, f64::max) < PUSHED;
        let now_pushed = most.filter(|(_, part)| part.abs() >= PUSHED && alone).map(|(axis, part)| (axis, part > 0.0));
        if now_pushed != self.pushed {
            (self.pushed, self.since) = (now_pushed, now);
        }
        let Some((axis, up)) = self.pushed.filter(|_| (now - self.since).s() >= PUSHED_S) else { return };
        if self.found.values().any(|(known, _)| *known == axis) {
            self.note = Some("That way is known already: push the other one.");
            return self.begin(Step::Middle(k), now);
        }
        self.note = None;
        self.found.insert(WAYS[k].1, (axis, up));
        if k + 1 < WAYS.len() {
            self.begin(Step::Middle(k + 1), now);
        } else {
            self.begin(Step::Button(0), now);
        }
    }

    /// The profile, when all has been asked.
    #[must_use]
    pub fn profile(&self) -> Option<Profile> {
        if self.step != Step::Done {
            return None;
        }
        let ways =
            self.found.iter().filter_map(|(way, (axis, up))| Some((*way, read_as(*axis, *up, self.seen.get(axis)?)))).collect();
        Some(Profile { device: self.device.clone(), mode: self.mode, ways, buttons: self.buttons.clone() })
    }
}

fn moved(seen: &Seen) -> bool {
    seen.ends.1 - seen.ends.0 >= MOVED
}

/// Where the stick rests: measured, unless it rests near an end, as a throttle without a spring may.
fn centre(seen: &Seen) -> f64 {
    let middle = f64::midpoint(seen.ends.0, seen.ends.1);
    let rest = if seen.count > 0 { seen.sum / f64::from(seen.count) } else { middle };
    let off = (rest - middle).abs() > OFF_CENTRE * (seen.ends.1 - seen.ends.0) / 2.0;
    if off { middle } else { rest }
}

fn read_as(axis: u32, up: bool, seen: &Seen) -> Axis {
    let centre = centre(seen);
    let way = (seen.ends.1 - centre).min(centre - seen.ends.0).max(LEAST_WAY);
    let noise = (seen.quiet.1 - seen.quiet.0) / 2.0 / way;
    let (low, high) = if up { seen.ends } else { (seen.ends.1, seen.ends.0) };
    Axis { axis, low, centre, high, dead_band: (NOISES * noise).clamp(DEAD_BAND, MOST_DEAD), expo: EXPO }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A person at a transmitter: axes 0 roll, 1 pitch (counts down), 2 throttle (no spring), 3 yaw; 5 is a knob.
    struct Person {
        wizard: Wizard,
        now: SimTime,
    }

    impl Person {
        fn new() -> Self {
            let device = Device { name: "Transmitter".into(), id: "1:2".into() };
            let mut person = Self { wizard: Wizard::new(device, StickMode::Two), now: SimTime::ZERO };
            for axis in [0, 1, 2, 3, 5] {
                person.axis(axis, 0.01);
            }
            person.axis(2, -0.9);
            person
        }

        fn axis(&mut self, axis: u32, value: f64) {
            self.wizard.handle(Event::Axis { axis, value }, self.now);
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

        fn stir(&mut self) {
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
            self.wait(0.1);
        }
    }

    #[test]
    fn exact_the_wizard_finds_axes_ends_and_directions() {
        let mut person = Person::new();
        person.stir();
        person.confirm();
        person.wait(0.1);
        // Left up: throttle; left right: yaw; right up: pitch, which counts down; right right: roll.
        for (axis, value) in [(2, 0.9), (3, 0.8), (1, -1.0), (0, 0.95)] {
            person.hold(axis, value);
        }
        person.wizard.handle(Event::Button { button: 4, pressed: true }, person.now);
        person.wizard.handle(Event::Button { button: 4, pressed: true }, person.now);
        assert!(person.wizard.prompt().starts_with("That button is taken."), "{}", person.wizard.prompt());
        for _ in 1..BUTTONS.len() {
            assert_eq!(person.wizard.profile(), None);
            person.confirm();
        }
        let profile = person.wizard.profile().expect("all asked");
        let axis = |way| profile.ways[&way];
        assert_eq!(axis(Way::LeftVertical).axis, 2);
        assert!(axis(Way::LeftVertical).centre.abs() < 1e-12, "a throttle without a spring rests nowhere: its middle is taken");
        assert_eq!((axis(Way::RightVertical).low, axis(Way::RightVertical).high), (1.0, -1.0));
        assert_eq!((axis(Way::LeftHorizontal).low, axis(Way::LeftHorizontal).high), (-0.7, 0.8));
        assert_eq!(axis(Way::RightHorizontal).axis, 0);
        assert_eq!(profile.buttons, [(4, Action::Lamp)].into());
        let again = Profile::read("p", &profile.write()).unwrap();
        assert_eq!(again, profile);
    }

    #[test]
    fn exact_what_is_done_wrong_is_said_and_asked_again() {
        let mut person = Person::new();
        person.confirm();
        person.wait(2.0);
        person.confirm();
        assert!(person.wizard.prompt().starts_with("Fewer than four axes have moved."));
        let mut person = Person::new();
        person.stir();
        person.confirm();
        person.wait(0.1);
        person.hold(2, 0.9);
        person.hold(2, 0.9);
        assert!(person.wizard.prompt().contains("known already"), "{}", person.wizard.prompt());
        person.wizard.handle(Event::Lost, person.now);
        assert!(person.wizard.prompt().contains("plug it in again"));
    }
}
