//! Points that find their places on another surface together.
//!
//! Each point is drawn to where its distances along the surface to the places of the other points are what they are on
//! its own surface, to where the best similarity of the points around it would put it, and to where the surface faces
//! the same way. All points move, and again; what lies near counts more with every round.
//!
//! Distances to what is near are right even where proportions differ, and a similarity of what is near follows a limb
//! that is held another way.

use super::sampled::SampledSurface;
use super::similarity::Similarity;
use glam::DVec3;

/// Points that each point listens to, at most.
const VOTERS: usize = 48;

/// How far the scale around a point may differ from the scale of all.
const LOCAL_SCALE: [f64; 2] = [0.7, 1.4];

/// Squared distance from the foretold place beyond which it no longer matters how far: limbs are held in many ways, and
/// what is foretold for one from the trunk says nothing.
const FAR: f64 = 0.02;

/// What a squared difference of the mean distances from everything costs: tips go to tips.
const REMOTE: f64 = 0.3;

/// A point of the source surface.
#[derive(Clone, Debug)]
pub struct Point {
    /// Where it is.
    pub place: DVec3,
    /// Where the surface faces there.
    pub normal: DVec3,
    /// Its mean distance from the first samples.
    pub remote: f32,
    /// How much others listen to it.
    pub weight: f64,
    /// The place it has on the target, if that is given or, for a tip, found.
    pub given: Option<TargetPlace>,
}

/// A place on the target surface.
#[derive(Clone, Debug)]
pub struct TargetPlace {
    /// Where it is.
    pub place: DVec3,
    /// Its distances from all samples of the target.
    pub distances: Vec<f32>,
    /// The sample nearest to it.
    pub sample: u32,
}

/// What is weighed against what.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    /// How far points listen (a share of the diagonal): what is farther counts less by the third power.
    pub reach: f64,
    /// What a squared distance from where the points around would put it costs.
    pub place: f64,
    /// What it costs to face away, half of it to face sideways.
    pub facing: f64,
}

/// The rules of the last round, and by which outcomes are compared.
pub const LAST: Rules = Rules { reach: 0.1, place: 0.75, facing: 0.04 };

/// The points, where they are now, and what they think of it.
pub struct Consensus<'a> {
    target: &'a SampledSurface,
    /// Only the first so many samples of the target are considered.
    considered: usize,
    points: &'a [Point],
    /// #points × #points distances on the source, row by row.
    distances: &'a [f32],
    /// #points samples of the target; `None` for a point that has no place yet.
    pub at: Vec<Option<u32>>,
    /// #points: what its place costs each point.
    pub costs: Vec<f64>,
    /// #points: how much the others listen to it, for what it thinks of its own place.
    trust: Vec<f64>,
}

/// What the other points foretell for one.
pub struct Prediction {
    /// (point, weight), the weights adding up to one.
    pub votes: Vec<(u32, f64)>,
    /// How much longer distances are on the target.
    pub scale: f64,
    /// Where the others would put it.
    pub place: DVec3,
    /// Where it would face.
    pub normal: DVec3,
}

impl<'a> Consensus<'a> {
    /// Starts with places (#points); given ones are put in.
    pub fn new(
        target: &'a SampledSurface,
        considered: usize,
        points: &'a [Point],
        distances: &'a [f32],
        at: Vec<Option<u32>>,
    ) -> Self {
        let considered = considered.min(target.len());
        let at: Vec<_> = points.iter().zip(at).map(|(p, at)| p.given.as_ref().map(|g| g.sample).or(at)).collect();
        Self {
            target,
            considered,
            points,
            distances,
            at,
            costs: vec![0.0; points.len()],
            trust: vec![1.0; points.len()],
        }
    }

    /// One round: every point looks for a better place.
    pub fn round(&mut self, rules: &Rules) {
        let mut field = Vec::new();
        let mut next = Vec::with_capacity(self.points.len());
        for i in 0..self.points.len() {
            let Some(prediction) = self.prediction(i, rules) else {
                next.push((self.at[i], 1.0));
                continue;
            };
            self.field(i, &prediction, rules, &mut field);
            let best = match &self.points[i].given {
                Some(given) => field.get(given.sample as usize).map(|&cost| (given.sample, cost)),
                None => lowest(&field),
            };
            next.push(best.map_or((self.at[i], 1.0), |(place, cost)| (Some(place), f64::from(cost))));
        }
        for (i, (at, cost)) in next.into_iter().enumerate() {
            self.at[i] = at;
            self.costs[i] = cost;
        }
        self.trust();
    }

    /// Points whose places cost much more than usual are trusted less.
    fn trust(&mut self) {
        let mut sorted = self.costs.clone();
        sorted.sort_by(f64::total_cmp);
        let usual = 3.0 * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0) + 1e-9;
        for ((trust, &cost), point) in self.trust.iter_mut().zip(&self.costs).zip(self.points) {
            let doubt = cost / usual;
            *trust = if point.given.is_some() { 1.0 } else { 1.0 / (1.0 + doubt * doubt) };
        }
    }

    /// Where a point is on the target.
    pub fn place(&self, i: usize) -> Option<DVec3> {
        match &self.points[i].given {
            Some(given) => Some(given.place),
            None => self.at[i].map(|s| self.target.places[s as usize]),
        }
    }

    /// Distances of the target's samples from where a point is.
    pub fn column(&self, i: usize) -> Option<&[f32]> {
        match &self.points[i].given {
            Some(given) => Some(&given.distances),
            None => self.at[i].map(|s| self.target.row(s)),
        }
    }

    /// The places of the target's samples.
    pub fn target_places(&self) -> &[DVec3] {
        &self.target.places
    }

    /// The points that are trusted and have a place; the given ones first.
    pub fn trusted(&self) -> impl Iterator<Item = usize> + '_ {
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        order.sort_by_key(|&i| self.points[i].given.is_none());
        order.into_iter().filter(|&i| self.trust[i] > 0.5 && self.at[i].is_some())
    }

    /// Up to `most` of them, as places of the source and of the target.
    pub fn guides(&self, most: usize) -> Vec<(DVec3, DVec3)> {
        self.trusted().filter_map(|i| Some((self.points[i].place, self.place(i)?))).take(most).collect()
    }

    /// The places of the given points, and the target's samples at them.
    pub fn given(&self) -> impl Iterator<Item = (DVec3, u32)> + '_ {
        self.points.iter().filter_map(|point| Some((point.place, point.given.as_ref()?.sample)))
    }

    /// What the others foretell for a point; `None` if no other point has a place.
    pub fn prediction(&self, i: usize, rules: &Rules) -> Option<Prediction> {
        let n = self.points.len();
        let row = &self.distances[i * n..(i + 1) * n];
        let weight = |j: usize| {
            let far = f64::from(row[j]);
            let point = &self.points[j];
            point.weight * self.trust[j] / fall(far, rules.reach)
        };
        let others = (0..n).filter(|&j| j != i && self.at[j].is_some());
        let mut votes: Vec<(u32, f64)> = others.map(|j| (j as u32, weight(j))).collect();
        if votes.len() > VOTERS {
            votes.select_nth_unstable_by(VOTERS, |a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            votes.truncate(VOTERS);
            votes.sort_unstable_by_key(|v| v.0);
        }
        let total: f64 = votes.iter().map(|v| v.1).sum();
        if total <= 0.0 {
            return None;
        }
        votes.iter_mut().for_each(|v| v.1 /= total);
        // A limb that is held another way moves with what is nearest alone.
        let near = |j: u32, w: f64| w / fall(f64::from(row[j as usize]), rules.reach);
        let pairs = votes
            .iter()
            .filter_map(|&(j, w)| Some((near(j, w), self.points[j as usize].place, self.place(j as usize)?)));
        let motion = Similarity::fit(pairs);
        Some(Prediction {
            scale: self.scale(row, &votes, i),
            place: motion.apply(self.points[i].place),
            normal: motion.rotation * self.points[i].normal,
            votes,
        })
    }

    /// How much longer distances from a point are on the target.
    fn scale(&self, row: &[f32], votes: &[(u32, f64)], i: usize) -> f64 {
        let Some(own) = self.at[i] else { return 1.0 };
        let (mut squares, mut theirs) = (1e-6, 1e-6);
        for &(j, w) in votes {
            let Some(column) = self.column(j as usize) else { continue };
            let (here, there) = (f64::from(row[j as usize]), f64::from(column[own as usize]));
            squares += w * here * here;
            theirs += w * there * there;
        }
        (theirs / squares).sqrt().clamp(LOCAL_SCALE[0], LOCAL_SCALE[1])
    }

    /// What each considered sample would cost point `i`.
    fn field(&self, i: usize, prediction: &Prediction, rules: &Rules, field: &mut Vec<f32>) {
        let n = self.points.len();
        let row = &self.distances[i * n..(i + 1) * n];
        field.clear();
        field.resize(self.considered, 0.0);
        for &(j, w) in &prediction.votes {
            let Some(column) = self.column(j as usize) else { continue };
            let (w, wanted) = (w as f32, prediction.scale as f32 * row[j as usize]);
            for (cost, &there) in field.iter_mut().zip(column) {
                let off = there - wanted;
                *cost += w * off * off;
            }
        }
        for (cost, far) in field.iter_mut().zip(&self.target.remote) {
            *cost += REMOTE as f32 * (far - self.points[i].remote) * (far - self.points[i].remote);
        }
        for ((cost, place), normal) in field.iter_mut().zip(&self.target.places).zip(&self.target.normals) {
            *cost += away(prediction, *place, *normal, rules) as f32;
        }
    }

    /// What a vertex of the target would cost a point.
    pub fn price(&self, i: usize, rules: &Rules) -> Option<impl Fn(u32) -> f64 + '_> {
        let prediction = self.prediction(i, rules)?;
        let (n, rules) = (self.points.len(), *rules);
        let row = &self.distances[i * n..(i + 1) * n];
        let columns: Vec<(f64, f64, &[f32])> = prediction
            .votes
            .iter()
            .filter_map(|&(j, w)| Some((w, prediction.scale * f64::from(row[j as usize]), self.column(j as usize)?)))
            .collect();
        Some(move |v: u32| {
            let target = self.target;
            let reading = target.readings[v as usize];
            let far = |column: &[f32]| -> f64 { reading.iter().map(|&(s, w)| f64::from(w * column[s as usize])).sum() };
            let distances: f64 = columns.iter().map(|(w, wanted, column)| w * (far(column) - wanted).powi(2)).sum();
            let r: f64 = reading.iter().map(|&(s, w)| f64::from(w * target.remote[s as usize])).sum();
            distances
                + REMOTE * (r - f64::from(self.points[i].remote)).powi(2)
                + away(&prediction, target.points[v as usize], target.vertex_normals[v as usize], &rules)
        })
    }

    /// The target's own vertex near a point's sample that costs least, and the cost.
    pub fn vertex(&self, i: usize, rules: &Rules) -> Option<(u32, f64)> {
        let own = self.at[i]?;
        let target = self.target;
        let fallback = Some((target.samples[own as usize], self.costs[i]));
        let Some(cost) = self.price(i, rules) else { return fallback };
        let best = target.around(own).map(|v| (v, cost(v))).min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        best.filter(|b| b.1.is_finite()).or(fallback)
    }

    /// How bad the outcome is: what it costs the points (no point more than a wrong one would), and how far parts of the
    /// target are from any of them.
    pub fn badness(&mut self) -> f64 {
        const WRONG: f64 = 0.03;
        self.round(&Rules { reach: 0.2, ..LAST });
        let own = self.costs.iter().map(|c| c.min(WRONG)).sum::<f64>() / self.points.len().max(1) as f64;
        let mut bare = vec![f32::INFINITY; self.considered];
        for column in (0..self.points.len()).filter_map(|i| self.column(i)) {
            bare.iter_mut().zip(column).for_each(|(b, &d)| *b = b.min(d));
        }
        let bare = bare.iter().map(|&b| f64::from(b * b).min(2.0 * WRONG)).sum::<f64>() / self.considered.max(1) as f64;
        own + bare
    }
}

/// How much less is listened to what is far: about alike within reach, and then by the third power of the distance.
fn fall(far: f64, reach: f64) -> f64 {
    let square = far * far + reach * reach;
    square * square.sqrt()
}

/// What it costs to be away from where the others would put a point, and to face another way.
fn away(prediction: &Prediction, place: DVec3, normal: DVec3, rules: &Rules) -> f64 {
    rules.place * place.distance_squared(prediction.place).min(FAR)
        + 0.5 * rules.facing * (1.0 - prediction.normal.dot(normal))
}

/// The lowest finite value and where it is; of equals, the first.
fn lowest(field: &[f32]) -> Option<(u32, f32)> {
    let finite = (0..).zip(field.iter().copied()).filter(|(_, cost)| cost.is_finite());
    finite.reduce(|best, next| if next.1 < best.1 { next } else { best })
}
