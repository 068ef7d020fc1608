//! The node tree: which nodes the scene shows, in which order, and where they are.

use super::document::Document;
use crate::import::ImportError;
use crate::warning::Warning;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use gltf::json;

/// Where a node is in its parent's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Local {
    /// As a matrix.
    Matrix(DAffine3),
    /// As translation, rotation and scale, which animations replace one by one.
    Trs(Trs),
}

/// Translation, rotation (of unit length) and scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trs {
    /// Translation.
    pub translation: DVec3,
    /// Rotation, of unit length.
    pub rotation: DQuat,
    /// Scale.
    pub scale: DVec3,
}

impl Local {
    /// As an affine map.
    pub fn affine(&self) -> DAffine3 {
        match self {
            Self::Matrix(matrix) => *matrix,
            Self::Trs(Trs { translation, rotation, scale }) => {
                DAffine3::from_scale_rotation_translation(*scale, *rotation, *translation)
            }
        }
    }

    /// Taken apart, so that one part of it can be animated. Shear is lost, as everywhere.
    pub fn trs(&self) -> Trs {
        match self {
            Self::Trs(trs) => *trs,
            Self::Matrix(matrix) => {
                let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
                let whole = scale.is_finite() && rotation.is_finite() && scale.min_element() != 0.0;
                let rotation = if whole { self::rotation(rotation) } else { DQuat::IDENTITY };
                Trs { translation, rotation, scale: if scale.is_finite() { scale } else { DVec3::ONE } }
            }
        }
    }
}

/// A quaternion that stands for a rotation: as it is where it has unit length but for rounding, else brought to
/// unit length; the identity for one without a direction.
///
/// Files written by hand round to three digits (0.707, 0.707). Viewers take these as they are; so does Sinew, that
/// it shows what they show.
pub fn rotation(q: DQuat) -> DQuat {
    let length = q.length();
    if (length - 1.0).abs() < ROUNDED {
        return q;
    }
    unit(q)
}

/// A quaternion at unit length; the identity for one without a direction.
pub fn unit(q: DQuat) -> DQuat {
    let length = q.length();
    if length > 1e-12 && length.is_finite() { q / length } else { DQuat::IDENTITY }
}

/// How far from unit length rounding to three digits takes a quaternion.
const ROUNDED: f64 = 1e-3;

/// Shoemake, *Animating rotation with quaternion curves* (1985), the short way round.
pub fn slerp(from: DQuat, to: DQuat, s: f64) -> DQuat {
    if from == to {
        return from;
    }
    let dot = from.dot(to);
    let (to, dot) = if dot < 0.0 { (-to, -dot) } else { (to, dot) };
    if dot > NEARLY_ONE {
        return unit(from * (1.0 - s) + to * s);
    }
    let angle = dot.acos();
    let sine = angle.sin();
    rotation(from * (((1.0 - s) * angle).sin() / sine) + to * ((s * angle).sin() / sine))
}

/// Cosine below which slerp is well-conditioned; above it the chord is as good as the arc.
const NEARLY_ONE: f64 = 0.9995;

/// The nodes of a file.
#[derive(Clone, Debug)]
pub struct Nodes {
    /// Each node's parent.
    pub parents: Vec<Option<usize>>,
    /// Each node's place where no clip moves it.
    pub locals: Vec<Local>,
    /// All nodes, parents before children.
    pub order: Vec<usize>,
    /// The nodes that the scene shows, in the order in which one walks the tree.
    pub shown: Vec<usize>,
}

impl Nodes {
    /// Checks the tree (no cycles, one parent each) and finds what the scene shows.
    pub fn read(document: &Document, warnings: &mut Vec<Warning>) -> Result<Self, ImportError> {
        let (parents, children) = family(document)?;
        let roots: Vec<usize> = (0..parents.len()).filter(|&n| parents[n].is_none()).collect();
        let order = walk(&roots, &children);
        if order.len() < parents.len() {
            let mut reached = vec![false; parents.len()];
            order.iter().for_each(|&n| reached[n] = true);
            let lost = reached.iter().position(|&r| !r).unwrap_or(0);
            return Err(ImportError(format!(
                "{} of {} is its own ancestor; the file is damaged, export it again",
                document.node_name(lost),
                document.name
            )));
        }
        let locals = (0..parents.len()).map(|n| local(document, n)).collect::<Result<_, _>>()?;
        let shown = shown(document, &roots, &children, warnings)?;
        Ok(Self { parents, locals, order, shown })
    }

    /// World transforms of all nodes with the given places in their parents' frames.
    pub fn worlds(&self, locals: &[Local]) -> Vec<DAffine3> {
        let mut worlds = vec![DAffine3::IDENTITY; self.parents.len()];
        for &node in &self.order {
            let local = locals[node].affine();
            worlds[node] = self.parents[node].map_or(local, |parent| worlds[parent] * local);
        }
        worlds
    }

    /// How far each node is from its root.
    pub fn depths(&self) -> Vec<usize> {
        let mut depths = vec![0; self.parents.len()];
        for &node in &self.order {
            depths[node] = self.parents[node].map_or(0, |parent| depths[parent] + 1);
        }
        depths
    }
}

type Family = (Vec<Option<usize>>, Vec<Vec<usize>>);

fn family(document: &Document) -> Result<Family, ImportError> {
    let count = document.nodes.len();
    let mut parents = vec![None; count];
    let mut children = vec![Vec::new(); count];
    for (node, entry) in document.nodes.iter().enumerate() {
        for child in entry.children.iter().flatten().map(json::Index::value) {
            let wrong = |what: String| {
                let (name, file) = (document.node_name(node), &document.name);
                Err(ImportError(format!("{name} of {file} {what}; the file is damaged, export it again")))
            };
            if child >= count {
                return wrong(format!("has child {child}, but there are only {count} nodes"));
            }
            if parents[child].is_some() {
                return wrong(format!("has child {child}, which already has a parent"));
            }
            parents[child] = Some(node);
            children[node].push(child);
        }
    }
    Ok((parents, children))
}

/// Nodes below the given ones, each once and before its children, siblings in order.
fn walk(roots: &[usize], children: &[Vec<usize>]) -> Vec<usize> {
    let mut waiting: Vec<usize> = roots.iter().rev().copied().collect();
    let mut seen = vec![false; children.len()];
    let mut order = Vec::new();
    while let Some(node) = waiting.pop() {
        if !std::mem::replace(&mut seen[node], true) {
            order.push(node);
            waiting.extend(children[node].iter().rev());
        }
    }
    order
}

fn shown(
    document: &Document,
    roots: &[usize],
    children: &[Vec<usize>],
    warnings: &mut Vec<Warning>,
) -> Result<Vec<usize>, ImportError> {
    let name = &document.name;
    if let Some(scene) = document.scene.filter(|&scene| scene >= document.scenes.len()) {
        warnings.push(Warning::new(
            "no-default-scene",
            format!("The file names scene {scene} as the one to show, which does not exist; another was taken."),
        ));
    }
    let default = document.scene.and_then(|scene| document.scenes.get(scene)).or(document.scenes.first());
    let all = || walk(roots, children);
    let Some(scene) = default else { return Ok(all()) };
    let mut tops: Vec<usize> = Vec::new();
    for node in scene.nodes.iter().map(json::Index::value) {
        if node >= children.len() {
            return Err(ImportError(format!(
                "the scene of {name} shows node {node}, but there are only {} nodes; the file is damaged, export it \
                 again",
                children.len()
            )));
        }
        tops.push(node);
    }
    let nodes = walk(&tops, children);
    let has_mesh = |nodes: &[usize]| nodes.iter().any(|&n| document.nodes[n].mesh.is_some());
    if !has_mesh(&nodes) {
        let everything = all();
        if has_mesh(&everything) {
            warnings.push(Warning::new(
                "empty-scene",
                "The scene to show has no mesh; the nodes outside it were taken as well.",
            ));
            return Ok(everything);
        }
    }
    Ok(nodes)
}

fn local(document: &Document, node: usize) -> Result<Local, ImportError> {
    let entry = &document.nodes[node];
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let local = match entry.matrix {
        Some(m) => {
            let column = |k: usize| DVec3::new(f64::from(m[4 * k]), f64::from(m[4 * k + 1]), f64::from(m[4 * k + 2]));
            let linear = DMat3::from_cols(column(0), column(1), column(2));
            Local::Matrix(DAffine3 { matrix3: linear, translation: column(3) })
        }
        None => {
            let [x, y, z, w] = entry.rotation.map_or([0.0, 0.0, 0.0, 1.0], |r| r.0).map(f64::from);
            Local::Trs(Trs {
                translation: entry.translation.map_or(DVec3::ZERO, vector),
                rotation: rotation(DQuat::from_xyzw(x, y, z, w)),
                scale: entry.scale.map_or(DVec3::ONE, vector),
            })
        }
    };
    if !local.affine().is_finite() {
        return Err(ImportError(format!(
            "{} of {} is placed by numbers that are not finite; the file is damaged, export it again",
            document.node_name(node),
            document.name
        )));
    }
    Ok(local)
}
