//! The command line: reports, files, and the exit status 2 with one sentence for what cannot be used.
#![cfg(all(feature = "cli", not(target_arch = "wasm32")))]

#[allow(dead_code, unused_imports)]
mod gltf_maker;

use gltf_maker::{PNG, triangle};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder for one test's files.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("command_line").join(test);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn sinew(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sinew")).current_dir(folder).args(arguments).output().unwrap()
}

/// Runs a command that must succeed.
fn done(folder: &Path, line: &str) {
    let output = sinew(folder, &line.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
}

fn json(bytes: &[u8]) -> Value {
    serde_json::from_slice(bytes).unwrap()
}

/// Two quads and a triangle in a row; the second pose bends the last two faces up.
fn strip(folder: &Path) {
    let faces = "f 1 2 5 4\nf 2 3 6 5\nf 3 7 6\n";
    let vertices = |z: f64| format!("v 0 0 0\nv 1 0 0\nv 2 0 {z}\nv 0 1 0\nv 1 1 0\nv 2 1 {z}\nv 3 0.5 {z}\n");
    std::fs::write(folder.join("rest.obj"), vertices(0.0) + faces).unwrap();
    std::fs::write(folder.join("pose.2.obj"), vertices(0.5) + faces).unwrap();
    std::fs::write(folder.join("pose.10.obj"), vertices(1.0) + faces).unwrap();
}

/// A triangle that slides, as GLB.
fn slider(folder: &Path) {
    let mut maker = triangle();
    maker.animate("translation", "LINEAR", &[0.0, 2.0], &[0., 0., 0., 1., 0., 0.], "VEC3");
    maker.json["animations"][0]["name"] = "slide".into();
    std::fs::write(folder.join("slider.glb"), maker.glb()).unwrap();
    let (document, buffer) = maker.split("the%20data.bin");
    std::fs::write(folder.join("slider.gltf"), document).unwrap();
    std::fs::write(folder.join("the data.bin"), buffer).unwrap();
}

#[test]
fn inspect_counts() {
    let folder = folder("inspect");
    strip(&folder);
    // The poses in any order: the first argument is the reference.
    let output = sinew(&folder, &["inspect", "rest.obj", "pose.10.obj", "pose.2.obj", "--json"]);
    assert!(output.status.success());
    let report = json(&output.stdout);
    for (key, value) in [("vertices", 7), ("faces", 5), ("input_faces", 3), ("components", 1), ("poses", 2)] {
        assert_eq!(report[key], value, "{key}");
    }
    for (key, value) in [("boundary_edges", 7), ("nonmanifold_edges", 0), ("collapsed_faces", 0)] {
        assert_eq!(report[key], value, "{key}");
    }
    assert_eq!(report["clips"], serde_json::json!([]));
    assert!((report["diagonal"].as_f64().unwrap() - 10_f64.sqrt()).abs() < 1e-12);
    let text = sinew(&folder, &["inspect", "rest.obj"]);
    assert!(text.status.success());
    assert!(String::from_utf8_lossy(&text.stdout).contains("vertices    7"));
    assert!(String::from_utf8_lossy(&text.stderr).contains("stands still"));
}

#[test]
fn inspect_samples_clips() {
    let folder = folder("clips");
    slider(&folder);
    for input in ["slider.glb", "slider.gltf"] {
        for (arguments, poses) in [(&[][..], 25), (&["--fps", "2"], 5), (&["--keys"], 2), (&["--clip", "slide"], 25)] {
            let output = sinew(&folder, &[&["inspect", input, "--json"], arguments].concat());
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            let report = json(&output.stdout);
            assert_eq!(report["poses"], poses, "{arguments:?}");
            assert_eq!(report["clips"][0]["name"], "slide");
            assert_eq!(report["clips"][0]["seconds"], 2.0);
        }
    }
}

#[test]
fn segment_writes_labels_and_a_report() {
    let folder = folder("segment");
    strip(&folder);
    let arguments =
        ["segment", "rest.obj", "pose.2.obj", "pose.10.obj", "--labels", "labels.txt", "--report", "report.json"];
    let output = sinew(&folder, &arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let labels = std::fs::read_to_string(folder.join("labels.txt")).unwrap();
    let report = json(&std::fs::read(folder.join("report.json")).unwrap());
    let parts = report["parts"].as_u64().unwrap();
    // One label for each of the three faces of the file, though the sequence has five triangles.
    assert_eq!(labels.lines().count(), 3);
    assert!(labels.lines().all(|label| label.parse::<u64>().unwrap() < parts));
    assert_eq!(report["part_list"].as_array().unwrap().len() as u64, parts);
    assert_eq!((&report["faces"], &report["poses"]), (&Value::from(5), &Value::from(2)));
    for key in ["rigid_residual", "residual_before_smoothing", "epsilon", "gamma"] {
        assert!(report[key].is_number(), "{key}");
    }
    assert!(report["seconds"]["total"].as_f64().unwrap() >= report["seconds"]["import"].as_f64().unwrap());
    assert_eq!(report["parameters"]["method"], "tree");
    let output = sinew(&folder, &["segment", "rest.obj", "pose.2.obj", "pose.10.obj", "--parts", "50"]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("50 parts were asked for"));
}

#[test]
fn parameters_reach_the_report() {
    let folder = folder("parameters");
    strip(&folder);
    let arguments = ["segment", "rest.obj", "pose.2.obj", "--report", "report.json", "--paper", "--delta", "0.2"];
    let more = ["--epsilon", "0.5", "--gamma", "0.9", "--alpha", "0.05", "--min-area", "0.01", "--smoothing", "none"];
    assert!(sinew(&folder, &[&arguments[..], &more].concat()).status.success());
    let parameters = &json(&std::fs::read(folder.join("report.json")).unwrap())["parameters"];
    for (key, value) in [("delta", 0.2), ("epsilon", 0.5), ("gamma", 0.9), ("alpha", 0.05), ("min-area", 0.01)] {
        assert_eq!(parameters[key], value, "{key}");
    }
    assert_eq!((&parameters["method"], &parameters["smoothing"]), (&"paper".into(), &"none".into()));
}

#[test]
fn weights_are_written_as_numpy_and_a_report() {
    let folder = folder("weights");
    strip(&folder);
    // The same handles as a JSON list and as plain numbers.
    std::fs::write(folder.join("handles.json"), "[0, 6,\n 2]").unwrap();
    std::fs::write(folder.join("handles.txt"), "0 6\n2\n").unwrap();
    for (handles, more, joint) in [("handles.json", &[][..], false), ("handles.txt", &["--joint"], true)] {
        let arguments =
            ["weights", "rest.obj", "--handles", handles, "--out", "weights.npy", "--report", "report.json"];
        let output = sinew(&folder, &[&arguments[..], more].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !said.contains("other poses"), "{said}");
        let bytes = std::fs::read(folder.join("weights.npy")).unwrap();
        let array = npyz::NpyFile::new(&bytes[..]).unwrap();
        assert_eq!((array.shape(), array.order()), (&[7, 3][..], npyz::Order::C));
        let values = array.into_vec::<f64>().unwrap();
        for row in values.chunks_exact(3) {
            assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-12 && row.iter().all(|w| (0.0..=1.0).contains(w)));
        }
        for (j, handle) in [0, 6, 2].into_iter().enumerate() {
            assert_eq!(values[handle * 3 + j], 1.0);
        }
        let report = json(&std::fs::read(folder.join("report.json")).unwrap());
        assert!(report["kkt_residual"].as_f64().unwrap() <= 1e-6);
        assert!(report["seconds"]["total"].as_f64().unwrap() >= report["seconds"]["solve"].as_f64().unwrap());
        assert_eq!((&report["vertices"], &report["faces"]), (&Value::from(7), &Value::from(5)));
        assert_eq!(report["handles"], serde_json::json!([0, 6, 2]));
        assert_eq!(report["energies"].as_array().unwrap().len(), 3);
        assert_eq!(report["parameters"]["joint"], joint);
        assert!(report["warnings"].is_array());
    }
}

#[test]
fn what_cannot_be_used_is_one_sentence_and_status_2() {
    let folder = folder("refusals");
    strip(&folder);
    slider(&folder);
    std::fs::write(folder.join("bad.obj"), "v 0 0 0\nf 1 2 3\n").unwrap();
    std::fs::write(folder.join("bad.glb"), "glTF").unwrap();
    for (name, text) in [("far.txt", "0 7"), ("twice.txt", "3 1 3"), ("word.txt", "0 one"), ("none.json", "[]")] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    for (arguments, part) in [
        (&["inspect", "nothing.obj"][..], "nothing.obj cannot be read"),
        (&["inspect", "bad.obj"], "names vertex 2"),
        (&["inspect", "bad.glb"], "cut short"),
        (&["inspect", "slider.glb", "--clip", "fly"], "no clip \"fly\""),
        (&["inspect", "slider.glb", "--fps", "0"], "above 0"),
        (&["segment", "rest.obj", "bad.obj"], "bad.obj"),
        (&["weights", "rest.obj", "--handles", "far.txt"], "handle 7 does not exist"),
        (&["weights", "rest.obj", "--handles", "twice.txt"], "vertex 3 is named as a handle twice"),
        (&["weights", "rest.obj", "--handles", "word.txt"], "“one” is not a vertex number"),
        (&["weights", "rest.obj", "--handles", "none.json"], "there are no handles"),
        (&["weights", "rest.obj", "--handles", "nothing.txt"], "nothing.txt cannot be read"),
        (&["zoo", "unicorn"], "there is no unicorn"),
    ] {
        let output = sinew(&folder, arguments);
        let why = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(why.starts_with("sinew: ") && why.trim_end().lines().count() == 1 && why.contains(part), "{why}");
        assert!(output.stdout.is_empty());
    }
    for arguments in [&["segment"][..], &["segment", "rest.obj", "--parts", "0"], &["dance"], &["zoo"]] {
        assert_eq!(sinew(&folder, arguments).status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn the_zoo_is_listed() {
    let output = sinew(Path::new("."), &["zoo", "--list"]);
    assert!(output.status.success());
    let listed: Vec<String> = String::from_utf8(output.stdout).unwrap().lines().map(Into::into).collect();
    assert_eq!(listed, sinew::zoo::NAMES);
}

/// What the zoo writes, the importer reads: the creature comes back with its poses and its faces in their order.
#[test]
fn a_creature_goes_out_and_comes_back() {
    let folder = folder("creature");
    let arguments =
        ["zoo", "horse", "--faces", "3000", "--poses", "6", "--exact", "--out", "horse.glb", "--labels", "true.txt"];
    let output = sinew(&folder, &arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let recipe = sinew::zoo::Recipe {
        name: "horse".into(),
        faces: 3000,
        poses: 6,
        exact: true,
        ..sinew::zoo::Recipe::default()
    };
    let creature = sinew::zoo::make(&recipe).unwrap();
    let bytes = std::fs::read(folder.join("horse.glb")).unwrap();
    let file = sinew::import::File { name: "horse.glb".into(), bytes };
    let options = sinew::import::Options { sampling: sinew::import::Sampling::Keys, ..Default::default() };
    let back = sinew::import::open(&[file], &options).unwrap().sequence;
    let (sizes, expected) = (back.sizes(), creature.sequence.sizes());
    assert_eq!((sizes.vertices, sizes.faces), (expected.vertices, expected.faces));
    // One primitive a part: faces come back part by part, each corner where it was.
    let labels: Vec<u32> =
        std::fs::read_to_string(folder.join("true.txt")).unwrap().lines().map(|l| l.parse().unwrap()).collect();
    assert_eq!(labels, creature.labels);
    let mut order: Vec<usize> = (0..labels.len()).collect();
    order.sort_by_key(|&f| labels[f]);
    for (pose, theirs) in creature.sequence.poses().iter().zip(back.poses()) {
        for (face, &f) in back.faces().iter().zip(&order) {
            for (a, b) in face.iter().zip(&creature.sequence.faces()[f]) {
                let far = theirs.positions[*a as usize].distance(pose.positions[*b as usize]);
                assert!(far < 1e-5 * creature.sequence.diagonal(), "face {f}: {far}");
            }
        }
    }
}

#[test]
fn parts_are_written_as_glb() {
    let folder = folder("parts");
    strip(&folder);
    let output = sinew(&folder, &["segment", "rest.obj", "pose.2.obj", "pose.10.obj", "--out", "parts.glb"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report = json(&sinew(&folder, &["inspect", "parts.glb", "--json"]).stdout);
    assert_eq!((&report["vertices"], &report["faces"]), (&Value::from(7), &Value::from(5)));
    let output = sinew(&folder, &["segment", "rest.obj", "pose.2.obj", "--out", "no/such/folder.glb"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn transfer_by_faces_reads_lines_and_compares_methods() {
    let folder = folder("faces");
    let run = |arguments: &[&str]| {
        let output = sinew(&folder, arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    strip(&folder);
    std::fs::write(folder.join("pairs.cons"), "4\n0, 0\n2, 2\n3, 3\n6, 6\n").unwrap();
    let common = ["transfer", "rest.obj", "pose.2.obj", "pose.10.obj", "--target", "rest.obj", "--pairs", "pairs.cons"];
    for method in ["gradients", "posed"] {
        let rest = ["--method", method, "--pin", "0", "--out-poses", method, "--report", "report.json", "--truth"];
        run(&[&common[..], &rest, &["pose.2.obj", "pose.10.obj"]].concat());
        let report = json(&std::fs::read(folder.join("report.json")).unwrap());
        assert_eq!(report["parameters"]["method"], method);
        assert!(report["fit"]["coverage"].as_f64().unwrap() > 0.99, "{report}");
        let error = report["error"]["mean"].as_f64().unwrap();
        assert!(error < if method == "gradients" { 1e-6 } else { 0.2 }, "{method}: {error}");
        assert!(folder.join(method).join("pose_001.obj").is_file());
    }
    for (options, said) in [
        ("--method gradients --bones 5", "leave --bones out"),
        ("--variant relative --bones 5", "leave --bones out"),
        ("--method posed --light --out out.glb", "leave --light out"),
        ("--method posed --variant direct", "leave --variant out"),
        ("--pin 0", "--pin is for"),
    ] {
        let output = sinew(&folder, &common.iter().copied().chain(options.split(' ')).collect::<Vec<_>>());
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && error.contains(said), "{options}: {error}");
    }
    run(&[&common[..], &["--bones", "5", "--compare", "compare.json", "--truth", "pose.2.obj", "pose.10.obj"]].concat());
    let report = json(&std::fs::read(folder.join("compare.json")).unwrap());
    let names: Vec<&str> = report["methods"].as_array().unwrap().iter().filter_map(|m| m["method"].as_str()).collect();
    assert_eq!(names, ["bones", "direct", "relative", "gradients", "posed"]);
    assert_eq!(report["methods"][3]["within"].as_array().unwrap().len(), report["bounds"].as_array().unwrap().len());
    // A folder of true poses may hold more than meshes.
    let truth = folder.join("gradients");
    for other in [".DS_Store", "rest.mtl", "skin.png", "notes.txt", "pose.mtl"] {
        std::fs::write(truth.join(other), "").unwrap();
    }
    run(&[&common[..], &["--method", "gradients", "--pin", "0", "--truth", "gradients"]].concat());
    std::fs::write(folder.join("pairs.cons"), "9\n0, 0\n").unwrap();
    let output = sinew(&folder, &common);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("its first line says 9"));
}

/// The strip lies in the plane of x and y, and what bends goes along z: that is up.
#[test]
fn figures_are_raised_and_poses_are_written_as_the_target_lies() {
    let folder = folder("up");
    strip(&folder);
    std::fs::write(folder.join("pairs.cons"), "4\n0, 0\n2, 2\n3, 3\n6, 6\n").unwrap();
    let line = "transfer rest.obj pose.2.obj pose.10.obj --up z --target rest.obj --target-up z --pairs pairs.cons \
                --method gradients --out out.glb --out-poses poses --report report.json --truth pose.2.obj pose.10.obj";
    let output = sinew(&folder, &line.split_whitespace().collect::<Vec<_>>());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let error = json(&std::fs::read(folder.join("report.json")).unwrap())["error"]["mean"].as_f64().unwrap();
    assert!(error < 1e-6, "the truth is raised as the target is: {error}");
    let read = |name: &str| {
        let file = sinew::import::File { name: name.into(), bytes: std::fs::read(folder.join(name)).unwrap() };
        let options = sinew::import::Options { sampling: sinew::import::Sampling::Keys, ..Default::default() };
        sinew::import::open(&[file], &options).unwrap().sequence
    };
    let (written, truth) = (read("poses/pose_001.obj"), read("pose.10.obj"));
    for (a, b) in written.reference().iter().zip(truth.reference()) {
        assert!(a.distance(*b) < 1e-6, "{a} is not {b}");
    }
    let raised = read("out.glb");
    let last = &raised.poses().last().unwrap().positions;
    let height = last.iter().map(|p| p.y).fold(0.0, f64::max) - last.iter().map(|p| p.y).fold(0.0, f64::min);
    assert!((height - 1.0).abs() < 1e-6, "other programs see it upright, {height} high");
    let report = json(&sinew(&folder, &["inspect", "rest.obj", "--up", "-X", "--json"]).stdout);
    assert_eq!(report["up"], "-x");
    let output = sinew(&folder, &["inspect", "rest.obj", "--up", "w"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("expected one of"));
}

#[test]
fn a_target_keeps_the_materials_that_lie_beside_it() {
    let outside = folder("materials");
    let folder = folder("materials/inside");
    strip(&folder);
    std::fs::create_dir_all(folder.join("skins")).unwrap();
    std::fs::write(folder.join("skins/a.png"), PNG).unwrap();
    std::fs::write(outside.join("secret.png"), [PNG, b"secret"].concat()).unwrap();
    let strip = std::fs::read_to_string(folder.join("rest.obj")).unwrap();
    let dressed =
        strip.replace("f 1", "mtllib skins/list.mtl\nvt 0 0\nusemtl a\nf 1/1").replace("f 2", "usemtl b\nf 2/1");
    std::fs::write(folder.join("target.obj"), dressed).unwrap();
    let absolute = outside.join("secret.png").canonicalize().unwrap();
    for beyond in ["../../secret.png", &absolute.display().to_string()] {
        let list = format!("newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd {beyond}\n");
        std::fs::write(folder.join("skins/list.mtl"), list).unwrap();
        std::fs::write(folder.join("pairs.cons"), "2\n0, 0\n6, 6\n").unwrap();
        let line = "transfer rest.obj pose.2.obj --target target.obj --pairs pairs.cons --out out.glb";
        let output = sinew(&folder, &line.split(' ').collect::<Vec<_>>());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let made = std::fs::read(folder.join("out.glb")).unwrap();
        let document = gltf::Gltf::from_slice(&made).unwrap();
        assert_eq!(document.materials().filter_map(|material| material.name()).collect::<Vec<_>>(), ["a", "b"]);
        assert_eq!(document.images().count(), 1, "only what lies below the folder is read");
        assert!(!made.windows(6).any(|bytes| bytes == b"secret"));
    }
}

#[test]
fn what_a_command_reports_the_next_one_reads() {
    let folder = folder("chain");
    let run = |line: &str| done(&folder, line);
    run("zoo horse --faces 1000 --poses 3 --out horse.glb");
    run("zoo camel --faces 1000 --poses 1 --out camel.glb");
    run("keypoints horse.glb --points 6 --report points.json");
    run("weights horse.glb --handles points.json --report weights.json");
    run("propose horse.glb --target camel.glb --points points.json --report proposals.json");
    run("transfer horse.glb --target camel.glb --pairs proposals.json --out walking.glb");
    let read = |name: &str| json(&std::fs::read(folder.join(name)).unwrap());
    assert_eq!(read("weights.json")["handles"], read("points.json")["key_points"]);
    assert_eq!(read("proposals.json")["pairs"].as_array().map(Vec::len), Some(6));
    let walking = json(&sinew(&folder, &["inspect", "walking.glb", "--json"]).stdout);
    assert!(walking["poses"].as_u64() >= Some(3), "{walking}");
    let output = sinew(&folder, &["transfer", "horse.glb", "--target", "camel.glb", "--pairs", "points.json"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("points.json is no report with pairs"));
}

#[test]
fn pairs_of_other_points_tell_where_those_asked_for_lie() {
    let folder = folder("others");
    let run = |line: &str| done(&folder, line);
    run("zoo horse --faces 1000 --poses 1 --out horse.glb");
    let file =
        sinew::import::File { name: "horse.glb".into(), bytes: std::fs::read(folder.join("horse.glb")).unwrap() };
    let horse = sinew::import::open(&[file], &sinew::import::Options::default()).unwrap().sequence;
    let places = horse.reference();
    let middle = places.iter().map(|p| p.y).sum::<f64>() / places.len() as f64;
    // The horse looks along an axis, and is narrower across it.
    let wide = |axis: usize| places.iter().map(|p| p[axis].abs()).fold(0.0, f64::max);
    let across = if wide(0) < wide(2) { 0 } else { 2 };
    let side = |v: u32| places[v as usize][across];
    let mirrored = |v: u32| {
        let mut place = places[v as usize];
        place[across] = -place[across];
        let far = |u: &u32| places[*u as usize].distance_squared(place);
        (0..places.len() as u32).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap()
    };
    let legs: Vec<u32> = (0..places.len() as u32)
        .filter(|&v| places[v as usize].y < 0.5 * middle && side(v).abs() > 0.1 * wide(across))
        .collect();
    let (asked, told) = ([legs[0], legs[legs.len() / 2]], legs.iter().step_by(legs.len() / 8));
    let told: Vec<Value> = told
        .filter(|v| !asked.contains(v))
        .map(|&v| serde_json::json!({ "source": v, "target": mirrored(v) }))
        .collect();
    std::fs::write(folder.join("points.json"), serde_json::to_vec(&asked).unwrap()).unwrap();
    std::fs::write(folder.join("pairs.json"), serde_json::to_vec(&told).unwrap()).unwrap();
    let proposed = |more: &str| -> Vec<u32> {
        run(&format!("propose horse.glb --target horse.glb --points points.json --report out.json{more}"));
        let report = json(&std::fs::read(folder.join("out.json")).unwrap());
        report["pairs"].as_array().unwrap().iter().map(|pair| pair["target"].as_u64().unwrap() as u32).collect()
    };
    let (as_it_is, by_pairs) = (proposed(""), proposed(" --pairs pairs.json"));
    assert_eq!([as_it_is.len(), by_pairs.len()], [2, 2]);
    for (v, (same, other)) in asked.into_iter().zip(as_it_is.into_iter().zip(by_pairs)) {
        assert!(side(v) * side(same) > 0.0 && side(v) * side(other) < 0.0, "{v}: {same}, {other}");
    }
}
