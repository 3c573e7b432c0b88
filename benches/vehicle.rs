//! Measures how fast the complete vehicle runs on one core, as a multiple of real time: physics, site, sensors,
//! estimator, autopilot, and telemetry encoding for a ground station, an SDK, and the monitor. Each run is a complete
//! demo flight at the two bridges, including contacts. The synthetic trainee flies each one once to record its inputs.
//! The timed runs replay these inputs, so the measurement does not include the trainee. The time of one tick is also printed
//! as a ratio to a step of a minimal quadrotor in the same run, which barely depends on the machine's speed and load.

#[path = "support/baseline.rs"]
mod baseline;

use spandrel_clients::pilot::{Pilot, PilotConfig, Skill};
use spandrel_mavlink::codec::Decoder;
use spandrel_mavlink::dialect::{MavMessage, MavSysStatusSensor};
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::endpoint::flavor::px4;
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::{Sim, SimConfig, SimEvent};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

/// Minimum speed of the complete vehicle, as a multiple of real time (requirement).
const MIN_SPEED: f64 = 300.0;
const STEP: SimTime = SimTime::from_ms(20);
/// Time limit of a flight. The battery runs out earlier.
const MAX_FLIGHT_DURATION: SimTime = SimTime::from_ms(1_600_000);
const PILOT_LINK: LinkId = LinkId(1);
const ROUNDS: usize = 3;
/// Number of baseline steps per round.
const BASELINE_STEPS: i64 = 100_000;
/// Duration of a tick, s.
const TICK_S: f64 = 1e-3;

type Inputs = Vec<(SimTime, Vec<u8>)>;

struct Job {
    scenario: Arc<Scenario>,
    vehicle: Arc<Vehicle>,
    site: Arc<Site>,
    seed: u64,
}

impl Job {
    fn two_bridges(seed: u64) -> Self {
        let scenario = include_str!("../scenarios/two-bridges.toml");
        let scenario = spandrel_model::scenario::read("two-bridges.toml", scenario, &|_| Err("none".into()))
            .expect("the shipped file must be valid");
        let vehicle = spandrel_model::vehicle::read("phantom2.toml", include_str!("../vehicle-params/phantom2.toml"))
            .expect("the shipped file must be valid");
        let site = Arc::new(Site::build(&scenario, seed));
        Self { scenario: Arc::new(scenario), vehicle: Arc::new(vehicle), site, seed }
    }

    fn sim(&self, lockstep: bool) -> Sim {
        let (scenario, vehicle) = (Arc::clone(&self.scenario), Arc::clone(&self.vehicle));
        let mut sim = Sim::new(
            SimConfig { scenario, vehicle, seed: self.seed, instance: 0, flavor: &px4::FLAVOR, after_crash: None },
            Arc::clone(&self.site),
        );
        sim.open_link(PILOT_LINK, LinkKind::GroundStation, lockstep);
        sim.open_link(LinkId(2), LinkKind::Payload, false);
        sim.open_link(LinkId(3), LinkKind::Sdk, false);
        sim
    }

    /// Runs a flight with the synthetic trainee. Returns the trainee's timestamped inputs, the end time, the number of
    /// contacts, and the reason for the end.
    fn fly(&self, skill: Skill) -> (Inputs, SimTime, usize, String) {
        let (scenario, vehicle) = (Arc::clone(&self.scenario), Arc::clone(&self.vehicle));
        let mut pilot = Pilot::new(PilotConfig { scenario, vehicle, skill, seed: self.seed });
        let mut sim = self.sim(true);
        let (mut inputs, mut crashes) = (Inputs::new(), 0);
        while pilot.finished().is_none() && sim.now() < MAX_FLIGHT_DURATION {
            sim.handle_timeout(sim.now() + STEP);
            while let Some(datagram) = sim.poll_transmit() {
                if datagram.link == PILOT_LINK {
                    pilot.handle_datagram(&datagram.bytes);
                }
            }
            while let Some(bytes) = pilot.poll_transmit() {
                sim.handle_datagram(PILOT_LINK, &bytes);
                inputs.push((sim.now(), bytes));
            }
            crashes += std::iter::from_fn(|| sim.poll_event()).filter(|event| matches!(event, SimEvent::Crash { .. })).count();
        }
        let how = pilot.finished().map_or("unfinished".to_owned(), |report| report.reason.clone());
        (inputs, sim.now(), crashes, how)
    }

    /// Replays a flight without the trainee. Returns the wall time and the number of bytes sent.
    #[expect(clippy::disallowed_methods, reason = "benchmarks measure wall time")]
    fn replay(&self, inputs: &Inputs, end: SimTime) -> (Duration, usize) {
        let mut sim = self.sim(false);
        let (mut next, mut sent) = (inputs.iter().peekable(), 0);
        let start = std::time::Instant::now();
        while sim.now() < end {
            while let Some((_, bytes)) = next.next_if(|(at, _)| *at <= sim.now()) {
                sim.handle_datagram(PILOT_LINK, bytes);
            }
            sim.handle_timeout(sim.now() + STEP);
            while let Some(datagram) = sim.poll_transmit() {
                sent += datagram.bytes.len();
            }
        }
        (start.elapsed(), sent)
    }
}

/// Returns the wall time of a baseline step, s.
#[expect(clippy::disallowed_methods, reason = "benchmarks measure wall time")]
fn baseline_step_s() -> f64 {
    let start = std::time::Instant::now();
    baseline::run(BASELINE_STEPS);
    start.elapsed().as_secs_f64() / BASELINE_STEPS as f64
}

/// Returns the simulation time of the first message that satisfies `said` on the ground station link.
fn first(job: &Job, mut said: impl FnMut(&MavMessage) -> bool) -> SimTime {
    let (mut sim, mut decoder) = (job.sim(false), Decoder::new());
    while sim.now() < MAX_FLIGHT_DURATION {
        sim.handle_timeout(sim.now() + SimTime::from_ms(1));
        while let Some(datagram) = sim.poll_transmit() {
            let frames = decoder.datagram(&datagram.bytes);
            if datagram.link == PILOT_LINK && frames.iter().filter_map(|frame| frame.message.as_ref()).any(&mut said) {
                return sim.now();
            }
        }
    }
    SimTime::NEVER
}

/// Returns the current and peak resident memory, in MB (Linux only).
fn memory() -> Option<(f64, f64)> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let mb = |key: &str| {
        let line = status.lines().find(|line| line.starts_with(key))?;
        line.split_whitespace().nth(1)?.parse::<f64>().ok().map(|kb| kb / 1024.0)
    };
    Some((mb("VmRSS")?, mb("VmHWM")?))
}

fn main() -> ExitCode {
    let job = Job::two_bridges(7);
    let ready = MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK;
    println!("first heartbeat after {}", first(&job, |said| matches!(said, MavMessage::HEARTBEAT(_))));
    let armable =
        |said: &MavMessage| matches!(said, MavMessage::SYS_STATUS(s) if s.onboard_control_sensors_health.contains(ready));
    println!("ready to arm after {}", first(&job, armable));
    let mut misses = false;
    for (name, skill) in [("expert", Skill::EXPERT), ("novice", Skill::NOVICE)] {
        let (inputs, end, crashes, how) = job.fly(skill);
        let runs: Vec<(f64, (Duration, usize))> = (0..ROUNDS).map(|_| (baseline_step_s(), job.replay(&inputs, end))).collect();
        let (wall, sent) = runs.iter().map(|(_, run)| *run).min_by_key(|(wall, _)| *wall).unwrap_or_default();
        let step_s = runs.iter().map(|(step_s, _)| *step_s).fold(f64::INFINITY, f64::min);
        let times = end.s() / wall.as_secs_f64();
        misses |= times < MIN_SPEED;
        let verdict = if times >= MIN_SPEED { "reaches" } else { "MISSES" };
        println!(
            "{name}: {end} flight ({how}, {crashes} contacts) in {:.2} s: {times:.0} x real time, {:.1} x baseline per tick, {:.0} kB/s sent; {verdict} the minimum of {MIN_SPEED:.0}",
            wall.as_secs_f64(),
            TICK_S / times / step_s,
            sent as f64 / 1e3 / end.s()
        );
    }
    if let Some((now, most)) = memory() {
        println!("resident memory: {now:.0} MB, peak {most:.0} MB");
    }
    ExitCode::from(u8::from(misses))
}
