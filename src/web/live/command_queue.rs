//! Queue of instructor commands to the vehicle. Datagrams can be lost, so each step is repeated until the vehicle
//! responds; a step without a response is reported.

use super::instructor_command::{CommandOutcome, InstructorCommand, InstructorReport, Rejection};
use spandrel_mavlink::codec::{Encoder, ReceivedFrame};
use spandrel_mavlink::contract::practice::{PracticeRequest, request_number};
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

/// A single message to the vehicle.
#[derive(Debug, Clone, PartialEq)]
enum CommandStep {
    Parameter(&'static str, ParamNumber),
    Inject { unit: f32, kind: f32 },
    Practice(PracticeRequest),
    Walk(WalkRequest),
    Note(String),
}

impl CommandStep {
    /// Returns the command that the vehicle acknowledges; `None` for other messages.
    fn command(&self) -> Option<MavCmd> {
        match self {
            Self::Inject { .. } => Some(MavCmd::MAV_CMD_INJECT_FAILURE),
            Self::Practice(request) => Some(request.command(0).0),
            Self::Walk(request) => Some(request.command().0),
            Self::Parameter(..) | Self::Note(_) => None,
        }
    }
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
    command: InstructorCommand,
    /// When the current step was sent first.
    first_sent: Option<Duration>,
    last_sent: Option<Duration>,
    attempts: u32,
}

/// Unfinished commands, processed in order.
#[derive(Debug, Default)]
pub struct CommandQueue(VecDeque<QueuedCommand>);

impl QueuedCommand {
    fn report(self, outcome: CommandOutcome) -> InstructorReport {
        InstructorReport { command: self.command, outcome }
    }
}

/// Returns the messages that carry out a command.
fn steps(command: &InstructorCommand) -> Vec<CommandStep> {
    match command {
        InstructorCommand::Note(text) => vec![CommandStep::Note(text.clone())],
        InstructorCommand::Wind { speed_m_s, from_deg } => {
            let value = |value: f64| ParamNumber::Real(value as f32);
            vec![
                CommandStep::Parameter("SIM_WIND_DIR", value(*from_deg)),
                CommandStep::Parameter("SIM_WIND_SPD", value(*speed_m_s)),
            ]
        }
        InstructorCommand::Traffic { open } => {
            vec![CommandStep::Parameter("SIM_TRAFFIC", ParamNumber::Integer(i32::from(*open)))]
        }
        InstructorCommand::Practice(request) => vec![CommandStep::Practice(*request)],
        InstructorCommand::Walk(request) => vec![CommandStep::Walk(*request)],
        InstructorCommand::Failure { unit, fails } => {
            let kind = if *fails { FAILURE_TYPE_OFF } else { FAILURE_TYPE_OK };
            let inject = CommandStep::Inject { unit: unit.code(), kind };
            vec![CommandStep::Parameter("SYS_FAILURE_EN", ParamNumber::Integer(1)), inject]
        }
    }
}

impl CommandQueue {
    /// Appends an instructor's command to the queue.
    pub fn push(&mut self, command: InstructorCommand) {
        let steps = steps(&command).into();
        self.0.push_back(QueuedCommand { steps, command, first_sent: None, last_sent: None, attempts: 0 });
    }

    /// Returns the frames to send now, and the finished commands. For `cast`, see [`ParamNumber::to_wire`].
    pub fn poll_frames(
        &mut self,
        now: Duration,
        encoder: &mut Encoder,
        system: u8,
        cast: bool,
    ) -> (Vec<Vec<u8>>, Vec<InstructorReport>) {
        let (mut frames, mut reports) = (Vec::new(), Vec::new());
        while let Some(task) = self.0.front_mut() {
            let Some(step) = task.steps.front() else {
                reports.extend(self.end_current(CommandOutcome::Done));
                continue;
            };
            if task.last_sent.is_some_and(|asked| now < asked + RETRY_INTERVAL) {
                break;
            }
            if task.attempts >= MAX_ATTEMPTS {
                reports.extend(self.end_current(CommandOutcome::NoResponse));
                continue;
            }
            let first_sent = *task.first_sent.get_or_insert(now);
            frames.push(frame(step, encoder, system, (cast, first_sent)));
            (task.last_sent, task.attempts) = (Some(now), task.attempts + 1);
            // Notes have no response; datagrams to a monitor on the same machine are hardly ever lost.
            if matches!(step, CommandStep::Note(_)) {
                task.steps.pop_front();
            }
        }
        (frames, reports)
    }

    /// Removes the current command and reports its outcome.
    fn end_current(&mut self, outcome: CommandOutcome) -> Option<InstructorReport> {
        Some(self.0.pop_front()?.report(outcome))
    }

    /// Checks whether a frame is a response to the current step. If the step was rejected, ends the command and reports it.
    pub fn handle_frame(&mut self, frame: &ReceivedFrame) -> Option<InstructorReport> {
        let task = self.0.front_mut()?;
        match answer(task.steps.front()?, frame.message.as_ref()?)? {
            Ok(()) => {
                task.steps.pop_front();
                (task.first_sent, task.last_sent, task.attempts) = (None, None, 0);
                None
            }
            Err(why) => self.end_current(CommandOutcome::Rejected(why)),
        }
    }
}

/// Returns the response to a step: success, or rejection with a reason. Ignores responses addressed to other systems.
fn answer(step: &CommandStep, message: &MavMessage) -> Option<Result<(), Rejection>> {
    let ours = |system: u8, component: u8| (system, component) == (INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT);
    match (step, message) {
        // Only the new value counts as a response; another client may have requested the old value.
        (CommandStep::Parameter(name, number), MavMessage::PARAM_VALUE(value)) => {
            let done = value.param_id.to_str().is_ok_and(|id| id == *name) && number.matches(value.param_value);
            done.then_some(Ok(()))
        }
        (CommandStep::Parameter(name, _), MavMessage::PARAM_ERROR(error)) => {
            let it = error.param_id.to_str().is_ok_and(|id| id == *name) && ours(error.target_system, error.target_component);
            it.then(|| Err(param_rejection(error.error)))
        }
        (step, MavMessage::COMMAND_ACK(ack))
            if step.command() == Some(ack.command) && ours(ack.target_system, ack.target_component) =>
        {
            result(ack.result)
        }
        _ => None,
    }
}

/// Returns a command's result, or `None` while it is in progress.
fn result(result: MavResult) -> Option<Result<(), Rejection>> {
    match result {
        MavResult::MAV_RESULT_ACCEPTED => Some(Ok(())),
        MavResult::MAV_RESULT_IN_PROGRESS => None,
        MavResult::MAV_RESULT_TEMPORARILY_REJECTED => Some(Err(Rejection::NotNow)),
        MavResult::MAV_RESULT_UNSUPPORTED => Some(Err(Rejection::Unsupported)),
        MavResult::MAV_RESULT_DENIED => Some(Err(Rejection::Denied)),
        _ => Some(Err(Rejection::Failed)),
    }
}

fn param_rejection(error: MavParamError) -> Rejection {
    match error {
        MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST => Rejection::NoSuchParameter,
        MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE => Rejection::OutOfRange,
        MavParamError::MAV_PARAM_ERROR_READ_ONLY | MavParamError::MAV_PARAM_ERROR_PERMISSION_DENIED => Rejection::ReadOnly,
        _ => Rejection::InvalidValue,
    }
}

/// Encodes a step. `first_sent` is when it was sent first, so that a repeated request keeps its number.
fn frame(step: &CommandStep, encoder: &mut Encoder, system: u8, (cast, first_sent): (bool, Duration)) -> Vec<u8> {
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
        CommandStep::Practice(request) => {
            let number = request_number(u64::try_from(first_sent.as_millis()).unwrap_or_default());
            request_frame(request.command(number), encoder, system)
        }
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
    use spandrel_text::Language;
    use spandrel_training::web::live::FailingUnit;

    fn received_frame(message: &MavMessage) -> ReceivedFrame {
        Decoder::new().datagram(&Encoder::new(1, 1).encode(message)).remove(0)
    }

    fn sent(commands: &mut CommandQueue, now_ms: u64) -> (Vec<ReceivedFrame>, Vec<String>) {
        let (frames, words) = commands.poll_frames(Duration::from_millis(now_ms), &mut Encoder::new(252, 192), 1, false);
        let words = words.iter().map(|report| report.words(Language::English)).collect();
        (frames.iter().map(|frame| Decoder::new().datagram(frame).remove(0)).collect(), words)
    }

    fn words(report: Option<InstructorReport>) -> Option<String> {
        report.map(|report| report.words(Language::English))
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
        commands.push(InstructorCommand::Failure { unit: FailingUnit::Gnss, fails: true });
        commands.push(InstructorCommand::Note("look".into()));
        sent(&mut commands, 0);
        commands.handle_frame(&value("SYS_FAILURE_EN", f32::from_bits(1)));
        sent(&mut commands, 1);
        let denied = command_ack(MavResult::MAV_RESULT_DENIED, (INSTRUCTOR_SYSTEM, INSTRUCTOR_COMPONENT));
        assert_eq!(
            words(commands.handle_frame(&received_frame(&denied))).as_deref(),
            Some("instructor: satellite navigation fails: rejected, the vehicle denied this command")
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
        assert_eq!(words(refused).as_deref(), Some("instructor: wind 8 m/s from 270°: rejected, the value is out of range"));
        assert_eq!(sent(&mut commands, 10_000), (vec![], vec![]), "the command has ended");

        commands.push(InstructorCommand::Failure { unit: FailingUnit::Compass, fails: true });
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
        assert_eq!(words(refused).as_deref(), Some("instructor: rewind 10 s: rejected, the vehicle denied this command"));
    }

    #[test]
    fn regress_a_repeated_rewind_keeps_its_number() {
        let mut commands = CommandQueue::default();
        commands.push(InstructorCommand::Practice(PracticeRequest::Rewind { by: SimTime::from_ms(10_000) }));
        let mut number = |ms: u64| match &sent(&mut commands, ms).0[0].message {
            Some(MavMessage::COMMAND_LONG(command)) => command.param2,
            other => panic!("{other:?}"),
        };
        assert_eq!([number(4_000), number(4_500)], [4_001.0, 4_001.0]);
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
            let frame = Decoder::new().datagram(&frame(&step, &mut Encoder::new(252, 192), 1, (cast, Duration::ZERO))).remove(0);
            let Some(MavMessage::PARAM_SET(set)) = frame.message else { panic!() };
            assert_eq!(set.param_value.to_bits(), bits);
        }
    }
}
