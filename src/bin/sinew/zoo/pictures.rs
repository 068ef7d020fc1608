//! Pictures of the creatures in all their motions, and a page that shows them.

use super::unknown;
use crate::Refusal;
use crate::output;
use crate::picture::{Eye, Model, Picture, draw};
use sinew::view::palette::part_colours;
use sinew::zoo::{Creature, NAMES, Recipe, make, motions, title};
use std::fmt::Write;
use std::path::Path;

/// Pixels of a portrait.
const PORTRAIT: [usize; 2] = [168, 126];
/// Steps of brightness in a portrait are this wide: files are smaller and no eye sees it.
const STEP: u8 = 4;
/// Pixels of each pose in a strip, and how many there are.
const FRAME: [usize; 2] = [180, 150];
const FRAMES: usize = 8;
/// From where creatures are looked at: degrees to their left, and up.
const LEFT: f64 = 52.0;
const UP: f64 = 12.0;

/// Draws the named creatures into a folder: `NAME.png`, `NAME-MOTION.png`, a strip of poses for each motion, and
/// `index.html` with all of them.
pub fn write(folder: &Path, names: &[&str], recipe: impl Fn(&str) -> Recipe) -> Result<(), Refusal> {
    if let Some(name) = names.iter().find(|name| !NAMES.contains(name)) {
        return Err(unknown(name));
    }
    std::fs::create_dir_all(folder)
        .map_err(|error| Refusal(format!("{} cannot be made: {error}", folder.display())))?;
    let mut page = String::from(HEAD);
    for name in names {
        let wanted = recipe(name);
        let _ = writeln!(page, "<h2>{}</h2>\n<p><img src=\"{name}.png\" alt=\"\"></p>", title(name));
        for (number, motion) in motions(name).into_iter().enumerate() {
            if !wanted.motion.is_empty() && wanted.motion != motion {
                continue;
            }
            let recipe = Recipe { motion: motion.to_owned(), poses: FRAMES, ..wanted.clone() };
            let creature = make(&recipe).ok_or_else(|| unknown(name))?;
            let portrait = png(&portrait(&creature, motion))?;
            output::write(&folder.join(format!("{name}-{motion}.png")), &portrait)?;
            output::write(&folder.join(format!("{name}-{motion}-strip.png")), png(&strip(&creature))?)?;
            let _ = writeln!(page, "<p>{motion}<br><img src=\"{name}-{motion}-strip.png\" alt=\"\"></p>");
            if number == 0 || !wanted.motion.is_empty() {
                output::write(&folder.join(format!("{name}.png")), &portrait)?;
            }
        }
    }
    output::write(&folder.join("index.html"), page)
}

const HEAD: &str = "<!doctype html>
<html lang=\"en\">
<meta charset=\"utf-8\">
<title>The zoo</title>
<style>
  body { margin: 3rem; font: 16px/1.5 system-ui, sans-serif; background: #efebe4; color: #37332d; }
  img { max-width: 100%; }
  h2 { margin: 3rem 0 0; font-weight: 500; }
</style>
<h1>The zoo</h1>
";

/// Which pose shows a creature in a motion best.
fn best_pose(name: &str, motion: &str) -> usize {
    match (name, motion) {
        ("bird" | "person" | "robot" | "hand", "fly" | "walk" | "wave" | "grasp") => 0,
        ("horse" | "camel" | "giraffe" | "dog" | "cat" | "elephant", "walk" | "wave" | "collapse") => 3,
        (_, "gallop" | "swim") => 2,
        ("cloth", _) => 5,
        _ => 1,
    }
}

/// A creature in its most telling pose.
fn portrait(creature: &Creature, motion: &str) -> Picture {
    let poses = creature.sequence.poses();
    let pose = poses.get(best_pose(creature.sequence.name(), motion) % poses.len().max(1));
    let points = pose.map_or(creature.sequence.reference(), |pose| &pose.positions);
    let [width, height] = PORTRAIT;
    let eye = Eye::around(points.iter(), LEFT, UP, width as f64 / height as f64);
    let mut portrait = paint(creature, points, &eye, PORTRAIT);
    for value in portrait.pixels.as_flattened_mut() {
        *value = if *value > 255 - STEP { 255 } else { (*value + STEP / 2) / STEP * STEP };
    }
    portrait
}

/// All poses side by side, seen from one place, after the reference pose.
fn strip(creature: &Creature) -> Picture {
    let sequence = &creature.sequence;
    let [width, height] = FRAME;
    let poses: Vec<&[glam::DVec3]> =
        std::iter::once(sequence.reference()).chain(sequence.poses().iter().map(|p| p.positions.as_slice())).collect();
    let eye = Eye::around(poses.iter().copied().flatten(), LEFT, UP, width as f64 / height as f64);
    let mut strip = Picture::new(width * poses.len(), height);
    for (number, points) in poses.into_iter().enumerate() {
        strip.put(&paint(creature, points, &eye, FRAME), number * width, 0);
    }
    strip
}

fn paint(creature: &Creature, points: &[glam::DVec3], eye: &Eye, [width, height]: [usize; 2]) -> Picture {
    let colours = part_colours(creature.sequence.faces(), &creature.labels);
    let faces = creature.sequence.faces();
    let open = creature.plan == "cloth";
    draw(&Model { points, faces, labels: &creature.labels, colours: &colours, open }, eye, width, height)
}

fn png(picture: &Picture) -> Result<Vec<u8>, Refusal> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width as u32, picture.height as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(picture.pixels.as_flattened())?;
    writer.finish()?;
    Ok(bytes)
}
