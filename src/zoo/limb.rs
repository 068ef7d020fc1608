//! A limb: a smooth tube through stations, with a radius and a flattening at each.
//!
//! A designer thinks of a leg or a neck as a line with a thickness here and there. [`Limb::new`] draws a smooth
//! curve through the stations (a cubic Hermite spline whose tangents are those of the parabola through three
//! neighbours) and cuts it into short round-ended cones with elliptic cross-sections; their union is the limb.

use glam::DVec3;

/// Cones between two stations.
const CUTS: usize = 4;

/// From the first of these stretches on, cross-sections count as blades; from the second on, wholly.
const BLADE: [f64; 2] = [1.5, 2.0];

/// The thickness of a limb at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// The centre of the cross-section.
    pub at: DVec3,
    /// Its radius.
    pub radius: f64,
    /// Its radius along the limb's flat direction as a share of `radius` (1: round).
    pub flat: f64,
}

/// A station at `x, y, z` with a radius and a flattening.
pub const fn station(x: f64, y: f64, z: f64, radius: f64, flat: f64) -> Station {
    Station { at: DVec3::new(x, y, z), radius, flat }
}

/// A short cone of a limb: from a station-like end to the next.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    from: DVec3,
    along: DVec3,
    inverse_length2: f64,
    radius: [f64; 2],
    /// How much the flat direction is stretched to make cross-sections round, less 1, at both ends.
    stretch: [f64; 2],
    /// Arc length from the start of the limb at both ends.
    arc: [f64; 2],
    direction: DVec3,
    centre: DVec3,
    reach: f64,
    /// How far it reaches from the plane across its flat direction through the centre; infinite if it is no blade.
    thickness: f64,
}

/// Where a point lies with respect to a cone or a limb.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    /// Signed distance (first-order where the cross-section is elliptic), negative inside.
    pub distance: f64,
    /// Direction away from the surface, of length about 1.
    pub gradient: DVec3,
    /// Arc length along the limb of the nearest place on its centre line.
    pub arc: f64,
    /// Radius there, along the flat direction (the smaller one).
    pub radius: f64,
}

impl Cone {
    #[inline]
    /// Signed distance, its gradient and where on the centre line.
    pub fn near(&self, p: DVec3) -> Near {
        let from = p - self.from;
        let t = (from.dot(self.along) * self.inverse_length2).clamp(0.0, 1.0);
        let radius = self.radius[0] + t * (self.radius[1] - self.radius[0]);
        let stretch = self.stretch[0] + t * (self.stretch[1] - self.stretch[0]);
        let q = from - t * self.along;
        // Stretch the flat direction until the cross-section is round, measure there, and divide by how much the
        // stretching steepens the distance.
        let round = q + self.direction * (q.dot(self.direction) * stretch);
        let steep = round + self.direction * (round.dot(self.direction) * stretch);
        let (length, steepness) = (round.length(), steep.length());
        let arc = self.arc[0] + t * (self.arc[1] - self.arc[0]);
        let thin = if stretch > 0.0 { radius / (1.0 + stretch) } else { radius };
        if steepness < 1e-12 {
            return Near { distance: -thin, gradient: self.direction, arc, radius: thin };
        }
        let near =
            Near { distance: (length - radius) * length / steepness, gradient: steep / steepness, arc, radius: thin };
        // Far from a thin blade the first order says too little; what lies between is mixed.
        let blade = ((stretch - BLADE[0]) / (BLADE[1] - BLADE[0])).clamp(0.0, 1.0);
        if blade == 0.0 {
            return near;
        }
        let (distance, gradient) = from_blade(q, self.direction, radius, thin);
        Near {
            distance: near.distance + blade * (distance - near.distance),
            gradient: near.gradient.lerp(gradient, blade),
            ..near
        }
    }

    /// A ball that holds the cone: centre and radius.
    pub fn ball(&self) -> (DVec3, f64) {
        (self.centre, self.reach)
    }

    #[inline]
    /// Whether a point is certainly farther away than `distance`, found without a square root.
    pub fn is_beyond(&self, p: DVec3, distance: f64) -> bool {
        let limit = distance + self.reach;
        let from = p - self.centre;
        limit < 0.0
            || from.length_squared() > limit * limit
            || from.dot(self.direction).abs() > distance + self.thickness
    }
}

/// Signed distance of `q` from an ellipse of half axes `wide` and, along `direction`, `thin`, and its gradient (the
/// iteration of A. Nurnberg, *Robustly finding the distance to an ellipse*, 2017).
fn from_blade(q: DVec3, direction: DVec3, wide: f64, thin: f64) -> (f64, DVec3) {
    let up = q.dot(direction);
    let aside = q - up * direction;
    let (px, py) = (aside.length(), up.abs());
    let (mut tx, mut ty) = (std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2);
    for _ in 0..4 {
        let (ex, ey) =
            ((wide * wide - thin * thin) * tx.powi(3) / wide, (thin * thin - wide * wide) * ty.powi(3) / thin);
        let r = length(wide * tx - ex, thin * ty - ey);
        let away = length(px - ex, py - ey).max(1e-12);
        let x = (((px - ex) * r / away + ex) / wide).clamp(0.0, 1.0);
        let y = (((py - ey) * r / away + ey) / thin).clamp(0.0, 1.0);
        let norm = length(x, y).max(1e-12);
        (tx, ty) = (x / norm, y / norm);
    }
    let inside = (px / wide).powi(2) + (py / thin).powi(2) < 1.0;
    let distance = length(px - wide * tx, py - thin * ty);
    let normal = aside.normalize_or_zero() * (tx / wide) + direction * (up.signum() * ty / thin);
    (if inside { -distance } else { distance }, normal.normalize_or(direction))
}

/// Length in the plane. `hypot` guards against overflow, which is far from here, and is several times slower.
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// A smooth tube that follows a chain of bones.
#[derive(Clone, Debug)]
pub struct Limb {
    /// The bones that it follows, from its first station to its last.
    pub bones: Vec<u32>,
    /// How wide the seam is where it meets what came before it.
    pub blend: f64,
    /// The stations.
    pub stations: Vec<Station>,
    /// The direction in which cross-sections are flattened.
    pub direction: DVec3,
    /// Limbs of one pair are left and right of each other.
    pub pair: u32,
    cones: Vec<Cone>,
}

impl Limb {
    /// A limb through `stations` (at least two), flattened along `direction` (unit length).
    pub fn new(bones: Vec<u32>, blend: f64, pair: u32, direction: DVec3, stations: Vec<Station>) -> Self {
        let cones = cut(&stations, direction);
        Self { bones, blend, stations, direction, pair, cones }
    }

    /// Its image in the plane x = 0, following other bones.
    pub fn mirrored(&self, bones: Vec<u32>) -> Self {
        let flip = |p: DVec3| DVec3::new(-p.x, p.y, p.z);
        let stations = self.stations.iter().map(|s| Station { at: flip(s.at), ..*s }).collect();
        Self::new(bones, self.blend, self.pair, flip(self.direction), stations)
    }

    /// The cones, from the first station to the last.
    pub fn cones(&self) -> &[Cone] {
        &self.cones
    }

    /// Where a point lies with respect to the whole limb; `None` if it is farther away than `limit`.
    pub fn near(&self, p: DVec3, limit: f64) -> Option<Near> {
        let mut best: Option<Near> = None;
        for cone in &self.cones {
            let limit = best.map_or(limit, |best| best.distance);
            if !cone.is_beyond(p, limit) {
                best = Some(cone.near(p)).filter(|near| near.distance < limit).or(best);
            }
        }
        best
    }

    /// Arc length of the place on the centre line nearest to a point, and the radius there.
    pub fn project(&self, p: DVec3) -> (f64, f64) {
        let nearest = self.cones.iter().map(|cone| {
            let from = p - cone.from;
            let t = (from.dot(cone.along) * cone.inverse_length2).clamp(0.0, 1.0);
            let away = (from - t * cone.along).length_squared();
            let mix = |ends: [f64; 2]| ends[0] + t * (ends[1] - ends[0]);
            (away, mix(cone.arc), mix(cone.radius))
        });
        nearest.min_by(|a, b| a.0.total_cmp(&b.0)).map_or((0.0, 0.0), |(_, arc, radius)| (arc, radius))
    }
}

/// Cuts the smooth curve through the stations into cones.
fn cut(stations: &[Station], direction: DVec3) -> Vec<Cone> {
    let knots = knots(stations);
    let samples: Vec<Station> = (0..stations.len().saturating_sub(1))
        .flat_map(|span| (0..CUTS).map(move |step| (span, step as f64 / CUTS as f64)))
        .map(|(span, t)| sample(stations, &knots, span, t))
        .chain(stations.last().copied())
        .collect();
    let mut arc = 0.0;
    let mut cones = Vec::with_capacity(samples.len());
    for pair in samples.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let along = b.at - a.at;
        let length = along.length();
        if length > 1e-9 {
            let (thin, stretch) = ((a.radius * a.flat).max(b.radius * b.flat), 1.0 / a.flat.max(b.flat) - 1.0);
            let thickness = if stretch >= BLADE[1] { thin + 0.5 * along.dot(direction).abs() } else { f64::INFINITY };
            cones.push(Cone {
                from: a.at,
                along,
                inverse_length2: 1.0 / (length * length),
                radius: [a.radius, b.radius],
                stretch: [1.0 / a.flat - 1.0, 1.0 / b.flat - 1.0],
                arc: [arc, arc + length],
                direction,
                centre: a.at + 0.5 * along,
                thickness,
                reach: 0.5 * length + (a.radius * a.flat.max(1.0)).max(b.radius * b.flat.max(1.0)),
            });
            arc += length;
        }
    }
    cones
}

/// Distances along the polygon of stations.
fn knots(stations: &[Station]) -> Vec<f64> {
    let mut knots = vec![0.0];
    for pair in stations.windows(2) {
        let last = knots[knots.len() - 1];
        knots.push(last + pair[0].at.distance(pair[1].at).max(1e-6));
    }
    knots
}

/// The spline between stations `span` and `span + 1`, at `t` from 0 to 1.
fn sample(stations: &[Station], knots: &[f64], span: usize, t: f64) -> Station {
    let numbers = |s: &Station| [s.at.x, s.at.y, s.at.z, s.radius, s.flat];
    let (a, b) = (numbers(&stations[span]), numbers(&stations[span + 1]));
    let width = knots[span + 1] - knots[span];
    let slope = |i: usize, k: usize| {
        let d = |i: usize| (numbers(&stations[i + 1])[k] - numbers(&stations[i])[k]) / (knots[i + 1] - knots[i]);
        if i == 0 {
            d(0)
        } else if i + 1 == stations.len() {
            d(i - 1)
        } else {
            let (before, after) = (knots[i] - knots[i - 1], knots[i + 1] - knots[i]);
            (d(i - 1) * after + d(i) * before) / (before + after)
        }
    };
    let (t2, t3) = (t * t, t * t * t);
    let hermite = |k: usize| {
        (2.0 * t3 - 3.0 * t2 + 1.0) * a[k]
            + (t3 - 2.0 * t2 + t) * width * slope(span, k)
            + (3.0 * t2 - 2.0 * t3) * b[k]
            + (t3 - t2) * width * slope(span + 1, k)
    };
    let radius = hermite(3).max(0.5 * a[3].min(b[3]));
    let flat = hermite(4).clamp(0.1, 4.0);
    Station { at: DVec3::new(hermite(0), hermite(1), hermite(2)), radius, flat }
}
