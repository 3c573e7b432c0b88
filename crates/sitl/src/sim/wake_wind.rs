//! Wind that the wakes of piers, towers and decks add, at the center of the aircraft and at each rotor.

use crate::physics::{MAX_ROTORS, RigidState};
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_model::scenario::bridges::Member;
use spandrel_model::site::wakes::{LocalAir, WakeField, WakeGusts};
use spandrel_model::site::wind::SAMPLE_PERIOD;
use spandrel_model::time::{Schedule, SimTime};
use spandrel_model::vehicle::Rotor;

/// Rate at which the strongest added wind is reported, Hz: that of the message.
const REPORT_RATE_HZ: f64 = 2.0;

/// Added velocities at one time, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AddedWind {
    /// At the center of mass.
    pub(super) center_m_s: Vec3<Ned>,
    /// At each rotor, in addition to the center's.
    pub(super) rotors_m_s: [Vec3<Ned>; MAX_ROTORS],
}

impl AddedWind {
    const NONE: Self = Self { center_m_s: Vec3::zero(), rotors_m_s: [Vec3::zero(); MAX_ROTORS] };
}

/// The largest velocity that wakes added at the center of the aircraft in each interval between two reports.
#[derive(Debug, Clone, PartialEq)]
struct StrongestWind {
    due: Schedule,
    present_m_s: Vec3<Ned>,
    last_m_s: Vec3<Ned>,
}

impl StrongestWind {
    fn new() -> Self {
        Self { due: Schedule::new(SimTime::ZERO, REPORT_RATE_HZ), present_m_s: Vec3::zero(), last_m_s: Vec3::zero() }
    }

    fn include(&mut self, added_m_s: Vec3<Ned>, now: SimTime) {
        if added_m_s.norm() > self.present_m_s.norm() {
            self.present_m_s = added_m_s;
        }
        if self.due.fire(now) {
            self.last_m_s = std::mem::replace(&mut self.present_m_s, Vec3::zero());
        }
    }
}

/// The wakes of a site, sampled as the wind is, with linear interpolation between samples.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WakeWind {
    field: WakeField,
    gusts: WakeGusts,
    hubs: Vec<Vec3<Frd>>,
    /// Largest distance of a hub from the center of mass, m.
    arm_m: f64,
    sampled_at: SimTime,
    previous: AddedWind,
    current: AddedWind,
    strongest: StrongestWind,
}

impl WakeWind {
    /// Returns `None` if the job has no wakes.
    pub(super) fn of(scenario: &Scenario, members: &[Member], rotors: &[Rotor], seed: u64) -> Option<Self> {
        scenario.has_wakes().then(|| Self {
            field: WakeField::new(members, &scenario.bridges, seed),
            gusts: WakeGusts::new(rotors.iter().map(|rotor| rotor.position_m.norm()).collect(), seed),
            hubs: rotors.iter().map(|rotor| rotor.position_m).collect(),
            arm_m: rotors.iter().map(|rotor| rotor.position_m.norm()).fold(0.0, f64::max),
            sampled_at: SimTime::ZERO,
            previous: AddedWind::NONE,
            current: AddedWind::NONE,
            strongest: StrongestWind::new(),
        })
    }

    /// Draws the next sample, in a mean wind, with the height of the water or ground below the aircraft.
    pub(super) fn sample(&mut self, rigid: &RigidState, mean_m_s: Vec3<Ned>, surface_up_m: f64, now: SimTime) {
        self.field.advance(mean_m_s, SAMPLE_PERIOD);
        let nearby = self.field.near(rigid.position_m.enu(), self.arm_m);
        let center = nearby.air(rigid.position_m.enu(), surface_up_m);
        let mut rotors = [LocalAir::default(); MAX_ROTORS];
        for (rotor, hub) in rotors.iter_mut().zip(&self.hubs) {
            *rotor = nearby.air((rigid.position_m + rigid.attitude * *hub).enu(), surface_up_m);
        }
        self.previous = self.current;
        self.current = self.added(&center, &rotors, rigid, mean_m_s);
        self.strongest.include(self.current.center_m_s, now);
        self.sampled_at = now;
    }

    /// Returns the largest velocity that wakes added at the center of mass in the last complete half second, m/s.
    pub(super) fn strongest_m_s(&self) -> Vec3<Ned> {
        self.strongest.last_m_s
    }

    /// Adds the gusts to the mean air at the center and the rotors.
    fn added(&mut self, center: &LocalAir, rotors: &[LocalAir], rigid: &RigidState, mean_m_s: Vec3<Ned>) -> AddedWind {
        // The gusts drift with the wind, so that a hovering aircraft also moves through them.
        let through_m_s = (rigid.velocity_m_s - mean_m_s - center.velocity_m_s).norm().max(mean_m_s.norm());
        let rotors = &rotors[..self.hubs.len()];
        let gusts = self.gusts.sample(center, rotors, through_m_s * SAMPLE_PERIOD.s());
        let (center_gust, rotor_gusts) = gusts.unwrap_or((Vec3::zero(), [Vec3::zero(); MAX_ROTORS]));
        let center_m_s = center.velocity_m_s + center_gust;
        let mut rotors_m_s = [Vec3::zero(); MAX_ROTORS];
        for ((added, rotor), gust) in rotors_m_s.iter_mut().zip(rotors).zip(rotor_gusts) {
            *added = rotor.velocity_m_s + gust - center_m_s;
        }
        AddedWind { center_m_s, rotors_m_s }
    }

    /// Returns the added wind at a time up to one sample after the last one.
    pub(super) fn at(&self, now: SimTime) -> AddedWind {
        let share = ((now - self.sampled_at).s() / SAMPLE_PERIOD.s()).clamp(0.0, 1.0);
        let mut rotors_m_s = [Vec3::zero(); MAX_ROTORS];
        for (rotor, (from, to)) in rotors_m_s.iter_mut().zip(self.previous.rotors_m_s.iter().zip(self.current.rotors_m_s)) {
            *rotor = from.lerp(to, share);
        }
        AddedWind { center_m_s: self.previous.center_m_s.lerp(self.current.center_m_s, share), rotors_m_s }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Vehicle;
    use spandrel_model::frames::{Enu, Rotation};
    use spandrel_model::scenario::Bridge;
    use spandrel_model::shipped;

    /// The job at the two bridges, without hazards.
    fn job() -> String {
        shipped::without_hazards(shipped::TWO_BRIDGES)
    }

    /// Wind toward the east, m/s.
    const WIND_M_S: f64 = 6.0;

    /// Returns the wakes of the shipped job's suspension bridge, and a point on the wind's shadow edge behind its first pier.
    fn behind_a_pier(hazards: &str) -> (Option<WakeWind>, Vec3<Enu>) {
        wakes_of(&format!("{}\n[hazards]\n{hazards}\n", job()))
    }

    fn wakes_of(text: &str) -> (Option<WakeWind>, Vec3<Enu>) {
        let job = spandrel_model::scenario::read("job.toml", text, &|file| Err(format!("no {file}"))).unwrap();
        let members: Vec<Member> = job.bridges.iter().flat_map(Bridge::members).collect();
        let pier = members.iter().find(|member| member.name.contains("pier-")).unwrap();
        let high = |value: fn(&Vec3<Enu>) -> f64| pier.solid.vertices_m.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
        let top_up_m = high(|corner| corner.up());
        let edge = Vec3::new(high(|corner| corner.east()) + 4.0, high(|corner| corner.north()), top_up_m - 3.0);
        let vehicle =
            spandrel_model::vehicle::read("phantom2.toml", include_str!("../../../../vehicle-params/phantom2.toml")).unwrap();
        (WakeWind::of(&job, &members, &vehicle.rotors, 1), edge)
    }

    fn level_at(position_m: Vec3<Enu>) -> RigidState {
        RigidState {
            position_m: position_m.ned(),
            velocity_m_s: Vec3::zero(),
            attitude: Rotation::identity(),
            rates_rad_s: Vec3::zero(),
            rotor_rad_s: [0.0; MAX_ROTORS],
        }
    }

    #[test]
    fn exact_rotors_at_the_edge_of_a_wake_feel_different_winds() {
        let (wakes, edge) = behind_a_pier("wakes = true");
        let (mut wakes, rigid, wind) = (wakes.unwrap(), level_at(edge), Vec3::new(0.0, WIND_M_S, 0.0));
        wakes.sample(&rigid, wind, 0.0, SimTime::from_ms(10));
        let added = wakes.at(SimTime::from_ms(20));
        let mean = |hub: Vec3<Frd>| wakes.field.air((rigid.position_m + rigid.attitude * hub).enu(), 0.0);
        let center = mean(Vec3::zero());
        assert!(center.turbulence_m_s > 0.0, "{center:?}");
        for (rotor, hub) in added.rotors_m_s.iter().zip(&wakes.hubs) {
            // Beyond the mean, only the gusts: within five standard deviations of both.
            let gust = (added.center_m_s + *rotor - mean(*hub).velocity_m_s).norm();
            assert!(gust > 0.0 && gust < 5.0 * mean(*hub).turbulence_m_s.max(center.turbulence_m_s) * 3f64.sqrt(), "{gust}");
        }
        // The rotors toward the wake's axis, in the south, have on average less wind than those in the north.
        let east = wakes.hubs.iter().map(|hub| (mean(*hub).velocity_m_s - center.velocity_m_s).east()).collect::<Vec<_>>();
        let south =
            wakes.hubs.iter().zip(&east).filter(|(hub, _)| hub.forward() < 0.0).map(|(_, east)| *east).fold(0.0, f64::max);
        let north =
            wakes.hubs.iter().zip(&east).filter(|(hub, _)| hub.forward() > 0.0).map(|(_, east)| *east).fold(0.0, f64::min);
        assert!(south <= 0.0 && north >= 0.0 && added.center_m_s.east() < 0.0, "{added:?}");
    }

    #[test]
    fn exact_added_wind_changes_linearly_between_samples() {
        let (wakes, edge) = behind_a_pier("wakes = true");
        let mut wakes = wakes.unwrap();
        wakes.sample(&level_at(edge), Vec3::new(0.0, WIND_M_S, 0.0), 0.0, SimTime::from_ms(10));
        let (half, whole) = (wakes.at(SimTime::from_ms(15)).center_m_s, wakes.at(SimTime::from_ms(20)).center_m_s);
        assert!((half * 2.0 - whole).norm() < 1e-12 && whole.norm() > 0.0, "{half:?} {whole:?}");
    }

    #[test]
    fn exact_strongest_wind_is_that_of_the_last_complete_half_second() {
        let (wakes, edge) = behind_a_pier("wakes = true");
        let mut wakes = wakes.unwrap();
        let mut strongest = vec![Vec3::<Ned>::zero()];
        for k in 0..200_i64 {
            wakes.sample(&level_at(edge), Vec3::new(0.0, WIND_M_S, 0.0), 0.0, SimTime::from_ms(10 * k));
            let added = wakes.current.center_m_s;
            let last = strongest.last_mut().unwrap();
            if added.norm() > last.norm() {
                *last = added;
            }
            if k % 50 == 0 {
                strongest.push(Vec3::zero());
            }
            assert_eq!(wakes.strongest_m_s(), strongest[strongest.len() - 2], "{k}");
        }
        assert!(strongest.len() == 5 && strongest[..4].iter().all(|added| added.norm() > 0.0), "{strongest:?}");
    }

    #[test]
    fn flight_aircraft_beside_a_pier_feels_the_wake_at_its_center_and_rotors() {
        let with = |hazards: &str| {
            let text = format!("{}\n[hazards]\n{hazards}\n", job()).replace("level = \"light\"", "level = \"gentle\"");
            let mut sim = Vehicle::builder().scenario(text).build().unwrap().sim;
            // The job's wind comes from the southwest, and so its wakes are northeast of the piers.
            let edge = wakes_of(&job()).1 + Vec3::new(1.0, 2.0, 0.0);
            sim.state.rigid.position_m = edge.ned();
            for ms in 0..100 {
                sim.step_wind(SimTime::from_ms(ms));
            }
            sim
        };
        let (calm, swept) = (with("wakes = false"), with("wakes = true"));
        let added = swept.wakes.as_ref().unwrap().at(SimTime::from_ms(99));
        assert!(added.center_m_s.norm() > 0.1, "{added:?}");
        assert_eq!(swept.air.velocity_m_s, calm.air.velocity_m_s + added.center_m_s);
        assert_eq!((calm.air.rotors_m_s, swept.air.rotors_m_s), (None, Some(added.rotors_m_s)));
    }

    /// Flights at the lee of the girder bridge's deck, in a steady wind across it.
    mod fascia {
        use super::super::super::controller::Controller;
        use super::*;

        const GIRDER: &str = include_str!("../../../../scenarios/girder.toml");
        /// Distance behind the leeward fascia, and heights of its middle and of the hold above it, m.
        const BEHIND_M: f64 = 5.0;
        const UP_M: (f64, f64) = (17.5, 24.5);
        /// Time to settle, and measured time, s.
        const SETTLING_S: f64 = 8.0;
        const MEASURED_S: f64 = 8.0;

        /// Mean tilt in the wake and above it, and the largest drift downwind while rising from one to the other.
        #[derive(Debug, Clone, Copy, PartialEq)]
        struct Crossing {
            lee_tilt_rad: f64,
            free_tilt_rad: f64,
            drift_m: f64,
        }

        /// Puts a flying aircraft at rest at another place.
        fn place(vehicle: &mut Vehicle, position_m: Vec3<Enu>) {
            let sim = &mut vehicle.sim;
            let from_m = sim.state.rigid.position_m;
            sim.place_at_rest(position_m.ned(), 0.0, sim.model.hover_rotor_rad_s());
            let (pose, now) = (sim.pose(), sim.now);
            if let Controller::Builtin(own) = &mut sim.controller {
                own.autopilot.continue_at(from_m, &pose, now);
            }
        }

        /// Returns the mean tilt into the wind while the aircraft holds its place, rad. The wind blows toward the north, and the aircraft
        /// faces it from behind: leaning into it raises the nose.
        fn mean_tilt_rad(vehicle: &mut Vehicle) -> f64 {
            vehicle.run(SimTime::from_s(SETTLING_S));
            let samples = (MEASURED_S / 0.02) as i32;
            let mut sum = 0.0;
            for _ in 0..samples {
                vehicle.run(SimTime::from_ms(20));
                sum += vehicle.sim.state.rigid.attitude.euler().1;
            }
            sum / f64::from(samples)
        }

        /// Rises past the leeward fascia.
        fn cross(wakes: bool) -> Crossing {
            let steady = GIRDER.replace("from_deg = 250.0\nturbulence = 0.8", "from_deg = 180.0\nturbulence = 0.0");
            let windy = steady.replace("level = \"light\"", "level = \"gentle\"");
            let job = windy.replace("wakes = true", &format!("wakes = {wakes}"));
            assert!(job.contains("turbulence = 0.0") && job.contains("gentle"), "the shipped job has changed");
            let mut vehicle = Vehicle::builder().scenario(job).build().unwrap();
            vehicle.arm(SimTime::from_s(30.0)).unwrap();
            vehicle.take_off(5.0).unwrap();
            vehicle.run_until(|v| v.height_m() > 4.5, SimTime::from_s(20.0)).unwrap();
            let bridge = &vehicle.sim.config.scenario.bridges[0];
            let north_m = bridge.center_m.north() + 0.5 * bridge.deck_width_m() + BEHIND_M;
            let at = |up_m: f64| Vec3::<Enu>::new(bridge.center_m.east(), north_m, up_m);
            let (low, high) = (at(UP_M.0), at(UP_M.1));
            place(&mut vehicle, low);
            vehicle.go_to(low).unwrap();
            let lee_tilt_rad = mean_tilt_rad(&mut vehicle);
            let held_north_m = vehicle.position_m().north();
            vehicle.go_to(high).unwrap();
            let mut drift_m = 0.0_f64;
            while vehicle.position_m().up() < high.up() - 1.0 {
                vehicle.run(SimTime::from_ms(20));
                drift_m = drift_m.max(vehicle.position_m().north() - held_north_m);
            }
            Crossing { lee_tilt_rad, free_tilt_rad: mean_tilt_rad(&mut vehicle), drift_m }
        }

        #[test]
        fn flight_drone_that_rises_past_the_leeward_fascia_meets_the_wind_at_once() {
            let (without, with) = (cross(false), cross(true));
            println!("without {without:?}, with {with:?}");
            // Without wakes the wind is the same everywhere: the tilts differ by the wind profile and the noise of the hold.
            assert!((without.lee_tilt_rad / without.free_tilt_rad - 1.0).abs() < 0.25, "{without:?}");
            // In the lee, less than half of the wind's drag is left; above the wake, all of it.
            assert!(with.lee_tilt_rad.abs() < 0.5 * without.lee_tilt_rad.abs(), "{with:?} {without:?}");
            assert!((with.free_tilt_rad / without.free_tilt_rad - 1.0).abs() < 0.25, "{with:?} {without:?}");
            // The edge pushes the aircraft downwind, before the autopilot leans into the wind.
            assert!(with.drift_m > without.drift_m + 0.1, "{with:?} {without:?}");
        }
    }

    #[test]
    fn regress_jobs_without_wakes_have_none() {
        assert_eq!(behind_a_pier("").0, None);
        assert_eq!(behind_a_pier("wakes = false").0, None);
        let paper = job().replace("model = \"physical\"", "model = \"paper\"");
        assert_eq!(wakes_of(&format!("{paper}\n[hazards]\nwakes = true\n")).0, None);
    }
}
