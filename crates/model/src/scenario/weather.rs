//! Reads the wind and the visible weather, and parses the start time.

use super::job::{WeatherSpec, WindEvent, WindModel, WindSpec};
use crate::math::M_S_PER_MPH;
use crate::time::SimTime;
use crate::toml::{Reader, Section};

/// Wind levels of the TASBID paper: speed (mph) and force (N). The light level's speed is 2.2 mph, so that its force of
/// 0.12 N follows the same square law as the 3 N and 12 N of the other levels.
const WIND_LEVELS: [(&str, (f64, f64)); 4] =
    [("calm", (0.0, 0.0)), ("light", (2.2, 0.12)), ("gentle", (11.0, 3.0)), ("medium", (22.0, 12.0))];

pub(super) fn read(r: &mut Reader, root: &mut Section) -> WindSpec {
    let mut s = r.section(root, "wind");
    let model = r.keyword(&mut s, "model", &[("physical", WindModel::Physical), ("paper", WindModel::Paper)], Some(0));
    let (mph, force_n) = r.keyword(&mut s, "level", &WIND_LEVELS, Some(0));
    let speed_m_s = r.number(&mut s, "speed_m_s", (0.0, 30.0), Some(mph * M_S_PER_MPH));
    let paper_force_n = r.number(&mut s, "paper_force_n", (0.0, 100.0), Some(force_n));
    r.describe_default(&s, "speed_m_s", "by level: 0, 0.98, 4.92, 9.83");
    r.describe_default(&s, "paper_force_n", "by level: 0, 0.12, 3, 12");
    let mut wind = WindSpec {
        model,
        speed_m_s,
        paper_force_n,
        from_deg: r.number(&mut s, "from_deg", (0.0, 360.0), Some(0.0)),
        up_m_s: r.number(&mut s, "up_m_s", (-10.0, 10.0), Some(0.0)),
        turbulence: r.number(&mut s, "turbulence", (0.0, 5.0), Some(1.0)),
        events: Vec::new(),
    };
    for mut event in r.sections(&mut s, "events") {
        wind.events.push(read_event(r, &mut event));
        r.finish(&event);
    }
    wind.events.sort_by_key(start_time);
    r.finish(&s);
    wind
}

pub(super) fn read_visible(r: &mut Reader, root: &mut Section) -> WeatherSpec {
    let mut s = r.section(root, "weather");
    let weather = WeatherSpec {
        visibility_m: r.number(&mut s, "visibility_m", (50.0, 50_000.0), Some(WeatherSpec::CLEAR_VISIBILITY_M)),
        rain_mm_h: r.number(&mut s, "rain_mm_h", (0.0, 100.0), Some(0.0)),
        snow_mm_h: r.number(&mut s, "snow_mm_h", (0.0, 10.0), Some(0.0)),
    };
    r.finish(&s);
    weather
}

fn start_time(event: &WindEvent) -> SimTime {
    match event {
        WindEvent::Gust { at, .. } | WindEvent::Change { at, .. } => *at,
    }
}

fn read_event(r: &mut Reader, s: &mut Section) -> WindEvent {
    let gust = r.keyword(s, "kind", &[("gust", true), ("change", false)], None);
    let at = SimTime::from_s(r.number(s, "at_s", (0.0, 86_400.0), None));
    let from_deg = r.number(s, "from_deg", (0.0, 360.0), None);
    if gust {
        let duration = SimTime::from_s(r.number(s, "duration_s", (0.1, 600.0), None));
        WindEvent::Gust { at, duration, peak_speed_m_s: r.number(s, "peak_m_s", (0.0, 30.0), None), from_deg }
    } else {
        let over = SimTime::from_s(r.number(s, "over_s", (0.1, 3_600.0), None));
        WindEvent::Change { at, over, speed_m_s: r.number(s, "speed_m_s", (0.0, 30.0), None), from_deg }
    }
}

/// Parses a UTC time `YYYY-MM-DDTHH:MM:SSZ`; returns seconds since the Unix epoch.
#[must_use]
pub fn parse_unix_s(text: &str) -> Option<i64> {
    text.parse::<jiff::Timestamp>().ok().map(jiff::Timestamp::as_second)
}
