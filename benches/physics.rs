//! Measures the cost of a physics step in free flight, near a bridge, standing on a bridge, and scraping along it.
//! Prints the medians in nanoseconds and as ratios to a baseline from the same run: a minimal Runge-Kutta quadrotor
//! with rotor lag and drag that uses plain arrays. The ratios barely depend on the machine's speed and load. The
//! benchmark fails if a ratio exceeds its limit.

#[path = "support/baseline.rs"]
mod baseline;
#[path = "support/deck.rs"]
mod deck;

use deck::deck;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{BatteryModel, Scenario};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, MAX_ROTORS, PhysicsState, PowerLoad};
use std::hint::black_box;
use std::path::Path;
use std::process::ExitCode;

const STEP: SimTime = SimTime::from_ms(1);
/// Number of steps per sample. Every sample starts from the same state, so all samples do the same work.
const STEPS_PER_SAMPLE: i64 = 500;
/// Number of samples per median. The cases alternate, so a period of high machine load affects them all.
const SAMPLE_COUNT: usize = 61;

/// Highest allowed medians, as ratios to the baseline.
const MAX_HOVER_60_M_RATIO: f64 = 4.0;
const MAX_HOVER_2_M_RATIO: f64 = 8.0;
const MAX_HOVER_HALF_M_RATIO: f64 = 20.0;
const MAX_STANDING_RATIO: f64 = 200.0;
const MAX_SCRAPING_RATIO: f64 = 200.0;

struct Case {
    name: &'static str,
    /// Maximum median, as a ratio to the baseline.
    limit: f64,
    start: PhysicsState,
    /// Simulation time at the start.
    start_time: SimTime,
    actuators: Actuators,
    /// Whether the aircraft is in contact with the deck in almost every step.
    in_contact: bool,
    samples: Vec<f64>,
}

impl Case {
    fn new(name: &'static str, limit: f64, start: PhysicsState, actuators: Actuators) -> Self {
        Self { name, limit, start, start_time: SimTime::ZERO, actuators, in_contact: false, samples: Vec::new() }
    }

    /// Creates a case on the deck that starts at [`SETTLED_TIME`].
    fn on_deck(name: &'static str, limit: f64, start: PhysicsState) -> Self {
        Self { start_time: SETTLED_TIME, in_contact: true, ..Self::new(name, limit, start, Actuators::default()) }
    }

    fn fly(&self, model: &AirframeModel, site: &Site) -> PhysicsState {
        let (mut state, mut now) = (self.start.clone(), self.start_time);
        let load = PowerLoad { lamp_on: true, airborne: true };
        let mut touched = 0;
        for _ in 0..STEPS_PER_SAMPLE {
            model.advance(&mut state, &self.actuators, &AirState::STILL, site, load, now, STEP);
            now += STEP;
            touched += i64::from(state.contact.touching());
        }
        let wanted = if self.in_contact { STEPS_PER_SAMPLE * 9 / 10..=STEPS_PER_SAMPLE } else { 0..=0 };
        assert!(wanted.contains(&touched), "{}: in contact in {touched} of {STEPS_PER_SAMPLE} steps", self.name);
        state
    }
}

fn shipped(file: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).expect("the shipped file must be readable")
}

fn scenario() -> Scenario {
    let file = "scenarios/two-bridges.toml";
    spandrel_model::scenario::read(file, &shipped(file), &|f| Err(f.into())).unwrap_or_else(|problems| panic!("{problems}"))
}

fn vehicle() -> Vehicle {
    let file = "vehicle-params/phantom2.toml";
    spandrel_model::vehicle::read(file, &shipped(file)).unwrap_or_else(|problems| panic!("{problems}"))
}

fn at(place: Vec3<Enu>) -> PhysicsState {
    PhysicsState::at_rest(place.ned(), 0.3)
}

fn hovering(model: &AirframeModel, place: Vec3<Enu>) -> PhysicsState {
    let mut state = at(place);
    state.rigid.rotor_rad_s = [model.hover_rotor_rad_s(); MAX_ROTORS];
    state
}

/// Simulation time by which an aircraft placed on the deck has settled.
const SETTLED_TIME: SimTime = SimTime::from_ms(2000);

/// Returns the state of an aircraft standing on the deck at [`SETTLED_TIME`].
fn standing(model: &AirframeModel, site: &Site, vehicle: &Vehicle, deck: Vec3<Enu>) -> PhysicsState {
    let feet = vehicle.hull.feet_m.iter().map(|f| f.down()).fold(0.0, f64::max);
    let mut state = at(deck + Vec3::new(0.0, 0.0, feet + 0.03));
    let mut now = SimTime::ZERO;
    while now < SETTLED_TIME {
        model.advance(&mut state, &Actuators::default(), &AirState::STILL, site, PowerLoad::default(), now, STEP);
        now += STEP;
    }
    assert!(state.contact.touching(), "the aircraft must stand on the deck");
    state
}

fn cases(model: &AirframeModel, site: &Site, vehicle: &Vehicle) -> Vec<Case> {
    let hover = Actuators { motors: [model.hover_command(); MAX_ROTORS], armed: true };
    let deck = deck(site);
    let up = |m: f64| Vec3::new(0.0, 0.0, m);
    let stand = standing(model, site, vehicle, deck);
    let mut scrape = stand.clone();
    scrape.rigid.velocity_m_s = Vec3::new(4.0, 0.0, 0.0);
    vec![
        Case::new("hovering 60 m above the deck", MAX_HOVER_60_M_RATIO, hovering(model, deck + up(60.0)), hover),
        Case::new("hovering 2 m above the deck", MAX_HOVER_2_M_RATIO, hovering(model, deck + up(2.0)), hover),
        Case::new("hovering 0.5 m above the deck", MAX_HOVER_HALF_M_RATIO, hovering(model, deck + up(0.5)), hover),
        Case::on_deck("standing on the deck, motors off", MAX_STANDING_RATIO, stand),
        Case::on_deck("scraping along the deck", MAX_SCRAPING_RATIO, scrape),
    ]
}

#[expect(clippy::disallowed_methods, reason = "benchmarks measure wall time")]
fn ns_per_step(work: impl FnOnce()) -> f64 {
    let start = std::time::Instant::now();
    work();
    start.elapsed().as_secs_f64() * 1e9 / STEPS_PER_SAMPLE as f64
}

fn median(samples: &mut [f64]) -> f64 {
    samples.sort_by(f64::total_cmp);
    samples[samples.len() / 2]
}

fn main() -> ExitCode {
    let (vehicle, scenario) = (vehicle(), scenario());
    let site = Site::build(&scenario, 1);
    let model = AirframeModel::new(&vehicle, BatteryModel::Physical);
    let mut cases = cases(&model, &site, &vehicle);
    let mut floors = Vec::new();
    for _ in 0..SAMPLE_COUNT {
        floors.push(ns_per_step(|| baseline::run(STEPS_PER_SAMPLE)));
        for case in &mut cases {
            let taken = ns_per_step(|| {
                black_box(case.fly(&model, &site));
            });
            case.samples.push(taken);
        }
    }
    let floor = median(&mut floors);
    println!("{:<36} {floor:>9.0} ns", "baseline: minimal Runge-Kutta quadrotor");
    let mut held = true;
    for case in &mut cases {
        let taken = median(&mut case.samples);
        let ratio = taken / floor;
        let verdict = if ratio <= case.limit { "" } else { "  EXCEEDED" };
        held &= ratio <= case.limit;
        println!("{:<36} {taken:>9.0} ns {ratio:>7.1} x baseline, limit {:>5.0}{verdict}", case.name, case.limit);
    }
    if held { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
