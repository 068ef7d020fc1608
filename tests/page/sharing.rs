//! Links, frames, files that hold everything, and what else can be taken away.

use crate::harness::picture::Picture;
use crate::harness::{Backend, Page, Screen, glb};
use crate::opening::{SETTLED, opened};
use crate::pairs::proposed;
use base64::{Engine, engine::general_purpose::STANDARD};
use serde_json::{Value, json};

const IDLE: &str = "!sinew.state().busy && sinew.state().drawn";

/// The bytes of a blob that an expression promises.
fn bytes_of(page: &mut Page, blob: &str) -> Vec<u8> {
    let code = format!(
        "(async () => {{ const blob = await {blob}; const reader = new FileReader();
        await new Promise((done) => {{ reader.onload = done; reader.readAsDataURL(blob); }});
        return reader.result.slice(reader.result.indexOf(',') + 1); }})()"
    );
    let text = page.evaluate_within(&code, 60.0);
    STANDARD.decode(text.as_str().unwrap_or_default()).expect("the browser writes base64")
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_link_brings_back_the_stage_the_face_and_the_pairs() {
    let mut page =
        opened(Backend::WebGl2, Screen::Still, "#v1;zoo=horse;faces=3000;poses=8;view=features;at=3;t=2;lesson=open");
    assert_eq!((&page.state()["view"], &page.state()["place"]), (&json!("features"), &json!(3)));
    page.evaluate("sinew.app.setView('gradients'); sinew.app.chooseFace(77)");
    page.evaluate("void sinew.app.target.openPair('horse', 'camel')");
    page.wait_until(&format!("sinew.state().moves && {IDLE}"), 60.0);
    page.evaluate("sinew.app.setStep('parts'); sinew.app.setView('merging'); sinew.app.setPlace(40)");
    page.rest(0.8);
    let hash = page.evaluate("location.hash").as_str().unwrap_or_default().to_owned();
    assert!(hash.len() < 2000, "{} characters", hash.len());
    let before = page.state();
    page.go(&format!("?again{hash}"));
    page.wait_until(&format!("location.search === '?again' && sinew.state().moves && {IDLE}"), 60.0);
    let after = page.state();
    for what in ["source", "target", "step", "view", "place", "tally", "points", "parts"] {
        assert_eq!(after[what], before[what], "{what}");
    }
    assert_eq!(page.evaluate("sinew.app.lessons"), true);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn odd_and_old_links_open_something() {
    let mut page = opened(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000;view=clusters;at=0");
    assert_eq!(page.state()["view"], "clusters");
    for hash in [
        "#v1;zoo=nothing;step=elsewhere;view=none;at=-5;face=99999999;points=1,b,,3;pairs=~x;parts=1e9;look=1,2",
        "#v1;zoo=snake;faces=3000;view=merging;at=99999;face=99999999;tour=nowhere.7;p.epsilon=%22x%22;parts=-3;t=NaN",
        "#v9;something=new",
        "#%%%;;;===",
    ] {
        page.go(&format!("?{}{hash}", hash.len()));
        page.wait_until(&format!("location.search === '?{}' && {SETTLED}", hash.len()), 30.0);
        assert_eq!(page.state()["error"], Value::Null, "{hash}");
    }
    // What is shown is what is said of it, and two points are not in one place.
    page.go("?bounds#v1;zoo=snake;faces=-5.5;poses=9999;target=snake;target.faces=1e3;points=1,50,100;pairs=~7,~7,7");
    let distinct = "new Set(sinew.app.doc.points.map(({ target }) => target)).size === 3";
    page.wait_until(
        &format!("location.search === '?bounds' && sinew.state().moves?.pairs === 3 && {distinct} && {IDLE}"),
        60.0,
    );
    let (state, recipe) =
        (page.state(), page.evaluate("[sinew.app.source.recipe.faces, sinew.app.source.recipe.poses]"));
    assert_eq!((&state["error"], recipe, &state["source"]["poses"]), (&Value::Null, json!([1000, 240]), &json!(240)));
    page.go("?unknown#v1;zoo=nothing;target=zzz;t=99999");
    page.wait_until(&format!("location.search === '?unknown' && {SETTLED}"), 30.0);
    let said = page.evaluate("sinew.app.notice?.text").to_string();
    assert!(said.contains("“nothing”") && said.contains("“zzz”"), "{said}");
    assert_eq!(page.state()["time"], 0, "there is no such moment to stop at");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_frame_shows_the_picture_with_or_without_controls() {
    let mut page = opened(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000;parts=4");
    page.click("#open-share");
    page.wait_until("document.querySelector('#share').open", 2.0);
    let link = page.evaluate("document.querySelector('#share-link').value");
    assert!(link.as_str().is_some_and(|link| link.contains("zoo=snake") && link.contains("parts=4")), "{link}");
    let source = |page: &mut Page, kind: &str| {
        let code = page.evaluate(&format!(
            "import(new URL('www/share.js', location.href)).then(({{ embedCode }}) => {{
            const code = embedCode(sinew.app, sinew.app.timeline, '{kind}');
            return code.split('\"')[1].replaceAll('&#38;', '&'); }})"
        ));
        code.as_str().unwrap_or_default().split_once('?').map(|(_, tail)| format!("?{tail}")).unwrap_or_default()
    };
    let (controls, bare) = (source(&mut page, "controls"), source(&mut page, "bare"));
    let shown = "['.rail', '.panel', '.tools', '.below', '#whole'].filter((name) => document.querySelector(name).checkVisibility())";
    for (tail, wanted) in [(controls, json!([".below", "#whole"])), (bare, json!([]))] {
        page.go(&tail);
        page.wait_until(&format!("location.search.includes('embed') && {SETTLED} && sinew.state().parts === 4"), 30.0);
        assert_eq!(page.evaluate(shown), wanted, "{tail}");
        let canvas = page.picture_of("#stage canvas", "embed");
        assert!(canvas.hues(0.001) >= 3, "{tail}");
    }
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn addresses_that_are_neither_https_nor_here_are_refused() {
    let mut page = opened(Backend::WebGl2, Screen::Still, "?src=http://other.example/a.glb#v1");
    let state = page.state();
    assert!(state["error"].as_str().is_some_and(|error| error.contains("https")), "{state}");
    assert_eq!(state["source"]["name"], "horse", "{state}");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_project_holds_the_visitors_own_files() {
    let mut page = opened(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000");
    page.drop_files(&[("hinge.glb", &glb::hinge(24))]);
    page.wait_until("sinew.state().source.name.includes('hinge') && sinew.state().parts === 2", 30.0);
    page.evaluate("sinew.app.setStep('keypoints')");
    page.wait_until("sinew.state().points > 1 && !sinew.state().busy", 30.0);
    page.evaluate("sinew.app.setStep('target')");
    page.drop_files(&[("other.glb", &glb::hinge(16))]);
    page.wait_until(&format!("sinew.state().target && sinew.state().moves && {IDLE}"), 30.0);
    page.evaluate("sinew.app.target.acceptAll(); sinew.app.setStep('parts'); sinew.app.setView('clusters')");
    page.wait_until(&format!("sinew.state().tally.proposed === 0 && {IDLE}"), 30.0);
    let before = page.state();
    page.click("#open-share");
    let warned = page.evaluate("document.querySelector('#share .warning').innerText");
    assert!(warned.as_str().is_some_and(|text| text.contains("stays on this computer")), "{warned}");
    let project = "import(new URL('www/project.js', location.href)).then(({ writeProject }) => writeProject(sinew.app, sinew.app.timeline))";
    let bytes = bytes_of(&mut page, project);
    // It is a GLB as any other.
    let gltf = gltf::Gltf::from_slice(&bytes).expect("a valid GLB");
    assert_eq!(gltf.meshes().next().map(|mesh| mesh.primitives().len()), Some(2));
    // With points that were placed the browser would ask, and nobody is there to answer.
    page.evaluate("sinew.app.target.close()");
    page.go("?again#v1;zoo=snake;faces=3000");
    page.wait_until(&format!("location.search === '?again' && {SETTLED}"), 30.0);
    page.drop_files(&[("project.glb", &bytes)]);
    page.wait_until(
        &format!(
            "sinew.state().source.name.includes('hinge') && sinew.state().target && sinew.state().moves && {IDLE}"
        ),
        30.0,
    );
    let after = page.state();
    for what in ["source", "target", "parts", "step", "view", "points", "tally"] {
        assert_eq!(after[what], before[what], "{what}");
    }
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn what_is_taken_away_comes_back() {
    let mut page = opened(Backend::WebGl2, Screen::Still, "#v1;zoo=horse;faces=3000;poses=8;t=2");
    let residual = page.state()["residual"].as_f64().unwrap_or(f64::NAN);
    let made = page.evaluate(
        "sinew.app.parts.exportRigid().then(({ bytes, error, rms }) => (window.rigid = bytes, [error, rms]))",
    );
    let (error, rms) = (made[0].as_f64().unwrap_or(f64::NAN), made[1].as_f64().unwrap_or(f64::NAN));
    println!("rigid skin: rms {rms:.5}, largest {error:.5}, residual of the parts {residual:.5}");
    assert!(
        rms > 0.0 && rms < 4.0 * residual + 1e-4 && rms <= error,
        "rms {rms}, largest {error}, residual {residual}"
    );
    let bytes = bytes_of(&mut page, "Promise.resolve(new Blob([window.rigid]))");
    let sizes = |page: &mut Page, pixels: &str| {
        page.evaluate(&format!(
            "sinew.app.stage.picture({pixels}).then(createImageBitmap).then(({{ width, height }}) => [width, height])"
        ))
    };
    assert_eq!(sizes(&mut page, "[1600, 1200]"), json!([1600, 1200]));
    let shown = sizes(&mut page, "null");
    assert_eq!(shown, json!([960, 640]), "the picture has its size again");
    for (file, field) in [("partsFile", "labels"), ("pointsFile", "key_points")] {
        let list = page.evaluate(&format!(
            "import(new URL('www/save.js', location.href)).then(({{ {file} }}) => {file}(sinew.app).text()).then((text) => JSON.parse(text).{field}.length)"
        ));
        assert!(list.as_u64().is_some(), "{file}: {list}");
    }
    let video = "import(new URL('www/video.js', location.href)).then(({ recordLoop }) => recordLoop([sinew.app.stage], sinew.app.timeline, () => {})).then(({ blob }) => blob)";
    let film = bytes_of(&mut page, video);
    assert!(film.len() > 2000 && film.starts_with(&[0x1a, 0x45, 0xdf, 0xa3]), "a WebM of {} bytes", film.len());
    page.drop_files(&[("rigid.glb", &bytes)]);
    page.wait_until(&format!("sinew.state().source.name.includes('rigid') && {SETTLED}"), 30.0);
    let again = page.state();
    assert!(again["residual"].as_f64().is_some_and(|again| again < residual + 1e-4), "a rigid skin is rigid: {again}");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_picture_holds_both_figures() {
    let mut page = proposed(Backend::WebGl2, Screen::Still);
    let seam = page.evaluate("document.querySelector('#second').getBoundingClientRect().left");
    let seam = seam.as_f64().unwrap_or_default() as usize;
    let taken = |page: &mut Page, asked: &str| {
        let blob = format!(
            "import(new URL('www/save.js', location.href)).then(({{ pictureOf, shownFigures }}) => pictureOf(shownFigures(sinew.app), {asked}))"
        );
        Picture::from_png(&bytes_of(page, &blob))
    };
    for (asked, size, middle) in [("null", (960, 640), seam), ("[800, 600]", (800, 600), 400)] {
        let picture = taken(&mut page, asked);
        assert_eq!((picture.width, picture.height), size, "{asked}");
        // Pins have many hues, clay and ground have one.
        for (left, width) in [(0, middle), (middle, picture.width - middle)] {
            let figure = picture.cut(left, 0, width, picture.height);
            assert!(figure.hues(0.0002) >= 3, "{asked}, from {left}: {} hues", figure.hues(0.0002));
        }
        let [aside, seam] = [middle / 2, middle].map(|x| picture.cut(x - 4, 0, 8, 8).brightness());
        assert!(seam >= aside, "{asked}: the ground is darker between the figures, {seam} beside {aside}");
    }
    page.resize(Screen::Phone);
    page.evaluate("sinew.app.setPanel(false)");
    page.wait_until("document.documentElement.hasAttribute('data-stacked') && sinew.state().drawn", 10.0);
    let picture = taken(&mut page, "null");
    assert_eq!((picture.width, picture.height), (780, 1688));
    let [left, right] = [0, 760].map(|x| picture.cut(x, 1200, 20, 20).brightness());
    assert!(left > 150.0 && (left - right).abs() < 10.0, "the lower figure fades in from above: {left}, {right}");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn letters_of_any_language_stay_in_the_names_of_files() {
    let mut page = opened(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000");
    let names = page.evaluate(
        "import(new URL('www/save.js', location.href)).then(({ fileName }) =>
        ['Füchse & Söhne.glb', '狐狸.obj', '-- walk (2) --.glb', '!.glb'].map((name) => fileName({ sequence: { name } })))",
    );
    assert_eq!(names, json!(["sinew-Füchse-Söhne", "sinew-狐狸", "sinew-walk-2", "sinew-picture"]));
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_video_is_recorded_or_cancelled() {
    let mut page = opened(Backend::WebGl2, Screen::Small, "#v1;zoo=snake;faces=3000;poses=24;t=2");
    // What the page hands to the browser to keep.
    page.evaluate(
        "window.kept = []; HTMLAnchorElement.prototype.click = function () { kept.push(this.download); }; undefined",
    );
    page.evaluate("sinew.app.setStep('export'); document.querySelector('#export-video').click()");
    page.wait_until(
        "sinew.app.busy?.lane === 'video' && sinew.state().playing && !document.querySelector('#progress').hidden",
        10.0,
    );
    page.click("#progress button");
    page.wait_until("!sinew.state().busy && !sinew.app.recording", 5.0);
    let state = page.state();
    assert_eq!(
        (&state["error"], &state["playing"], &state["time"]),
        (&Value::Null, &json!(false), &json!(2)),
        "{state}"
    );
    assert_eq!(page.evaluate("kept"), json!([]), "what was cancelled is not saved");
    // Slowly: software may take half a second to draw a picture.
    page.evaluate("sinew.app.timeline.speed = 0.25; document.querySelector('#export-video').click()");
    page.wait_until("kept.length === 1 && !sinew.state().busy", 60.0);
    let name = page.evaluate("kept[0]");
    assert!(name.as_str().is_some_and(|name| name.ends_with(".webm")), "{name}");
    let state = page.state();
    assert_eq!((&state["playing"], &state["time"]), (&json!(false), &json!(2)), "one goes on where one was: {state}");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_link_that_asks_for_too_many_parts_says_how_many_there_are() {
    let mut page = opened(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000;parts=100000");
    page.wait_until("sinew.state().parts > 48 && location.hash.includes(`parts=${sinew.state().parts}`)", 20.0);
    let shown =
        "[document.querySelector('#control-number-of-parts').value, document.querySelector('.legend output').value]";
    let parts = page.state()["parts"].to_string();
    assert_eq!(page.evaluate(shown), json!([parts, parts]));
    assert_eq!(page.state()["undo"], 0, "that is no step of its own");
}
