//! Classes and assignments, which remain consistent when people, classes and sessions are removed.

use crate::records::database::Database;
use spandrel_training::assignment::{Assignment, AssignmentTarget};
use spandrel_training::trainee::Role;
use spandrel_training::training_class::TrainingClass;

/// Runs all tests in this file on one database.
pub fn run_all(target: &str) {
    classes_keep_their_members(target);
    assignments_reach_members_and_end_with_their_target(target);
}

fn class(name: &str, members: &[&str]) -> TrainingClass {
    TrainingClass { name: name.into(), members: members.iter().map(|name| (*name).to_owned()).collect() }
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

fn classes_keep_their_members(target: &str) {
    let (here, there) = (Database::open(target).unwrap(), Database::open(target).unwrap());
    assert_eq!([here.add_class("spring"), there.add_class("spring"), here.add_class("autumn")], [Ok(true), Ok(false), Ok(true)]);
    assert_eq!(here.add_members("nothing", &names(&["anna"])), Ok(false));
    assert!(here.trainees().unwrap().is_empty(), "an unknown class adds nobody");
    here.set_login("ben", Role::Instructor, "hash").unwrap();
    assert_eq!(here.add_members("spring", &names(&["zoe", "anna", "ben"])), Ok(true));
    assert_eq!(there.add_members("spring", &names(&["anna"])), Ok(true), "a second time changes nothing");
    assert_eq!(there.add_members("autumn", &names(&["anna"])), Ok(true));
    let expected = [class("autumn", &["anna"]), class("spring", &["anna", "ben", "zoe"])];
    assert_eq!(there.classes().unwrap(), expected);
    assert_eq!(there.classes_of("anna").unwrap(), ["autumn", "spring"]);
    assert_eq!(here.account("ben").unwrap().unwrap().person.role, Role::Instructor, "the role does not change");
    assert_eq!([here.remove_member("spring", "zoe"), here.remove_member("spring", "zoe")], [Ok(true), Ok(false)]);
    assert_eq!([here.remove_class("autumn"), here.remove_class("autumn")], [Ok(true), Ok(false)]);
    assert_eq!(here.account("anna").unwrap().unwrap().person.pseudonym, "anna", "people remain");
    here.erase("ben", &[]).unwrap();
    assert_eq!(here.classes().unwrap(), [class("spring", &["anna"])]);
    assert_eq!(here.remove_class("spring"), Ok(true));
    for trainee in ["anna", "zoe"] {
        here.erase(trainee, &[]).unwrap();
    }
}

fn assignment(id: &str, target: AssignmentTarget, due_unix_us: u64) -> Assignment {
    Assignment {
        id: id.into(),
        target,
        scenario: "drill-gap'; --".into(),
        variant: Some("6".into()),
        assigned_unix_us: 1_700_000_000_000_000,
        due_unix_us,
        assigned_by: "ida".into(),
    }
}

fn assignments_reach_members_and_end_with_their_target(target: &str) {
    let database = Database::open(target).unwrap();
    database.add_class("spring").unwrap();
    database.add_members("spring", &names(&["anna", "ben"])).unwrap();
    database.update_details("ida", Some(Role::Instructor), [None; 3]).unwrap();
    let to_class = assignment("c", AssignmentTarget::Class("spring".into()), 9);
    let to_anna = Assignment { variant: None, ..assignment("a", AssignmentTarget::Trainee("anna".into()), 5) };
    assert_eq!([database.assign(&to_class), database.assign(&to_anna)], [Ok(true), Ok(true)]);
    let nobody = assignment("n", AssignmentTarget::Trainee("nobody".into()), 5);
    let no_class = assignment("n", AssignmentTarget::Class("nothing".into()), 5);
    assert_eq!([database.assign(&nobody), database.assign(&no_class)], [Ok(false), Ok(false)]);
    assert_eq!(database.assignments_of_trainee("anna").unwrap(), [to_anna.clone(), to_class.clone()], "the earliest due first");
    assert_eq!(database.assignments_of_trainee("ben").unwrap(), std::slice::from_ref(&to_class));
    assert_eq!(database.assignments_of_class("spring").unwrap(), std::slice::from_ref(&to_class));
    assert_eq!((database.assignment("a"), database.assignment("' OR 1 = 1 --")), (Ok(Some(to_anna)), Ok(None)));
    database.remove_member("spring", "ben").unwrap();
    assert!(database.assignments_of_trainee("ben").unwrap().is_empty(), "assignments are those of the current classes");
    database.erase("ida", &[]).unwrap();
    let anonymous = Assignment { assigned_by: String::new(), ..to_class };
    assert_eq!(database.assignments_of_class("spring").unwrap(), [anonymous]);
    database.erase("anna", &[]).unwrap();
    assert_eq!(database.assignment("a"), Ok(None));
    assert_eq!([database.remove_assignment("c"), database.remove_assignment("c")], [Ok(true), Ok(false)]);
    let again = assignment("d", AssignmentTarget::Class("spring".into()), 9);
    assert_eq!((database.assign(&again), database.remove_class("spring")), (Ok(true), Ok(true)));
    assert_eq!(database.assignment("d"), Ok(None), "a removed class leaves no assignments");
    database.erase("ben", &[]).unwrap();
}
