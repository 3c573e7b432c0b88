use super::*;
use crate::questionnaire::{InspectionPhase, OverallItem, PhaseAspect, QuestionnaireItem};
use crate::record::CertificationRecord;
use crate::terms::measure_title;
use crate::testing::{aborted_record, perfect_record};
use spandrel_model::random::RandomStream;
use spandrel_monitor::score::certification::CertificationScores;
use spandrel_monitor::score::certification::precision::PrecisionMeasures;
use spandrel_text::Language;

/// Returns records of 22 trainees, the first eight with three sessions each. Scores and answers are random, but higher demand
/// leads to more strain and more strain to less safety.
fn pilot_study_records() -> Vec<SessionRecord> {
    let mut stream = RandomStream::new(11, "made-up cohort");
    let mut records = Vec::new();
    for person in 0..22usize {
        for repetition in 0..if person < 8 { 3 } else { 1 } {
            let mut record = perfect_record(&format!("p{person:02}"), repetition + 1);
            let demand = stream.range(1.0, 5.0);
            let strain = (0.7 * demand + stream.range(0.0, 1.5)).clamp(1.0, 5.0);
            let answers = record.answers.as_mut().unwrap();
            for item in QuestionnaireItem::all(&[1, 2, 3, 4]) {
                let value = match item {
                    QuestionnaireItem::Overall(OverallItem::TimePressure | OverallItem::Frustration) => strain,
                    QuestionnaireItem::Overall(OverallItem::Feedback) => stream.range(1.0, 3.4),
                    QuestionnaireItem::Phase(_, PhaseAspect::Performance) => stream.range(1.0, 4.0),
                    QuestionnaireItem::Phase(_, PhaseAspect::MentalDemand | PhaseAspect::PhysicalDemand) => {
                        demand + stream.range(-0.5, 0.5)
                    }
                };
                answers.given.insert(item, value.round().clamp(1.0, 5.0) as u8);
            }
            record.scores.conformity = Some(stream.range(60.0, 80.0) + 5.0 * repetition as f64);
            record.scores.safety = (100.0 - 12.0 * strain + stream.range(-5.0, 5.0)).clamp(0.0, 100.0);
            record.scores.overall = record.scores.conformity.unwrap() + 100.0 + record.scores.safety + 100.0;
            record.tasks[2].crashes.bridge = stream.below(4);
            record.crashes_outside.water = stream.below(2);
            record.seconds = stream.range(600.0, 1500.0);
            records.push(record);
        }
    }
    records
}

/// Returns the limitations in English.
fn words(cohort: &Cohort) -> Vec<String> {
    cohort.limitations.iter().map(|one| one.words(Language::English)).collect()
}

fn analyzed(records: &[SessionRecord]) -> Cohort {
    cohort(records, &Selection { scenarios: Vec::new(), repetitions: 3, incomplete: IncompletePolicy::Exclude })
}

#[test]
fn exact_tasbid_study_design_yields_tables_of_expected_size() {
    let cohort = analyzed(&pilot_study_records());
    assert_eq!((cohort.trainees, cohort.sessions, cohort.group.len()), (22, 38, 8));
    assert_eq!(cohort.scenarios, ["two-bridges"]);
    assert_eq!(cohort.distributions.len(), 5);
    assert!(cohort.distributions.iter().all(|one| one.summary.n == 22));
    assert_eq!(cohort.distributions[4].histogram.iter().map(|bar| bar.count).sum::<usize>(), 22);
    assert_eq!(cohort.boxes.len(), 15);
    assert_eq!(cohort.tests.len(), 15);
    // 24 questions, counted once over all first sessions and once per repetition.
    assert_eq!(cohort.likert.len(), 96);
    assert_eq!(cohort.crashes.rows.len(), 22);
    assert_eq!(cohort.crashes.total, cohort.crashes.by_task.iter().sum::<usize>());
    assert_eq!(cohort.crashes.total, cohort.crashes.by_kind.total());
    assert_eq!(cohort.progress[0].repetitions.len(), 3);
    assert!(cohort.progress.iter().all(|one| one.curves.is_empty()), "a curve requires four repetitions");
    assert!(words(&cohort).iter().any(|words| words.contains("22 trainees") && words.contains("78")), "{:?}", cohort.limitations);
}

#[test]
fn exact_repetitions_are_chronological_and_paired_by_trainee() {
    let mut records = pilot_study_records();
    let expected = analyzed(&records);
    records.reverse();
    assert_eq!(analyzed(&records), expected, "results depend on the order of the records");
    let test = expected.tests.iter().find(|test| test.score == "conformity" && (test.earlier, test.later) == (1, 3)).unwrap();
    assert_eq!(test.test.n, 8);
    let of = |k: usize| {
        let scores: Vec<f64> = expected.progress[..8].iter().filter_map(|one| one.repetitions[k].conformity).collect();
        scores.iter().sum::<f64>() / 8.0
    };
    assert!((test.test.mean_difference - (of(2) - of(0))).abs() < 1e-9);
    let holm = test.p_holm.unwrap();
    assert!(holm.upper >= test.test.p.unwrap().upper && holm.two <= 1.0);
    // Efficiency is always 100, so t is undefined and the test is excluded from the Holm correction.
    let flat = expected.tests.iter().find(|test| test.score == "efficiency").unwrap();
    assert_eq!((flat.test.t, flat.p_holm), (None, None));
}

#[test]
fn exact_causal_model_recovers_generating_effects() {
    let model = analyzed(&pilot_study_records()).causal.unwrap();
    let of = |model: &crate::statistics::Regression, name: &str| {
        model.coefficients.iter().find(|one| one.name == name).unwrap().estimate
    };
    assert_eq!(model.n, 22);
    assert!((of(&model.strain, "demand") - 0.7).abs() < 0.25, "{:?}", model.strain.coefficients);
    // 12 points per unit of strain correspond to 3% of 400.
    assert!((of(&model.performance, "strain") + 3.0).abs() < 1.5, "{:?}", model.performance.coefficients);
    let middle = model.indirect[1];
    let interval = middle.interval_95.unwrap();
    assert!(interval[0] < middle.effect && middle.effect < interval[1] && interval[1] < 0.0, "{middle:?}");
    assert_eq!(analyzed(&pilot_study_records()).causal.unwrap(), model, "the bootstrap is reproducible");
}

#[test]
fn exact_contradictions_are_found() {
    let mut records: Vec<SessionRecord> = (0..8).map(|k| perfect_record(&format!("p{k}"), 1)).collect();
    for (k, record) in records.iter_mut().enumerate() {
        record.scores.overall = 400.0 - 10.0 * k as f64;
        record.seconds = 800.0 + 50.0 * k as f64;
    }
    records[0].answers.as_mut().unwrap().given.insert(QuestionnaireItem::Overall(OverallItem::TimePressure), 4);
    let found = analyzed(&records).self_rating.contradictions;
    let of = |who: &str| found.iter().filter(|one| one.trainee == who).map(|one| one.kind).collect::<Vec<_>>();
    assert!(of("p0").contains(&ContradictionKind::FastUnderPressure { time_s: 800.0 }));
    assert!(of("p7").iter().any(|kind| matches!(kind, ContradictionKind::RatedTooHigh { .. })));
    assert!(of("p7").contains(&ContradictionKind::SlowWithoutPressure { time_s: 1150.0 }));
    assert!(of("p3").is_empty() && of("p4").is_empty());
}

#[test]
fn regress_a_flight_that_did_not_land_is_not_fast() {
    let mut records: Vec<SessionRecord> = (0..8).map(|k| perfect_record(&format!("p{k}"), 1)).collect();
    for (k, record) in records.iter_mut().enumerate() {
        record.seconds = 800.0 + 50.0 * k as f64;
        record.answers.as_mut().unwrap().given.insert(QuestionnaireItem::Overall(OverallItem::TimePressure), 4);
    }
    // The shortest flight ended in a vehicle.
    (records[0].end_reason, records[0].seconds) = ("vehicle".into(), 288.0);
    let selection = Selection { scenarios: Vec::new(), repetitions: 2, incomplete: IncompletePolicy::Include };
    let found = cohort(&records, &selection).self_rating.contradictions;
    let fast: Vec<&str> = found
        .iter()
        .filter(|one| matches!(one.kind, ContradictionKind::FastUnderPressure { .. }))
        .map(|one| one.trainee.as_str())
        .collect();
    assert_eq!(fast, ["p1", "p2"], "{found:?}");
}

/// Gives a record a form with a predicted detection.
fn on_form(mut record: SessionRecord, form: &str, detection_pct: f64) -> SessionRecord {
    (record.form, record.form_detection_pct) = (Some(form.into()), Some(detection_pct));
    record
}

#[test]
fn exact_pooled_forms_are_named() {
    let limitations = |records: &[SessionRecord]| analyzed(records).limitations;
    let same = [on_form(perfect_record("anna", 1), "A", 95.0), on_form(perfect_record("ben", 1), "A", 95.0)];
    assert!(!limitations(&same).iter().any(|one| matches!(one, Limitation::PooledForms(_))));
    let mixed = [same.as_slice(), &[on_form(perfect_record("anna", 2), "H", 25.0)]].concat();
    let found = limitations(&mixed);
    assert!(found.contains(&Limitation::PooledForms(vec!["A".into(), "H".into()])), "{found:?}");
}

#[test]
fn exact_progress_compares_only_equated_forms() {
    let forms = [("A", 95.0), ("H", 25.0), ("B", 95.0)];
    let records: Vec<SessionRecord> =
        (1..).zip(forms).map(|(k, (form, pct))| on_form(perfect_record("anna", k), form, pct)).collect();
    let jobs = by_job(&records, IncompletePolicy::Exclude, &JobReliability::new());
    let shown: Vec<(String, usize)> = jobs.iter().map(|job| (job.forms.join(""), job.progress.repetitions.len())).collect();
    assert_eq!(shown, [("AB".to_owned(), 2), ("H".to_owned(), 1)]);
}

#[test]
fn exact_details_have_the_reliability_of_the_same_values() {
    let crashes = [[5.0, 0.0], [2.0, 3.0], [7.0, 6.0]];
    let mut records = Vec::new();
    for (who, counts) in ["anna", "ben", "cleo"].into_iter().zip(crashes) {
        for (k, count) in (1..).zip(counts) {
            let mut record = perfect_record(who, k);
            (record.tasks[0].crashes.bridge, record.tasks[0].on_path) = (count as usize, 0.9 - 0.02 * count);
            records.push(record);
        }
    }
    let known = job_reliability(&records, "two-bridges", IncompletePolicy::Exclude);
    let of = |key: &str| reliability_of(&known, key).unwrap().reliability;
    let expected = crate::statistics::reliability(&crashes.map(|counts| counts.to_vec())).unwrap();
    assert_eq!(of(&crash_key("bridge")), Some(expected));
    let task = records[0].tasks[0].name.clone();
    assert_eq!(of(&TaskDetail::Crashes.key(&task)), Some(expected));
    let (on_path, change) = (of(&TaskDetail::OnPath.key(&task)).unwrap(), expected.minimal_detectable_change);
    assert!((on_path.minimal_detectable_change - 2.0 * change).abs() < 1e-9, "2 points for each crash");
    assert_eq!(
        (of(&crash_key("water")), of(&TaskDetail::Speeding.key(&task))),
        (None, None),
        "without variance, the error is unknown"
    );
}

#[test]
fn exact_learning_curve_requires_four_repetitions() {
    let mut records: Vec<SessionRecord> = (1..=5).map(|k| perfect_record("anna", k)).collect();
    for (k, record) in records.iter_mut().enumerate() {
        record.scores.safety = 40.0 * spandrel_model::math::pow((k + 1) as f64, 0.4);
        record.scores.accuracy = None;
    }
    let cohort = analyzed(&records);
    let curve = cohort.progress[0].curves.iter().find(|curve| curve.score == "safety").unwrap();
    assert!((curve.curve.exponent - 0.4).abs() < 1e-9);
    assert!(!cohort.progress[0].curves.iter().any(|curve| curve.score == "accuracy"));
}

#[test]
fn exact_group_curve_fits_means_of_eligible_trainees() {
    let safety = |first: f64, k: usize| first * spandrel_model::math::pow(k as f64, 0.3);
    let mut records = Vec::new();
    // Two trainees' curves have the same exponent, so the curve of their mean has the same one. Only repetitions that
    // both trainees flew count. A third trainee has too few sessions, and a fourth has no accuracy score in one
    // session.
    for (who, first, times) in [("anna", 30.0, 6), ("ben", 50.0, 4), ("cleo", 90.0, 3), ("dan", 40.0, 4)] {
        for k in 1..=times {
            let mut record = perfect_record(who, k);
            record.scores.safety = safety(first, k);
            if who == "dan" && k == 2 {
                record.scores.accuracy = None;
            }
            records.push(record);
        }
    }
    let learning = analyzed(&records).learning;
    let of = |score: &str| learning.iter().find(|one| one.score == score).unwrap();
    assert_eq!((of("safety").people, of("safety").means.len(), of("accuracy").people), (3, 4, 2));
    assert!((of("safety").curve.exponent - 0.3).abs() < 1e-9 && (of("safety").curve.first - 40.0).abs() < 1e-6);
    assert!((of("safety").curve.at(3.0) - of("safety").means[2]).abs() < 1e-6);
    assert!(analyzed(&pilot_study_records()).learning.is_empty(), "a curve requires four repetitions");
}

#[test]
fn exact_rewound_sessions_are_not_compared() {
    let mut records = pilot_study_records();
    let all = analyzed(&records);
    records[0].practice_aids.rewinds = 2;
    let without = analyzed(&records);
    assert_eq!((without.sessions, without.left_out), (all.sessions - 1, all.left_out));
    let words = "1 session was frozen or rewound, and is not compared";
    assert!(self::words(&without).iter().any(|warning| warning == words), "{:?}", without.limitations);
    let repetitions = |records: &[SessionRecord]| {
        by_job(records, IncompletePolicy::Exclude, &JobReliability::new())[0].progress.repetitions.len()
    };
    assert_eq!(repetitions(&records), records.len() - 1);
}

#[test]
fn exact_progress_is_separate_per_job() {
    let mut records: Vec<SessionRecord> = (1..=9).map(|k| perfect_record("anna", k)).collect();
    for record in records.iter_mut().step_by(2) {
        record.scenario = "drill-gap".into();
        record.tasks.truncate(1);
        record.scores.safety = 10.0;
    }
    records.reverse();
    let jobs = by_job(&records, IncompletePolicy::Exclude, &JobReliability::new());
    let told: Vec<(&str, usize, usize)> =
        jobs.iter().map(|job| (job.scenario.as_str(), job.tasks.len(), job.progress.repetitions.len())).collect();
    assert_eq!(told, [("two-bridges", 4, 4), ("drill-gap", 1, 5)], "the job is listed before its drills");
    assert!(jobs[0].progress.repetitions.iter().all(|one| one.safety == 100.0));
    assert!(jobs[1].progress.repetitions.windows(2).all(|pair| pair[0].started_unix_us < pair[1].started_unix_us));
    assert_eq!((jobs[0].progress.curves.len(), jobs[1].progress.curves.len()), (5, 5));
    assert!(by_job(&[], IncompletePolicy::Exclude, &JobReliability::new()).is_empty());
}

#[test]
fn exact_small_and_empty_cohorts_have_warnings() {
    let none = analyzed(&[]);
    assert_eq!((none.trainees, none.causal, none.tests.len()), (0, None, 0));
    assert!(!none.limitations.is_empty());
    let one = analyzed(&[perfect_record("anna", 1)]);
    assert_eq!((one.trainees, one.distributions.len(), one.distributions[0].summary.sd), (1, 5, None));
    assert!(words(&one).iter().any(|words| words.contains("could not be estimated")));
    // Commas in quotes do not separate fields.
    let fields = |line: &str| 1 + line.split('"').step_by(2).map(|unquoted| unquoted.matches(',').count()).sum::<usize>();
    for (name, table) in tables(&one) {
        let columns = fields(table.lines().next().unwrap());
        assert!(table.lines().all(|line| fields(line) == columns), "{name}");
    }
}

#[test]
fn exact_only_selected_jobs_count() {
    let mut records = pilot_study_records();
    let mut drill = perfect_record("p00", 9);
    drill.scenario = "drill-gap".into();
    records.push(drill);
    assert_eq!(analyzed(&records).sessions, 38);
    let both = Selection {
        scenarios: vec!["two-bridges".into(), "drill-gap".into()],
        repetitions: 3,
        incomplete: IncompletePolicy::Exclude,
    };
    assert_eq!(cohort(&records, &both).sessions, 39);
}

#[test]
fn exact_task_self_rating_correlates_with_its_path_share() {
    let mut records: Vec<SessionRecord> = (0..6).map(|k| perfect_record(&format!("p{k}"), 1)).collect();
    for (k, record) in records.iter_mut().enumerate() {
        record.tasks[2].on_path = 0.3 + 0.1 * k as f64;
        let answer = 5 - (k as u8).min(4);
        record
            .answers
            .as_mut()
            .unwrap()
            .given
            .insert(QuestionnaireItem::Phase(InspectionPhase::Task(3), PhaseAspect::Performance), answer);
    }
    let rating = analyzed(&records).self_rating;
    let third = rating.tasks.iter().find(|(id, _)| *id == 3).and_then(|(_, correlation)| *correlation).unwrap();
    assert!(third.r > 0.95, "{third:?}");
    assert_eq!(rating.tasks.iter().find(|(id, _)| *id == 1).unwrap().1, None, "all answers are equal");
}

#[test]
fn regress_aborted_session_is_not_a_first_session_by_default() {
    let records = vec![aborted_record("anna", 1), perfect_record("anna", 2), perfect_record("ben", 1), aborted_record("cleo", 1)];
    let of = |incomplete: IncompletePolicy| cohort(&records, &Selection { scenarios: Vec::new(), repetitions: 1, incomplete });
    let (without, with) = (of(IncompletePolicy::Exclude), of(IncompletePolicy::Include));
    assert_eq!((without.trainees, without.sessions, without.left_out), (2, 2, 2));
    assert_eq!(
        without.individuals.iter().map(|one| one.session.as_str()).collect::<Vec<_>>(),
        ["session-anna-002", "session-ben-001"]
    );
    assert_eq!(without.progress[0].repetitions.len(), 1);
    assert_eq!((with.trainees, with.sessions, with.left_out), (3, 4, 0));
    assert_eq!(with.individuals[0].session, "session-anna-001");
    let older = vec![SessionRecord { completion: None, ..perfect_record("anna", 1) }];
    let older = cohort(&older, &Selection { scenarios: Vec::new(), repetitions: 1, incomplete: IncompletePolicy::Exclude });
    assert_eq!((older.sessions, older.left_out), (0, 1), "a record without completion data counts as incomplete");
}

#[test]
fn regress_learning_curves_exclude_incomplete_sessions() {
    let mut records: Vec<SessionRecord> = (1..=4).map(|k| perfect_record("anna", k)).collect();
    records.push(aborted_record("anna", 5));
    let (without, with) = (
        &by_job(&records, IncompletePolicy::Exclude, &JobReliability::new())[0],
        &by_job(&records, IncompletePolicy::Include, &JobReliability::new())[0],
    );
    assert_eq!((without.progress.repetitions.len(), without.left_out), (4, 1));
    assert_eq!((with.progress.repetitions.len(), with.left_out), (5, 0));
    assert!(without.progress.curves.iter().all(|curve| curve.curve.n == 4));
}

#[test]
fn exact_reliability_covers_every_measure_and_labels_changes() {
    let mut records = pilot_study_records();
    for (k, record) in records.iter_mut().enumerate() {
        record.scores.accuracy = Some(if k % 2 == 0 { 100.0 } else { 60.0 });
        // Trainees differ by more than their sessions do.
        let ability: f64 = record.trainee[1..].parse().unwrap();
        record.scores.conformity = record.scores.conformity.map(|noise| 0.5 * noise + 4.0 * ability);
    }
    let cohort = analyzed(&records);
    let of = |measure: &str| reliability_of(&cohort.reliability, measure).unwrap();
    assert_eq!(cohort.reliability.len(), 14);
    let conformity = of("conformity").reliability.unwrap();
    assert_eq!((conformity.n, conformity.repetitions), (8, 3));
    assert!(
        0.7 < conformity.icc_2_1 && conformity.icc_2_1 < conformity.icc_3_1,
        "all trainees improve, which lowers only the agreement: {conformity:?}"
    );
    assert_eq!((of("accuracy").sessions, of("accuracy").at_ceiling), (38, Some(0.5)));
    // Efficiency is 100 in every session: nothing to estimate, and no change is labeled.
    assert_eq!((of("efficiency").reliability, of("efficiency").at_ceiling), (None, Some(1.0)));
    assert!(words(&cohort).iter().any(|words| words.starts_with("no reliability of efficiency: ")), "{:?}", cohort.limitations);
    let flat = cohort.tests.iter().find(|test| test.score == "efficiency").unwrap();
    assert_eq!((flat.within_error, flat.trainees_beyond_error), (None, None));
    for test in cohort.tests.iter().filter(|test| test.score == "conformity") {
        let least = conformity.minimal_detectable_change / 8.0f64.sqrt();
        assert_eq!(test.within_error, Some(test.test.mean_difference.abs() < least));
        assert!(test.trainees_beyond_error.unwrap() <= 8);
    }
    for trainee in &cohort.progress {
        assert!(trainee.repetitions[0].within_error.is_empty(), "the first session is not compared with anything");
        for pair in trainee.repetitions.windows(2) {
            let change = pair[1].conformity.unwrap() - pair[0].conformity.unwrap();
            let labeled = pair[1].within_error.iter().any(|score| score == "conformity");
            assert_eq!(labeled, change.abs() < conformity.minimal_detectable_change, "{change}");
        }
    }
}

/// Returns certification results that a trainee's ability determines up to a random part.
fn certification(ability: f64, stream: &mut RandomStream) -> CertificationRecord {
    let mut score = || 40.0 + 2.0 * ability + stream.range(0.0, 5.0);
    let scores = CertificationScores {
        conformity: Some(score()),
        efficiency: score(),
        safety: score(),
        accuracy: Some(score()),
        precision: Some(score()),
        sum: score(),
        sum_max: 500.0,
    };
    let precision = PrecisionMeasures {
        frames: 1000,
        rms_distance_ratio: 0.01 * score(),
        rms_speeding_ratio: 0.0,
        rms_framing_deg: None,
        low_clearance_share: 0.0,
    };
    CertificationRecord { scores, requirements: Vec::new(), precision: Some(precision), time_ratio: None }
}

#[test]
fn exact_reliability_covers_the_certification_and_the_distance_from_the_path() {
    let mut stream = RandomStream::new(12, "made-up certifications");
    let mut records = pilot_study_records();
    for record in &mut records {
        let ability: f64 = record.trainee[1..].parse().unwrap();
        record.certification = Some(certification(ability, &mut stream));
    }
    // Records before format 7 have no RMS distance.
    records.last_mut().unwrap().certification.as_mut().unwrap().precision = None;
    let cohort = analyzed(&records);
    let names =
        ["conformity", "precision", "safety", "accuracy", "efficiency", "sum"].map(|name| format!("certification_{name}"));
    for name in names.iter().map(String::as_str).chain(["rms_distance"]) {
        let one = reliability_of(&cohort.reliability, name).unwrap();
        let known = one.reliability.unwrap();
        assert!((known.n, known.repetitions) == (8, 3) && known.icc_2_1 > 0.8, "{name}: {known:?}");
        assert_eq!((one.unit, one.sessions), if name == "rms_distance" { ("%", 37) } else { ("points", 38) }, "{name}");
        assert_eq!(one.at_ceiling, Some(0.0), "{name}");
    }
    let titles = |key: &str| Language::ALL.map(|language| measure_title(key, language));
    for one in &cohort.reliability {
        let [english, german, spanish] = titles(&one.measure);
        assert!(!english.contains('_') && german != english && spanish != english, "{english}, {german}, {spanish}");
    }
    assert_eq!(titles("certification_safety")[0], "impact-weighted safety");
    let row = |table: &str| table.lines().find(|line| line.starts_with("rms_distance,%,37,")).map(str::to_owned);
    assert!(table(&cohort, "reliability.csv").is_some_and(|table| row(&table).is_some()));
    // A session of a trainee with repetitions without the measure: this trainee does not count.
    records[0].certification = None;
    let fewer = reliability_of(&analyzed(&records).reliability, "certification_safety").unwrap().reliability.unwrap().n;
    assert_eq!(fewer, 7);
}

#[test]
fn exact_first_sessions_have_both_headlines() {
    let mut records = vec![aborted_record("anna", 1), perfect_record("anna", 2), perfect_record("ben", 1)];
    (records[2].certified, records[2].unmet) = (false, vec!["accuracy 40, 50 needed".into(), "precision 30, 45 needed".into()]);
    let of = |incomplete| cohort(&records, &Selection { scenarios: Vec::new(), repetitions: 1, incomplete });
    let (with, without) = (of(IncompletePolicy::Include), of(IncompletePolicy::Exclude));
    assert_eq!((with.sessions, with.incomplete, with.certified), (3, 1, 1));
    assert_eq!((without.sessions, without.incomplete, without.left_out, without.certified), (2, 0, 1, 1));
    let state = |cohort: &Cohort| cohort.individuals.iter().map(|one| (one.complete, one.certified)).collect::<Vec<_>>();
    assert_eq!((state(&with), state(&without)), (vec![(false, false), (true, false)], vec![(true, true), (true, false)]));
    let csv = table(&with, "individuals.csv").unwrap();
    let end = |k: usize| csv.lines().nth(k).unwrap().split_once("700.25,").unwrap().1.to_owned();
    assert!(csv.lines().next().unwrap().ends_with(",purpose,complete,completion,certified,unmet"), "{csv}");
    assert_eq!(
        end(1),
        ",0,\"Incomplete: 0 of 4 tasks, 15% of the path\",0,\"task 1 not done: 60% of its path, 80% needed; not landed at home\""
    );
    assert_eq!(end(2), ",1,\"Complete: 4 of 4 tasks, 100% of the path\",0,\"accuracy 40, 50 needed; precision 30, 45 needed\"");
}

#[test]
fn regress_equal_flight_times_make_nobody_slow() {
    let mut records: Vec<SessionRecord> = (0..8).map(|k| perfect_record(&format!("p{k}"), 1)).collect();
    for (k, record) in records.iter_mut().enumerate() {
        // Flights that differ by one frame, and scores that differ by less than a printed digit.
        record.seconds = 700.0 + k as f64 / 30.0;
        record.scores.overall = 400.0 - 0.01 * k as f64;
    }
    records[0].answers.as_mut().unwrap().given.insert(QuestionnaireItem::Overall(OverallItem::TimePressure), 5);
    assert_eq!(analyzed(&records).self_rating.contradictions, []);
    // A flight time beyond the error of the measure still counts.
    records[7].seconds = 900.0;
    let found = analyzed(&records).self_rating.contradictions;
    let slow = Contradiction { trainee: "p7".into(), kind: ContradictionKind::SlowWithoutPressure { time_s: 900.0 } };
    assert_eq!(found, [slow]);
}

#[test]
fn exact_learning_curves_are_labeled_with_the_error_of_the_score() {
    let mut records = Vec::new();
    for (who, step) in [("anna", 10.0), ("ben", 9.0)] {
        for k in 1..=4 {
            let mut record = perfect_record(who, k);
            record.scores.safety = 20.0 + step * k as f64;
            record.scores.conformity = Some(if (k + who.len()) % 2 == 0 { 80.0 } else { 90.0 });
            records.push(record);
        }
    }
    let selection = Selection { scenarios: Vec::new(), repetitions: 4, incomplete: IncompletePolicy::Exclude };
    let cohort = cohort(&records, &selection);
    let label = |score: &str| cohort.progress[0].curves.iter().find(|curve| curve.score == score).unwrap().within_error;
    assert_eq!((label("safety"), label("conformity"), label("efficiency")), (Some(false), Some(true), None));
    let group = cohort.learning.iter().find(|curve| curve.score == "safety").unwrap();
    assert_eq!(group.within_error, Some(false));
    // The same labels on one trainee's page, with the reliability from all trainees.
    let known = JobReliability::from([("two-bridges".to_owned(), cohort.reliability.clone())]);
    let jobs = by_job(&records[..4], IncompletePolicy::Exclude, &known);
    assert_eq!(jobs[0].progress, cohort.progress[0]);
}
