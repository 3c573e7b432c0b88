//! The mean air around a job's bridges: what an aircraft would feel on average at a place, without the turbulence and the gusts of the wind.

use super::Site;
use super::wakes::WakeField;
use super::wind::{MeanWind, WindField, mean_at};
use crate::frames::{Enu, Vec3};
use crate::scenario::{Scenario, WindEvent, WindSpec};
use crate::time::SimTime;

/// Height above the surface below which the wind does not change, m: that of an aircraft on the ground.
pub const MIN_AIR_HEIGHT_M: f64 = 0.3;
/// Mean wind at 20 ft below which there is nothing to show, m/s (estimate: an aircraft's own downwash is much faster).
const MIN_WIND_M_S: f64 = 0.5;

/// Mean air at a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirSample {
    /// Velocity of the wind without the bridges, m/s.
    pub free_m_s: Vec3<Enu>,
    /// Velocity of the air, m/s.
    pub velocity_m_s: Vec3<Enu>,
    /// Standard deviation of the turbulence that the bridges add in each direction, m/s.
    pub turbulence_m_s: f64,
}

/// The mean air around a job's bridges at one time.
#[derive(Debug, Clone)]
pub struct MeanAir<'a> {
    site: &'a Site,
    water_up_m: f64,
    wind: WindField,
    wakes: WakeField,
    mean: MeanWind,
    at: SimTime,
}

impl<'a> MeanAir<'a> {
    /// Returns the air of a job at a time; `None` if its bridges don't disturb the wind, or without wind.
    #[must_use]
    pub fn at(scenario: &Scenario, site: &'a Site, at: SimTime) -> Option<Self> {
        /// The mean wind does not depend on the seed.
        const ANY_SEED: u64 = 0;
        let mean = mean_at(&scenario.wind, at);
        let is_disturbed = scenario.has_wakes() && !scenario.bridges.is_empty() && mean.speed_m_s >= MIN_WIND_M_S;
        is_disturbed.then(|| Self {
            site,
            water_up_m: scenario.terrain.water_level_m,
            wind: WindField::new(&without_gusts(&scenario.wind), ANY_SEED),
            wakes: WakeField::averaged(site.members(), &scenario.bridges),
            mean,
            at,
        })
    }

    /// Returns the mean wind at 20 ft above the water.
    #[must_use]
    pub fn wind(&self) -> MeanWind {
        self.mean
    }

    /// Returns the height of the water, ground or pad below a position, m above the origin.
    #[must_use]
    pub fn surface_up_m(&self, position_m: Vec3<Enu>) -> f64 {
        self.site.ground_up_m(position_m.east(), position_m.north()).max(self.water_up_m)
    }

    /// Returns the air at a position. As in a flight, the wind around the bridges is that at the height of the position.
    pub fn sample(&mut self, position_m: Vec3<Enu>) -> AirSample {
        let surface_up_m = self.surface_up_m(position_m);
        self.wind.set_over_ground(surface_up_m > self.water_up_m);
        let free = self.wind.mean_velocity(self.at, (position_m.up() - surface_up_m).max(MIN_AIR_HEIGHT_M));
        self.wakes.advance(free, SimTime::ZERO);
        let air = self.wakes.air(position_m, surface_up_m);
        AirSample { free_m_s: free.enu(), velocity_m_s: (free + air.velocity_m_s).enu(), turbulence_m_s: air.turbulence_m_s }
    }
}

/// Returns a wind without its gusts, which last only seconds.
fn without_gusts(wind: &WindSpec) -> WindSpec {
    let is_change = |event: &WindEvent| match event {
        WindEvent::Change { .. } => true,
        WindEvent::Gust { .. } => false,
    };
    WindSpec { events: wind.events.iter().filter(|event| is_change(event)).cloned().collect(), ..wind.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{WindModel, read};
    use crate::shipped::TWO_BRIDGES;

    fn job() -> Scenario {
        let mut job = read("two-bridges.toml", TWO_BRIDGES, &|_| Err("none".into())).unwrap();
        (job.hazards.wakes, job.wind.speed_m_s, job.wind.from_deg) = (true, 6.0, 200.0);
        job
    }

    #[test]
    fn exact_mean_air_is_the_wind_of_the_flight_with_the_averaged_wakes() {
        let mut job = job();
        let at = SimTime::from_s(30.0);
        let gust =
            WindEvent::Gust { at: SimTime::from_s(29.0), duration: SimTime::from_s(2.0), peak_speed_m_s: 9.0, from_deg: 0.0 };
        job.wind.events = vec![gust];
        let site = Site::without_defects(&job);
        let mut air = MeanAir::at(&job, &site, at).unwrap();
        let calm = WindSpec { events: Vec::new(), ..job.wind.clone() };
        let mut wakes = WakeField::averaged(site.members(), &job.bridges);
        let (bridge, mut disturbed) = (&job.bridges[0], 0);
        for k in 0..60 {
            let place = bridge.placement().point([f64::from(k) - 30.0, 8.0, -3.0]);
            let (surface_up_m, found) = (air.surface_up_m(place), air.sample(place));
            let mut wind = WindField::new(&calm, 7);
            wind.set_over_ground(surface_up_m > job.terrain.water_level_m);
            let free = wind.mean_velocity(at, (place.up() - surface_up_m).max(MIN_AIR_HEIGHT_M));
            wakes.advance(free, SimTime::ZERO);
            let expected = wakes.air(place, surface_up_m);
            assert_eq!(found.free_m_s, free.enu());
            assert_eq!(
                (found.velocity_m_s, found.turbulence_m_s),
                ((free + expected.velocity_m_s).enu(), expected.turbulence_m_s)
            );
            disturbed += usize::from(found.velocity_m_s != found.free_m_s);
        }
        assert!(disturbed > 30, "{disturbed}");
    }

    #[test]
    fn exact_there_is_no_disturbed_air_without_wind_wakes_or_bridges() {
        let changes: [fn(&mut Scenario); 4] = [
            |job| job.wind.speed_m_s = 0.0,
            |job| job.hazards.wakes = false,
            |job| job.wind.model = WindModel::Paper,
            |job| job.bridges.clear(),
        ];
        let site = Site::without_defects(&job());
        assert!(MeanAir::at(&job(), &site, SimTime::ZERO).is_some());
        for change in changes {
            let mut job = job();
            change(&mut job);
            assert!(MeanAir::at(&job, &site, SimTime::ZERO).is_none());
        }
    }
}
