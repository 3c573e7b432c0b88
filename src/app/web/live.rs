//! The flight that is watched: a thread that is one more subscriber of the vehicle's payload port, the stream of what it sees, and what an
//! instructor asks of the vehicle.

mod orders;

use super::answer::{Answer, Answered, Refusal};
use super::asked::Asked;
use super::scenarios;
use super::state::{State, lock};
use crate::app::clock::Stopwatch;
use crate::app::errors::AppError;
use crate::app::net::{Arrival, Hub, SocketId};
use crate::mav::codec::{Decoder, Encoder};
use crate::mav::dialect::{HEARTBEAT_DATA, MavAutopilot, MavMessage, MavModeFlag, MavState, MavType};
use crate::report::plots::job::{job_plan, job_side, job_south};
use crate::scenario::Scenario;
use crate::site::Site;
use crate::web::access::Needs;
use crate::web::live::{self as pages, Drawn, UNITS};
use crate::web::watch::{JobKey, Watch};
use axum::body::Body;
use axum::http::{Response, header};
use axum::response::IntoResponse;
use axum::response::sse::{Event, KeepAlive, Sse};
use orders::{Order, Orders};
use serde_json::json;
use std::convert::Infallible;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tokio::sync::watch;

/// Who we are on the wire: a system of our own, a companion computer, which no vehicle takes for the ground station whose loss it fears.
const SYSTEM: u8 = 252;
const COMPONENT: u8 = 192;
/// Moments a second.
const EVERY: Duration = Duration::from_millis(200);
/// Longest wait for a datagram.
const WAIT: Duration = Duration::from_millis(50);
/// The vehicle forgets who is silent.
const HEARTBEAT_EVERY: Duration = Duration::from_secs(1);
/// A vehicle that says nothing for so long is silent.
const SILENT: Duration = Duration::from_secs(3);
/// Datagrams taken before anything else is done.
const BATCH: usize = 256;
/// A visitor's right to watch is looked at again after so many moments.
const LOOK_AGAIN: u32 = 50;

/// The flight that is watched.
#[derive(Debug)]
pub struct Live {
    vehicle: Option<SocketAddr>,
    moments: watch::Receiver<String>,
    drawn: Arc<Mutex<Option<Drawn>>>,
    orders: Sender<Order>,
}

impl Live {
    /// Starts to listen.
    ///
    /// # Errors
    /// When no socket can be opened.
    pub fn start(vehicle: Option<SocketAddr>, sessions: &[PathBuf], scenarios: &Path) -> Result<Self, AppError> {
        let (sender, moments) = watch::channel(Watch::new().moment(false).to_string());
        let (orders, received) = channel();
        let drawn = Arc::new(Mutex::new(None));
        if let Some(vehicle) = vehicle {
            let ip: IpAddr = match vehicle.ip() {
                ip if ip.is_loopback() => ip,
                IpAddr::V4(_) => Ipv4Addr::UNSPECIFIED.into(),
                IpAddr::V6(_) => Ipv6Addr::UNSPECIFIED.into(),
            };
            let mut hub = Hub::new();
            let socket = hub.bind(ip, 0, "--vehicle")?;
            let mut ear = Ear {
                hub,
                socket,
                vehicle,
                watch: Watch::new(),
                encoder: Encoder::new(SYSTEM, COMPONENT),
                orders: Orders::default(),
                unknown: None,
                drawn: drawn.clone(),
                places: (sessions.to_vec(), scenarios.to_path_buf()),
            };
            std::thread::spawn(move || ear.listen(&sender, &received));
        }
        Ok(Self { vehicle, moments, drawn, orders })
    }
}

/// The listening thread.
struct Ear {
    hub: Hub,
    socket: SocketId,
    vehicle: SocketAddr,
    watch: Watch,
    encoder: Encoder,
    orders: Orders,
    /// A job that was looked for and not found, and when.
    unknown: Option<(JobKey, Duration)>,
    drawn: Arc<Mutex<Option<Drawn>>>,
    places: (Vec<PathBuf>, PathBuf),
}

impl Ear {
    fn listen(&mut self, moments: &watch::Sender<String>, orders: &Receiver<Order>) {
        let clock = Stopwatch::start();
        let (mut heard, mut beat, mut told) = (None, None, None);
        let due = |last: Option<Duration>, every: Duration| last.is_none_or(|last| clock.elapsed() >= last + every);
        // The server and its pages are gone when nobody can hear any more.
        while !moments.is_closed() {
            if self.hear() {
                heard = Some(clock.elapsed());
            }
            if due(beat, HEARTBEAT_EVERY) {
                beat = Some(clock.elapsed());
                self.say(&heartbeat());
            }
            for order in orders.try_iter() {
                self.orders.give(order);
            }
            self.carry_out(clock.elapsed());
            self.look_for_the_job(clock.elapsed());
            if due(told, EVERY) {
                told = Some(clock.elapsed());
                let heard = heard.is_some_and(|heard: Duration| clock.elapsed() < heard + SILENT);
                moments.send_replace(self.watch.moment(heard).to_string());
            }
        }
    }

    /// Takes in what has come. True when the vehicle spoke.
    fn hear(&mut self) -> bool {
        let (mut wait, mut spoke) = (WAIT, false);
        for _ in 0..BATCH {
            let Some(arrival) = self.hub.next(wait) else { break };
            wait = Duration::ZERO;
            let Arrival::Datagram { from, bytes, .. } = arrival else { continue };
            // Nobody else may tell what the vehicle does.
            if from != self.vehicle {
                continue;
            }
            for frame in Decoder::new().datagram(&bytes) {
                self.watch.take(&frame);
                if let Some(words) = self.orders.hear(&frame) {
                    self.watch.say("info", words);
                }
                spoke = true;
            }
        }
        spoke
    }

    fn carry_out(&mut self, now: Duration) {
        let Some(system) = self.watch.system else { return };
        let cast = self.watch.autopilot == Some(MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA);
        let (frames, words) = self.orders.due(now, &mut self.encoder, system, cast);
        for frame in frames {
            self.hub.send(self.socket, self.vehicle, &frame);
        }
        for one in words {
            self.watch.say("info", one);
        }
    }

    fn say(&mut self, message: &MavMessage) {
        let bytes = self.encoder.encode(message);
        self.hub.send(self.socket, self.vehicle, &bytes);
    }

    /// Finds the scenario that the vehicle names by its checksum: shipped, uploaded, or of a session that is under way.
    fn look_for_the_job(&mut self, now: Duration) {
        let Some(key) = self.watch.wanted().filter(|key| self.watch.job() != Some(*key)) else { return };
        if self.unknown.is_some_and(|(other, at)| other == key && now < at + SILENT) {
            return;
        }
        let Some(scenario) = self.scenario_of(key.crc) else {
            self.unknown = Some((key, now));
            return;
        };
        let drawn = draw(&scenario, key);
        *lock(&self.drawn) = Some(drawn);
        self.watch.set_job(key, &scenario);
    }

    fn scenario_of(&self, crc: u32) -> Option<Scenario> {
        let (sessions, uploads) = &self.places;
        let known = scenarios::all(uploads).into_iter().map(|job| job.scenario).find(|scenario| scenario.crc == crc);
        known.or_else(|| {
            let here: Vec<PathBuf> = sessions.iter().filter(|folder| folder.is_dir()).cloned().collect();
            let folders = crate::app::records::session_folders(&here).ok()?;
            // The newest are last.
            folders.iter().rev().take(20).find_map(|folder| {
                let scenario = crate::app::session_folder::Stored::scenario_of(folder).ok()?.scenario;
                (scenario.crc == crc).then_some(scenario)
            })
        })
    }
}

fn draw(scenario: &Scenario, key: JobKey) -> Drawn {
    let site = Site::build(scenario, key.seed);
    let mut drawings = vec![("From above, north up".to_owned(), job_plan(scenario, &site).into_string())];
    for bridge in &scenario.bridges {
        drawings.push((format!("{} from the side", bridge.name), job_side(scenario, &site, bridge).into_string()));
    }
    if scenario.bridges.is_empty() {
        drawings.push(("From the south".to_owned(), job_south(scenario, &site).into_string()));
    }
    Drawn { key: format!("{:08x}-{}", key.crc, key.seed), title: scenario.title.clone(), drawings }
}

fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        mavtype: MavType::MAV_TYPE_ONBOARD_CONTROLLER,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
        ..HEARTBEAT_DATA::default()
    })
}

/// The page.
pub fn page(state: &State, asked: &Asked) -> Answered {
    let drawn = lock(&state.live.drawn).clone();
    let vehicle = state.live.vehicle.map_or("none (--vehicle)".to_owned(), |vehicle| vehicle.to_string());
    Ok(Answer::page(pages::live(&asked.visitor, drawn.as_ref(), &vehicle)))
}

/// Values as they come, until the browser goes or the visitor may no more.
pub fn stream(state: Arc<State>, cookie: Option<String>) -> Response<Body> {
    let moments = state.live.moments.clone();
    let events = futures_util::stream::unfold((moments, state, cookie, 0u32), |(mut moments, state, cookie, count)| async move {
        // The first moment is there already.
        if count > 0 {
            moments.changed().await.ok()?;
        }
        if count % LOOK_AGAIN == LOOK_AGAIN - 1 && !still_may(&state, cookie.clone()).await {
            return None;
        }
        let text = moments.borrow_and_update().clone();
        Some((Ok::<Event, Infallible>(Event::default().data(text)), (moments, state, cookie, count.wrapping_add(1))))
    });
    let mut response = Sse::new(events).keep_alive(KeepAlive::default()).into_response();
    response.headers_mut().insert(header::CACHE_CONTROL, header::HeaderValue::from_static("no-store"));
    response
}

async fn still_may(state: &Arc<State>, cookie: Option<String>) -> bool {
    let state = state.clone();
    let looked = tokio::task::spawn_blocking(move || state.guard.recognise(&state.database, cookie)).await;
    looked.is_ok_and(|recognised| {
        recognised.is_ok_and(|recognised| !recognised.fresh && recognised.visitor.meets(Needs::Instructor))
    })
}

/// An instructor's action. It is under way when this answers; what became of it is said in the stream.
pub fn act(state: &State, asked: &Asked) -> Answered {
    if state.live.vehicle.is_none() {
        return Err(Refusal::Wrong("no vehicle is watched (--vehicle)".into()));
    }
    let order = order(asked)?;
    state.live.orders.send(order).map_err(|_| Refusal::Failed("the live link has ended: start the server again".into()))?;
    Ok(if asked.by_script { Answer::json(&json!({ "under_way": true })) } else { Answer::to("/live") })
}

fn order(asked: &Asked) -> Result<Order, Refusal> {
    match asked.needed("act")? {
        "note" => {
            let text = asked.needed("text")?;
            let count = text.chars().count();
            if count > pages::NOTE_MOST || text.chars().any(char::is_control) {
                return Err(Refusal::Wrong(format!(
                    "text: {count} characters (allowed: 1 to {}, on one line)",
                    pages::NOTE_MOST
                )));
            }
            Ok(Order::Note(text.to_owned()))
        }
        "wind" => {
            let number = |name: &str, most: f64| {
                let value: Option<f64> = asked.needed(name)?.parse().ok();
                let allowed = || Refusal::Wrong(format!("{name}: no such number (allowed: 0 to {most})"));
                value.filter(|value| (0.0..=most).contains(value)).ok_or_else(allowed)
            };
            Ok(Order::Wind { speed_m_s: number("speed", pages::WIND_MOST_M_S)?, from_deg: number("from", 360.0)? })
        }
        "failure" => {
            let key = asked.needed("unit")?;
            let unit = UNITS.iter().find(|(name, ..)| *name == key);
            let (_, words, unit) = unit.ok_or_else(|| Refusal::Wrong("unit: unknown".into()))?;
            Ok(Order::Failure { unit: *unit, words, fails: asked.needed("fails")? == "yes" })
        }
        _ => Err(Refusal::Wrong("act: unknown (allowed: note, wind, failure)".into())),
    }
}
