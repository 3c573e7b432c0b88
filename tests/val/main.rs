//! Tests against what is shipped and against outside data.

mod documented;
mod shipped;
mod synthetic_cohort;
