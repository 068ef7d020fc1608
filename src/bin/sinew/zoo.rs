//! `sinew zoo`: creatures made by code.

use crate::Refusal;
use crate::output::{self, counted, say};
use clap::Args;
use sinew::export::labels;
use sinew::zoo::{NAMES, Recipe, make};
use std::path::PathBuf;

/// Arguments of `sinew zoo`.
#[derive(Args)]
pub struct Zoo {
    /// The creature
    #[arg(required_unless_present = "list")]
    name: Option<String>,
    /// List the creatures
    #[arg(long)]
    list: bool,
    /// About how many faces
    #[arg(long)]
    faces: Option<usize>,
    /// Poses in one loop of the motion
    #[arg(long)]
    poses: Option<usize>,
    /// Every vertex follows exactly one bone
    #[arg(long)]
    exact: bool,
    /// Write the creature, painted by its true parts
    #[arg(long, value_name = "FILE.glb")]
    out: Option<PathBuf>,
    /// Write the number of each face's true part, one a line
    #[arg(long, value_name = "FILE")]
    labels: Option<PathBuf>,
}

impl Zoo {
    /// Lists the creatures, or makes one and writes what was asked for.
    pub fn run(&self) -> Result<(), Refusal> {
        let Some(name) = self.name.as_ref().filter(|_| !self.list) else {
            NAMES.iter().for_each(say);
            return Ok(());
        };
        let default = Recipe::default();
        let recipe = Recipe {
            name: name.clone(),
            faces: self.faces.unwrap_or(default.faces),
            poses: self.poses.unwrap_or(default.poses),
            exact: self.exact,
        };
        let creature = make(&recipe)
            .ok_or_else(|| Refusal(format!("there is no {name} in the zoo; there are: {}", NAMES.join(", "))))?;
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
}
