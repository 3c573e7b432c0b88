//! Measures an imported scan of two million triangles against a parametric girder bridge in the same run: the time to import and to load
//! it, the cost of a step of an aircraft that hovers below it, and the time to draw a picture. Exits with an error if a limit is exceeded.

#[path = "support/best.rs"]
mod best;

use best::best;
use spandrel_model::elements::Element;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::mesh::part_shapes::{ConcaveShape, ShapeLimits};
use spandrel_model::mesh::reader::ModelFormat;
use spandrel_model::mesh::voxel_surface::CloudLimits;
use spandrel_model::scenario::bridges::element_map::ElementMap;
use spandrel_model::scenario::bridges::model::Model;
use spandrel_model::scenario::{Bridge, BridgeKind, Scenario};
use spandrel_model::site::Site;
use spandrel_model::site::bridge_import::{ImportOptions, ImportSource, ModelOrigin, UpAxis, import};
use spandrel_model::time::SimTime;
use spandrel_testkit::bench::Bench;
use spandrel_testkit::shipped::{scenario, vehicle};
use spandrel_testkit::studio::{Studio, at};
use std::process::ExitCode;

/// Maximum time from the file to the site, s (requirement).
const MAX_LOAD_S: f64 = 10.0;
/// Maximum cost of a step, as a multiple of that at a parametric bridge (requirement).
const MAX_STEP_RATIO: f64 = 2.0;
/// Minimum rate of pictures, as a share of that at a parametric bridge (requirement).
const MIN_PICTURE_RATIO: f64 = 0.6;
/// Cells of the scan along and around the vault: two triangles each.
const CELLS: (u32, u32) = (2_000, 500);
/// Inner and outer radius of the vault, and its length, m.
const VAULT_M: (f64, f64, f64) = (9.0, 10.0, 60.0);
/// Size of the roughness, m.
const ROUGHNESS_M: f64 = 0.01;
/// Height of the hover below the vault's crown and below the girders, m.
const HOVER_UP_M: f64 = 5.0;
const HOVER_S: f64 = 5.0;
const STEPS_PER_S: f64 = 1_000.0;
const ROUNDS: usize = 3;
const PICTURE_PX: (u32, u32) = (640, 360);
const PICTURES: usize = 5;

/// Returns a rough vault along x as a binary PLY file with z up.
fn vault_ply() -> Vec<u8> {
    let (along, around) = CELLS;
    let (inner_m, outer_m, length_m) = VAULT_M;
    let half = around / 2;
    let mut body = Vec::new();
    for i in 0..=along {
        let x = length_m * (f64::from(i) / f64::from(along) - 0.5);
        for k in 0..around {
            // The outer side from right to left, and the inner side back.
            let (radius_m, step) = if k < half { (outer_m, k) } else { (inner_m, around - 1 - k) };
            let (s, c) = math::sin_cos(std::f64::consts::PI * f64::from(step) / f64::from(half - 1));
            let rough_m = ROUGHNESS_M * (math::sin(31.0 * x) + math::sin(f64::from(step)));
            for value in [x, -(radius_m + rough_m) * c, (radius_m + rough_m) * s] {
                body.extend((value as f32).to_le_bytes());
            }
        }
    }
    let number = |i: u32, k: u32| i * around + k % around;
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for (i, k) in (0..along).flat_map(|i| (0..around).map(move |k| (i, k))) {
        let [a, b, c, d] = [number(i, k), number(i + 1, k), number(i + 1, k + 1), number(i, k + 1)];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    for k in 0..half - 1 {
        for (i, is_last) in [(0, false), (along, true)] {
            let [a, b, c, d] = [k, k + 1, around - 2 - k, around - 1 - k].map(|k| number(i, k));
            triangles.extend([[a, b, c], [a, c, d]].map(|[a, b, c]| if is_last { [a, c, b] } else { [a, b, c] }));
        }
    }
    for triangle in &triangles {
        body.push(3);
        triangle.iter().for_each(|k| body.extend(k.to_le_bytes()));
    }
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        (along + 1) * around,
        triangles.len()
    );
    [header.into_bytes(), body].concat()
}

fn imported(file: &[u8]) -> Vec<u8> {
    let options = ImportOptions {
        name: "vault".into(),
        scale: 1.0,
        up: UpAxis::Z,
        origin: ModelOrigin::Center,
        turn_deg: 0.0,
        default_element: Some(Element::MasonryArch),
        limits: ShapeLimits { tolerance_m: 0.01, concave: ConcaveShape::Mesh },
        cloud: CloudLimits::default(),
    };
    let none = |_: &str| Err("no file".to_owned());
    let source =
        ImportSource { file: "vault.ply", format: ModelFormat::Ply, bytes: file, load: &none, elements: ElementMap::default() };
    let bridge = import(&source, &options).expect("the vault must be valid");
    let part = &bridge.report.parts[0];
    println!("{} triangles, {} shapes by {:?}, {} open edges", part.triangles, part.shapes, part.method, part.open_edges);
    bridge.model
}

fn job(bridge: Bridge) -> Scenario {
    Scenario { bridges: vec![bridge], ..scenario("drill-hover") }
}

/// Returns the cost of a step of an aircraft that hovers, in microseconds.
fn step_us(site: &Scenario) -> f64 {
    let mut bench = Bench::new(&vehicle("m30"), 3);
    bench.site = Site::without_defects(site);
    bench.take_off(HOVER_UP_M);
    let near = bench.site.geometry().nearest_member(bench.position().enu(), 20.0);
    println!("  hovering {:.1} m from the bridge", near.map_or(f64::NAN, |near| near.distance_m));
    let taken = best(ROUNDS, || bench.run(HOVER_S, |_| ()));
    1e6 * taken.as_secs_f64() / (HOVER_S * STEPS_PER_S)
}

/// Returns the time to prepare the pictures of a site, and to draw one, in seconds.
fn picture_s(site: &Scenario) -> (f64, f64) {
    let mut studio = None;
    let prepared = best(1, || studio = Some(Studio::new(site.clone(), 7, "low", SimTime::ZERO)));
    let Some(mut studio) = studio else { return (f64::NAN, f64::NAN) };
    let shot = studio.seen(at(-35.0, -25.0, 4.0), at(0.0, 0.0, 7.0), 70.0, false, PICTURE_PX);
    studio.draw(&shot);
    (prepared.as_secs_f64(), best(PICTURES, || studio.draw(&shot)).as_secs_f64())
}

fn main() -> ExitCode {
    let file = vault_ply();
    let mut model = Vec::new();
    let importing = best(1, || model = imported(&file));
    println!("import: {:.1} s; file of {:.1} MB", importing.as_secs_f64(), model.len() as f64 / 1e6);
    let read = || Model::read("bridge.glb", &model, &ElementMap::default()).expect("the import must be readable");
    let reading = best(1, read);
    let center_m = Vec3::<Enu>::new(0.0, 0.0, VAULT_M.1);
    let vault = job(Bridge { name: "vault".into(), center_m, heading_deg: 90.0, kind: BridgeKind::Model(read()) });
    let building = best(1, || Site::without_defects(&vault));
    let load_s = reading.as_secs_f64() + building.as_secs_f64();
    println!("load: {load_s:.1} s, of which {:.1} s for the file (limit {MAX_LOAD_S} s)", reading.as_secs_f64());

    let mut girder = scenario("girder").bridges.swap_remove(0);
    girder.center_m = Vec3::new(15.0, 0.0, VAULT_M.1);
    let girder = job(girder);
    let (at_girder, at_vault) = (step_us(&girder), step_us(&vault));
    println!("step: {at_girder:.2} us at the girders, {at_vault:.2} us at the scan (limit: {MAX_STEP_RATIO} times as much)");
    let ((girder_built, girder_s), (vault_built, vault_s)) = (picture_s(&girder), picture_s(&vault));
    println!("pictures prepared in {girder_built:.1} s and {vault_built:.1} s");
    let rate = girder_s / vault_s;
    println!("picture: {:.0} ms and {:.0} ms, {rate:.2} of the rate (limit {MIN_PICTURE_RATIO})", 1e3 * girder_s, 1e3 * vault_s);
    let holds = load_s <= MAX_LOAD_S && at_vault <= MAX_STEP_RATIO * at_girder && rate >= MIN_PICTURE_RATIO;
    if holds { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
