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
use super::result::Tried;
use crate::skinning::factor::Factor;
use crate::skinning::{FitParameters, Fitter, Rig, Rows, clusters};
use glam::DVec3;

/// How many candidates pass the first and the second sieve when a point is added.
const ADDING: [usize; 2] = [40, 5];

/// The same when one is replaced.
const REPLACING: [usize; 2] = [25, 3];

/// A replacement must gain more than this share of the error…
const WORTH: f64 = 1e-4;

/// …and than this: below it, errors are rounding…
const ROUNDING: f64 = 1e-12;

/// …and is not looked at closely if it seems worse by more than this share.
const HOPELESS: f64 = 0.01;

/// A field that is below this at a vertex hardly feels what happens there.
const FELT: f64 = 1e-3;

/// Asked now and then: whether to go on.
pub type KeepGoing<'a> = &'a mut dyn FnMut() -> bool;

/// A set of key points on the coarse mesh.
#[derive(Clone, Default)]
pub struct Set {
    /// Indices of candidates, in the order chosen.
    pub members: Vec<usize>,
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
        let fit = FitParameters { rounds: 6, tolerance: 1e-3, ..fit };
        let mut search = Self { coarse, fit, scratch: Scratch::default(), set: Set::default(), probes: Vec::new() };
        if !coarse.candidates.is_empty() {
            let field = search.field(0, &[], None);
            let groups = vec![0; coarse.energy.len()];
            let set = Set { members: vec![0], fields: vec![field], rough: vec![false], groups, error: 0.0 };
            search.set = search.regrouped(set);
            search.probes = (0..coarse.candidates.len()).map(|c| search.field(c, &[0], None)).collect();
        }
        search
    }

    /// Adds the best candidate; what was tried, or `None` if there is no other candidate, or no wish to go on.
    pub fn add(&mut self, keep_going: KeepGoing) -> Option<Vec<Tried>> {
        let base = self.set.clone();
        let probes = self.probes.clone();
        let (best, tried) = self.sieve(&base, &probes, ADDING, f64::INFINITY, keep_going)?;
        self.accept(best.map(|best| self.regrouped(best))?, probes);
        Some(tried)
    }

    /// Tries to replace the point at `place`; whether a better one was found, or `None` on no wish to go on.
    pub fn replace(&mut self, place: usize, keep_going: KeepGoing) -> Option<bool> {
        let gone = self.set.members[place];
        let vertex = self.coarse.candidates[gone];
        let bump = self.set.fields[place].clone();
        let base = self.without(&self.set, place);
        let mut probes = self.probes.clone();
        for (c, probe) in probes.iter_mut().enumerate() {
            if c != gone && !base.members.contains(&c) {
                let bump = bump.lowered(self.coarse.candidates[c], probe);
                *probe = probe.plus(self.coarse.energy.share(probe, vertex, &bump), &bump);
            }
        }
        probes[gone] = bump;
        let limit = self.set.error * (1.0 + HOPELESS);
        let (best, _) = self.sieve(&base, &probes, REPLACING, limit, keep_going)?;
        // New groups change the error a little: only what is better with them is an improvement.
        match best.map(|best| self.regrouped(best)) {
            Some(mut best) if best.error < self.set.error * (1.0 - WORTH) - ROUNDING => {
                // The new point takes the place of the old one.
                best.members[place..].rotate_right(1);
                best.fields[place..].rotate_right(1);
                best.rough[place..].rotate_right(1);
                self.accept(best, probes);
                Some(true)
            }
            _ => Some(false),
        }
    }

    /// The points in the order in which they count, and the error with the first 1, 2, … of them: time and again the one
    /// is taken away that can be spared best, and what is left first comes first.
    pub fn order(&mut self, keep_going: KeepGoing) -> Option<(Vec<usize>, Vec<f64>)> {
        let mut set = self.set.clone();
        let (mut order, mut errors) = (Vec::new(), vec![set.error]);
        while set.members.len() > 1 {
            let mut best: Option<(usize, Set)> = None;
            for place in 0..set.members.len() {
                if !keep_going() {
                    return None;
                }
                let mut rest = self.without(&set, place);
                rest.error = self.error(&rest);
                if best.as_ref().is_none_or(|(_, b)| rest.error < b.error) {
                    best = Some((place, rest));
                }
            }
            let (gone, rest) = best?;
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
            let vertex = self.coarse.candidates[*added];
            for (c, probe) in probes.iter_mut().enumerate() {
                let reach = probe.value[vertex as usize];
                if c != *added && reach > NOTHING {
                    // 1 at the candidate and 0 at the new point, both being 0 at all others.
                    let own = self.coarse.candidates[c];
                    let whole = 1.0 - reach * field.value[own as usize];
                    *probe = probe.plus(-reach, field).times(1.0 / whole.max(NOTHING), own);
                }
            }
        }
        self.set = set;
        self.probes = probes;
    }

    /// The set with its own groups (§3.3), and its error with them.
    fn regrouped(&self, mut set: Set) -> Set {
        let handles = self.handles(&set.members);
        set.groups = clusters(&self.weights(&set), &self.coarse.features, &handles, &self.coarse.surface.counts);
        set.error = self.error(&set);
        set
    }

    fn handles(&self, members: &[usize]) -> Vec<u32> {
        members.iter().map(|&m| self.coarse.candidates[m]).collect()
    }

    fn field(&mut self, one: usize, zeros: &[usize], before: Option<&Field>) -> Field {
        let zeros = self.handles(zeros);
        self.coarse.energy.field(self.coarse.candidates[one], &zeros, before, &mut self.scratch)
    }

    /// The set without one of its points: the fields that it held down rise.
    fn without(&self, set: &Set, place: usize) -> Set {
        let mut rest = set.clone();
        let vertex = self.coarse.candidates[rest.members.remove(place)];
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
    fn with(&self, base: &Set, added: usize, probe: &Field) -> Set {
        let vertex = self.coarse.candidates[added];
        let mut set = base.clone();
        for (field, rough) in set.fields.iter_mut().zip(&mut set.rough) {
            if field.value[vertex as usize] > NOTHING {
                *rough |= field.value[vertex as usize] > FELT;
                *field = field.lowered(vertex, probe);
            }
        }
        set.members.push(added);
        set.fields.push(probe.clone());
        set.rough.push(true);
        set
    }

    /// The set with true fields where it has estimates, and its error.
    fn refined(&mut self, mut set: Set) -> Set {
        for k in 0..set.members.len() {
            if set.rough[k] {
                let mut others = set.members.clone();
                let own = others.remove(k);
                set.fields[k] = self.field(own, &others, Some(&set.fields[k]));
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

    /// The best of the candidates that pass all sieves, and all that were fitted. Estimates above `limit` do not pass.
    fn sieve(
        &mut self,
        base: &Set,
        probes: &[Field],
        pass: [usize; 2],
        limit: f64,
        keep_going: KeepGoing,
    ) -> Option<(Option<Set>, Vec<Tried>)> {
        let handles = self.handles(&base.members);
        let leftover = Leftover::new(self.coarse, &handles, &self.weights(base), self.fit.hold);
        let free = (0..probes.len()).filter(|c| !base.members.contains(c) && !self.set.members.contains(c));
        let mut gains: Vec<(f64, usize)> =
            free.map(|c| (leftover.gain(self.coarse.candidates[c], &probes[c]), c)).collect();
        gains.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut estimates = Vec::new();
        for &(_, c) in gains.iter().take(pass[0]) {
            if !keep_going() {
                return None;
            }
            let mut set = self.with(base, c, &probes[c]);
            set.error = self.error(&set);
            estimates.push((c, set));
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

    fn tried(&self, candidate: usize, error: f64) -> Tried {
        Tried { vertex: self.coarse.surface.origin[self.coarse.candidates[candidate] as usize], error }
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

fn entries<'a>(rows: &'a Rows, v: usize, p: DVec3, at: &'a [DVec3]) -> impl Iterator<Item = (usize, [f64; 4])> + 'a {
    rows.entries(v).map(move |(k, w)| {
        let local = p - at[k as usize];
        (k as usize, [w * local.x, w * local.y, w * local.z, w])
    })
}
