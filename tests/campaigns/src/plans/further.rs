//! A third set of faults, also by another author than the rules of the plan: the author had read the drills and the faults of the
//! other two sets, but neither the rules nor any plan for these faults. Sizes and expected drills are an instructor's judgment
//! (estimates), and were fixed before the first plan.
//!
//! Don't change a fault or its expected drills because of a plan, and don't adjust the rules to single faults.

use crate::bumps::{BumpPlan, bump};
use crate::unseen::{
    ARCH, GAP, LOWEST_THROTTLE, NEUTRAL_THROTTLE, PIER, SLAB, STICK_RATE_HZ, Unseen, action, certification_accuracy,
    delay_picture, idle_pictures, on_command, owe, precision, reshape, task, tasks_of, up, wave,
};
use crate::weaknesses::{FULL_STICK, Hands, NO_WEAKNESS, STICK_DEADBAND, Weakness, command, picture, with_sticks};
use spandrel_clients::pilot::Skill;
use spandrel_mavlink::dialect::{COMMAND_LONG_DATA, MANUAL_CONTROL_DATA, MavCmd, MavMessage};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{Scenario, TaskKind};
use spandrel_training::record::{SessionRecord, TaskTechnique};

/// Share of the circle around the pier that the pilot flies.
const CIRCLE_SHARE: f64 = 0.5;
/// The pilot flies 3.5 m too low under the arch: at 8 m instead of 4.5 m.
const BELOW_ARCH_M: f64 = 3.5;
/// The pilot wants to fly 0.8 m too high in the gap, where the path has 1.2 m of air above it.
const ABOVE_GAP_M: f64 = 0.8;
/// The racing pilot moves the stick along the slab this many times as far. The drone then flies 5.7 m/s instead of 2.1 m/s; the limit is
/// 4.5 m/s.
const RACING_FACTOR: f64 = 7.0;
/// The nose wanders by 80 degrees to either side of the slab, every 24 m.
const WANDER_RAD: f64 = 80.0 * math::PI / 180.0;
const WANDER_WAVELENGTH_M: f64 = 24.0;
/// The lamp is switched on late by this many stick messages: 60 s.
const LATE_LAMP: u64 = 60 * STICK_RATE_HZ;
/// The shutter is pressed late by this many stick messages: 2 s.
const LATE_SHUTTER: u64 = 2 * STICK_RATE_HZ;
/// Before each picture, the pilot already flies on sideways for 0.7 s with this deflection, 1.3 m/s.
const MOVING_ON: u64 = 35;
const MOVING_ON_STICK: f64 = 0.13;
/// Stick messages between two pictures of a camera that runs: 6 s.
const RUNNING_CAMERA_PERIOD: u64 = 6 * STICK_RATE_HZ;
/// The pilot photographs as if every surface faced 65 degrees to the side, and within 15 degrees of that.
const ASKEW_RAD: f64 = 65.0 * math::PI / 180.0;
const ASKEW_INCIDENCE_DEG: f64 = 15.0;
/// Behind the pier, the pilot confuses left and right, and forward and back, for 3 s out of 8 s while the drone's nose is within 60 degrees
/// of the pilot.
const CONFUSION: u64 = 3 * STICK_RATE_HZ;
const CONFUSION_PERIOD: u64 = 8 * STICK_RATE_HZ;
const FACING_RAD: f64 = math::PI / 3.0;
/// Speed at which the drone drifts with the wind when the pilot lets go of the sticks, m/s: the wind blows with 1 m/s.
const DRIFT_M_S: f64 = 0.5;
/// Direction toward which the wind of the job blows, rad.
const DOWNWIND_RAD: f64 = 60.0 * math::PI / 180.0;
/// While landing, the pilot sinks as fast as possible for 0.8 s, 2 m/s, and stops that for 0.5 s with some thrust, in turn.
const PUMPING: u64 = 40;
const PUMPING_PERIOD: u64 = 65;
const PUMPING_THROTTLE: i16 = 550;
/// Stick messages after which the pilot comes home: 21 min, when 15% of the battery are left.
const LATE_RETURN: u64 = 21 * 60 * STICK_RATE_HZ;
/// The pilot bumps into the slab every 25 s.
const BUMPS: BumpPlan =
    BumpPlan { condition: |hands| hands.flies_task(SLAB), period: 25 * STICK_RATE_HZ, touches: 1, total: u32::MAX };
/// The jerky pilot moves the sticks once in this many stick messages: 1 s.
const JERK: usize = 50;

/// The faults. To fly the job again is no mistake where a fault leaves a task undone.
pub const FURTHER: &[Unseen] = &[
    Unseen {
        weakness: Weakness {
            name: "circles only half of the pier",
            drills: &["drill-orbit"],
            also: &["drill-search", "practice", "two-bridges"],
            belief: |job| {
                for task in tasks_of(job, TaskKind::PierCircle) {
                    let kept = (CIRCLE_SHARE * task.path_m.len() as f64) as usize;
                    task.path_m.truncate(kept);
                    task.viewing_directions.truncate(kept);
                    task.closed = false;
                }
            },
            ..NO_WEAKNESS
        },
        action: action("covered share of the circle", |r| task(r, PIER).covered.unwrap(), -0.3),
    },
    Unseen {
        weakness: Weakness {
            name: "leaves the gap out",
            drills: &["drill-gap"],
            also: &["drill-lamp", "drill-search", "practice", "two-bridges"],
            belief: |job| job.tasks.retain(|task| task.kind != TaskKind::Interlayer),
            ..NO_WEAKNESS
        },
        action: action("tasks done", |r| r.completion.unwrap().tasks_done as f64, -1.0),
    },
    Unseen {
        weakness: Weakness {
            name: "stays too far below the arch",
            drills: &["drill-stand-off", "drill-curve-under-arch"],
            also: &["drill-search", "drill-framing", "drill-lamp", "practice", "two-bridges"],
            belief: |job| reshape(job, TaskKind::ArchBottom, |_| up(-BELOW_ARCH_M)),
            ..NO_WEAKNESS
        },
        action: action("distance from the arch beyond the path's, m", |r| technique(r, ARCH).stand_off_error_m.unwrap(), 1.5),
    },
    Unseen {
        weakness: Weakness {
            name: "flies just below the ceiling of the gap",
            drills: &["drill-gap"],
            also: &["drill-stand-off", "drill-lamp", "drill-search"],
            belief: |job| reshape(job, TaskKind::Interlayer, |_| up(ABOVE_GAP_M)),
            ..NO_WEAKNESS
        },
        action: action("share of the time in the gap too close to something", |r| technique(r, GAP).low_clearance, 0.3),
    },
    Unseen {
        weakness: Weakness {
            name: "races along the slab",
            drills: &["drill-straight-line"],
            also: &["drill-framing", "drill-search", "drill-stand-off", "drill-hover"],
            tamper: |hands, message| {
                with_sticks(hands, message, |hands, [x, y, z, r]| {
                    [x, if hands.flies_task(SLAB) { RACING_FACTOR * y } else { y }, z, r]
                })
            },
            ..NO_WEAKNESS
        },
        action: action("time above the speed limit at the slab, s", |r| task(r, SLAB).speeding_s, 4.0),
    },
    Unseen {
        weakness: Weakness {
            name: "circles the pier without turning",
            drills: &["drill-orbit"],
            also: &["drill-framing", "drill-search", "drill-stand-off", "practice", "two-bridges"],
            tamper: |hands, message| {
                with_sticks(hands, message, |hands, [x, y, z, r]| [x, y, z, if hands.flies_task(PIER) { 0.0 } else { r }])
            },
            ..NO_WEAKNESS
        },
        action: action("RMS framing error at the pier, degrees", |r| framing_deg(r, PIER), 15.0),
    },
    Unseen {
        weakness: Weakness {
            name: "lets the nose wander along the slab",
            drills: &["drill-framing"],
            also: &["drill-straight-line", "drill-hover", "drill-search"],
            belief: |job| wander(job, TaskKind::SlabSide),
            ..NO_WEAKNESS
        },
        action: action("RMS framing error at the slab, degrees", |r| framing_deg(r, SLAB), 8.0),
    },
    Unseen {
        weakness: Weakness {
            name: "leaves the camera tilted up after the arch",
            drills: &["drill-framing"],
            also: &["drill-search", "drill-orbit", "drill-gap", "drill-lamp"],
            tamper: |hands, message| {
                let tilts = command(&message) == Some(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW);
                let leaves_it = hands.has_begun_task(ARCH) && !hands.flies_task(ARCH);
                if tilts && leaves_it { Vec::new() } else { vec![message] }
            },
            ..NO_WEAKNESS
        },
        action: action("RMS framing error at the pier, degrees", |r| framing_deg(r, PIER), 5.0),
    },
    Unseen {
        weakness: Weakness {
            name: "switches the lamp on late",
            drills: &["drill-lamp"],
            also: &["drill-search", "drill-gap", "drill-curve-under-arch"],
            tamper: |hands, message| {
                on_command(hands, message, MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, |hands, switch| {
                    hands.owed.clear();
                    if !switches_on(&switch) {
                        return vec![switch];
                    }
                    owe(hands, LATE_LAMP, switch);
                    Vec::new()
                })
            },
            ..NO_WEAKNESS
        },
        action: action("share of the time in the dark with the lamp off", lamp_off_in_the_dark, 0.25),
    },
    Unseen {
        weakness: Weakness {
            name: "presses the shutter two seconds late",
            drills: &["drill-framing", "drill-hover"],
            also: &["drill-search"],
            tamper: |hands, message| delay_picture(hands, message, LATE_SHUTTER),
            ..NO_WEAKNESS
        },
        action: action("accuracy of the certification", certification_accuracy, -15.0),
    },
    Unseen {
        weakness: Weakness {
            name: "lets the camera run",
            drills: &["drill-search", "drill-framing"],
            also: &["practice", "two-bridges"],
            tamper: |hands, message| {
                let is_stick = matches!(message, MavMessage::MANUAL_CONTROL(_));
                hands.stick_messages += u64::from(is_stick);
                let is_due = is_stick && hands.has_begun_task(SLAB) && !hands.lands();
                let runs = is_due && hands.stick_messages.is_multiple_of(RUNNING_CAMERA_PERIOD);
                if runs { vec![message, picture()] } else { vec![message] }
            },
            ..NO_WEAKNESS
        },
        action: action("pictures without a new defect", idle_pictures, 25.0),
    },
    Unseen {
        weakness: Weakness {
            name: "takes no pictures under the arch",
            drills: &["drill-search"],
            also: &["drill-curve-under-arch", "drill-framing", "drill-lamp", "practice", "two-bridges"],
            tamper: |hands, message| {
                let is_picture = command(&message) == Some(MavCmd::MAV_CMD_IMAGE_START_CAPTURE);
                if is_picture && hands.flies_task(ARCH) { Vec::new() } else { vec![message] }
            },
            ..NO_WEAKNESS
        },
        action: action("defects found at the arch", |r| task(r, ARCH).defects_found as f64, -1.0),
    },
    Unseen {
        weakness: Weakness {
            name: "photographs without stopping",
            drills: &["drill-hover", "drill-framing"],
            also: &["drill-search"],
            tamper: |hands, message| {
                before_picture(hands, message, MOVING_ON, |sticks| MANUAL_CONTROL_DATA {
                    y: (FULL_STICK * MOVING_ON_STICK) as i16,
                    ..sticks
                })
            },
            ..NO_WEAKNESS
        },
        action: action("share of the pictures in motion", moving_pictures, 0.4),
    },
    Unseen {
        weakness: Weakness {
            name: "photographs from the side",
            drills: &["drill-framing", "drill-search"],
            also: &["drill-hover", "drill-stand-off"],
            skill: Skill { photo_incidence_deg: ASKEW_INCIDENCE_DEG, ..Skill::EXPERT },
            belief: see_surfaces_askew,
            ..NO_WEAKNESS
        },
        action: action("defects whose pictures are too oblique", |r| with_reason(r, "oblique"), 1.0),
    },
    Unseen {
        weakness: Weakness {
            name: "confuses left and right behind the pier",
            drills: &["drill-orbit"],
            also: &[
                "drill-hover",
                "drill-straight-line",
                "drill-stand-off",
                "drill-framing",
                "drill-search",
                "practice",
                "two-bridges",
            ],
            tamper: |hands, message| {
                with_sticks(hands, message, |hands, [x, y, z, r]| {
                    let is_confused = hands.flies_task(PIER) && hands.stick_messages % CONFUSION_PERIOD < CONFUSION;
                    if is_confused && faces_pilot(hands) { [-x, -y, z, r] } else { [x, y, z, r] }
                })
            },
            ..NO_WEAKNESS
        },
        action: action("share of the pier's window on its path", |r| task(r, PIER).on_path, -0.05),
    },
    Unseen {
        weakness: Weakness {
            name: "lets the wind carry the drone away at every stop",
            drills: &["drill-hover"],
            also: &["drill-straight-line", "drill-stand-off", "drill-framing", "drill-search", "practice", "two-bridges"],
            // The pilot photographs in spite of the drift.
            skill: Skill { photo_speed_m_s: 1.0, ..Skill::EXPERT },
            tamper: |hands, message| with_sticks(hands, message, drift_when_released),
            ..NO_WEAKNESS
        },
        action: action("RMS distance to the path, thresholds", |r| precision(r).rms_distance_ratio, 0.1),
    },
    Unseen {
        weakness: Weakness {
            name: "pumps the throttle on touchdown",
            drills: &["drill-landing"],
            also: &["drill-hover"],
            tamper: |hands, message| match message {
                MavMessage::MANUAL_CONTROL(sticks) if hands.lands() && sticks.z < NEUTRAL_THROTTLE => {
                    hands.stick_messages += 1;
                    let sinks = hands.stick_messages % PUMPING_PERIOD < PUMPING;
                    let z = if sinks { LOWEST_THROTTLE } else { PUMPING_THROTTLE };
                    vec![MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { z, ..sticks })]
                }
                other => vec![other],
            },
            ..NO_WEAKNESS
        },
        action: action("contacts outside the tasks", |r| r.contacts_outside().total() as f64, 1.0),
    },
    Unseen {
        weakness: Weakness {
            name: "comes home on the last of the battery",
            drills: &["drill-landing", "practice", "two-bridges"],
            also: &[],
            tamper: |hands, message| match message {
                MavMessage::MANUAL_CONTROL(sticks) => {
                    hands.stick_messages += 1;
                    let lingers = hands.last_task_flown && !hands.lands() && hands.stick_messages < LATE_RETURN;
                    let released = MANUAL_CONTROL_DATA { x: 0, y: 0, z: 500, r: 0, ..sticks };
                    vec![MavMessage::MANUAL_CONTROL(if lingers { released } else { sticks })]
                }
                other => vec![other],
            },
            ..NO_WEAKNESS
        },
        action: action("charge at the end, %", |r| r.battery_at_end_pct, -25.0),
    },
    Unseen {
        weakness: Weakness {
            name: "bumps into the slab for a closer look",
            drills: &["drill-stand-off"],
            also: &["drill-straight-line", "drill-hover", "drill-framing", "drill-search", "practice", "two-bridges"],
            tamper: |hands, message| with_sticks(hands, message, |hands, axes| bump(hands, axes, &BUMPS)),
            ..NO_WEAKNESS
        },
        action: action("contacts at the slab", |r| task(r, SLAB).contacts().total() as f64, 2.0),
    },
    Unseen {
        weakness: Weakness {
            name: "moves the sticks in jerks",
            drills: &["drill-hover", "drill-straight-line"],
            also: &[
                "drill-stand-off",
                "drill-orbit",
                "drill-gap",
                "drill-curve-under-arch",
                "drill-framing",
                "drill-search",
                "practice",
                "two-bridges",
            ],
            tamper: |hands, message| with_sticks(hands, message, move_in_jerks),
            ..NO_WEAKNESS
        },
        action: action("RMS distance to the path, thresholds", |r| precision(r).rms_distance_ratio, 0.1),
    },
];

/// Turns the views of a kind of task from side to side along the path.
fn wander(job: &mut Scenario, kind: TaskKind) {
    for task in tasks_of(job, kind) {
        let mut along_m = 0.0;
        for k in 0..task.path_m.len() {
            along_m += (task.path_m[k] - task.path_m[k.saturating_sub(1)]).norm();
            let angle_rad = WANDER_RAD * wave(along_m, WANDER_WAVELENGTH_M);
            task.viewing_directions[k] = turned(task.viewing_directions[k], up(1.0), angle_rad);
        }
    }
}

/// Returns a vector turned about a unit vector at right angles to it.
pub fn turned(vector: Vec3<Enu>, about: Vec3<Enu>, angle_rad: f64) -> Vec3<Enu> {
    let (sin, cos) = math::sin_cos(angle_rad);
    vector * cos + about.cross(vector) * sin
}

/// Mistakes the direction that every surface faces.
fn see_surfaces_askew(job: &mut Scenario) {
    for defect in job.defects.placed.as_mut().unwrap() {
        defect.normal = turned(defect.normal, defect.along, ASKEW_RAD);
    }
}

/// Holds back each picture for a number of stick messages, and changes the sticks until it is taken.
pub fn before_picture(
    hands: &mut Hands,
    message: MavMessage,
    by: u64,
    change: fn(MANUAL_CONTROL_DATA) -> MANUAL_CONTROL_DATA,
) -> Vec<MavMessage> {
    let sent = delay_picture(hands, message, by);
    let changed = sent.into_iter().map(|message| match message {
        MavMessage::MANUAL_CONTROL(sticks) if !hands.owed.is_empty() => MavMessage::MANUAL_CONTROL(change(sticks)),
        other => other,
    });
    changed.collect()
}

fn switches_on(message: &MavMessage) -> bool {
    matches!(message, MavMessage::COMMAND_LONG(COMMAND_LONG_DATA { param1, .. }) if *param1 > 0.0)
}

/// Returns whether the drone's nose points at the pilot, who stands beside the landing pad.
fn faces_pilot(hands: &Hands) -> bool {
    let way = hands.pilot_m - hands.drone.position_m;
    math::wrap_pi(math::atan2(way.east(), way.north()) - hands.drone.heading_rad).abs() < FACING_RAD
}

fn drift_when_released(hands: &mut Hands, [x, y, z, r]: [f64; 4]) -> [f64; 4] {
    if [x, y, z].iter().any(|axis| axis.abs() > STICK_DEADBAND) {
        return [x, y, z, r];
    }
    let (sin, cos) = math::sin_cos(DOWNWIND_RAD);
    let [x, y, z] = hands.sticks_for(Vec3::new(sin, cos, 0.0) * DRIFT_M_S);
    [x, y, z, r]
}

fn move_in_jerks(hands: &mut Hands, axes: [f64; 4]) -> [f64; 4] {
    let held = &mut hands.late_sticks;
    if held.is_empty() || held.len() > JERK {
        held.clear();
        held.push_back(axes);
    }
    let first = held[0];
    held.push_back(axes);
    first
}

pub fn technique(record: &SessionRecord, id: u32) -> TaskTechnique {
    task(record, id).technique.unwrap()
}

pub fn framing_deg(record: &SessionRecord, id: u32) -> f64 {
    technique(record, id).rms_framing_deg.unwrap()
}

fn lamp_off_in_the_dark(record: &SessionRecord) -> f64 {
    let dark = [ARCH, GAP].map(|id| technique(record, id));
    let off_s: f64 = dark.iter().map(|one| one.near_s * one.lamp_off.unwrap()).sum();
    off_s / dark.iter().map(|one| one.near_s).sum::<f64>()
}

fn moving_pictures(record: &SessionRecord) -> f64 {
    record.technique.unwrap().moving_pictures.unwrap()
}

/// Returns the number of defects whose best picture lacks quality for a reason with these words.
pub fn with_reason(record: &SessionRecord, words: &str) -> f64 {
    let reasons = record.defects.iter().map(|defect| defect.lacked.iter().chain(&defect.shortfalls));
    reasons.filter(|of_one| of_one.clone().any(|reason| reason.contains(words))).count() as f64
}
