//! Finds tasks whose paths lead along each other. A frame counts for one task only, and a task's window is from its first to its last
//! frame on the path, so a flight along one of two such paths takes frames from the other's window.

use spandrel_model::scenario::Scenario;
use spandrel_monitor::measures::on_path::ReferencePaths;
use spandrel_text::{Language, text};

/// Share of a path within another task's threshold above which `check` warns (estimate: more than two paths share where they cross).
pub const MAX_SHARE: f64 = 0.1;

/// Part of a task's path that is within the threshold of another task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Index of the task with the path.
    pub task: usize,
    /// Index of the other task.
    pub other: usize,
    /// Share of the path's points within the other task's threshold, 0 to 1.
    pub share: f64,
}

/// Returns the overlaps of more than a share of a path, in the order of the tasks.
#[must_use]
pub fn above(scenario: &Scenario, min_share: f64) -> Vec<Overlap> {
    let paths = ReferencePaths::new(scenario);
    let pairs = (0..paths.len()).flat_map(|task| (0..paths.len()).map(move |other| (task, other)));
    pairs
        .filter(|(task, other)| task != other)
        .map(|(task, other)| Overlap { task, other, share: share_within(&paths, task, other) })
        .filter(|overlap| overlap.share > min_share)
        .collect()
}

/// Returns the share of a path's points within the threshold of another task.
fn share_within(paths: &ReferencePaths, task: usize, other: usize) -> f64 {
    let points = paths.path(task).points_m();
    let is_within = |point| paths.nearest(other, point).is_some_and(|near| near.distance_m <= paths.threshold_m(other));
    points.iter().filter(|point| is_within(**point)).count() as f64 / points.len().max(1) as f64
}

/// Returns a warning for each overlap of more than [`MAX_SHARE`] of a path. Equal paths have their own warning.
pub(crate) fn warnings(file: &str, scenario: &Scenario, language: Language) -> Vec<String> {
    let tasks = &scenario.tasks;
    let words = |overlap: &Overlap| {
        let (task, other) = (&tasks[overlap.task], &tasks[overlap.other]);
        let words = text!(
            language,
            "check-overlap",
            share = format!("{:.0}", 100.0 * overlap.share),
            task = task.id,
            name = task.name.as_str(),
            threshold = other.threshold_m.to_string(),
            other = other.id,
            othername = other.name.as_str()
        );
        format!("{file}: {words}")
    };
    let is_copy = |overlap: &&Overlap| tasks[overlap.task].path_m == tasks[overlap.other].path_m;
    above(scenario, MAX_SHARE).iter().filter(|overlap| !is_copy(overlap)).map(words).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{scenario, shipped};

    /// Largest share of a shipped path within another task's threshold (estimate: where the ends of two paths meet).
    const MAX_SHIPPED_SHARE: f64 = 0.05;

    /// Returns two parallel lines of 40 m, the second one with another threshold and shifted by a distance.
    fn two_lines(apart_m: f64, shifted_m: f64, threshold_m: f64) -> Scenario {
        let text = shipped::TWO_BRIDGES;
        let (start, end) = (text.find("[[tasks]]").unwrap(), text.find("[defects]").unwrap());
        let line = |name: &str, north_m: f64, east_m: f64, threshold_m: f64| {
            format!(
                "[[tasks]]\nname = \"{name}\"\nkind = \"free\"\nthreshold_m = {threshold_m:.2}\n\
                 points_m = [[{:.2}, {north_m:.2}, 60.0], [{:.2}, {north_m:.2}, 60.0]]\n",
                east_m,
                east_m + 40.0
            )
        };
        let tasks = format!("{}{}\n", line("First", 0.0, 0.0, 2.0), line("Second", apart_m, shifted_m, threshold_m));
        scenario::read("lines.toml", &text.replace(&text[start..end], &tasks), &|_| Err("none".into())).unwrap()
    }

    #[test]
    fn exact_overlap_is_the_share_of_points_within_the_other_threshold() {
        // 51 points, 0.8 m apart. Of the first line, 20 m (0.8 m * 25) are beside the second one, at 2.5 m: within its 3 m only.
        let overlaps = above(&two_lines(2.5, 20.0, 3.0), 0.0);
        // The ends reach farther by sqrt(3² - 2.5²) = 1.66 m: points at 18.4 m and beyond, of which there are 28.
        assert_eq!(overlaps, [Overlap { task: 0, other: 1, share: 28.0 / 51.0 }]);
        assert_eq!(above(&two_lines(3.1, 20.0, 3.0), 0.0), []);
        assert_eq!(above(&two_lines(1.0, 0.0, 3.0), 0.0).len(), 2, "each line is within the other's threshold");
    }

    #[test]
    fn exact_warning_names_both_tasks_and_the_share() {
        let text = warnings("a.toml", &two_lines(2.5, 20.0, 3.0), Language::English);
        assert_eq!(
            text,
            [
                "a.toml: 55% of the path of task 1 'First' is within the threshold (3 m) of task 2 'Second', so that a flight along it counts \
              for both tasks: move the paths apart, or reduce threshold_m"
            ]
        );
        // 3 of 51 points, 6 %.
        assert_eq!(warnings("a.toml", &two_lines(2.5, 40.0, 3.0), Language::English), Vec::<String>::new());
        assert_eq!(
            warnings("a.toml", &two_lines(0.0, 0.0, 3.0), Language::English),
            Vec::<String>::new(),
            "equal paths have their own warning"
        );
    }

    #[test]
    fn regress_paths_of_shipped_jobs_belong_to_one_task() {
        for (name, text) in shipped::SCENARIOS {
            let job = scenario::read(&format!("{name}.toml"), text, &|_| Err("none".into())).unwrap();
            assert_eq!(above(&job, MAX_SHIPPED_SHARE), [], "{name}");
        }
    }
}
