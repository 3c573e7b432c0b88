//! One more subscriber of the vehicle's telemetry, in a thread of its own: a slow picture delays no datagram's stamp.

use crate::errors::AppError;
use crate::io::clock::Stopwatch;
use crate::io::net::{NetEvent, SocketHub};
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;
use spandrel_view::live::LiveFlight;
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Longest wait for a datagram: heartbeats are due meanwhile.
const WAIT: Duration = Duration::from_millis(50);

/// What is heard, shared with whoever draws.
#[derive(Debug, Clone)]
pub struct TelemetryListener {
    live: Arc<Mutex<LiveFlight>>,
    stopwatch: Stopwatch,
    vehicle: SocketAddr,
}

impl TelemetryListener {
    /// Dials the vehicle and listens from now on.
    ///
    /// # Errors
    /// When no socket can be opened.
    pub fn dial(listen: IpAddr, vehicle: SocketAddr, scenario: &Scenario) -> Result<Self, AppError> {
        let mut hub = SocketHub::new();
        let socket = hub.bind(listen, 0, "--listen")?;
        let listener = Self { live: Arc::new(Mutex::new(LiveFlight::new(scenario))), stopwatch: Stopwatch::start(), vehicle };
        let heard = listener.clone();
        std::thread::spawn(move || {
            // Ends when nobody but this thread holds what is heard.
            while Arc::strong_count(&heard.live) > 1 {
                let arrival = hub.next(WAIT);
                let wall = heard.wall();
                let mut live = heard.live();
                if let Some(NetEvent::Datagram { from, bytes, .. }) = arrival
                    && from == vehicle
                {
                    live.handle_datagram(&bytes, wall);
                }
                live.handle_timeout(wall);
                let said: Vec<Vec<u8>> = std::iter::from_fn(|| live.poll_transmit()).collect();
                drop(live);
                for bytes in said {
                    hub.send(socket, vehicle, &bytes);
                }
            }
        });
        Ok(listener)
    }

    /// Whom it listens to.
    pub fn vehicle(&self) -> SocketAddr {
        self.vehicle
    }

    /// Wall time since it began.
    pub fn wall(&self) -> SimTime {
        SimTime::from_s(self.stopwatch.elapsed().as_secs_f64())
    }

    /// What has been heard.
    pub fn live(&self) -> MutexGuard<'_, LiveFlight> {
        // A thread that broke off in the middle leaves plain data behind.
        self.live.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
