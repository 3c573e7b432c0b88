//! Assets embedded in a report page: Spandrel's style sheet and scripts plus two unmodified npm libraries. The page's
//! content security policy lists every script and style by hash and allows no network requests but those for a video.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

/// Style sheet of the report pages.
pub const STYLE: &str = include_str!("assets/report.css");
/// Script shared by the report pages.
pub const COMMON_SCRIPT: &str = include_str!("assets/common.js");
/// Script for the session report.
pub const SCRIPT: &str = include_str!("assets/report.js");
/// Script of the button that prints a page.
pub const PRINT_SCRIPT: &str = include_str!("assets/print.js");
/// Script for the session comparison page.
pub const COMPARE_SCRIPT: &str = include_str!("assets/compare.js");
/// uPlot 1.6.32 (MIT, assets/uPlot.LICENSE): `dist/uPlot.iife.min.js` of the npm package `uplot`.
pub const UPLOT_SCRIPT: &str = include_str!("assets/uPlot.iife.min.js");
/// uPlot's style sheet, `dist/uPlot.min.css`.
pub const UPLOT_STYLE: &str = include_str!("assets/uPlot.min.css");
/// three.js r184 (MIT, assets/three.LICENSE): `build/three.core.min.js` of the npm package `three` 0.184.0.
pub const THREE_CORE_SCRIPT: &str = include_str!("assets/three.core.min.js");
/// The three.js renderer, `build/three.module.min.js`; imports the core as [`THREE_CORE_NAME`].
pub const THREE_SCRIPT: &str = include_str!("assets/three.module.min.js");
/// Module specifier that the renderer uses to import the core. The page's script replaces it with the actual URL.
pub const THREE_CORE_NAME: &str = "./three.core.min.js";

/// Encodes bytes as Base64.
#[must_use]
pub fn base64(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

/// Returns a content security policy that allows only embedded images and these scripts and styles. `blob:` lets the
/// page's script load the 3D library, which is embedded as text.
#[must_use]
pub fn policy(scripts: &[&str], styles: &[&str]) -> String {
    let hashes = |texts: &[&str]| {
        let hash = |text: &&str| format!("'sha256-{}'", base64(&Sha256::digest(text.as_bytes())));
        texts.iter().map(hash).collect::<Vec<_>>().join(" ")
    };
    format!(
        "default-src 'none'; script-src {} blob:; style-src {}; img-src data: blob:; media-src 'self' file:; base-uri 'none'; form-action 'none'",
        hashes(scripts),
        hashes(styles)
    )
}

/// Returns the policy for report pages written by this version.
#[must_use]
pub fn page_policy() -> String {
    policy(&[UPLOT_SCRIPT, COMMON_SCRIPT, SCRIPT, PRINT_SCRIPT, COMPARE_SCRIPT], &[STYLE, UPLOT_STYLE])
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_monitor::folder::sha256_hex;

    #[test]
    fn val_embedded_libraries_match_published_hashes() {
        // SHA-256 hashes of the files in the npm packages uplot-1.6.32.tgz and three-0.184.0.tgz.
        let published = [
            (UPLOT_SCRIPT, "19c8d4c6ad88929a79f4ae49d6f7161566dfd0ba3d15cc495e974f787eb78f1f"),
            (UPLOT_STYLE, "df630c6a8d6f8eeaff264b50f73ce5b114f646ffd9a0bb74f049b0a00135fa04"),
            (THREE_CORE_SCRIPT, "6486aa0d719cfa87ec88dc47223b59b1fb8417a1a407fc0e52467c943e2f8cc9"),
            (THREE_SCRIPT, "36a60b0120335f89a80a0dab70292292b0ec414b3d05e83cd09a3ea428c6712a"),
        ];
        for (text, hash) in published {
            assert_eq!(sha256_hex(text.as_bytes()), hash, "{}", &text[..40]);
        }
        assert!(THREE_SCRIPT.contains(THREE_CORE_NAME));
    }

    #[test]
    fn exact_assets_cannot_end_their_element() {
        for text in [COMMON_SCRIPT, SCRIPT, PRINT_SCRIPT, COMPARE_SCRIPT, UPLOT_SCRIPT, THREE_CORE_SCRIPT, THREE_SCRIPT] {
            assert!(!text.contains("</script") && !text.contains("<!--"));
        }
        for text in [STYLE, UPLOT_STYLE] {
            assert!(!text.contains("</style") && !text.contains("url(") && !text.contains("@import"));
        }
    }

    #[test]
    fn exact_policy_allows_only_listed_scripts_and_styles() {
        // SHA-256 of the empty string in Base64.
        let empty = "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='";
        let policy = policy(&[""], &[""]);
        assert!(policy.starts_with("default-src 'none'; "));
        assert_eq!(policy.matches(empty).count(), 2);
        assert!(!policy.contains("unsafe") && !policy.contains("http"));
    }
}
