//! The search for key points on the coarse mesh (§3.5): add the best one, then replace them in turn.
//!
//! Algorithm 1 solves, for every candidate at every step, the weights of all handles and the fit of all poses. Here three
//! sieves of growing fineness do it:
//!
//! 1. All candidates are ranked by how much squared distance the four functions `w_c [p − c, 1]` take from what the
//!    points so far leave over. Were weights not bounded, adding a handle would add just these to the space of Eq. 2, for
//!    `w_k′ = w_k − w_k(c) w_c′`.
//! 2. The better ones are fitted with these `w_k′`, cut off at 0, as weights.
//! 3. The best few get true bounded weights ([`super::field`]) and are fitted again.
//!
//! Taking a point away works the same way round: a field rises by as much of the field of that point as balances the
//! force that held it down there.

use super::coarse::CoarseMesh;
use super::field::{Field, NOTHING, Scratch};
use super::leftover::Leftover;
use super::result::Tried;
use crate::crew::Crew;
use crate::skinning::{FitParameters, Fitter, Rows, SkinnedMesh, clusters};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// How many candidates pass the first and the second sieve when a point is added.
const ADDING: [usize; 2] = [20, 3];

/// How many pass the first when one is replaced; the second, one.
const REPLACING: usize = 12;

/// The same when one is moved to a vertex at most so many edges away.
const MOVING: usize = 4;
const RINGS: usize = 2;

/// Fields that are estimated one after the other: they have some of their factors in common.
const PROBES: usize = 8;

/// A replacement must gain more than this share of the error…
pub const WORTH: f64 = 1e-4;

/// …and than this: below it, errors are rounding.
const ROUNDING: f64 = 1e-12;

/// A field that is below this at a vertex hardly feels what happens there.
const FELT: f64 = 1e-3;

/// A set of key points on the coarse mesh.
#[derive(Clone, Default, Serialize, Deserialize)]
pub struct Set {
    /// Vertices of the coarse mesh, in the order chosen.
    pub members: Vec<u32>,
    fields: Vec<Field>,
    /// Fields that are estimates.
    rough: Vec<bool>,
    groups: Vec<u32>,
    /// Mean vertex distance over poses.
    pub error: f64,
}

/// A vertex and an estimate of its field.
type Probed<'f> = (u32, &'f Field);

/// The search at one moment.
pub struct Search<'a> {
    coarse: &'a CoarseMesh,
    fit: FitParameters,
    /// The set so far.
    pub set: Set,
    /// For each candidate, an estimate of its field if it were added.
    probes: Vec<Field>,
}

impl<'a> Search<'a> {
    /// Starts from the first candidate (§3.5), which matters little, as it will be replaced.
    pub async fn new(crew: &impl Crew, coarse: &'a CoarseMesh, fit: FitParameters) -> Self {
        let mut search = Self::from_points(coarse, fit, coarse.candidates.get(..1).unwrap_or_default());
        search.probe(crew).await;
        search
    }

    /// Starts from points (vertices of the coarse mesh). They can be moved and put in order, and after
    /// [`Search::probe`] replaced.
    pub fn from_points(coarse: &'a CoarseMesh, fit: FitParameters, points: &[u32]) -> Self {
        let fit = FitParameters { rounds: 6, tolerance: 1e-3, ..fit };
        let mut search = Self { coarse, fit, set: Set::default(), probes: Vec::new() };
        if points.is_empty() {
            return search;
        }
        let mut scratch = Scratch::default();
        let field = |k: usize| coarse.energy.field(points[k], &without(points, k), None, &mut scratch);
        let fields = (0..points.len()).map(field).collect();
        let (groups, rough) = (vec![0; coarse.energy.len()], vec![false; points.len()]);
        search.set = search.regrouped(Set { members: points.to_vec(), fields, rough, groups, error: 0.0 });
        search
    }

    /// Estimates the candidates' fields anew: while the set changes, they grow worse.
    pub async fn probe(&mut self, crew: &impl Crew) {
        let Set { members, fields, .. } = &self.set;
        let some: Vec<&[u32]> = self.coarse.candidates.chunks(PROBES).collect();
        let probes = |i: usize| -> Vec<Field> {
            let mut scratch = Scratch::default();
            let probe = |&c: &u32| match members.iter().position(|&m| m == c) {
                Some(place) => fields[place].clone(),
                None => self.coarse.energy.estimate(c, members, &mut scratch),
            };
            some[i].iter().map(probe).collect()
        };
        self.probes = crew.each(some.len(), &probes).await.concat();
    }

    /// What [`Search::restore`] goes back to.
    pub fn state(&self) -> (Set, Vec<Field>) {
        (self.set.clone(), self.probes.clone())
    }

    /// Goes back.
    pub fn restore(&mut self, (set, probes): (Set, Vec<Field>)) {
        (self.set, self.probes) = (set, probes);
    }

    /// Adds the best candidate; what was tried, or `None` if there is no other candidate.
    pub async fn add(&mut self, crew: &impl Crew) -> Option<Vec<Tried>> {
        let probes = self.probes.clone();
        let free: Vec<Probed> = self.coarse.candidates.iter().copied().zip(&probes).collect();
        let ranked = self.ranked(&self.set, &free);
        let [some, few] = ADDING;
        let some = &ranked[..some.min(ranked.len())];
        let errors = crew.each(some.len(), &|i| self.error(&self.with(&self.set, some[i]))).await;
        let mut tried = ascending(errors.into_iter().zip(some.iter().copied()).collect());
        let refined = crew.each(few.min(tried.len()), &|i| self.refined(self.with(&self.set, tried[i].1))).await;
        tried.iter_mut().zip(&refined).for_each(|(tried, set)| tried.0 = set.error);
        let best = refined.into_iter().reduce(|best, set| if set.error < best.error { set } else { best })?;
        let tried = tried.iter().map(|&(error, (vertex, _))| self.tried(vertex, error)).collect();
        self.accept(self.regrouped(best), probes);
        Some(tried)
    }

    /// Takes away the point that can be spared best; `None` if there is only one.
    pub async fn remove(&mut self, crew: &impl Crew) -> Option<()> {
        let place = self.spared(crew, &self.set).await?;
        let probes = self.released(place);
        let rest = self.refined(self.without(&self.set, place));
        self.set = self.regrouped(rest);
        self.probes = probes;
        Some(())
    }

    /// A better set, the point at `place` replaced by another candidate; see [`Search::accept_instead`].
    pub fn replaced(&self, place: usize) -> Option<Set> {
        let probes = self.released(place);
        let candidates: Vec<Probed> = self.coarse.candidates.iter().copied().zip(&probes).collect();
        self.instead(place, &candidates, REPLACING)
    }

    /// A better set, the point at `place` moved to a vertex near it; see [`Search::accept_instead`].
    pub fn shifted(&self, place: usize) -> Option<Set> {
        let near = self.coarse.around(self.set.members[place], RINGS);
        let zeros = without(&self.set.members, place);
        let fields = self.coarse.energy.fields_like(&near, &zeros, &self.set.fields[place], &mut Scratch::default());
        let near: Vec<Probed> = near.iter().copied().zip(&fields).filter(|(_, f)| !f.value.is_empty()).collect();
        self.instead(place, &near, MOVING)
    }

    /// The set with the best of others in place of the point at `place`, if it is better; the new point comes last. So many
    /// of them `pass` the first sieve, and one the second.
    fn instead(&self, place: usize, others: &[Probed], pass: usize) -> Option<Set> {
        let base = self.without(&self.set, place);
        let tried = self.ranked(&base, others).into_iter().take(pass);
        let tried = ascending(tried.map(|one| (self.error(&self.with(&base, one)), one)).collect());
        let &(_, best) = tried.first().filter(|(error, _)| *error <= self.set.error)?;
        let better = self.refined(self.with(&base, best));
        // New groups change the error a little: only what is better with them is an improvement.
        let better = self.regrouped(better);
        (better.error < self.set.error * (1.0 - WORTH) - ROUNDING).then_some(better)
    }

    /// Takes a set over whose last point replaces that at `place`; the places of the points whose fields felt it.
    pub fn accept_instead(&mut self, place: usize, mut better: Set) -> Vec<usize> {
        let probes = self.released(place);
        // The new point takes the place of the old one.
        better.members[place..].rotate_right(1);
        better.fields[place..].rotate_right(1);
        better.rough[place..].rotate_right(1);
        let felt = |&k: &usize| self.set.fields[k].differs(&better.fields[k], FELT);
        let felt = (0..better.fields.len()).filter(felt).collect();
        self.accept(better, probes);
        felt
    }

    /// The probes when the point at `place` is not there.
    fn released(&self, place: usize) -> Vec<Field> {
        let (vertex, bump) = (self.set.members[place], &self.set.fields[place]);
        let released = |(&c, probe): (&u32, &Field)| {
            if c == vertex {
                bump.clone()
            } else if self.set.members.contains(&c) {
                probe.clone()
            } else {
                let bump = bump.lowered(c, probe);
                probe.plus(self.coarse.energy.share(probe, vertex, &bump), &bump)
            }
        };
        self.coarse.candidates.iter().zip(&self.probes).map(released).collect()
    }

    /// The place of the point that can be spared best; `None` if there is only one.
    async fn spared(&self, crew: &impl Crew, set: &Set) -> Option<usize> {
        if set.members.len() < 2 {
            return None;
        }
        let errors = crew.each(set.members.len(), &|place| self.error(&self.without(set, place))).await;
        (0..errors.len()).min_by(|&a, &b| errors[a].total_cmp(&errors[b]))
    }

    /// The points (vertices of the coarse mesh) in the order in which they count, and the error with the first 1, 2, … of
    /// them: time and again the one is taken away that can be spared best, and what is left first comes first.
    pub async fn order(&self, crew: &impl Crew) -> (Vec<u32>, Vec<f64>) {
        let mut set = self.set.clone();
        let (mut order, mut errors) = (Vec::new(), vec![set.error]);
        while let Some(gone) = self.spared(crew, &set).await {
            order.push(set.members[gone]);
            set = self.regrouped(self.refined(self.without(&set, gone)));
            errors.push(set.error);
        }
        order.extend(set.members);
        order.reverse();
        errors.reverse();
        (order, errors)
    }

    /// Takes a set over as the current one; `probes` are those of the set before its last point came in.
    fn accept(&mut self, set: Set, mut probes: Vec<Field>) {
        for (added, field) in set.members.iter().zip(&set.fields).filter(|(m, _)| !self.set.members.contains(m)) {
            for (own, probe) in self.coarse.candidates.iter().zip(&mut probes) {
                let reach = probe.value[*added as usize];
                if own != added && reach > NOTHING {
                    // 1 at the candidate and 0 at the new point, both being 0 at all others.
                    let whole = 1.0 - reach * field.value[*own as usize];
                    *probe = probe.plus(-reach, field).times(1.0 / whole.max(NOTHING), *own);
                }
            }
        }
        self.set = set;
        self.probes = probes;
    }

    /// The set with its own groups (§3.3), and its error with them.
    fn regrouped(&self, mut set: Set) -> Set {
        let surface = &self.coarse.surface;
        set.groups = clusters(&self.weights(&set), &self.coarse.features, &set.members, &surface.counts);
        set.error = self.error(&set);
        set
    }

    /// The set without one of its points: the fields that it held down rise.
    fn without(&self, set: &Set, place: usize) -> Set {
        let mut rest = set.clone();
        let vertex = rest.members.remove(place);
        let bump = rest.fields.remove(place);
        rest.rough.remove(place);
        for (field, rough) in rest.fields.iter_mut().zip(&mut rest.rough) {
            let share = self.coarse.energy.share(field, vertex, &bump);
            if share > FELT {
                *field = field.plus(share, &bump);
                *rough = true;
            }
        }
        rest
    }

    /// The set with one point more: the fields that reach there are held down.
    fn with(&self, base: &Set, (vertex, probe): Probed) -> Set {
        let mut set = base.clone();
        for (field, rough) in set.fields.iter_mut().zip(&mut set.rough) {
            if field.value[vertex as usize] > NOTHING {
                *rough |= field.value[vertex as usize] > FELT;
                *field = field.lowered(vertex, probe);
            }
        }
        set.members.push(vertex);
        set.fields.push(probe.clone());
        set.rough.push(true);
        set
    }

    /// The set with true fields where it has estimates, and its error.
    fn refined(&self, mut set: Set) -> Set {
        let mut scratch = Scratch::default();
        for k in 0..set.members.len() {
            if set.rough[k] {
                let zeros = without(&set.members, k);
                set.fields[k] = self.coarse.energy.field(set.members[k], &zeros, Some(&set.fields[k]), &mut scratch);
                set.rough[k] = false;
            }
        }
        set.error = self.error(&set);
        set
    }

    /// #V × #H row-major: fields over their sums; pieces without a handle follow the nearest that has one.
    fn weights(&self, set: &Set) -> Vec<f64> {
        let (n, h) = (self.coarse.energy.len(), set.members.len());
        let mut has_handle = vec![false; self.coarse.surface.pieces.len()];
        for &m in &set.members {
            if let Some(has) = has_handle.get_mut(self.coarse.energy.piece(m) as usize) {
                *has = true;
            }
        }
        let all = has_handle.iter().all(|&has| has);
        let mut weights = vec![0.0; n * h];
        for v in 0..n {
            let own = has_handle.get(self.coarse.energy.piece(v as u32) as usize).copied().unwrap_or(false);
            let from = if all || own { Some(v as u32) } else { self.coarse.followed(v, &has_handle) };
            let Some(from) = from else { continue };
            let sum: f64 = set.fields.iter().map(|field| field.value[from as usize]).sum();
            for (k, field) in set.fields.iter().enumerate() {
                weights[v * h + k] = if sum > 0.0 { field.value[from as usize] / sum } else { 1.0 / h as f64 };
            }
        }
        weights
    }

    /// The mean vertex distance over all poses when the set's maps are fitted.
    fn error(&self, set: &Set) -> f64 {
        let surface = &self.coarse.surface;
        let rows = Rows::new(&self.weights(set), set.members.len());
        let mesh = SkinnedMesh {
            reference: &surface.reference,
            edges: &surface.laplacian.edges,
            stiffness: &surface.laplacian.cotangents,
            mass: &surface.counts,
            handles: &set.members,
            weights: &rows,
            groups: &set.groups,
            ball: (DVec3::ZERO, 1.0),
        };
        let fitter = Fitter::new(&mesh, &self.fit);
        let sum: f64 = self.coarse.placed.iter().map(|placed| fitter.fit_error(placed)).sum();
        sum / surface.poses.len().max(1) as f64
    }

    /// Of `others`, those that are not in the set, by how much they take from what `base` leaves over, the most first.
    fn ranked<'f>(&self, base: &Set, others: &[Probed<'f>]) -> Vec<Probed<'f>> {
        let leftover = Leftover::new(self.coarse, &base.members, &self.weights(base), self.fit.hold);
        let free = others.iter().filter(|(v, _)| !self.set.members.contains(v));
        let ranked = ascending(free.map(|&one| (-leftover.gain(one.0, one.1), one)).collect());
        ranked.into_iter().map(|(_, one)| one).collect()
    }

    fn tried(&self, vertex: u32, error: f64) -> Tried {
        Tried { vertex: self.coarse.surface.origin[vertex as usize], error }
    }
}

/// Sorted by the number that comes with each.
fn ascending(mut list: Vec<(f64, Probed)>) -> Vec<(f64, Probed)> {
    list.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.0.cmp(&b.1.0)));
    list
}

/// All but one.
fn without(points: &[u32], place: usize) -> Vec<u32> {
    let mut others = points.to_vec();
    others.remove(place);
    others
}
