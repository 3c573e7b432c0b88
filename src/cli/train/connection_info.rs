//! Instructions for connecting a ground station or a script.

use crate::cli::ports::PortArgs;
use crate::io::files;
use std::path::Path;

/// Returns the address of the site's map tiles for a ground station. `scenario` is the name or path of the job.
fn map_tiles(scenario: &str, web: Option<&str>) -> String {
    let shipped = scenario.split(files::FORM_SEPARATOR).next().filter(|name| files::scenario_names().contains(name));
    let named = shipped.map(str::to_owned).or_else(|| own_job_name(scenario));
    match web.zip(named) {
        Some((web, name)) => {
            let tiles = format!("{}/tiles/{name}", web.trim_end_matches('/'));
            format!(
                "{tiles}/{{z}}/{{x}}/{{y}}.png\n                   {tiles}/WMTSCapabilities.xml (Mission Planner: WMTS Custom)"
            )
        }
        None => "none".to_owned(),
    }
}

/// Returns the name of a job from a file. The tiles of one with the name of a shipped job would be those of the shipped one.
fn own_job_name(scenario: &str) -> Option<String> {
    let name = files::scenario(scenario).ok()?.scenario.name;
    (!files::scenario_names().contains(&name.as_str())).then_some(name)
}

/// Returns the instructions for one flight of a scenario. `web` is the web pages' address, and `window` is true if a window
/// shows the flight.
pub fn connection_instructions(
    (title, scenario): (&str, &str),
    args: &PortArgs,
    ports: &serde_json::Value,
    session: &Path,
    (web, window): (Option<&str>, bool),
) -> String {
    let port = |key: &str| ports[key].as_u64().map_or("not opened".to_owned(), |port| port.to_string());
    let targets: Vec<String> = args.ground_stations().iter().map(ToString::to_string).collect();
    let (auto, targets) = if targets.is_empty() { ("no", "none".to_owned()) } else { ("yes", targets.join(", ")) };
    format!(
        "\
{title}
  QGroundControl   connects automatically: {auto} (the vehicle sends to {targets})
  connect to       UDP {} or TCP {} at {}
  MAVSDK           {}
  pymavlink        udpout:127.0.0.1:{}
  session folder   {}
  web pages        {}
  map tiles        {}
{}
Take off, fly the tasks and land on the pad. You then see your scores, and the vehicle stays connected.
Press Ctrl-C to end the session early.
",
        port("gcs_port"),
        port("tcp_port"),
        args.listen,
        args.sdk().map_or("none".to_owned(), |sdk| format!("udpin://0.0.0.0:{}", sdk.port())),
        port("gcs_port"),
        session.display(),
        web.unwrap_or("none"),
        map_tiles(scenario, web),
        if window {
            "A window shows both views and the flight keys; you can also fly with a ground station or a script."
        } else {
            "No window: fly with the map and instruments of a ground station, or with a script."
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::train::args::parse_args;

    #[test]
    fn exact_instructions_match_window_availability() {
        let ports = parse_args(&[]).ports;
        let told = |window| {
            connection_instructions(("Drill", "drill-hover"), &ports, &serde_json::Value::Null, Path::new("s"), (None, window))
        };
        assert!(told(true).contains("A window shows") && !told(true).contains("No window"), "{}", told(true));
        assert!(told(true).contains("map tiles        none"));
        let is_served = |told: &str, name: &str| {
            let address = |file: &str| format!("http://127.0.0.1:8080/tiles/{name}/{file}");
            told.contains(&address("{z}/{x}/{y}.png\n")) && told.contains(&address("WMTSCapabilities.xml "))
        };
        assert!(is_served(&map_tiles("drill-hover", Some("http://127.0.0.1:8080/")), "drill-hover"));
        assert!(is_served(&map_tiles("pilot-study@B", Some("http://127.0.0.1:8080")), "pilot-study"));
        let folder = tempfile::tempdir().unwrap();
        let own = folder.path().join("job.toml");
        let path = own.to_str().unwrap();
        assert_eq!(map_tiles(path, Some("http://127.0.0.1:8080")), "none", "no such file");
        let text = spandrel_model::shipped::DRILL_HOVER;
        std::fs::write(&own, text).unwrap();
        assert_eq!(map_tiles(path, Some("http://127.0.0.1:8080")), "none", "another job with the name of a shipped one");
        std::fs::write(&own, text.replace("name = \"drill-hover\"", "name = \"my-job\"")).unwrap();
        assert!(is_served(&map_tiles(path, Some("http://127.0.0.1:8080")), "my-job"));
        assert!(told(false).contains("No window: fly with") && !told(false).contains("A window shows"), "{}", told(false));
    }
}
