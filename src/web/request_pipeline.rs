//! Request pipeline. It identifies the visitor of every request, authorizes the request and checks its form token. Then
//! the route's handler runs on a thread that may block on disk and database access.

use super::auth::{IdentifiedVisitor, cookie_value};
use super::body;
use super::live;
use super::request::WebRequest;
use super::response::{HandlerResult, WebError, WebResponse, set_security_headers};
use super::routes::{Route, RouteKind, STREAM_PATH};
use super::state::ServerState;
use axum::RequestExt;
use axum::body::Body;
use axum::extract::{ConnectInfo, Path, Request};
use axum::http::{HeaderMap, Method, Response, header};
use spandrel_text::Language;
use spandrel_training::web::access::AccessLevel;
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
    let head = match parse_head(&shared, route, &mut request).await {
        Ok(head) => head,
        Err(refusal) => return error_response(&shared, None, &refusal),
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
        Err(refusal) => error_response(&shared, Some(&visitor), &refusal),
    };
    if let Some(cookie) = cookie.and_then(|cookie| cookie.parse().ok())
        && !response.headers().contains_key(header::SET_COOKIE)
    {
        response.headers_mut().insert(header::SET_COOKIE, cookie);
    }
    response
}

/// Cookie with the tag of the language that the visitor has selected.
pub const LANGUAGE_COOKIE: &str = "spandrel-language";

async fn parse_head(shared: &PipelineState, route: &'static Route, request: &mut Request) -> Result<RequestHead, WebError> {
    let path = request.extract_parts::<Path<BTreeMap<String, String>>>().await;
    let path = path.map_err(|_| WebError::NotFound)?.0;
    let headers = request.headers().clone();
    let socket = request.extensions().get::<ConnectInfo<SocketAddr>>().map(|info| info.0.ip());
    let query = request.uri().query().unwrap_or_default();
    let query = form_urlencoded::parse(query.as_bytes()).into_owned().collect();
    let state = shared.state.clone();
    let changes = !route.kind.is_read_only();
    let anonymous = matches!(route.kind, RouteKind::File | RouteKind::StationMessage);
    blocking(move || {
        let open = state.auth.has_no_passwords(&state.database)?;
        state.auth.check_origin(&headers, changes, open)?;
        let from =
            state.auth.address(socket.ok_or_else(|| WebError::Failed("the request has no client address".into()))?, &headers)?;
        let recognized =
            if anonymous { None } else { Some(state.auth.identify(&state.database, state.auth.session_cookie_from(&headers))?) };
        let mut visitor = recognized.as_ref().map_or_else(anonymous_visitor, |recognized| recognized.visitor.clone());
        let cookie = recognized.as_ref().map(|recognized| recognized.cookie.clone());
        let device = state.auth.browser_cookie_from(&headers);
        let expects_json = accepts_json(&headers);
        let text = |name| headers.get(name).and_then(|value| value.to_str().ok()).map(str::to_owned);
        let (languages, range) = (text(header::ACCEPT_LANGUAGE).unwrap_or_default(), text(header::RANGE));
        visitor.language = language_from(&headers, &languages);
        let authorization = text(header::AUTHORIZATION);
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
            expects_json,
        };
        Ok(RequestHead { request: web_request, identity: recognized })
    })
    .await
}

fn anonymous_visitor() -> spandrel_training::web::access::Visitor {
    spandrel_training::web::access::Visitor {
        name: None,
        role: spandrel_training::trainee::Role::Trainee,
        open: false,
        token: String::new(),
        language: Language::default(),
    }
}

/// Returns the language that the visitor has selected, or else the one that the browser prefers.
fn language_from(headers: &HeaderMap, accepted: &str) -> Language {
    let selected = cookie_value(headers, LANGUAGE_COOKIE).and_then(|tag| Language::from_tag(&tag));
    selected.or_else(|| Language::accepted(accepted)).unwrap_or_default()
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
    let who = if route.required_access == AccessLevel::Administrator { "administrators" } else { "instructors" };
    Err(WebError::Forbidden(format!("This page is for {who} only.")))
}

/// Runs a function that may block on disk or database access.
async fn blocking<T: Send + 'static>(work: impl FnOnce() -> Result<T, WebError> + Send + 'static) -> Result<T, WebError> {
    let done = tokio::task::spawn_blocking(work).await;
    done.unwrap_or_else(|_| Err(WebError::Failed("a request handler panicked: please report this bug".into())))
}

fn error_response(
    shared: &PipelineState,
    visitor: Option<&spandrel_training::web::access::Visitor>,
    refusal: &WebError,
) -> Response<Body> {
    if let WebError::Failed(words) = refusal {
        tracing::error!("{words}");
    }
    if *refusal == WebError::LoginRequired {
        return WebResponse::redirect("/login").into_response();
    }
    let (status, title, words) = refusal.status_and_text();
    let visitor = visitor.cloned().unwrap_or_else(anonymous_visitor);
    let page = WebResponse::page(layout::refusal(&visitor, title, &words)).with_status(status);
    let mut response = page.retry_after(refusal.retry_after_s()).into_response();
    set_security_headers(response.headers_mut(), shared.state.auth.is_secure());
    response
}

/// Handles a request for a path that is not in the route table.
pub async fn handle_unknown_path(shared: PipelineState, request: Request) -> Response<Body> {
    let status = if request.method() == Method::GET || request.method() == Method::HEAD {
        WebError::NotFound
    } else {
        WebError::Forbidden("This page does not accept changes.".into())
    };
    error_response(&shared, None, &status)
}

/// Streams live values while the browser is connected and the visitor has access.
pub async fn live_stream(shared: PipelineState, mut request: Request) -> Response<Body> {
    static ROUTE: Route = Route {
        path: STREAM_PATH,
        kind: RouteKind::Show,
        required_access: AccessLevel::Instructor,
        handler: unreachable_handler,
    };
    let head = match parse_head(&shared, &ROUTE, &mut request).await {
        Ok(head) => head,
        Err(refusal) => return error_response(&shared, None, &refusal),
    };
    if let Err(refusal) = authorize(&head.request, &ROUTE) {
        let refusal =
            if refusal == WebError::LoginRequired { WebError::Forbidden("Please log in first.".into()) } else { refusal };
        return error_response(&shared, Some(&head.request.visitor), &refusal);
    }
    let cookie = head.request.cookie.clone();
    let mut response = match live::select_vehicle(&shared.state, head.request.query_param("vehicle")) {
        Ok((_, live)) => live::stream(shared.state.clone(), live, cookie),
        Err(refusal) => return error_response(&shared, Some(&head.request.visitor), &refusal),
    };
    set_security_headers(response.headers_mut(), shared.state.auth.is_secure());
    response
}

fn unreachable_handler(_: &ServerState, _: &WebRequest) -> HandlerResult {
    Err(WebError::NotFound)
}
