//! The database of records: SQLite in a file, or PostgreSQL by URL; the same statements and migrations on both. Blocking, as the other
//! shells are. Every change is one transaction that takes the write lock first, so that stations that write at once wait for one another
//! and a kill at any moment leaves all of a session or nothing.

use super::address::{self, sqlite_url, without_password};
use crate::errors::AppError;
use sqlx::any::AnyPoolOptions;
use sqlx::{Any, AnyConnection, AnyPool, Connection, Executor, Row, Transaction};
use std::future::Future;
use std::path::Path;
use std::time::Duration;

/// SQLite waits so long for other writers, ms.
const PATIENCE: &str = "PRAGMA busy_timeout = 60000";
/// What is deleted is overwritten.
const FORGET: &str = "PRAGMA secure_delete = ON";
/// Names the lock that PostgreSQL holds during a change: any number that nobody else uses. Without it two stations that take in the same
/// new trainees in different orders would wait for each other, and one would be thrown out.
const WRITE_LOCK: &str = "SELECT pg_advisory_xact_lock(7301420226)";

/// Whose dialect is spoken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SqlDialect {
    Sqlite,
    Postgres,
}

/// An open database with its tables made.
#[derive(Debug)]
pub struct Database {
    /// Taken out when it ends.
    runtime: Option<tokio::runtime::Runtime>,
    pub(super) pool: AnyPool,
    pub(super) kind: SqlDialect,
    name: String,
}

impl Database {
    /// Opens `postgres://...`, or a file, which is made when it is not there; brings its tables up to date.
    ///
    /// # Errors
    /// When the URL is wrong, or it cannot be opened or is of a newer version.
    pub fn open(target: &str) -> Result<Self, AppError> {
        sqlx::any::install_default_drivers();
        let kind = if address::is_url(target) { SqlDialect::Postgres } else { SqlDialect::Sqlite };
        let name = without_password(target);
        address::check(target).map_err(|wrong| AppError::wrong(format!("{name}: {wrong}")))?;
        if let (SqlDialect::Sqlite, Some(folder)) = (kind, Path::new(target).parent()) {
            std::fs::create_dir_all(folder)
                .map_err(|error| AppError::failed(format!("{}: cannot be made: {error}", folder.display())))?;
        }
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .map_err(|error| AppError::failed(format!("{name}: no runtime for the database: {error}")))?;
        let url = if kind == SqlDialect::Sqlite { sqlite_url(target) } else { target.to_owned() };
        // SQLite's version of its data counts within one connection: it stays open.
        let lives = |seconds| (kind == SqlDialect::Postgres).then(|| Duration::from_secs(seconds));
        let options = AnyPoolOptions::new().max_connections(1).idle_timeout(lives(600)).max_lifetime(lives(1800)).after_connect(
            move |connection, _| {
                Box::pin(async move { if kind == SqlDialect::Sqlite { prepare(connection).await } else { Ok(()) } })
            },
        );
        // The pool would try a server that refuses again and again; one that does not answer at once is told at once.
        let open = async {
            AnyConnection::connect(&url).await?.close().await?;
            options.connect(&url).await
        };
        let refused =
            |error: sqlx::Error| AppError::failed(format!("{name}: cannot be opened: {}", address::connection_error(&error)));
        let pool = runtime.block_on(open).map_err(refused)?;
        let database = Self { runtime: Some(runtime), pool, kind, name };
        database.run(database.migrate())?;
        Ok(database)
    }

    /// Says that its tables are of another version.
    #[cfg(test)]
    pub fn pretend_version(&self, version: i64) -> Result<(), AppError> {
        self.run(async {
            let change = sqlx::query("UPDATE schema_version SET version = $1").bind(version).execute(&self.pool).await;
            change.map(|_| ())
        })
    }

    /// Begins to write and does not end.
    #[cfg(test)]
    pub fn keep_writing(&self) -> Result<(), AppError> {
        self.run(async {
            match self.kind {
                SqlDialect::Sqlite => self.pool.execute("BEGIN IMMEDIATE").await.map(|_| ()),
                SqlDialect::Postgres => {
                    self.pool.execute("BEGIN").await?;
                    self.pool.execute(WRITE_LOCK).await?;
                    self.pool.execute("UPDATE sessions SET fingerprint = ''").await.map(|_| ())
                }
            }
        })
    }

    /// Its place, without a password, for messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn run<T>(&self, work: impl Future<Output = Result<T, sqlx::Error>>) -> Result<T, AppError> {
        let ended = || AppError::failed(format!("{}: is being closed", self.name));
        let runtime = self.runtime.as_ref().ok_or_else(ended)?;
        runtime.block_on(work).map_err(|error| AppError::failed(format!("{}: {error}", self.name)))
    }

    /// Returns a text that differs from an earlier answer of the same handle whenever another handle has changed the database since.
    ///
    /// # Errors
    /// If the database fails.
    pub fn version(&self) -> Result<String, AppError> {
        self.run(async {
            match self.kind {
                SqlDialect::Sqlite => {
                    let version: i64 = sqlx::query("PRAGMA data_version").fetch_one(&self.pool).await?.try_get(0)?;
                    Ok(version.to_string())
                }
                // Any transaction of the server that writes changes it: figures are computed too often rather than too seldom.
                SqlDialect::Postgres => {
                    sqlx::query("SELECT txid_current_snapshot()::text").fetch_one(&self.pool).await?.try_get(0)
                }
            }
        })
    }

    pub(super) async fn begin(&self) -> Result<Transaction<'static, Any>, sqlx::Error> {
        match self.kind {
            SqlDialect::Sqlite => self.pool.begin_with("BEGIN IMMEDIATE").await,
            SqlDialect::Postgres => {
                let mut change = self.pool.begin().await?;
                change.execute(WRITE_LOCK).await?;
                Ok(change)
            }
        }
    }

    /// What was deleted leaves SQLite's journal, too.
    pub(super) async fn forget(&self) -> Result<(), sqlx::Error> {
        match self.kind {
            SqlDialect::Sqlite => self.pool.execute("PRAGMA wal_checkpoint(TRUNCATE)").await.map(|_| ()),
            SqlDialect::Postgres => Ok(()),
        }
    }
}

impl Drop for Database {
    fn drop(&mut self) {
        // The last to let go of it may be a task of the web server, which must not wait: an ordinary end of a runtime does.
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}

async fn prepare(connection: &mut AnyConnection) -> Result<(), sqlx::Error> {
    for pragma in [PATIENCE, FORGET] {
        connection.execute(pragma).await?;
    }
    // A journal beside the file lets readers read while somebody writes. While another station has the file open it may be refused;
    // then the other one asks for it as well, and until then only patience is needed.
    let _ = connection.execute("PRAGMA journal_mode = WAL").await;
    Ok(())
}

/// Times and versions fit in 63 bits.
pub(super) fn signed(number: u64) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}
