//! Feeds arbitrary text to the scenario parser, which must return a scenario or a list of problems and never panic.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Err(problems) = spandrel_model::scenario::read("fuzz.toml", text, &|_| Ok("1,2\n3,4\n".into())) {
        assert!(!problems.0.is_empty());
    }
});
