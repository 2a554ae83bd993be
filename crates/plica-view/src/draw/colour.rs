//! Colours of fields and lines, distinguishable with colour-blindness and in grey printing.

/// Viridis by S. van der Walt, N. Smith and E. Firing (matplotlib, CC0): every fifth of its 256 colours.
const VIRIDIS: [u32; 52] = [
    0x440154, 0x46085C, 0x471063, 0x481769, 0x481D6F, 0x482475, 0x472A7A, 0x46307E, 0x453781,
    0x433D84, 0x414287, 0x3F4889, 0x3D4E8A, 0x3A538B, 0x38598C, 0x355E8D, 0x33638D, 0x31688E,
    0x2E6D8E, 0x2C718E, 0x2A768E, 0x297B8E, 0x27808E, 0x25848E, 0x23898E, 0x218E8D, 0x20928C,
    0x1F978B, 0x1E9C89, 0x1FA188, 0x21A585, 0x24AA83, 0x28AE80, 0x2EB37C, 0x35B779, 0x3DBC74,
    0x46C06F, 0x50C46A, 0x5AC864, 0x65CB5E, 0x70CF57, 0x7CD250, 0x89D548, 0x95D840, 0xA2DA37,
    0xB0DD2F, 0xBDDF26, 0xCAE11F, 0xD8E219, 0xE5E419, 0xF1E51D, 0xFDE725,
];

/// Magma by the same authors (CC0), from its light end to its dark one.
const MAGMA: [u32; 52] = [
    0xFCFDBF, 0xFCF4B6, 0xFDEBAC, 0xFDE2A3, 0xFED89A, 0xFECF92, 0xFEC68A, 0xFEBD82, 0xFEB47B,
    0xFEAA74, 0xFEA16E, 0xFD9869, 0xFC8E64, 0xFB8560, 0xF97B5D, 0xF7725C, 0xF4695C, 0xF1605D,
    0xEC5860, 0xE75263, 0xE04C67, 0xD9466B, 0xD2426F, 0xCA3E72, 0xC23B75, 0xBA3878, 0xB2357B,
    0xAA337D, 0xA1307E, 0x992D80, 0x912B81, 0x892881, 0x812581, 0x792282, 0x721F81, 0x6A1C81,
    0x621980, 0x5A167E, 0x52137C, 0x4A1079, 0x420F75, 0x390F6E, 0x311165, 0x29115A, 0x21114E,
    0x1A1042, 0x140E36, 0x0E0B2B, 0x090720, 0x050416, 0x02020B, 0x000004,
];

/// Line colours: black, then Okabe and Ito's (2008) blue, vermilion, green, purple, orange and sky blue.
const LINES: [u32; 7] = [
    0x222222, 0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0xE69F00, 0x56B4E9,
];

/// Colour of points where a field is NaN.
pub(super) const MISSING: [u8; 3] = [150, 150, 150];

/// A perceptually uniform colour map. The lightness of all maps but the diverging one is monotone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ColourMap {
    /// Pale cream through red to purple: magma reversed, without its black end. Most of a tube is unstressed, and
    /// shading is most visible on pale surfaces.
    #[default]
    Pale,
    /// Dark violet through green to yellow: viridis.
    Viridis,
    /// Blue through near white to vermilion, for fields of two signs.
    Diverging,
}

impl ColourMap {
    /// Returns the colour at `t`, clamped to the range 0 to 1; grey for NaN.
    #[must_use]
    pub fn colour(self, t: f64) -> [u8; 3] {
        if t.is_nan() {
            return MISSING;
        }
        let t = t.clamp(0.0, 1.0);
        let (table, position) = match self {
            ColourMap::Pale => (&MAGMA, 0.02 + 0.76 * t),
            ColourMap::Viridis => (&VIRIDIS, t),
            ColourMap::Diverging => {
                let end = rgb(if t < 0.5 { LINES[1] } else { LINES[2] });
                return mix([244; 3], end, (2.0 * t - 1.0).abs());
            }
        };
        let position = position * (table.len() - 1) as f64;
        let below = (position as usize).min(table.len() - 2);
        mix(
            rgb(table[below]),
            rgb(table[below + 1]),
            position - below as f64,
        )
    }
}

/// Returns line colour number `n`: 0 is black, followed by six colours; larger numbers repeat them.
#[must_use]
pub fn line_colour(n: usize) -> [u8; 3] {
    rgb(LINES[n % LINES.len()])
}

/// Interpolates from `a` at t = 0 to `b` at t = 1.
pub(super) fn mix(a: [u8; 3], b: [u8; 3], t: f64) -> [u8; 3] {
    std::array::from_fn(|i| {
        (f64::from(a[i]) + t * (f64::from(b[i]) - f64::from(a[i]))).round() as u8
    })
}

/// Converts an sRGB byte to linear light from 0 to 1 (IEC 61966-2-1).
pub(super) fn to_linear(byte: u8) -> f64 {
    let c = f64::from(byte) / 255.0;
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// Converts linear light to an sRGB byte; inverse of [`to_linear`].
pub(super) fn to_srgb(light: f64) -> u8 {
    let l = light.clamp(0.0, 1.0);
    let c = if l <= 0.003_130_8 {
        12.92 * l
    } else {
        1.055 * l.powf(1.0 / 2.4) - 0.055
    };
    (c * 255.0).round() as u8
}

fn rgb(hex: u32) -> [u8; 3] {
    [(hex >> 16) as u8, (hex >> 8) as u8, hex as u8]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_changes_uniformly() {
        // CIE lightness L* from luminance
        let lightness = |map: ColourMap, i: i32| {
            let [r, g, b] = map.colour(f64::from(i) / 20.0).map(to_linear);
            let y: f64 = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            if y > 0.008_856 {
                116.0 * y.cbrt() - 16.0
            } else {
                903.3 * y
            }
        };
        for (map, direction) in [(ColourMap::Viridis, 1.0), (ColourMap::Pale, -1.0)] {
            for i in 0..20 {
                let step = direction * (lightness(map, i + 1) - lightness(map, i));
                assert!((2.5..5.5).contains(&step), "{map:?} from {i}/20: {step}");
            }
        }
    }

    #[test]
    fn maps_clamp_and_show_missing_values() {
        assert_eq!(
            ColourMap::Viridis.colour(f64::NEG_INFINITY),
            [0x44, 0x01, 0x54]
        );
        assert_eq!(ColourMap::Viridis.colour(2.0), [0xFD, 0xE7, 0x25]);
        assert_eq!(ColourMap::Viridis.colour(f64::NAN), MISSING);
    }

    #[test]
    fn srgb_round_trip() {
        assert!((0..=255).all(|byte| to_srgb(to_linear(byte)) == byte));
    }
}
