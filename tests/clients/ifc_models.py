"""IFC bridges that ifcopenshell writes, and its own measures of their parts."""

import math

import ifcopenshell
import ifcopenshell.api.aggregate
import ifcopenshell.api.context
import ifcopenshell.api.feature
import ifcopenshell.api.geometry
import ifcopenshell.api.material
import ifcopenshell.api.pset
import ifcopenshell.api.root
import ifcopenshell.api.spatial
import ifcopenshell.api.type
import ifcopenshell.api.unit
import ifcopenshell.geom
import ifcopenshell.util.shape
import numpy

LENGTH_M, DECK_M, COLUMN_M = 30.0, (8.0, 0.25), (0.5, 7.0)
# Place of the site on the map, m, and counterclockwise turn of the bridge, degrees.
MAP_M, TURN_DEG = (504_000.0, 4_475_000.0, 180.0), 30.0
# Element of each part, by the first word of its name.
ELEMENTS = {"deck": 12, "girder": 107, "column": 205, "bearing": 310, "railing": 330, "footing": 220}


def placed(x, y, z, turn_deg=0.0):
    """Returns a placement, m."""
    matrix = numpy.eye(4)
    s, c = math.sin(math.radians(turn_deg)), math.cos(math.radians(turn_deg))
    matrix[:2, :2] = (c, -s), (s, c)
    matrix[:3, 3] = x, y, z
    return matrix


class Writer:
    """An IFC4X3 file of a slab bridge in millimeters, with z up, on a site far from the origin."""

    def __init__(self):
        self.file = ifcopenshell.file(schema="IFC4X3")
        project = self.product("IfcProject", "project")
        ifcopenshell.api.unit.assign_unit(self.file, length={"is_metric": True, "raw": "MILLIMETERS"})
        model = ifcopenshell.api.context.add_context(self.file, context_type="Model")
        self.body = ifcopenshell.api.context.add_context(
            self.file, context_type="Model", context_identifier="Body", target_view="MODEL_VIEW", parent=model
        )
        site = self.product("IfcSite", "site")
        self.bridge = self.product("IfcBridge", "bridge")
        self.deck_part = self.product("IfcBridgePart", "deck part", "DECK")
        for whole, part in ((project, site), (site, self.bridge), (self.bridge, self.deck_part)):
            ifcopenshell.api.aggregate.assign_object(self.file, products=[part], relating_object=whole)
        self.place(site, placed(*MAP_M))
        self.place(self.bridge, placed(*MAP_M, TURN_DEG))

    def product(self, kind, name, predefined=None):
        return ifcopenshell.api.root.create_entity(self.file, ifc_class=kind, name=name, predefined_type=predefined)

    def place(self, product, matrix):
        ifcopenshell.api.geometry.edit_object_placement(self.file, product=product, matrix=matrix, is_si=True)

    def material(self, product, name):
        material = ifcopenshell.api.material.add_material(self.file, name=name)
        ifcopenshell.api.material.assign_material(self.file, products=[product], material=material)

    def shape(self, item, kind):
        return self.file.createIfcShapeRepresentation(self.body, "Body", kind, [item])

    def extrusion(self, profile, height_m):
        """Returns a profile, in millimeters, that is extruded along z."""
        up = self.file.createIfcDirection((0.0, 0.0, 1.0))
        return self.shape(self.file.createIfcExtrudedAreaSolid(profile, None, up, 1000.0 * height_m), "SweptSolid")

    def box(self, x_m, y_m, z_m):
        return self.extrusion(self.file.createIfcRectangleProfileDef("AREA", None, None, 1000.0 * x_m, 1000.0 * y_m), z_m)

    def mesh(self, low, high):
        """Returns a box between two corners, m, as a face set."""
        corners = [[1000.0 * (high if k >> axis & 1 else low)[axis] for axis in range(3)] for k in range(8)]
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        indexed = [self.file.createIfcIndexedPolygonalFace([k + 1 for k in face]) for face in faces]
        points = self.file.createIfcCartesianPointList3D(corners)
        return self.shape(self.file.createIfcPolygonalFaceSet(points, True, indexed), "Tessellation")

    def add(self, product, shape, matrix, container=None):
        """Places a product in the axes of the bridge."""
        if shape:
            ifcopenshell.api.geometry.assign_representation(self.file, product=product, representation=shape)
        ifcopenshell.api.spatial.assign_container(self.file, products=[product], relating_structure=container or self.bridge)
        self.place(product, placed(*MAP_M, TURN_DEG) @ matrix)
        return product


def add_superstructure(writer):
    file = writer.file
    deck = writer.add(writer.product("IfcSlab", "deck"), writer.box(LENGTH_M, *DECK_M), placed(0, 0, 9.0), writer.deck_part)
    writer.material(deck, "Concrete C40/50")
    drain = writer.product("IfcOpeningElement", "drain")
    ifcopenshell.api.geometry.assign_representation(file, product=drain, representation=writer.box(0.5, 0.5, 1.0))
    ifcopenshell.api.feature.add_feature(file, feature=drain, element=deck)
    writer.place(drain, placed(*MAP_M, TURN_DEG) @ placed(6.0, 3.0, 8.5))
    profile = file.createIfcIShapeProfileDef("AREA", None, None, 400.0, 1200.0, 20.0, 20.0)
    along = numpy.array([(0, 0, 1, 0), (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 0, 1)], dtype=float)
    for k, y in enumerate((-2.0, 2.0)):
        girder = writer.product("IfcBeam", f"girder-{k + 1}", "GIRDER_SEGMENT")
        writer.add(girder, writer.extrusion(profile, LENGTH_M), placed(-LENGTH_M / 2, y, 8.4) @ along)
        writer.material(girder, "S355")
        properties = ifcopenshell.api.pset.add_pset(file, product=girder, name="Inspection")
        ifcopenshell.api.pset.edit_pset(file, pset=properties, properties={"element": 107})
        railing = writer.product("IfcRailing", f"railing-{k + 1}", "GUARDRAIL")
        side = 1.95 * y
        writer.add(railing, writer.mesh((-LENGTH_M / 2, side - 0.05, 9.25), (LENGTH_M / 2, side + 0.05, 10.35)), numpy.eye(4))
        writer.material(railing, "Galvanized steel")


def add_substructure(writer):
    file = writer.file
    radius, height = COLUMN_M
    kind = writer.product("IfcBearingType", "pad", "ELASTOMERIC")
    ifcopenshell.api.geometry.assign_representation(file, product=kind, representation=writer.box(0.5, 0.6, 0.2))
    for k, (x, y) in enumerate((x, y) for x in (-12.0, 12.0) for y in (-2.0, 2.0)):
        column = writer.product("IfcColumn", f"column-{k + 1}", "COLUMN")
        circle = file.createIfcCircleProfileDef("AREA", None, None, 1000.0 * radius)
        writer.add(column, writer.extrusion(circle, height), placed(x, y, 0.6))
        bearing = writer.product("IfcBearing", f"bearing-{k + 1}")
        ifcopenshell.api.type.assign_type(file, related_objects=[bearing], relating_type=kind)
        writer.add(bearing, None, placed(x, y, 7.6, 15.0 * k))
        footing = writer.product("IfcFooting", f"footing-{k + 1}", "PAD_FOOTING")
        writer.add(footing, writer.mesh((x - 1.5, y - 1.5, 0.0), (x + 1.5, y + 1.5, 0.6)), numpy.eye(4))
        for product in (column, footing):
            writer.material(product, "Stahlbeton C30/37")
    bar = writer.product("IfcReinforcingBar", "bar")
    writer.add(bar, writer.box(0.02, 0.02, 5.0), placed(-12.0, -2.0, 1.0))


def write_bridge(target):
    """Writes the bridge, and returns its file in memory."""
    writer = Writer()
    add_superstructure(writer)
    add_substructure(writer)
    writer.file.write(str(target))
    return writer.file


def measures(file):
    """Returns the volume and the extent of each part in the axes of the bridge, as ifcopenshell computes them, m. Circles are fine polygons."""
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", False)
    settings.set("mesher-linear-deflection", 1e-4)
    found = {}
    to_bridge = numpy.linalg.inv(placed(*MAP_M, TURN_DEG))
    for product in file.by_type("IfcBuiltElement"):
        shape = ifcopenshell.geom.create_shape(settings, product)
        vertices = ifcopenshell.util.shape.get_vertices(shape.geometry)
        matrix = to_bridge @ ifcopenshell.util.shape.get_shape_matrix(shape)
        placed_vertices = vertices @ matrix[:3, :3].T + matrix[:3, 3]
        found[product.Name] = ifcopenshell.util.shape.get_volume(shape.geometry), placed_vertices.min(axis=0), placed_vertices.max(axis=0)
    return found
