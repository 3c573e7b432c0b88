//! The window and its threads: one receives telemetry, one builds the scene and one flies the vehicle. `train` controls
//! the window through a pipe. The main loop renders.

mod cockpit;
mod controller_slot;
mod display;
mod flight_view;
mod frame;
mod keys;
mod listener;
mod panes;
mod picture_writer;
mod pilot;
pub mod priority;
mod screen;
pub mod secondary_renderer;
mod sound;
mod stream;
mod train_pipe;
mod window_config;
mod window_text;

use crate::errors::AppError;
use crate::io::clock;
use crate::io::stop::StopRequest;
use cockpit::{Cockpit, WindowThreads};
use flight_view::FlightView;
use pilot::{PilotCommand, PilotThread};
use sound::AudioOutput;
use spandrel_view::flow::{KeyNames, WindowFlow};
use stream::StreamSender;
use train_pipe::TrainPipe;

pub use window_config::{CaptureRequest, WindowConfig, WindowSetup};

/// Opens the window and runs it until it is closed.
pub fn run(setup: WindowSetup) -> Result<(), AppError> {
    let WindowSetup { config, keys, sound, led, .. } = setup;
    let stop = StopRequest::install(setup.leash && !led)?;
    let mut crew = WindowThreads { pilot: None, train_pipe: None, flight: None, stream: None };
    if led || setup.fly.is_some() {
        crew.pilot = Some(PilotThread::start(config.listen, setup.device, setup.profiles, keys.clone())?);
    }
    let names = KeyNames::new(keys.labels());
    let flow = if led {
        crew.train_pipe = Some(TrainPipe::listen(&stop));
        WindowFlow::new(sound, names)
    } else {
        crew.flight = Some(FlightView::begin(config.listen, setup.connect, (setup.scenario, setup.vehicle), setup.seed)?);
        WindowFlow::watch_only(sound, names)
    };
    if let (Some(pilot), Some(vehicle)) = (&crew.pilot, setup.fly) {
        pilot.send_command(PilotCommand::Fly(vehicle));
    }
    // On Linux, a new thread inherits the nice value of the thread that starts it. The pilot thread started earlier and
    // keeps its priority; the encoder starts later and gets the lower priority.
    priority::lower_priority();
    crew.stream = match setup.stream.map(|to| StreamSender::open(to, clock::unix_us())).transpose() {
        // The trainee's window takes precedence over the stream.
        Err(error) if led => {
            tracing::warn!("cannot stream: {error}");
            None
        }
        opened => opened?,
    };
    let speaker = AudioOutput::new(keys.sounds, sound);
    Cockpit::new(config, keys, flow, crew, speaker, stop).run()
}
