//! A test bench: an aircraft flying above flat ground, without MAVLink.

use crate::shipped::scenario;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{BatteryModel, SessionRules};
use spandrel_model::site::Site;
use spandrel_model::stick_response::StickResponse;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::autopilot::{
    Autopilot, AutopilotRequest, CONTROL_HZ, FlightMode, LandedState, RequestOutcome, Sticks, Tuning,
};
use spandrel_sitl::faults::Faults;
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, PhysicsState, PowerLoad};
use spandrel_sitl::sensors::{BatteryReading, FeltMotion, Readings, SensorInputs, SensorSite, Sensors};

pub const VEHICLES: [&str; 4] = ["phantom2", "f450", "m30", "elios3"];
const STEP: SimTime = SimTime::from_ms(1);

pub struct Bench {
    pub site: Site,
    pub model: AirframeModel,
    pub state: PhysicsState,
    pub sensors: Sensors,
    pub autopilot: Autopilot,
    pub air: AirState,
    pub now: SimTime,
    pub sticks: Option<Sticks>,
    pub actuators: Actuators,
    /// Whether the GNSS receiver has no signal.
    pub gnss_lost: bool,
    /// Whether the optical-flow sensor has no valid image.
    pub flow_lost: bool,
    /// Function that modifies the sensor readings.
    pub modify_readings: Option<fn(&mut Readings, SimTime)>,
    /// Failures injected by an instructor.
    pub faults: Faults,
    control: Schedule,
    stick_clock: Schedule,
}

impl Bench {
    pub fn new(vehicle: &Vehicle, seed: u64) -> Self {
        Self::with_rules(vehicle, seed, |_| ())
    }

    pub fn with_rules(vehicle: &Vehicle, seed: u64, change: impl Fn(&mut SessionRules)) -> Self {
        let mut scenario = scenario("drill-hover");
        change(&mut scenario.rules);
        let model = AirframeModel::new(vehicle, BatteryModel::Physical);
        let density_kg_m3 = model.air_density_kg_m3(scenario.origin.altitude_m);
        let feet = vehicle.hull.feet_m.iter().map(|f| f.down()).fold(0.0, f64::max);
        Self {
            site: Site::build(&scenario, seed),
            model,
            state: PhysicsState::at_rest(Vec3::new(0.0, 0.0, -feet - 0.02), 0.0),
            sensors: Sensors::new(vehicle, SensorSite::open(scenario.origin), seed),
            autopilot: Autopilot::new(vehicle, &scenario.rules, scenario.origin, Tuning::default()),
            air: AirState { density_kg_m3, ..AirState::STILL },
            now: SimTime::ZERO,
            sticks: None,
            actuators: Actuators::default(),
            gnss_lost: false,
            flow_lost: false,
            faults: Faults::new(seed),
            modify_readings: None,
            control: Schedule::new(SimTime::ZERO, CONTROL_HZ),
            stick_clock: Schedule::new(SimTime::ZERO, 25.0),
        }
    }

    pub fn run(&mut self, seconds: f64, mut each: impl FnMut(&Self)) {
        let end = self.now + SimTime::from_s(seconds);
        while self.now < end {
            if let Some(sticks) = self.sticks
                && self.stick_clock.fire(self.now)
            {
                self.autopilot.sticks(sticks, self.now);
            }
            if self.control.fire(self.now) {
                let b = &self.state.battery;
                let battery = BatteryReading { voltage_v: b.voltage_v, current_a: b.current_a, remaining_pct: b.remaining_pct() };
                let rigid = &self.state.rigid;
                let air_velocity_m_s = rigid.velocity_m_s - self.air.velocity_m_s;
                let truth = SensorInputs { rigid, air_velocity_m_s, battery, lamp_on: false };
                let mut readings = self.sensors.sample(&truth, &self.site, self.now);
                readings.gnss = readings.gnss.filter(|_| !self.gnss_lost);
                readings.flow = readings.flow.filter(|_| !self.flow_lost);
                if let Some(modify_readings) = self.modify_readings {
                    modify_readings(&mut readings, self.now);
                }
                self.faults.corrupt_readings(&mut readings, self.now);
                self.actuators = self.autopilot.step(&readings, self.now);
            }
            let load = PowerLoad { lamp_on: false, airborne: true };
            self.model.advance(&mut self.state, &self.actuators, &self.air, &self.site, load, self.now, STEP);
            self.sensors.integrate_imu(&FeltMotion::of(&self.state), STEP);
            self.now += STEP;
            each(self);
        }
    }

    pub fn ask(&mut self, request: AutopilotRequest) {
        assert_eq!(self.autopilot.request(request, self.now), RequestOutcome::Accepted, "{request:?}");
    }

    /// Requests a flight to a position, in meters from the pad.
    pub fn go_to(&mut self, north_m: f64, east_m: f64, up_m: f64) {
        let north_east_m = Some((north_m, east_m));
        self.ask(AutopilotRequest::GoTo { north_east_m, up_m: Some(up_m), yaw_rad: None, speed_m_s: None });
    }

    /// Returns the texts of the events since the last call.
    pub fn take_texts(&mut self) -> Vec<String> {
        self.autopilot.drain_events().into_iter().map(|event| event.text).collect()
    }

    pub fn position(&self) -> Vec3<Ned> {
        self.state.rigid.position_m
    }

    /// Creates a bench with the aircraft ready, armed and hovering at a height, given in meters.
    pub fn airborne(vehicle: &Vehicle, seed: u64, height_m: f64) -> Self {
        let mut bench = Self::new(vehicle, seed);
        bench.take_off(height_m);
        bench
    }

    pub fn take_off(&mut self, height_m: f64) {
        self.run(2.0, |_| ());
        self.ask(AutopilotRequest::Arm { force: false });
        self.ask(AutopilotRequest::Takeoff { height_m: Some(height_m) });
        self.run(6.0 + height_m, |_| ());
        let status = self.autopilot.status();
        assert_eq!((status.mode, status.landed), (FlightMode::Hold, LandedState::InAir), "{:?}", self.position());
    }

    /// Creates a bench with the aircraft hovering in position mode with centered sticks.
    pub fn in_position_mode(vehicle: &Vehicle, seed: u64, height_m: f64) -> Self {
        let mut bench = Self::airborne(vehicle, seed, height_m);
        bench.sticks = Some(Sticks::default());
        bench.run(0.1, |_| ());
        bench.ask(AutopilotRequest::SetMode(FlightMode::Position));
        bench.run(2.0, |_| ());
        bench
    }

    /// The same with sticks that command speeds in proportion, as quickly as the airframe allows.
    pub fn in_sport_mode(vehicle: &Vehicle, seed: u64, height_m: f64) -> Self {
        let mut bench = Self::in_position_mode(vehicle, seed, height_m);
        bench.autopilot.tuning.stick_response = StickResponse::Sport;
        bench
    }

    /// Centers the sticks during a turn, clockwise for a positive `direction`, and waits. Returns the angle by which the nose swings back
    /// and the angle by which it first keeps turning, in rad.
    pub fn end_turn(&mut self, direction: f64, seconds: f64) -> (f64, f64) {
        self.sticks = Some(Sticks::default());
        let (mut last, mut turned, mut farthest) = (self.state.rigid.attitude.yaw_rad(), 0.0_f64, 0.0_f64);
        self.run(seconds, |b| {
            let now = b.state.rigid.attitude.yaw_rad();
            turned += math::wrap_pi(now - last) * direction.signum();
            last = now;
            farthest = farthest.max(turned);
        });
        (farthest - turned, turned)
    }

    /// Resets the clock to an earlier time, to continue from a saved state.
    pub fn rewind(&mut self, to: SimTime) {
        self.now = to;
        self.control = Schedule::new(SimTime::ZERO, CONTROL_HZ);
        self.stick_clock = Schedule::new(SimTime::ZERO, 25.0);
        self.control.fire(to - STEP);
        self.stick_clock.fire(to - STEP);
    }
}
