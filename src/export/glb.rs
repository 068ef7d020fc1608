//! A moving mesh as one GLB file, exactly.
//!
//! glTF 2.0 (Khronos Group, ISO/IEC 12113:2022), binary form. Every part is a primitive with its own material;
//! all of them share one set of positions. Every pose is a morph target, and one animation shows them one after
//! the other at their times. That plays back exactly the positions of the sequence (as 32-bit floats) in any
//! viewer, whatever made them move.

use super::container::{Writer, single};
use super::cover::Cover;
use super::timing;
use crate::sequence::Sequence;
use glam::{DVec3, Vec3};
use serde_json::{Value, json};

/// Normals are written for smooth shading unless positions alone take more bytes than this; then viewers shade flat.
const SMOOTH_LIMIT: usize = 24 << 20;

/// The sequence as a GLB file with one primitive and one material a part, called "part 1" and so on.
///
/// `labels` is #F part numbers (faces without a label count as part 0), `colours` linear RGB by part, 0 to 1. The
/// animation has a key at the time of every pose; if the last pose leads back to the first, one more key closes
/// the loop. Coordinates beyond the range of 32-bit floats are brought into it.
pub fn parts(sequence: &Sequence, labels: &[u32], colours: &[[f32; 3]]) -> Vec<u8> {
    named_parts(sequence, labels, colours, &[])
}

/// The same, with the names of the parts as names of their materials.
pub fn named_parts(sequence: &Sequence, labels: &[u32], colours: &[[f32; 3]], names: &[String]) -> Vec<u8> {
    covered(sequence, Cover::painted(sequence.faces(), labels, colours, names))
}

/// The sequence as a GLB file with a morph target for every pose, under a cover of its faces.
pub(super) fn covered(sequence: &Sequence, cover: Cover) -> Vec<u8> {
    let mut file = Writer::default();
    let mut document = json!({
        "asset": Writer::asset(),
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": sequence.name() }],
    });
    if !sequence.faces().is_empty() {
        let Vertices { reference, targets } = Vertices::write(sequence, &cover, &mut file);
        let primitives = cover.write(&mut file, &mut document, reference, &targets);
        document["nodes"][0]["mesh"] = json!(0);
        document["meshes"] = json!([{ "name": sequence.name(), "primitives": primitives }]);
        if !targets.is_empty() {
            document["meshes"][0]["weights"] = json!(vec![0.0; targets.len()]);
            document["meshes"][0]["extras"] = json!({ "targetNames": pose_names(sequence) });
            document["animations"] = json!([animation(sequence, &mut file)]);
        }
    }
    file.finish(document)
}

fn pose_names(sequence: &Sequence) -> Vec<&str> {
    sequence.poses().iter().map(|pose| pose.name.as_str()).collect()
}

/// Accessors that all primitives share.
struct Vertices {
    reference: Value,
    targets: Vec<Value>,
}

impl Vertices {
    fn write(sequence: &Sequence, cover: &Cover, file: &mut Writer) -> Self {
        let reference = cover.spread(sequence.reference());
        let base: Vec<Vec3> = reference.iter().map(|&p| single(p)).collect();
        let smooth = 12 * base.len() * (1 + sequence.poses().len()) <= SMOOTH_LIMIT;
        let base_normals = if smooth { cover.normals(&reference) } else { None };
        let mut attributes = json!({ "POSITION": file.vectors(&base) });
        if let Some(normals) = &base_normals {
            attributes["NORMAL"] = json!(file.vectors(normals));
        }
        let mut targets = Vec::with_capacity(sequence.poses().len());
        for pose in sequence.poses() {
            let positions = cover.spread(&pose.positions);
            let moved = positions.iter().zip(&base).map(|(&p, b)| single(p - b.as_dvec3()));
            let mut target = json!({ "POSITION": file.vectors(&moved.collect::<Vec<_>>()) });
            if let Some((base, turned)) = base_normals.as_ref().zip(cover.normals(&positions)) {
                let turned: Vec<Vec3> = turned.iter().zip(base).map(|(n, b)| *n - *b).collect();
                target["NORMAL"] = json!(file.vectors(&turned));
            }
            targets.push(target);
        }
        Self { reference: attributes, targets }
    }
}

/// One weight a pose, 1 at its own time.
fn animation(sequence: &Sequence, file: &mut Writer) -> Value {
    let poses = sequence.poses().len();
    let mut times = timing::from_zero(sequence.poses().iter().map(|pose| pose.time));
    let positions: Vec<&[DVec3]> = sequence.poses().iter().map(|pose| pose.positions.as_slice()).collect();
    if timing::closes(poses, |a, b| timing::step(positions[a], positions[b])) {
        timing::close(&mut times);
    }
    let mut weights = vec![0.0f32; times.len() * poses];
    for key in 0..times.len() {
        weights[key * poses + key % poses] = 1.0;
    }
    let input = file.times(&times);
    let output = file.scalars(&weights);
    json!({
        "name": sequence.name(),
        "samplers": [{ "input": input, "output": output, "interpolation": "LINEAR" }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::Pose;
    use crate::zoo::{Recipe, make};

    fn floats(blob: &[u8], accessor: &gltf::Accessor) -> Vec<f32> {
        let view = accessor.view().unwrap();
        let start = view.offset() + accessor.offset();
        let count = accessor.count() * accessor.dimensions().multiplicity();
        blob[start..start + 4 * count].chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect()
    }

    #[test]
    fn plays_back_every_pose() {
        let creature = make(&Recipe { faces: 1500, poses: 6, ..Recipe::default() }).unwrap();
        let sequence = &creature.sequence;
        let colours = vec![[0.25, 0.5, 0.75]; creature.parts.len()];
        let bytes = named_parts(sequence, &creature.labels, &colours, &creature.parts);
        let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
        let blob = gltf.blob.as_deref().unwrap();
        let mesh = gltf.meshes().next().unwrap();
        assert_eq!(mesh.primitives().len(), creature.parts.len());
        let mut faces = 0;
        for primitive in mesh.primitives() {
            let name = primitive.material().name().unwrap().to_owned();
            let part = creature.parts.iter().position(|p| *p == name).unwrap();
            let indices = primitive.indices().unwrap();
            assert_eq!(indices.count() / 3, creature.labels.iter().filter(|&&l| l as usize == part).count());
            faces += indices.count() / 3;
            let base = floats(blob, &primitive.get(&gltf::Semantic::Positions).unwrap());
            assert_eq!(primitive.morph_targets().len(), 6);
            for (target, pose) in primitive.morph_targets().zip(sequence.poses()) {
                let moved = floats(blob, &target.positions().unwrap());
                for (v, p) in pose.positions.iter().enumerate() {
                    for k in 0..3 {
                        assert!((f64::from(base[3 * v + k] + moved[3 * v + k]) - p[k]).abs() < 1e-6);
                    }
                }
            }
        }
        assert_eq!(faces, sequence.faces().len());
        let animation = gltf.animations().next().unwrap();
        let sampler = animation.channels().next().unwrap().sampler();
        let (times, weights) = (floats(blob, &sampler.input()), floats(blob, &sampler.output()));
        assert_eq!(times.len(), 7, "a key for every pose and one that closes the loop");
        assert!((f64::from(times[6]) - 1.2 * f64::from(times[5])).abs() < 1e-6);
        assert_eq!(weights.len(), 7 * 6);
        for (key, row) in weights.chunks_exact(6).enumerate() {
            let one = row.iter().position(|&w| w == 1.0);
            assert_eq!(one, Some(key % 6));
            assert_eq!(row.iter().sum::<f32>(), 1.0);
        }
    }

    #[test]
    fn writes_still_and_empty_meshes_and_odd_labels() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let faces = vec![[0, 1, 2], [0, 2, 3]];
        let still = Sequence::new("still", faces.clone(), points.clone(), vec![]).unwrap();
        let gltf = gltf::Gltf::from_slice(&parts(&still, &[7], &[])).unwrap();
        let names: Vec<_> = gltf.materials().map(|m| m.name().unwrap().to_owned()).collect();
        assert_eq!(names, ["part 1", "part 8"]);
        assert_eq!(gltf.animations().len(), 0);
        let empty = Sequence::new("empty", vec![], vec![], vec![]).unwrap();
        assert_eq!(gltf::Gltf::from_slice(&parts(&empty, &[], &[])).unwrap().meshes().len(), 0);
        let pose = |time: f64| Pose { name: String::new(), time, positions: points.clone() };
        let same_time = Sequence::new("x", faces, points.clone(), vec![pose(3.0), pose(3.0)]).unwrap();
        let bytes = parts(&same_time, &[0, 0], &[[2.0, f32::NAN, 0.0]]);
        let gltf = gltf::Gltf::from_slice(&bytes).unwrap();
        let input = gltf.animations().next().unwrap().channels().next().unwrap().sampler().input();
        assert_eq!(floats(gltf.blob.as_deref().unwrap(), &input), [0.0, timing::STEP]);
    }
}
