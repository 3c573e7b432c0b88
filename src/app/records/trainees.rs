//! Trainees in the database: who there is and what is known of them.

use super::database::Database;
use crate::app::errors::AppError;
use crate::training::trainee::{Role, Trainee};
use sqlx::any::AnyRow;
use sqlx::{Any, Row, Transaction};

const SET_TRAINEE: &str = "INSERT INTO trainees (pseudonym, role, age_band, drone_experience, gaming_experience) \
    VALUES ($1, $2, $3, $4, $5) ON CONFLICT (pseudonym) DO UPDATE SET role = excluded.role, age_band = excluded.age_band, \
    drone_experience = excluded.drone_experience, gaming_experience = excluded.gaming_experience";
const TRAINEES: &str = "SELECT pseudonym, role, age_band, drone_experience, gaming_experience FROM trainees ORDER BY pseudonym";

impl Database {
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
}

/// Adds a trainee or sets his details, within a change.
pub(super) async fn set(change: &mut Transaction<'static, Any>, trainee: &Trainee) -> Result<(), sqlx::Error> {
    let query = sqlx::query(SET_TRAINEE).bind(trainee.pseudonym.clone()).bind(trainee.role.word().to_owned());
    let details = [&trainee.age_band, &trainee.drone_experience, &trainee.gaming_experience];
    details.into_iter().fold(query, |query, detail| query.bind(detail.clone())).execute(&mut **change).await.map(|_| ())
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
