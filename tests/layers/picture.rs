//! Draws the layers and their imports, read from the source code, as an SVG image.

use crate::rules::{crate_label, layers};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Number of imported names, by importing and imported layer.
pub type Imports = BTreeMap<(&'static str, &'static str), usize>;

/// Start and end, px.
type Arrow = ((usize, usize), (usize, usize));

const WIDTH: usize = 1_200;
const BOX_WIDTH: usize = 132;
const BOX_HEIGHT: usize = 46;
const ROW_HEIGHT: usize = 118;
const MARGIN: usize = 30;
/// One fill color for each crate and one for the program, in the order of their first layers.
const COLORS: [&str; 8] = ["#e8eef7", "#e5f3ee", "#f8ecdf", "#f3e9f5", "#fbf3d6", "#e9f2dc", "#dff0f6", "#f0f0f0"];

/// Draws layers as boxes in rows, each above the layers that it imports from. Arrows show imports, with the
/// number of imported names. An import that is also reachable through an intermediate layer has no arrow.
pub fn svg(imports: &Imports) -> String {
    let rows = rows(imports);
    let centers = centers(&rows, imports);
    let height = 2 * MARGIN + (rows.len() - 1) * ROW_HEIGHT + BOX_HEIGHT;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" font-size=\"14\">\n\
         <!-- Generated from the code: SPANDREL_REFERENCE=write cargo nextest run layers -->\n\
         <title>Layers of the code and their imports</title>\n\
         <defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"8\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" orient=\"auto\">\
         <path d=\"M0 0L8 4L0 8z\" fill=\"#555\"/></marker></defs>\n\
         <rect width=\"{WIDTH}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    let direct = direct_imports(imports);
    let arrows: Vec<(Arrow, usize)> = direct.iter().map(|(edge, count)| (arrow(*edge, &direct, &centers), *count)).collect();
    for (((x1, y1), (x2, y2)), _) in &arrows {
        let bend = (y1 + y2) / 2;
        let _ = writeln!(
            out,
            "<path d=\"M{x1} {y1}C{x1} {bend} {x2} {bend} {x2} {y2}\" fill=\"none\" stroke=\"#555\" marker-end=\"url(#tip)\"/>"
        );
    }
    for (layer, (x, y)) in &centers {
        let (left, top) = (x.saturating_sub(BOX_WIDTH / 2), y - BOX_HEIGHT / 2);
        let (place, color) = (crate_label(layer), color(layer));
        let _ = writeln!(
            out,
            "<rect x=\"{left}\" y=\"{top}\" width=\"{BOX_WIDTH}\" height=\"{BOX_HEIGHT}\" rx=\"5\" fill=\"{color}\" stroke=\"#333\"/>\
             <text x=\"{x}\" y=\"{}\" text-anchor=\"middle\" font-weight=\"bold\">{layer}</text>\
             <text x=\"{x}\" y=\"{}\" text-anchor=\"middle\" font-size=\"11\">{place}</text>",
            y - 4,
            y + 13
        );
    }
    for (((x1, y1), (x2, y2)), count) in &arrows {
        // Place the label near the tip, where arrows to different layers are apart.
        let (x, y) = ((x1 + 9 * x2) / 10, y2 - (y2 - y1) / 5);
        let _ = writeln!(
            out,
            "<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\" font-size=\"11\" stroke=\"#fff\" stroke-width=\"4\" paint-order=\"stroke\">{count}</text>"
        );
    }
    out + "</svg>\n"
}

/// Returns the start and end of an arrow in pixels. Arrows at the same box are side by side, in the order of their other
/// ends.
fn arrow((from, to): (&'static str, &'static str), direct: &Imports, centers: &BTreeMap<&str, (usize, usize)>) -> Arrow {
    let spread = |center: usize, mut others: Vec<&str>, other: &str| {
        others.sort_by_key(|layer| centers[layer].0);
        let k = others.iter().position(|layer| *layer == other).unwrap_or_default();
        (center + (k + 1) * BOX_WIDTH / (others.len() + 1)).saturating_sub(BOX_WIDTH / 2)
    };
    let ((x1, y1), (x2, y2)) = (centers[from], centers[to]);
    let targets = direct.keys().filter(|(layer, _)| *layer == from).map(|(_, to)| *to).collect();
    let sources = direct.keys().filter(|(_, layer)| *layer == to).map(|(from, _)| *from).collect();
    ((spread(x1, targets, to), y1 + BOX_HEIGHT / 2), (spread(x2, sources, from), y2 - BOX_HEIGHT / 2))
}

/// Returns the layers in each row, from the highest row to the lowest.
fn rows(imports: &Imports) -> Vec<Vec<&'static str>> {
    let mut levels: BTreeMap<&'static str, usize> = layers().map(|layer| (layer, 0)).collect();
    // Another test forbids cycles, so the levels settle after at most one round per layer.
    for _ in 0..levels.len() {
        for (from, to) in imports.keys() {
            levels.insert(from, levels[from].max(levels[to] + 1));
        }
    }
    let highest = levels.values().max().copied().unwrap_or_default();
    (0..=highest).rev().map(|level| layers().filter(|layer| levels[layer] == level).collect()).collect()
}

/// Returns the centers of the boxes in pixels. Starting with the lowest row, sorts each row's layers by the mean
/// position of the layers that they import from.
fn centers(rows: &[Vec<&'static str>], imports: &Imports) -> BTreeMap<&'static str, (usize, usize)> {
    let mut out: BTreeMap<&'static str, (usize, usize)> = BTreeMap::new();
    for (k, row) in rows.iter().enumerate().rev() {
        let mean = |layer: &str| {
            let below = imports.keys().filter(|(from, _)| *from == layer).filter_map(|(_, to)| out.get(to));
            let (sum, count) = below.fold((0, 0), |(sum, count), (x, _)| (sum + x, count + 1));
            sum / count.max(1)
        };
        let mut ordered = row.clone();
        ordered.sort_by_key(|layer| mean(layer));
        let y = MARGIN + k * ROW_HEIGHT + BOX_HEIGHT / 2;
        let step = WIDTH / (ordered.len() + 1);
        let placed: Vec<_> = ordered.into_iter().enumerate().map(|(i, layer)| (layer, ((i + 1) * step, y))).collect();
        out.extend(placed);
    }
    out
}

/// Returns the imports without those that are also reachable through an intermediate layer.
fn direct_imports(imports: &Imports) -> Imports {
    let mut reached: BTreeSet<(&str, &str)> = imports.keys().copied().collect();
    for middle in layers() {
        let (into, out): (Vec<&str>, Vec<&str>) = (
            reached.iter().filter(|(_, to)| *to == middle).map(|(from, _)| *from).collect(),
            reached.iter().filter(|(from, _)| *from == middle).map(|(_, to)| *to).collect(),
        );
        reached.extend(into.iter().flat_map(|from| out.iter().map(move |to| (*from, *to))));
    }
    let through =
        |from: &str, to: &str| layers().any(|middle| reached.contains(&(from, middle)) && reached.contains(&(middle, to)));
    imports.iter().filter(|((from, to), _)| !through(from, to)).map(|(edge, count)| (*edge, *count)).collect()
}

fn color(layer: &str) -> &'static str {
    let mut places: Vec<String> = Vec::new();
    for place in layers().map(crate_label) {
        if !places.contains(&place) {
            places.push(place);
        }
    }
    let k = places.iter().position(|place| *place == crate_label(layer)).unwrap_or_default();
    COLORS[k % COLORS.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_only_direct_imports_have_arrows() {
        let imports = Imports::from([(("mav", "base"), 3), (("telemetry", "mav"), 2), (("telemetry", "base"), 9)]);
        assert_eq!(direct_imports(&imports), Imports::from([(("mav", "base"), 3), (("telemetry", "mav"), 2)]));
    }

    #[test]
    fn exact_every_layer_is_above_its_imports() {
        let imports = Imports::from([(("mav", "base"), 3), (("telemetry", "mav"), 2), (("telemetry", "base"), 9)]);
        let centers = centers(&rows(&imports), &imports);
        assert!(imports.keys().all(|(from, to)| centers[from].1 < centers[to].1));
        assert_eq!(svg(&imports), svg(&imports));
    }
}
