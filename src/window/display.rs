//! Opens the display, or reports why no display is available.

use crate::errors::AppError;
use crate::io::panics::caught_silently;
use winit::error::EventLoopError;
use winit::event_loop::EventLoop;

/// Returns an event loop for the display.
pub fn open() -> Result<EventLoop<()>, AppError> {
    // The keyboard library is loaded on first use, and the loader panics if it is missing. Convert the panic to an
    // error.
    let why = match caught_silently(EventLoop::new) {
        Some(Ok(events)) => return Ok(events),
        Some(Err(EventLoopError::Os(_))) => display_problem(),
        Some(Err(error)) => error.to_string(),
        None => {
            "a library is missing; on Debian and Ubuntu, run apt-get install libxkbcommon-x11-0 libx11-xcb1 libxcursor1 libxi6 \
                   libxrandr2"
                .to_owned()
        }
    };
    Err(AppError::failed(format!("no display is available for the window ({why}); all other features work without one")))
}

/// Describes the configured display. The library's own message is not helpful because it refers to its source code.
fn display_problem() -> String {
    let set = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
    let asked: Vec<String> =
        ["WAYLAND_DISPLAY", "DISPLAY"].into_iter().filter_map(|name| Some(format!("{name}={}", set(name)?))).collect();
    if asked.is_empty() {
        "neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned()
    } else {
        format!("{} cannot be opened", asked.join(" and "))
    }
}
