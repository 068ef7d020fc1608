//! Exported files elsewhere: the Khronos validator finds no error in them, and three.js moves their vertices as we do.
//!
//! Both come as npm packages, which `cargo xtask test` fetches and serves; where it cannot, it leaves these tests out
//! and says so.

#[path = "../common/skinned.rs"]
mod skinned;

use crate::harness::{Backend, Page, Screen};
use glam::DVec3;
use serde_json::{Value, json};
use sinew::export::animation::{Influences, Skin, exact, light};
use sinew::import::{File, Options, Sampling, open};
use sinew::look::{Layer, Look};
use skinned::Made;
use std::path::PathBuf;
use std::process::Command;

/// Moments of the clip at which vertices are compared, as shares of its length; the importer samples them, too.
const MOMENTS: usize = 16;

/// Where the players are: their address and their folder.
fn players() -> (String, PathBuf) {
    let variable = |name| {
        std::env::var(name).unwrap_or_else(|_| panic!("{name} is not set: `cargo xtask test` fetches and serves this"))
    };
    (variable("SINEW_PLAYERS"), PathBuf::from(variable("SINEW_PLAYERS_FOLDER")))
}

/// Puts a file where the browser and Node.js find it.
fn put(name: &str, bytes: &[u8]) -> PathBuf {
    let path = players().1.join(name);
    std::fs::write(&path, bytes).expect("the players' folder can be written");
    path
}

/// What the Khronos validator says of a file.
fn validate(name: &str, bytes: &[u8]) -> Value {
    let path = put(name, bytes);
    let script = "const v = require('gltf-validator');
        v.validateBytes(new Uint8Array(require('fs').readFileSync(process.argv[1])), { maxIssues: 20 })
            .then((report) => console.log(JSON.stringify(report.issues)));";
    let mut node = Command::new("node");
    node.current_dir(players().1).args(["-e", script]).arg(path);
    let output = node.output().expect("node runs");
    let text = String::from_utf8_lossy(&output.stdout);
    serde_json::from_str(&text)
        .unwrap_or_else(|_| panic!("no report but {text} {}", String::from_utf8_lossy(&output.stderr)))
}

fn expect_valid(name: &str, bytes: &[u8]) {
    let issues = validate(name, bytes);
    assert_eq!((&issues["numErrors"], &issues["numWarnings"]), (&json!(0), &json!(0)), "{name}: {issues:#}");
}

/// Plays a file in three.js. Returns the largest distance from where our own importer has the vertices, and, at the
/// poses' own times, from `wanted(pose)`.
fn play(page: &mut Page, name: &str, bytes: Vec<u8>, made: &Made, wanted: impl Fn(usize) -> Vec<DVec3>) -> [f64; 2] {
    put(name, &bytes);
    page.evaluate(&format!("players.open('{name}').then((player) => void (window.player = player))"));
    let seconds = page.evaluate("player.seconds").as_f64().expect("a length");
    let poses = made.sequence.poses();
    // The clip closes its loop: as many steps as poses. Each is cut in two, for moments between keys.
    let step = seconds / poses.len() as f64;
    assert!((step - (poses[1].time - poses[0].time)).abs() < 1e-6, "{step}");
    let options = Options { weld: false, sampling: Sampling::Rate(2.0 / step), ..Options::default() };
    let ours = open(&[File { name: name.into(), bytes }], &options).expect("our own file").sequence;
    assert!(ours.poses().len() >= MOMENTS);
    let mut worst = [0.0_f64; 2];
    for (moment, our) in ours.poses().iter().enumerate().take(MOMENTS) {
        let theirs = page.evaluate(&format!("players.vertices(player, {})", our.time));
        let theirs: Vec<f64> = theirs.as_array().expect("numbers").iter().filter_map(Value::as_f64).collect();
        assert_eq!(theirs.len(), 3 * made.sequence.reference().len());
        let farthest = |places: &[DVec3]| {
            let apart = theirs.chunks_exact(3).zip(places).map(|(a, b)| DVec3::from_slice(a).distance(*b));
            apart.fold(0.0, f64::max) / made.sequence.diagonal()
        };
        worst[0] = worst[0].max(farthest(&our.positions));
        if moment % 2 == 0 {
            worst[1] = worst[1].max(farthest(&wanted(moment / 2)));
        }
    }
    println!("{name}: from ours {:.1e}, from the poses {:.1e} of the diagonal", worst[0], worst[1]);
    page.evaluate("players.draw(player, players.vertices(player, player.seconds / 3))");
    let picture = page.picture_of("canvas", &name.replace('.', "-"));
    assert!(picture.colours() > 50, "three.js draws it in {} colours", picture.colours());
    worst
}

fn three() -> Page {
    let address = players().0;
    put("index.html", include_bytes!("players.html"));
    let mut page = Page::open_at(address, Backend::WebGl2, Screen::Still, "");
    page.wait_until("window.players", 20.0);
    page
}

#[test]
#[ignore = "needs three.js and Chromium: run by `cargo xtask test`"]
fn three_plays_the_exact_form() {
    let made = Made::new("horse", 2000, 8, 4);
    let mut page = three();
    let poses = made.sequence.poses();
    let worst = play(&mut page, "exact.glb", exact(&made.sequence, None), &made, |pose| poses[pose].positions.clone());
    assert!(worst.into_iter().all(|worst| worst < 1e-5), "{worst:?}");
}

#[test]
#[ignore = "needs three.js and Chromium: run by `cargo xtask test`"]
fn three_plays_the_light_form() {
    let mut page = three();
    for (name, handles) in [("snake", 9), ("horse", 14)] {
        let made = Made::new(name, 2000, 8, handles);
        let poses = made.poses();
        let file = light(&made.skin(&poses), Influences::Four).expect("a skin");
        let worst = play(&mut page, &format!("light-{name}.glb"), file.bytes, &made, |pose| made.blend(pose));
        assert!(worst[0] < 1e-5, "{worst:?}");
        assert!(worst[1] < file.largest + 1e-5, "{worst:?} where {} is stated", file.largest);
    }
}

/// A look of two materials, one of them with a texture of 2 × 2 squares.
fn chequered(made: &Made) -> Look {
    let (points, faces) = (made.sequence.reference(), made.sequence.faces());
    let mut image = Vec::new();
    let mut encoder = png::Encoder::new(&mut image, 2, 2);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("a picture");
    writer.write_image_data(&[30, 220, 220, 30]).and_then(|()| writer.finish()).expect("a picture");
    let document = json!({
        "materials": [{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }, { "doubleSided": true }],
        "textures": [{ "source": 0 }],
        "images": [{ "mimeType": "image/png" }],
    });
    let numbers: Vec<u32> = (0..points.len() as u32).collect();
    Look {
        vertices: numbers.clone(),
        shades: numbers,
        faces: faces.to_vec(),
        materials: (0..faces.len()).map(|f| Some(u32::from(2 * f > faces.len()))).collect(),
        layers: vec![Layer {
            name: "TEXCOORD_0".into(),
            width: 2,
            values: points.iter().flat_map(|p| [p.x as f32, p.y as f32]).collect(),
        }],
        document: document.as_object().expect("an object").clone(),
        images: vec![image],
    }
}

#[test]
#[ignore = "needs three.js and Chromium: run by `cargo xtask test`"]
fn three_shows_materials_and_textures() {
    let made = Made::new("horse", 2000, 4, 8);
    let look = chequered(&made);
    let poses = made.poses();
    let skin = Skin { look: Some(&look), ..made.skin(&poses) };
    let mut page = three();
    for (name, bytes) in [
        ("chequered-exact.glb", exact(&made.sequence, Some(&look))),
        ("chequered-light.glb", light(&skin, Influences::Four).expect("a skin").bytes),
    ] {
        expect_valid(name, &bytes);
        page.evaluate(&format!("players.open('{name}').then((player) => void (window.player = player))"));
        let shown =
            page.evaluate("player.meshes.map(({ material }) => [material.map?.image.width ?? 0, material.side])");
        assert_eq!(shown, json!([[2, 0], [0, 2]]), "three.js calls double-sided 2");
        page.evaluate("players.draw(player, players.vertices(player, player.seconds / 3))");
        page.picture_of("canvas", &name.replace('.', "-"));
    }
}

#[test]
#[ignore = "needs the Khronos validator: run by `cargo xtask test`"]
fn the_validator_finds_nothing() {
    let made = Made::new("horse", 1500, 6, 11);
    expect_valid("valid-exact.glb", &exact(&made.sequence, None));
    let poses = made.poses();
    for influences in [Influences::Four, Influences::Eight] {
        let file = light(&made.skin(&poses), influences).expect("a skin");
        expect_valid(&format!("valid-{influences:?}.glb"), &file.bytes);
    }
    // More joints than a byte can number.
    let many = Made::new("snake", 1500, 3, 300);
    let poses = many.poses();
    expect_valid("valid-many.glb", &light(&many.skin(&poses), Influences::Four).expect("a skin").bytes);
    expect_valid("valid-still.glb", &light(&made.skin(&[]), Influences::Four).expect("a skin").bytes);
    // The validator is awake.
    let mut broken = exact(&made.sequence, None);
    let length = broken.len();
    broken.truncate(length - 400);
    assert_ne!(validate("broken.glb", &broken)["numErrors"], json!(0));
}
