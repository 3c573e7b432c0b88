//! Serial ports: a telemetry radio or a cable.

use serial2::SerialPort;
use std::fmt;
use std::io::ErrorKind;
use std::str::FromStr;
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::Duration;

/// Bits on the line for a byte: start, eight, stop.
const BITS_A_BYTE: f64 = 10.0;
/// Between two looks for a port that has vanished.
const AGAIN: Duration = Duration::from_secs(1);
/// Baud rates that radios and cables use; the system refuses what its hardware cannot do.
const BAUD: std::ops::RangeInclusive<u32> = 1_200..=4_000_000;

/// A serial port and its speed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SerialDevice {
    path: String,
    baud: u32,
}

impl SerialDevice {
    /// What it carries, bytes a second.
    pub fn bytes_s(&self) -> f64 {
        f64::from(self.baud) / BITS_A_BYTE
    }

    /// Opens it raw: no flow control, no parity.
    ///
    /// # Errors
    /// When it is not there, is in use, or cannot do the baud rate.
    pub fn open(&self) -> std::io::Result<SerialPort> {
        SerialPort::open(&self.path, self.baud)
    }
}

impl fmt::Display for SerialDevice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.path, self.baud)
    }
}

impl FromStr for SerialDevice {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!("'{text}' is no DEVICE:BAUD such as /dev/ttyUSB0:57600 (allowed: {} to {} baud)", BAUD.start(), BAUD.end())
        };
        let (path, baud) = text.rsplit_once(':').ok_or_else(wrong)?;
        let baud = baud.parse().ok().filter(|baud| BAUD.contains(baud)).ok_or_else(wrong)?;
        if path.is_empty() { Err(wrong()) } else { Ok(Self { path: path.to_owned(), baud }) }
    }
}

/// Reads a port until nobody wants its bytes any more: `begin` gives what is to be written, `give` takes what was read, `end` is told
/// when the port vanishes; then it is looked for until it is back.
pub fn keep(
    device: &SerialDevice,
    mut port: SerialPort,
    begin: impl Fn() -> Option<Receiver<Vec<u8>>>,
    give: impl Fn(&[u8]) -> bool,
    end: impl Fn() -> bool,
) {
    loop {
        let Some(frames) = begin() else { return };
        if !read(port, frames, &give) || !end() {
            return;
        }
        tracing::warn!("serial port {device} is gone; it is opened again when it is back");
        port = loop {
            std::thread::sleep(AGAIN);
            if let Ok(port) = device.open() {
                break port;
            }
        };
    }
}

/// False when nobody wants the bytes; true when the port is gone.
fn read(port: SerialPort, frames: Receiver<Vec<u8>>, give: &impl Fn(&[u8]) -> bool) -> bool {
    let port = Arc::new(port);
    let to_write = Arc::clone(&port);
    std::thread::spawn(move || {
        for frame in frames {
            // A port that is gone is told by its reader; a radio that is full loses what it cannot take.
            let _ = to_write.write_all(&frame);
        }
    });
    let mut buffer = [0u8; 1024];
    loop {
        match port.read(&mut buffer) {
            Ok(len @ 1..) if give(&buffer[..len]) => {}
            Ok(1..) => return false,
            Ok(0) => return true,
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted | ErrorKind::WouldBlock) => {}
            Err(_) => return true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_device_has_a_name_and_a_speed() {
        let radio: SerialDevice = "/dev/ttyUSB0:57600".parse().unwrap();
        assert_eq!((radio.to_string().as_str(), radio.bytes_s()), ("/dev/ttyUSB0:57600", 5_760.0));
        for bad in ["/dev/ttyUSB0", ":57600", "/dev/ttyUSB0:fast", "/dev/ttyUSB0:5", "/dev/ttyUSB0:99999999"] {
            assert!(bad.parse::<SerialDevice>().unwrap_err().contains("1200 to 4000000"), "{bad}");
        }
    }
}
