//! Maps from numbers to colours, for fields drawn on the surface.
//!
//! Viridis (N. Smith, S. van der Walt, 2015) and cividis (J. Nuñez, C. Anderton, R. Renslow, PLOS ONE 13(7), 2018)
//! are in the public domain; the knots here are least-squares fits to them. The diverging map is made in OKLCH:
//! blue and vermilion of equal lightness at equal distance from a light neutral middle.

use super::colour::{Srgb, oklch};

/// A colour map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourMap {
    /// Dark blue over green to yellow, for values that begin at zero.
    Viridis,
    /// Dark blue over grey to yellow: the same to almost every eye.
    Cividis,
    /// Blue over neutral to vermilion, for values where the middle matters.
    Diverging,
}

/// Colours (0xRRGGBB) at 33 equal steps; between them the maps are straight.
const VIRIDIS: [u32; 33] = [
    0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453681, 0x424086, 0x3f4989, 0x3b528b, 0x375a8d, 0x33638d,
    0x2f6a8e, 0x2c728e, 0x297a8e, 0x26818e, 0x23898e, 0x21908d, 0x1f988b, 0x1e9f88, 0x21a685, 0x27ae80, 0x31b57b,
    0x3dbc74, 0x4cc26c, 0x5cc963, 0x6ece58, 0x81d44c, 0x96d840, 0xabdc32, 0xc0df24, 0xd5e219, 0xeae519, 0xfde724,
];
const CIVIDIS: [u32; 33] = [
    0x00234e, 0x00285b, 0x002e6b, 0x043372, 0x1c386f, 0x273e6e, 0x32436d, 0x3b496c, 0x434e6c, 0x4b546c, 0x52596d,
    0x5a5f6e, 0x61646f, 0x686a71, 0x6f7073, 0x757676, 0x7c7b78, 0x848179, 0x8b8778, 0x938d78, 0x9b9376, 0xa39a75,
    0xaba072, 0xb3a670, 0xbbad6d, 0xc3b469, 0xccba64, 0xd4c15f, 0xddc958, 0xe6d051, 0xefd748, 0xf9df3b, 0xffe734,
];

impl ColourMap {
    /// The map called `name`: `viridis`, `cividis` or `diverging`.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "viridis" => Some(Self::Viridis),
            "cividis" => Some(Self::Cividis),
            "diverging" => Some(Self::Diverging),
            _ => None,
        }
    }

    /// The map as 256 colours.
    pub fn table(self) -> Vec<Srgb> {
        (0..256).map(|i| self.at(i as f32 / 255.0)).collect()
    }

    /// The colour at `t`, clamped to 0…1; the colour at 0 for NaN.
    pub fn at(self, t: f32) -> Srgb {
        let t = if t > 0.0 { t.min(1.0) } else { 0.0 };
        match self {
            Self::Viridis => between(&VIRIDIS, t),
            Self::Cividis => between(&CIVIDIS, t),
            Self::Diverging => {
                let away = 2.0 * t - 1.0;
                let strength = away.abs().powf(0.8);
                oklch(0.94 - 0.38 * strength, 0.005 + 0.145 * strength, if away < 0.0 { 252.0 } else { 38.0 })
            }
        }
    }
}

/// The colour at `t` (0 to 1) on the straight lines between `knots`.
fn between(knots: &[u32; 33], t: f32) -> Srgb {
    let x = t * 32.0;
    let (low, f) = ((x as usize).min(31), x - (x as usize).min(31) as f32);
    let mix = |shift: u32| {
        let byte = |k: u32| (k >> shift & 255) as f32;
        (byte(knots[low]) * (1.0 - f) + byte(knots[low + 1]) * f + 0.5) as u8
    };
    [mix(16), mix(8), mix(0)]
}

#[cfg(test)]
mod tests {
    use super::super::colour::{linear_to_oklab, srgb_to_linear};
    use super::*;

    fn near(a: Srgb, b: Srgb) {
        assert!(a.iter().zip(b).all(|(x, y)| x.abs_diff(y) <= 4), "{a:?} is not {b:?}");
    }

    #[test]
    fn published_colours() {
        near(ColourMap::Viridis.at(0.0), [68, 1, 84]);
        near(ColourMap::Viridis.at(0.5), [33, 145, 140]);
        near(ColourMap::Viridis.at(1.0), [253, 231, 37]);
        near(ColourMap::Cividis.at(0.0), [0, 34, 78]);
        near(ColourMap::Cividis.at(1.0), [254, 232, 56]);
    }

    #[test]
    fn one_sided_maps_grow_lighter() {
        for map in [ColourMap::Viridis, ColourMap::Cividis] {
            let light: Vec<f32> = map.table().iter().map(|&c| linear_to_oklab(srgb_to_linear(c)).x).collect();
            assert!(light.windows(2).all(|w| w[1] > w[0] - 0.006), "{map:?}");
            assert!(light[255] - light[0] > 0.6);
        }
    }

    #[test]
    fn diverging_is_balanced() {
        let light = |t| linear_to_oklab(srgb_to_linear(ColourMap::Diverging.at(t))).x;
        for i in 0..=50 {
            let t = i as f32 / 100.0;
            assert!((light(t) - light(1.0 - t)).abs() < 0.01);
        }
        assert!(light(0.5) > light(0.0) + 0.35);
    }

    #[test]
    fn odd_numbers_have_colours() {
        let map = ColourMap::Viridis;
        assert_eq!(map.at(f32::NAN), map.at(0.0));
        assert_eq!(map.at(f32::INFINITY), map.at(1.0));
        assert_eq!(ColourMap::named("jet"), None);
    }
}
