//! Sign-offs of the rubric: the history is kept, and erased names leave no trace.

use crate::records::database::Database;
use spandrel_training::rubric::{SignOffAction, SignOffEvent};
use spandrel_training::trainee::Role;

fn event(action: SignOffAction, unix_us: u64, by: &str) -> SignOffEvent {
    let (criterion, title) = ("path".to_owned(), "Flies the path; DROP TABLE sign_offs --'".to_owned());
    SignOffEvent { criterion, title, action, unix_us, by: by.into(), note: "calm in gusts".into() }
}

/// Runs all tests in this file on one database.
pub fn run_all(target: &str) {
    let (here, there) = (Database::open(target).unwrap(), Database::open(target).unwrap());
    for (name, role) in [("anna", Role::Trainee), ("ida", Role::Instructor), ("ivo", Role::Instructor)] {
        here.update_details(name, Some(role), [None; 3]).unwrap();
    }
    let history = [
        event(SignOffAction::SignedOff, 5, "ida"),
        event(SignOffAction::Withdrawn, 6, "ivo"),
        event(SignOffAction::SignedOff, 7, "ivo"),
    ];
    assert_eq!(here.add_sign_off("anna", &history[1]), Ok(false), "nothing to withdraw");
    assert_eq!(here.add_sign_off("anna", &history[0]), Ok(true));
    assert_eq!(
        there.add_sign_off("anna", &event(SignOffAction::SignedOff, 6, "ivo")),
        Ok(false),
        "another instructor was faster"
    );
    assert_eq!([there.add_sign_off("anna", &history[1]), there.add_sign_off("anna", &history[1])], [Ok(true), Ok(false)]);
    assert_eq!(here.add_sign_off("anna", &history[2]), Ok(true));
    assert!(here.add_sign_off("nobody", &history[0]).is_err());
    assert_eq!(here.sign_offs("anna").unwrap(), history);
    assert!(here.sign_offs("ben").unwrap().is_empty());
    here.erase("ida", &[]).unwrap();
    let names: Vec<String> = here.sign_offs("anna").unwrap().into_iter().map(|event| event.by).collect();
    assert_eq!(names, ["", "ivo", "ivo"], "an erased instructor's sign-off stays, without the name");
    here.erase("anna", &[]).unwrap();
    assert!(here.sign_offs("anna").unwrap().is_empty());
    here.erase("ivo", &[]).unwrap();
}
