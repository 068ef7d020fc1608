//! Writes small sound files for the targets to begin with: `corpus/TARGET/NUMBER`.

#[path = "../../tests/gltf_maker/mod.rs"]
mod gltf_maker;

use gltf_maker::{draco_triangle, f32s, rich, triangle};
use std::io::Write;
use zip::write::SimpleFileOptions;

const OBJ: &str = "v 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0\ng a\nf 1/1 2//2 3/3/3 4\nf -4 -3 -2\n";
const OFF: &str =
    "COFF\n# x\n4 2 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n1 1 0 1 1 1 1\n0 1 0 1 1 1 1\n4 0 1 2 3\n3 0 1 2 9 9 9\n";
const STL: &str =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

fn main() -> std::io::Result<()> {
    let glb = rich().glb();
    let (document, buffer) = rich().split("a.bin");
    let split = [document.as_slice(), &[0], &buffer].concat();
    for (target, files) in [
        ("gltf", vec![glb.clone(), split, triangle().glb()]),
        ("obj", vec![OBJ.into()]),
        ("off", vec![OFF.into(), binary_off()]),
        ("ply", vec![ply("ascii", b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), ply("binary_little_endian", &ply_body())]),
        ("stl", vec![STL.into(), binary_stl()]),
        ("zip", vec![archive(&[("a.obj", OBJ.as_bytes()), ("b.obj", OBJ.as_bytes())])?, archive(&[("a.glb", &glb)])?]),
        ("poses", vec![[OBJ.as_bytes(), &[0], OFF.as_bytes()].concat()]),
        ("draco", vec![draco_triangle(0), draco_triangle(5), draco_triangle(10)]),
        ("meshopt", meshopt()),
        ("codec", vec![(0..200).collect()]),
    ] {
        let folder = std::path::Path::new("corpus").join(target);
        std::fs::create_dir_all(&folder)?;
        for (number, bytes) in files.iter().enumerate() {
            std::fs::write(folder.join(number.to_string()), bytes)?;
        }
    }
    Ok(())
}

fn binary_off() -> Vec<u8> {
    let mut bytes = b"OFF BINARY\n".to_vec();
    [3_i32, 1, 0].iter().for_each(|n| bytes.extend(n.to_be_bytes()));
    [0_f32, 0., 0., 1., 0., 0., 0., 1., 0.].iter().for_each(|x| bytes.extend(x.to_be_bytes()));
    [3_i32, 0, 1, 2, 0].iter().for_each(|n| bytes.extend(n.to_be_bytes()));
    bytes
}

fn ply(format: &str, body: &[u8]) -> Vec<u8> {
    let head = format!(
        "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    );
    [head.as_bytes(), body].concat()
}

fn ply_body() -> Vec<u8> {
    let mut bytes = f32s(&[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    bytes.push(3);
    [0_i32, 1, 2].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    bytes
}

fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend(f32s(&[0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0.]));
    bytes.extend([0, 0]);
    bytes
}

fn archive(files: &[(&str, &[u8])]) -> std::io::Result<Vec<u8>> {
    let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (name, bytes) in files {
        zip.start_file(*name, SimpleFileOptions::default())?;
        zip.write_all(bytes)?;
    }
    Ok(zip.finish()?.into_inner())
}

/// Streams of the three modes behind the four bytes that choose them.
fn meshopt() -> Vec<Vec<u8>> {
    use meshoptimizer_rs::{Workspace, codec};
    let mut workspace = Workspace::default();
    let vertices = f32s(&[0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.]);
    let indices = [0, 1, 2, 2, 1, 3];
    let mut all = Vec::new();
    for version in [0, 1] {
        let encoding = codec::VertexEncoding::new(version, 2).expect("a version");
        let coded = codec::encode_vertex_buffer(&vertices, 4, 12, encoding, &mut workspace).expect("vertices");
        all.push([&[0, 0, 12, 4], coded.as_slice()].concat());
    }
    let encoding = codec::IndexEncoding::DEFAULT;
    let coded = codec::encode_index_buffer(&indices, encoding, &mut workspace).expect("triangles");
    all.push([&[1, 0, 4, 6], coded.as_slice()].concat());
    let coded = codec::encode_index_sequence(&indices, encoding, &mut workspace).expect("indices");
    all.push([&[2, 0, 2, 6], coded.as_slice()].concat());
    all
}
