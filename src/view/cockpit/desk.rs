//! The controller in the window: tried, calibrated, flown with.

use crate::controller::{Hand, Profiles, Source, Watch};
use crate::errors::AppError;
use spandrel_clients::rc::link::Link;
use spandrel_clients::rc::wizard::Wizard;
use spandrel_clients::rc::{Profile, Raw, StickMode, Sticks};
use spandrel_model::time::SimTime;
use spandrel_view::flow::{Controls, Tune};

/// What is known of the device.
enum Held {
    /// There is none; who waits for one.
    Nothing(Watch),
    /// It has no profile yet.
    Raw(Source, Raw),
    /// It flies.
    Hand(Box<Hand>),
    /// It is being calibrated.
    Asked(Source, Box<Wizard>),
}

/// The controller, or none.
pub struct Desk {
    wanted: Option<String>,
    profiles: Profiles,
    held: Held,
    /// Waits for another device while the one in hand is away.
    away: Option<Watch>,
    mode: StickMode,
    note: String,
}

impl Desk {
    /// Looks for the device of this name, or the only one.
    pub fn new(wanted: Option<String>, profiles: Profiles) -> Self {
        let mut desk = Self {
            wanted,
            profiles,
            held: Held::Nothing(Watch::default()),
            away: None,
            mode: StickMode::Two,
            note: String::new(),
        };
        desk.look();
        desk
    }

    /// Looks for the device again.
    pub fn look(&mut self) {
        match Source::device(self.wanted.as_deref()) {
            Ok(source) => self.sit_down(source),
            Err(error) => {
                self.held = Held::Nothing(Watch::start());
                // What follows is the command line's business.
                let why = error.to_string();
                let why = why.rsplit_once(';').map_or(why.as_str(), |(why, _)| why);
                let mut signs = why.chars();
                self.note = signs.next().map_or(String::new(), |first| format!("{}{}.", first.to_uppercase(), signs.as_str()));
            }
        }
    }

    /// Sits down with a device that has come where there was none. True when one has, whether it is calibrated or not.
    pub fn welcome(&mut self) -> bool {
        let Held::Nothing(watch) = &mut self.held else { return self.take_over() };
        if !watch.has_come() {
            return false;
        }
        self.look();
        !matches!(self.held, Held::Nothing(_))
    }

    /// Sits down with a device that has come while the one in hand is away: that one is waited for unless the other can do as much.
    fn take_over(&mut self) -> bool {
        if !self.lost() || matches!(self.held, Held::Asked(..)) {
            self.away = None;
            return false;
        }
        if !self.away.get_or_insert_with(Watch::start).has_come() {
            return false;
        }
        let Ok(source) = Source::device(self.wanted.as_deref()) else { return false };
        if self.flies() && !matches!(self.profiles.find(source.of()), Ok(Some(_))) {
            return false;
        }
        self.sit_down(source);
        true
    }

    fn sit_down(&mut self, source: Source) {
        let device = source.of().clone();
        (self.held, self.note) = match self.profiles.find(&device) {
            Ok(Some(profile)) => {
                self.mode = profile.mode;
                let place = self.profiles.path(&device);
                let note = place.map_or(String::new(), |path| format!("Its profile is {}.", path.display()));
                (Held::Hand(Box::new(Hand::with(source, profile))), note)
            }
            Ok(None) => (Held::Raw(source, Raw::default()), format!("'{}' is not calibrated yet.", device.name)),
            Err(error) => (Held::Raw(source, Raw::default()), error.to_string()),
        };
    }

    /// A controller flies, or would if it were not lost.
    pub fn flies(&self) -> bool {
        matches!(self.held, Held::Hand(_))
    }

    /// The device was there and is away.
    pub fn lost(&self) -> bool {
        match &self.held {
            Held::Nothing(_) => false,
            Held::Raw(_, raw) => raw.lost,
            Held::Hand(hand) => hand.raw().lost,
            Held::Asked(_, wizard) => wizard.lost(),
        }
    }

    /// What the device is called.
    pub fn name(&self) -> Option<&str> {
        match &self.held {
            Held::Nothing(_) => None,
            Held::Raw(source, _) | Held::Asked(source, _) => Some(&source.of().name),
            Held::Hand(hand) => Some(&hand.profile().device.name),
        }
    }

    /// Why only keys fly; `None` while a controller does.
    pub fn why_keys(&self) -> Option<String> {
        match self.name() {
            Some(name) if self.lost() => Some(format!("'{name}' is not connected.")),
            _ => (!self.flies()).then(|| self.note.clone()),
        }
    }

    /// Why none does, or where its profile lies.
    pub fn note(&self) -> &str {
        &self.note
    }

    /// Begins to ask which axis is which stick. A device that is away is looked for first.
    pub fn calibrate(&mut self) {
        if self.lost() {
            self.look();
        }
        self.held = match self.take() {
            Held::Nothing(watch) => Held::Nothing(watch),
            Held::Raw(source, _) | Held::Asked(source, _) => self.ask(source),
            Held::Hand(hand) => self.ask(hand.let_go()),
        };
    }

    fn take(&mut self) -> Held {
        std::mem::replace(&mut self.held, Held::Nothing(Watch::default()))
    }

    fn ask(&self, source: Source) -> Held {
        let wizard = Wizard::new(source.of().clone(), self.mode);
        Held::Asked(source, Box::new(wizard))
    }

    /// The wizard's Enter.
    pub fn confirm(&mut self, now: SimTime) {
        if let Held::Asked(_, wizard) = &mut self.held {
            wizard.confirm(now);
        }
    }

    /// Leaves the wizard; what was known before counts. A device that went away in it is looked for: it must not come back as one that is
    /// there and holds still.
    pub fn cancel(&mut self) {
        let lost = self.lost();
        match self.take() {
            Held::Asked(..) if lost => self.look(),
            Held::Asked(source, _) => self.sit_down(source),
            held => self.held = held,
        }
    }

    /// Changes this of the profile, and keeps it.
    pub fn tune(&mut self, tune: Tune) {
        if let Tune::Mode(number) = tune {
            self.mode = StickMode::numbered(number).unwrap_or(self.mode);
        }
        let Held::Hand(hand) = &mut self.held else { return };
        let profile = tuned(hand.profile(), tune);
        hand.set(profile.clone());
        self.keep(&profile);
    }

    fn keep(&mut self, profile: &Profile) {
        self.note = match self.profiles.keep(profile) {
            Ok(path) => format!("Kept in {}.", path.display()),
            Err(error) => format!("Not kept: {error}."),
        };
    }

    /// The device's sticks by now, when it flies; its buttons act on the link.
    ///
    /// # Errors
    /// When it is given up.
    pub fn sticks(&mut self, link: &mut Link, now: SimTime) -> Result<Option<Sticks>, AppError> {
        match &mut self.held {
            Held::Nothing(_) => Ok(None),
            Held::Raw(source, raw) => {
                std::iter::from_fn(|| source.next(now)).for_each(|event| raw.take(event));
                Ok(None)
            }
            Held::Hand(hand) => Ok(hand.look(link, now, now).sticks),
            Held::Asked(source, wizard) => {
                std::iter::from_fn(|| source.next(now)).for_each(|event| wizard.handle(event, now));
                wizard.handle_timeout(now);
                if let Some(profile) = wizard.profile() {
                    self.keep(&profile);
                    if let Held::Asked(source, _) = self.take() {
                        self.held = Held::Hand(Box::new(Hand::with(source, profile)));
                    }
                }
                Ok(None)
            }
        }
    }

    /// Gives the device up.
    pub fn give_up(&mut self, why: &AppError) {
        self.held = Held::Nothing(Watch::start());
        self.note = format!("The controller is given up: {why}.");
    }

    /// How it stands, for the page; `keyboard`: the keys' sticks.
    pub fn controls(&self, keyboard: Sticks, keys: &str) -> Controls {
        let plain = Controls {
            device: self.name().map(str::to_owned),
            lost: self.lost(),
            mode: self.mode.number(),
            note: self.note.clone(),
            keys: keys.to_owned(),
            ..Controls::default()
        };
        let from_rest = |(axis, value): (&u32, &f64)| (*axis, *value, (value.min(0.0), value.max(0.0)));
        match &self.held {
            Held::Asked(_, wizard) => Controls { axes: wizard.axes().collect(), wizard: Some(wizard.prompt()), ..plain },
            _ if plain.device.is_none() || plain.lost => {
                Controls { mode: 2, sticks: StickMode::Two.hands(keyboard), calibrated: self.flies(), ..plain }
            }
            Held::Nothing(_) => plain,
            Held::Raw(_, raw) => Controls { axes: raw.axes.iter().map(from_rest).collect(), ..plain },
            Held::Hand(hand) => {
                let profile = hand.profile();
                let axis = profile.ways.values().next();
                Controls {
                    calibrated: true,
                    dead_band: axis.map_or(0.0, |axis| axis.dead_band),
                    expo: axis.map_or(0.0, |axis| axis.expo),
                    sticks: profile.mode.hands(profile.sticks(hand.raw())),
                    ..plain
                }
            }
        }
    }
}

/// A profile with this changed: an axis keeps what the wizard measured of it, or a person wrote, until that itself is asked for.
fn tuned(profile: &Profile, tune: Tune) -> Profile {
    let mut profile = profile.clone();
    match tune {
        Tune::Mode(number) => profile.mode = StickMode::numbered(number).unwrap_or(profile.mode),
        Tune::DeadBand(part) => profile.ways.values_mut().for_each(|axis| axis.dead_band = part),
        Tune::Expo(expo) => profile.ways.values_mut().for_each(|axis| axis.expo = expo),
    }
    profile
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_clients::rc::axis::Axis;
    use spandrel_clients::rc::profile::WAYS;
    use spandrel_clients::rc::{Device, Event, record};

    /// A desk with a calibrated device that reports this.
    fn held(events: &[(f64, Event)]) -> Desk {
        let axis = |n: u32| Axis { axis: n, low: -1.0, centre: 0.0, high: 1.0, dead_band: 0.0, expo: 0.0 };
        let ways = WAYS.iter().zip(0..).map(|((_, way, _), n)| (*way, axis(n))).collect();
        let device = Device { name: "Pad".into(), id: "1:2".into() };
        let lines = events.iter().map(|(s, event)| record::line(SimTime::from_s(*s), *event));
        let text: Vec<String> = std::iter::once(record::head(&device)).chain(lines).collect();
        let source = Source::Record(record::Record::read("pad.jsonl", &text.join("\n")).unwrap());
        let profile = Profile { device, mode: StickMode::Two, ways, buttons: [].into() };
        Desk {
            // None of this machine's devices is meant.
            wanted: Some("no device is called so".into()),
            profiles: Profiles::at(None),
            held: Held::Hand(Box::new(Hand::with(source, profile))),
            away: None,
            mode: StickMode::Two,
            note: String::new(),
        }
    }

    fn stand(desk: &mut Desk, s: f64) -> Option<Sticks> {
        desk.welcome();
        desk.sticks(&mut Link::default(), SimTime::from_s(s)).unwrap()
    }

    #[test]
    fn exact_a_lost_device_holds_no_sticks_is_said_to_be_away_and_flies_when_it_is_back() {
        let pushed = Event::Axis { axis: 0, value: 1.0 };
        let mut desk = held(&[(0.0, pushed), (1.0, Event::Lost), (2.0, Event::Found)]);
        assert!(stand(&mut desk, 0.5).is_some() && desk.why_keys().is_none());
        assert_eq!(stand(&mut desk, 1.5), None);
        let keys = Sticks { up: 1.0, ..Sticks::default() };
        let shown = desk.controls(keys, "");
        assert!(shown.lost && !shown.is_there() && shown.sticks == StickMode::Two.hands(keys), "{shown:?}");
        assert_eq!(desk.why_keys().as_deref(), Some("'Pad' is not connected."));
        assert_eq!(stand(&mut desk, 2.5), Some(Sticks::default()));
        assert!(!desk.controls(keys, "").lost);
    }

    #[test]
    fn regress_a_device_that_is_lost_in_the_wizard_does_not_come_back_from_it_holding_still() {
        for lost_s in [1.0, 3.0] {
            let mut desk = held(&[(lost_s, Event::Lost)]);
            stand(&mut desk, 2.0);
            desk.calibrate();
            stand(&mut desk, 4.0);
            desk.cancel();
            assert_eq!(stand(&mut desk, 5.0), None, "lost at {lost_s} s");
            assert!(!desk.flies() && !desk.note().is_empty(), "why is said");
        }
        let mut desk = held(&[]);
        desk.cancel();
        assert!(desk.flies(), "leaving a wizard that has ended takes nothing away");
    }

    #[test]
    fn exact_what_is_not_asked_for_stays_as_every_axis_has_it() {
        let axis = |n: u32| {
            let own = f64::from(n) / 10.0;
            Axis { axis: n, low: -1.0, centre: 0.0, high: 1.0, dead_band: own, expo: 2.0 * own }
        };
        let ways = WAYS.iter().zip(0..).map(|((_, way, _), n)| (*way, axis(n))).collect();
        let device = Device { name: "Pad".into(), id: "1:2".into() };
        let before = Profile { device, mode: StickMode::Two, ways, buttons: [].into() };
        let of = |profile: &Profile| profile.ways.values().map(|axis| (axis.dead_band, axis.expo)).collect::<Vec<_>>();
        let own = of(&before);
        assert_eq!(tuned(&before, Tune::Mode(4)), Profile { mode: StickMode::Four, ..before.clone() });
        let still = tuned(&before, Tune::DeadBand(0.07));
        assert_eq!(of(&still), own.iter().map(|(_, expo)| (0.07, *expo)).collect::<Vec<_>>());
        let straight = tuned(&before, Tune::Expo(0.0));
        assert_eq!(of(&straight), own.iter().map(|(dead_band, _)| (*dead_band, 0.0)).collect::<Vec<_>>());
    }
}
