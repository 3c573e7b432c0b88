//! Reference page of pilot files, generated from the synthetic trainee's numbers.

use crate::table::{code, table};
use crate::{check, page_head};
use spandrel_clients::pilot::Skill;
use spandrel_clients::pilot::skill::{FIELDS, LEARNING_EXPONENT, SkillFactor};

const ABOUT: &str = "A pilot file sets the numbers of a synthetic trainee. `pilot`, `demo` and `study` read it with `--pilot FILE`. Errors of a synthetic
trainee result from these numbers; none are scripted.

The trainee flies with the [response to the sticks](../how-to/controllers.md#response-to-the-sticks) `sport`, with which its numbers were adjusted, and
selects it before takeoff.

    format = 1
    base = \"novice\"             # novice, trained or expert: the values of all numbers that the file doesn't set
    noise = 1.6
    median_length_mm = 40.0
    session = 2                 # optional: the trainee's second session of the job

## Practice";

const SOURCES: &str = "## Sources

- Pfeiffer and Scaramuzza, [arXiv:2103.04672](https://arxiv.org/abs/2103.04672): latency and gaze of 21 drone pilots.
- McRuer and Jex, *A Review of Quasi-Linear Pilot Models*, IEEE Transactions on Human Factors in Electronics 8, 1967.
- Campbell et al. 2020: probability that bridge inspectors detect a defect, by its size (see [Domain facts](domain.md)).
- Renner, Velichkovsky and Helmert, *The Perception of Egocentric Distances in Virtual Environments*, ACM Computing Surveys 46, 2013.
- Newell and Rosenbloom, *Mechanisms of Skill Acquisition and the Law of Practice*, 1981.

An estimate has no source, and describes no real person. The estimates were calibrated on a few flights of `two-bridges` (seeds 101 to 111) and
`pilot-study`: the trained pilot's and the expert's so that the certification separates them, the novice's so that a flight of `pilot-study` takes as
long as in the TASBID pilot study.
";

fn practice() -> String {
    format!(
        "In session *n*, the difference between each number and the expert's is *n*^-*b* times the difference in the first session (power law of\npractice). `session` is a whole number from 1 to 1000 (default 1), and `learning_exponent` is *b*, from 0 to 3 (default {LEARNING_EXPONENT}).\n"
    )
}

fn rows(factor: SkillFactor) -> Vec<Vec<String>> {
    let number = |value: f64| value.to_string();
    let fields = FIELDS.iter().filter(|field| field.factor == factor);
    fields
        .map(|field| {
            let unit = if field.unit.is_empty() { String::new() } else { format!(" ({})", field.unit) };
            let range = format!("{} to {}", field.range.0, field.range.1);
            let levels = [Skill::NOVICE, Skill::TRAINED, Skill::EXPERT].map(|skill| number((field.get)(&skill)));
            let mut row = vec![code(field.key), format!("{}{unit}", field.meaning), range];
            row.extend(levels);
            row.push(field.source.to_owned());
            row
        })
        .collect()
}

#[test]
fn exact_pilot_page_is_up_to_date() {
    let heads = ["key", "meaning", "range", "novice", "trained", "expert", "source"];
    let every: Vec<Vec<String>> = SkillFactor::ALL.into_iter().flat_map(rows).collect();
    assert_eq!(every.len(), FIELDS.len());
    let groups = SkillFactor::ALL.map(|factor| {
        let keys: Vec<String> = FIELDS.iter().filter(|field| field.factor == factor).map(|field| code(field.key)).collect();
        vec![code(factor.name()), keys.join(", ")]
    });
    let text = [
        page_head("Pilot files", ABOUT),
        practice(),
        format!("## Numbers\n\n{}", table(&heads, every.into_iter())),
        format!(
            "## Groups\n\n`--expert-in GROUP,...` takes the numbers of these groups from the expert.\n\n{}",
            table(&["group", "numbers"], groups.into_iter())
        ),
        SOURCES.to_owned(),
    ]
    .join("\n");
    check("pilot.md", &text);
}
