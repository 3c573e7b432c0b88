//! Capture mode of the camera.

/// Capture mode. Images can be taken in either mode; recording requires video mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CaptureMode {
    /// Takes photos only.
    #[default]
    Photo,
    /// Takes photos and records video.
    Video,
}
