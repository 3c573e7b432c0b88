//! Who is who: cookies and logins. The rules are `spandrel_training::web`'s; here are clock and randomness.

mod origin;

pub use origin::{AllowedOrigins, is_host_name};

use super::hashing::HashingQueue;
use super::lock::lock;
use super::response::WebError;
use crate::errors::AppError;
use crate::io::clock;
use crate::records::{Account, Database};
use axum::http::{HeaderMap, header};
use spandrel_training::trainee::{Role, Trainee};
use spandrel_training::web::access::Visitor;
use spandrel_training::web::devices::KnownBrowsers;
use spandrel_training::web::throttle::{LoginOrigin, LoginThrottle};
use spandrel_training::web::visits::{BrowserSession, BrowserSessions, TokenBytes, constant_time_eq};
use std::net::IpAddr;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// A browser keeps the cookie by which it is known this long; the server forgets it after the same time.
const DEVICE_KEPT: cookie::time::Duration = cookie::time::Duration::days(90);

/// The guard.
#[derive(Debug)]
pub struct Authenticator {
    visits: Mutex<BrowserSessions>,
    throttle: Mutex<LoginThrottle>,
    devices: Mutex<KnownBrowsers>,
    /// The queue for password hashing.
    pub hashing: HashingQueue,
    somebody_has_a_password: AtomicBool,
    secure: bool,
    reach: AllowedOrigins,
}

/// Where a login comes from.
#[derive(Debug, Clone, Copy)]
pub struct LoginClient<'a> {
    /// Address.
    pub from: IpAddr,
    /// Cookie of a browser that somebody has logged in with before.
    pub device: Option<&'a str>,
}

/// A visitor with his cookie, and the cookie to set when it is new.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identified {
    /// Who.
    pub visitor: Visitor,
    /// His cookie.
    pub cookie: String,
    /// To be set.
    pub fresh: bool,
}

impl Authenticator {
    /// A guard; `secure` says that all requests come over TLS.
    pub fn new(somebody_has_a_password: bool, secure: bool, reach: AllowedOrigins) -> Self {
        Self {
            visits: Mutex::default(),
            throttle: Mutex::default(),
            devices: Mutex::default(),
            hashing: HashingQueue::default(),
            somebody_has_a_password: AtomicBool::new(somebody_has_a_password),
            secure,
            reach,
        }
    }

    /// Checks where a request comes from, as [`AllowedOrigins::check_origin`].
    ///
    /// # Errors
    /// As [`AllowedOrigins::check_origin`].
    pub fn check_origin(&self, headers: &HeaderMap, changes: bool, open: bool) -> Result<(), WebError> {
        self.reach.check_origin(headers, changes, open)
    }

    /// Returns the client's address, as [`AllowedOrigins::address`].
    ///
    /// # Errors
    /// As [`AllowedOrigins::address`].
    pub fn address(&self, socket: IpAddr, headers: &HeaderMap) -> Result<IpAddr, WebError> {
        self.reach.address(socket, headers)
    }

    /// Requests come over TLS.
    pub fn is_secure(&self) -> bool {
        self.secure
    }

    /// From now on everybody has to log in.
    pub fn require_login(&self) {
        self.somebody_has_a_password.store(true, Ordering::SeqCst);
    }

    /// Nobody has a password: whoever reaches the server does everything.
    ///
    /// # Errors
    /// If the database fails.
    pub fn is_open(&self, database: &Database) -> Result<bool, AppError> {
        if self.somebody_has_a_password.load(Ordering::SeqCst) {
            return Ok(false);
        }
        // The command line may have set the first one meanwhile. Once closed the server stays so until it is started again.
        if !database.with_password()?.is_empty() {
            self.require_login();
            return Ok(false);
        }
        Ok(true)
    }

    /// Who sends this cookie. Without a living one a stranger's visit begins.
    ///
    /// # Errors
    /// When the database refuses or the system has no randomness.
    pub fn identify(&self, database: &Database, cookie: Option<String>) -> Result<Identified, WebError> {
        let open = self.is_open(database)?;
        let now_us = clock::unix_us();
        let found = cookie.and_then(|cookie| lock(&self.visits).find(&cookie, now_us).map(|visit| (cookie, visit)));
        // Asked for again with every request: who was degraded, erased or given another password is put out at once, whoever did it, here,
        // by another server or at the command line.
        let account = found.as_ref().and_then(|(_, visit)| visit.name.as_deref());
        let account = account.map(|name| database.account(name)).transpose()?.flatten();
        let over =
            |visit: &BrowserSession| visit.name.is_some() && visit.credential != account.as_ref().and_then(Account::credential);
        let found = match found {
            Some((cookie, visit)) if over(&visit) => {
                lock(&self.visits).end(&cookie);
                None
            }
            found => found,
        };
        let Some((cookie, visit)) = found else {
            let (cookie, visit) = lock(&self.visits).begin(None, secrets()?, now_us);
            return Ok(Identified { visitor: visitor(open, None, visit), cookie, fresh: true });
        };
        let person = account.map(|account| account.person);
        Ok(Identified { visitor: visitor(open, person, visit), cookie, fresh: false })
    }

    /// Logs in: checks name and password, ends the visit before, begins a new one. Returns the new cookie and that of the browser, which is
    /// known for this name from now on.
    ///
    /// # Errors
    /// When it has to wait, or name and password do not fit; which of the two is not told.
    pub fn log_in(
        &self,
        database: &Database,
        asked: (&str, &str),
        before: Option<&str>,
        client: &LoginClient<'_>,
    ) -> Result<(String, String), WebError> {
        let (name, password) = asked;
        let account = self.check(database, name, password, client)?;
        let credential = account.credential().ok_or_else(wrong_credentials)?;
        let now_us = clock::unix_us();
        let [secret, _] = secrets()?;
        let device = lock(&self.devices).remember(client.device, name, &secret, now_us);
        let mut visits = lock(&self.visits);
        before.iter().for_each(|cookie| visits.end(cookie));
        let (cookie, _) = visits.begin(Some((name, credential)), secrets()?, now_us);
        Ok((cookie, device))
    }

    /// Checks a password, within the limits on failures. Returns whose it is, as it was when it fitted.
    ///
    /// # Errors
    /// As [`Self::log_in`].
    pub fn check(&self, database: &Database, name: &str, password: &str, client: &LoginClient<'_>) -> Result<Account, WebError> {
        let now_us = clock::unix_us();
        let known = client.device.and_then(|cookie| lock(&self.devices).find(cookie, name, now_us));
        let from = LoginOrigin::for_address(client.from, known);
        if let Some(wait_us) = lock(&self.throttle).wait_us(from, name, now_us) {
            return Err(WebError::RateLimited(wait_us.div_ceil(1_000_000)));
        }
        // A full queue refuses before the failure counts: a flood from elsewhere must not lock anybody out.
        let turn = self.hashing.acquire()?;
        // Counted before the slow part, so that a flood at once is a flood, too.
        lock(&self.throttle).record_failure(from, name, now_us);
        let account = database.account(name)?;
        let hash = account.as_ref().and_then(|account| account.hash.as_deref());
        if !turn.verify(password, hash) {
            tracing::info!("a login from {} failed", client.from);
            return Err(wrong_credentials());
        }
        lock(&self.throttle).clear_failures(from, name);
        account.ok_or_else(wrong_credentials)
    }

    /// Ends a visit.
    pub fn log_out(&self, cookie: Option<&str>) {
        cookie.iter().for_each(|cookie| lock(&self.visits).end(cookie));
    }

    /// Ends all visits of a person but that of one cookie.
    pub fn end_other_sessions(&self, name: &str, but: Option<&str>) {
        lock(&self.visits).end_all_of(name, but);
    }

    /// The visit of a cookie goes on under this account's new password or role.
    pub fn renew(&self, cookie: Option<&str>, account: &Account) {
        if let (Some(cookie), Some(credential)) = (cookie, account.credential()) {
            lock(&self.visits).renew(cookie, credential);
        }
    }

    /// The token of a form is the visitor's.
    ///
    /// # Errors
    /// When it is not: another site's form, or one from before a login.
    pub fn check_token(visitor: &Visitor, given: Option<&str>) -> Result<(), WebError> {
        if given.is_some_and(|given| constant_time_eq(given, &visitor.token)) {
            return Ok(());
        }
        Err(WebError::Forbidden("This form is not of this visit. Please open its page again and send it once more.".into()))
    }

    /// Name of our cookie.
    fn cookie_name(&self) -> &'static str {
        if self.secure { "__Host-spandrel" } else { "spandrel" }
    }

    /// Name of the cookie of a known browser.
    fn device_name(&self) -> &'static str {
        if self.secure { "__Host-spandrel-device" } else { "spandrel-device" }
    }

    /// Our cookie's value in a request.
    pub fn cookie_of(&self, headers: &HeaderMap) -> Option<String> {
        value_of(headers, self.cookie_name())
    }

    /// The value of a known browser's cookie in a request.
    pub fn device_of(&self, headers: &HeaderMap) -> Option<String> {
        value_of(headers, self.device_name())
    }

    /// The cookie of a known browser, to be set. It opens nothing: it only counts failed logins apart.
    pub fn device_cookie(&self, value: &str) -> String {
        let built = cookie::Cookie::build((self.device_name(), value)).path("/").http_only(true).secure(self.secure);
        built.same_site(cookie::SameSite::Strict).max_age(DEVICE_KEPT).build().to_string()
    }

    /// Our cookie, to be set. Lax, for with Strict a link in a mail would come without it and be given a stranger's in its place: logged
    /// out by a link. What changes something has a form's token and is asked where it comes from.
    pub fn cookie(&self, value: &str) -> String {
        let built = cookie::Cookie::build((self.cookie_name(), value)).path("/").http_only(true).secure(self.secure);
        built.same_site(cookie::SameSite::Lax).build().to_string()
    }
}

fn value_of(headers: &HeaderMap, name: &str) -> Option<String> {
    let all = headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
    let mut pairs = all.flat_map(cookie::Cookie::split_parse).flatten();
    pairs.find(|cookie| cookie.name() == name).map(|cookie| cookie.value().to_owned())
}

fn wrong_credentials() -> WebError {
    WebError::Forbidden("Name and password do not fit.".into())
}

fn visitor(open: bool, person: Option<Trainee>, visit: BrowserSession) -> Visitor {
    let role = if open { Role::Administrator } else { person.as_ref().map_or(Role::Trainee, |person| person.role) };
    Visitor { name: person.map(|person| person.pseudonym), role, open, token: visit.token }
}

fn secrets() -> Result<[TokenBytes; 2], WebError> {
    let mut secrets = [[0; 32]; 2];
    for secret in &mut secrets {
        getrandom::fill(secret).map_err(|error| WebError::Failed(format!("the system has no randomness: {error}")))?;
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
    fn exact_cookies_are_out_of_scripts_reach_and_stay_with_a_link() {
        let plain = Authenticator::new(true, false, AllowedOrigins::default()).cookie("v");
        assert_eq!(plain, "spandrel=v; HttpOnly; SameSite=Lax; Path=/");
        let guard = Authenticator::new(true, true, AllowedOrigins::default());
        let cookie = guard.cookie("v");
        assert!(cookie.starts_with("__Host-spandrel=v;") && cookie.contains("Secure"), "{cookie}");
        assert_eq!(guard.cookie_of(&headers(&[("cookie", "a=b; __Host-spandrel=xyz; spandrel=no")])), Some("xyz".into()));
        assert_eq!(guard.cookie_of(&headers(&[])), None);
        let device = guard.device_cookie("v");
        assert!(device.starts_with("__Host-spandrel-device=v; HttpOnly; SameSite=Strict; Secure;"), "{device}");
        assert!(device.contains("Max-Age=7776000"), "{device}");
    }
}
