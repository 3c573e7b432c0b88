//! Queue of instructor commands to the vehicle. Datagrams can be lost, so each step is repeated until the vehicle
//! responds; a step without a response is reported.

use spandrel_mavlink::codec::{Encoder, ReceivedFrame};
use spandrel_mavlink::contract::practice::PracticeRequest;
use spandrel_mavlink::contract::walk::WalkRequest;
use spandrel_mavlink::dialect::{COMMAND_LONG_DATA, MavCmd, MavMessage, MavParamError, MavParamType, MavResult, PARAM_SET_DATA};
use spandrel_mavlink::{instructor_note, station};
use spandrel_monitor::sidecar::MONITOR_COMPONENT_ID as MONITOR;
use std::collections::VecDeque;
use std::time::Duration;

/// Interval at which a step without a response is repeated.
const RETRY_INTERVAL: Duration = Duration::from_millis(500);
/// Maximum number of attempts per step.
const MAX_ATTEMPTS: u32 = 20;
/// MAVLink system ID of the live page. Its component type is a companion computer, so that losing it does not trigger
/// the vehicle's ground station failsafe.
pub const INSTRUCTOR_SYSTEM: u8 = 252;
pub const INSTRUCTOR_COMPONENT: u8 = 192;
/// FAILURE_TYPE_OK and FAILURE_TYPE_OFF of MAV_CMD_INJECT_FAILURE.
const FAILURE_TYPE_OK: f32 = 0.0;
const FAILURE_TYPE_OFF: f32 = 1.0;

/// An instructor's command.
#[derive(Debug, Clone, PartialEq)]
pub enum InstructorCommand {
    /// Adds a note to the monitor's event log.
    Note(String),
    /// Sets the mean wind.
    Wind {
        /// Mean wind speed, m/s.
        speed_m_s: f64,
        /// Wind direction (where the wind comes from), degrees clockwise from north.
        from_deg: f64,
    },
    /// Opens the bridges to traffic or closes them.
    Traffic {
        /// True to open the bridges.
        open: bool,
    },
    /// Freezes, resumes or rewinds a practice flight.
    Practice(PracticeRequest),
    /// Sends the inspector to another place.
    Walk(WalkRequest),
    /// Injects or clears a failure.
    Failure {
        /// The component's FAILURE_UNIT.
        unit: f32,
        /// Component name.
        words: String,
        /// True to inject the failure, false to clear it.
        fails: bool,
    },
}

/// A single message to the vehicle.
#[derive(Debug, Clone, PartialEq)]
enum CommandStep {
    Parameter(&'static str, ParamNumber),
    Inject { unit: f32, kind: f32 },
    Practice(PracticeRequest),
    Walk(WalkRequest),
    Note(String),
}

/// Parameter value with its type.
#[derive(Debug, Clone, Copy, PartialEq)]
enum ParamNumber {
    Real(f32),
    Integer(i32),
}

impl ParamNumber {
    /// Returns the value in its wire format. `cast` is true for vehicles that expect integers converted to float, and
    /// false for vehicles that expect the integer's bit pattern.
    fn to_wire(self, cast: bool) -> f32 {
        match self {
            Self::Real(value) => value,
            Self::Integer(value) if cast => value as f32,
            Self::Integer(value) => f32::from_bits(value.cast_unsigned()),
        }
    }

    fn matches(self, wire: f32) -> bool {
        [true, false].into_iter().any(|cast| self.to_wire(cast).to_bits() == wire.to_bits())
    }
}

#[derive(Debug, Clone, PartialEq)]
struct QueuedCommand {
    steps: VecDeque<CommandStep>,
    description: String,
    last_sent: Option<Duration>,
    attempts: u32,
}

/// Unfinished commands, processed in order.
#[derive(Debug, Default)]
pub struct CommandQueue(VecDeque<QueuedCommand>);

impl CommandQueue {
    /// Appends an instructor's command to the queue.
    pub fn push(&mut self, order: InstructorCommand) {
        let (steps, words) = match order {
            InstructorCommand::Note(text) => (vec![CommandStep::Note(text.clone())], format!("note: {text}")),
            InstructorCommand::Wind { speed_m_s, from_deg } => {
                let words = format!("instructor: wind {speed_m_s} m/s from {from_deg}°");
                let value = |value: f64| ParamNumber::Real(value as f32);
                (
                    vec![
                        CommandStep::Parameter("SIM_WIND_DIR", value(from_deg)),
                        CommandStep::Parameter("SIM_WIND_SPD", value(speed_m_s)),
                    ],
                    words,
                )
            }
            InstructorCommand::Traffic { open } => {
                let words = format!("instructor: the bridges are {} to traffic", if open { "open" } else { "closed" });
                (vec![CommandStep::Parameter("SIM_TRAFFIC", ParamNumber::Integer(i32::from(open)))], words)
            }
            InstructorCommand::Practice(request) => {
                let words = match request {
                    PracticeRequest::Freeze => "freeze".to_owned(),
                    PracticeRequest::Resume => "continue".to_owned(),
                    PracticeRequest::Rewind { by } => format!("rewind {:.0} s", by.s()),
                    PracticeRequest::MoveToTask { task } => format!("move to task {task}"),
                };
                (vec![CommandStep::Practice(request)], format!("instructor: {words}"))
            }
            InstructorCommand::Walk(request) => {
                (vec![CommandStep::Walk(request)], format!("instructor: the inspector walks to place {}", request.place))
            }
            InstructorCommand::Failure { unit, words, fails } => {
                let said = format!("instructor: {} {}", words.to_lowercase(), if fails { "fails" } else { "restored" });
                let inject = CommandStep::Inject { unit, kind: if fails { FAILURE_TYPE_OFF } else { FAILURE_TYPE_OK } };
                (vec![CommandStep::Parameter("SYS_FAILURE_EN", ParamNumber::Integer(1)), inject], said)
            }
        };
        self.0.push_back(QueuedCommand { steps: steps.into(), description: words, last_sent: None, attempts: 0 });
    }

    /// Returns the frames to send now, and messages about finished commands. For `cast`, see [`ParamNumber::to_wire`].
    pub fn poll_frames(&mut self, now: Duration, encoder: &mut Encoder, system: u8, cast: bool) -> (Vec<Vec<u8>>, Vec<String>) {
        let (mut frames, mut words) = (Vec::new(), Vec::new());
        while let Some(task) = self.0.front_mut() {
            let Some(step) = task.steps.front() else {
                words.push(std::mem::take(&mut task.description));
                self.0.pop_front();
                continue;
            };
            if task.last_sent.is_some_and(|asked| now < asked + RETRY_INTERVAL) {
                break;
            }
            if task.attempts >= MAX_ATTEMPTS {
                words.push(format!("{}: no response", task.description));
                self.0.pop_front();
                continue;
            }
            frames.push(frame(step, encoder, system, cast));
            (task.last_sent, task.attempts) = (Some(now), task.attempts + 1);
            // Notes have no response; datagrams to a monitor on the same machine are hardly ever lost.
            if matches!(step, CommandStep::Note(_)) {
                task.steps.pop_front();
            }
        }
        (frames, words)
    }

    /// Checks whether a frame is a response to the current step. If the step was rejected, ends the command and returns
    /// a message.
    pub fn handle_frame(&mut self, frame: &ReceivedFrame) -> Option<String> {
        let task = self.0.front_mut()?;
        match answer(task.steps.front()?, frame.message.as_ref()?)? {
            Ok(()) => {
                task.steps.pop_front();
                (task.last_sent, task.attempts) = (None, 0);
                None
            }
            Err(why) => {
                let words = format!("{}: rejected, {why}", task.description);
                self.0.pop_front();
                Some(words)
            }
        }
    }
}

/// Returns the response to a step: success, or rejection with a reason. Ignores responses addressed to other systems.
fn answer(step: &CommandStep, message: &MavMessage) -> Option<Result<(), &'static str>> {
    let ours = |system: u8, component: u8| (system, component) == (INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT);
    match (step, message) {
        // Only the new value counts as a response; another client may have requested the old value.
        (CommandStep::Parameter(name, number), MavMessage::PARAM_VALUE(value)) => {
            let done = value.param_id.to_str().is_ok_and(|id| id == *name) && number.matches(value.param_value);
            done.then_some(Ok(()))
        }
        (CommandStep::Parameter(name, _), MavMessage::PARAM_ERROR(error)) => {
            let it = error.param_id.to_str().is_ok_and(|id| id == *name) && ours(error.target_system, error.target_component);
            it.then(|| Err(param_error_text(error.error)))
        }
        (CommandStep::Inject { .. }, MavMessage::COMMAND_ACK(ack))
            if ack.command == MavCmd::MAV_CMD_INJECT_FAILURE && ours(ack.target_system, ack.target_component) =>
        {
            result(ack.result)
        }
        (CommandStep::Practice(request), MavMessage::COMMAND_ACK(ack))
            if ack.command == request.command().0 && ours(ack.target_system, ack.target_component) =>
        {
            result(ack.result)
        }
        (CommandStep::Walk(request), MavMessage::COMMAND_ACK(ack))
            if ack.command == request.command().0 && ours(ack.target_system, ack.target_component) =>
        {
            result(ack.result)
        }
        _ => None,
    }
}

/// Returns a command's result, or `None` while it is in progress.
fn result(result: MavResult) -> Option<Result<(), &'static str>> {
    match result {
        MavResult::MAV_RESULT_ACCEPTED => Some(Ok(())),
        MavResult::MAV_RESULT_IN_PROGRESS => None,
        MavResult::MAV_RESULT_TEMPORARILY_REJECTED => Some(Err("not now")),
        MavResult::MAV_RESULT_UNSUPPORTED => Some(Err("the vehicle does not support this command")),
        MavResult::MAV_RESULT_DENIED => Some(Err("the vehicle denied this command")),
        _ => Some(Err("the vehicle reported a failure")),
    }
}

fn param_error_text(error: MavParamError) -> &'static str {
    match error {
        MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST => "this vehicle has no such parameter",
        MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE => "the value is out of range",
        MavParamError::MAV_PARAM_ERROR_READ_ONLY | MavParamError::MAV_PARAM_ERROR_PERMISSION_DENIED => {
            "the parameter is read-only"
        }
        _ => "the vehicle rejected the value",
    }
}

fn frame(step: &CommandStep, encoder: &mut Encoder, system: u8, cast: bool) -> Vec<u8> {
    match step {
        CommandStep::Parameter(name, number) => {
            let param_type = match number {
                ParamNumber::Real(_) => MavParamType::MAV_PARAM_TYPE_REAL32,
                ParamNumber::Integer(_) => MavParamType::MAV_PARAM_TYPE_INT32,
            };
            let param_value = number.to_wire(cast);
            let set =
                PARAM_SET_DATA { param_value, target_system: system, target_component: 1, param_id: (*name).into(), param_type };
            encoder.encode(&MavMessage::PARAM_SET(set))
        }
        CommandStep::Inject { unit, kind } => {
            let params = [*unit, *kind, 0.0, 0.0, 0.0, 0.0, 0.0];
            let command: COMMAND_LONG_DATA = station::command(system, 1, MavCmd::MAV_CMD_INJECT_FAILURE, params);
            encoder.encode(&MavMessage::COMMAND_LONG(command))
        }
        CommandStep::Practice(request) => request_frame(request.command(), encoder, system),
        CommandStep::Walk(request) => request_frame(request.command(), encoder, system),
        CommandStep::Note(text) => instructor_note::encode(encoder, system, MONITOR, text),
    }
}

fn request_frame((command, params): (MavCmd, [f32; 7]), encoder: &mut Encoder, system: u8) -> Vec<u8> {
    encoder.encode(&MavMessage::COMMAND_LONG(station::command(system, 1, command, params)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::codec::Decoder;
    use spandrel_mavlink::dialect::{COMMAND_ACK_DATA, PARAM_ERROR_DATA, PARAM_VALUE_DATA};
    use spandrel_model::time::SimTime;

    fn received_frame(message: &MavMessage) -> ReceivedFrame {
        Decoder::new().datagram(&Encoder::new(1, 1).encode(message)).remove(0)
    }

    fn sent(commands: &mut CommandQueue, now_ms: u64) -> (Vec<ReceivedFrame>, Vec<String>) {
        let (frames, words) = commands.poll_frames(Duration::from_millis(now_ms), &mut Encoder::new(252, 192), 1, false);
        (frames.iter().map(|frame| Decoder::new().datagram(frame).remove(0)).collect(), words)
    }

    fn command_ack(result: MavResult, (target_system, target_component): (u8, u8)) -> MavMessage {
        let command = MavCmd::MAV_CMD_INJECT_FAILURE;
        MavMessage::COMMAND_ACK(COMMAND_ACK_DATA {
            command,
            result,
            target_system,
            target_component,
            ..COMMAND_ACK_DATA::default()
        })
    }

    fn value(name: &str, param_value: f32) -> ReceivedFrame {
        received_frame(&MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
            param_id: name.into(),
            param_value,
            ..PARAM_VALUE_DATA::default()
        }))
    }

    #[test]
    fn wire_wind_steps_are_repeated_until_answered() {
        let mut commands = CommandQueue::default();
        commands.push(InstructorCommand::Wind { speed_m_s: 8.0, from_deg: 270.0 });
        let name = |frames: &[ReceivedFrame]| match frames[0].message.as_ref() {
            Some(MavMessage::PARAM_SET(set)) => (set.param_id.to_str().unwrap().to_owned(), set.param_value),
            other => panic!("{other:?}"),
        };
        assert_eq!(name(&sent(&mut commands, 0).0), ("SIM_WIND_DIR".into(), 270.0));
        assert!(sent(&mut commands, 100).0.is_empty());
        assert_eq!(name(&sent(&mut commands, 500).0).0, "SIM_WIND_DIR");
        commands.handle_frame(&value("SIM_WIND_SPD", 270.0));
        commands.handle_frame(&value("SIM_WIND_DIR", 0.0));
        assert_eq!(name(&sent(&mut commands, 1_000).0).0, "SIM_WIND_DIR", "other answers are ignored");
        commands.handle_frame(&value("SIM_WIND_DIR", 270.0));
        assert_eq!(name(&sent(&mut commands, 1_010).0), ("SIM_WIND_SPD".into(), 8.0));
        commands.handle_frame(&value("SIM_WIND_SPD", 8.0));
        assert_eq!(sent(&mut commands, 1_020), (vec![], vec!["instructor: wind 8 m/s from 270°".into()]));
    }

    #[test]
    fn wire_rejections_and_timeouts_are_reported_and_next_command_runs() {
        let mut commands = CommandQueue::default();
        commands.push(InstructorCommand::Failure { unit: 5.0, words: "Satellite navigation".into(), fails: true });
        commands.push(InstructorCommand::Note("look".into()));
        sent(&mut commands, 0);
        commands.handle_frame(&value("SYS_FAILURE_EN", f32::from_bits(1)));
        sent(&mut commands, 1);
        assert_eq!(
            commands.handle_frame(&received_frame(&command_ack(
                MavResult::MAV_RESULT_DENIED,
                (INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT)
            ))),
            Some("instructor: satellite navigation fails: rejected, the vehicle denied this command".into())
        );
        let (frames, words) = sent(&mut commands, 2);
        assert_eq!((instructor_note::decode(&frames[0]).unwrap().1, words), ("look".into(), vec!["note: look".into()]));
        commands.push(InstructorCommand::Wind { speed_m_s: 1.0, from_deg: 0.0 });
        let told: Vec<String> = (0..30).flat_map(|k| sent(&mut commands, 1_000 + 500 * k).1).collect();
        assert_eq!(told, ["instructor: wind 1 m/s from 0°: no response"]);
    }

    #[test]
    fn wire_rejected_parameters_are_reported_and_answers_to_other_systems_ignored() {
        let mut commands = CommandQueue::default();
        commands.push(InstructorCommand::Wind { speed_m_s: 8.0, from_deg: 270.0 });
        sent(&mut commands, 0);
        let error = |name: &str, (target_system, target_component): (u8, u8)| {
            received_frame(&MavMessage::PARAM_ERROR(PARAM_ERROR_DATA {
                target_system,
                target_component,
                param_id: name.into(),
                error: MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE,
                ..PARAM_ERROR_DATA::default()
            }))
        };
        for other in [
            error("SIM_WIND_DIR", (255, 190)),
            error("SIM_WIND_DIR", (INSTRUCTOR_SYSTEM, 1)),
            error("SIM_WIND_SPD", (INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT)),
        ] {
            assert_eq!(commands.handle_frame(&other), None);
        }
        let refused = commands.handle_frame(&error("SIM_WIND_DIR", (INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT)));
        assert_eq!(refused.as_deref(), Some("instructor: wind 8 m/s from 270°: rejected, the value is out of range"));
        assert_eq!(sent(&mut commands, 10_000), (vec![], vec![]), "the command has ended");

        commands.push(InstructorCommand::Failure { unit: 5.0, words: "Compass".into(), fails: true });
        sent(&mut commands, 10_000);
        commands.handle_frame(&value("SYS_FAILURE_EN", f32::from_bits(1)));
        sent(&mut commands, 10_001);
        assert_eq!(
            commands.handle_frame(&received_frame(&command_ack(MavResult::MAV_RESULT_DENIED, (255, 190)))),
            None,
            "an answer to another system"
        );
        assert_eq!(
            commands.handle_frame(&received_frame(&command_ack(
                MavResult::MAV_RESULT_IN_PROGRESS,
                (INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT)
            ))),
            None
        );
        assert_eq!(sent(&mut commands, 10_600).0.len(), 1, "still waiting for its own answer");
        assert_eq!(
            commands.handle_frame(&received_frame(&command_ack(
                MavResult::MAV_RESULT_ACCEPTED,
                (INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT)
            ))),
            None
        );
        assert_eq!(sent(&mut commands, 10_601).1, ["instructor: compass fails"]);
    }

    #[test]
    fn wire_bridges_are_closed_with_an_integer_parameter() {
        let mut commands = CommandQueue::default();
        commands.push(InstructorCommand::Traffic { open: false });
        let (frames, _) = sent(&mut commands, 0);
        let Some(MavMessage::PARAM_SET(set)) = &frames[0].message else { panic!("{frames:?}") };
        assert_eq!((set.param_id.to_str().unwrap(), set.param_value.to_bits()), ("SIM_TRAFFIC", 0));
        commands.handle_frame(&value("SIM_TRAFFIC", f32::from_bits(0)));
        assert_eq!(sent(&mut commands, 1).1, ["instructor: the bridges are closed to traffic"]);
    }

    #[test]
    fn wire_rewind_in_an_assessment_is_reported_as_denied() {
        let mut commands = CommandQueue::default();
        commands.push(InstructorCommand::Practice(PracticeRequest::Freeze));
        let acknowledged = |command, result| {
            let (target_system, target_component) = (INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT);
            let ack = COMMAND_ACK_DATA { command, result, target_system, target_component, ..COMMAND_ACK_DATA::default() };
            received_frame(&MavMessage::COMMAND_ACK(ack))
        };
        let (frames, _) = sent(&mut commands, 0);
        let Some(MavMessage::COMMAND_LONG(command)) = &frames[0].message else { panic!("{frames:?}") };
        assert_eq!((command.command, command.param1), (MavCmd::MAV_CMD_USER_1, 1.0));
        assert_eq!(commands.handle_frame(&acknowledged(MavCmd::MAV_CMD_USER_2, MavResult::MAV_RESULT_ACCEPTED)), None);
        assert_eq!(commands.handle_frame(&acknowledged(MavCmd::MAV_CMD_USER_1, MavResult::MAV_RESULT_ACCEPTED)), None);
        assert_eq!(sent(&mut commands, 1).1, ["instructor: freeze"]);
        commands.push(InstructorCommand::Practice(PracticeRequest::Rewind { by: SimTime::from_ms(10_000) }));
        sent(&mut commands, 2);
        let refused = commands.handle_frame(&acknowledged(MavCmd::MAV_CMD_USER_2, MavResult::MAV_RESULT_DENIED));
        assert_eq!(refused.as_deref(), Some("instructor: rewind 10 s: rejected, the vehicle denied this command"));
    }

    #[test]
    fn wire_walk_of_the_inspector_is_a_command() {
        let mut commands = CommandQueue::default();
        commands.push(InstructorCommand::Walk(WalkRequest { place: 3 }));
        let (frames, _) = sent(&mut commands, 0);
        let Some(MavMessage::COMMAND_LONG(command)) = &frames[0].message else { panic!("{frames:?}") };
        assert_eq!((command.command, command.param1), (MavCmd::MAV_CMD_USER_4, 3.0));
        let (target_system, target_component) = (INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT);
        let (command, result) = (MavCmd::MAV_CMD_USER_4, MavResult::MAV_RESULT_ACCEPTED);
        let ack = COMMAND_ACK_DATA { command, result, target_system, target_component, ..COMMAND_ACK_DATA::default() };
        assert_eq!(commands.handle_frame(&received_frame(&MavMessage::COMMAND_ACK(ack))), None);
        assert_eq!(sent(&mut commands, 1).1, ["instructor: the inspector walks to place 3"]);
    }

    #[test]
    fn exact_integer_parameters_use_the_vehicle_encoding() {
        for (cast, bits) in [(false, 1), (true, 1f32.to_bits())] {
            let step = CommandStep::Parameter("SYS_FAILURE_EN", ParamNumber::Integer(1));
            let frame = Decoder::new().datagram(&frame(&step, &mut Encoder::new(252, 192), 1, cast)).remove(0);
            let Some(MavMessage::PARAM_SET(set)) = frame.message else { panic!() };
            assert_eq!(set.param_value.to_bits(), bits);
        }
    }
}
