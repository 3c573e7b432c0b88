//! What a trainee sees of the own flight: the camera's picture. Map, cues and actions are the instructor's, for an assessment has none of them.

use super::{Live, picture};
use crate::web::answer::{Answer, Answered, Refusal};
use crate::web::asked::Asked;
use crate::web::state::{State, lock};
use serde_json::json;
use spandrel_training::web::live as pages;

/// The flight that this visitor flies just now.
fn flight<'a>(state: &'a State, asked: &Asked) -> Option<&'a Live> {
    let name = asked.visitor.name.as_ref()?;
    state.live.iter().find(|live| lock(&live.known.trainee).as_ref() == Some(name))
}

/// The page; it fills itself as soon as the visitor flies.
pub fn page(_: &State, asked: &Asked) -> Answered {
    Ok(Answer::page(pages::own(&asked.visitor)))
}

/// Whether the visitor flies, and the name of the picture that is there now.
pub fn now(state: &State, asked: &Asked) -> Answered {
    let flight = flight(state, asked);
    let version = flight.and_then(|live| live.picture.as_deref()).and_then(picture::version);
    Ok(Answer::json(&json!({ "flying": flight.is_some(), "picture": version })))
}

/// The picture.
pub fn camera(state: &State, asked: &Asked) -> Answered {
    picture::of(flight(state, asked).ok_or(Refusal::NotFound)?)
}
