//! Estimates text widths for the layout, which has no access to the font.

/// Returns the width of a character as a fraction of the font size (egui's Ubuntu Light, by character class; slightly
/// wide to prevent overflow).
fn glyph_width(sign: char) -> f64 {
    match plain_letter(sign) {
        ' ' => 0.25,
        'm' | 'w' | 'M' | 'W' | '%' => 0.9,
        'f' | 'i' | 'j' | 'l' | 'r' | 't' | '.' | ',' | ':' | '/' | '(' | ')' | '-' | '°' | '?' | '\'' | '¿' | '¡' => 0.38,
        '0'..='9' => 0.57,
        'A'..='Z' | 'Þ' => 0.64,
        'ß' | 'ð' | 'þ' | '„' | '“' | '”' | '«' | '»' | '±' | '–' => 0.58,
        sign if sign.is_ascii() => 0.58,
        // Characters of other scripts may be as wide as they are tall.
        _ => 1.0,
    }
}

/// Letters with accents (Latin-1 and Latin Extended-A), each group after its plain letter.
const ACCENTED: [&str; 44] = [
    "AÀÁÂÃÄÅĀĂĄ",
    "aàáâãäåāăą",
    "CÇĆĈĊČ",
    "cçćĉċč",
    "DĎĐÐ",
    "dďđ",
    "EÈÉÊËĒĔĖĘĚ",
    "eèéêëēĕėęě",
    "GĜĞĠĢ",
    "gĝğġģ",
    "HĤĦ",
    "hĥħ",
    "IÌÍÎÏĨĪĬĮİ",
    "iìíîïĩīĭįı",
    "JĴ",
    "jĵ",
    "KĶ",
    "kķĸ",
    "LĹĻĽĿŁ",
    "lĺļľŀł",
    "NÑŃŅŇŊ",
    "nñńņňŋ",
    "OÒÓÔÕÖØŌŎŐ",
    "oòóôõöøōŏő",
    "RŔŖŘ",
    "rŕŗř",
    "SŚŜŞŠ",
    "sśŝşš",
    "TŢŤŦ",
    "tţťŧ",
    "UÙÚÛÜŨŪŬŮŰŲ",
    "uùúûüũūŭůűų",
    "WŴ",
    "wŵ",
    "YÝŶŸ",
    "yýÿŷ",
    "ZŹŻŽ",
    "zźżž",
    "BƁ",
    "bƀ",
    "FƑ",
    "fƒ",
    "VṼ",
    "vṽ",
];

/// Returns a letter without its accent, which does not change its width; other characters stay.
fn plain_letter(sign: char) -> char {
    if sign.is_ascii() {
        return sign;
    }
    ACCENTED.iter().find(|group| group.contains(sign)).and_then(|group| group.chars().next()).unwrap_or(sign)
}

/// Returns a font size at which a text fits into a width: the wanted one, or less.
#[must_use]
pub fn fitted(words: &str, size: f64, width: f64) -> f64 {
    size.min(size * width / text_width(words, size).max(1e-9))
}

/// Returns the approximate width of a line of text, in the same unit as the font size.
#[must_use]
pub fn text_width(words: &str, height: f64) -> f64 {
    height * words.chars().map(glyph_width).sum::<f64>()
}

/// Truncates a text until it fits and appends an ellipsis.
pub fn truncate_text(words: &str, fits: impl Fn(&str) -> bool) -> String {
    let mut kept = words.to_owned();
    let mut shown = kept.clone();
    while !fits(&shown) && kept.pop().is_some() {
        shown = format!("{}…", kept.trim_end());
    }
    shown
}

/// Wraps a text at spaces into at most `most` lines that satisfy `fits`, and truncates lines that are too long.
pub fn wrap_text(words: &str, most: usize, fits: impl Fn(&str) -> bool) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words.split(' ') {
        let full = lines.len() >= most;
        match lines.last_mut() {
            Some(line) if full || fits(&format!("{line} {word}")) => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines.iter().map(|line| truncate_text(line, &fits)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_text_wraps_at_spaces_and_is_truncated() {
        let ten = |line: &str| line.chars().count() <= 10;
        assert_eq!(wrap_text("a pier", 2, ten), ["a pier"]);
        assert_eq!(wrap_text("bridge member 7", 2, ten), ["bridge", "member 7"]);
        assert_eq!(wrap_text("bridge member arch/rib-left/07", 2, ten), ["bridge", "member ar…"]);
        assert_eq!(wrap_text("incomprehensible", 2, ten), ["incompreh…"]);
        assert_eq!(wrap_text("", 2, ten), [""]);
        assert_eq!(truncate_text("nothing fits", |_| false), "…");
    }

    #[test]
    fn exact_accents_do_not_change_the_width() {
        for (accented, plain) in
            [("Höhe über Straße", "Hohe uber Strase"), ("¿Distancia más pequeña?", "?Distancia mas pequena?")]
        {
            assert_eq!(text_width(accented, 1.0), text_width(plain, 1.0), "{accented}");
        }
        assert_eq!(text_width("橋", 1.0), 1.0, "other scripts are wide");
    }

    #[test]
    fn exact_estimated_widths_slightly_exceed_the_font_widths() {
        // Sums of the font's advance widths, as fractions of the font size.
        for (words, em) in [
            ("OFF THE PATH", 6.54),
            ("TOO CLOSE", 5.28),
            ("TOO FAST: limit 10 mph", 10.60),
            ("CRASH: bridge member arch/rib-left/07", 17.48),
            ("no battery data", 6.86),
            ("Position   GNSS lost (4)   LINK LOST 12 s", 17.31),
            ("12.3 m/s", 3.82),
            ("100%", 2.52),
            ("time left", 3.83),
        ] {
            let found = text_width(words, 1.0);
            assert!(found >= em && found < 1.2 * em, "{words}: {found} for {em}");
        }
    }
}
