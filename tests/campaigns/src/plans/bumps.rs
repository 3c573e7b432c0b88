//! Hands that push the drone slowly against the nearest part of a bridge, as pilots do who misjudge the last half meter.

use crate::weaknesses::Hands;
use spandrel_model::frames::{Enu, Vec3};

/// Speed at which the drone touches the surface and moves away from it, m/s: below the 1 m/s that the certification allows.
const TOUCH_SPEED_M_S: f64 = 0.5;
/// Highest speed of the approach, m/s, and its decrease with the distance from where the touch begins, 1/s.
const APPROACH_SPEED_M_S: f64 = 1.5;
const APPROACH_RATE_PER_S: f64 = 0.8;
/// Distance of the drone's center from a surface at which the touch begins, m: half its span of 0.59 m and some air.
const TOUCH_DISTANCE_M: f64 = 0.5;
/// Largest distance to a surface that the hands approach, m.
const REACH_M: f64 = 8.0;
/// Stick messages for which the drone moves away after a touch: 1 s at 50 Hz. It takes another one to come back. Contacts less than 1 s
/// apart count as one, and the pilot gives up a place or a task after setbacks more than 3 s apart.
const RETREAT: u64 = 50;
/// Stick messages after which the hands give an approach up: 10 s.
const LONGEST_APPROACH: u64 = 500;

/// When and how often the drone touches the surface.
pub struct BumpPlan {
    /// Condition under which it does.
    pub condition: fn(&Hands) -> bool,
    /// Stick messages between two approaches.
    pub period: u64,
    /// Touches in each approach.
    pub touches: u32,
    /// Touches after which the drone keeps away.
    pub total: u32,
}

#[derive(Debug, Clone, Copy, Default)]
enum Phase {
    #[default]
    Waiting,
    Closing {
        since: u64,
    },
    Retreating {
        since: u64,
    },
}

/// Progress of the bumps, counted in stick messages.
#[derive(Debug, Default)]
pub struct Bumps {
    phase: Phase,
    /// Touches in this approach, and in all.
    touches: u32,
    total: u32,
    waiting_since: u64,
}

/// Replaces the sticks, except for yaw, while the hands push the drone toward a surface or away from it.
pub fn bump(hands: &mut Hands, axes: [f64; 4], plan: &BumpPlan) -> [f64; 4] {
    let Some(near) = hands.site.geometry().nearest_member(hands.drone.position_m, REACH_M) else { return axes };
    step(hands, plan);
    let speed_m_s = match hands.bumps.phase {
        Phase::Waiting => return axes,
        Phase::Closing { .. } => {
            let rest_m = near.distance_m - TOUCH_DISTANCE_M;
            -(APPROACH_RATE_PER_S * rest_m).clamp(TOUCH_SPEED_M_S, APPROACH_SPEED_M_S)
        }
        Phase::Retreating { .. } => TOUCH_SPEED_M_S,
    };
    let away: Vec3<Enu> = (hands.drone.position_m - near.point_m).unit();
    let [x, y, z] = hands.sticks_for(away * speed_m_s);
    [x, y, z, axes[3]]
}

fn step(hands: &mut Hands, plan: &BumpPlan) {
    let (now, touching) = (hands.stick_messages, hands.drone.touching);
    let is_due = (plan.condition)(hands) && now >= hands.bumps.waiting_since + plan.period && hands.bumps.total < plan.total;
    let bumps = &mut hands.bumps;
    let wait = |bumps: &mut Bumps| *bumps = Bumps { waiting_since: now, total: bumps.total, ..Bumps::default() };
    match bumps.phase {
        Phase::Waiting if is_due => bumps.phase = Phase::Closing { since: now },
        Phase::Closing { .. } if touching => {
            bumps.touches += 1;
            bumps.total += 1;
            bumps.phase = Phase::Retreating { since: now };
        }
        Phase::Closing { since } if now > since + LONGEST_APPROACH => wait(bumps),
        Phase::Retreating { since } if now > since + RETREAT => {
            if bumps.touches < plan.touches && bumps.total < plan.total {
                bumps.phase = Phase::Closing { since: now };
            } else {
                wait(bumps);
            }
        }
        Phase::Waiting | Phase::Closing { .. } | Phase::Retreating { .. } => {}
    }
}
