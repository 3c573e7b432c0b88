//! Finds the person that a request is about.

use super::request::WebRequest;
use super::response::WebError;
use super::state::ServerState;
use spandrel_training::trainee::Trainee;

/// Returns the person named in the path, if the visitor may see them.
///
/// # Errors
/// Returns an error if there is no such person, or the visitor has no access to their data.
pub fn person(state: &ServerState, request: &WebRequest) -> Result<Trainee, WebError> {
    let name = request.path_param("name");
    request.check_access(name)?;
    state.database.account(name)?.map(|account| account.person).ok_or(WebError::NotFound)
}
