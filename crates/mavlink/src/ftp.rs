//! MAVLink FTP: the 251 bytes inside FILE_TRANSFER_PROTOCOL (<https://mavlink.io/en/services/ftp.html>).

/// Bytes of data that one packet carries.
pub const DATA_MAX: usize = 239;
/// Bytes of a whole payload.
pub const PAYLOAD: usize = 251;
const HEADER: usize = 12;

/// What a client asks for. Numbers as on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Opcode {
    /// Ignored, acknowledged.
    None = 0,
    /// Ends one session.
    TerminateSession = 1,
    /// Ends all of the asker's sessions.
    ResetSessions = 2,
    /// Lists a directory from the entry numbered by the offset.
    ListDirectory = 3,
    /// Opens a file to be read; answers its size.
    OpenFileRo = 4,
    /// Reads at an offset.
    ReadFile = 5,
    /// Creates a file to be written.
    CreateFile = 6,
    /// Writes at an offset.
    WriteFile = 7,
    /// Removes a file.
    RemoveFile = 8,
    /// Makes a directory.
    CreateDirectory = 9,
    /// Removes an empty directory.
    RemoveDirectory = 10,
    /// Opens a file to be written.
    OpenFileWo = 11,
    /// Cuts a file to the length in the offset.
    TruncateFile = 12,
    /// Renames: two paths with a zero between.
    Rename = 13,
    /// Checksum of a whole file.
    CalcFileCrc32 = 14,
    /// Reads in one stream of packets.
    BurstReadFile = 15,
}

/// Opcode of a good answer.
pub const ACK: u8 = 128;
/// Opcode of a refusal.
pub const NAK: u8 = 129;

impl Opcode {
    /// All that a client may send.
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

    /// By its number on the wire.
    #[must_use]
    pub fn of(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }
}

/// Why a request is refused. Numbers as on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum FtpError {
    /// For a reason without a number.
    Fail = 1,
    /// The size field is larger than the data.
    InvalidDataSize = 3,
    /// No such session of this asker.
    InvalidSession = 4,
    /// All sessions are taken.
    NoSessionsAvailable = 5,
    /// The offset lies at or past the end.
    EndOfFile = 6,
    /// No such opcode.
    UnknownCommand = 7,
    /// A thing of that name is there.
    FileExists = 8,
    /// It may not be written.
    FileProtected = 9,
    /// There is none.
    FileNotFound = 10,
}

/// One packet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FtpPacket {
    /// Counts up with every packet of a conversation.
    pub sequence: u16,
    /// Which open file.
    pub session: u8,
    /// [`Opcode`], [`ACK`] or [`NAK`].
    pub opcode: u8,
    /// The size field: bytes of data, or bytes wanted by a read.
    pub size: u8,
    /// In an answer: what was asked.
    pub request: u8,
    /// Last packet of a burst.
    pub burst_complete: bool,
    /// Offset in a file, number of a directory entry, or length.
    pub offset: u32,
    /// All data bytes, used or not.
    pub data: [u8; DATA_MAX],
}

impl FtpPacket {
    /// Reads a payload; every 251 bytes are a packet.
    #[must_use]
    pub fn read(bytes: &[u8; PAYLOAD]) -> Self {
        let mut data = [0; DATA_MAX];
        data.copy_from_slice(&bytes[HEADER..]);
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

    /// The payload.
    #[must_use]
    pub fn write(&self) -> [u8; PAYLOAD] {
        let mut bytes = [0; PAYLOAD];
        bytes[..2].copy_from_slice(&self.sequence.to_le_bytes());
        bytes[2] = self.session;
        bytes[3] = self.opcode;
        bytes[4] = self.size;
        bytes[5] = self.request;
        bytes[6] = u8::from(self.burst_complete);
        bytes[8..HEADER].copy_from_slice(&self.offset.to_le_bytes());
        bytes[HEADER..].copy_from_slice(&self.data);
        bytes
    }

    /// The data that the size field covers; `None` when it claims more than a packet holds.
    #[must_use]
    pub fn sized(&self) -> Option<&[u8]> {
        self.data.get(..usize::from(self.size))
    }

    /// The answer to this request with so much data (cut to what a packet holds).
    #[must_use]
    pub fn acknowledge(&self, data: &[u8]) -> Self {
        let length = data.len().min(DATA_MAX);
        let mut out = Self { opcode: ACK, size: length as u8, data: [0; DATA_MAX], ..self.reply() };
        out.data[..length].copy_from_slice(&data[..length]);
        out
    }

    /// The refusal of this request.
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

/// The checksum of CalcFileCRC32, continued from `sum` (0 to begin): CRC-32 with the reflected polynomial 0xEDB88320, begun at zero and
/// not inverted at the end, as PX4 and MAVSDK have it.
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
    fn exact_a_payload_reads_back_as_it_was_written() {
        let mut bytes = [0u8; PAYLOAD];
        for (k, byte) in bytes.iter_mut().enumerate() {
            *byte = (k * 7 + 3) as u8;
        }
        (bytes[6], bytes[7]) = (1, 0);
        assert_eq!(FtpPacket::read(&bytes).write(), bytes);
    }

    #[test]
    fn exact_opcodes_stand_at_their_numbers() {
        for (number, opcode) in Opcode::ALL.into_iter().enumerate() {
            assert_eq!(opcode as usize, number);
        }
        assert_eq!((Opcode::of(15), Opcode::of(16), Opcode::of(255)), (Some(Opcode::BurstReadFile), None, None));
    }

    #[test]
    fn exact_a_size_that_no_packet_holds_is_no_data() {
        let mut packet = FtpPacket::read(&[0; PAYLOAD]);
        packet.size = DATA_MAX as u8;
        assert_eq!(packet.sized().map(<[u8]>::len), Some(DATA_MAX));
        packet.size += 1;
        assert_eq!(packet.sized(), None);
    }

    #[test]
    fn val_the_checksum_is_crc32_without_its_inversions() {
        // CRC-32/ISO-HDLC of "123456789" is cbf43926 (the check value of the CRC catalogue): begun and ended with inverted bits.
        assert_eq!(!checksum(!0, b"123456789"), 0xcbf4_3926);
        assert_eq!(checksum(checksum(0, b"1234"), b"56789"), checksum(0, b"123456789"));
    }
}
