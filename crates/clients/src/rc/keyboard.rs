//! Keyboard control: holding a key deflects a stick.

use super::{ControllerAction, Sticks, key};
use spandrel_model::time::SimTime;
use spandrel_model::toml::{Problems, Reader, Section};
use spandrel_text::{Language, text};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Stick deflection when a key is held (estimate: half, to keep beginners from flying at full speed).
pub const DEFAULT_DEFLECTION: f64 = 0.5;
/// Time for which a key counts as held after its last event, s. Used in terminals, which do not report key releases.
/// Longer than the usual delay before a held key repeats, 0.5 s (defaults of X.Org and Windows: 0.25 to 0.66 s).
pub const KEY_HOLD_TIMEOUT_S: f64 = 0.7;
/// Minimum interval between gimbal or zoom steps from repeated taps, s (estimate: up to 8 taps per second). Longer than
/// the usual repeat interval of a held key, 0.03 s.
const MIN_TAP_INTERVAL_S: f64 = 0.12;

/// Direction of a stick deflection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum StickDirection {
    /// Fly forward.
    Forward,
    /// Fly backward.
    Back,
    /// Fly left.
    Left,
    /// Fly right.
    Right,
    /// Climb.
    Up,
    /// Descend.
    Down,
    /// Turn left.
    TurnLeft,
    /// Turn right.
    TurnRight,
}

impl StickDirection {
    /// Returns what the direction does, for display.
    fn title(self, language: Language) -> String {
        match self {
            Self::Forward => text!(language, "keys-forward"),
            Self::Back => text!(language, "keys-back"),
            Self::Left => text!(language, "keys-left"),
            Self::Right => text!(language, "keys-right"),
            Self::Up => text!(language, "keys-up"),
            Self::Down => text!(language, "keys-down"),
            Self::TurnLeft => text!(language, "keys-turn-left"),
            Self::TurnRight => text!(language, "keys-turn-right"),
        }
    }

    /// Returns the same in fewer words.
    fn short_title(self, language: Language) -> String {
        match self {
            Self::Forward => text!(language, "terms-direction-forward"),
            Self::Back => text!(language, "terms-direction-back"),
            Self::Left => text!(language, "terms-direction-left"),
            Self::Right => text!(language, "terms-direction-right"),
            Self::Up => text!(language, "terms-direction-up"),
            Self::Down => text!(language, "terms-direction-down"),
            Self::TurnLeft => text!(language, "keys-short-turn-left"),
            Self::TurnRight => text!(language, "keys-short-turn-right"),
        }
    }
}

const STICK_BINDINGS: [(&str, StickDirection, &str); 8] = [
    ("forward", StickDirection::Forward, "up"),
    ("back", StickDirection::Back, "down"),
    ("left", StickDirection::Left, "left"),
    ("right", StickDirection::Right, "right"),
    ("up", StickDirection::Up, "w"),
    ("down", StickDirection::Down, "s"),
    ("turn_left", StickDirection::TurnLeft, "a"),
    ("turn_right", StickDirection::TurnRight, "d"),
];

const ACTION_BINDINGS: [(ControllerAction, &str); 16] = [
    (ControllerAction::Lamp, "b"),
    (ControllerAction::Snapshot, "p"),
    (ControllerAction::Arm, "1"),
    (ControllerAction::Disarm, "0"),
    (ControllerAction::TakeOff, "t"),
    (ControllerAction::Land, "l"),
    (ControllerAction::Return, "r"),
    (ControllerAction::Hold, "h"),
    (ControllerAction::Position, "o"),
    (ControllerAction::GimbalUp, "pageup"),
    (ControllerAction::GimbalDown, "pagedown"),
    (ControllerAction::CameraZoomIn, "]"),
    (ControllerAction::CameraZoomOut, "["),
    (ControllerAction::Freeze, "x"),
    (ControllerAction::Rewind, "z"),
    (ControllerAction::StickResponse, "j"),
];

/// Key action in the viewer window; not available in a terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum WindowAction {
    /// Cycles the layout: camera large with the instruments, inspector large, both views side by side.
    Swap,
    /// Toggles the map.
    Map,
    /// Shows the map large, or the layout before it.
    LargeMap,
    /// Toggles the path in the pictures.
    Path,
    /// Toggles the ghost of an earlier flight.
    Ghost,
    /// Sends the inspector to the next place.
    Walk,
    /// Makes the inspector view follow the aircraft again.
    Follow,
    /// Turns the inspector view left.
    LookLeft,
    /// Turns the inspector view right.
    LookRight,
    /// Tilts the inspector view up.
    LookUp,
    /// Tilts the inspector view down.
    LookDown,
    /// Zooms the inspector view in.
    ZoomIn,
    /// Zooms the inspector view out.
    ZoomOut,
    /// Pauses or resumes a practice session.
    Pause,
    /// Restarts a practice session after confirmation.
    Restart,
    /// Turns sound on or off.
    Sound,
}

impl WindowAction {
    /// Returns what the action does, for display.
    fn title(self, language: Language) -> String {
        match self {
            Self::Swap => text!(language, "keys-swap"),
            Self::Map => text!(language, "keys-map"),
            Self::LargeMap => text!(language, "keys-large-map"),
            Self::Path => text!(language, "keys-path"),
            Self::Ghost => text!(language, "keys-ghost"),
            Self::Walk => text!(language, "keys-walk"),
            Self::Follow => text!(language, "keys-follow"),
            Self::LookLeft => text!(language, "keys-look-left"),
            Self::LookRight => text!(language, "keys-look-right"),
            Self::LookUp => text!(language, "keys-look-up"),
            Self::LookDown => text!(language, "keys-look-down"),
            Self::ZoomIn => text!(language, "keys-zoom-in"),
            Self::ZoomOut => text!(language, "keys-zoom-out"),
            Self::Pause => text!(language, "keys-pause"),
            Self::Restart => text!(language, "keys-restart"),
            Self::Sound => text!(language, "keys-sound"),
        }
    }
}

const WINDOW_BINDINGS: [(&str, WindowAction, &str); 16] = [
    ("swap", WindowAction::Swap, "tab"),
    ("map", WindowAction::Map, "m"),
    ("large_map", WindowAction::LargeMap, "c"),
    ("path", WindowAction::Path, "v"),
    ("ghost", WindowAction::Ghost, "g"),
    ("walk", WindowAction::Walk, "e"),
    ("follow", WindowAction::Follow, "f"),
    ("look_left", WindowAction::LookLeft, ","),
    ("look_right", WindowAction::LookRight, "."),
    ("look_up", WindowAction::LookUp, "i"),
    ("look_down", WindowAction::LookDown, "k"),
    ("zoom_in", WindowAction::ZoomIn, "+"),
    ("zoom_out", WindowAction::ZoomOut, "-"),
    ("pause", WindowAction::Pause, "escape"),
    ("restart", WindowAction::Restart, "backspace"),
    ("sound", WindowAction::Sound, "n"),
];

/// Sound settings of the viewer window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoundPreferences {
    /// Whether there is sound at all.
    pub on: bool,
    /// Whether propeller sound is on.
    pub propellers: bool,
    /// Whether warning tones are on.
    pub warnings: bool,
    /// Whether spoken warnings are on.
    pub speech: bool,
    /// Volume, 0 to 1.
    pub volume: f64,
}

impl Default for SoundPreferences {
    fn default() -> Self {
        Self { on: true, propellers: true, warnings: true, speech: false, volume: 0.7 }
    }
}

/// Outcome of a change to a key binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rebinding {
    /// The binding has the key, which was free or its own.
    Done,
    /// The key belonged to this binding, given by its name in configuration files. The two have exchanged their keys.
    Exchanged(&'static str),
    /// Nothing has changed: there is no such binding or key.
    Refused,
}

/// Key bindings, by the key names of [`key`].
#[derive(Debug, Clone, PartialEq)]
pub struct KeyBindings {
    push: f64,
    stick_keys: BTreeMap<String, StickDirection>,
    actions: BTreeMap<String, ControllerAction>,
    window_actions: BTreeMap<String, WindowAction>,
    /// Sound settings of the viewer window.
    pub sounds: SoundPreferences,
}

impl Default for KeyBindings {
    fn default() -> Self {
        Self {
            push: DEFAULT_DEFLECTION,
            stick_keys: STICK_BINDINGS.iter().map(|(_, push, key)| ((*key).to_owned(), *push)).collect(),
            actions: ACTION_BINDINGS.iter().map(|(action, key)| ((*key).to_owned(), *action)).collect(),
            window_actions: WINDOW_BINDINGS.iter().map(|(_, wish, key)| ((*key).to_owned(), *wish)).collect(),
            sounds: SoundPreferences::default(),
        }
    }
}

impl KeyBindings {
    /// Reads a key file; omitted bindings keep their defaults. `file` is the name used in error messages.
    ///
    /// # Errors
    /// Reports all errors in the file, each with its line, key, value, and allowed range.
    pub fn read(file: &str, text: &str) -> Result<Self, Problems> {
        let mut r = Reader::new(file, text);
        let keys = r.parse().map(|document| {
            let mut root = r.root(&document);
            r.integer(&mut root, "format", (1, 1), None);
            let keys = Self::read_tables(&mut r, &mut root);
            r.finish(&root);
            keys
        });
        match keys {
            Some(keys) if r.problems.is_empty() => Ok(keys),
            _ => Err(Problems(r.problems)),
        }
    }

    /// Reads the key `push` and the tables of a key file, which may be part of another file. The reader collects the problems.
    pub fn read_tables(r: &mut Reader, root: &mut Section) -> Self {
        let mut keys = Self {
            push: r.number(root, "push", (0.05, 1.0), Some(DEFAULT_DEFLECTION)),
            stick_keys: BTreeMap::new(),
            actions: BTreeMap::new(),
            window_actions: BTreeMap::new(),
            sounds: SoundPreferences::default(),
        };
        let mut taken = BTreeMap::new();
        let mut s = r.section(root, "sticks");
        for (name, push, usual) in STICK_BINDINGS {
            keys.stick_keys.extend(read_binding(r, &mut s, (name, usual), &mut taken).map(|key| (key, push)));
        }
        r.finish(&s);
        let (mut later_actions, mut later_window_actions) = (Vec::new(), Vec::new());
        let mut s = r.section(root, "actions");
        for (action, usual) in ACTION_BINDINGS {
            match read_binding(r, &mut s, (action.name(), usual), &mut taken) {
                Some(key) => drop(keys.actions.insert(key, action)),
                None => later_actions.push((action, usual)),
            }
        }
        r.finish(&s);
        let mut s = r.section(root, "window");
        for (name, wish, usual) in WINDOW_BINDINGS {
            match read_binding(r, &mut s, (name, usual), &mut taken) {
                Some(key) => drop(keys.window_actions.insert(key, wish)),
                None => later_window_actions.push((name, wish, usual)),
            }
        }
        r.finish(&s);
        for (action, usual) in later_actions {
            keys.actions.insert(free_key(usual, action.name(), &mut taken), action);
        }
        for (name, wish, usual) in later_window_actions {
            keys.window_actions.insert(free_key(usual, name, &mut taken), wish);
        }
        keys.sounds = sounds(r, root);
        keys
    }

    /// Returns the key `push` and the tables as TOML, as [`Self::read_tables`] reads them.
    #[must_use]
    pub fn write_tables(&self) -> String {
        let mut text = format!("push = {:?}\n", self.push);
        let sticks = STICK_BINDINGS.map(|(name, ..)| name);
        let actions = ACTION_BINDINGS.map(|(action, _)| action.name());
        let wishes = WINDOW_BINDINGS.map(|(name, ..)| name);
        for (table, names) in [("sticks", sticks.as_slice()), ("actions", &actions), ("window", &wishes)] {
            let _ = writeln!(text, "\n[{table}]");
            for name in names {
                let _ = writeln!(text, "{name} = {}", serde_json::Value::from(self.of(name).unwrap_or_default()));
            }
        }
        let SoundPreferences { on, propellers, warnings, speech, volume } = self.sounds;
        let _ = writeln!(
            text,
            "\n[sound]\non = {on}\npropellers = {propellers}\nwarnings = {warnings}\nspeech = {speech}\nvolume = {volume:?}"
        );
        text
    }

    /// Binds a key. If it belongs to another binding, the two exchange their keys, so that each binding always has one key.
    pub fn rebind(&mut self, name: &str, key: &str) -> Rebinding {
        let key = key.to_lowercase();
        let Some(own) = self.of(name).map(str::to_owned).filter(|_| key::is_valid_key(&key)) else { return Rebinding::Refused };
        if own == key {
            return Rebinding::Done;
        }
        let before = every_name().find(|other| self.of(other) == Some(key.as_str()));
        exchange(&mut self.stick_keys, &own, &key);
        exchange(&mut self.actions, &own, &key);
        exchange(&mut self.window_actions, &own, &key);
        before.map_or(Rebinding::Done, Rebinding::Exchanged)
    }

    /// Restores the default key of every binding; the other settings stay.
    pub fn restore_keys(&mut self) {
        *self = Self { push: self.push, sounds: self.sounds, ..Self::default() };
    }

    /// Returns every binding in the order of display: its name in configuration files, and what it does.
    pub fn functions(language: Language) -> impl Iterator<Item = (&'static str, String)> {
        let sticks = STICK_BINDINGS.into_iter().map(move |(name, push, _)| (name, push.title(language)));
        let actions = ACTION_BINDINGS.into_iter().map(move |(action, _)| (action.name(), action.title(language)));
        let wishes = WINDOW_BINDINGS.into_iter().map(move |(name, wish, _)| (name, wish.title(language)));
        sticks.chain(actions).chain(wishes)
    }

    /// Returns the window action of a key, if any.
    #[must_use]
    pub fn window_action(&self, key: &str) -> Option<WindowAction> {
        self.window_actions.get(&key.to_lowercase()).copied()
    }

    /// Checks whether a key controls a stick.
    #[must_use]
    pub fn is_stick(&self, key: &str) -> bool {
        self.stick_keys.contains_key(&key.to_lowercase())
    }

    /// Returns the stick direction or vehicle action of a key, by its name in configuration files.
    #[must_use]
    pub fn binding_name(&self, key: &str) -> Option<&'static str> {
        let push = self.stick_keys.get(key).and_then(|push| STICK_BINDINGS.iter().find(|p| p.1 == *push)).map(|p| p.0);
        push.or_else(|| self.actions.get(key).map(|action| action.name()))
    }

    /// Returns the display name of the key for a stick direction, vehicle action, or window action, given by its name
    /// in configuration files; empty if the name is unknown.
    #[must_use]
    pub fn label(&self, name: &str, language: Language) -> String {
        self.of(name).map_or(String::new(), |key| key::label(key, language))
    }

    /// Returns the display name of every bound key, by the binding's name in configuration files.
    #[must_use]
    pub fn labels(&self, language: Language) -> BTreeMap<&'static str, String> {
        every_name().map(|name| (name, self.label(name, language))).collect()
    }

    /// Returns the key for a stick direction, vehicle action, or window action, given by its name in configuration
    /// files.
    #[must_use]
    pub fn of(&self, name: &str) -> Option<&str> {
        let push = STICK_BINDINGS.iter().find(|p| p.0 == name).map(|p| p.1);
        let wish = WINDOW_BINDINGS.iter().find(|w| w.0 == name).map(|w| w.1);
        let pushes = self.stick_keys.iter().filter(|(_, p)| Some(**p) == push).map(|(key, _)| key);
        let wishes = self.window_actions.iter().filter(|(_, w)| Some(**w) == wish).map(|(key, _)| key);
        let actions = self.actions.iter().filter(|(_, a)| a.name() == name).map(|(key, _)| key);
        pushes.chain(wishes).chain(actions).next().map(String::as_str)
    }

    /// Returns the display name of the key of each stick direction and vehicle action, with what it does in a few words.
    #[must_use]
    pub fn help(&self, language: Language) -> Vec<(String, String)> {
        let pushes = self.stick_keys.iter().map(|(key, push)| (key::label(key, language), push.short_title(language)));
        let actions = self.actions.iter().map(|(key, action)| (key::label(key, language), action.short_title(language)));
        pushes.chain(actions).collect()
    }

    /// Returns the bindings of sticks and vehicle actions as text for a terminal, one per line.
    #[must_use]
    pub fn help_text(&self) -> String {
        let pushes = self
            .stick_keys
            .iter()
            .map(|(key, push)| format!("{key:10} {}", STICK_BINDINGS.iter().find(|p| p.1 == *push).map_or("", |p| p.0)));
        let actions = self.actions.iter().map(|(key, action)| format!("{key:10} {}", action.name()));
        pushes.chain(actions).collect::<Vec<_>>().join("\n")
    }
}

/// Returns the name of every binding in configuration files.
fn every_name() -> impl Iterator<Item = &'static str> {
    let sticks = STICK_BINDINGS.into_iter().map(|(name, ..)| name);
    let actions = ACTION_BINDINGS.into_iter().map(|(action, _)| action.name());
    let wishes = WINDOW_BINDINGS.into_iter().map(|(name, ..)| name);
    sticks.chain(actions).chain(wishes)
}

/// Exchanges what two keys do.
fn exchange<T>(bindings: &mut BTreeMap<String, T>, one: &str, other: &str) {
    let (first, second) = (bindings.remove(one), bindings.remove(other));
    bindings.extend(first.map(|action| (other.to_owned(), action)));
    bindings.extend(second.map(|action| (one.to_owned(), action)));
}

fn sounds(r: &mut Reader, root: &mut Section) -> SoundPreferences {
    let usual = SoundPreferences::default();
    let mut s = r.section(root, "sound");
    let sounds = SoundPreferences {
        on: r.boolean(&mut s, "on", usual.on),
        propellers: r.boolean(&mut s, "propellers", usual.propellers),
        warnings: r.boolean(&mut s, "warnings", usual.warnings),
        speech: r.boolean(&mut s, "speech", usual.speech),
        volume: r.number(&mut s, "volume", (0.0, 1.0), Some(usual.volume)),
    };
    r.finish(&s);
    sounds
}

/// Functions that key files of earlier versions do not contain. Where such a file uses their default for something else, they give
/// way.
const LATER_FUNCTIONS: [&str; 6] = ["freeze", "rewind", "large_map", "ghost", "walk", "stick_response"];

/// Returns the usual key, or the first free character if it is taken, and marks it as taken.
fn free_key(usual: &str, name: &'static str, taken: &mut BTreeMap<String, &'static str>) -> String {
    let characters = ('a'..='z').chain('0'..='9').chain("-=;',./".chars()).map(String::from);
    let mut candidates = std::iter::once(usual.to_owned()).chain(characters);
    // There are more characters than functions.
    let key = candidates.find(|key| !taken.contains_key(key)).unwrap_or_default();
    taken.insert(key.clone(), name);
    key
}

/// Reads a binding's key, which must be valid and not bound to anything else. Returns `None` if the file does not bind one of the
/// [`LATER_FUNCTIONS`].
fn read_binding(
    r: &mut Reader,
    s: &mut Section,
    (name, usual): (&'static str, &str),
    bound_keys: &mut BTreeMap<String, &'static str>,
) -> Option<String> {
    if LATER_FUNCTIONS.contains(&name) && !s.has(name) {
        return None;
    }
    let key = r.text(s, name, Some(usual)).to_lowercase();
    if !key::is_valid_key(&key) {
        r.add_problem(s, name, &key, &key::allowed(Language::English), "unknown key");
    } else if let Some(before) = bound_keys.insert(key.clone(), name) {
        r.add_problem(s, name, &key, "an unused key", &format!("already bound to {before}"));
    }
    Some(key)
}

/// Keys that are currently held.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct KeyboardState {
    keys: KeyBindings,
    held: BTreeMap<StickDirection, Option<SimTime>>,
    last_repeats: BTreeMap<ControllerAction, SimTime>,
}

impl KeyboardState {
    /// Creates the state with no keys held.
    #[must_use]
    pub fn new(keys: KeyBindings) -> Self {
        Self { keys, held: BTreeMap::new(), last_repeats: BTreeMap::new() }
    }

    /// Returns the key bindings.
    #[must_use]
    pub fn keys(&self) -> &KeyBindings {
        &self.keys
    }

    /// Handles a key press and returns its action unless the key controls a stick. If the system reports key releases
    /// (`until_released`), do not pass on the repeats of a held key. Otherwise, a stick key counts as held for
    /// [`KEY_HOLD_TIMEOUT_S`], and repeats are ignored: an action key must have been idle for that time, or for
    /// `MIN_TAP_INTERVAL_S` if it is a gimbal or zoom step.
    pub fn press(&mut self, key: &str, until_released: bool, now: SimTime) -> Option<ControllerAction> {
        let key = key.to_lowercase();
        if let Some(push) = self.keys.stick_keys.get(&key) {
            self.held.insert(*push, (!until_released).then(|| now + SimTime::from_s(KEY_HOLD_TIMEOUT_S)));
        }
        let action = self.keys.actions.get(&key).copied()?;
        let rest_s = if action.is_repeatable() { MIN_TAP_INTERVAL_S } else { KEY_HOLD_TIMEOUT_S };
        let before = self.last_repeats.insert(action, now);
        let repeated = before.is_some_and(|before| (now - before).s() < rest_s);
        (until_released || !repeated).then_some(action)
    }

    /// Handles a key release.
    pub fn release(&mut self, key: &str) {
        if let Some(push) = self.keys.stick_keys.get(&key.to_lowercase()) {
            self.held.remove(push);
        }
    }

    /// Releases all keys, for example when the window loses focus.
    pub fn release_all(&mut self) {
        self.held.clear();
    }

    /// Returns the stick positions; opposite keys cancel out.
    pub fn sticks(&mut self, now: SimTime) -> Sticks {
        self.held.retain(|_, until| until.is_none_or(|until| now < until));
        let one = |push: StickDirection| if self.held.contains_key(&push) { self.keys.push } else { 0.0 };
        Sticks {
            forward: one(StickDirection::Forward) - one(StickDirection::Back),
            right: one(StickDirection::Right) - one(StickDirection::Left),
            up: one(StickDirection::Up) - one(StickDirection::Down),
            yaw: one(StickDirection::TurnRight) - one(StickDirection::TurnLeft),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(s: f64) -> SimTime {
        SimTime::from_s(s)
    }

    #[test]
    fn regress_key_files_of_earlier_versions_stay_valid() {
        let keys = KeyBindings::read("keys.toml", "format = 1\n[actions]\nlamp = \"x\"\n[window]\nmap = \"g\"\n").unwrap();
        assert_eq!((keys.label("lamp", Language::English).as_str(), keys.label("map", Language::English).as_str()), ("X", "G"));
        let functions: std::collections::BTreeSet<String> =
            KeyBindings::functions(Language::English).map(|(name, _)| keys.label(name, Language::English)).collect();
        assert_eq!(functions.len(), KeyBindings::functions(Language::English).count(), "every function has a key of its own");
        let both = "format = 1\n[actions]\nlamp = \"x\"\nfreeze = \"x\"\n";
        assert!(KeyBindings::read("keys.toml", both).is_err(), "a conflict in the file is an error");
    }

    #[test]
    fn exact_held_keys_deflect_and_opposite_keys_cancel() {
        let mut board = KeyboardState::default();
        assert_eq!(board.press("w", true, at(0.0)), None);
        board.press("Up", true, at(0.0));
        board.press("d", true, at(0.0));
        assert_eq!(
            board.sticks(at(100.0)),
            Sticks { forward: DEFAULT_DEFLECTION, right: 0.0, up: DEFAULT_DEFLECTION, yaw: DEFAULT_DEFLECTION }
        );
        board.press("a", true, at(100.0));
        board.release("up");
        assert_eq!(board.sticks(at(100.0)), Sticks { up: DEFAULT_DEFLECTION, ..Sticks::default() });
        board.release_all();
        assert_eq!(board.sticks(at(100.0)), Sticks::default());
        assert_eq!(
            (board.press("B", true, at(0.0)), board.press("p", true, at(0.0))),
            (Some(ControllerAction::Lamp), Some(ControllerAction::Snapshot))
        );
    }

    #[test]
    fn exact_keys_time_out_without_release_events() {
        let mut board = KeyboardState::default();
        board.press("w", false, at(0.0));
        board.press("w", false, at(0.5));
        assert_eq!(board.sticks(at(0.5 + KEY_HOLD_TIMEOUT_S - 0.01)).up, DEFAULT_DEFLECTION);
        assert_eq!(board.sticks(at(0.5 + KEY_HOLD_TIMEOUT_S)).up, 0.0);
    }

    #[test]
    fn exact_key_repeats_are_ignored_except_for_tapped_steps() {
        let mut board = KeyboardState::default();
        // One second of events: 0.5 s until the first repeat, then 30 repeats per second.
        let held: Vec<f64> = std::iter::once(0.0).chain((0..15).map(|k| 0.5 + f64::from(k) / 30.0)).collect();
        let done = |board: &mut KeyboardState, key: &str, times: &[f64]| {
            times.iter().filter_map(|s| board.press(key, false, at(*s))).collect::<Vec<_>>()
        };
        assert_eq!(done(&mut board, "p", &held), [ControllerAction::Snapshot]);
        assert_eq!(done(&mut board, "b", &held), [ControllerAction::Lamp], "a held key must not repeat its action");
        assert_eq!(
            done(&mut board, "p", &[1.0, 1.0 + KEY_HOLD_TIMEOUT_S]),
            [ControllerAction::Snapshot],
            "a new press must repeat the action"
        );
        assert_eq!(done(&mut board, "pagedown", &[0.0, 0.2, 0.4]), [ControllerAction::GimbalDown; 3]);
        assert_eq!(done(&mut board, "]", &[0.0, 0.03, 0.06]), [ControllerAction::CameraZoomIn]);
        let told = [2.0, 2.1].map(|s| board.press("p", true, at(s)));
        assert_eq!(told, [Some(ControllerAction::Snapshot); 2], "if releases are reported, every press must count");
    }

    #[test]
    fn exact_key_file_binds_each_key_once() {
        let keys = KeyBindings::read("keys.toml", "format = 1\npush = 1.0\n[sticks]\nup = \"space\"\n").unwrap();
        let mut board = KeyboardState::new(keys);
        board.press("space", true, at(0.0));
        assert_eq!(board.sticks(at(0.0)).up, 1.0);
        assert_eq!((board.keys().of("up"), board.keys().of("lamp")), (Some("space"), Some("b")));
        let quiet = KeyBindings::read("keys.toml", "format = 1\n[sound]\nspeech = true\nvolume = 0.2\n").unwrap();
        assert_eq!(quiet.sounds, SoundPreferences { speech: true, volume: 0.2, ..SoundPreferences::default() });
        let told = KeyBindings::read("keys.toml", "format = 1\n[sound]\nvolume = 7\nbells = true\n").unwrap_err().to_string();
        assert!(told.contains("keys.toml:3") && told.contains("0 to 1") && told.contains("bells"), "{told}");
        assert_eq!((board.keys().window_action("Tab"), board.keys().window_action("w")), (Some(WindowAction::Swap), None));
        assert_eq!(board.keys().window_action("E"), Some(WindowAction::Walk));
        assert_eq!(board.keys().window_action("C"), Some(WindowAction::LargeMap));
        let taken = KeyBindings::read("keys.toml", "format = 1\n[window]\nmap = \"e\"\n").unwrap();
        assert_eq!((taken.window_action("e"), taken.of("walk")), (Some(WindowAction::Map), Some("m")), "it gives way");
        let told =
            KeyBindings::read("keys.toml", "format = 1\n[sticks]\nup = \"b\"\n[actions]\nfly = \"f\"\n").unwrap_err().to_string();
        assert!(told.contains("already bound to up") && told.contains("fly"), "{told}");
    }

    #[test]
    fn exact_unknown_key_is_reported_with_its_line() {
        let text = "format = 1\n[actions]\nlamp = \"F5\"\n[window]\nmap = \"shift\"\n";
        let told = KeyBindings::read("keys.toml", text).unwrap_err().to_string();
        assert!(told.contains("keys.toml:3: actions.lamp = f5: unknown key (allowed: one character, or up, "), "{told}");
        assert!(told.contains("keys.toml:5: window.map = shift: unknown key"), "{told}");
    }

    #[test]
    fn exact_every_binding_has_a_readable_key_label() {
        let (usual, every) = (KeyBindings::default(), STICK_BINDINGS.len() + ACTION_BINDINGS.len() + WINDOW_BINDINGS.len());
        let labels = usual.labels(Language::English);
        let keys: std::collections::BTreeSet<&str> = labels.keys().filter_map(|name| usual.of(name)).collect();
        assert_eq!((labels.len(), keys.len()), (every, every), "each binding must have its own key");
        assert!(keys.into_iter().all(key::is_valid_key));
        let label = |name: &str| usual.label(name, Language::English);
        assert_eq!([label("pause"), label("forward"), label("lamp"), label("camera_zoom_in")], ["Esc", "Up", "B", "]"]);
        assert_eq!(label("fly"), "");
        assert!(usual.is_stick("W") && usual.is_stick("up") && !usual.is_stick("b") && !usual.is_stick("tab"));
    }

    #[test]
    fn exact_a_bound_key_is_exchanged_and_an_unknown_one_refused() {
        let mut keys = KeyBindings::default();
        assert_eq!(keys.rebind("lamp", "y"), Rebinding::Done);
        assert_eq!((keys.of("lamp"), keys.binding_name("y"), keys.binding_name("b")), (Some("y"), Some("lamp"), None));
        assert_eq!(keys.rebind("lamp", "Y"), Rebinding::Done, "its own key");
        assert_eq!(keys.rebind("lamp", "w"), Rebinding::Exchanged("up"));
        assert_eq!((keys.of("lamp"), keys.of("up")), (Some("w"), Some("y")));
        assert_eq!(keys.rebind("pause", "w"), Rebinding::Exchanged("lamp"), "a window key and a vehicle action");
        assert_eq!((keys.of("lamp"), keys.window_action("w")), (Some("escape"), Some(WindowAction::Pause)));
        let before = keys.clone();
        for (name, key) in [("lamp", "f5"), ("lamp", ""), ("fly", "y")] {
            assert_eq!(keys.rebind(name, key), Rebinding::Refused, "{name}, {key}");
        }
        assert_eq!(keys, before, "a refused key changes nothing");
        keys.sounds.volume = 0.25;
        keys.restore_keys();
        let usual = KeyBindings { sounds: keys.sounds, ..KeyBindings::default() };
        assert_eq!((keys.sounds.volume, keys), (0.25, usual));
    }

    #[test]
    fn prop_bindings_survive_writing_and_reading_after_any_change() {
        let names: Vec<&str> = every_name().collect();
        let keys = ["w", "\"", "\\", "ü", "'", "space", "escape", "7", "#", "["];
        let mut bound = KeyBindings::default();
        for step in 0..200 {
            bound.rebind(names[step * 7 % names.len()], keys[step * 3 % keys.len()]);
            bound.sounds = SoundPreferences { on: step % 2 == 0, volume: (step % 11) as f64 / 10.0, ..bound.sounds };
            let text = format!("format = 1\n{}", bound.write_tables());
            assert_eq!(KeyBindings::read("keys.toml", &text).as_ref(), Ok(&bound), "step {step}:\n{text}");
            let used: std::collections::BTreeSet<&str> = names.iter().filter_map(|name| bound.of(name)).collect();
            assert_eq!(used.len(), names.len(), "step {step}: each binding must have its own key");
        }
    }

    #[test]
    fn exact_every_function_has_a_title_of_its_own() {
        for language in Language::ALL.into_iter().chain([Language::Pseudo]) {
            let titles: std::collections::BTreeSet<String> = KeyBindings::functions(language).map(|(_, title)| title).collect();
            assert_eq!(titles.len(), every_name().count(), "{language:?}");
            assert!(titles.iter().all(|title| !title.is_empty() && !title.contains('_')), "{titles:?}");
        }
    }

    #[test]
    fn exact_functions_and_keys_are_translated() {
        let keys = KeyBindings::default();
        let help = keys.help(Language::German);
        assert!(
            help.contains(&("Bild auf".into(), "Gimbal hoch".into())) && help.contains(&("W".into(), "hoch".into())),
            "{help:?}"
        );
        assert!(keys.help(Language::English).contains(&("Page up".into(), "gimbal up".into())));
        assert_eq!(keys.label("restart", Language::Spanish), "Retroceso");
        let english: Vec<String> = KeyBindings::functions(Language::English).map(|(_, title)| title).collect();
        for (title, pseudo) in english.iter().zip(KeyBindings::functions(Language::Pseudo)) {
            assert!(title.len() < pseudo.1.len() && *title != pseudo.1, "{title}: {}", pseudo.1);
        }
    }
}
