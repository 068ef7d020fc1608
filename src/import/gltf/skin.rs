//! Skins, and the pose in which they were bound.
//!
//! A skin says where each joint was when the mesh was bound to it (the inverse of its inverse bind matrix), in
//! the frame of the mesh. That frame often lies on its side or has another scale than the scene. The bind pose is
//! therefore brought to where the file puts the topmost joint: reference and poses share scale and orientation.

use super::accessor::Accessor;
use super::buffers::Buffers;
use super::document::Document;
use super::nodes::Nodes;
use crate::import::ImportError;
use glam::{DAffine3, DMat3, DVec3};
use gltf::json::accessor::Type;

/// The joints of a skin.
#[derive(Clone, Debug)]
pub struct Skin {
    /// The nodes that are its joints.
    pub joints: Vec<usize>,
    /// From the frame of the mesh to that of each joint.
    pub inverse_binds: Vec<DAffine3>,
}

impl Skin {
    /// Reads skin `index`.
    pub fn read(document: &Document, buffers: &Buffers, index: usize) -> Result<Self, ImportError> {
        let wrong = |what: String| ImportError(format!("skin {index} of {} {what}; export it again", document.name));
        let entry = document.skins.get(index).ok_or_else(|| wrong("does not exist".into()))?;
        let joints: Vec<usize> = entry.joints.iter().map(gltf::json::Index::value).collect();
        if let Some(joint) = joints.iter().find(|&&joint| joint >= document.nodes.len()) {
            return Err(wrong(format!("names node {joint} as a joint, which does not exist")));
        }
        if joints.is_empty() {
            return Err(wrong("has no joints".into()));
        }
        let inverse_binds = match entry.inverse_bind_matrices {
            None => vec![DAffine3::IDENTITY; joints.len()],
            Some(accessor) => {
                let purpose = format!("inverse bind matrices of skin {index}");
                let matrices = Accessor::open(document, buffers, accessor.value(), &purpose)?;
                matrices.expect_shape(Type::Mat4)?;
                if matrices.len() < joints.len() {
                    return Err(matrices.wrong(&format!(
                        "has {} elements for {} joints",
                        matrices.len(),
                        joints.len()
                    )));
                }
                (0..joints.len()).map(|k| matrices.numbers(k).map(affine)).collect::<Result<_, _>>()?
            }
        };
        Ok(Self { joints, inverse_binds })
    }

    /// From the frame of the mesh to the world, by joint.
    pub fn matrices(&self, worlds: &[DAffine3]) -> Vec<DAffine3> {
        self.joints.iter().zip(&self.inverse_binds).map(|(&joint, bind)| worlds[joint] * *bind).collect()
    }
}

fn affine(m: [f64; 16]) -> DAffine3 {
    let column = |k: usize| DVec3::new(m[4 * k], m[4 * k + 1], m[4 * k + 2]);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}

/// The bind pose of a file.
pub struct BindPose {
    /// For each skin, from the frame of its mesh to the world.
    pub skins: Vec<DAffine3>,
    /// For each node its place: joints where the skins say, what hangs on a joint moved along with it.
    pub worlds: Vec<DAffine3>,
}

/// Finds the bind pose from the skins and the nodes' default places `worlds`.
///
/// Skins that share joints (a body and its clothes) are bound in one common pose: the skin with the most joints
/// comes first, and every later one is placed by the topmost joint whose bind place is known already.
pub fn bind_pose(skins: &[Skin], nodes: &Nodes, worlds: &[DAffine3]) -> BindPose {
    let depths = nodes.depths();
    let mut bound: Vec<Option<DAffine3>> = vec![None; worlds.len()];
    let mut placed = vec![DAffine3::IDENTITY; skins.len()];
    let mut order: Vec<usize> = (0..skins.len()).collect();
    order.sort_by_key(|&s| (std::cmp::Reverse(skins[s].joints.len()), s));
    for s in order {
        let skin = &skins[s];
        let mut top_down: Vec<usize> = (0..skin.joints.len()).collect();
        top_down.sort_by_key(|&k| (depths[skin.joints[k]], k));
        let known = |&k: &usize| bound[skin.joints[k]].map(|world| world * skin.inverse_binds[k]);
        let hanging = |&k: &usize| Some(carried(skin.joints[k], &bound, nodes, worlds) * skin.inverse_binds[k]);
        let place = top_down.iter().filter_map(known).find(is_sound);
        let place = place.or_else(|| top_down.iter().filter_map(hanging).find(is_sound)).unwrap_or(DAffine3::IDENTITY);
        placed[s] = place;
        for (&joint, inverse) in skin.joints.iter().zip(&skin.inverse_binds) {
            if bound[joint].is_none() && is_sound(inverse) {
                bound[joint] = Some(place * inverse.inverse());
            }
        }
    }
    let mut all = worlds.to_vec();
    for &node in &nodes.order {
        all[node] = match (bound[node], nodes.parents[node]) {
            (Some(world), _) => world,
            (None, Some(parent)) => all[parent] * nodes.locals[node].affine(),
            (None, None) => worlds[node],
        };
    }
    BindPose { skins: placed, worlds: all }
}

/// Where a node is when its nearest bound ancestor is in its bind place.
fn carried(node: usize, bound: &[Option<DAffine3>], nodes: &Nodes, worlds: &[DAffine3]) -> DAffine3 {
    let mut above = nodes.parents[node];
    while let Some(ancestor) = above {
        if let Some(world) = bound[ancestor]
            && is_sound(&worlds[ancestor])
        {
            return world * worlds[ancestor].inverse() * worlds[node];
        }
        above = nodes.parents[ancestor];
    }
    worlds[node]
}

/// True for a map that can be inverted: finite, and no axis flattened.
fn is_sound(map: &DAffine3) -> bool {
    let m = map.matrix3;
    let size = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    map.is_finite() && size > 1e-30 && m.determinant().abs() > 1e-9 * size
}
