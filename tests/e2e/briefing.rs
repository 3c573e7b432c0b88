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

/// A PNG file of one pixel.
const PIXEL: &[u8] = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\0\0\0\0:~\x9bU\0\0\0\nIDATx\x9cc`\0\0\0\x02\0\x01H\xaf\xa4q\0\0\0\0IEND\xaeB`\x82";

/// Runs the program. Returns whether it succeeded, standard output and standard error.
fn run(arguments: &[&str]) -> (bool, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_spandrel")).args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.success(), text(output.stdout), text(output.stderr))
}

#[test]
fn wire_pictures_are_embedded_and_only_the_page_needs_them() {
    let folder = tempfile::tempdir().unwrap();
    let job = folder.path().join("job.toml");
    let table = "[[briefing_pictures]]\nfile = \"gate.png\"\ncaption = \"The gate\"\n";
    let text = spandrel_model::shipped::PRACTICE.replacen("[origin]", &format!("{table}\n[origin]"), 1);
    std::fs::write(&job, &text).unwrap();
    let job = job.display().to_string();
    let page = folder.path().join("briefing.html").display().to_string();
    let html = ["brief", "--scenario", &job, "--html", &page];
    // Without the file, the texts are complete.
    let (is_good, shown, _) = run(&["brief", "--scenario", &job]);
    assert!(is_good && shown.contains("gate.png: The gate"), "{shown}");
    let (is_good, shown, _) = run(&["brief", "--scenario", &job, "--json"]);
    let json: serde_json::Value = serde_json::from_str(&shown).unwrap();
    assert!(is_good && json["pictures"] == serde_json::json!([{ "file": "gate.png", "caption": "The gate" }]), "{shown}");
    let line = 1 + text.lines().position(|line| line.contains("gate.png")).unwrap();
    let problem = format!("{job}:{line}: briefing_pictures[].file = gate.png: cannot read");
    let (is_good, _, error) = run(&html);
    assert!(!is_good && error.contains(&problem), "{error}");
    let (is_good, shown, _) = run(&["check", &job]);
    assert!(!is_good && shown.contains(&problem) && shown.contains("allowed: a PNG or JPEG file"), "{shown}");
    std::fs::write(folder.path().join("gate.png"), PIXEL).unwrap();
    assert_eq!(run(&html), (true, String::new(), String::new()));
    let html = std::fs::read_to_string(page).unwrap();
    assert!(html.contains("<img src=\"data:image/png;base64,iVBORw0KGgo") && html.contains("<figcaption>The gate</figcaption>"));
    assert!(run(&["check", &job]).0);
}
