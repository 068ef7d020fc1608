//! Sequences kept as NumPy archives beside a checkout: `rest` (V,3), `faces` (F,3), `frames` (K,V,3).

use glam::DVec3;
use sinew::sequence::{Pose, Sequence};
use std::fs::File;
use std::path::{Path, PathBuf};
use zip::ZipArchive;

/// The folder with data to measure with, where there is one; else a sentence is printed that says what is left out.
pub fn data(left_out: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if !folder.is_dir() {
        println!("left out: {left_out}, because there is no data folder beside the checkout");
        return None;
    }
    Some(folder)
}

/// Reads a sequence.
#[allow(dead_code)]
pub fn sequence(path: &Path) -> Sequence {
    let mut archive = open(path);
    let points = |(values, _): (Vec<f64>, _)| -> Vec<DVec3> { values.chunks_exact(3).map(DVec3::from_slice).collect() };
    let reference = points(array(&mut archive, "rest"));
    let frames = points(array(&mut archive, "frames"));
    let faces = array(&mut archive, "faces").0;
    let faces = faces.chunks_exact(3).map(|f| [f[0] as u32, f[1] as u32, f[2] as u32]).collect();
    let pose = |(i, positions): (usize, &[DVec3])| Pose {
        name: format!("frame {i}"),
        time: i as f64 / 12.0,
        positions: positions.to_vec(),
    };
    let poses = frames.chunks_exact(reference.len()).enumerate().map(pose).collect();
    let name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    Sequence::new(name, faces, reference, poses).expect("a sequence")
}

/// #F true parts from the (V, bones) skinning weights in `path`: the bone with the largest sum over a face's corners.
#[allow(dead_code)]
pub fn true_parts(path: &Path, faces: &[[u32; 3]]) -> Vec<u32> {
    let mut archive = open(path);
    let (weights, shape) = array(&mut archive, "W");
    let bones = shape[1];
    let sum = |face: &[u32; 3], bone: usize| face.iter().map(|&v| weights[v as usize * bones + bone]).sum::<f64>();
    let largest = |face| (0..bones).max_by(|&a, &b| sum(face, a).total_cmp(&sum(face, b))).unwrap_or(0) as u32;
    faces.iter().map(largest).collect()
}

/// NumPy's archives are ZIP archives with a file for each array.
fn open(path: &Path) -> ZipArchive<File> {
    ZipArchive::new(File::open(path).expect("a file")).expect("a NumPy archive")
}

/// An array in row-major order, and its shape.
fn array(archive: &mut ZipArchive<File>, name: &str) -> (Vec<f64>, Vec<usize>) {
    let file = archive.by_name(&format!("{name}.npy")).expect("an array of that name");
    let npy = npyz::NpyFile::new(file).expect("a NumPy array");
    let shape: Vec<usize> = npy.shape().iter().map(|&n| n as usize).collect();
    let by_columns = npy.header().order() == npyz::Order::Fortran;
    let kind = npy.dtype().descr();
    let values: Vec<f64> = match kind.trim_matches(|c| "'<|".contains(c)) {
        "f8" => npy.into_vec::<f64>().expect("doubles"),
        "f4" => npy.into_vec::<f32>().expect("floats").into_iter().map(f64::from).collect(),
        "i8" => npy.into_vec::<i64>().expect("integers").into_iter().map(|x| x as f64).collect(),
        "i4" => npy.into_vec::<i32>().expect("integers").into_iter().map(f64::from).collect(),
        other => panic!("arrays of {other} are not needed here"),
    };
    if !by_columns {
        return (values, shape);
    }
    let mut rows = vec![0.0; values.len()];
    for (i, &value) in values.iter().enumerate() {
        let (mut rest, mut place) = (i, 0);
        let index: Vec<usize> = shape.iter().map(|n| (rest % n, rest /= n).0).collect();
        for (n, k) in shape.iter().zip(index) {
            place = place * n + k;
        }
        rows[place] = value;
    }
    (rows, shape)
}

/// A list of points.
#[allow(dead_code)]
pub fn points(path: &Path, name: &str) -> Vec<DVec3> {
    values(path, name).chunks_exact(3).map(DVec3::from_slice).collect()
}

/// An array of vertex numbers, row by row.
#[allow(dead_code)]
pub fn numbers(path: &Path, name: &str) -> Vec<u32> {
    values(path, name).into_iter().map(|x| x as u32).collect()
}

/// An array, row by row.
#[allow(dead_code)]
pub fn values(path: &Path, name: &str) -> Vec<f64> {
    array(&mut open(path), name).0
}
