//! Page with the training stations, where an instructor starts flights.

use super::access::Visitor;
use super::assets;
use super::layout::{STATIONS_URL, message, page_with_script, section, table, token};
use crate::stations::{OrderState, Station, StationFlight, StationState};
use maud::{Markup, html};
use spandrel_text::terms::{capitalized, purpose_title};
use spandrel_text::{Language, Sentence, SentenceTable, text};
use std::sync::LazyLock;

/// URL of the page.
pub const URL: &str = STATIONS_URL;

/// The stations at a time.
#[derive(Debug)]
pub struct StationList<'a> {
    /// Stations by name.
    pub stations: Vec<(&'a str, &'a Station)>,
    /// Current time, µs since the Unix epoch.
    pub now_unix_us: u64,
}

/// Contents of the page.
#[derive(Debug)]
pub struct StationsPage<'a> {
    /// The stations.
    pub list: StationList<'a>,
    /// Names of the scenarios, and their names with each form or level.
    pub scenarios: &'a [&'a str],
    /// Known trainees.
    pub trainees: &'a [String],
    /// Why the last order was refused.
    pub refusal: Option<&'a str>,
    /// Values of the refused order: station, trainee, scenario, purpose.
    pub entered: [&'a str; 4],
    /// Whether the server accepts stations.
    pub enabled: bool,
}

/// Renders the page.
#[must_use]
pub fn stations_page(visitor: &Visitor, about: &StationsPage<'_>) -> Markup {
    let language = visitor.language;
    let body = html! {
        @if let Some(refusal) = about.refusal { (message("bad", refusal)) }
        @if about.list.stations.is_empty() {
            p { (if about.enabled { text!(language, "stations-none") } else { text!(language, "stations-disabled") }) }
        } @else {
            (section("stations", &text!(language, "stations-title"), &station_table(language, &about.list)))
            (section("start-flight", &text!(language, "stations-start"), &order_form(visitor, about)))
        }
    };
    page_with_script(visitor, URL, &text!(language, "stations-title"), Some(assets::STATIONS_SCRIPT_NAME), &body)
}

/// Renders what changes on the page: the table, and the stations that can be selected. The page asks for it at short intervals.
#[must_use]
pub fn stations_now(language: Language, list: &StationList<'_>) -> Markup {
    html! {
        @if !list.stations.is_empty() {
            (station_table(language, list))
            (station_select(list, ""))
        }
    }
}

fn station_table(language: Language, list: &StationList<'_>) -> Markup {
    let heads = [
        text!(language, "stations-name"),
        text!(language, "stations-state"),
        text!(language, "stations-flight"),
        text!(language, "stations-order"),
    ];
    let heads = heads.map(|head| (head, false));
    let rows = html! {
        @for (name, station) in &list.stations {
            tr {
                th scope="row" { (name) }
                td { (state_words(language, station.state(list.now_unix_us))) }
                td { @match &station.flight { Some(flight) => (flight_words(language, flight)), None => "–" } }
                td { (order_words(language, station.order.as_ref())) }
            }
        }
    };
    html! { div id="station-table" { (table(&text!(language, "stations-table"), &heads, &rows)) } }
}

fn state_words(language: Language, state: StationState) -> String {
    match state {
        StationState::Ready => text!(language, "stations-ready"),
        StationState::Flying => text!(language, "stations-flying"),
        StationState::Lost => text!(language, "stations-lost"),
    }
}

fn flight_words(language: Language, flight: &StationFlight) -> String {
    let (trainee, job) = (flight.trainee.as_str(), flight.scenario.as_str());
    if flight.purpose == ASSESSMENT {
        text!(language, "stations-assessment-of", trainee = trainee, job = job)
    } else {
        text!(language, "stations-practice-of", trainee = trainee, job = job)
    }
}

fn order_words(language: Language, order: Option<&OrderState>) -> String {
    match order {
        None => "–".to_owned(),
        Some(OrderState::Sent(order, _)) => text!(language, "stations-sent", flight = flight_words(language, &order.flight)),
        Some(OrderState::Expired(flight)) => text!(language, "stations-expired", flight = flight_words(language, flight)),
        Some(OrderState::InBriefing(order)) => {
            text!(language, "stations-in-briefing", flight = flight_words(language, &order.flight))
        }
        Some(OrderState::Started(flight)) => text!(language, "stations-started", flight = flight_words(language, flight)),
        Some(OrderState::Refused(flight, why)) => {
            text!(language, "stations-refused", flight = flight_words(language, flight), why = refusal_words(language, why))
        }
    }
}

/// Known reasons of stations.
static REFUSALS: LazyLock<SentenceTable> = LazyLock::new(|| {
    SentenceTable::new([
        Sentence::new(0, |l, _| text!(l, "stations-refusal-declined")),
        Sentence::new(0, |l, _| text!(l, "stations-refusal-other-flight")),
        Sentence::new(0, |l, _| text!(l, "stations-refusal-window-closed")),
        Sentence::new(0, |l, _| text!(l, "stations-refusal-flying")),
    ])
});

/// Returns why a station did not start a flight. Errors of the station are in English.
fn refusal_words(language: Language, why: &str) -> String {
    REFUSALS.translate(why, language).unwrap_or_else(|| why.to_owned())
}

/// Purposes, as in files.
const PRACTICE: &str = "practice";
const ASSESSMENT: &str = "assessment";

fn station_select(list: &StationList<'_>, selected: &str) -> Markup {
    html! {
        select name="station" required {
            @for (name, station) in &list.stations {
                option value=(name) selected[*name == selected] disabled[station.state(list.now_unix_us) != StationState::Ready] { (name) }
            }
        }
    }
}

fn order_form(visitor: &Visitor, about: &StationsPage<'_>) -> Markup {
    let language = visitor.language;
    let [station_name, trainee, scenario, purpose] = about.entered;
    html! {
        form.stacked method="post" action=(URL) {
            (token(visitor))
            label { (text!(language, "stations-station")) (station_select(&about.list, station_name)) }
            label { (text!(language, "stations-trainee"))
                input name="trainee" list="known-trainees" value=(trainee) required maxlength="32" autocomplete="off";
            }
            datalist id="known-trainees" { @for name in about.trainees { option value=(name) {} } }
            label { (text!(language, "stations-job"))
                select name="scenario" required { @for name in about.scenarios { option value=(name) selected[*name == scenario] { (name) } } }
            }
            label { (text!(language, "stations-purpose"))
                select name="purpose" {
                    option value=(PRACTICE) { (capitalized(&purpose_title(PRACTICE, language))) }
                    option value=(ASSESSMENT) selected[purpose == ASSESSMENT] { (capitalized(&purpose_title(ASSESSMENT, language))) }
                }
            }
            button type="submit" { (text!(language, "stations-start")) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::layout::tests::{HOSTILE_NAME, administrator, check};
    use super::*;
    use crate::stations::{CheckIn, FlightOrder, StationBoard};

    fn flight() -> StationFlight {
        StationFlight { trainee: HOSTILE_NAME.into(), scenario: "drill-hover".into(), purpose: PRACTICE.into() }
    }

    #[test]
    fn exact_page_shows_stations_and_offers_only_those_that_are_ready() {
        let mut board = StationBoard::default();
        let station = |name: &str, flight| CheckIn { station: name.into(), instance: 1, flight, answer: None };
        board.check_in(station("s1", None), 0).unwrap();
        board.check_in(station("s2", Some(flight())), 0).unwrap();
        board.order("s1", FlightOrder { id: "a".into(), flight: flight(), scenario_text: None }, 0).unwrap();
        let about = |now_unix_us| StationsPage {
            list: StationList { stations: board.stations().collect(), now_unix_us },
            scenarios: &[],
            trainees: &[],
            refusal: Some(HOSTILE_NAME),
            entered: ["s1", HOSTILE_NAME, "", ""],
            enabled: true,
        };
        let text = stations_page(&administrator(), &about(0)).into_string();
        check(&text);
        assert!(text.contains("<option value=\"s1\" selected>") && text.contains("<option value=\"s2\" disabled>"), "{text}");
        assert!(text.contains("ready") && text.contains("practice of"), "{text}");
        let words = |order: OrderState| order_words(Language::German, Some(&order));
        let refused = OrderState::Refused(flight(), "the trainee declined the flight".into());
        assert!(words(refused).ends_with("der Trainee hat den Flug abgelehnt"));
        assert!(words(OrderState::Refused(flight(), "no such file".into())).ends_with("no such file"));
        let order = FlightOrder { id: "a".into(), flight: flight(), scenario_text: None };
        assert!(words(OrderState::InBriefing(order)).starts_with("Einweisung: "));
        let now = stations_now(Language::English, &about(0).list).into_string();
        let table = now.split_once("<select").unwrap().0;
        assert!(text.contains(table) && now.contains("<option value=\"s2\" disabled>"), "{now}");
        let german = Visitor { language: Language::German, ..administrator() };
        let lost = stations_page(&german, &about(u64::MAX)).into_string();
        assert!(lost.contains("keine Verbindung") && lost.contains("<option value=\"s1\" selected disabled>"), "{lost}");
    }

    #[test]
    fn exact_empty_page_explains_how_stations_connect() {
        let about = |enabled| StationsPage {
            list: StationList { stations: Vec::new(), now_unix_us: 0 },
            scenarios: &[],
            trainees: &[],
            refusal: None,
            entered: [""; 4],
            enabled,
        };
        let text = stations_page(&administrator(), &about(true)).into_string();
        assert!(text.contains("No station") && !text.contains("<select"), "{text}");
        assert_eq!(stations_now(Language::English, &about(true).list).into_string(), "");
        assert!(stations_page(&administrator(), &about(false)).into_string().contains("--station-key"));
    }
}
