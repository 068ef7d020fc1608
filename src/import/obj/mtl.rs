//! The lists of materials beside an OBJ: colour, opacity, glow, roughness, and the picture on it. All else, and what is
//! broken, is passed over.

use crate::import::text::{Lines, words};
use serde_json::{Map, Value, json};

/// Grey, for what has no material.
const PLAIN: [f64; 3] = [0.8; 3];
/// As dull as parts are painted.
const ROUGHNESS: f64 = 0.9;
/// The exponent of a mirror's highlight; that of Blender, which writes most of these lists and reads them so.
const SHARPEST: f64 = 1000.0;
/// Options of a picture that take one word, and those that take up to three numbers.
const ONE: &[&[u8]] =
    &[b"-blendu", b"-blendv", b"-boost", b"-bm", b"-cc", b"-clamp", b"-imfchan", b"-texres", b"-type"];
const NUMBERS: &[&[u8]] = &[b"-mm", b"-o", b"-s", b"-t"];

/// A material of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub name: String,
    colour: [f64; 3],
    /// By the statements `d` and `Tr`; the first is believed where both are there.
    opacity: [Option<f64>; 2],
    glow: [f64; 3],
    roughness: f64,
    /// The file with the picture, as it is written.
    pub picture: Option<String>,
    /// The same for how opaque it is.
    mask: Option<String>,
}

impl Material {
    /// One without anything.
    pub fn plain(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            colour: PLAIN,
            opacity: [None; 2],
            glow: [0.0; 3],
            roughness: ROUGHNESS,
            picture: None,
            mask: None,
        }
    }

    /// As glTF has it; `texture` is the number of its picture. A picture takes the place of the colour, which is often
    /// black or grey beside one.
    pub fn entry(&self, texture: Option<usize>) -> Value {
        let [r, g, b] = if texture.is_some() { [1.0; 3] } else { self.colour };
        // What cannot be seen at all is a slip of the program that wrote it.
        let opacity = self.opacity.iter().flatten().next().copied().filter(|&opacity| opacity > 0.0).unwrap_or(1.0);
        let mut surface = Map::new();
        surface.insert("baseColorFactor".into(), json!([r, g, b, opacity]));
        surface.insert("metallicFactor".into(), json!(0.0));
        surface.insert("roughnessFactor".into(), json!(self.roughness));
        if let Some(texture) = texture {
            surface.insert("baseColorTexture".into(), json!({ "index": texture }));
        }
        let mut entry = json!({ "name": self.name, "pbrMetallicRoughness": surface });
        if self.glow != [0.0; 3] {
            entry["emissiveFactor"] = json!(self.glow);
        }
        if opacity < 1.0 {
            entry["alphaMode"] = json!("BLEND");
        } else if texture.is_some() && self.mask == self.picture {
            // Cut out, not mixed: what is mixed does not hide what lies behind it, and this is often a whole figure.
            entry["alphaMode"] = json!("MASK");
        }
        entry
    }
}

/// The materials of a list, in its order.
pub fn read(bytes: &[u8]) -> Vec<Material> {
    let mut lines = Lines::new("", bytes);
    let mut materials: Vec<Material> = Vec::new();
    while let Some(line) = lines.next_line() {
        let (key, rest) = cut(line);
        if key == b"newmtl" {
            materials.push(Material::plain(&text(rest)));
        }
        let Some(material) = materials.last_mut() else { continue };
        let last = || words(rest).last().and_then(number);
        match key {
            b"Kd" => set_colour(&mut material.colour, rest),
            b"Ke" => set_colour(&mut material.glow, rest),
            b"Ns" => {
                if let Some(exponent) = words(rest).next().and_then(float) {
                    material.roughness = 1.0 - (exponent / SHARPEST).clamp(0.0, 1.0).sqrt();
                }
            }
            b"d" => material.opacity[0] = last(),
            b"Tr" => material.opacity[1] = last().map(|through| 1.0 - through),
            b"map_Kd" => material.picture = picture(rest),
            b"map_d" => material.mask = picture(rest),
            _ => {}
        }
    }
    materials
}

/// Takes over a colour, or a grey, where there is one.
fn set_colour(colour: &mut [f64; 3], line: &[u8]) {
    let found: Vec<f64> = words(line).map_while(number).collect();
    match found[..] {
        [r, g, b, ..] => *colour = [r, g, b],
        [grey] => *colour = [grey; 3],
        _ => {}
    }
}

/// The name of a picture's file.
fn picture(line: &[u8]) -> Option<String> {
    Some(text(without_options(line))).filter(|name| !name.is_empty())
}

/// A number from 0 to 1.
fn number(word: &[u8]) -> Option<f64> {
    float(word).map(|value| value.clamp(0.0, 1.0))
}

/// A finite number.
pub fn float(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok().filter(|value: &f64| value.is_finite())
}

/// The first word of a line, and what follows.
pub fn cut(line: &[u8]) -> (&[u8], &[u8]) {
    let line = line.trim_ascii();
    let (word, rest) = line.split_at(line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len()));
    (word, rest.trim_ascii_start())
}

/// A name in a line; it may have spaces in it.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).chars().filter(|c| !c.is_control()).collect()
}

/// What follows on the options of a picture: the name of its file.
fn without_options(mut line: &[u8]) -> &[u8] {
    loop {
        let (option, mut rest) = cut(line);
        if ONE.contains(&option) {
            rest = cut(rest).1;
        } else if NUMBERS.contains(&option) {
            for _ in 0..3 {
                let (word, after) = cut(rest);
                if after.is_empty() || float(word).is_none() {
                    break;
                }
                rest = after;
            }
        } else {
            return line;
        }
        line = rest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_exporters_write() {
        let list = b"# Blender\r\nKd 1 1 1\r\nnewmtl skin of a cat\r\n\tKd 0.5 0.25 0\r\nd 0.5\r\nTr 0\r\nillum 2\r\n\
            newmtl eye\nKd nan 1 1\nKd 0.5\nTr 0.25\nmap_Kd -s 1 1 1 -o 0.5 -clamp on textures\\my eye.png\n\
            Ke 0 0 0\nmap_d -imfchan m textures\\my eye.png\nNs 250\n\
            newmtl\nKd 7 -1 .5\nKe 2 0.5 0\nNs nan\nd -halo 0\nmap_Kd -s 1 2 3\nmap_Kd\n\
            newmtl hair\nmap_Kd hair.png\nmap_d hair.png\nNs 2000\nnewmtl lash\nmap_Kd a.png\nmap_d b.png";
        let [skin, eye, last, hair, lash] = &read(list)[..] else { panic!("five materials") };
        assert_eq!((skin.name.as_str(), &skin.picture), ("skin of a cat", &None));
        let surface = |entry: &Value| entry["pbrMetallicRoughness"].clone();
        let entry = skin.entry(None);
        assert_eq!(surface(&entry)["baseColorFactor"], json!([0.5, 0.25, 0.0, 0.5]));
        assert_eq!(entry["alphaMode"], "BLEND");
        assert_eq!(eye.picture.as_deref(), Some("textures\\my eye.png"));
        assert_eq!(surface(&eye.entry(None))["baseColorFactor"], json!([0.5, 0.5, 0.5, 0.75]));
        let pictured = surface(&eye.entry(Some(3)));
        assert_eq!(pictured["baseColorFactor"], json!([1.0, 1.0, 1.0, 0.75]));
        assert_eq!(pictured["baseColorTexture"], json!({ "index": 3 }));
        let entry = last.entry(None);
        assert_eq!(surface(&entry)["baseColorFactor"], json!([1.0, 0.0, 0.5, 1.0]), "seen, and within bounds");
        assert_eq!((last.name.as_str(), &last.picture, entry.get("alphaMode")), ("", &None, None));
        assert_eq!(entry["emissiveFactor"], json!([1.0, 0.5, 0.0]));
        assert_eq!(eye.entry(Some(3)).get("emissiveFactor"), None, "nothing glows black");
        let dull = |material: &Material| surface(&material.entry(None))["roughnessFactor"].clone();
        assert_eq!([skin, eye, last, hair].map(dull), [0.9, 0.5, 0.9, 0.0].map(|value| json!(value)));
        let cut = |material: &Material, texture| material.entry(texture).get("alphaMode").cloned();
        assert_eq!(cut(hair, Some(0)), Some(json!("MASK")), "by the opacity in the picture itself");
        assert_eq!([cut(hair, None), cut(lash, Some(0))], [None, None], "that of another picture is not there");
    }
}
