//! Pictures rendered by Mesa's software Vulkan (lavapipe): a gallery compared with committed pictures, contrast as a
//! function of ground sampling distance, and agreement between pictures and measures.
#![allow(clippy::unwrap_used, reason = "test code")]
#![allow(missing_docs, reason = "test code")]

mod close_ups;
mod compare;
mod condition_states;
mod contrast;
mod exposure;
mod flight_states;
mod gallery;
mod light;
mod masks;
mod pages;
mod snapshots;
mod video_link;
mod weather;
mod wind;
