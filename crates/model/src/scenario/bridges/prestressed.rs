//! Multi-span bridge with precast, prestressed concrete I-beams or bulb tees under a concrete deck: end and intermediate diaphragms,
//! elastomeric bearings, piers with columns and caps or hammerheads, and seat abutments.
//!
//! The sections are the standard ones of AASHTO and PCI. The default span, beams and slab are those of the design example with BT-72
//! beams in chapter 9 of the PCI *Bridge Design Manual* (120 ft, beams 9 ft apart).

use super::beam_bridge::BeamBridge;
use super::beam_layout::{BeamLayout, BearingLayout, DeckLayout, LineLayout, SpanLayout, Station, support_layout};
use super::dimensions::{InconsistencyList, bridge_dimensions};
use super::quantity::Amounts;
use super::solid::MemberBuilder;
use crate::elements::Element;

/// Length of an inch, m.
const INCH_M: f64 = 0.0254;
/// Distance from the bearings to the ends of the beams, m (estimate: 10 in).
const BEAM_OVERHANG_M: f64 = 0.25;
/// Length of a bearing pad along the bridge, m (estimate: 10 in).
const PAD_LENGTH_M: f64 = 0.25;
/// Width of a bearing pad, as a share of the beam's bottom flange (estimate).
const PAD_SHARE: f64 = 0.85;
/// Gap between the beams of two spans in a continuity diaphragm above a pier, m (estimate: 12 in).
const CONTINUITY_GAP_M: f64 = 0.3;
/// Longest span, as a multiple of the beam's depth (estimate).
const MAX_SLENDERNESS: f64 = 28.0;

/// Dimensions of a standard section, in inches, from the top to the bottom: rectangles and trapezoids that are symmetric about the web.
#[derive(Debug, Clone, Copy, PartialEq)]
struct StandardSection {
    /// Value of the key `section`.
    number: f64,
    top_width_in: f64,
    top_flange_in: f64,
    /// Height of the tapered part of the top flange, and its width at the bottom; 0 if there is none.
    taper_in: (f64, f64),
    top_fillet_in: f64,
    web_height_in: f64,
    web_in: f64,
    bottom_fillet_in: f64,
    bottom_flange_in: f64,
    bottom_width_in: f64,
}

/// Creates an AASHTO section without a taper, types I to IV.
const fn aashto(number: f64, top: (f64, f64), fillet_in: f64, web: (f64, f64), bottom: (f64, f64, f64)) -> StandardSection {
    StandardSection {
        number,
        top_width_in: top.0,
        top_flange_in: top.1,
        taper_in: (0.0, 0.0),
        top_fillet_in: fillet_in,
        web_height_in: web.0,
        web_in: web.1,
        bottom_fillet_in: bottom.0,
        bottom_flange_in: bottom.1,
        bottom_width_in: bottom.2,
    }
}

/// Creates an AASHTO section with a wide top flange, types V and VI.
const fn wide_aashto(number: f64, web_height_in: f64) -> StandardSection {
    StandardSection { taper_in: (3.0, 16.0), ..aashto(number, (42.0, 5.0), 4.0, (web_height_in, 8.0), (10.0, 8.0, 28.0)) }
}

/// Creates a PCI bulb tee with a depth in inches.
const fn bulb_tee(depth_in: f64) -> StandardSection {
    StandardSection {
        number: depth_in,
        top_width_in: 42.0,
        top_flange_in: 3.5,
        taper_in: (2.0, 10.0),
        top_fillet_in: 2.0,
        web_height_in: depth_in - 18.0,
        web_in: 6.0,
        bottom_fillet_in: 4.5,
        bottom_flange_in: 6.0,
        bottom_width_in: 26.0,
    }
}

/// The sections of the key `section` (PCI, *Bridge Design Manual*, appendix B).
const SECTIONS: [StandardSection; 9] = [
    aashto(1.0, (12.0, 4.0), 3.0, (11.0, 6.0), (5.0, 5.0, 16.0)),
    aashto(2.0, (12.0, 6.0), 3.0, (15.0, 6.0), (6.0, 6.0, 18.0)),
    aashto(3.0, (16.0, 7.0), 4.5, (19.0, 7.0), (7.5, 7.0, 22.0)),
    aashto(4.0, (20.0, 8.0), 6.0, (23.0, 8.0), (9.0, 8.0, 26.0)),
    wide_aashto(5.0, 33.0),
    wide_aashto(6.0, 42.0),
    bulb_tee(54.0),
    bulb_tee(63.0),
    bulb_tee(72.0),
];

bridge_dimensions! {
    /// Dimensions of a prestressed concrete girder bridge. Bridge axes: x along the deck, y left, z up, origin on the deck in the middle
    /// between the abutments.
    Prestressed "prestressed" {
        spans 1.0 to 8.0, 3.0, "Number of spans; a whole number.";
        span_m 10.0 to 55.0, 36.58, "Length of each span between bearings, m, except for the first and the last of several spans; 36.6 m (120 ft) in the PCI Bridge Design Manual's example with BT-72 beams.";
        end_span_m 10.0 to 55.0, 33.53, "Length of the first and the last of several spans, m; 110 ft (estimate).";
        simple_spans 0.0 to 1.0, 0.0, "1 if the deck has joints above the piers; 0 if it is continuous, with a diaphragm around the ends of the beams; a whole number.";
        joint_gap_m 0.03 to 0.15, 0.06, "Width of the expansion joints, m (estimate).";
        girders 2.0 to 12.0, 6.0, "Number of girders; 6 in the PCI Bridge Design Manual's example with BT-72 beams; a whole number.";
        girder_spacing_m 1.5 to 4.0, 2.74, "Distance between girders, m; 2.74 m (9 ft) in the PCI Bridge Design Manual's example with BT-72 beams.";
        overhang_m 0.6 to 2.0, 1.22, "Deck width beyond the outer girders' axes, m (estimate).";
        slab_m 0.178 to 0.35, 0.203, "Slab thickness, m; 0.203 m (8 in) in the PCI Bridge Design Manual's example with BT-72 beams, at least 7 in (AASHTO LRFD 9.7.1.1).";
        haunch_m 0.01 to 0.15, 0.05, "Height of the concrete haunch between the slab and a girder, m (estimate).";
        section 1.0 to 72.0, 72.0, "Standard section of the girders: 1 to 6 for AASHTO types I to VI, 54, 63 or 72 for PCI bulb tees of this depth in inches; a whole number.";
        diaphragm_spacing_m 6.0 to 30.0, 12.2, "Maximum distance between diaphragms, m; 40 ft in older AASHTO specifications.";
        diaphragm_m 0.15 to 0.5, 0.25, "Thickness of the diaphragms, m; 8 to 12 in (estimate).";
        barrier_m 0.685 to 1.4, 0.86, "Barrier height, m; 27 in for test level 3, 42 in for test level 5 (AASHTO LRFD 13.7.3.2).";
        drain_spacing_m 5.0 to 100.0, 18.0, "Distance between deck drains, m (estimate).";
        bearing_m 0.04 to 0.2, 0.1, "Height of the bearings, m (estimate).";
        pedestal_m 0.1 to 1.0, 0.3, "Height of the pedestals below the bearings, m (estimate).";
        cap_depth_m 0.6 to 3.0, 1.3, "Depth of the pier caps, m (estimate).";
        cap_width_m 0.8 to 4.0, 1.5, "Width of the pier caps along the bridge, m (estimate).";
        columns 1.0 to 6.0, 3.0, "Number of columns per pier; a whole number.";
        column_m 0.5 to 3.0, 1.22, "Side length or diameter of the columns, m (estimate).";
        round_columns 0.0 to 1.0, 1.0, "1 if the columns are round, 0 if they are square; a whole number.";
        column_height_m 2.0 to 60.0, 10.0, "Height of the columns between footing and cap, m (estimate).";
        abutment_m 2.0 to 15.0, 4.0, "Height of the abutments below the bearing seats, m (estimate).";
        approach_m 4.0 to 20.0, 6.0, "Length of the approach slabs and wing walls, m (estimate).";
    }
}

/// Dimensions of a section, m, as parts from the top to the bottom.
#[derive(Debug, Clone, PartialEq)]
struct Section {
    top_width_m: f64,
    bottom_width_m: f64,
    web_m: f64,
    depth_m: f64,
    parts: Vec<SectionPart>,
}

/// A part of a section: name, depths of its top and bottom below the beam's top, and widths there, m.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SectionPart {
    name: &'static str,
    depth_m: (f64, f64),
    width_m: (f64, f64),
}

impl StandardSection {
    fn to_section(self) -> Section {
        let (taper_in, tapered_width_in) = if self.taper_in.0 > 0.0 { self.taper_in } else { (0.0, self.top_width_in) };
        let rows = [
            ("top", self.top_flange_in, (self.top_width_in, self.top_width_in)),
            ("taper", taper_in, (self.top_width_in, tapered_width_in)),
            ("top-fillet", self.top_fillet_in, (tapered_width_in, self.web_in)),
            ("web", self.web_height_in, (self.web_in, self.web_in)),
            ("bottom-fillet", self.bottom_fillet_in, (self.web_in, self.bottom_width_in)),
            ("bottom", self.bottom_flange_in, (self.bottom_width_in, self.bottom_width_in)),
        ];
        let mut parts = Vec::new();
        let mut top_in = 0.0;
        for (name, height_in, (above_in, below_in)) in rows {
            let depth_m = (top_in * INCH_M, (top_in + height_in) * INCH_M);
            top_in += height_in;
            if height_in > 0.0 {
                parts.push(SectionPart { name, depth_m, width_m: (above_in * INCH_M, below_in * INCH_M) });
            }
        }
        Section {
            top_width_m: self.top_width_in * INCH_M,
            bottom_width_m: self.bottom_width_in * INCH_M,
            web_m: self.web_in * INCH_M,
            depth_m: top_in * INCH_M,
            parts,
        }
    }
}

impl BeamBridge for Prestressed {
    const IN_WORDS: &'static str = "a prestressed girder bridge";

    fn layout(&self) -> BeamLayout {
        let section = self.section();
        let group_m = (self.girders.round() - 1.0) * self.girder_spacing_m;
        let width_m = group_m + 2.0 * self.overhang_m;
        let top_z_m = -self.slab_m - self.haunch_m;
        let has_pier_joints = self.has_pier_joints();
        BeamLayout {
            spans: SpanLayout {
                count: self.spans,
                span_m: self.span_m,
                end_span_m: self.end_span_m,
                overhang_m: BEAM_OVERHANG_M,
                pier_gap_m: Some(if has_pier_joints { self.joint_gap_m } else { CONTINUITY_GAP_M }),
                has_pier_joints,
                joint_gap_m: self.joint_gap_m,
                station_spacing_m: self.diaphragm_spacing_m,
            },
            lines: LineLayout {
                count: self.girders,
                spacing_m: self.girder_spacing_m,
                haunch_width_m: section.top_width_m,
                top_z_m,
                bottom_z_m: top_z_m - section.depth_m,
                abutment_bottom_z_m: top_z_m - section.depth_m,
            },
            deck: DeckLayout {
                width_m,
                slab_m: self.slab_m,
                element: Element::RcDeck,
                railing_m: self.barrier_m,
                railing: Element::RcRailing,
                drain_spacing_m: self.drain_spacing_m,
                has_floorbeams: false,
            },
            bearings: BearingLayout {
                height_m: self.bearing_m,
                length_m: PAD_LENGTH_M,
                width_m: PAD_SHARE * section.bottom_width_m,
                pedestal_m: self.pedestal_m,
                expansion: Element::ElastomericBearing,
                fixed: Element::ElastomericBearing,
            },
            supports: support_layout!(self, width_m),
        }
    }

    fn require(&self, layout: &BeamLayout, m: &mut InconsistencyList) {
        for (key, value) in [
            ("spans", self.spans),
            ("simple_spans", self.simple_spans),
            ("girders", self.girders),
            ("section", self.section),
            ("columns", self.columns),
            ("round_columns", self.round_columns),
        ] {
            m.require_integer(key, value);
        }
        let numbers = SECTIONS.map(|section| section.number);
        m.require_one_of("section", self.section, &numbers, "a standard section");
        let section = self.section();
        let widest_m = section.top_width_m.max(section.bottom_width_m);
        layout.require_deck_room(m, self.overhang_m, (widest_m, "section"));
        m.require_at_least("girder_spacing_m", self.girder_spacing_m, widest_m + 0.3, "room between the girders (section)");
        let longest_m = MAX_SLENDERNESS * section.depth_m;
        let why = "28 times the depth of the girders (section; estimate)";
        layout.require_spans_at_most(m, longest_m, why);
        layout.require_pier_room(m, "simple_spans, joint_gap_m", "girders, girder_spacing_m");
    }

    fn add_beams(&self, layout: &BeamLayout, b: &mut MemberBuilder) {
        let section = self.section();
        self.add_girders(layout, &section, b);
        self.add_diaphragms(layout, &section, b);
    }

    fn add_beam_amounts(&self, layout: &BeamLayout, amounts: &mut Amounts) {
        amounts.add(Element::PscGirder, layout.beam_length_m() * self.girders.round());
    }
}

impl Prestressed {
    /// Returns the section; that of the deepest bulb tee for a number without a section, which is inconsistent.
    fn section(&self) -> Section {
        let standard = SECTIONS.iter().find(|section| section.number.total_cmp(&self.section).is_eq());
        standard.copied().unwrap_or(bulb_tee(72.0)).to_section()
    }

    fn has_pier_joints(&self) -> bool {
        self.simple_spans.round() > 0.0
    }

    fn add_girders(&self, layout: &BeamLayout, section: &Section, b: &mut MemberBuilder) {
        for (line, y) in layout.numbered_lines() {
            for (k, (from, to)) in layout.beam_panels().into_iter().enumerate() {
                for part in &section.parts {
                    let name = format!("girder-{line}/{k:02}/{}", part.name);
                    b.add_cross_section(&name, Element::PscGirder, &self.profile(layout, part, y), from, to);
                }
            }
        }
    }

    /// Returns the profile of a part of the section of the girder at y.
    fn profile(&self, layout: &BeamLayout, part: &SectionPart, y: f64) -> [[f64; 2]; 4] {
        let top = layout.lines.top_z_m;
        let (high, low) = (top - part.depth_m.0, top - part.depth_m.1);
        let (above, below) = (0.5 * part.width_m.0, 0.5 * part.width_m.1);
        [[y - below, low], [y + below, low], [y + above, high], [y - above, high]]
    }

    /// Adds diaphragms between the girders: along their webs within the spans, up to the slab at their ends, and around their ends above
    /// the piers if the deck is continuous.
    fn add_diaphragms(&self, layout: &BeamLayout, section: &Section, b: &mut MemberBuilder) {
        let (supports, piers) = (layout.support_positions(), layout.piers());
        if !self.has_pier_joints() {
            for pier in piers.clone() {
                self.add_pier_diaphragm(layout, section, b, (pier, supports[pier]));
            }
        }
        let bays = layout.beam_lines().len() - 1;
        let last = supports.len() - 1;
        let is_in_pier_diaphragm = |station: &Station| {
            let nearest =
                (0..=last).min_by(|a, b| (supports[*a] - station.x_m).abs().total_cmp(&(supports[*b] - station.x_m).abs()));
            !self.has_pier_joints() && station.at_bearings && nearest.is_some_and(|support| piers.contains(&support))
        };
        for (k, station) in layout.beam_stations().iter().enumerate().filter(|(_, station)| !is_in_pier_diaphragm(station)) {
            for (bay, left) in layout.numbered_lines().take(bays) {
                self.add_diaphragm(layout, section, b, &format!("diaphragm-{bay}/{k:02}"), (*station, left));
            }
        }
    }

    /// Adds a diaphragm between the girder at `left` and the next one.
    fn add_diaphragm(
        &self,
        layout: &BeamLayout,
        section: &Section,
        b: &mut MemberBuilder,
        name: &str,
        (station, left): (Station, f64),
    ) {
        let (half, right) = (0.5 * self.diaphragm_m, left - self.girder_spacing_m);
        let (high, low) = self.web_z_m(layout, section);
        let web = 0.5 * section.web_m;
        let x = (station.x_m - half, station.x_m + half);
        b.add_box(&format!("{name}/web"), Element::PscGirder, [x.0, right + web, low], [x.1, left - web, high]);
        if station.at_bearings {
            let flange = 0.5 * section.top_width_m;
            let soffit = -self.slab_m;
            b.add_box(&format!("{name}/top"), Element::PscGirder, [x.0, right + flange, high], [x.1, left - flange, soffit]);
        }
    }

    /// Adds the diaphragm that fills the gap between the girders of two spans.
    fn add_pier_diaphragm(&self, layout: &BeamLayout, section: &Section, b: &mut MemberBuilder, (pier, x): (usize, f64)) {
        let (along, across) = (0.5 * CONTINUITY_GAP_M, 0.5 * (layout.beam_group_m() + section.bottom_width_m));
        let (low, high) = ([x - along, -across, layout.lines.bottom_z_m], [x + along, across, -self.slab_m]);
        b.add_box(&format!("diaphragm-pier/{pier}"), Element::PscGirder, low, high);
    }

    /// Returns the heights of the upper and lower end of the webs.
    fn web_z_m(&self, layout: &BeamLayout, section: &Section) -> (f64, f64) {
        let top = layout.lines.top_z_m;
        let web = section.parts.iter().find(|part| part.name == "web");
        web.map_or((top, top - section.depth_m), |part| (top - part.depth_m.0, top - part.depth_m.1))
    }
}
