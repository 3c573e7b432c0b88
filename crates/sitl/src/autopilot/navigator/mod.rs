//! The navigator: modes, missions, returns, circles, home and the heading. It converts stick inputs, requests and external
//! setpoints into setpoints for the control loops.

mod automatic;
mod circle;
mod flown_path;
pub mod follow;
mod heading;
pub mod home;
pub mod input;
mod manual;
pub mod mission;
mod mission_executor;
pub mod mission_step;
mod modes;
mod offboard;
pub mod orbit;
mod pause;
mod requests;
mod return_state;
mod returning;
pub mod trajectory;

use self::flown_path::FlownPath;
use self::follow::Follower;
use self::heading::Heading;
use self::home::Home;
use self::input::NavigatorInput;
use self::mission::Mission;
use self::mission_step::MissionStep;
use self::orbit::Orbit;
use self::return_state::ReturnState;
use self::trajectory::Trajectory;
use super::control::landed::FlightPhase;
use super::control::shaper::MotionShaper;
use super::events::EventQueue;
use super::external_input::{OffboardSetpoint, Sticks};
use super::flight_state::{FlightMode, LandedState};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// The active and the requested mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeState {
    /// The active mode.
    pub active: FlightMode,
    /// The requested mode. A failsafe can override it.
    pub intended: FlightMode,
    /// Whether a failsafe overrides the requested mode.
    pub overridden: bool,
    /// Stick input at the start of the active mode; the reference for detecting stick takeover.
    pub sticks_at_start: Sticks,
}

/// Mission progress for telemetry and mode changes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MissionStatus {
    /// Current item, zero-based.
    pub current: usize,
    /// Item reached since the last query.
    pub reached: Option<usize>,
    /// Whether the mission is complete.
    pub finished: bool,
    /// Whether the mission was interrupted and can be continued.
    pub paused: bool,
    /// Whether a command started the mission in this flight.
    pub started: bool,
}

/// Requested values that expire at the end of the flight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CommandedValues {
    /// Cruise speed, m/s.
    pub speed_m_s: Option<f64>,
    /// Takeoff height, m above the origin.
    pub takeoff_target_height_m: Option<f64>,
    /// Position at which automatic modes point the nose, m.
    pub look_at_m: Option<Vec3<Ned>>,
}

/// Position held with the sticks centered.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct StickLocks {
    /// North and east, m.
    horizontal: Option<(f64, f64)>,
    /// Height, m down.
    height_down_m: Option<f64>,
}

/// Position and start time of a pause.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PausedAt {
    /// Hold position, m.
    position_m: Vec3<Ned>,
    /// Start of the pause.
    since: SimTime,
}

/// Setpoints for telemetry.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NavigatorReport {
    /// Current target position, m.
    pub target_m: Option<Vec3<Ned>>,
    /// The active external setpoint.
    pub setpoint: Option<OffboardSetpoint>,
    /// Whether a takeoff climb is in progress, as a mode or a mission item.
    pub climbing_out: bool,
    /// The active circle.
    pub orbit: Option<Orbit>,
}

/// Navigator state.
#[derive(Debug, Clone)]
pub struct Navigator {
    /// Active and requested mode.
    pub modes: ModeState,
    /// Home and rally points.
    pub home: Home,
    /// Mission items and progress.
    pub mission: Mission,
    /// Mission progress for telemetry.
    pub mission_status: MissionStatus,
    /// Follow mode target and state.
    pub follower: Follower,
    /// Setpoints for telemetry.
    pub report: NavigatorReport,
    /// Events that the autopilot has not collected yet.
    pub events: EventQueue,
    /// A pending request to enable or disable the geofence.
    pub fence_switch: Option<bool>,
    heading: Heading,
    commanded: CommandedValues,
    /// Trajectory through the mission's waypoints, while one is active.
    trajectory: Option<Trajectory>,
    orbit: Option<Orbit>,
    /// The path recorded since takeoff.
    flown_path: FlownPath,
    returning: ReturnState,
    shaper: MotionShaper,
    locks: StickLocks,
    /// Target of hold, go-to, takeoff, landing and return, m.
    target_m: Vec3<Ned>,
    /// Speed of a go-to, m/s.
    speed_m_s: Option<f64>,
    /// The pause, if the active mode is paused.
    paused: Option<PausedAt>,
    /// Whether the vehicle is in the air and descending to land.
    descends_to_land: bool,
}

impl Default for Navigator {
    fn default() -> Self {
        Self {
            modes: ModeState {
                active: FlightMode::Position,
                intended: FlightMode::Position,
                overridden: false,
                sticks_at_start: Sticks::default(),
            },
            home: Home::default(),
            mission: Mission::default(),
            mission_status: MissionStatus::default(),
            follower: Follower::default(),
            report: NavigatorReport::default(),
            events: EventQueue::default(),
            fence_switch: None,
            heading: Heading::default(),
            commanded: CommandedValues::default(),
            trajectory: None,
            orbit: None,
            flown_path: FlownPath::default(),
            returning: ReturnState::default(),
            shaper: MotionShaper::default(),
            locks: StickLocks::default(),
            target_m: Vec3::zero(),
            speed_m_s: None,
            paused: None,
            descends_to_land: false,
        }
    }
}

impl Navigator {
    /// Returns the landed state for a flight phase.
    #[must_use]
    pub fn landed_state(&self, phase: FlightPhase) -> LandedState {
        match phase {
            FlightPhase::OnGround => LandedState::OnGround,
            FlightPhase::TakingOff => LandedState::TakingOff,
            FlightPhase::InAir if self.descends_to_land => LandedState::Landing,
            FlightPhase::InAir => LandedState::InAir,
        }
    }

    fn landed(&self, input: &NavigatorInput) -> LandedState {
        self.landed_state(input.phase)
    }

    /// Heading rate feedforward for the setpoint, rad/s.
    #[must_use]
    pub fn yaw_rate_rad_s(&self) -> f64 {
        self.heading.feedforward_rad_s()
    }

    /// Records an external setpoint, which takes control of the heading back from the pilot.
    pub fn record_external_setpoint(&mut self) {
        self.heading.end_pilot_turn();
    }

    /// Moves the position lock with a position reset to GNSS so that the vehicle stays in place. Targets on the map do
    /// not move. PX4 and ArduCopter treat position hold and waypoints the same way.
    pub fn move_position_lock(&mut self, step_m: Vec3<Ned>) {
        if let Some((north, east)) = &mut self.locks.horizontal {
            *north += step_m.north();
            *east += step_m.east();
        }
    }

    /// Sets home to the first valid position estimate.
    pub fn set_first_home(&mut self, input: &NavigatorInput) {
        if self.home.position_m.is_none() && input.estimate.position_valid {
            self.move_home(input.here());
        }
    }

    /// Replaces the mission. The first item becomes current.
    pub fn set_mission(&mut self, steps: Vec<MissionStep>, input: &NavigatorInput) {
        self.mission = Mission::new(steps);
        self.commanded.look_at_m = None;
        let started = self.mission_status.started;
        self.mission_status = MissionStatus { reached: self.mission_status.reached, started, ..MissionStatus::default() };
        if self.modes.active == FlightMode::Mission {
            self.enter(FlightMode::Hold, input);
            self.modes.intended = FlightMode::Hold;
        }
    }

    /// Jumps to a mission item. With `restart`, resets the mission's progress. Returns false if the item does not exist.
    pub fn set_mission_current(&mut self, index: usize, restart: bool) -> bool {
        let known = self.mission.jump(index);
        if known {
            if restart {
                self.mission.reset_counters();
            }
            self.mission_status.current = index;
            (self.mission_status.finished, self.mission_status.paused) = (false, false);
        }
        known
    }

    /// Starts a flight when the vehicle arms.
    pub fn begin_flight(&mut self, input: &NavigatorInput) {
        self.mission.reset();
        if self.modes.intended == FlightMode::Mission {
            self.restart_finished_mission();
        }
        self.home.arming_yaw_rad = Some(input.estimate.attitude.yaw_rad());
        (self.mission_status.paused, self.mission_status.started) = (false, false);
        if input.estimate.position_valid && !self.home.set_by_command {
            self.move_home(input.here());
        }
        // Without a pilot at the sticks, automatic modes stay active.
        if self.modes.intended.is_manual() && !input.has_recent_sticks() {
            self.modes.intended = FlightMode::Hold;
        }
        self.enter(self.modes.intended, input);
    }

    /// Ends the flight when the vehicle disarms. Requests made during the flight expire.
    pub fn end_flight(&mut self, input: &NavigatorInput) {
        self.descends_to_land = false;
        self.commanded = CommandedValues::default();
        let stays = self.modes.intended == FlightMode::Mission && input.tuning.stays_in_mission_mode;
        if !self.modes.intended.is_manual() && !stays {
            (self.modes.intended, self.modes.active) = (FlightMode::Hold, FlightMode::Hold);
        }
    }

    /// Starts the active mode and the path recording at liftoff.
    pub fn lift_off(&mut self, input: &NavigatorInput) {
        self.flown_path.begin(input.here());
        self.begin_mode(input);
    }

    /// Ends a landing or an abandoned takeoff.
    pub fn touch_down(&mut self, input: &NavigatorInput) {
        self.descends_to_land = false;
        self.shaper.start(input.estimate.velocity_m_s);
        if matches!(self.modes.active, FlightMode::Return | FlightMode::Mission) {
            self.finish_landing(input);
        }
    }

    /// Continues in the air after a respawn. Keeps a manual mode; otherwise switches to Hold.
    pub fn continue_in_air(&mut self, input: &NavigatorInput) {
        self.descends_to_land = false;
        self.flown_path.truncate_to(input.here());
        let intended = self.modes.intended;
        self.modes.intended = if intended.is_manual() { intended } else { FlightMode::Hold };
        self.enter(self.modes.intended, input);
    }

    /// Activates the requested mode while disarmed.
    pub fn follow_request(&mut self) {
        self.modes.overridden = false;
        self.modes.active = self.modes.intended;
    }

    /// Changes the requested mode, for a failsafe or a stick takeover.
    pub fn change_mode(&mut self, mode: FlightMode, ends_override: bool, input: &NavigatorInput) {
        self.modes.intended = mode;
        self.modes.overridden &= !ends_override;
        self.enter(mode, input);
    }

    /// Flies a mode other than the requested one.
    pub fn override_mode(&mut self, mode: FlightMode, input: &NavigatorInput) {
        self.modes.overridden = true;
        if self.modes.active != mode {
            self.enter(mode, input);
        }
    }

    /// Flies the requested mode again.
    pub fn end_override(&mut self, input: &NavigatorInput) {
        self.modes.overridden = false;
        self.enter(self.modes.intended, input);
    }
}
