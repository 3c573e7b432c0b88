//! The jobs that an instructor can order at stations. Reading them means parsing all scenarios, so they are kept until a file
//! changes.

use super::lock::lock;
use super::scenario_library::{self, StoredScenario};
use crate::io::files::with_variant;
use spandrel_model::scenario::{form_names, variant_names};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::SystemTime;

/// A job that can be ordered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StationJob {
    /// Its name with each form; or its name alone, and with each level.
    pub names: Vec<String>,
    /// Text of the scenario file, unless the scenario is shipped.
    pub uploaded_text: Option<String>,
}

impl StationJob {
    fn new(stored: StoredScenario) -> Self {
        let names = names(&stored.named.name, &stored.text);
        Self { names, uploaded_text: stored.named.uploaded.then_some(stored.text) }
    }
}

/// Returns a scenario's name with each of its forms; or its name alone, and with each of its levels.
fn names(name: &str, text: &str) -> Vec<String> {
    let forms = form_names(text);
    let alone = forms.is_empty().then(|| name.to_owned());
    alone.into_iter().chain(variant_names(text).iter().map(|variant| with_variant(name, Some(variant), None))).collect()
}

/// Path, length and modification time of an uploaded file.
type FileStamp = (PathBuf, u64, Option<SystemTime>);

/// The jobs that were read, and the stamps of the uploaded files at that time.
#[derive(Debug)]
struct ReadJobs {
    stamps: Vec<FileStamp>,
    jobs: Arc<[StationJob]>,
}

/// The jobs, kept until an uploaded file changes.
#[derive(Debug, Default)]
pub struct StationJobs(Mutex<Option<ReadJobs>>);

impl StationJobs {
    /// Returns all jobs: the shipped ones, then those in a folder.
    pub fn all(&self, folder: &Path) -> Arc<[StationJob]> {
        let stamps = stamps(folder);
        let mut cached = lock(&self.0);
        if let Some(known) = cached.as_ref().filter(|known| known.stamps == stamps) {
            return known.jobs.clone();
        }
        let jobs: Arc<[StationJob]> = scenario_library::all(folder).into_iter().map(StationJob::new).collect();
        *cached = Some(ReadJobs { stamps, jobs: jobs.clone() });
        jobs
    }
}

fn stamps(folder: &Path) -> Vec<FileStamp> {
    let stamp = |path: PathBuf| {
        let metadata = std::fs::metadata(&path).ok();
        let length = metadata.as_ref().map_or(0, std::fs::Metadata::len);
        (path, length, metadata.and_then(|metadata| metadata.modified().ok()))
    };
    scenario_library::uploaded(folder).into_iter().map(stamp).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::shipped::PRACTICE;

    #[test]
    fn exact_jobs_are_read_again_only_after_a_file_has_changed() {
        let folder = tempfile::tempdir().unwrap();
        let jobs = StationJobs::default();
        let shipped = jobs.all(folder.path());
        let names: Vec<&str> = shipped.iter().flat_map(|job| &job.names).map(String::as_str).collect();
        assert!(
            names.contains(&"drill-hover") && names.contains(&"drill-hover@9") && names.contains(&"pilot-study@B"),
            "{names:?}"
        );
        assert!(Arc::ptr_eq(&shipped, &jobs.all(folder.path())), "the same list");
        let text = PRACTICE.replace("name = \"practice\"", "name = \"windy\"");
        let path = folder.path().join("windy.toml");
        std::fs::write(&path, &text).unwrap();
        let with_own = jobs.all(folder.path());
        let own = with_own.last().unwrap();
        assert_eq!((own.names[0].as_str(), own.uploaded_text.as_ref()), ("windy", Some(&text)));
        std::fs::remove_file(path).unwrap();
        assert_eq!(jobs.all(folder.path()), shipped);
    }
}
