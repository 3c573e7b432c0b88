//! Fog, rain and snow in pictures. No label and no measure depends on it.

use super::compare::check_album_picture;
use spandrel_model::scenario::WeatherSpec;
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, girder_job};
use spandrel_view::shot::{SensorResponse, Shot};
use spandrel_view::visible_weather::VisibleWeather;

const SIZE_PX: (u32, u32) = (640, 360);

fn weathers() -> [(&'static str, WeatherSpec); 3] {
    let clear = WeatherSpec::default();
    [
        ("fog", WeatherSpec { visibility_m: 300.0, ..clear }),
        ("rain", WeatherSpec { visibility_m: 6_000.0, rain_mm_h: 8.0, ..clear }),
        ("snow", WeatherSpec { snow_mm_h: 1.5, ..clear }),
    ]
}

/// Returns the girder bridge under a closed cloud cover.
fn studio(quality: &str, weather: WeatherSpec) -> Studio {
    let mut job = girder_job();
    (job.light.cloud_cover, job.weather) = (1.0, weather);
    Studio::new(job, 7, quality, SimTime::from_ms(95_000))
}

/// Returns a shot of the girder bridge from the bank.
fn from_the_bank(studio: &Studio) -> Shot {
    studio.seen(at(-72.0, -62.0, 14.0), at(-4.0, 0.0, 13.5), 74.0, false, SIZE_PX)
}

#[test]
fn regress_weather_is_seen() {
    let mut problems = Vec::new();
    for quality in ["low", "medium"] {
        for (name, spec) in weathers() {
            let mut studio = studio(quality, spec);
            let shot = from_the_bank(&studio);
            let picture = studio.draw(&shot);
            problems.extend(check_album_picture(&format!("weather-{name}-{quality}"), &picture).err());
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn exact_weather_changes_neither_labels_nor_measures() {
    let found = |spec: WeatherSpec| {
        let mut studio = studio("low", spec);
        let shot = from_the_bank(&studio);
        let moment = studio.moment(at(-20.0, -6.0, 12.0), at(-20.0, 0.0, 18.0), true, at(0.0, 0.0, 0.0));
        let views = studio.site.view_defects(&moment.camera, &studio.vehicle.camera, &studio.vehicle.lamp, studio.at);
        let (gpu, renderer) = studio.renderer();
        let labels = renderer.labels(gpu, &shot).unwrap();
        (labels.elements, labels.defects, views)
    };
    let clear = found(WeatherSpec::default());
    assert!(!clear.2.is_empty() && clear.0.iter().any(|element| *element != 0));
    for (name, spec) in weathers() {
        assert!(found(spec) == clear, "{name}");
    }
}

/// The bridge loses contrast in fog, the more the shorter the visual range.
#[test]
fn prop_fog_takes_contrast_with_the_visual_range() {
    // Luma is not linear, so that only the order is exact (estimate of a clear step).
    const MAX_SHARE: f64 = 0.8;
    let mut studio = studio("low", WeatherSpec::default());
    let shot = from_the_bank(&studio);
    let masks = {
        let (gpu, renderer) = studio.renderer();
        renderer.labels(gpu, &shot).unwrap()
    };
    let contrasts: Vec<f64> = [12_000.0, 300.0, 100.0, 50.0]
        .into_iter()
        .map(|visibility_m| {
            let spec = WeatherSpec { visibility_m, ..WeatherSpec::default() };
            let weather = VisibleWeather::at(&spec, &studio.site, &shot.eye);
            let finish = SensorResponse::eyes(shot.finish.exposure);
            let picture = studio.draw(&Shot { weather, finish, ..shot.clone() });
            // Variation over the bridge, which is between 40 and 150 m away.
            let of_bridge = (0..SIZE_PX.0 * SIZE_PX.1).filter(|k| masks.elements[*k as usize] != 0);
            let lumas: Vec<f64> =
                of_bridge.map(|k| (k % SIZE_PX.0, k / SIZE_PX.0)).map(|(x, y)| picture.luma((x, y), (x + 1, y + 1))).collect();
            let mean = lumas.iter().sum::<f64>() / lumas.len() as f64;
            (lumas.iter().map(|luma| (luma - mean) * (luma - mean)).sum::<f64>() / lumas.len() as f64).sqrt() / mean
        })
        .collect();
    println!("contrast of the bridge: {contrasts:.3?}");
    assert!(contrasts.windows(2).all(|pair| pair[1] < MAX_SHARE * pair[0]), "{contrasts:?}");
}
