//! What is drawn, by Mesa's software Vulkan (lavapipe): a gallery held against committed pictures, contrast against ground sampling distance,
//! and whether a picture shows what the measures say it shows.
#![allow(clippy::unwrap_used, reason = "a test")]
#![allow(missing_docs, reason = "a test")]

mod compare;
mod contrast;
mod gallery;
mod masks;
mod snapshots;
