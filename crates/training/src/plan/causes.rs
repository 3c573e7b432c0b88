//! Order by cause: what follows from another finding is listed with its cause, and does not recommend a scenario of its
//! own.

use super::finding::Finding;
use spandrel_model::math;

/// A finding with its urgency and its cause.
pub(super) struct RankedFinding<'a> {
    /// Index in the ranking.
    pub index: usize,
    pub finding: Finding<'a>,
    pub urgency: f64,
    /// Index of the finding that causes this one, directly or indirectly, and has no cause itself; `None` for a cause.
    pub cause: Option<usize>,
}

/// Returns the urgency of a finding: the rule's weight, plus the weight for each doubling of the limit. A logarithm, so
/// that measures with wide ranges, such as counts, don't outweigh the others.
fn urgency(finding: &Finding<'_>) -> f64 {
    finding.rule.weight * (1.0 + math::ln(finding.value / finding.rule.limit) / std::f64::consts::LN_2)
}

/// Ranks findings above their limits, most urgent first, and assigns causes. If several findings explain one, the most
/// urgent counts. Rules can't explain themselves, so every chain of causes ends.
pub(super) fn rank(findings: Vec<Finding<'_>>) -> Vec<RankedFinding<'_>> {
    let mut ranked: Vec<RankedFinding<'_>> = findings
        .into_iter()
        .map(|finding| RankedFinding { index: 0, urgency: urgency(&finding), finding, cause: None })
        .collect();
    ranked.sort_by(|a, b| b.urgency.total_cmp(&a.urgency));
    let direct: Vec<Option<usize>> = ranked.iter().map(|effect| direct_cause(&ranked, effect)).collect();
    for (index, one) in ranked.iter_mut().enumerate() {
        let mut cause = direct[index];
        while let Some(next) = cause.and_then(|at| direct[at]) {
            cause = Some(next);
        }
        (one.index, one.cause) = (index, cause);
    }
    ranked
}

fn direct_cause(ranked: &[RankedFinding<'_>], effect: &RankedFinding<'_>) -> Option<usize> {
    ranked
        .iter()
        .position(|cause| cause.finding.rule.explains(effect.finding.rule) && cause.finding.shares_scope_with(&effect.finding))
}
