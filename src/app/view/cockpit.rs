//! The window and what stands behind it: a thread that listens, a thread that builds the scene, a thread that flies, and the loop that draws.

mod keeper;
mod keys;
mod listener;
mod panes;
mod pilot;
mod screen;
mod stream;
mod window;

use super::Args;
use crate::app::controller;
use crate::app::errors::AppError;
use crate::app::files;
use crate::app::render::size;
use crate::app::stop::Stop;
use listener::Listener;
use pilot::Pilot;
use std::time::Duration;
use stream::Stream;
use window::Cockpit;

/// Longest time to the picture that can be asked for, s.
const AFTER_MAX_S: f64 = 3_600.0;

/// Opens the window and stays until it is closed.
pub fn run(args: &Args) -> Result<(), AppError> {
    let scenario = files::scenario(&args.job.scenario)?.scenario;
    let vehicle = files::vehicle(&args.job.vehicle)?.vehicle;
    let keys = controller::keys(args.keys.as_deref())?;
    let plan = window::Plan {
        quality: window::quality(&args.quality)?,
        size_px: size(&args.size)?,
        map: !args.no_map,
        seed: args.job.seed,
        picture: picture(args)?,
        keep: args.picture.clone(),
        announce: args.announce,
    };
    let stop = Stop::install(args.leash)?;
    be_nice();
    let listener = Listener::dial(args.listen, args.connect, &scenario)?;
    let pilot = args.fly.map(|vehicle| Pilot::start(args, vehicle, keys.clone())).transpose()?;
    let stream = args.stream.map(Stream::open).transpose()?;
    Cockpit::new(plan, (scenario, vehicle), keys, (listener, pilot, stream), stop).run()
}

fn picture(args: &Args) -> Result<Option<window::Picture>, AppError> {
    let (Some(path), Some(after)) = (&args.screenshot, args.after) else { return Ok(None) };
    if !(0.0..=AFTER_MAX_S).contains(&after) {
        return Err(AppError::wrong(format!("--after {after}: give seconds, 0 to {AFTER_MAX_S}")));
    }
    Ok(Some(window::Picture { path: path.clone(), after: Duration::from_secs_f64(after) }))
}

/// The simulator comes first, whoever draws: pictures take what is left of the processor.
fn be_nice() {
    #[cfg(unix)]
    if let Err(error) = rustix::process::nice(NICENESS) {
        tracing::debug!("the view keeps its priority: {error}");
    }
}

/// Half way to the lowest priority.
#[cfg(unix)]
const NICENESS: i32 = 10;
