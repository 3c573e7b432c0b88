//! The aircraft that the start page offers, and the one that is selected.

use crate::errors::AppError;
use crate::io::files;
use spandrel_model::vehicle::Vehicle;
use spandrel_view::flow::pipe::AircraftOffer;
use std::path::Path;

/// An aircraft with its name on the command line and in the window.
#[derive(Debug, Clone)]
pub struct SelectedAircraft {
    /// Name of a shipped aircraft, or path of a file.
    pub name: String,
    /// The aircraft.
    pub vehicle: Vehicle,
}

impl SelectedAircraft {
    /// Reads an aircraft.
    ///
    /// # Errors
    /// Returns an error if the file is missing or invalid.
    pub fn read(name: &str) -> Result<Self, AppError> {
        Ok(Self { name: name.to_owned(), vehicle: files::vehicle(name)?.vehicle })
    }
}

/// Returns the shipped aircraft and the command line's, if that is another one.
pub fn offered(own: &str) -> Vec<AircraftOffer> {
    let shipped = files::vehicle_names();
    let own = Some(own).filter(|own| !shipped.contains(own));
    shipped.iter().copied().chain(own).filter_map(|name| offer(name, own == Some(name))).collect()
}

/// Returns an aircraft with its title; `None` if it cannot be read. The title of a file contains the file's name, because a
/// modified copy of an aircraft often keeps the aircraft's name.
fn offer(name: &str, is_file: bool) -> Option<AircraftOffer> {
    let vehicle = SelectedAircraft::read(name).ok()?.vehicle;
    let file = Path::new(name).file_name().map_or_else(|| name.into(), |file| file.to_string_lossy());
    let title = if is_file { format!("{} ({file})", vehicle.name) } else { vehicle.name };
    Some(AircraftOffer { name: name.to_owned(), title })
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::shipped;

    #[test]
    fn exact_shipped_aircraft_and_the_command_lines_file_are_offered_once() {
        let names = |own: &str| offered(own).into_iter().map(|offer| offer.name).collect::<Vec<_>>();
        assert_eq!(names("phantom2"), files::vehicle_names());
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("ours.toml");
        let text = shipped::VEHICLES.iter().find(|(name, _)| *name == "phantom2").unwrap().1;
        std::fs::write(&file, text).unwrap();
        let own = file.display().to_string();
        let with_file = offered(&own);
        assert_eq!(with_file.len(), files::vehicle_names().len() + 1);
        let expected = AircraftOffer { name: own, title: "Phantom 2 class (ours.toml)".into() };
        assert_eq!(with_file.last(), Some(&expected));
        assert_eq!(names("missing.toml"), files::vehicle_names(), "an aircraft that cannot be read");
    }
}
