//! Wind, satellite navigation, compass and radio at the aircraft, as the live pages show them.

use spandrel_mavlink::contract::hazards::{self, HazardReport, RadioMargins};
use spandrel_mavlink::dialect::MavMessage;
use spandrel_mavlink::telemetry::GnssReport;
use spandrel_model::math;
use spandrel_model::time::SimTime;
use spandrel_text::{Language, Value, text};

/// Dilution of precision of GPS_RAW_INT that means that it is unknown.
const UNKNOWN_DILUTION: u16 = u16::MAX;
/// Error of the compass from which the pages warn, rad (estimate: as in the report, 8 degrees).
const NOTABLE_COMPASS_RAD: f64 = 0.14;
/// Speed below which the wind has no direction, m/s.
const CALM_M_S: f64 = 0.05;

/// Last values received.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct HazardState {
    /// Component that reports the wind, and the velocity of the air toward the north and the east, m/s.
    wind: Option<(u8, (f64, f64))>,
    /// Fix and satellites, and the horizontal dilution of precision.
    gnss: Option<(GnssReport, Option<f64>)>,
    report: Option<(SimTime, HazardReport)>,
}

impl HazardState {
    /// Uses a message that a component sent at a simulation time. Behind an external autopilot, the simulator's wind replaces the
    /// autopilot's estimate.
    pub(super) fn handle(&mut self, message: &MavMessage, component: u8, now: SimTime) {
        match message {
            MavMessage::WIND_COV(wind) => {
                let (north, east) = (f64::from(wind.wind_x), f64::from(wind.wind_y));
                let is_better = self.wind.is_none_or(|(known, _)| component >= known);
                if is_better && north.is_finite() && east.is_finite() {
                    self.wind = Some((component, (north, east)));
                }
            }
            MavMessage::GPS_RAW_INT(gps) => {
                let dilution = (gps.eph != UNKNOWN_DILUTION).then(|| f64::from(gps.eph) / 100.0);
                self.gnss = Some((GnssReport::of(gps), dilution));
            }
            _ => {
                if let Some(report) = HazardReport::of(message) {
                    self.report = Some((now, report));
                }
            }
        }
    }

    /// Returns the wind, such as "4.2 m/s from 250°".
    pub(super) fn wind(&self, language: Language) -> Option<String> {
        let (_, (north, east)) = self.wind?;
        let speed_m_s = math::hypot(north, east);
        let speed = format!("{speed_m_s:.1}");
        if speed_m_s < CALM_M_S {
            return Some(text!(language, "live-wind-calm", speed = speed));
        }
        let from_deg = (math::bearing_deg(-east, -north).round() % 360.0).abs();
        Some(text!(language, "live-wind-now", speed = speed, direction = format!("{from_deg:.0}")))
    }

    /// Returns the satellites and the dilution of precision, or that there is no position.
    pub(super) fn gnss(&self, language: Language) -> Option<String> {
        let (report, dilution) = self.gnss?;
        let satellites: Value = report.satellites.map_or_else(|| "?".into(), |count| count.into());
        Some(match dilution.filter(|_| report.has_fix) {
            _ if !report.has_fix => text!(language, "live-gnss-lost", satellites = satellites),
            Some(dilution) => {
                text!(language, "live-gnss-dilution", satellites = satellites, dilution = format!("{dilution:.1}"))
            }
            None => text!(language, "live-gnss-now", satellites = satellites),
        })
    }

    /// Returns by how much steel turns the compass; `None` if the job does not simulate it.
    pub(super) fn compass(&self, now: SimTime, language: Language) -> Option<String> {
        let degrees = self.recent(now)?.compass_rad?.to_degrees();
        Some(text!(language, "live-compass-now", degrees = format!("{:.0}", degrees.abs())))
    }

    /// Returns the margins of the radio links; `None` if the job does not simulate them.
    pub(super) fn radio(&self, now: SimTime, language: Language) -> Option<String> {
        let RadioMargins { control_db, video_db, .. } = self.recent(now)?.radio?;
        let margin = |db: f64| format!("{db:+.0}").replace('-', "−");
        Some(text!(language, "live-radio-now", control = margin(control_db), video = margin(video_db)))
    }

    /// Returns what the hazards do at this time, the most serious first.
    pub(super) fn warnings(&self, now: SimTime, language: Language) -> Vec<String> {
        let report = self.recent(now).unwrap_or_default();
        let warnings = [
            (report.radio.is_some_and(|radio| radio.control_db < 0.0), text!(language, "live-warning-control")),
            (self.gnss.is_some_and(|(gnss, _)| !gnss.has_fix), text!(language, "live-warning-gnss")),
            (report.radio.is_some_and(|radio| radio.video_db < 0.0), text!(language, "live-warning-video")),
            (report.compass_rad.is_some_and(|rad| rad.abs() >= NOTABLE_COMPASS_RAD), text!(language, "live-warning-compass")),
        ];
        warnings.into_iter().filter_map(|(acts, words)| acts.then_some(words)).collect()
    }

    fn recent(&self, now: SimTime) -> Option<HazardReport> {
        self.report.filter(|(heard, _)| now.saturating_sub(*heard) <= hazards::TIMEOUT).map(|(_, report)| report)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::dialect::{GPS_RAW_INT_DATA, GpsFixType, WIND_COV_DATA};
    use spandrel_model::radio::RadioWay;

    fn wind(north: f32, east: f32) -> MavMessage {
        MavMessage::WIND_COV(WIND_COV_DATA { wind_x: north, wind_y: east, ..WIND_COV_DATA::default() })
    }

    fn gps(fix_type: GpsFixType, satellites_visible: u8, eph: u16) -> MavMessage {
        MavMessage::GPS_RAW_INT(GPS_RAW_INT_DATA { fix_type, satellites_visible, eph, ..GPS_RAW_INT_DATA::default() })
    }

    #[test]
    fn exact_wind_comes_from_its_direction_and_the_simulator_knows_it_best() {
        let mut state = HazardState::default();
        assert_eq!(state.wind(Language::English), None);
        state.handle(&wind(-3.0, 0.0), 1, SimTime::ZERO);
        assert_eq!(state.wind(Language::English).as_deref(), Some("3.0 m/s from 0°"));
        state.handle(&wind(0.0, 4.0), 192, SimTime::ZERO);
        state.handle(&wind(9.0, 9.0), 1, SimTime::ZERO);
        assert_eq!(state.wind(Language::German).as_deref(), Some("4.0 m/s aus 270°"));
        state.handle(&wind(f32::NAN, 0.0), 192, SimTime::ZERO);
        state.handle(&wind(0.0, 0.0), 192, SimTime::ZERO);
        assert_eq!(state.wind(Language::English).as_deref(), Some("0.0 m/s"));
    }

    #[test]
    fn exact_satellites_are_shown_with_their_dilution_or_as_lost() {
        let shown = |message: &MavMessage| {
            let mut state = HazardState::default();
            state.handle(message, 1, SimTime::ZERO);
            (state.gnss(Language::English).unwrap(), state.warnings(SimTime::ZERO, Language::English))
        };
        let fix = GpsFixType::GPS_FIX_TYPE_3D_FIX;
        assert_eq!(shown(&gps(fix, 11, 120)), ("11 satellites, HDOP 1.2".into(), vec![]));
        assert_eq!(shown(&gps(fix, 11, u16::MAX)), ("11 satellites".into(), vec![]));
        let lost = ("No position, 3 satellites".to_owned(), vec!["GNSS lost".to_owned()]);
        assert_eq!(shown(&gps(GpsFixType::GPS_FIX_TYPE_NO_FIX, 3, u16::MAX)), lost);
    }

    #[test]
    fn exact_reports_of_compass_and_radio_expire() {
        let mut state = HazardState::default();
        let radio = RadioMargins { control_db: 12.4, video_db: -3.6, way: RadioWay::AroundEdge, losses: 0 };
        let report = HazardReport { compass_rad: Some(-0.2), radio: Some(radio), ..HazardReport::default() };
        let now = SimTime::from_ms(10_000);
        state.handle(&report.message(10_000_000), 1, now);
        let at = now + hazards::TIMEOUT;
        assert_eq!(state.compass(at, Language::English).as_deref(), Some("off by 11°"));
        assert_eq!(state.radio(at, Language::English).as_deref(), Some("control +12 dB, video −4 dB"));
        assert_eq!(state.warnings(at, Language::English), ["Poor video", "Compass disturbed"]);
        let later = at + SimTime::from_ms(1);
        assert_eq!((state.compass(later, Language::English), state.radio(later, Language::English)), (None, None));
        assert_eq!(state.warnings(later, Language::English), Vec::<String>::new());
    }
}
