//! Scheduling priority for rendering, which is lower than the priority of the simulator and the monitor.

/// Lowers the priority of this thread and all threads that it starts, so that rendering does not delay the simulator.
pub fn lower_priority() {
    #[cfg(unix)]
    if let Err(error) = rustix::process::nice(NICENESS) {
        tracing::debug!("cannot lower the priority: {error}");
    }
}

/// Nice value halfway between normal and lowest priority.
#[cfg(unix)]
const NICENESS: i32 = 10;
