//! Likert charts: bars centered on "neutral", with agreement to the left and disagreement to the right.

use super::{coord, svg_figure};
use maud::{Markup, html};

const WIDTH: f64 = 640.0;
const MIDDLE_X: f64 = 320.0;
/// Width of 100%, in drawing units. A row with full agreement fits in the left half.
const FULL_WIDTH: f64 = 300.0;
/// Height of a question and its bar, in drawing units; extra lines of text add to it.
const ROW_HEIGHT: f64 = 42.0;
const LINE_HEIGHT: f64 = 15.0;
/// Maximum number of characters per text line (for a wide sans-serif font at the label size).
const MAX_LINE_CHARACTERS: usize = 84;

/// A question with its answer counts.
#[derive(Debug, Clone, PartialEq)]
pub struct LikertQuestion {
    /// Question text.
    pub name: String,
    /// Counts from strongly agree to strongly disagree.
    pub counts: [usize; 5],
}

/// Returns the left end and width of each answer's bar, from strongly agree to strongly disagree.
#[must_use]
pub fn bars(counts: [usize; 5]) -> [(f64, f64); 5] {
    let n = counts.iter().sum::<usize>().max(1) as f64;
    let widths = counts.map(|count| FULL_WIDTH * count as f64 / n);
    let mut at = MIDDLE_X - widths[0] - widths[1] - 0.5 * widths[2];
    widths.map(|width| {
        let from = at;
        at += width;
        (from, width)
    })
}

/// Wraps a question's text into lines.
fn lines(name: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in name.split_whitespace() {
        if let Some(line) =
            lines.last_mut().filter(|line| line.is_empty() || line.chars().count() + word.chars().count() < MAX_LINE_CHARACTERS)
        {
            line.push_str(if line.is_empty() { "" } else { " " });
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

/// Draws the rows of answers.
#[must_use]
pub fn likert(questions: &[LikertQuestion], title: &str) -> Markup {
    let mut height = 0.0;
    let rows: Vec<(f64, Vec<String>, &LikertQuestion)> = questions
        .iter()
        .map(|question| {
            let (top, lines) = (height, lines(&question.name));
            height += ROW_HEIGHT + LINE_HEIGHT * (lines.len() - 1) as f64;
            (top, lines, question)
        })
        .collect();
    svg_figure(
        (WIDTH, height + 4.0),
        title,
        "likert",
        &html! { @for (top, lines, question) in &rows { (row(*top, lines, question)) } },
    )
}

fn row(top: f64, lines: &[String], question: &LikertQuestion) -> Markup {
    let bar = top + 19.0 + LINE_HEIGHT * (lines.len() - 1) as f64;
    html! {
        text.label x="4" y=(coord(top + 13.0)) {
            @for (k, line) in lines.iter().enumerate() { tspan x="4" dy=(if k == 0 { 0.0 } else { LINE_HEIGHT }) { (line) } " " }
        }
        @for (answer, (x, width)) in bars(question.counts).into_iter().enumerate() {
            @let count = question.counts[answer];
            @if count > 0 {
                rect class={ "answer-" (answer + 1) } x=(coord(x)) y=(coord(bar)) width=(coord(width)) height="16" {}
                @if width >= 14.0 { text class={ "count count-" (answer + 1) } x=(coord(x + 0.5 * width)) y=(coord(bar + 12.0)) text-anchor="middle" { (count) } }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_agreement_is_left_and_disagreement_right_of_center() {
        assert_eq!(bars([1, 0, 0, 0, 0])[0], (20.0, 300.0));
        assert_eq!(bars([0, 0, 0, 0, 3])[4], (320.0, 300.0));
        assert_eq!(bars([1, 0, 2, 0, 1]), [(170.0, 75.0), (245.0, 0.0), (245.0, 150.0), (395.0, 0.0), (395.0, 75.0)]);
        assert_eq!(bars([0; 5]), [(320.0, 0.0); 5]);
        let figure = likert(&[LikertQuestion { name: "<q>".into(), counts: [0, 2, 0, 0, 0] }], "t").into_string();
        assert!(figure.contains("&lt;q&gt;") && figure.matches("<rect").count() == 1, "{figure}");
    }

    #[test]
    fn exact_long_question_wraps_at_words_and_shifts_following_rows() {
        let long = "physical activity ".repeat(10);
        let broken = lines(&long);
        assert_eq!(broken.join(" "), long.trim());
        assert!(broken.len() == 3 && broken.iter().all(|line| line.chars().count() <= MAX_LINE_CHARACTERS), "{broken:?}");
        assert_eq!((lines(""), lines(&"x".repeat(90)).len()), (vec![String::new()], 1));
        let question = |name: &str| LikertQuestion { name: name.into(), counts: [1, 0, 0, 0, 0] };
        let figure = likert(&[question(&long), question("short")], "t").into_string();
        assert!(
            figure.contains(r#"y="49""#) && figure.contains(r#"y="91""#),
            "the bars are below the third line of text and in the next row: {figure}"
        );
    }
}
