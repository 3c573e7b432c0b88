//! Chi-squared homogeneity test for the answers or scores of multiple groups.

use super::StatisticsError;
use super::distribution::chi_squared_upper_tail;
use serde::Serialize;

/// Minimum expected cell count for a good chi-squared approximation (Cochran 1954).
const MIN_EXPECTED_COUNT: f64 = 5.0;

/// Result of a chi-squared test of homogeneity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Homogeneity {
    /// Test statistic: sum of (observed - expected)^2 / expected.
    pub chi_squared: f64,
    /// Degrees of freedom, counting only nonempty rows and columns.
    pub df: usize,
    /// Probability of a difference this large or larger between homogeneous groups.
    pub p: f64,
    /// Smallest expected cell count.
    pub smallest_expected: f64,
    /// Warning, if any expected count is below 5.
    pub warning: Option<String>,
}

/// Tests whether the rows (groups) of a table of counts have the same distribution across columns (categories). Empty
/// rows and columns are ignored.
///
/// # Errors
/// Fails if the rows differ in length or if fewer than two rows or columns are nonempty.
pub fn homogeneity(table: &[Vec<usize>]) -> Result<Homogeneity, StatisticsError> {
    let columns = table.first().map_or(0, Vec::len);
    if let Some(other) = table.iter().find(|row| row.len() != columns) {
        return Err(StatisticsError::Unpaired { left: columns, right: other.len() });
    }
    let rows: Vec<&Vec<usize>> = table.iter().filter(|row| row.iter().sum::<usize>() > 0).collect();
    let kept: Vec<usize> = (0..columns).filter(|column| rows.iter().any(|row| row[*column] > 0)).collect();
    if rows.len() < 2 {
        return Err(StatisticsError::TooFew { n: rows.len(), needed: 2 });
    }
    if kept.len() < 2 {
        return Err(StatisticsError::Constant("the category"));
    }
    let row_sum = |row: &[usize]| row.iter().sum::<usize>() as f64;
    let total: f64 = rows.iter().map(|row| row_sum(row)).sum();
    let (mut chi_squared, mut smallest) = (0.0, f64::INFINITY);
    for column in &kept {
        let column_sum = rows.iter().map(|row| row[*column]).sum::<usize>() as f64;
        for row in &rows {
            let expected = row_sum(row) * column_sum / total;
            let off = row[*column] as f64 - expected;
            chi_squared += off * off / expected;
            smallest = smallest.min(expected);
        }
    }
    let df = (rows.len() - 1) * (kept.len() - 1);
    let few = smallest < MIN_EXPECTED_COUNT;
    Ok(Homogeneity {
        chi_squared,
        df,
        p: chi_squared_upper_tail(chi_squared, df as f64).unwrap_or(1.0),
        smallest_expected: smallest,
        warning: few.then(|| {
            format!("an expected count is {smallest:.2}, below {MIN_EXPECTED_COUNT}, so the p value is only approximate")
        }),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_two_by_two_table_matches_closed_form() {
        // n (ad - bc)^2 / (product of the marginal sums) = 100 (10 x 20 - 30 x 40)^2 / (40 x 60 x 50 x 50).
        let test = homogeneity(&[vec![10, 30], vec![40, 20]]).unwrap();
        assert!((test.chi_squared - 100.0 * 1e6 / (40.0 * 60.0 * 50.0 * 50.0)).abs() < 1e-12);
        assert_eq!((test.df, test.smallest_expected, test.warning), (1, 20.0, None));
    }

    #[test]
    fn exact_equal_groups_have_p_1_and_small_counts_have_a_warning() {
        let test = homogeneity(&[vec![2, 0, 4], vec![1, 0, 2], vec![0, 0, 0]]).unwrap();
        assert_eq!((test.chi_squared, test.df, test.p), (0.0, 1, 1.0));
        assert!(test.warning.unwrap().contains("below 5"));
    }

    #[test]
    fn exact_degenerate_tables_are_rejected() {
        assert!(homogeneity(&[vec![3, 4]]).is_err());
        assert!(homogeneity(&[vec![3, 0], vec![4, 0]]).is_err());
        assert!(homogeneity(&[vec![3, 0], vec![4]]).is_err());
        assert!(homogeneity(&[]).is_err());
    }
}
