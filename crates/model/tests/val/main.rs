//! What is shipped, and what the READMEs say of it.

mod documented;
mod shipped;
