//! Tests of the defect school.

use super::record::BOX_COUNT;
use super::*;
use crate::testing::untranslated_word;
use spandrel_model::defect_codes;
use spandrel_model::elements::Element;
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::PlacedDefect;
use spandrel_model::site::CameraPose;
use spandrel_text::Language;
use std::collections::BTreeSet;

/// A day in seconds.
const DAY_S: u64 = 86_400;
/// A time, s since the Unix epoch.
const NOW: u64 = 1_790_000_000;

fn every_card() -> Vec<Card> {
    let subjects = defect_codes::ALL.iter().map(|code| Subject::Defect(*code)).chain([Subject::Sound]);
    subjects.flat_map(|subject| Distance::ALL.map(|distance| Card { distance, subject })).collect()
}

/// Returns a picture of each card on an element that permits it. Cracks cannot be seen from 8 m.
fn pictures() -> Vec<SchoolPicture> {
    let picture = |card: Card| {
        let code = match card.subject {
            Subject::Sound => None,
            Subject::Defect(code) => Some(code),
        };
        let element = *Element::ALL.iter().find(|element| code.is_none_or(|code| element.permitted_defects().contains(&code)))?;
        let up = Vec3::new(0.0, 0.0, 1.0);
        let defect = code.map(|kind| PlacedDefect {
            id: 1,
            element,
            member: "arch/rib".into(),
            kind,
            condition_state: 2,
            position_m: Vec3::new(0.0, 0.0, 0.0),
            normal: up,
            along: Vec3::new(1.0, 0.0, 0.0),
            length_m: 0.4,
            width_m: 0.0005,
            line: defect_codes::is_line(kind),
            cause: None,
            stain: None,
        });
        let hidden = card.distance == Distance::Far && defect.as_ref().is_some_and(|defect| defect.line);
        let pose = CameraPose { position_m: up, forward: -up, right: Vec3::new(1.0, 0.0, 0.0), lamp_on: true };
        Some(SchoolPicture { card, pose, element, defect, visible: !hidden, pixel_m: 0.000_4 * f64::from(card.distance.m()) })
    };
    every_card().into_iter().filter_map(picture).collect()
}

/// Returns the number of the right answer to the current question.
fn right_number(round: &Round) -> usize {
    let question = round.question().unwrap();
    question.answers.iter().position(|answer| *answer == question.right_answer()).unwrap()
}

#[test]
fn prop_every_card_has_one_name() {
    let cards = every_card();
    let names: BTreeSet<String> = cards.iter().map(|card| card.name()).collect();
    assert_eq!(names.len(), cards.len());
    assert!(cards.iter().all(|card| Card::from_name(&card.name()) == Some(*card)));
    for wrong in ["1130@2m", "1130@03m", "01130@3m", "1131@3m", "1130@3", "@3m", "1130", ""] {
        assert_eq!(Card::from_name(wrong), None, "{wrong}");
    }
}

#[test]
fn exact_boxes_follow_the_answers() {
    let card = Card { distance: Distance::Middle, subject: Subject::Defect(defect_codes::SPALL) };
    let mut record = SchoolRecord::default();
    let mut steps = Vec::new();
    for right in [true, true, true, true, true, false, true] {
        record.answer(card, right, NOW);
        let progress = record.progress(card).unwrap();
        steps.push((progress.number, (progress.due_unix_s - NOW) / DAY_S));
    }
    assert_eq!(steps, [(2, 1), (3, 3), (4, 7), (5, 21), (BOX_COUNT, 21), (1, 0), (2, 1)]);
    let progress = record.progress(card).unwrap();
    assert_eq!((progress.asked, progress.right), (7, 6));
}

#[test]
fn exact_due_cards_come_first_then_new_ones_from_near_to_far() {
    let crack = |distance| Card { distance, subject: Subject::Defect(defect_codes::CRACK) };
    let mut record = SchoolRecord::default();
    record.answer(crack(Distance::Far), false, NOW);
    record.answer(crack(Distance::Middle), true, NOW);
    let available: Vec<Card> = every_card();
    let chosen = record.choose(&available, 3, NOW);
    assert_eq!(chosen[0], crack(Distance::Far), "missed cards are due at once");
    assert!(chosen[1..].iter().all(|card| card.distance == Distance::Near && record.progress(*card).is_none()), "{chosen:?}");
    let later = record.choose(&available, 2, NOW + DAY_S);
    assert_eq!(later, [crack(Distance::Far), crack(Distance::Middle)]);
    let all = record.choose(&available, 100, NOW);
    assert_eq!((all.len(), all.last()), (available.len(), Some(&crack(Distance::Middle))), "known cards come last");
}

#[test]
fn prop_records_survive_storage() {
    let mut record = SchoolRecord::default();
    record.rounds = 3;
    for (k, card) in every_card().into_iter().enumerate() {
        record.answer(card, k % 3 > 0, NOW + k as u64);
    }
    assert_eq!(SchoolRecord::read(&record.text()), Ok(record));
}

#[test]
fn exact_invalid_records_are_refused_with_the_reason() {
    let text = |card: &str, number: u8, right: u32| {
        format!(
            r#"{{"format":1,"rounds":1,"last_unix_s":5,"cards":{{"{card}":{{"box":{number},"due_unix_s":5,"asked":2,"right":{right}}}}}}}"#
        )
    };
    assert!(SchoolRecord::read(&text("1130@3m", 2, 1)).is_ok());
    for (wrong, part) in [
        (text("1131@3m", 2, 1), "cards.1131@3m: unknown"),
        (text("1130@3m", 0, 1), "cards.1130@3m.box 0: out of range (allowed: 1 to 5)"),
        (text("1130@3m", 6, 1), "box 6"),
        (text("1130@3m", 2, 3), "right 3: out of range (allowed: 0 to 2"),
        (text("1130@3m", 2, 1).replace("\"format\":1", "\"format\":2"), "format 2: unknown (allowed: 1)"),
        (text("1130@3m", 2, 1).replace("rounds", "round"), "line 1"),
        ("{".to_owned(), "line 1"),
    ] {
        let error = SchoolRecord::read(&wrong).unwrap_err().to_string();
        assert!(error.contains(part), "{wrong}: {error}");
    }
}

#[test]
fn exact_round_ends_when_every_missed_card_was_answered() {
    let (mut record, mut clock) = (SchoolRecord::default(), NOW);
    let mut round = Round::new(&record, pictures(), 7, NOW);
    let (mut asked, mut missed) = (0, None);
    while let Some(question) = round.question() {
        assert!(question.answers.contains(&question.right_answer()) && question.answers.last() == Some(&Answer::Nothing));
        asked += 1;
        clock += 10;
        let right = right_number(&round);
        let wrong = (right + 1) % round.question().unwrap().answers.len();
        // The first card is missed once.
        let verdict = if asked == 1 {
            missed = Some(round.question().unwrap().picture.card);
            round.answer(wrong, &mut record, clock, Language::English)
        } else {
            round.answer(right, &mut record, clock, Language::English)
        };
        assert_eq!(verdict.map(|verdict| verdict.right), Some(asked != 1));
        round.advance();
    }
    assert_eq!(asked, CARDS_PER_ROUND + 1);
    let summary = round.summary(Language::English);
    assert_eq!((summary.asked, summary.right, summary.missed.len()), (CARDS_PER_ROUND, CARDS_PER_ROUND - 1, 1));
    let missed = record.progress(missed.unwrap()).unwrap();
    assert_eq!((missed.number, missed.asked), (1, 1), "the repetition in the same round does not count");
    assert_eq!(record.choose(&every_card(), 1, clock).len(), 1);
}

#[test]
fn exact_round_ends_for_a_trainee_who_misses_everything() {
    let mut record = SchoolRecord::default();
    let mut round = Round::new(&record, pictures(), 7, NOW);
    let mut asked = 0;
    while let Some(question) = round.question() {
        let wrong = (right_number(&round) + 1) % question.answers.len();
        assert_eq!(round.answer(wrong, &mut record, NOW, Language::English).map(|verdict| verdict.right), Some(false));
        asked += 1;
        round.advance();
    }
    assert_eq!(asked, 3 * CARDS_PER_ROUND, "each card is repeated twice");
    assert_eq!((round.summary(Language::English).asked, round.summary(Language::English).right), (CARDS_PER_ROUND, 0));
}

#[test]
fn exact_answer_that_is_not_offered_changes_nothing() {
    let mut record = SchoolRecord::default();
    let mut round = Round::new(&record, pictures(), 7, NOW);
    let before = round.question().cloned();
    assert_eq!(round.answer(99, &mut record, NOW, Language::English), None);
    assert_eq!((round.question(), record), (before.as_ref(), SchoolRecord::default()));
    assert_eq!(round.position(), (1, CARDS_PER_ROUND));
    round.advance();
    assert_eq!(round.question(), before.as_ref(), "an open question must be answered first");
    assert!(
        Round::new(&SchoolRecord::default(), Vec::new(), 1, NOW).question().is_none(),
        "without pictures there is no question"
    );
}

#[test]
fn exact_defects_that_cannot_be_seen_teach_to_fly_closer() {
    let hidden = pictures().into_iter().find(|picture| !picture.visible).unwrap();
    let mut record = SchoolRecord::default();
    let mut round = Round::new(&record, vec![hidden], 1, NOW);
    assert_eq!(round.question().map(Question::right_answer), Some(Answer::Nothing));
    let number = right_number(&round);
    let verdict = round.answer(number, &mut record, NOW, Language::English).unwrap();
    assert!(verdict.right && verdict.words[1].contains("a pixel covers 3.2 mm"), "{verdict:?}");
    assert!(verdict.words[1].ends_with("Fly closer."), "{verdict:?}");
}

#[test]
fn exact_questions_and_verdicts_are_in_the_language_of_the_page() {
    let hidden = pictures().into_iter().find(|picture| !picture.visible).unwrap();
    let shown = |language| {
        let mut round = Round::new(&SchoolRecord::default(), vec![hidden.clone()], 1, NOW);
        let question = round.question().unwrap();
        let mut texts = vec![question.words(language)];
        texts.extend(question.answers.iter().map(|answer| answer.words(language)));
        texts.extend(round.answer(0, &mut SchoolRecord::default(), NOW, language).unwrap().words);
        texts.extend(round.summary(language).missed);
        texts.join("\n")
    };
    let german = shown(Language::German);
    assert!(german.contains("Von hier ist kein Schaden zu sehen") && german.contains("Fliegen Sie näher heran."), "{german}");
    let words = shown(Language::Pseudo);
    assert_eq!(untranslated_word(&words, &[]), None, "{words}");
}

#[test]
fn val_gallery_of_a_shipped_job_has_clear_pictures_of_most_defects() {
    let job = spandrel_model::scenario::read("two-bridges", spandrel_model::shipped::TWO_BRIDGES, &|name| Err(name.to_owned()))
        .unwrap();
    let scenario = school_scenario(&job, 1);
    let vehicle = spandrel_model::vehicle::read("phantom2", spandrel_model::shipped::PHANTOM2).unwrap();
    let site = spandrel_model::site::Site::build(&scenario, 1);
    let pictures = gallery(&site, &vehicle, 1);
    let cards: BTreeSet<Card> = pictures.iter().map(|picture| picture.card).collect();
    // The bridges have no prestressed concrete and no masonry, and fatigue cracks are too thin for the job's paths.
    let absent = [defect_codes::PSC_CRACK, defect_codes::FATIGUE, defect_codes::MORTAR, defect_codes::SPLIT_STONE];
    for code in defect_codes::ALL.iter().filter(|code| !absent.contains(code)) {
        let some = cards.iter().any(|card| card.subject == Subject::Defect(*code));
        assert!(some, "{code}: no picture");
    }
    for distance in Distance::ALL {
        assert!(cards.contains(&Card { distance, subject: Subject::Sound }), "{distance:?}: no sound surface");
        let some = pictures.iter().filter(|picture| picture.card.distance == distance).count();
        assert!(some >= CARDS_PER_ROUND, "{distance:?}: {some} pictures");
    }
    let camera = picture_camera(&vehicle.camera);
    assert!(
        (camera.focal_px() / vehicle.camera.focal_px() - 1.0).abs() < 0.01,
        "one lens: the picture is a part of the photograph"
    );
    for picture in &pictures {
        let Some(defect) = &picture.defect else { continue };
        let distance_m = (defect.position_m - picture.pose.position_m).norm();
        assert!((distance_m - f64::from(picture.card.distance.m())).abs() < 1e-9);
        assert!(picture.element.permitted_defects().contains(&defect.kind));
    }
    assert!(pictures.iter().any(|picture| !picture.visible), "some defects cannot be seen from far away");
}
