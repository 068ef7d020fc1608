//! Colour: sRGB, linear light, OKLab/OKLCH, and how colour-blind eyes see it.
//!
//! OKLab is from B. Ottosson, *A perceptual color space for image processing*, 2020. The simulation of colour
//! blindness is from G. Machado, M. Oliveira, L. Fernandes, *A physiologically-based model for simulation of
//! color vision deficiency*, IEEE TVCG 15(6), 2009, table 1 at severity 1.0.

use glam::{Mat3, Vec3};

/// A colour as a screen takes it: three sRGB bytes.
pub type Srgb = [u8; 3];

/// Which eyes look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vision {
    /// All three kinds of cones.
    Normal,
    /// Without cones for long wavelengths.
    Protanopia,
    /// Without cones for medium wavelengths.
    Deuteranopia,
}

/// One sRGB component (0 to 1) as linear light (0 to 1).
pub fn to_linear(c: f32) -> f32 {
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// Linear light (0 to 1) as an sRGB component (0 to 1).
pub fn from_linear(c: f32) -> f32 {
    if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// An sRGB colour as linear light.
pub fn srgb_to_linear(c: Srgb) -> Vec3 {
    Vec3::from_array(c.map(|b| to_linear(f32::from(b) / 255.0)))
}

/// Linear light as the nearest sRGB colour; what no screen can show is clamped.
pub fn linear_to_srgb(c: Vec3) -> Srgb {
    c.to_array().map(|x| (from_linear(x.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8)
}

/// Linear light as OKLab: lightness (0 to 1), green–red, blue–yellow.
pub fn linear_to_oklab(c: Vec3) -> Vec3 {
    let lms = Vec3::new(
        0.412_221_46 * c.x + 0.536_332_55 * c.y + 0.051_445_995 * c.z,
        0.211_903_5 * c.x + 0.680_699_5 * c.y + 0.107_396_96 * c.z,
        0.088_302_46 * c.x + 0.281_718_85 * c.y + 0.629_978_7 * c.z,
    );
    let [l, m, s] = lms.to_array().map(f32::cbrt);
    Vec3::new(
        0.210_454_26 * l + 0.793_617_8 * m - 0.004_072_047 * s,
        1.977_998_5 * l - 2.428_592_2 * m + 0.450_593_7 * s,
        0.025_904_037 * l + 0.782_771_77 * m - 0.808_675_77 * s,
    )
}

/// OKLab as linear light; components outside 0 to 1 are colours that a screen cannot show.
pub fn oklab_to_linear(c: Vec3) -> Vec3 {
    let l = (c.x + 0.396_337_78 * c.y + 0.215_803_76 * c.z).powi(3);
    let m = (c.x - 0.105_561_346 * c.y - 0.063_854_17 * c.z).powi(3);
    let s = (c.x - 0.089_484_18 * c.y - 1.291_485_5 * c.z).powi(3);
    Vec3::new(
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_4 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    )
}

/// The sRGB colour of an OKLCH lightness (0 to 1), chroma (0 to about 0.3) and hue (degrees). Where a screen cannot
/// show that much chroma, the chroma is lowered and lightness and hue are kept.
pub fn oklch(lightness: f32, chroma: f32, hue: f32) -> Srgb {
    let (sin, cos) = hue.to_radians().sin_cos();
    let at = |c: f32| oklab_to_linear(Vec3::new(lightness, c * cos, c * sin));
    let shows = |c: f32| at(c).to_array().iter().all(|x| (-1e-4..=1.000_1).contains(x));
    let mut c = chroma;
    while c > 0.0 && !shows(c) {
        c -= 0.002;
    }
    linear_to_srgb(at(c.max(0.0)))
}

/// What linear light looks like to `vision`, as linear light again.
pub fn seen_by(vision: Vision, c: Vec3) -> Vec3 {
    let rows = match vision {
        Vision::Normal => return c,
        Vision::Protanopia => {
            [[0.152_286, 1.052_583, -0.204_868], [0.114_503, 0.786_281, 0.099_216], [-0.003_882, -0.048_116, 1.051_998]]
        }
        Vision::Deuteranopia => {
            [[0.367_322, 0.860_646, -0.227_968], [0.280_085, 0.672_501, 0.047_413], [-0.011_820, 0.042_940, 0.968_881]]
        }
    };
    (Mat3::from_cols_array_2d(&rows).transpose() * c).clamp(Vec3::ZERO, Vec3::ONE)
}

/// OKLab distance between two colours as the eyes see them that tell them apart worst.
pub fn least_distance(a: Srgb, b: Srgb) -> f32 {
    let (a, b) = (srgb_to_linear(a), srgb_to_linear(b));
    [Vision::Normal, Vision::Protanopia, Vision::Deuteranopia]
        .into_iter()
        .map(|v| linear_to_oklab(seen_by(v, a)).distance(linear_to_oklab(seen_by(v, b))))
        .fold(f32::INFINITY, f32::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn oklab_of_known_colours() {
        // The values that Ottosson gives for white and red.
        assert!(linear_to_oklab(Vec3::ONE).distance(Vec3::new(1.0, 0.0, 0.0)) < 1e-4);
        let red = linear_to_oklab(Vec3::X);
        assert!(red.distance(Vec3::new(0.627_96, 0.224_86, 0.125_85)) < 1e-4, "{red}");
    }

    #[test]
    fn there_and_back() {
        for c in [[0, 0, 0], [255, 255, 255], [12, 200, 99], [255, 0, 128]] {
            assert_eq!(linear_to_srgb(oklab_to_linear(linear_to_oklab(srgb_to_linear(c)))), c);
        }
    }

    #[test]
    fn lowered_chroma_keeps_lightness() {
        let lab = linear_to_oklab(srgb_to_linear(oklch(0.7, 0.4, 200.0)));
        assert!((lab.x - 0.7).abs() < 0.01, "{lab}");
    }

    #[test]
    fn red_and_green_meet_in_deuteranopia_only() {
        let (red, green) = (srgb_to_linear([200, 80, 60]), srgb_to_linear([110, 130, 50]));
        let distance = |v| linear_to_oklab(seen_by(v, red)).distance(linear_to_oklab(seen_by(v, green)));
        assert!(distance(Vision::Deuteranopia) < 0.4 * distance(Vision::Normal));
        assert!(seen_by(Vision::Protanopia, Vec3::ONE).distance(Vec3::ONE) < 1e-4, "white stays white");
    }
}
