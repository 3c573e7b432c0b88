-- Practice or assessment, where somebody chose.
ALTER TABLE sessions ADD COLUMN purpose TEXT;
