//! Looking at a screenshot.

use std::collections::BTreeSet;

/// A picture of 8-bit RGB, rows from top to bottom.
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height` colours.
    pub pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// Reads a PNG as the browser writes it.
    pub fn from_png(bytes: &[u8]) -> Self {
        let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().expect("the browser writes a PNG");
        let mut data = vec![0; reader.output_buffer_size().expect("a screenshot fits in memory")];
        let info = reader.next_frame(&mut data).expect("the browser writes a whole PNG");
        let samples = info.color_type.samples();
        let pixels = data[..info.buffer_size()].chunks_exact(samples).map(|p| match samples {
            1 | 2 => [p[0]; 3],
            _ => [p[0], p[1], p[2]],
        });
        Self { width: info.width as usize, height: info.height as usize, pixels: pixels.collect() }
    }

    /// A rectangle of it, kept inside.
    pub fn cut(&self, left: usize, top: usize, width: usize, height: usize) -> Self {
        let (right, bottom) = ((left + width).min(self.width), (top + height).min(self.height));
        let rows = (top..bottom).map(|row| &self.pixels[row * self.width..][left.min(right)..right]);
        let pixels: Vec<_> = rows.flatten().copied().collect();
        Self { width: right.saturating_sub(left), height: bottom.saturating_sub(top), pixels }
    }

    /// How many different colours there are. A blank canvas has one.
    pub fn colours(&self) -> usize {
        self.pixels.iter().collect::<BTreeSet<_>>().len()
    }

    /// How many different hues cover at least `share` of the picture each, in twelfths of the circle, greys left
    /// out. A creature painted in parts has several.
    pub fn hues(&self, share: f64) -> usize {
        let mut counts = [0_usize; 12];
        for hue in self.pixels.iter().filter_map(hue) {
            counts[(hue * 12.0) as usize % 12] += 1;
        }
        counts.iter().filter(|&&count| count as f64 >= share * self.pixels.len() as f64).count()
    }

    /// The share of pixels (0 to 1) that differ by more than `tolerance` in some channel from another picture of the
    /// same size.
    pub fn difference(&self, other: &Self, tolerance: u8) -> f64 {
        assert_eq!((self.width, self.height), (other.width, other.height), "pictures of different sizes");
        let apart = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).any(|channel| a[channel].abs_diff(b[channel]) > tolerance);
        let count = self.pixels.iter().zip(&other.pixels).filter(|pair| apart(*pair)).count();
        count as f64 / self.pixels.len().max(1) as f64
    }

    /// The mean of the three channels over all pixels, 0 to 255.
    pub fn brightness(&self) -> f64 {
        let sum: f64 = self.pixels.iter().flatten().map(|&channel| f64::from(channel)).sum();
        sum / (3 * self.pixels.len().max(1)) as f64
    }
}

/// Hue from 0 to 1, unless the colour is nearly grey.
fn hue(&[r, g, b]: &[u8; 3]) -> Option<f64> {
    let (low, high) = (r.min(g).min(b), r.max(g).max(b));
    if high - low < 24 {
        return None;
    }
    let [r, g, b, range] = [r, g, b, high - low].map(f64::from);
    let sixth = if f64::from(high) == r {
        ((g - b) / range).rem_euclid(6.0)
    } else if f64::from(high) == g {
        (b - r) / range + 2.0
    } else {
        (r - g) / range + 4.0
    };
    Some(sixth / 6.0)
}
