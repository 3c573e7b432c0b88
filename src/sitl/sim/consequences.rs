//! What follows from a step: lift-off, contact, an empty battery, being put back; clearance and light for the scoring.

use super::{CLEARANCE_REACH_M, Sim, SimEvent};
use crate::base::frames::{Rotation, Vec3};
use crate::mav::dialect::MavSeverity;
use crate::scenario::AfterCrash;
use crate::site::Surface;
use crate::sitl::autopilot::Landed;
use crate::sitl::physics;

/// Lift-off: this far above where it stood, m (assessment.md).
const LIFT_OFF_M: f64 = 0.3;
/// A hover counts as safe with this much clearance, m.
const SAFE_CLEARANCE_M: f64 = 1.0;
/// Slower than this it lies still, m/s.
const STILL_M_S: f64 = 0.3;
/// Touching the pad more slowly than this is landing, m/s (assessment.md).
const PAD_TOUCH_M_S: f64 = 1.0;

impl Sim {
    /// Lift-off, contact, battery, putting back.
    pub(super) fn consequences(&mut self) {
        let up = -self.state.rigid.position_m.down();
        if !self.lifted && up > self.standing_up_m + LIFT_OFF_M {
            self.lifted = true;
            self.events.push_back(SimEvent::LiftOff);
        }
        self.note_contact();
        if self.state.battery.empty() && !self.battery_told {
            self.battery_told = true;
            self.events.push_back(SimEvent::BatteryEmpty);
            self.endpoint.tell(MavSeverity::MAV_SEVERITY_EMERGENCY, "Battery empty");
            self.end("battery empty");
        }
        self.put_back_when_down();
    }

    fn end(&mut self, reason: &str) {
        if self.ended.is_none() {
            self.ended = Some(reason.to_string());
            self.events.push_back(SimEvent::Ended { reason: reason.to_string() });
        }
    }

    /// The wire's contact code and its onsets. Touching the pad gently, near home or before lift-off, is none.
    fn note_contact(&mut self) {
        let report = self.state.contact;
        let code = match report.surface {
            Some((surface, _)) if self.lifted && !self.gentle(surface, report.impact_m_s) => contact_code(surface),
            _ => 0,
        };
        let before = std::mem::replace(&mut self.scoring.contact, code);
        // Who scrapes along a bridge and then hits somebody has hit somebody: that ends the session from any contact.
        let grave = |code: i32| [contact_code(Surface::Person), contact_code(Surface::Vehicle)].contains(&code);
        let onset = code != 0 && before == 0;
        let worse = grave(code) && !grave(before);
        if !onset && !worse {
            return;
        }
        self.scoring.hits += 1;
        let (surface, object) = report.surface.unwrap_or((Surface::Other, crate::site::ObjectId(0)));
        let what = self.site.object_name(object);
        self.events.push_back(SimEvent::Crash { what: what.clone(), impact_m_s: report.impact_m_s });
        if matches!(surface, Surface::Person | Surface::Vehicle) {
            self.end(&format!("hit {what}"));
        } else if self.config.scenario.rules.after_crash == AfterCrash::End {
            self.end(&format!("crashed into {what}"));
        }
    }

    fn gentle(&self, surface: Surface, impact_m_s: f64) -> bool {
        let team = &self.config.scenario.ground_team;
        let here = self.state.rigid.position_m.enu() - team.pad_m;
        let home = here.horizontal_norm() <= team.home_radius_m;
        surface == Surface::Pad || (surface == Surface::Terrain && home && impact_m_s < PAD_TOUCH_M_S)
    }

    /// On its side or back: near home that is gentle contact and no crash, yet it will not fly from there.
    fn lies_upset(&self) -> bool {
        const UPRIGHT: f64 = 0.8;
        let down = self.state.rigid.attitude * Vec3::<crate::base::frames::Frd>::new(0.0, 0.0, 1.0);
        self.state.contact.touching() && down.down() < UPRIGHT
    }

    /// A drone that lies still away from the pad, or touches water, goes back to its last safe hover after a while.
    fn put_back_when_down(&mut self) {
        let rules = &self.config.scenario.rules;
        if !self.lifted || self.ended.is_some() || rules.after_crash != AfterCrash::Respawn {
            return;
        }
        let rigid = &self.state.rigid;
        let touching = self.scoring.contact != 0 || self.lies_upset();
        let still = rigid.velocity_m_s.norm() < STILL_M_S;
        let wet = self.scoring.contact == contact_code(Surface::Water);
        if !(touching && (still || wet)) {
            // A lying body rocks off its contact for a step or two; a flying one is gone for longer.
            if self.crashed_since.is_some_and(|_| !touching && !still) {
                self.crashed_since = None;
            }
            return;
        }
        let since = *self.crashed_since.get_or_insert(self.now);
        if self.now - since >= rules.respawn_after && !self.state.battery.empty() {
            self.put_back();
        }
    }

    fn put_back(&mut self) {
        let (position_m, yaw_rad) = self.safe;
        self.crashed_since = None;
        self.state.place(position_m, yaw_rad);
        let hover = self.model.hover_rotor_rad_s();
        self.state.rigid.rotor_rad_s = [hover; physics::MAX_ROTORS];
        self.scoring.respawns += 1;
        self.scoring.contact = 0;
        let attitude = Rotation::from_euler(0.0, 0.0, yaw_rad);
        let now = self.now;
        if let Some(autopilot) = self.backend.builtin_mut() {
            autopilot.respawn(position_m, Vec3::zero(), attitude, now);
        }
        self.events.push_back(SimEvent::Respawn);
    }

    /// Clearance and light for the scoring, and the last safe hover.
    pub(super) fn look_around(&mut self) {
        let position = self.state.rigid.position_m.enu();
        if self.clearance_due.fire(self.now) {
            let near = self.site.nearest(position, CLEARANCE_REACH_M, self.now);
            self.scoring.clearance_m = near.map_or(CLEARANCE_REACH_M, |n| n.distance_m);
            self.remember_hover();
        }
        if self.lux_due.fire(self.now) {
            self.scoring.lux = self.site.ambient_lux(position, None, self.now);
        }
    }

    fn remember_hover(&mut self) {
        let rigid = &self.state.rigid;
        let (roll, pitch, yaw) = rigid.attitude.euler();
        let calm = rigid.velocity_m_s.norm() < 2.0 && roll.abs() < 0.4 && pitch.abs() < 0.4 && rigid.rates_rad_s.norm() < 1.0;
        let flying = self.backend.builtin().is_some_and(|a| a.status().landed == Landed::InAir);
        if calm && flying && self.scoring.clearance_m > SAFE_CLEARANCE_M && self.crashed_since.is_none() {
            self.safe = (rigid.position_m, yaw);
        }
    }
}

/// design.md: 0 none, 1 bridge, 2 terrain, 3 water, 4 vehicle, 5 person, 6 other.
fn contact_code(surface: Surface) -> i32 {
    match surface {
        Surface::Bridge => 1,
        Surface::Terrain => 2,
        Surface::Water => 3,
        Surface::Vehicle => 4,
        Surface::Person => 5,
        Surface::Other => 6,
        Surface::Pad => 0,
    }
}
