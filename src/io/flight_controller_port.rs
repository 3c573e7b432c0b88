//! Serial port of a flight controller. It carries the simulator interface and ordinary MAVLink messages in one byte stream.

use super::autopilot_sockets::Handled;
use super::link_event::LinkEvent;
use super::net::{NetEvent, SocketHub, StreamId, StreamOrigin};
use spandrel_mavlink::codec::{Decoder, ReceivedFrame};
use spandrel_sitl::backend::px4::MOTOR_COMMANDS_ID;

/// The port, which belongs to the autopilot's MAVLink link.
#[derive(Debug)]
pub struct FlightControllerPort {
    link: u32,
    stream: Option<StreamId>,
    decoder: Decoder,
    earlier_bad_bytes: u64,
}

impl FlightControllerPort {
    /// Creates a port that is not open yet. `link` is the number of the MAVLink link.
    pub fn new(link: u32) -> Self {
        Self { link, stream: None, decoder: Decoder::new(), earlier_bad_bytes: 0 }
    }

    /// Returns the number of the MAVLink link.
    pub fn link(&self) -> u32 {
        self.link
    }

    /// Returns the number of bytes that were not part of a frame.
    pub fn bad_bytes(&self) -> u64 {
        self.earlier_bad_bytes + self.decoder.bad_bytes()
    }

    /// Sends frames, if the port is open.
    pub fn send(&self, hub: &SocketHub, bytes: Vec<u8>) {
        if let Some(stream) = self.stream {
            hub.send_stream(stream, bytes);
        }
    }

    /// Handles a network event if it belongs to the port.
    pub fn handle_event(&mut self, event: NetEvent) -> Handled {
        match event {
            NetEvent::Connected(stream, StreamOrigin::FlightController(_)) => {
                self.stream = Some(stream);
                self.earlier_bad_bytes += self.decoder.bad_bytes();
                self.decoder = Decoder::new();
                Handled::Changes(vec![LinkEvent::AutopilotConnected])
            }
            NetEvent::Bytes(stream, bytes) if self.stream == Some(stream) => {
                let frames = self.decoder.push(&bytes);
                Handled::Changes(frames.into_iter().map(|frame| self.event(frame)).collect())
            }
            NetEvent::Closed(stream) if self.stream == Some(stream) => {
                self.stream = None;
                Handled::Changes(vec![LinkEvent::AutopilotClosed])
            }
            other @ (NetEvent::Connected(..) | NetEvent::Bytes(..) | NetEvent::Closed(_) | NetEvent::Datagram { .. }) => {
                Handled::NotMine(other)
            }
        }
    }

    /// Sorts a frame: motor commands belong to the simulator interface.
    fn event(&self, frame: ReceivedFrame) -> LinkEvent {
        if frame.message_id == MOTOR_COMMANDS_ID {
            LinkEvent::AutopilotBytes(frame.bytes)
        } else {
            LinkEvent::FlightControllerFrame { link: self.link, frame: Box::new(frame) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::codec::Encoder;
    use spandrel_mavlink::station;

    const LINK: u32 = 5;

    fn port() -> FlightControllerPort {
        let mut port = FlightControllerPort::new(LINK);
        let opened = NetEvent::Connected(StreamId::for_test(7), StreamOrigin::FlightController("/dev/x:921600".parse().unwrap()));
        assert_eq!(port.handle_event(opened), Handled::Changes(vec![LinkEvent::AutopilotConnected]));
        port
    }

    #[test]
    fn wire_one_stream_is_split_into_motor_commands_and_messages() {
        let mut controller = Encoder::new(1, 1);
        let commands = controller.encode_payload(MOTOR_COMMANDS_ID, &[1; 81]);
        let heartbeat = controller.encode(&station::heartbeat());
        let stream = [&heartbeat[..], b"noise", &commands, &heartbeat].concat();
        for chunk in [1, 7, 40, stream.len()] {
            let (mut port, mut events) = (port(), Vec::new());
            for bytes in stream.chunks(chunk) {
                match port.handle_event(NetEvent::Bytes(StreamId::for_test(7), bytes.to_vec())) {
                    Handled::Changes(changes) => events.extend(changes),
                    Handled::NotMine(event) => panic!("{event:?}"),
                }
            }
            let Ok([first, second, third]) = <[LinkEvent; 3]>::try_from(events) else { panic!("not three events") };
            for event in [first, third] {
                let LinkEvent::FlightControllerFrame { link: LINK, frame } = event else { panic!("{event:?}") };
                assert_eq!(frame.bytes, heartbeat);
            }
            assert_eq!(second, LinkEvent::AutopilotBytes(commands.clone()));
            assert_eq!(port.bad_bytes(), 5);
        }
    }

    #[test]
    fn wire_other_streams_are_left_alone_and_a_closed_port_is_reported() {
        let mut port = port();
        let other = NetEvent::Bytes(StreamId::for_test(8), vec![1]);
        assert_eq!(port.handle_event(other.clone()), Handled::NotMine(other));
        let radio = NetEvent::Connected(StreamId::for_test(9), StreamOrigin::Serial("/dev/y:57600".parse().unwrap()));
        assert_eq!(port.handle_event(radio.clone()), Handled::NotMine(radio));
        let closed = NetEvent::Closed(StreamId::for_test(7));
        assert_eq!(port.handle_event(closed.clone()), Handled::Changes(vec![LinkEvent::AutopilotClosed]));
        assert_eq!(port.handle_event(closed.clone()), Handled::NotMine(closed));
    }
}
