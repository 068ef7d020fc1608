//! Draco meshes, by the encoder of the crate that also decodes them.

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder, PointAttribute,
    PointIndex,
};

/// A triangle with joints and weights: attributes 0, 1 and 2. Speed 10 is sequential, the others Edgebreaker.
pub fn draco_triangle(speed: i32) -> Vec<u8> {
    let positions = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    draco_mesh(&positions, &[[0, 1, 2]], &[0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0], speed)
}

/// #V × 3 positions, #F faces, #V × 4 joints; the weights of each vertex are ¼ each. Nothing is quantised.
pub fn draco_mesh(positions: &[f32], faces: &[[u32; 3]], joints: &[u8], speed: i32) -> Vec<u8> {
    let vertices = positions.len() / 3;
    let mut mesh = Mesh::new();
    let mut attribute = |kind, width: u8, data_type, bytes: Vec<u8>| {
        let mut attribute = PointAttribute::new();
        attribute.init(kind, width, data_type, false, vertices);
        attribute.buffer_mut().write(0, &bytes);
        mesh.add_attribute(attribute);
    };
    let floats = |values: &[f32]| values.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    attribute(GeometryAttributeType::Position, 3, DataType::Float32, floats(positions));
    attribute(GeometryAttributeType::Generic, 4, DataType::Uint8, joints.to_vec());
    attribute(GeometryAttributeType::Generic, 4, DataType::Float32, floats(&vec![0.25; 4 * vertices]));
    mesh.set_num_points(vertices);
    mesh.set_num_faces(faces.len());
    for (number, face) in (0..).zip(faces) {
        mesh.set_face(FaceIndex(number), face.map(PointIndex));
    }
    let mut options = EncoderOptions::new();
    options.set_compression_level(10 - speed);
    (0..3).for_each(|attribute| options.set_attribute_quantization(attribute, 0));
    let mut out = EncoderBuffer::new();
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    encoder.encode(&options, &mut out).expect("a mesh can be encoded");
    out.data().to_vec()
}
