//! Connection of a training station to the web server: checks in, and receives the flights that an instructor orders.

use crate::errors::AppError;
use crate::io::clock::Stopwatch;
use crate::io::files::{self, FORM_SEPARATOR};
use crate::io::picture_file::{MAX_PICTURE_BYTES, PictureFile};
use crate::io::replace::replace;
use crate::io::station_key::StationKey;
use crate::io::trainee_id::TraineeId;
use crate::web::picture_store::{picture_path, remove_unlisted};
use crate::web::scenario_library::{self, MAX_SCENARIO_BYTES, UPLOAD_FOLDER, upload_path};
use spandrel_model::scenario::Scenario;
use spandrel_text::{Language, text};
use spandrel_training::stations::{
    CHECK_IN_INTERVAL_S, CheckIn, CheckInRefusal, CheckInReply, FlightOrder, OrderAnswer, StationFlight,
};
use spandrel_view::flow::pipe::{FlightChoice, FlownBy, Purpose};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use ureq::tls::{PemItem, RootCerts, TlsConfig};

/// Timeout for a request.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(10);
/// Limit for all pictures of an order together (estimate): the server takes a station that does not check in for 10 s for lost.
const PICTURES_TIMEOUT: Duration = Duration::from_secs(6);
/// Interval at which the thread checks whether it must stop.
const STOP_CHECK_INTERVAL: Duration = Duration::from_millis(100);
/// Folder for scenarios from the server, inside the folder for the station's own scenarios: it never replaces those.
const SERVER_FOLDER: &str = "from-server";
/// Maximum size of a reply, bytes: a scenario in JSON.
const MAX_REPLY_BYTES: u64 = 2 * MAX_SCENARIO_BYTES as u64 + 4_096;

/// State that the thread sends.
#[derive(Debug, Default)]
struct Shared {
    flight: Option<StationFlight>,
    answer: Option<OrderAnswer>,
}

/// An order with the pictures of its briefing, by their names in the scenario.
#[derive(Debug)]
struct ReceivedOrder {
    order: FlightOrder,
    pictures: Vec<(String, PictureFile)>,
}

/// A station's connection.
pub struct StationLink {
    shared: Arc<Mutex<Shared>>,
    orders: Receiver<ReceivedOrder>,
    /// ID of the order whose flight is about to start.
    starting: Option<String>,
    stop: Arc<AtomicBool>,
    sessions: PathBuf,
}

/// Address, name and files of a station.
#[derive(Debug, Clone, Copy)]
pub struct StationSetup<'a> {
    /// URL of the server.
    pub server: &'a str,
    /// Certificates that the server's certificate must be signed by (PEM); `None` for the public authorities.
    pub server_ca: Option<&'a Path>,
    /// Name of the station.
    pub name: &'a TraineeId,
    /// File with the stations' key.
    pub key: &'a Path,
    /// Folder with the sessions.
    pub sessions: &'a Path,
}

impl StationLink {
    /// Starts to check in.
    ///
    /// # Errors
    /// Returns an error if the key or the certificates cannot be read.
    pub fn start(setup: &StationSetup<'_>) -> Result<Self, AppError> {
        let client = StationClient::new(setup)?;
        let (shared, stop) = (Arc::new(Mutex::new(Shared::default())), Arc::new(AtomicBool::new(false)));
        let (sender, orders) = channel();
        let (own, stopped) = (shared.clone(), stop.clone());
        std::thread::spawn(move || client.run(&own, &sender, &stopped));
        Ok(Self { shared, orders, starting: None, stop, sessions: setup.sessions.to_path_buf() })
    }

    /// Reports that a flight has started, which answers the order for it. Refuses an order that arrived in the meantime.
    pub fn report_start(&mut self, choice: &FlightChoice) {
        lock(&self.shared).flight = Some(StationFlight {
            trainee: choice.trainee.clone(),
            scenario: job_name(&choice.scenario),
            purpose: choice.purpose.word().to_owned(),
        });
        match self.starting.take() {
            Some(order) => self.answer(order, None),
            None => {
                if let Some(ReceivedOrder { order, .. }) = self.orders.try_iter().last() {
                    self.answer(order.id, Some(text!(Language::English, "stations-refusal-flying")));
                }
            }
        }
    }

    /// Reports the end of a flight, or why it could not be started.
    pub fn report_end(&mut self, error: Option<&AppError>) {
        lock(&self.shared).flight = None;
        if let Some(order) = self.starting.take() {
            self.answer(order, error.map(ToString::to_string));
        }
    }

    /// Reports that the trainee reads the briefing of the ordered flight.
    pub fn report_briefing(&mut self) {
        if let Some(id) = self.starting.clone() {
            lock(&self.shared).answer = Some(OrderAnswer { id, refusal: None, in_briefing: true });
        }
    }

    /// Reports why the ordered flight does not start, if there is one.
    pub fn decline(&mut self, why: String) {
        if let Some(order) = self.starting.take() {
            self.answer(order, Some(why));
        }
    }

    /// Returns the next flight that an instructor has ordered, with the station's aircraft. The order is answered once the flight has started.
    pub fn next_flight(&mut self, vehicle: &str) -> Option<FlightChoice> {
        let ReceivedOrder { order, pictures } = self.orders.try_iter().last()?;
        match choice(&order, (&self.sessions, vehicle)) {
            Ok(choice) => {
                if let Err(error) = save_pictures(&order, &pictures, &server_folder(&self.sessions)) {
                    // The briefing is shown without them.
                    tracing::warn!("the pictures of {} were not saved: {error}", order.flight.scenario);
                }
                tracing::info!("the instructor starts {} for {}", order.flight.scenario, order.flight.trainee);
                self.starting = Some(order.id);
                Some(choice)
            }
            Err(error) => {
                self.answer(order.id, Some(error.to_string()));
                None
            }
        }
    }

    fn answer(&self, id: String, refusal: Option<String>) {
        if let Some(why) = &refusal {
            tracing::warn!("the flight ordered by the instructor was not started: {why}");
        }
        lock(&self.shared).answer = Some(OrderAnswer { id, refusal, in_briefing: false });
    }
}

impl Drop for StationLink {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::SeqCst);
    }
}

fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Converts an order to a choice of a flight with an aircraft, as if the trainee had made it. Saves the scenario unless it is shipped.
fn choice(order: &FlightOrder, (sessions, vehicle): (&Path, &str)) -> Result<FlightChoice, AppError> {
    let flight = &order.flight;
    flight.trainee.parse::<TraineeId>().map_err(AppError::invalid)?;
    let purpose = [Purpose::Practice, Purpose::Assessment].into_iter().find(|purpose| purpose.word() == flight.purpose);
    let purpose = purpose.ok_or_else(|| AppError::invalid(format!("unknown purpose '{}'", flight.purpose)))?;
    let scenario = match &order.scenario_text {
        Some(text) => save_scenario(&flight.scenario, text, &server_folder(sessions))?,
        None if files::scenario_names().contains(&split(&flight.scenario).0) => flight.scenario.clone(),
        None => return Err(AppError::invalid(format!("'{}' is not a shipped scenario", flight.scenario))),
    };
    files::scenario(&scenario)?;
    Ok(FlightChoice { trainee: flight.trainee.clone(), scenario, purpose, by: FlownBy::Trainee, vehicle: vehicle.to_owned() })
}

/// Returns the folder for scenarios from the server.
fn server_folder(sessions: &Path) -> PathBuf {
    sessions.join(UPLOAD_FOLDER).join(SERVER_FOLDER)
}

/// Returns the name of a job from its argument, which may be a path, with the form or level.
fn job_name(argument: &str) -> String {
    let (file, variant) = split(argument);
    let name = Path::new(file).file_stem().map_or_else(|| file.into(), |stem| stem.to_string_lossy());
    files::with_variant(&name, variant, None)
}

/// Splits a scenario argument into the name and the form or level.
fn split(argument: &str) -> (&str, Option<&str>) {
    argument.split_once(FORM_SEPARATOR).map_or((argument, None), |(name, variant)| (name, Some(variant)))
}

/// Saves a scenario and returns the argument that names it, with its form or level.
fn save_scenario(name: &str, text: &str, folder: &Path) -> Result<String, AppError> {
    let (stem, variant) = split(name);
    // The name becomes a file name.
    stem.parse::<TraineeId>().map_err(AppError::invalid)?;
    let scenario = scenario_library::read(folder, stem, text)?;
    if scenario.name != stem {
        return Err(AppError::invalid(format!("the scenario is named '{}' and not '{stem}'", scenario.name)));
    }
    std::fs::create_dir_all(folder).map_err(|error| AppError::failed(format!("{}: {error}", folder.display())))?;
    let path = upload_path(folder, stem);
    replace(&path, text.as_bytes())?;
    Ok(files::with_variant(&path.display().to_string(), variant, None))
}

/// Returns the scenario of an order, unless it is shipped or invalid.
fn ordered_scenario(folder: &Path, order: &FlightOrder) -> Option<Scenario> {
    let (stem, _) = split(&order.flight.scenario);
    scenario_library::read(folder, stem, order.scenario_text.as_deref()?).ok().filter(|scenario| scenario.name == stem)
}

/// Saves the pictures of an order's briefing beside its scenario, and removes those of an earlier version.
fn save_pictures(order: &FlightOrder, pictures: &[(String, PictureFile)], folder: &Path) -> Result<(), AppError> {
    let Some(scenario) = ordered_scenario(folder, order) else { return Ok(()) };
    for (name, picture) in pictures {
        let Some(path) = picture_path(folder, &scenario.name, name) else { continue };
        let own = folder.join(&scenario.name);
        std::fs::create_dir_all(&own).map_err(|error| AppError::failed(format!("{}: {error}", own.display())))?;
        replace(&path, &picture.bytes)?;
    }
    remove_unlisted(folder, &scenario.name, &scenario.briefing_pictures);
    Ok(())
}

/// The part that talks to the server, in a thread of its own.
struct StationClient {
    agent: ureq::Agent,
    /// Address of the server, without a slash at the end.
    server: String,
    url: String,
    authorization: String,
    name: String,
    instance: u64,
    /// Folder for scenarios from the server.
    folder: PathBuf,
}

impl StationClient {
    fn new(setup: &StationSetup<'_>) -> Result<Self, AppError> {
        let mut tls = TlsConfig::builder();
        if let Some(file) = setup.server_ca {
            tls = tls.root_certs(certificates(file)?);
        }
        let config = ureq::Agent::config_builder()
            .http_status_as_error(false)
            .timeout_global(Some(REQUEST_TIMEOUT))
            .max_redirects(0)
            .tls_config(tls.build())
            .build();
        let mut instance = [0; 8];
        getrandom::fill(&mut instance)
            .map_err(|error| AppError::failed(format!("the system's random number generator failed: {error}")))?;
        Ok(Self {
            agent: config.into(),
            server: setup.server.trim_end_matches('/').to_owned(),
            url: format!("{}/stations/check-in", setup.server.trim_end_matches('/')),
            authorization: StationKey::read(setup.key)?.authorization(),
            name: setup.name.as_str().to_owned(),
            instance: u64::from_le_bytes(instance),
            folder: server_folder(setup.sessions),
        })
    }

    /// Checks in until the connection is dropped. Reports only changes of the connection.
    fn run(&self, shared: &Mutex<Shared>, orders: &Sender<ReceivedOrder>, stop: &AtomicBool) {
        let (mut connected, mut last_order) = (None, None);
        while !stop.load(Ordering::SeqCst) {
            match self.check_in(shared) {
                Ok(reply) => {
                    if connected != Some(true) {
                        tracing::info!("connected to {} as station {}", self.url, self.name);
                    }
                    connected = Some(true);
                    if let Some(order) = reply.order.filter(|order| last_order.as_ref() != Some(&order.id)) {
                        last_order = Some(order.id.clone());
                        let pictures = self.pictures(&order);
                        if orders.send(ReceivedOrder { order, pictures }).is_err() {
                            return;
                        }
                    }
                }
                Err(why) => {
                    if connected != Some(false) {
                        tracing::warn!("{}: {why}; the station keeps trying", self.url);
                    }
                    connected = Some(false);
                }
            }
            let mut waited = Duration::ZERO;
            while waited < Duration::from_secs(CHECK_IN_INTERVAL_S) && !stop.load(Ordering::SeqCst) {
                std::thread::sleep(STOP_CHECK_INTERVAL);
                waited += STOP_CHECK_INTERVAL;
            }
        }
    }

    /// Fetches the pictures of an order's briefing. After the first one that fails, the briefing is shown without the rest.
    fn pictures(&self, order: &FlightOrder) -> Vec<(String, PictureFile)> {
        let Some(scenario) = ordered_scenario(&self.folder, order) else { return Vec::new() };
        let listed = scenario.briefing_pictures.into_iter().map(|picture| picture.file);
        // Only pictures in the scenario's own folder are on the server. Their names need no escapes in a URL.
        let own = listed.filter(|name| picture_path(Path::new(""), &scenario.name, name).is_some());
        let waiting = Stopwatch::start();
        let fetch = |name: String| match self.picture(&name, PICTURES_TIMEOUT.saturating_sub(waiting.elapsed())) {
            Ok(picture) => Some((name, picture)),
            Err(why) => {
                tracing::debug!("cannot fetch the picture {name}: {why}");
                None
            }
        };
        own.map_while(fetch).collect()
    }

    fn picture(&self, name: &str, timeout: Duration) -> Result<PictureFile, String> {
        let request = self.agent.get(&format!("{}/stations/pictures/{name}", self.server));
        let request = request.config().timeout_global(Some(timeout)).build();
        let mut answer = request.header("Authorization", &self.authorization).call().map_err(|error| error.to_string())?;
        if answer.status().as_u16() != 200 {
            return Err(format!("status {}", answer.status().as_u16()));
        }
        let limit = MAX_PICTURE_BYTES as u64 + 1;
        let bytes = answer.body_mut().with_config().limit(limit).read_to_vec().map_err(|error| error.to_string())?;
        PictureFile::new(bytes).map_err(|error| error.to_string())
    }

    fn check_in(&self, shared: &Mutex<Shared>) -> Result<CheckInReply, String> {
        let message = {
            let now = lock(shared);
            CheckIn {
                station: self.name.clone(),
                instance: self.instance,
                flight: now.flight.clone(),
                answer: now.answer.clone(),
            }
        };
        let body = serde_json::to_string(&message).map_err(|error| error.to_string())?;
        let request = self.agent.post(&self.url).header("Content-Type", "application/json");
        let sent = request.header("Accept", "application/json").header("Authorization", &self.authorization).send(&body);
        let mut answer = sent.map_err(|error| error.to_string())?;
        let status = answer.status().as_u16();
        let text = answer.body_mut().with_config().limit(MAX_REPLY_BYTES).read_to_string().map_err(|error| error.to_string())?;
        if status == 200 {
            return serde_json::from_str(&text).map_err(|error| format!("the reply is invalid: {error}"));
        }
        Err(match serde_json::from_str::<CheckInRefusal>(&text) {
            Ok(refusal) => format!("the server rejects the station: {}", refusal.error),
            Err(_) if status == 404 => "the server does not accept stations (serve --station-key)".to_owned(),
            // The server's own checks: host name, origin, proxy.
            Err(_) => format!("the server rejects the request (status {status}): open its address in a browser to see why"),
        })
    }
}

/// Reads certificates from a PEM file.
fn certificates(file: &Path) -> Result<RootCerts, AppError> {
    let bytes = std::fs::read(file).map_err(|error| AppError::failed(format!("{}: {error}", file.display())))?;
    let found = ureq::tls::parse_pem(&bytes).filter_map(|item| match item {
        Ok(PemItem::Certificate(certificate)) => Some(Ok(certificate)),
        Ok(_) => None,
        Err(error) => Some(Err(error)),
    });
    let found = found.collect::<Result<Vec<_>, _>>();
    let found = found.map_err(|error| AppError::invalid(format!("{}: not a certificate (PEM): {error}", file.display())))?;
    if found.is_empty() {
        return Err(AppError::invalid(format!("{}: contains no certificate (PEM)", file.display())));
    }
    Ok(RootCerts::Specific(Arc::new(found)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario::BriefingPicture;
    use spandrel_model::scenario::edit::with_briefing_picture;
    use spandrel_model::shipped;
    use spandrel_view::picture::Picture;

    fn order(scenario: &str, purpose: &str, text: Option<&str>) -> FlightOrder {
        let flight = StationFlight { trainee: "anna".into(), scenario: scenario.into(), purpose: purpose.into() };
        FlightOrder { id: "a".into(), flight, scenario_text: text.map(str::to_owned) }
    }

    #[test]
    fn exact_orders_become_choices_and_own_scenarios_are_saved() {
        let sessions = tempfile::tempdir().unwrap();
        let shipped = choice(&order("drill-hover", "assessment", None), (sessions.path(), "phantom2")).unwrap();
        assert_eq!((shipped.scenario.as_str(), shipped.purpose), ("drill-hover", Purpose::Assessment));
        let text = shipped::PRACTICE.replace("name = \"practice\"", "name = \"windy\"");
        let own = choice(&order("windy", "practice", Some(&text)), (sessions.path(), "phantom2")).unwrap();
        let path = sessions.path().join(UPLOAD_FOLDER).join(SERVER_FOLDER).join("windy.toml");
        assert_eq!(own.scenario, path.display().to_string());
        assert_eq!(std::fs::read_to_string(path).unwrap(), text);
    }

    #[test]
    fn exact_pictures_of_an_order_are_saved_where_its_scenario_expects_them() {
        let folder = tempfile::tempdir().unwrap();
        let text = |files: &[&str]| {
            let add = |text: String, file: &&str| {
                with_briefing_picture(&text, &BriefingPicture { file: (*file).into(), caption: "The gate".into() }).unwrap()
            };
            files.iter().fold(shipped::PRACTICE.replace("name = \"practice\"", "name = \"windy\""), add)
        };
        let png = crate::io::png::png(&Picture { width: 1, height: 1, rgba: vec![9; 4] }).unwrap();
        let picture = |name: &str| (name.to_owned(), PictureFile::new(png.clone()).unwrap());
        let names = || {
            let entries = std::fs::read_dir(folder.path().join("windy")).into_iter().flatten().flatten();
            let mut names: Vec<_> = entries.map(|entry| entry.file_name().into_string().unwrap()).collect();
            names.sort();
            names
        };
        let save = |files: &[&str], pictures: &[(String, PictureFile)]| {
            let order = order("windy@5", "practice", Some(&text(files)));
            save_pictures(&order, pictures, folder.path()).unwrap();
        };
        let sent = [picture("windy/a.png"), picture("windy/b.png"), picture("other/c.png"), picture("../d.png")];
        save(&["windy/a.png", "windy/b.png"], &sent);
        assert_eq!(names(), ["a.png", "b.png"]);
        assert_eq!(std::fs::read(folder.path().join("windy/a.png")).unwrap(), png);
        save(&["windy/b.png"], &[]);
        assert_eq!(names(), ["b.png"], "those of an earlier version are removed");
        save_pictures(&order("drill-hover", "practice", None), &sent, folder.path()).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "a shipped scenario has none");
    }

    #[test]
    fn exact_job_names_are_reported_without_their_folder() {
        assert_eq!(job_name("drill-gap@6"), "drill-gap@6");
        assert_eq!(job_name("sessions/scenarios/from-server/windy.toml"), "windy");
        assert_eq!(job_name("/srv/a b.toml@B"), "a b@B");
    }

    #[test]
    fn exact_bad_orders_are_refused_and_leave_no_file() {
        let sessions = tempfile::tempdir().unwrap();
        let text = shipped::PRACTICE.replace("name = \"practice\"", "name = \"windy\"");
        for bad in [
            order("no-such-job", "practice", None),
            order("/etc/passwd", "practice", None),
            order("../windy", "practice", Some(&text)),
            order("calm", "practice", Some(&text)),
            order("windy", "practice", Some("name = ")),
            order("drill-hover", "fun", None),
            FlightOrder {
                flight: StationFlight { trainee: "a b".into(), ..order("drill-hover", "practice", None).flight },
                ..order("x", "x", None)
            },
        ] {
            assert!(choice(&bad, (sessions.path(), "phantom2")).is_err(), "{bad:?}");
        }
        assert!(!sessions.path().join(UPLOAD_FOLDER).exists());
    }
}
