//! OBJ, OFF, PLY and STL files with the same faces, as the poses of one sequence.

use super::limits::Budget;
use super::polygons::PolygonMesh;
use super::{File, ImportError, Imported, Up, counted, obj, off, ply, seams, stl};
use crate::sequence::{Pose, Sequence};
use crate::warning::Warning;

/// Seconds from pose to pose: files have no times of their own.
const STEP: f64 = 1.0 / 12.0;

/// A format of still polygon meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Geomview OFF.
    Off,
    /// Stanford PLY.
    Ply,
    /// STL.
    Stl,
}

impl Format {
    /// The axis that is up in most files of it.
    fn up(self) -> Up {
        match self {
            Self::Obj | Self::Off | Self::Ply => Up::Y,
            Self::Stl => Up::Z,
        }
    }
}

/// The warning that files name other vertices in their faces.
pub const DIFFERENT: &str = "different-faces";

/// Reads files as poses: the first is the reference, the others its poses in the given order. What the reference looks
/// like is looked for `beside` it, if that is given.
pub fn open(files: &[(&File, Format)], beside: Option<&[File]>) -> Result<Imported, ImportError> {
    let Some((first, poses)) = files.split_first() else {
        return Err(ImportError("no OBJ, OFF, PLY or STL file was given".into()));
    };
    let name = &first.0.name;
    let mut warnings = Vec::new();
    let mut said = beside.filter(|_| first.1 == Format::Obj).map(|beside| (obj::Said::new(name), beside));
    let mut reference = read(first, said.as_mut().map(|(said, _)| said))?;
    let (mut faces, mut polygons) = reference.triangulate();
    if faces.is_empty() {
        return Err(ImportError(format!("{name} has no faces; Sinew needs a surface, not only points")));
    }
    Budget::new(name).poses(reference.positions.len() as u64, files.len() as u64)?;
    let look = said.and_then(|(said, beside)| said.look(name, beside, &reference, (&faces, &polygons)));
    note_polygons(&reference, &polygons, &mut warnings);
    let mut others = Vec::with_capacity(poses.len());
    let mut different = Vec::new();
    for (k, file) in poses.iter().enumerate() {
        let mesh = read(file, None)?;
        check_pose(name, &reference, &file.0.name, &mesh)?;
        if mesh.len() > 0 && !mesh.same_polygons(&reference) {
            different.push(file.0.name.clone());
        }
        others.push(Pose { name: file.0.name.clone(), time: k as f64 * STEP, positions: mesh.positions });
    }
    if let Some(example) = different.first() {
        warnings.push(Warning::new(
            DIFFERENT,
            format!(
                "The faces of {} (such as {example}) name other vertices than those of {name}; the faces of {name} \
                 were taken, which is right only if the vertices are the same ones in the same order.",
                counted(different.len(), "file", "files")
            ),
        ));
    }
    if others.is_empty() {
        warnings.push(Warning::new(
            "no-animation",
            "There is one file only, so the mesh stands still; give its other poses together with it to find parts.",
        ));
    }
    let input_faces = reference.len();
    if first.1 == Format::Stl {
        seams::weld_seams(&mut faces, &mut reference.positions, &mut others, None);
        if let Some(stay) = seams::drop_collapsed(&mut faces, &mut warnings) {
            polygons = stay.iter().map(|&f| polygons[f as usize]).collect();
        }
        if faces.is_empty() {
            return Err(ImportError(format!("all triangles of {name} are collapsed to a point or a line")));
        }
    }
    let cut = faces.len() != input_faces || polygons.iter().enumerate().any(|(f, &p)| f != p as usize);
    let wrong = |error: crate::sequence::SequenceError| ImportError(format!("{name}: {error}"));
    let paths: Vec<&str> = files.iter().map(|(file, _)| file.name.as_str()).collect();
    let mut sequence = Sequence::new(title(&paths), faces, reference.positions, others).map_err(wrong)?;
    if cut {
        sequence = sequence.with_polygons(polygons).map_err(wrong)?;
    }
    Ok(Imported { sequence, up: first.1.up(), clips: Vec::new(), clip: None, input_faces, look, warnings })
}

fn read((file, format): &(&File, Format), said: Option<&mut obj::Said>) -> Result<PolygonMesh, ImportError> {
    let mesh = match format {
        Format::Obj => obj::read(&file.name, &file.bytes, said),
        Format::Off => off::read(&file.name, &file.bytes),
        Format::Ply => ply::read(&file.name, &file.bytes),
        Format::Stl => stl::read(&file.name, &file.bytes),
    }?;
    mesh.check(&file.name)?;
    Ok(mesh)
}

fn check_pose(name: &str, reference: &PolygonMesh, pose_name: &str, pose: &PolygonMesh) -> Result<(), ImportError> {
    let (vertices, expected) = (pose.positions.len(), reference.positions.len());
    if vertices != expected {
        return Err(ImportError(format!(
            "{pose_name} has {vertices} vertices, but {name} has {expected}; all poses must be of one mesh"
        )));
    }
    // A pose may leave its faces away.
    if pose.len() != 0 && pose.len() != reference.len() {
        return Err(ImportError(format!(
            "{pose_name} has {} faces, but {name} has {}; all poses must be of one mesh",
            pose.len(),
            reference.len()
        )));
    }
    Ok(())
}

fn note_polygons(mesh: &PolygonMesh, polygons: &[u32], warnings: &mut Vec<Warning>) {
    let thin = (0..mesh.len()).filter(|&p| mesh.polygon(p).len() < 3).count();
    if thin > 0 {
        let what = format!("{} left out for want of a third corner.", counted(thin, "face was", "faces were"));
        warnings.push(Warning::new("thin-faces", what));
    }
    let repeats = |polygon: &[u32]| {
        let mut sorted = polygon.to_vec();
        sorted.sort_unstable();
        sorted.windows(2).any(|w| w[0] == w[1])
    };
    let of_polygon = |&f: &usize| repeats(mesh.polygon(polygons[f] as usize));
    let faces: Vec<u32> = (0..polygons.len()).filter(of_polygon).map(|f| f as u32).collect();
    if !faces.is_empty() {
        let what = format!(
            "{} a vertex twice; they were kept, so that faces keep their numbers.",
            counted(faces.len(), "triangle names", "triangles name")
        );
        warnings.push(Warning::on_faces("collapsed-faces", what, faces));
    }
}

/// What to call the sequence: the folder of its files, what their names begin with alike (the numbers left away), or
/// the first file.
fn title(paths: &[&str]) -> String {
    let first = paths.first().copied().unwrap_or_default();
    let [folder, file] = split(first);
    if paths.len() < 2 {
        return file.to_owned();
    }
    let named = split(folder)[1];
    if named.contains(char::is_alphanumeric) && paths.iter().all(|path| split(path)[0] == folder) {
        return named.to_owned();
    }
    let stem = |path| {
        let [_, file] = split(path);
        file.rsplit_once('.').map_or(file, |(stem, _)| stem)
    };
    let alike = paths.iter().fold(stem(first), |alike, path| {
        let pairs = alike.char_indices().zip(stem(path).chars());
        let same = pairs.take_while(|((_, a), b)| a == b).map(|((at, a), _)| at + a.len_utf8()).last();
        &alike[..same.unwrap_or(0)]
    });
    let alike = alike.trim_end_matches(|c: char| !c.is_alphabetic());
    if alike.chars().count() > 1 { alike.to_owned() } else { file.to_owned() }
}

/// The folder of a path, if it has one, and the name in it.
fn split(path: &str) -> [&str; 2] {
    path.rsplit_once(['/', '\\']).map_or(["", path], |(folder, name)| [folder, name])
}

#[cfg(test)]
mod tests {
    use super::title;

    #[test]
    fn a_sequence_is_named_after_what_its_files_share() {
        assert_eq!(title(&["horse/rest.obj", "horse/frame_1.obj"]), "horse");
        assert_eq!(title(&["models/horse/rest.obj", "models/horse/frame_1.obj"]), "horse");
        assert_eq!(title(&["horse-01.ply", "horse-02.ply"]), "horse");
        assert_eq!(title(&["a/camel_1.obj", "b/camel_2.obj"]), "camel");
        assert_eq!(title(&["rest.obj", "frame_1.obj"]), "rest.obj");
        assert_eq!(title(&["../bear1.obj", "../bear2.obj"]), "bear");
        assert_eq!(title(&["001.obj", "002.obj"]), "001.obj");
        assert_eq!(title(&["één1.obj", "één2.obj"]), "één");
        assert_eq!(title(&["a\\lion.off"]), "lion.off");
        assert_eq!(title(&[]), "");
    }
}
