//! A request, read.

use super::auth::LoginClient;
use super::response::WebError;
use super::spool::SpooledUpload;
use spandrel_training::web::access::Visitor;
use std::collections::BTreeMap;
use std::net::IpAddr;

/// A file of a form.
#[derive(Debug)]
pub struct UploadedFile {
    /// Its name as the browser sent it; never used as a path.
    pub name: String,
    /// Its contents.
    pub file: SpooledUpload,
}

/// A request, read: who, what, with which words.
#[derive(Debug)]
pub struct WebRequest {
    /// Who.
    pub visitor: Visitor,
    /// His cookie.
    pub cookie: Option<String>,
    /// From where.
    pub from: IpAddr,
    /// Cookie of a browser that somebody has logged in with before.
    pub device: Option<String>,
    /// Parts of the path by their names in the table of routes.
    pub path: BTreeMap<String, String>,
    /// Words after the question mark.
    pub query: Vec<(String, String)>,
    /// Fields of the form.
    pub form: Vec<(String, String)>,
    /// Its file.
    pub upload: Option<UploadedFile>,
    /// Languages that the browser likes (Accept-Language).
    pub languages: String,
    /// A script of ours asks and reads JSON.
    pub by_script: bool,
}

impl WebRequest {
    /// Where a login comes from.
    pub fn client(&self) -> LoginClient<'_> {
        LoginClient { from: self.from, device: self.device.as_deref() }
    }

    /// A part of the path.
    pub fn path_part(&self, name: &str) -> &str {
        self.path.get(name).map_or("", String::as_str)
    }

    /// A word after the question mark.
    pub fn query_value(&self, name: &str) -> Option<&str> {
        self.query.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str()).filter(|value| !value.is_empty())
    }

    /// A field of the form.
    pub fn form_field(&self, name: &str) -> Option<&str> {
        self.form.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }

    /// A field that must be there.
    ///
    /// # Errors
    /// When it is not.
    pub fn required_field(&self, name: &str) -> Result<&str, WebError> {
        self.form_field(name).filter(|value| !value.is_empty()).ok_or_else(|| WebError::BadRequest(format!("{name}: missing")))
    }

    /// What belongs to this trainee is shown to him and to whoever trains him; to others it is not there.
    ///
    /// # Errors
    /// When it is not his.
    pub fn require_access(&self, trainee: &str) -> Result<(), WebError> {
        if self.visitor.may_see(trainee) { Ok(()) } else { Err(WebError::NotFound) }
    }
}
