//! The folder of a data set.

use super::masks;
use crate::errors::AppError;
use crate::io::replace::replace;
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::PlacedDefect;
use spandrel_view::dataset::annotations::{Annotation, annotations};
use spandrel_view::dataset::coco::CocoFile;
use spandrel_view::dataset::scenes::Split;
use spandrel_view::dataset::{DatasetOrigin, DatasetPicture, poses, readme, yolo};
use spandrel_view::masks::LabelMask;
use spandrel_view::photo;
use spandrel_view::picture::Picture;
use std::path::{Path, PathBuf};

/// Writes a data set's files. The annotations and the README come last, so that a folder with a README is complete.
pub struct DatasetFolder {
    folder: PathBuf,
    plane: LocalPlane,
    files: [CocoFile; 2],
    poses: String,
}

impl DatasetFolder {
    /// Checks that the folder is new or empty. The first picture creates it.
    pub fn new(folder: &Path, plane: LocalPlane) -> Result<Self, AppError> {
        match std::fs::read_dir(folder) {
            Ok(mut entries) => {
                if entries.next().is_some() {
                    return Err(AppError::invalid(format!(
                        "--out {}: the folder is not empty (allowed: a new or empty folder)",
                        folder.display()
                    )));
                }
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
            Err(error) => return Err(refused(folder, &error)),
        }
        Ok(Self { folder: folder.to_path_buf(), plane, files: Default::default(), poses: format!("{}\n", poses::COLUMNS) })
    }

    /// Creates the folder with its subfolders.
    fn create(&self) -> Result<(), AppError> {
        let parts = Split::ALL.into_iter().flat_map(|split| ["images", "labels"].map(|part| format!("{part}/{}", split.name())));
        for part in parts.chain(["annotations".to_owned()]) {
            std::fs::create_dir_all(self.folder.join(part)).map_err(|error| refused(&self.folder, &error))?;
        }
        Ok(())
    }

    /// Writes a picture with its labels, and with its label masks if `with_masks` is set.
    pub fn add(
        &mut self,
        about: &DatasetPicture,
        drawn: &Picture,
        (labels, placed, with_masks): (&LabelMask, &[PlacedDefect], bool),
    ) -> Result<(), AppError> {
        if about.number == 1 {
            self.create()?;
        }
        let split = about.scene.split;
        let found: Vec<Annotation> = annotations(labels, placed);
        let path = self.folder.join("images").join(split.name()).join(about.file_name());
        replace(&path, &photo::plain(drawn, usize::MAX)?)?;
        if with_masks {
            let beside = self.folder.join("annotations").join(about.file_name());
            masks::write_labels(labels, placed, &beside)?;
        }
        let text = yolo::labels(&found, about.size_px);
        replace(&self.folder.join("labels").join(split.name()).join(format!("{}.txt", about.stem())), text.as_bytes())?;
        self.files[split as usize].add(about, &found);
        self.poses.push_str(&poses::line(about, &self.plane));
        self.poses.push('\n');
        Ok(())
    }

    /// Writes the files that cover all pictures. Returns the number of annotations.
    pub fn finish(self, origin: &DatasetOrigin, command: &str) -> Result<usize, AppError> {
        for split in Split::ALL {
            let path = self.folder.join("annotations").join(format!("instances_{}.json", split.name()));
            replace(&path, format!("{}\n", self.files[split as usize].content(origin)).as_bytes())?;
        }
        replace(&self.folder.join("data.yaml"), yolo::data_yaml().as_bytes())?;
        replace(&self.folder.join("poses.csv"), self.poses.as_bytes())?;
        let counts = self.files.each_ref().map(|file| (file.image_count(), file.annotation_count()));
        replace(&self.folder.join("README.md"), readme::text(origin, command, counts).as_bytes())?;
        Ok(counts.iter().map(|(_, annotations)| annotations).sum())
    }
}

fn refused(folder: &Path, error: &std::io::Error) -> AppError {
    AppError::invalid(format!("--out {}: {error}", folder.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::geodesy::Geo;

    #[test]
    fn exact_folder_must_be_new_or_empty() {
        let at = tempfile::tempdir().unwrap();
        let open = |name: &str| {
            let plane = LocalPlane::new(Geo { latitude_deg: 40.0, longitude_deg: -80.0, altitude_m: 0.0 });
            DatasetFolder::new(&at.path().join(name), plane)
        };
        open("new/set").unwrap().create().unwrap();
        assert!(at.path().join("new/set/labels/val").is_dir());
        let full = open("new").err().unwrap();
        assert!(full.to_string().contains("is not empty (allowed: a new or empty folder)"), "{full}");
        std::fs::write(at.path().join("file"), "").unwrap();
        let not_a_folder = open("file").err().unwrap();
        assert!(not_a_folder.to_string().contains("--out"), "{not_a_folder}");
        std::fs::create_dir(at.path().join("empty")).unwrap();
        open("empty").unwrap();
    }
}
