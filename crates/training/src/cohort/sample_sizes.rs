//! Numbers of trainees below which a statistic is limited.

/// Number of trainees needed to detect medium effects at a power of 0.8 with a percentile bootstrap (Fritz and
/// MacKinnon 2007). Smaller samples cause a warning.
pub const RECOMMENDED_RESPONDENTS: usize = 78;

/// Minimum number of pairs for meaningful paired tests. Detecting a medium effect (d = 0.5) at a power of 0.8 and a
/// two-tailed significance level of 0.05 takes 34 pairs (Cohen 1988).
pub const RECOMMENDED_PAIRS: usize = 34;

/// Minimum number of trainees for a reliability that can be relied on (Koo and Li 2016).
pub const RECOMMENDED_REPEATERS: usize = 30;
