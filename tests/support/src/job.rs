//! A small job, a site with predefined query results, and a recorder of datagrams as sent by a vehicle.

use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::dialect::*;
use spandrel_mavlink::telemetry::tlog;
use spandrel_model::frames::{Enu, Frd, Rotation, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::scenario::*;
use spandrel_model::site::{CameraPose, DefectView};
use spandrel_model::speed_unit::SpeedUnit;
use spandrel_model::stick_response::StickResponse;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::*;
use spandrel_monitor::assessment::{AssessedSession, assess_log};
use spandrel_monitor::measures::attention::SiteSurvey;
use std::sync::Arc;

/// Frame rate of the test job, Hz. It evenly divides the truth rate of 50 Hz, so that frames coincide with samples.
pub const RATE_HZ: f64 = 25.0;
/// The test job's scenario CRC.
pub const CRC: u32 = 0xC0FF_EE00;
/// Session seed on the tape.
pub const SEED: u64 = 7;

pub fn line(from: (f64, f64, f64), to: (f64, f64, f64)) -> Vec<Vec3<Enu>> {
    let (a, b) = (Vec3::new(from.0, from.1, from.2), Vec3::new(to.0, to.1, to.2));
    let steps = (b - a).norm().ceil() as usize;
    (0..=steps).map(|k| a.lerp(b, k as f64 / steps as f64)).collect()
}

pub fn task(id: u32, path_m: Vec<Vec3<Enu>>, threshold_m: f64) -> Task {
    let look = vec![Vec3::new(0.0, 1.0, 0.0); path_m.len()];
    Task {
        id,
        name: format!("task {id}"),
        bridge: None,
        kind: TaskKind::Free,
        threshold_m,
        closed: false,
        path_m,
        viewing_directions: look,
        inspects_surface: true,
        stand_off: None,
        too_close_m: None,
        dark: false,
    }
}

pub fn scenario(tasks: Vec<Task>) -> Scenario {
    Scenario {
        name: "test-job".to_owned(),
        title: "A job for tests".to_owned(),
        briefing: Vec::new(),
        briefing_pictures: Vec::new(),
        lesson: Vec::new(),
        seed: None,
        origin: Geo { latitude_deg: 46.0, longitude_deg: 8.0, altitude_m: 400.0 },
        terrain: TerrainSpec {
            size_m: 400.0,
            spacing_m: 10.0,
            water_level_m: -20.0,
            source: TerrainSource::Flat { height_m: 0.0 },
            photo: None,
        },
        ground_team: ground_team(),
        bridges: Vec::new(),
        tasks,
        defects: DefectSpec { size_factor: 1.0, ..DefectSpec::default() },
        drones: Vec::new(),
        ropes: Vec::new(),
        traffic: TrafficSpec { cars: 0, trucks: 0, pedestrians: 0, car_speed_m_s: 15.0 },
        wind: WindSpec {
            model: WindModel::Paper,
            speed_m_s: 0.0,
            paper_force_n: 0.0,
            from_deg: 0.0,
            up_m_s: 0.0,
            turbulence: 0.0,
            events: Vec::new(),
        },
        light: LightSpec { start_unix_s: 0, cloud_cover: 0.0, water_albedo: 0.1, ground_albedo: 0.2 },
        weather: WeatherSpec::default(),
        hazards: HazardSpec::default(),
        rules: SessionRules {
            battery_temperature_c: 25.0,
            after_crash: AfterCrash::Respawn,
            battery: BatteryModel::Paper,
            low_battery_return: false,
            low_battery_pct: 25.0,
            critical_battery_pct: 10.0,
            gnss_shadow: false,
            respawn_after: SimTime::from_ms(3_000),
            stick_response: StickResponse::Position,
        },
        feedback: feedback(),
        scoring: ScoringParams {
            frame_rate_hz: RATE_HZ,
            speed_limit_m_s: 4.4704,
            speed_limit_unit: SpeedUnit::MilesPerHour,
            max_speed_m_s: 13.4112,
            time_best_s: 900.0,
            time_max_s: 1500.0,
            beta: 1.0,
            exact_path: false,
            task_completion_fraction: 0.8,
            clearance_m: 2.0,
        },
        certification: CertificationParams::default(),
        form: None,
        difficulty: None,
        crc: CRC,
    }
}

fn ground_team() -> GroundTeam {
    GroundTeam {
        pad_m: Vec3::new(0.0, 0.0, 0.0),
        pad_heading_deg: 0.0,
        pad_half_m: 1.0,
        inspector_m: Vec3::new(-3.0, 0.0, 0.0),
        places_m: Vec::new(),
        truck_m: Vec3::new(-6.0, 0.0, 0.0),
        truck_heading_deg: 0.0,
        home_radius_m: 5.0,
    }
}

fn feedback() -> FeedbackThresholds {
    FeedbackThresholds {
        too_close_m: 2.5,
        too_close_clear_m: 2.8,
        off_path_max_m: 8.0,
        off_path_delay: SimTime::from_ms(1_000),
        off_path_hold_time: SimTime::from_ms(2_000),
        leave_delay: SimTime::from_ms(2_000),
        visit_delay: SimTime::from_ms(3_000),
        speeding_margin: 0.05,
        speeding_hold_time: SimTime::from_ms(1_000),
        battery_green_pct: 70.0,
        battery_yellow_pct: 30.0,
        text_interval: SimTime::from_ms(5_000),
        // Tests of the cues expect no other texts.
        guidance: GuidancePolicy::Never,
    }
}

#[expect(clippy::too_many_lines, reason = "one value, field by field")]
pub fn vehicle() -> Vehicle {
    Vehicle {
        id: "test".to_owned(),
        name: "Test".to_owned(),
        mass_kg: 1.3,
        inertia_kg_m2: [0.01, 0.01, 0.02],
        rotors: Vec::new(),
        rotor: RotorModel {
            radius_m: 0.12,
            thrust_coefficient_n_s2: 1e-5,
            torque_coefficient_n_m_s2: 1e-7,
            time_constant_s: 0.05,
            max_speed_rad_s: 1000.0,
            idle_speed_rad_s: 100.0,
            speed_spread: 0.0,
            inertia_kg_m2: 1e-5,
            drag_coefficient_n_s2_m: 0.0,
            efficiency: 0.6,
        },
        drag: Drag { area_m2: [0.01; 3], angular_damping_n_m_s: [0.0; 3] },
        aerodynamics: Aerodynamics::default(),
        hull: Hull {
            tip_to_tip_m: 0.6,
            has_propeller_guard: false,
            body_half_extent_m: [0.1, 0.1, 0.05],
            feet_m: vec![Vec3::<Frd>::new(0.1, 0.1, 0.15)],
            restitution: 0.3,
            friction: 0.5,
        },
        battery: BatterySpec {
            cells: 3,
            capacity_ah: 5.2,
            internal_resistance_ohm: 0.02,
            ocv_cell_v: [3.3, 3.5, 3.6, 3.65, 3.7, 3.75, 3.8, 3.9, 4.0, 4.1, 4.2],
            avionics_power_w: 5.0,
            lamp_power_w: 10.0,
            paper_endurance_s: 1500.0,
        },
        limits: FlightLimits {
            forward_m_s: 10.0,
            sideways_speed_m_s: 10.0,
            climb_m_s: 3.0,
            descend_m_s: 2.0,
            yaw_rate_rad_s: 1.5,
            tilt_rad: 0.5,
            rate_rad_s: 3.0,
            slow_down_time_s: 1.0,
        },
        sensors: SensorSpec {
            imu_rate_hz: 400.0,
            accel_noise_density: 0.0,
            accel_bias_m_s2: 0.0,
            gyro_noise_density: 0.0,
            gyro_bias_rad_s: 0.0,
            accel_vibration_m_s2: 0.0,
            gyro_vibration_rad_s: 0.0,
            gnss_rate_hz: 5.0,
            gnss_horizontal_noise_m: 0.0,
            gnss_vertical_noise_m: 0.0,
            gnss_velocity_noise_m_s: 0.0,
            gnss_delay_s: 0.0,
            baro_rate_hz: 50.0,
            baro_noise_m: 0.0,
            baro_drift_m_sqrt_s: 0.0,
            baro_airflow: 0.0,
            mag_rate_hz: 50.0,
            mag_noise_gauss: 0.0,
            mag_bias_gauss: 0.0,
            range_rate_hz: 20.0,
            range_noise_m: 0.0,
            range_bias_m: 0.0,
            range_max_m: 10.0,
            flow_velocity_m_s: 0.0,
        },
        camera: Camera {
            position_m: Vec3::new(0.1, 0.0, 0.0),
            width_px: 4000,
            height_px: 3000,
            hfov_rad: 1.2,
            zoom_max: 1.0,
            f_number: 2.8,
            iso_max: 1600.0,
            max_exposure_time_s: 0.01,
            gimbal_pitch_min_rad: -1.57,
            gimbal_pitch_max_rad: 1.57,
            gimbal_rate_rad_s: 1.0,
        },
        lamp: Lamp { luminous_flux_lm: 500.0, beam_angle_rad: 1.0 },
    }
}

/// A site where defect k (from 1) is visible to every camera within one meter of 10 k m east.
#[derive(Debug)]
pub struct TestSurvey {
    pub defects: Vec<PlacedDefect>,
}

impl TestSurvey {
    pub fn of(count: u32) -> Self {
        let one = |id: u32| PlacedDefect {
            id,
            element: spandrel_model::elements::Element::RcArch,
            member: "fence".to_owned(),
            kind: 1080,
            condition_state: 2,
            position_m: Vec3::new(10.0 * f64::from(id), 2.0, 10.0),
            normal: Vec3::new(0.0, -1.0, 0.0),
            along: Vec3::new(1.0, 0.0, 0.0),
            length_m: 0.3,
            width_m: 0.2,
            line: false,
            cause: None,
            stain: None,
        };
        Self { defects: (1..=count).map(one).collect() }
    }
}

impl SiteSurvey for TestSurvey {
    fn defects(&self) -> &[PlacedDefect] {
        &self.defects
    }
    fn view_defects(&self, pose: &CameraPose, _: &Camera, _: &Lamp, _: SimTime) -> Vec<DefectView> {
        let near = |defect: &&PlacedDefect| (defect.position_m.east() - pose.position_m.east()).abs() < 1.0;
        let seen = |defect: &PlacedDefect| DefectView {
            defect_id: defect.id,
            in_frame: true,
            unoccluded: true,
            incidence_rad: 0.0,
            extent_px: 100.0,
            width_px: 50.0,
            illuminance_lux: if pose.lamp_on { 1000.0 } else { 10.0 },
            required_illuminance_lux: 100.0,
            distance_m: 2.0,
            hit: pose.lamp_on,
            lamp_on: pose.lamp_on,
            line: defect.line,
        };
        self.defects.iter().filter(near).map(seen).collect()
    }
    fn nearest_object_name(&self, _: Vec3<Enu>, _: f64, _: SimTime) -> Option<String> {
        Some("fence".to_owned())
    }
}

pub fn test_survey(_: &Scenario, _: u64) -> Arc<dyn SiteSurvey> {
    Arc::new(TestSurvey::of(10))
}

/// Recorded datagrams in sending order, one frame each.
#[derive(Debug, Clone)]
pub struct Tape {
    plane: LocalPlane,
    encoder: Encoder,
    /// Datagrams sent.
    pub datagrams: Vec<Vec<u8>>,
    /// Simulator time at the start of the tape, ms.
    epoch_ms: u64,
    /// Time of the last truth sample since the start of the tape, ms.
    pub now_ms: u32,
    /// Position of the last truth sample, m.
    pub at_m: Vec3<Enu>,
    /// Heading, rad clockwise from north.
    pub yaw_rad: f64,
}

impl Default for Tape {
    fn default() -> Self {
        Self::new()
    }
}

impl Tape {
    /// Creates a tape with the aircraft armed on the pad at simulation time zero, with the seed and scenario CRC sent.
    pub fn new() -> Self {
        Self::of(&scenario(Vec::new()))
    }

    /// Creates a tape like [`Self::new`] for any job.
    pub fn of(job: &Scenario) -> Self {
        Self::starting_at(0, job)
    }

    /// Creates a tape like [`Self::of`] for a simulator that has already run for `epoch_ms`.
    pub fn starting_at(epoch_ms: u64, job: &Scenario) -> Self {
        let plane = LocalPlane::new(job.origin);
        let at_m = job.ground_team.pad_m + Vec3::new(0.0, 0.0, 0.15);
        let mut tape =
            Self { plane, encoder: Encoder::new(1, 1), datagrams: Vec::new(), epoch_ms, now_ms: 0, at_m, yaw_rad: 0.0 };
        tape.truth(Vec3::zero());
        tape.int("seed", SEED as i32);
        tape.int("scn_crc", job.crc as i32);
        tape.int("hits", 0);
        tape.int("respawns", 0);
        tape.contact(0);
        tape.battery(100);
        tape.armed(true);
        tape
    }

    /// Returns the time as a 32-bit millisecond counter.
    fn clock_ms(&self) -> u32 {
        (self.epoch_ms + u64::from(self.now_ms)) as u32
    }

    pub fn send(&mut self, message: &MavMessage) {
        self.datagrams.push(self.encoder.encode(message));
    }

    fn truth(&mut self, velocity: Vec3<Enu>) {
        let geo = self.plane.geo_from_enu(self.at_m);
        let [e, n, u] = velocity.array().map(|v| (v * 100.0).round() as i16);
        self.send(&MavMessage::HIL_STATE_QUATERNION(HIL_STATE_QUATERNION_DATA {
            time_usec: (self.epoch_ms + u64::from(self.now_ms)) * 1000,
            attitude_quaternion: quaternion(0.0, self.yaw_rad),
            lat: (geo.latitude_deg * 1e7).round() as i32,
            lon: (geo.longitude_deg * 1e7).round() as i32,
            alt: (geo.altitude_m * 1e3).round() as i32,
            vx: n,
            vy: e,
            vz: -u,
            ..HIL_STATE_QUATERNION_DATA::default()
        }));
    }

    pub fn int(&mut self, name: &str, value: i32) {
        let time_boot_ms = self.clock_ms();
        self.send(&MavMessage::NAMED_VALUE_INT(NAMED_VALUE_INT_DATA { time_boot_ms, value, name: name.into() }));
    }

    pub fn contact(&mut self, code: i32) {
        self.int("contact", code);
    }

    pub fn clearance(&mut self, meters: f32) {
        let time_boot_ms = self.clock_ms();
        let name = "clearance".into();
        self.send(&MavMessage::NAMED_VALUE_FLOAT(NAMED_VALUE_FLOAT_DATA { time_boot_ms, value: meters, name }));
    }

    pub fn battery(&mut self, pct: i8) {
        self.send(&MavMessage::BATTERY_STATUS(BATTERY_STATUS_DATA { battery_remaining: pct, ..BATTERY_STATUS_DATA::default() }));
    }

    pub fn armed(&mut self, armed: bool) {
        self.beat(armed, 3 << 16);
    }

    pub fn beat(&mut self, armed: bool, custom_mode: u32) {
        let base_mode = if armed { MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED } else { MavModeFlag::empty() };
        let autopilot = MavAutopilot::MAV_AUTOPILOT_PX4;
        self.send(&MavMessage::HEARTBEAT(HEARTBEAT_DATA { base_mode, custom_mode, autopilot, ..HEARTBEAT_DATA::default() }));
    }

    pub fn lamp(&mut self, on: bool) {
        let lamp =
            ILLUMINATOR_STATUS_DATA { uptime_ms: self.clock_ms(), enable: u8::from(on), ..ILLUMINATOR_STATUS_DATA::default() };
        self.send(&MavMessage::ILLUMINATOR_STATUS(lamp));
    }

    /// Sets the gimbal pitch in radians above the horizon.
    pub fn gimbal(&mut self, pitch_rad: f64) {
        self.send(&MavMessage::GIMBAL_DEVICE_ATTITUDE_STATUS(GIMBAL_DEVICE_ATTITUDE_STATUS_DATA {
            time_boot_ms: self.clock_ms(),
            q: quaternion(pitch_rad, 0.0),
            ..GIMBAL_DEVICE_ATTITUDE_STATUS_DATA::default()
        }));
    }

    pub fn field_of_view(&mut self, hfov_deg: f32) {
        let time_boot_ms = self.clock_ms();
        self.send(&MavMessage::CAMERA_FOV_STATUS(CAMERA_FOV_STATUS_DATA { time_boot_ms, hfov: hfov_deg, ..Default::default() }));
    }

    pub fn snapshot(&mut self, index: i32) {
        self.snapshot_at(index, self.clock_ms());
    }

    pub fn snapshot_at(&mut self, index: i32, time_boot_ms: u32) {
        self.send(&MavMessage::CAMERA_IMAGE_CAPTURED(CAMERA_IMAGE_CAPTURED_DATA {
            time_boot_ms,
            image_index: index,
            capture_result: MavBool::MAV_BOOL_TRUE,
            ..CAMERA_IMAGE_CAPTURED_DATA::default()
        }));
    }

    /// Flies straight and level to `to` at `speed_m_s`, with a truth sample and the sticks every 20 ms.
    pub fn fly(&mut self, to: (f64, f64, f64), speed_m_s: f64) {
        let to: Vec3<Enu> = Vec3::new(to.0, to.1, to.2);
        let (from, way) = (self.at_m, to - self.at_m);
        let steps = (way.norm() / (speed_m_s * 0.02)).ceil() as u32;
        for k in 1..=steps {
            self.now_ms += 20;
            self.at_m = from.lerp(to, f64::from(k) / f64::from(steps));
            self.truth(way.unit() * speed_m_s);
            self.sticks();
        }
    }

    /// Holds position for `seconds`.
    pub fn hold(&mut self, seconds: f64) {
        for _ in 0..(seconds * 50.0).round() as u32 {
            self.now_ms += 20;
            self.truth(Vec3::zero());
            self.sticks();
        }
    }

    /// Holds position for `ms` without recording.
    pub fn hold_unrecorded(&mut self, ms: u32) {
        self.now_ms += ms;
    }

    fn sticks(&mut self) {
        let forward = 1500 + (self.now_ms / 20 % 100) as u16;
        self.send(&MavMessage::RC_CHANNELS(RC_CHANNELS_DATA {
            time_boot_ms: self.clock_ms(),
            chan1_raw: 1500,
            chan2_raw: forward,
            chan3_raw: 1500,
            chan4_raw: 1500,
            chancount: 4,
            ..RC_CHANNELS_DATA::default()
        }));
    }

    /// Returns home, lands and disarms.
    pub fn land(&mut self) {
        self.fly((0.0, 0.0, 10.0), 4.0);
        self.fly((0.0, 0.0, 0.15), 0.8);
        self.hold(3.5);
        self.armed(false);
        self.hold(1.0);
    }

    /// Converts the tape to a telemetry log that starts at Unix time `start_us`.
    pub fn log(&self, start_us: u64) -> Vec<u8> {
        log_of(&self.datagrams, start_us)
    }
}

fn quaternion(pitch_rad: f64, yaw_rad: f64) -> [f32; 4] {
    Rotation::from_euler(0.0, pitch_rad, yaw_rad).wxyz().map(|component| component as f32)
}

pub fn log_of(datagrams: &[Vec<u8>], start_us: u64) -> Vec<u8> {
    datagrams.iter().flat_map(|datagram| tlog::record(start_us, datagram)).collect()
}

/// Creates a job with one straight task along the east axis, 10 m up, from 10 to 60 m.
pub fn one_task() -> Scenario {
    scenario(vec![task(1, line((10.0, 0.0, 10.0), (60.0, 0.0, 10.0)), 3.0)])
}

/// Takes off, flies the task's path once at 4 m/s, returns home and lands.
pub fn clean_flight() -> Tape {
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((60.0, 0.0, 10.0), 4.0);
    tape.land();
    tape
}

/// Scores a tape.
pub fn score_tape(tape: &Tape, scenario: &Scenario) -> AssessedSession {
    assess_log(&tape.log(1_000_000), scenario, &vehicle(), test_survey).unwrap()
}
