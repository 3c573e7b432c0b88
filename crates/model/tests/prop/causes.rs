//! Tests of defects that are placed by their causes, at the shipped girder bridge, and of placement without causes, which must keep every
//! bit.

use spandrel_model::defect_codes;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{self, DefectCause, DefectPlacement, DefectSpec, PlacedDefect, Scenario, TaskKind, resolve};
use spandrel_model::shipped::SCENARIOS;
use spandrel_model::site::Site;
use spandrel_model::site::defects::{self, PlacementContext};
use spandrel_model::time::SimTime;
use std::collections::{BTreeMap, BTreeSet};

/// Number of defects and checksum of jobs at seed 7.
const EXPECTED: [(&str, usize, u32); 4] = [
    ("two-bridges", 10, 0x7a95_28ee),
    ("girder", 12, 0xf185_a85c),
    ("certification", 64, 0x6fcd_2ed6),
    ("practice", 6, 0x055c_2579),
];

/// Number of seeds of the girder job that are tested.
const SEED_COUNT: u64 = 24;

fn shipped_text(name: &str) -> &'static str {
    SCENARIOS.iter().find(|(stem, _)| *stem == name).unwrap().1
}

fn shipped_job(name: &str) -> Scenario {
    scenario::read(name, shipped_text(name), &|file| Err(format!("no file {file}"))).unwrap()
}

fn sites(job: &Scenario) -> impl Iterator<Item = (u64, Site)> + '_ {
    (0..SEED_COUNT).map(|seed| (seed, Site::build(job, seed)))
}

fn is_photographable(defect: &PlacedDefect, job: &Scenario, site: &Site) -> bool {
    let cast = |origin, direction, max_m| site.geometry().ray(origin, direction, max_m);
    let ambient = |p, n| site.ambient_lux(p, Some(n), SimTime::ZERO);
    let clearance = |p| site.geometry().nearest(p, defects::CAMERA_CLEARANCE_M).map_or(f64::INFINITY, |near| near.distance_m);
    let context = PlacementContext {
        members: site.members(),
        tasks: &job.tasks,
        cast: &cast,
        ambient: &ambient,
        clearance_m: &clearance,
        water_up_m: job.terrain.water_level_m,
    };
    job.tasks.iter().any(|task| defects::find_view(defect, task, &context).is_some())
}

#[test]
fn prop_all_defects_with_causes_are_permitted_photographable_and_apart() {
    /// Minimum distance between two defects, m: half of the usual one (`ATTEMPTS` relaxes it near the end).
    const MIN_DISTANCE_M: f64 = 0.2;
    let job = shipped_job("girder");
    let mut causes = BTreeMap::new();
    let mut states = BTreeMap::new();
    for (seed, site) in sites(&job) {
        let placed = site.defects();
        assert_eq!(placed.len(), job.defects.count, "seed {seed}");
        for (k, defect) in placed.iter().enumerate() {
            assert!(defect.element.permitted_defects().contains(&defect.kind), "seed {seed}: {defect:?}");
            assert!((2..=4).contains(&defect.condition_state), "seed {seed}: {defect:?}");
            assert!(is_photographable(defect, &job, &site), "seed {seed}: {defect:?}");
            let near = placed[k + 1..].iter().any(|other| (other.position_m - defect.position_m).norm() < MIN_DISTANCE_M);
            assert!(!near, "seed {seed}: {defect:?}");
            *causes.entry(defect.cause.unwrap()).or_insert(0) += 1;
            *states.entry(defect.condition_state).or_insert(0) += 1;
        }
    }
    println!("{causes:?}, condition states {states:?}");
    assert!(causes.len() >= 9 && states.len() == 3, "{causes:?}, {states:?}");
}

#[test]
fn prop_stains_are_below_their_defects() {
    let job = shipped_job("girder");
    let (mut on_walls, mut on_undersides) = (0, 0);
    for (_, site) in sites(&job) {
        for (defect, stain) in site.defects().iter().filter_map(|defect| Some((defect, defect.stain_patch()?))) {
            if defect.normal.up() < -0.8 {
                assert_eq!(stain.center_m, defect.position_m);
                on_undersides += 1;
                continue;
            }
            let down = defect.position_m - stain.center_m;
            assert!(down.up() > 0.0 && down.horizontal_norm() < 0.35 * down.norm(), "{defect:?}: {stain:?}");
            // The stain and the defect touch: the sum of their half extents is their distance.
            let extent_m = defect.half_extent_m(stain.along) + 0.5 * stain.length_m;
            assert!((down.norm() - extent_m).abs() < 1e-9, "{defect:?}: {stain:?}");
            on_walls += 1;
        }
    }
    assert!(on_walls > 5 && on_undersides > 5, "{on_walls} on walls, {on_undersides} on undersides");
}

#[test]
fn prop_water_damage_is_at_joints_and_drains() {
    /// Maximum horizontal distance between the middle of a defect and the joint or drain, m: 1.2 girder depths, and the jitter.
    const MAX_DISTANCE_M: f64 = 2.5;
    let job = shipped_job("girder");
    let mut seen = BTreeMap::new();
    for (_, site) in sites(&job) {
        let sources = |word: &str| -> Vec<&[Vec3<Enu>]> {
            let named = site.members().iter().filter(|member| member.name.starts_with(&format!("girder/{word}")));
            named.map(|member| member.solid.vertices_m.as_slice()).collect()
        };
        let (joints, drains) = (sources("joint"), sources("drain"));
        for defect in site.defects() {
            let near = match defect.cause {
                Some(DefectCause::LeakingJoint) => &joints,
                Some(DefectCause::Drain) => &drains,
                _ => continue,
            };
            // The bridge's axes are those of the site, and joints are as wide as the deck.
            let distance_m = |vertices: &&[Vec3<Enu>]| {
                let gap = |value: f64, all: Vec<f64>| {
                    let (low, high) = spandrel_model::math::range(all.into_iter());
                    (low - value).max(value - high).max(0.0)
                };
                let east = gap(defect.position_m.east(), vertices.iter().map(|v| v.east()).collect());
                let north = gap(defect.position_m.north(), vertices.iter().map(|v| v.north()).collect());
                east.max(north)
            };
            let nearest = near.iter().map(distance_m).fold(f64::INFINITY, f64::min);
            assert!(nearest < MAX_DISTANCE_M, "{nearest} m: {defect:?}");
            *seen.entry(defect.cause).or_insert(0) += 1;
        }
    }
    assert!(seen.values().all(|count| *count > 5) && seen.len() == 2, "{seen:?}");
}

#[test]
fn prop_same_seed_same_bits_and_other_seeds_other_places() {
    let job = shipped_job("girder");
    let first = Site::build(&job, 3).defects().to_vec();
    assert_eq!(first, Site::build(&job, 3).defects().to_vec());
    let other = Site::build(&job, 4).defects().to_vec();
    assert!(first.iter().all(|a| other.iter().all(|b| a.position_m != b.position_m)));
}

#[test]
fn exact_resolved_files_keep_causes_and_stains() {
    let text = shipped_text("girder");
    let job = shipped_job("girder");
    let placed = Site::build(&job, 5).defects().to_vec();
    assert!(placed.iter().any(|defect| defect.stain.is_some()));
    let resolved = resolve(text, 5, &placed);
    let again = scenario::read("girder.toml", &resolved, &|file| Err(format!("no file {file}"))).unwrap();
    assert_eq!(again.defects.placed, Some(placed));
    assert_eq!(again.crc, job.crc);
}

#[test]
fn regress_incomplete_stains_are_reported() {
    let text = shipped_text("girder");
    let placed = Site::build(&shipped_job("girder"), 5).defects().to_vec();
    let resolved = resolve(text, 5, &placed);
    let line = resolved.lines().find(|line| line.starts_with("stain_m")).unwrap();
    let broken = resolved.replacen(line, "", 1);
    let problems = scenario::read("girder.toml", &broken, &|file| Err(format!("no file {file}"))).unwrap_err().to_string();
    assert!(problems.contains("stain_m") && problems.contains("both stain and stain_m, or none"), "{problems}");
}

#[test]
fn regress_free_tasks_get_defects_with_causes() {
    let job = shipped_job("girder");
    let tasks =
        job.tasks.iter().map(|task| scenario::Task { kind: TaskKind::Free, inspects_surface: false, ..task.clone() }).collect();
    let free = Scenario { tasks, ..job };
    let site = Site::build(&free, 2);
    assert_eq!(site.defects().len(), free.defects.count);
    assert!(site.defects().iter().all(|defect| defect.cause.is_some() && is_photographable(defect, &free, &site)));
}

#[test]
fn regress_arch_and_suspension_bridges_have_causes_without_code_of_their_own() {
    let job = shipped_job("two-bridges");
    let by_cause = DefectSpec { placement: DefectPlacement::Causes, ..job.defects.clone() };
    let job = Scenario { defects: by_cause, ..job };
    let mut causes = BTreeSet::new();
    for seed in 0..6 {
        let site = Site::build(&job, seed);
        assert_eq!(site.defects().len(), job.defects.count, "seed {seed}");
        causes.extend(site.defects().iter().filter_map(|defect| defect.cause));
    }
    assert!(causes.contains(&DefectCause::WaterLine), "{causes:?}");
    assert!(causes.contains(&DefectCause::Reinforcement) && causes.contains(&DefectCause::Swelling), "{causes:?}");
}

/// Returns a checksum of the defects of a job at seed 7, placed anywhere.
fn checksum_anywhere(name: &str) -> (usize, u32) {
    let job = shipped_job(name);
    let defects = DefectSpec { placement: DefectPlacement::Anywhere, ..job.defects.clone() };
    let site = Site::build(&Scenario { defects, ..job }, 7);
    let mut hasher = crc32fast::Hasher::new();
    for defect in site.defects() {
        assert_eq!((defect.cause, defect.stain), (None, None));
        for value in defect.position_m.array().into_iter().chain([defect.length_m, defect.width_m]) {
            hasher.update(&value.to_le_bytes());
        }
        hasher.update(&defect.kind.to_le_bytes());
    }
    (site.defects().len(), hasher.finalize())
}

#[test]
fn regress_placement_without_causes_keeps_every_bit() {
    // Computed with the program before it knew causes (`spandrel export JOB --seed 7 --scenario`).
    for (name, count, checksum) in EXPECTED {
        assert_eq!(checksum_anywhere(name), (count, checksum), "{name}");
    }
}

/// Returns the defects of a job at some seeds, with their causes, members and codes.
fn defects_of(name: &str) -> Vec<PlacedDefect> {
    let job = shipped_job(name);
    let mut out = Vec::new();
    for seed in 0..6 {
        let site = Site::build(&job, seed);
        assert_eq!(site.defects().len(), job.defects.count, "{name}, seed {seed}");
        out.extend(site.defects().iter().cloned());
    }
    out
}

#[test]
fn prop_box_girders_crack_where_they_bend() {
    let job = shipped_job("box-girder");
    let bridge = &job.bridges[0];
    let defects = defects_of("box-girder");
    let bent = defects.iter().filter(|one| one.cause == Some(DefectCause::Bending) && one.member.contains("/box/"));
    let mut count = 0;
    for defect in bent {
        count += 1;
        let [x, _, _] = bridge.placement().local(defect.position_m);
        // Cracks in the soffit and at the lower edges of the webs are in the middle of a span, those at the upper edges above a pier. The piers
        // are 27.43 m from midspan.
        let to_pier_m = (x.abs() - 27.43).abs();
        if defect.normal.up() < -0.8 {
            assert!(to_pier_m > 8.0, "{defect:?}");
            // They run across the box, within a few degrees.
            assert!(bridge.placement().direction([1.0, 0.0, 0.0]).dot(defect.along).abs() < 0.2, "{defect:?}");
        }
        assert_eq!(defect.kind, defect_codes::PSC_CRACK);
    }
    assert!(count >= 3, "{count}");
}

#[test]
fn prop_masonry_has_its_own_defects_where_water_is() {
    let job = shipped_job("masonry-arch");
    let defects = defects_of("masonry-arch");
    let mut seen = BTreeMap::new();
    for defect in &defects {
        let cause = defect.cause.unwrap();
        *seen.entry(cause).or_insert(0) += 1;
        let over_m = defect.position_m.up() - job.terrain.water_level_m;
        match cause {
            DefectCause::WaterLine => {
                assert!(
                    defect.kind == defect_codes::MORTAR && defect.element.number() == 213 || defect.element.number() == 217,
                    "{defect:?}"
                );
                assert!((0.0..=1.4).contains(&over_m), "{over_m}");
            }
            // The walls above the barrels and the barrels themselves.
            DefectCause::Seepage => assert_eq!(defect.element.number(), 145, "{defect:?}"),
            DefectCause::Frost => assert!(defect.kind == defect_codes::SPLIT_STONE && over_m > 0.0, "{defect:?}"),
            other => panic!("{other:?}"),
        }
    }
    assert!(seen.len() == 3 && seen.values().all(|count| *count >= 6), "{seen:?}");
    assert!(defects.iter().any(|one| one.kind == defect_codes::EFFLORESCENCE && one.normal.up() < -0.3), "lime below the barrel");
}

#[test]
fn prop_stays_corrode_at_their_lower_ends() {
    let job = shipped_job("cable-stayed");
    let deck_up_m = job.bridges[0].center_m.up();
    let defects = defects_of("cable-stayed");
    let of_stays: Vec<f64> =
        defects.iter().filter(|one| one.cause == Some(DefectCause::Cable)).map(|one| one.position_m.up() - deck_up_m).collect();
    assert!(of_stays.len() >= 3, "{of_stays:?}");
    let low = of_stays.iter().filter(|up_m| **up_m < 9.0).count();
    assert!(2 * low >= of_stays.len(), "{of_stays:?}");
}
