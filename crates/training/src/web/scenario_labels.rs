//! Labels of the scenario editor's fields.

use spandrel_text::{Language, text};

/// Units at the end of keys, and their symbols.
const UNITS: [(&str, &str); 16] = [
    ("_m_s", "m/s"),
    ("_mph", "mph"),
    ("_deg", "°"),
    ("_pct", "%"),
    ("_min", "min"),
    ("_utc", "UTC"),
    ("_mm_h", "mm/h"),
    ("_mm", "mm"),
    ("_px", "px"),
    ("_hz", "Hz"),
    ("_kg_m", "kg/m"),
    ("_m", "m"),
    ("_s", "s"),
    ("_n", "N"),
    ("_kg", "kg"),
    ("_c", "°C"),
];

/// Returns the label of a key with its unit, such as `Stand-off (m)` for `tasks[2].stand_off_m`.
#[must_use]
pub fn label(language: Language, location: &str) -> String {
    let key = location.rsplit('.').next().unwrap_or_default();
    let (name, unit) = UNITS
        .iter()
        .find_map(|(end, unit)| Some((key.strip_suffix(end).filter(|name| !name.is_empty())?, *unit)))
        .unwrap_or((key, ""));
    let label = translated(language, name).unwrap_or_else(|| in_words(name));
    if unit.is_empty() { label } else { text!(language, "editor-with-unit", label = label, unit = unit) }
}

/// Makes a label from the name of a key that has no label in the catalog, without its unit: `rib_width` becomes `Rib width`.
fn in_words(name: &str) -> String {
    let words = name.replace('_', " ").replace("centre", "center").replace("gnss", "GNSS");
    let mut letters = words.chars();
    let first = letters.next().map(|c| c.to_ascii_uppercase()).into_iter();
    first.chain(letters).collect()
}

fn translated(language: Language, name: &str) -> Option<String> {
    let place = place_label(language, name).or_else(|| bridge_label(language, name));
    let place = place.or_else(|| girder_label(language, name)).or_else(|| truss_label(language, name));
    let place = place.or_else(|| box_girder_label(language, name)).or_else(|| masonry_label(language, name));
    let place = place.or_else(|| cable_stayed_label(language, name));
    place.or_else(|| flight_label(language, name)).or_else(|| rule_label(language, name))
}

/// Labels of the job, the place and the ground team.
fn place_label(language: Language, name: &str) -> Option<String> {
    Some(match name {
        "format" => text!(language, "editor-key-format"),
        "name" => text!(language, "editor-key-name"),
        "title" => text!(language, "editor-key-title"),
        "briefing" => text!(language, "editor-key-briefing"),
        "caption" => text!(language, "editor-key-caption"),
        "seed" => text!(language, "editor-key-seed"),
        "form" => text!(language, "editor-key-form"),
        "level" => text!(language, "editor-key-level"),
        "latitude" => text!(language, "editor-key-latitude"),
        "longitude" => text!(language, "editor-key-longitude"),
        "altitude" => text!(language, "editor-key-altitude"),
        "size" => text!(language, "editor-key-size"),
        "spacing" => text!(language, "editor-key-spacing"),
        "water_level" => text!(language, "editor-key-water-level"),
        "source" => text!(language, "editor-key-source"),
        "height" => text!(language, "editor-key-height"),
        "lake_width" => text!(language, "editor-key-lake-width"),
        "axis" => text!(language, "editor-key-axis"),
        "relief" => text!(language, "editor-key-relief"),
        "lake_depth" => text!(language, "editor-key-lake-depth"),
        "file" => text!(language, "editor-key-file"),
        "offset" => text!(language, "editor-key-offset"),
        "water_depth" => text!(language, "editor-key-water-depth"),
        "photo" => text!(language, "editor-key-photo"),
        "pad" => text!(language, "editor-key-pad"),
        "pad_heading" => text!(language, "editor-key-pad-heading"),
        "pad_half" => text!(language, "editor-key-pad-half"),
        "inspector" => text!(language, "editor-key-inspector"),
        "places" => text!(language, "editor-key-places"),
        "truck" => text!(language, "editor-key-truck"),
        "truck_heading" => text!(language, "editor-key-truck-heading"),
        "home_radius" => text!(language, "editor-key-home-radius"),
        _ => return None,
    })
}

/// Labels of bridges.
fn bridge_label(language: Language, name: &str) -> Option<String> {
    Some(match name {
        "centre" => text!(language, "editor-key-centre"),
        "heading" => text!(language, "editor-key-heading"),
        "type" => text!(language, "editor-key-type"),
        "span" => text!(language, "editor-key-span"),
        "rise" => text!(language, "editor-key-rise"),
        "crown_depth" => text!(language, "editor-key-crown-depth"),
        "springing_depth" => text!(language, "editor-key-springing-depth"),
        "rib_width" => text!(language, "editor-key-rib-width"),
        "rib_spacing" => text!(language, "editor-key-rib-spacing"),
        "crown_gap" => text!(language, "editor-key-crown-gap"),
        "panels" => text!(language, "editor-key-panels"),
        "column" => text!(language, "editor-key-column"),
        "deck_width" => text!(language, "editor-key-deck-width"),
        "slab" => text!(language, "editor-key-slab"),
        "floorbeam_depth" => text!(language, "editor-key-floorbeam-depth"),
        "floorbeam_width" => text!(language, "editor-key-floorbeam-width"),
        "stringers" => text!(language, "editor-key-stringers"),
        "stringer_depth" => text!(language, "editor-key-stringer-depth"),
        "stringer_width" => text!(language, "editor-key-stringer-width"),
        "railing" => text!(language, "editor-key-railing"),
        "approach" => text!(language, "editor-key-approach"),
        "main_span" => text!(language, "editor-key-main-span"),
        "side_span" => text!(language, "editor-key-side-span"),
        "sag" => text!(language, "editor-key-sag"),
        "cable_clearance" => text!(language, "editor-key-cable-clearance"),
        "cable_radius" => text!(language, "editor-key-cable-radius"),
        "hanger_spacing" => text!(language, "editor-key-hanger-spacing"),
        "hanger_radius" => text!(language, "editor-key-hanger-radius"),
        "girder_depth" => text!(language, "editor-key-girder-depth"),
        "leg_x" => text!(language, "editor-key-leg-x"),
        "leg_y" => text!(language, "editor-key-leg-y"),
        "pier_x" => text!(language, "editor-key-pier-x"),
        "pier_y" => text!(language, "editor-key-pier-y"),
        "pier_top" => text!(language, "editor-key-pier-top"),
        "pier_height" => text!(language, "editor-key-pier-height"),
        "anchorage" => text!(language, "editor-key-anchorage"),
        _ => return None,
    })
}

/// Labels of girder bridges, for keys that other bridges don't have.
fn girder_label(language: Language, name: &str) -> Option<String> {
    Some(match name {
        "spans" => text!(language, "editor-key-spans"),
        "end_span" => text!(language, "editor-key-end-span"),
        "simple_spans" => text!(language, "editor-key-simple-spans"),
        "joint_gap" => text!(language, "editor-key-joint-gap"),
        "girders" => text!(language, "editor-key-girders"),
        "girder_spacing" => text!(language, "editor-key-girder-spacing"),
        "overhang" => text!(language, "editor-key-overhang"),
        "haunch" => text!(language, "editor-key-haunch"),
        "web_depth" => text!(language, "editor-key-web-depth"),
        "web" => text!(language, "editor-key-web"),
        "flange_width" => text!(language, "editor-key-flange-width"),
        "flange" => text!(language, "editor-key-flange"),
        "section" => text!(language, "editor-key-section"),
        "diaphragm_spacing" => text!(language, "editor-key-diaphragm-spacing"),
        "diaphragm" => text!(language, "editor-key-diaphragm"),
        "cross_frame_spacing" => text!(language, "editor-key-cross-frame-spacing"),
        "barrier" => text!(language, "editor-key-barrier"),
        "drain_spacing" => text!(language, "editor-key-drain-spacing"),
        "bearing" => text!(language, "editor-key-bearing"),
        "pedestal" => text!(language, "editor-key-pedestal"),
        "cap_depth" => text!(language, "editor-key-cap-depth"),
        "cap_width" => text!(language, "editor-key-cap-width"),
        "columns" => text!(language, "editor-key-columns"),
        "round_columns" => text!(language, "editor-key-round-columns"),
        "column_height" => text!(language, "editor-key-column-height"),
        "abutment" => text!(language, "editor-key-abutment"),
        _ => return None,
    })
}

/// Labels of truss bridges, for keys that other bridges don't have.
fn truss_label(language: Language, name: &str) -> Option<String> {
    Some(match name {
        "depth" => text!(language, "editor-key-depth"),
        "hip_depth" => text!(language, "editor-key-hip-depth"),
        "truss_spacing" => text!(language, "editor-key-truss-spacing"),
        "chord" => text!(language, "editor-key-chord"),
        "gusset" => text!(language, "editor-key-gusset"),
        "bracing_depth" => text!(language, "editor-key-bracing-depth"),
        _ => return None,
    })
}

/// Labels of box girder bridges, for keys that other bridges don't have.
fn box_girder_label(language: Language, name: &str) -> Option<String> {
    Some(match name {
        "midspan_depth" => text!(language, "editor-key-midspan-depth"),
        "pier_depth" => text!(language, "editor-key-pier-depth"),
        "haunch_length" => text!(language, "editor-key-haunch-length"),
        "cells" => text!(language, "editor-key-cells"),
        "cell_width" => text!(language, "editor-key-cell-width"),
        "web_slope" => text!(language, "editor-key-web-slope"),
        "bottom_slab" => text!(language, "editor-key-bottom-slab"),
        _ => return None,
    })
}

/// Labels of masonry arch bridges, for keys that other bridges don't have.
fn masonry_label(language: Language, name: &str) -> Option<String> {
    Some(match name {
        "clear_span" => text!(language, "editor-key-clear-span"),
        "ring" => text!(language, "editor-key-ring"),
        "cover" => text!(language, "editor-key-cover"),
        "width" => text!(language, "editor-key-width"),
        "wall" => text!(language, "editor-key-wall"),
        "parapet" => text!(language, "editor-key-parapet"),
        "pier" => text!(language, "editor-key-pier"),
        "cutwater" => text!(language, "editor-key-cutwater"),
        _ => return None,
    })
}

/// Labels of cable-stayed bridges, for keys that other bridges don't have.
fn cable_stayed_label(language: Language, name: &str) -> Option<String> {
    Some(match name {
        "tower_height" => text!(language, "editor-key-tower-height"),
        "stays" => text!(language, "editor-key-stays"),
        "anchor_spacing" => text!(language, "editor-key-anchor-spacing"),
        "stay_radius" => text!(language, "editor-key-stay-radius"),
        _ => return None,
    })
}

/// Labels of tasks, defects, traffic, wind and light.
fn flight_label(language: Language, name: &str) -> Option<String> {
    Some(match name {
        "kind" => text!(language, "editor-key-kind"),
        "bridge" => text!(language, "editor-key-bridge"),
        "span_number" => text!(language, "editor-key-span-number"),
        "support_number" => text!(language, "editor-key-support-number"),
        "stand_off" => text!(language, "editor-key-stand-off"),
        "stand_off_tolerance" => text!(language, "editor-key-stand-off-tolerance"),
        "threshold" => text!(language, "editor-key-threshold"),
        "closed" => text!(language, "editor-key-closed"),
        "points_relative_to" => text!(language, "editor-key-points-relative-to"),
        "points" => text!(language, "editor-key-points"),
        "look_at" => text!(language, "editor-key-look-at"),
        "too_close" => text!(language, "editor-key-too-close"),
        "dark" => text!(language, "editor-key-dark"),
        "count" => text!(language, "editor-key-count"),
        "placement" => text!(language, "editor-key-placement"),
        "size_factor" => text!(language, "editor-key-size-factor"),
        "elements" => text!(language, "editor-key-elements"),
        "kinds" => text!(language, "editor-key-kinds"),
        "detection" => text!(language, "editor-key-detection"),
        "lines" => text!(language, "editor-key-lines"),
        "none_placed" => text!(language, "editor-key-none-placed"),
        "cars" => text!(language, "editor-key-cars"),
        "trucks" => text!(language, "editor-key-trucks"),
        "pedestrians" => text!(language, "editor-key-pedestrians"),
        "car_speed" => text!(language, "editor-key-car-speed"),
        "vehicle" => text!(language, "editor-key-vehicle"),
        "spread" => text!(language, "editor-key-spread"),
        "wait" => text!(language, "editor-key-wait"),
        "repeat" => text!(language, "editor-key-repeat"),
        "diameter" => text!(language, "editor-key-diameter"),
        "length" => text!(language, "editor-key-length"),
        "mass" => text!(language, "editor-key-mass"),
        "model" => text!(language, "editor-key-model"),
        "speed" => text!(language, "editor-key-speed"),
        "paper_force" => text!(language, "editor-key-paper-force"),
        "from" => text!(language, "editor-key-from"),
        "up" => text!(language, "editor-key-up"),
        "turbulence" => text!(language, "editor-key-turbulence"),
        "at" => text!(language, "editor-key-at"),
        "duration" => text!(language, "editor-key-duration"),
        "peak" => text!(language, "editor-key-peak"),
        "over" => text!(language, "editor-key-over"),
        "start" => text!(language, "editor-key-start"),
        "cloud_cover" => text!(language, "editor-key-cloud-cover"),
        "water_albedo" => text!(language, "editor-key-water-albedo"),
        "visibility" => text!(language, "editor-key-visibility"),
        "rain" => text!(language, "editor-key-rain"),
        "snow" => text!(language, "editor-key-snow"),
        "ground_albedo" => text!(language, "editor-key-ground-albedo"),
        _ => return None,
    })
}

/// Labels of rules, scoring, feedback and certification.
fn rule_label(language: Language, name: &str) -> Option<String> {
    Some(match name {
        "after_crash" => text!(language, "editor-key-after-crash"),
        "battery" => text!(language, "editor-key-battery"),
        "low_battery_return" => text!(language, "editor-key-low-battery-return"),
        "low_battery" => text!(language, "editor-key-low-battery"),
        "critical_battery" => text!(language, "editor-key-critical-battery"),
        "water" => text!(language, "editor-key-water"),
        "battery_temperature" => text!(language, "editor-key-battery-temperature"),
        "wakes" => text!(language, "editor-key-wakes"),
        "sky" => text!(language, "editor-key-sky"),
        "almanac" => text!(language, "editor-key-almanac"),
        "radio" => text!(language, "editor-key-radio"),
        "severity" => text!(language, "editor-key-severity"),
        "hazard_severity" => text!(language, "editor-key-hazard-severity"),
        "compass" => text!(language, "editor-key-compass"),
        "gnss_shadow" => text!(language, "editor-key-gnss-shadow"),
        "stick_response" => text!(language, "editor-key-stick-response"),
        "respawn_after" => text!(language, "editor-key-respawn-after"),
        "too_close_clear" => text!(language, "editor-key-too-close-clear"),
        "off_path_max" => text!(language, "editor-key-off-path-max"),
        "off_path_after" => text!(language, "editor-key-off-path-after"),
        "off_path_hold" => text!(language, "editor-key-off-path-hold"),
        "leave_after" => text!(language, "editor-key-leave-after"),
        "visit_after" => text!(language, "editor-key-visit-after"),
        "speeding_margin" => text!(language, "editor-key-speeding-margin"),
        "speeding_hold" => text!(language, "editor-key-speeding-hold"),
        "battery_green" => text!(language, "editor-key-battery-green"),
        "battery_yellow" => text!(language, "editor-key-battery-yellow"),
        "text_interval" => text!(language, "editor-key-text-interval"),
        "guidance" => text!(language, "editor-key-guidance"),
        "frame_rate" => text!(language, "editor-key-frame-rate"),
        "speed_limit" => text!(language, "editor-key-speed-limit"),
        "max_speed" => text!(language, "editor-key-max-speed"),
        "time_best" => text!(language, "editor-key-time-best"),
        "time_max" => text!(language, "editor-key-time-max"),
        "beta" => text!(language, "editor-key-beta"),
        "clearance" => text!(language, "editor-key-clearance"),
        "task_done" => text!(language, "editor-key-task-done"),
        "exact_path" => text!(language, "editor-key-exact-path"),
        "max_contacts" => text!(language, "editor-key-max-contacts"),
        "max_contact_speed" => text!(language, "editor-key-max-contact-speed"),
        "min_battery" => text!(language, "editor-key-min-battery"),
        "min_conformity" => text!(language, "editor-key-min-conformity"),
        "min_precision" => text!(language, "editor-key-min-precision"),
        "min_safety" => text!(language, "editor-key-min-safety"),
        "min_accuracy" => text!(language, "editor-key-min-accuracy"),
        "min_inspected" => text!(language, "editor-key-min-inspected"),
        "inspection_speed" => text!(language, "editor-key-inspection-speed"),
        "time_per_defect" => text!(language, "editor-key-time-per-defect"),
        "transit_time" => text!(language, "editor-key-transit-time"),
        "max_time_ratio" => text!(language, "editor-key-max-time-ratio"),
        "max_gsd" => text!(language, "editor-key-max-gsd"),
        "gsd_per_line_width" => text!(language, "editor-key-gsd-per-line-width"),
        "max_smear" => text!(language, "editor-key-max-smear"),
        "max_incidence" => text!(language, "editor-key-max-incidence"),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::web::scenario_form::ScenarioForm;
    use spandrel_model::shipped::SCENARIOS;

    #[test]
    fn exact_labels_come_from_the_catalog_and_have_units() {
        for (location, expected) in [
            ("tasks[2].stand_off_m", "Stand-off (m)"),
            ("bridges[0].centre_m", "Center (m)"),
            ("wind.speed_m_s", "Speed (m/s)"),
            ("scoring.time_best_min", "Time for full score (min)"),
            ("rules.gnss_shadow", "GNSS shadowing"),
            ("name", "Name"),
            ("unknown_key_m", "Unknown key (m)"),
        ] {
            assert_eq!(label(Language::English, location), expected);
        }
        assert_eq!(label(Language::German, "tasks[2].stand_off_m"), "Abstand (m)");
    }

    #[test]
    fn prop_every_field_has_a_label_in_the_catalog() {
        let pictures = "[[briefing_pictures]]\nfile = \"a.png\"\ncaption = \"a\"\n";
        for (name, text) in SCENARIOS.iter().chain(&[("pictures", pictures)]) {
            for field in ScenarioForm::read(text).unwrap().fields() {
                let key = field.location.rsplit('.').next().unwrap();
                let stem = UNITS.iter().find_map(|(end, _)| key.strip_suffix(end).filter(|stem| !stem.is_empty())).unwrap_or(key);
                for language in Language::ALL {
                    let label = translated(language, stem).unwrap_or_default();
                    assert!(!label.trim().is_empty(), "{name}: {} has no label in {language:?}", field.location);
                }
            }
        }
    }
}
