//! The web server: its port, threads and axum router.

use super::auth::AllowedOrigins;
use super::listening::ListenConfig;
use super::request_pipeline::{self, PipelineState};
use super::routes::{MAX_FORM_BYTES, ROUTES, Route, RouteKind, STREAM_PATH};
use super::state::{ServerSetup, ServerState};
use super::tls;
use crate::errors::AppError;
use crate::io::stop::StopRequest;
use axum::Router;
use axum::extract::{DefaultBodyLimit, Request};
use axum::routing::{MethodRouter, get, post};
use axum_server::Handle;
use std::net::{SocketAddr, TcpListener};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;
use tokio::sync::Semaphore;

/// Time limit for a client to send a request header.
const HEADER_TIMEOUT: Duration = Duration::from_secs(30);
/// Maximum number of simultaneous uploads; each one uses up to `MAX_RECORDING_BYTES` of disk space. Estimate: a class
/// of thirty.
const MAX_UPLOADS: usize = 32;
/// Time limit for requests in progress when the server stops.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(2);
/// Interval at which stop requests are checked.
const STOP_CHECK_INTERVAL: Duration = Duration::from_millis(50);
/// Number of threads for blocking disk and database access.
const BLOCKING_THREADS: usize = 16;

/// A running server, stopped when it is dropped.
#[derive(Debug)]
pub struct WebServer {
    address: String,
    handle: Handle<SocketAddr>,
    thread: Option<JoinHandle<()>>,
}

impl WebServer {
    /// Opens the port and starts serving.
    ///
    /// # Errors
    /// Returns an error if arguments, files, the port or the database are invalid.
    pub fn start(args: &ListenConfig, setup: ServerSetup) -> Result<Self, AppError> {
        let secure = args.tls_cert.is_some() || args.behind_proxy;
        let tls = tls::config(args)?;
        let reach = if args.behind_proxy {
            AllowedOrigins::behind_proxies(&args.trusted_proxy, &args.host)
        } else {
            AllowedOrigins { hosts: args.host.clone(), ..AllowedOrigins::default() }
        };
        let state = ServerState::open(setup, secure, reach)?;
        tls::check(args, !state.database.names_with_password()?.is_empty())?;
        let taken = |error: std::io::Error| AppError::failed(format!("--listen {}: cannot open: {error}", args.listen));
        let listener = TcpListener::bind(args.listen).map_err(taken)?;
        listener.set_nonblocking(true).map_err(taken)?;
        let bound = listener.local_addr().map_err(taken)?;
        let address = format!("{}://{bound}", if tls.is_some() { "https" } else { "http" });
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .max_blocking_threads(BLOCKING_THREADS)
            .enable_all()
            .build()
            .map_err(|error| AppError::failed(format!("cannot start the server runtime: {error}")))?;
        let handle = Handle::new();
        let shared = PipelineState {
            state: Arc::new(state),
            uploads: Arc::new(Semaphore::new(MAX_UPLOADS)),
            compute_permit: Arc::new(Semaphore::new(1)),
        };
        let (router, own) = (router(&shared), handle.clone());
        let thread = std::thread::spawn(move || {
            let ended = runtime.block_on(serve(listener, tls, own, router));
            if let Err(error) = ended {
                tracing::error!("the server stopped: {error}");
            }
            // This does not wait for streams and slow handlers.
            runtime.shutdown_background();
        });
        Ok(Self { address, handle, thread: Some(thread) })
    }

    /// Returns the server's URL.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Serves until a stop is requested.
    pub fn serve_until(&self, stop: &StopRequest) {
        while !stop.is_requested() && self.thread.as_ref().is_some_and(|thread| !thread.is_finished()) {
            std::thread::sleep(STOP_CHECK_INTERVAL);
        }
    }
}

impl Drop for WebServer {
    fn drop(&mut self) {
        self.handle.graceful_shutdown(Some(SHUTDOWN_TIMEOUT));
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the server thread panicked: please report this bug");
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

/// Close connections that do not send a complete header in time.
fn limit(builder: &mut hyper_util::server::conn::auto::Builder<hyper_util::rt::TokioExecutor>) {
    builder.http1().timer(hyper_util::rt::TokioTimer::new()).header_read_timeout(HEADER_TIMEOUT);
}

fn router(shared: &PipelineState) -> Router {
    let mut router = Router::new();
    for route in ROUTES {
        router = router.route(route.path, method(route, shared));
    }
    let stream = shared.clone();
    router = router.route(STREAM_PATH, get(move |request: Request| request_pipeline::live_stream(stream.clone(), request)));
    let (lost, wrong) = (shared.clone(), shared.clone());
    router
        .fallback(move |request: Request| request_pipeline::handle_unknown_path(lost.clone(), request))
        .method_not_allowed_fallback(move |request: Request| request_pipeline::handle_unknown_path(wrong.clone(), request))
}

fn method(route: &'static Route, shared: &PipelineState) -> MethodRouter {
    let shared = shared.clone();
    let handle = move |request: Request| request_pipeline::handle_route(shared.clone(), route, request);
    match route.kind {
        RouteKind::File | RouteKind::Show | RouteKind::Compute => get(handle),
        RouteKind::Change | RouteKind::Text(_) | RouteKind::StationMessage => post(handle),
        // The form's other fields also need space.
        RouteKind::Upload(most) => post(handle).layer(DefaultBodyLimit::max(most + MAX_FORM_BYTES)),
    }
}
