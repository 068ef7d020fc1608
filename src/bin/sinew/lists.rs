//! Files that name vertices, and files of pairs: lists, or what other commands report.

use crate::Refusal;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use sinew::transfer::Pair;
use std::path::Path;

/// Reads vertex numbers, counted from 0: separated by white space or commas, a JSON list, or the report of `sinew
/// keypoints`.
pub fn vertices(path: &Path) -> Result<Vec<u32>, Refusal> {
    #[derive(Deserialize)]
    struct Report {
        key_points: Vec<u32>,
    }
    let text = read(path)?;
    if text.trim_start().starts_with('{') {
        return json::<Report>(path, &text, "report of key points").map(|report| report.key_points);
    }
    let number = |word: &str| {
        let refusal = |_| Refusal(format!("{}: “{word}” is not a vertex number (0, 1, 2, …)", path.display()));
        word.parse().map_err(refusal)
    };
    let separator = |c: char| c.is_whitespace() || matches!(c, ',' | '[' | ']');
    text.split(separator).filter(|word| !word.is_empty()).map(number).collect()
}

/// Reads pairs: `[{"source": 12, "target": 34}, …]`; the report of `sinew propose` or `sinew transfer`, which has such a
/// list; or one `12, 34` a line, counted from 0, after an optional first line with their number (`.cons`).
pub fn pairs(path: &Path) -> Result<Vec<Pair>, Refusal> {
    #[derive(Deserialize)]
    struct Report {
        pairs: Vec<Pair>,
    }
    let text = read(path)?;
    match text.trim_start().chars().next() {
        Some('[') => json(path, &text, "list of pairs such as [{\"source\": 12, \"target\": 34}]"),
        Some('{') => json::<Report>(path, &text, "report with pairs").map(|report| report.pairs),
        _ => lines(&text).map_err(|what| Refusal(format!("{} is no list of pairs: {what}", path.display()))),
    }
}

fn read(path: &Path) -> Result<String, Refusal> {
    std::fs::read_to_string(path).map_err(|error| Refusal(format!("{} cannot be read: {error}", path.display())))
}

fn json<T: DeserializeOwned>(path: &Path, text: &str, what: &str) -> Result<T, Refusal> {
    serde_json::from_str(text).map_err(|error| Refusal(format!("{} is no {what}: {error}", path.display())))
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
