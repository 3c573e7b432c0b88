//! Website visitors and their access rights.

use crate::trainee::Role;
use spandrel_text::Language;

/// Access level that a page or action requires.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AccessLevel {
    /// Everyone, including visitors who are not logged in.
    Public,
    /// Any logged-in user. Access to a trainee's data is checked by [`Visitor::may_see`].
    Login,
    /// Only instructors and administrators.
    Instructor,
    /// Only administrators.
    Administrator,
}

/// A website visitor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Visitor {
    /// Pseudonym; `None` if not logged in.
    pub name: Option<String>,
    /// Role; ignored if not logged in.
    pub role: Role,
    /// Whether access is unrestricted: no passwords are set, and the server is reachable only from this machine.
    pub open: bool,
    /// CSRF token included in every form.
    pub token: String,
    /// Language of the pages.
    pub language: Language,
    /// Whether the server accepts training stations, so that instructors can start flights there.
    pub has_stations: bool,
    /// Path and query of the requested page, which the language form shows again; empty if the request was a change.
    pub address: String,
}

impl Visitor {
    /// Returns whether the visitor is logged in or does not have to log in.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.open || self.name.is_some()
    }

    /// Returns whether the visitor has the required access level.
    #[must_use]
    pub fn satisfies(&self, needs: AccessLevel) -> bool {
        match needs {
            AccessLevel::Public => true,
            AccessLevel::Login => self.is_known(),
            AccessLevel::Instructor => self.is_known() && self.role >= Role::Instructor,
            AccessLevel::Administrator => self.is_known() && self.role >= Role::Administrator,
        }
    }

    /// Returns whether the visitor may see this trainee's data: their own, or all for instructors and administrators.
    #[must_use]
    pub fn may_see(&self, trainee: &str) -> bool {
        self.satisfies(AccessLevel::Instructor) || self.name.as_deref() == Some(trainee)
    }

    /// Returns the trainee that lists are restricted to; `None` for visitors who may see all.
    #[must_use]
    pub fn restricted_to(&self) -> Option<&str> {
        if self.satisfies(AccessLevel::Instructor) { None } else { Some(self.name.as_deref().unwrap_or_default()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn visitor(name: Option<&str>, role: Role, open: bool) -> Visitor {
        Visitor {
            name: name.map(str::to_owned),
            role,
            open,
            token: String::new(),
            language: Language::English,
            has_stations: false,
            address: String::new(),
        }
    }

    #[test]
    fn exact_each_role_has_its_permissions() {
        let all = [AccessLevel::Public, AccessLevel::Login, AccessLevel::Instructor, AccessLevel::Administrator];
        for (who, met) in [
            (visitor(None, Role::Administrator, false), [true, false, false, false]),
            (visitor(Some("a"), Role::Trainee, false), [true, true, false, false]),
            (visitor(Some("a"), Role::Instructor, false), [true, true, true, false]),
            (visitor(Some("a"), Role::Administrator, false), [true; 4]),
            (visitor(None, Role::Administrator, true), [true; 4]),
        ] {
            assert_eq!(all.map(|needs| who.satisfies(needs)), met, "{who:?}");
        }
    }

    #[test]
    fn exact_trainees_see_only_their_own_sessions() {
        let anna = visitor(Some("anna"), Role::Trainee, false);
        assert!(anna.may_see("anna") && !anna.may_see("ben") && !anna.may_see(""));
        assert_eq!(anna.restricted_to(), Some("anna"));
        let stranger = visitor(None, Role::Trainee, false);
        assert!(!stranger.may_see("anna") && !stranger.may_see(""));
        assert_eq!(visitor(Some("i"), Role::Instructor, false).restricted_to(), None);
    }
}
