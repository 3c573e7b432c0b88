-- Lists start with the newest session. The indices contain the sort keys, so that a late page reads only the records that it shows.
DROP INDEX sessions_by_trainee;
DROP INDEX sessions_by_time;
CREATE INDEX sessions_newest ON sessions (started_unix_us DESC, id);
CREATE INDEX sessions_newest_of_trainee ON sessions (trainee, started_unix_us DESC, id);
CREATE INDEX sessions_by_telemetry ON sessions (telemetry_sha256);
-- Erased trainees and sessions, which must not be imported again from folders on other stations. For a trainee, this applies to all sessions that
-- started before the erasure. Contains the SHA-256 of the pseudonym or ID, because an erasure must not leave a name.
CREATE TABLE erased (
    what TEXT NOT NULL,
    sha256 TEXT NOT NULL,
    erased_unix_us BIGINT NOT NULL,
    PRIMARY KEY (what, sha256)
);
