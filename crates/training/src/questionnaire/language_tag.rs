//! Language tags (BCP 47).

/// Maximum length of a language tag, characters (BCP 47 requires support for 35).
const MAX_TAG_LEN: usize = 35;

/// Returns whether a string is a well-formed language tag.
#[must_use]
pub fn is_language_tag(tag: &str) -> bool {
    let parts = || tag.split('-');
    tag.len() <= MAX_TAG_LEN
        && parts().all(|part| (1..=8).contains(&part.len()) && part.chars().all(|c| c.is_ascii_alphanumeric()))
}
