//! Properties of a picture that its files contain.

use super::scenes::DatasetScene;
use super::viewpoints::Viewpoint;
use crate::exposure::Exposure;
use spandrel_model::math;
use spandrel_model::vehicle::Camera;

/// A picture of a data set, except its pixels and labels.
#[derive(Debug, Clone, Copy)]
pub struct DatasetPicture<'a> {
    /// Number in the data set, from 1.
    pub number: u32,
    /// Size, px.
    pub size_px: (u32, u32),
    /// Scene that it shows.
    pub scene: &'a DatasetScene,
    /// Camera pose and time.
    pub viewpoint: &'a Viewpoint,
    /// Lens.
    pub lens: &'a Camera,
    /// Exposure.
    pub exposure: Exposure,
}

impl DatasetPicture<'_> {
    /// Returns the name of the picture's files without extension.
    #[must_use]
    pub fn stem(&self) -> String {
        format!("{:06}", self.number)
    }

    /// Returns the name of the picture's file in its split's folder.
    #[must_use]
    pub fn file_name(&self) -> String {
        format!("{}.jpg", self.stem())
    }

    /// Returns the ground sampling distance at the center of the picture, mm/px.
    #[must_use]
    pub fn gsd_mm(&self) -> f64 {
        let width = 2.0 * math::tan(0.5 * self.lens.hfov_rad);
        1000.0 * self.viewpoint.distance_m * width / f64::from(self.size_px.0.max(1))
    }

    /// Returns the time of the picture, seconds since the Unix epoch.
    #[must_use]
    pub fn unix_s(&self) -> f64 {
        self.scene.start_unix_s as f64 + self.viewpoint.at.s()
    }
}
