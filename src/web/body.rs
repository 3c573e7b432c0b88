//! Reads request bodies: form fields and uploaded files.

use super::auth::Authenticator;
use super::request::{UploadedFile, WebRequest};
use super::response::WebError;
use super::routes::{MAX_FORM_BYTES, RouteKind};
use super::spool::{SpooledUpload, UploadSpool};
use axum::body::to_bytes;
use axum::extract::multipart::{Field, MultipartError};
use axum::extract::{FromRequest, Multipart, Request};
use spandrel_text::{Language, text};
use std::path::Path;
use std::time::Duration;

/// Time limit for a form without a file.
const FORM_TIMEOUT: Duration = Duration::from_secs(30);
/// Time limit for uploading a file, even over a slow connection.
const UPLOAD_TIMEOUT: Duration = Duration::from_secs(600);

/// Reads the body and checks the form token. Large files are written to `spool` during the upload.
///
/// # Errors
/// Returns an error if the body is too large, arrives too slowly, is not a form, or has a wrong token.
pub async fn read(web_request: &mut WebRequest, kind: RouteKind, request: Request, spool: &Path) -> Result<(), WebError> {
    let language = web_request.visitor.language;
    match kind {
        RouteKind::File | RouteKind::Show | RouteKind::Compute => Ok(()),
        RouteKind::StationMessage => {
            web_request.body = read_all(request, MAX_FORM_BYTES, language).await?;
            Ok(())
        }
        RouteKind::Change => read_form(web_request, request, MAX_FORM_BYTES).await,
        // Up to three bytes encode one byte, and the form's other fields also need space.
        RouteKind::Text(most) => read_form(web_request, request, 3 * most + MAX_FORM_BYTES).await,
        RouteKind::Upload(most) => {
            let parts = read_parts(web_request, most, request, spool);
            tokio::time::timeout(UPLOAD_TIMEOUT, parts).await.map_err(|_| late(language))?
        }
    }
}

/// Returns the error for a form that did not arrive in time.
fn late(language: Language) -> WebError {
    WebError::BadRequest(text!(language, "web-error-timed-out"))
}

/// Reads a body of at most this many bytes.
async fn read_all(request: Request, most: usize, language: Language) -> Result<Vec<u8>, WebError> {
    let bytes = tokio::time::timeout(FORM_TIMEOUT, to_bytes(request.into_body(), most)).await;
    let bytes = bytes.map_err(|_| late(language))?;
    Ok(bytes.map_err(|_| WebError::TooLarge(most))?.to_vec())
}

/// Reads a form without a file.
async fn read_form(web_request: &mut WebRequest, request: Request, most: usize) -> Result<(), WebError> {
    let bytes = read_all(request, most, web_request.visitor.language).await?;
    web_request.form = form_urlencoded::parse(&bytes).into_owned().collect();
    Authenticator::check_token(&web_request.visitor, web_request.form_field("token"))
}

/// Reads a form with a file. The token must be the first field; without it, nothing else is read.
async fn read_parts(web_request: &mut WebRequest, most: usize, request: Request, spool: &Path) -> Result<(), WebError> {
    let language = web_request.visitor.language;
    let mut parts = Multipart::from_request(request, &()).await.map_err(|_| not_a_form_error(language))?;
    let too_large = |error: MultipartError| unreadable(&error, most, language);
    while let Some(mut part) = parts.next_field().await.map_err(too_large)? {
        let name = part.name().unwrap_or_default().to_owned();
        let file = part.file_name().map(str::to_owned);
        if name != "token" {
            Authenticator::check_token(&web_request.visitor, web_request.form_field("token"))?;
        }
        match file {
            Some(_) if web_request.upload.is_some() => {
                return Err(WebError::BadRequest(text!(language, "web-error-one-file")));
            }
            Some(name) => {
                let file = read_file(&mut part, UploadSpool::new(spool, most, language), language).await?;
                web_request.upload = Some(UploadedFile { name, file });
            }
            None => {
                let bytes = part.bytes().await.map_err(too_large)?;
                if bytes.len() > MAX_FORM_BYTES {
                    return Err(WebError::TooLarge(MAX_FORM_BYTES));
                }
                web_request.form.push((name, String::from_utf8_lossy(&bytes).into_owned()));
            }
        }
    }
    Authenticator::check_token(&web_request.visitor, web_request.form_field("token"))
}

/// Reads a file as it arrives.
async fn read_file(part: &mut Field<'_>, mut spool: UploadSpool<'_>, language: Language) -> Result<SpooledUpload, WebError> {
    let begun = tokio::time::Instant::now();
    let most = spool.max_bytes();
    while let Some(chunk) = part.chunk().await.map_err(|error| unreadable(&error, most, language))? {
        // This usually writes only to the page cache; if the disk is slow, the runtime's other threads continue.
        tokio::task::block_in_place(|| spool.append(&chunk, begun.elapsed()))?;
    }
    Ok(spool.finish())
}

fn not_a_form_error(language: Language) -> WebError {
    WebError::BadRequest(text!(language, "web-error-no-file-form"))
}

fn unreadable(error: &MultipartError, most: usize, language: Language) -> WebError {
    if error.status() == axum::http::StatusCode::PAYLOAD_TOO_LARGE {
        WebError::TooLarge(most)
    } else {
        not_a_form_error(language)
    }
}
