//! Who may log in to `spandrel serve`.

use super::database::Database;
use super::trainees::{set, trainee};
use crate::app::errors::AppError;
use crate::training::trainee::Trainee;
use sqlx::Row;

const ACCOUNT: &str = "SELECT trainees.pseudonym, role, age_band, drone_experience, gaming_experience, hash FROM trainees \
    LEFT JOIN passwords ON passwords.pseudonym = trainees.pseudonym WHERE trainees.pseudonym = $1";
const SET_PASSWORD: &str = "INSERT INTO passwords (pseudonym, hash) VALUES ($1, $2) \
    ON CONFLICT (pseudonym) DO UPDATE SET hash = excluded.hash";

/// A person and, where he may log in, the hash of his password.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Account {
    /// Who.
    pub person: Trainee,
    /// Argon2, PHC form.
    pub hash: Option<String>,
}

impl Database {
    /// A person; `None` when nobody has this name.
    ///
    /// # Errors
    /// When the database refuses.
    pub fn account(&self, name: &str) -> Result<Option<Account>, AppError> {
        self.run(async {
            let row = sqlx::query(ACCOUNT).bind(name.to_owned()).fetch_optional(&self.pool).await?;
            row.map(|row| Ok(Account { person: trainee(&row)?, hash: row.try_get(5)? })).transpose()
        })
    }

    /// Adds a person or sets his details, and his password, in one change.
    ///
    /// # Errors
    /// When the database refuses.
    pub fn set_account(&self, person: &Trainee, hash: &str) -> Result<(), AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            set(&mut change, person).await?;
            let query = sqlx::query(SET_PASSWORD).bind(person.pseudonym.clone()).bind(hash.to_owned());
            query.execute(&mut *change).await?;
            change.commit().await
        })
    }

    /// Takes somebody's password away: he logs in no more. False when he had none.
    ///
    /// # Errors
    /// When the database refuses.
    pub fn drop_password(&self, name: &str) -> Result<bool, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let query = sqlx::query("DELETE FROM passwords WHERE pseudonym = $1").bind(name.to_owned());
            let done = query.execute(&mut *change).await?;
            change.commit().await.map(|()| done.rows_affected() > 0)
        })
    }

    /// Those who may log in.
    ///
    /// # Errors
    /// When the database refuses.
    pub fn with_password(&self) -> Result<Vec<String>, AppError> {
        self.run(async {
            let rows = sqlx::query("SELECT pseudonym FROM passwords ORDER BY pseudonym").fetch_all(&self.pool).await?;
            rows.iter().map(|row| row.try_get(0)).collect()
        })
    }
}
