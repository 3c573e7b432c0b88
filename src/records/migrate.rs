//! Brings the database's tables up to date.

use super::database::Database;
use sqlx::{Executor, Row};

/// Migrations in order; database version n includes the first n migrations. Released migrations never change; new
/// migrations are appended.
const MIGRATIONS: &[&str] = &[
    include_str!("migrations/0001_first.sql"),
    include_str!("migrations/0002_passwords.sql"),
    include_str!("migrations/0003_newest_and_erased.sql"),
    include_str!("migrations/0004_purpose.sql"),
    include_str!("migrations/0005_classes.sql"),
    include_str!("migrations/0006_sign_offs.sql"),
];

impl Database {
    /// Runs the missing migrations in one transaction while holding the write lock.
    pub(super) async fn migrate(&self) -> Result<(), sqlx::Error> {
        // If the tables are up to date, this takes no lock, so readers do not wait for writers.
        let version = sqlx::query("SELECT version FROM schema_version").fetch_optional(&self.pool).await;
        if let Ok(Some(row)) = version
            && row.try_get::<i64, _>(0).is_ok_and(|version| usize::try_from(version) == Ok(MIGRATIONS.len()))
        {
            return Ok(());
        }
        let mut change = self.begin().await?;
        change.execute("CREATE TABLE IF NOT EXISTS schema_version (version BIGINT NOT NULL)").await?;
        let found = sqlx::query("SELECT version FROM schema_version").fetch_optional(&mut *change).await?;
        let version: i64 = found.as_ref().map_or(Ok(0), |row| row.try_get(0))?;
        let done = usize::try_from(version).unwrap_or(usize::MAX);
        let Some(missing) = MIGRATIONS.get(done..) else {
            let newest = MIGRATIONS.len();
            return Err(sqlx::Error::Configuration(
                format!(
                    "the database has version {version}, but this program supports versions up to {newest}: use a newer version of spandrel"
                )
                .into(),
            ));
        };
        for migration in missing {
            sqlx::raw_sql(*migration).execute(&mut *change).await?;
        }
        if !missing.is_empty() {
            change.execute("DELETE FROM schema_version").await?;
            let newest = i64::try_from(MIGRATIONS.len()).unwrap_or(i64::MAX);
            sqlx::query("INSERT INTO schema_version (version) VALUES ($1)").bind(newest).execute(&mut *change).await?;
        }
        change.commit().await
    }
}
