//! The controller in the window: tried, calibrated, flown with.

use crate::app::controller::{Hand, Profiles, Source, Watch};
use crate::app::errors::AppError;
use crate::base::time::SimTime;
use crate::rc::link::Link;
use crate::rc::wizard::Wizard;
use crate::rc::{Profile, Raw, StickMode, Sticks};
use crate::view::flow::Controls;

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
    mode: StickMode,
    note: String,
}

impl Desk {
    /// Looks for the device of this name, or the only one.
    pub fn new(wanted: Option<String>, profiles: Profiles) -> Self {
        let mut desk =
            Self { wanted, profiles, held: Held::Nothing(Watch::default()), mode: StickMode::Two, note: String::new() };
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
                let why = why.split(';').next().unwrap_or_default();
                let mut signs = why.chars();
                self.note = signs.next().map_or(String::new(), |first| format!("{}{}.", first.to_uppercase(), signs.as_str()));
            }
        }
    }

    /// Sits down with a device that has come where there was none. True when one has, whether it is calibrated or not.
    pub fn welcome(&mut self) -> bool {
        let Held::Nothing(watch) = &mut self.held else { return false };
        if !watch.has_come() {
            return false;
        }
        self.look();
        !matches!(self.held, Held::Nothing(_))
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

    /// A controller flies.
    pub fn flies(&self) -> bool {
        matches!(self.held, Held::Hand(_))
    }

    /// Why none does, or where its profile lies.
    pub fn note(&self) -> &str {
        &self.note
    }

    /// Begins to ask which axis is which stick.
    pub fn calibrate(&mut self) {
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

    /// Leaves the wizard; what was known before counts.
    pub fn cancel(&mut self) {
        if let Held::Asked(source, _) = self.take() {
            self.sit_down(source);
        }
    }

    /// Changes and keeps stick mode, dead band and expo of all sticks.
    pub fn change(&mut self, mode: i64, dead_band: f64, expo: f64) {
        self.mode = StickMode::numbered(mode).unwrap_or(self.mode);
        let Held::Hand(hand) = &mut self.held else { return };
        let mut profile = hand.profile().clone();
        profile.mode = self.mode;
        for axis in profile.ways.values_mut() {
            (axis.dead_band, axis.expo) = (dead_band, expo);
        }
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
            Held::Hand(hand) => hand.look(link, now, now).map(|look| look.sticks),
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
        let plain = Controls { mode: self.mode.number(), note: self.note.clone(), keys: keys.to_owned(), ..Controls::default() };
        let from_rest = |(axis, value): (&u32, &f64)| (*axis, *value, (value.min(0.0), value.max(0.0)));
        match &self.held {
            Held::Nothing(_) => Controls { mode: 2, sticks: StickMode::Two.hands(keyboard), ..plain },
            Held::Raw(source, raw) => {
                Controls { device: Some(source.of().name.clone()), axes: raw.axes.iter().map(from_rest).collect(), ..plain }
            }
            Held::Asked(source, wizard) => Controls {
                device: Some(source.of().name.clone()),
                axes: wizard.axes().collect(),
                wizard: Some(wizard.prompt()),
                ..plain
            },
            Held::Hand(hand) => {
                let profile = hand.profile();
                let axis = profile.ways.values().next();
                Controls {
                    device: Some(profile.device.name.clone()),
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
