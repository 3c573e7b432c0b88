//! `spandrel brief`: text, JSON and page.

use std::process::Command;

/// Runs `brief` for the paper's job. Returns its output.
fn brief(more: &[&str]) -> String {
    let output =
        Command::new(env!("CARGO_BIN_EXE_spandrel")).args(["brief", "--scenario", "two-bridges"]).args(more).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn wire_brief_writes_text_json_and_a_page_with_drawings() {
    let text = brief(&[]);
    for words in ["Tasks, in this order", "from west to east", "Hazards", "What counts", "Site check"] {
        assert!(text.contains(words), "{words}:\n{text}");
    }
    let json: serde_json::Value = serde_json::from_str(&brief(&["--json"])).unwrap();
    assert_eq!((json["job"].as_str(), json["tasks"].as_array().map(Vec::len)), (Some("two-bridges"), Some(4)));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("briefing.html");
    assert_eq!(brief(&["--html", &path.display().to_string()]), "");
    let page = std::fs::read_to_string(path).unwrap();
    assert_eq!((page.matches("<svg").count(), page.matches("class=\"start\"").count()), (3, 8), "each task in two drawings");
}
