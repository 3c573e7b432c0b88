//! Training stations: computers that check in with the web server at short intervals and start the flights that an instructor
//! orders. Sans-IO: the caller supplies time and messages.
//!
//! A station sends a [`CheckIn`] and receives a [`CheckInReply`]. An order is repeated in every reply until the station has
//! answered it, because a reply can be lost. A station with a window first shows the briefing, and answers again when the trainee
//! has started or declined the flight.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Interval at which stations check in, s (estimate: an instructor waits at most this long).
pub const CHECK_IN_INTERVAL_S: u64 = 2;
/// Time after which a station that has not checked in counts as lost, µs.
const LOST_AFTER_US: u64 = 5 * CHECK_IN_INTERVAL_S * 1_000_000;
/// Time after which an order that was not answered expires, µs (estimate: no trainee expects a flight to start later).
const ORDER_EXPIRES_AFTER_US: u64 = 30_000_000;
/// Maximum number of stations.
pub const MAX_STATIONS: usize = 200;

/// A flight at a station.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StationFlight {
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Scenario with its form or level, as on the command line.
    pub scenario: String,
    /// `practice` or `assessment`.
    pub purpose: String,
}

/// A flight that an instructor has ordered.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FlightOrder {
    /// Unique ID.
    pub id: String,
    /// The flight.
    pub flight: StationFlight,
    /// Text of the scenario file, unless the scenario is shipped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scenario_text: Option<String>,
}

/// A station's answer to an order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct OrderAnswer {
    /// ID of the order.
    pub id: String,
    /// Why the flight was not started; `None` if it was, or if the trainee reads the briefing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refusal: Option<String>,
    /// Whether the trainee reads the briefing; another answer follows.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub in_briefing: bool,
}

/// Message from a station to the server.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CheckIn {
    /// Name of the station.
    pub station: String,
    /// Random number of the process, by which the server recognizes two stations with the same name.
    #[serde(default)]
    pub instance: u64,
    /// The flight in progress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flight: Option<StationFlight>,
    /// Answer to the last order.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub answer: Option<OrderAnswer>,
}

/// The server's reply.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct CheckInReply {
    /// Flight to start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<FlightOrder>,
}

/// The server's reply to a station that it rejects.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CheckInRefusal {
    /// Why, in English, for the station's log.
    pub error: String,
}

/// State of the last order to a station.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum OrderState {
    /// The station has not answered since this time, µs since the Unix epoch.
    Sent(FlightOrder, u64),
    /// The station did not answer in time, so that the order is void.
    Expired(StationFlight),
    /// The station shows the briefing, which the trainee has not acknowledged yet.
    InBriefing(FlightOrder),
    /// The station has started the flight.
    Started(StationFlight),
    /// The station could not start it, for this reason.
    Refused(StationFlight, String),
}

/// Availability of a station.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StationState {
    /// It waits for a flight.
    Ready,
    /// A flight is in progress.
    Flying,
    /// It has not checked in for a while.
    Lost,
}

impl OrderState {
    /// Returns the state after a check-in with this answer.
    fn answered(self, answer: Option<OrderAnswer>, now_unix_us: u64) -> Self {
        match (self, answer) {
            (Self::Sent(order, _) | Self::InBriefing(order), Some(answer)) if answer.id == order.id => match answer.refusal {
                Some(why) => Self::Refused(order.flight, why),
                None if answer.in_briefing => Self::InBriefing(order),
                None => Self::Started(order.flight),
            },
            (Self::Sent(order, since), _) if now_unix_us.saturating_sub(since) > ORDER_EXPIRES_AFTER_US => {
                Self::Expired(order.flight)
            }
            (order, _) => order,
        }
    }

    /// Returns the state after the station's program was restarted: a briefing that it showed is gone.
    fn after_restart(self) -> Self {
        match self {
            Self::InBriefing(order) => Self::Expired(order.flight),
            Self::Sent(..) | Self::Expired(_) | Self::Started(_) | Self::Refused(..) => self,
        }
    }
}

/// A station as the server knows it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Station {
    /// Random number of its process.
    pub instance: u64,
    /// The flight in progress at the last check-in.
    pub flight: Option<StationFlight>,
    /// Time of the last check-in, µs since the Unix epoch.
    pub seen_unix_us: u64,
    /// The last order.
    pub order: Option<OrderState>,
}

impl Station {
    /// Returns the state at this time.
    #[must_use]
    pub fn state(&self, now_unix_us: u64) -> StationState {
        if now_unix_us.saturating_sub(self.seen_unix_us) > LOST_AFTER_US {
            StationState::Lost
        } else if self.flight.is_some() {
            StationState::Flying
        } else {
            StationState::Ready
        }
    }
}

/// Why a flight cannot be ordered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum OrderError {
    /// No station with this name has checked in.
    #[error("unknown station")]
    Unknown,
    /// The station has not checked in for a while.
    #[error("the station does not respond")]
    Lost,
    /// A flight is in progress.
    #[error("a flight is in progress at this station")]
    Flying,
}

/// Why a station cannot check in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum CheckInError {
    /// There are too many stations.
    #[error("too many stations (at most {MAX_STATIONS})")]
    TooMany,
    /// Another station with this name is connected.
    #[error("another station with this name is connected: give each station a name of its own (--station)")]
    NameTaken,
}

/// All stations that have checked in since the server was started.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StationBoard(BTreeMap<String, Station>);

impl StationBoard {
    /// Handles a check-in. The caller has checked the name.
    ///
    /// # Errors
    /// Returns an error if there are too many stations, or another one has this name.
    pub fn check_in(&mut self, message: CheckIn, now_unix_us: u64) -> Result<CheckInReply, CheckInError> {
        self.make_room(&message.station, now_unix_us)?;
        let known = self.0.get(&message.station);
        let is_other = |known: &Station| known.instance != message.instance && known.state(now_unix_us) != StationState::Lost;
        if known.is_some_and(is_other) {
            return Err(CheckInError::NameTaken);
        }
        let is_restarted = known.is_some_and(|known| known.instance != message.instance);
        let before = self.0.remove(&message.station).and_then(|station| station.order);
        let before = if is_restarted { before.map(OrderState::after_restart) } else { before };
        let order = before.map(|order| order.answered(message.answer, now_unix_us));
        let pending = match &order {
            Some(OrderState::Sent(order, _)) if message.flight.is_none() => Some(order.clone()),
            _ => None,
        };
        let CheckIn { station, instance, flight, .. } = message;
        self.0.insert(station, Station { instance, flight, seen_unix_us: now_unix_us, order });
        Ok(CheckInReply { order: pending })
    }

    /// Removes lost stations if there is no room for a new one.
    fn make_room(&mut self, station: &str, now_unix_us: u64) -> Result<(), CheckInError> {
        if self.0.contains_key(station) || self.0.len() < MAX_STATIONS {
            return Ok(());
        }
        self.0.retain(|_, station| station.state(now_unix_us) != StationState::Lost);
        if self.0.len() < MAX_STATIONS { Ok(()) } else { Err(CheckInError::TooMany) }
    }

    /// Orders a flight. A newer order replaces one that the station has not answered yet.
    ///
    /// # Errors
    /// Returns an error if the station is unknown or lost, or a flight is in progress there.
    pub fn order(&mut self, station: &str, order: FlightOrder, now_unix_us: u64) -> Result<(), OrderError> {
        let station = self.0.get_mut(station).ok_or(OrderError::Unknown)?;
        match station.state(now_unix_us) {
            StationState::Ready => {}
            StationState::Flying => return Err(OrderError::Flying),
            StationState::Lost => return Err(OrderError::Lost),
        }
        station.order = Some(OrderState::Sent(order, now_unix_us));
        Ok(())
    }

    /// Returns the stations in the order of their names.
    pub fn stations(&self) -> impl Iterator<Item = (&str, &Station)> {
        self.0.iter().map(|(name, station)| (name.as_str(), station))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flight() -> StationFlight {
        StationFlight { trainee: "anna".into(), scenario: "drill-hover".into(), purpose: "practice".into() }
    }

    fn order(id: &str) -> FlightOrder {
        FlightOrder { id: id.into(), flight: flight(), scenario_text: None }
    }

    fn check_in(answer: Option<(&str, Option<&str>)>, flight: Option<StationFlight>) -> CheckIn {
        let answer =
            answer.map(|(id, refusal)| OrderAnswer { id: id.into(), refusal: refusal.map(str::to_owned), in_briefing: false });
        CheckIn { station: "s1".into(), instance: 1, flight, answer }
    }

    fn last_order(board: &StationBoard) -> Option<OrderState> {
        board.stations().next().and_then(|(_, station)| station.order.clone())
    }

    #[test]
    fn exact_order_is_repeated_until_the_station_answers() {
        let mut board = StationBoard::default();
        assert_eq!(board.order("s1", order("a"), 0), Err(OrderError::Unknown));
        assert_eq!(board.check_in(check_in(None, None), 0), Ok(CheckInReply::default()));
        assert_eq!(board.order("s1", order("a"), 1), Ok(()));
        for now in [2, 3] {
            assert_eq!(board.check_in(check_in(Some(("old", None)), None), now).unwrap().order, Some(order("a")));
        }
        assert_eq!(board.check_in(check_in(Some(("a", None)), Some(flight())), 4), Ok(CheckInReply::default()));
        assert_eq!(last_order(&board), Some(OrderState::Started(flight())));
        assert_eq!(board.order("s1", order("b"), 5), Err(OrderError::Flying));
        board.check_in(check_in(None, None), 6).unwrap();
        board.order("s1", order("b"), 7).unwrap();
        board.check_in(check_in(Some(("b", Some("no such file"))), None), 8).unwrap();
        assert_eq!(last_order(&board), Some(OrderState::Refused(flight(), "no such file".into())));
        assert_eq!(board.order("s1", order("c"), 8 + LOST_AFTER_US + 1), Err(OrderError::Lost));
    }

    #[test]
    fn exact_a_briefing_ends_with_the_start_or_a_refusal_and_does_not_expire() {
        let reading = |id: &str| {
            let answer = OrderAnswer { id: id.into(), refusal: None, in_briefing: true };
            CheckIn { answer: Some(answer), ..check_in(None, None) }
        };
        let mut board = StationBoard::default();
        board.check_in(check_in(None, None), 0).unwrap();
        for (id, refusal) in [("a", None), ("b", Some("declined"))] {
            board.order("s1", order(id), 0).unwrap();
            assert_eq!(board.check_in(reading(id), 1), Ok(CheckInReply::default()), "the order is not repeated");
            let late = LOST_AFTER_US - 1;
            board.check_in(reading(id), late).unwrap();
            board.check_in(reading(id), ORDER_EXPIRES_AFTER_US + 2).unwrap();
            assert_eq!(last_order(&board), Some(OrderState::InBriefing(order(id))));
            board.check_in(check_in(Some((id, refusal)), None), ORDER_EXPIRES_AFTER_US + 3).unwrap();
        }
        assert_eq!(last_order(&board), Some(OrderState::Refused(flight(), "declined".into())));
        board.order("s1", order("c"), ORDER_EXPIRES_AFTER_US + 4).unwrap();
        board.check_in(reading("c"), ORDER_EXPIRES_AFTER_US + 5).unwrap();
        let restarted = CheckIn { instance: 2, ..check_in(None, None) };
        board.check_in(restarted, ORDER_EXPIRES_AFTER_US + LOST_AFTER_US + 9).unwrap();
        assert_eq!(last_order(&board), Some(OrderState::Expired(flight())));
    }

    #[test]
    fn exact_orders_expire_and_wait_for_no_flight_in_progress() {
        let mut board = StationBoard::default();
        board.check_in(check_in(None, None), 0).unwrap();
        board.order("s1", order("a"), 0).unwrap();
        assert_eq!(board.check_in(check_in(None, Some(flight())), 1).unwrap().order, None, "the trainee has just started one");
        assert_eq!(board.check_in(check_in(None, None), ORDER_EXPIRES_AFTER_US).unwrap().order, Some(order("a")));
        assert_eq!(board.check_in(check_in(None, None), ORDER_EXPIRES_AFTER_US + 1).unwrap().order, None);
        assert_eq!(last_order(&board), Some(OrderState::Expired(flight())));
        board.check_in(check_in(Some(("a", None)), None), ORDER_EXPIRES_AFTER_US + 2).unwrap();
        assert_eq!(last_order(&board), Some(OrderState::Expired(flight())), "a late answer");
    }

    #[test]
    fn exact_name_belongs_to_one_station_until_it_is_lost() {
        let mut board = StationBoard::default();
        let other = || CheckIn { instance: 2, ..check_in(None, None) };
        board.check_in(check_in(None, None), 0).unwrap();
        assert_eq!(board.check_in(other(), 1), Err(CheckInError::NameTaken));
        board.check_in(other(), LOST_AFTER_US + 1).unwrap();
        assert_eq!(board.check_in(check_in(None, None), LOST_AFTER_US + 2), Err(CheckInError::NameTaken));
    }

    #[test]
    fn exact_lost_stations_make_room_for_new_ones() {
        let mut board = StationBoard::default();
        let new = |k: usize| CheckIn { station: format!("s{k}"), ..check_in(None, None) };
        for k in 0..MAX_STATIONS {
            board.check_in(new(k), 0).unwrap();
        }
        assert_eq!(board.check_in(new(MAX_STATIONS), 1), Err(CheckInError::TooMany));
        board.check_in(new(0), LOST_AFTER_US).unwrap();
        board.check_in(new(MAX_STATIONS), LOST_AFTER_US + 1).unwrap();
        assert_eq!(board.stations().map(|(name, _)| name).collect::<Vec<_>>(), ["s0".to_owned(), format!("s{MAX_STATIONS}")]);
    }

    #[test]
    fn exact_messages_survive_json() {
        let message = check_in(Some(("a", Some("why"))), Some(flight()));
        let text = serde_json::to_string(&message).unwrap();
        assert_eq!(serde_json::from_str::<CheckIn>(&text).unwrap(), message);
        assert!(!text.contains("in_briefing"), "older servers get what they know: {text}");
        let least = CheckIn { instance: 0, ..check_in(None, None) };
        assert_eq!(serde_json::from_str::<CheckIn>("{\"station\":\"s1\"}").unwrap(), least);
        assert_eq!(serde_json::to_string(&CheckInReply::default()).unwrap(), "{}");
    }
}
