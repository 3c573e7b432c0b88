//! The window and what stands behind it: a thread that listens, a thread that builds the scene, a thread that flies, the pipe to whoever
//! leads it, and the loop that draws.

mod desk;
mod display;
mod flight;
mod frame;
mod keeper;
mod keys;
mod lead;
mod listener;
mod panes;
mod pilot;
pub mod plan;
mod screen;
mod sound;
mod stream;
mod window;
mod words;

use super::Args;
use crate::clock;
use crate::controller;
use crate::errors::AppError;
use crate::files;
use crate::priority;
use crate::render::size;
use crate::stop::Stop;
use flight::Flight;
use lead::Lead;
use pilot::{Ask, Pilot};
use sound::Speaker;
use spandrel_view::flow::{Flow, Names};
use std::time::Duration;
use stream::Stream;
use window::{Cockpit, Crew};

/// Longest time to the picture that can be asked for, s.
const AFTER_MAX_S: f64 = 3_600.0;

/// Opens the window and stays until it is closed.
pub fn run(args: &Args) -> Result<(), AppError> {
    let scenario = files::scenario(&args.job.scenario)?.scenario;
    let vehicle = files::vehicle(&args.job.vehicle)?.vehicle;
    let keys = controller::keys(args.keys.as_deref())?;
    let plan = plan::Plan {
        listen: args.listen,
        quality: plan::quality(&args.quality)?,
        size_px: size(&args.size)?,
        map: !args.no_map,
        picture: picture(args)?,
        keep: args.picture.clone(),
        // Led, its standard output belongs to the pipe.
        announce: args.announce && !args.led,
    };
    let stop = Stop::install(args.leash && !args.led)?;
    let mut crew = Crew { pilot: None, lead: None, flight: None, stream: None };
    if args.led || args.fly.is_some() {
        crew.pilot = Some(Pilot::start(args, keys.clone())?);
    }
    let names = Names::new(keys.labels());
    let flow = if args.led {
        crew.lead = Some(Lead::listen(&stop));
        Flow::new(!args.no_sound, names)
    } else {
        crew.flight = Some(Flight::begin(args.listen, args.connect, (scenario, vehicle), args.job.seed)?);
        Flow::watching(!args.no_sound, names)
    };
    if let (Some(pilot), Some(vehicle)) = (&crew.pilot, args.fly) {
        pilot.ask(Ask::Fly(vehicle));
    }
    // On Linux every thread has a niceness of its own, that of the thread which began it: sticks are sent by one that began before, pictures
    // are encoded by one that begins after.
    priority::stand_back();
    crew.stream = match args.stream.map(|to| Stream::open(to, clock::unix_us())).transpose() {
        // A trainee's window is worth more than what it sends elsewhere.
        Err(error) if args.led => {
            tracing::warn!("no stream: {error}");
            None
        }
        opened => opened?,
    };
    let speaker = Speaker::new(keys.sounds, !args.no_sound);
    Cockpit::new(plan, keys, flow, crew, speaker, stop).run()
}

fn picture(args: &Args) -> Result<Option<plan::Picture>, AppError> {
    let (Some(path), Some(after)) = (&args.screenshot, args.after) else { return Ok(None) };
    if !(0.0..=AFTER_MAX_S).contains(&after) {
        return Err(AppError::wrong(format!("--after {after}: give seconds, 0 to {AFTER_MAX_S}")));
    }
    Ok(Some(plan::Picture { path: path.clone(), after: Duration::from_secs_f64(after) }))
}
