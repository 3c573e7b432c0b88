//! The door: sockets and HTTP. Every request goes the same way: who is it, may he, is the form his, then the row's handler, on a thread that
//! may wait for disk and database.

use super::answer::{Answer, Answered, Refusal, harden};
use super::asked::{Asked, Upload};
use super::guard::{Guard, Recognised};
use super::live;
use super::routes::{FORM_MOST, How, ROUTES, Route, STREAM};
use super::state::{Setup, State};
use super::{ListenArgs, tls};
use crate::app::errors::AppError;
use crate::app::stop::Stop;
use crate::web::access::Needs;
use crate::web::frame;
use axum::body::{Body, to_bytes};
use axum::extract::{ConnectInfo, DefaultBodyLimit, FromRequest, Multipart, Path, Request};
use axum::http::{HeaderMap, Method, Response, header};
use axum::routing::{MethodRouter, get, post};
use axum::{RequestExt, Router};
use axum_server::Handle;
use std::collections::BTreeMap;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;
use tokio::sync::Semaphore;

/// A browser has this long to send the head of a request, and a form.
const FORM_WAIT: Duration = Duration::from_secs(30);
/// And this long for a recording, over a slow line.
const UPLOAD_WAIT: Duration = Duration::from_secs(600);
/// Uploads that are held in memory at once.
const UPLOADS: usize = 2;
/// What is under way when the server ends has this long.
const FAREWELL: Duration = Duration::from_secs(2);
/// Between two looks whether to end.
const LOOK: Duration = Duration::from_millis(50);
/// Threads that wait for disk and database.
const WAITING_THREADS: usize = 16;

/// A running server; it ends when it is dropped.
#[derive(Debug)]
pub struct Server {
    address: String,
    handle: Handle<SocketAddr>,
    thread: Option<JoinHandle<()>>,
}

/// What the requests' tasks share.
#[derive(Debug, Clone)]
struct Shared {
    state: Arc<State>,
    uploads: Arc<Semaphore>,
}

impl Server {
    /// Opens the port and serves.
    ///
    /// # Errors
    /// When arguments, files, the port or the database are wrong.
    pub fn start(args: &ListenArgs, setup: Setup) -> Result<Self, AppError> {
        let secure = args.tls_cert.is_some() || args.behind_proxy;
        let tls = tls::config(args)?;
        let state = State::open(setup, secure, args.behind_proxy)?;
        tls::check(args, !state.database.with_password()?.is_empty())?;
        let taken = |error: std::io::Error| AppError::failed(format!("--listen {}: cannot be opened: {error}", args.listen));
        let listener = TcpListener::bind(args.listen).map_err(taken)?;
        listener.set_nonblocking(true).map_err(taken)?;
        let bound = listener.local_addr().map_err(taken)?;
        let address = format!("{}://{bound}", if tls.is_some() { "https" } else { "http" });
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .max_blocking_threads(WAITING_THREADS)
            .enable_all()
            .build()
            .map_err(|error| AppError::failed(format!("no runtime for the server: {error}")))?;
        let handle = Handle::new();
        let shared = Shared { state: Arc::new(state), uploads: Arc::new(Semaphore::new(UPLOADS)) };
        let (router, own) = (router(&shared), handle.clone());
        let thread = std::thread::spawn(move || {
            let ended = runtime.block_on(serve(listener, tls, own, router));
            if let Err(error) = ended {
                tracing::error!("the server ended: {error}");
            }
            // Streams and slow handlers are not waited for.
            runtime.shutdown_background();
        });
        Ok(Self { address, handle, thread: Some(thread) })
    }

    /// Where a browser finds it.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Serves until somebody asks to stop.
    pub fn until(&self, stop: &Stop) {
        while !stop.asked() && self.thread.as_ref().is_some_and(|thread| !thread.is_finished()) {
            std::thread::sleep(LOOK);
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.handle.graceful_shutdown(Some(FAREWELL));
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the server's thread broke off: this is a fault of the program");
        }
    }
}

async fn serve(
    listener: TcpListener,
    tls: Option<axum_server::tls_rustls::RustlsConfig>,
    handle: Handle<SocketAddr>,
    router: Router,
) -> std::io::Result<()> {
    let service = router.into_make_service_with_connect_info::<SocketAddr>();
    match tls {
        Some(tls) => {
            let mut server = axum_server::from_tcp_rustls(listener, tls)?.handle(handle);
            limit(server.http_builder());
            server.serve(service).await
        }
        None => {
            let mut server = axum_server::from_tcp(listener)?.handle(handle);
            limit(server.http_builder());
            server.serve(service).await
        }
    }
}

/// Who opens connections and says nothing is put out.
fn limit(builder: &mut hyper_util::server::conn::auto::Builder<hyper_util::rt::TokioExecutor>) {
    builder.http1().timer(hyper_util::rt::TokioTimer::new()).header_read_timeout(FORM_WAIT);
}

fn router(shared: &Shared) -> Router {
    let mut router = Router::new();
    for route in ROUTES {
        router = router.route(route.path, method(route, shared));
    }
    let stream = shared.clone();
    router = router.route(STREAM, get(move |request: Request| live_stream(stream.clone(), request)));
    let (lost, wrong) = (shared.clone(), shared.clone());
    router
        .fallback(move |request: Request| nothing(lost.clone(), request))
        .method_not_allowed_fallback(move |request: Request| nothing(wrong.clone(), request))
}

fn method(route: &'static Route, shared: &Shared) -> MethodRouter {
    let shared = shared.clone();
    let handle = move |request: Request| {
        let shared = shared.clone();
        async move {
            let secure = shared.state.guard.is_secure();
            let mut response = asked(shared, route, request).await;
            harden(response.headers_mut(), secure);
            response
        }
    };
    match route.how {
        How::File | How::Show => get(handle),
        How::Change => post(handle),
        // The fields beside the file need room, too.
        How::Upload(most) => post(handle).layer(DefaultBodyLimit::max(most + FORM_MOST)),
    }
}

/// What a request says before its body is read.
struct Head {
    asked: Asked,
    recognised: Option<Recognised>,
}

async fn asked(shared: Shared, route: &'static Route, mut request: Request) -> Response<Body> {
    let head = match head(&shared, route, &mut request).await {
        Ok(head) => head,
        Err(refusal) => return refused(&shared, None, &refusal),
    };
    let Head { mut asked, recognised } = head;
    let cookie = recognised.filter(|recognised| recognised.fresh).map(|recognised| shared.state.guard.cookie(&recognised.cookie));
    let visitor = asked.visitor.clone();
    let answered = async {
        admit(&asked, route)?;
        let _room = match route.how {
            How::Upload(_) => Some(shared.uploads.acquire().await.map_err(|_| Refusal::Failed("the server ends".into()))?),
            How::File | How::Show | How::Change => None,
        };
        read_body(&mut asked, route.how, request).await?;
        let state = shared.state.clone();
        blocking(move || (route.handler)(&state, &asked)).await
    }
    .await;
    let mut response = match answered {
        Ok(answer) => answer.into_response(),
        Err(refusal) => refused(&shared, Some(&visitor), &refusal),
    };
    if let Some(cookie) = cookie.and_then(|cookie| cookie.parse().ok())
        && !response.headers().contains_key(header::SET_COOKIE)
    {
        response.headers_mut().insert(header::SET_COOKIE, cookie);
    }
    response
}

async fn head(shared: &Shared, route: &'static Route, request: &mut Request) -> Result<Head, Refusal> {
    let path = request.extract_parts::<Path<BTreeMap<String, String>>>().await;
    let path = path.map_err(|_| Refusal::NotFound)?.0;
    let headers = request.headers().clone();
    let socket = request.extensions().get::<ConnectInfo<SocketAddr>>().map(|info| info.0.ip());
    let query = request.uri().query().unwrap_or_default();
    let query = form_urlencoded::parse(query.as_bytes()).into_owned().collect();
    let state = shared.state.clone();
    let changes = !matches!(route.how, How::File | How::Show);
    let file = route.how == How::File;
    blocking(move || {
        let open = state.guard.is_open(&state.database)?;
        state.guard.check_origin(&headers, changes, open)?;
        let from = state.guard.address(socket.ok_or_else(|| Refusal::Failed("a request from nowhere".into()))?, &headers);
        let recognised = if file { None } else { Some(state.guard.recognise(&state.database, state.guard.cookie_of(&headers))?) };
        let visitor = recognised.as_ref().map_or_else(nobody, |recognised| recognised.visitor.clone());
        let cookie = recognised.as_ref().map(|recognised| recognised.cookie.clone());
        let by_script = accepts_json(&headers);
        let asked = Asked { visitor, cookie, from, path, query, form: Vec::new(), upload: None, by_script };
        Ok(Head { asked, recognised })
    })
    .await
}

fn nobody() -> crate::web::access::Visitor {
    crate::web::access::Visitor { name: None, role: crate::training::trainee::Role::Trainee, open: false, token: String::new() }
}

fn accepts_json(headers: &HeaderMap) -> bool {
    headers.get(header::ACCEPT).is_some_and(|value| value.as_bytes() == b"application/json")
}

/// The visitor may ask this.
fn admit(asked: &Asked, route: &Route) -> Result<(), Refusal> {
    if asked.visitor.meets(route.needs) {
        return Ok(());
    }
    if !asked.visitor.is_known() {
        return Err(Refusal::Stranger);
    }
    let who = if route.needs == Needs::Administrator { "administrators" } else { "instructors" };
    Err(Refusal::Forbidden(format!("This is for {who}.")))
}

async fn read_body(asked: &mut Asked, how: How, request: Request) -> Result<(), Refusal> {
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

/// Runs what may wait for disk or database.
async fn blocking<T: Send + 'static>(work: impl FnOnce() -> Result<T, Refusal> + Send + 'static) -> Result<T, Refusal> {
    let done = tokio::task::spawn_blocking(work).await;
    done.unwrap_or_else(|_| Err(Refusal::Failed("a handler broke off: this is a fault of the program".into())))
}

fn refused(shared: &Shared, visitor: Option<&crate::web::access::Visitor>, refusal: &Refusal) -> Response<Body> {
    if let Refusal::Failed(words) = refusal {
        tracing::error!("{words}");
    }
    if *refusal == Refusal::Stranger {
        return Answer::to("/login").into_response();
    }
    let (status, title, words) = refusal.told();
    let visitor = visitor.cloned().unwrap_or_else(nobody);
    let mut response = Answer::page(frame::refusal(&visitor, title, &words)).with_status(status).into_response();
    harden(response.headers_mut(), shared.state.guard.is_secure());
    response
}

/// What is not in the table.
async fn nothing(shared: Shared, request: Request) -> Response<Body> {
    let status = if request.method() == Method::GET || request.method() == Method::HEAD {
        Refusal::NotFound
    } else {
        Refusal::Forbidden("There is nothing to change here.".into())
    };
    refused(&shared, None, &status)
}

/// Live values, as long as the browser listens and the visitor may.
async fn live_stream(shared: Shared, mut request: Request) -> Response<Body> {
    static ROUTE: Route = Route { path: STREAM, how: How::Show, needs: Needs::Instructor, handler: not_called };
    let head = match head(&shared, &ROUTE, &mut request).await {
        Ok(head) => head,
        Err(refusal) => return refused(&shared, None, &refusal),
    };
    if let Err(refusal) = admit(&head.asked, &ROUTE) {
        let refusal = if refusal == Refusal::Stranger { Refusal::Forbidden("Please log in first.".into()) } else { refusal };
        return refused(&shared, Some(&head.asked.visitor), &refusal);
    }
    let cookie = head.asked.cookie.clone();
    let mut response = live::stream(shared.state.clone(), cookie);
    harden(response.headers_mut(), shared.state.guard.is_secure());
    response
}

fn not_called(_: &State, _: &Asked) -> Answered {
    Err(Refusal::NotFound)
}
