-- Sign-offs of the rubric and their withdrawals. Rows are only added, so that the history is kept.
CREATE TABLE sign_offs (
    trainee TEXT NOT NULL REFERENCES trainees (pseudonym),
    criterion TEXT NOT NULL,
    unix_us BIGINT NOT NULL,
    title TEXT NOT NULL,
    action TEXT NOT NULL,
    signed_by TEXT NOT NULL,
    note TEXT NOT NULL,
    PRIMARY KEY (trainee, criterion, unix_us)
);
