//! Imports, lists and deletes sessions in the database.

use super::database::{Database, signed};
use super::erasure_marks::{self, ErasedKind, folder_name};
use crate::errors::AppError;
use spandrel_monitor::score::completion::Completion;
use spandrel_training::record::{SessionListEntry, SessionRecord};
use spandrel_training::trainee::Role;
use sqlx::any::{AnyArguments, AnyRow};
use sqlx::query::Query;
use sqlx::{Any, Row, Transaction};
use std::collections::BTreeMap;
use std::path::PathBuf;

const UPSERT_SESSION_QUERY: &str = "INSERT INTO sessions (id, trainee, started_unix_us, scenario, scenario_sha256, vehicle, vehicle_sha256, \
    telemetry_sha256, spandrel_version, scorer_version, end_reason, seconds, conformity, efficiency, safety, accuracy, overall, \
    overall_max, fingerprint, record, purpose) \
    VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14, $15, $16, $17, $18, $19, $20, $21) \
    ON CONFLICT (id) DO UPDATE SET trainee = excluded.trainee, started_unix_us = excluded.started_unix_us, \
    scenario = excluded.scenario, scenario_sha256 = excluded.scenario_sha256, vehicle = excluded.vehicle, \
    vehicle_sha256 = excluded.vehicle_sha256, telemetry_sha256 = excluded.telemetry_sha256, \
    spandrel_version = excluded.spandrel_version, scorer_version = excluded.scorer_version, end_reason = excluded.end_reason, \
    seconds = excluded.seconds, conformity = excluded.conformity, efficiency = excluded.efficiency, safety = excluded.safety, \
    accuracy = excluded.accuracy, overall = excluded.overall, overall_max = excluded.overall_max, \
    fingerprint = excluded.fingerprint, record = excluded.record, purpose = excluded.purpose \
    WHERE sessions.fingerprint <> excluded.fingerprint";
pub(super) const ADD_TRAINEE_QUERY: &str =
    "INSERT INTO trainees (pseudonym, role) VALUES ($1, $2) ON CONFLICT (pseudonym) DO NOTHING";
// The subquery uses only an index, so complete rows are read only for the sessions to show.
const LIST_ALL_QUERY: &str = "SELECT id, trainee, started_unix_us, scenario, overall, overall_max, end_reason, purpose, record FROM sessions WHERE id IN \
    (SELECT id FROM sessions ORDER BY started_unix_us DESC, id LIMIT $1 OFFSET $2) ORDER BY started_unix_us DESC, id";
const LIST_TRAINEE_QUERY: &str = "SELECT id, trainee, started_unix_us, scenario, overall, overall_max, end_reason, purpose, record FROM sessions WHERE id IN \
    (SELECT id FROM sessions WHERE trainee = $3 ORDER BY started_unix_us DESC, id LIMIT $1 OFFSET $2) ORDER BY started_unix_us DESC, id";

/// Statements that remove a person's entries in all tables that refer to people. Assignments and sign-offs by an erased
/// instructor remain, without the name.
const ERASE_PERSON_QUERIES: [&str; 6] = [
    "DELETE FROM passwords WHERE pseudonym = $1",
    "DELETE FROM class_members WHERE trainee = $1",
    "DELETE FROM assignments WHERE trainee = $1",
    "DELETE FROM sign_offs WHERE trainee = $1",
    "UPDATE sign_offs SET signed_by = '' WHERE signed_by = $1",
    "UPDATE assignments SET assigned_by = '' WHERE assigned_by = $1",
];

impl Database {
    /// Adds records and their trainees. Does not touch unchanged sessions or add erased sessions again. Returns the
    /// number of new or changed sessions.
    ///
    /// # Errors
    /// Returns an error if the database fails; nothing is imported in that case.
    pub fn put(&self, records: &[SessionRecord]) -> Result<usize, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let changed = upsert_all(&mut change, records).await?;
            change.commit().await.map(|()| changed)
        })
    }

    /// Replaces these sessions and deletes those with IDs in `gone`. Keeps all other sessions, which another station
    /// may have added in the meantime, and all trainees with their details. Returns the number of sessions added.
    ///
    /// # Errors
    /// Returns an error if the database fails; nothing is changed in that case.
    pub fn rebuild(&self, records: &[SessionRecord], gone: &[String]) -> Result<usize, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            for id in records.iter().map(|record| &record.id).chain(gone) {
                delete(&mut change, id).await?;
            }
            let made = upsert_all(&mut change, records).await?;
            change.commit().await.map(|()| made)
        })
    }

    /// Returns the ID and trainee of the session with this telemetry hash (SHA-256, hexadecimal).
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn find_by_telemetry(&self, sha256: &str) -> Result<Option<(String, String)>, AppError> {
        self.run(async {
            let query = sqlx::query("SELECT id, trainee FROM sessions WHERE telemetry_sha256 = $1 ORDER BY id LIMIT 1");
            let row = query.bind(sha256.to_owned()).fetch_optional(&self.pool).await?;
            row.map(|row| Ok((row.try_get(0)?, row.try_get(1)?))).transpose()
        })
    }

    /// Returns all sessions' fingerprints by session ID.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn fingerprints(&self) -> Result<BTreeMap<String, String>, AppError> {
        self.run(async {
            let rows = sqlx::query("SELECT id, fingerprint FROM sessions").fetch_all(&self.pool).await?;
            rows.iter().map(|row| Ok((row.try_get(0)?, row.try_get(1)?))).collect()
        })
    }

    /// Returns the records of all trainees or one trainee, ordered by start time.
    ///
    /// # Errors
    /// Returns an error if the database fails or contains an invalid record.
    pub fn records(&self, trainee: Option<&str>) -> Result<Vec<SessionRecord>, AppError> {
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
            serde_json::from_str(&text).map_err(|error| AppError::failed(format!("{}: session {id}: {error}", self.name())))
        };
        rows.into_iter().map(read).collect()
    }

    /// Returns a session's record.
    ///
    /// # Errors
    /// Returns an error if the database fails or contains an invalid record.
    pub fn record(&self, id: &str) -> Result<Option<SessionRecord>, AppError> {
        let text: Option<String> = self.run(async {
            let query = sqlx::query("SELECT record FROM sessions WHERE id = $1").bind(id.to_owned());
            query.fetch_optional(&self.pool).await?.map(|row| row.try_get(0)).transpose()
        })?;
        let wrong = |error| AppError::failed(format!("{}: session {id}: {error}", self.name()));
        text.map(|text| serde_json::from_str(&text).map_err(wrong)).transpose()
    }

    /// Returns the number of sessions of all trainees or one trainee.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn count(&self, trainee: Option<&str>) -> Result<u64, AppError> {
        let counted: i64 = self.run(async {
            let query = match trainee {
                Some(trainee) => sqlx::query("SELECT COUNT(*) FROM sessions WHERE trainee = $1").bind(trainee.to_owned()),
                None => sqlx::query("SELECT COUNT(*) FROM sessions"),
            };
            query.fetch_one(&self.pool).await?.try_get(0)
        })?;
        Ok(u64::try_from(counted).unwrap_or_default())
    }

    /// Returns up to `most` list entries of all trainees or one trainee, newest first. Skips the first `skip` entries.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn list(&self, trainee: Option<&str>, most: u32, skip: u32) -> Result<Vec<SessionListEntry>, AppError> {
        let query = if trainee.is_some() { LIST_TRAINEE_QUERY } else { LIST_ALL_QUERY };
        self.run(async {
            let query = sqlx::query(query).bind(i64::from(most)).bind(i64::from(skip));
            let query = if let Some(trainee) = trainee { query.bind(trainee.to_owned()) } else { query };
            query.fetch_all(&self.pool).await?.iter().map(list_entry).collect()
        })
    }

    /// Returns the IDs and trainees of the sessions that started before this time (µs since the Unix epoch).
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn older_than(&self, unix_us: u64) -> Result<Vec<(String, String)>, AppError> {
        self.run(async {
            let query = "SELECT id, trainee FROM sessions WHERE started_unix_us < $1 ORDER BY started_unix_us, id";
            let rows = sqlx::query(query).bind(signed(unix_us)).fetch_all(&self.pool).await?;
            rows.iter().map(|row| Ok((row.try_get(0)?, row.try_get(1)?))).collect()
        })
    }

    /// Erases sessions. They cannot be imported again from folders on other stations. Marks `folders` for
    /// [`super::erasure::remove_folders`]. Returns the number of sessions deleted.
    ///
    /// # Errors
    /// Returns an error if the database fails; nothing is changed in that case.
    pub fn delete_sessions(&self, ids: &[String], folders: &[PathBuf]) -> Result<u64, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            mark_folders(&mut change, folders).await?;
            let mut deleted = 0;
            for id in ids {
                erasure_marks::mark(&mut change, ErasedKind::Session, id).await?;
                deleted += delete(&mut change, id).await?;
            }
            change.commit().await?;
            self.truncate_journal().await.map(|()| deleted)
        })
    }

    /// Erases a trainee and all their data. The existing sessions cannot be imported again from folders on other
    /// stations. Marks `folders` for [`super::erasure::remove_folders`]. Returns true if the trainee existed, and the
    /// number of sessions deleted.
    ///
    /// # Errors
    /// Returns an error if the database fails; nothing is changed in that case.
    pub fn erase(&self, trainee: &str, folders: &[PathBuf]) -> Result<(bool, u64), AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            mark_folders(&mut change, folders).await?;
            erasure_marks::mark(&mut change, ErasedKind::Trainee, trainee).await?;
            let answers = "DELETE FROM answers WHERE session IN (SELECT id FROM sessions WHERE trainee = $1)";
            sqlx::query(answers).bind(trainee.to_owned()).execute(&mut *change).await?;
            let by = |query: &'static str| sqlx::query(query).bind(trainee.to_owned());
            let sessions = by("DELETE FROM sessions WHERE trainee = $1").execute(&mut *change).await?.rows_affected();
            for query in ERASE_PERSON_QUERIES {
                by(query).execute(&mut *change).await?;
            }
            let known = by("DELETE FROM trainees WHERE pseudonym = $1").execute(&mut *change).await?.rows_affected() > 0;
            change.commit().await?;
            self.truncate_journal().await.map(|()| (known, sessions))
        })
    }
}

async fn mark_folders(change: &mut Transaction<'static, Any>, folders: &[PathBuf]) -> Result<(), sqlx::Error> {
    for folder in folders {
        erasure_marks::mark(change, ErasedKind::Folder, &folder_name(folder)).await?;
    }
    Ok(())
}

async fn upsert_all(change: &mut Transaction<'static, Any>, records: &[SessionRecord]) -> Result<usize, sqlx::Error> {
    let mut changed = 0;
    for record in records {
        changed += usize::from(put(change, record).await?);
    }
    Ok(changed)
}

/// Deletes a session. Returns the number of deleted rows.
async fn delete(change: &mut Transaction<'static, Any>, id: &str) -> Result<u64, sqlx::Error> {
    sqlx::query("DELETE FROM answers WHERE session = $1").bind(id.to_owned()).execute(&mut **change).await?;
    let done = sqlx::query("DELETE FROM sessions WHERE id = $1").bind(id.to_owned()).execute(&mut **change).await?;
    Ok(done.rows_affected())
}

async fn put(change: &mut Transaction<'static, Any>, record: &SessionRecord) -> Result<bool, sqlx::Error> {
    record.check().map_err(|wrong| sqlx::Error::Encode(format!("session {}: {wrong}", record.id).into()))?;
    if erasure_marks::contains(change, record).await? {
        return Ok(false);
    }
    let trainee = sqlx::query(ADD_TRAINEE_QUERY).bind(record.trainee.clone()).bind(Role::Trainee.word().to_owned());
    trainee.execute(&mut **change).await?;
    let text = serde_json::to_string(record).map_err(|error| sqlx::Error::Encode(error.into()))?;
    let done = bind(sqlx::query(UPSERT_SESSION_QUERY), record, text).execute(&mut **change).await?;
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

fn bind<'q>(query: Query<'q, Any, AnyArguments>, record: &SessionRecord, text: String) -> Query<'q, Any, AnyArguments> {
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
        .bind(record.purpose.clone())
}

/// JSON record fields that lists show in addition to the columns.
#[derive(serde::Deserialize)]
struct ListFields {
    #[serde(default)]
    completion: Option<Completion>,
    certified: bool,
    #[serde(default)]
    unmet: Vec<String>,
}

fn list_entry(row: &AnyRow) -> Result<SessionListEntry, sqlx::Error> {
    let started: i64 = row.try_get(2)?;
    let text: String = row.try_get(8)?;
    let shown: ListFields = serde_json::from_str(&text).map_err(|error| sqlx::Error::Decode(error.into()))?;
    Ok(SessionListEntry {
        id: row.try_get(0)?,
        trainee: row.try_get(1)?,
        started_unix_us: u64::try_from(started).unwrap_or_default(),
        scenario: row.try_get(3)?,
        overall: row.try_get(4)?,
        overall_max: row.try_get(5)?,
        end_reason: row.try_get(6)?,
        purpose: row.try_get(7)?,
        completion: shown.completion,
        certified: shown.certified,
        unmet: shown.unmet,
    })
}
