//! Properties of files: whatever is wrong in one is named.

mod files;
mod mistakes;
