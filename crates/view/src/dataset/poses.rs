//! Writes the table of a data set's pictures: camera poses, ground sampling distances, weather and seeds.

use super::picture::DatasetPicture;
use super::viewpoints::Aim;
use crate::photo::direction_deg;
use spandrel_model::calendar;
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::math;
use spandrel_model::site::sun;

/// Columns of the table. Angles are in degrees; yaw is clockwise from north, pitch is above the horizon.
pub const COLUMNS: &str = "file,split,scene,scene_seed,task,defect,east_m,north_m,up_m,latitude_deg,longitude_deg,altitude_m,yaw_deg,\
pitch_deg,roll_deg,hfov_deg,distance_m,gsd_mm_px,lamp,utc,time_s,sun_azimuth_deg,sun_elevation_deg,cloud_cover,wind_m_s,wind_from_deg,\
exposure_s,iso";

/// Returns a picture's line.
#[must_use]
pub fn line(picture: &DatasetPicture, plane: &LocalPlane) -> String {
    let (scene, viewpoint) = (picture.scene, picture.viewpoint);
    let (task, defect) = match viewpoint.aim {
        Aim::Task(id) => (id.to_string(), String::new()),
        Aim::Defect(id) => (String::new(), id.to_string()),
    };
    let position_m = viewpoint.pose.position_m;
    let place = plane.geo_from_enu(position_m);
    let (yaw_deg, pitch_deg) = direction_deg(&viewpoint.pose);
    let sun = sun::direction(picture.unix_s(), plane.geo_from_enu(spandrel_model::frames::Vec3::zero()));
    let fields = [
        format!("images/{}/{}", scene.split.name(), picture.file_name()),
        scene.split.name().to_owned(),
        scene.number.to_string(),
        scene.seed.to_string(),
        task,
        defect,
        format!("{:.4}", position_m.east()),
        format!("{:.4}", position_m.north()),
        format!("{:.4}", position_m.up()),
        format!("{:.9}", place.latitude_deg),
        format!("{:.9}", place.longitude_deg),
        format!("{:.4}", place.altitude_m),
        format!("{yaw_deg:.4}"),
        format!("{pitch_deg:.4}"),
        // The gimbal keeps the camera free of roll.
        "0".to_owned(),
        format!("{:.4}", picture.lens.hfov_rad.to_degrees()),
        format!("{:.4}", viewpoint.distance_m),
        format!("{:.4}", picture.gsd_mm()),
        if viewpoint.pose.lamp_on { "on" } else { "off" }.to_owned(),
        calendar::utc((picture.unix_s() * 1e6) as u64).0,
        format!("{:.3}", viewpoint.at.s()),
        format!("{:.2}", math::bearing_deg(sun.east(), sun.north())),
        format!("{:.2}", sun::elevation_rad(sun).to_degrees()),
        format!("{:.3}", scene.cloud_cover),
        format!("{:.2}", scene.wind_m_s),
        format!("{:.1}", scene.wind_from_deg),
        format!("{:.6}", picture.exposure.time_s),
        format!("{:.0}", picture.exposure.iso),
    ];
    fields.join(",")
}
