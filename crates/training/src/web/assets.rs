//! Style sheet and scripts of the web pages. The style sheet extends that of the reports. URLs contain a content hash,
//! so browsers cache a file until it changes.

use crate::report::assets as report;
use spandrel_monitor::folder::sha256_hex;

/// File name of the style sheet.
pub const STYLE_NAME: &str = "style.css";
/// File name of the questionnaire's script.
pub const FORM_NAME: &str = "form.js";
/// File name of the script of the button that prints a page.
pub const PRINT_NAME: &str = "print.js";
/// File name of the live page's script.
pub const LIVE_NAME: &str = "live.js";
/// File name of the script for the page with all live flights.
pub const TILES_NAME: &str = "tiles.js";
/// File name of the script of a session's page.
pub const SESSION_NAME: &str = "session.js";
/// File name of the scenario editor's script.
pub const EDITOR_NAME: &str = "editor.js";
/// File name of the script for the page of the stations.
pub const STATIONS_SCRIPT_NAME: &str = "stations.js";
/// File name of the script for the trainee's own flight page.
pub const FLIGHT_NAME: &str = "flight.js";

const STYLE_SHEET: &str = include_str!("assets/web.css");
const FORM_SCRIPT: &str = include_str!("assets/form.js");
/// Functions at the beginning of the live pages' scripts.
const LIVE_COMMON_SCRIPT: &str = include_str!("assets/live_common.js");
const TILES_SCRIPT: &str = include_str!("assets/tiles.js");
const LIVE_SCRIPT: &str = include_str!("assets/live.js");
const SESSION_SCRIPT: &str = include_str!("assets/session.js");
const EDITOR_SCRIPT: &str = include_str!("assets/editor.js");
const STATIONS_SCRIPT: &str = include_str!("assets/stations.js");
const FLIGHT_SCRIPT: &str = include_str!("assets/flight.js");

/// Returns the content and media type of a file; `None` if there is no such file.
#[must_use]
pub fn file(name: &str) -> Option<(String, &'static str)> {
    let script = "text/javascript; charset=utf-8";
    match name {
        STYLE_NAME => Some((format!("{}{STYLE_SHEET}", report::STYLE), "text/css; charset=utf-8")),
        FORM_NAME => Some((FORM_SCRIPT.to_owned(), script)),
        PRINT_NAME => Some((report::PRINT_SCRIPT.to_owned(), script)),
        LIVE_NAME => Some((format!("{LIVE_COMMON_SCRIPT}{LIVE_SCRIPT}"), script)),
        TILES_NAME => Some((format!("{LIVE_COMMON_SCRIPT}{TILES_SCRIPT}"), script)),
        SESSION_NAME => Some((SESSION_SCRIPT.to_owned(), script)),
        FLIGHT_NAME => Some((format!("{LIVE_COMMON_SCRIPT}{FLIGHT_SCRIPT}"), script)),
        STATIONS_SCRIPT_NAME => Some((STATIONS_SCRIPT.to_owned(), script)),
        EDITOR_NAME => Some((EDITOR_SCRIPT.to_owned(), script)),
        _ => None,
    }
}

/// Returns the URL of a file, including its content hash.
#[must_use]
pub fn asset_url(name: &str) -> String {
    let hash = file(name).map(|(text, _)| sha256_hex(text.as_bytes())).unwrap_or_default();
    format!("/assets/{name}?v={}", hash.get(..12).unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_asset_urls_contain_content_hash() {
        let scripts =
            [FORM_NAME, PRINT_NAME, LIVE_NAME, TILES_NAME, SESSION_NAME, FLIGHT_NAME, EDITOR_NAME, STATIONS_SCRIPT_NAME];
        for name in [STYLE_NAME].into_iter().chain(scripts) {
            let (text, _) = file(name).unwrap();
            assert_eq!(asset_url(name), format!("/assets/{name}?v={}", &sha256_hex(text.as_bytes())[..12]));
        }
        assert_eq!(file("../mod.rs"), None);
    }
}
