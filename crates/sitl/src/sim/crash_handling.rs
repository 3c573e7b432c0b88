//! Consequences of a step: liftoff, contact, empty battery and respawn, plus clearance and light for scoring.

use super::controller::Controller;
use super::{CLEARANCE_SEARCH_RADIUS_M, Sim, SimEvent};
use crate::autopilot::Pose;
use crate::physics;
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::dialect::MavSeverity;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::scenario::AfterCrash;
use spandrel_model::site::Surface;

/// Height above the start position that counts as liftoff, m (docs/src/reference/assessment.md, "Frames").
const LIFTOFF_HEIGHT_M: f64 = 0.3;
/// Minimum clearance of a safe hover, m.
const MIN_SAFE_CLEARANCE_M: f64 = 1.0;
/// Speed below which the vehicle counts as motionless, m/s.
const MOTIONLESS_SPEED_M_S: f64 = 0.3;
/// Speed below which contact with the landing pad or the ground around it is a landing, m/s (docs/src/reference/assessment.md,
/// "Crashes").
const GENTLE_CONTACT_SPEED_M_S: f64 = 1.0;
/// Time without contact after which the vehicle counts as flying, s (estimate: a body at rest can rock off its contact for a step
/// or two).
const CONTACT_FREE_FLIGHT_TIME_S: f64 = 0.5;
/// The same with an external autopilot, s. One that has not noticed the crash keeps the rotors turning, and the wreck hops (PX4
/// with a failed motor: for less than 1 s each).
const EXTERNAL_CONTACT_FREE_FLIGHT_TIME_S: f64 = 2.0;

impl Sim {
    /// Handles liftoff, contact, empty battery and respawn.
    pub(super) fn handle_crash_and_respawn(&mut self) {
        let up = -self.state.rigid.position_m.down();
        if !self.has_lifted_off && up > self.start_height_m + LIFTOFF_HEIGHT_M {
            self.has_lifted_off = true;
            self.events.push_back(SimEvent::LiftOff);
        }
        self.record_contact();
        if self.state.battery.empty() && !self.battery_empty_reported {
            self.battery_empty_reported = true;
            self.events.push_back(SimEvent::BatteryEmpty);
            self.controller.push_text(MavSeverity::MAV_SEVERITY_EMERGENCY, "Battery empty");
            self.end_session("battery empty");
        }
        self.respawn_when_down();
    }

    fn end_session(&mut self, reason: &str) {
        if self.end_reason.is_none() {
            self.end_reason = Some(reason.to_string());
            self.events.push_back(SimEvent::Ended { reason: reason.to_string() });
        }
    }

    /// Updates the current contact and counts new ones. Gentle contact with the landing pad, near home or before
    /// liftoff does not count.
    fn record_contact(&mut self) {
        let report = self.all_contacts();
        let contact = match report.surface {
            Some((surface, _)) if self.has_lifted_off && !self.is_gentle_touch(surface, report.impact_m_s) => {
                contact_kind(surface)
            }
            _ => ContactKind::None,
        };
        let before = std::mem::replace(&mut self.scoring.contact, contact);
        // Hitting a person or vehicle during another contact counts as a new hit and ends the session.
        let grave = |contact: ContactKind| matches!(contact, ContactKind::Person | ContactKind::Vehicle);
        let onset = contact != ContactKind::None && before == ContactKind::None;
        let worse = grave(contact) && !grave(before);
        if !onset && !worse {
            return;
        }
        self.scoring.hits += 1;
        let (surface, object) = report.surface.unwrap_or((Surface::Other, spandrel_model::site::ObjectId(0)));
        let what = self.object_name(object);
        self.events.push_back(SimEvent::Crash { what: what.clone(), impact_m_s: report.impact_m_s });
        if matches!(surface, Surface::Person | Surface::Vehicle) {
            self.end_session(&format!("hit {what}"));
        } else if self.config.after_crash() == AfterCrash::End {
            self.end_session(&format!("crashed into {what}"));
        }
    }

    fn is_gentle_touch(&self, surface: Surface, impact_m_s: f64) -> bool {
        let team = &self.config.scenario.ground_team;
        let here = self.state.rigid.position_m.enu() - team.pad_m;
        let home = here.horizontal_norm() <= team.home_radius_m;
        let place = surface == Surface::Pad || (surface == Surface::Terrain && home);
        place && impact_m_s < GENTLE_CONTACT_SPEED_M_S
    }

    /// Returns true if the vehicle is lying on its side or back. Near home, this is gentle contact and not a crash, but
    /// the vehicle cannot take off.
    fn is_upside_down(&self) -> bool {
        const UPRIGHT: f64 = 0.8;
        let down = self.state.rigid.attitude * Vec3::<spandrel_model::frames::Frd>::new(0.0, 0.0, 1.0);
        self.state.contact.touching() && down.down() < UPRIGHT
    }

    /// Returns true after a gentle, upright landing that is not in water. The vehicle stays and can take off again.
    fn has_landed_upright(&self) -> bool {
        let landed = self.controller.is_on_ground();
        let wet = self.scoring.contact == ContactKind::Water;
        landed && !wet && !self.hard_contact && !self.is_upside_down()
    }

    /// Returns true if the vehicle has crashed near home and an external autopilot still considers it in flight. Gentle contact
    /// near home is otherwise a landing.
    fn lies_with_running_motors(&self) -> bool {
        self.controller.external().is_some()
            && self.hard_contact
            && self.state.contact.touching()
            && !self.controller.is_on_ground()
    }

    /// Resets the vehicle to its last safe hover after a delay if it has crashed and is motionless away from the
    /// landing pad, has tipped over, or is touching water.
    fn respawn_when_down(&mut self) {
        let rules = &self.config.scenario.rules;
        if !self.has_lifted_off || self.end_reason.is_some() || self.config.after_crash() != AfterCrash::Respawn {
            return;
        }
        let rigid = &self.state.rigid;
        let touching = self.scoring.contact != ContactKind::None || self.is_upside_down() || self.lies_with_running_motors();
        let still = rigid.velocity_m_s.norm() < MOTIONLESS_SPEED_M_S;
        let wet = self.scoring.contact == ContactKind::Water;
        if touching {
            self.touched_at = self.now;
        }
        self.hard_contact |= touching && self.state.contact.impact_m_s >= GENTLE_CONTACT_SPEED_M_S;
        let is_external = self.controller.external().is_some();
        let flight_time_s = if is_external { EXTERNAL_CONTACT_FREE_FLIGHT_TIME_S } else { CONTACT_FREE_FLIGHT_TIME_S };
        let has_left_contact = !touching && (self.now - self.touched_at).s() > flight_time_s;
        if has_left_contact {
            self.hard_contact = false;
        }
        if self.has_landed_upright() {
            self.crashed_since = None;
            return;
        }
        if !(touching && (still || wet)) {
            let moves_freely = !touching && !still && !is_external;
            if has_left_contact || moves_freely {
                self.crashed_since = None;
            }
            return;
        }
        let since = *self.crashed_since.get_or_insert(self.now);
        if self.now - since >= rules.respawn_after && !self.state.battery.empty() {
            self.respawn();
        }
    }

    fn respawn(&mut self) {
        if self.controller.external().is_some() {
            self.respawn_on_pad();
            return;
        }
        let from_m = self.state.rigid.position_m;
        let (position_m, yaw_rad) = self.last_safe_hover;
        self.place_after_crash(position_m, yaw_rad, self.model.hover_rotor_rad_s());
        let (pose, now) = (self.pose(), self.now);
        if let Controller::Builtin(own) = &mut self.controller {
            own.autopilot.respawn(from_m, &pose, now);
        }
    }

    /// Places the aircraft at rest with all rotors at one speed, ends its contact, and counts the respawn.
    pub(super) fn place_after_crash(&mut self, position_m: Vec3<Ned>, yaw_rad: f64, rotor_rad_s: f64) {
        self.place_at_rest(position_m, yaw_rad, rotor_rad_s);
        self.end_contact();
        self.scoring.respawns += 1;
        self.events.push_back(SimEvent::Respawn);
    }

    /// Places the aircraft at rest with all rotors at one speed.
    pub(super) fn place_at_rest(&mut self, position_m: Vec3<Ned>, yaw_rad: f64, rotor_rad_s: f64) {
        self.state.place(position_m, yaw_rad);
        self.state.rigid.rotor_rad_s = [rotor_rad_s; physics::MAX_ROTORS];
        self.sensors.discard_pending();
    }

    /// Returns the true pose and velocity.
    pub(super) fn pose(&self) -> Pose {
        let rigid = &self.state.rigid;
        Pose { position_m: rigid.position_m, velocity_m_s: rigid.velocity_m_s, attitude: rigid.attitude }
    }

    /// Ends a contact and its consequences, because the aircraft is now at another place.
    pub(super) fn end_contact(&mut self) {
        (self.crashed_since, self.hard_contact) = (None, false);
        self.scoring.contact = ContactKind::None;
    }

    /// Updates clearance and light for scoring, and the last safe hover.
    pub(super) fn update_clearance_and_light(&mut self) {
        let position = self.state.rigid.position_m.enu();
        if self.clearance_due.fire(self.now) {
            let near = self.site.nearest(position, CLEARANCE_SEARCH_RADIUS_M, self.now);
            self.scoring.clearance_m = near.map_or(CLEARANCE_SEARCH_RADIUS_M, |n| n.distance_m);
            self.save_safe_hover();
        }
        if self.lux_due.fire(self.now) {
            self.scoring.lux = self.site.ambient_lux(position, None, self.now);
        }
    }

    fn save_safe_hover(&mut self) {
        let rigid = &self.state.rigid;
        let (roll, pitch, yaw) = rigid.attitude.euler();
        let calm = rigid.velocity_m_s.norm() < 2.0 && roll.abs() < 0.4 && pitch.abs() < 0.4 && rigid.rates_rad_s.norm() < 1.0;
        let flying = self.controller.is_flying();
        if calm && flying && self.scoring.clearance_m > MIN_SAFE_CLEARANCE_M && self.crashed_since.is_none() {
            self.last_safe_hover = (rigid.position_m, yaw);
        }
    }
}

/// Maps a surface to a contact kind. A landing pad counts as another object because gentle landings on it are excluded earlier.
fn contact_kind(surface: Surface) -> ContactKind {
    match surface {
        Surface::Bridge => ContactKind::Bridge,
        Surface::Terrain => ContactKind::Terrain,
        Surface::Water => ContactKind::Water,
        Surface::Vehicle => ContactKind::Vehicle,
        Surface::Person => ContactKind::Person,
        Surface::Other | Surface::Pad => ContactKind::Other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::px4::Px4Interface;
    use crate::endpoint::flavor::px4;
    use crate::endpoint::params::param_view;
    use crate::endpoint::relay::RelayRules;
    use crate::physics::ContactReport;
    use crate::sim::{SimConfig, SimEvent};
    use spandrel_model::frames::Enu;
    use spandrel_model::scenario::Scenario;
    use spandrel_model::site::{ObjectId, Site};
    use spandrel_model::time::SimTime;
    use std::sync::Arc;

    const MS: SimTime = SimTime::from_ms(1);
    /// Last safe hover position in these tests, NED, m.
    const SAFE_HOVER_POSITION: (f64, f64, f64) = (3.0, 4.0, -6.0);

    /// A vehicle that has flown and is now 50 m from the landing pad, level and at rest.
    fn sim_in_flight(change: impl Fn(&mut Scenario)) -> Sim {
        sim_with(change, Sim::new)
    }

    /// The same with an external autopilot, which has not reported a landing.
    fn sim_in_external_flight() -> Sim {
        sim_with(
            |_| (),
            |config, site| {
                let interface = Box::new(Px4Interface::new(&config.vehicle, 250.0).expect("rate"));
                let rules = RelayRules {
                    params: &param_view::PX4,
                    restarts_by_process: true,
                    roi_above_sea_level: true,
                    stick_sender: None,
                };
                Sim::with_external_autopilot(config, site, interface, rules)
            },
        )
    }

    fn sim_with(change: impl Fn(&mut Scenario), new: impl Fn(SimConfig, Arc<Site>) -> Sim) -> Sim {
        let text = include_str!("../../../../scenarios/drill-hover.toml");
        let mut scenario = spandrel_model::scenario::read("drill-hover.toml", text, &|_| Err("none".into())).expect("shipped");
        change(&mut scenario);
        let vehicle = include_str!("../../../../vehicle-params/phantom2.toml");
        let vehicle = Arc::new(spandrel_model::vehicle::read("phantom2.toml", vehicle).expect("shipped"));
        let site = Arc::new(Site::build(&scenario, 1));
        let scenario = Arc::new(scenario);
        let mut sim = new(SimConfig { scenario, vehicle, seed: 1, instance: 0, flavor: &px4::FLAVOR, after_crash: None }, site);
        sim.has_lifted_off = true;
        sim.last_safe_hover = (Vec3::new(SAFE_HOVER_POSITION.0, SAFE_HOVER_POSITION.1, SAFE_HOVER_POSITION.2), 0.3);
        put(&mut sim, Vec3::new(50.0, 0.0, 0.1));
        sim
    }

    fn put(sim: &mut Sim, place: Vec3<Enu>) {
        sim.state = physics::PhysicsState::at_rest(place.ned(), 0.0);
    }

    fn set_contact(sim: &mut Sim, surface: Option<Surface>, impact_m_s: f64) {
        sim.state.contact = ContactReport { surface: surface.map(|s| (s, ObjectId(0))), impact_m_s, normal_force_n: 1.0 };
    }

    /// Runs crash handling for `ms` ticks on an unchanging physical state.
    fn run_ticks(sim: &mut Sim, ms: i64) -> Vec<SimEvent> {
        for _ in 0..ms {
            sim.now += MS;
            sim.handle_crash_and_respawn();
        }
        sim.events.drain(..).collect()
    }

    fn crashes(events: &[SimEvent]) -> usize {
        events.iter().filter(|e| matches!(e, SimEvent::Crash { .. })).count()
    }

    #[test]
    fn exact_motionless_or_wet_vehicle_respawns_after_3_s() {
        let going = Vec3::new(1.5, 0.0, 0.0);
        for (surface, velocity, back) in [
            (Surface::Bridge, Vec3::zero(), true),
            (Surface::Terrain, Vec3::zero(), true),
            (Surface::Water, Vec3::zero(), true),
            (Surface::Water, going, true),
            (Surface::Bridge, going, false),
        ] {
            let mut sim = sim_in_flight(|_| ());
            set_contact(&mut sim, Some(surface), 2.0);
            sim.state.rigid.velocity_m_s = velocity;
            // The crash counts from the first tick.
            assert_eq!(crashes(&run_ticks(&mut sim, 3_000)), 1, "{surface:?}");
            assert_eq!(sim.scoring.respawns, 0, "{surface:?}: too early");
            let events = run_ticks(&mut sim, 1);
            assert_eq!(events.contains(&SimEvent::Respawn), back, "{surface:?} {events:?}");
            assert_eq!(sim.scoring.respawns, i32::from(back));
            if back {
                assert_eq!(
                    sim.state.rigid.position_m,
                    Vec3::new(SAFE_HOVER_POSITION.0, SAFE_HOVER_POSITION.1, SAFE_HOVER_POSITION.2)
                );
                assert_eq!(sim.state.rigid.velocity_m_s.norm(), 0.0);
            }
        }
    }

    #[test]
    fn regress_gentle_upright_landing_does_not_respawn() {
        let tipped = spandrel_model::frames::Rotation::from_euler(1.2, 0.0, 0.0);
        for (surface, impact_m_s, attitude, back) in [
            (Surface::Terrain, 0.7, None, false),
            (Surface::Bridge, 0.7, None, false),
            (Surface::Terrain, 1.5, None, true),
            (Surface::Terrain, 0.7, Some(tipped), true),
            (Surface::Water, 0.7, None, true),
        ] {
            let mut sim = sim_in_flight(|_| ());
            sim.state.rigid.attitude = attitude.unwrap_or(sim.state.rigid.attitude);
            set_contact(&mut sim, Some(surface), impact_m_s);
            run_ticks(&mut sim, 1);
            set_contact(&mut sim, Some(surface), 0.0);
            let events = run_ticks(&mut sim, 10_000);
            assert_eq!(events.contains(&SimEvent::Respawn), back, "{surface:?} at {impact_m_s} m/s, {attitude:?}");
        }
    }

    #[test]
    fn exact_other_crash_rules_prevent_respawn_or_end_session() {
        let mut sim = sim_in_flight(|s| s.rules.after_crash = AfterCrash::Continue);
        set_contact(&mut sim, Some(Surface::Bridge), 2.0);
        let events = run_ticks(&mut sim, 20_000);
        assert!(crashes(&events) == 1 && events.len() == 1 && sim.ended().is_none(), "{events:?}");
        let mut sim = sim_in_flight(|s| s.rules.after_crash = AfterCrash::End);
        set_contact(&mut sim, Some(Surface::Bridge), 2.0);
        let events = run_ticks(&mut sim, 1);
        assert!(sim.ended().is_some_and(|why| why.starts_with("crashed into")), "{events:?}");
    }

    #[test]
    fn exact_hitting_person_or_vehicle_always_ends_session() {
        for rule in [AfterCrash::Continue, AfterCrash::Respawn, AfterCrash::End] {
            for surface in [Surface::Person, Surface::Vehicle] {
                let mut sim = sim_in_flight(|s| s.rules.after_crash = rule);
                if rule != AfterCrash::End {
                    set_contact(&mut sim, Some(Surface::Bridge), 1.0);
                    run_ticks(&mut sim, 10);
                    assert!(sim.ended().is_none());
                }
                set_contact(&mut sim, Some(surface), 0.1);
                let events = run_ticks(&mut sim, 5_000);
                assert!(sim.ended().is_some_and(|why| why.starts_with("hit ")), "{rule:?} {surface:?} {events:?}");
                assert!(!events.contains(&SimEvent::Respawn));
            }
        }
    }

    #[test]
    fn exact_empty_battery_prevents_respawn() {
        // One millisecond before the respawn, and exactly at the respawn.
        for ms in [2_999, 3_000] {
            let mut sim = sim_in_flight(|_| ());
            set_contact(&mut sim, Some(Surface::Bridge), 2.0);
            run_ticks(&mut sim, ms);
            sim.state.battery.charge = 0.0;
            let events = run_ticks(&mut sim, 10_000);
            assert_eq!(sim.ended(), Some("battery empty"), "{events:?}");
            assert!(events.contains(&SimEvent::BatteryEmpty) && !events.contains(&SimEvent::Respawn), "{events:?}");
        }
    }

    #[test]
    fn exact_vehicle_flying_after_contact_does_not_respawn() {
        let mut sim = sim_in_flight(|_| ());
        set_contact(&mut sim, Some(Surface::Bridge), 0.2);
        run_ticks(&mut sim, 100);
        // Below the motionless threshold, but in the air.
        set_contact(&mut sim, None, 0.0);
        sim.state.rigid.velocity_m_s = Vec3::new(0.1, 0.0, 0.0);
        run_ticks(&mut sim, 10_000);
        set_contact(&mut sim, Some(Surface::Bridge), 0.2);
        let events = run_ticks(&mut sim, 100);
        assert!(crashes(&events) == 1 && !events.contains(&SimEvent::Respawn), "{events:?}");
    }

    /// PX4 with a failed motor keeps the other rotors turning after the crash, so the wreck hops every second or two.
    #[test]
    fn regress_hopping_wreck_near_home_respawns() {
        let mut sim = sim_in_external_flight();
        put(&mut sim, Vec3::new(4.0, 0.0, 0.1));
        set_contact(&mut sim, Some(Surface::Terrain), 10.0);
        assert_eq!(crashes(&run_ticks(&mut sim, 1)), 1);
        // Upright and at rest, with gentle contact near home, which would otherwise be a landing.
        let lie = |sim: &mut Sim| {
            set_contact(sim, Some(Surface::Terrain), 0.0);
            sim.state.rigid.velocity_m_s = Vec3::zero();
            run_ticks(sim, 1_400).contains(&SimEvent::Respawn)
        };
        assert!(!lie(&mut sim));
        set_contact(&mut sim, None, 0.0);
        sim.state.rigid.velocity_m_s = Vec3::new(0.9, 0.0, -0.9);
        assert!(!run_ticks(&mut sim, 600).contains(&SimEvent::Respawn), "in a hop");
        assert!(lie(&mut sim), "3 s after the crash");
    }

    /// A bump near home is forgotten in flight, and the landing after it is not a crash.
    #[test]
    fn regress_external_autopilot_that_flies_on_does_not_respawn() {
        let mut sim = sim_in_external_flight();
        put(&mut sim, Vec3::new(4.0, 0.0, 0.1));
        set_contact(&mut sim, Some(Surface::Terrain), 2.0);
        run_ticks(&mut sim, 1);
        set_contact(&mut sim, None, 0.0);
        sim.state.rigid.velocity_m_s = Vec3::new(0.0, 0.0, -1.0);
        run_ticks(&mut sim, 2_100);
        set_contact(&mut sim, Some(Surface::Terrain), 0.5);
        sim.state.rigid.velocity_m_s = Vec3::zero();
        assert!(!run_ticks(&mut sim, 10_000).contains(&SimEvent::Respawn));
    }

    #[test]
    fn exact_pad_contact_is_crash_only_above_1_m_s() {
        for (impact_m_s, expected) in [(0.99, 0), (1.01, 1), (6.0, 1)] {
            for surface in [Surface::Pad, Surface::Terrain] {
                let mut sim = sim_in_flight(|_| ());
                let pad = sim.config.scenario.ground_team.pad_m;
                put(&mut sim, pad + Vec3::new(0.3, 0.0, 0.1));
                set_contact(&mut sim, Some(surface), impact_m_s);
                let mut events = run_ticks(&mut sim, 1);
                // The vehicle then remains at that position.
                set_contact(&mut sim, Some(surface), 0.0);
                events.extend(run_ticks(&mut sim, 10_000));
                assert_eq!(crashes(&events), expected, "{surface:?} at {impact_m_s} m/s: {events:?}");
                assert!(!events.contains(&SimEvent::Respawn) && sim.ended().is_none(), "{events:?}");
                assert_eq!(sim.scoring.contact, ContactKind::None, "resting on the pad does not count as a contact");
            }
        }
    }
}
