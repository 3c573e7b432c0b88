//! Inspection jobs: one TOML file per job in `scenarios/`, parsed into validated types ([`Scenario`]). scenarios/README.md
//! documents every key; a test checks it against this code.

pub mod bridges;
mod briefing_pictures;
mod certification;
mod defect_cause;
mod difficulty;
pub mod drones;
pub mod edit;
mod forms;
mod job;
mod lesson;
mod names;
pub mod places;
mod point;
mod read;
mod resolve;
mod ropes;
mod siblings;
mod stain_patch;
pub mod tasks;
mod terrain;
mod toml_text;
pub mod values;
mod weather;

pub use bridges::path::TaskKind;
pub use bridges::{Bridge, BridgeKind};
pub use briefing_pictures::{BriefingPicture, MAX_BRIEFING_PICTURES, MAX_CAPTION_CHARS, check_picture_files, is_picture_name};
pub use certification::CertificationParams;
pub use defect_cause::{DefectCause, DefectPlacement, Stain, StainSubstance};
pub use difficulty::{level_count, select_level};
pub use forms::{form_names, select_form};
pub use job::{
    AfterCrash, BatteryModel, DefectSpec, Difficulty, DroneSpec, FeedbackThresholds, GroundTeam, GuidancePolicy, HOLD_DURATION,
    HazardSpec, INSPECTOR_EYE_HEIGHT_M, LightSpec, MAX_DEFECTS, PlacedDefect, RopeSpec, Scenario, ScoringParams, SelectedForm,
    SessionRules, StandOff, Task, TerrainSource, TerrainSpec, TrafficSpec, WeatherSpec, WindEvent, WindModel, WindSpec,
};
pub use lesson::{LessonPlace, LessonStep};
pub use names::{MAX_NAME_CHARS, is_name, is_name_char};
pub use point::MAX_COORDINATE_M;
pub use read::{FORMAT, read, read_with_keys};
pub use resolve::{LENGTH_RANGE_M, WIDTH_RANGE_M, resolve, select_variant, variant_names, variant_with_crc};
pub use siblings::SiblingLoader;
pub use stain_patch::{StainPatch, downhill};
pub use terrain::MAX_TERRAIN_M;
