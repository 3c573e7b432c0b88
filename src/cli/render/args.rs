//! Command line of `spandrel render`.

use crate::cli::args::parse_seed;
use crate::errors::EXIT_CODES;
use std::path::PathBuf;

/// Maximum number of pictures of a data set: COCO files of more would need several GB of memory (estimate).
const MAX_DATASET_PICTURES: i64 = 100_000;

/// Render any moment of a recorded session, or a scenario from any viewpoint, as a PNG picture
///
/// For a session, renders the aircraft camera's view at a simulation time, the inspector's view from the landing pad,
/// or both side by side, with head-up display. For a scenario, renders the view from any point toward another point. It
/// needs no window or graphics card: a software Vulkan driver is enough (Debian and Ubuntu: mesa-vulkan-drivers).
/// --snapshots renders all photographs of a session into its folder as JPEG files with EXIF and XMP; --video renders
/// the camera's view, with the photographs as chapters in a separate file (WebVTT). --dataset renders labeled pictures of
/// a scenario for training defect detectors.
#[cfg_attr(not(feature = "view"), allow(dead_code, reason = "help and errors are the same with and without the view"))]
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel render sessions/20260801T... --at 95 --out both.png
  spandrel render sessions/20260801T... --at 95 --view camera --size 4000x3000 --quality high --no-hud
  spandrel render sessions/20260801T... --snapshots
  spandrel render sessions/20260801T... --snapshots --masks
  spandrel render sessions/20260801T... --video
  spandrel render sessions/20260801T... --video flight.mp4 --span 60,90 --size 960x540
  spandrel render two-bridges --from=-60,-110,30 --look 0,0,25 --utc 2026-06-20T08:00:00Z --cloud 0.2
  spandrel render two-bridges --from 20,-1,28 --look 0,0,31 --lamp --seed 7
  spandrel render girder --dataset 500 --out girder-set --seed 7

{EXIT_CODES}"))]
pub struct Args {
    /// Session folder, scenario file, or the name of a shipped scenario
    #[arg(value_name = "SESSION|SCENARIO")]
    pub what: String,
    /// Simulation time in s [default for a session: the middle of the flight]
    #[arg(long, value_name = "S")]
    pub at: Option<f64>,
    /// Output file; '-' for standard output. With --dataset, the folder of the data set, which must be new or empty (by default, "dataset")
    #[arg(
        long,
        value_name = "FILE",
        default_value = "picture.png",
        default_value_if("dataset", clap::builder::ArgPredicate::IsPresent, "dataset")
    )]
    pub out: String,
    /// View to render for a session
    #[arg(long, value_name = "VIEW", value_parser = ["camera", "inspector", "both"], default_value = "both")]
    pub view: String,
    /// Size of each view in px; the camera's view and photographs keep the sensor's aspect ratio within it [default:
    /// 1280x720; 1280x960 for a data set; for photographs the camera's size, or a smaller size without a graphics card]
    #[arg(long, value_name = "WxH")]
    pub size: Option<String>,
    /// Rendering quality: low, medium, high or ultra
    #[arg(long, value_name = "PRESET", default_value = "high")]
    pub quality: String,
    /// Write label masks for each picture, for training detectors: NAME.elements.png (AASHTO element numbers),
    /// NAME.defects.png (defect numbers), both 16-bit grayscale, and NAME.masks.json (kind, condition state and box of
    /// each defect)
    #[arg(long, conflicts_with = "video")]
    pub masks: bool,
    /// Render N labeled pictures of a scenario to a folder, for training defect detectors: COCO annotations with exact outlines, YOLO
    /// boxes, camera poses and weather, split into training and validation by the seed
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MAX_DATASET_PICTURES),
        conflicts_with_all = ["at", "view", "no_hud", "snapshots", "video", "from", "look", "fov", "lamp", "utc", "cloud"])]
    pub dataset: Option<u32>,
    /// Hide the head-up display
    #[arg(long)]
    pub no_hud: bool,
    /// Render all of a session's photographs to its "snapshots" folder (JPEG) and small copies for the report to its
    /// "small" folder, and rewrite the report
    #[arg(long, conflicts_with_all = ["at", "out", "view", "video"])]
    pub snapshots: bool,
    /// Render a session's camera view as a video (MP4, H.264), with chapters in a .vtt file next to it. Without FILE, the video
    /// goes to the session folder, begins at lift-off, and appears in the report
    #[arg(long, value_name = "FILE", num_args = 0..=1, conflicts_with_all = ["at", "out", "view"])]
    #[expect(clippy::option_option, reason = "clap's type for an option with an optional value")]
    pub video: Option<Option<PathBuf>>,
    /// Render the video only with a graphics card; without one, do nothing
    #[arg(long, requires = "video")]
    pub only_with_gpu: bool,
    /// Video frame rate in frames per second (1 to 60)
    #[arg(long, value_name = "HZ", default_value_t = 15.0, requires = "video")]
    pub fps: f64,
    /// Part of the flight to show in the video, in s of simulation time [default: all]
    #[arg(long, value_name = "FROM,TO", requires = "video")]
    pub span: Option<String>,
    /// Viewpoint in m east, north and up from the scenario's origin; scenarios only
    #[arg(long, value_name = "E,N,U", allow_hyphen_values = true, requires = "look")]
    pub from: Option<String>,
    /// Point to look at, in the same coordinates
    #[arg(long, value_name = "E,N,U", allow_hyphen_values = true, requires = "from")]
    pub look: Option<String>,
    /// Horizontal field of view in deg; scenarios only [default: the aircraft camera's]
    #[arg(long, value_name = "DEG")]
    pub fov: Option<f64>,
    /// Turn on the lamp at the viewpoint; scenarios only
    #[arg(long)]
    pub lamp: bool,
    /// Start time in UTC (2026-06-20T08:00:00Z), which determines the sun's position; scenarios only
    #[arg(long, value_name = "UTC")]
    pub utc: Option<String>,
    /// Cloud cover (0 to 1); scenarios only
    #[arg(long, value_name = "SHARE")]
    pub cloud: Option<f64>,
    /// Aircraft for a scenario: a file, or the name of a shipped aircraft
    #[arg(long, value_name = "FILE|NAME", default_value = "phantom2")]
    pub vehicle: String,
    /// Run at low CPU priority
    #[arg(long)]
    pub nice: bool,
    /// Seed for a scenario's defects and traffic, or for all of a data set [default: the scenario's seed]
    #[arg(long, value_name = "N", value_parser = parse_seed)]
    pub seed: Option<u64>,
}
