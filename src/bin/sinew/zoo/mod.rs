//! `sinew zoo`: creatures made by code.

mod pictures;

use crate::Refusal;
use crate::output::{self, counted, say};
use clap::Args;
use sinew::export::labels;
use sinew::zoo::{NAMES, Recipe, make, motions};
use std::path::PathBuf;

/// Arguments of `sinew zoo`.
#[derive(Args)]
pub struct Zoo {
    /// The creature
    #[arg(required_unless_present_any = ["list", "pictures"])]
    name: Option<String>,
    /// List the creatures, or the motions of the one that is named
    #[arg(long)]
    list: bool,
    /// About how many faces, 1000 to 1000000
    #[arg(long)]
    faces: Option<usize>,
    /// Poses in one loop of the motion, 1 to 240
    #[arg(long)]
    poses: Option<usize>,
    /// Every vertex follows exactly one bone
    #[arg(long)]
    exact: bool,
    /// What it does: walk, gallop, …; `NAME --list` lists what there is
    #[arg(long)]
    motion: Option<String>,
    #[command(flatten)]
    proportions: Proportions,
    /// Write the creature, painted by its true parts
    #[arg(long, value_name = "FILE.glb")]
    out: Option<PathBuf>,
    /// Write the number of each face's true part, one a line
    #[arg(long, value_name = "FILE")]
    labels: Option<PathBuf>,
    /// Draw the creature, or all of them, in all motions: PNG files and a page that shows them
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,
}

/// Proportions, 1 each as the creature was designed.
#[derive(Args)]
struct Proportions {
    /// Size of everything
    #[arg(long, default_value_t = 1.0)]
    size: f64,
    /// Thickness of body and limbs (this and the following: 0.5 to 2)
    #[arg(long, default_value_t = 1.0)]
    build: f64,
    /// Size of the head
    #[arg(long, default_value_t = 1.0)]
    head: f64,
    /// Length of the neck
    #[arg(long, default_value_t = 1.0)]
    neck: f64,
    /// Length of the legs
    #[arg(long, default_value_t = 1.0)]
    legs: f64,
    /// Length of arms or wings
    #[arg(long, default_value_t = 1.0)]
    arms: f64,
    /// Length of the tail
    #[arg(long, default_value_t = 1.0)]
    tail: f64,
}

impl Zoo {
    /// Lists the creatures, or makes one and writes what was asked for.
    pub fn run(&self) -> Result<(), Refusal> {
        if self.list {
            return self.list();
        }
        let names: Vec<&str> = self.name.as_deref().map_or(NAMES.to_vec(), |name| vec![name]);
        if let Some(folder) = &self.pictures {
            return pictures::write(folder, &names, |name| self.recipe(name));
        }
        names.into_iter().try_for_each(|name| self.make(name))
    }

    fn list(&self) -> Result<(), Refusal> {
        match &self.name {
            None => NAMES.iter().for_each(say),
            Some(name) if NAMES.contains(&name.as_str()) => motions(name).iter().for_each(say),
            Some(name) => return Err(unknown(name)),
        }
        Ok(())
    }

    fn recipe(&self, name: &str) -> Recipe {
        let default = Recipe::default();
        let &Proportions { size, build, head, neck, legs, arms, tail } = &self.proportions;
        Recipe {
            name: name.to_owned(),
            faces: self.faces.unwrap_or(default.faces),
            poses: self.poses.unwrap_or(default.poses),
            exact: self.exact,
            motion: self.motion.clone().unwrap_or_default(),
            size,
            build,
            head,
            neck,
            legs,
            arms,
            tail,
        }
    }

    fn make(&self, name: &str) -> Result<(), Refusal> {
        let creature = make(&self.recipe(name)).ok_or_else(|| self.refusal(name))?;
        if let Some(path) = &self.labels {
            output::write(path, labels::text(&creature.labels))?;
        }
        if let Some(path) = &self.out {
            output::write_glb(path, &creature.sequence, &creature.labels, &creature.parts)?;
        }
        let sizes = creature.sequence.sizes();
        say(format_args!(
            "{name}: {} vertices, {}, {}, {} ({})",
            sizes.vertices,
            counted(sizes.faces, "face"),
            counted(sizes.poses, "pose"),
            counted(creature.parts.len(), "part"),
            creature.parts.join(", ")
        ));
        Ok(())
    }

    /// Why a creature cannot be made.
    fn refusal(&self, name: &str) -> Refusal {
        match &self.motion {
            Some(motion) if NAMES.contains(&name) && !motions(name).contains(&motion.as_str()) => {
                Refusal(format!("the {name} has no motion {motion}; it has: {}", motions(name).join(", ")))
            }
            _ if NAMES.contains(&name) => Refusal(format!("the {name} cannot be made of so many faces: ask for fewer")),
            _ => unknown(name),
        }
    }
}

fn unknown(name: &str) -> Refusal {
    Refusal(format!("there is no {name} in the zoo; there are: {}", NAMES.join(", ")))
}
