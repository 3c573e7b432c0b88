//! What a request brings: the fields of a form, or a file with them.

use super::answer::Refusal;
use super::asked::{Asked, Upload};
use super::guard::Guard;
use super::routes::{FORM_MOST, How};
use super::spool::{Spool, Spooled};
use axum::body::to_bytes;
use axum::extract::multipart::{Field, MultipartError};
use axum::extract::{FromRequest, Multipart, Request};
use std::path::Path;
use std::time::Duration;

/// A browser has this long to send a form.
const FORM_WAIT: Duration = Duration::from_secs(30);
/// And this long for a recording, over a slow line.
const UPLOAD_WAIT: Duration = Duration::from_secs(600);

/// Reads the body, and holds it to the visitor's token. Large files go to `spool` meanwhile.
///
/// # Errors
/// When it is too large, too slow, no form, or not of this visit.
pub async fn read(asked: &mut Asked, how: How, request: Request, spool: &Path) -> Result<(), Refusal> {
    let late = |_| Refusal::Wrong("the form came too slowly".into());
    match how {
        How::File | How::Show | How::Compute => Ok(()),
        How::Change => {
            let bytes = tokio::time::timeout(FORM_WAIT, to_bytes(request.into_body(), FORM_MOST)).await.map_err(late)?;
            let bytes = bytes.map_err(|_| Refusal::TooLarge(FORM_MOST))?;
            asked.form = form_urlencoded::parse(&bytes).into_owned().collect();
            Guard::check_token(&asked.visitor, asked.field("token"))
        }
        How::Upload(most) => tokio::time::timeout(UPLOAD_WAIT, read_parts(asked, most, request, spool)).await.map_err(late)?,
    }
}

/// Reads a form with a file. The token comes first: without it nothing more is read.
async fn read_parts(asked: &mut Asked, most: usize, request: Request, spool: &Path) -> Result<(), Refusal> {
    let mut parts = Multipart::from_request(request, &()).await.map_err(|_| no_form())?;
    let too_large = |error: MultipartError| unreadable(&error, most);
    while let Some(mut part) = parts.next_field().await.map_err(too_large)? {
        let name = part.name().unwrap_or_default().to_owned();
        let file = part.file_name().map(str::to_owned);
        if name != "token" {
            Guard::check_token(&asked.visitor, asked.field("token"))?;
        }
        match file {
            Some(_) if asked.upload.is_some() => return Err(Refusal::Wrong("one file at a time".into())),
            Some(file) => asked.upload = Some(Upload { name: file, file: arrive(&mut part, Spool::new(spool, most)).await? }),
            None => {
                let bytes = part.bytes().await.map_err(too_large)?;
                if bytes.len() > FORM_MOST {
                    return Err(Refusal::TooLarge(FORM_MOST));
                }
                asked.form.push((name, String::from_utf8_lossy(&bytes).into_owned()));
            }
        }
    }
    Guard::check_token(&asked.visitor, asked.field("token"))
}

/// Reads a file as it arrives.
async fn arrive(part: &mut Field<'_>, mut spool: Spool<'_>) -> Result<Spooled, Refusal> {
    let begun = tokio::time::Instant::now();
    let most = spool.most();
    while let Some(chunk) = part.chunk().await.map_err(|error| unreadable(&error, most))? {
        // A write to the page cache; the other threads of the runtime go on should the disk be slow.
        tokio::task::block_in_place(|| spool.take(&chunk, begun.elapsed()))?;
    }
    Ok(spool.end())
}

fn no_form() -> Refusal {
    Refusal::Wrong("this is no form with a file".into())
}

fn unreadable(error: &MultipartError, most: usize) -> Refusal {
    if error.status() == axum::http::StatusCode::PAYLOAD_TOO_LARGE { Refusal::TooLarge(most) } else { no_form() }
}
