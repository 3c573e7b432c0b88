//! Effects of a weak video link on the camera's picture on the pilot's screen: blocks without data, and frames that don't arrive. The
//! aircraft's own photographs are not affected.

use super::stage::SceneMoment;
use spandrel_model::radio;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;

/// Time in which either all frames arrive or none, as a receiver waits for the next frame that it can decode (estimate).
const FREEZE_STEP: SimTime = SimTime::from_ms(200);
/// Largest share of blocks that a decoder still shows without data; beyond it, it shows no new frame (estimate).
const MAX_LOST_BLOCKS: f64 = 0.4;

/// Receiver of the camera's picture.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VideoReceiver {
    arrived: Option<SceneMoment>,
}

/// A frame as it is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReceivedFrame {
    /// State that the frame shows. If no frame arrives, it is an earlier one.
    pub moment: SceneMoment,
    /// Share of the blocks without data, 0 to 1.
    pub lost_blocks: f64,
}

impl VideoReceiver {
    /// Returns the frame to show. `margin_db` is the margin of the video link; `None` if the job does not simulate it.
    pub fn receive(&mut self, moment: &SceneMoment, margin_db: Option<f64>) -> ReceivedFrame {
        let delivered = margin_db.map_or(1.0, radio::delivered_share);
        let last = self.arrived.filter(|last| last.at <= moment.at && !frame_arrives(delivered, moment.at));
        let shown = last.unwrap_or(*moment);
        self.arrived = Some(shown);
        ReceivedFrame { moment: shown, lost_blocks: MAX_LOST_BLOCKS * (1.0 - delivered) }
    }
}

/// Decides whether frames arrive at a time: always if all data is delivered, never if none is.
fn frame_arrives(delivered: f64, at: SimTime) -> bool {
    let step = at.ns().div_euclid(FREEZE_STEP.ns()).cast_unsigned();
    RandomStream::new(step, "video-link").uniform() < delivered
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::DronePose;
    use crate::stage::{CameraTurnRate, camera_aimed_at};
    use spandrel_model::frames::{Rotation, Vec3};
    use spandrel_model::pose::Pose;
    use spandrel_model::site::defects::REFERENCE_CAMERA;

    fn moment(ms: i64) -> SceneMoment {
        let zero = Vec3::zero();
        SceneMoment {
            at: SimTime::from_ms(ms),
            drone: DronePose { pose: Pose { position_m: zero, ned_from_frd: Rotation::identity() }, spinning: true },
            velocity_m_s: zero,
            camera: camera_aimed_at(zero, Vec3::new(0.0, 1.0, 0.0), false),
            lens: REFERENCE_CAMERA,
            turn: CameraTurnRate::default(),
        }
    }

    /// Returns the share of frames that show the current state, and the last frame's share of lost blocks.
    fn shown(margin_db: Option<f64>) -> (f64, f64) {
        let mut receiver = VideoReceiver::default();
        let frames: Vec<ReceivedFrame> = (0..1_000).map(|k| receiver.receive(&moment(40 * k), margin_db)).collect();
        let current = frames.iter().zip(0..).filter(|(frame, k)| frame.moment.at == SimTime::from_ms(40 * k)).count();
        (current as f64 / 1_000.0, frames[999].lost_blocks)
    }

    #[test]
    fn exact_good_links_show_every_frame_whole() {
        for margin_db in [None, Some(3.0), Some(20.0)] {
            assert_eq!(shown(margin_db), (1.0, 0.0), "{margin_db:?}");
        }
    }

    #[test]
    fn exact_dead_link_keeps_the_last_frame() {
        let mut receiver = VideoReceiver::default();
        receiver.receive(&moment(1_000), Some(10.0));
        for ms in [1_040, 5_000, 60_000] {
            assert_eq!(receiver.receive(&moment(ms), Some(-10.0)).moment.at, SimTime::from_ms(1_000));
        }
        assert_eq!(receiver.receive(&moment(60_040), Some(10.0)), ReceivedFrame { moment: moment(60_040), lost_blocks: 0.0 });
        // Another flight has begun.
        assert_eq!(receiver.receive(&moment(500), Some(-10.0)).moment.at, SimTime::from_ms(500));
    }

    #[test]
    fn prop_frames_and_blocks_fall_with_the_margin() {
        let all: Vec<(f64, f64)> = [3.0, 1.5, 0.0, -1.5].into_iter().map(|margin_db| shown(Some(margin_db))).collect();
        assert!(all.windows(2).all(|pair| pair[0].0 > pair[1].0 && pair[0].1 < pair[1].1), "{all:?}");
    }
}
