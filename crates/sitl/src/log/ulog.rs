//! Encoder for the ULog file format (<https://docs.px4.io/main/en/dev_log/ulog_file_format.html>).

/// File magic bytes and format version 1.
const MAGIC: [u8; 8] = [b'U', b'L', b'o', b'g', 0x01, 0x12, 0x35, 0x01];

/// Encodes ULog messages into a buffer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct UlogWriter {
    out: Vec<u8>,
}

/// Value of an information or parameter message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum UlogValue<'a> {
    /// Text string.
    Text(&'a str),
    /// Integer.
    Int(i32),
    /// Floating-point number.
    Real(f32),
}

impl UlogValue<'_> {
    fn kind(&self) -> String {
        match self {
            Self::Text(text) => format!("char[{}]", text.len()),
            Self::Int(_) => "int32_t".into(),
            Self::Real(_) => "float".into(),
        }
    }

    fn bytes(&self) -> Vec<u8> {
        match self {
            Self::Text(text) => text.as_bytes().to_vec(),
            Self::Int(value) => value.to_le_bytes().to_vec(),
            Self::Real(value) => value.to_le_bytes().to_vec(),
        }
    }
}

impl UlogWriter {
    /// Writes the file header with the start time in microseconds, then the flag-bits message.
    pub fn begin(&mut self, at_us: u64) {
        self.out.extend_from_slice(&MAGIC);
        self.out.extend_from_slice(&at_us.to_le_bytes());
        self.message(b'B', &[&[0; 40]]);
    }

    /// Writes the format of a topic: `type name;` for every field, starting with `uint64_t timestamp` (microseconds).
    pub fn format(&mut self, topic: &str, fields: &str) {
        self.message(b'F', &[topic.as_bytes(), b":", fields.as_bytes()]);
    }

    /// Writes an information message about the log.
    pub fn information(&mut self, name: &str, value: UlogValue) {
        self.write_key_value(b'I', name, value);
    }

    /// Writes the initial value of a parameter. Must precede the first data row.
    pub fn parameter(&mut self, name: &str, value: UlogValue) {
        self.write_key_value(b'P', name, value);
    }

    /// Assigns a message ID to a topic. The format must be written first.
    pub fn subscribe(&mut self, number: u16, topic: &str) {
        self.message(b'A', &[&[0], &number.to_le_bytes(), topic.as_bytes()]);
    }

    /// Writes one data row. Fields have no padding.
    pub fn row(&mut self, number: u16, row: &[u8]) {
        self.message(b'D', &[&number.to_le_bytes(), row]);
    }

    /// Writes a text message with its severity (0 = emergency to 7 = debug).
    pub fn text(&mut self, severity: u8, at_us: u64, text: &str) {
        self.message(b'L', &[&[b'0' + severity.min(7)], &at_us.to_le_bytes(), text.as_bytes()]);
    }

    /// Returns the number of buffered bytes.
    #[must_use]
    pub fn buffered_bytes(&self) -> usize {
        self.out.len()
    }

    /// Returns the buffered bytes and clears the buffer; the caller appends them to the file.
    pub fn take(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.out)
    }

    fn write_key_value(&mut self, kind: u8, name: &str, value: UlogValue) {
        let key = format!("{} {name}", value.kind());
        // All names are internal and short; a longer name would overflow the length byte.
        let length = key.len().min(255);
        self.message(kind, &[&[length as u8], &key.as_bytes()[..length], &value.bytes()]);
    }

    fn message(&mut self, kind: u8, parts: &[&[u8]]) {
        let length: usize = parts.iter().map(|part| part.len()).sum();
        // The length field has 16 bits. A longer message would corrupt the rest of the log, so it is dropped.
        let Ok(length) = u16::try_from(length) else { return };
        self.out.extend_from_slice(&length.to_le_bytes());
        self.out.push(kind);
        parts.iter().for_each(|part| self.out.extend_from_slice(part));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_message_layout_matches_ulog_format() {
        let mut log = UlogWriter::default();
        log.begin(5);
        assert_eq!(log.take(), [&MAGIC[..], &[5, 0, 0, 0, 0, 0, 0, 0, 40, 0, b'B'], &[0; 40]].concat());
        log.format("t", "uint64_t timestamp;");
        assert_eq!(log.take(), [&[21, 0, b'F'], b"t:uint64_t timestamp;".as_slice()].concat());
        log.parameter("A", UlogValue::Int(-1));
        assert_eq!(log.take(), [&[14, 0, b'P', 9], b"int32_t A".as_slice(), &[255; 4]].concat());
        log.subscribe(258, "t");
        assert_eq!(log.take(), [4, 0, b'A', 0, 2, 1, b't']);
        log.row(258, &[9, 8]);
        assert_eq!(log.take(), [4, 0, b'D', 2, 1, 9, 8]);
        log.text(4, 1, "x");
        assert_eq!(log.take(), [10, 0, b'L', b'4', 1, 0, 0, 0, 0, 0, 0, 0, b'x']);
    }
}
