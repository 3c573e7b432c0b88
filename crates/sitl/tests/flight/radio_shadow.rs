//! Flight into the radio shadow of a bridge: first the video, then control is lost, and the aircraft's failsafe takes over.

use spandrel_mavlink::codec::Decoder;
use spandrel_mavlink::contract::hazards::{HazardReport, RadioMargins, WaterSensors};
use spandrel_mavlink::contract::radio_status::dbm_of_value;
use spandrel_mavlink::dialect::{MavCmd, MavMessage};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::radio::RadioWay;
use spandrel_model::scenario::read;
use spandrel_model::shipped;
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::{LinkId, LinkKind};
use spandrel_sitl::testing::Vehicle;

/// Link that receives the scoring data. The radio does not affect it.
const PAYLOAD: LinkId = LinkId(2);
/// In front of the arch bridge, and behind it, each in sight of the inspector above the deck, m.
const BEFORE_M: Vec3<Enu> = Vec3::new(-46.9, 30.0, 52.0);
const BEHIND_M: Vec3<Enu> = Vec3::new(-46.9, -16.0, 48.0);
/// Above the lake, between the bridges and in reach of the range finder, m.
const OVER_WATER_M: Vec3<Enu> = Vec3::new(0.0, 75.0, 6.0);
/// Height at which the deck and the arch are between inspector and aircraft, m.
const SHADOW_UP_M: f64 = 26.0;
/// Margin below which data is lost, dB.
const LOSSY_DB: f64 = 3.0;
/// Vertical stick for a slow descent, 0 to 1.
const DESCENT: f64 = 0.3;
/// PX4's main mode for position control.
const POSITION_MODE: f32 = 3.0;

/// A flight with the messages of the payload link.
struct Flight {
    vehicle: Vehicle,
    payload: Vec<MavMessage>,
}

impl Flight {
    /// Takes off in a job with these lines in its table of hazards.
    fn begin(hazards: &str) -> Self {
        let text = format!("{}\n[hazards]\n{hazards}\n", shipped::without_hazards(shipped::TWO_BRIDGES));
        let mut vehicle = Vehicle::builder().scenario(text).build().unwrap();
        vehicle.sim.open_link(PAYLOAD, LinkKind::Payload, false);
        vehicle.arm(SimTime::from_s(30.0)).unwrap();
        vehicle.take_off(40.0).unwrap();
        let mut flight = Self { vehicle, payload: Vec::new() };
        flight.run(25.0);
        flight
    }

    fn run(&mut self, seconds: f64) {
        self.vehicle.run(SimTime::from_s(seconds));
        while let Some(transmit) = self.vehicle.poll_transmit() {
            self.payload.extend(Decoder::new().datagram(&transmit.bytes).into_iter().filter_map(|frame| frame.message));
        }
    }

    fn fly_to(&mut self, place_m: Vec3<Enu>, seconds: f64) {
        self.vehicle.go_to(place_m).unwrap();
        self.run(seconds);
    }

    fn margins(&self) -> Vec<RadioMargins> {
        self.payload.iter().filter_map(|message| HazardReport::of(message)?.radio).collect()
    }

    fn has_text(&self, words: &str) -> bool {
        let is_it = |message: &MavMessage| matches!(message, MavMessage::STATUSTEXT(text) if text.text.to_str().is_ok_and(|text| text.contains(words)));
        self.payload.iter().any(is_it)
    }
}

#[test]
fn flight_behind_a_bridge_loses_the_video_before_control() {
    let mut flight = Flight::begin("radio = true\nseverity = 2.0");
    flight.fly_to(BEFORE_M, 25.0);
    flight.fly_to(BEHIND_M, 20.0);
    let open = flight.margins();
    assert!(open.len() > 100, "two reports per second: {}", open.len());
    let last = open.last().unwrap();
    assert!(last.way == RadioWay::LineOfSight && last.video_db > 3.0 && last.control_db > last.video_db, "{last:?}");
    assert_eq!(last.losses, 0);
    flight.vehicle.command(MavCmd::MAV_CMD_DO_SET_MODE, &[1.0, POSITION_MODE]).unwrap();
    flight.payload.clear();
    while flight.vehicle.position_m().up() > SHADOW_UP_M && !flight.has_text("manual control lost") {
        flight.vehicle.sticks(0.0, 0.0, DESCENT, 0.0);
        flight.run(0.05);
    }
    assert!(flight.has_text("manual control lost"), "{:?}", flight.vehicle.position_m());
    let descent = flight.margins();
    assert!(descent.iter().all(|margins| margins.video_db < margins.control_db), "{descent:?}");
    let first = |is_gone: &dyn Fn(&RadioMargins) -> bool| descent.iter().position(is_gone).unwrap();
    let (video, control) = (first(&|margins| margins.video_db < LOSSY_DB), first(&|margins| margins.control_db < LOSSY_DB));
    // The descent through the margin between both takes some seconds.
    assert!(video + 4 < control, "{video} {control} {descent:?}");
    flight.run(1.0);
    // Near the margin, control may come back for a moment and be lost again.
    assert!((1..=3).contains(&flight.margins().last().unwrap().losses), "{:?}", flight.margins().last());
    assert!(flight.vehicle.armed(), "the aircraft returns");
}

#[test]
fn flight_radio_status_reports_the_control_signal_to_ground_stations() {
    let flight = Flight::begin("radio = true");
    let received: Vec<_> = flight.vehicle.received.iter().filter(|frame| frame.component_id == 68).collect();
    let status = |message: &MavMessage| if let MavMessage::RADIO_STATUS(status) = message { Some(status.clone()) } else { None };
    let all: Vec<_> = received.iter().filter_map(|frame| status(frame.message.as_ref()?)).collect();
    // Two per second.
    assert!((1.8..2.2).contains(&(all.len() as f64 / flight.vehicle.now().s())), "{}", all.len());
    let (last, margins) = (all.last().unwrap(), *flight.margins().last().unwrap());
    let signal_dbm = dbm_of_value(last.rssi).unwrap();
    // Rounding to whole values of 1/1.9 dB, and half a second of a hover.
    assert!((signal_dbm - (margins.control_db - 94.0)).abs() < 0.6, "{signal_dbm} {margins:?}");
    assert!(last.rssi == last.remrssi && last.rxerrors == 0 && last.noise < last.rssi, "{last:?}");
}

#[test]
fn regress_jobs_without_the_hazard_send_nothing_about_it() {
    for hazards in ["", "radio = false", "sky = true"] {
        let flight = Flight::begin(hazards);
        assert!(flight.vehicle.received.iter().all(|frame| frame.component_id != 68), "{hazards}");
        assert!(flight.payload.iter().all(|message| HazardReport::of(message).is_none()), "{hazards}");
    }
}

#[test]
fn flight_wakes_are_reported_where_the_bridge_disturbs_the_wind() {
    let mut flight = Flight::begin("wakes = true");
    let added = |flight: &mut Flight| -> Vec<f64> {
        let messages = std::mem::take(&mut flight.payload);
        messages.iter().filter_map(|message| Some(HazardReport::of(message)?.wake_m_s?.norm())).collect()
    };
    let free = added(&mut flight);
    assert!(free.len() > 40 && free.iter().all(|speed_m_s| *speed_m_s == 0.0), "above the bridges: {free:?}");
    flight.fly_to(BEFORE_M, 15.0);
    let job = read("two-bridges.toml", shipped::TWO_BRIDGES, &|_| Err("none".into())).unwrap();
    let bridge = &job.bridges[0];
    // In the lee of the deck: the wind blows from the southwest, and the bridge's left side is in the north.
    let (low, high) = bridge.fascia_z_m();
    flight.fly_to(bridge.placement().point([0.0, 0.5 * bridge.deck_width_m() + 4.0, 0.5 * (low + high)]), 30.0);
    let disturbed = added(&mut flight);
    assert!(disturbed.iter().any(|speed_m_s| *speed_m_s > 0.3), "{disturbed:?}");
}

#[test]
fn flight_flow_and_ranges_over_water_are_counted() {
    let mut flight = Flight::begin("water = true");
    let sensors = |flight: &Flight| -> Vec<WaterSensors> {
        flight.payload.iter().filter_map(|message| HazardReport::of(message)?.water).collect()
    };
    assert_eq!(sensors(&flight).last(), Some(&WaterSensors::default()), "the pad is on land");
    flight.fly_to(OVER_WATER_M, 30.0);
    flight.run(10.0);
    let over = sensors(&flight);
    let [earlier, last] = [over[over.len() - 11], over[over.len() - 1]];
    assert!(last.flow_lost && earlier.flow_lost, "{earlier:?} {last:?}");
    // The range finder's 20 readings per second for 5 s, of which half are lost: three standard deviations are 15.
    let (ranges, lost) = (last.ranges - earlier.ranges, last.lost_ranges - earlier.lost_ranges);
    assert!((95..=105).contains(&ranges) && (35..=65).contains(&lost), "{ranges} {lost}");
}

#[test]
fn flight_compass_error_near_steel_is_reported() {
    let flight = Flight::begin("compass = true");
    let errors: Vec<f64> = flight.payload.iter().filter_map(|message| HazardReport::of(message)?.compass_rad).collect();
    assert!(errors.len() > 40 && errors.iter().all(|error_rad| error_rad.abs() < 0.05), "far from steel: {errors:?}");
    assert!(flight.margins().is_empty());
}
