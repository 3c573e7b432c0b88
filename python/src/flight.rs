//! A vehicle stepped by a script.

use crate::commands;
use crate::errors::{RefusedError, SpandrelError};
use crate::job;
use crate::links::Links;
use crate::state::State;
use num_traits::FromPrimitive;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use spandrel_mavlink::dialect::{MavCmd, MavMessage};
use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::files::job::FileError;
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::sim::{LOCKSTEP, STEP};
use spandrel_sitl::testing::Vehicle;
use std::io::ErrorKind;
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A vehicle, its links, and the command that is waiting for a reply.
#[derive(Debug)]
struct Inner {
    vehicle: Vehicle,
    links: Links,
    asked: Option<(MavCmd, usize)>,
    /// UTC at simulation start, seconds since the Unix epoch.
    start_unix_s: i64,
}

impl Inner {
    /// Runs until the given time, or returns true earlier if a lockstep peer has not replied. Datagrams are exchanged
    /// every 20 ms.
    fn run(&mut self, until: SimTime) -> bool {
        loop {
            self.links.receive(&mut self.vehicle.sim);
            let now = self.vehicle.now();
            if self.vehicle.sim.waiting() {
                return true;
            }
            if now + STEP > until {
                return false;
            }
            let slice_ends = SimTime::from_ns((now.ns() / LOCKSTEP.ns() + 1) * LOCKSTEP.ns());
            self.vehicle.run(slice_ends.min(until) - now);
            let stamp_us = u64::try_from(1_000_000 * self.start_unix_s + self.vehicle.now().us()).unwrap_or(0);
            while let Some(transmit) = self.vehicle.poll_transmit() {
                self.links.deliver(transmit.link, transmit.bytes, stamp_us);
            }
            // There is no SD card to read, so clients receive an error.
            while let Some(job) = self.vehicle.sim.poll_file_job() {
                self.vehicle.sim.finish_file_job(job.ticket, Err(FileError::NotFound));
            }
        }
    }
}

/// A vehicle in this process, wrapped by Python's `spandrel.Vehicle`.
#[pyclass(frozen, module = "spandrel._spandrel")]
pub struct Flight {
    inner: Mutex<Inner>,
    guided_mode: Option<u32>,
}

impl Flight {
    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Flight {
    #[new]
    fn new(py: Python<'_>, scenario: &str, vehicle: &str, seed: u64, flavor: &str, after_crash: &str) -> PyResult<Self> {
        let (job, aircraft) = (job::read_scenario(scenario)?, job::read_vehicle(vehicle)?);
        let flavor = job::flavor(flavor)?;
        let mut builder = Vehicle::builder().seed(seed).flavor(flavor);
        if let Some(rule) = job::after_crash(after_crash)? {
            builder = builder.after_crash(rule);
        }
        let start_unix_s = job.light.start_unix_s;
        let mut vehicle = py.detach(|| builder.build_from(job, aircraft));
        // The script already controls the time; in a freeze, `run` would never reach its end.
        vehicle.sim.forbid_freeze_and_rewind();
        let inner = Inner { vehicle, links: Links::new(), asked: None, start_unix_s };
        Ok(Self { inner: Mutex::new(inner), guided_mode: flavor.goto_mode })
    }

    /// Returns the simulation time in ns.
    fn now_ns(&self, py: Python<'_>) -> i64 {
        py.detach(|| self.lock().vehicle.now().ns())
    }

    /// Returns the current state.
    fn state(&self, py: Python<'_>) -> State {
        py.detach(|| State::of(&self.lock().vehicle))
    }

    /// Returns the SHA-256 of the state at every tick so far, as 64 hexadecimal digits.
    fn digest(&self, py: Python<'_>) -> String {
        let digest = py.detach(|| self.lock().vehicle.sim.digest());
        digest.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Runs until a simulation time, given in ns. Returns true earlier if a lockstep peer has not replied.
    fn run(&self, py: Python<'_>, until_ns: i64) -> bool {
        py.detach(|| self.lock().run(SimTime::from_ns(until_ns)))
    }

    /// Sends a command by its MAVLink number, optionally with a position in the scenario's frame (east, north, up, in
    /// meters).
    #[pyo3(signature = (command, params, place_enu_m=None))]
    fn ask(&self, py: Python<'_>, command: u32, params: Vec<f32>, place_enu_m: Option<(f64, f64, f64)>) -> PyResult<()> {
        let command = MavCmd::from_u32(command).ok_or_else(|| PyValueError::new_err(format!("unknown MAV_CMD {command}")))?;
        py.detach(|| {
            let inner = &mut *self.lock();
            let message = match place_enu_m {
                Some((east, north, up)) => {
                    commands::at_place(command, &params, Vec3::new(east, north, up), inner.vehicle.sim.site().plane())
                }
                None => commands::long(command, &params),
            };
            inner.asked = Some((command, inner.vehicle.received.len()));
            inner.vehicle.send(&message);
        });
        Ok(())
    }

    /// Returns the reply to the last command as MAV_RESULT; `None` until there is one.
    fn answer(&self, py: Python<'_>) -> Option<u32> {
        py.detach(|| {
            let inner = self.lock();
            let (command, before) = inner.asked?;
            let received = &inner.vehicle.received[..];
            received.get(before..).unwrap_or(received).iter().rev().find_map(|frame| match &frame.message {
                Some(MavMessage::COMMAND_ACK(ack)) if ack.command == command => Some(ack.result as u32),
                _ => None,
            })
        })
    }

    /// Sends one manual control input.
    fn sticks(&self, py: Python<'_>, forward: f64, right: f64, up: f64, yaw: f64) {
        py.detach(|| self.lock().vehicle.sticks(forward, right, up, yaw));
    }

    /// Opens a UDP socket on a free loopback port. Returns the link ID and the port.
    #[pyo3(signature = (kind, peer, lockstep=false))]
    fn open_udp(&self, py: Python<'_>, kind: &str, peer: (String, u16), lockstep: bool) -> PyResult<(u32, u16)> {
        let kind = link_kind(kind)?;
        let (host, port) = peer;
        let ip: IpAddr = host.parse().map_err(|_| PyValueError::new_err(format!("{host} is not an IP address")))?;
        let peer = SocketAddr::new(ip, port);
        let opened = py.detach(|| {
            let inner = &mut *self.lock();
            inner.links.open_udp(&mut inner.vehicle.sim, kind, peer, lockstep)
        });
        opened.map(|(link, port)| (link.0, port)).map_err(|error| PyOSError::new_err(error.to_string()))
    }

    /// Opens a link whose datagrams Python reads with `take`.
    fn open_mailbox(&self, py: Python<'_>, kind: &str) -> PyResult<u32> {
        let kind = link_kind(kind)?;
        Ok(py.detach(|| {
            let inner = &mut *self.lock();
            inner.links.open_mailbox(&mut inner.vehicle.sim, kind).0
        }))
    }

    /// Opens a telemetry log, which is written until the link is closed.
    fn open_log(&self, py: Python<'_>, path: PathBuf) -> PyResult<u32> {
        let opened = py.detach(|| {
            let inner = &mut *self.lock();
            inner.links.open_log(&mut inner.vehicle.sim, &path)
        });
        opened.map(|link| link.0).map_err(|error| PyOSError::new_err(format!("{}: {error}", path.display())))
    }

    /// Sends a datagram to the vehicle.
    fn send(&self, py: Python<'_>, link: u32, datagram: &[u8]) -> PyResult<()> {
        py.detach(|| {
            let inner = &mut *self.lock();
            if !inner.links.is_mailbox(LinkId(link)) {
                return Err(no_link(link));
            }
            inner.vehicle.sim.handle_datagram(LinkId(link), datagram);
            Ok(())
        })
    }

    /// Returns and removes the datagrams received from the vehicle on a mailbox link.
    fn take(&self, py: Python<'_>, link: u32) -> PyResult<Vec<Vec<u8>>> {
        py.detach(|| self.lock().links.take(LinkId(link)).ok_or_else(|| no_link(link)))
    }

    /// Closes a link.
    fn close(&self, py: Python<'_>, link: u32) -> PyResult<()> {
        py.detach(|| {
            let inner = &mut *self.lock();
            inner.links.close(&mut inner.vehicle.sim, LinkId(link))
        })
        .map_err(|error| match error.kind() {
            ErrorKind::NotConnected => no_link(link),
            _ => PyOSError::new_err(error.to_string()),
        })
    }

    /// Returns the number of the mode required for takeoff commands; `None` if any mode is allowed.
    fn guided_mode(&self) -> Option<u32> {
        self.guided_mode
    }

    /// Returns the exception for a rejected command.
    fn refusal(&self, py: Python<'_>, result: Option<u32>) -> PyErr {
        let (asked, said) = py.detach(|| {
            let inner = self.lock();
            (inner.asked, inner.vehicle.status_texts())
        });
        let Some((command, _)) = asked else { return SpandrelError::new_err("no command was sent") };
        match result.and_then(spandrel_mavlink::dialect::MavResult::from_u32) {
            Some(result) => RefusedError::new_err(format!("{command:?} returned {result:?}; last status text: {said}")),
            None => RefusedError::new_err(format!("no reply to {command:?}; last status text: {said}")),
        }
    }
}

fn no_link(link: u32) -> PyErr {
    SpandrelError::new_err(format!("link {link} is closed"))
}

fn link_kind(kind: &str) -> PyResult<LinkKind> {
    match kind {
        "gcs" => Ok(LinkKind::GroundStation),
        "sdk" => Ok(LinkKind::Sdk),
        "payload" => Ok(LinkKind::Payload),
        _ => Err(PyValueError::new_err(format!("unknown link kind {kind}; allowed: gcs, sdk, payload"))),
    }
}
