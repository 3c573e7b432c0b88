//! What a request brings: the fields of a form, or a file with them.

use super::answer::Refusal;
use super::asked::{Asked, Upload};
use super::guard::Guard;
use super::routes::{FORM_MOST, How};
use axum::body::to_bytes;
use axum::extract::{FromRequest, Multipart, Request};
use std::time::Duration;

/// A browser has this long to send a form.
const FORM_WAIT: Duration = Duration::from_secs(30);
/// And this long for a recording, over a slow line.
const UPLOAD_WAIT: Duration = Duration::from_secs(600);

/// Reads the body, and holds it to the visitor's token.
///
/// # Errors
/// When it is too large, too slow, no form, or not of this visit.
pub async fn read(asked: &mut Asked, how: How, request: Request) -> Result<(), Refusal> {
    let late = |_| Refusal::Wrong("the form came too slowly".into());
    match how {
        How::File | How::Show => Ok(()),
        How::Change => {
            let bytes = tokio::time::timeout(FORM_WAIT, to_bytes(request.into_body(), FORM_MOST)).await.map_err(late)?;
            let bytes = bytes.map_err(|_| Refusal::TooLarge(FORM_MOST))?;
            asked.form = form_urlencoded::parse(&bytes).into_owned().collect();
            Guard::check_token(&asked.visitor, asked.field("token"))
        }
        How::Upload(most) => tokio::time::timeout(UPLOAD_WAIT, read_parts(asked, most, request)).await.map_err(late)?,
    }
}

/// Reads a form with a file. The token comes first: without it nothing more is read.
async fn read_parts(asked: &mut Asked, most: usize, request: Request) -> Result<(), Refusal> {
    let no_form = || Refusal::Wrong("this is no form with a file".into());
    let mut parts = Multipart::from_request(request, &()).await.map_err(|_| no_form())?;
    let too_large = |error: axum::extract::multipart::MultipartError| {
        if error.status() == axum::http::StatusCode::PAYLOAD_TOO_LARGE { Refusal::TooLarge(most) } else { no_form() }
    };
    while let Some(part) = parts.next_field().await.map_err(too_large)? {
        let name = part.name().unwrap_or_default().to_owned();
        let file = part.file_name().map(str::to_owned);
        if name != "token" {
            Guard::check_token(&asked.visitor, asked.field("token"))?;
        }
        let bytes = part.bytes().await.map_err(too_large)?;
        match file {
            Some(_) if bytes.len() > most => return Err(Refusal::TooLarge(most)),
            Some(file) if asked.upload.is_none() => asked.upload = Some(Upload { name: file, bytes: bytes.to_vec() }),
            Some(_) => return Err(Refusal::Wrong("one file at a time".into())),
            None if bytes.len() > FORM_MOST => return Err(Refusal::TooLarge(FORM_MOST)),
            None => asked.form.push((name, String::from_utf8_lossy(&bytes).into_owned())),
        }
    }
    Guard::check_token(&asked.visitor, asked.field("token"))
}
