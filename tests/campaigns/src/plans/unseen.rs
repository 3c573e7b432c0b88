//! Faults by another author than the rules of the plan: the author had read the drills, but neither the rules nor any plan for
//! these faults. Sizes and expected drills are an instructor's judgment (estimates), and were fixed before the first plan. After the
//! first flights (docs/src/measured/plans.md), the rules were adjusted to the six that they had not recognized.
//!
//! Don't change a fault or its expected drills because of a plan.

use crate::table::Flown;
use crate::weaknesses::{Hands, NO_WEAKNESS, Weakness, command, with_sticks};
use spandrel_mavlink::dialect::{MANUAL_CONTROL_DATA, MavCmd, MavMessage};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{PlacedDefect, Scenario, Task, TaskKind};
use spandrel_monitor::score::certification::precision::PrecisionMeasures;
use spandrel_training::record::{SessionRecord, TaskRecord};
use std::fmt;

/// A fault, and how it shows in the record of the flight.
pub struct Unseen {
    pub weakness: Weakness,
    pub action: Action,
}

/// The measure by which a fault shows: its change from a flight with the same seed but no fault.
pub struct Action {
    measure: &'static str,
    of: fn(&SessionRecord) -> f64,
    /// Smallest change that counts: an increase if positive, a decrease if negative.
    least_change: f64,
}

pub const fn action(measure: &'static str, of: fn(&SessionRecord) -> f64, least_change: f64) -> Action {
    Action { measure, of, least_change }
}

/// Messages of the sticks per second.
pub const STICK_RATE_HZ: u64 = 50;
/// Lowest throttle in MANUAL_CONTROL, and the one that holds the height.
pub const LOWEST_THROTTLE: i16 = 0;
pub const NEUTRAL_THROTTLE: i16 = 500;

/// Numbers of the tasks in the job.
pub const SLAB: u32 = 1;
pub const ARCH: u32 = 2;
pub const GAP: u32 = 3;
pub const PIER: u32 = 4;

/// The porpoising pilot rises and falls by 4 m every 30 m.
const PORPOISE_M: f64 = 4.0;
const PORPOISE_WAVELENGTH_M: f64 = 30.0;
/// The swinging pilot is between 1.8 and 9.8 m from the slab, every 30 m: 4 m on either side of 1.3 m too far away.
const SWING_M: f64 = 4.0;
const SWING_CENTER_M: f64 = 1.3;
const SWING_WAVELENGTH_M: f64 = 30.0;
/// Share of the gap that the pilot flies before turning back.
const GAP_SHARE: f64 = 0.3;
/// Share of the arch's rise that the pilot follows.
const RISE_SHARE: f64 = 0.5;
/// The pilot hugs the slab 2.6 m closer than the path: at 1.9 m instead of 4.5 m.
const HUG_M: f64 = 2.6;
/// Displacement of the circle around the pier, with the wind from 240 degrees, east and north, m: 3.2 m together.
const DOWNWIND_M: (f64, f64) = (2.77, 1.6);
/// Place of the landing beside the pad, east and north of it, m: 9.2 m, while the home radius is 5 m.
const BESIDE_PAD_M: (f64, f64) = (7.0, -6.0);
/// The shutter is pressed late by this many stick messages: 4 s.
const LATE_SHUTTER: u64 = 4 * STICK_RATE_HZ;
/// Further pictures of everything, and the stick messages between two of them: 0.5 s.
const FURTHER_PICTURES: u64 = 4;
const FURTHER_PICTURE_PERIOD: u64 = STICK_RATE_HZ / 2;
/// Distance from a defect to the stain beside it that the pilot takes for another one, m.
const STAIN_M: f64 = 1.5;
/// First number of the stains, above those of all defects.
const FIRST_STAIN: u32 = 1000;
/// Northing that separates the two bridges, m.
const BETWEEN_BRIDGES_M: f64 = 75.0;
/// The hesitant pilot lets go of the sticks for 4 s out of 6 s.
const HESITATION: u64 = 4 * STICK_RATE_HZ;
const HESITATION_PERIOD: u64 = 6 * STICK_RATE_HZ;
/// The pilot's hands are late by 0.6 s.
const LATE_STICKS: usize = 30;
/// Eyes on the screen, the pilot lets the drone sink for 4 s out of 12 s, with this deflection: 1.4 m/s.
const SINKING: u64 = 4 * STICK_RATE_HZ;
const SINKING_PERIOD: u64 = 12 * STICK_RATE_HZ;
const SINKING_STICK: f64 = -0.7;

/// The faults. To fly the job again is no mistake where a fault leaves a task undone.
pub const UNSEEN: &[Unseen] =
    &[
        Unseen {
            weakness: Weakness {
                name: "porpoises along the slab",
                drills: &["drill-straight-line"],
                also: &["drill-stand-off", "drill-framing", "drill-hover", "drill-search", "practice", "two-bridges"],
                belief: |job| reshape(job, TaskKind::SlabSide, |at| up(PORPOISE_M * wave(at.along_m, PORPOISE_WAVELENGTH_M))),
                ..NO_WEAKNESS
            },
            action: action("share of the slab's window on its path", |r| task(r, SLAB).on_path, -0.25),
        },
        Unseen {
            weakness: Weakness {
                name: "swings toward and away from the slab",
                drills: &["drill-stand-off", "drill-straight-line"],
                also: &["drill-framing", "drill-hover", "drill-search", "practice", "two-bridges"],
                belief: |job| {
                    reshape(job, TaskKind::SlabSide, |at| {
                        at.view * -(SWING_CENTER_M + SWING_M * wave(at.along_m, SWING_WAVELENGTH_M))
                    });
                },
                ..NO_WEAKNESS
            },
            action: action("share of the slab's window on its path", |r| task(r, SLAB).on_path, -0.1),
        },
        Unseen {
            weakness: Weakness {
                name: "turns back in the gap",
                drills: &["drill-gap"],
                also: &["practice", "two-bridges", "drill-search", "drill-lamp"],
                belief: turn_back_in_gap,
                ..NO_WEAKNESS
            },
            action: action("covered share of the gap", covered_gap, -0.5),
        },
        Unseen {
            weakness: Weakness {
                name: "flattens the curve under the arch",
                drills: &["drill-curve-under-arch"],
                also: &["drill-stand-off", "drill-search", "drill-framing", "drill-lamp", "practice", "two-bridges"],
                belief: flatten_arch,
                ..NO_WEAKNESS
            },
            action: action("share of the arch's window on its path", |r| task(r, ARCH).on_path, -0.25),
        },
        Unseen {
            weakness: Weakness {
                name: "hugs the slab",
                drills: &["drill-stand-off"],
                also: &["drill-straight-line", "drill-framing"],
                belief: |job| reshape(job, TaskKind::SlabSide, |at| at.view * HUG_M),
                ..NO_WEAKNESS
            },
            action: action("share of frames too close to something", |r| precision(r).low_clearance_share, 0.1),
        },
        Unseen {
            weakness: Weakness {
                name: "circles the pier nose first",
                drills: &["drill-orbit"],
                also: &["drill-framing", "drill-search", "drill-stand-off"],
                belief: |job| nose_first(job, TaskKind::PierCircle),
                ..NO_WEAKNESS
            },
            action: action("RMS framing error, degrees", framing_deg, 5.0),
        },
        Unseen {
            weakness: Weakness {
                name: "lets the circle around the pier drift downwind",
                drills: &["drill-orbit", "drill-stand-off"],
                also: &["drill-hover", "drill-search", "drill-framing", "practice", "two-bridges"],
                belief: |job| reshape(job, TaskKind::PierCircle, |_| Vec3::new(DOWNWIND_M.0, DOWNWIND_M.1, 0.0)),
                ..NO_WEAKNESS
            },
            action: action("share of the pier's window on its path", |r| task(r, PIER).on_path, -0.2),
        },
        Unseen {
            weakness: Weakness {
                name: "forgets the pier",
                drills: &["two-bridges", "practice", "drill-orbit"],
                also: &["drill-search"],
                belief: |job| job.tasks.retain(|task| task.kind != TaskKind::PierCircle),
                ..NO_WEAKNESS
            },
            action: action("tasks done", |r| r.completion.as_ref().map_or(0.0, |done| done.tasks_done as f64), -1.0),
        },
        Unseen {
            weakness: Weakness {
                name: "flies the slab nose first",
                drills: &["drill-framing"],
                also: &["drill-straight-line", "drill-search"],
                belief: |job| nose_first(job, TaskKind::SlabSide),
                ..NO_WEAKNESS
            },
            action: action("RMS framing error, degrees", framing_deg, 5.0),
        },
        Unseen {
            weakness: Weakness {
                name: "never tilts the camera",
                drills: &["drill-framing"],
                also: &["drill-search", "drill-curve-under-arch", "drill-gap", "drill-lamp", "drill-stand-off"],
                tamper: |_, message| {
                    let tilts = command(&message) == Some(MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW);
                    if tilts { Vec::new() } else { vec![message] }
                },
                ..NO_WEAKNESS
            },
            action: action("defects found", found, -3.0),
        },
        Unseen {
            weakness: Weakness {
                name: "presses the shutter when already flying on",
                drills: &["drill-framing"],
                also: &["drill-hover", "drill-search"],
                tamper: |hands, message| delay_picture(hands, message, LATE_SHUTTER),
                ..NO_WEAKNESS
            },
            action: action("accuracy of the certification", certification_accuracy, -20.0),
        },
        Unseen {
            weakness: Weakness {
                name: "photographs everything five times",
                drills: &["drill-search", "drill-framing"],
                also: &["practice", "two-bridges"],
                tamper: |hands, message| {
                    on_picture(hands, message, |hands, picture| {
                        (1..=FURTHER_PICTURES).for_each(|k| owe(hands, k * FURTHER_PICTURE_PERIOD, picture.clone()));
                        vec![picture]
                    })
                },
                ..NO_WEAKNESS
            },
            action: action("pictures without a new defect", idle_pictures, 12.0),
        },
        Unseen {
            weakness: Weakness {
                name: "takes stains for defects",
                drills: &["drill-search"],
                also: &["drill-framing"],
                belief: see_stains,
                ..NO_WEAKNESS
            },
            action: action("pictures without a new defect", idle_pictures, 4.0),
        },
        Unseen {
            weakness: Weakness {
                name: "does not photograph at the second bridge",
                drills: &["drill-search"],
                also: &["drill-orbit", "drill-framing", "practice", "two-bridges"],
                belief: |job| keep_defects(job, |defect| defect.position_m.north() < BETWEEN_BRIDGES_M),
                ..NO_WEAKNESS
            },
            action: action("defects found at the pier", |r| task(r, PIER).defects_found as f64, -1.0),
        },
        Unseen {
            weakness: Weakness {
                name: "leaves the lamp off in the gap",
                drills: &["drill-lamp"],
                also: &["drill-gap", "drill-search"],
                belief: |job| tasks_of(job, TaskKind::Interlayer).for_each(|task| task.dark = false),
                ..NO_WEAKNESS
            },
            action: action("share of the time in the gap with the lamp off", lamp_off_in_gap, 0.8),
        },
        Unseen {
            weakness: Weakness {
                name: "hesitates on the sticks",
                drills: &["drill-straight-line", "practice", "two-bridges"],
                also: &["drill-hover", "drill-landing", "drill-search", "drill-framing"],
                tamper: |hands, message| {
                    with_sticks(hands, message, |hands, axes| {
                        if hands.stick_messages % HESITATION_PERIOD < HESITATION { [0.0; 4] } else { axes }
                    })
                },
                ..NO_WEAKNESS
            },
            action: action("flight time, s", |r| r.seconds, 240.0),
        },
        Unseen {
            weakness: Weakness {
                name: "is late on the sticks",
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
                tamper: |hands, message| with_sticks(hands, message, follow_late),
                ..NO_WEAKNESS
            },
            action: action("RMS distance to the path, thresholds", |r| precision(r).rms_distance_ratio, 0.1),
        },
        Unseen {
            weakness: Weakness {
                name: "sinks with the eyes on the screen",
                drills: &["drill-straight-line", "drill-hover"],
                also: &["drill-curve-under-arch", "drill-stand-off", "drill-framing", "drill-search", "practice", "two-bridges"],
                tamper: |hands, message| {
                    with_sticks(hands, message, |hands, [x, y, z, r]| {
                        let sinks = hands.flies_task(SLAB) || hands.flies_task(ARCH);
                        let looks = hands.stick_messages % SINKING_PERIOD < SINKING;
                        [x, y, if sinks && looks { SINKING_STICK } else { z }, r]
                    })
                },
                ..NO_WEAKNESS
            },
            action: action("share of the slab's window on its path", |r| task(r, SLAB).on_path, -0.1),
        },
        Unseen {
            weakness: Weakness {
                name: "lands beside the pad",
                drills: &["drill-landing"],
                also: &["practice", "two-bridges"],
                belief: |job| job.ground_team.pad_m += Vec3::new(BESIDE_PAD_M.0, BESIDE_PAD_M.1, 0.0),
                ..NO_WEAKNESS
            },
            action: action("landed at home", landed_at_home, -1.0),
        },
        Unseen {
            weakness: Weakness {
                name: "drops onto the pad",
                drills: &["drill-landing"],
                also: &[],
                tamper: |hands, message| match message {
                    MavMessage::MANUAL_CONTROL(sticks) if hands.lands() && sticks.z < NEUTRAL_THROTTLE => {
                        vec![MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { z: LOWEST_THROTTLE, ..sticks })]
                    }
                    other => vec![other],
                },
                ..NO_WEAKNESS
            },
            action: action("crashes outside the tasks", |r| r.crashes_outside.total() as f64, 1.0),
        },
    ];

/// A point of a path to be reshaped.
pub struct PathPlace {
    /// Distance from the path's start, m.
    pub along_m: f64,
    /// Direction to the surface.
    pub view: Vec3<Enu>,
}

pub fn up(by_m: f64) -> Vec3<Enu> {
    Vec3::new(0.0, 0.0, by_m)
}

pub fn wave(along_m: f64, wavelength_m: f64) -> f64 {
    math::sin(math::TAU * along_m / wavelength_m)
}

pub fn tasks_of(job: &mut Scenario, kind: TaskKind) -> impl Iterator<Item = &mut Task> {
    job.tasks.iter_mut().filter(move |task| task.kind == kind)
}

/// Returns the direction from a path point to the next one, or to the last one from the one before.
fn direction(path_m: &[Vec3<Enu>], at: usize) -> Vec3<Enu> {
    let from = at.min(path_m.len() - 2);
    (path_m[from + 1] - path_m[from]).unit()
}

/// Moves the points of the paths of a kind.
pub fn reshape(job: &mut Scenario, kind: TaskKind, offset_m: impl Fn(&PathPlace) -> Vec3<Enu>) {
    for task in tasks_of(job, kind) {
        let path_m = task.path_m.clone();
        let mut along_m = 0.0;
        for (k, point) in task.path_m.iter_mut().enumerate() {
            along_m += (path_m[k] - path_m[k.saturating_sub(1)]).norm();
            *point += offset_m(&PathPlace { along_m, view: task.viewing_directions[k] });
        }
    }
}

/// Goes into the gap from the end at which the arch's path ends, and back out.
fn turn_back_in_gap(job: &mut Scenario) {
    for task in tasks_of(job, TaskKind::Interlayer) {
        let inside = (GAP_SHARE * task.path_m.len() as f64) as usize;
        let out = (0..inside).map(|k| task.path_m.len() - 1 - k);
        let way: Vec<usize> = out.clone().chain(out.rev().skip(1)).collect();
        task.viewing_directions = way.iter().map(|k| task.viewing_directions[*k]).collect();
        task.path_m = way.iter().map(|k| task.path_m[*k]).collect();
    }
}

/// Lowers the path under the arch toward the height of its lower end.
fn flatten_arch(job: &mut Scenario) {
    for task in tasks_of(job, TaskKind::ArchBottom) {
        let lowest_m = task.path_m.iter().map(|point| point.up()).fold(f64::INFINITY, f64::min);
        for point in &mut task.path_m {
            *point += up((RISE_SHARE - 1.0) * (point.up() - lowest_m));
        }
    }
}

/// Looks along the path instead of at the surface. The paths are flown from their first point.
fn nose_first(job: &mut Scenario, kind: TaskKind) {
    for task in tasks_of(job, kind) {
        task.viewing_directions = (0..task.path_m.len()).map(|k| direction(&task.path_m, k)).collect();
    }
}

/// Leaves only some of the defects for the pilot to see.
pub fn keep_defects(job: &mut Scenario, keep: fn(&PlacedDefect) -> bool) {
    job.defects.placed.as_mut().unwrap().retain(keep);
}

/// Puts a stain on either side of every defect.
fn see_stains(job: &mut Scenario) {
    let placed = job.defects.placed.as_mut().unwrap();
    let sides = placed.iter().flat_map(|defect| [(defect, STAIN_M), (defect, -STAIN_M)]);
    let stains: Vec<PlacedDefect> = (FIRST_STAIN..)
        .zip(sides)
        .map(|(id, (defect, side_m))| PlacedDefect {
            id,
            position_m: defect.position_m + defect.along * side_m,
            ..defect.clone()
        })
        .collect();
    placed.extend(stains);
}

/// Promises a message after a number of stick messages.
pub fn owe(hands: &mut Hands, after: u64, message: MavMessage) {
    hands.owed.push_back((hands.stick_messages + after, message));
}

/// Holds back each picture for a number of stick messages.
pub fn delay_picture(hands: &mut Hands, message: MavMessage, by: u64) -> Vec<MavMessage> {
    on_picture(hands, message, |hands, picture| {
        owe(hands, by, picture);
        Vec::new()
    })
}

/// Changes the command to take a picture, and sends what the hands still owe.
pub fn on_picture(
    hands: &mut Hands,
    message: MavMessage,
    change: impl FnOnce(&mut Hands, MavMessage) -> Vec<MavMessage>,
) -> Vec<MavMessage> {
    on_command(hands, message, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, change)
}

/// Changes a command, and sends what the hands still owe.
pub fn on_command(
    hands: &mut Hands,
    message: MavMessage,
    changed: MavCmd,
    change: impl FnOnce(&mut Hands, MavMessage) -> Vec<MavMessage>,
) -> Vec<MavMessage> {
    if command(&message) == Some(changed) {
        return change(hands, message);
    }
    hands.stick_messages += u64::from(matches!(message, MavMessage::MANUAL_CONTROL(_)));
    let mut sent = Vec::new();
    while let Some((_, owed)) = hands.owed.pop_front_if(|(due, _)| *due <= hands.stick_messages) {
        sent.push(owed);
    }
    sent.push(message);
    sent
}

fn follow_late(hands: &mut Hands, axes: [f64; 4]) -> [f64; 4] {
    hands.late_sticks.push_back(axes);
    let is_due = hands.late_sticks.len() > LATE_STICKS;
    if is_due { hands.late_sticks.pop_front().unwrap() } else { [0.0; 4] }
}

pub fn task(record: &SessionRecord, id: u32) -> &TaskRecord {
    record.tasks.iter().find(|task| task.id == id).unwrap()
}

fn covered_gap(record: &SessionRecord) -> f64 {
    task(record, GAP).covered.unwrap()
}

pub fn precision(record: &SessionRecord) -> PrecisionMeasures {
    record.certification.as_ref().and_then(|certification| certification.precision).unwrap()
}

pub fn framing_deg(record: &SessionRecord) -> f64 {
    precision(record).rms_framing_deg.unwrap()
}

pub fn certification_accuracy(record: &SessionRecord) -> f64 {
    record.certification.as_ref().and_then(|certification| certification.scores.accuracy).unwrap()
}

pub fn idle_pictures(record: &SessionRecord) -> f64 {
    (record.snapshots - record.hits) as f64
}

fn lamp_off_in_gap(record: &SessionRecord) -> f64 {
    task(record, GAP).technique.and_then(|technique| technique.lamp_off).unwrap()
}

pub fn found(record: &SessionRecord) -> f64 {
    record.defects.iter().filter(|defect| defect.found).count() as f64
}

fn landed_at_home(record: &SessionRecord) -> f64 {
    f64::from(u8::from(record.end_reason == "landed"))
}

/// How a fault shows in one flight.
struct Effect {
    fault: &'static Unseen,
    seed: u64,
    faultless: f64,
    faulty: f64,
    summary: String,
}

impl Effect {
    fn acts(&self) -> bool {
        let (change, least) = (self.faulty - self.faultless, self.fault.action.least_change);
        change * least.signum() >= least.abs()
    }
}

/// The effects of all faults, and the flights that they are compared with.
pub struct EffectTable {
    effects: Vec<Effect>,
    faultless: Vec<String>,
}

impl EffectTable {
    /// Compares every flight with a fault with the faultless one with the same seed.
    pub fn of(faults: &'static [Unseen], flown: &[Flown], seeds: &[u64]) -> Self {
        let (faultless, faulty) = flown.split_at(seeds.len());
        let of = |(k, one): (usize, &Flown)| {
            let (fault, base) = (&faults[k / seeds.len()], &faultless[k % seeds.len()]);
            let of = fault.action.of;
            let (faultless, faulty) = (of(&base.record), of(&one.record));
            Effect { fault, seed: one.seed, faultless, faulty, summary: summary(&one.record) }
        };
        Self {
            effects: faulty.iter().enumerate().map(of).collect(),
            faultless: faultless.iter().map(|one| format!("no fault, seed {}: {}", one.seed, summary(&one.record))).collect(),
        }
    }

    /// Returns the flights in which a fault does not show.
    pub fn without_effect(&self) -> Vec<String> {
        let idle = self.effects.iter().filter(|one| !one.acts());
        idle.map(|one| format!("{}, seed {}", one.fault.weakness.name, one.seed)).collect()
    }
}

/// Returns the end, the scores and the tasks of a flight in a few words.
fn summary(record: &SessionRecord) -> String {
    let tasks = record.tasks.iter().map(|task| {
        let (on_path, covered) = (100.0 * task.on_path, 100.0 * task.covered.unwrap_or(0.0));
        format!("{on_path:.0}/{covered:.0}/{}", task.crashes.total())
    });
    let (end, minutes, outside) = (&record.end_reason, record.seconds / 60.0, record.crashes_outside.total());
    let tasks: Vec<String> = tasks.collect();
    let pictures = format!("{:.0} found in {} of {} pictures", found(record), record.hits, record.snapshots);
    format!("{end} after {minutes:.1} min; {}; {outside} crashes outside; {pictures}", tasks.join(", "))
}

impl fmt::Display for EffectTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "| fault | seed | measure | faultless | faulty | acts | flight (task: % on path/% covered/crashes) |\n|---|---|---|---|---|---|---|"
        )?;
        for one in &self.effects {
            let Effect { fault, seed, faultless, faulty, summary } = one;
            let (name, measure, acts) = (fault.weakness.name, fault.action.measure, if one.acts() { "yes" } else { "no" });
            writeln!(f, "| {name} | {seed} | {measure} | {faultless:.2} | {faulty:.2} | {acts} | {summary} |")?;
        }
        write!(f, "\n{}", self.faultless.join("\n"))
    }
}
