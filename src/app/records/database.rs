//! The database of records: SQLite in a file, or PostgreSQL by URL; the same statements and migrations on both. Blocking, as the other
//! shells are. Every change is one transaction that takes the write lock first, so that stations that write at once wait for one another
//! and a kill at any moment leaves all of a session or nothing.

use crate::app::errors::AppError;
use crate::training::record::{Listed, Record};
use crate::training::trainee::{Role, Trainee};
use sqlx::any::{AnyArguments, AnyPoolOptions, AnyRow};
use sqlx::query::Query;
use sqlx::{Any, AnyConnection, AnyPool, Connection, Executor, Row, Transaction};
use std::collections::BTreeMap;
use std::future::Future;
use std::path::Path;

/// Migrations in their order; a database of version n has seen the first n. What is released here never changes, a new one is added.
const MIGRATIONS: &[&str] = &[include_str!("migrations/0001_first.sql"), include_str!("migrations/0002_passwords.sql")];
/// Names the lock that PostgreSQL holds while tables are made: any number that nobody else uses.
const MIGRATION_LOCK: &str = "SELECT pg_advisory_xact_lock(7301420226)";
/// SQLite waits so long for other writers, ms.
const PATIENCE: &str = "PRAGMA busy_timeout = 60000";
/// What is deleted is overwritten.
const FORGET: &str = "PRAGMA secure_delete = ON";
const UPSERT: &str = "INSERT INTO sessions (id, trainee, started_unix_us, scenario, scenario_sha256, vehicle, vehicle_sha256, \
    telemetry_sha256, spandrel_version, scorer_version, end_reason, seconds, conformity, efficiency, safety, accuracy, overall, \
    overall_max, fingerprint, record) \
    VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16, $17, $18, $19, $20) \
    ON CONFLICT (id) DO UPDATE SET trainee = excluded.trainee, started_unix_us = excluded.started_unix_us, \
    scenario = excluded.scenario, scenario_sha256 = excluded.scenario_sha256, vehicle = excluded.vehicle, \
    vehicle_sha256 = excluded.vehicle_sha256, telemetry_sha256 = excluded.telemetry_sha256, \
    spandrel_version = excluded.spandrel_version, scorer_version = excluded.scorer_version, end_reason = excluded.end_reason, \
    seconds = excluded.seconds, conformity = excluded.conformity, efficiency = excluded.efficiency, safety = excluded.safety, \
    accuracy = excluded.accuracy, overall = excluded.overall, overall_max = excluded.overall_max, \
    fingerprint = excluded.fingerprint, record = excluded.record \
    WHERE sessions.fingerprint <> excluded.fingerprint";
const ADD_TRAINEE: &str = "INSERT INTO trainees (pseudonym, role) VALUES ($1, $2) ON CONFLICT (pseudonym) DO NOTHING";
const SET_TRAINEE: &str = "INSERT INTO trainees (pseudonym, role, age_band, drone_experience, gaming_experience) \
    VALUES ($1, $2, $3, $4, $5) ON CONFLICT (pseudonym) DO UPDATE SET role = excluded.role, age_band = excluded.age_band, \
    drone_experience = excluded.drone_experience, gaming_experience = excluded.gaming_experience";
const TRAINEES: &str = "SELECT pseudonym, role, age_band, drone_experience, gaming_experience FROM trainees ORDER BY pseudonym";

const LIST: &str = "SELECT id, trainee, started_unix_us, scenario, overall, overall_max, end_reason FROM sessions";
const NEWEST: &str = "ORDER BY started_unix_us DESC, id LIMIT $1 OFFSET $2";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Sqlite,
    Postgres,
}

/// An open database with its tables made.
#[derive(Debug)]
pub struct Database {
    runtime: tokio::runtime::Runtime,
    pub(super) pool: AnyPool,
    kind: Kind,
    name: String,
}

impl Database {
    /// Opens `postgres://...`, or a file, which is made when it is not there; brings its tables up to date.
    ///
    /// # Errors
    /// When it cannot be opened or is of a newer version.
    pub fn open(target: &str) -> Result<Self, AppError> {
        sqlx::any::install_default_drivers();
        let kind = if is_url(target) { Kind::Postgres } else { Kind::Sqlite };
        let name = without_password(target);
        if let (Kind::Sqlite, Some(folder)) = (kind, Path::new(target).parent()) {
            std::fs::create_dir_all(folder)
                .map_err(|error| AppError::failed(format!("{}: cannot be made: {error}", folder.display())))?;
        }
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .map_err(|error| AppError::failed(format!("{name}: no runtime for the database: {error}")))?;
        let url = if kind == Kind::Sqlite { sqlite_url(target) } else { target.to_owned() };
        let options = AnyPoolOptions::new().max_connections(1).after_connect(move |connection, _| {
            Box::pin(async move { if kind == Kind::Sqlite { prepare(connection).await } else { Ok(()) } })
        });
        // The pool would try a server that refuses again and again; one that does not answer at once is told at once.
        let open = async {
            AnyConnection::connect(&url).await?.close().await?;
            options.connect(&url).await
        };
        let pool = runtime.block_on(open).map_err(|error| AppError::failed(format!("{name}: cannot be opened: {error}")))?;
        let database = Self { runtime, pool, kind, name };
        database.run(database.migrate())?;
        Ok(database)
    }

    /// Takes records in, each with its trainee; a session that is there unchanged stays untouched. Returns how many were new or changed.
    ///
    /// # Errors
    /// When the database refuses; then nothing is taken in.
    pub fn put(&self, records: &[Record]) -> Result<usize, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let changed = put_all(&mut change, records).await?;
            change.commit().await.map(|()| changed)
        })
    }

    /// Replaces all sessions by these; trainees and their details stay.
    ///
    /// # Errors
    /// When the database refuses; then all stays as it was.
    pub fn replace_all(&self, records: &[Record]) -> Result<usize, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            for statement in ["DELETE FROM answers", "DELETE FROM sessions"] {
                change.execute(statement).await?;
            }
            let changed = put_all(&mut change, records).await?;
            change.commit().await.map(|()| changed)
        })
    }

    /// Fingerprints of all sessions by their id.
    ///
    /// # Errors
    /// When the database refuses.
    pub fn fingerprints(&self) -> Result<BTreeMap<String, String>, AppError> {
        self.run(async {
            let rows = sqlx::query("SELECT id, fingerprint FROM sessions").fetch_all(&self.pool).await?;
            rows.iter().map(|row| Ok((row.try_get(0)?, row.try_get(1)?))).collect()
        })
    }

    /// Records in the order of their start: all, or one trainee's.
    ///
    /// # Errors
    /// When the database refuses or holds what is no record.
    pub fn records(&self, trainee: Option<&str>) -> Result<Vec<Record>, AppError> {
        let rows: Vec<(String, String)> = self.run(async {
            let rows = match trainee {
                Some(trainee) => {
                    let query = "SELECT id, record FROM sessions WHERE trainee = $1 ORDER BY started_unix_us, id";
                    sqlx::query(query).bind(trainee.to_owned()).fetch_all(&self.pool).await?
                }
                None => sqlx::query("SELECT id, record FROM sessions ORDER BY started_unix_us, id").fetch_all(&self.pool).await?,
            };
            rows.iter().map(|row| Ok((row.try_get(0)?, row.try_get(1)?))).collect()
        })?;
        let read = |(id, text): (String, String)| {
            serde_json::from_str(&text).map_err(|error| AppError::failed(format!("{}: session {id}: {error}", self.name)))
        };
        rows.into_iter().map(read).collect()
    }

    /// Sessions in short, the newest first: all, or one trainee's; so many after the first `skip`.
    ///
    /// # Errors
    /// When the database refuses.
    pub fn list(&self, trainee: Option<&str>, most: u32, skip: u32) -> Result<Vec<Listed>, AppError> {
        let query = match trainee {
            Some(_) => format!("{LIST} WHERE trainee = $3 {NEWEST}"),
            None => format!("{LIST} {NEWEST}"),
        };
        self.run(async {
            let query = sqlx::query(&query).bind(i64::from(most)).bind(i64::from(skip));
            let query = if let Some(trainee) = trainee { query.bind(trainee.to_owned()) } else { query };
            query.fetch_all(&self.pool).await?.iter().map(listed).collect()
        })
    }

    /// Ids and trainees of the sessions that started before this instant, µs since the Unix epoch.
    ///
    /// # Errors
    /// When the database refuses.
    pub fn older_than(&self, unix_us: u64) -> Result<Vec<(String, String)>, AppError> {
        self.run(async {
            let query = "SELECT id, trainee FROM sessions WHERE started_unix_us < $1 ORDER BY started_unix_us, id";
            let rows = sqlx::query(query).bind(signed(unix_us)).fetch_all(&self.pool).await?;
            rows.iter().map(|row| Ok((row.try_get(0)?, row.try_get(1)?))).collect()
        })
    }

    /// Deletes sessions. Returns how many there were.
    ///
    /// # Errors
    /// When the database refuses; then all stays as it was.
    pub fn delete_sessions(&self, ids: &[String]) -> Result<u64, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let mut deleted = 0;
            for id in ids {
                sqlx::query("DELETE FROM answers WHERE session = $1").bind(id.clone()).execute(&mut *change).await?;
                let done = sqlx::query("DELETE FROM sessions WHERE id = $1").bind(id.clone()).execute(&mut *change).await?;
                deleted += done.rows_affected();
            }
            change.commit().await?;
            self.forget().await.map(|()| deleted)
        })
    }

    /// Deletes a trainee with everything. Returns whether he was known, and how many sessions there were.
    ///
    /// # Errors
    /// When the database refuses; then all stays as it was.
    pub fn erase(&self, trainee: &str) -> Result<(bool, u64), AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let answers = "DELETE FROM answers WHERE session IN (SELECT id FROM sessions WHERE trainee = $1)";
            sqlx::query(answers).bind(trainee.to_owned()).execute(&mut *change).await?;
            let by = |query: &'static str| sqlx::query(query).bind(trainee.to_owned());
            let sessions = by("DELETE FROM sessions WHERE trainee = $1").execute(&mut *change).await?.rows_affected();
            by("DELETE FROM passwords WHERE pseudonym = $1").execute(&mut *change).await?;
            let known = by("DELETE FROM trainees WHERE pseudonym = $1").execute(&mut *change).await?.rows_affected() > 0;
            change.commit().await?;
            self.forget().await.map(|()| (known, sessions))
        })
    }

    /// All trainees.
    ///
    /// # Errors
    /// When the database refuses.
    pub fn trainees(&self) -> Result<Vec<Trainee>, AppError> {
        self.run(async {
            let rows = sqlx::query(TRAINEES).fetch_all(&self.pool).await?;
            rows.iter().map(trainee).collect()
        })
    }

    /// Adds a trainee or sets his details.
    ///
    /// # Errors
    /// When the database refuses.
    pub fn set_trainee(&self, trainee: &Trainee) -> Result<(), AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            set(&mut change, trainee).await?;
            change.commit().await
        })
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
        self.run(async { self.pool.execute("BEGIN IMMEDIATE").await.map(|_| ()) })
    }

    /// Its place, without a password, for messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn run<T>(&self, work: impl Future<Output = Result<T, sqlx::Error>>) -> Result<T, AppError> {
        self.runtime.block_on(work).map_err(|error| AppError::failed(format!("{}: {error}", self.name)))
    }

    pub(super) async fn begin(&self) -> Result<Transaction<'static, Any>, sqlx::Error> {
        let begin = match self.kind {
            Kind::Sqlite => "BEGIN IMMEDIATE",
            Kind::Postgres => "BEGIN",
        };
        self.pool.begin_with(begin).await
    }

    async fn migrate(&self) -> Result<(), sqlx::Error> {
        // Who finds the tables made takes no lock: readers do not wait for writers.
        let version = sqlx::query("SELECT version FROM schema_version").fetch_optional(&self.pool).await;
        if let Ok(Some(row)) = version
            && row.try_get::<i64, _>(0).is_ok_and(|version| usize::try_from(version) == Ok(MIGRATIONS.len()))
        {
            return Ok(());
        }
        let mut change = self.begin().await?;
        if self.kind == Kind::Postgres {
            change.execute(MIGRATION_LOCK).await?;
        }
        change.execute("CREATE TABLE IF NOT EXISTS schema_version (version BIGINT NOT NULL)").await?;
        let found = sqlx::query("SELECT version FROM schema_version").fetch_optional(&mut *change).await?;
        let version: i64 = found.as_ref().map_or(Ok(0), |row| row.try_get(0))?;
        let done = usize::try_from(version).unwrap_or(usize::MAX);
        let Some(missing) = MIGRATIONS.get(done..) else {
            let newest = MIGRATIONS.len();
            return Err(sqlx::Error::Configuration(
                format!("its tables are of version {version}, this program knows {newest}: use a newer one").into(),
            ));
        };
        for migration in missing {
            sqlx::raw_sql(migration).execute(&mut *change).await?;
        }
        if !missing.is_empty() {
            change.execute("DELETE FROM schema_version").await?;
            let newest = i64::try_from(MIGRATIONS.len()).unwrap_or(i64::MAX);
            sqlx::query("INSERT INTO schema_version (version) VALUES ($1)").bind(newest).execute(&mut *change).await?;
        }
        change.commit().await
    }

    /// What was deleted leaves SQLite's journal, too.
    async fn forget(&self) -> Result<(), sqlx::Error> {
        match self.kind {
            Kind::Sqlite => self.pool.execute("PRAGMA wal_checkpoint(TRUNCATE)").await.map(|_| ()),
            Kind::Postgres => Ok(()),
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

/// Adds a trainee or sets his details, within a change.
pub(super) async fn set(change: &mut Transaction<'static, Any>, trainee: &Trainee) -> Result<(), sqlx::Error> {
    let query = sqlx::query(SET_TRAINEE).bind(trainee.pseudonym.clone()).bind(trainee.role.word().to_owned());
    let details = [&trainee.age_band, &trainee.drone_experience, &trainee.gaming_experience];
    details.into_iter().fold(query, |query, detail| query.bind(detail.clone())).execute(&mut **change).await.map(|_| ())
}

async fn put_all(change: &mut Transaction<'static, Any>, records: &[Record]) -> Result<usize, sqlx::Error> {
    let mut changed = 0;
    for record in records {
        changed += usize::from(put(change, record).await?);
    }
    Ok(changed)
}

async fn put(change: &mut Transaction<'static, Any>, record: &Record) -> Result<bool, sqlx::Error> {
    record.check().map_err(|wrong| sqlx::Error::Encode(format!("session {}: {wrong}", record.id).into()))?;
    let trainee = sqlx::query(ADD_TRAINEE).bind(record.trainee.clone()).bind(Role::Trainee.word().to_owned());
    trainee.execute(&mut **change).await?;
    let text = serde_json::to_string(record).map_err(|error| sqlx::Error::Encode(error.into()))?;
    let done = bind(sqlx::query(UPSERT), record, text).execute(&mut **change).await?;
    if done.rows_affected() == 0 {
        return Ok(false);
    }
    sqlx::query("DELETE FROM answers WHERE session = $1").bind(record.id.clone()).execute(&mut **change).await?;
    let Some(answers) = &record.answers else { return Ok(true) };
    let given = answers.given.iter().map(|(item, answer)| (item.to_string(), *answer));
    let tlx = answers.tlx.iter().map(|(scale, answer)| (format!("tlx.{}", scale.key()), *answer));
    for (question, answer) in given.chain(tlx) {
        let query = sqlx::query("INSERT INTO answers (session, question, answer) VALUES ($1, $2, $3)");
        query.bind(record.id.clone()).bind(question).bind(i64::from(answer)).execute(&mut **change).await?;
    }
    Ok(true)
}

fn bind<'q>(query: Query<'q, Any, AnyArguments<'q>>, record: &Record, text: String) -> Query<'q, Any, AnyArguments<'q>> {
    let scores = &record.scores;
    query
        .bind(record.id.clone())
        .bind(record.trainee.clone())
        .bind(signed(record.started_unix_us))
        .bind(record.scenario.clone())
        .bind(record.scenario_sha256.clone())
        .bind(record.vehicle.clone())
        .bind(record.vehicle_sha256.clone())
        .bind(record.telemetry_sha256.clone())
        .bind(record.spandrel_version.clone())
        .bind(i64::from(record.scorer_version))
        .bind(record.end_reason.clone())
        .bind(record.seconds)
        .bind(scores.conformity)
        .bind(scores.efficiency)
        .bind(scores.safety)
        .bind(scores.accuracy)
        .bind(scores.overall)
        .bind(scores.overall_max)
        .bind(record.fingerprint.clone())
        .bind(text)
}

fn listed(row: &AnyRow) -> Result<Listed, sqlx::Error> {
    let started: i64 = row.try_get(2)?;
    Ok(Listed {
        id: row.try_get(0)?,
        trainee: row.try_get(1)?,
        started_unix_us: u64::try_from(started).unwrap_or_default(),
        scenario: row.try_get(3)?,
        overall: row.try_get(4)?,
        overall_max: row.try_get(5)?,
        end_reason: row.try_get(6)?,
    })
}

pub(super) fn trainee(row: &AnyRow) -> Result<Trainee, sqlx::Error> {
    let role: String = row.try_get(1)?;
    Ok(Trainee {
        pseudonym: row.try_get(0)?,
        role: Role::from_word(&role).ok_or_else(|| sqlx::Error::Decode(format!("'{role}' is no role").into()))?,
        age_band: row.try_get(2)?,
        drone_experience: row.try_get(3)?,
        gaming_experience: row.try_get(4)?,
    })
}

/// Times and versions fit in 63 bits.
fn signed(number: u64) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}

fn is_url(target: &str) -> bool {
    target.starts_with("postgres://") || target.starts_with("postgresql://")
}

/// A file name as a URL; a missing file is made.
fn sqlite_url(file: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/._-~".contains(&byte);
    let encoded: String =
        file.bytes().map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect();
    format!("sqlite://{encoded}?mode=rwc")
}

/// `postgres://user:secret@host/db` without the secret.
fn without_password(target: &str) -> String {
    let Some((scheme, rest)) = target.split_once("://").filter(|_| is_url(target)) else { return target.to_owned() };
    let (address, _) = rest.split_once('?').unwrap_or((rest, ""));
    match address.rsplit_once('@') {
        Some((user, host)) => format!("{scheme}://{}@{host}", user.split(':').next().unwrap_or_default()),
        None => format!("{scheme}://{address}"),
    }
}
