//! `spandrel questionnaire`: asks the post-flight questions in a terminal.

use crate::errors::{AppError, EXIT_CODES};
use crate::io::answers::{languages, read_saved_answers, task_ids};
use crate::io::replace::replace;
use crate::io::session_folder::StoredSession;
use spandrel_model::scenario::Scenario;
use spandrel_monitor::export::json_text;
use spandrel_training::questionnaire::{
    ANSWERS, Answers, FormWording, Languages, QuestionnaireItem, STRONGLY_AGREE, STRONGLY_DISAGREE, TLX_MAX, TLX_STEP, TlxScale,
    Wording,
};
use std::io::{BufRead, Write};
use std::path::PathBuf;

/// Answer the questionnaire after a flight
///
/// Asks how strongly you agree with three statements about the whole session and three about each phase (24 statements
/// for the default scenario). Every answer is saved immediately in the session's answers.json. You can quit at any time
/// and continue later with the same command.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel questionnaire sessions/20260801T...             ask the unanswered questions
  spandrel questionnaire sessions/20260801T... --tlx       also ask the six NASA-TLX scales
  spandrel questionnaire sessions/20260801T... --again     ask all questions again; Enter keeps the previous answer
  spandrel questionnaire sessions/20260801T... --language de    ask in German (available: en, de, es)

{EXIT_CODES}"))]
pub struct Args {
    /// Session folder
    #[arg(value_name = "SESSION")]
    session: PathBuf,
    /// Also ask the six NASA-TLX scales
    #[arg(long)]
    tlx: bool,
    /// Ask all questions again, including those already answered
    #[arg(long)]
    again: bool,
    /// Custom wording file (a copy of a shipped wording with modified texts)
    #[arg(long, value_name = "FILE", conflicts_with = "language")]
    wording: Option<PathBuf>,
    /// Language: en, de or es [default: the language of the saved answers, the terminal's language, or en]
    #[arg(long, value_name = "TAG")]
    language: Option<String>,
}

/// A question of either questionnaire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PromptQuestion {
    Likert(QuestionnaireItem),
    Tlx(TlxScale),
}

/// A parsed line of terminal input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TypedInput {
    Answer(u8),
    Keep,
    Back,
    Leave,
    Invalid,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if the session or a file is invalid, or answers cannot be written.
pub fn run(args: &Args) -> Result<(), AppError> {
    let scenario = StoredSession::read_scenario(&args.session)?.scenario;
    let mut answers = read_saved_answers(&args.session, &scenario)?.unwrap_or_default();
    let languages = languages(args.wording.as_slice())?;
    let wording = select_wording(args, &languages, &answers)?;
    answers.language.clone_from(&wording.language);
    let questions = questions(args, &scenario, &answers);
    let (mut input, mut output) = (std::io::stdin().lock(), std::io::stdout().lock());
    let mut save = |answers: &Answers| replace(&args.session.join(ANSWERS), json_text(answers).as_bytes());
    ask_questions(&questions, wording, &scenario, &mut answers, (&mut input, &mut output), &mut save)?;
    let tasks = task_ids(&scenario);
    let (all, open) = (QuestionnaireItem::all(&tasks).len(), answers.open(&tasks).len());
    let again = if open > 0 { format!("; {}", wording.form.later) } else { String::new() };
    let _ = writeln!(output, "\n{}{again}", wording.form.answered(all - open, all));
    Ok(())
}

/// Selects the wording, in order of preference: the requested language, the custom wording file, the language of the
/// saved answers, the terminal's language.
fn select_wording<'a>(args: &Args, languages: &'a Languages, answers: &Answers) -> Result<&'a Wording, AppError> {
    if let Some(tag) = &args.language {
        let names: Vec<&str> = languages.all().iter().map(|wording| wording.language.as_str()).collect();
        let none = || AppError::invalid(format!("--language {tag}: unknown language (allowed: {})", names.join(", ")));
        return languages.of(tag).ok_or_else(none);
    }
    let begun = || languages.of(&answers.language).filter(|_| !answers.language.is_empty());
    let first = &languages.all()[0];
    Ok(if args.wording.is_some() { first } else { begun().or_else(|| languages.of(&terminal_language()?)).unwrap_or(first) })
}

/// Returns the terminal's language as a language tag: `de_CH.UTF-8` becomes `de-CH`.
fn terminal_language() -> Option<String> {
    let set = |name: &&str| std::env::var(name).ok().filter(|value| !value.is_empty());
    let value = ["LC_ALL", "LC_MESSAGES", "LANG"].iter().find_map(set)?;
    Some(value.split(['.', '@']).next().unwrap_or_default().replace('_', "-"))
}

fn questions(args: &Args, scenario: &Scenario, answers: &Answers) -> Vec<PromptQuestion> {
    let likert =
        QuestionnaireItem::all(&task_ids(scenario)).into_iter().filter(|item| args.again || !answers.given.contains_key(item));
    let tlx = TlxScale::ALL.into_iter().filter(|scale| args.tlx && (args.again || !answers.tlx.contains_key(scale)));
    likert.map(PromptQuestion::Likert).chain(tlx.map(PromptQuestion::Tlx)).collect()
}

/// Asks the questions in order until all are answered or the trainee quits.
fn ask_questions(
    questions: &[PromptQuestion],
    wording: &Wording,
    scenario: &Scenario,
    answers: &mut Answers,
    (input, output): (&mut impl BufRead, &mut impl Write),
    save: &mut impl FnMut(&Answers) -> Result<(), AppError>,
) -> Result<(), AppError> {
    let told = |error: std::io::Error| AppError::failed(format!("cannot use the terminal: {error}"));
    if questions.is_empty() {
        return Ok(());
    }
    writeln!(output, "{}\n{}\n{}", wording.title, wording.introduction, help(wording)).map_err(told)?;
    let mut at = 0;
    while let Some(question) = questions.get(at) {
        write!(output, "\n[{}/{}] {}", at + 1, questions.len(), prompt_text(*question, wording, scenario, answers))
            .map_err(told)?;
        output.flush().map_err(told)?;
        let mut line = String::new();
        if input.read_line(&mut line).map_err(told)? == 0 {
            return Ok(());
        }
        match parse_input(&line, *question) {
            TypedInput::Answer(value) => {
                match question {
                    PromptQuestion::Likert(item) => answers.given.insert(*item, value),
                    PromptQuestion::Tlx(scale) => answers.tlx.insert(*scale, value),
                };
                save(answers)?;
                at += 1;
            }
            TypedInput::Keep => at += 1,
            TypedInput::Back => at = at.saturating_sub(1),
            TypedInput::Leave => return Ok(()),
            TypedInput::Invalid => writeln!(output, "{}", allowed(*question, &wording.form)).map_err(told)?,
        }
    }
    Ok(())
}

fn help(wording: &Wording) -> String {
    let scale: Vec<String> = wording.scale.iter().enumerate().map(|(k, word)| format!("{} {word}", k + 1)).collect();
    format!("{}\n{}", scale.join("   "), wording.form.keys)
}

fn prompt_text(question: PromptQuestion, wording: &Wording, scenario: &Scenario, answers: &Answers) -> String {
    let name = |id: u32| scenario.tasks.iter().find(|task| task.id == id).map_or(String::new(), |task| task.name.clone());
    let before = |given: Option<&u8>| given.map_or(String::new(), |value| format!(" [{value}]"));
    match question {
        PromptQuestion::Likert(item) => {
            let (heading, statement) = (wording.heading(item, name), wording.statement(item));
            format!("{heading}\n  {statement}\n  {STRONGLY_AGREE}-{STRONGLY_DISAGREE}{}: ", before(answers.given.get(&item)))
        }
        PromptQuestion::Tlx(scale) => {
            let (question, low, high) = wording.tlx(scale);
            let given = before(answers.tlx.get(&scale));
            format!("{}\n  {question}\n  0 {low} - {TLX_MAX} {high}, steps of {TLX_STEP}{given}: ", wording.tlx_title)
        }
    }
}

fn allowed(question: PromptQuestion, form: &FormWording) -> String {
    match question {
        PromptQuestion::Likert(_) => form.integer_instruction(),
        PromptQuestion::Tlx(_) => form.step_instruction(),
    }
}

fn parse_input(line: &str, question: PromptQuestion) -> TypedInput {
    let fits = |value: &u8| match question {
        PromptQuestion::Likert(_) => (STRONGLY_AGREE..=STRONGLY_DISAGREE).contains(value),
        PromptQuestion::Tlx(_) => *value <= TLX_MAX && value.is_multiple_of(TLX_STEP),
    };
    match line.trim() {
        "" => TypedInput::Keep,
        "b" | "B" => TypedInput::Back,
        "q" | "Q" => TypedInput::Leave,
        number => number.parse().ok().filter(fits).map_or(TypedInput::Invalid, TypedInput::Answer),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::files;
    use spandrel_training::questionnaire::{InspectionPhase, OverallItem, PhaseAspect};

    /// Enters lines into the default scenario's questionnaire. Returns the output and the number of saves.
    fn run_with_input(questions: &[PromptQuestion], answers: &mut Answers, lines: &str) -> (String, usize) {
        let scenario = files::scenario("two-bridges").unwrap().scenario;
        let (mut shown, mut saved) = (Vec::new(), 0);
        let mut save = |_: &Answers| {
            saved += 1;
            Ok(())
        };
        ask_questions(
            questions,
            &languages(&[]).unwrap().all()[0],
            &scenario,
            answers,
            (&mut lines.as_bytes(), &mut shown),
            &mut save,
        )
        .unwrap();
        (String::from_utf8(shown).unwrap(), saved)
    }

    fn all() -> Vec<PromptQuestion> {
        QuestionnaireItem::all(&[1, 2, 3, 4]).into_iter().map(PromptQuestion::Likert).collect()
    }

    #[test]
    fn exact_every_answer_is_saved_immediately() {
        let mut answers = Answers::default();
        let (shown, saved) = run_with_input(&all(), &mut answers, &"2\n".repeat(24));
        assert_eq!((answers.given.len(), saved), (24, 24));
        assert!(answers.given.values().all(|answer| *answer == 2));
        assert!(shown.contains("[24/24] Landing"), "{shown}");
    }

    #[test]
    fn exact_quitting_keeps_answers_and_invalid_input_repeats_question() {
        let mut answers = Answers::default();
        let (shown, saved) = run_with_input(&all(), &mut answers, "1\n6\nfive\n0\n4\nq\n3\n");
        assert_eq!((answers.given.len(), saved), (2, 2));
        assert_eq!(answers.given[&QuestionnaireItem::Overall(OverallItem::Frustration)], 4);
        assert_eq!(shown.matches("Please enter a whole number from 1 to 5").count(), 3);
        // The questionnaire also ends when the input ends.
        assert_eq!(run_with_input(&all(), &mut answers, "").1, 0);
    }

    #[test]
    fn exact_b_goes_back_and_enter_keeps_answer() {
        let mut answers = Answers::default();
        run_with_input(&all(), &mut answers, "1\n1\nb\n5\n\n3\nq\n");
        assert_eq!(answers.given[&QuestionnaireItem::Overall(OverallItem::Frustration)], 5);
        assert_eq!(answers.given.get(&QuestionnaireItem::Overall(OverallItem::Feedback)), None);
        assert_eq!(answers.given[&QuestionnaireItem::Phase(InspectionPhase::Calibration, PhaseAspect::Performance)], 3);
    }

    #[test]
    fn exact_tlx_answers_are_multiples_of_five() {
        let mut answers = Answers::default();
        let questions: Vec<PromptQuestion> = TlxScale::ALL.into_iter().map(PromptQuestion::Tlx).collect();
        run_with_input(&questions, &mut answers, "7\n105\n35\n100\n0\n5\n10\n15\n");
        assert_eq!(answers.tlx.values().copied().collect::<Vec<u8>>(), [35, 100, 0, 5, 10, 15]);
    }
}
