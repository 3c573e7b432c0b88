//! Sign-offs of the rubric in the database.

use super::database::{Database, signed};
use crate::errors::AppError;
use spandrel_training::rubric::{SignOffAction, SignOffEvent, current_sign_off};
use sqlx::any::AnyRow;
use sqlx::{Any, Row, Transaction};

const EVENTS_QUERY: &str = "SELECT criterion, title, action, unix_us, signed_by, note FROM sign_offs WHERE trainee = $1 \
    ORDER BY unix_us, criterion";
const ADD_QUERY: &str = "INSERT INTO sign_offs (trainee, criterion, unix_us, title, action, signed_by, note) \
    VALUES ($1, $2, $3, $4, $5, $6, $7)";

impl Database {
    /// Returns a trainee's sign-offs and withdrawals in chronological order.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn sign_offs(&self, trainee: &str) -> Result<Vec<SignOffEvent>, AppError> {
        self.run(async {
            let rows = sqlx::query(EVENTS_QUERY).bind(trainee.to_owned()).fetch_all(&self.pool).await?;
            rows.iter().map(event).collect()
        })
    }

    /// Adds a sign-off or a withdrawal. Returns false and changes nothing if the criterion already has this state, for
    /// example because another instructor was faster.
    ///
    /// # Errors
    /// Returns an error if the database fails, or there is no such trainee.
    pub fn add_sign_off(&self, trainee: &str, event: &SignOffEvent) -> Result<bool, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let signed_off = is_signed_off(&mut change, trainee, &event.criterion).await?;
            let changes = match event.action {
                SignOffAction::SignedOff => !signed_off,
                SignOffAction::Withdrawn => signed_off,
            };
            if !changes {
                return change.rollback().await.map(|()| false);
            }
            let query = sqlx::query(ADD_QUERY).bind(trainee.to_owned()).bind(event.criterion.clone());
            let query = query.bind(signed(event.unix_us)).bind(event.title.clone()).bind(event.action.word().to_owned());
            query.bind(event.by.clone()).bind(event.note.clone()).execute(&mut *change).await?;
            change.commit().await.map(|()| true)
        })
    }
}

async fn is_signed_off(change: &mut Transaction<'static, Any>, trainee: &str, criterion: &str) -> Result<bool, sqlx::Error> {
    let rows = sqlx::query(EVENTS_QUERY).bind(trainee.to_owned()).fetch_all(&mut **change).await?;
    let events = rows.iter().map(event).collect::<Result<Vec<_>, _>>()?;
    Ok(current_sign_off(&events, criterion).is_some())
}

fn event(row: &AnyRow) -> Result<SignOffEvent, sqlx::Error> {
    let (action, unix_us): (String, i64) = (row.try_get(2)?, row.try_get(3)?);
    Ok(SignOffEvent {
        criterion: row.try_get(0)?,
        title: row.try_get(1)?,
        action: SignOffAction::from_word(&action)
            .ok_or_else(|| sqlx::Error::Decode(format!("unknown action '{action}'").into()))?,
        unix_us: u64::try_from(unix_us).unwrap_or_default(),
        by: row.try_get(4)?,
        note: row.try_get(5)?,
    })
}
