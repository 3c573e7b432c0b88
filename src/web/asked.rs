//! A request, read.

use super::answer::Refusal;
use super::guard::Client;
use super::spool::Spooled;
use spandrel_training::web::access::Visitor;
use std::collections::BTreeMap;
use std::net::IpAddr;

/// A file of a form.
#[derive(Debug)]
pub struct Upload {
    /// Its name as the browser sent it; never used as a path.
    pub name: String,
    /// Its contents.
    pub file: Spooled,
}

/// A request, read: who, what, with which words.
#[derive(Debug)]
pub struct Asked {
    /// Who.
    pub visitor: Visitor,
    /// His cookie.
    pub cookie: Option<String>,
    /// From where.
    pub from: IpAddr,
    /// Cookie of a browser that somebody has logged in with before.
    pub device: Option<String>,
    /// Parts of the path by their names in the table of routes.
    pub path: BTreeMap<String, String>,
    /// Words after the question mark.
    pub query: Vec<(String, String)>,
    /// Fields of the form.
    pub form: Vec<(String, String)>,
    /// Its file.
    pub upload: Option<Upload>,
    /// Languages that the browser likes (Accept-Language).
    pub languages: String,
    /// A script of ours asks and reads JSON.
    pub by_script: bool,
}

impl Asked {
    /// Where a login comes from.
    pub fn client(&self) -> Client<'_> {
        Client { from: self.from, device: self.device.as_deref() }
    }

    /// A part of the path.
    pub fn part(&self, name: &str) -> &str {
        self.path.get(name).map_or("", String::as_str)
    }

    /// A word after the question mark.
    pub fn word(&self, name: &str) -> Option<&str> {
        self.query.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str()).filter(|value| !value.is_empty())
    }

    /// A field of the form.
    pub fn field(&self, name: &str) -> Option<&str> {
        self.form.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }

    /// A field that must be there.
    ///
    /// # Errors
    /// When it is not.
    pub fn needed(&self, name: &str) -> Result<&str, Refusal> {
        self.field(name).filter(|value| !value.is_empty()).ok_or_else(|| Refusal::Wrong(format!("{name}: missing")))
    }

    /// What belongs to this trainee is shown to him and to whoever trains him; to others it is not there.
    ///
    /// # Errors
    /// When it is not his.
    pub fn must_see(&self, trainee: &str) -> Result<(), Refusal> {
        if self.visitor.may_see(trainee) { Ok(()) } else { Err(Refusal::NotFound) }
    }
}
