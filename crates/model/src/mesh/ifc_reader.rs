//! Reads IFC files (IFC2X3 to IFC4X3, in the STEP format): each product with a body becomes a part, in meters with z up, with its openings cut
//! out. The library tessellates the bodies.

use super::Mesh;
use super::ifc_elements::element_of;
use super::ifc_relations::Relations;
use super::mesh_file::{MAX_NODES, MAX_TRIANGLES, MeshFile, MeshNode, check_file_size, check_vertex, clean_name};
use super::vectors::{Point, add_scaled};
use ifc_lite_core::{DecodedEntity, EntityDecoder, EntityScanner, IfcType, RtcVerdict, SchemaVersion, is_geometry_job, slot};
use ifc_lite_geometry::{GeometryRouter, RouterConfig, void_index_from_content};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Words at the beginning and at the end of each file, and the number of bytes at the end that are searched for the latter.
const FIRST_WORDS: &[u8] = b"ISO-10303-21";
const LAST_WORDS: &[u8] = b"END-ISO-10303-21";
const END_BYTES: usize = 4096;
/// Schemas that the library knows.
const SCHEMAS: &str = "IFC2X3, IFC4, IFC4X1, IFC4X2 or IFC4X3";
/// Classes, in capitals, on which the slab of a deck rests; without them, the bridge is a slab bridge.
const GIRDERS: [&str; 2] = ["IFCBEAM", "IFCMEMBER"];
/// Attributes of each product: its global ID and its name.
const GLOBAL_ID: usize = 0;
const NAME: usize = 2;
/// Number of decoded entities that are kept for other products (estimate: far more than one product refers to).
const MAX_CACHED_ENTITIES: usize = 200_000;
/// Number of notes on products without geometry in an error (estimate: more hide the first).
const NOTES_IN_ERROR: usize = 3;

/// Classes of products that are no part of a bridge: structures whose parts are products of their own, spaces and land, axes and grids,
/// models of loads, bars and tendons inside concrete, bolts and welds.
const OTHER_CLASSES: [IfcType; 19] = [
    IfcType::IfcSpace,
    IfcType::IfcSite,
    IfcType::IfcSpatialZone,
    IfcType::IfcExternalSpatialElement,
    IfcType::IfcBuilding,
    IfcType::IfcPositioningElement,
    IfcType::IfcLinearElement,
    IfcType::IfcAnnotation,
    IfcType::IfcVirtualElement,
    IfcType::IfcStructuralActivity,
    IfcType::IfcStructuralItem,
    IfcType::IfcGeographicElement,
    IfcType::IfcGeotechnicalElement,
    IfcType::IfcEarthworksElement,
    IfcType::IfcReinforcingElement,
    IfcType::IfcFacility,
    IfcType::IfcFacilityPart,
    IfcType::IfcFastener,
    IfcType::IfcMechanicalFastener,
];

/// Reads an IFC file. `file` is its name in messages.
///
/// # Errors
/// Returns what is wrong, with the file and, where there is one, the line and the entity.
pub(super) fn read(file: &str, bytes: &[u8]) -> Result<MeshFile, String> {
    check_file_size(bytes).and_then(|()| check_frame(bytes)).map_err(|words| format!("{file}: {words}"))?;
    catch_unwind(|| decode(file, bytes)).unwrap_or_else(|_| Err(format!("{file}: not an IFC file: damaged entities")))
}

/// Checks the beginning, the schema and the end of a file.
fn check_frame(bytes: &[u8]) -> Result<(), String> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    if !text.starts_with(FIRST_WORDS) {
        return Err("not an IFC file (allowed: the STEP format, which begins with ISO-10303-21)".to_owned());
    }
    let known = |label: &str| SchemaVersion::from_file_schema(label).is_some();
    let declared = ifc_lite_core::declared_schema_bounded(bytes);
    if !declared.as_deref().is_some_and(known) {
        let found = declared.unwrap_or_else(|| "none".to_owned());
        return Err(format!("FILE_SCHEMA = {} (allowed: {SCHEMAS})", found.escape_default()));
    }
    let end = &bytes[bytes.len().saturating_sub(END_BYTES)..];
    if !end.windows(LAST_WORDS.len()).any(|words| words == LAST_WORDS) {
        return Err(format!("truncated: END-ISO-10303-21 is missing at the end ({} bytes)", bytes.len()));
    }
    Ok(())
}

/// Openings by the products that they cut.
type Openings = FxHashMap<u32, Vec<u32>>;

/// Position of an entity in a file, bytes.
#[derive(Debug, Clone, Copy)]
struct Place {
    id: u32,
    start: usize,
    end: usize,
}

fn decode(file: &str, bytes: &[u8]) -> Result<MeshFile, String> {
    let mut decoder = EntityDecoder::new(bytes).with_strict_reals();
    let mut relations = Relations::default();
    let products = scan(file, bytes, &mut decoder, &mut relations)?;
    let router = router(bytes, &mut decoder).map_err(|words| format!("{file}: {words}"))?;
    let openings = void_index_from_content(bytes, &mut decoder);
    let mut reader = ProductReader { file, bytes, decoder, router, relations, triangles: 0, skipped: BTreeMap::new() };
    let mut content = MeshFile::default();
    for (k, place) in products.iter().enumerate() {
        if reader.decoder.cache_size() > MAX_CACHED_ENTITIES {
            reader.decoder.clear_entity_cache();
        }
        let entity = reader.decoder.decode_at_with_id(place.id, place.start, place.end);
        let entity = entity.map_err(|error| format!("{}: {error}", reader.at(*place)))?;
        let name = product_name(&entity, k);
        if !reader.is_part(&entity) {
            continue;
        }
        let label = format!("#{} {} {name}", place.id, entity.ifc_type.name());
        let (mesh, notes) = reader.mesh(&entity, &openings);
        content.notes.extend(notes.into_iter().map(|note| format!("{label}: {note}")));
        let mesh = mesh.map_err(|words| format!("{file}:{}: {label}: {words}", line(bytes, place.start)))?;
        if mesh.triangles.is_empty() {
            continue;
        }
        let element = reader.element(&entity);
        content.notes.extend(reader.relations.take_problems().map(|words| format!("{label}: {words}")));
        content.nodes.push(MeshNode { name, element, is_surface: false, mesh, colors: Vec::new(), ignored_primitives: 0 });
        if content.nodes.len() > MAX_NODES {
            return Err(format!("{file}: more than {MAX_NODES} products with a body"));
        }
    }
    content.skipped = reader.skipped.iter().map(|(class, count)| format!("{count} {class}")).collect();
    if content.nodes.is_empty() {
        let notes: Vec<String> = content.notes.iter().take(NOTES_IN_ERROR).map(|note| format!("; {note}")).collect();
        return Err(format!("{file}: no triangles (allowed: at least one product with a body){}", notes.concat()));
    }
    Ok(content)
}

/// Finds the products with a shape, and the relations between entities.
fn scan(file: &str, bytes: &[u8], decoder: &mut EntityDecoder, relations: &mut Relations) -> Result<Vec<Place>, String> {
    let mut products = Vec::new();
    let mut ids = FxHashSet::default();
    let mut scanner = EntityScanner::new(bytes);
    while let Some((id, class, start, end)) = scanner.next_entity() {
        // The library caches decoded entities by number and could return one in place of the other.
        if !ids.insert(id) {
            return Err(format!("{file}:{}: #{id}: occurs twice (allowed: once)", line(bytes, start)));
        }
        if is_geometry_job(class, &bytes[start..end]) {
            products.push(Place { id, start, end });
            relations.has_girders |= GIRDERS.contains(&class);
        } else if Relations::takes(class) {
            let entity = decoder.decode_at_uncached(start, end);
            let entity = entity.map_err(|error| format!("{file}:{}: #{id}: {error}", line(bytes, start)))?;
            relations.add(&entity);
        }
    }
    if let Some(start) = scanner.malformed_record_start() {
        return Err(format!("{file}:{}: an entity without an end (allowed: #number=NAME(...);)", line(bytes, start)));
    }
    if let Some(start) = scanner.skipped_oversized_id_starts().first() {
        return Err(format!(
            "{file}:{}: the number of an entity is too large (allowed: at most {})",
            line(bytes, *start),
            u32::MAX
        ));
    }
    Ok(products)
}

/// Returns the library's converter of bodies. Far from the origin, it computes relative to a point near the products, and each mesh has a
/// 64-bit origin of its own, so that its 32-bit positions remain exact.
fn router(bytes: &[u8], decoder: &mut EntityDecoder) -> Result<GeometryRouter, String> {
    let with_units = GeometryRouter::with_units(bytes, decoder);
    if with_units.length_unit_refused() {
        return Err("IfcUnitAssignment: the length unit has no valid factor to meters".to_owned());
    }
    let offset = with_units.detect_rtc_offset_for_file(bytes, decoder);
    let rtc_offset = offset.map_or((0.0, 0.0, 0.0), RtcVerdict::offset);
    let unit_scale = with_units.unit_scale();
    Ok(GeometryRouter::from_config(RouterConfig { unit_scale, rtc_offset, local_frame: Some(true), ..RouterConfig::default() }))
}

/// Returns the line of a byte, from 1.
fn line(bytes: &[u8], at: usize) -> usize {
    bytes[..at.min(bytes.len())].iter().filter(|byte| **byte == b'\n').count() + 1
}

/// Returns the name of a product; its global ID if it has none.
fn product_name(entity: &DecodedEntity, index: usize) -> String {
    let text = |attribute: usize| entity.get_string(attribute).map(str::trim).filter(|text| !text.is_empty());
    clean_name(text(NAME).or_else(|| text(GLOBAL_ID)).unwrap_or_default(), index)
}

struct ProductReader<'a> {
    file: &'a str,
    bytes: &'a [u8],
    decoder: EntityDecoder<'a>,
    router: GeometryRouter,
    relations: Relations,
    triangles: usize,
    /// Number of products by the names of classes that are no part of a bridge.
    skipped: BTreeMap<String, usize>,
}

impl ProductReader<'_> {
    /// Returns the file and the line of an entity.
    fn at(&self, place: Place) -> String {
        format!("{}:{}: #{}", self.file, line(self.bytes, place.start), place.id)
    }

    /// Returns whether a product can be a part of a bridge, and counts the others.
    fn is_part(&mut self, entity: &DecodedEntity) -> bool {
        let class = &entity.ifc_type;
        if class.is_subtype_of(IfcType::IfcFeatureElementSubtraction) || class.is_subtype_of(IfcType::IfcPort) {
            return false;
        }
        let is_other = OTHER_CLASSES.iter().any(|other| class.is_subtype_of(other.clone()));
        let has_shape = entity.get(slot::IfcProduct::REPRESENTATION.index()).is_some_and(|shape| !shape.is_null());
        if is_other && has_shape {
            *self.skipped.entry(class.name().to_owned()).or_default() += 1;
        }
        !is_other && has_shape
    }

    /// Returns the triangles of a product, and notes on what the library could not convert.
    fn mesh(&mut self, entity: &DecodedEntity, openings: &Openings) -> (Result<Mesh, String>, Vec<String>) {
        let Self { router, decoder, .. } = self;
        // A panic leaves only caches behind, which the library fills again.
        let parts = catch_unwind(AssertUnwindSafe(|| router.process_element_with_voids_parts(entity, decoder, openings)));
        let mut notes = Vec::new();
        let left_out = self.router.take_unsupported_items();
        if !left_out.is_empty() {
            notes.push(format!("left out: {}", ifc_lite_geometry::format_unsupported_breakdown(&left_out)));
        }
        let failed: usize = self.router.take_csg_failures().values().map(Vec::len).sum();
        if failed > 0 {
            let cut = openings.get(&entity.id).map_or(0, Vec::len);
            let plural = if failed == 1 { "" } else { "s" };
            notes.push(format!("{failed} cut{plural} failed (openings: {cut}): compare the part with the model"));
        }
        let parts = match parts {
            Ok(Ok(parts)) => parts,
            Ok(Err(error)) => {
                notes.push(format!("left out: {error}"));
                Vec::new()
            }
            Err(_) => {
                notes.push("left out: its geometry can't be computed".to_owned());
                Vec::new()
            }
        };
        if notes.is_empty() && parts.iter().all(|part| part.indices.is_empty()) {
            notes.push("left out: no triangles".to_owned());
        }
        let (x, y, z) = self.router.rtc_offset();
        (self.count(&parts).and_then(|()| joined(&parts, [x, y, z])), notes)
    }

    /// Checks the number of triangles of all products so far.
    fn count(&mut self, parts: &[ifc_lite_geometry::Mesh]) -> Result<(), String> {
        let sum = |length: fn(&ifc_lite_geometry::Mesh) -> usize| parts.iter().map(length).sum::<usize>() / 3;
        self.triangles += sum(|part| part.indices.len()).max(sum(|part| part.positions.len()));
        if self.triangles > MAX_TRIANGLES {
            return Err(format!("more than {MAX_TRIANGLES} triangles or vertices in the file"));
        }
        Ok(())
    }

    /// Returns the element of a product: by its property, or by its class.
    fn element(&mut self, entity: &DecodedEntity) -> Option<u16> {
        let tagged = self.relations.tag(entity.id, &mut self.decoder);
        tagged.or_else(|| element_of(&self.relations.traits(entity, &mut self.decoder)).map(|element| element.number()))
    }
}

/// Returns the meshes of a product as one, in the file's axes.
fn joined(parts: &[ifc_lite_geometry::Mesh], offset: Point) -> Result<Mesh, String> {
    let mut mesh = Mesh::default();
    for part in parts {
        let first = mesh.vertices_m.len();
        for own in part.positions.chunks_exact(3) {
            // Coordinates of a map may be larger than those in it are allowed to be.
            let near = [0, 1, 2].map(|k: usize| f64::from(own[k]) + part.origin[k]);
            check_vertex(mesh.vertices_m.len(), near)?;
            mesh.vertices_m.push(add_scaled(near, offset, 1.0));
        }
        let count = mesh.vertices_m.len() - first;
        if let Some(index) = part.indices.iter().find(|index| **index as usize >= count) {
            return Err(format!("index {index} (allowed: 0 to {})", count as i64 - 1));
        }
        mesh.triangles.extend(part.indices.chunks_exact(3).map(|corners| [0, 1, 2].map(|k: usize| first as u32 + corners[k])));
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::RandomStream;

    const MUTANTS: usize = 300;
    const METERS: &str = "$";
    const MILLIMETERS: &str = ".MILLI.";

    /// Returns a file with this prefix of its unit of length and these entities, from number 20 on.
    fn file(prefix: &str, entities: &str) -> String {
        format!(
            "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('IFC4X3_ADD2'));\n\
             ENDSEC;\nDATA;\n#1=IFCPROJECT('project',$,'p',$,$,$,$,(#3),#2);\n#2=IFCUNITASSIGNMENT((#5));\n\
             #3=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,#4,$);\n#4=IFCAXIS2PLACEMENT3D(#6,$,$);\n\
             #5=IFCSIUNIT(*,.LENGTHUNIT.,{prefix},.METRE.);\n#6=IFCCARTESIANPOINT((0.,0.,0.));\n#7=IFCDIRECTION((0.,0.,1.));\n\
             #8=IFCDIRECTION((0.,1.,0.));\n{entities}ENDSEC;\nEND-ISO-10303-21;\n"
        )
    }

    /// A product with a box as its body: in the middle of its lower side is the origin of its placement.
    struct BoxProduct {
        /// Number of the product; its other entities have the next eight.
        id: u32,
        /// Class, and the attributes after the representation.
        class: (&'static str, &'static str),
        name: &'static str,
        place: Point,
        /// Direction of the x axis.
        along: &'static str,
        size: Point,
    }

    impl BoxProduct {
        fn new(id: u32, class: (&'static str, &'static str), name: &'static str, place: Point, size: Point) -> Self {
            Self { id, class, name, place, along: "$", size }
        }

        fn text(&self) -> String {
            let Self { id, class: (class, rest), name, place: [x, y, z], along, size: [a, b, c] } = self;
            let [placement, axes, point, shape, body, solid, profile] = [1, 2, 3, 4, 5, 6, 7].map(|k| id + k);
            format!(
                "#{id}={class}('guid-{id}',$,{name},$,$,#{placement},#{shape}{rest});\n\
                 #{placement}=IFCLOCALPLACEMENT($,#{axes});\n#{axes}=IFCAXIS2PLACEMENT3D(#{point},$,{along});\n\
                 #{point}=IFCCARTESIANPOINT(({x:?},{y:?},{z:?}));\n#{shape}=IFCPRODUCTDEFINITIONSHAPE($,$,(#{body}));\n\
                 #{body}=IFCSHAPEREPRESENTATION(#3,'Body','SweptSolid',(#{solid}));\n\
                 #{solid}=IFCEXTRUDEDAREASOLID(#{profile},#4,#7,{c:?});\n\
                 #{profile}=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,{a:?},{b:?});\n"
            )
        }
    }

    const COLUMN: (&str, &str) = ("IFCCOLUMN", ",$,.COLUMN.");
    const SLAB: (&str, &str) = ("IFCSLAB", ",$,.FLOOR.");

    fn content(entities: &str) -> MeshFile {
        read("a.ifc", file(METERS, entities).as_bytes()).unwrap()
    }

    #[track_caller]
    fn assert_bounds(node: &MeshNode, low: Point, high: Point, tolerance_m: f64) {
        let (found_low, found_high) = node.mesh.bounds().unwrap();
        let near = |a: Point, b: Point| a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance_m);
        assert!(near(found_low, low) && near(found_high, high), "{found_low:?} {found_high:?}");
    }

    #[test]
    fn exact_parts_are_in_meters_whatever_the_unit() {
        let column = |unit: f64| BoxProduct {
            along: "#8",
            ..BoxProduct::new(20, COLUMN, "'column 1'", [10.0 * unit, 2.0 * unit, -3.0 * unit], [4.0 * unit, unit, 6.0 * unit])
        };
        for (prefix, unit) in [(METERS, 1.0), (MILLIMETERS, 1000.0)] {
            let content = read("a.ifc", file(prefix, &column(unit).text()).as_bytes()).unwrap();
            let [node] = &content.nodes[..] else { panic!("{content:?}") };
            assert_eq!((node.name.as_str(), node.element, &content.notes[..]), ("column 1", None, &[][..]));
            assert_bounds(node, [9.5, 0.0, -3.0], [10.5, 4.0, 3.0], 1e-6);
            assert!((node.mesh.volume_m3() - 24.0).abs() < 1e-5, "{}", node.mesh.volume_m3());
        }
    }

    #[test]
    fn exact_openings_are_cut_out_and_are_no_parts() {
        let slab = BoxProduct::new(20, SLAB, "'deck'", [0.0, 0.0, 5.0], [10.0, 4.0, 0.25]);
        let drain = BoxProduct::new(40, ("IFCOPENINGELEMENT", ",$,.OPENING."), "'drain'", [2.0, 1.0, 4.0], [0.5, 0.5, 2.0]);
        let cut = "#60=IFCRELVOIDSELEMENT('cut',$,$,$,#20,#40);\n";
        let content = content(&(slab.text() + &drain.text() + cut));
        let [node] = &content.nodes[..] else { panic!("{content:?}") };
        assert!((node.mesh.volume_m3() - 0.25 * (40.0 - 0.25)).abs() < 1e-5, "{}", node.mesh.volume_m3());
        assert!(content.skipped.is_empty() && content.notes.is_empty(), "{content:?}");
    }

    #[test]
    fn exact_map_coordinates_keep_their_micrometers() {
        let far = [504_000.25, 4_475_000.125, 180.0];
        let placed = content(&BoxProduct::new(20, COLUMN, "'a'", far, [0.02, 1.0, 6.0]).text());
        assert_bounds(&placed.nodes[0], [far[0] - 0.01, far[1] - 0.5, 180.0], [far[0] + 0.01, far[1] + 0.5, 186.0], 1e-6);
        // Coordinates of a map in the body itself.
        let corner = |x: f64, y: f64, z: f64| format!("({:?},{:?},{:?})", far[0] + x, far[1] + y, far[2] + z);
        let points = [corner(0.0, 0.0, 0.0), corner(0.02, 0.0, 0.0), corner(0.0, 1.0, 0.0), corner(0.0, 0.0, 6.0)].join(",");
        let body = format!(
            "#20=IFCBUILDINGELEMENTPROXY('guid',$,'a',$,$,$,#21,$,$);\n#21=IFCPRODUCTDEFINITIONSHAPE($,$,(#22));\n\
             #22=IFCSHAPEREPRESENTATION(#3,'Body','Tessellation',(#23));\n\
             #23=IFCTRIANGULATEDFACESET(#24,$,.T.,((1,3,2),(1,2,4),(2,3,4),(1,4,3)),$);\n#24=IFCCARTESIANPOINTLIST3D(({points}),$);\n"
        );
        assert_bounds(&content(&body).nodes[0], far, [far[0] + 0.02, far[1] + 1.0, 186.0], 1e-6);
    }

    #[test]
    fn exact_names_are_those_of_products_or_global_ids() {
        let text = [("$", 20), ("' '", 40), ("'Tr\\X\\E4ger*'", 60)]
            .map(|(name, id)| BoxProduct::new(id, COLUMN, name, [0.0; 3], [1.0; 3]).text())
            .concat();
        let names: Vec<String> = content(&text).nodes.into_iter().map(|node| node.name).collect();
        assert_eq!(names, ["guid-20", "guid-40", "Träger-"]);
    }

    #[test]
    fn exact_products_that_are_no_part_of_a_bridge_are_counted() {
        let text = [(COLUMN, 20), (("IFCREINFORCINGBAR", ",$,$,$,$,$,$,$"), 40), (("IFCTENDON", ",$,$,$,$,$,$,$,$,$"), 60)]
            .map(|(class, id)| BoxProduct::new(id, class, "'a'", [0.0; 3], [1.0; 3]).text())
            .concat();
        let content = content(&(text + "#80=IFCSITE('site',$,'without a shape',$,$,$,$,$,$,$,$,$,$,$);\n"));
        assert_eq!(
            (content.nodes.len(), &content.skipped[..]),
            (1, &["1 IfcReinforcingBar".to_owned(), "1 IfcTendon".to_owned()][..])
        );
    }

    #[test]
    fn exact_elements_come_from_properties_before_classes() {
        let columns = [20, 40, 60, 80, 100].map(|id| BoxProduct::new(id, COLUMN, "$", [0.0; 3], [1.0; 3]).text()).concat();
        let relations = "#200=IFCMATERIAL('C30/37',$,$);\n#201=IFCRELASSOCIATESMATERIAL('m',$,$,$,(#20,#40,#60,#80),#200);\n\
             #202=IFCPROPERTYSINGLEVALUE('element',$,IFCINTEGER(210),$);\n#203=IFCPROPERTYSET('s',$,'Inspection',$,(#202));\n\
             #204=IFCRELDEFINESBYPROPERTIES('r',$,$,$,(#40),#203);\n\
             #205=IFCPROPERTYSINGLEVALUE('element',$,IFCLABEL('207'),$);\n#206=IFCPROPERTYSET('t',$,'Inspection',$,(#205));\n\
             #207=IFCCOLUMNTYPE('k',$,'kind',$,$,(#206),$,$,$,.COLUMN.);\n#208=IFCRELDEFINESBYTYPE('d',$,$,$,(#60),#207);\n\
             #209=IFCELEMENTASSEMBLY('x',$,'pier',$,$,$,$,$,$,.PIER.);\n#210=IFCRELAGGREGATES('g',$,$,$,#209,(#80));\n\
             #211=IFCRELAGGREGATES('h',$,$,$,#80,(#209));\n\
             #212=IFCRELDEFINESBYPROPERTIES('q',$,$,$,(#209),#203);\n";
        let found: Vec<Option<u16>> = content(&(columns + relations)).nodes.iter().map(|node| node.element).collect();
        assert_eq!(found, [Some(205), Some(210), Some(207), Some(210), None]);
    }

    #[test]
    fn exact_types_and_parts_of_the_bridge_determine_elements() {
        let bearing = BoxProduct::new(20, ("IFCBEARING", ",$,.NOTDEFINED."), "$", [0.0; 3], [1.0; 3]).text();
        let slab = BoxProduct::new(40, SLAB, "$", [0.0; 3], [1.0; 3]).text();
        let beam = BoxProduct::new(60, ("IFCBEAM", ",$,.GIRDER_SEGMENT."), "$", [0.0; 3], [1.0; 3]).text();
        let relations = "#200=IFCBEARINGTYPE('k',$,'pads',$,$,$,$,$,$,.ELASTOMERIC.);\n#201=IFCRELDEFINESBYTYPE('d',$,$,$,(#20),#200);\n\
             #202=IFCBRIDGEPART('p',$,'deck',$,$,$,$,$,.ELEMENT.,.NOTDEFINED.,.DECK.);\n\
             #203=IFCRELCONTAINEDINSPATIALSTRUCTURE('c',$,$,$,(#40),#202);\n\
             #204=IFCMATERIAL('Concrete',$,$);\n#205=IFCMATERIALLAYER(#204,250.,$,$,$,$,$);\n\
             #206=IFCMATERIALLAYERSET((#205),$,$);\n#207=IFCMATERIALLAYERSETUSAGE(#206,.AXIS3.,.POSITIVE.,0.,$);\n\
             #208=IFCRELASSOCIATESMATERIAL('m',$,$,$,(#40),#207);\n";
        let found: Vec<Option<u16>> =
            content(&(bearing + &slab + &beam + relations)).nodes.iter().map(|node| node.element).collect();
        assert_eq!(found, [Some(310), Some(12), None]);
    }

    #[test]
    fn exact_old_schemas_are_read() {
        let text = file(MILLIMETERS, &BoxProduct::new(20, ("IFCCOLUMN", ",$"), "'a'", [0.0; 3], [1000.0; 3]).text());
        for schema in ["IFC2X3", "IFC4"] {
            let content = read("a.ifc", text.replace("IFC4X3_ADD2", schema).as_bytes()).unwrap();
            assert_bounds(&content.nodes[0], [-0.5, -0.5, 0.0], [0.5, 0.5, 1.0], 1e-6);
        }
    }

    #[test]
    fn regress_bad_files_name_the_file_the_line_and_the_cause() {
        let column = BoxProduct::new(20, COLUMN, "'a'", [0.0; 3], [1.0; 3]).text();
        let good = file(METERS, &column);
        let error = |text: &str| read("a.ifc", text.as_bytes()).unwrap_err();
        assert_eq!(error("solid a\n"), "a.ifc: not an IFC file (allowed: the STEP format, which begins with ISO-10303-21)");
        assert_eq!(error(&good.replace("IFC4X3_ADD2", "AP242")), format!("a.ifc: FILE_SCHEMA = AP242 (allowed: {SCHEMAS})"));
        let cut = &good[..good.len() - 30];
        assert_eq!(error(cut), format!("a.ifc: truncated: END-ISO-10303-21 is missing at the end ({} bytes)", cut.len()));
        assert_eq!(error(&file(METERS, "")), "a.ifc: no triangles (allowed: at least one product with a body)");
        assert_eq!(error(&file(METERS, &(column.clone() + &column))), "a.ifc:24: #20: occurs twice (allowed: once)");
        let drain = BoxProduct::new(40, ("IFCOPENINGELEMENT", ",$,.OPENING."), "'drain'", [0.0; 3], [0.5, 0.5, 2.0]).text();
        let cut = "#40=IFCRELVOIDSELEMENT('cut',$,$,$,#20,#40);\n";
        assert_eq!(error(&file(METERS, &(column.clone() + &drain + cut))), "a.ifc:32: #40: occurs twice (allowed: once)");
        let unit = good.replace(
            "#5=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);",
            "#5=IFCCONVERSIONBASEDUNIT(*,.LENGTHUNIT.,'ELL',#9);\n#9=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(-1.),$);",
        );
        assert_eq!(error(&unit), "a.ifc: IfcUnitAssignment: the length unit has no valid factor to meters");
        let broken = error(&good.replace("#20=IFCCOLUMN('guid-20'", "#20=IFCCOLUMN(('guid-20'"));
        assert!(broken.starts_with("a.ifc:"), "{broken}");
    }

    #[test]
    fn regress_properties_of_other_programs_are_noted() {
        let column = BoxProduct::new(20, COLUMN, "'a'", [0.0; 3], [1.0; 3]).text();
        let tag = "#60=IFCPROPERTYSINGLEVALUE('element',$,IFCLABEL('Wall-03'),$);\n#61=IFCPROPERTYSET('s',$,'Other',$,(#60));\n\
             #62=IFCRELDEFINESBYPROPERTIES('r',$,$,$,(#20),#61);\n";
        let content = content(&(column + tag));
        assert_eq!((content.nodes.len(), content.nodes[0].element), (1, None));
        assert_eq!(content.notes, ["#20 IfcColumn a: property #60: element = \"Wall-03\" (allowed: 1 to 999)"]);
    }

    #[test]
    fn regress_a_property_of_another_program_is_noted_once_and_the_class_determines_the_elements() {
        let columns = [20, 40].map(|id| BoxProduct::new(id, COLUMN, "$", [0.0; 3], [1.0; 3]).text()).concat();
        let relations = "#60=IFCPROPERTYSINGLEVALUE('element',$,IFCLABEL('Wall-03'),$);\n#61=IFCPROPERTYSET('s',$,'Other',$,(#60));\n\
             #62=IFCRELDEFINESBYPROPERTIES('r',$,$,$,(#20,#40),#61);\n#63=IFCMATERIAL('C30/37',$,$);\n\
             #64=IFCRELASSOCIATESMATERIAL('m',$,$,$,(#20,#40),#63);\n";
        let content = content(&(columns + relations));
        assert_eq!(content.nodes.iter().map(|node| node.element).collect::<Vec<_>>(), [Some(205); 2]);
        assert_eq!(content.notes.len(), 1, "{:?}", content.notes);
    }

    #[test]
    fn regress_long_lists_on_both_sides_of_a_relation_take_little_memory() {
        // Stored as pairs, these would be 10^10 values.
        const LENGTH: usize = 100_000;
        let column = BoxProduct::new(20, COLUMN, "'a'", [0.0; 3], [1.0; 3]).text();
        let products = (0..LENGTH).map(|k| format!("#{}", 1000 + k)).collect::<Vec<_>>().join(",");
        let content = content(&format!("{column}#62=IFCRELDEFINESBYPROPERTIES('r',$,$,$,({products}),({products}));\n"));
        assert_eq!((content.nodes.len(), content.nodes[0].element), (1, None));
    }

    #[test]
    fn exact_a_slab_in_a_deck_without_girders_is_no_deck() {
        let slab = BoxProduct::new(40, SLAB, "$", [0.0; 3], [1.0; 3]).text();
        let relations = "#202=IFCBRIDGEPART('p',$,'deck',$,$,$,$,$,.ELEMENT.,.NOTDEFINED.,.DECK.);\n\
             #203=IFCRELCONTAINEDINSPATIALSTRUCTURE('c',$,$,$,(#40),#202);\n\
             #204=IFCMATERIAL('Concrete',$,$);\n#208=IFCRELASSOCIATESMATERIAL('m',$,$,$,(#40),#204);\n";
        let beam = BoxProduct::new(60, ("IFCBEAM", ",$,.GIRDER_SEGMENT."), "$", [0.0; 3], [1.0; 3]).text();
        assert_eq!(content(&(slab.clone() + relations)).nodes[0].element, None);
        assert_eq!(content(&(slab + &beam + relations)).nodes[0].element, Some(12));
    }

    #[test]
    fn exact_maps_with_a_zone_in_their_eastings_are_allowed() {
        let far = [32_504_000.25, 5_475_000.125, 180.0];
        let placed = content(&BoxProduct::new(20, COLUMN, "'a'", far, [0.02, 1.0, 6.0]).text());
        assert_bounds(&placed.nodes[0], [far[0] - 0.01, far[1] - 0.5, 180.0], [far[0] + 0.01, far[1] + 0.5, 186.0], 1e-6);
    }

    #[test]
    fn regress_products_without_geometry_are_noted_and_the_others_are_read() {
        let good = BoxProduct::new(20, COLUMN, "'good'", [0.0; 3], [1.0; 3]).text();
        let bad = BoxProduct::new(40, COLUMN, "'bad'", [0.0; 3], [1.0; 3]).text();
        for (from, to) in [
            // A placement relative to itself, a shape that contains itself, a missing profile, an unknown body, and numbers out of range.
            ("#41=IFCLOCALPLACEMENT($,", "#41=IFCLOCALPLACEMENT(#41,"),
            ("(#3,'Body','SweptSolid',(#46))", "(#3,'Body','SweptSolid',(#45))"),
            ("IFCEXTRUDEDAREASOLID(#47,", "IFCEXTRUDEDAREASOLID(#99,"),
            ("IFCEXTRUDEDAREASOLID(#47,", "IFCSWEPTAREABYMAGIC(#47,"),
            ("IFCRECTANGLEPROFILEDEF(.AREA.,$,$,1.0,", "IFCRECTANGLEPROFILEDEF(.AREA.,$,$,1.E999,"),
        ] {
            assert!(bad.contains(from), "{from}");
            let content = content(&(good.clone() + &bad.replace(from, to)));
            assert_eq!(content.nodes.iter().map(|node| node.name.as_str()).collect::<Vec<_>>(), ["good"], "{to}");
            assert_eq!(content.notes.len(), 1, "{to}: {:?}", content.notes);
            assert!(content.notes[0].starts_with("#40 IfcColumn bad: left out: "), "{to}: {:?}", content.notes);
        }
    }

    #[test]
    fn prop_damaged_files_are_read_or_refused() {
        let slab = BoxProduct::new(20, SLAB, "'deck'", [0.0, 0.0, 5.0], [10.0, 4.0, 0.25]);
        let drain = BoxProduct::new(40, ("IFCOPENINGELEMENT", ",$,.OPENING."), "'drain'", [2.0, 1.0, 4.0], [0.5, 0.5, 2.0]);
        let text = file(METERS, &(slab.text() + &drain.text() + "#60=IFCRELVOIDSELEMENT('cut',$,$,$,#20,#40);\n"));
        let mut random = RandomStream::new(5, "damage");
        let mut read_files = 0;
        for _ in 0..MUTANTS {
            let mut damaged = text.clone().into_bytes();
            damaged[random.below(text.len())] = b"#($9.,"[random.below(6)];
            match read("a.ifc", &damaged) {
                Ok(content) => {
                    read_files += 1;
                    let is_finite = |node: &MeshNode| node.mesh.vertices_m.iter().flatten().all(|value| value.is_finite());
                    assert!(content.nodes.iter().all(is_finite), "{}", String::from_utf8_lossy(&damaged));
                }
                Err(words) => assert!(words.starts_with("a.ifc:"), "{words}"),
            }
        }
        assert!(read_files > MUTANTS / 4 && read_files < MUTANTS, "{read_files} of {MUTANTS} are read");
    }
}
