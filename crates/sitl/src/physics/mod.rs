//! Rigid body, rotors, surface effects, drag, battery and contact. State is plain data; models are functions.

mod airframe;
pub mod battery;
pub mod contact;
pub mod inflow;
mod multirotor_surfaces;
mod obstacles;
pub mod pair_contact;
mod recirculation;
pub mod rigid;
mod rotor_lanes;
mod state;
pub mod surface_effects;
pub mod vortex_ring;
pub mod walls;

pub use airframe::AirframeModel;
pub use obstacles::{MAX_OBJECT_SPEED_M_S, Obstacles, OpenSky, Touched, more_severe_surface};
pub use rigid::RotorConditions;
pub use state::{Actuators, AirState, BatteryState, ContactReport, MAX_ROTORS, PhysicsState, PowerLoad, RigidState, WarmStart};

use nalgebra::Vector2;
use spandrel_model::frames::{Enu, Ned, Vec3};
use spandrel_model::math;
use spandrel_model::time::SimTime;
use state::ClearSphere;
use std::borrow::Cow;
use vortex_ring::VortexRing;
use walls::WallEffect;

/// Search radius for clearance, m.
const CLEARANCE_REACH_M: f64 = 4.0;
/// Update interval of surface effects, s.
const SURFACE_EFFECT_INTERVAL_S: f64 = 0.02;

impl AirframeModel {
    /// Runs one physics step that starts at `now`.
    #[allow(clippy::too_many_arguments, reason = "each input of the step has a different type")]
    pub fn advance(
        &self,
        state: &mut PhysicsState,
        actuators: &Actuators,
        air: &AirState,
        obstacles: &impl Obstacles,
        load: PowerLoad,
        now: SimTime,
        dt: SimTime,
    ) {
        let dt_s = dt.s();
        let target_rotor_speeds = self.target_rotor_speeds(actuators, &state.battery);
        let position = state.rigid.position_m.enu();
        self.refresh_clearance(state, obstacles, position, now);
        self.refresh_effects(state, air, obstacles, now);
        let start = state.rigid;
        let before = start.velocity_m_s;
        let air_here = self.beside_walls(air, state);
        rigid::advance(self, &mut state.rigid, &target_rotor_speeds, &air_here, &state.effect, dt_s);
        let reach =
            self.hull_radius_m + state.rigid.velocity_m_s.norm().max(before.norm()) * dt_s + contact::CONTACT_SEARCH_MARGIN_M;
        if state.clear_sphere.remaining_radius_m(state.rigid.position_m.enu(), now + dt) <= reach {
            contact::resolve(self, state, &start, obstacles, now + dt, dt_s);
        } else if state.contact.touching() {
            state.contact = ContactReport::default();
            state.initial_guess = WarmStart::default();
        }
        let gravity = Vec3::<Ned>::new(0.0, 0.0, math::GRAVITY_M_S2 * self.gravity_scale);
        let mut change_m_s = state.rigid.velocity_m_s - before;
        let pushed_m_s = std::mem::replace(&mut state.pushed_m_s, Vec3::zero());
        if pushed_m_s != Vec3::zero() {
            change_m_s += pushed_m_s;
        }
        let felt = change_m_s / dt_s - gravity;
        state.specific_force_m_s2 = state.rigid.attitude.inverse() * felt;
        battery::advance(self, state, air, load, dt_s);
    }

    fn refresh_clearance(&self, state: &mut PhysicsState, obstacles: &impl Obstacles, position_m: Vec3<Enu>, now: SimTime) {
        let speed = state.rigid.velocity_m_s.norm();
        let need = self.hull_radius_m.max(surface_effects::reach_m(self)) + 0.05 + 0.002 * speed;
        if state.clear_sphere.remaining_radius_m(position_m, now) > need {
            return;
        }
        let radius_m = obstacles.clearance(position_m, CLEARANCE_REACH_M, now).unwrap_or(CLEARANCE_REACH_M);
        state.clear_sphere = ClearSphere { center_m: position_m, radius_m, since: now };
    }

    fn refresh_effects(&self, state: &mut PhysicsState, air: &AirState, obstacles: &impl Obstacles, now: SimTime) {
        if now < state.effect_due {
            return;
        }
        state.effect_due = now + SimTime::from_s(SURFACE_EFFECT_INTERVAL_S);
        state.wall_pull = Vec3::zero();
        state.effect = self.surface_factors(state, obstacles, now);
        if let Some(ring) = &self.vortex_ring {
            self.apply_vortex_ring(ring, state, air, now);
        }
    }

    /// Returns the air with the force of walls beside the aircraft.
    fn beside_walls<'a>(&self, air: &'a AirState, state: &PhysicsState) -> Cow<'a, AirState> {
        if state.wall_pull == Vec3::zero() {
            return Cow::Borrowed(air);
        }
        let squares: f64 = state.rigid.rotor_rad_s.iter().map(|speed| speed * speed).sum();
        let thrust_n = self.rotor.thrust_coefficient_n_s2 * squares * air.density_ratio();
        Cow::Owned(AirState { force_n: air.force_n + state.wall_pull * thrust_n, ..*air })
    }

    fn surface_factors(&self, state: &mut PhysicsState, obstacles: &impl Obstacles, now: SimTime) -> [f64; MAX_ROTORS] {
        let reach = surface_effects::reach_m(self);
        let spinning = state.rigid.rotor_rad_s[0] > 0.0;
        let free_m = state.clear_sphere.remaining_radius_m(state.rigid.position_m.enu(), now);
        if !spinning || free_m > reach + self.hull_radius_m {
            return [1.0; MAX_ROTORS];
        }
        let found = surface_effects::distances(self, &state.rigid, obstacles, now);
        let mut factors = surface_effects::factors(self, &found);
        if let Some(walls) = self.walls.as_ref().filter(|walls| free_m <= walls.reach_m()) {
            let WallEffect { pull, factors: beside } = walls.effect(&state.rigid, found.nearest_m(), obstacles, now);
            state.wall_pull = pull;
            factors.iter_mut().zip(beside).for_each(|(factor, other)| *factor *= other);
        }
        factors
    }

    fn apply_vortex_ring(&self, ring: &VortexRing, state: &mut PhysicsState, air: &AirState, now: SimTime) {
        for (i, rotor) in self.rotors.iter().enumerate() {
            let hub = rigid::hub_air_velocity(&state.rigid, air, i, rotor.position_m);
            let edgewise_m_s = Vector2::new(hub.forward(), hub.right());
            state.effect[i] *= ring.factor(i, hub.down(), edgewise_m_s, air.density_kg_m3, now);
        }
    }
}
