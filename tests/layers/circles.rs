//! Finds import cycles between a crate's files: files that cannot be understood, tested or moved separately.

use crate::paths::{Import, Token, code_only, imports, inline_paths, is_word, tokens, without_imports, without_tests};
use std::collections::{BTreeMap, BTreeSet};

/// One file in a crate.
struct SourceModule {
    /// Path relative to the crate's `src`.
    file: String,
    /// Names of the items that the file defines.
    items: BTreeSet<String>,
    /// `use` declarations of the file.
    imports: Vec<Import>,
    /// All other tokens of the file.
    body: Vec<Token>,
}

/// All of a crate's files, by module path.
pub struct CrateFiles {
    modules: BTreeMap<Vec<String>, SourceModule>,
}

/// Module paths of the files that each file imports from, by the importing file's module path.
type Edges = BTreeMap<Vec<String>, BTreeSet<Vec<String>>>;

impl CrateFiles {
    /// Parses a crate's files, given as paths relative to `src` and texts. Excludes test modules.
    pub fn read<'a>(files: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let mut modules = BTreeMap::new();
        let mut for_tests = Vec::new();
        for (file, source) in files {
            let path = module_path(file);
            let all = tokens(&code_only(source));
            let code = without_tests(&all);
            for_tests.extend(
                declared_modules(&all)
                    .difference(&declared_modules(&code))
                    .map(|name| [&path[..], std::slice::from_ref(name)].concat()),
            );
            let items = items(&code);
            let (imports, body) = (imports(&code), without_imports(&code));
            modules.insert(path, SourceModule { file: file.to_owned(), items, imports, body });
        }
        modules.retain(|path, _| !for_tests.iter().any(|test| path.starts_with(test)));
        Self { modules }
    }

    /// Returns the import cycles, each as lines `file -> files in the same cycle that it imports`.
    pub fn find_import_cycles(&self) -> Vec<Vec<String>> {
        let edges: Edges = self.modules.keys().map(|path| (path.clone(), self.imported_files(path))).collect();
        let reachable: Edges = edges.keys().map(|path| (path.clone(), reachable(path, &edges))).collect();
        let mut seen = BTreeSet::new();
        let mut found = Vec::new();
        for (path, reached) in &reachable {
            if !reached.contains(path) || seen.contains(path) {
                continue;
            }
            let circle: BTreeSet<&Vec<String>> = reached.iter().filter(|other| reachable[*other].contains(path)).collect();
            seen.extend(circle.iter().map(|path| (*path).clone()));
            found.push(circle.iter().map(|path| self.line(path, &edges[*path], &circle)).collect());
        }
        found
    }

    fn line(&self, path: &[String], imported: &BTreeSet<Vec<String>>, circle: &BTreeSet<&Vec<String>>) -> String {
        let name = |path: &Vec<String>| self.modules[path].file.clone();
        let others: Vec<String> = imported.iter().filter(|path| circle.contains(path)).map(name).collect();
        format!("{} -> {}", self.modules[path].file, others.join(", "))
    }

    /// Returns the module paths of the files that a file imports from. Re-exports are not edges: an import counts as an
    /// edge to the module that defines the name, not to the modules that re-export it.
    fn imported_files(&self, path: &[String]) -> BTreeSet<Vec<String>> {
        let module = &self.modules[path];
        let mut found = BTreeSet::new();
        let mut imported_modules = BTreeMap::new();
        for import in module.imports.iter().filter(|import| !import.public) {
            match self.path_in_crate(path, &import.path) {
                Some(whole) if self.modules.contains_key(&whole) => {
                    imported_modules.insert(import.name.clone(), import.path.clone());
                }
                _ => found.extend(self.defining_module(path, &import.path, 0)),
            }
        }
        for named in inline_paths(&module.body) {
            let whole = match imported_modules.get(&named[0]) {
                Some(start) => [&start[..], &named[1..]].concat(),
                None => named,
            };
            found.extend(self.defining_module(path, &whole, 0));
        }
        found.remove(path);
        found
    }

    /// Returns a path relative to the crate root; `None` if it is outside the crate.
    fn path_in_crate(&self, from: &[String], path: &[String]) -> Option<Vec<String>> {
        let ups = path.iter().take_while(|part| *part == "super").count();
        let (base, rest) = match path.first()?.as_str() {
            "crate" => (&from[..0], &path[1..]),
            "self" => (from, &path[1..]),
            "super" => (&from[..from.len().checked_sub(ups)?], &path[ups..]),
            first if self.modules.contains_key(&[from, &[first.to_owned()]].concat()) => (from, path),
            _ => return None,
        };
        Some([base, rest].concat())
    }

    /// Returns the module that defines the item at a path. Follows re-exports.
    fn defining_module(&self, from: &[String], path: &[String], depth: u32) -> Option<Vec<String>> {
        let whole = self.path_in_crate(from, path)?;
        let mut len = 0;
        while len < whole.len() && self.modules.contains_key(&whole[..=len]) {
            len += 1;
        }
        let (home, rest) = whole.split_at(len);
        let module = self.modules.get(home)?;
        let Some(name) = rest.first() else { return Some(home.to_vec()) };
        if name == "*" || module.items.contains(name) {
            return Some(home.to_vec());
        }
        // A name that is re-exported in a cycle has no defining module.
        if depth > 16 {
            return None;
        }
        if let Some(import) = module.imports.iter().find(|import| import.name == *name) {
            return self.defining_module(home, &[&import.path[..], &rest[1..]].concat(), depth + 1);
        }
        let globs = module.imports.iter().filter(|import| import.public && import.name == "*");
        globs.filter_map(|glob| self.defining_module(home, &[&glob.path[..glob.path.len() - 1], rest].concat(), depth + 1)).next()
    }
}

fn reachable(from: &[String], edges: &Edges) -> BTreeSet<Vec<String>> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&Vec<String>> = edges[from].iter().collect();
    while let Some(path) = open.pop() {
        if found.insert(path.clone()) {
            open.extend(&edges[path]);
        }
    }
    found
}

/// Returns the module path of a file: `a::b` for both `a/b/mod.rs` and `a/b.rs`.
fn module_path(file: &str) -> Vec<String> {
    let mut parts: Vec<String> = file.trim_end_matches(".rs").split(['/', '\\']).map(str::to_owned).collect();
    if parts.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
        parts.pop();
    }
    parts
}

/// Returns the names of the modules that a file declares.
fn declared_modules(code: &[Token]) -> BTreeSet<String> {
    let declared = code.windows(3).filter(|three| three[0].1 == "mod" && is_word(&three[1].1) && three[2].1 == ";");
    declared.map(|three| three[1].1.clone()).collect()
}

/// Names of the items that a file defines.
fn items(code: &[Token]) -> BTreeSet<String> {
    const KINDS: [&str; 8] = ["fn", "struct", "enum", "trait", "type", "const", "static", "union"];
    let named =
        code.windows(2).filter(|two| KINDS.contains(&two[0].1.as_str()) && is_word(&two[1].1)).map(|two| two[1].1.clone());
    let macros = code.windows(3).filter(|three| three[0].1 == "macro_rules" && three[1].1 == "!").map(|three| three[2].1.clone());
    named.chain(macros).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find_import_cycles(files: &[(&str, &str)]) -> Vec<Vec<String>> {
        CrateFiles::read(files.iter().copied()).find_import_cycles()
    }

    #[test]
    fn exact_files_that_import_each_other_form_a_cycle() {
        let files =
            [("lib.rs", "mod a; mod b;"), ("a.rs", "use crate::b::B; pub struct A;"), ("b.rs", "pub struct B(super::a::A);")];
        assert_eq!(find_import_cycles(&files), [["a.rs -> b.rs", "b.rs -> a.rs"]]);
        let files = [("lib.rs", "mod a; mod b;"), ("a.rs", "use crate::b::B; pub struct A;"), ("b.rs", "pub struct B;")];
        assert!(find_import_cycles(&files).is_empty());
    }

    #[test]
    fn exact_imported_names_count_for_the_defining_file() {
        let handed_on = [("a/mod.rs", "mod b; mod c; pub use c::C;"), ("a/b.rs", "use super::C;"), ("a/c.rs", "pub struct C;")];
        assert!(find_import_cycles(&handed_on).is_empty());
        let defined = [("a/mod.rs", "mod b; use b::B; pub struct C;"), ("a/b.rs", "use super::C; pub struct B;")];
        assert_eq!(find_import_cycles(&defined), [["a/mod.rs -> a/b.rs", "a/b.rs -> a/mod.rs"]]);
        let through_glob = [
            ("a/mod.rs", "mod b; mod c; pub use c::*;"),
            ("a/b.rs", "use super::C;"),
            ("a/c.rs", "use super::b::B; pub enum C {}"),
        ];
        assert!(find_import_cycles(&through_glob).is_empty(), "b defines no B");
    }

    #[test]
    fn exact_imported_modules_count_where_they_are_used() {
        let used = [("a.rs", "use crate::b; fn f() { b::g() }"), ("b.rs", "pub fn g() { crate::a::f() }")];
        assert_eq!(find_import_cycles(&used), [["a.rs -> b.rs", "b.rs -> a.rs"]]);
        let unused = [("a.rs", "use crate::b; fn f() {}"), ("b.rs", "pub fn g() { crate::a::f() }")];
        assert!(find_import_cycles(&unused).is_empty());
        let renamed = [("a.rs", "use crate::b::g as h; fn f() { h() }"), ("b.rs", "pub fn g() { crate::a::f() }")];
        assert_eq!(find_import_cycles(&renamed).len(), 1);
    }

    #[test]
    fn exact_test_modules_do_not_form_cycles() {
        let inside =
            [("a.rs", "fn f() {} #[cfg(test)] mod tests { use crate::b::g; }"), ("b.rs", "pub fn g() { crate::a::f() }")];
        assert!(find_import_cycles(&inside).is_empty());
        let beside =
            [("a.rs", "#[cfg(test)]\nmod checks; fn f() { self::checks::g() }"), ("a/checks.rs", "pub fn g() { super::f() }")];
        assert!(find_import_cycles(&beside).is_empty());
    }

    #[test]
    fn exact_long_cycles_list_every_file_once() {
        let files = [
            ("a.rs", "use crate::b::B; pub struct A;"),
            ("b.rs", "use crate::c::{self, C}; pub struct B;"),
            ("c.rs", "use crate::a; pub struct C; fn f() -> a::A { a::A }"),
            ("d.rs", "use crate::a::A; use std::fmt::Debug; pub struct D;"),
        ];
        assert_eq!(find_import_cycles(&files), [["a.rs -> b.rs", "b.rs -> c.rs", "c.rs -> a.rs"]]);
    }
}
