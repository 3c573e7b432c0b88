//! Database of records: an SQLite file, or a PostgreSQL server specified by URL. Both use the same statements and
//! migrations. All calls block. Every change is one transaction that takes the write lock first, so concurrent writers
//! wait for each other, and an interrupted program never leaves a partial session.

use super::address::{self, sqlite_url, without_password};
use crate::errors::AppError;
use sqlx::any::AnyPoolOptions;
use sqlx::{Any, AnyConnection, AnyPool, Connection, Executor, Row, Transaction};
use std::future::Future;
use std::path::Path;
use std::time::Duration;

/// Maximum time that SQLite waits for other writers, ms.
const BUSY_TIMEOUT_PRAGMA: &str = "PRAGMA busy_timeout = 60000";
/// SQLite overwrites deleted data with zeros.
const SECURE_DELETE_PRAGMA: &str = "PRAGMA secure_delete = ON";
/// Advisory lock that PostgreSQL holds during a change; the number is arbitrary. Without the lock, two stations that
/// add the same new trainees in different orders would deadlock, and PostgreSQL would abort one transaction.
const WRITE_LOCK_QUERY: &str = "SELECT pg_advisory_xact_lock(7301420226)";

/// SQL dialect of the database.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SqlDialect {
    Sqlite,
    Postgres,
}

/// An open database with up-to-date tables.
#[derive(Debug)]
pub struct Database {
    /// `None` only while it is being dropped.
    runtime: Option<tokio::runtime::Runtime>,
    pub(super) pool: AnyPool,
    pub(super) kind: SqlDialect,
    name: String,
}

impl Database {
    /// Opens `postgres://...` or a file and brings its tables up to date. Creates the file if it does not exist.
    ///
    /// # Errors
    /// Returns an error if the URL is invalid, or the database cannot be opened or has a newer version.
    pub fn open(target: &str) -> Result<Self, AppError> {
        sqlx::any::install_default_drivers();
        let kind = if address::is_url(target) { SqlDialect::Postgres } else { SqlDialect::Sqlite };
        let name = without_password(target);
        address::check_tls_options(target).map_err(|wrong| AppError::invalid(format!("{name}: {wrong}")))?;
        if let (SqlDialect::Sqlite, Some(folder)) = (kind, Path::new(target).parent()) {
            std::fs::create_dir_all(folder)
                .map_err(|error| AppError::failed(format!("{}: cannot create the folder: {error}", folder.display())))?;
        }
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .map_err(|error| AppError::failed(format!("{name}: cannot start the database runtime: {error}")))?;
        let url = if kind == SqlDialect::Sqlite { sqlite_url(target) } else { target.to_owned() };
        // SQLite's data_version is meaningful only within one connection, so the connection stays open.
        let lives = |seconds| (kind == SqlDialect::Postgres).then(|| Duration::from_secs(seconds));
        let options = AnyPoolOptions::new().max_connections(1).idle_timeout(lives(600)).max_lifetime(lives(1800)).after_connect(
            move |connection, _| {
                Box::pin(async move { if kind == SqlDialect::Sqlite { prepare(connection).await } else { Ok(()) } })
            },
        );
        // The pool would keep retrying if the server refuses connections; a separate first connection reports the error
        // immediately.
        let open = async {
            AnyConnection::connect(&url).await?.close().await?;
            options.connect(&url).await
        };
        let refused =
            |error: sqlx::Error| AppError::failed(format!("{name}: cannot open: {}", address::connection_error(&error)));
        let pool = runtime.block_on(open).map_err(refused)?;
        let database = Self { runtime: Some(runtime), pool, kind, name };
        database.run(database.migrate())?;
        Ok(database)
    }

    /// Sets the stored version number of the tables.
    #[cfg(test)]
    pub fn set_schema_version(&self, version: i64) -> Result<(), AppError> {
        self.run(async {
            let change = sqlx::query("UPDATE schema_version SET version = $1").bind(version).execute(&self.pool).await;
            change.map(|_| ())
        })
    }

    /// Starts a write transaction and leaves it open.
    #[cfg(test)]
    pub fn begin_uncommitted_write(&self) -> Result<(), AppError> {
        self.run(async {
            match self.kind {
                SqlDialect::Sqlite => self.pool.execute("BEGIN IMMEDIATE").await.map(|_| ()),
                SqlDialect::Postgres => {
                    self.pool.execute("BEGIN").await?;
                    self.pool.execute(WRITE_LOCK_QUERY).await?;
                    self.pool.execute("UPDATE sessions SET fingerprint = ''").await.map(|_| ())
                }
            }
        })
    }

    /// Returns the database's address without a password, for messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn run<T>(&self, work: impl Future<Output = Result<T, sqlx::Error>>) -> Result<T, AppError> {
        let ended = || AppError::failed(format!("{}: the database is being closed", self.name));
        let runtime = self.runtime.as_ref().ok_or_else(ended)?;
        runtime.block_on(work).map_err(|error| AppError::failed(format!("{}: {error}", self.name)))
    }

    /// Returns a version string that changes whenever another connection modifies the database.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn version(&self) -> Result<String, AppError> {
        self.run(async {
            match self.kind {
                SqlDialect::Sqlite => {
                    let version: i64 = sqlx::query("PRAGMA data_version").fetch_one(&self.pool).await?.try_get(0)?;
                    Ok(version.to_string())
                }
                // Every write transaction on the server changes this value, so results may be recomputed unnecessarily,
                // but they are never outdated.
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
                change.execute(WRITE_LOCK_QUERY).await?;
                Ok(change)
            }
        }
    }

    /// Also removes deleted data from SQLite's write-ahead log.
    pub(super) async fn truncate_journal(&self) -> Result<(), sqlx::Error> {
        match self.kind {
            SqlDialect::Sqlite => self.pool.execute("PRAGMA wal_checkpoint(TRUNCATE)").await.map(|_| ()),
            SqlDialect::Postgres => Ok(()),
        }
    }
}

impl Drop for Database {
    fn drop(&mut self) {
        // The last reference may be dropped in a web server task, which must not block; dropping the runtime normally
        // would block.
        if let Some(runtime) = self.runtime.take() {
            runtime.shutdown_background();
        }
    }
}

async fn prepare(connection: &mut AnyConnection) -> Result<(), sqlx::Error> {
    for pragma in [BUSY_TIMEOUT_PRAGMA, SECURE_DELETE_PRAGMA] {
        connection.execute(pragma).await?;
    }
    // The write-ahead log allows reads while another process writes. SQLite may reject the mode change while another
    // station has the file open. That station also requests the change; until then, the busy timeout is sufficient.
    let _ = connection.execute("PRAGMA journal_mode = WAL").await;
    Ok(())
}

/// Converts to the database's integer type. Times and versions fit in 63 bits.
pub(super) fn signed(number: u64) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}
