//! Sanitized paths from client requests; none can escape the root directory.

/// A path below the root: components joined by '/', without a leading '/', empty components, `.` or `..`; empty for the
/// root.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct FilePath(String);

impl FilePath {
    /// Sanitizes a path from a client. Returns `None` if it contains `..`, is not UTF-8, or contains a character that
    /// some operating systems treat as a separator or drive letter.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
        let text = std::str::from_utf8(&bytes[..end]).ok()?;
        let odd = |c: char| c.is_control() || matches!(c, '\\' | ':');
        let parts: Vec<&str> = text.split('/').filter(|part| !part.is_empty() && *part != ".").collect();
        if text.contains(odd) || parts.contains(&"..") {
            return None;
        }
        Some(Self(parts.join("/")))
    }

    /// Returns the path as text; empty for the root.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Returns this path relative to `directory`, or `None` if it is not inside `directory`.
    #[must_use]
    pub fn below<'a>(&'a self, directory: &Self) -> Option<&'a str> {
        if directory.is_root() {
            return Some(&self.0);
        }
        self.0.strip_prefix(&directory.0)?.strip_prefix('/')
    }

    /// Checks whether this is the root.
    #[must_use]
    pub fn is_root(&self) -> bool {
        self.0.is_empty()
    }
}

impl std::fmt::Display for FilePath {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "/{}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_equivalent_paths_are_normalized() {
        for text in ["/log/a.ulg", "log/a.ulg", "//log/./a.ulg/", "log/a.ulg\0rubbish"] {
            assert_eq!(FilePath::of(text.as_bytes()).unwrap().as_str(), "log/a.ulg", "{text:?}");
        }
        for text in ["", "/", ".", "./", "\0"] {
            assert!(FilePath::of(text.as_bytes()).unwrap().is_root(), "{text:?}");
        }
    }

    #[test]
    fn exact_paths_outside_the_root_are_rejected() {
        for text in ["..", "/..", "a/../b", "a/..", "..\\..\\b", "C:/x", "a\nb", "../log-of-somebody-else"] {
            assert_eq!(FilePath::of(text.as_bytes()), None, "{text:?}");
        }
        assert_eq!(FilePath::of(&[0xff, 0xfe]), None);
        assert_eq!(FilePath::of(b"a/...").unwrap().as_str(), "a/...");
    }
}
