//! Serial ports for telemetry radios and cables.

use serial2::SerialPort;
use std::fmt;
use std::io::ErrorKind;
use std::str::FromStr;
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::Duration;

/// Bits per byte on the wire: one start bit, eight data bits, one stop bit.
const BITS_PER_BYTE: f64 = 10.0;
/// Interval between attempts to reopen a disconnected port.
const REOPEN_INTERVAL: Duration = Duration::from_secs(1);
/// Range of baud rates that radios and cables use. The operating system rejects rates that the hardware does not
/// support.
const BAUD_RANGE: std::ops::RangeInclusive<u32> = 1_200..=4_000_000;

/// A serial port and its baud rate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SerialDevice {
    path: String,
    baud: u32,
}

impl SerialDevice {
    /// Returns the capacity in bytes/s.
    pub fn capacity_bytes_s(&self) -> f64 {
        f64::from(self.baud) / BITS_PER_BYTE
    }

    /// Returns the baud rate that gives a capacity, rounded up.
    pub fn baud_for(capacity_bytes_s: f64) -> u32 {
        (capacity_bytes_s * BITS_PER_BYTE).ceil() as u32
    }

    /// Opens the port in raw mode, without flow control or parity.
    ///
    /// # Errors
    /// Returns an error if the port does not exist, is in use, or does not support the baud rate.
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
            format!(
                "'{text}' is not DEVICE:BAUD, for example /dev/ttyUSB0:57600 (allowed: {} to {} baud)",
                BAUD_RANGE.start(),
                BAUD_RANGE.end()
            )
        };
        let (path, baud) = text.rsplit_once(':').ok_or_else(wrong)?;
        let baud = baud.parse().ok().filter(|baud| BAUD_RANGE.contains(baud)).ok_or_else(wrong)?;
        if path.is_empty() { Err(wrong()) } else { Ok(Self { path: path.to_owned(), baud }) }
    }
}

/// Reads a port until its data is no longer needed. `begin` returns the frames to write, `on_bytes` receives the data,
/// and `end` is called when the port disconnects. The port is then reopened as soon as possible.
pub fn run_with_reconnect(
    device: &SerialDevice,
    mut port: SerialPort,
    begin: impl Fn() -> Option<Receiver<Vec<u8>>>,
    on_bytes: impl Fn(&[u8]) -> bool,
    end: impl Fn() -> bool,
) {
    loop {
        let Some(frames) = begin() else { return };
        if !read_until_disconnect(port, frames, &on_bytes) || !end() {
            return;
        }
        tracing::warn!("serial port {device} disconnected; waiting for it to return");
        port = loop {
            std::thread::sleep(REOPEN_INTERVAL);
            if let Ok(port) = device.open() {
                break port;
            }
        };
    }
}

/// Reads the port while another thread writes `frames` to it. Returns false if the data is no longer needed, true if
/// the port disconnected.
fn read_until_disconnect(port: SerialPort, frames: Receiver<Vec<u8>>, on_bytes: &impl Fn(&[u8]) -> bool) -> bool {
    let port = Arc::new(port);
    let to_write = Arc::clone(&port);
    std::thread::spawn(move || {
        for frame in frames {
            // The reader detects a disconnected port; if a radio's buffer is full, the frame is dropped.
            let _ = to_write.write_all(&frame);
        }
    });
    let mut buffer = [0u8; 1024];
    loop {
        match port.read(&mut buffer) {
            Ok(len @ 1..) if on_bytes(&buffer[..len]) => {}
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
    fn exact_serial_devices_parse_with_path_and_baud_rate() {
        let radio: SerialDevice = "/dev/ttyUSB0:57600".parse().unwrap();
        assert_eq!((radio.to_string().as_str(), radio.capacity_bytes_s()), ("/dev/ttyUSB0:57600", 5_760.0));
        for bad in ["/dev/ttyUSB0", ":57600", "/dev/ttyUSB0:fast", "/dev/ttyUSB0:5", "/dev/ttyUSB0:99999999"] {
            assert!(bad.parse::<SerialDevice>().unwrap_err().contains("1200 to 4000000"), "{bad}");
        }
    }
}
