//! Database marks for erased data. Every import and rebuild checks them, so erased sessions do not return from folders
//! on other stations.

use super::database::{Database, signed};
use crate::errors::AppError;
use crate::io::clock;
use spandrel_monitor::folder::sha256_hex;
use spandrel_training::record::SessionRecord;
use sqlx::{Any, Row, Transaction};
use std::collections::BTreeMap;
use std::path::Path;

const INSERT_MARK_QUERY: &str = "INSERT INTO erased (what, sha256, erased_unix_us) VALUES ($1, $2, $3) \
    ON CONFLICT (what, sha256) DO UPDATE SET erased_unix_us = excluded.erased_unix_us";
const MARK_EXISTS_QUERY: &str = "SELECT COUNT(*) FROM erased WHERE (what = 'trainee' AND sha256 = $1 AND erased_unix_us >= $2) \
    OR (what = 'session' AND sha256 = $3)";

/// What an erasure mark applies to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ErasedKind {
    /// All sessions of a trainee that started before the mark.
    Trainee,
    /// A single session, by its ID.
    Session,
    /// A folder on this machine that must still be removed.
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

/// All marks: time of erasure in µs since the Unix epoch, by kind and name hash.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ErasureMarks(BTreeMap<(String, String), u64>);

impl ErasureMarks {
    /// Returns true if the session was erased, or if its trainee was erased after it started.
    #[must_use]
    pub fn contains(&self, id: &str, trainee: &str, started_unix_us: u64) -> bool {
        let at = |what: ErasedKind, name: &str| self.0.get(&(what.word().to_owned(), hash(name)));
        at(ErasedKind::Session, id).is_some() || at(ErasedKind::Trainee, trainee).is_some_and(|erased| *erased >= started_unix_us)
    }
}

/// Returns the last component of a folder path.
pub(super) fn folder_name(folder: &Path) -> String {
    folder.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Returns the hash that identifies a name in a mark; storing the name itself would defeat the erasure.
pub(super) fn hash(name: &str) -> String {
    sha256_hex(format!("erased: {name}").as_bytes())
}

impl Database {
    /// Returns all erasure marks.
    ///
    /// # Errors
    /// Returns an error if the database fails.
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

/// Marks a name as erased at the current time, within the transaction that erases it.
pub(super) async fn mark(change: &mut Transaction<'static, Any>, what: ErasedKind, name: &str) -> Result<(), sqlx::Error> {
    let query = sqlx::query(INSERT_MARK_QUERY).bind(what.word().to_owned()).bind(hash(name)).bind(signed(clock::unix_us()));
    query.execute(&mut **change).await.map(|_| ())
}

/// Removes a mark, within a transaction.
pub(super) async fn unmark(change: &mut Transaction<'static, Any>, what: ErasedKind, name: &str) -> Result<(), sqlx::Error> {
    let query = sqlx::query("DELETE FROM erased WHERE what = $1 AND sha256 = $2");
    query.bind(what.word().to_owned()).bind(hash(name)).execute(&mut **change).await.map(|_| ())
}

/// Like [`ErasureMarks::contains`], but within a transaction: nothing can be erased between this check and the commit.
pub(super) async fn contains(change: &mut Transaction<'static, Any>, record: &SessionRecord) -> Result<bool, sqlx::Error> {
    let query =
        sqlx::query(MARK_EXISTS_QUERY).bind(hash(&record.trainee)).bind(signed(record.started_unix_us)).bind(hash(&record.id));
    let count: i64 = query.fetch_one(&mut **change).await?.try_get(0)?;
    Ok(count > 0)
}
