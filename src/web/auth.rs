//! Authentication: cookies and logins. The rules are in `spandrel_training::web`; this module adds the clock and random
//! numbers.

mod origin;

pub use origin::{AllowedOrigins, is_host_name};

use super::hashing::HashingQueue;
use super::lock::lock;
use super::response::WebError;
use crate::errors::AppError;
use crate::io::clock;
use crate::records::{Account, Database};
use axum::http::{HeaderMap, header};
use spandrel_text::{Language, text};
use spandrel_training::trainee::{Role, Trainee};
use spandrel_training::web::access::Visitor;
use spandrel_training::web::browser_sessions::{BrowserSession, BrowserSessions, TokenBytes, constant_time_eq};
use spandrel_training::web::known_browsers::KnownBrowsers;
use spandrel_training::web::login_throttle::{LoginOrigin, LoginThrottle};
use std::net::IpAddr;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// Lifetime of the cookie that identifies a browser. The server also discards its record of the browser after this
/// period.
const BROWSER_COOKIE_LIFETIME: cookie::time::Duration = cookie::time::Duration::days(90);

/// Cookie with the tag of the language that the visitor has selected.
pub const LANGUAGE_COOKIE: &str = "spandrel-language";
/// Lifetime of the cookie with the language.
const LANGUAGE_COOKIE_LIFETIME: cookie::time::Duration = cookie::time::Duration::days(365);

/// Stores the browser sessions, the known browsers and the failed logins.
#[derive(Debug)]
pub struct Authenticator {
    browser_sessions: Mutex<BrowserSessions>,
    throttle: Mutex<LoginThrottle>,
    devices: Mutex<KnownBrowsers>,
    /// Queue for password hash requests.
    pub hashing: HashingQueue,
    login_required: AtomicBool,
    secure: bool,
    allowed_origins: AllowedOrigins,
}

/// Client that sent a login request.
#[derive(Debug, Clone, Copy)]
pub struct LoginClient<'a> {
    /// The client's IP address.
    pub from: IpAddr,
    /// Cookie that identifies a browser that has logged in before.
    pub device: Option<&'a str>,
    /// Language of messages.
    pub language: Language,
}

/// A visitor and their session cookie.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct IdentifiedVisitor {
    /// The visitor's name and role.
    pub visitor: Visitor,
    /// Session cookie value.
    pub cookie: String,
    /// True if the cookie is new and must be set.
    pub is_new: bool,
}

impl Authenticator {
    /// Creates an authenticator; `secure` is true if all requests use TLS.
    pub fn new(login_required: bool, secure: bool, allowed_origins: AllowedOrigins) -> Self {
        Self {
            browser_sessions: Mutex::default(),
            throttle: Mutex::default(),
            devices: Mutex::default(),
            hashing: HashingQueue::default(),
            login_required: AtomicBool::new(login_required),
            secure,
            allowed_origins,
        }
    }

    /// Checks the origin of a request.
    ///
    /// # Errors
    /// See [`AllowedOrigins::check_origin`].
    pub fn check_origin(&self, headers: &HeaderMap, changes: bool, open: bool, language: Language) -> Result<(), WebError> {
        self.allowed_origins.check_origin(headers, changes, open, language)
    }

    /// Returns the client's address.
    ///
    /// # Errors
    /// See [`AllowedOrigins::address`].
    pub fn address(&self, socket: IpAddr, headers: &HeaderMap, language: Language) -> Result<IpAddr, WebError> {
        self.allowed_origins.address(socket, headers, language)
    }

    /// Returns true if all requests use TLS.
    pub fn is_secure(&self) -> bool {
        self.secure
    }

    /// Requires a login from now on.
    pub fn require_login(&self) {
        self.login_required.store(true, Ordering::SeqCst);
    }

    /// Returns true if no password is set, so every visitor has full access.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn has_no_passwords(&self, database: &Database) -> Result<bool, AppError> {
        if self.login_required.load(Ordering::SeqCst) {
            return Ok(false);
        }
        // Someone may have set the first password on the command line in the meantime. Once logins are required, they
        // stay required until a restart.
        if !database.names_with_password()?.is_empty() {
            self.require_login();
            return Ok(false);
        }
        Ok(true)
    }

    /// Identifies the visitor by this cookie. Without a valid cookie, a new anonymous browser session starts.
    ///
    /// # Errors
    /// Returns an error if the database or the system's random number generator fails.
    pub fn identify(&self, database: &Database, cookie: Option<String>) -> Result<IdentifiedVisitor, WebError> {
        let open = self.has_no_passwords(database)?;
        let now_us = clock::unix_us();
        let found = cookie.and_then(|cookie| lock(&self.browser_sessions).find(&cookie, now_us).map(|visit| (cookie, visit)));
        if let Some((cookie, visit)) = found {
            if let Some(visitor) = valid_visitor(database, open, visit)? {
                return Ok(IdentifiedVisitor { visitor, cookie, is_new: false });
            }
            lock(&self.browser_sessions).end(&cookie);
        }
        let (cookie, visit) = lock(&self.browser_sessions).begin(None, secrets()?, now_us);
        Ok(IdentifiedVisitor { visitor: visitor(open, None, visit), cookie, is_new: true })
    }

    /// Identifies the visitor whose page received this key for a file; `None` if there is none or their login has ended.
    ///
    /// # Errors
    /// Returns an error if the database fails.
    pub fn identify_by_file_key(&self, database: &Database, file: &str, key: &str) -> Result<Option<Visitor>, WebError> {
        let open = self.has_no_passwords(database)?;
        let found = lock(&self.browser_sessions).find_by_file_key(file, key, clock::unix_us());
        found.map_or(Ok(None), |visit| valid_visitor(database, open, visit))
    }

    /// Logs in: checks the name and password, ends the previous browser session and starts a new one. Returns the new
    /// session cookie and the browser cookie, which marks the browser as known for this name.
    ///
    /// # Errors
    /// Returns an error if there were too many failures, or if the name or password is wrong; the message does not
    /// reveal which.
    pub fn log_in(
        &self,
        database: &Database,
        credentials: (&str, &str),
        before: Option<&str>,
        client: &LoginClient<'_>,
    ) -> Result<(String, String), WebError> {
        let (name, password) = credentials;
        let account = self.check(database, name, password, client)?;
        let credential = account.credential().ok_or_else(|| wrong_credentials(client.language))?;
        let now_us = clock::unix_us();
        let [secret, _] = secrets()?;
        let device = lock(&self.devices).remember(client.device, name, &secret, now_us);
        let mut browser_sessions = lock(&self.browser_sessions);
        before.iter().for_each(|cookie| browser_sessions.end(cookie));
        let (cookie, _) = browser_sessions.begin(Some((name, credential)), secrets()?, now_us);
        Ok((cookie, device))
    }

    /// Checks a password, subject to the limits on failed logins. Returns the account as it was when the password
    /// matched.
    ///
    /// # Errors
    /// See [`Self::log_in`].
    pub fn check(&self, database: &Database, name: &str, password: &str, client: &LoginClient<'_>) -> Result<Account, WebError> {
        let now_us = clock::unix_us();
        let known = client.device.and_then(|cookie| lock(&self.devices).find(cookie, name, now_us));
        let from = LoginOrigin::for_address(client.from, known);
        if let Some(wait_us) = lock(&self.throttle).wait_us(from, name, now_us) {
            return Err(WebError::RateLimited(wait_us.div_ceil(1_000_000)));
        }
        // If the queue is full, the request is rejected before it counts as a failure: a flood of requests must not
        // lock out other users.
        let turn = self.hashing.acquire()?;
        // Attempts are counted before the slow hashing so that simultaneous attempts also count.
        lock(&self.throttle).record_failure(from, name, now_us);
        let account = database.account(name)?;
        let hash = account.as_ref().and_then(|account| account.hash.as_deref());
        if !turn.verify(password, hash) {
            tracing::info!("failed login from {}", client.from);
            return Err(wrong_credentials(client.language));
        }
        lock(&self.throttle).clear_failures(from, name);
        account.ok_or_else(|| wrong_credentials(client.language))
    }

    /// Ends a browser session.
    pub fn log_out(&self, cookie: Option<&str>) {
        cookie.iter().for_each(|cookie| lock(&self.browser_sessions).end(cookie));
    }

    /// Ends all of a person's browser sessions except the one with the `but` cookie.
    pub fn end_other_sessions(&self, name: &str, but: Option<&str>) {
        lock(&self.browser_sessions).end_all_of(name, but);
    }

    /// Keeps a browser session valid after its account's password or role has changed.
    pub fn update_credential(&self, cookie: Option<&str>, account: &Account) {
        if let (Some(cookie), Some(credential)) = (cookie, account.credential()) {
            lock(&self.browser_sessions).update_credential(cookie, credential);
        }
    }

    /// Checks that the form token belongs to the visitor.
    ///
    /// # Errors
    /// Returns an error if it does not: the form comes from another site or was loaded before a login.
    pub fn check_token(visitor: &Visitor, given: Option<&str>) -> Result<(), WebError> {
        if given.is_some_and(|given| constant_time_eq(given, &visitor.token)) {
            return Ok(());
        }
        Err(WebError::Forbidden(text!(visitor.language, "web-error-expired")))
    }

    /// Returns the name of the session cookie.
    fn cookie_name(&self) -> &'static str {
        if self.secure { "__Host-spandrel" } else { "spandrel" }
    }

    /// Returns the name of the cookie that identifies a browser.
    fn browser_cookie_name(&self) -> &'static str {
        if self.secure { "__Host-spandrel-device" } else { "spandrel-device" }
    }

    /// Returns the value of the session cookie in a request.
    pub fn session_cookie_from(&self, headers: &HeaderMap) -> Option<String> {
        cookie_value(headers, self.cookie_name())
    }

    /// Returns the value of the browser cookie in a request.
    pub fn browser_cookie_from(&self, headers: &HeaderMap) -> Option<String> {
        cookie_value(headers, self.browser_cookie_name())
    }

    /// Returns the Set-Cookie value for a known browser. The cookie grants no access; the server only counts known
    /// browsers' failed logins separately.
    pub fn browser_cookie(&self, value: &str) -> String {
        let built = cookie::Cookie::build((self.browser_cookie_name(), value)).path("/").http_only(true).secure(self.secure);
        built.same_site(cookie::SameSite::Strict).max_age(BROWSER_COOKIE_LIFETIME).build().to_string()
    }

    /// Returns the Set-Cookie value for the selected language.
    pub fn language_cookie(&self, language: Language) -> String {
        let built = cookie::Cookie::build((LANGUAGE_COOKIE, language.tag())).path("/").http_only(true).secure(self.secure);
        built.same_site(cookie::SameSite::Lax).max_age(LANGUAGE_COOKIE_LIFETIME).build().to_string()
    }

    /// Returns the Set-Cookie value for the session. The policy is Lax: with Strict, opening a link from an e-mail
    /// would send no cookie, and the new anonymous session would log the user out. Requests that change anything need a
    /// form token and pass an origin check.
    pub fn cookie(&self, value: &str) -> String {
        let built = cookie::Cookie::build((self.cookie_name(), value)).path("/").http_only(true).secure(self.secure);
        built.same_site(cookie::SameSite::Lax).build().to_string()
    }
}

/// Returns the value of a cookie.
pub fn cookie_value(headers: &HeaderMap, name: &str) -> Option<String> {
    let all = headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
    let mut pairs = all.flat_map(cookie::Cookie::split_parse).flatten();
    pairs.find(|cookie| cookie.name() == name).map(|cookie| cookie.value().to_owned())
}

fn wrong_credentials(language: Language) -> WebError {
    WebError::Forbidden(text!(language, "web-error-credentials"))
}

/// Returns the visitor of a browser session; `None` if their account has changed since the login. Every request is checked, so a role
/// change, an erasure or a new password ends the session immediately, even if another server or the command line made the change.
fn valid_visitor(database: &Database, open: bool, visit: BrowserSession) -> Result<Option<Visitor>, WebError> {
    let account = visit.name.as_deref().map(|name| database.account(name)).transpose()?.flatten();
    if visit.name.is_some() && visit.credential != account.as_ref().and_then(Account::credential) {
        return Ok(None);
    }
    Ok(Some(visitor(open, account.map(|account| account.person), visit)))
}

fn visitor(open: bool, person: Option<Trainee>, visit: BrowserSession) -> Visitor {
    let role = if open { Role::Administrator } else { person.as_ref().map_or(Role::Trainee, |person| person.role) };
    let (language, address) = (Language::default(), String::new());
    Visitor {
        name: person.map(|person| person.pseudonym),
        role,
        open,
        token: visit.token,
        language,
        has_stations: false,
        address,
    }
}

fn secrets() -> Result<[TokenBytes; 2], WebError> {
    let mut secrets = [[0; 32]; 2];
    for secret in &mut secrets {
        getrandom::fill(secret)
            .map_err(|error| WebError::Failed(format!("the system's random number generator failed: {error}")))?;
    }
    Ok(secrets)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        pairs.iter().map(|(name, value)| (header::HeaderName::from_static(name), value.parse().unwrap())).collect()
    }

    #[test]
    fn exact_cookies_are_http_only_and_lax() {
        let plain = Authenticator::new(true, false, AllowedOrigins::default()).cookie("v");
        assert_eq!(plain, "spandrel=v; HttpOnly; SameSite=Lax; Path=/");
        let guard = Authenticator::new(true, true, AllowedOrigins::default());
        let cookie = guard.cookie("v");
        assert!(cookie.starts_with("__Host-spandrel=v;") && cookie.contains("Secure"), "{cookie}");
        assert_eq!(
            guard.session_cookie_from(&headers(&[("cookie", "a=b; __Host-spandrel=xyz; spandrel=no")])),
            Some("xyz".into())
        );
        assert_eq!(guard.session_cookie_from(&headers(&[])), None);
        let device = guard.browser_cookie("v");
        assert!(device.starts_with("__Host-spandrel-device=v; HttpOnly; SameSite=Strict; Secure;"), "{device}");
        assert!(device.contains("Max-Age=7776000"), "{device}");
        let language = guard.language_cookie(Language::German);
        assert_eq!(language, "spandrel-language=de; HttpOnly; SameSite=Lax; Secure; Path=/; Max-Age=31536000");
    }
}
