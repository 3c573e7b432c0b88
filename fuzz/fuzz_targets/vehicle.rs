//! Feeds arbitrary text to the vehicle parser, which must return an aircraft or a list of problems and never panic.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Err(problems) = spandrel_model::vehicle::read("fuzz.toml", text) {
        assert!(!problems.0.is_empty());
    }
});
