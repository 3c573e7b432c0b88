//! Cohort score statistics: distributions, first sessions, crashes, repetitions and tests.

use super::limitation::Limitation;
use super::reliability::{MeasureReliability, reliability_of};
use super::samples::{OVERALL, SCORES, ScorePicker, SessionsByTrainee};
use crate::record::{Crashes, SessionOutcome, SessionRecord};
use crate::statistics::{
    BoxPlot, HistogramBin, Homogeneity, PairedTest, SampleSummary, TailProbabilities, box_plot, histogram, holm, homogeneity,
    paired_t, quantile, summary,
};
use serde::Serialize;
use spandrel_monitor::score::completion::Completion;

/// Number of bins in a score histogram.
const HISTOGRAM_BINS: usize = 20;

/// Distribution of one score across first sessions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Distribution {
    /// Score name, such as `conformity`.
    pub score: String,
    /// Summary statistics of the scores.
    pub summary: SampleSummary,
    /// Bins covering the score's full range.
    pub histogram: Vec<HistogramBin>,
}

/// One trainee's first session.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FirstSession {
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Session ID (its folder name).
    pub session: String,
    /// Session purpose, `practice` or `assessment`; `None` if not specified.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub purpose: Option<String>,
    /// Conformity, 0 to 100; `None` if it does not apply.
    pub conformity: Option<f64>,
    /// Efficiency score, 0 to 100.
    pub efficiency: f64,
    /// Safety score, 0 to 100.
    pub safety: f64,
    /// Accuracy, 0 to 100; `None` if it does not apply.
    pub accuracy: Option<f64>,
    /// Sum of all applicable scores.
    pub overall: f64,
    /// Flight duration, s.
    pub seconds: f64,
    /// Whether the job was done and the drone landed at home. The scores of an incomplete session cover only a part of the job.
    pub complete: bool,
    /// Job completion; absent if the record lacks it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub completion: Option<Completion>,
    /// Whether the session meets all certification requirements.
    pub certified: bool,
    /// Unmet certification requirements, as text.
    pub unmet: Vec<String>,
    /// On-path share and speeding by task.
    pub tasks: Vec<TaskShare>,
}

impl SessionOutcome for FirstSession {
    fn completion(&self) -> Option<&Completion> {
        self.completion.as_ref()
    }
    fn certification(&self) -> (bool, &[String]) {
        (self.certified, &self.unmet)
    }
}

/// One task's contribution to conformity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TaskShare {
    /// Task number in the scenario.
    pub id: u32,
    /// Task name in the scenario.
    pub name: String,
    /// Whether the task's path was entered.
    pub attempted: bool,
    /// On-path share (P_p), 0 to 1.
    pub on_path: f64,
    /// The task's speeding loss (P_s in TASBID).
    pub speeding: f64,
}

/// Crashes in the first sessions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CrashTable {
    /// Total number of crashes.
    pub total: usize,
    /// Crashes by kind.
    pub by_kind: Crashes,
    /// Task numbers. Each row has one count per task plus a final one for crashes outside the tasks.
    pub tasks: Vec<u32>,
    /// Each task's total across all trainees; the last element counts crashes outside the tasks.
    pub by_task: Vec<usize>,
    /// Crash counts by trainee.
    pub rows: Vec<CrashRow>,
}

/// One trainee's crashes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CrashRow {
    /// Trainee's pseudonym.
    pub trainee: String,
    /// Crashes in each task; the last element counts crashes outside the tasks.
    pub by_task: Vec<usize>,
    /// Total number of crashes.
    pub total: usize,
}

/// Box plot of one score for one group repetition.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RepetitionBox {
    /// Score name, such as `conformity`.
    pub score: String,
    /// Repetition number, from 1.
    pub repetition: usize,
    /// Box plot data.
    pub plot: BoxPlot,
}

/// Paired comparison of one score between two group repetitions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Score name, such as `conformity`.
    pub score: String,
    /// Earlier repetition number.
    pub earlier: usize,
    /// Later repetition number.
    pub later: usize,
    /// Paired test of later minus earlier.
    #[serde(flatten)]
    pub test: PairedTest,
    /// Holm-corrected p values, computed separately for each tail. Comparisons of the four scores form one family;
    /// comparisons of the overall score form another.
    pub p_holm: Option<TailProbabilities>,
    /// Smallest change of the mean of these trainees that exceeds the measurement error with 95% confidence; `None` if
    /// the score's reliability is unknown.
    pub minimal_detectable_mean_change: Option<f64>,
    /// Whether the mean difference is smaller than that.
    pub within_error: Option<bool>,
    /// Number of trainees whose own change is at least the minimal detectable change of a single trainee.
    pub trainees_beyond_error: Option<usize>,
}

/// Test of whether the group's first sessions are distributed across low, middle and high scores like those of the
/// other trainees.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GroupHomogeneityTest {
    /// Score name, such as `conformity`.
    pub score: String,
    /// Upper limits of low and middle scores: the terciles of all first sessions.
    pub cuts: [f64; 2],
    /// Number of group members with low, middle and high scores.
    pub group: Vec<usize>,
    /// Number of other trainees with low, middle and high scores.
    pub others: Vec<usize>,
    /// Result of the homogeneity test.
    #[serde(flatten)]
    pub test: Homogeneity,
}

fn values(records: &[&SessionRecord], pick: ScorePicker) -> Vec<f64> {
    records.iter().filter_map(|record| pick(record)).collect()
}

pub fn distributions(first_sessions: &[&SessionRecord]) -> Vec<Distribution> {
    let most = |score: &str| if score == OVERALL.0 { 400.0 } else { 100.0 };
    let one = |(score, pick): (&str, ScorePicker)| {
        let values = values(first_sessions, pick);
        let histogram = histogram(&values, (0.0, most(score)), HISTOGRAM_BINS);
        Some(Distribution { score: score.to_owned(), summary: summary(&values).ok()?, histogram })
    };
    SCORES.into_iter().filter_map(one).collect()
}

pub fn first_session(record: &SessionRecord) -> FirstSession {
    let share = |task: &crate::record::TaskRecord| TaskShare {
        id: task.id,
        name: task.name.clone(),
        attempted: task.attempted,
        on_path: task.on_path,
        speeding: task.speeding,
    };
    FirstSession {
        trainee: record.trainee.clone(),
        session: record.id.clone(),
        purpose: record.purpose.clone(),
        conformity: record.scores.conformity,
        efficiency: record.scores.efficiency,
        safety: record.scores.safety,
        accuracy: record.scores.accuracy,
        overall: record.scores.overall,
        seconds: record.seconds,
        complete: record.is_complete(),
        completion: record.completion,
        certified: record.certified,
        unmet: record.unmet.clone(),
        tasks: record.tasks.iter().map(share).collect(),
    }
}

pub fn crash_table(first_sessions: &[&SessionRecord]) -> CrashTable {
    let mut tasks: Vec<u32> = first_sessions.iter().flat_map(|record| record.task_ids()).collect();
    tasks.sort_unstable();
    tasks.dedup();
    let row = |record: &&SessionRecord| {
        let in_task = |id: &u32| record.tasks.iter().find(|task| task.id == *id).map_or(0, |task| task.crashes.total());
        let by_task = tasks.iter().map(in_task).chain([record.crashes_outside.total()]).collect();
        CrashRow { trainee: record.trainee.clone(), by_task, total: record.crashes().total() }
    };
    let rows: Vec<CrashRow> = first_sessions.iter().map(row).collect();
    CrashTable {
        total: rows.iter().map(|row| row.total).sum(),
        by_kind: first_sessions.iter().map(|record| record.crashes()).fold(Crashes::default(), Crashes::combined_with),
        by_task: (0..=tasks.len()).map(|k| rows.iter().map(|row| row.by_task[k]).sum()).collect(),
        tasks,
        rows,
    }
}

pub fn boxes(group: &SessionsByTrainee<'_>, repetitions: usize) -> Vec<RepetitionBox> {
    let mut boxes = Vec::new();
    for (score, pick) in SCORES {
        for k in 0..repetitions {
            let records: Vec<&SessionRecord> = group.values().map(|sessions| sessions[k]).collect();
            if let Ok(plot) = box_plot(&values(&records, pick)) {
                boxes.push(RepetitionBox { score: score.to_owned(), repetition: k + 1, plot });
            }
        }
    }
    boxes
}

pub fn comparisons(
    group: &SessionsByTrainee<'_>,
    repetitions: usize,
    reliability: &[MeasureReliability],
    limitations: &mut Vec<Limitation>,
) -> Vec<Comparison> {
    let mut tests = Vec::new();
    for (score, pick) in SCORES {
        let known = reliability_of(reliability, score).filter(|one| one.reliability.is_some());
        for later in 1..repetitions {
            for earlier in 0..later {
                let pairs = group.values().filter_map(|sessions| pick(sessions[earlier]).zip(pick(sessions[later])));
                let (before, after): (Vec<f64>, Vec<f64>) = pairs.unzip();
                match paired_t(&before, &after) {
                    Ok(test) => tests.push(Comparison {
                        score: score.to_owned(),
                        earlier: earlier + 1,
                        later: later + 1,
                        minimal_detectable_mean_change: known
                            .and_then(|one| one.reliability)
                            .map(|one| one.minimal_detectable_mean_change(test.n)),
                        within_error: known.and_then(|one| one.is_mean_within_error(test.mean_difference, test.n)),
                        trainees_beyond_error: known.map(|one| count_beyond_error(one, &before, &after)),
                        test,
                        p_holm: None,
                    }),
                    Err(reason) => {
                        let (earlier, later) = (earlier + 1, later + 1);
                        limitations.push(Limitation::NoComparison { score, earlier, later, reason });
                    }
                }
            }
        }
    }
    for overall in [false, true] {
        apply_holm_correction(tests.iter_mut().filter(|test| (test.score == OVERALL.0) == overall).collect());
    }
    tests
}

fn count_beyond_error(known: &MeasureReliability, before: &[f64], after: &[f64]) -> usize {
    before.iter().zip(after).filter(|(before, after)| known.is_within_error(**after - **before) == Some(false)).count()
}

/// Applies the Holm correction to one family of comparisons, separately for each tail.
fn apply_holm_correction(mut family: Vec<&mut Comparison>) {
    family.retain(|test| test.test.p.is_some());
    let tail = |pick: fn(&TailProbabilities) -> f64| {
        let p: Vec<f64> = family.iter().filter_map(|test| test.test.p.as_ref()).map(pick).collect();
        holm(&p)
    };
    let (upper, lower, two) = (tail(|p| p.upper), tail(|p| p.lower), tail(|p| p.two));
    for (k, test) in family.into_iter().enumerate() {
        test.p_holm = Some(TailProbabilities { upper: upper[k], lower: lower[k], two: two[k] });
    }
}

pub fn test_group_homogeneity(
    first_sessions: &[&SessionRecord],
    group: &SessionsByTrainee<'_>,
    limitations: &mut Vec<Limitation>,
) -> Vec<GroupHomogeneityTest> {
    let mut tests = Vec::new();
    if group.is_empty() || group.len() == first_sessions.len() {
        return tests;
    }
    for (score, pick) in SCORES {
        let mut sorted = values(first_sessions, pick);
        sorted.sort_by(f64::total_cmp);
        let (Some(low), Some(middle)) = (quantile(&sorted, 1.0 / 3.0), quantile(&sorted, 2.0 / 3.0)) else { continue };
        let count = |in_group: bool| {
            let mut counts = vec![0; 3];
            let those = first_sessions.iter().filter(|record| group.contains_key(record.trainee.as_str()) == in_group);
            for value in those.filter_map(|record| pick(record)) {
                counts[usize::from(value > low) + usize::from(value > middle)] += 1;
            }
            counts
        };
        let (own, others) = (count(true), count(false));
        match homogeneity(&[own.clone(), others.clone()]) {
            Ok(test) => {
                tests.push(GroupHomogeneityTest { score: score.to_owned(), cuts: [low, middle], group: own, others, test })
            }
            Err(reason) => limitations.push(Limitation::NoHomogeneityTest { score, reason }),
        }
    }
    tests
}
