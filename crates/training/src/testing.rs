//! Synthetic session records for tests.

use super::questionnaire::{Answers, QuestionnaireItem};
use super::record::{Crashes, DefectRecord, FORMAT_VERSION, Scores, SessionRecord, SessionTechnique, TaskRecord, TaskTechnique};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::time::SimTime;
use spandrel_monitor::measures::practice_aids::PracticeAids;
use spandrel_monitor::score::completion::{Completion, TaskState};

/// Returns the first word that the pseudo language did not change, except the given ones; `None` if there is none.
pub fn untranslated_word<'a>(pseudo: &'a str, kept: &[&str]) -> Option<&'a str> {
    let words = pseudo.split(|c: char| !c.is_alphanumeric());
    // The letter m has no accented form.
    let mut plain = words.filter(|word| word.chars().any(|c| c.is_ascii_alphabetic() && !"mM".contains(c)));
    plain.find(|word| word.is_ascii() && !kept.contains(word))
}

/// Returns the first frame of a drone that hovers at a point.
pub fn hovering_frame(position_m: Vec3<Enu>) -> Frame {
    Frame {
        index: 1,
        time: SimTime::ZERO,
        sticks: [0.0; 4],
        light: false,
        snapshot: false,
        position_m,
        velocity_m_s: Vec3::zero(),
        battery_pct: 90.0,
        contact: ContactKind::None,
        missing: false,
        interpolated: false,
        clearance_m: None,
        armed: Some(true),
        on_ground: false,
    }
}

/// Returns the record of a perfect flight on the TASBID job, with all 24 questions answered "agree".
pub fn perfect_record(trainee: &str, number: usize) -> SessionRecord {
    let mut answers = Answers { language: "en".into(), ..Answers::default() };
    answers.given.extend(QuestionnaireItem::all(&[1, 2, 3, 4]).into_iter().map(|item| (item, 2)));
    SessionRecord {
        format: FORMAT_VERSION,
        id: format!("session-{trainee}-{number:03}"),
        fingerprint: format!("f{number}"),
        trainee: trainee.to_owned(),
        purpose: None,
        started_unix_us: 1_700_000_000_000_000 + 259_200_000_000 * number as u64,
        spandrel_version: "0.1.0".into(),
        scorer_version: 1,
        scenario: "two-bridges".into(),
        level: None,
        form: None,
        form_detection_pct: None,
        scenario_sha256: "s".into(),
        vehicle: "phantom2".into(),
        vehicle_sha256: "v".into(),
        telemetry_sha256: "t".into(),
        seed: 7,
        scores: Scores {
            conformity: Some(100.0),
            efficiency: 100.0,
            safety: 100.0,
            accuracy: Some(100.0),
            overall: 400.0,
            overall_max: 400.0,
        },
        completion: Some(Completion {
            complete: true,
            tasks_done: 4,
            tasks: 4,
            path_share: 1.0,
            landed_at_home: true,
            done_share: 0.8,
        }),
        tasks: ["slab_side", "arch_bottom", "interlayer", "pier_circle"]
            .into_iter()
            .zip(1..)
            .map(|(kind, id)| task(kind, id))
            .collect(),
        crashes_outside: Crashes::default(),
        defects: (1..=10).map(defect).collect(),
        snapshots: 10,
        hits: 10,
        end_reason: "landed".into(),
        seconds: 700.25,
        battery_failed: false,
        battery_at_end_pct: 55.5,
        covered: 1.0,
        certified: true,
        unmet: Vec::new(),
        practice_aids: PracticeAids::default(),
        certification: None,
        technique: Some(SessionTechnique::default()),
        answers: Some(answers),
    }
}

/// Returns the record of a session that ended early, after only 60% of the first task's path was flown.
pub fn aborted_record(trainee: &str, number: usize) -> SessionRecord {
    let mut record = perfect_record(trainee, number);
    record.completion =
        Some(Completion { complete: false, tasks_done: 0, tasks: 4, path_share: 0.15, landed_at_home: false, done_share: 0.8 });
    (record.tasks[0].state, record.tasks[0].covered) = (Some(TaskState::Part), Some(0.6));
    record.tasks[0].technique = Some(TaskTechnique { near_s: 60.0, passed: 0.6, ..TaskTechnique::default() });
    for task in &mut record.tasks[1..] {
        (task.state, task.covered, task.attempted) = (Some(TaskState::NotAttempted), Some(0.0), false);
        task.technique = Some(TaskTechnique::default());
    }
    record.end_reason = "abort".into();
    record.certified = false;
    record.unmet = vec!["task 1 not done: 60% of its path, 80% needed".into(), "not landed at home".into()];
    record
}

fn task(kind: &str, id: u32) -> TaskRecord {
    TaskRecord {
        id,
        name: format!("The {kind}"),
        kind: kind.to_owned(),
        attempted: true,
        state: Some(TaskState::Done),
        covered: Some(1.0),
        seconds: 100.0,
        on_path: 1.0,
        speeding: 0.0,
        speeding_s: 0.0,
        fastest_m_s: 3.5,
        off_path_s: 0.0,
        off_sideways_m: None,
        off_height_m: None,
        crashes: Crashes::default(),
        defects_placed: 2,
        defects_found: 2,
        technique: Some(TaskTechnique { near_s: 100.0, passed: 1.0, ..TaskTechnique::default() }),
    }
}

fn defect(id: u32) -> DefectRecord {
    DefectRecord {
        id,
        kind: 1130,
        kind_name: "cracking (RC)".into(),
        element: spandrel_model::elements::Element::RcSlab,
        condition_state: 3,
        task: Some(1 + id % 4),
        found: true,
        lacked: Vec::new(),
        in_view_s: None,
        line: false,
        hidden: false,
        shortfalls: Vec::new(),
    }
}
