//! What the head-up display tells.

use spandrel_model::frames::{Enu, Vec3};

/// Fix and satellites.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GnssStatus {
    /// Has a fix in three dimensions.
    pub fixed: bool,
    /// Satellites used, as the wire counts them: [`Self::known`].
    pub satellites: u8,
}

impl GnssStatus {
    /// The wire's count where nobody counts (GPS_RAW_INT.satellites_visible).
    const UNKNOWN: u8 = 255;

    /// Satellites used, if that is known.
    #[must_use]
    pub fn known(self) -> Option<u8> {
        (self.satellites != Self::UNKNOWN).then_some(self.satellites)
    }
}

/// A task's reference path for the map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPath {
    /// Number for people.
    pub id: u32,
    /// Points, m.
    pub path_m: Vec<Vec3<Enu>>,
    /// It ends where it begins.
    pub closed: bool,
}

/// Everything on the display; plain data.
#[derive(Debug, Clone, PartialEq)]
pub struct Hud {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Speed limit, m/s.
    pub limit_m_s: f64,
    /// Battery, %.
    pub battery_pct: Option<f64>,
    /// Battery is green from here, %.
    pub green_pct: f64,
    /// And yellow from here, %.
    pub yellow_pct: f64,
    /// Mask of cues as `cues` carries it (docs/src/reference/wire.md, "The monitor").
    pub cues: i32,
    /// What was hit, when the monitor has said so.
    pub hit: Option<String>,
    /// Height over the pad, m.
    pub height_m: f64,
    /// Horizontal distance from the pad, m.
    pub home_m: f64,
    /// Mode in words.
    pub mode: String,
    /// Satellite navigation.
    pub gnss: Option<GnssStatus>,
    /// Age of the newest telemetry, s.
    pub silent_s: f64,
    /// Gimbal pitch, rad, up positive.
    pub gimbal_rad: f64,
    /// Zoom, 1 at the wide end.
    pub zoom: f64,
    /// The lamp is on.
    pub lamp: bool,
    /// Left of the flight's time, s.
    pub left_s: f64,
    /// Pictures taken.
    pub pictures: usize,
    /// A picture was taken just now.
    pub shutter: bool,
    /// What flashes does so by this, s: time that goes on whatever is shown, the wall's where a flight is live.
    pub time_s: f64,
    /// Where the drone is, m.
    pub position_m: Vec3<Enu>,
    /// Heading, rad clockwise from north.
    pub heading_rad: f64,
    /// The pad, m.
    pub pad_m: Vec3<Enu>,
    /// Paths on the map; none: the map is hidden.
    pub tracks: Vec<MapPath>,
}
