//! Encodes an Arrow schema as an encapsulated IPC message. Parquet files include it for Arrow-based readers, because
//! Parquet's own schema cannot store units. Format: <https://arrow.apache.org/docs/format/Columnar.html>, tables of
//! `Schema.fbs` and `Message.fbs`; encoding: <https://flatbuffers.dev/internals/>. Parents are written before their
//! children so that all offsets are positive.

/// Field type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldType {
    /// Signed 64-bit integer.
    Int64,
    /// 64-bit float.
    Double,
    /// Boolean.
    Bool,
    /// UTF-8 text.
    Utf8,
}

/// A schema field.
#[derive(Debug, Clone, PartialEq)]
pub struct Field<'a> {
    /// Column name.
    pub name: &'a str,
    /// True if values may be null.
    pub nullable: bool,
    /// Value type.
    pub kind: FieldType,
    /// Metadata as key-value pairs.
    pub metadata: Vec<(&'a str, &'a str)>,
}

/// `MetadataVersion.V5`.
const METADATA_VERSION_V5: i16 = 4;
/// `MessageHeader.Schema`.
const HEADER_SCHEMA: u8 = 1;
/// `Precision.DOUBLE`.
const PRECISION_DOUBLE: i16 = 2;
/// Marker at the start of an encapsulated message.
const CONTINUATION: [u8; 4] = [0xFF; 4];
/// Alignment of messages and of the widest scalar type, bytes.
const ALIGNMENT: usize = 8;

impl FieldType {
    /// Returns the type's number in the `Type` union.
    fn number(self) -> u8 {
        match self {
            Self::Int64 => 2,
            Self::Double => 3,
            Self::Utf8 => 5,
            Self::Bool => 6,
        }
    }
}

/// A value in a FlatBuffers table.
#[derive(Debug, Clone, Copy)]
enum Slot {
    Absent,
    Byte(u8),
    Short(i16),
    Int(i32),
    Long(i64),
    /// Placeholder for an offset that is set later.
    Offset,
}

impl Slot {
    fn bytes(self) -> Vec<u8> {
        match self {
            Self::Absent => Vec::new(),
            Self::Byte(value) => vec![value],
            Self::Short(value) => value.to_le_bytes().to_vec(),
            Self::Int(value) => value.to_le_bytes().to_vec(),
            Self::Long(value) => value.to_le_bytes().to_vec(),
            Self::Offset => vec![0; 4],
        }
    }
}

#[derive(Debug, Default)]
struct FlatBufferWriter {
    bytes: Vec<u8>,
}

impl FlatBufferWriter {
    fn align(&mut self, to: usize) {
        self.bytes.resize(self.bytes.len().next_multiple_of(to), 0);
    }

    /// Writes a table, preceded by its vtable. Returns the positions of the table and of each slot.
    fn table(&mut self, slots: &[Slot]) -> (usize, Vec<usize>) {
        let places_len = 4 + 2 * slots.len();
        let start = (self.bytes.len() + places_len).next_multiple_of(ALIGNMENT);
        // The vtable ends where the table starts, so the offset back to the vtable equals its length.
        self.bytes.resize(start - places_len, 0);
        let mut table = (places_len as i32).to_le_bytes().to_vec();
        let mut at = Vec::new();
        for slot in slots {
            let value = slot.bytes();
            table.resize(table.len().next_multiple_of(value.len().max(1)), 0);
            at.push(if value.is_empty() { 0 } else { table.len() });
            table.extend(value);
        }
        self.bytes.extend((places_len as u16).to_le_bytes());
        self.bytes.extend((table.len() as u16).to_le_bytes());
        self.bytes.extend(at.iter().flat_map(|place| (*place as u16).to_le_bytes()));
        self.bytes.extend(table);
        (start, at.iter().map(|place| start + place).collect())
    }

    /// Sets the offset at `from` so that it points to `to`.
    fn set_offset(&mut self, from: usize, to: usize) {
        let offset = ((to - from) as u32).to_le_bytes();
        self.bytes[from..from + 4].copy_from_slice(&offset);
    }

    /// Writes a vector of offsets that are set later. Returns the positions of the vector and of each offset.
    fn offsets(&mut self, count: usize) -> (usize, Vec<usize>) {
        self.align(4);
        let start = self.bytes.len();
        self.bytes.extend((count as u32).to_le_bytes());
        self.bytes.resize(start + 4 + 4 * count, 0);
        (start, (0..count).map(|k| start + 4 + 4 * k).collect())
    }

    /// Writes a string and points the offset at `from` to it.
    fn text(&mut self, from: usize, text: &str) {
        self.align(4);
        let start = self.bytes.len();
        self.bytes.extend((text.len() as u32).to_le_bytes());
        self.bytes.extend(text.as_bytes());
        self.bytes.push(0);
        self.set_offset(from, start);
    }

    fn field(&mut self, from: usize, field: &Field<'_>) {
        let kind = Slot::Byte(field.kind.number());
        let nullable = Slot::Byte(u8::from(field.nullable));
        // Slots: name, nullable, type number, type, dictionary, children, metadata.
        let slots = [Slot::Offset, nullable, kind, Slot::Offset, Slot::Absent, Slot::Offset, Slot::Offset];
        let (start, at) = self.table(&slots);
        self.set_offset(from, start);
        self.text(at[0], field.name);
        let (kind, _) = match field.kind {
            FieldType::Int64 => self.table(&[Slot::Int(64), Slot::Byte(1)]),
            FieldType::Double => self.table(&[Slot::Short(PRECISION_DOUBLE)]),
            FieldType::Bool | FieldType::Utf8 => self.table(&[]),
        };
        self.set_offset(at[3], kind);
        let (children, _) = self.offsets(0);
        self.set_offset(at[5], children);
        let (list, places) = self.offsets(field.metadata.len());
        self.set_offset(at[6], list);
        for (place, (key, value)) in places.into_iter().zip(&field.metadata) {
            let (pair, at) = self.table(&[Slot::Offset, Slot::Offset]);
            self.set_offset(place, pair);
            self.text(at[0], key);
            self.text(at[1], value);
        }
    }
}

/// Encodes a schema as an encapsulated message.
#[must_use]
pub fn message(fields: &[Field<'_>]) -> Vec<u8> {
    let mut flat = FlatBufferWriter { bytes: vec![0; 4] };
    let (message, at) = flat.table(&[Slot::Short(METADATA_VERSION_V5), Slot::Byte(HEADER_SCHEMA), Slot::Offset, Slot::Long(0)]);
    flat.set_offset(0, message);
    // Slots: endianness (little-endian by default), fields.
    let (schema, schema_at) = flat.table(&[Slot::Absent, Slot::Offset]);
    flat.set_offset(at[2], schema);
    let (list, places) = flat.offsets(fields.len());
    flat.set_offset(schema_at[1], list);
    for (place, field) in places.into_iter().zip(fields) {
        flat.field(place, field);
    }
    flat.align(ALIGNMENT);
    let mut out = CONTINUATION.to_vec();
    out.extend((flat.bytes.len() as u32).to_le_bytes());
    out.extend(flat.bytes);
    out
}
