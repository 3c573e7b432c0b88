//! Tests of statements in the help text.

use spandrel_testkit::shipped::text;

#[test]
fn regress_sim_does_not_respawn_by_default() {
    let help = std::process::Command::new(env!("CARGO_BIN_EXE_spandrel")).args(["sim", "--help"]).output().unwrap();
    let help = String::from_utf8_lossy(&help.stdout).into_owned();
    let rule = help.split("--after-crash").nth(1).expect("the option must exist");
    assert!(rule.split("--").next().is_some_and(|text| text.contains("[default: continue]")), "{rule}");
    // Sessions pass the job's own rule.
    for source in ["src/cli/demo.rs", "src/cli/train/flight_processes.rs"] {
        assert!(text(source).contains("\"--after-crash\""), "{source}");
    }
}
