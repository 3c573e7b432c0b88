//! Packets with motor outputs that ArduPilot sends: little-endian, one a datagram.

/// Maximum number of outputs in a packet.
pub const MAX_CHANNELS: usize = 32;

/// Magic number, number of channels and length of a packet without and with SERVO_32_ENABLE.
const FORMATS: [(u16, usize); 2] = [(18_458, 16), (29_569, MAX_CHANNELS)];
const HEADER_LEN: usize = 8;

/// Motor outputs of one frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ServoPacket {
    /// Number of states that ArduPilot has received since it started. A resent packet has the same number.
    pub frame_count: u32,
    /// Pulse widths, us; 0 if there is no output.
    pub pwm_us: [u16; MAX_CHANNELS],
}

impl ServoPacket {
    /// Decodes a datagram. On failure, returns a description for the log.
    pub fn decode(bytes: &[u8]) -> Result<Self, String> {
        let word = |at: usize| bytes.get(at..at + 2).map_or(0, |pair| u16::from_le_bytes([pair[0], pair[1]]));
        let channels = FORMATS.iter().find(|(magic, _)| *magic == word(0)).map(|(_, channels)| *channels);
        let Some(channels) = channels else {
            return Err(format!("datagram of {} bytes is not a servo packet (magic number {})", bytes.len(), word(0)));
        };
        let expected = HEADER_LEN + 2 * channels;
        if bytes.len() != expected {
            return Err(format!("servo packet with {channels} channels has {} bytes instead of {expected}", bytes.len()));
        }
        let mut pwm_us = [0; MAX_CHANNELS];
        for (channel, pwm) in pwm_us.iter_mut().take(channels).enumerate() {
            *pwm = word(HEADER_LEN + 2 * channel);
        }
        Ok(Self { frame_count: u32::from(word(4)) | u32::from(word(6)) << 16, pwm_us })
    }
}
