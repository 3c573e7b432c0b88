//! Maps wall time to simulation time: real time, N times real time, or as fast as possible. The wall clock is an
//! argument.

use spandrel_model::time::SimTime;
use std::str::FromStr;
use std::time::Duration;

/// Maximum simulation time between two socket polls, which is the lockstep interval (docs/src/reference/wire.md, "One
/// simulation step").
pub const LOCKSTEP_STEP: SimTime = SimTime::from_ms(20);
/// Wall time without a response from a lockstep peer after which the run ends. On a computer that is busy with other programs, a peer
/// that is well can take more than ten seconds for a response.
pub const LOCKSTEP_PEER_TIMEOUT: Duration = Duration::from_secs(30);
/// Wall time for which the simulation waits for the first message of a peer.
const FIRST_MESSAGE_TIMEOUT: Duration = Duration::from_secs(10);
/// Wall time without a response after which a lockstep request is sent again. Datagrams are lost if a peer's buffer is full, for
/// example because an external autopilot starts and simulation time does not wait for the peer meanwhile. Shorter intervals would
/// send repeated requests to peers that think for a while.
const LOCKSTEP_REPEAT_INTERVAL: Duration = Duration::from_secs(4);
/// Wall-clock delay beyond which the simulation does not catch up: the clock slips, and the program reports the slip.
const SLIP_THRESHOLD: Duration = Duration::from_millis(250);

/// The same for a flight controller. After a longer delay, its readings would arrive at once, as if no time passed between them,
/// and its estimate of the attitude would be wrong (a flight with PX4 crashed after a delay of 0.2 s without this limit).
const REAL_TIME_SLIP_THRESHOLD: Duration = Duration::from_millis(20);

/// Simulation speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SimulationSpeed {
    /// Multiple of real time.
    Factor(f64),
    /// As fast as possible.
    Max,
}

/// Maximum speed, as a multiple of real time.
const MAX_SPEED: f64 = 100.0;

impl SimulationSpeed {
    /// Returns the simulation seconds per wall-clock second for a client that is not in lockstep, at least 1. At `max`,
    /// the speed is unknown, so the highest multiple is returned.
    pub fn client_speed_factor(self) -> f64 {
        match self {
            Self::Factor(times) => times.max(1.0),
            Self::Max => MAX_SPEED,
        }
    }
}

impl FromStr for SimulationSpeed {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        if text == "max" {
            return Ok(Self::Max);
        }
        let allowed = || format!("'{text}' is not a speed (allowed: 0.1 to 100, or max)");
        let times: f64 = text.parse().map_err(|_| allowed())?;
        if (0.1..=MAX_SPEED).contains(&times) { Ok(Self::Factor(times)) } else { Err(allowed()) }
    }
}

impl std::fmt::Display for SimulationSpeed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Factor(times) => write!(f, "{times}"),
            Self::Max => f.write_str("max"),
        }
    }
}

/// The simulation's delay relative to its clock, in wall time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Lateness {
    /// Longest delay, including sleep time, because several ticks run after each wake-up.
    pub longest_delay: Duration,
    /// Number of times that the clock slipped because a delay exceeded the limit.
    pub slip_count: u32,
    /// Total wall time that the clock has slipped.
    pub slipped_time: Duration,
}

/// Computes the target simulation time for a given wall time.
#[derive(Debug, Clone)]
pub struct WallPacer {
    speed: SimulationSpeed,
    wall: Duration,
    sim: SimTime,
    late: Lateness,
    slip_threshold: Duration,
}

impl WallPacer {
    /// Creates a pacer whose simulation time is zero at wall time `wall`.
    pub fn new(speed: SimulationSpeed, wall: Duration) -> Self {
        Self { speed, wall, sim: SimTime::ZERO, late: Lateness::default(), slip_threshold: SLIP_THRESHOLD }
    }

    /// Uses the threshold for a peer that cannot catch up because its clock runs in real time.
    pub fn limit_bursts(&mut self) {
        self.slip_threshold = REAL_TIME_SLIP_THRESHOLD;
    }

    /// Returns the simulation time to run to, at most [`LOCKSTEP_STEP`] past `reached`.
    pub fn target(&mut self, wall: Duration, reached: SimTime) -> SimTime {
        let SimulationSpeed::Factor(times) = self.speed else { return reached + LOCKSTEP_STEP };
        let due = self.due(wall, times);
        let behind = Duration::from_secs_f64(due.saturating_sub(reached).s() / times);
        self.late.longest_delay = self.late.longest_delay.max(behind);
        if behind > self.slip_threshold {
            self.late.slip_count += 1;
            self.late.slipped_time += behind;
            self.wall = wall;
            self.sim = reached;
            return reached + LOCKSTEP_STEP;
        }
        due.min(reached + LOCKSTEP_STEP)
    }

    /// Changes the speed from now on.
    pub fn set_speed(&mut self, speed: SimulationSpeed, wall: Duration, reached: SimTime) {
        if self.speed != speed {
            self.speed = speed;
            self.resync(wall, reached);
        }
    }

    /// Moves the reference point to now, so that a pause does not count as a delay.
    pub fn resync(&mut self, wall: Duration, reached: SimTime) {
        (self.wall, self.sim) = (wall, reached);
    }

    /// Returns the wall time to sleep until simulation time `next`.
    pub fn sleep(&self, wall: Duration, next: SimTime) -> Duration {
        let SimulationSpeed::Factor(times) = self.speed else { return Duration::ZERO };
        let due_s = (next.saturating_sub(self.sim)).s() / times;
        (self.wall + Duration::from_secs_f64(due_s)).saturating_sub(wall)
    }

    /// Returns the simulation's delay so far.
    pub fn lateness(&self) -> Lateness {
        self.late
    }

    fn due(&self, wall: Duration, times: f64) -> SimTime {
        self.sim + SimTime::from_s(wall.saturating_sub(self.wall).as_secs_f64() * times)
    }
}

/// Time without a TIMESYNC response after which a peer that sends data is served in real time. MAVSDK responds after one of
/// its own time requests was answered, and sends these only every 5 s. Shorter than [`FIRST_MESSAGE_TIMEOUT`].
const FIRST_RESPONSE_TIMEOUT: Duration = Duration::from_secs(7);

/// Pauses the simulation until a peer's first response. No simulation time passes until then, so a peer that responds
/// quickly is in lockstep from the first tick.
#[derive(Debug, Clone, Default)]
pub struct FirstResponseWait {
    since: Option<Duration>,
    first_received: Option<Duration>,
    last_announced: Option<Duration>,
}

/// Action while waiting for the peer's first response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstResponseAction {
    /// Keep waiting for the peer.
    Wait,
    /// Announce the vehicle again.
    Announce,
    /// Continue without the peer.
    Proceed,
}

impl FirstResponseWait {
    /// Returns the action at wall time `wall`; `data_received` is true once data has arrived from the peer, and `every`
    /// is the announcement interval.
    pub fn next_action(&mut self, data_received: bool, wall: Duration, every: Duration) -> FirstResponseAction {
        let since = *self.since.get_or_insert(wall);
        let over = |since: Duration, most: Duration| wall.saturating_sub(since) > most;
        if data_received {
            self.first_received.get_or_insert(wall);
        }
        if over(since, FIRST_MESSAGE_TIMEOUT)
            || self.first_received.is_some_and(|data_received| over(data_received, FIRST_RESPONSE_TIMEOUT))
        {
            *self = Self::default();
            return FirstResponseAction::Proceed;
        }
        if over(self.last_announced.unwrap_or(since), every) {
            self.last_announced = Some(wall);
            return FirstResponseAction::Announce;
        }
        FirstResponseAction::Wait
    }
}

/// Limits how long the simulation waits for lockstep peers. Only time without progress counts, because every step
/// involves waiting at `max` speed.
#[derive(Debug, Clone, Default)]
pub struct LockstepTimeout {
    stalled_since: Option<(SimTime, Duration)>,
    repeated: u32,
}

impl LockstepTimeout {
    /// Returns true if simulation time, now `reached`, has not advanced for more than [`LOCKSTEP_PEER_TIMEOUT`] at wall
    /// time `wall`.
    pub fn is_over(&mut self, reached: SimTime, wall: Duration) -> bool {
        match self.stalled_since {
            Some((at, since)) if at == reached => wall.saturating_sub(since) > LOCKSTEP_PEER_TIMEOUT,
            _ => {
                self.stalled_since = Some((reached, wall));
                self.repeated = 0;
                false
            }
        }
    }

    /// Returns true if the lockstep requests must be sent again at wall time `wall`. Call after [`Self::is_over`].
    pub fn take_repeat(&mut self, wall: Duration) -> bool {
        let due = self
            .stalled_since
            .is_some_and(|(_, since)| wall.saturating_sub(since) > LOCKSTEP_REPEAT_INTERVAL * (self.repeated + 1));
        self.repeated += u32::from(due);
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_speed_four_runs_four_seconds_per_second() {
        let mut pace = WallPacer::new(SimulationSpeed::Factor(4.0), Duration::from_secs(10));
        let mut reached = SimTime::ZERO;
        for ms in 1..=1000 {
            reached = pace.target(Duration::from_secs(10) + Duration::from_millis(ms), reached);
        }
        assert_eq!(reached, SimTime::from_s(4.0));
        assert_eq!(pace.sleep(Duration::from_secs(11), SimTime::from_s(4.4)), Duration::from_millis(100));
    }

    #[test]
    fn exact_clock_slips_after_a_host_stall() {
        let mut pace = WallPacer::new(SimulationSpeed::Factor(1.0), Duration::ZERO);
        assert_eq!(pace.target(Duration::from_secs(5), SimTime::ZERO), LOCKSTEP_STEP);
        let five = Duration::from_secs(5);
        assert_eq!(pace.lateness(), Lateness { longest_delay: five, slip_count: 1, slipped_time: five });
        assert_eq!(pace.target(Duration::from_millis(5010), LOCKSTEP_STEP), SimTime::from_ms(10));
    }

    #[test]
    fn regress_flight_controller_gets_no_burst_after_a_stall() {
        let mut pace = WallPacer::new(SimulationSpeed::Factor(1.0), Duration::ZERO);
        pace.limit_bursts();
        assert_eq!(pace.target(Duration::from_millis(20), SimTime::ZERO), SimTime::from_ms(20));
        // A stall of 200 ms leads to one step of 20 ms instead of ten.
        assert_eq!(pace.target(Duration::from_millis(220), SimTime::from_ms(20)), SimTime::from_ms(40));
        assert_eq!(pace.lateness().slip_count, 1);
        assert_eq!(pace.target(Duration::from_millis(221), SimTime::from_ms(40)), SimTime::from_ms(21));
    }

    #[test]
    fn exact_paused_time_does_not_count_as_delay() {
        let mut pace = WallPacer::new(SimulationSpeed::Factor(2.0), Duration::ZERO);
        assert_eq!(pace.target(Duration::from_millis(5), SimTime::ZERO), SimTime::from_ms(10));
        pace.resync(Duration::from_secs(60), SimTime::from_ms(10));
        assert_eq!(pace.target(Duration::from_millis(60_005), SimTime::from_ms(10)), SimTime::from_ms(20));
        assert_eq!(pace.lateness(), Lateness { longest_delay: Duration::from_millis(5), ..Lateness::default() });
    }

    #[test]
    fn exact_longest_delay_is_wall_time_and_short_delays_do_not_slip() {
        let mut pace = WallPacer::new(SimulationSpeed::Factor(4.0), Duration::ZERO);
        for ms in [2, 102] {
            pace.target(Duration::from_millis(ms), SimTime::from_ms(8));
        }
        assert_eq!(pace.lateness(), Lateness { longest_delay: Duration::from_millis(100), ..Lateness::default() });
    }

    #[test]
    fn exact_max_speed_runs_single_steps_without_sleep() {
        let mut pace = WallPacer::new(SimulationSpeed::Max, Duration::ZERO);
        assert_eq!(pace.target(Duration::ZERO, SimTime::from_ms(40)), SimTime::from_ms(60));
        assert_eq!(pace.sleep(Duration::ZERO, SimTime::from_s(9.0)), Duration::ZERO);
    }

    #[test]
    fn exact_speeds_parse_and_print() {
        assert_eq!("max".parse(), Ok(SimulationSpeed::Max));
        assert_eq!("5".parse(), Ok(SimulationSpeed::Factor(5.0)));
        assert_eq!(SimulationSpeed::Factor(0.5).to_string(), "0.5");
        for bad in ["0", "-1", "fast", "1000", "NaN"] {
            assert!(bad.parse::<SimulationSpeed>().is_err(), "{bad}");
        }
    }

    #[test]
    fn regress_only_blocked_time_counts_toward_the_timeout() {
        let mut patience = LockstepTimeout::default();
        for (reached, wall) in (0..100).map(|step| SimTime::from_ms(20 * step)).zip((0..100).map(Duration::from_secs)) {
            assert!(!patience.is_over(reached, wall), "a long run in lockstep is not a timeout");
        }
        let (stuck, since) = (SimTime::from_ms(20 * 99), Duration::from_secs(99));
        assert!(!patience.is_over(stuck, since + LOCKSTEP_PEER_TIMEOUT));
        assert!(patience.is_over(stuck, since + LOCKSTEP_PEER_TIMEOUT + Duration::from_millis(1)));
    }

    #[test]
    fn regress_unanswered_lockstep_requests_are_repeated() {
        let mut patience = LockstepTimeout::default();
        let mut repeats = |reached_ms, from_s: u64, to_s: u64| {
            let walls = (1000 * from_s..1000 * to_s).step_by(100).map(Duration::from_millis);
            walls.filter(|wall| !patience.is_over(SimTime::from_ms(reached_ms), *wall) && patience.take_repeat(*wall)).count()
        };
        assert_eq!(repeats(20, 100, 104), 0, "a peer may think for a while");
        assert_eq!(repeats(20, 104, 110), 2);
        assert_eq!(repeats(40, 110, 114), 0, "an answer ends the wait");
        assert_eq!(repeats(40, 114, 116), 1);
    }
}
