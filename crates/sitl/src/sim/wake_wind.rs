//! Wind that the wakes of piers and towers add, at the center of the aircraft and at each rotor.

use crate::physics::{MAX_ROTORS, RigidState};
use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::scenario::bridges::Member;
use spandrel_model::scenario::{Scenario, WindModel};
use spandrel_model::site::wakes::WakeField;
use spandrel_model::site::wind::SAMPLE_PERIOD;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Rotor;

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

/// The wakes of a site, sampled as the wind is, with linear interpolation between samples.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WakeWind {
    field: WakeField,
    hubs: Vec<Vec3<Frd>>,
    sampled_at: SimTime,
    previous: AddedWind,
    current: AddedWind,
}

impl WakeWind {
    /// Returns `None` if the job has no wakes.
    pub(super) fn of(scenario: &Scenario, members: &[Member], rotors: &[Rotor], seed: u64) -> Option<Self> {
        let is_on = scenario.hazards.wakes && scenario.wind.model == WindModel::Physical;
        is_on.then(|| Self {
            field: WakeField::new(members, seed),
            hubs: rotors.iter().map(|rotor| rotor.position_m).collect(),
            sampled_at: SimTime::ZERO,
            previous: AddedWind::NONE,
            current: AddedWind::NONE,
        })
    }

    /// Draws the next sample, in a mean wind.
    pub(super) fn sample(&mut self, rigid: &RigidState, mean_m_s: Vec3<Ned>, now: SimTime) {
        self.field.advance(mean_m_s, SAMPLE_PERIOD);
        let center_m_s = self.field.velocity(rigid.position_m.enu(), mean_m_s);
        let mut rotors_m_s = [Vec3::zero(); MAX_ROTORS];
        for (rotor, hub) in rotors_m_s.iter_mut().zip(&self.hubs) {
            let position_m = rigid.position_m + rigid.attitude * *hub;
            *rotor = self.field.velocity(position_m.enu(), mean_m_s) - center_m_s;
        }
        self.previous = self.current;
        self.current = AddedWind { center_m_s, rotors_m_s };
        self.sampled_at = now;
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
    use spandrel_model::frames::{Enu, Rotation};
    use spandrel_model::scenario::Bridge;

    const JOB: &str = include_str!("../../../../scenarios/two-bridges.toml");
    /// Wind toward the east, m/s.
    const WIND_M_S: f64 = 6.0;

    /// Returns the wakes of the shipped job's suspension bridge, and a point on the wind's shadow edge behind its first pier.
    fn behind_a_pier(hazards: &str) -> (Option<WakeWind>, Vec3<Enu>) {
        wakes_of(&format!("{JOB}\n[hazards]\n{hazards}\n"))
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
        wakes.sample(&rigid, wind, SimTime::from_ms(10));
        wakes.sample(&rigid, wind, SimTime::from_ms(20));
        let added = wakes.at(SimTime::from_ms(30));
        for (rotor, hub) in added.rotors_m_s.iter().zip(&wakes.hubs) {
            let there = wakes.field.velocity((rigid.position_m + rigid.attitude * *hub).enu(), wind);
            assert!((added.center_m_s + *rotor - there).norm() < 1e-12, "{rotor:?}");
        }
        // The rotors toward the wake's axis, in the south, have less wind than those in the north.
        let east = added.rotors_m_s.map(|rotor| rotor.east());
        let south = wakes.hubs.iter().zip(east).filter(|(hub, _)| hub.forward() < 0.0).map(|(_, east)| east).fold(0.0, f64::max);
        let north = wakes.hubs.iter().zip(east).filter(|(hub, _)| hub.forward() > 0.0).map(|(_, east)| east).fold(0.0, f64::min);
        assert!(south <= 0.0 && north >= 0.0 && added.center_m_s.east() < 0.0, "{added:?}");
    }

    #[test]
    fn exact_added_wind_changes_linearly_between_samples() {
        let (wakes, edge) = behind_a_pier("wakes = true");
        let mut wakes = wakes.unwrap();
        wakes.sample(&level_at(edge), Vec3::new(0.0, WIND_M_S, 0.0), SimTime::from_ms(10));
        let (half, whole) = (wakes.at(SimTime::from_ms(15)).center_m_s, wakes.at(SimTime::from_ms(20)).center_m_s);
        assert!((half * 2.0 - whole).norm() < 1e-12 && whole.norm() > 0.0, "{half:?} {whole:?}");
    }

    #[test]
    fn regress_jobs_without_wakes_have_none() {
        assert_eq!(behind_a_pier("").0, None);
        assert_eq!(behind_a_pier("wakes = false").0, None);
        let paper = JOB.replace("model = \"physical\"", "model = \"paper\"");
        assert_eq!(wakes_of(&format!("{paper}\n[hazards]\nwakes = true\n")).0, None);
    }
}
