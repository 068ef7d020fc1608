//! Files of pairs: JSON, or lines of two numbers.

use crate::Refusal;
use sinew::transfer::Pair;
use std::path::Path;

/// Reads pairs: `[{"source": 12, "target": 34}, …]`, or one `12, 34` a line, counted from 0, after an optional first line
/// with their number (`.cons`).
pub fn pairs(path: &Path) -> Result<Vec<Pair>, Refusal> {
    let name = path.display();
    let text = std::fs::read_to_string(path).map_err(|error| Refusal(format!("{name} cannot be read: {error}")))?;
    if text.trim_start().starts_with(['[', '{']) {
        return serde_json::from_str(&text).map_err(|error| {
            Refusal(format!("{name} is no list of pairs such as [{{\"source\": 12, \"target\": 34}}]: {error}"))
        });
    }
    lines(&text).map_err(|what| Refusal(format!("{name} is no list of pairs: {what}")))
}

fn lines(text: &str) -> Result<Vec<Pair>, String> {
    let mut pairs = Vec::new();
    let mut promised = None;
    for (number, line) in text.lines().enumerate() {
        let words = line.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
        let numbers: Option<Vec<u32>> = words.map(|word| word.parse().ok()).collect();
        match numbers.as_deref() {
            Some([]) => {}
            Some([count]) if pairs.is_empty() && promised.is_none() => promised = Some(*count as usize),
            Some(&[source, target]) => pairs.push(Pair { source, target }),
            _ => return Err(format!("line {} is not two vertex numbers", number + 1)),
        }
    }
    match promised {
        Some(count) if count != pairs.len() => {
            Err(format!("its first line says {count}, but there are {}", pairs.len()))
        }
        _ => Ok(pairs),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_two_numbers() {
        let expected = vec![Pair { source: 750, target: 3386 }, Pair { source: 5, target: 0 }];
        assert_eq!(lines("2\n750, 3386\n5, 0\n"), Ok(expected.clone()));
        assert_eq!(lines("  750\t3386\n\n  5   0"), Ok(expected));
        assert!(lines("3\n1, 2\n").is_err());
        assert!(lines("1, 2, 3\n").is_err());
        assert!(lines("1, -2\n").is_err());
    }
}
