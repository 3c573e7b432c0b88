-- Who may log in to `spandrel serve`: an argon2 hash in PHC form; the role stands with the trainee.
CREATE TABLE passwords (
    pseudonym TEXT PRIMARY KEY REFERENCES trainees (pseudonym),
    hash TEXT NOT NULL
);
