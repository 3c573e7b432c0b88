-- Practice or assessment; null if the purpose was not chosen.
ALTER TABLE sessions ADD COLUMN purpose TEXT;
