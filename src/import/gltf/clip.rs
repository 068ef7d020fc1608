//! Clips: what their channels say at a time (glTF 2.0, appendix C).

use super::accessor::Accessor;
use super::buffers::Buffers;
use super::document::Document;
use super::nodes::{Local, rotation, slerp, unit};
use crate::import::ImportError;
use crate::import::limits::Budget;
use crate::warning::Warning;
use glam::{DQuat, DVec3};
use gltf::json::accessor::Type;
use gltf::json::animation::{Interpolation, Property};
use gltf::json::validation::Checked;

/// An animation, ready to be asked.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Its name, or its number where it has none.
    pub name: String,
    /// Time of its first key, in seconds.
    pub start: f64,
    /// Time of its last key.
    pub end: f64,
    /// What moves.
    pub channels: Vec<Channel>,
}

/// One animated property of one node.
#[derive(Clone, Debug)]
pub struct Channel {
    /// The node.
    pub node: usize,
    /// The property.
    pub property: Property,
    /// Ascending times of the keys, in seconds.
    pub times: Vec<f64>,
    /// Numbers a key (3, 4, or the number of morph targets), three times as many for cubic splines.
    values: Vec<f32>,
    width: usize,
    interpolation: Interpolation,
}

impl Motion {
    /// Reads animation `index`. `targets` is the number of morph targets of each node's mesh.
    pub fn read(
        document: &Document,
        buffers: &Buffers,
        index: usize,
        targets: &[usize],
        budget: &mut Budget,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, ImportError> {
        let animation = &document.animations[index];
        let name = animation.name.clone().filter(|n| !n.is_empty()).unwrap_or_else(|| index.to_string());
        let mut channels = Vec::new();
        for number in 0..animation.channels.len() {
            match Channel::read(document, buffers, index, number, targets, budget)? {
                Some(channel) => channels.push(channel),
                None => warnings.push(Warning::new(
                    "channels-left-out",
                    format!("Channel {number} of clip \"{name}\" moves nothing that is known here; it was left out."),
                )),
            }
        }
        let start = channels.iter().filter_map(|c| c.times.first()).copied().fold(f64::INFINITY, f64::min);
        let end = channels.iter().filter_map(|c| c.times.last()).copied().fold(f64::NEG_INFINITY, f64::max);
        let (start, end) = if start <= end { (start, end) } else { (0.0, 0.0) };
        Ok(Self { name, start, end, channels })
    }

    /// Sets what the clip says at `time` (in the file's seconds) in the places and morph weights of all nodes.
    pub fn apply(&self, time: f64, locals: &mut [Local], weights: &mut [Vec<f64>]) {
        for channel in &self.channels {
            if channel.property == Property::MorphTargetWeights {
                weights[channel.node] = channel.sample(time);
                continue;
            }
            let value = channel.sample(time);
            let mut trs = locals[channel.node].trs();
            match (channel.property, value.as_slice()) {
                (Property::Translation, &[x, y, z]) => trs.translation = DVec3::new(x, y, z),
                (Property::Scale, &[x, y, z]) => trs.scale = DVec3::new(x, y, z),
                (Property::Rotation, &[x, y, z, w]) => trs.rotation = rotation(DQuat::from_xyzw(x, y, z, w)),
                _ => continue,
            }
            locals[channel.node] = Local::Trs(trs);
        }
    }
}

impl Channel {
    fn read(
        document: &Document,
        buffers: &Buffers,
        animation: usize,
        number: usize,
        targets: &[usize],
        budget: &mut Budget,
    ) -> Result<Option<Self>, ImportError> {
        let entry = &document.animations[animation];
        let Some(channel) = entry.channels.get(number) else { return Ok(None) };
        let purpose = |what: &str| format!("{what} of channel {number} of animation {animation}");
        let wrong = |what: String| {
            let file = &document.name;
            ImportError(format!("channel {number} of animation {animation} of {file} {what}; export the file again"))
        };
        let node = channel.target.node.value();
        if node >= document.nodes.len() {
            return Err(wrong(format!("moves node {node}, which does not exist")));
        }
        let Checked::Valid(property) = channel.target.path else { return Ok(None) };
        let sampler = entry.samplers.get(channel.sampler.value());
        let sampler =
            sampler.ok_or_else(|| wrong(format!("names sampler {}, which does not exist", channel.sampler.value())))?;
        let Checked::Valid(interpolation) = sampler.interpolation else { return Ok(None) };
        let (width, shape) = match property {
            Property::Rotation => (4, Type::Vec4),
            Property::Translation | Property::Scale => (3, Type::Vec3),
            Property::MorphTargetWeights => (targets[node], Type::Scalar),
        };
        if width == 0 {
            return Ok(None);
        }
        let times = Accessor::open(document, buffers, sampler.input.value(), &purpose("times"))?;
        let values = Accessor::open(document, buffers, sampler.output.value(), &purpose("values"))?;
        times.expect_shape(Type::Scalar)?;
        values.expect_shape(shape)?;
        let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let rows = if property == Property::MorphTargetWeights { width } else { 1 };
        let needed = times.len().saturating_mul(per_key).saturating_mul(rows);
        values.expect_len(needed, &format!("{}, at {} values a key,", times.label(), per_key * rows))?;
        if times.len() == 0 {
            return Ok(None);
        }
        budget.take((times.len() as u64).saturating_mul((per_key * width) as u64 + 2), 4, &purpose("the list"))?;
        Ok(Some(Self {
            node,
            property,
            times: read_times(&times)?,
            values: read_values(&values, width / rows)?,
            width,
            interpolation,
        }))
    }

    /// The value at `time`; the first or the last outside the keys.
    pub fn sample(&self, time: f64) -> Vec<f64> {
        let next = self.times.partition_point(|&t| t <= time);
        if next == 0 {
            return self.key(0);
        }
        let key = next - 1;
        if next == self.times.len() || self.interpolation == Interpolation::Step {
            return self.key(key);
        }
        let span = self.times[next] - self.times[key];
        let s = (time - self.times[key]) / span;
        match self.interpolation {
            Interpolation::CubicSpline => self.cubic(key, s, span),
            _ => self.linear(key, s),
        }
    }

    /// Numbers `part` of key `key`: in- and out-tangents are parts 0 and 2 of cubic keys.
    fn part(&self, key: usize, part: usize) -> &[f32] {
        let start = (key * self.parts() + part) * self.width;
        &self.values[start..start + self.width]
    }

    fn parts(&self) -> usize {
        if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 }
    }

    fn key(&self, key: usize) -> Vec<f64> {
        self.part(key, self.parts() / 2).iter().map(|&x| f64::from(x)).collect()
    }

    fn linear(&self, key: usize, s: f64) -> Vec<f64> {
        let (from, to) = (self.key(key), self.key(key + 1));
        if self.property == Property::Rotation {
            let quaternion = |v: &[f64]| rotation(DQuat::from_xyzw(v[0], v[1], v[2], v[3]));
            return slerp(quaternion(&from), quaternion(&to), s).to_array().to_vec();
        }
        from.iter().zip(&to).map(|(a, b)| a + s * (b - a)).collect()
    }

    fn cubic(&self, key: usize, s: f64, span: f64) -> Vec<f64> {
        let (s2, s3) = (s * s, s * s * s);
        let (p0, m0, p1, m1) = (self.part(key, 1), self.part(key, 2), self.part(key + 1, 1), self.part(key + 1, 0));
        let hermite = |i: usize| {
            let [p0, m0, p1, m1] = [p0[i], m0[i], p1[i], m1[i]].map(f64::from);
            (2.0 * s3 - 3.0 * s2 + 1.0) * p0
                + span * (s3 - 2.0 * s2 + s) * m0
                + (3.0 * s2 - 2.0 * s3) * p1
                + span * (s3 - s2) * m1
        };
        let value: Vec<f64> = (0..self.width).map(hermite).collect();
        match (self.property, value.as_slice()) {
            // Between keys the length is no rounding of whoever wrote them (glTF 2.0, appendix C.5).
            (Property::Rotation, &[x, y, z, w]) => unit(DQuat::from_xyzw(x, y, z, w)).to_array().to_vec(),
            _ => value,
        }
    }
}

fn read_times(accessor: &Accessor) -> Result<Vec<f64>, ImportError> {
    let mut times: Vec<f64> = Vec::with_capacity(accessor.len());
    for element in 0..accessor.len() {
        let [time] = accessor.numbers(element)?;
        if times.last().is_some_and(|&last| last > time) {
            return Err(accessor.wrong(&format!("has keys that go back in time, at element {element}")));
        }
        times.push(time);
    }
    Ok(times)
}

fn read_values(accessor: &Accessor, width: usize) -> Result<Vec<f32>, ImportError> {
    let mut values = Vec::with_capacity(accessor.len() * width);
    for element in 0..accessor.len() {
        let numbers: [f64; 4] = accessor.numbers(element)?;
        values.extend(numbers.iter().take(width).map(|&x| x as f32));
    }
    Ok(values)
}
