//! The order in which a person would list files: `mesh.2` before `mesh.10`, the resting pose before all.

use super::File;
use std::cmp::Ordering;

/// Words that mark a file as the reference pose.
const RESTING: &[&str] = &["rest", "reference", "ref", "base", "bind", "neutral", "tpose"];

/// Sorts files as a person would list them; those whose name has a word for the resting pose (`rest`,
/// `reference`, `ref`, `base`, `bind`, `neutral`, `tpose`) come first.
pub fn natural_order(files: &mut [File]) {
    files.sort_by(|a, b| order(&a.name, &b.name));
}

/// The same for borrowed files.
pub(super) fn sort(files: &mut [&File]) {
    files.sort_by(|a, b| order(&a.name, &b.name));
}

fn order(a: &str, b: &str) -> Ordering {
    is_resting(b).cmp(&is_resting(a)).then_with(|| compare(a, b))
}

/// Compares names with the numbers in them taken as numbers and letters of either case taken as one.
fn compare(a: &str, b: &str) -> Ordering {
    let (mut left, mut right) = (a, b);
    loop {
        let (x, x_rest) = chunk(left);
        let (y, y_rest) = chunk(right);
        let order = match (is_number(x), is_number(y)) {
            (true, true) => compare_numbers(x, y),
            _ => x.to_lowercase().cmp(&y.to_lowercase()),
        };
        if order != Ordering::Equal {
            return order;
        }
        if x.is_empty() && y.is_empty() {
            return a.cmp(b);
        }
        (left, right) = (x_rest, y_rest);
    }
}

fn is_resting(name: &str) -> bool {
    let last = name.rsplit(['/', '\\']).next().unwrap_or(name).to_lowercase();
    let stem = last.rsplit_once('.').map_or(last.as_str(), |(stem, _)| stem);
    stem.split(|c: char| !c.is_alphabetic()).any(|word| RESTING.contains(&word))
}

/// The longest beginning that is all digits or has none, and the remainder.
fn chunk(text: &str) -> (&str, &str) {
    let digits = text.starts_with(|c: char| c.is_ascii_digit());
    text.split_at(text.find(|c: char| c.is_ascii_digit() != digits).unwrap_or(text.len()))
}

fn is_number(chunk: &str) -> bool {
    chunk.starts_with(|c: char| c.is_ascii_digit())
}

fn compare_numbers(a: &str, b: &str) -> Ordering {
    let (a, b) = (a.trim_start_matches('0'), b.trim_start_matches('0'));
    a.len().cmp(&b.len()).then_with(|| a.cmp(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sorted(names: &[&str]) -> Vec<String> {
        let mut files: Vec<File> = names.iter().map(|n| File { name: (*n).into(), bytes: Vec::new() }).collect();
        natural_order(&mut files);
        files.into_iter().map(|f| f.name).collect()
    }

    #[test]
    fn numbers_count_as_numbers() {
        assert_eq!(sorted(&["mesh.10.obj", "mesh.2.obj", "Mesh.1.obj"]), ["Mesh.1.obj", "mesh.2.obj", "mesh.10.obj"]);
        assert_eq!(sorted(&["a007", "a7", "a06"]), ["a06", "a007", "a7"]);
        assert_eq!(sorted(&["b", "a1", "a"]), ["a", "a1", "b"]);
    }

    #[test]
    fn the_resting_pose_comes_first() {
        assert_eq!(sorted(&["horse-01.obj", "horse-reference.obj"]), ["horse-reference.obj", "horse-01.obj"]);
        assert_eq!(sorted(&["d/frame_1.obj", "d/rest.obj"]), ["d/rest.obj", "d/frame_1.obj"]);
        assert_eq!(sorted(&["forest2.obj", "forest10.obj"]), ["forest2.obj", "forest10.obj"]);
    }
}
