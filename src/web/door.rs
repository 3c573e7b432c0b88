//! The door. Every request goes the same way: who is it, may he, is the form his, then the row's handler, on a thread that
//! may wait for disk and database.

use super::answer::{Answer, Answered, Refusal, harden};
use super::asked::Asked;
use super::body;
use super::guard::Recognised;
use super::live;
use super::routes::{How, Route, STREAM};
use super::state::State;
use axum::RequestExt;
use axum::body::Body;
use axum::extract::{ConnectInfo, Path, Request};
use axum::http::{HeaderMap, Method, Response, header};
use spandrel_training::web::access::Needs;
use spandrel_training::web::frame;
use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::sync::Semaphore;

/// A client that found no room may try again after this, s.
const BUSY_S: u64 = 5;

/// What the requests' tasks share.
#[derive(Debug, Clone)]
pub struct Shared {
    /// What all requests share.
    pub state: Arc<State>,
    /// Room for uploads that arrive.
    pub uploads: Arc<Semaphore>,
    /// Held while a recording is scored or a cohort's figures are computed; who waits for it holds no thread.
    pub working: Arc<Semaphore>,
}

/// A request for a row of the table.
pub async fn through(shared: Shared, route: &'static Route, request: Request) -> Response<Body> {
    let secure = shared.state.guard.is_secure();
    let mut response = asked(shared, route, request).await;
    harden(response.headers_mut(), secure);
    response
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
            How::Upload(_) => Some(shared.uploads.try_acquire().map_err(|_| Refusal::Busy(BUSY_S))?),
            How::File | How::Show | How::Compute | How::Change => None,
        };
        body::read(&mut asked, route.how, request, &shared.state.spool()).await?;
        let turn = match route.how {
            How::Upload(_) | How::Compute => {
                Some(shared.working.clone().acquire_owned().await.map_err(|_| Refusal::Failed("the server ends".into()))?)
            }
            How::File | How::Show | How::Change => None,
        };
        let state = shared.state.clone();
        blocking(move || {
            // The handler goes on when its client leaves, and keeps its turn.
            let _turn = turn;
            (route.handler)(&state, &asked)
        })
        .await
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
    let changes = !route.how.only_looks();
    let file = route.how == How::File;
    blocking(move || {
        let open = state.guard.is_open(&state.database)?;
        state.guard.check_origin(&headers, changes, open)?;
        let from = state.guard.address(socket.ok_or_else(|| Refusal::Failed("a request from nowhere".into()))?, &headers)?;
        let recognised = if file { None } else { Some(state.guard.recognise(&state.database, state.guard.cookie_of(&headers))?) };
        let visitor = recognised.as_ref().map_or_else(nobody, |recognised| recognised.visitor.clone());
        let cookie = recognised.as_ref().map(|recognised| recognised.cookie.clone());
        let device = state.guard.device_of(&headers);
        let by_script = accepts_json(&headers);
        let languages = headers.get(header::ACCEPT_LANGUAGE).and_then(|value| value.to_str().ok()).unwrap_or_default().to_owned();
        let asked = Asked { visitor, cookie, from, device, path, query, form: Vec::new(), upload: None, languages, by_script };
        Ok(Head { asked, recognised })
    })
    .await
}

fn nobody() -> spandrel_training::web::access::Visitor {
    spandrel_training::web::access::Visitor {
        name: None,
        role: spandrel_training::trainee::Role::Trainee,
        open: false,
        token: String::new(),
    }
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

/// Runs what may wait for disk or database.
async fn blocking<T: Send + 'static>(work: impl FnOnce() -> Result<T, Refusal> + Send + 'static) -> Result<T, Refusal> {
    let done = tokio::task::spawn_blocking(work).await;
    done.unwrap_or_else(|_| Err(Refusal::Failed("a handler broke off: this is a fault of the program".into())))
}

fn refused(shared: &Shared, visitor: Option<&spandrel_training::web::access::Visitor>, refusal: &Refusal) -> Response<Body> {
    if let Refusal::Failed(words) = refusal {
        tracing::error!("{words}");
    }
    if *refusal == Refusal::Stranger {
        return Answer::to("/login").into_response();
    }
    let (status, title, words) = refusal.told();
    let visitor = visitor.cloned().unwrap_or_else(nobody);
    let page = Answer::page(frame::refusal(&visitor, title, &words)).with_status(status);
    let mut response = page.retry_after(refusal.retry_after_s()).into_response();
    harden(response.headers_mut(), shared.state.guard.is_secure());
    response
}

/// What is not in the table.
pub async fn nothing(shared: Shared, request: Request) -> Response<Body> {
    let status = if request.method() == Method::GET || request.method() == Method::HEAD {
        Refusal::NotFound
    } else {
        Refusal::Forbidden("There is nothing to change here.".into())
    };
    refused(&shared, None, &status)
}

/// Live values, as long as the browser listens and the visitor may.
pub async fn live_stream(shared: Shared, mut request: Request) -> Response<Body> {
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
    let mut response = match live::chosen(&shared.state, head.asked.word("vehicle")) {
        Ok((_, live)) => live::stream(shared.state.clone(), live, cookie),
        Err(refusal) => return refused(&shared, Some(&head.asked.visitor), &refusal),
    };
    harden(response.headers_mut(), shared.state.guard.is_secure());
    response
}

fn not_called(_: &State, _: &Asked) -> Answered {
    Err(Refusal::NotFound)
}
