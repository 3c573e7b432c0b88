//! Message reference page: streams with their rates, and handled messages.

use crate::table::table;
use crate::{check, page_head};
use mavlink::Message;
use spandrel_mavlink::ardupilotmega;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_sitl::endpoint::flavor::{Flavor, ardupilot, generic, px4};
use spandrel_sitl::endpoint::streams::{CAMERA, STREAMS, StreamSpec};
use spandrel_sitl::endpoint::{HANDLED, LinkKind};

fn name(id: u32) -> String {
    let ours = [
        &ardupilotmega::MEMINFO,
        &ardupilotmega::AHRS,
        &ardupilotmega::SIMSTATE,
        &ardupilotmega::WIND,
        &ardupilotmega::EKF_STATUS_REPORT,
    ];
    let theirs = || MavMessage::default_message_from_id(id).map(|message| message.message_name().to_owned());
    let known = ours.iter().find(|definition| definition.id == id).map(|definition| definition.name.to_owned());
    known.or_else(theirs).unwrap_or_else(|| panic!("message {id} has no name"))
}

fn rate(stream: &StreamSpec, kind: LinkKind) -> String {
    match stream.rate_hz(kind) {
        0.0 => "on request".to_owned(),
        hz => hz.to_string(),
    }
}

fn flavors(stream: &StreamSpec) -> String {
    let all: [&Flavor; 3] = [&px4::FLAVOR, &ardupilot::FLAVOR, &generic::FLAVOR];
    let spoken: Vec<&str> = all.iter().filter(|flavor| stream.is_sent(flavor)).map(|flavor| flavor.name).collect();
    if spoken.len() == all.len() { "all".to_owned() } else { spoken.join(", ") }
}

/// Returns one row per stream; sensors that send the same message at the same rate share a row.
fn streams() -> String {
    let mut rows: Vec<Vec<String>> = Vec::new();
    for stream in STREAMS {
        let component = if stream.component == CAMERA { "camera" } else { "autopilot" };
        let rates = [LinkKind::GroundStation, LinkKind::Sdk, LinkKind::Payload].map(|kind| rate(stream, kind));
        let row =
            [vec![name(stream.id), stream.id.to_string(), component.to_owned()], rates.to_vec(), vec![flavors(stream)]].concat();
        if !rows.contains(&row) {
            rows.push(row);
        }
    }
    rows.sort();
    table(&["message", "id", "component", "ground station (Hz)", "SDK (Hz)", "payload (Hz)", "interface"], rows)
}

fn handled_messages() -> String {
    let mut rows: Vec<(String, u32)> = HANDLED.iter().map(|id| (name(*id), *id)).collect();
    rows.sort();
    table(&["message", "id"], rows.into_iter().map(|(name, id)| vec![name, id.to_string()]))
}

#[test]
fn exact_messages_page_matches_the_code() {
    let asks: Vec<&str> = [&px4::FLAVOR, &ardupilot::FLAVOR, &generic::FLAVOR]
        .iter()
        .filter(|f| f.streams_on_request_only)
        .map(|f| f.name)
        .collect();
    let about = format!(
        "The vehicle sends these streams at rates that depend on the type of link, most of them without a request. With `--flavor {}`, ground stations and SDKs \
         receive only heartbeats until they request streams; payload links receive all streams immediately. SET_MESSAGE_INTERVAL changes a \
         rate, and REQUEST_MESSAGE requests a single message. [Scoring data](wire.md#scoring-data) lists the named values used for scoring.",
        asks.join(" or ")
    );
    let acts = "The vehicle handles these messages. It forwards all other messages to the links of the target, such as those of [the \
                monitor](wire.md#the-monitor): its NAV_CONTROLLER_OUTPUT (component 191) is about the next step of the job, the autopilot's own \
                about the autopilot's target.";
    let page = format!(
        "{}\n## Streams\n\n{}\n## Handled messages\n\n{acts}\n\n{}",
        page_head("Messages", &about),
        streams(),
        handled_messages()
    );
    check("messages.md", &page);
}
