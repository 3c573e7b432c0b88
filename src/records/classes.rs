//! Classes of trainees in the database.

use super::database::Database;
use super::sessions::ADD_TRAINEE_QUERY;
use crate::errors::AppError;
use spandrel_training::trainee::Role;
use spandrel_training::training_class::TrainingClass;
use sqlx::Row;

const CLASSES_QUERY: &str = "SELECT classes.name, class_members.trainee FROM classes \
    LEFT JOIN class_members ON class_members.class = classes.name ORDER BY classes.name, class_members.trainee";
const ADD_MEMBER_QUERY: &str =
    "INSERT INTO class_members (class, trainee) VALUES ($1, $2) ON CONFLICT (class, trainee) DO NOTHING";

impl Database {
    /// Returns all classes in alphabetical order.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn classes(&self) -> Result<Vec<TrainingClass>, AppError> {
        let rows: Vec<(String, Option<String>)> = self.run(async {
            let rows = sqlx::query(CLASSES_QUERY).fetch_all(&self.pool).await?;
            rows.iter().map(|row| Ok((row.try_get(0)?, row.try_get(1)?))).collect()
        })?;
        let mut classes: Vec<TrainingClass> = Vec::new();
        for (name, member) in rows {
            match classes.last_mut().filter(|last| last.name == name) {
                Some(class) => class.members.extend(member),
                None => classes.push(TrainingClass { name, members: member.into_iter().collect() }),
            }
        }
        Ok(classes)
    }

    /// Returns the names of a trainee's classes in alphabetical order.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn classes_of(&self, trainee: &str) -> Result<Vec<String>, AppError> {
        self.run(async {
            let query = sqlx::query("SELECT class FROM class_members WHERE trainee = $1 ORDER BY class");
            query.bind(trainee.to_owned()).fetch_all(&self.pool).await?.iter().map(|row| row.try_get(0)).collect()
        })
    }

    /// Adds a class without members. Returns false if there is already a class with this name.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn add_class(&self, name: &str) -> Result<bool, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let query = sqlx::query("INSERT INTO classes (name) VALUES ($1) ON CONFLICT (name) DO NOTHING");
            let done = query.bind(name.to_owned()).execute(&mut *change).await?;
            change.commit().await.map(|()| done.rows_affected() > 0)
        })
    }

    /// Removes a class and its assignments; the members and their sessions remain. Returns false if there is no such
    /// class.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn remove_class(&self, name: &str) -> Result<bool, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let by = |query: &'static str| sqlx::query(query).bind(name.to_owned());
            by("DELETE FROM assignments WHERE class = $1").execute(&mut *change).await?;
            by("DELETE FROM class_members WHERE class = $1").execute(&mut *change).await?;
            let done = by("DELETE FROM classes WHERE name = $1").execute(&mut *change).await?;
            change.commit().await.map(|()| done.rows_affected() > 0)
        })
    }

    /// Adds trainees to a class; those who are not known yet are added to the database, so that a class can be prepared
    /// before the first flight. Returns false if there is no such class.
    ///
    /// # Errors
    /// Returns an error if the database fails; nothing is changed in that case.
    pub fn add_members(&self, class: &str, trainees: &[String]) -> Result<bool, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let found = sqlx::query("SELECT name FROM classes WHERE name = $1").bind(class.to_owned());
            if found.fetch_optional(&mut *change).await?.is_none() {
                return change.rollback().await.map(|()| false);
            }
            for trainee in trainees {
                let person = sqlx::query(ADD_TRAINEE_QUERY).bind(trainee.clone()).bind(Role::Trainee.word().to_owned());
                person.execute(&mut *change).await?;
                let member = sqlx::query(ADD_MEMBER_QUERY).bind(class.to_owned()).bind(trainee.clone());
                member.execute(&mut *change).await?;
            }
            change.commit().await.map(|()| true)
        })
    }

    /// Removes a trainee from a class. Returns false if they were not in it.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn remove_member(&self, class: &str, trainee: &str) -> Result<bool, AppError> {
        self.run(async {
            let mut change = self.begin().await?;
            let query = sqlx::query("DELETE FROM class_members WHERE class = $1 AND trainee = $2");
            let done = query.bind(class.to_owned()).bind(trainee.to_owned()).execute(&mut *change).await?;
            change.commit().await.map(|()| done.rows_affected() > 0)
        })
    }
}
