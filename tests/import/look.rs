//! Materials and textures: read where they are asked for, written with the motion, and never in the way of the mesh.

use super::file;
use super::folders::archive;
use super::gltf_maker::{Maker, PNG, dressed};
use glam::{DAffine3, DVec3};
use serde_json::{Value, json};
use sinew::export::animation::{Influences, Skin, SkinPose, exact, light};
use sinew::import::{File, Imported, Options, open};
use sinew::look::Look;
use sinew::sequence::{Pose, Sequence};

fn looked_at(files: &[File]) -> Imported {
    open(files, &Options { look: true, ..Options::default() }).expect("a mesh")
}

fn look(maker: &Maker) -> Look {
    looked_at(&[file("made.glb", maker.glb())]).look.expect("a look")
}

fn layer<'l>(look: &'l Look, name: &str) -> &'l [f32] {
    &look.layers.iter().find(|layer| layer.name == name).expect("a layer").values
}

#[test]
fn a_look_lies_on_the_vertices_that_were_joined() {
    assert!(
        open(&[file("made.glb", dressed().glb())], &Options::default()).unwrap().look.is_none(),
        "only if asked for"
    );
    let imported = looked_at(&[file("made.glb", dressed().glb())]);
    let look = imported.look.expect("a look");
    assert_eq!(imported.sequence.sizes().vertices, 4, "a square");
    assert!(look.fits(4, 2));
    assert_eq!(look.vertices, [0, 1, 2, 1, 3, 2]);
    assert_eq!(look.shades, [0, 1, 2, 1, 4, 2], "the seam is smooth");
    assert_eq!(look.faces, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(look.materials, [Some(0), Some(1)]);
    assert_eq!(layer(&look, "TEXCOORD_0"), [0., 0., 1., 0., 0., 1., 0.5, 0.5, 1., 1., 0., 0.5]);
    assert_eq!(layer(&look, "COLOR_0")[..16], [1., 1., 1., 1., 1., 1., 1., 1., 1., 1., 1., 1., 0.5, 0.25, 0., 1.]);
    assert_eq!(look.images, [PNG]);
}

#[test]
fn what_is_broken_in_a_look_is_left_out() {
    let mut maker = dressed();
    maker.json["images"].as_array_mut().unwrap().insert(0, json!({ "uri": "gone.png" }));
    maker.json["textures"] = json!([{ "source": 0, "sampler": 7 }, { "source": 1, "sampler": 0, "extras": 1 }, 5]);
    let broken = json!({ "index": 0 });
    maker.json["materials"][0]["normalTexture"] = json!({ "index": 1, "texCoord": 3 });
    maker.json["materials"][0]["pbrMetallicRoughness"] =
        json!({ "baseColorTexture": { "index": 1 }, "metallicRoughnessTexture": broken, "roughnessFactor": 0.25 });
    maker.json["materials"][1] = json!({ "emissiveTexture": { "index": 9 }, "extensions": {
        "KHR_materials_sheen": { "sheenColorTexture": { "index": 2 }, "sheenRoughnessFactor": 0.5 } } });
    let imported = looked_at(&[file("made.glb", maker.glb())]);
    assert!(imported.warnings.iter().any(|w| w.code == "image-left-out"), "{:?}", imported.warnings);
    let look = imported.look.expect("a look");
    let document = Value::Object(look.document);
    assert_eq!(document["textures"], json!([{}, { "source": 0, "sampler": 0 }, {}]));
    let rough = json!({ "baseColorTexture": { "index": 1 }, "roughnessFactor": 0.25 });
    assert_eq!(document["materials"][0]["pbrMetallicRoughness"], rough);
    assert!(document["materials"][0].get("normalTexture").is_none(), "there is no fourth set of coordinates");
    let sheen = json!({ "extensions": { "KHR_materials_sheen": { "sheenRoughnessFactor": 0.5 } } });
    assert_eq!(document["materials"][1], sheen);
    assert_eq!(document["extensionsUsed"], json!(["KHR_materials_sheen"]));
    assert!(document.get("extensionsRequired").is_none());
    // An image in a file beside the document.
    maker.json["images"][0]["uri"] = json!("textures/in%20a%20file.png");
    let (document, data) = maker.split("made.bin");
    let files = [file("made.gltf", document), file("made.bin", data), file("textures/in a file.png", PNG)];
    assert_eq!(looked_at(&files).look.expect("a look").images, [PNG, PNG]);
    assert!(
        look_without_coordinates().document["materials"][0]["pbrMetallicRoughness"].as_object().unwrap().is_empty()
    );
}

/// Coordinates that are not numbers are none.
fn look_without_coordinates() -> Look {
    let mut maker = dressed();
    let view = maker.json["accessors"][2]["bufferView"].as_u64().unwrap() as usize;
    let at = maker.json["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize;
    maker.bytes[at..at + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    maker.json["meshes"][0]["primitives"][1]["attributes"].as_object_mut().unwrap().remove("TEXCOORD_0");
    look(&maker)
}

#[test]
fn without_normals_a_look_is_flat() {
    let mut maker = dressed();
    for primitive in maker.json["meshes"][0]["primitives"].as_array_mut().unwrap() {
        primitive["attributes"].as_object_mut().unwrap().remove("NORMAL");
    }
    let flat = look(&maker);
    assert!(flat.shades.is_empty());
    let file = exact(&looked_at(&[file("made.glb", maker.glb())]).sequence, Some(&flat));
    let document = gltf::Gltf::from_slice(&file).unwrap();
    let primitive = document.meshes().next().unwrap().primitives().next().unwrap();
    assert!(primitive.get(&gltf::Semantic::Normals).is_none());
}

/// A look that was written in either form comes back as it was, on a mesh that moves as it did.
#[test]
fn a_moving_mesh_keeps_its_look() {
    let imported = looked_at(&[file("made.glb", dressed().glb())]);
    let (still, look) = (imported.sequence, imported.look.expect("a look"));
    let maps = [DAffine3::from_translation(DVec3::Z), DAffine3::from_scale(DVec3::splat(2.0))];
    let moved = |map: &DAffine3| still.reference().iter().map(|&p| map.transform_point3(p)).collect::<Vec<_>>();
    let poses = [0.0, 0.5].into_iter().zip(&maps);
    let poses: Vec<Pose> = poses.map(|(time, m)| Pose { name: "pose".into(), time, positions: moved(m) }).collect();
    let moving = Sequence::new("moving", still.faces().to_vec(), still.reference().to_vec(), poses).unwrap();
    let names = maps.iter().map(std::slice::from_ref);
    let skin_poses: Vec<SkinPose> =
        names.zip(moving.poses()).map(|(maps, pose)| SkinPose { name: "pose", time: pose.time, maps }).collect();
    let skin = Skin {
        name: "moving",
        faces: still.faces(),
        reference: still.reference(),
        weights: &[1.0; 4],
        handles: 1,
        poses: &skin_poses,
        look: Some(&look),
    };
    for bytes in [exact(&moving, Some(&look)), light(&skin, Influences::Four).expect("a skin").bytes] {
        gltf::Gltf::from_slice(&bytes).expect("a document without a fault");
        let back = looked_at(&[file("back.glb", bytes)]);
        let again = back.look.expect("a look");
        assert_eq!(back.sequence.faces(), still.faces());
        assert_eq!((&again.vertices, &again.shades, &again.faces), (&look.vertices, &look.shades, &look.faces));
        assert_eq!((&again.materials, &again.layers), (&look.materials, &look.layers));
        assert_eq!((&again.images, &again.document), (&look.images, &look.document));
        let last = back.sequence.poses().last().expect("poses");
        for (p, q) in last.positions.iter().zip(&moving.poses()[1].positions) {
            assert!(p.distance(*q) < 1e-6, "{p} is not {q}");
        }
    }
    // A look of another mesh is none.
    let other = Sequence::new("other", vec![[0, 1, 2]], still.reference().to_vec(), Vec::new()).unwrap();
    let clay = gltf::Gltf::from_slice(&exact(&other, Some(&look))).unwrap();
    assert_eq!((clay.materials().count(), clay.images().count()), (1, 0));
}

/// Two triangles of a square with a seam in the picture between them, and a fold of 90°; materials and picture in files
/// beside it.
const OBJ: &str = "mtllib list of a cat.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.5 0.5\n\
    vt 1 0\nvn 0 0 1\nvn 1 0 0\nvn 0 0 2\nusemtl skin\nf 1/1/1 2/2/1 3/3/3\nusemtl Glass#2\nf -3/5/2 4/4/2 3/3/2\n";
const MTL: &str = "newmtl unused\nmap_Kd other.png\nnewmtl skin\nKd 0 0 0\nmap_Kd -clamp on textures\\my skin.png\n\
    newmtl Glass#2\nKd 0.25 0.5 1\nd 0.5\n";

fn cat(obj: &str) -> [File; 4] {
    let names = ["cat/cat.obj", "cat/list of a cat.mtl", "cat/textures/my skin.png", "cat/textures/other.png"];
    let bytes = [obj.as_bytes(), MTL.as_bytes(), PNG, PNG];
    std::array::from_fn(|i| file(names[i], bytes[i]))
}

#[test]
fn an_obj_has_the_look_of_the_files_beside_it() {
    assert!(open(&cat(OBJ), &Options::default()).unwrap().look.is_none(), "only if asked for");
    let imported = looked_at(&cat(OBJ));
    assert_eq!(imported.sequence.sizes().vertices, 4);
    let look = imported.look.expect("a look");
    assert!(look.fits(4, 2));
    // Vertex 1 has one place in the picture and two sides of the fold, vertex 2 the fold alone.
    assert_eq!(look.vertices, [0, 1, 2, 1, 3, 2]);
    assert_eq!(look.faces, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(look.shades, [0, 1, 2, 3, 4, 5]);
    assert_eq!(look.materials, [Some(0), Some(1)]);
    assert_eq!(layer(&look, "TEXCOORD_0"), [0., 1., 1., 1., 0., 0., 1., 1., 0.5, 0.5, 0., 0.]);
    assert_eq!(look.images, [PNG], "one that is used");
    let document = Value::Object(look.document.clone());
    assert_eq!(document["images"], json!([{ "mimeType": "image/png", "name": "my skin.png" }]));
    assert_eq!(document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
    assert_eq!(document["materials"][1]["name"], "Glass#2");
    assert_eq!(document["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"], json!([0.25, 0.5, 1.0, 0.5]));
    // It comes back as it was.
    let bytes = exact(&imported.sequence, Some(&look));
    gltf::Gltf::from_slice(&bytes).expect("a document without a fault");
    let back = looked_at(&[file("back.glb", bytes)]).look.expect("a look");
    assert_eq!((&back.vertices, &back.shades, &back.faces), (&look.vertices, &look.shades, &look.faces));
    assert_eq!(back.layers, look.layers);
    assert_eq!((&back.materials, &back.images, &back.document), (&look.materials, &look.images, &look.document));
    // The same in an archive, and for its later poses.
    let files = cat(OBJ);
    let list: Vec<(&str, &[u8])> = files.iter().map(|f| (f.name.as_str(), f.bytes.as_slice())).collect();
    assert_eq!(looked_at(&[file("a.zip", archive(&list))]).look.as_ref(), Some(&look));
    let mut poses = files.to_vec();
    poses.push(file("cat/cat2.obj", OBJ));
    assert_eq!(looked_at(&poses).look, Some(look));
}

#[test]
fn without_normals_an_obj_is_smooth() {
    let faces = "f 1/1 2/2 3/3\nusemtl Glass#2\nf -3/5 4/4 3/3\n";
    let plain = format!("{}usemtl skin\n{faces}", OBJ.split_once("usemtl").unwrap().0);
    let look = looked_at(&cat(&plain)).look.expect("a look");
    assert_eq!(look.vertices, [0, 1, 2, 3], "vt 2 and 5 are the same");
    assert_eq!(look.shades, [0, 1, 2, 3]);
}

#[test]
fn what_is_broken_in_the_look_of_an_obj_is_left_out() {
    let [mesh, list, _, _] = cat(OBJ);
    // Without the picture, and without the list.
    let look =
        looked_at(&[mesh.clone(), list.clone(), file("textures/my skin.png", b"no picture")]).look.expect("a look");
    assert!(look.layers.is_empty() && look.images.is_empty() && look.document.get("textures").is_none());
    assert_eq!(look.document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"], json!([0.0, 0.0, 0.0, 1.0]));
    assert!(looked_at(std::slice::from_ref(&mesh)).look.is_none());
    assert!(looked_at(&[mesh, file("cat/list of a cat.mtl", b"newmtl other\nKd 1 0 0")]).look.is_none());
    // Numbers that are none, name nothing, or are left out; a material that is not there, and none.
    let odd = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nmtllib gone.mtl\nmtllib list of a cat.mtl\nvt nan 1e99\nvt 1\nvn inf x\nf 1/9/9 2/-9/0 3/x/99999999999\n\
        usemtl skin\nf 1/1/1 2/2 3 4//1\nusemtl gone\nf 1 1 2/1\nf 1 2\nf 2/1/1/1 3// 4/";
    let imported = looked_at(&[file("odd.obj", odd), list, file("my skin.png", PNG)]);
    let look = imported.look.expect("a look");
    assert!(look.fits(4, imported.sequence.faces().len()));
    assert_eq!(look.materials, [Some(2), Some(0), Some(0), Some(1), Some(1)]);
    assert_eq!(look.images, [PNG]);
    assert!(look.layers[0].values.iter().all(|value| value.is_finite()));
    gltf::Gltf::from_slice(&exact(&imported.sequence, Some(&look))).expect("a document without a fault");
    // A polygon of many corners is cut as a fan.
    let corners: String = (1..=300).map(|i| format!(" {i}/{i}")).collect();
    let points: String = (0..300).map(|i| format!("v {i} {} 0\nvt {i} 0\n", i * i)).collect();
    let fan = format!("mtllib list of a cat.mtl\n{points}usemtl skin\nf{corners}\n");
    let look = looked_at(&cat(&fan)).look.expect("a look");
    assert_eq!((look.faces.len(), look.vertices.len()), (298, 300));
    let coordinates = layer(&look, "TEXCOORD_0").chunks(2).zip(&look.vertices);
    assert!(coordinates.into_iter().all(|(at, &vertex)| at[0] == vertex as f32));
    // Cut short anywhere.
    for text in [OBJ, odd] {
        for end in 0..text.len() {
            let [_, list, skin, _] = cat("");
            let options = Options { look: true, ..Options::default() };
            let Ok(imported) = open(&[file("cat/cut.obj", &text[..end]), list, skin], &options) else { continue };
            let sizes = imported.sequence.sizes();
            assert!(imported.look.is_none_or(|look| look.fits(sizes.vertices, sizes.faces)), "{end}");
        }
    }
}
