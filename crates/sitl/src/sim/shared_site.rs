//! Several vehicles at one site: start places, and what they see of each other and do to each other after each tick.

use super::{STEP, Sim};
use crate::physics::pair_contact::{PairMember, may_touch, resolve_pair};
use crate::physics::{ContactReport, more_severe_surface};
use crate::sensors::{SensorSite, Sensors};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::aircraft_hull::{hull_radius_m, probes};
use spandrel_model::site::drones::{LiveDrone, live_drone_number, live_drone_object};
use spandrel_model::site::{ObjectId, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use std::sync::Arc;

/// Gap between the hulls of aircraft that stand side by side, m (estimate: a person can walk between them).
pub const START_GAP_M: f64 = 1.0;
/// Maximum height of a start place above or below the landing pad, m (estimate: level ground around a pad).
const MAX_START_STEP_M: f64 = 0.3;
/// Places on each side of the pad that are tried.
const MAX_START_ROWS: i32 = 4;

/// Returns the places on the ground where aircraft of one type start, m: the first one in the middle of the landing pad, the others
/// on level ground around it, within the home radius. Neighbors' hulls are [`START_GAP_M`] apart. `None` if there is not enough room.
#[must_use]
pub fn start_places(scenario: &Scenario, site: &Site, vehicle: &Vehicle, count: usize) -> Option<Vec<Vec3<Enu>>> {
    let radius_m = hull_radius_m(&probes(vehicle));
    let (pad_m, spacing_m) = (scenario.ground_team.pad_m, 2.0 * radius_m + START_GAP_M);
    let rows = -MAX_START_ROWS..=MAX_START_ROWS;
    let mut cells: Vec<(i32, i32)> = rows.clone().flat_map(|i| rows.clone().map(move |j| (i, j))).collect();
    let is_home =
        |(i, j): &(i32, i32)| spacing_m * math::hypot(f64::from(*i), f64::from(*j)) <= scenario.ground_team.home_radius_m;
    cells.retain(is_home);
    cells.sort_by_key(|(i, j)| (i * i + j * j, *j, *i));
    let place = |(i, j): (i32, i32)| {
        let (east, north) = (pad_m.east() + spacing_m * f64::from(i), pad_m.north() + spacing_m * f64::from(j));
        Vec3::new(east, north, site.ground_up_m(east, north))
    };
    let is_free = |at: &Vec3<Enu>| {
        // A sphere above the ground that people, the truck and members must not enter.
        let reach_m = radius_m + START_GAP_M;
        let free = site.nearest(*at + Vec3::new(0.0, 0.0, reach_m + MAX_START_STEP_M), reach_m, SimTime::ZERO).is_none();
        free && (at.up() - pad_m.up()).abs() <= MAX_START_STEP_M && site.water_up_m(at.east(), at.north()).is_none()
    };
    let mut places = vec![pad_m];
    places.extend(cells.into_iter().skip(1).map(place).filter(is_free).take(count.saturating_sub(1)));
    (places.len() == count).then_some(places)
}

/// Exchanges positions, and resolves contacts between vehicles. Call it after each tick of all vehicles.
pub fn exchange(sims: &mut [&mut Sim]) {
    for sim in sims.iter_mut() {
        sim.drone_contact = ContactReport::default();
    }
    for second in 1..sims.len() {
        let (before, after) = sims.split_at_mut(second);
        for first in before {
            first.collide_with(after[0]);
        }
    }
    let drones: Vec<LiveDrone> = sims.iter().map(|sim| sim.live_drone()).collect();
    for (k, sim) in sims.iter_mut().enumerate() {
        let others = drones.iter().enumerate().filter(|(other, _)| *other != k).map(|(_, drone)| drone.clone());
        let others: Vec<LiveDrone> = others.collect();
        Arc::make_mut(&mut sim.site).set_live_drones(others);
    }
}

impl Sim {
    /// Makes this vehicle one of several at the site: it stands at a place on the ground, and its sensors, radio and failures have
    /// their own random numbers. Call it before the first tick. The vehicle with number 0 keeps the random numbers that it has alone.
    pub fn share_site(&mut self, place_m: Vec3<Enu>) {
        let start = self.state.rigid.position_m + (place_m - self.config.scenario.ground_team.pad_m).ned();
        let yaw = self.state.rigid.attitude.yaw_rad();
        self.state.place(start, yaw);
        self.last_safe_hover = (start, yaw);
        self.start_height_m = -start.down();
        if self.config.instance > 0 {
            self.draw_own_random_numbers();
        }
    }

    fn draw_own_random_numbers(&mut self) {
        // The high half of the seed is free: sessions have 31-bit seeds.
        let seed = self.config.seed ^ (u64::from(self.config.instance) << 32);
        let scenario = &self.config.scenario;
        self.sensors = Sensors::new(&self.config.vehicle, SensorSite::of(scenario, self.site.members()), seed);
        self.radio = super::radio::RadioLink::new(seed);
        self.faults = crate::faults::Faults::new(seed);
    }

    fn collide_with(&mut self, other: &mut Self) {
        let dt_s = STEP.s();
        let near = may_touch((&self.model, &self.state.rigid), (&other.model, &other.state.rigid), dt_s);
        if !near {
            return;
        }
        let objects = [&*self, &*other].map(|sim| live_drone_object(sim.config.instance));
        let mut own = PairMember { model: &self.model, state: &mut self.state, object: objects[0] };
        let mut far = PairMember { model: &other.model, state: &mut other.state, object: objects[1] };
        let [of_own, of_other] = resolve_pair(&mut own, &mut far, dt_s);
        self.drone_contact = combined(self.drone_contact, of_own);
        other.drone_contact = combined(other.drone_contact, of_other);
    }

    fn live_drone(&self) -> LiveDrone {
        let rigid = &self.state.rigid;
        LiveDrone {
            object: live_drone_object(self.config.instance),
            parts: Arc::clone(&self.model.probes),
            reach_m: self.model.hull_radius_m(),
            position_m: rigid.position_m.enu(),
            attitude: rigid.attitude,
            armed: self.armed(),
        }
    }

    /// Returns the contacts of the last step, with those with other vehicles.
    pub(super) fn all_contacts(&self) -> ContactReport {
        combined(self.state.contact, self.drone_contact)
    }

    /// Returns the name of an object in contact.
    pub(super) fn object_name(&self, object: ObjectId) -> String {
        live_drone_number(object)
            .map_or_else(|| self.site.object_name(object), |instance| format!("drone {}", u16::from(instance) + 1))
    }
}

/// Returns the report of two sets of contacts at the same time.
fn combined(a: ContactReport, b: ContactReport) -> ContactReport {
    let surface = match (a.surface, b.surface) {
        (Some(one), Some(other)) => Some(if more_severe_surface(one.0, other.0) == one.0 { one } else { other }),
        (one, other) => one.or(other),
    };
    let impact_m_s = a.impact_m_s.max(b.impact_m_s);
    ContactReport { surface, impact_m_s, normal_force_n: a.normal_force_n + b.normal_force_n }
}
