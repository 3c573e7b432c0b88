//! The window and its threads: one receives telemetry, one builds the scene and one flies the vehicle. `train` controls
//! the window through a pipe. The main loop renders.

mod cockpit;
mod controller_slot;
mod display;
mod flight_view;
mod frame;
mod job_pictures;
mod keys;
mod listener;
mod page_pictures;
mod page_refresh;
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
mod window_settings;
mod window_text;
mod worker;

use crate::errors::AppError;
use crate::io::clock;
use crate::io::stop::StopRequest;
use cockpit::{Cockpit, WindowThreads};
use flight_view::FlightView;
use pilot::{PilotCommand, PilotThread};
use sound::AudioOutput;
use spandrel_view::flow::WindowFlow;
use stream::StreamSender;
use train_pipe::TrainPipe;

pub use window_config::{CaptureRequest, WindowConfig, WindowSetup};
pub use window_settings::{SettingsOverrides, WindowSettings};

/// Opens the window and runs it until it is closed.
pub fn run(setup: WindowSetup) -> Result<(), AppError> {
    let WindowSetup { config, settings, led, .. } = setup;
    let stop = StopRequest::install(setup.leash && !led)?;
    let mut crew = WindowThreads { pilot: None, train_pipe: None, flight: None, stream: None };
    if led || setup.fly.is_some() {
        crew.pilot = Some(PilotThread::start(config.listen, setup.device, setup.profiles, settings.current())?);
    }
    let mut flow = if led {
        crew.train_pipe = Some(TrainPipe::listen(&stop));
        WindowFlow::new()
    } else {
        crew.flight = Some(FlightView::begin(config.listen, setup.connect, (setup.scenario, setup.vehicle), setup.seed)?);
        WindowFlow::watch_only()
    };
    flow.arrangement = config.layout;
    flow.update_settings(settings.status());
    if let Some(words) = settings.file_notice() {
        flow.show_notice(words);
    }
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
    let speaker = AudioOutput::new(settings.current().keys.sounds);
    Cockpit::new(config, settings, flow, crew, speaker, stop).run()
}
