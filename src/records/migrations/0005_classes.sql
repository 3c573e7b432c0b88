-- Classes of trainees. A trainee may be in several classes.
CREATE TABLE classes (
    name TEXT PRIMARY KEY
);
CREATE TABLE class_members (
    class TEXT NOT NULL REFERENCES classes (name),
    trainee TEXT NOT NULL REFERENCES trainees (pseudonym),
    PRIMARY KEY (class, trainee)
);
CREATE INDEX class_members_by_trainee ON class_members (trainee);
-- Jobs assigned to a trainee or a class; exactly one of the two is set. Whether they are done follows from the sessions.
CREATE TABLE assignments (
    id TEXT PRIMARY KEY,
    trainee TEXT REFERENCES trainees (pseudonym),
    class TEXT REFERENCES classes (name),
    scenario TEXT NOT NULL,
    variant TEXT,
    assigned_unix_us BIGINT NOT NULL,
    due_unix_us BIGINT NOT NULL,
    assigned_by TEXT NOT NULL
);
CREATE INDEX assignments_by_trainee ON assignments (trainee);
CREATE INDEX assignments_by_class ON assignments (class);
