//! A fourth set of faults, also by another author than the rules of the plan: the author had read the drills and the faults of the
//! other three sets, but neither the rules nor any plan for these faults. Sizes and expected drills are an instructor's judgment
//! (estimates), and were fixed before the first plan.
//!
//! Don't change a fault or its expected drills because of a plan, and don't adjust the rules to single faults.

use crate::bumps::{BumpPlan, bump};
use crate::further::{before_picture, framing_deg, technique, turned, with_reason};
use crate::unseen::{
    ARCH, GAP, PIER, SLAB, STICK_RATE_HZ, Unseen, action, found, keep_defects, on_picture, owe, precision, reshape, task,
    tasks_of, up, wave,
};
use crate::weaknesses::{FULL_STICK, Hands, NO_WEAKNESS, Weakness, with_sticks, with_sticks_while};
use spandrel_clients::pilot::Skill;
use spandrel_mavlink::dialect::{MANUAL_CONTROL_DATA, MavCmd, MavMessage};
use spandrel_mavlink::station;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{Scenario, TaskKind};
use spandrel_training::record::SessionRecord;

/// The creeping pilot rises by 5 m over the 98 m of the slab.
const CREEP: f64 = 0.05;
/// The camera is tilted down by 75 degrees along the slab.
const TILT_RAD: f64 = 75.0 * math::PI / 180.0;
/// The pilot drifts north from under the arch, by 7 m at the far end.
const ASIDE: f64 = 0.075;
/// The rushing pilot moves the sticks under the arch this many times as far. The drone reaches 7 to 8 m/s; the
/// limit is 4.5 m/s.
const RUSHING_FACTOR: f64 = 7.0;
/// Distance from the middle of the arch bridge at which the pilot passes the gap outside, m: 4 m beside the deck.
const OUTSIDE_GAP_M: f64 = 8.8;
/// In the gap, the pilot pushes the stick to the left and to the right by this deflection, every 4 s, and at times leaves
/// the path, whose threshold is 1.75 m.
const SWAY_STICK: f64 = 0.2;
const SWAY_PERIOD: u64 = 4 * STICK_RATE_HZ;
/// The pilot rises by 4.5 m on the side of the pier that is away from the pad.
const BEHIND_PIER_M: f64 = 4.5;
/// Condition state of the defects that the pilot takes for sound surfaces; the others are in state 3.
const MILD: u8 = 2;
/// For a picture in the dark, the lamp is off from 0.3 s before it until 0.5 s after it.
const LAMP_OFF_BEFORE: u64 = 15;
const LAMP_OFF: u64 = 40;
/// Before each picture, the pilot already turns away for 1 s with this deflection, 60 degrees/s.
const TURNING_AWAY: u64 = STICK_RATE_HZ;
const TURNING_AWAY_STICK: f64 = 0.6;
/// Between the tasks, the pilot bumps into the bridge every 8 s while it is near, and eight times in all.
const BUMPS: BumpPlan = BumpPlan { condition: Hands::in_transit, period: 8 * STICK_RATE_HZ, touches: 1, total: 8 };
/// Throttle that goes with full yaw: the drone sinks with 1 m/s.
const THROTTLE_WITH_YAW: f64 = -0.5;
/// The pilot answers gusts for 8 s out of 20 s, with this deflection, back and forth every 2.4 s.
const ANSWER: u64 = 8 * STICK_RATE_HZ;
const ANSWER_PERIOD: u64 = 20 * STICK_RATE_HZ;
const ANSWER_STICK: f64 = 0.24;
const ANSWER_WAVELENGTH: f64 = 2.4 * STICK_RATE_HZ as f64;
/// Height above the ground at which the motors are switched off, m.
const MOTORS_OFF_M: f64 = 3.0;
/// Value of the second parameter with which a drone in the air accepts the command to switch the motors off.
const FORCED: f32 = 21196.0;
/// The pilot who balks at landing pulls up for 4 s out of 10 s with this throttle, 1.4 m/s, for 4 min.
const BALKING: u64 = 240 * STICK_RATE_HZ;
const BALKING_PERIOD: u64 = 10 * STICK_RATE_HZ;
const SINKING: u64 = 6 * STICK_RATE_HZ;
const BALKING_THROTTLE: i16 = 620;

/// The faults. To fly the job again is no mistake where a fault leaves a task undone.
pub const FOURTH: &[Unseen] = &[
    Unseen {
        weakness: Weakness {
            name: "creeps upward along the slab",
            drills: &["drill-straight-line"],
            also: &["drill-hover", "drill-stand-off", "drill-framing", "drill-search", "practice", "two-bridges"],
            belief: |job| reshape(job, TaskKind::SlabSide, |at| up(CREEP * at.along_m)),
            ..NO_WEAKNESS
        },
        action: action("share of the slab's window on its path", |r| task(r, SLAB).on_path, -0.15),
    },
    Unseen {
        weakness: Weakness {
            name: "flies the slab with the camera at the water",
            drills: &["drill-framing"],
            also: &["drill-search", "drill-straight-line"],
            belief: tilt_down_at_slab,
            ..NO_WEAKNESS
        },
        action: action("RMS framing error at the slab, degrees", |r| framing_deg(r, SLAB), 12.0),
    },
    Unseen {
        weakness: Weakness {
            name: "drifts out from under the arch",
            drills: &["drill-curve-under-arch"],
            also: &[
                "drill-stand-off",
                "drill-straight-line",
                "drill-framing",
                "drill-search",
                "drill-lamp",
                "practice",
                "two-bridges",
            ],
            belief: |job| reshape(job, TaskKind::ArchBottom, |at| north(ASIDE * at.along_m)),
            ..NO_WEAKNESS
        },
        action: action("covered share of the arch", |r| task(r, ARCH).covered.unwrap(), -0.2),
    },
    Unseen {
        weakness: Weakness {
            name: "rushes along under the arch",
            drills: &["drill-curve-under-arch"],
            also: &["drill-straight-line", "drill-stand-off", "drill-framing", "drill-search", "drill-hover"],
            tamper: |hands, message| {
                with_sticks(hands, message, |hands, [x, y, z, r]| {
                    let factor = if hands.flies_task(ARCH) { RUSHING_FACTOR } else { 1.0 };
                    [factor * x, factor * y, factor * z, r]
                })
            },
            ..NO_WEAKNESS
        },
        action: action("time above the speed limit at the arch, s", |r| task(r, ARCH).speeding_s, 4.0),
    },
    Unseen {
        weakness: Weakness {
            name: "switches the lamp off for every picture",
            drills: &["drill-lamp"],
            also: &["drill-search", "drill-framing"],
            tamper: |hands, message| on_picture(hands, message, photograph_without_lamp),
            ..NO_WEAKNESS
        },
        action: action("defects whose pictures are too dark", |r| with_reason(r, "too dark"), 1.0),
    },
    Unseen {
        weakness: Weakness {
            name: "sways from side to side in the gap",
            drills: &["drill-gap"],
            also: &[
                "drill-hover",
                "drill-straight-line",
                "drill-stand-off",
                "drill-lamp",
                "drill-search",
                "practice",
                "two-bridges",
            ],
            tamper: |hands, message| {
                with_sticks(hands, message, |hands, [x, y, z, r]| {
                    let sway = SWAY_STICK * wave(hands.stick_messages as f64, SWAY_PERIOD as f64);
                    [x, if hands.flies_task(GAP) { y + sway } else { y }, z, r]
                })
            },
            ..NO_WEAKNESS
        },
        action: action("stick reversals per minute in the gap", |r| technique(r, GAP).stick_reversals_per_min, 15.0),
    },
    Unseen {
        weakness: Weakness {
            name: "looks into the gap from outside",
            drills: &["drill-gap"],
            also: &["drill-lamp", "drill-search", "drill-framing", "practice", "two-bridges"],
            belief: pass_gap_outside,
            ..NO_WEAKNESS
        },
        action: action("covered share of the gap", |r| task(r, GAP).covered.unwrap(), -0.5),
    },
    Unseen {
        weakness: Weakness {
            name: "rises behind the pier",
            drills: &["drill-orbit"],
            also: &["drill-hover", "drill-stand-off", "drill-framing", "drill-search", "practice", "two-bridges"],
            belief: |job| reshape(job, TaskKind::PierCircle, |at| up(BEHIND_PIER_M * (-at.view.east()).max(0.0))),
            ..NO_WEAKNESS
        },
        action: action("covered share of the circle", |r| task(r, PIER).covered.unwrap(), -0.15),
    },
    Unseen {
        weakness: Weakness {
            name: "circles the pier on the other shore",
            drills: &["practice", "two-bridges"],
            also: &["drill-orbit", "drill-search"],
            belief: take_the_other_pier,
            ..NO_WEAKNESS
        },
        action: action("tasks done", |r| r.completion.unwrap().tasks_done as f64, -1.0),
    },
    Unseen {
        weakness: Weakness {
            name: "has no eye for distances",
            drills: &["drill-stand-off"],
            also: &[
                "drill-straight-line",
                "drill-curve-under-arch",
                "drill-gap",
                "drill-orbit",
                "drill-hover",
                "drill-framing",
                "drill-search",
                "practice",
                "two-bridges",
            ],
            skill: Skill { distance_error: 0.5, ..Skill::EXPERT },
            ..NO_WEAKNESS
        },
        action: action("RMS distance to the path, thresholds", |r| precision(r).rms_distance_ratio, 0.1),
    },
    Unseen {
        weakness: Weakness {
            name: "looks at the drone instead of the picture",
            drills: &["drill-search"],
            also: &["drill-framing", "practice", "two-bridges"],
            skill: Skill { look_spacing_m: 1000.0, fixation_s: 2.0, fixation_area: 0.15, ..Skill::EXPERT },
            ..NO_WEAKNESS
        },
        action: action("defects found", found, -2.0),
    },
    Unseen {
        weakness: Weakness {
            name: "takes mild defects for sound surfaces",
            drills: &["drill-search"],
            also: &["drill-framing", "practice", "two-bridges"],
            belief: |job| keep_defects(job, |defect| defect.condition_state > MILD),
            ..NO_WEAKNESS
        },
        action: action("defects found", found, -2.0),
    },
    Unseen {
        weakness: Weakness {
            name: "turns away before the shutter opens",
            drills: &["drill-framing"],
            also: &["drill-search", "drill-hover"],
            tamper: |hands, message| {
                before_picture(hands, message, TURNING_AWAY, |sticks| MANUAL_CONTROL_DATA {
                    r: (FULL_STICK * TURNING_AWAY_STICK) as i16,
                    ..sticks
                })
            },
            ..NO_WEAKNESS
        },
        action: action("defects found", found, -2.0),
    },
    Unseen {
        weakness: Weakness {
            name: "stares at every surface",
            drills: &["practice", "two-bridges", "drill-search"],
            also: &["drill-straight-line"],
            skill: Skill { look_duration_s: 3.5, ..Skill::EXPERT },
            ..NO_WEAKNESS
        },
        action: action("flight time, s", |r| r.seconds, 180.0),
    },
    Unseen {
        weakness: Weakness {
            name: "comes home with two thirds of the battery",
            drills: &["practice", "two-bridges"],
            also: &["drill-orbit", "drill-gap", "drill-search", "drill-lamp"],
            skill: Skill { return_battery_pct: 70.0, ..Skill::EXPERT },
            ..NO_WEAKNESS
        },
        action: action("tasks done", |r| r.completion.unwrap().tasks_done as f64, -1.0),
    },
    Unseen {
        weakness: Weakness {
            name: "scrapes the bridge between the tasks",
            drills: &["drill-stand-off", "practice"],
            also: &["drill-hover", "drill-straight-line", "drill-framing", "drill-search", "two-bridges"],
            tamper: |hands, message| {
                with_sticks_while(hands, message, Hands::in_transit, |hands, axes| bump(hands, axes, &BUMPS))
            },
            ..NO_WEAKNESS
        },
        action: action("contacts outside the tasks", |r| r.contacts_outside().bridge as f64, 2.0),
    },
    Unseen {
        weakness: Weakness {
            name: "lets the throttle follow the yaw",
            drills: &["drill-hover", "drill-straight-line"],
            also: &[
                "drill-orbit",
                "drill-gap",
                "drill-curve-under-arch",
                "drill-stand-off",
                "drill-framing",
                "drill-search",
                "practice",
                "two-bridges",
            ],
            tamper: |hands, message| with_sticks(hands, message, |_, [x, y, z, r]| [x, y, z + THROTTLE_WITH_YAW * r.abs(), r]),
            ..NO_WEAKNESS
        },
        action: action("RMS distance to the path, thresholds", |r| precision(r).rms_distance_ratio, 0.1),
    },
    Unseen {
        weakness: Weakness {
            name: "overcorrects in gusts",
            drills: &["drill-hover"],
            also: &[
                "drill-straight-line",
                "drill-stand-off",
                "drill-orbit",
                "drill-gap",
                "drill-curve-under-arch",
                "drill-framing",
                "drill-search",
                "practice",
                "two-bridges",
            ],
            tamper: |hands, message| with_sticks(hands, message, answer_gusts),
            ..NO_WEAKNESS
        },
        action: action("stick reversals per minute", reversals_per_min, 5.0),
    },
    Unseen {
        weakness: Weakness {
            name: "switches the motors off above the pad",
            drills: &["drill-landing"],
            also: &[],
            tamper: |hands, message| {
                let is_due = hands.lands() && hands.height_m() < MOTORS_OFF_M && hands.stick_messages == 0;
                hands.stick_messages += u64::from(is_due);
                if is_due { vec![message, motors_off()] } else { vec![message] }
            },
            ..NO_WEAKNESS
        },
        action: action("crashes outside the tasks", |r| r.crashes_outside.total() as f64, 1.0),
    },
    Unseen {
        weakness: Weakness {
            name: "balks at landing",
            drills: &["drill-landing"],
            also: &["drill-hover", "practice", "two-bridges"],
            tamper: |hands, message| match message {
                MavMessage::MANUAL_CONTROL(sticks) if hands.lands() => {
                    hands.stick_messages += 1;
                    let balks = hands.stick_messages < BALKING && hands.stick_messages % BALKING_PERIOD >= SINKING;
                    let z = if balks { BALKING_THROTTLE } else { sticks.z };
                    vec![MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { z, ..sticks })]
                }
                other => vec![other],
            },
            ..NO_WEAKNESS
        },
        action: action("flight time, s", |r| r.seconds, 180.0),
    },
];

fn north(by_m: f64) -> Vec3<Enu> {
    Vec3::new(0.0, by_m, 0.0)
}

fn tilt_down_at_slab(job: &mut Scenario) {
    for view in tasks_of(job, TaskKind::SlabSide).flat_map(|task| &mut task.viewing_directions) {
        *view = turned(*view, view.cross(up(1.0)), -TILT_RAD);
    }
}

/// Flies along the bridge at the height of the gap, but north of the deck, and looks in.
fn pass_gap_outside(job: &mut Scenario) {
    reshape(job, TaskKind::Interlayer, |_| north(OUTSIDE_GAP_M));
    for view in tasks_of(job, TaskKind::Interlayer).flat_map(|task| &mut task.viewing_directions) {
        *view = north(-1.0);
    }
}

/// Mistakes the suspension bridge's other pier for the one to inspect: the bridge is symmetrical about a plane through the origin.
fn take_the_other_pier(job: &mut Scenario) {
    let mirrored = |v: Vec3<Enu>| Vec3::new(-v.east(), v.north(), v.up());
    for task in tasks_of(job, TaskKind::PierCircle) {
        task.path_m.iter_mut().for_each(|point| *point = mirrored(*point));
        task.viewing_directions.iter_mut().for_each(|view| *view = mirrored(*view));
    }
}

fn photograph_without_lamp(hands: &mut Hands, picture: MavMessage) -> Vec<MavMessage> {
    if !hands.flies_task(ARCH) && !hands.flies_task(GAP) {
        return vec![picture];
    }
    owe(hands, LAMP_OFF_BEFORE, picture);
    owe(hands, LAMP_OFF, lamp(1.0));
    vec![lamp(0.0)]
}

/// Returns the command that switches the lamp on with 1 and off with 0.
fn lamp(on: f32) -> MavMessage {
    to_autopilot(MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, [on, 0.0])
}

fn motors_off() -> MavMessage {
    to_autopilot(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [0.0, FORCED])
}

fn to_autopilot(command: MavCmd, [first, second]: [f32; 2]) -> MavMessage {
    MavMessage::COMMAND_LONG(station::command(1, 1, command, [first, second, 0.0, 0.0, 0.0, 0.0, 0.0]))
}

fn answer_gusts(hands: &mut Hands, [x, y, z, r]: [f64; 4]) -> [f64; 4] {
    if hands.stick_messages % ANSWER_PERIOD >= ANSWER {
        return [x, y, z, r];
    }
    let angle_rad = math::TAU * hands.stick_messages as f64 / ANSWER_WAVELENGTH;
    let (sin, cos) = math::sin_cos(angle_rad);
    [x + ANSWER_STICK * sin, y + ANSWER_STICK * cos, z, r]
}

fn reversals_per_min(record: &SessionRecord) -> f64 {
    let of_tasks = record.tasks.iter().filter_map(|task| task.technique);
    let (reversals, minutes) = of_tasks.fold((0.0, 0.0), |(reversals, minutes), one| {
        let near_min = one.near_s / 60.0;
        (reversals + one.stick_reversals_per_min * near_min, minutes + near_min)
    });
    reversals / minutes
}
