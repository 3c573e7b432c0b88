//! EXIF 2.32 metadata.

use super::info::{PhotoError, PhotoInfo};
use exif::experimental::Writer;
use exif::{Field, In, Rational, Tag, Value};
use spandrel_model::vehicle::SENSOR_WIDTH_MM;
use std::io::Cursor;

/// Width of a 35 mm film frame, mm.
const FILM_WIDTH_MM: f64 = 36.0;

/// Returns the TIFF structure of an EXIF segment.
pub fn write(about: &PhotoInfo, size_px: (u32, u32)) -> Result<Vec<u8>, PhotoError> {
    let fields: Vec<Field> = camera(about, size_px)
        .into_iter()
        .chain(place(about))
        .map(|(tag, value)| Field { tag, ifd_num: In::PRIMARY, value })
        .collect();
    let mut writer = Writer::new();
    fields.iter().for_each(|field| writer.push_field(field));
    let mut out = Cursor::new(Vec::new());
    writer.write(&mut out, true).map_err(|error| PhotoError::Refused(error.to_string()))?;
    Ok(out.into_inner())
}

fn text(words: &str) -> Value {
    // EXIF text is ASCII.
    let plain = |c: char| if c.is_ascii() && !c.is_ascii_control() { c as u8 } else { b'?' };
    Value::Ascii(vec![words.chars().map(plain).collect()])
}

fn rational(value: f64, parts: u32) -> Rational {
    Rational { num: (value * f64::from(parts)).round().clamp(0.0, f64::from(u32::MAX)) as u32, denom: parts }
}

fn rational_value(value: f64, parts: u32) -> Value {
    Value::Rational(vec![rational(value, parts)])
}

fn camera(about: &PhotoInfo, (width, height): (u32, u32)) -> Vec<(Tag, Value)> {
    let (date, time) = &about.taken_utc;
    let lens = &about.lens;
    let focal_mm = lens.focal_mm();
    vec![
        (Tag::ImageDescription, text(&format!("Inspection picture {} of {}", about.number, about.job))),
        (Tag::Make, text("Spandrel")),
        (Tag::Model, text(&about.model)),
        (Tag::Software, text(concat!("spandrel ", env!("CARGO_PKG_VERSION")))),
        (Tag::DateTime, text(&format!("{date} {time}"))),
        (Tag::DateTimeOriginal, text(&format!("{date} {time}"))),
        (Tag::OffsetTimeOriginal, text("+00:00")),
        (Tag::SubSecTimeOriginal, text(&format!("{:03}", about.taken_unix_us / 1000 % 1000))),
        (Tag::ExifVersion, Value::Undefined(b"0232".to_vec(), 0)),
        (Tag::PixelXDimension, Value::Long(vec![width])),
        (Tag::PixelYDimension, Value::Long(vec![height])),
        (Tag::FocalLength, rational_value(focal_mm, 1000)),
        (Tag::FocalLengthIn35mmFilm, Value::Short(vec![(focal_mm * FILM_WIDTH_MM / SENSOR_WIDTH_MM).round() as u16])),
        // Picture pixels per centimeter of the sensor; bundle adjustment needs only this and the focal length. EXIF
        // defines only inches and centimeters; millimeters (4) come from TIFF/EP, which not all programs read.
        (Tag::FocalPlaneXResolution, rational_value(10.0 * f64::from(width) / SENSOR_WIDTH_MM, 1000)),
        (Tag::FocalPlaneYResolution, rational_value(10.0 * f64::from(width) / SENSOR_WIDTH_MM, 1000)),
        (Tag::FocalPlaneResolutionUnit, Value::Short(vec![3])),
        (Tag::FNumber, rational_value(lens.f_number, 100)),
        (Tag::ExposureTime, rational_value(about.exposure_s, 1_000_000)),
        (Tag::PhotographicSensitivity, Value::Short(vec![about.iso.round().clamp(1.0, 65_535.0) as u16])),
        (Tag::Flash, Value::Short(vec![0])),
    ]
}

fn place(about: &PhotoInfo) -> Vec<(Tag, Value)> {
    let place = &about.place;
    let north = if place.latitude_deg < 0.0 { "S" } else { "N" };
    let east = if place.longitude_deg < 0.0 { "W" } else { "E" };
    let below = u8::from(place.altitude_m < 0.0);
    let seconds = (about.taken_unix_us / 1_000) as f64 / 1000.0;
    let of_day = seconds.rem_euclid(86_400.0);
    let clock =
        vec![rational((of_day / 3600.0).floor(), 1), rational((of_day / 60.0).floor() % 60.0, 1), rational(of_day % 60.0, 1000)];
    vec![
        (Tag::GPSVersionID, Value::Byte(vec![2, 3, 0, 0])),
        (Tag::GPSLatitudeRef, text(north)),
        (Tag::GPSLatitude, degrees(place.latitude_deg)),
        (Tag::GPSLongitudeRef, text(east)),
        (Tag::GPSLongitude, degrees(place.longitude_deg)),
        (Tag::GPSAltitudeRef, Value::Byte(vec![below])),
        (Tag::GPSAltitude, rational_value(place.altitude_m.abs(), 1000)),
        (Tag::GPSTimeStamp, Value::Rational(clock)),
        (Tag::GPSDateStamp, text(&about.taken_utc.0)),
        (Tag::GPSMapDatum, text("WGS-84")),
        (Tag::GPSImgDirectionRef, text("T")),
        // Rounds to hundredths below a full turn: 0 to 359.99.
        (Tag::GPSImgDirection, rational_value((about.yaw_deg * 100.0).round().rem_euclid(36_000.0) / 100.0, 100)),
    ]
}

/// Returns an angle as degrees, minutes, and seconds, with seconds to four decimals (3 mm on the ground).
fn degrees(angle_deg: f64) -> Value {
    // Rounds the whole angle first, so that 59.99999 s never becomes 60 s.
    let parts = (angle_deg.abs() * 3600.0 * 10_000.0).round();
    let whole = |size: f64| (parts / size).floor();
    Value::Rational(vec![
        rational(whole(36_000_000.0), 1),
        rational(whole(600_000.0) % 60.0, 1),
        Rational { num: (parts % 600_000.0) as u32, denom: 10_000 },
    ])
}
