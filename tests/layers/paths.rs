//! Extracts the paths from Rust source code: `use` trees and inline paths, with `self` and `super` resolved.

/// A line number and the path on that line, such as (12, ["crate", "site", "Site"]).
pub type PathUse = (usize, Vec<String>);

/// Returns the source with comments, string literals and character literals replaced by spaces. Keeps line breaks.
pub fn code_only(source: &str) -> String {
    let bytes: Vec<char> = source.chars().collect();
    let mut out = String::with_capacity(source.len());
    let mut at = 0;
    while at < bytes.len() {
        let end = literal_end(&bytes, at);
        if end == at {
            out.push(bytes[at]);
            at += 1;
        } else {
            out.extend(bytes[at..end].iter().map(|c| if *c == '\n' { '\n' } else { ' ' }));
            at = end;
        }
    }
    out
}

/// Returns the end of the comment or literal that starts at `at`; returns `at` if none starts there.
fn literal_end(text: &[char], at: usize) -> usize {
    let starts = |what: &str| what.chars().enumerate().all(|(k, c)| text.get(at + k) == Some(&c));
    let joined = at > 0 && (text[at - 1].is_alphanumeric() || text[at - 1] == '_');
    if starts("//") {
        return text[at..].iter().position(|c| *c == '\n').map_or(text.len(), |k| at + k);
    }
    if starts("/*") {
        return block_comment(text, at);
    }
    if starts("\"") {
        return string(text, at + 1);
    }
    if !joined && (starts("r\"") || starts("r#") || starts("br\"") || starts("br#")) {
        return raw_string(text, at);
    }
    if starts("'") { character(text, at) } else { at }
}

fn block_comment(text: &[char], at: usize) -> usize {
    let (mut depth, mut k) = (0, at);
    while k < text.len() {
        match (text[k], text.get(k + 1)) {
            ('/', Some('*')) => (depth, k) = (depth + 1, k + 2),
            ('*', Some('/')) => (depth, k) = (depth - 1, k + 2),
            _ => k += 1,
        }
        if depth == 0 {
            return k;
        }
    }
    text.len()
}

fn string(text: &[char], mut k: usize) -> usize {
    while k < text.len() {
        match text[k] {
            '\\' => k += 2,
            '"' => return k + 1,
            _ => k += 1,
        }
    }
    text.len()
}

fn raw_string(text: &[char], at: usize) -> usize {
    let mut k = at + if text[at] == 'b' { 2 } else { 1 };
    let hashes = text[k..].iter().take_while(|c| **c == '#').count();
    k += hashes;
    if text.get(k) != Some(&'"') {
        return at;
    }
    let closes = |k: usize| text[k] == '"' && text[k + 1..].iter().take(hashes).filter(|c| **c == '#').count() == hashes;
    (k + 1..text.len()).find(|k| closes(*k)).map_or(text.len(), |k| k + 1 + hashes)
}

/// Returns the end of a character literal. Returns `at` for a lifetime.
fn character(text: &[char], at: usize) -> usize {
    match (text.get(at + 1), text.get(at + 2)) {
        (Some('\\'), _) => (at + 3..text.len()).find(|k| text[*k] == '\'').map_or(text.len(), |k| k + 1),
        (Some(_), Some('\'')) => at + 3,
        _ => at,
    }
}

/// Returns every path of two or more parts in `code` that starts with one of `roots`, with `use` groups expanded.
/// `module` is the file's module path, which resolves `self`.
pub fn rooted_paths(code: &str, module: &[String], roots: &[&str]) -> Vec<PathUse> {
    rooted_paths_in(&tokens(code), module, roots)
}

/// Same as [`rooted_paths`], for code that is already split into tokens.
pub fn rooted_paths_in(tokens: &[Token], module: &[String], roots: &[&str]) -> Vec<PathUse> {
    let mut found = Vec::new();
    for at in 0..tokens.len() {
        let begins = roots.contains(&tokens[at].1.as_str()) || ["self", "super"].contains(&tokens[at].1.as_str());
        let continues = at > 0 && tokens[at - 1].1 == "::" && at > 1 && is_word(&tokens[at - 2].1);
        if begins && !continues && tokens.get(at + 1).is_some_and(|next| next.1 == "::") {
            let mut parts = Vec::new();
            tree(tokens, at, &mut parts, &mut found);
        }
    }
    found.into_iter().filter_map(|(line, path)| Some((line, resolve(path, module)?))).collect()
}

/// A line number and the token on that line.
pub type Token = (usize, String);

/// One name in a `use` declaration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Import {
    /// Whether the name is re-exported.
    pub public: bool,
    /// Path as written, such as ["super", "site", "Site"].
    pub path: Vec<String>,
    /// Name in the importing file; `*` for a glob import.
    pub name: String,
}

/// Returns the code without items that are compiled only for tests.
pub fn without_tests(code: &[Token]) -> Vec<Token> {
    const MARK: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut out = Vec::new();
    let mut at = 0;
    while at < code.len() {
        if code[at..].iter().map(|token| token.1.as_str()).take(MARK.len()).eq(MARK) {
            at = item_end(code, at + MARK.len());
        } else {
            out.push(code[at].clone());
            at += 1;
        }
    }
    out
}

/// Returns the end of an item: the token after its `;` or closing brace.
fn item_end(code: &[Token], mut at: usize) -> usize {
    let mut depth = 0_u32;
    while let Some((_, token)) = code.get(at) {
        match token.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" if depth == 0 => return at,
            "}" if depth == 1 => return at + 1,
            "}" | ")" | "]" => depth -= 1,
            ";" if depth == 0 => return at + 1,
            _ => {}
        }
        at += 1;
    }
    at
}

/// Returns all names in all `use` declarations.
pub fn imports(code: &[Token]) -> Vec<Import> {
    let mut out = Vec::new();
    for at in (0..code.len()).filter(|at| code[*at].1 == "use") {
        // Matches `pub use`, and the end of `pub(crate) use`.
        let public = at > 0 && (code[at - 1].1 == "pub" || code[at - 1].1 == ")");
        import_tree(code, at + 1, &mut Vec::new(), public, &mut out);
    }
    out
}

/// Parses the `use` tree at `at` and returns its end.
fn import_tree(code: &[Token], mut at: usize, prefix: &mut Vec<String>, public: bool, out: &mut Vec<Import>) -> usize {
    let depth = prefix.len();
    while let Some((_, token)) = code.get(at) {
        match token.as_str() {
            "::" => at += 1,
            "{" => {
                at += 1;
                while code.get(at).is_some_and(|token| token.1 != "}") {
                    at = if code[at].1 == "," { at + 1 } else { import_tree(code, at, prefix, public, out) };
                }
                prefix.truncate(depth);
                return at + 1;
            }
            word if is_word(word) || word == "*" => {
                prefix.push(word.to_owned());
                at += 1;
                if code.get(at).is_none_or(|next| next.1 != "::") {
                    break;
                }
            }
            _ => break,
        }
    }
    if prefix.len() > depth {
        if prefix.len() > 1 && prefix.last().is_some_and(|last| last == "self") {
            prefix.pop();
        }
        let renamed = code.get(at).is_some_and(|token| token.1 == "as");
        let name = if renamed { code.get(at + 1).map(|token| token.1.clone()) } else { prefix.last().cloned() };
        out.push(Import { public, path: prefix.clone(), name: name.unwrap_or_default() });
        at += if renamed { 2 } else { 0 };
    }
    prefix.truncate(depth);
    // Any other token ends the tree.
    if code.get(at).is_some_and(|token| [",", "}", ";"].contains(&token.1.as_str())) { at } else { at + 1 }
}

/// Returns the code without `use` declarations.
pub fn without_imports(code: &[Token]) -> Vec<Token> {
    let mut out = Vec::new();
    let mut inside = false;
    for (at, token) in code.iter().enumerate() {
        // `use<'a>` in a type is not an import.
        inside |= token.1 == "use" && code.get(at + 1).is_some_and(|next| next.1 != "<");
        if !inside {
            out.push(token.clone());
        }
        inside &= token.1 != ";";
    }
    out
}

/// Returns the paths of two or more parts that start with a module, `crate`, `self` or `super`.
pub fn inline_paths(code: &[Token]) -> Vec<Vec<String>> {
    let mut out = Vec::new();
    let mut at = 0;
    while at < code.len() {
        let begins = code[at].1.starts_with(|c: char| c.is_ascii_lowercase() || c == '_');
        let mut parts = vec![code[at].1.clone()];
        at += 1;
        while code.get(at).is_some_and(|token| token.1 == "::") && code.get(at + 1).is_some_and(|token| is_word(&token.1)) {
            parts.push(code[at + 1].1.clone());
            at += 2;
        }
        if begins && parts.len() > 1 {
            out.push(parts);
        }
    }
    out
}

/// Returns true if the token is an identifier or a keyword.
pub fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Splits code (see [`code_only`]) into words, `::` and single punctuation characters.
pub fn tokens(code: &str) -> Vec<Token> {
    let mut out: Vec<Token> = Vec::new();
    for (number, line) in code.lines().enumerate() {
        let mut rest = line;
        while let Some(first) = rest.chars().next() {
            let len = if first.is_alphanumeric() || first == '_' {
                rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())
            } else if rest.starts_with("::") {
                2
            } else {
                first.len_utf8()
            };
            if !first.is_whitespace() {
                out.push((number + 1, rest[..len].to_owned()));
            }
            rest = &rest[len..];
        }
    }
    out
}

/// Parses the path or `use` tree at `at` and returns its end.
fn tree(tokens: &[(usize, String)], mut at: usize, prefix: &mut Vec<String>, found: &mut Vec<PathUse>) -> usize {
    let depth = prefix.len();
    let line = tokens[at].0;
    while let Some((_, token)) = tokens.get(at) {
        if token == "{" {
            at = group(tokens, at + 1, prefix, found);
            prefix.truncate(depth);
            return at;
        }
        if !is_word(token) && token != "*" {
            break;
        }
        prefix.push(token.clone());
        at += 1;
        if tokens.get(at).is_none_or(|next| next.1 != "::") {
            break;
        }
        at += 1;
    }
    found.push((line, prefix.clone()));
    prefix.truncate(depth);
    at
}

fn group(tokens: &[(usize, String)], mut at: usize, prefix: &mut Vec<String>, found: &mut Vec<PathUse>) -> usize {
    while let Some((_, token)) = tokens.get(at) {
        match token.as_str() {
            "}" => return at + 1,
            "," => at += 1,
            // Skips `as name` inside a group.
            "as" => at += 2,
            word if is_word(word) || word == "*" => at = tree(tokens, at, prefix, found),
            _ => at += 1,
        }
    }
    at
}

/// Resolves `self::` and `super::` relative to the file's module.
fn resolve(path: Vec<String>, module: &[String]) -> Option<Vec<String>> {
    let ups = path.iter().take_while(|part| *part == "super" || *part == "self").filter(|part| *part == "super").count();
    let relative = path.iter().take_while(|part| *part == "super" || *part == "self").count();
    if relative == 0 {
        return Some(path);
    }
    // A `super` inside an inline module of the file refers to the file itself or to a module in it. Treating it as the
    // parent of the file is stricter.
    let base = module.len().checked_sub(ups)?;
    let own = std::iter::once("crate".to_owned()).chain(module[..base].iter().cloned());
    Some(own.chain(path[relative..].iter().cloned()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(source: &str, module: &[&str]) -> Vec<String> {
        let module: Vec<String> = module.iter().map(|part| (*part).to_owned()).collect();
        rooted_paths(&code_only(source), &module, &["crate", "std"]).into_iter().map(|(_, path)| path.join("::")).collect()
    }

    #[test]
    fn exact_use_groups_are_expanded() {
        let found = paths("use crate::{a::B, c::{self, d::E as F, *}};", &[]);
        assert_eq!(found, ["crate::a::B", "crate::c::self", "crate::c::d::E", "crate::c::*"]);
    }

    #[test]
    fn exact_inline_paths_are_found() {
        assert_eq!(paths("let x = crate::a::b(); my::crate_::c(); std::fs::read(p)", &[]), ["crate::a::b", "std::fs::read"]);
    }

    #[test]
    fn exact_super_and_self_are_resolved() {
        assert_eq!(
            paths("use super::physics::X; use self::y::Z;", &["sitl", "autopilot"]),
            ["crate::sitl::physics::X", "crate::sitl::autopilot::y::Z"]
        );
        assert_eq!(paths("use super::super::physics::X;", &["sitl", "autopilot", "core"]), ["crate::sitl::physics::X"]);
    }

    #[test]
    fn exact_comments_strings_and_lifetimes_are_ignored() {
        let source = "// crate::a::b\n/* crate::c::d /* deep */ crate::e */ let s = \"crate::f::g\"; let r = r#\"crate::h::i\"#; \
                      fn f<'a>(c: char) { if c == '\"' { crate::real::one() } }";
        assert_eq!(paths(source, &[]), ["crate::real::one"]);
    }
}
