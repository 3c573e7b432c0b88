//! Assignments in the database.

use super::database::{Database, signed};
use crate::errors::AppError;
use spandrel_training::assignment::{Assignment, AssignmentTarget};
use sqlx::Row;
use sqlx::any::AnyRow;

const ADD_QUERY: &str = "INSERT INTO assignments (id, trainee, class, scenario, variant, assigned_unix_us, due_unix_us, assigned_by) \
    VALUES ($1, $2, $3, $4, $5, $6, $7, $8)";
const OF_TRAINEE_QUERY: &str = "SELECT id, trainee, class, scenario, variant, assigned_unix_us, due_unix_us, assigned_by FROM assignments \
    WHERE trainee = $1 OR class IN (SELECT class FROM class_members WHERE trainee = $1) ORDER BY due_unix_us, id";
const OF_CLASS_QUERY: &str = "SELECT id, trainee, class, scenario, variant, assigned_unix_us, due_unix_us, assigned_by FROM assignments \
    WHERE class = $1 ORDER BY due_unix_us, id";
const WITH_ID_QUERY: &str =
    "SELECT id, trainee, class, scenario, variant, assigned_unix_us, due_unix_us, assigned_by FROM assignments WHERE id = $1";

impl Database {
    /// Adds an assignment. Returns false if its trainee or class does not exist.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn assign(&self, assignment: &Assignment) -> Result<bool, AppError> {
        let (trainee, class) = match &assignment.target {
            AssignmentTarget::Trainee(name) => (Some(name.clone()), None),
            AssignmentTarget::Class(name) => (None, Some(name.clone())),
        };
        self.run(async {
            let mut change = self.begin().await?;
            let exists = match &assignment.target {
                AssignmentTarget::Trainee(name) => {
                    sqlx::query("SELECT pseudonym FROM trainees WHERE pseudonym = $1").bind(name.clone())
                }
                AssignmentTarget::Class(name) => sqlx::query("SELECT name FROM classes WHERE name = $1").bind(name.clone()),
            };
            if exists.fetch_optional(&mut *change).await?.is_none() {
                return change.rollback().await.map(|()| false);
            }
            let query = sqlx::query(ADD_QUERY).bind(assignment.id.clone()).bind(trainee).bind(class);
            let query = query.bind(assignment.scenario.clone()).bind(assignment.variant.clone());
            let query = query.bind(signed(assignment.assigned_unix_us)).bind(signed(assignment.due_unix_us));
            query.bind(assignment.assigned_by.clone()).execute(&mut *change).await?;
            change.commit().await.map(|()| true)
        })
    }

    /// Returns a trainee's assignments, including those of their classes, by due date.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn assignments_of_trainee(&self, trainee: &str) -> Result<Vec<Assignment>, AppError> {
        self.assignments(OF_TRAINEE_QUERY, trainee)
    }

    /// Returns a class's assignments by due date.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn assignments_of_class(&self, class: &str) -> Result<Vec<Assignment>, AppError> {
        self.assignments(OF_CLASS_QUERY, class)
    }

    /// Returns the assignment with this ID, or `None` if there is none.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn assignment(&self, id: &str) -> Result<Option<Assignment>, AppError> {
        Ok(self.assignments(WITH_ID_QUERY, id)?.pop())
    }

    /// Removes an assignment. Returns false if there is none with this ID.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn remove_assignment(&self, id: &str) -> Result<bool, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let done = sqlx::query("DELETE FROM assignments WHERE id = $1").bind(id.to_owned()).execute(&mut *change).await?;
            change.commit().await.map(|()| done.rows_affected() > 0)
        })
    }

    fn assignments(&self, query: &'static str, key: &str) -> Result<Vec<Assignment>, AppError> {
        self.run(async {
            let rows = sqlx::query(query).bind(key.to_owned()).fetch_all(&self.pool).await?;
            rows.iter().map(assignment).collect()
        })
    }
}

fn assignment(row: &AnyRow) -> Result<Assignment, sqlx::Error> {
    let (trainee, class): (Option<String>, Option<String>) = (row.try_get(1)?, row.try_get(2)?);
    let target = match (trainee, class) {
        (Some(trainee), None) => AssignmentTarget::Trainee(trainee),
        (None, Some(class)) => AssignmentTarget::Class(class),
        (Some(_), Some(_)) | (None, None) => {
            return Err(sqlx::Error::Decode("an assignment must have either a trainee or a class".into()));
        }
    };
    let (assigned, due): (i64, i64) = (row.try_get(5)?, row.try_get(6)?);
    Ok(Assignment {
        id: row.try_get(0)?,
        target,
        scenario: row.try_get(3)?,
        variant: row.try_get(4)?,
        assigned_unix_us: u64::try_from(assigned).unwrap_or_default(),
        due_unix_us: u64::try_from(due).unwrap_or_default(),
        assigned_by: row.try_get(7)?,
    })
}
