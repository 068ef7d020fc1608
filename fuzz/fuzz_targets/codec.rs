//! What another program compresses comes out as it was: every mode of meshopt, against the crate `meshoptimizer-rs`.
#![no_main]

use meshoptimizer_rs::{Workspace, codec};
use sinew::import::gltf::meshopt::{Compressed, Filter, Mode};

fn decoded(data: &[u8], mode: Mode, filter: Filter, count: usize, stride: usize) -> Vec<u8> {
    let view = Compressed {
        buffer: 0,
        byte_offset: 0,
        byte_length: data.len() as u64,
        byte_stride: stride as u64,
        count: count as u64,
        mode,
        filter,
    };
    view.decode(data).unwrap_or_else(|why| panic!("what another program compressed {why}"))
}

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Some((&[kind, size], data)) = data.split_first_chunk() else { return };
    let mut workspace = Workspace::default();
    let plain = codec::IndexEncoding::DEFAULT;
    let indices: Vec<u32> = data.as_chunks().0.iter().map(|&pair| u16::from_le_bytes(pair).into()).collect();
    match kind % 5 {
        0 | 1 => {
            let stride = 4 * (usize::from(size) % 64 + 1);
            let whole = &data[..data.len() / stride * stride];
            let level = u8::from(size > 63) + u8::from(size > 127) + u8::from(size > 191);
            let encoding = codec::VertexEncoding::new(kind % 5, level).expect("a version and a level");
            let coded = codec::encode_vertex_buffer(whole, whole.len() / stride, stride, encoding, &mut workspace)
                .expect("vertices can be compressed");
            assert_eq!(decoded(&coded, Mode::Attributes, Filter::None, whole.len() / stride, stride), whole);
        }
        2 => {
            let triangles = &indices[..indices.len() / 3 * 3];
            let coded = codec::encode_index_buffer(triangles, plain, &mut workspace).expect("triangles");
            // The corners of a triangle may be turned round.
            let turned = |t: &[u32]| {
                let first = (0..3).min_by_key(|&k| (t[k], t[(k + 1) % 3])).unwrap_or(0);
                [t[first], t[(first + 1) % 3], t[(first + 2) % 3]]
            };
            let ours: Vec<u32> = decoded(&coded, Mode::Triangles, Filter::None, triangles.len(), 4)
                .as_chunks()
                .0
                .iter()
                .map(|&four| u32::from_le_bytes(four))
                .collect();
            assert!(ours.chunks(3).map(turned).eq(triangles.chunks(3).map(turned)));
        }
        3 => {
            let coded = codec::encode_index_sequence(&indices, plain, &mut workspace).expect("indices");
            let ours = decoded(&coded, Mode::Indices, Filter::None, indices.len(), 4);
            assert!(ours.as_chunks().0.iter().map(|&four| u32::from_le_bytes(four)).eq(indices.iter().copied()));
        }
        _ => {
            floats(&data[..data.len() / 4 * 4], &mut workspace);
            units(&data[..data.len() / 4 * 4], &mut workspace);
        }
    }
});

/// Floats agree to the bit.
fn floats(data: &[u8], workspace: &mut Workspace) {
    let count = data.len() / 4;
    let mut theirs = data.to_vec();
    codec::decode_filter_exp(&mut theirs, count, 4, workspace).expect("floats");
    let coded = codec::encode_vertex_buffer(data, count, 4, codec::VertexEncoding::DEFAULT, workspace).expect("floats");
    let ours = decoded(&coded, Mode::Attributes, Filter::Exponential, count, 4);
    for ((ours, theirs), word) in ours.chunks(4).zip(theirs.chunks(4)).zip(data.as_chunks().0) {
        // Beyond these exponents the result is not laid down.
        let exponent = i32::from_le_bytes(*word) >> 24;
        assert!(ours == theirs || exponent.abs() > 100, "a float with exponent {exponent}");
    }
}

/// Unit vectors, rotations and colours agree to one step.
fn units(data: &[u8], workspace: &mut Workspace) {
    let count = data.len() / 4;
    let raw: Vec<f32> = data.iter().map(|&b| f32::from(b as i8) + 0.5).collect();
    let unit: Vec<f32> = raw
        .chunks(4)
        .flat_map(|v| {
            let length = v.iter().map(|x| x * x).sum::<f32>().sqrt();
            v.iter().map(move |x| x / length).collect::<Vec<f32>>()
        })
        .collect();
    let shares: Vec<f32> = data.iter().map(|&b| f32::from(b) / 255.0).collect();
    let quaternions = codec::encode_filter_quat(count, 8, 12, &unit, workspace).expect("rotations");
    let mut theirs = quaternions.clone();
    codec::decode_filter_quat(&mut theirs, count, 8, workspace).expect("rotations");
    near(&quaternions, &theirs, Filter::Quaternion, workspace);
    let vectors = codec::encode_filter_oct(count, 8, 12, &unit, workspace).expect("vectors");
    let mut theirs = vectors.clone();
    codec::decode_filter_oct(&mut theirs, count, 8, workspace).expect("vectors");
    near(&vectors, &theirs, Filter::Octahedral, workspace);
    let colours = codec::encode_filter_color(count, 8, 12, &shares, workspace).expect("colours");
    let mut theirs = colours.clone();
    codec::decode_filter_color(&mut theirs, count, 8, workspace).expect("colours");
    near(&colours, &theirs, Filter::Color, workspace);
}

fn near(data: &[u8], theirs: &[u8], filter: Filter, workspace: &mut Workspace) {
    let count = data.len() / 8;
    let coded = codec::encode_vertex_buffer(data, count, 8, codec::VertexEncoding::DEFAULT, workspace).expect("words");
    let ours = decoded(&coded, Mode::Attributes, filter, count, 8);
    for (ours, theirs) in ours.as_chunks().0.iter().zip(theirs.as_chunks().0) {
        let (ours, theirs) = (u16::from_le_bytes(*ours), u16::from_le_bytes(*theirs));
        assert!(ours.wrapping_sub(theirs).wrapping_add(1) <= 2, "{filter:?}: {ours} is not {theirs}");
    }
}
