//! Where everything stands.

use super::icons::{Shape, symbol};
use super::map::map;
use super::state::{Hud, cue};
use super::{Colour, Item, Point, Side, at};

/// Distance of blocks from the picture's edges, as a share of its height.
const EDGE: f64 = 0.025;
/// Type sizes as shares of the height.
const LARGE: f64 = 0.052;
const MIDDLE: f64 = 0.034;
const SMALL: f64 = 0.027;
/// Flashes this often, Hz (two a second: seen, and far below what harms).
const FLASH_HZ: f64 = 2.0;
/// Telemetry older than this is a lost link, s.
pub const SILENT_S: f64 = 1.5;
/// Metres a second in a mile an hour.
const M_S_PER_MPH: f64 = crate::base::math::M_S_PER_MPH;
/// Share of the picture, from its middle, in which a defect counts.
const CENTRAL: f64 = 0.8;

fn text(place: Point, side: Side, height: f64, colour: Colour, words: impl Into<String>) -> Item {
    Item::Text { place, side, height, colour, words: words.into() }
}

/// Everything on the display for a picture of this aspect (width over height).
#[must_use]
pub fn layout(hud: &Hud, aspect: f64) -> Vec<Item> {
    let mut items = frame(hud, aspect);
    items.extend(speed(hud, aspect));
    items.extend(battery(hud, aspect));
    items.extend(status(hud, aspect));
    items.extend(numbers(hud, aspect));
    items.extend(messages(hud, aspect));
    items.extend(map(hud, aspect));
    items
}

/// The middle, and the part of the picture in which a defect counts.
fn frame(hud: &Hud, aspect: f64) -> Vec<Item> {
    let mut items = Vec::new();
    let mut line = |points: Vec<Point>, width: f64, colour: Colour| items.push(Item::Line { points, width, colour });
    let (low, high, arm) = (0.5 - 0.5 * CENTRAL, 0.5 + 0.5 * CENTRAL, 0.035);
    let colour = if hud.shutter { Colour::Yellow } else { Colour::Grey };
    for (x, right) in [(low, 1.0), (high, -1.0)] {
        for (y, down) in [(low, 1.0), (high, -1.0)] {
            line(vec![at(x + right * arm / aspect, y), at(x, y), at(x, y + down * arm)], 0.003, colour);
        }
    }
    let cross = 0.018;
    line(vec![at(0.5 - cross / aspect, 0.5), at(0.5 + cross / aspect, 0.5)], 0.0025, Colour::White);
    line(vec![at(0.5, 0.5 - cross), at(0.5, 0.5 + cross)], 0.0025, Colour::White);
    items
}

/// Upper left.
fn speed(hud: &Hud, aspect: f64) -> Vec<Item> {
    let left = EDGE / aspect;
    let fast = hud.cues & cue::SPEEDING != 0;
    let colour = if fast { Colour::Yellow } else { Colour::White };
    let inner = left + 0.016 / aspect;
    let mph = |m_s: f64| m_s / M_S_PER_MPH;
    vec![
        Item::Panel { from: at(left, EDGE), to: at(left + 0.25 / aspect, EDGE + 0.105), colour: Colour::Shade },
        text(at(inner, EDGE + 0.037), Side::Left, LARGE, colour, format!("{:.1} m/s", hud.speed_m_s)),
        text(
            at(inner, EDGE + 0.081),
            Side::Left,
            SMALL,
            Colour::Grey,
            format!("{:.0} mph, limit {:.0}", mph(hud.speed_m_s), mph(hud.limit_m_s)),
        ),
    ]
}

/// Upper right: a battery that empties, a number, and a shape for its state.
fn battery(hud: &Hud, aspect: f64) -> Vec<Item> {
    let right = 1.0 - EDGE / aspect;
    let from = right - 0.27 / aspect;
    let mut items = vec![Item::Panel { from: at(from, EDGE), to: at(right, EDGE + 0.075), colour: Colour::Shade }];
    let Some(pct) = hud.battery_pct else {
        items.push(text(at(right - 0.016 / aspect, EDGE + 0.037), Side::Right, MIDDLE, Colour::Grey, "no battery data"));
        return items;
    };
    let (colour, shape) = if pct >= hud.green_pct {
        (Colour::Green, Shape::Disc)
    } else if pct >= hud.yellow_pct {
        (Colour::Yellow, Shape::Triangle)
    } else {
        (Colour::Red, Shape::Octagon)
    };
    let dark = colour == Colour::Red && (hud.time_s * FLASH_HZ).rem_euclid(1.0) >= 0.5;
    let y = EDGE + 0.0375;
    if !dark {
        items.extend(symbol(shape, at(from + 0.03 / aspect, y), 0.036, aspect, colour));
    }
    let (low, high, half) = (from + 0.062 / aspect, from + 0.142 / aspect, 0.017);
    let case = vec![at(low, y - half), at(high, y - half), at(high, y + half), at(low, y + half), at(low, y - half)];
    items.push(Item::Line { points: case, width: 0.003, colour: Colour::White });
    let knob = vec![
        at(high, y - 0.007),
        at(high + 0.006 / aspect, y - 0.007),
        at(high + 0.006 / aspect, y + 0.007),
        at(high, y + 0.007),
    ];
    items.push(Item::Fill { points: knob, colour: Colour::White });
    if !dark {
        let (inset, full) = (0.004, high - low - 0.008 / aspect);
        let end = low + inset / aspect + full * (pct / 100.0).clamp(0.0, 1.0);
        let charge = vec![
            at(low + inset / aspect, y - half + inset),
            at(end, y - half + inset),
            at(end, y + half - inset),
            at(low + inset / aspect, y + half - inset),
        ];
        items.push(Item::Fill { points: charge, colour });
    }
    items.push(text(at(right - 0.016 / aspect, y), Side::Right, MIDDLE, colour, format!("{pct:.0} %")));
    items
}

/// Middle of the upper edge: mode, satellites, link.
fn status(hud: &Hud, aspect: f64) -> Vec<Item> {
    let gnss = match hud.gnss {
        Some(gnss) if gnss.fixed => format!("GNSS {}", gnss.satellites),
        Some(gnss) => format!("GNSS lost ({})", gnss.satellites),
        None => "GNSS ?".into(),
    };
    let lost = hud.silent_s > SILENT_S;
    let link = if lost { format!("LINK LOST {:.0} s", hud.silent_s) } else { "link ok".into() };
    let words = format!("{}   {gnss}   {link}", hud.mode);
    let bad = lost || hud.gnss.is_some_and(|gnss| !gnss.fixed);
    let half = 0.0085 * words.len() as f64 / aspect;
    vec![
        Item::Panel { from: at(0.5 - half, EDGE), to: at(0.5 + half, EDGE + 0.048), colour: Colour::Shade },
        text(at(0.5, EDGE + 0.024), Side::Middle, SMALL, if bad { Colour::Orange } else { Colour::White }, words),
    ]
}

/// Below the battery: heights, distances, gimbal, time, lamp, pictures.
fn numbers(hud: &Hud, aspect: f64) -> Vec<Item> {
    let right = 1.0 - EDGE / aspect;
    let top = EDGE + 0.085;
    let left = hud.left_s.max(0.0);
    let mut lines = vec![
        ("height", format!("{:.1} m", hud.height_m)),
        ("home", format!("{:.0} m", hud.home_m)),
        ("gimbal", format!("{:+.0}°", hud.gimbal_rad.to_degrees())),
        ("time left", format!("{}:{:02}", (left / 60.0).floor(), (left % 60.0).floor())),
        ("lamp", if hud.lamp { "on".into() } else { "off".into() }),
        ("pictures", hud.pictures.to_string()),
    ];
    if hud.zoom > 1.01 {
        lines.push(("zoom", format!("{:.1} x", hud.zoom)));
    }
    let step = 0.037;
    let from = right - 0.225 / aspect;
    let bottom = top + step * lines.len() as f64 + 0.012;
    let mut items = vec![Item::Panel { from: at(from, top), to: at(right, bottom), colour: Colour::Shade }];
    for (k, (name, value)) in lines.into_iter().enumerate() {
        let y = top + 0.006 + step * (k as f64 + 0.5);
        let lit = name == "lamp" && hud.lamp;
        items.push(text(at(from + 0.012 / aspect, y), Side::Left, SMALL, Colour::Grey, name));
        let colour = if lit { Colour::Yellow } else { Colour::White };
        items.push(text(at(right - 0.012 / aspect, y), Side::Right, SMALL, colour, value));
    }
    items
}

/// Lower left, the gravest at the bottom.
fn messages(hud: &Hud, aspect: f64) -> Vec<Item> {
    let limit = hud.limit_m_s / M_S_PER_MPH;
    let crash = hud.hit.as_ref().map_or_else(|| "CRASH".to_owned(), |what| format!("CRASH: {what}"));
    let all = [
        (cue::CRASH, Shape::Octagon, Colour::Red, crash),
        (cue::TOO_CLOSE, Shape::Diamond, Colour::Orange, "TOO CLOSE".to_owned()),
        (cue::SPEEDING, Shape::Triangle, Colour::Yellow, format!("TOO FAST: limit {limit:.0} mph")),
        (cue::OFF_PATH, Shape::Disc, Colour::Blue, "OFF THE PATH".to_owned()),
    ];
    let left = EDGE / aspect;
    let mut y = 1.0 - EDGE - 0.03;
    let mut items = Vec::new();
    for (_, shape, colour, words) in all.into_iter().filter(|(bit, ..)| hud.cues & bit != 0) {
        let wide = 0.085 + 0.0205 * words.chars().count() as f64;
        items.push(Item::Panel { from: at(left, y - 0.03), to: at(left + wide / aspect, y + 0.03), colour: Colour::Shade });
        items.extend(symbol(shape, at(left + 0.035 / aspect, y), 0.04, aspect, colour));
        items.push(text(at(left + 0.07 / aspect, y), Side::Left, MIDDLE, colour, words));
        y -= 0.07;
    }
    items
}

#[cfg(test)]
mod tests {
    use super::super::state::{Gnss, Track};
    use super::*;
    use crate::base::frames::Vec3;

    const WIDE: f64 = 16.0 / 9.0;

    fn hud() -> Hud {
        Hud {
            speed_m_s: 3.2,
            limit_m_s: 4.4704,
            battery_pct: Some(76.0),
            green_pct: 70.0,
            yellow_pct: 30.0,
            cues: 0,
            hit: None,
            height_m: 21.4,
            home_m: 118.0,
            mode: "Position".into(),
            gnss: Some(Gnss { fixed: true, satellites: 14 }),
            silent_s: 0.02,
            gimbal_rad: 0.35,
            zoom: 1.0,
            lamp: false,
            left_s: 1234.5,
            pictures: 3,
            shutter: false,
            time_s: 100.0,
            position_m: Vec3::new(10.0, -4.0, 20.0),
            heading_rad: 1.2,
            pad_m: Vec3::new(-100.0, 60.0, 5.0),
            tracks: vec![Track { id: 1, path_m: vec![Vec3::new(-50.0, -5.0, 30.0), Vec3::new(50.0, -5.0, 30.0)], closed: false }],
        }
    }

    fn texts(hud: &Hud) -> Vec<(Point, Colour, String)> {
        let of = |item| match item {
            Item::Text { place, colour, words, .. } => Some((place, colour, words)),
            Item::Panel { .. } | Item::Fill { .. } | Item::Line { .. } => None,
        };
        layout(hud, WIDE).into_iter().filter_map(of).collect()
    }

    fn find(hud: &Hud, part: &str) -> Option<(Point, Colour)> {
        texts(hud).into_iter().find(|(_, _, words)| words.contains(part)).map(|(place, colour, _)| (place, colour))
    }

    /// Every word of the display with its place in hundredths and its colour.
    fn snapshot(hud: &Hud) -> String {
        let line = |(place, colour, words): (Point, Colour, String)| {
            format!("{:3.0} {:3.0} {colour:?}: {words}\n", 100.0 * place.x, 100.0 * place.y)
        };
        texts(hud).into_iter().map(line).collect()
    }

    #[test]
    fn regress_the_display_in_calm_flight() {
        let expected = "  2   6 White: 3.2 m/s\n  2  11 Grey: 7 mph, limit 10\n 98   6 Green: 76 %\n 50   5 White: Position   GNSS 14   link ok\n \
                        87  13 Grey: height\n 98  13 White: 21.4 m\n 87  17 Grey: home\n 98  17 White: 118 m\n 87  21 Grey: gimbal\n \
                        98  21 White: +20°\n 87  25 Grey: time left\n 98  25 White: 20:34\n 87  28 Grey: lamp\n 98  28 White: off\n \
                        87  32 Grey: pictures\n 98  32 White: 3\n 89  88 Grey: 1\n 91  72 Grey: N\n";
        assert_eq!(snapshot(&hud()), expected, "\n{}", snapshot(&hud()));
    }

    #[test]
    fn exact_places_are_those_of_the_assessment() {
        let all = Hud { cues: 0b11_1100, hit: Some("bridge".into()), ..hud() };
        let speed = find(&all, "3.2 m/s").unwrap().0;
        assert!(speed.x < 0.3 && speed.y < 0.2, "speed is upper left");
        let battery = find(&all, "76 %").unwrap().0;
        assert!(battery.x > 0.7 && battery.y < 0.2, "battery is upper right");
        for words in ["CRASH: bridge", "TOO CLOSE", "TOO FAST", "OFF THE PATH"] {
            let place = find(&all, words).unwrap().0;
            assert!(place.x < 0.5 && place.y > 0.5, "{words} is lower left");
            assert!(find(&hud(), words).is_none(), "{words} shows without its cue");
        }
    }

    #[test]
    fn exact_the_battery_changes_at_70_and_30_and_flashes_when_red() {
        let at = |pct: f64, time_s: f64| Hud { battery_pct: Some(pct), time_s, ..hud() };
        assert_eq!(find(&at(70.0, 0.0), "70 %").unwrap().1, Colour::Green);
        assert_eq!(find(&at(69.9, 0.0), "70 %").unwrap().1, Colour::Yellow);
        assert_eq!(find(&at(30.0, 0.0), "30 %").unwrap().1, Colour::Yellow);
        assert_eq!(find(&at(29.0, 0.0), "29 %").unwrap().1, Colour::Red);
        let fills = |hud: &Hud| layout(hud, WIDE).iter().filter(|i| matches!(i, Item::Fill { .. })).count();
        assert!(fills(&at(29.0, 0.1)) > fills(&at(29.0, 0.3)), "red flashes");
        assert_eq!(fills(&at(50.0, 0.1)), fills(&at(50.0, 0.3)), "yellow does not");
        assert!(find(&Hud { battery_pct: None, ..hud() }, "no battery").is_some());
    }

    #[test]
    fn exact_a_lost_link_and_a_lost_fix_are_told() {
        let lost = Hud { silent_s: 3.0, ..hud() };
        assert_eq!(find(&lost, "LINK LOST 3 s").unwrap().1, Colour::Orange);
        let dark = Hud { gnss: Some(Gnss { fixed: false, satellites: 4 }), ..hud() };
        assert_eq!(find(&dark, "GNSS lost (4)").unwrap().1, Colour::Orange);
    }

    #[test]
    fn prop_everything_stays_in_pictures_of_any_shape() {
        let states = [hud(), Hud { cues: 0b11_1100, hit: Some("pedestrian 3".into()), zoom: 2.0, ..hud() }];
        for aspect in [4.0 / 3.0, WIDE, 21.0 / 9.0] {
            for state in &states {
                for item in layout(state, aspect) {
                    let points = match item {
                        Item::Panel { from, to, .. } => vec![from, to],
                        Item::Text { place, .. } => vec![place],
                        Item::Fill { points, .. } | Item::Line { points, .. } => points,
                    };
                    for p in points {
                        assert!((0.0..=1.0).contains(&p.x) && (0.0..=1.0).contains(&p.y), "{p:?} at {aspect}");
                    }
                }
            }
        }
    }

    #[test]
    fn exact_shapes_differ_where_colours_do() {
        let corners = |pct: f64| {
            layout(&Hud { battery_pct: Some(pct), tracks: vec![], ..hud() }, WIDE).into_iter().find_map(|item| match item {
                Item::Fill { points, .. } => Some(points.len()),
                Item::Panel { .. } | Item::Text { .. } | Item::Line { .. } => None,
            })
        };
        assert_eq!([corners(90.0), corners(50.0), corners(10.0)], [Some(16), Some(3), Some(8)]);
    }
}
