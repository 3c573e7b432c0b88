//! Relations between the entities of an IFC file: what a product is part of, its type, its materials and its properties.

use super::ifc_elements::{Location, Material, Traits, location, material};
use ifc_lite_core::{AttributeValue, DecodedEntity, EntityDecoder, IfcType};
use std::collections::{BTreeMap, BTreeSet};

/// Name of the property with the number of the bridge element.
const ELEMENT_PROPERTY: &str = "element";
/// Attributes of all relations: what is related (or, in those of parts, the whole), and what it is related to (or the parts).
const FIRST_END: usize = 4;
const SECOND_END: usize = 5;
/// Attributes of property sets, of the property sets of types, and of properties and materials.
const HAS_PROPERTIES: usize = 4;
const TYPE_PROPERTY_SETS: usize = 5;
const NAME: usize = 0;
const NOMINAL_VALUE: usize = 2;
const CATEGORY: usize = 2;
/// Maximum number of assemblies and structures around a product, and of entities that state its material (estimate: far more than any
/// program writes).
const MAX_DEPTH: usize = 100;
const MAX_MATERIALS: usize = 1000;

/// The relations that determine the elements of products.
#[derive(Debug, Default)]
pub(super) struct Relations {
    /// Whether the file has girders, on which a deck rests.
    pub(super) has_girders: bool,
    /// The assembly of a part.
    assemblies: BTreeMap<u32, u32>,
    /// The spatial structure that contains a product.
    structures: BTreeMap<u32, u32>,
    types: BTreeMap<u32, u32>,
    materials: BTreeMap<u32, u32>,
    /// Sets of properties that products share, and their indices by product.
    shared_sets: Vec<Vec<u32>>,
    property_sets: BTreeMap<u32, Vec<usize>>,
    /// Element numbers that were found before, by property set and by product, type or structure.
    tags_of_sets: BTreeMap<u32, Option<u16>>,
    tags: BTreeMap<u32, Option<u16>>,
    /// Materials that were found before, by the entity that a product refers to.
    found_materials: BTreeMap<u32, Option<Material>>,
    /// Properties without an element number that were found and not yet taken.
    problems: Vec<String>,
}

impl Relations {
    /// Returns whether a class of entities, in capitals, is a relation that is needed.
    pub(super) fn takes(class: &str) -> bool {
        matches!(
            IfcType::from_str(class),
            IfcType::IfcRelAggregates
                | IfcType::IfcRelNests
                | IfcType::IfcRelContainedInSpatialStructure
                | IfcType::IfcRelDefinesByType
                | IfcType::IfcRelDefinesByProperties
                | IfcType::IfcRelAssociatesMaterial
        )
    }

    /// Adds a relation.
    pub(super) fn add(&mut self, relation: &DecodedEntity) {
        let refs = |attribute: usize| relation.get_refs(attribute).unwrap_or_default();
        let (first, second) = (refs(FIRST_END), refs(SECOND_END));
        let map = match relation.ifc_type {
            IfcType::IfcRelAggregates | IfcType::IfcRelNests => {
                self.assemblies.extend(second.iter().filter_map(|part| Some((*part, *first.first()?))));
                return;
            }
            IfcType::IfcRelDefinesByProperties => {
                let index = self.shared_sets.len();
                self.shared_sets.push(second);
                let products: BTreeSet<u32> = first.into_iter().collect();
                products.into_iter().for_each(|id| self.property_sets.entry(id).or_default().push(index));
                return;
            }
            IfcType::IfcRelContainedInSpatialStructure => &mut self.structures,
            IfcType::IfcRelDefinesByType => &mut self.types,
            _ => &mut self.materials,
        };
        map.extend(first.iter().filter_map(|id| Some((*id, *second.first()?))));
    }

    /// Returns a product, its assembly or structure, and so on.
    fn ancestors(&self, id: u32) -> Vec<u32> {
        let mut chain = vec![id];
        while let Some(next) = chain.last().and_then(|last| self.assemblies.get(last).or_else(|| self.structures.get(last))) {
            if chain.len() > MAX_DEPTH || chain.contains(next) {
                break;
            }
            chain.push(*next);
        }
        chain
    }

    /// Takes the problems of the properties that were read since the last call: the entity and the value.
    pub(super) fn take_problems(&mut self) -> impl Iterator<Item = String> + use<> {
        std::mem::take(&mut self.problems).into_iter()
    }

    /// Returns the element number in the properties of a product, of its type, or of an assembly or structure around it.
    pub(super) fn tag(&mut self, id: u32, decoder: &mut EntityDecoder) -> Option<u16> {
        self.ancestors(id).into_iter().find_map(|ancestor| {
            let known = self.tags.get(&ancestor).copied();
            let tag = known.unwrap_or_else(|| self.own_tag(ancestor, decoder));
            self.tags.insert(ancestor, tag);
            tag
        })
    }

    /// Returns the element number in the properties of an entity, or of its type.
    fn own_tag(&mut self, id: u32, decoder: &mut EntityDecoder) -> Option<u16> {
        let indices = self.property_sets.get(&id).into_iter().flatten();
        let mut sets: Vec<u32> = indices.filter_map(|index| self.shared_sets.get(*index)).flatten().copied().collect();
        if let Some(kind) = self.types.get(&id).and_then(|kind| decoder.decode_by_id(*kind).ok()) {
            sets.extend(kind.get_refs(TYPE_PROPERTY_SETS).unwrap_or_default());
        }
        let Self { tags_of_sets, problems, .. } = self;
        let mut read = |set: u32| {
            tag_in(set, decoder).unwrap_or_else(|words| {
                problems.push(words);
                None
            })
        };
        sets.into_iter().find_map(|set| *tags_of_sets.entry(set).or_insert_with(|| read(set)))
    }

    /// Returns what determines the element of a product without a number of its own.
    pub(super) fn traits(&mut self, entity: &DecodedEntity, decoder: &mut EntityDecoder) -> Traits {
        let chain = self.ancestors(entity.id);
        let around = chain.iter().skip(1).find_map(|id| self.location(*id, decoder));
        Traits {
            class: entity.ifc_type.clone(),
            kind: self.kind(entity, decoder),
            location: around,
            material: self.material(entity.id, decoder),
            has_girders: self.has_girders,
        }
    }

    /// Returns the predefined type of a product or, without one, of its type.
    fn kind(&self, entity: &DecodedEntity, decoder: &mut EntityDecoder) -> Option<String> {
        predefined_type(entity, decoder).or_else(|| {
            let kind = decoder.decode_by_id(*self.types.get(&entity.id)?).ok()?;
            predefined_type(&kind, decoder)
        })
    }

    fn location(&self, id: u32, decoder: &mut EntityDecoder) -> Option<Location> {
        let entity = decoder.decode_by_id(id).ok()?;
        matches!(entity.ifc_type, IfcType::IfcBridgePart | IfcType::IfcElementAssembly).then_some(())?;
        location(&self.kind(&entity, decoder)?)
    }

    /// Returns the material of a product or, without one, of its type; `None` if there are several, or unknown ones.
    fn material(&mut self, id: u32, decoder: &mut EntityDecoder) -> Option<Material> {
        let by_type = || self.materials.get(self.types.get(&id)?);
        let first = *self.materials.get(&id).or_else(by_type)?;
        *self.found_materials.entry(first).or_insert_with(|| only_material(first, decoder))
    }
}

/// Returns the material of all entities that a material, its layers or its constituents consist of; `None` if they differ, one is
/// unknown, or there are too many.
fn only_material(first: u32, decoder: &mut EntityDecoder) -> Option<Material> {
    let mut open = vec![first];
    let mut seen = BTreeSet::new();
    let mut found = BTreeSet::new();
    while let Some(next) = open.pop() {
        if seen.len() >= MAX_MATERIALS {
            return None;
        }
        let Ok(entity) = decoder.decode_by_id(next) else { continue };
        if !seen.insert(next) || !entity.ifc_type.name().starts_with("IfcMaterial") {
            continue;
        }
        if entity.ifc_type == IfcType::IfcMaterial {
            found.insert(material(entity.get_string(NAME).unwrap_or_default(), entity.get_string(CATEGORY).unwrap_or_default()));
        } else {
            entity.attributes.iter().for_each(|attribute| push_refs(attribute, &mut open));
        }
    }
    let only = found.pop_first()?;
    if found.is_empty() { only } else { None }
}

fn push_refs(attribute: &AttributeValue, open: &mut Vec<u32>) {
    open.extend(attribute.as_ref_members().unwrap_or_default().iter().filter_map(AttributeValue::as_entity_ref));
}

fn predefined_type(entity: &DecodedEntity, decoder: &mut EntityDecoder) -> Option<String> {
    let index = decoder.attribute_index(entity.ifc_type.name(), "PredefinedType")?;
    entity.get(index)?.as_enum().filter(|kind| *kind != "NOTDEFINED").map(str::to_owned)
}

/// Returns the element number in a property set.
fn tag_in(set: u32, decoder: &mut EntityDecoder) -> Result<Option<u16>, String> {
    let Ok(entity) = decoder.decode_by_id(set) else { return Ok(None) };
    if entity.ifc_type != IfcType::IfcPropertySet {
        return Ok(None);
    }
    for id in entity.get_refs(HAS_PROPERTIES).unwrap_or_default() {
        let Ok(property) = decoder.decode_by_id(id) else { continue };
        if property.ifc_type != IfcType::IfcPropertySingleValue || property.get_string(NAME) != Some(ELEMENT_PROPERTY) {
            continue;
        }
        let value = property.get(NOMINAL_VALUE);
        let number = value.and_then(|value| value.as_int().or_else(|| value.as_string()?.trim().parse().ok()));
        return match number.and_then(|number| u16::try_from(number).ok()) {
            Some(number @ 1..=999) => Ok(Some(number)),
            _ => Err(format!("property #{id}: {ELEMENT_PROPERTY} = {} (allowed: 1 to 999)", shown(value))),
        };
    }
    Ok(None)
}

fn shown(value: Option<&AttributeValue>) -> String {
    let number = value.and_then(AttributeValue::as_float).map(|number| number.to_string());
    let text = || value.and_then(AttributeValue::as_string).map(|text| format!("{text:?}"));
    number.or_else(text).unwrap_or_else(|| "no value".to_owned())
}
