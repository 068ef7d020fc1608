//! The search for key points on the coarse mesh (§3.5): add the best one, then replace them in turn.
//!
//! Algorithm 1 solves, for every candidate at every step, the weights of all handles and the fit of all poses. Here:
//!
//! * a field changes only where a point is added that it reaches, or taken away that it is held by: all others stay,
//!   exactly ([`super::field`]);
//! * candidates are ranked by how much squared distance the four functions `w_c [p − c, 1]` take from what the points so
//!   far leave over. Were weights not bounded, adding a handle would add just these to the space of Eq. 2, for
//!   `w_k′ = w_k − w_k(c) w_c′`;
//! * the first few of that ranking are tried in full: weights, alternation, error.

use super::coarse::Coarse;
use super::field::{Field, NOTHING, Scratch};
use super::result::Tried;
use crate::skinning::factor::Factor;
use crate::skinning::{FitParameters, Fitter, Rig, Rows, clusters};
use glam::DVec3;

/// How many candidates are tried in full when a point is added, and when one is replaced.
const SHORT_LIST: [usize; 2] = [10, 6];

/// A replacement must gain more than this share of the error.
const WORTH: f64 = 1e-4;

/// Asked now and then: whether to go on.
pub type KeepGoing<'a> = &'a mut dyn FnMut() -> bool;

/// A set of key points on the coarse mesh.
#[derive(Clone, Default)]
pub struct Set {
    /// Indices of candidates, in the order chosen.
    pub members: Vec<usize>,
    fields: Vec<Field>,
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
    /// For each candidate, its field if it were added; `None` where not known.
    probes: Vec<Option<Field>>,
    /// Whether a probe is only a start for solving.
    stale: Vec<bool>,
}

impl<'a> Search<'a> {
    /// Starts from the first candidate (§3.5), which matters little, as it will be replaced.
    pub fn new(coarse: &'a Coarse, fit: FitParameters) -> Self {
        let count = coarse.candidates.len();
        let fit = FitParameters { rounds: 6, tolerance: 1e-3, ..fit };
        let (probes, stale) = (vec![None; count], vec![true; count]);
        let mut search = Self { coarse, fit, scratch: Scratch::default(), set: Set::default(), probes, stale };
        if count > 0 {
            let field = search.field(0, &[], None);
            search.set = search.complete(vec![0], vec![field], &[]);
            search.regroup();
        }
        search
    }

    /// Adds the best candidate; what was tried, or `None` if there is no other candidate, or no wish to go on.
    pub fn add(&mut self, keep_going: KeepGoing) -> Option<Vec<Tried>> {
        let members = self.set.members.clone();
        for c in 0..self.probes.len() {
            if !members.contains(&c) && self.stale[c] {
                if !keep_going() {
                    return None;
                }
                let before = self.probes[c].take();
                self.probes[c] = Some(self.field(c, &members, before.as_ref()));
                self.stale[c] = false;
            }
        }
        let base = self.set.clone();
        let probes = std::mem::take(&mut self.probes);
        let ranked = self.ranked(&base, &probes);
        let tried = self.try_first(&base, &ranked, &probes, SHORT_LIST[0], keep_going);
        self.probes = probes;
        let (best, tried) = tried?;
        self.accept(best?);
        Some(tried)
    }

    /// Tries to replace the point at `place`; whether a better one was found, or `None` on no wish to go on.
    pub fn replace(&mut self, place: usize, keep_going: KeepGoing) -> Option<bool> {
        let gone = self.set.members[place];
        let base = self.without(place);
        let vertex = self.coarse.candidates[gone];
        let mut probes = std::mem::take(&mut self.probes);
        let kept = probes.clone();
        for (c, probe) in probes.iter_mut().enumerate() {
            if c == gone || base.members.contains(&c) {
                *probe = None;
                continue;
            }
            let touched = probe.as_ref().is_none_or(|field| self.coarse.energy.presses(field, vertex));
            if touched || self.stale[c] {
                if !keep_going() {
                    self.probes = kept;
                    return None;
                }
                *probe = Some(self.field(c, &base.members, probe.as_ref()));
            }
        }
        let ranked = self.ranked(&base, &probes);
        let tried = self.try_first(&base, &ranked, &probes, SHORT_LIST[1], keep_going);
        let Some((best, _)) = tried else {
            self.probes = kept;
            return None;
        };
        match best {
            Some(mut best) if best.error < self.set.error * (1.0 - WORTH) => {
                self.stale.iter_mut().zip(&probes).for_each(|(stale, probe)| *stale = probe.is_none());
                self.probes = probes;
                // The new point takes the place of the old one.
                best.members[place..].rotate_right(1);
                best.fields[place..].rotate_right(1);
                self.accept(best);
                Some(true)
            }
            _ => {
                self.probes = kept;
                Some(false)
            }
        }
    }

    /// The order of taking points away that costs least each time, reversed: the last point left comes first.
    pub fn order(&mut self, keep_going: KeepGoing) -> Option<Vec<usize>> {
        let mut set = self.set.clone();
        let mut order = Vec::new();
        while set.members.len() > 1 {
            let mut best: Option<Set> = None;
            let mut gone = 0;
            for place in 0..set.members.len() {
                if !keep_going() {
                    return None;
                }
                let mut rest = self.without_from(&set, place);
                rest.error = self.error(&rest);
                if best.as_ref().is_none_or(|b| rest.error < b.error) {
                    gone = place;
                    best = Some(rest);
                }
            }
            order.push(set.members[gone]);
            set = best?;
        }
        order.extend(set.members);
        order.reverse();
        Some(order)
    }

    /// Takes a set over as the current one.
    fn accept(&mut self, set: Set) {
        for &added in set.members.iter().filter(|m| !self.set.members.contains(m)) {
            let vertex = self.coarse.candidates[added] as usize;
            for (stale, probe) in self.stale.iter_mut().zip(&self.probes) {
                *stale |= probe.as_ref().is_none_or(|field| field.value[vertex] > NOTHING);
            }
        }
        self.set = set;
        self.regroup();
    }

    /// Groups of the current set (§3.3), and its error with them.
    fn regroup(&mut self) {
        let handles = self.handles(&self.set.members);
        let weights = self.weights(&self.set);
        let surface = &self.coarse.surface;
        self.set.groups = clusters(&weights, &self.coarse.features, &handles, &surface.counts);
        self.set.error = self.error(&self.set);
    }

    fn handles(&self, members: &[usize]) -> Vec<u32> {
        members.iter().map(|&m| self.coarse.candidates[m]).collect()
    }

    fn field(&mut self, one: usize, zeros: &[usize], before: Option<&Field>) -> Field {
        let zeros = self.handles(zeros);
        self.coarse.energy.field(self.coarse.candidates[one], &zeros, before, &mut self.scratch)
    }

    fn without(&mut self, place: usize) -> Set {
        let set = self.set.clone();
        self.without_from(&set, place)
    }

    /// The set without one of its points: the fields that were held down there rise.
    fn without_from(&mut self, set: &Set, place: usize) -> Set {
        let mut rest = set.clone();
        let vertex = self.coarse.candidates[rest.members.remove(place)];
        rest.fields.remove(place);
        for k in 0..rest.members.len() {
            if self.coarse.energy.presses(&rest.fields[k], vertex) {
                let mut others = rest.members.clone();
                let own = others.remove(k);
                rest.fields[k] = self.field(own, &others, Some(&rest.fields[k]));
            }
        }
        rest
    }

    /// The set with one point more: the fields that reach there are held down.
    fn with(&mut self, base: &Set, added: usize, field: &Field) -> Set {
        let vertex = self.coarse.candidates[added] as usize;
        let mut fields = Vec::with_capacity(base.fields.len() + 1);
        let mut members = base.members.clone();
        members.push(added);
        for (k, own) in base.fields.iter().enumerate() {
            fields.push(if own.value[vertex] > NOTHING {
                let mut others = members.clone();
                let one = others.remove(k);
                self.field(one, &others, Some(own))
            } else {
                own.clone()
            });
        }
        fields.push(field.clone());
        self.complete(members, fields, &base.groups)
    }

    fn complete(&self, members: Vec<usize>, fields: Vec<Field>, groups: &[u32]) -> Set {
        let groups = if groups.is_empty() { vec![0; self.coarse.energy.len()] } else { groups.to_vec() };
        let mut set = Set { members, fields, groups, error: 0.0 };
        set.error = self.error(&set);
        set
    }

    /// #V × #H row-major: fields over their sums; pieces without a handle follow the nearest that has one.
    fn weights(&self, set: &Set) -> Vec<f64> {
        let (n, h) = (self.coarse.energy.len(), set.members.len());
        let mut has_handle = vec![false; self.coarse.surface.pieces.len()];
        for &m in &set.members {
            if let Some(has) = has_handle.get_mut(self.coarse.energy.piece(self.coarse.candidates[m]) as usize) {
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
        let handles = self.handles(&set.members);
        let rows = Rows::new(&self.weights(set), handles.len());
        let rig = Rig {
            reference: &surface.reference,
            edges: &surface.laplacian.edges,
            stiffness: &surface.laplacian.cotangents,
            mass: &surface.counts,
            handles: &handles,
            weights: &rows,
            groups: &set.groups,
            ball: (DVec3::ZERO, 1.0),
        };
        let fitter = Fitter::new(&rig, &self.fit);
        let sum: f64 = surface.poses.iter().map(|pose| fitter.fit(pose).error).sum();
        sum / surface.poses.len().max(1) as f64
    }

    /// Candidates with a probe by falling gain.
    fn ranked(&self, base: &Set, probes: &[Option<Field>]) -> Vec<usize> {
        let leftover = Leftover::new(self.coarse, &self.handles(&base.members), &self.weights(base), self.fit.hold);
        let mut gains: Vec<(f64, usize)> = probes
            .iter()
            .enumerate()
            .filter(|(c, _)| !base.members.contains(c))
            .filter_map(|(c, probe)| Some((leftover.gain(self.coarse.candidates[c], probe.as_ref()?), c)))
            .collect();
        gains.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        gains.into_iter().map(|(_, c)| c).collect()
    }

    /// The best of the first few, and all that were tried.
    fn try_first(
        &mut self,
        base: &Set,
        ranked: &[usize],
        probes: &[Option<Field>],
        count: usize,
        keep_going: KeepGoing,
    ) -> Option<(Option<Set>, Vec<Tried>)> {
        let mut best: Option<Set> = None;
        let mut tried = Vec::new();
        for &c in ranked.iter().take(count) {
            if !keep_going() {
                return None;
            }
            let Some(field) = &probes[c] else { continue };
            let set = self.with(base, c, field);
            tried.push(Tried { vertex: self.coarse.surface.origin[self.coarse.candidates[c] as usize], error: set.error });
            if best.as_ref().is_none_or(|b| set.error < b.error) {
                best = Some(set);
            }
        }
        Some((best, tried))
    }
}

/// What a set leaves of the poses when it is fitted by least squares alone.
struct Leftover<'a> {
    coarse: &'a Coarse,
    at: Vec<DVec3>,
    rows: Rows,
    factor: Factor,
    /// #V displacements left, pose by pose.
    left: Vec<Vec<DVec3>>,
    hold: f64,
}

impl<'a> Leftover<'a> {
    fn new(coarse: &'a Coarse, handles: &[u32], weights: &[f64], hold: f64) -> Self {
        let surface = &coarse.surface;
        let at: Vec<DVec3> = handles.iter().map(|&v| surface.reference[v as usize]).collect();
        let rows = Rows::new(weights, handles.len());
        let n = 4 * at.len();
        let mut a = vec![0.0; n * n];
        let mut held = vec![0.0; at.len()];
        for (v, &m) in surface.counts.iter().enumerate() {
            let row: Vec<(usize, [f64; 4])> = entries(&rows, v, surface.reference[v], &at).collect();
            for (r, (k, f)) in row.iter().enumerate() {
                held[*k] += hold * m * f[3];
                for (l, g) in &row[..=r] {
                    for (i, f) in f.iter().enumerate() {
                        (0..4).for_each(|j| a[(4 * k + i) * n + 4 * l + j] += m * f * g[j]);
                    }
                }
            }
        }
        (0..n).for_each(|i| a[i * n + i] += held[i / 4]);
        let factor = Factor::new(a, n);
        let left = coarse.displacements.iter().map(|d| {
            let mut x = vec![[0.0; 3]; n];
            for (v, (&m, d)) in surface.counts.iter().zip(d).enumerate() {
                for (k, f) in entries(&rows, v, surface.reference[v], &at) {
                    for (x, f) in x[4 * k..4 * k + 4].iter_mut().zip(f) {
                        (0..3).for_each(|c| x[c] += m * f * d[c]);
                    }
                }
            }
            factor.solve(&mut x);
            let left = |(v, d): (usize, &DVec3)| {
                let mut d = *d;
                for (k, f) in entries(&rows, v, surface.reference[v], &at) {
                    x[4 * k..4 * k + 4].iter().zip(f).for_each(|(x, f)| d -= f * DVec3::from_array(*x));
                }
                d
            };
            d.iter().enumerate().map(left).collect()
        });
        let left = left.collect();
        Self { coarse, at, rows, factor, left, hold }
    }

    /// By how much the summed squared distance falls when the functions `field [p − c, 1]` may be added.
    fn gain(&self, candidate: u32, field: &Field) -> f64 {
        let surface = &self.coarse.surface;
        let c = surface.reference[candidate as usize];
        let mut own = [[0.0; 4]; 4];
        let mut cross = vec![[0.0; 4]; 4 * self.at.len()];
        let mut pull = vec![[[0.0; 3]; 4]; self.left.len()];
        for (v, (&m, &w)) in surface.counts.iter().zip(&field.value).enumerate() {
            if w <= NOTHING || m <= 0.0 {
                continue;
            }
            let p = surface.reference[v] - c;
            let f = [w * p.x, w * p.y, w * p.z, w];
            let mf = f.map(|f| m * f);
            for (own, mf) in own.iter_mut().zip(mf) {
                (0..4).for_each(|j| own[j] += mf * f[j]);
            }
            for (k, g) in entries(&self.rows, v, surface.reference[v], &self.at) {
                for (cross, g) in cross[4 * k..4 * k + 4].iter_mut().zip(g) {
                    (0..4).for_each(|j| cross[j] += g * mf[j]);
                }
            }
            for (pull, left) in pull.iter_mut().zip(&self.left) {
                let left = left[v];
                for (pull, mf) in pull.iter_mut().zip(mf) {
                    (0..3).for_each(|i| pull[i] += mf * left[i]);
                }
            }
        }
        let mut x = cross.clone();
        self.factor.solve(&mut x);
        let held = self.hold * own[3][3].max(f64::MIN_POSITIVE);
        let mut schur = vec![0.0; 16];
        for i in 0..4 {
            for j in 0..4 {
                let known: f64 = cross.iter().zip(&x).map(|(a, b)| a[i] * b[j]).sum();
                schur[4 * i + j] = own[i][j] - known + if i == j { held } else { 0.0 };
            }
        }
        let factor = Factor::new(schur, 4);
        let gain = |pull: &[[f64; 3]; 4]| -> f64 {
            let mut x = pull.to_vec();
            factor.solve(&mut x);
            x.as_flattened().iter().zip(pull.as_flattened()).map(|(a, b)| a * b).sum()
        };
        pull.iter().map(gain).sum()
    }
}

fn entries<'a>(
    rows: &'a Rows,
    v: usize,
    p: DVec3,
    at: &'a [DVec3],
) -> impl Iterator<Item = (usize, [f64; 4])> + 'a {
    rows.entries(v).map(move |(k, w)| {
        let local = p - at[k as usize];
        (k as usize, [w * local.x, w * local.y, w * local.z, w])
    })
}
