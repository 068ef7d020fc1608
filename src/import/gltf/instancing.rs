//! Nodes that repeat their mesh: `EXT_mesh_gpu_instancing`.

use super::accessor::Accessor;
use super::buffers::Buffers;
use super::document::Document;
use super::nodes::{Local, Trs, rotation};
use crate::import::ImportError;
use crate::import::limits::Budget;
use glam::{DAffine3, DQuat, DVec3};
use gltf::json::accessor::Type;

/// Where the copies of a node's mesh are, in the node's frame; one in its origin for a node that repeats nothing.
pub fn places(
    document: &Document,
    buffers: &Buffers,
    node: usize,
    budget: &mut Budget,
) -> Result<Vec<DAffine3>, ImportError> {
    let Some(entry) = document.extensions.instancing.get(&node) else { return Ok(vec![DAffine3::IDENTITY]) };
    let whose = document.node_name(node);
    let open = |name: &str, shape: Type| -> Result<Option<Accessor>, ImportError> {
        let Some(&index) = entry.attributes.get(name) else { return Ok(None) };
        let accessor = Accessor::open(document, buffers, index, &format!("instances of {whose}"))?;
        accessor.expect_shape(shape)?;
        Ok(Some(accessor))
    };
    let translations = open("TRANSLATION", Type::Vec3)?;
    let rotations = open("ROTATION", Type::Vec4)?;
    let scales = open("SCALE", Type::Vec3)?;
    let mut given = [&translations, &rotations, &scales].into_iter().flatten();
    let Some(first) = given.next() else { return Ok(vec![DAffine3::IDENTITY]) };
    for other in given {
        other.expect_len(first.len(), first.label())?;
    }
    budget.take(first.len() as u64, size_of::<DAffine3>() as u64, &format!("the list of instances of {whose}"))?;
    let vector = |accessor: &Option<Accessor>, at: usize, otherwise: DVec3| match accessor {
        Some(accessor) => accessor.numbers(at).map(DVec3::from_array),
        None => Ok(otherwise),
    };
    let place = |at: usize| -> Result<DAffine3, ImportError> {
        let rotation = match &rotations {
            Some(accessor) => rotation(DQuat::from_array(accessor.numbers(at)?)),
            None => DQuat::IDENTITY,
        };
        let (translation, scale) = (vector(&translations, at, DVec3::ZERO)?, vector(&scales, at, DVec3::ONE)?);
        Ok(Local::Trs(Trs { translation, rotation, scale }).affine())
    };
    (0..first.len()).map(place).collect()
}
