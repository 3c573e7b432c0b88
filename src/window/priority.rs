//! Who draws stands back: the simulator and the monitor come first.

/// From here on this thread, and those that it begins, take what is left of the processor.
pub fn lower_priority() {
    #[cfg(unix)]
    if let Err(error) = rustix::process::nice(NICENESS) {
        tracing::debug!("the priority stays: {error}");
    }
}

/// Half way to the lowest priority.
#[cfg(unix)]
const NICENESS: i32 = 10;
