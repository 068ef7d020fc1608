//! The file of a skin: nodes, skin, mesh, animation.

use super::Skin;
use super::chain::{Link, is_single};
use super::influences::Joints;
use crate::export::animation::CLAY;
use crate::export::container::{Writer, single};
use crate::export::cover::Cover;
use glam::{DVec3, Mat4, Vec3};
use serde_json::{Value, json};

/// A scale is written if it ever differs from 1 by more than this.
const UNSCALED: f64 = 1e-9;

/// The nodes are the mesh (0), the root of the handles (1) and then those of the handles.
pub fn write(skin: &Skin, tracks: &[Vec<Link>], centres: &[DVec3], joints: &[Joints]) -> Vec<u8> {
    let mut file = Writer::default();
    let mut document = json!({
        "asset": Writer::asset(),
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": skin.name }],
    });
    if !skin.faces.is_empty() {
        let mut nodes = vec![json!({ "name": skin.name, "mesh": 0, "skin": 0 }), json!({ "name": "handles" })];
        let mut animation = Animation::default();
        let (mut tops, mut bones) = (Vec::new(), Vec::new());
        for (handle, (track, &centre)) in tracks.iter().zip(centres).enumerate() {
            let outer = nodes.len();
            let place = centre.as_vec3().as_dvec3().to_array();
            nodes.push(json!({ "name": format!("handle {}", handle + 1), "translation": place }));
            tops.push(outer);
            let inner = (!is_single(track)).then(|| {
                nodes.push(json!({ "name": format!("handle {}, shear", handle + 1) }));
                nodes[outer]["children"] = json!([outer + 1]);
                outer + 1
            });
            bones.push(inner.unwrap_or(outer));
            animation.handle(outer, inner, track, &mut file);
        }
        nodes[1]["children"] = json!(tops);
        let binds: Vec<Mat4> = centres.iter().map(|c| Mat4::from_translation(-c.as_vec3())).collect();
        document["skins"] = json!([{ "joints": bones, "skeleton": 1, "inverseBindMatrices": file.binds(&binds) }]);
        document["scenes"] = json!([{ "nodes": [0, 1] }]);
        document["nodes"] = json!(nodes);
        let primitives = primitives(skin, joints, &mut file, &mut document);
        document["meshes"] = json!([{ "name": skin.name, "primitives": primitives }]);
        if !animation.channels.is_empty() {
            document["animations"] = json!([{
                "name": skin.name,
                "channels": animation.channels,
                "samplers": animation.samplers,
                "extras": { "poseNames": skin.poses.iter().map(|pose| pose.name).collect::<Vec<_>>() },
            }]);
        }
    }
    file.finish(document)
}

fn primitives(skin: &Skin, joints: &[Joints], file: &mut Writer, document: &mut Value) -> Value {
    let cover = Cover::own(skin.look, skin.reference.len(), skin.faces, CLAY, skin.name);
    let reference = cover.spread(skin.reference);
    let positions: Vec<Vec3> = reference.iter().map(|&p| single(p)).collect();
    let mut attributes = json!({ "POSITION": file.vectors(&positions) });
    if let Some(normals) = cover.normals(&reference) {
        attributes["NORMAL"] = json!(file.vectors(&normals));
    }
    let joints: Vec<&Joints> = cover.spread(&joints.iter().collect::<Vec<_>>());
    let sets = joints.first().map_or(1, |joints| joints.len() / 4);
    for set in 0..sets {
        let four = |joints: &Joints, k: usize| joints.get(4 * set + k).copied().unwrap_or_default();
        let numbers: Vec<[u16; 4]> = joints.iter().map(|j| std::array::from_fn(|k| four(j, k).0)).collect();
        let weights: Vec<[f32; 4]> = joints.iter().map(|j| std::array::from_fn(|k| four(j, k).1)).collect();
        attributes[format!("JOINTS_{set}")] = json!(file.joints(&numbers, skin.handles));
        attributes[format!("WEIGHTS_{set}")] = json!(file.weights(&weights));
    }
    cover.write(file, document, attributes, &[])
}

/// Channels and samplers, growing together. Handles with keys at the same times share them.
#[derive(Default)]
struct Animation {
    channels: Vec<Value>,
    samplers: Vec<Value>,
    times: Vec<(Vec<f32>, usize)>,
}

impl Animation {
    fn handle(&mut self, outer: usize, inner: Option<usize>, track: &[Link], file: &mut Writer) {
        if track.is_empty() {
            return;
        }
        let input = self.times(track, file);
        let places = file.shifts(track.iter().map(|key| single(key.place)));
        self.channel(outer, "translation", input, places);
        let turns = file.turns(track.iter().map(|key| key.outer.as_quat().normalize()));
        self.channel(outer, "rotation", input, turns);
        if track.iter().any(|key| (key.scale - DVec3::ONE).abs().max_element() > UNSCALED) {
            let scales = file.shifts(track.iter().map(|key| single(key.scale)));
            self.channel(outer, "scale", input, scales);
        }
        if let Some(inner) = inner {
            let turns = file.turns(track.iter().map(|key| key.inner.as_quat().normalize()));
            self.channel(inner, "rotation", input, turns);
        }
    }

    fn times(&mut self, track: &[Link], file: &mut Writer) -> usize {
        let times: Vec<f32> = track.iter().map(|key| key.time).collect();
        if let Some((_, known)) = self.times.iter().find(|(other, _)| *other == times) {
            return *known;
        }
        let input = file.times(&times);
        self.times.push((times, input));
        input
    }

    fn channel(&mut self, node: usize, path: &str, input: usize, output: usize) {
        self.channels.push(json!({ "sampler": self.samplers.len(), "target": { "node": node, "path": path } }));
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
    }
}
