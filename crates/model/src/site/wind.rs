//! Wind field: mean profile over water and ground, weather changes, 1-cosine gusts, and Dryden turbulence (over land that of
//! MIL-F-8785C at low altitude, over water that of open water).
//!
//! Turbulence depends on the motion of the vehicle and therefore has state, which is plain data and part of a snapshot.
//! The mean profile is that of open water or, below 20 ft over land, that of grass. [`super::wakes`] adds the wakes of piers
//! and the flow around decks; other effects of structures are not modeled.

use super::turbulence::{Dryden, FirstOrderFilter, REFERENCE_HEIGHT_M, SecondOrderFilter, WATER_ROUGHNESS_M};
use crate::frames::{Ned, Vec3};
use crate::math;
use crate::random::RandomStream;
use crate::scenario::{WindEvent, WindModel, WindSpec};
use crate::time::SimTime;

/// Sample rate of the wind, Hz. Linear interpolation between samples delays the wind by one sample (10 ms).
pub const SAMPLE_RATE_HZ: i64 = 100;
/// Interval between wind samples.
pub const SAMPLE_PERIOD: SimTime = SimTime::from_ms(1000 / SAMPLE_RATE_HZ);
/// Roughness length of open ground with grass, m (WMO guide to instruments, class 3: 0.03 m).
const GROUND_ROUGHNESS_M: f64 = 0.03;
/// Height below which turbulence is proportional to the mean wind, m: 10 ft, the lower limit of MIL-F-8785C (estimate: constant
/// relative intensity).
const MIN_TURBULENCE_HEIGHT_M: f64 = 3.048;
/// Height below which the profile is constant, m (estimate: wave height).
const MIN_PROFILE_HEIGHT_M: f64 = 0.5;
/// Length of the way along which the turbulence of the air adapts to another surface, m (estimate: a turbulent layer grows by about a
/// tenth of the way behind a shore, so that this one reaches 10 m).
const SHORE_LENGTH_M: f64 = 100.0;
/// Number of intervals in which a change of the wind is integrated.
const DRIFT_INTERVALS: u32 = 8;
/// Minimum drift speed of the turbulence past the vehicle, m/s (estimate; keeps the time scale finite in still air).
const MIN_DRIFT_SPEED_M_S: f64 = 0.1;

/// Mean wind at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanWind {
    /// Speed at 20 ft above the water, m/s.
    pub speed_m_s: f64,
    /// Direction that the wind blows from, rad clockwise from north.
    pub from_rad: f64,
}

/// Wind at the position of one vehicle. Call [`WindField::update`] as simulation time advances, then
/// [`WindField::air_velocity`] whenever the physics needs it.
#[derive(Debug, Clone, PartialEq)]
pub struct WindField {
    wind: WindSpec,
    stream: RandomStream,
    along: FirstOrderFilter,
    across: SecondOrderFilter,
    vertical: SecondOrderFilter,
    over_ground: bool,
    /// Share of land in the turbulence; none before the first sample.
    share_of_land: Option<f64>,
    next_sample: SimTime,
    previous_velocity_m_s: Vec3<Ned>,
    current_velocity_m_s: Vec3<Ned>,
}

impl WindField {
    /// Creates the wind field from a scenario's settings and a session's seed.
    #[must_use]
    pub fn new(wind: &WindSpec, seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "wind.turbulence");
        let along = FirstOrderFilter::start(&mut stream);
        let across = SecondOrderFilter::start(&mut stream);
        let vertical = SecondOrderFilter::start(&mut stream);
        let mut field = Self {
            wind: wind.clone(),
            stream,
            along,
            across,
            vertical,
            over_ground: false,
            share_of_land: None,
            next_sample: SimTime::ZERO,
            previous_velocity_m_s: Vec3::zero(),
            current_velocity_m_s: Vec3::zero(),
        };
        field.current_velocity_m_s = field.mean_velocity(SimTime::ZERO, REFERENCE_HEIGHT_M);
        field.previous_velocity_m_s = field.current_velocity_m_s;
        field
    }

    /// Advances the wind to time `now` for a vehicle at `height_m` above the surface that moves at `velocity_m_s` over ground.
    /// Draws new samples at [`SAMPLE_RATE_HZ`] of simulation time. Does nothing in the `paper` model, whose air is still.
    pub fn update(&mut self, now: SimTime, height_m: f64, velocity_m_s: Vec3<Ned>) {
        if self.wind.model == WindModel::Paper {
            return;
        }
        while self.next_sample <= now {
            let sample = self.sample(self.next_sample, height_m, velocity_m_s);
            self.previous_velocity_m_s = if self.next_sample == SimTime::ZERO { sample } else { self.current_velocity_m_s };
            self.current_velocity_m_s = sample;
            self.next_sample += SAMPLE_PERIOD;
        }
    }

    /// Sets whether the vehicle is over ground, which slows the wind near it and makes it more turbulent, or over water.
    pub fn set_over_ground(&mut self, over_ground: bool) {
        self.over_ground = over_ground;
    }

    /// Changes the mean wind linearly, starting at `at` and lasting `over`, to a new speed at 20 ft (m/s) and a new
    /// direction that it blows from (degrees clockwise from north). Affects only the `physical` model.
    pub fn add_change(&mut self, at: SimTime, over: SimTime, speed_m_s: f64, from_deg: f64) {
        self.wind.events.push(WindEvent::Change { at, over, speed_m_s, from_deg });
    }

    /// Returns the air velocity over ground in m/s. The time must not be later than the next sample. Zero in the
    /// `paper` model.
    #[must_use]
    pub fn air_velocity(&self, at: SimTime) -> Vec3<Ned> {
        if self.wind.model == WindModel::Paper {
            return Vec3::zero();
        }
        let since = (at - (self.next_sample - SAMPLE_PERIOD)).s();
        self.previous_velocity_m_s.lerp(self.current_velocity_m_s, (since / SAMPLE_PERIOD.s()).clamp(0.0, 1.0))
    }

    /// Returns the constant force, in N, that the `paper` model applies at the center of mass; zero in the `physical`
    /// model. The force points downwind, including the vertical wind component.
    #[must_use]
    pub fn paper_force_n(&self) -> Vec3<Ned> {
        if self.wind.model == WindModel::Physical {
            return Vec3::zero();
        }
        let horizontal = direction_toward(self.wind.from_deg.to_radians());
        let tilted = horizontal * self.wind.speed_m_s + Vec3::new(0.0, 0.0, -self.wind.up_m_s);
        let direction = if tilted.norm() > 0.0 { tilted.unit() } else { horizontal };
        direction * self.wind.paper_force_n
    }

    /// Returns the air velocity in m/s, including gusts and mean wind changes but without turbulence.
    #[must_use]
    pub fn mean_velocity(&self, at: SimTime, height_m: f64) -> Vec3<Ned> {
        let mean = mean_at(&self.wind, at);
        direction_toward(mean.from_rad) * (mean.speed_m_s * self.profile(height_m))
            + gusts_at(&self.wind, at)
            + Vec3::new(0.0, 0.0, -self.wind.up_m_s)
    }

    /// Returns the ratio of the speed at a height above the surface to the speed at 20 ft.
    fn profile(&self, height_m: f64) -> f64 {
        let water = profile(height_m);
        if self.over_ground { water.min(log_profile(height_m, GROUND_ROUGHNESS_M)) } else { water }
    }

    fn sample(&mut self, at: SimTime, height_m: f64, velocity_m_s: Vec3<Ned>) -> Vec3<Ned> {
        let mean = mean_at(&self.wind, at);
        let mean_velocity = self.mean_velocity(at, height_m);
        if self.wind.turbulence <= 0.0 {
            return mean_velocity;
        }
        // Turbulence drifts with the mean wind (Taylor's hypothesis), so a hovering drone also moves through it.
        let drift = (velocity_m_s - mean_velocity).norm().max(mean_velocity.norm()).max(MIN_DRIFT_SPEED_M_S);
        let traveled_m = drift * SAMPLE_PERIOD.s();
        let share_of_land = self.share_of_land_after(traveled_m);
        let dryden = Dryden::near_shore(height_m, mean.speed_m_s, share_of_land);
        let u = self.along.step(traveled_m / dryden.horizontal_length_scale_m, &mut self.stream);
        let v = self.across.step(traveled_m / dryden.horizontal_length_scale_m, &mut self.stream);
        let w = self.vertical.step(traveled_m / dryden.vertical_length_scale_m, &mut self.stream);
        let along = direction_toward(mean.from_rad);
        let across = Vec3::new(-along.east(), along.north(), 0.0);
        let near_surface = (self.profile(height_m) / self.profile(MIN_TURBULENCE_HEIGHT_M)).min(1.0);
        let scale = self.wind.turbulence * near_surface;
        mean_velocity
            + along * (u * dryden.sigma_along_m_s * scale)
            + across * (v * dryden.sigma_across_m_s * scale)
            + Vec3::new(0.0, 0.0, w * dryden.sigma_vertical_m_s * scale)
    }

    /// Returns the share of land in the turbulence after the air has traveled past the vehicle.
    fn share_of_land_after(&mut self, traveled_m: f64) -> f64 {
        let here = if self.over_ground { 1.0 } else { 0.0 };
        let before = self.share_of_land.unwrap_or(here);
        let share = here + (before - here) * math::exp(-traveled_m / SHORE_LENGTH_M);
        self.share_of_land = Some(share);
        share
    }
}

/// Returns the unit vector in the direction of air motion, for wind from `from_rad` (clockwise from north).
#[must_use]
pub fn direction_toward(from_rad: f64) -> Vec3<Ned> {
    let (s, c) = math::sin_cos(from_rad);
    Vec3::new(-c, -s, 0.0)
}

/// Returns the ratio of the wind speed at a height to the wind speed at 20 ft according to the logarithmic profile over
/// water.
#[must_use]
pub fn profile(height_m: f64) -> f64 {
    log_profile(height_m, WATER_ROUGHNESS_M)
}

fn log_profile(height_m: f64, roughness_m: f64) -> f64 {
    math::ln(height_m.max(MIN_PROFILE_HEIGHT_M) / roughness_m) / math::ln(REFERENCE_HEIGHT_M / roughness_m)
}

/// Returns the mean wind at a time. Each change is linear in speed and in direction, which turns the shorter way.
#[must_use]
pub fn mean_at(wind: &WindSpec, at: SimTime) -> MeanWind {
    let mut mean = MeanWind { speed_m_s: wind.speed_m_s, from_rad: wind.from_deg.to_radians() };
    for event in &wind.events {
        let WindEvent::Change { at: start, over, speed_m_s, from_deg } = event else { continue };
        let since = (at - *start).s();
        if since <= 0.0 {
            continue;
        }
        let share = if over.s() > 0.0 { (since / over.s()).min(1.0) } else { 1.0 };
        mean.speed_m_s = math::lerp(mean.speed_m_s, *speed_m_s, share);
        mean.from_rad += math::wrap_pi(from_deg.to_radians() - mean.from_rad) * share;
    }
    mean
}

/// Returns the horizontal air velocity at 20 ft, m/s, with gusts and changes of the mean wind but without turbulence.
#[must_use]
pub fn velocity_at(wind: &WindSpec, at: SimTime) -> Vec3<Ned> {
    let mean = mean_at(wind, at);
    direction_toward(mean.from_rad) * mean.speed_m_s + gusts_at(wind, at)
}

/// Returns the displacement of the air at 20 ft from the simulation's start to a time, m.
#[must_use]
pub fn drift_m(wind: &WindSpec, at: SimTime) -> Vec3<Ned> {
    let end_s = at.s().max(0.0);
    let changes = wind.events.iter().flat_map(|event| match event {
        WindEvent::Gust { at, duration, .. } => [at.s(), (*at + *duration).s()],
        WindEvent::Change { at, over, .. } => [at.s(), (*at + *over).s()],
    });
    let mut times_s: Vec<f64> = changes.filter(|time_s| (0.0..end_s).contains(time_s)).chain([0.0, end_s]).collect();
    times_s.sort_by(f64::total_cmp);
    times_s.windows(2).fold(Vec3::zero(), |sum, pair| sum + drift_between(wind, (pair[0], pair[1])))
}

/// Integrates the velocity between two times, s, with two Gauss points in each interval. They are inside, so that a jump at an end
/// causes no error; a constant or linear velocity is exact.
fn drift_between(wind: &WindSpec, (from_s, to_s): (f64, f64)) -> Vec3<Ned> {
    let step_s = (to_s - from_s) / f64::from(DRIFT_INTERVALS);
    let reach = 0.5 / 3.0_f64.sqrt();
    let times_s = (0..DRIFT_INTERVALS).flat_map(|k| [-reach, reach].map(|side| from_s + step_s * (f64::from(k) + 0.5 + side)));
    times_s.fold(Vec3::zero(), |sum, time_s| sum + velocity_at(wind, SimTime::from_s(time_s)) * (0.5 * step_s))
}

/// Returns the standard deviation of the wind speed at 20 ft above open water relative to the mean speed.
#[must_use]
pub fn gust_intensity(wind: &WindSpec) -> f64 {
    Dryden::over_water(REFERENCE_HEIGHT_M, 1.0).sigma_along_m_s * wind.turbulence
}

/// Returns the sum of all 1-cosine gusts at a time. A gust has the speed peak/2 (1 - cos(2 pi t/duration)) while it lasts.
fn gusts_at(wind: &WindSpec, at: SimTime) -> Vec3<Ned> {
    wind.events.iter().fold(Vec3::zero(), |sum, event| match event {
        WindEvent::Gust { at: start, duration, peak_speed_m_s, from_deg } => {
            let since = (at - *start).s();
            let inside = since > 0.0 && since < duration.s();
            let speed = if inside { 0.5 * peak_speed_m_s * (1.0 - math::cos(math::TAU * since / duration.s())) } else { 0.0 };
            sum + direction_toward(from_deg.to_radians()) * speed
        }
        WindEvent::Change { .. } => sum,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wind() -> WindSpec {
        WindSpec {
            model: WindModel::Physical,
            speed_m_s: 4.917,
            paper_force_n: 3.0,
            from_deg: 0.0,
            up_m_s: 0.0,
            turbulence: 1.0,
            events: Vec::new(),
        }
    }

    /// Returns `seconds` of turbulence samples at the wind's sample rate.
    fn turbulence(wind: &WindSpec, seconds: i64, height_m: f64, airspeed_m_s: f64) -> Vec<Vec3<Ned>> {
        let mut field = WindField::new(wind, 11);
        let mean = field.mean_velocity(SimTime::ZERO, height_m);
        let velocity = mean + Vec3::new(airspeed_m_s, 0.0, 0.0);
        (0..seconds * SAMPLE_RATE_HZ)
            .map(|k| {
                field.update(SimTime::from_ms(k * 10), height_m, velocity);
                field.current_velocity_m_s - mean
            })
            .collect()
    }

    fn correlation(values: &[f64], lag: usize) -> f64 {
        let pairs = values.len() - lag;
        (0..pairs).map(|k| values[k] * values[k + lag]).sum::<f64>() / pairs as f64
    }

    #[test]
    fn exact_turbulence_has_the_specified_variance_and_length_scales() {
        const HEIGHT_M: f64 = 10.0;
        const AIRSPEED_M_S: f64 = 25.0;
        // Relative tolerance. 30 000 s contain 11 000 time scales of the slowest component, so one standard error is 1.4%.
        const VARIANCE_TOLERANCE: f64 = 0.05;
        // Tolerance on the correlation coefficient at a lag of one time scale: five standard errors.
        const CORRELATION_TOLERANCE: f64 = 0.05;
        let samples = turbulence(&wind(), 30_000, HEIGHT_M, AIRSPEED_M_S);
        let d = Dryden::over_water(HEIGHT_M, 4.917);
        // Wind from the north moves the air south. At a lag of one time scale, the correlation of a first-order filter is 1/e,
        // and that of a second-order filter 1/(2e).
        let axes: [(Vec<f64>, f64, f64, f64); 3] = [
            (samples.iter().map(|s| s.north()).collect(), d.sigma_along_m_s, d.horizontal_length_scale_m, 1.0),
            (samples.iter().map(|s| s.east()).collect(), d.sigma_across_m_s, d.horizontal_length_scale_m, 0.5),
            (samples.iter().map(|s| s.down()).collect(), d.sigma_vertical_m_s, d.vertical_length_scale_m, 0.5),
        ];
        for (values, sigma, length, factor) in axes {
            let variance = correlation(&values, 0);
            assert!((variance / (sigma * sigma) - 1.0).abs() < VARIANCE_TOLERANCE, "{variance} against {}", sigma * sigma);
            let lag = (length / AIRSPEED_M_S * SAMPLE_RATE_HZ as f64).round();
            let scales = lag * AIRSPEED_M_S / SAMPLE_RATE_HZ as f64 / length;
            let expected = math::exp(-scales) * (1.0 - scales * (1.0 - factor));
            let measured = correlation(&values, lag as usize) / variance;
            assert!((measured - expected).abs() < CORRELATION_TOLERANCE, "{measured} against {expected}");
        }
    }

    #[test]
    fn exact_turbulence_adapts_to_land_along_the_way_behind_a_shore() {
        let mut field = WindField::new(&wind(), 1);
        assert_eq!(field.share_of_land_after(1.0), 0.0);
        field.set_over_ground(true);
        let share = (0..100).map(|_| field.share_of_land_after(0.01 * SHORE_LENGTH_M)).last().unwrap();
        assert!((share - (1.0 - math::exp(-1.0))).abs() < 1e-12, "{share}");
        let mut inland = WindField::new(&wind(), 1);
        inland.set_over_ground(true);
        assert_eq!(inland.share_of_land_after(1.0), 1.0, "a flight that begins over land has its turbulence at once");
    }

    #[test]
    fn exact_wind_from_north_moves_air_south_and_from_east_moves_it_west() {
        let mut w = wind();
        w.turbulence = 0.0;
        let at_reference = |w: &WindSpec| WindField::new(w, 1).mean_velocity(SimTime::ZERO, REFERENCE_HEIGHT_M);
        assert!((at_reference(&w) - Vec3::new(-4.917, 0.0, 0.0)).norm() < 1e-12);
        w.from_deg = 90.0;
        assert!((at_reference(&w) - Vec3::new(0.0, -4.917, 0.0)).norm() < 1e-12);
        w.up_m_s = 1.0;
        assert!((at_reference(&w).down() + 1.0).abs() < 1e-12);
    }

    #[test]
    fn exact_ground_slows_the_wind_only_below_the_reference_height() {
        let mut w = wind();
        w.turbulence = 0.0;
        let speed = |over_ground: bool, height_m: f64| {
            let mut field = WindField::new(&w, 1);
            field.set_over_ground(over_ground);
            field.mean_velocity(SimTime::ZERO, height_m).norm() / 4.917
        };
        // ln(1/0.03)/ln(6.096/0.03), calculated independently. The two profiles are equal at 20 ft.
        assert!((speed(true, 1.0) - 0.6598).abs() < 1e-3, "{}", speed(true, 1.0));
        assert!((speed(true, REFERENCE_HEIGHT_M) - 1.0).abs() < 1e-12);
        assert_eq!(speed(true, 20.0), speed(false, 20.0));
    }

    #[test]
    fn exact_drift_is_the_integral_of_the_wind_with_its_changes_and_gusts() {
        // Gauss points in eight intervals: rounding errors for linear changes, and less for a whole period of a cosine.
        const TOLERANCE_M: f64 = 1e-6;
        let mut w = wind();
        w.speed_m_s = 2.0;
        assert!((drift_m(&w, SimTime::from_s(100.0)) - Vec3::new(-200.0, 0.0, 0.0)).norm() < TOLERANCE_M);
        assert_eq!(drift_m(&w, SimTime::from_s(-5.0)), Vec3::zero());
        w.events = vec![
            WindEvent::Change { at: SimTime::from_s(10.0), over: SimTime::from_s(20.0), speed_m_s: 6.0, from_deg: 0.0 },
            WindEvent::Gust { at: SimTime::from_s(40.0), duration: SimTime::from_s(4.0), peak_speed_m_s: 5.0, from_deg: 270.0 },
            WindEvent::Change { at: SimTime::from_s(50.0), over: SimTime::ZERO, speed_m_s: 3.0, from_deg: 90.0 },
        ];
        // South: 10 s at 2 m/s, 20 s at 4 m/s on average, 20 s at 6 m/s. East: half the peak times the duration, minus 10 s at 3 m/s.
        let expected = Vec3::new(-220.0, 10.0 - 30.0, 0.0);
        assert!((drift_m(&w, SimTime::from_s(60.0)) - expected).norm() < TOLERANCE_M, "{:?}", drift_m(&w, SimTime::from_s(60.0)));
        // The displacement has no jumps.
        let before = drift_m(&w, SimTime::from_s(49.999));
        assert!((drift_m(&w, SimTime::from_s(50.001)) - before).norm() < 0.02);
    }

    #[test]
    fn exact_gust_displaces_air_by_half_its_peak_times_its_duration() {
        let mut w = wind();
        w.speed_m_s = 0.0;
        w.events = vec![WindEvent::Gust {
            at: SimTime::from_s(2.0),
            duration: SimTime::from_s(4.0),
            peak_speed_m_s: 6.0,
            from_deg: 180.0,
        }];
        let field = WindField::new(&w, 1);
        // The trapezoidal rule is exact for a whole period of a cosine, so only rounding errors remain.
        let dt_s = 0.01;
        let traveled: f64 = (0..1000).map(|k| field.mean_velocity(SimTime::from_ms(10 * k), 6.0).north() * dt_s).sum();
        assert!((traveled - 12.0).abs() < 1e-9, "{traveled}");
        assert!((field.mean_velocity(SimTime::from_s(4.0), 6.0).north() - 6.0).abs() < 1e-12);
        assert_eq!(field.mean_velocity(SimTime::from_s(6.5), 6.0).norm(), 0.0);
    }

    #[test]
    fn exact_wind_changes_linearly_and_turns_the_shorter_way() {
        let mut w = wind();
        w.from_deg = 350.0;
        w.events =
            vec![WindEvent::Change { at: SimTime::from_s(10.0), over: SimTime::from_s(20.0), speed_m_s: 8.917, from_deg: 10.0 }];
        let half = mean_at(&w, SimTime::from_s(20.0));
        assert!((half.speed_m_s - 6.917).abs() < 1e-12);
        assert!(math::wrap_pi(half.from_rad).abs() < 1e-12);
        assert!((mean_at(&w, SimTime::from_s(99.0)).speed_m_s - 8.917).abs() < 1e-12);
        assert_eq!(mean_at(&w, SimTime::from_s(9.0)).speed_m_s, 4.917);
    }

    #[test]
    fn prop_wind_and_its_clones_are_bit_identical_for_a_seed() {
        let run = |seed: u64| {
            let mut field = WindField::new(&wind(), seed);
            let mut copy = None;
            for k in 0..5000 {
                field.update(SimTime::from_ms(k), 12.0, Vec3::new(1.0, 2.0, 0.0));
                if k == 2500 {
                    copy = Some(field.clone());
                }
            }
            let mut copy = copy.expect("taken at 2500");
            copy.update(SimTime::from_ms(4999), 12.0, Vec3::new(1.0, 2.0, 0.0));
            assert_eq!(copy.air_velocity(SimTime::from_ms(4999)), field.air_velocity(SimTime::from_ms(4999)));
            field.air_velocity(SimTime::from_ms(4999))
        };
        assert_eq!(run(5), run(5));
        assert_ne!(run(5), run(6));
    }

    #[test]
    fn prop_air_velocity_is_continuous() {
        // Within one millisecond, the air velocity changes by at most a tenth of the step between two samples.
        let mut field = WindField::new(&wind(), 3);
        let (mut last, mut last_jump) = (None, 0.0_f64);
        for k in 0..20_000 {
            let now = SimTime::from_ms(k);
            field.update(now, 5.0, Vec3::zero());
            let air = field.air_velocity(now);
            let jump = (field.current_velocity_m_s - field.previous_velocity_m_s).norm();
            let bound = 0.1 * jump.max(last_jump) + 1e-12;
            assert!(last.is_none_or(|l: Vec3<Ned>| (air - l).norm() <= bound), "at {now}");
            (last, last_jump) = (Some(air), jump);
        }
    }

    #[test]
    fn exact_paper_model_is_a_force_in_still_air() {
        let mut w = wind();
        w.model = WindModel::Paper;
        let mut field = WindField::new(&w, 1);
        field.update(SimTime::from_s(1.0), 5.0, Vec3::zero());
        assert_eq!(field.air_velocity(SimTime::from_s(1.0)), Vec3::zero());
        assert!((field.paper_force_n() - Vec3::new(-3.0, 0.0, 0.0)).norm() < 1e-12);
        w.model = WindModel::Physical;
        assert_eq!(WindField::new(&w, 1).paper_force_n(), Vec3::zero());
    }
}
