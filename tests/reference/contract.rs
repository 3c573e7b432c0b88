//! The telemetry contract page must match the code.

use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::modes::ControlSource;
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::contract::{VERSION, cue};
use spandrel_mavlink::dialect::MavMessage;
use spandrel_sitl::sim::CLEARANCE_SEARCH_RADIUS_M;
use spandrel_testkit::shipped::text;

fn page() -> String {
    text("docs/src/reference/contract.md")
}

#[test]
fn exact_contract_page_lists_every_name_code_and_bit() {
    let page = page();
    let has = |row: &str| assert!(page.contains(row), "docs/src/reference/contract.md lacks {row:?}");
    has(&format!("Version {VERSION}."));
    let named = [
        NamedValue::Contact(ContactKind::None),
        NamedValue::Hits(0),
        NamedValue::Respawns(0),
        NamedValue::Freezes(0),
        NamedValue::Rewinds(0),
        NamedValue::Frozen(false),
        NamedValue::Traffic(0),
        NamedValue::Walk(0),
        NamedValue::Seed(0),
        NamedValue::ScenarioCrc(0),
        NamedValue::ClearanceM(0.0),
        NamedValue::Lux(0.0),
        NamedValue::Pace(1.0),
        NamedValue::Cues(0),
    ];
    for value in named {
        let kind = if matches!(value.message(0), MavMessage::NAMED_VALUE_INT(_)) { "int" } else { "float" };
        has(&format!("| `{}` | {kind} |", value.name()));
    }
    for contact in ContactKind::ALL {
        has(&format!("| {} | {} | {} |", contact.code(), contact.label(), contact.severity()));
    }
    for (bit, name) in cue::ALL {
        has(&format!("| {bit} | {name} |"));
    }
}

#[test]
fn exact_contract_mode_table_matches_the_code() {
    let page = page();
    let copter = |source: ControlSource| {
        let numbers: Vec<String> =
            (0..64).filter(|mode| ControlSource::of(3, *mode) == source).map(|mode| mode.to_string()).collect();
        format!("{} |", numbers.join(", "))
    };
    for source in [ControlSource::Mission, ControlSource::Script, ControlSource::Autopilot] {
        let row = page.lines().find(|line| line.starts_with(&format!("| {} |", source.label()))).expect("a row for each mode");
        assert!(row.ends_with(&copter(source)), "{row}");
    }
    let px4 = |main: u32, sub: u32| ControlSource::of(12, main << 16 | sub << 24);
    assert_eq!((px4(4, 4), px4(6, 0), px4(3, 1)), (ControlSource::Mission, ControlSource::Script, ControlSource::Autopilot));
    assert!((0..256).filter(|sub| *sub != 4).all(|sub| px4(4, sub) == ControlSource::Autopilot));
    let by_hand = (0..256).filter(|main| ![4, 6].contains(main)).flat_map(|main| [(main, 0), (main, 2)]);
    assert!(by_hand.into_iter().all(|(main, sub)| px4(main, sub) == ControlSource::Pilot));
}

#[test]
fn exact_pages_state_the_largest_published_clearance() {
    let limit = format!("at most {CLEARANCE_SEARCH_RADIUS_M} m");
    for page in [page(), text("docs/src/reference/wire.md")] {
        let row = page.lines().find(|line| line.contains("| `clearance` |")).expect("a row for the clearance");
        assert!(row.contains(&limit), "{row} lacks {limit:?}");
    }
}
