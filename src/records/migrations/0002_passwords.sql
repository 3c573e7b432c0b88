-- Logins of `spandrel serve`: argon2 hashes in PHC format. The role is in the table of trainees.
CREATE TABLE passwords (
    pseudonym TEXT PRIMARY KEY REFERENCES trainees (pseudonym),
    hash TEXT NOT NULL
);
