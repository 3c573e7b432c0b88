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

/// Responds with a session's video, or the requested part of it.
pub fn video(state: &ServerState, request: &WebRequest) -> HandlerResult {
    video_part(&folder(state, request, request.path_param("id"))?.join(VIDEO), request)
}

/// Responds with a session's video to the report of a visitor who may see the session.
pub fn report_video(state: &ServerState, request: &WebRequest) -> HandlerResult {
    let (id, key) = (request.path_param("id"), request.path_param("key"));
    let viewer = state.auth.identify_by_file_key(&state.database, id, key)?.ok_or(WebError::NotFound)?;
    let record = state.database.record(id)?.filter(|record| viewer.may_see(&record.trainee)).ok_or(WebError::NotFound)?;
    let folder = state.folder(&record.id).ok_or(WebError::NotFound)?;
    Ok(video_part(&folder.join(VIDEO), request)?.for_sandboxed_page())
}

fn video_part(path: &Path, request: &WebRequest) -> HandlerResult {
    let (mut file, len) = open(path)?;
    let Some(range) = request.range.as_deref().and_then(requested) else {
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(|error| unreadable(path, &error))?;
        return Ok(WebResponse::seekable("video/mp4", bytes));
    };
    let Some((from, count)) = part(range, len) else { return Ok(WebResponse::range_not_satisfiable(len)) };
    let mut bytes = Vec::new();
    let read = file.seek(SeekFrom::Start(from)).and_then(|_| file.take(count).read_to_end(&mut bytes));
    read.map_err(|error| unreadable(path, &error))?;
    Ok(WebResponse::partial("video/mp4", bytes, from, len))
}

fn open(path: &Path) -> Result<(File, u64), WebError> {
    let file = File::open(path).map_err(|_| WebError::NotFound)?;
    let len = file.metadata().map_err(|error| unreadable(path, &error))?.len();
    Ok((file, len))
}

fn unreadable(path: &Path, error: &std::io::Error) -> WebError {
    WebError::Failed(format!("{}: cannot read: {error}", path.display()))
}

/// First and last byte of a request; without the first one, the last one is the number of bytes from the end.
type ByteRange = (Option<u64>, Option<u64>);

/// Returns the first range of a Range header; `None` if the header is invalid and therefore ignored (RFC 9110, section 14.2).
fn requested(header: &str) -> Option<ByteRange> {
    let (from, last) = header.strip_prefix("bytes=")?.split(',').next()?.trim().split_once('-')?;
    let number = |text: &str| if text.is_empty() { Some(None) } else { text.parse().ok().map(Some) };
    match (number(from)?, number(last)?) {
        (None, None) => None,
        (Some(from), Some(last)) if last < from => None,
        range => Some(range),
    }
}

/// Returns the start and the number of bytes to send; `None` if the file has none of the requested bytes.
fn part(range: ByteRange, len: u64) -> Option<(u64, u64)> {
    let (from, last) = match range {
        (Some(from), last) => (from, last.unwrap_or(u64::MAX)),
        (None, count) => (len.saturating_sub(count.unwrap_or(0)), u64::MAX),
    };
    if from >= len {
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
            ("bytes=0-", 10, Some((0, 10))),
            ("bytes=2-3", 10, Some((2, 2))),
            ("bytes=2-99", 10, Some((2, 8))),
            ("bytes=-3", 10, Some((7, 3))),
            ("bytes=-99", 10, Some((0, 10))),
            ("bytes=-0", 10, None),
            ("bytes=4-5, 7-8", 10, Some((4, 2))),
            ("bytes=10-", 10, None),
            ("bytes=0-", 0, None),
            ("bytes=0-", LONG, Some((0, MAX_PART_BYTES))),
            ("bytes=5000000-", LONG, Some((5_000_000, LONG - 5_000_000))),
        ] {
            assert_eq!(part(requested(range).unwrap(), len), expected, "{range} of {len}");
        }
        for invalid in ["", "bytes=", "bytes=-", "bytes=5-4", "bytes=a-b", "lines=1-2", "bytes=5"] {
            assert_eq!(requested(invalid), None, "{invalid}");
        }
    }
}
