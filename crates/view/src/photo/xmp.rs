//! XMP metadata: gimbal and aircraft attitude under the names that photogrammetry software expects from drones (DJI's
//! names, which Metashape, Pix4D, and OpenDroneMap use), and simulator-specific values in the `spandrel` namespace.
//!
//! The values are attributes of one `rdf:Description`, as DJI writes them. OpenDroneMap finds them only there. The
//! `xmp-writer` crate writes every value as an element, and Adobe's toolkit requires a C++ compiler.

use super::info::PhotoInfo;
use std::fmt::Write;

/// Returns the XMP packet.
pub fn write(about: &PhotoInfo, (width, height): (u32, u32)) -> String {
    let mut fields = String::new();
    let mut field = |name: &str, value: String| {
        let _ = write!(fields, "\n   {name}=\"{value}\"");
    };
    let [yaw, pitch, roll] = about.aircraft_attitude_deg;
    // DJI's yaw ranges from -180 to 180.
    let signed = |deg: f64| (deg + 180.0).rem_euclid(360.0) - 180.0;
    field("drone-dji:AbsoluteAltitude", format!("{:+.3}", about.place.altitude_m));
    field("drone-dji:RelativeAltitude", format!("{:+.3}", about.height_over_pad_m));
    field("drone-dji:GpsLatitude", format!("{:.8}", about.place.latitude_deg));
    field("drone-dji:GpsLongitude", format!("{:.8}", about.place.longitude_deg));
    field("drone-dji:GimbalYawDegree", format!("{:+.2}", signed(about.yaw_deg)));
    field("drone-dji:GimbalPitchDegree", format!("{:+.2}", about.pitch_deg));
    field("drone-dji:GimbalRollDegree", format!("{:+.2}", 0.0));
    field("drone-dji:FlightYawDegree", format!("{:+.2}", signed(yaw)));
    field("drone-dji:FlightPitchDegree", format!("{pitch:+.2}"));
    field("drone-dji:FlightRollDegree", format!("{roll:+.2}"));
    field("spandrel:Picture", about.number.to_string());
    field("spandrel:SimulationTime", format!("{:.3}", about.at_s));
    field("spandrel:HorizontalFieldOfViewDegree", format!("{:.4}", about.lens.hfov_rad.to_degrees()));
    field("spandrel:CameraWidth", about.lens.width_px.to_string());
    field("spandrel:CameraHeight", about.lens.height_px.to_string());
    field("spandrel:DrawnWidth", width.to_string());
    field("spandrel:DrawnHeight", height.to_string());
    field("spandrel:Lamp", if about.lamp { "on" } else { "off" }.to_owned());
    if let (Some(distance_m), Some(gsd_mm)) = (about.distance_m, about.gsd_mm(width)) {
        field("spandrel:DistanceMetre", format!("{distance_m:.3}"));
        field("spandrel:GroundSamplingDistanceMillimetre", format!("{gsd_mm:.4}"));
    }
    format!(
        "<?xpacket begin=\"\u{feff}\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">\n \
         <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n  <rdf:Description rdf:about=\"\"\n   \
         xmlns:drone-dji=\"http://www.dji.com/drone-dji/1.0/\"\n   xmlns:spandrel=\"urn:spandrel:picture:1#\"{fields}/>\n </rdf:RDF>\n\
         </x:xmpmeta>\n<?xpacket end=\"w\"?>"
    )
}
