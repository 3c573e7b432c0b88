//! Who is asking, and what he may do.

use crate::trainee::Role;

/// Who may open a page or act.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AccessLevel {
    /// Anybody, logged in or not.
    Nothing,
    /// Whoever is logged in; what belongs to a trainee is judged by [`Visitor::may_see`].
    Login,
    /// Instructors and administrators.
    Instructor,
    /// Administrators.
    Administrator,
}

/// Who is asking.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Visitor {
    /// Pseudonym; `None` for a stranger.
    pub name: Option<String>,
    /// What he may do; a stranger's does not count.
    pub role: Role,
    /// Nobody has a password and the server is reached from this machine alone: whoever sits here does everything.
    pub open: bool,
    /// Goes with every form, so that no other site can send one.
    pub token: String,
}

impl Visitor {
    /// Logged in, or in no need to be.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.open || self.name.is_some()
    }

    /// Meets what a page needs.
    #[must_use]
    pub fn satisfies(&self, needs: AccessLevel) -> bool {
        match needs {
            AccessLevel::Nothing => true,
            AccessLevel::Login => self.is_known(),
            AccessLevel::Instructor => self.is_known() && self.role >= Role::Instructor,
            AccessLevel::Administrator => self.is_known() && self.role >= Role::Administrator,
        }
    }

    /// What belongs to this trainee is shown: his own, or to whom trains him.
    #[must_use]
    pub fn may_see(&self, trainee: &str) -> bool {
        self.satisfies(AccessLevel::Instructor) || self.name.as_deref() == Some(trainee)
    }

    /// The trainee that lists are limited to; `None` for whoever sees all.
    #[must_use]
    pub fn limited_to(&self) -> Option<&str> {
        if self.satisfies(AccessLevel::Instructor) { None } else { Some(self.name.as_deref().unwrap_or_default()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn visitor(name: Option<&str>, role: Role, open: bool) -> Visitor {
        Visitor { name: name.map(str::to_owned), role, open, token: String::new() }
    }

    #[test]
    fn exact_each_role_has_its_permissions() {
        let all = [AccessLevel::Nothing, AccessLevel::Login, AccessLevel::Instructor, AccessLevel::Administrator];
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
        assert_eq!(anna.limited_to(), Some("anna"));
        let stranger = visitor(None, Role::Trainee, false);
        assert!(!stranger.may_see("anna") && !stranger.may_see(""));
        assert_eq!(visitor(Some("i"), Role::Instructor, false).limited_to(), None);
    }
}
