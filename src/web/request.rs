//! A parsed HTTP request.

use super::auth::LoginClient;
use super::response::WebError;
use super::spool::SpooledUpload;
use crate::io::trainee_id::TraineeId;
use spandrel_text::{Language, text};
use spandrel_training::web::access::Visitor;
use spandrel_training::web::rejected_form::RejectedForm;
use std::collections::BTreeMap;
use std::net::IpAddr;

/// A file uploaded with a form.
#[derive(Debug)]
pub struct UploadedFile {
    /// File name as sent by the browser; never used as a path.
    pub name: String,
    /// File contents.
    pub file: SpooledUpload,
}

impl UploadedFile {
    /// Returns the file's name for messages.
    pub fn shown_name(&self) -> String {
        self.name.chars().filter(|c| !c.is_control()).take(60).collect()
    }
}

/// Returns the message about a file that is not a text.
pub fn not_text(language: Language, file: &str, error: std::str::Utf8Error) -> String {
    text!(language, "web-error-not-text", file = file, byte = error.valid_up_to())
}

/// A parsed request and its visitor.
#[derive(Debug)]
pub struct WebRequest {
    /// Visitor who sent the request.
    pub visitor: Visitor,
    /// Session cookie value.
    pub cookie: Option<String>,
    /// Client address.
    pub from: IpAddr,
    /// Cookie that identifies a browser that has logged in before.
    pub device: Option<String>,
    /// Path parameters, keyed by their names in the route table.
    pub path: BTreeMap<String, String>,
    /// Query parameters as name and value.
    pub query: Vec<(String, String)>,
    /// Form fields as name and value.
    pub form: Vec<(String, String)>,
    /// Uploaded file, if any.
    pub upload: Option<UploadedFile>,
    /// The visitor's preferred languages: the selected one, or else those of the browser (Accept-Language).
    pub languages: String,
    /// Value of the Authorization header.
    pub authorization: Option<String>,
    /// Body of a message from a training station.
    pub body: Vec<u8>,
    /// The requested part of a file (Range).
    pub range: Option<String>,
    /// Address of the server as the client entered it, such as `http://127.0.0.1:8080`.
    pub server: String,
    /// True for requests from the pages' scripts, which expect JSON.
    pub expects_json: bool,
}

impl WebRequest {
    /// Returns the client that sent a login request.
    pub fn client(&self) -> LoginClient<'_> {
        LoginClient { from: self.from, device: self.device.as_deref(), language: self.visitor.language }
    }

    /// Returns a path parameter, or an empty string.
    pub fn path_param(&self, name: &str) -> &str {
        self.path.get(name).map_or("", String::as_str)
    }

    /// Returns a non-empty query parameter.
    pub fn query_param(&self, name: &str) -> Option<&str> {
        self.query.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str()).filter(|value| !value.is_empty())
    }

    /// Returns a form field.
    pub fn form_field(&self, name: &str) -> Option<&str> {
        self.form.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }

    /// Returns a form field that must not be empty.
    ///
    /// # Errors
    /// Returns an error if the field is missing or empty.
    pub fn required_field(&self, name: &str) -> Result<&str, WebError> {
        self.form_field(name).filter(|value| !value.is_empty()).ok_or_else(|| WebError::missing(self.visitor.language, name))
    }

    /// Returns a form field that is one line of text, without spaces at both ends; a missing field is empty. `min` and `max` are
    /// its length in characters.
    ///
    /// # Errors
    /// Returns an error if the text is too short or too long, or has control characters.
    pub fn line_field(&self, name: &str, (min, max): (usize, usize)) -> Result<&str, WebError> {
        let text = self.form_field(name).unwrap_or_default().trim();
        let count = text.chars().count();
        if (min..=max).contains(&count) && !text.chars().any(char::is_control) {
            return Ok(text);
        }
        let language = self.visitor.language;
        Err(WebError::BadRequest(text!(language, "web-error-line", field = name, count = count, least = min, most = max)))
    }

    /// Returns the submitted form with the problem of one of its fields; `None` if the error is not about what was entered.
    pub fn rejected<'a>(&'a self, field: &'a str, error: &'a WebError) -> Option<RejectedForm<'a>> {
        error.invalid_input().map(|problem| RejectedForm { entered: &self.form, field, problem })
    }

    /// Returns the pseudonym in a form field.
    ///
    /// # Errors
    /// Returns an error if the field is missing or not a pseudonym.
    pub fn trainee_field(&self, name: &str) -> Result<TraineeId, WebError> {
        self.trainee_id(name, self.required_field(name)?)
    }

    /// Returns a pseudonym that is a part of a form field.
    ///
    /// # Errors
    /// Returns an error if it is not a pseudonym.
    pub fn trainee_id(&self, field: &str, given: &str) -> Result<TraineeId, WebError> {
        let language = self.visitor.language;
        given.parse().map_err(|_| WebError::BadRequest(text!(language, "web-error-id", field = field, value = given)))
    }

    /// Returns the uploaded file.
    ///
    /// # Errors
    /// Returns an error if there is none.
    pub fn required_upload(&self) -> Result<&UploadedFile, WebError> {
        self.upload.as_ref().ok_or_else(|| WebError::missing(self.visitor.language, "file"))
    }

    /// Checks that the visitor may see this trainee's data. Only the trainee, instructors and administrators may; for
    /// everyone else, the data appears not to exist.
    ///
    /// # Errors
    /// Returns an error if the visitor has no access.
    pub fn check_access(&self, trainee: &str) -> Result<(), WebError> {
        if self.visitor.may_see(trainee) { Ok(()) } else { Err(WebError::NotFound) }
    }
}
