//! Telemetry subscriber. It runs in a separate thread so that slow frames do not delay datagram timestamps.

use crate::errors::AppError;
use crate::io::clock::Stopwatch;
use crate::io::net::{NetEvent, SocketHub};
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;
use spandrel_view::live::LiveFlight;
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Maximum time to wait for a datagram, so that heartbeats are sent on time.
const MAX_DATAGRAM_WAIT: Duration = Duration::from_millis(50);

/// Received telemetry, shared with the render loop.
#[derive(Debug, Clone)]
pub struct TelemetryListener {
    live: Arc<Mutex<LiveFlight>>,
    stopwatch: Stopwatch,
    vehicle: SocketAddr,
}

impl TelemetryListener {
    /// Connects to the vehicle and starts the thread.
    ///
    /// # Errors
    /// Returns an error if the socket cannot be opened.
    pub fn connect(listen: IpAddr, vehicle: SocketAddr, scenario: &Scenario) -> Result<Self, AppError> {
        let mut hub = SocketHub::new();
        let socket = hub.bind(listen, 0, "--listen")?;
        let listener = Self { live: Arc::new(Mutex::new(LiveFlight::new(scenario))), stopwatch: Stopwatch::start(), vehicle };
        let heard = listener.clone();
        std::thread::spawn(move || {
            // The thread ends when the telemetry has no other owner.
            while Arc::strong_count(&heard.live) > 1 {
                let arrival = hub.next(MAX_DATAGRAM_WAIT);
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

    /// Returns the vehicle's address.
    pub fn vehicle(&self) -> SocketAddr {
        self.vehicle
    }

    /// Returns the wall time since the start.
    pub fn wall(&self) -> SimTime {
        SimTime::from_s(self.stopwatch.elapsed().as_secs_f64())
    }

    /// Returns the telemetry received so far.
    pub fn live(&self) -> MutexGuard<'_, LiveFlight> {
        // The data is valid even if a thread has panicked while holding the lock.
        self.live.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
