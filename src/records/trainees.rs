//! Reads and writes trainees in the database.

use super::database::Database;
use crate::errors::AppError;
use spandrel_training::trainee::{Role, Trainee};
use sqlx::any::AnyRow;
use sqlx::{Any, Row, Transaction};

/// Empty values do not overwrite stored values, so no concurrent change is lost.
const UPSERT_DETAILS_QUERY: &str = "INSERT INTO trainees (pseudonym, role, age_band, drone_experience, gaming_experience) \
    VALUES ($1, CASE WHEN $2 = '' THEN 'trainee' ELSE $2 END, NULLIF($3, ''), NULLIF($4, ''), NULLIF($5, '')) \
    ON CONFLICT (pseudonym) DO UPDATE SET role = CASE WHEN $2 = '' THEN trainees.role ELSE excluded.role END, \
    age_band = COALESCE(excluded.age_band, trainees.age_band), \
    drone_experience = COALESCE(excluded.drone_experience, trainees.drone_experience), \
    gaming_experience = COALESCE(excluded.gaming_experience, trainees.gaming_experience)";
/// Updates the details only if they have not changed since the form was loaded.
const SET_DETAILS_QUERY: &str = "UPDATE trainees SET age_band = NULLIF($1, ''), drone_experience = NULLIF($2, ''), \
    gaming_experience = NULLIF($3, '') WHERE pseudonym = $4 AND COALESCE(age_band, '') = $5 AND COALESCE(drone_experience, '') = $6 \
    AND COALESCE(gaming_experience, '') = $7";
const TRAINEES_QUERY: &str =
    "SELECT pseudonym, role, age_band, drone_experience, gaming_experience FROM trainees ORDER BY pseudonym";

impl Database {
    /// Returns all trainees, ordered by pseudonym.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn trainees(&self) -> Result<Vec<Trainee>, AppError> {
        self.run(async {
            let rows = sqlx::query(TRAINEES_QUERY).fetch_all(&self.pool).await?;
            rows.iter().map(trainee).collect()
        })
    }

    /// Adds a trainee, or sets the role and any specified details (age, drones, games).
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn update_details(&self, name: &str, role: Option<Role>, details: [Option<&str>; 3]) -> Result<(), AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            update_details(&mut change, name, role, details).await?;
            change.commit().await
        })
    }

    /// Sets a person's details (age, drones, games; empty for no answer) if they still match `before`. If they do not
    /// match, or there is no such person, returns false and changes nothing.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn set_details(&self, name: &str, before: [&str; 3], after: [&str; 3]) -> Result<bool, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let query = after.into_iter().fold(sqlx::query(SET_DETAILS_QUERY), |query, value| query.bind(value.to_owned()));
            let query = before.into_iter().fold(query.bind(name.to_owned()), |query, value| query.bind(value.to_owned()));
            let done = query.execute(&mut *change).await?;
            change.commit().await.map(|()| done.rows_affected() > 0)
        })
    }
}

/// Adds a trainee or sets the specified details, within a transaction.
pub(super) async fn update_details(
    change: &mut Transaction<'static, Any>,
    name: &str,
    role: Option<Role>,
    details: [Option<&str>; 3],
) -> Result<(), sqlx::Error> {
    let query = sqlx::query(UPSERT_DETAILS_QUERY).bind(name.to_owned()).bind(role.map_or("", Role::word).to_owned());
    let query = details.into_iter().fold(query, |query, detail| query.bind(detail.unwrap_or_default().to_owned()));
    query.execute(&mut **change).await.map(|_| ())
}

pub(super) fn trainee(row: &AnyRow) -> Result<Trainee, sqlx::Error> {
    let role: String = row.try_get(1)?;
    Ok(Trainee {
        pseudonym: row.try_get(0)?,
        role: Role::from_word(&role).ok_or_else(|| sqlx::Error::Decode(format!("unknown role '{role}'").into()))?,
        age_band: row.try_get(2)?,
        drone_experience: row.try_get(3)?,
        gaming_experience: row.try_get(4)?,
    })
}
