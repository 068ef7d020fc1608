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

use super::coarse::Coarse;
use super::field::{Field, NOTHING, Scratch};
use super::leftover::Leftover;
use super::result::Tried;
use crate::skinning::{FitParameters, Fitter, Rig, Rows, clusters};
use glam::DVec3;

/// How many candidates pass the first and the second sieve when a point is added.
const ADDING: [usize; 2] = [20, 3];

/// The same when one is replaced.
const REPLACING: [usize; 2] = [12, 1];

/// The same when one is moved to a vertex at most so many edges away.
const MOVING: [usize; 2] = [4, 1];
const RINGS: usize = 2;

/// A replacement must gain more than this share of the error…
pub const WORTH: f64 = 1e-4;

/// …and than this: below it, errors are rounding.
const ROUNDING: f64 = 1e-12;

/// A field that is below this at a vertex hardly feels what happens there.
const FELT: f64 = 1e-3;

/// Asked now and then: whether to go on.
pub type KeepGoing<'a> = &'a mut dyn FnMut() -> bool;

/// A set of key points on the coarse mesh.
#[derive(Clone, Default)]
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

/// The search at one moment.
pub struct Search<'a> {
    coarse: &'a Coarse,
    fit: FitParameters,
    scratch: Scratch,
    /// The set so far.
    pub set: Set,
    /// For each candidate, an estimate of its field if it were added.
    probes: Vec<Field>,
}

impl<'a> Search<'a> {
    /// Starts from the first candidate (§3.5), which matters little, as it will be replaced.
    pub fn new(coarse: &'a Coarse, fit: FitParameters) -> Self {
        let mut search = Self::from_points(coarse, fit, coarse.candidates.get(..1).unwrap_or_default());
        search.probe();
        search
    }

    /// Starts from points (vertices of the coarse mesh). They can be moved and put in order, and after
    /// [`Search::probe`] replaced.
    pub fn from_points(coarse: &'a Coarse, fit: FitParameters, points: &[u32]) -> Self {
        let fit = FitParameters { rounds: 6, tolerance: 1e-3, ..fit };
        let mut search = Self { coarse, fit, scratch: Scratch::default(), set: Set::default(), probes: Vec::new() };
        if points.is_empty() {
            return search;
        }
        let fields = (0..points.len()).map(|k| search.field(points[k], &without(points, k), None)).collect();
        let (groups, rough) = (vec![0; coarse.energy.len()], vec![false; points.len()]);
        search.set = search.regrouped(Set { members: points.to_vec(), fields, rough, groups, error: 0.0 });
        search
    }

    /// Estimates the candidates' fields anew: while the set changes, they grow worse.
    pub fn probe(&mut self) {
        let members = self.set.members.clone();
        let probe = |&c: &u32| match members.iter().position(|&m| m == c) {
            Some(place) => self.set.fields[place].clone(),
            None => self.coarse.energy.estimate(c, &members, &mut self.scratch),
        };
        self.probes = self.coarse.candidates.iter().map(probe).collect();
    }

    /// What [`Search::restore`] goes back to.
    pub fn state(&self) -> (Set, Vec<Field>) {
        (self.set.clone(), self.probes.clone())
    }

    /// Goes back.
    pub fn restore(&mut self, (set, probes): (Set, Vec<Field>)) {
        (self.set, self.probes) = (set, probes);
    }

    /// Adds the best candidate; what was tried, or `None` if there is no other candidate, or no wish to go on.
    pub fn add(&mut self, keep_going: KeepGoing) -> Option<Vec<Tried>> {
        let probes = self.probes.clone();
        let free: Vec<(u32, &Field)> = self.coarse.candidates.iter().copied().zip(&probes).collect();
        let base = self.set.clone();
        let (best, tried) = self.sieve(&base, &free, ADDING, f64::INFINITY, keep_going)?;
        self.accept(best.map(|best| self.regrouped(best))?, probes);
        Some(tried)
    }

    /// Takes away the point that can be spared best; `None` on no wish to go on, or if there is only one.
    pub fn remove(&mut self, keep_going: KeepGoing) -> Option<()> {
        let (place, rest) = self.spared(&self.set, keep_going)?;
        let probes = self.released(place);
        let rest = self.refined(rest);
        self.set = self.regrouped(rest);
        self.probes = probes;
        Some(())
    }

    /// Tries to replace the point at `place`; whether a better one was found, or `None` on no wish to go on.
    pub fn replace(&mut self, place: usize, keep_going: KeepGoing) -> Option<bool> {
        let probes = self.released(place);
        let candidates: Vec<(u32, &Field)> = self.coarse.candidates.iter().copied().zip(&probes).collect();
        let best = self.instead(place, &candidates, REPLACING, keep_going)?;
        Some(self.accept_instead(place, best, Some(probes)))
    }

    /// Tries to move the point at `place` to a vertex near it; whether that was for the better, or `None` on no wish to go
    /// on.
    pub fn shift(&mut self, place: usize, keep_going: KeepGoing) -> Option<bool> {
        let near = self.coarse.around(self.set.members[place], RINGS);
        let zeros = without(&self.set.members, place);
        let fields = self.coarse.energy.fields_like(&near, &zeros, &self.set.fields[place], &mut self.scratch);
        let near: Vec<(u32, &Field)> = near.iter().copied().zip(&fields).filter(|(_, f)| !f.value.is_empty()).collect();
        let best = self.instead(place, &near, MOVING, keep_going)?;
        Some(self.accept_instead(place, best, None))
    }

    /// The best of others, with estimates of their fields, in place of the point at `place`.
    fn instead(
        &mut self,
        place: usize,
        others: &[(u32, &Field)],
        pass: [usize; 2],
        keep_going: KeepGoing,
    ) -> Option<Option<Set>> {
        let base = self.without(&self.set, place);
        let (best, _) = self.sieve(&base, others, pass, self.set.error, keep_going)?;
        // New groups change the error a little: only what is better with them is an improvement.
        Some(best.map(|best| self.regrouped(best)))
    }

    /// Takes a set over, whose last point replaces that at `place`, if it is better. `probes` are those without the point at
    /// `place`, if they are known.
    fn accept_instead(&mut self, place: usize, best: Option<Set>, probes: Option<Vec<Field>>) -> bool {
        let enough = self.set.error * (1.0 - WORTH) - ROUNDING;
        let Some(mut best) = best.filter(|best| best.error < enough) else { return false };
        let probes = probes.unwrap_or_else(|| self.released(place));
        // The new point takes the place of the old one.
        best.members[place..].rotate_right(1);
        best.fields[place..].rotate_right(1);
        best.rough[place..].rotate_right(1);
        self.accept(best, probes);
        true
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

    /// The point that can be spared best, and an estimate of the set without it.
    fn spared(&self, set: &Set, keep_going: KeepGoing) -> Option<(usize, Set)> {
        if set.members.len() < 2 {
            return None;
        }
        let mut best: Option<(usize, Set)> = None;
        for place in 0..set.members.len() {
            if !keep_going() {
                return None;
            }
            let mut rest = self.without(set, place);
            rest.error = self.error(&rest);
            if best.as_ref().is_none_or(|(_, b)| rest.error < b.error) {
                best = Some((place, rest));
            }
        }
        best
    }

    /// The points (vertices of the coarse mesh) in the order in which they count, and the error with the first 1, 2, … of them: time and again the one
    /// is taken away that can be spared best, and what is left first comes first.
    pub fn order(&mut self, keep_going: KeepGoing) -> Option<(Vec<u32>, Vec<f64>)> {
        let mut set = self.set.clone();
        let (mut order, mut errors) = (Vec::new(), vec![set.error]);
        while set.members.len() > 1 {
            let (gone, rest) = self.spared(&set, keep_going)?;
            order.push(set.members[gone]);
            set = self.refined(rest);
            set = self.regrouped(set);
            errors.push(set.error);
        }
        order.extend(set.members);
        order.reverse();
        errors.reverse();
        Some((order, errors))
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

    fn field(&mut self, one: u32, zeros: &[u32], before: Option<&Field>) -> Field {
        self.coarse.energy.field(one, zeros, before, &mut self.scratch)
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
    fn with(&self, base: &Set, vertex: u32, probe: &Field) -> Set {
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
    fn refined(&mut self, mut set: Set) -> Set {
        for k in 0..set.members.len() {
            if set.rough[k] {
                set.fields[k] = self.field(set.members[k], &without(&set.members, k), Some(&set.fields[k]));
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
        let rig = Rig {
            reference: &surface.reference,
            edges: &surface.laplacian.edges,
            stiffness: &surface.laplacian.cotangents,
            mass: &surface.counts,
            handles: &set.members,
            weights: &rows,
            groups: &set.groups,
            ball: (DVec3::ZERO, 1.0),
        };
        let fitter = Fitter::new(&rig, &self.fit);
        let sum: f64 = self.coarse.placed.iter().map(|placed| fitter.fit_error(placed)).sum();
        sum / surface.poses.len().max(1) as f64
    }

    /// The best of `others`, vertices with estimates of their fields, that passes all sieves, and all that were fitted.
    /// Estimates above `limit` do not pass.
    fn sieve(
        &mut self,
        base: &Set,
        others: &[(u32, &Field)],
        pass: [usize; 2],
        limit: f64,
        keep_going: KeepGoing,
    ) -> Option<(Option<Set>, Vec<Tried>)> {
        let leftover = Leftover::new(self.coarse, &base.members, &self.weights(base), self.fit.hold);
        let free = others.iter().filter(|(v, _)| !base.members.contains(v) && !self.set.members.contains(v));
        let mut gains: Vec<(f64, u32, &Field)> = free.map(|&(v, field)| (leftover.gain(v, field), v, field)).collect();
        gains.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut estimates = Vec::new();
        for &(_, vertex, field) in gains.iter().take(pass[0]) {
            if !keep_going() {
                return None;
            }
            let mut set = self.with(base, vertex, field);
            set.error = self.error(&set);
            estimates.push((vertex, set));
        }
        estimates.sort_by(|a, b| a.1.error.total_cmp(&b.1.error).then(a.0.cmp(&b.0)));
        let mut tried: Vec<Tried> = estimates.iter().map(|(c, set)| self.tried(*c, set.error)).collect();
        let mut best: Option<Set> = None;
        for ((c, set), tried) in estimates.into_iter().zip(&mut tried).take(pass[1]) {
            if set.error > limit {
                break;
            }
            if !keep_going() {
                return None;
            }
            let set = self.refined(set);
            *tried = self.tried(c, set.error);
            if best.as_ref().is_none_or(|b| set.error < b.error) {
                best = Some(set);
            }
        }
        Some((best, tried))
    }

    fn tried(&self, vertex: u32, error: f64) -> Tried {
        Tried { vertex: self.coarse.surface.origin[vertex as usize], error }
    }
}

/// All but one.
fn without(points: &[u32], place: usize) -> Vec<u32> {
    let mut others = points.to_vec();
    others.remove(place);
    others
}
