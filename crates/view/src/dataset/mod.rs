//! Labeled pictures of a scenario for training defect detectors: the scenes and camera poses that a seed draws, and the files that
//! detectors read. [`scenes`] varies defects, traffic, sun, clouds and wind; [`viewpoints`] places the camera; [`annotations`] derives
//! boxes and outlines from the exact label masks; [`coco`], [`yolo`] and [`poses`] write them.

pub mod annotations;
pub mod coco;
pub mod origin;
pub mod picture;
pub mod poses;
pub mod readme;
pub mod scenes;
pub mod viewpoints;
pub mod yolo;

pub use origin::DatasetOrigin;
pub use picture::DatasetPicture;
