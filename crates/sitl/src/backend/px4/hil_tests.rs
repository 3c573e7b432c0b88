//! Tests of hardware in the loop: the plan of the link, the byte stream and the clock offset.

use super::clock_offset::{ClockOffset, MeasuredOffset, REQUEST_INTERVAL};
use super::hil::{COMMAND_TIMEOUT, Px4HilInterface};
use super::hil_plan::{self, ExtraSensors, HilPlan, LINK_SHARE, MAX_RATE_HZ, MIN_RATE_HZ};
use super::testing::{Bench, answer, decoded, shipped};
use crate::backend::interface::{InterfaceEvent, SimulatorInterface};
use crate::physics::Actuators;
use crate::sensors::{FlowReading, GnssReading};
use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::dialect::{
    DISTANCE_SENSOR_DATA, HIL_GPS_DATA, HIL_OPTICAL_FLOW_DATA, HIL_SENSOR_DATA, HilSensorUpdatedFlags, MavMessage, TIMESYNC_DATA,
};
use spandrel_model::frames::Vec3;
use spandrel_model::time::SimTime;

const SYSTEM_ID: u8 = 3;
/// Capacities of usual baud rates, bytes/s.
const SLOW: f64 = 11_520.0;
const MEDIUM: f64 = 23_040.0;
const FAST: f64 = 92_160.0;
const HOVER: [f32; 4] = [0.5, 0.6, 0.5, 0.6];

fn interface(capacity_bytes_s: f64) -> Px4HilInterface {
    let mut px4 = Px4HilInterface::new(&shipped()[0], SYSTEM_ID, capacity_bytes_s).unwrap();
    px4.connect();
    px4
}

fn sent(px4: &mut Px4HilInterface, bench: &Bench, now: SimTime) -> Vec<MavMessage> {
    px4.send(&bench.step(now));
    px4.poll_transmit().map_or_else(Vec::new, |bytes| decoded(&bytes))
}

/// An aircraft whose sensors all have new readings.
fn all_fresh() -> Bench {
    let mut bench = Bench::new();
    bench.fresh.mag_gauss = Some(Vec3::new(0.2, 0.01, 0.4));
    bench.fresh.pressure_pa = Some(96_611.0);
    bench.fresh.range_down_m = Some(1.3);
    bench.fresh.range_up_m = Some(7.0);
    bench.fresh.range_around_m = Some([5.0; 8]);
    bench.fresh.flow = Some(FlowReading { forward_m_s: 0.1, right_m_s: 0.0, quality: 1.0 });
    bench.fresh.gnss = Some(GnssReading {
        fix: 3,
        satellites: 14,
        position_m: Vec3::zero(),
        velocity_m_s: Vec3::zero(),
        hdop: 0.8,
        vdop: 1.2,
        eph_m: 0.63,
        epv_m: 1.01,
    });
    bench
}

fn warnings(px4: &mut Px4HilInterface) -> usize {
    std::iter::from_fn(|| px4.poll_event()).filter(|event| matches!(event, InterfaceEvent::Warning(_))).count()
}

#[test]
fn exact_rate_follows_from_the_capacity() {
    let sensors = &shipped()[0].sensors;
    let plan = |capacity| HilPlan::new(capacity, sensors);
    // 921,600 baud: 46,080 bytes/s for the readings, more than 250 Hz of HIL_SENSOR and all other sensors need.
    assert_eq!(plan(FAST), Some(HilPlan { rate_hz: MAX_RATE_HZ, extra: ExtraSensors::All }));
    // 230,400 baud: (11,520 - 5 x 51) / 77 = 146 Hz, which is a period of 7 ms.
    assert_eq!(sensors.gnss_rate_hz, 5.0);
    assert_eq!(plan(MEDIUM), Some(HilPlan { rate_hz: 1000.0 / 7.0, extra: ExtraSensors::None }));
    assert_eq!(plan(SLOW), None);
    let least = HilPlan::min_capacity_bytes_s(sensors);
    assert_eq!(plan(least).map(|plan| plan.rate_hz), Some(MIN_RATE_HZ));
    assert_eq!(plan(least - 1.0), None);
    assert_eq!(plan(0.0), None);
}

#[test]
fn prop_readings_never_use_more_than_their_share() {
    for vehicle in &shipped() {
        let mut last_hz = 0.0;
        for baud in (100_000..=4_000_000).step_by(1_000) {
            let capacity = f64::from(baud) / 10.0;
            let Some(plan) = HilPlan::new(capacity, &vehicle.sensors) else { continue };
            assert!(plan.bytes_s(&vehicle.sensors) <= LINK_SHARE * capacity + 1e-6, "{baud} {plan:?}");
            assert!((MIN_RATE_HZ..=MAX_RATE_HZ).contains(&plan.rate_hz) && plan.rate_hz >= last_hz, "{baud} {plan:?}");
            last_hz = plan.rate_hz;
        }
        assert_eq!(last_hz, MAX_RATE_HZ);
    }
}

#[test]
fn exact_frames_are_as_long_as_planned() {
    let mut encoder = Encoder::new(255, 255);
    let mut bytes = |message| encoder.encode(&message).len() as f64;
    let all = HilSensorUpdatedFlags::all();
    let sensor = HIL_SENSOR_DATA { id: 255, fields_updated: all, ..Default::default() };
    assert_eq!(bytes(MavMessage::HIL_SENSOR(sensor)), hil_plan::SENSOR_FRAME_BYTES);
    assert_eq!(bytes(MavMessage::HIL_GPS(HIL_GPS_DATA { yaw: 35_999, ..Default::default() })), hil_plan::GPS_FRAME_BYTES);
    let range = DISTANCE_SENSOR_DATA { signal_quality: 100, ..Default::default() };
    assert_eq!(bytes(MavMessage::DISTANCE_SENSOR(range)), hil_plan::RANGE_FRAME_BYTES);
    let flow = HIL_OPTICAL_FLOW_DATA { quality: 255, ..Default::default() };
    assert_eq!(bytes(MavMessage::HIL_OPTICAL_FLOW(flow)), hil_plan::FLOW_FRAME_BYTES);
}

#[test]
fn wire_inertial_reading_comes_first_and_a_slow_link_gets_no_extra_sensors() {
    let names = |capacity| {
        let messages = sent(&mut interface(capacity), &all_fresh(), SimTime::from_ms(4));
        let Some(MavMessage::HIL_SENSOR(first)) = messages.first() else { panic!("{messages:?}") };
        assert_eq!((first.id, first.time_usec, first.fields_updated.bits()), (0, 4_000, 0x3F | 0x1C0 | 0x1A00));
        let count = |kind: fn(&MavMessage) -> bool| messages.iter().filter(|message| kind(message)).count();
        [
            count(|message| matches!(message, MavMessage::HIL_SENSOR(_))),
            count(|message| matches!(message, MavMessage::HIL_GPS(_))),
            count(|message| matches!(message, MavMessage::DISTANCE_SENSOR(_))),
            count(|message| matches!(message, MavMessage::HIL_OPTICAL_FLOW(_))),
            messages.len(),
        ]
    };
    assert_eq!(names(FAST), [1, 1, 10, 1, 13]);
    assert_eq!(names(46_080.0), [1, 1, 1, 1, 4]);
    assert_eq!(names(MEDIUM), [1, 1, 0, 0, 2]);
}

#[test]
fn wire_never_waits_and_keeps_the_latest_commands() {
    let (mut px4, mut controller, bench) = (interface(FAST), Encoder::new(SYSTEM_ID, 1), Bench::new());
    for step in 1..=5 {
        assert_eq!(sent(&mut px4, &bench, SimTime::from_ms(4 * step)).len(), 1);
        assert!(!px4.is_waiting() && !px4.has_answered() && px4.runs_in_real_time());
    }
    let bytes = answer(&mut controller, SimTime::from_ms(987_654), true, &HOVER);
    let (first, second) = bytes.split_at(40);
    px4.receive(first);
    assert!(!px4.has_answered(), "half a frame");
    px4.receive(second);
    assert!(px4.has_answered() && px4.actuators().armed);
    assert!((px4.actuators().motors[1] - 0.6).abs() < 1e-6);
    assert_eq!(sent(&mut px4, &bench, SimTime::from_ms(24)).len(), 1);
    assert!(!px4.is_waiting());
    px4.receive(&answer(&mut controller, SimTime::from_ms(987_655), true, &[f32::NAN; 4]));
    assert!((px4.actuators().motors[1] - 0.6).abs() < 1e-6, "invalid commands are ignored");
    assert!(matches!(px4.poll_event(), Some(InterfaceEvent::Rejected(_))));
    px4.connect();
    assert_eq!((px4.has_answered(), px4.actuators()), (false, Actuators::default()));
}

#[test]
fn exact_motors_stop_when_commands_are_too_old() {
    let (mut px4, mut controller, bench) = (interface(FAST), Encoder::new(SYSTEM_ID, 1), Bench::new());
    let mut step = |px4: &mut Px4HilInterface, ms: i64, commanded: bool| {
        if commanded {
            px4.receive(&answer(&mut controller, SimTime::from_ms(ms), true, &HOVER));
        }
        sent(px4, &bench, SimTime::from_ms(ms));
    };
    // Before the first answer, nothing can be too old.
    for ms in (4..2_000).step_by(4) {
        step(&mut px4, ms, false);
    }
    step(&mut px4, 2_000, true);
    let timeout_ms = COMMAND_TIMEOUT.ms();
    step(&mut px4, 2_000 + timeout_ms - 4, false);
    assert!(px4.actuators().armed && warnings(&mut px4) == 0);
    step(&mut px4, 2_000 + timeout_ms, false);
    assert_eq!(px4.actuators(), Actuators::default());
    step(&mut px4, 2_000 + 2 * timeout_ms, false);
    assert_eq!(warnings(&mut px4), 1, "reported once");
    step(&mut px4, 4_000, true);
    assert!(px4.actuators().armed, "later commands start them again");
    step(&mut px4, 4_000 + timeout_ms, false);
    assert_eq!((px4.actuators(), warnings(&mut px4)), (Actuators::default(), 1));
}

/// Runs round trips with these delays to and from a flight controller, ms, and returns the result.
fn measured(offset: SimTime, delays_ms: &[(i64, i64)]) -> Option<MeasuredOffset> {
    let mut clock = ClockOffset::default();
    let mut now = SimTime::from_ms(10);
    for (there, back) in delays_ms {
        let Some(MavMessage::TIMESYNC(request)) = clock.request(now) else { panic!("not due") };
        assert_eq!((request.tc1, clock.request(now + SimTime::from_ms(999))), (0, None));
        let arrived = now + SimTime::from_ms(*there);
        let reply = TIMESYNC_DATA { tc1: (arrived + offset).ns(), ts1: request.ts1, ..Default::default() };
        let received = arrived + SimTime::from_ms(*back);
        assert!(!clock.receive(&TIMESYNC_DATA { tc1: 0, ..reply }, received), "a request");
        assert!(!clock.receive(&TIMESYNC_DATA { ts1: reply.ts1 + 1, ..reply }, received), "another client's reply");
        assert!(clock.receive(&reply, received));
        now += REQUEST_INTERVAL;
    }
    clock.measured()
}

#[test]
fn exact_clock_offset_is_the_median_of_round_trips() {
    let offset = SimTime::from_ms(123_456);
    assert_eq!(measured(offset, &[(1, 1); 4]), None, "too few");
    let steady = MeasuredOffset { offset, round_trip: SimTime::from_ms(2) };
    assert_eq!(measured(offset, &[(1, 1); 5]), Some(steady));
    // Delays in one direction and lost replies do not change the median.
    assert_eq!(measured(offset, &[(1, 1), (90, 1), (1, 1), (1, 70), (1, 1), (1, 1), (500, 500)]), Some(steady));
    assert_eq!(measured(SimTime::from_ms(-5), &[(1, 1); 20]).map(|found| found.offset), Some(SimTime::from_ms(-5)));
    // Only the latest round trips count.
    let improved: Vec<(i64, i64)> = [(40, 60)].repeat(9).into_iter().chain([(2, 2)].repeat(9)).collect();
    assert_eq!(measured(offset, &improved), Some(MeasuredOffset { offset, round_trip: SimTime::from_ms(4) }));
}
