//! What was erased stays so: a mark in the database that every import and rebuild looks at, whichever station has a folder of it still.

use super::database::{Database, signed};
use crate::errors::AppError;
use crate::io::clock;
use spandrel_monitor::folder::sha256_hex;
use spandrel_training::record::SessionRecord;
use sqlx::{Any, Row, Transaction};
use std::collections::BTreeMap;
use std::path::Path;

const MARK: &str = "INSERT INTO erased (what, sha256, erased_unix_us) VALUES ($1, $2, $3) \
    ON CONFLICT (what, sha256) DO UPDATE SET erased_unix_us = excluded.erased_unix_us";
const HOLDS: &str = "SELECT COUNT(*) FROM erased WHERE (what = 'trainee' AND sha256 = $1 AND erased_unix_us >= $2) \
    OR (what = 'session' AND sha256 = $3)";

/// What is marked as erased.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ErasedKind {
    /// All sessions of a trainee that began before.
    Trainee,
    /// One session.
    Session,
    /// A folder here that is still to be removed.
    Folder,
}

impl ErasedKind {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Trainee => "trainee",
            Self::Session => "session",
            Self::Folder => "folder",
        }
    }
}

/// All marks, by what and the hash of its name, with their times, µs since the Unix epoch.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ErasureMarks(BTreeMap<(String, String), u64>);

impl ErasureMarks {
    /// A session must not come back: it was erased, or its trainee after it had begun.
    #[must_use]
    pub fn contains(&self, id: &str, trainee: &str, started_unix_us: u64) -> bool {
        let at = |what: ErasedKind, name: &str| self.0.get(&(what.word().to_owned(), hash(name)));
        at(ErasedKind::Session, id).is_some() || at(ErasedKind::Trainee, trainee).is_some_and(|erased| *erased >= started_unix_us)
    }
}

/// A folder's own name.
pub(super) fn name_of(folder: &Path) -> String {
    folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// A name is not kept where it was to be forgotten.
pub(super) fn hash(name: &str) -> String {
    sha256_hex(format!("erased: {name}").as_bytes())
}

impl Database {
    /// What was erased so far.
    ///
    /// # Errors
    /// If the database fails.
    pub fn erased(&self) -> Result<ErasureMarks, AppError> {
        self.run(async {
            let rows = sqlx::query("SELECT what, sha256, erased_unix_us FROM erased").fetch_all(&self.pool).await?;
            let mark = |row: &sqlx::any::AnyRow| {
                let erased: i64 = row.try_get(2)?;
                Ok(((row.try_get(0)?, row.try_get(1)?), u64::try_from(erased).unwrap_or_default()))
            };
            rows.iter().map(mark).collect::<Result<_, sqlx::Error>>().map(ErasureMarks)
        })
    }
}

/// Marks a name as erased now, within the change that erases it.
pub(super) async fn mark(change: &mut Transaction<'static, Any>, what: ErasedKind, name: &str) -> Result<(), sqlx::Error> {
    let query = sqlx::query(MARK).bind(what.word().to_owned()).bind(hash(name)).bind(signed(clock::unix_us()));
    query.execute(&mut **change).await.map(|_| ())
}

/// Takes a mark away, within a change.
pub(super) async fn unmark(change: &mut Transaction<'static, Any>, what: ErasedKind, name: &str) -> Result<(), sqlx::Error> {
    let query = sqlx::query("DELETE FROM erased WHERE what = $1 AND sha256 = $2");
    query.bind(what.word().to_owned()).bind(hash(name)).execute(&mut **change).await.map(|_| ())
}

/// The same as [`ErasureMarks::contains`], within a change: nobody erases between this answer and the change's end.
pub(super) async fn contains(change: &mut Transaction<'static, Any>, record: &SessionRecord) -> Result<bool, sqlx::Error> {
    let query = sqlx::query(HOLDS).bind(hash(&record.trainee)).bind(signed(record.started_unix_us)).bind(hash(&record.id));
    let count: i64 = query.fetch_one(&mut **change).await?.try_get(0)?;
    Ok(count > 0)
}
