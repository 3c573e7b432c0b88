//! MAVLink FTP: the 251-byte payload of FILE_TRANSFER_PROTOCOL (<https://mavlink.io/en/services/ftp.html>).

/// Maximum number of data bytes per packet.
pub const DATA_MAX: usize = 239;
/// Size of an FTP payload, bytes.
pub const PAYLOAD: usize = 251;
const HEADER_LEN: usize = 12;

/// Opcodes of client requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Opcode {
    /// Does nothing; always acknowledged.
    None = 0,
    /// Terminates one session.
    TerminateSession = 1,
    /// Terminates all of the client's sessions.
    ResetSessions = 2,
    /// Lists a directory, starting at the entry whose index is in the offset field.
    ListDirectory = 3,
    /// Opens a file for reading and returns its size.
    OpenFileRo = 4,
    /// Reads data at an offset.
    ReadFile = 5,
    /// Creates a file for writing.
    CreateFile = 6,
    /// Writes data at an offset.
    WriteFile = 7,
    /// Deletes a file.
    RemoveFile = 8,
    /// Creates a directory.
    CreateDirectory = 9,
    /// Deletes an empty directory.
    RemoveDirectory = 10,
    /// Opens a file for writing.
    OpenFileWo = 11,
    /// Truncates a file to the length in the offset field.
    TruncateFile = 12,
    /// Renames a file or directory: two paths separated by a null byte.
    Rename = 13,
    /// Computes the CRC-32 of a file.
    CalcFileCrc32 = 14,
    /// Reads a file as a burst of packets.
    BurstReadFile = 15,
}

/// Opcode of a positive response.
pub const ACK: u8 = 128;
/// Opcode of a negative response.
pub const NAK: u8 = 129;

impl Opcode {
    /// All requests, indexed by opcode.
    pub const ALL: [Self; 16] = [
        Self::None,
        Self::TerminateSession,
        Self::ResetSessions,
        Self::ListDirectory,
        Self::OpenFileRo,
        Self::ReadFile,
        Self::CreateFile,
        Self::WriteFile,
        Self::RemoveFile,
        Self::CreateDirectory,
        Self::RemoveDirectory,
        Self::OpenFileWo,
        Self::TruncateFile,
        Self::Rename,
        Self::CalcFileCrc32,
        Self::BurstReadFile,
    ];

    /// Returns the request with this opcode; `None` if the opcode is unknown.
    #[must_use]
    pub fn of(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }
}

/// Error codes in a negative response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum FtpError {
    /// Unspecified failure.
    Fail = 1,
    /// The size field exceeds the packet capacity.
    InvalidDataSize = 3,
    /// The client has no session with this ID.
    InvalidSession = 4,
    /// All sessions are in use.
    NoSessionsAvailable = 5,
    /// The offset is at or past the end of the file.
    EndOfFile = 6,
    /// The opcode is unknown.
    UnknownCommand = 7,
    /// The file or directory already exists.
    FileExists = 8,
    /// The file is write-protected.
    FileProtected = 9,
    /// The file or directory does not exist.
    FileNotFound = 10,
}

/// An FTP packet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FtpPacket {
    /// Sequence number, incremented with each packet of an exchange.
    pub sequence: u16,
    /// Session ID of the open file.
    pub session: u8,
    /// [`Opcode`], [`ACK`] or [`NAK`].
    pub opcode: u8,
    /// Size field: number of data bytes, or the number of bytes that a read requests.
    pub size: u8,
    /// In a response, the opcode of the request.
    pub request: u8,
    /// Whether this is the last packet of a burst.
    pub burst_complete: bool,
    /// Offset in a file, index of a directory entry, or file length, depending on the request.
    pub offset: u32,
    /// The complete data field, including unused bytes.
    pub data: [u8; DATA_MAX],
}

impl FtpPacket {
    /// Decodes a payload. Any 251 bytes form a valid packet.
    #[must_use]
    pub fn read(bytes: &[u8; PAYLOAD]) -> Self {
        let mut data = [0; DATA_MAX];
        data.copy_from_slice(&bytes[HEADER_LEN..]);
        Self {
            sequence: u16::from_le_bytes([bytes[0], bytes[1]]),
            session: bytes[2],
            opcode: bytes[3],
            size: bytes[4],
            request: bytes[5],
            burst_complete: bytes[6] != 0,
            offset: u32::from_le_bytes([bytes[8], bytes[9], bytes[10], bytes[11]]),
            data,
        }
    }

    /// Encodes the packet as a payload.
    #[must_use]
    pub fn write(&self) -> [u8; PAYLOAD] {
        let mut bytes = [0; PAYLOAD];
        bytes[..2].copy_from_slice(&self.sequence.to_le_bytes());
        bytes[2] = self.session;
        bytes[3] = self.opcode;
        bytes[4] = self.size;
        bytes[5] = self.request;
        bytes[6] = u8::from(self.burst_complete);
        bytes[8..HEADER_LEN].copy_from_slice(&self.offset.to_le_bytes());
        bytes[HEADER_LEN..].copy_from_slice(&self.data);
        bytes
    }

    /// Returns the data covered by the size field; `None` if the size exceeds the packet capacity.
    #[must_use]
    pub fn data_in_use(&self) -> Option<&[u8]> {
        self.data.get(..usize::from(self.size))
    }

    /// Creates a positive response to this request. Data beyond the packet capacity is dropped.
    #[must_use]
    pub fn acknowledge(&self, data: &[u8]) -> Self {
        let length = data.len().min(DATA_MAX);
        let mut out = Self { opcode: ACK, size: length as u8, data: [0; DATA_MAX], ..self.reply() };
        out.data[..length].copy_from_slice(&data[..length]);
        out
    }

    /// Creates a negative response to this request.
    #[must_use]
    pub fn error_reply(&self, why: FtpError) -> Self {
        let mut out = Self { opcode: NAK, size: 1, data: [0; DATA_MAX], ..self.reply() };
        out.data[0] = why as u8;
        out
    }

    fn reply(&self) -> Self {
        Self { sequence: self.sequence.wrapping_add(1), request: self.opcode, burst_complete: false, ..self.clone() }
    }
}

/// Updates the CalcFileCRC32 checksum `sum` (0 at the start of a file) with more bytes: CRC-32 with the reflected
/// polynomial 0xEDB88320, initial value 0 and no final inversion, as in PX4 and MAVSDK.
#[must_use]
pub fn checksum(sum: u32, bytes: &[u8]) -> u32 {
    let mut crc = crc32fast::Hasher::new_with_initial(!sum);
    crc.update(bytes);
    !crc.finalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_ftp_payload_round_trips() {
        let mut bytes = [0u8; PAYLOAD];
        for (k, byte) in bytes.iter_mut().enumerate() {
            *byte = (k * 7 + 3) as u8;
        }
        (bytes[6], bytes[7]) = (1, 0);
        assert_eq!(FtpPacket::read(&bytes).write(), bytes);
    }

    #[test]
    fn exact_opcodes_have_their_mavlink_numbers() {
        for (number, opcode) in Opcode::ALL.into_iter().enumerate() {
            assert_eq!(opcode as usize, number);
        }
        assert_eq!((Opcode::of(15), Opcode::of(16), Opcode::of(255)), (Some(Opcode::BurstReadFile), None, None));
    }

    #[test]
    fn exact_oversized_ftp_packet_has_no_data() {
        let mut packet = FtpPacket::read(&[0; PAYLOAD]);
        packet.size = DATA_MAX as u8;
        assert_eq!(packet.data_in_use().map(<[u8]>::len), Some(DATA_MAX));
        packet.size += 1;
        assert_eq!(packet.data_in_use(), None);
    }

    #[test]
    fn val_ftp_checksum_is_crc32_without_inversions() {
        // The CRC catalog lists cbf43926 as the CRC-32/ISO-HDLC checksum of "123456789". That variant inverts the
        // initial and final values.
        assert_eq!(!checksum(!0, b"123456789"), 0xcbf4_3926);
        assert_eq!(checksum(checksum(0, b"1234"), b"56789"), checksum(0, b"123456789"));
    }
}
