//! Lines and numbers of text formats.

use super::ImportError;

/// A text file, line by line: byte-order mark, any line ends, and bytes that are no text are all tolerated.
pub struct Lines<'a> {
    name: &'a str,
    left: &'a [u8],
    /// The number of the line that was returned last, from 1.
    number: usize,
}

impl<'a> Lines<'a> {
    /// The lines of the file called `name`.
    pub fn new(name: &'a str, bytes: &'a [u8]) -> Self {
        Self { name, left: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), number: 0 }
    }

    /// The next line without its end; `None` after the last.
    pub fn next_line(&mut self) -> Option<&'a [u8]> {
        if self.left.is_empty() {
            return None;
        }
        let end = self.left.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(self.left.len());
        let (line, rest) = self.left.split_at(end);
        self.left = rest.strip_prefix(b"\r\n").or_else(|| rest.get(1..)).unwrap_or_default();
        self.number += 1;
        Some(line)
    }

    /// The bytes after the line that was returned last.
    pub fn rest(&self) -> &'a [u8] {
        self.left
    }

    /// An error at the current line.
    pub fn wrong(&self, what: impl std::fmt::Display) -> ImportError {
        ImportError(format!("{}, line {}: {what}", self.name, self.number))
    }

    /// A finite number.
    pub fn number(&self, word: Option<&[u8]>) -> Result<f64, ImportError> {
        let word = word.ok_or_else(|| self.wrong("a number is missing"))?;
        let value: Option<f64> = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
        match value {
            Some(value) if value.is_finite() => Ok(value),
            Some(_) => Err(self.wrong(format!("{} is not a finite number", shown(word)))),
            None => Err(self.wrong(format!("{} is not a number", shown(word)))),
        }
    }

    /// A whole number.
    pub fn integer(&self, word: Option<&[u8]>) -> Result<i64, ImportError> {
        let word = word.ok_or_else(|| self.wrong("a whole number is missing"))?;
        let value = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
        value.ok_or_else(|| self.wrong(format!("{} is not a whole number", shown(word))))
    }
}

/// The words of a line.
pub fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// A word, short enough for a sentence.
pub fn shown(word: &[u8]) -> String {
    let text: String = String::from_utf8_lossy(word).chars().filter(|c| !c.is_control()).take(30).collect();
    format!("\"{text}\"")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_line_ends() {
        let mut lines = Lines::new("a", b"\xef\xbb\xbfone\r\ntwo\rthree\n\nfive");
        let mut all = Vec::new();
        while let Some(line) = lines.next_line() {
            all.push(String::from_utf8_lossy(line).into_owned());
        }
        assert_eq!(all, ["one", "two", "three", "", "five"]);
        assert_eq!(lines.number, 5);
    }

    #[test]
    fn numbers() {
        let lines = Lines::new("a", b"");
        assert_eq!(lines.number(Some(b"-1.5e3")), Ok(-1500.0));
        assert!(lines.number(Some(b"nan")).unwrap_err().0.contains("not a finite number"));
        assert!(lines.number(Some(b"1e999")).is_err());
        assert!(lines.number(None).is_err());
        assert!(lines.integer(Some(b"1.5")).is_err());
    }
}
