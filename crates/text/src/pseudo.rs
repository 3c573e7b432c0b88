//! Pseudo language: accents on all letters, and every vowel twice.

use std::borrow::Cow;

/// Plain letters and their replacements (Latin-1, Latin Extended-A), which the fonts of the window contain.
const LETTERS: [(&str, &str); 2] =
    [("abcdefghijklmnopqrstuvwxyz", "áƀçđéƒğĥíĵķĺmñóþqŕšţúvŵxýž"), ("ABCDEFGHIJKLMNOPQRSTUVWXYZ", "ÁƁÇĐÉƑĞĤÍĴĶĹMÑÓÞQŔŠŢÚVŴXÝŽ")];
/// Letters that are doubled: texts become about a third longer, as translations do.
const DOUBLED: &str = "aeiou";

/// Returns a text in the pseudo language.
pub fn pseudo(text: &str) -> Cow<'_, str> {
    let mut changed = String::with_capacity(2 * text.len());
    for letter in text.chars() {
        let replaced = accented(letter);
        changed.push(replaced);
        if DOUBLED.contains(letter) {
            changed.push(replaced);
        }
    }
    Cow::Owned(changed)
}

fn accented(letter: char) -> char {
    let replaced = |(plain, accented): (&str, &str)| plain.chars().zip(accented.chars()).find(|(from, _)| *from == letter);
    LETTERS.into_iter().find_map(replaced).map_or(letter, |(_, to)| to)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_letters_get_accents_and_other_characters_stay() {
        assert_eq!(pseudo("Fly to task 2: 14 m"), "Ƒĺý ţóó ţáášķ 2: 14 m");
        for (plain, accented) in LETTERS {
            assert_eq!(plain.chars().count(), accented.chars().count());
        }
    }
}
