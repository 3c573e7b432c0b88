//! Login accounts of `spandrel serve`.

use super::database::Database;
use super::trainees::{trainee, update_details};
use crate::errors::AppError;
use sha2::{Digest, Sha256};
use spandrel_training::trainee::{Role, Trainee};
use spandrel_training::web::browser_sessions::CredentialHash;
use sqlx::Row;

const ACCOUNT_QUERY: &str = "SELECT trainees.pseudonym, role, age_band, drone_experience, gaming_experience, hash FROM trainees \
    LEFT JOIN passwords ON passwords.pseudonym = trainees.pseudonym WHERE trainees.pseudonym = $1";
const SET_PASSWORD_QUERY: &str = "INSERT INTO passwords (pseudonym, hash) VALUES ($1, $2) \
    ON CONFLICT (pseudonym) DO UPDATE SET hash = excluded.hash";

/// A person and their password hash.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Account {
    /// Pseudonym, role and details.
    pub person: Trainee,
    /// Argon2 hash in PHC format; `None` for a person who cannot log in.
    pub hash: Option<String>,
}

impl Account {
    /// Returns a hash of the password and the role, or `None` for a person who cannot log in. Browser sessions end when
    /// this hash changes.
    #[must_use]
    pub fn credential(&self) -> Option<CredentialHash> {
        let hash = self.hash.as_ref()?;
        Some(Sha256::digest(format!("{}\0{hash}", self.person.role.word()).as_bytes()).into())
    }
}

impl Database {
    /// Returns a person, or `None` if nobody has this name.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn account(&self, name: &str) -> Result<Option<Account>, AppError> {
        self.run(async {
            let row = sqlx::query(ACCOUNT_QUERY).bind(name.to_owned()).fetch_optional(&self.pool).await?;
            row.map(|row| Ok(Account { person: trainee(&row)?, hash: row.try_get(5)? })).transpose()
        })
    }

    /// Sets a person's password and role in one transaction; adds the person if necessary. Their details do not change.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn set_login(&self, name: &str, role: Role, hash: &str) -> Result<(), AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            update_details(&mut change, name, Some(role), [None; 3]).await?;
            let query = sqlx::query(SET_PASSWORD_QUERY).bind(name.to_owned()).bind(hash.to_owned());
            query.execute(&mut *change).await?;
            change.commit().await
        })
    }

    /// Changes a person's password if the stored hash is still `before`. Returns false if it is not.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn change_password(&self, name: &str, before: &str, after: &str) -> Result<bool, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let query = sqlx::query("UPDATE passwords SET hash = $1 WHERE pseudonym = $2 AND hash = $3");
            let done = query.bind(after.to_owned()).bind(name.to_owned()).bind(before.to_owned()).execute(&mut *change).await?;
            change.commit().await.map(|()| done.rows_affected() > 0)
        })
    }

    /// Removes a person's password, so they can no longer log in. Returns false if there was no password.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn remove_password(&self, name: &str) -> Result<bool, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let query = sqlx::query("DELETE FROM passwords WHERE pseudonym = $1").bind(name.to_owned());
            let done = query.execute(&mut *change).await?;
            change.commit().await.map(|()| done.rows_affected() > 0)
        })
    }

    /// Returns the names of all people with a password.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn names_with_password(&self) -> Result<Vec<String>, AppError> {
        self.run(async {
            let rows = sqlx::query("SELECT pseudonym FROM passwords ORDER BY pseudonym").fetch_all(&self.pool).await?;
            rows.iter().map(|row| row.try_get(0)).collect()
        })
    }
}
