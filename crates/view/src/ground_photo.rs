//! The aerial photograph of a site, as the views and the maps draw it on the ground.

use super::tiles::{MipLevels, levels};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::raster::ground_photo::GroundPicture;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;

/// Pixels per side of the picture: on a site of 800 m, one pixel is 0.4 m wide. Finer details are those of the surface itself.
const SIDE_PX: usize = 2048;

/// The colors of the ground of a site.
#[derive(Debug, Clone)]
pub struct GroundColors {
    half_m: f64,
    picture: GroundPicture,
}

impl GroundColors {
    /// Returns the colors of a site; `None` without a photograph.
    #[must_use]
    pub fn new(scenario: &Scenario, site: &Site) -> Option<Self> {
        let size_m = scenario.terrain.size_m;
        // The file was decoded when the scenario was read, so this fails only if the coordinate system ends within the site.
        let picture = scenario.terrain.photo.as_ref()?.picture(site.plane(), size_m, SIDE_PX).ok()?;
        Some(Self { half_m: 0.5 * size_m, picture })
    }

    /// Returns half the side of the square that the picture covers, m.
    #[must_use]
    pub fn half_m(&self) -> f64 {
        self.half_m
    }

    /// Returns the color at a place; `None` outside the photograph.
    #[must_use]
    pub fn at(&self, place_m: Vec3<Enu>) -> Option<[u8; 3]> {
        let share = |at_m: f64| 0.5 + 0.5 * at_m / self.half_m;
        let (x, y) = (share(place_m.east()), 1.0 - share(place_m.north()));
        if !((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y)) {
            return None;
        }
        let [column, row] = [x, y].map(|share| (share * SIDE_PX as f64) as usize);
        let [red, green, blue, opacity] = self.picture.pixels[row * SIDE_PX + column];
        (opacity > 0).then_some([red, green, blue])
    }

    /// Returns the picture with its mipmaps.
    #[must_use]
    pub fn levels(&self) -> MipLevels {
        levels(SIDE_PX, self.picture.pixels.clone())
    }
}
