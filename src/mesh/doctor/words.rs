//! Numbers in words.

use crate::warning::Warning;

/// `1 face`, `2 faces`, `12,345 faces`.
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{} {}", grouped(count), if count == 1 { one } else { many })
}

/// `12,345`.
pub fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// The importer's note of a kind, and the number that it begins with.
pub fn noted<'n>(notes: &'n [Warning], code: &str) -> Option<(usize, &'n str)> {
    let note = notes.iter().find(|note| note.code == code)?;
    let number = note.message.split_whitespace().next().and_then(|word| word.parse().ok());
    Some((number.unwrap_or(note.faces.len()), &note.message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_numbers_are_grouped() {
        assert_eq!(counted(1, "face", "faces"), "1 face");
        assert_eq!(counted(0, "face", "faces"), "0 faces");
        assert_eq!([999, 1_000, 1_234_567].map(grouped), ["999", "1,000", "1,234,567"]);
    }

    #[test]
    fn notes_tell_their_number() {
        let notes = [Warning::new("welded", "12 vertices were joined.")];
        assert_eq!(noted(&notes, "welded"), Some((12, "12 vertices were joined.")));
        assert_eq!(noted(&notes, "other"), None);
    }
}
