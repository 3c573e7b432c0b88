//! A session's video and photographs.

use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse};
use super::sessions::folder;
use super::state::ServerState;
use crate::io::report::photograph_path;
use spandrel_monitor::folder::{SNAPSHOTS, VIDEO};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Maximum number of bytes of a video per response. Browsers request the rest when they need it.
const MAX_PART_BYTES: u64 = 2 * 1024 * 1024;

/// Responds with the requested part of a session's video.
pub fn video(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let path = folder(state, request, request.path_param("id"))?.join(VIDEO);
    let (mut file, len) = open(&path)?;
    let Some((from, count)) = part(request.range.as_deref(), len) else { return Ok(WebResponse::range_not_satisfiable(len)) };
    let mut bytes = Vec::new();
    let read = file.seek(SeekFrom::Start(from)).and_then(|_| file.take(count).read_to_end(&mut bytes));
    read.map_err(|error| WebError::Failed(format!("{}: cannot read: {error}", path.display())))?;
    Ok(WebResponse::partial("video/mp4", bytes, from, len))
}

fn open(path: &Path) -> Result<(File, u64), WebError> {
    let file = File::open(path).map_err(|_| WebError::NotFound)?;
    let len = file.metadata().map_err(|error| WebError::Failed(format!("{}: {error}", path.display())))?.len();
    Ok((file, len))
}

/// Returns the start and the number of bytes to send for a Range header; `None` if no requested byte exists. A missing or
/// unreadable header requests everything (RFC 9110, section 14.2). Of several ranges, the first counts.
fn part(range: Option<&str>, len: u64) -> Option<(u64, u64)> {
    let asked = range.and_then(|range| range.strip_prefix("bytes=")?.split(',').next()?.trim().split_once('-'));
    let (from, last) = match asked {
        Some(("", count)) => (len.saturating_sub(count.parse().unwrap_or(len)), u64::MAX),
        Some((from, last)) => (from.parse().unwrap_or(0), last.parse().unwrap_or(u64::MAX)),
        None => (0, u64::MAX),
    };
    if from >= len || last < from {
        return None;
    }
    Some((from, (last.min(len - 1) - from + 1).min(MAX_PART_BYTES)))
}

/// Responds with the chapters of a session's video.
pub fn chapters(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let path = folder(state, request, request.path_param("id"))?.join(VIDEO).with_extension("vtt");
    Ok(WebResponse::track(std::fs::read(path).map_err(|_| WebError::NotFound)?))
}

/// Responds with a photograph of a session, in the size of the report.
pub fn photograph(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let folder = folder(state, request, request.path_param("id"))?.join(SNAPSHOTS);
    let number = request.path_param("name").strip_suffix(".jpg").and_then(|number| number.parse().ok());
    let path = number.and_then(|number| photograph_path(&folder, number)).ok_or(WebError::NotFound)?;
    Ok(WebResponse::picture(std::fs::read(path).map_err(|_| WebError::NotFound)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_parts_of_a_file() {
        const LONG: u64 = 3 * MAX_PART_BYTES;
        for (range, len, expected) in [
            (None, 10, Some((0, 10))),
            (Some("bytes=0-"), 10, Some((0, 10))),
            (Some("bytes=2-3"), 10, Some((2, 2))),
            (Some("bytes=2-99"), 10, Some((2, 8))),
            (Some("bytes=-3"), 10, Some((7, 3))),
            (Some("bytes=-99"), 10, Some((0, 10))),
            (Some("bytes=4-5, 7-8"), 10, Some((4, 2))),
            (Some("lines=1-2"), 10, Some((0, 10))),
            (Some("bytes=10-"), 10, None),
            (Some("bytes=5-4"), 10, None),
            (Some("bytes=0-"), 0, None),
            (None, LONG, Some((0, MAX_PART_BYTES))),
            (Some("bytes=5000000-"), LONG, Some((5_000_000, LONG - 5_000_000))),
        ] {
            assert_eq!(part(range, len), expected, "{range:?} of {len}");
        }
    }
}
