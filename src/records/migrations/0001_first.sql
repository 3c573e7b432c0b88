-- For both SQLite and PostgreSQL: simple types only, times in microseconds since the Unix epoch, booleans as 0 and 1.
CREATE TABLE trainees (
    pseudonym TEXT PRIMARY KEY,
    role TEXT NOT NULL,
    age_band TEXT,
    drone_experience TEXT,
    gaming_experience TEXT
);
CREATE TABLE sessions (
    id TEXT PRIMARY KEY,
    trainee TEXT NOT NULL REFERENCES trainees (pseudonym),
    started_unix_us BIGINT NOT NULL,
    scenario TEXT NOT NULL,
    scenario_sha256 TEXT NOT NULL,
    vehicle TEXT NOT NULL,
    vehicle_sha256 TEXT NOT NULL,
    telemetry_sha256 TEXT NOT NULL,
    spandrel_version TEXT NOT NULL,
    scorer_version BIGINT NOT NULL,
    end_reason TEXT NOT NULL,
    seconds DOUBLE PRECISION NOT NULL,
    conformity DOUBLE PRECISION,
    efficiency DOUBLE PRECISION NOT NULL,
    safety DOUBLE PRECISION NOT NULL,
    accuracy DOUBLE PRECISION,
    overall DOUBLE PRECISION NOT NULL,
    overall_max DOUBLE PRECISION NOT NULL,
    fingerprint TEXT NOT NULL,
    record TEXT NOT NULL
);
CREATE INDEX sessions_by_trainee ON sessions (trainee, started_unix_us);
CREATE INDEX sessions_by_time ON sessions (started_unix_us);
CREATE TABLE answers (
    session TEXT NOT NULL REFERENCES sessions (id),
    question TEXT NOT NULL,
    answer BIGINT NOT NULL,
    PRIMARY KEY (session, question)
);
