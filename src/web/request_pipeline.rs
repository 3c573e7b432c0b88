//! Request pipeline. It identifies the visitor of every request, authorizes the request and checks its form token. Then
//! the route's handler runs on a thread that may block on disk and database access.

use super::auth::{IdentifiedVisitor, LANGUAGE_COOKIE, cookie_value};
use super::body;
use super::live;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse, set_security_headers};
use super::routes::{Route, RouteKind, STREAM_PATH};
use super::state::ServerState;
use axum::RequestExt;
use axum::body::Body;
use axum::extract::{ConnectInfo, Path, Request};
use axum::http::{HeaderMap, HeaderName, Method, Response, header};
use spandrel_text::{Language, text};
use spandrel_training::trainee::Role;
use spandrel_training::web::access::{AccessLevel, Visitor};
use spandrel_training::web::layout;
use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::sync::Semaphore;

/// Retry-After value for a client that was rejected for lack of capacity, s.
const RETRY_AFTER_S: u64 = 5;

/// State shared by the tasks that handle requests.
#[derive(Debug, Clone)]
pub struct PipelineState {
    /// Server state.
    pub state: Arc<ServerState>,
    /// Limits the number of concurrent uploads.
    pub uploads: Arc<Semaphore>,
    /// Permit required to score a recording or compute cohort figures. Waiting for it does not occupy a thread.
    pub compute_permit: Arc<Semaphore>,
}

/// Handles a request for a route in the route table.
pub async fn handle_route(shared: PipelineState, route: &'static Route, request: Request) -> Response<Body> {
    let secure = shared.state.auth.is_secure();
    let mut response = run_route(shared, route, request).await;
    set_security_headers(response.headers_mut(), secure);
    response
}

/// A request before its body is read.
struct RequestHead {
    request: WebRequest,
    identity: Option<IdentifiedVisitor>,
}

async fn run_route(shared: PipelineState, route: &'static Route, mut request: Request) -> Response<Body> {
    let unknown = anonymous_visitor(&request);
    let head = match parse_head(&shared, route, &mut request).await {
        Ok(head) => head,
        Err(refusal) => return error_response(&shared, &unknown, &refusal),
    };
    let RequestHead { request: mut web_request, identity: recognized } = head;
    let cookie = recognized.filter(|recognized| recognized.is_new).map(|recognized| shared.state.auth.cookie(&recognized.cookie));
    let visitor = web_request.visitor.clone();
    let answered = async {
        authorize(&web_request, route)?;
        let _room = match route.kind {
            RouteKind::Upload(_) | RouteKind::Text(_) => {
                Some(shared.uploads.try_acquire().map_err(|_| WebError::Busy(RETRY_AFTER_S))?)
            }
            RouteKind::File | RouteKind::Show | RouteKind::Compute | RouteKind::Change | RouteKind::StationMessage => None,
        };
        body::read(&mut web_request, route.kind, request, &shared.state.spool()).await?;
        let turn = match route.kind {
            RouteKind::Upload(_) | RouteKind::Text(_) | RouteKind::Compute => Some(
                shared
                    .compute_permit
                    .clone()
                    .acquire_owned()
                    .await
                    .map_err(|_| WebError::Failed("the server is stopping".into()))?,
            ),
            RouteKind::File | RouteKind::Show | RouteKind::Change | RouteKind::StationMessage => None,
        };
        let state = shared.state.clone();
        blocking(move || {
            // If the client disconnects, the handler continues and keeps its permit.
            let _turn = turn;
            (route.handler)(&state, &web_request)
        })
        .await
    }
    .await;
    let mut response = match answered {
        Ok(answer) => answer.into_response(),
        Err(refusal) => error_response(&shared, &visitor, &refusal),
    };
    if let Some(cookie) = cookie.and_then(|cookie| cookie.parse().ok())
        && !response.headers().contains_key(header::SET_COOKIE)
    {
        response.headers_mut().insert(header::SET_COOKIE, cookie);
    }
    response
}

async fn parse_head(shared: &PipelineState, route: &'static Route, request: &mut Request) -> Result<RequestHead, WebError> {
    let path = request.extract_parts::<Path<BTreeMap<String, String>>>().await;
    let path = path.map_err(|_| WebError::NotFound)?.0;
    let headers = request.headers().clone();
    let socket = request.extensions().get::<ConnectInfo<SocketAddr>>().map(|info| info.0.ip());
    let query = request.uri().query().unwrap_or_default();
    let query = form_urlencoded::parse(query.as_bytes()).into_owned().collect();
    let state = shared.state.clone();
    let changes = !route.kind.is_read_only();
    let unidentified = matches!(route.kind, RouteKind::File | RouteKind::StationMessage);
    let anonymous = anonymous_visitor(request);
    blocking(move || {
        let open = state.auth.has_no_passwords(&state.database)?;
        let language = anonymous.language;
        state.auth.check_origin(&headers, changes, open, language)?;
        let socket = socket.ok_or_else(|| WebError::Failed("the request has no client address".into()))?;
        let from = state.auth.address(socket, &headers, language)?;
        let recognized = if unidentified {
            None
        } else {
            Some(state.auth.identify(&state.database, state.auth.session_cookie_from(&headers))?)
        };
        let address = anonymous.address.clone();
        let has_stations = state.station_key.is_some();
        let visitor = recognized.as_ref().map_or(anonymous, |recognized| Visitor {
            language,
            has_stations,
            address,
            ..recognized.visitor.clone()
        });
        let cookie = recognized.as_ref().map(|recognized| recognized.cookie.clone());
        let device = state.auth.browser_cookie_from(&headers);
        let expects_json = accepts_json(&headers);
        let (languages, range) = (preferred_languages(&headers), header_text(&headers, header::RANGE));
        let authorization = header_text(&headers, header::AUTHORIZATION);
        let scheme = if state.auth.is_secure() { "https" } else { "http" };
        let server = format!("{scheme}://{}", header_text(&headers, header::HOST).unwrap_or_default());
        let (form, upload, body) = (Vec::new(), None, Vec::new());
        let web_request = WebRequest {
            visitor,
            cookie,
            from,
            device,
            path,
            query,
            form,
            upload,
            languages,
            authorization,
            body,
            range,
            server,
            expects_json,
        };
        Ok(RequestHead { request: web_request, identity: recognized })
    })
    .await
}

/// Returns the visitor of a request that has not been identified yet, with their language.
fn anonymous_visitor(request: &Request) -> Visitor {
    let language = Language::accepted(&preferred_languages(request.headers())).unwrap_or_default();
    let shows = request.method() == Method::GET || request.method() == Method::HEAD;
    let address = request.uri().path_and_query().filter(|_| shows).map(ToString::to_string).unwrap_or_default();
    Visitor { name: None, role: Role::Trainee, open: false, token: String::new(), language, has_stations: false, address }
}

/// Returns the language that the visitor has selected, or else those that the browser prefers.
fn preferred_languages(headers: &HeaderMap) -> String {
    let selected = cookie_value(headers, LANGUAGE_COOKIE).and_then(|tag| Language::from_tag(&tag));
    let accepted = || header_text(headers, header::ACCEPT_LANGUAGE).unwrap_or_default();
    selected.map_or_else(accepted, |language| language.tag().to_owned())
}

fn header_text(headers: &HeaderMap, name: HeaderName) -> Option<String> {
    headers.get(name).and_then(|value| value.to_str().ok()).map(str::to_owned)
}

fn accepts_json(headers: &HeaderMap) -> bool {
    headers.get(header::ACCEPT).is_some_and(|value| value.as_bytes() == b"application/json")
}

/// Checks that the visitor has the route's access level.
fn authorize(web_request: &WebRequest, route: &Route) -> Result<(), WebError> {
    if web_request.visitor.satisfies(route.required_access) {
        return Ok(());
    }
    if !web_request.visitor.is_known() {
        return Err(WebError::LoginRequired);
    }
    let language = web_request.visitor.language;
    Err(WebError::Forbidden(match route.required_access {
        AccessLevel::Administrator => text!(language, "web-error-administrators"),
        AccessLevel::Public | AccessLevel::Login | AccessLevel::Instructor => text!(language, "web-error-instructors"),
    }))
}

/// Runs a function that may block on disk or database access.
async fn blocking<T: Send + 'static>(work: impl FnOnce() -> Result<T, WebError> + Send + 'static) -> Result<T, WebError> {
    let done = tokio::task::spawn_blocking(work).await;
    done.unwrap_or_else(|_| Err(WebError::Failed("a request handler panicked: please report this bug".into())))
}

fn error_response(shared: &PipelineState, visitor: &Visitor, refusal: &WebError) -> Response<Body> {
    if let WebError::Failed(words) = refusal {
        tracing::error!("{words}");
    }
    if *refusal == WebError::LoginRequired {
        return WebResponse::redirect("/login").into_response();
    }
    let (status, title, words) = refusal.status_and_text(visitor.language);
    let page = WebResponse::page(layout::refusal(visitor, &title, &words)).with_status(status);
    let mut response = page.retry_after(refusal.retry_after_s()).into_response();
    set_security_headers(response.headers_mut(), shared.state.auth.is_secure());
    response
}

/// Handles a request for a path that is not in the route table.
pub async fn handle_unknown_path(shared: PipelineState, request: Request) -> Response<Body> {
    let visitor = anonymous_visitor(&request);
    let status = if request.method() == Method::GET || request.method() == Method::HEAD {
        WebError::NotFound
    } else {
        WebError::Forbidden(text!(visitor.language, "web-error-no-changes"))
    };
    error_response(&shared, &visitor, &status)
}

/// Streams live values while the browser is connected and the visitor has access.
pub async fn live_stream(shared: PipelineState, mut request: Request) -> Response<Body> {
    static ROUTE: Route = Route {
        path: STREAM_PATH,
        kind: RouteKind::Show,
        required_access: AccessLevel::Instructor,
        handler: unreachable_handler,
    };
    let unknown = anonymous_visitor(&request);
    let head = match parse_head(&shared, &ROUTE, &mut request).await {
        Ok(head) => head,
        Err(refusal) => return error_response(&shared, &unknown, &refusal),
    };
    let visitor = &head.request.visitor;
    if let Err(refusal) = authorize(&head.request, &ROUTE) {
        let login = || WebError::Forbidden(text!(visitor.language, "web-error-login-text"));
        let refusal = if refusal == WebError::LoginRequired { login() } else { refusal };
        return error_response(&shared, visitor, &refusal);
    }
    let cookie = head.request.cookie.clone();
    let mut response = match live::select_vehicle(&shared.state, visitor.language, head.request.query_param("vehicle")) {
        Ok((_, live)) => live::stream(shared.state.clone(), live, (cookie, visitor.language)),
        Err(refusal) => return error_response(&shared, visitor, &refusal),
    };
    set_security_headers(response.headers_mut(), shared.state.auth.is_secure());
    response
}

fn unreachable_handler(_: &ServerState, _: &WebRequest) -> HandlerResult {
    Err(WebError::NotFound)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn visitor(method: &str, address: &str, headers: &[(&str, &str)]) -> Visitor {
        let mut request = Request::builder().method(method).uri(address);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        anonymous_visitor(&request.body(Body::empty()).unwrap())
    }

    #[test]
    fn exact_language_is_the_selected_one_or_that_of_the_browser() {
        let language = |headers: &[(&str, &str)]| visitor("GET", "/", headers).language;
        assert_eq!(language(&[]), Language::English);
        assert_eq!(language(&[("accept-language", "es-MX,es;q=0.9")]), Language::Spanish);
        assert_eq!(language(&[("accept-language", "es"), ("cookie", "spandrel-language=de")]), Language::German);
        assert_eq!(language(&[("accept-language", "es"), ("cookie", "spandrel-language=tlh")]), Language::Spanish);
        assert_eq!(language(&[("cookie", "spandrel-language=en-XA")]), Language::Pseudo);
    }

    #[test]
    fn exact_address_is_that_of_a_page() {
        assert_eq!(visitor("GET", "/sessions?page=2&trainee=a", &[]).address, "/sessions?page=2&trainee=a");
        assert_eq!(visitor("POST", "/account", &[]).address, "");
    }
}
