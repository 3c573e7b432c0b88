//! HTTP responses, and the headers common to all responses.

use crate::errors::AppError;
use axum::body::Body;
use axum::http::{HeaderName, HeaderValue, Response, StatusCode, header};
use maud::Markup;
use spandrel_text::{Language, text};

/// Content security policy for the pages: only the server's own files, no inline code and no requests to other sites.
const PAGE_POLICY: &str = "default-src 'none'; style-src 'self'; script-src 'self'; img-src 'self' data:; media-src 'self'; connect-src 'self'; \
    form-action 'self'; base-uri 'none'; frame-ancestors 'none'";

/// Header that says which sites' pages may load a response.
const RESOURCE_POLICY: HeaderName = HeaderName::from_static("cross-origin-resource-policy");

/// A handler's HTTP response.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WebResponse {
    status: StatusCode,
    kind: &'static str,
    policy: String,
    location: Option<String>,
    download: Option<String>,
    cacheable: bool,
    retry_after_s: Option<u64>,
    content_range: Option<String>,
    accepts_ranges: bool,
    resource_policy: &'static str,
    /// Complete values of Set-Cookie headers.
    pub cookies: Vec<String>,
    body: Vec<u8>,
}

/// A handler's error, which determines the HTTP status.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum WebError {
    /// The resource does not exist, or this visitor may not see it. The response is the same in both cases so that
    /// guessing reveals nothing.
    NotFound,
    /// The visitor must log in first.
    LoginRequired,
    /// The visitor lacks permission; contains a message in the visitor's language.
    Forbidden(String),
    /// The request is invalid; contains a message in the visitor's language, or in English about the contents of a file.
    BadRequest(String),
    /// The body is larger than this maximum in bytes.
    TooLarge(usize),
    /// There were too many failed logins; contains the time to wait in s.
    RateLimited(u64),
    /// The server is overloaded; contains the time to wait in s.
    Busy(u64),
    /// Internal error. The message is logged, but not shown.
    Failed(String),
}

/// A handler's result.
pub type HandlerResult = Result<WebResponse, WebError>;

impl WebResponse {
    fn new(kind: &'static str, body: Vec<u8>) -> Self {
        Self {
            status: StatusCode::OK,
            kind,
            policy: PAGE_POLICY.to_owned(),
            location: None,
            download: None,
            cacheable: false,
            retry_after_s: None,
            content_range: None,
            accepts_ranges: false,
            resource_policy: "same-origin",
            cookies: Vec::new(),
            body,
        }
    }

    /// Responds with a page.
    pub fn page(markup: Markup) -> Self {
        Self::new("text/html; charset=utf-8", markup.into_string().into_bytes())
    }

    /// Responds with a page that shows a rejected form again.
    pub fn rejected_form(markup: Markup) -> Self {
        Self::page(markup).with_status(StatusCode::UNPROCESSABLE_ENTITY)
    }

    /// Responds with a page that has its own policy and scripts (a report). The page is sandboxed and cannot access the
    /// cookies.
    pub fn sandboxed_page(page: Vec<u8>, policy: &str) -> Self {
        let policy = format!("{policy}; frame-ancestors 'none'; sandbox allow-scripts allow-downloads allow-modals");
        Self { policy, ..Self::new("text/html; charset=utf-8", page) }
    }

    /// Responds with JSON for the pages' scripts.
    pub fn json(value: &serde_json::Value) -> Self {
        Self::new("application/json", value.to_string().into_bytes())
    }

    /// Responds with a file to download.
    pub fn download(name: &str, kind: &'static str, bytes: Vec<u8>) -> Self {
        Self { download: Some(name.to_owned()), ..Self::new(kind, bytes) }
    }

    /// Responds with an image that is not cached.
    pub fn picture(jpeg: Vec<u8>) -> Self {
        Self::new("image/jpeg", jpeg)
    }

    /// Responds with an image of this media type that is not cached.
    pub fn image(kind: &'static str, bytes: Vec<u8>) -> Self {
        Self::new(kind, bytes)
    }

    /// Responds with an entire file of which clients may also request parts.
    pub fn seekable(kind: &'static str, bytes: Vec<u8>) -> Self {
        Self { accepts_ranges: true, ..Self::new(kind, bytes) }
    }

    /// Responds with a part of a file of `len` bytes that starts at `from`.
    pub fn partial(kind: &'static str, bytes: Vec<u8>, from: u64, len: u64) -> Self {
        let last = (from + bytes.len() as u64).saturating_sub(1);
        let part = Self { content_range: Some(format!("bytes {from}-{last}/{len}")), ..Self::seekable(kind, bytes) };
        part.with_status(StatusCode::PARTIAL_CONTENT)
    }

    /// Lets sandboxed pages load the response; to the browser, they are another site.
    pub fn for_sandboxed_page(self) -> Self {
        Self { resource_policy: "cross-origin", ..self }
    }

    /// Responds that the requested part is outside the file of `len` bytes.
    pub fn range_not_satisfiable(len: u64) -> Self {
        let none = Self::seekable("text/plain; charset=utf-8", Vec::new());
        let none = Self { content_range: Some(format!("bytes */{len}")), ..none };
        none.with_status(StatusCode::RANGE_NOT_SATISFIABLE)
    }

    /// Responds with text that a page's element loads, such as the chapters of a video.
    pub fn track(text: Vec<u8>) -> Self {
        Self::new("text/vtt; charset=utf-8", text)
    }

    /// Responds with an XML document.
    pub fn xml(document: maud::Markup) -> Self {
        Self::new("application/xml", document.into_string().into_bytes())
    }

    /// Responds with a map tile.
    pub fn map_tile(png: Vec<u8>) -> Self {
        Self::new("image/png", png)
    }

    /// Responds with a file that browsers may cache until its URL changes.
    pub fn asset(kind: &'static str, text: String) -> Self {
        Self { cacheable: true, ..Self::new(kind, text.into_bytes()) }
    }

    /// Redirects to another page.
    pub fn redirect(address: &str) -> Self {
        let there = Self::new("text/plain; charset=utf-8", Vec::new());
        Self { status: StatusCode::SEE_OTHER, location: Some(address.to_owned()), ..there }
    }

    /// Sets the status code.
    pub fn with_status(mut self, status: StatusCode) -> Self {
        self.status = status;
        self
    }

    /// Sets the time in seconds after which the client may retry.
    pub fn retry_after(mut self, seconds: Option<u64>) -> Self {
        self.retry_after_s = seconds;
        self
    }

    /// Converts to an axum response.
    pub fn into_response(self) -> Response<Body> {
        let mut response = Response::new(Body::from(self.body));
        *response.status_mut() = self.status;
        let mut set = |name: HeaderName, value: &str| {
            // All values are generated or validated, so this cannot fail; an invalid header would be omitted.
            if let Ok(value) = HeaderValue::from_str(value) {
                response.headers_mut().insert(name, value);
            }
        };
        set(header::CONTENT_TYPE, self.kind);
        set(header::CONTENT_SECURITY_POLICY, &self.policy);
        set(header::CACHE_CONTROL, if self.cacheable { "public, max-age=31536000, immutable" } else { "no-store" });
        set(RESOURCE_POLICY, self.resource_policy);
        if let Some(location) = &self.location {
            set(header::LOCATION, location);
        }
        if let Some(name) = &self.download {
            set(header::CONTENT_DISPOSITION, &format!("attachment; filename=\"{name}\""));
        }
        if let Some(range) = &self.content_range {
            set(header::CONTENT_RANGE, range);
        }
        if self.accepts_ranges {
            set(header::ACCEPT_RANGES, "bytes");
        }
        if let Some(seconds) = self.retry_after_s {
            set(header::RETRY_AFTER, &seconds.to_string());
        }
        for cookie in self.cookies.iter().filter_map(|cookie| HeaderValue::from_str(cookie).ok()) {
            response.headers_mut().append(header::SET_COOKIE, cookie);
        }
        response
    }
}

/// Sets the headers of every response, including error responses.
pub fn set_security_headers(headers: &mut axum::http::HeaderMap, secure: bool) {
    let mut set = |name: HeaderName, value: &'static str| headers.insert(name, HeaderValue::from_static(value));
    set(header::X_CONTENT_TYPE_OPTIONS, "nosniff");
    set(header::X_FRAME_OPTIONS, "DENY");
    set(header::REFERRER_POLICY, "same-origin");
    set(HeaderName::from_static("cross-origin-opener-policy"), "same-origin");
    set(HeaderName::from_static("permissions-policy"), "camera=(), microphone=(), geolocation=()");
    if secure {
        set(header::STRICT_TRANSPORT_SECURITY, "max-age=31536000");
    }
    headers.entry(RESOURCE_POLICY).or_insert(HeaderValue::from_static("same-origin"));
    headers.entry(header::CONTENT_SECURITY_POLICY).or_insert(HeaderValue::from_static(PAGE_POLICY));
}

impl WebError {
    /// Returns the time in s after which the client may retry, or `None` if waiting does not help.
    pub fn retry_after_s(&self) -> Option<u64> {
        match self {
            Self::RateLimited(seconds) | Self::Busy(seconds) => Some(*seconds),
            Self::NotFound
            | Self::LoginRequired
            | Self::Forbidden(_)
            | Self::BadRequest(_)
            | Self::TooLarge(_)
            | Self::Failed(_) => None,
        }
    }

    /// Returns the message about invalid input; `None` for other errors.
    pub fn invalid_input(&self) -> Option<&str> {
        match self {
            Self::BadRequest(words) => Some(words),
            Self::NotFound
            | Self::LoginRequired
            | Self::Forbidden(_)
            | Self::TooLarge(_)
            | Self::RateLimited(_)
            | Self::Busy(_)
            | Self::Failed(_) => None,
        }
    }

    /// Returns the error page's status, title and message.
    pub fn status_and_text(&self, language: Language) -> (StatusCode, String, String) {
        match self {
            Self::NotFound => {
                let (title, words) = (text!(language, "web-error-not-found"), text!(language, "web-error-not-found-text"));
                (StatusCode::NOT_FOUND, title, words)
            }
            Self::LoginRequired => {
                (StatusCode::UNAUTHORIZED, text!(language, "web-error-login"), text!(language, "web-error-login-text"))
            }
            Self::Forbidden(words) => (StatusCode::FORBIDDEN, text!(language, "web-error-forbidden"), words.clone()),
            Self::BadRequest(words) => (StatusCode::UNPROCESSABLE_ENTITY, text!(language, "web-error-invalid"), words.clone()),
            Self::TooLarge(most) => {
                let words = text!(language, "web-error-too-large-text", most = *most);
                (StatusCode::PAYLOAD_TOO_LARGE, text!(language, "web-error-too-large"), words)
            }
            Self::RateLimited(seconds) => {
                let words = text!(language, "web-error-wait-text", seconds = *seconds);
                (StatusCode::TOO_MANY_REQUESTS, text!(language, "web-error-wait"), words)
            }
            Self::Busy(seconds) => {
                let words = text!(language, "web-error-busy-text", seconds = *seconds);
                (StatusCode::SERVICE_UNAVAILABLE, text!(language, "web-error-busy"), words)
            }
            Self::Failed(_) => {
                let (title, words) = (text!(language, "web-error-internal"), text!(language, "web-error-internal-text"));
                (StatusCode::INTERNAL_SERVER_ERROR, title, words)
            }
        }
    }

    /// Returns the error for a form field that is missing.
    pub fn missing(language: Language, field: &str) -> Self {
        Self::BadRequest(text!(language, "web-error-missing", field = field))
    }

    /// Returns the error for a form field with a word that is not in the list of allowed ones.
    pub fn unknown(language: Language, field: &str, allowed: &str) -> Self {
        Self::BadRequest(text!(language, "web-error-unknown-allowed", field = field, allowed = allowed))
    }

    /// Returns the error for a form field that is not a number in the allowed range.
    pub fn not_in_range(language: Language, field: &str, least: u32, most: u32) -> Self {
        Self::BadRequest(text!(language, "web-error-number", field = field, least = least, most = most))
    }
}

impl From<crate::io::append_file::WriteError> for WebError {
    fn from(refused: crate::io::append_file::WriteError) -> Self {
        Self::Failed(refused.to_string())
    }
}

impl From<AppError> for WebError {
    fn from(error: AppError) -> Self {
        match error {
            AppError::Wrong(words) => Self::BadRequest(words),
            AppError::Failed(words) | AppError::Autopilot(_, words) => Self::Failed(words),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_errors_are_in_the_visitor_language() {
        let errors = [
            WebError::NotFound,
            WebError::LoginRequired,
            WebError::TooLarge(7),
            WebError::RateLimited(7),
            WebError::Busy(7),
            WebError::Failed("disk".into()),
            WebError::missing(Language::Pseudo, "7"),
            WebError::unknown(Language::Pseudo, "7", "8"),
            WebError::not_in_range(Language::Pseudo, "7", 1, 2),
        ];
        for error in errors {
            let (_, title, words) = error.status_and_text(Language::Pseudo);
            let plain =
                |text: &str| text.split_whitespace().any(|word| word.len() > 2 && word.chars().all(|c| c.is_ascii_alphabetic()));
            assert!(!plain(&title) && !plain(&words), "{title}: {words}");
        }
        let (_, title, words) = WebError::Busy(5).status_and_text(Language::German);
        assert_eq!(
            (title.as_str(), words.as_str()),
            ("Server ausgelastet", "Der Server ist ausgelastet. Versuchen Sie es in 5 s erneut.")
        );
    }
}
