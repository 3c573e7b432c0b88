//! Style and scripts.

use super::answer::{Answer, Answered, Refusal};
use super::asked::Asked;
use super::state::State;
use spandrel_training::web::assets;

/// A file of ours.
pub fn file(_: &State, asked: &Asked) -> Answered {
    let (text, kind) = assets::file(asked.part("name")).ok_or(Refusal::NotFound)?;
    Ok(Answer::asset(kind, text))
}
