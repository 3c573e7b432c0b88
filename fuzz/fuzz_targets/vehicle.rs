//! Any text: an aircraft or named problems, never a panic.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Err(problems) = spandrel_model::vehicle::read("fuzz.toml", text) {
        assert!(!problems.0.is_empty());
    }
});
