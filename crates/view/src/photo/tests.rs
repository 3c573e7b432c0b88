use super::*;
use exif::{In, Tag};
use spandrel_model::geodesy::Geo;
use spandrel_model::pose::Pose;
use spandrel_model::vehicle::Camera;

fn about() -> PhotoInfo {
    PhotoInfo {
        number: 3,
        taken_unix_us: 1_781_943_330_250_000,
        taken_utc: ("2026:06:20".into(), "08:15:30".into()),
        at_s: 95.25,
        place: Geo { latitude_deg: 47.123_456_78, longitude_deg: -8.999_999_99, altitude_m: 432.1 },
        height_over_pad_m: 20.5,
        yaw_deg: 271.5,
        pitch_deg: 30.25,
        aircraft_attitude_deg: [271.5, -1.0, 2.0],
        lens: Camera {
            width_px: 4000,
            height_px: 3000,
            hfov_rad: std::f64::consts::FRAC_PI_2,
            ..spandrel_model::site::defects::REFERENCE_CAMERA
        },
        exposure_s: 0.004,
        iso: 200.0,
        lamp: true,
        distance_m: Some(4.0),
        model: "Phantom 2".into(),
        job: "two-bridges".into(),
    }
}

fn noise(width: u32, height: u32) -> Picture {
    let mut random = spandrel_model::random::RandomStream::new(7, "picture");
    Picture { width, height, rgba: (0..4 * width * height).map(|_| (random.bits() >> 40) as u8).collect() }
}

#[test]
fn exact_exif_contains_position_lens_and_direction() {
    let file = jpeg(&noise(64, 48), &about()).unwrap();
    let read = exif::Reader::new().read_from_container(&mut std::io::Cursor::new(&file)).unwrap();
    let value = |tag| read.get_field(tag, In::PRIMARY).map(|field| field.display_value().to_string()).unwrap_or_default();
    let numbers = |tag| match &read.get_field(tag, In::PRIMARY).unwrap().value {
        exif::Value::Rational(parts) => parts.iter().map(exif::Rational::to_f64).collect::<Vec<_>>(),
        other => panic!("{other:?}"),
    };
    let [degrees, minutes, seconds] = numbers(Tag::GPSLatitude)[..] else { panic!("three parts") };
    // Seconds are rounded to four decimals.
    assert!((degrees + minutes / 60.0 + seconds / 3600.0 - 47.123_456_78).abs() < 0.5e-4 / 3600.0 + 1e-12);
    assert_eq!(numbers(Tag::GPSLongitude), [9.0, 0.0, 0.0], "seconds must carry over at 60");
    assert_eq!((value(Tag::GPSLatitudeRef), value(Tag::GPSLongitudeRef)), ("N".into(), "W".into()));
    assert_eq!((numbers(Tag::GPSAltitude), numbers(Tag::GPSImgDirection)), (vec![432.1], vec![271.5]));
    // At ninety degrees, the focal length is half the sensor's width, equivalent to 18 mm on film.
    assert_eq!((numbers(Tag::FocalLength), value(Tag::FocalLengthIn35mmFilm)), (vec![3.085], "18".into()));
    // Pixels per centimeter (unit 3) of a sensor 6.17 mm wide, to three decimals.
    assert_eq!(read.get_field(Tag::FocalPlaneResolutionUnit, In::PRIMARY).unwrap().value.get_uint(0), Some(3));
    for tag in [Tag::FocalPlaneXResolution, Tag::FocalPlaneYResolution] {
        assert!((numbers(tag)[0] - 64.0 / 0.617).abs() <= 0.5e-3, "{:?}", numbers(tag));
    }
    assert_eq!(value(Tag::DateTimeOriginal), "2026-06-20 08:15:30");
    assert_eq!(numbers(Tag::ExposureTime), [0.004]);
}

#[test]
fn exact_heading_is_defined_for_vertical_views() {
    use spandrel_model::frames::Rotation;
    let camera = spandrel_model::site::defects::REFERENCE_CAMERA;
    for yaw_deg in [0.5_f64, 45.0, 135.0, 180.0, 271.5, 359.0] {
        for pitch_deg in [-90.0_f64, -30.0, 0.0, 89.0, 90.0] {
            let attitude = Rotation::from_euler(0.1, -0.05, yaw_deg.to_radians());
            let pose = CameraPose::on_aircraft(
                &camera,
                Pose { position_m: Vec3::zero(), ned_from_frd: attitude },
                pitch_deg.to_radians(),
                false,
            );
            let (yaw, pitch) = direction_deg(&pose);
            // The arcsine is steep at its ends, where rounding errors of 1e-16 become 1e-6 degrees.
            assert!((yaw - yaw_deg).abs() < 1e-9 && (pitch - pitch_deg).abs() < 1e-5, "{yaw_deg} {pitch_deg}: {yaw} {pitch}");
        }
    }
}

#[test]
fn exact_ground_sampling_distance_matches_the_rendered_size() {
    // A 90-degree lens at 4 m covers 8 m, across 4000 px or 1000 px.
    let close = |width, mm: f64| (about().gsd_mm(width).unwrap() - mm).abs() < 1e-9;
    assert!(close(4000, 2.0) && close(1000, 8.0));
    let text = xmp::write(&about(), (1000, 750));
    assert!(text.contains("spandrel:GroundSamplingDistanceMillimetre=\"8.0000\""), "{text}");
    assert!(text.contains("drone-dji:GimbalYawDegree=\"-88.50\"") && text.contains("drone-dji:GimbalPitchDegree=\"+30.25\""));
    assert!(!xmp::write(&PhotoInfo { distance_m: None, ..about() }, (10, 10)).contains("GroundSampling"));
}

#[test]
fn exact_quality_is_the_highest_that_fits() {
    let picture = noise(400, 300);
    let free = plain(&picture, usize::MAX).unwrap();
    let most = free.len() / 2;
    let fitted = plain(&picture, most).unwrap();
    // Bisection stops at most one quality step below the limit; for a picture of noise, a step is a few percent of the
    // size.
    assert!(fitted.len() <= most && fitted.len() > most * 9 / 10, "{} of {most}", fitted.len());
}

#[test]
fn exact_copies_shrink_to_fit_and_photos_keep_their_size() {
    let picture = noise(1600, 1200);
    let size = |file: &[u8]| {
        let image = image::load_from_memory(file).unwrap();
        (image.width(), image.height())
    };
    let free = copy(&picture, usize::MAX).unwrap();
    assert_eq!(size(&free), (1280, 960));
    let quarter = copy(&picture, free.len() / 10).unwrap();
    assert!(quarter.len() <= free.len() / 10 && size(&quarter) == (640, 480), "{} of {}", quarter.len(), free.len());
    assert_eq!(size(&copy(&picture, 1_000).unwrap()), (320, 240), "a copy must not become narrower even if it is too large");
    assert_eq!(size(&jpeg(&picture, &about()).unwrap()), (1600, 1200));
}
