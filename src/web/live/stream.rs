//! Streams live values as server-sent events.

use super::vehicle::LiveVehicle;
use crate::web::state::ServerState;
use axum::body::Body;
use axum::http::{Response, header};
use axum::response::IntoResponse;
use axum::response::sse::{Event, KeepAlive, Sse};
use spandrel_text::Language;
use spandrel_training::web::access::AccessLevel;
use std::convert::Infallible;
use std::sync::Arc;

/// Number of events between checks of the visitor's access.
const ACCESS_CHECK_INTERVAL: u32 = 50;

/// Streams the values in a language until the browser disconnects or the visitor loses access.
pub fn stream(state: Arc<ServerState>, live: &LiveVehicle, (cookie, language): (Option<String>, Language)) -> Response<Body> {
    let moments = live.moments.clone();
    let events =
        futures_util::stream::unfold((moments, state, cookie, 0u32), move |(mut moments, state, cookie, count)| async move {
            // The first value is sent immediately.
            if count > 0 {
                moments.changed().await.ok()?;
            }
            if count % ACCESS_CHECK_INTERVAL == ACCESS_CHECK_INTERVAL - 1 && !still_has_access(&state, cookie.clone()).await {
                return None;
            }
            let text = moments.borrow_and_update().get(language).clone();
            Some((Ok::<Event, Infallible>(Event::default().data(text)), (moments, state, cookie, count.wrapping_add(1))))
        });
    let mut response = Sse::new(events).keep_alive(KeepAlive::default()).into_response();
    response.headers_mut().insert(header::CACHE_CONTROL, header::HeaderValue::from_static("no-store"));
    response
}

async fn still_has_access(state: &Arc<ServerState>, cookie: Option<String>) -> bool {
    let state = state.clone();
    let looked = tokio::task::spawn_blocking(move || state.auth.identify(&state.database, cookie)).await;
    looked.is_ok_and(|recognized| {
        recognized.is_ok_and(|recognized| !recognized.is_new && recognized.visitor.satisfies(AccessLevel::Instructor))
    })
}
