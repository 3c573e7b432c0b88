//! Answers from strongly agree to strongly disagree: rows of shares that meet at the middle of "neutral", so that agreement goes to the
//! left and disagreement to the right.

use super::{sheet, unit};
use maud::{Markup, html};

const WIDTH: f64 = 640.0;
const MIDDLE: f64 = 320.0;
/// Units of the sheet for all answers together: a row that agrees as a whole ends before the sheet does.
const WHOLE: f64 = 300.0;
const ROW: f64 = 42.0;

/// One question.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// What was asked.
    pub name: String,
    /// From strongly agree to strongly disagree.
    pub counts: [usize; 5],
}

/// Left end and width of each answer's bar, from strongly agree to strongly disagree.
#[must_use]
pub fn bars(counts: [usize; 5]) -> [(f64, f64); 5] {
    let n = counts.iter().sum::<usize>().max(1) as f64;
    let widths = counts.map(|count| WHOLE * count as f64 / n);
    let mut at = MIDDLE - widths[0] - widths[1] - 0.5 * widths[2];
    widths.map(|width| {
        let from = at;
        at += width;
        (from, width)
    })
}

/// Rows of answers.
#[must_use]
pub fn likert(questions: &[Question], title: &str) -> Markup {
    sheet(
        (WIDTH, ROW * questions.len() as f64 + 4.0),
        title,
        "likert",
        &html! {
            @for (k, question) in questions.iter().enumerate() {
                @let top = ROW * k as f64;
                text.label x="4" y=(unit(top + 13.0)) { (question.name) }
                @for (answer, (x, width)) in bars(question.counts).into_iter().enumerate() {
                    @let count = question.counts[answer];
                    @if count > 0 {
                        rect class={ "answer-" (answer + 1) } x=(unit(x)) y=(unit(top + 19.0)) width=(unit(width)) height="16" {}
                        @if width >= 14.0 { text class={ "count count-" (answer + 1) } x=(unit(x + 0.5 * width)) y=(unit(top + 31.0)) text-anchor="middle" { (count) } }
                    }
                }
            }
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_agreement_goes_left_and_disagreement_right_of_the_middle() {
        assert_eq!(bars([1, 0, 0, 0, 0])[0], (20.0, 300.0));
        assert_eq!(bars([0, 0, 0, 0, 3])[4], (320.0, 300.0));
        assert_eq!(bars([1, 0, 2, 0, 1]), [(170.0, 75.0), (245.0, 0.0), (245.0, 150.0), (395.0, 0.0), (395.0, 75.0)]);
        assert_eq!(bars([0; 5]), [(320.0, 0.0); 5]);
        let figure = likert(&[Question { name: "<q>".into(), counts: [0, 2, 0, 0, 0] }], "t").into_string();
        assert!(figure.contains("&lt;q&gt;") && figure.matches("<rect").count() == 1, "{figure}");
    }
}
