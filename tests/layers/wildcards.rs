//! Finds catch-all arms in matches on our own enums: a new variant would match them unnoticed.

use crate::paths::{Token, is_word};
use std::collections::BTreeSet;

/// Returns the names of the enums that the code defines.
pub fn enums(code: &[Token]) -> BTreeSet<String> {
    let defined =
        code.windows(3).filter(|three| three[0].1 == "enum" && is_word(&three[1].1) && ["{", "<"].contains(&three[2].1.as_str()));
    defined.map(|three| three[1].1.clone()).collect()
}

/// Returns the catch-all arms in matches on one of `enums`, each as a line number and the enum's name.
pub fn find_catch_all_arms(code: &[Token], enums: &BTreeSet<String>) -> Vec<(usize, String)> {
    let implementations = impl_blocks(code);
    let mut out = Vec::new();
    for at in (0..code.len()).filter(|at| code[*at].1 == "match") {
        let arms = arms(code, at);
        let variant_of = |pattern: &[Token]| {
            let start = pattern.iter().position(|token| !["|", "&", "ref", "("].contains(&token.1.as_str()))?;
            let path: Vec<&str> = path_at(pattern, start);
            let name = path.len().checked_sub(2).map(|k| path[k])?;
            let own = implementations.iter().rev().find(|(from, to, _)| (*from..*to).contains(&at));
            let name = if name == "Self" { own.map(|(_, _, name)| name.as_str())? } else { name };
            (start == 0 && enums.contains(name)).then(|| name.to_owned())
        };
        let Some(name) = arms.iter().find_map(|arm| variant_of(arm)) else { continue };
        out.extend(arms.iter().filter(|arm| is_catch_all(arm)).map(|arm| (arm[0].0, name.clone())));
    }
    out
}

/// Returns true for a pattern without a guard that matches everything: `_`, or a new name.
fn is_catch_all(pattern: &[Token]) -> bool {
    match pattern {
        [(_, only)] => {
            only == "_" || (only.starts_with(|c: char| c.is_ascii_lowercase()) && !["true", "false"].contains(&only.as_str()))
        }
        _ => false,
    }
}

/// Returns the parts of the path that starts at a token.
fn path_at(code: &[Token], start: usize) -> Vec<&str> {
    let mut parts = Vec::new();
    let mut at = start;
    while code.get(at).is_some_and(|token| is_word(&token.1)) {
        parts.push(code[at].1.as_str());
        if code.get(at + 1).is_none_or(|token| token.1 != "::") {
            break;
        }
        at += 2;
    }
    parts
}

/// Returns the `impl` blocks, each as first token, last token and name of the type.
fn impl_blocks(code: &[Token]) -> Vec<(usize, usize, String)> {
    let mut out = Vec::new();
    for at in (0..code.len()).filter(|at| code[*at].1 == "impl") {
        let Some(open) = (at..code.len()).find(|k| ["{", ";", "("].contains(&code[*k].1.as_str())) else { continue };
        if code[open].1 != "{" {
            continue;
        }
        let header = &code[at..open];
        let of = header.iter().rposition(|token| token.1 == "for").map_or(header, |k| &header[k + 1..]);
        let name = of.iter().find(|token| token.1.starts_with(|c: char| c.is_ascii_uppercase()));
        out.extend(name.map(|name| (open, closing_bracket(code, open), name.1.clone())));
    }
    out
}

/// Returns the index of the bracket that closes the bracket at `open`.
fn closing_bracket(code: &[Token], open: usize) -> usize {
    let mut depth = 0_u32;
    for (at, token) in code.iter().enumerate().skip(open) {
        match token.1.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth -= 1,
            _ => continue,
        }
        if depth == 0 {
            return at;
        }
    }
    code.len()
}

/// Returns the patterns of the `match` at a token.
fn arms(code: &[Token], at: usize) -> Vec<&[Token]> {
    let mut open = at + 1;
    while code.get(open).is_some_and(|token| token.1 != "{") {
        open = if ["(", "["].contains(&code[open].1.as_str()) { closing_bracket(code, open) + 1 } else { open + 1 };
    }
    let end = closing_bracket(code, open.min(code.len()));
    let mut out = Vec::new();
    let mut next = open + 1;
    while next < end {
        let arrow = arrow(code, next, end);
        out.push(&code[next..arrow]);
        let body = arrow + 2;
        next = if code.get(body).is_some_and(|token| token.1 == "{") {
            closing_bracket(code, body) + 1
        } else {
            arm_end(code, body, end)
        };
        if code.get(next).is_some_and(|token| token.1 == ",") {
            next += 1;
        }
    }
    out.retain(|pattern| !pattern.is_empty());
    out
}

/// Returns the index of the `=>` after a pattern.
fn arrow(code: &[Token], from: usize, end: usize) -> usize {
    let mut at = from;
    while at < end {
        match code[at].1.as_str() {
            "{" | "(" | "[" => at = closing_bracket(code, at),
            "=" if code[at + 1].1 == ">" => return at,
            _ => {}
        }
        at += 1;
    }
    end
}

/// Returns the end of an arm without a block.
fn arm_end(code: &[Token], from: usize, end: usize) -> usize {
    let mut at = from;
    while at < end && code[at].1 != "," {
        at = if ["{", "(", "["].contains(&code[at].1.as_str()) { closing_bracket(code, at) + 1 } else { at + 1 };
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paths::{code_only, tokens};

    fn lines(source: &str) -> Vec<usize> {
        let code = tokens(&code_only(source));
        find_catch_all_arms(&code, &enums(&code)).into_iter().map(|(line, _)| line).collect()
    }

    #[test]
    fn exact_catch_all_arms_are_found() {
        assert_eq!(lines("enum E { A, B(u8) }\nfn f(e: E) { match e { E::A => 1,\n_ => 2 } }"), [3]);
        assert_eq!(lines("enum E { A, B(u8) }\nfn f(e: E) { match e { E::B(k) if k > 1 => { g(k) }\nother => h(other) } }"), [3]);
        assert_eq!(lines("enum E { A, B }\nimpl E { fn f(self) { match self { Self::A => 1,\n_ => 2 } } }"), [3]);
        assert_eq!(lines("enum E { A, B }\nfn f(e: E) { match g(|x| { x }, e) { a::E::A | E::B => x(1, 2),\n_ => {} } }"), [3]);
    }

    #[test]
    fn exact_exhaustive_arms_and_matches_on_other_types_are_ignored() {
        for fine in [
            "enum E { A, B }\nfn f(e: E) { match e { E::A => 1, E::B => 2 } }",
            "enum E { A, B }\nfn f(k: u8) { match k { 0 => E::A, _ => E::B } }",
            "enum E { A, B }\nfn f(e: Other) { match e { Other::A => E::A, _ => E::B } }",
            "enum E { A, B(u8) }\nfn f(e: E) { match e { E::A => 1, E::B(_) => 2 } }",
            "enum E { A, B }\nimpl Other { fn f(self) { match self { Self::A => 1, _ => 2 } } }",
        ] {
            assert!(lines(fine).is_empty(), "{fine}");
        }
    }
}
