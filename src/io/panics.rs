//! Catches panics of libraries that report damaged input by panicking.

use std::panic::{UnwindSafe, catch_unwind, set_hook, take_hook};

/// Runs a function, without printing a message if it panics. Returns `None` if it panicked. No other thread may depend on the messages
/// meanwhile.
pub fn caught_silently<T>(function: impl FnOnce() -> T + UnwindSafe) -> Option<T> {
    let hook = take_hook();
    set_hook(Box::new(|_| {}));
    let result = catch_unwind(function);
    set_hook(hook);
    result.ok()
}
