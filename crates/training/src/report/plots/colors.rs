//! The track's three color modes: value shown, legend, and segments of equal color.

use super::plot_map::{PlotMap, TRACK_WITHIN};
use super::{line, simplified};
use crate::report::Review;
use crate::report::words;
use spandrel_mavlink::contract::continuity::is_jump;
use spandrel_mavlink::telemetry::Frame;

/// Limits of the clearance colors, m, from nearest to farthest.
pub const CLEARANCES_M: [f64; 3] = [1.0, 2.5, 5.0];

/// Color modes of the track: name in the selection, class of the layer.
pub const COLOURINGS: [(&str, &str); 3] = [("on path", "by-path"), ("speed", "by-speed"), ("clearance", "by-clearance")];

/// Returns the track in segments of one color: class and path data, in class order.
pub(super) fn track(review: &Review, map: &PlotMap, layer: usize, shown: &dyn Fn(&Frame) -> bool) -> Vec<(&'static str, String)> {
    let names = classes(layer);
    let pieces = pieces(review, map, names.len(), &|i| class_of(review, i, layer), shown);
    names.iter().copied().zip(pieces).filter(|(_, data)| !data.is_empty()).collect()
}

/// Returns the whole track in one color.
pub(super) fn plain_color(review: &Review, map: &PlotMap, shown: &dyn Fn(&Frame) -> bool) -> String {
    pieces(review, map, 1, &|_| 0, shown).swap_remove(0)
}

/// Returns whether the drone was respawned between two frames.
fn jumped(before: &Frame, next: &Frame) -> bool {
    let step_m = (next.position_m - before.position_m).norm();
    is_jump(step_m, before.velocity_m_s.norm().max(next.velocity_m_s.norm()), next.time - before.time)
}

fn pieces(
    review: &Review,
    map: &PlotMap,
    colours: usize,
    colour_of: &dyn Fn(usize) -> usize,
    shown: &dyn Fn(&Frame) -> bool,
) -> Vec<String> {
    let mut pieces = vec![String::new(); colours];
    let mut run: Vec<(f64, f64)> = Vec::new();
    let mut colour = 0;
    let mut close = |run: &mut Vec<(f64, f64)>, colour: usize| {
        if run.len() > 1 {
            pieces[colour].push_str(&line(&simplified(run, TRACK_WITHIN), false));
        }
        run.clear();
    };
    for (i, frame) in review.frames.iter().enumerate() {
        let broken = i > 0 && jumped(&review.frames[i - 1], frame);
        if broken || !shown(frame) {
            close(&mut run, colour);
            if !shown(frame) {
                continue;
            }
        }
        let now = colour_of(i);
        let here = map.at(frame.position_m);
        if now != colour {
            // The step between two colors belongs to the segment that ends.
            if !run.is_empty() {
                run.push(here);
            }
            close(&mut run, colour);
            colour = now;
        }
        run.push(here);
    }
    close(&mut run, colour);
    pieces
}

/// Returns the classes of a color mode, in legend order.
#[must_use]
pub fn classes(layer: usize) -> &'static [&'static str] {
    match layer {
        0 => &["p-between", "p-on", "p-off"],
        1 => &["q-1", "q-2", "q-3", "q-4", "q-over"],
        _ => &["c-unknown", "c-4", "c-3", "c-2", "c-1"],
    }
}

/// Returns the legend texts of a color mode, in class order.
#[must_use]
pub fn legend(layer: usize, limit_m_s: f64) -> Vec<String> {
    let speed = |share: f64| words::number(share * limit_m_s, 1);
    match layer {
        0 => vec!["between tasks".into(), "on the path".into(), "off path during a task".into()],
        1 => vec![
            format!("up to {} m/s", speed(0.25)),
            format!("to {}", speed(0.5)),
            format!("to {}", speed(0.75)),
            format!("to {}", speed(1.0)),
            format!("above the limit of {} m/s", words::number(limit_m_s, 2)),
        ],
        _ => {
            let [a, b, c] = CLEARANCES_M.map(|limit| words::number(limit, 1));
            vec!["nothing near".into(), format!("over {c} m"), format!("to {c} m"), format!("to {b} m"), format!("under {a} m")]
        }
    }
}

/// Returns the index into [`classes`] for a frame.
fn class_of(review: &Review, i: usize, layer: usize) -> usize {
    let frame = &review.frames[i];
    match layer {
        0 => match (review.track[i].on, review.track[i].inside) {
            (true, _) => 1,
            (false, true) => 2,
            (false, false) => 0,
        },
        1 => speed_class(frame.speed_m_s(), review.scenario.scoring.speed_limit_m_s),
        _ => frame.clearance_m.map_or(0, clearance_class),
    }
}

/// Returns the speed class: quarters of the limit, then strictly above it, as in the score.
fn speed_class(speed_m_s: f64, limit_m_s: f64) -> usize {
    if speed_m_s > limit_m_s { 4 } else { ((speed_m_s / limit_m_s * 4.0).ceil() as usize).clamp(1, 4) - 1 }
}

fn clearance_class(clearance_m: f64) -> usize {
    4 - CLEARANCES_M.iter().filter(|limit| clearance_m >= **limit).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_speeds_and_clearances_fall_into_their_colours() {
        assert_eq!([0.0, 1.0, 1.1, 3.0, 4.0, 4.1].map(|v| speed_class(v, 4.0)), [0, 0, 1, 2, 3, 4]);
        assert_eq!([0.2, 1.0, 2.5, 5.0, 9.0].map(clearance_class), [4, 3, 2, 1, 1]);
        for layer in 0..3 {
            assert_eq!(classes(layer).len(), legend(layer, 4.0).len());
        }
    }
}
