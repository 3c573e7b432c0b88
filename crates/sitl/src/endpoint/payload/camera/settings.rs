//! Camera settings for ground stations, accessed by name or index over PARAM_EXT and described by a camera definition
//! file (<https://mavlink.io/en/services/camera_def.html>).

use super::{CameraError, CameraSettings, CameraState};
use std::fmt::Write;

/// Path of the definition file on the camera's file server.
pub const DEFINITION_PATH: &str = "camera.xml";
/// Address of the definition file, sent to ground stations.
pub const DEFINITION_URI: &str = "mftp://camera.xml";
/// Version of the definition, which ground stations use as a cache key. Increment it with every change to the table
/// below.
pub const DEFINITION_VERSION: u16 = 1;

/// Values that a setting accepts.
#[derive(Debug, Clone, Copy)]
pub enum AllowedValues {
    /// A list of named options.
    Options(&'static [(&'static str, u32)]),
    /// Minimum, maximum and step.
    Range(u32, u32, u32),
}

/// A camera setting.
pub struct CameraSetting {
    /// Parameter name on the wire, at most 16 characters.
    pub name: &'static str,
    description: &'static str,
    allowed: AllowedValues,
    default: u32,
    get: fn(&CameraState) -> u32,
    set: fn(&mut CameraState, u32) -> Result<(), CameraError>,
}

/// All settings, in index order. The mode is not one of them: MAV_CMD_SET_CAMERA_MODE sets it, and MAVSDK misreads the
/// values of a setting named CAM_MODE (it counts them from 1).
pub const ALL: &[CameraSetting] = &[
    CameraSetting {
        name: "CAM_PHOTOQUAL",
        description: "Photo quality",
        allowed: AllowedValues::Options(&[("Normal", 0), ("Fine", 1)]),
        default: 1,
        get: |camera| u32::from(camera.settings.high_quality),
        set: |camera, value| camera.set(CameraSettings { high_quality: value == 1, ..camera.settings }),
    },
    CameraSetting {
        name: "CAM_VIDRATE",
        description: "Video rate (Mbit/s)",
        allowed: AllowedValues::Range(10, 100, 10),
        default: 60,
        get: |camera| camera.settings.video_bit_rate_mbit_s,
        set: |camera, value| camera.set(CameraSettings { video_bit_rate_mbit_s: value, ..camera.settings }),
    },
];

impl CameraSetting {
    /// Returns the setting with this name and its index.
    #[must_use]
    pub fn named(name: &str) -> Option<(usize, &'static Self)> {
        ALL.iter().enumerate().find(|(_, setting)| setting.name == name)
    }

    /// Returns the current value.
    #[must_use]
    pub fn value(&self, camera: &CameraState) -> u32 {
        (self.get)(camera)
    }

    /// Changes the value.
    ///
    /// # Errors
    /// Returns an error if the value is not allowed or the camera's state does not permit the change.
    pub fn change(&self, camera: &mut CameraState, value: u32) -> Result<(), CameraError> {
        let is_allowed = match self.allowed {
            AllowedValues::Options(options) => options.iter().any(|(_, option)| *option == value),
            AllowedValues::Range(low, high, step) => (low..=high).contains(&value) && (value - low).is_multiple_of(step),
        };
        if is_allowed { (self.set)(camera, value) } else { Err(CameraError::Invalid) }
    }

    fn describe(&self, xml: &mut String) {
        let (name, default, description) = (self.name, self.default, self.description);
        // Writing to a string cannot fail.
        let _ = match self.allowed {
            AllowedValues::Options(options) => {
                let options: String =
                    options.iter().map(|(name, value)| format!("<option name=\"{name}\" value=\"{value}\"/>")).collect();
                writeln!(
                    xml,
                    "<parameter name=\"{name}\" type=\"uint32\" default=\"{default}\">\
                     <description>{description}</description><options>{options}</options></parameter>"
                )
            }
            AllowedValues::Range(low, high, step) => writeln!(
                xml,
                "<parameter name=\"{name}\" type=\"uint32\" default=\"{default}\" min=\"{low}\" max=\"{high}\" step=\"{step}\">\
                 <description>{description}</description></parameter>"
            ),
        };
    }
}

/// Returns the camera definition file (XML).
#[must_use]
pub fn definition() -> String {
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<mavlinkcamera>\n<definition version=\"{DEFINITION_VERSION}\">\
         <model>Inspection camera</model><vendor>Spandrel</vendor></definition>\n<parameters>\n"
    );
    ALL.iter().for_each(|setting| setting.describe(&mut xml));
    xml.push_str("</parameters>\n</mavlinkcamera>\n");
    xml
}

#[cfg(test)]
mod tests {
    use super::super::CaptureMode;
    use super::*;
    use spandrel_model::time::SimTime;

    #[test]
    fn exact_settings_accept_only_values_allowed_by_their_description() {
        for setting in ALL {
            assert!(setting.name.len() <= 16);
            let mut camera = CameraState::default();
            assert_eq!(setting.value(&camera), setting.default, "{}", setting.name);
            let legal: Vec<u32> = (0..=200).filter(|value| setting.change(&mut camera, *value).is_ok()).collect();
            let described: Vec<u32> = match setting.allowed {
                AllowedValues::Options(options) => options.iter().map(|option| option.1).collect(),
                AllowedValues::Range(low, high, step) => (low..=high).step_by(step as usize).collect(),
            };
            assert_eq!(legal, described, "{}", setting.name);
            assert_eq!(setting.value(&camera), *described.last().expect("some"));
            assert_eq!(setting.change(&mut camera, u32::MAX), Err(CameraError::Invalid));
        }
    }

    #[test]
    fn exact_settings_affect_the_storage_used_by_pictures_and_recordings() {
        let mut camera = CameraState::default();
        let mib = |camera: &CameraState| (camera.settings.picture_size_mib(), camera.settings.video_data_rate_mib_s());
        let before = mib(&camera);
        for (name, value) in [("CAM_PHOTOQUAL", 0), ("CAM_VIDRATE", 30)] {
            assert_eq!(CameraSetting::named(name).map(|(_, setting)| setting.change(&mut camera, value)), Some(Ok(())), "{name}");
        }
        assert_eq!(mib(&camera), (0.5 * before.0, 0.5 * before.1));
        camera.mode = CaptureMode::Video;
        assert_eq!(camera.start_recording(0.0, SimTime::ZERO), Ok(()));
        let done = CameraSetting::named("CAM_VIDRATE").map(|(_, setting)| setting.change(&mut camera, 40));
        assert_eq!(done, Some(Err(CameraError::Recording)));
    }
}
