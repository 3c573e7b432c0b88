//! Recording and playback of controller input in JSON Lines format.
//!
//! The first line is `{"format":1,"device":NAME,"id":ID}`, followed by one line per event:
//! `{"t_s":S,"axis":N,"value":V}`, `{"t_s":S,"button":N,"pressed":BOOL}`, `{"t_s":S,"lost":true}` or
//! `{"t_s":S,"found":true}`. `t_s` is the time since the start and never decreases. Another program can also write these lines
//! while it flies ([`LiveInput`]).

use super::{Device, DeviceEvent};
use serde_json::{Value, json};
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Newest supported format version.
const FORMAT: u64 = 1;

/// Returns the first line of a recording.
#[must_use]
pub fn head(device: &Device) -> String {
    json!({ "format": FORMAT, "device": device.name, "id": device.id }).to_string()
}

/// Returns one event line of a recording.
#[must_use]
pub fn line(at: SimTime, event: DeviceEvent) -> String {
    let t_s = at.s();
    match event {
        DeviceEvent::Axis { axis, value } => json!({ "t_s": t_s, "axis": axis, "value": value }),
        DeviceEvent::Button { button, pressed } => json!({ "t_s": t_s, "button": button, "pressed": pressed }),
        DeviceEvent::Lost => json!({ "t_s": t_s, "lost": true }),
        DeviceEvent::Found => json!({ "t_s": t_s, "found": true }),
    }
    .to_string()
}

/// A recording for playback.
#[derive(Debug, Clone, PartialEq)]
pub struct InputRecording {
    /// The recorded device.
    pub device: Device,
    events: VecDeque<(SimTime, DeviceEvent)>,
}

impl InputRecording {
    /// Parses a recording. `file` is the name used in error messages.
    ///
    /// # Errors
    /// Returns the file, line number, problem, and allowed values of the first invalid line.
    pub fn read(file: &str, text: &str) -> Result<Self, String> {
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let (_, first) = lines
            .next()
            .ok_or_else(|| format!("{file}: file is empty (allowed: a recording made with `spandrel rc --record`)"))?;
        let device = device(first).map_err(|what| format!("{file}:1: {what}"))?;
        let mut events: VecDeque<(SimTime, DeviceEvent)> = VecDeque::new();
        for (k, line) in lines {
            let (at, event) = event(line).map_err(|what| format!("{file}:{}: {what}", k + 1))?;
            if let Some((before, _)) = events.back().filter(|(before, _)| *before > at) {
                return Err(format!(
                    "{file}:{}: t_s = {} is before the previous event (allowed: {} or later)",
                    k + 1,
                    at.s(),
                    before.s()
                ));
            }
            events.push_back((at, event));
        }
        Ok(Self { device, events })
    }

    /// Returns the next event that is due at `now`.
    pub fn due(&mut self, now: SimTime) -> Option<DeviceEvent> {
        self.events.front().filter(|(at, _)| *at <= now)?;
        self.events.pop_front().map(|(_, event)| event)
    }

    /// Checks whether all events have been played.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.events.is_empty()
    }
}

/// Reads the lines of a recording one at a time, as another program writes them.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveInput {
    /// The device that the other program stands for.
    pub device: Device,
    file: String,
    line: usize,
}

impl LiveInput {
    /// Parses the first line. `file` is the name used in error messages.
    ///
    /// # Errors
    /// Returns the file, line number, problem, and allowed values if the line is invalid.
    pub fn begin(file: &str, first: &str) -> Result<Self, String> {
        let device = device(first).map_err(|what| format!("{file}:1: {what}"))?;
        Ok(Self { device, file: file.to_owned(), line: 1 })
    }

    /// Parses the next line. Its time has no effect, because the event happens now.
    ///
    /// # Errors
    /// Returns the file, line number, problem, and allowed values if the line is invalid.
    pub fn next(&mut self, text: &str) -> Result<DeviceEvent, String> {
        self.line += 1;
        event(text).map(|(_, event)| event).map_err(|what| format!("{}:{}: {what}", self.file, self.line))
    }
}

fn object(line: &str) -> Result<Value, String> {
    serde_json::from_str::<Value>(line).ok().filter(Value::is_object).ok_or_else(|| format!("'{line}' is not a JSON object"))
}

fn device(line: &str) -> Result<Device, String> {
    let head = object(line)?;
    if head["format"].as_u64() != Some(FORMAT) {
        return Err(format!("format = {} (allowed: {FORMAT})", head["format"]));
    }
    let text =
        |key: &str| head[key].as_str().map(str::to_owned).ok_or_else(|| format!("{key} = {} (allowed: a string)", head[key]));
    Ok(Device { name: text("device")?, id: text("id")? })
}

fn event(line: &str) -> Result<(SimTime, DeviceEvent), String> {
    let value = object(line)?;
    let seconds = value["t_s"].as_f64().filter(|s| (0.0..1e6).contains(s));
    let at = SimTime::from_s(seconds.ok_or_else(|| format!("t_s = {} (allowed: 0 to 1e6)", value["t_s"]))?);
    let number = |key: &str| value[key].as_u64().and_then(|n| u32::try_from(n).ok());
    if let Some(axis) = number("axis") {
        let read = value["value"].as_f64().filter(|v| (-1.0..=1.0).contains(v));
        return Ok((
            at,
            DeviceEvent::Axis { axis, value: read.ok_or_else(|| format!("value = {} (allowed: -1 to 1)", value["value"]))? },
        ));
    }
    if let Some(button) = number("button") {
        let pressed =
            value["pressed"].as_bool().ok_or_else(|| format!("pressed = {} (allowed: true, false)", value["pressed"]))?;
        return Ok((at, DeviceEvent::Button { button, pressed }));
    }
    match (value["lost"].as_bool(), value["found"].as_bool()) {
        (Some(true), None) => Ok((at, DeviceEvent::Lost)),
        (None, Some(true)) => Ok((at, DeviceEvent::Found)),
        _ => Err(format!("'{line}' is not an event (allowed: axis and value, button and pressed, lost, found)")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_recording_plays_back_with_its_timing() {
        let device = Device { name: "Pad".into(), id: "1:2".into() };
        let events = [
            (0.0, DeviceEvent::Found),
            (0.02, DeviceEvent::Axis { axis: 3, value: -0.123_456_789_012_345_67 }),
            (0.02, DeviceEvent::Button { button: 1, pressed: true }),
            (1.0, DeviceEvent::Lost),
        ];
        let text: Vec<String> =
            std::iter::once(head(&device)).chain(events.map(|(s, event)| line(SimTime::from_s(s), event))).collect();
        let mut record = InputRecording::read("r", &text.join("\n")).unwrap();
        assert_eq!(record.device, device);
        assert_eq!(record.due(SimTime::ZERO), Some(events[0].1));
        assert_eq!(record.due(SimTime::ZERO), None);
        let late = SimTime::from_s(2.0);
        assert_eq!(
            std::iter::from_fn(|| record.due(late)).collect::<Vec<_>>(),
            events[1..].iter().map(|e| e.1).collect::<Vec<_>>()
        );
        assert!(record.is_over());
    }

    #[test]
    fn exact_invalid_line_is_reported() {
        let head = head(&Device { name: "Pad".into(), id: "1:2".into() });
        for (line, told) in [
            ("{", "is not a JSON object"),
            ("{\"t_s\":-1,\"lost\":true}", "t_s = -1 (allowed: 0 to 1e6)"),
            ("{\"t_s\":1,\"axis\":1,\"value\":2}", "value = 2 (allowed: -1 to 1)"),
            (
                "{\"t_s\":1,\"axis\":1,\"value\":0}\n{\"t_s\":0.5,\"lost\":true}",
                "r:3: t_s = 0.5 is before the previous event (allowed: 1 or later)",
            ),
            ("{\"t_s\":1,\"button\":1}", "pressed = null"),
            ("{\"t_s\":1,\"fly\":1}", "is not an event"),
        ] {
            let error = InputRecording::read("r", &format!("{head}\n{line}")).unwrap_err();
            assert!(error.contains(told) && error.starts_with("r:"), "{error}");
        }
        assert!(InputRecording::read("r", "").is_err() && InputRecording::read("r", "{\"format\":2}").is_err());
    }

    #[test]
    fn exact_live_lines_are_events_or_reported() {
        let device = Device { name: "Pad".into(), id: "1:2".into() };
        let mut live = LiveInput::begin("standard input", &head(&device)).unwrap();
        assert_eq!(live.device, device);
        let pressed = DeviceEvent::Button { button: 4, pressed: true };
        assert_eq!(live.next(&line(SimTime::from_s(9.0), pressed)), Ok(pressed));
        assert_eq!(live.next(&line(SimTime::ZERO, DeviceEvent::Lost)), Ok(DeviceEvent::Lost), "times have no order");
        let error = live.next("{\"t_s\":0,\"axis\":1,\"value\":2}").unwrap_err();
        assert_eq!(error, "standard input:4: value = 2 (allowed: -1 to 1)");
        assert!(LiveInput::begin("standard input", "").unwrap_err().starts_with("standard input:1: "));
    }
}
