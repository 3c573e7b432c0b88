-- Lists are read from the newest on: the indices hold what orders them, so that a late page reads no record that it does not show.
DROP INDEX sessions_by_trainee;
DROP INDEX sessions_by_time;
CREATE INDEX sessions_newest ON sessions (started_unix_us DESC, id);
CREATE INDEX sessions_newest_of_trainee ON sessions (trainee, started_unix_us DESC, id);
CREATE INDEX sessions_by_telemetry ON sessions (telemetry_sha256);
-- What was erased and must not come back from a folder elsewhere: of a trainee all that began before, of a session itself. The SHA-256 of the
-- pseudonym or id stands here, for an erasure must leave no name.
CREATE TABLE erased (
    what TEXT NOT NULL,
    sha256 TEXT NOT NULL,
    erased_unix_us BIGINT NOT NULL,
    PRIMARY KEY (what, sha256)
);
