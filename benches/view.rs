//! Measures the cost of rendering both views of a flight: frame time, triangles, and draw calls per frame, and startup
//! time; then the frame rate of the whole window. Uses software rendering, like a machine without a graphics card.
//! `SPANDREL_BENCH_DEVICE=best` uses the best available device and higher presets, and fails if a graphics card does not
//! reach the target frame rate.

#[path = "support/running.rs"]
mod running;

use running::{Client, Lateness, now, start};
use spandrel::secondary_renderer::SecondaryRenderer;
use spandrel_mavlink::dialect::{HEARTBEAT_DATA, MavMessage};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, two_bridges};
use spandrel_view::gpu::{DrawCounts, Gpu, fill, picture_texture};
use spandrel_view::quality::Quality;
use spandrel_view::shot::Shot;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Target frame rate of both views at 640 x 360 with the `low` preset on two cores, frames/s (requirement).
const TARGET_FRAME_RATE_HZ: f64 = 15.0;
/// Maximum CPU time per frame, s: twice the time of the slowest viewpoints when the limit was set. CPU time barely
/// depends on other load on the machine.
const MAX_FRAME_CPU_TIME_S: f64 = 0.25;
/// Minimum frame rate of both views at 1920 x 1080 with the `high` preset on a data center graphics card, frames/s
/// (requirement).
const MIN_GPU_FRAME_RATE_HZ: f64 = 144.0;
/// Number of measured frames per viewpoint, after one frame that warms up the caches.
const FRAMES_PER_VIEWPOINT: usize = 4;

/// Returns viewpoints along a flight, each with the camera's target point.
fn viewpoints() -> Vec<(&'static str, Vec3<Enu>, Vec3<Enu>)> {
    vec![
        ("take-off", at(-112.0, 78.0, 12.0), at(-40.0, 20.0, 25.0)),
        ("slab", at(-30.0, -9.0, 33.0), at(-30.0, 0.0, 32.5)),
        ("arch bottom", at(-20.0, 0.0, 21.5), at(-14.0, 0.4, 33.0)),
        ("interlayer", at(14.0, 0.3, 30.8), at(0.0, 0.0, 31.5)),
        ("pier", at(-72.0, 139.0, 3.5), at(-72.0, 150.0, 3.0)),
        ("over the lake", at(0.0, 70.0, 30.0), at(0.0, 150.0, 10.0)),
    ]
}

/// Minimum ratio of simulation time to wall time for a simulator that runs while this process renders continuously.
const MIN_SPEED_FACTOR: f64 = 0.99;
/// Maximum number of clock slips of that simulator. The clock slips when a tick is 0.25 s late; each slip shortens the
/// flight. Pilots notice control delays above 0.1 s. The benchmark prints such delays but does not limit them, because
/// other load on the machine can cause them.
const MAX_SLIPS: u64 = 0;
/// Duration of the measurement with a running simulator.
const MEASUREMENT_DURATION: Duration = Duration::from_secs(10);

struct FrameCost {
    frame: Duration,
    counts: DrawCounts,
}

/// Renders both views the same way as the window does: without a graphics card, a second device renders the camera's
/// view.
struct Views {
    studio: Studio,
    secondary: Option<SecondaryRenderer>,
    /// Textures of the inspector's view and the camera's view.
    textures: [wgpu::Texture; 2],
}

impl Views {
    fn on(gpu: Gpu, preset: &str) -> Self {
        let software = gpu.software;
        let studio = Studio::on(gpu, two_bridges(), 7, preset, SimTime::ZERO);
        let quality = Quality::by_name(preset).expect("the preset must exist");
        let secondary = software
            .then(|| SecondaryRenderer::open(quality, Arc::clone(&studio.scene)).expect("a second device must be available"));
        let textures = [(); 2].map(|()| picture_texture(&studio.gpu, (1, 1)));
        Self { studio, secondary, textures }
    }

    /// Renders a frame of both views and waits until it is complete.
    fn frame(&mut self, (from, look): (Vec3<Enu>, Vec3<Enu>), size_px: (u32, u32)) -> FrameCost {
        let start = now();
        let moment = self.studio.moment(from, look, false, at(1.0, 0.5, 0.0));
        let camera = self.studio.stage().camera(&moment, size_px);
        if let Some(secondary) = &self.secondary {
            secondary.start(camera.clone()).expect("the second device must not fail");
        }
        let inspector = self.studio.stage().inspector(&moment, size_px);
        let (gpu, renderer) = self.studio.renderer();
        if (self.textures[0].width(), self.textures[0].height()) != size_px {
            self.textures = [(); 2].map(|()| picture_texture(gpu, size_px));
        }
        let [left, right] = &self.textures;
        let mut draw = |shot: &Shot, texture: &wgpu::Texture| {
            renderer.draw(gpu, shot, &texture.create_view(&wgpu::TextureViewDescriptor::default()));
            renderer.counts()
        };
        let counts = draw(&inspector, left).and(match &self.secondary {
            Some(secondary) => {
                let (picture, cost) = secondary.picture().expect("the second device must not fail");
                fill(gpu, right, &picture);
                cost
            }
            None => draw(&camera, right),
        });
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device must not fail");
        FrameCost { frame: start.elapsed(), counts }
    }
}

/// Returns the CPU time that this process has used so far, in seconds. Linux reports it in hundredths of a second;
/// other systems return `None`.
fn cpu_s() -> Option<f64> {
    const TICKS_PER_S: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // User and system time are the 12th and 13th fields after the name in parentheses.
    let mut numbers = stat.rsplit(')').next()?.split_whitespace().skip(11);
    let mut ticks = || numbers.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / TICKS_PER_S)
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort();
    times[times.len() / 2]
}

/// Renders all viewpoints. Returns the CPU time per frame in seconds, if available, and the frame rate in frames/s.
fn measure(views: &mut Views, size_px: (u32, u32), preset: &str) -> (Option<f64>, f64) {
    let (mut medians, mut cpu) = (Vec::new(), Some(0.0));
    for (name, from, look) in viewpoints() {
        views.frame((from, look), size_px);
        let before = cpu_s();
        let costs: Vec<FrameCost> = (0..FRAMES_PER_VIEWPOINT).map(|_| views.frame((from, look), size_px)).collect();
        let spent = cpu_s().zip(before).map(|(after, before)| (after - before) / FRAMES_PER_VIEWPOINT as f64);
        cpu = cpu.zip(spent).map(|(sum, spent)| sum + spent / viewpoints().len() as f64);
        let (counts, time) = (costs[0].counts, median(costs.into_iter().map(|cost| cost.frame).collect()));
        println!(
            "  {name}: {:.0} ms, {:.0} ms CPU time, {} triangles, {} draw calls",
            1e3 * time.as_secs_f64(),
            1e3 * spent.unwrap_or(f64::NAN),
            counts.triangles,
            counts.draw_calls
        );
        medians.push(time);
    }
    let whole = median(medians).as_secs_f64();
    println!(
        "2 x {} x {}, {preset}: {:.0} ms ({:.1} frames/s), {:.0} ms CPU time",
        size_px.0,
        size_px.1,
        1e3 * whole,
        1.0 / whole,
        1e3 * cpu.unwrap_or(f64::NAN)
    );
    (cpu, 1.0 / whole)
}

/// Measures a simulator that runs in real time while this process renders both views continuously at the same priority
/// (the real window has a lower priority). Returns the simulator's speed relative to real time, the frame rate, and the
/// simulator's delays.
fn measure_simulator_while_rendering(views: &mut Views) -> (f64, f64, Lateness) {
    let (running, port) = start();
    let stop = Arc::new(AtomicBool::new(false));
    let watch = {
        let stop = Arc::clone(&stop);
        std::thread::spawn(move || {
            let mut client = Client::new(port, 255);
            client.send(&MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
            let pace = client.speed_factor(MEASUREMENT_DURATION);
            stop.store(true, Ordering::Relaxed);
            pace
        })
    };
    let (_, from, look) = viewpoints()[1];
    let mut frames = 0.0;
    while !stop.load(Ordering::Relaxed) {
        views.frame((from, look), (640, 360));
        frames += 1.0;
    }
    let (pace, wall_s) = watch.join().expect("the client thread must not panic");
    (pace, frames / wall_s, running.end())
}

/// Measures the frame rate of the whole window and the time from a key press to the picture, on a virtual display. Returns whether the
/// window is fast enough; true if it cannot be measured here.
fn measure_window() -> bool {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let python = root.join(".venv/bin/python");
    if !python.is_file() {
        println!("skipped: the whole window, because {} is missing (tools/test creates it)", python.display());
        return true;
    }
    let script = root.join("tests/clients/window_speed.py");
    let run = Command::new(python).arg(script).env("SPANDREL_COCKPIT", env!("CARGO_BIN_EXE_spandrel")).status();
    run.expect("Python must start").success()
}

fn main() {
    let best = std::env::var("SPANDREL_BENCH_DEVICE").is_ok_and(|device| device == "best");
    let start = now();
    let gpu = if best { Gpu::open() } else { Gpu::open_software() }.expect("a device must be available");
    println!("device: {}", gpu.name);
    let mut views = Views::on(gpu, "low");
    let built = start.elapsed();
    let (_, from, look) = viewpoints()[1];
    let first = views.frame((from, look), (640, 360));
    println!(
        "startup: {:.1} s to load the scene, then {:.1} s for the first frame (including shader compilation)",
        built.as_secs_f64(),
        first.frame.as_secs_f64()
    );
    let (small, small_hz) = measure(&mut views, (640, 360), "low");
    let (pace, rate_hz, late) = measure_simulator_while_rendering(&mut views);
    println!(
        "simulator during continuous rendering at {rate_hz:.1} frames/s: {pace:.4} simulated seconds per real second (minimum {MIN_SPEED_FACTOR}), \
         longest tick delay {:.1} ms, {} clock slips (maximum {MAX_SLIPS})",
        late.latest_ms, late.slips
    );
    let card = views.secondary.is_none();
    let mut large_hz = measure(&mut views, (1920, 1080), "low").1;
    let (size_px, low_hz) = if card { ((1920, 1080), large_hz) } else { ((640, 360), small_hz) };
    for preset in ["medium", "high", "ultra"] {
        views = Views::on(views.studio.gpu, preset);
        let rate_hz = measure(&mut views, size_px, preset).1;
        println!("    {:.1} times as long as with low", low_hz / rate_hz);
        if preset == "high" {
            large_hz = rate_hz;
        }
    }
    let kept = if card { large_hz >= MIN_GPU_FRAME_RATE_HZ } else { small.is_none_or(|cpu| cpu <= MAX_FRAME_CPU_TIME_S) };
    let verdict = if kept { "ok" } else { "MISSED" };
    if card {
        println!("2 x 1920 x 1080, high: minimum {MIN_GPU_FRAME_RATE_HZ:.0} frames/s: {verdict}");
    } else {
        println!(
            "2 x 640 x 360: target {TARGET_FRAME_RATE_HZ:.0} frames/s; limit {MAX_FRAME_CPU_TIME_S} s CPU time per frame: {verdict}"
        );
    }
    drop(views);
    let is_window_fast = measure_window();
    if !kept || !is_window_fast || pace < MIN_SPEED_FACTOR || late.slips > MAX_SLIPS {
        std::process::exit(1);
    }
}
