//! MAVLink's checksum, CRC-16/MCRF4XX. Every frame sent and received needs one, so four bytes are processed at a time.

/// Reflected polynomial.
const POLYNOMIAL: u16 = 0x8408;
/// Initial value.
const START: u16 = 0xffff;
/// Number of bytes processed at a time.
const SLICE: usize = 4;

/// Remainders of each byte followed by 0 to 3 zero bytes.
const TABLES: [[u16; 256]; SLICE] = tables();

const fn tables() -> [[u16; 256]; SLICE] {
    let mut tables = [[0; 256]; SLICE];
    let mut byte = 0;
    while byte < 256 {
        let mut crc = byte as u16;
        let mut bit = 0;
        while bit < 8 {
            crc = if crc & 1 == 1 { (crc >> 1) ^ POLYNOMIAL } else { crc >> 1 };
            bit += 1;
        }
        tables[0][byte] = crc;
        byte += 1;
    }
    let mut zeros = 1;
    while zeros < SLICE {
        let mut byte = 0;
        while byte < 256 {
            let crc = tables[zeros - 1][byte];
            tables[zeros][byte] = (crc >> 8) ^ tables[0][(crc & 0xff) as usize];
            byte += 1;
        }
        zeros += 1;
    }
    tables
}

fn add_byte(crc: u16, byte: u8) -> u16 {
    (crc >> 8) ^ TABLES[0][usize::from(crc as u8 ^ byte)]
}

fn add_slice(crc: u16, bytes: &[u8; SLICE]) -> u16 {
    let [low, high] = crc.to_le_bytes();
    TABLES[3][usize::from(bytes[0] ^ low)]
        ^ TABLES[2][usize::from(bytes[1] ^ high)]
        ^ TABLES[1][usize::from(bytes[2])]
        ^ TABLES[0][usize::from(bytes[3])]
}

/// Returns the checksum of a frame's header and payload, followed by the message's CRC_EXTRA.
#[must_use]
pub fn checksum(data: &[u8], crc_extra: u8) -> u16 {
    let (slices, rest) = data.as_chunks::<SLICE>();
    let crc = slices.iter().fold(START, add_slice);
    let crc = rest.iter().fold(crc, |crc, byte| add_byte(crc, *byte));
    add_byte(crc, crc_extra)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_checksum_matches_the_published_check_value_and_the_protocol_library() {
        // Catalog of parametrised CRC algorithms: CRC-16/MCRF4XX of "123456789" is 0x6f91.
        assert_eq!(checksum(b"12345678", b'9'), 0x6f91);
        let bytes: Vec<u8> = (0..300_u32).map(|k| (k * k * 31 + 7 * k) as u8).collect();
        for len in 0..bytes.len() {
            assert_eq!(checksum(&bytes[..len], 217), mavlink::calculate_crc(&bytes[..len], 217), "{len} bytes");
        }
    }
}
