//! Difficulty levels: what a level changes, the checksums, and the errors in the `[difficulty]` table.

use spandrel_model::scenario::{BridgeKind, Scenario, level_count, read, resolve, select_level};
use spandrel_model::shipped::{DRILL_GAP, DRILL_HOVER, DRILL_LAMP, DRILL_SEARCH, PILOT_STUDY, TWO_BRIDGES};
use spandrel_model::site::Site;
use spandrel_model::toml::Problems;

fn parse(text: &str) -> Result<Scenario, Problems> {
    read("job.toml", text, &|file| Err(format!("no file {file}")))
}

fn at(text: &str, level: u8) -> Scenario {
    parse(&select_level(text, level)).unwrap()
}

/// Returns the first error of the hover drill with one text replaced, without file and line.
fn problem(from: &str, to: &str) -> String {
    assert!(DRILL_HOVER.contains(from), "{from}");
    let text = parse(&DRILL_HOVER.replacen(from, to, 1)).unwrap_err().0[0].to_string();
    text.split_once(": ").map(|(_, words)| words.to_owned()).unwrap()
}

/// Returns a scenario without its `[difficulty]` table.
fn without_table(text: &str) -> &str {
    text.split_once("\n# [easiest, hardest]").map(|(before, _)| before).unwrap()
}

#[test]
fn exact_levels_interpolate_from_the_ends_to_the_files_own_values() {
    let of = |level: u8| {
        let job = at(DRILL_HOVER, level);
        (job.wind.speed_m_s, job.tasks[0].threshold_m)
    };
    let own = parse(without_table(DRILL_HOVER)).unwrap();
    let light_m_s = own.wind.speed_m_s;
    assert_eq!(of(1), (0.0, 2.5));
    assert_eq!(of(3), (0.5 * light_m_s, 2.0));
    assert_eq!(of(5), (light_m_s, 1.5));
    assert_eq!(of(7), (0.5 * light_m_s + 4.0, 0.5 * 1.5 + 0.5 * 0.8));
    assert_eq!(of(9), (8.0, 0.8));
    let difficulty = at(DRILL_HOVER, 7).difficulty.unwrap();
    assert_eq!((difficulty.level, difficulty.levels(), difficulty.standard), (7, 9, 5));
    assert_eq!(difficulty.settings_at(9), "wind 8 m/s, on path within 0.8 m");
    assert_eq!(difficulty.settings_at(10), "");
}

#[test]
fn exact_gap_and_defects_follow_the_level() {
    let gap_m = |level: u8| {
        let BridgeKind::Arch(arch) = &at(DRILL_GAP, level).bridges[0].kind else { panic!("not an arch") };
        arch.crown_gap_m
    };
    assert_eq!([1, 5, 9].map(gap_m), [5.0, 3.4, 2.8]);
    assert_eq!([1, 5, 9].map(|level| at(DRILL_SEARCH, level).defects.mean_detection), [Some(0.8), Some(0.5), Some(0.25)]);
}

#[test]
fn exact_standard_level_is_the_file_without_the_table() {
    let plain = parse(without_table(DRILL_HOVER)).unwrap();
    for text in [DRILL_HOVER.to_owned(), select_level(DRILL_HOVER, 5)] {
        let job = parse(&text).unwrap();
        assert_eq!(Scenario { difficulty: None, ..job.clone() }, plain, "the checksum is the same, too");
        assert_eq!(job.name_with_form(), "drill-hover");
    }
    assert_eq!(at(DRILL_HOVER, 7).name_with_form(), "drill-hover@7");
    assert_eq!((level_count(DRILL_HOVER), level_count(TWO_BRIDGES)), (Some(9), None));
}

#[test]
fn exact_severity_of_hazards_follows_the_level() {
    let text = DRILL_HOVER.replacen("wind_speed_m_s = [0.0, 8.0]", "hazard_severity = [0.5, 2.0]", 1);
    let text = format!("{text}\n[hazards]\nradio = true\n");
    let severity = |level: u8| parse(&select_level(&text, level)).unwrap().hazards.severity;
    assert_eq!([1, 5, 7, 9].map(severity), [0.5, 1.0, 1.5, 2.0]);
    assert!(parse(&text).unwrap().difficulty.unwrap().settings_at(9).contains("hazard severity 2"));
    let wrong = parse(&text.replace("radio = true", "radio = true\nseverity = 3.0")).unwrap_err().to_string();
    assert!(wrong.contains("hazards.severity = 3.0: ") && wrong.contains("0.5 to 2"), "{wrong}");
}

#[test]
fn exact_each_level_has_its_own_checksum_which_survives_resolving() {
    let checksums: Vec<u32> = (1..=9).map(|level| at(DRILL_HOVER, level).crc).collect();
    assert!((0..9).all(|k| !checksums[..k].contains(&checksums[k])), "{checksums:?}");
    let source = select_level(DRILL_HOVER, 3);
    let (job, resolved) = (parse(&source).unwrap(), parse(&resolve(&source, 5, &[])).unwrap());
    assert_eq!((resolved.crc, &resolved.difficulty), (job.crc, &job.difficulty));
    let standard = resolve(DRILL_HOVER, 5, &[]);
    assert!(standard.contains("\nlevel = 5\n"), "a session states its level: {standard}");
    assert_eq!(parse(&standard).unwrap().crc, parse(DRILL_HOVER).unwrap().crc);
}

#[test]
fn regress_sessions_with_levels_of_defects_can_be_read() {
    for drill in [DRILL_LAMP, DRILL_SEARCH] {
        let source = select_level(drill, 7);
        let job = parse(&source).unwrap();
        let defects = Site::build(&job, 5).defects().to_vec();
        assert!(!defects.is_empty());
        let session = parse(&resolve(&source, 5, &defects)).unwrap();
        assert_eq!((session.crc, &session.difficulty, session.defects.placed), (job.crc, &job.difficulty, Some(defects)));
    }
}

#[test]
fn regress_wrong_levels_and_tables_are_reported() {
    let wrong = |text: &str| parse(text).unwrap_err().to_string();
    let unknown = wrong(&select_level(DRILL_HOVER, 10));
    assert!(unknown.ends_with("level = 10: unknown difficulty level (allowed: 1 to 9)"), "{unknown}");
    let none = wrong(&select_level(TWO_BRIDGES, 3));
    let expected = "level = 3: this job has no difficulty levels (allowed: only in a file with [difficulty])";
    assert!(none.ends_with(expected), "{none}");
    let forms = wrong(&format!("{PILOT_STUDY}\n[difficulty]\nwind_speed_m_s = [0.0, 8.0]\n"));
    assert!(forms.ends_with("difficulty: a job with forms (allowed: only in a file without [[forms]])"), "{forms}");
    let standard = "difficulty.standard = 10: too large (allowed: 1 to levels, which is 9)";
    assert_eq!(problem("standard = 5", "standard = 10"), standard);
    for (standard, level) in [(8, 9), (5, 6), (8, 6)] {
        // There is no arithmetic on a level that does not exist.
        let text =
            DRILL_HOVER.replacen("levels = 9", "levels = 5", 1).replacen("standard = 5", &format!("standard = {standard}"), 1);
        assert!(parse(&format!("level = {level}\n{text}")).is_err(), "standard {standard}, level {level}");
    }
    let empty = problem("wind_speed_m_s = [0.0, 8.0]\nthreshold_m = [2.5, 0.8]\n", "");
    assert!(
        empty.starts_with("difficulty: nothing changes with the level (allowed: at least one of wind_speed_m_s, "),
        "{empty}"
    );
}

#[test]
fn regress_wrong_ends_are_reported() {
    let wind = |ends: &str| problem("wind_speed_m_s = [0.0, 8.0]", ends);
    let range = "difficulty.wind_speed_m_s = [0.0, 31.0]: not a valid list (allowed: 2 numbers, each 0 to 30)";
    assert_eq!(wind("wind_speed_m_s = [0.0, 31.0]"), range);
    let order = "difficulty.wind_speed_m_s = [8, 0]: wrong order (allowed: easiest, hardest; the first is smaller)";
    assert_eq!(wind("wind_speed_m_s = [8.0, 0.0]"), order);
    let outside = "difficulty.wind_speed_m_s = [2, 8]: the file's own value is outside (allowed: a range that contains wind.speed_m_s = 0.983)";
    assert_eq!(wind("wind_speed_m_s = [2.0, 8.0]"), outside);
    let gap = wind("crown_gap_m = [5.0, 2.8]");
    assert_eq!(gap, "difficulty.crown_gap_m = [5, 2.8]: has no effect in this job (allowed: only with an arch bridge)");
    let defects = wind("detection_pct = [90.0, 30.0]");
    assert!(defects.contains("allowed: only with defects and defects.detection_pct"), "{defects}");
    let hazards = wind("hazard_severity = [0.5, 2.0]");
    assert!(hazards.contains("allowed: only with hazards.compass, hazards.sky or hazards.radio"), "{hazards}");
    let paper = problem("level = \"light\"", "level = \"light\"\nmodel = \"paper\"");
    assert!(paper.contains("allowed: only with the physical wind model"), "{paper}");
    assert!(wind("wind_sped_m_s = [0.0, 8.0]").contains("did you mean wind_speed_m_s?"));
}

#[test]
fn regress_job_must_be_valid_at_both_ends() {
    // At level 9, the time limit is as short as the time for the full score.
    let text = DRILL_HOVER.replace("[difficulty]\n", "[difficulty]\ntime_max_min = [25.0, 15.0]\n");
    let line = text.lines().position(|line| line == "[difficulty]").unwrap() + 1;
    let found = parse(&text).unwrap_err().to_string();
    let expected =
        "invalid at the hardest level: scoring.time_max_min = 15: too small (allowed: more than time_best_min, which is 15)";
    assert_eq!(found, format!("job.toml:{line}: difficulty = level 9: {expected}"));
    assert!(parse(&text.replace("15.0]", "15.1]")).is_ok());
}
