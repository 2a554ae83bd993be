//! Colours for fields and for lines, chosen to survive colour blindness and grey printing.

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

/// Lines: black, then Okabe and Ito's (2008) blue, vermilion, green, purple, orange and sky blue.
const LINES: [u32; 7] = [
    0x222222, 0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0xE69F00, 0x56B4E9,
];

/// What is drawn where a field is not a number.
pub const MISSING: [u8; 3] = [150, 150, 150];

/// A colour map that is even to the eye. All but the one for two signs rise or fall in lightness all
/// the way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Map {
    /// Pale cream through red to purple: magma backwards, without its black end. Shading shows best on pale surfaces,
    /// and most of a tube is unstressed.
    #[default]
    Pale,
    /// Dark violet through green to yellow: viridis.
    Viridis,
    /// Blue through near white to vermilion, for fields of two signs.
    Signed,
}

impl Map {
    /// The colour at `t` from 0 to 1; beyond the ends the end colours, for NaN [`MISSING`].
    #[must_use]
    pub fn colour(self, t: f64) -> [u8; 3] {
        if t.is_nan() {
            return MISSING;
        }
        let t = t.clamp(0.0, 1.0);
        let (table, place) = match self {
            Map::Pale => (&MAGMA, 0.02 + 0.76 * t),
            Map::Viridis => (&VIRIDIS, t),
            Map::Signed => {
                let end = rgb(if t < 0.5 { LINES[1] } else { LINES[2] });
                return mix([244; 3], end, (2.0 * t - 1.0).abs());
            }
        };
        let place = place * (table.len() - 1) as f64;
        let below = (place as usize).min(table.len() - 2);
        mix(
            rgb(table[below]),
            rgb(table[below + 1]),
            place - below as f64,
        )
    }
}

/// [`Map::Viridis`] at `t`.
#[must_use]
pub fn colour(t: f64) -> [u8; 3] {
    Map::Viridis.colour(t)
}

/// The `n`th line colour; 0 is black, and the list starts over after six others.
#[must_use]
pub fn line_colour(n: usize) -> [u8; 3] {
    rgb(LINES[n % LINES.len()])
}

/// From `a` at t = 0 to `b` at t = 1.
pub(super) fn mix(a: [u8; 3], b: [u8; 3], t: f64) -> [u8; 3] {
    std::array::from_fn(|i| {
        (f64::from(a[i]) + t * (f64::from(b[i]) - f64::from(a[i]))).round() as u8
    })
}

/// sRGB byte to light, 0 to 1 (IEC 61966-2-1).
pub(super) fn to_light(byte: u8) -> f64 {
    let c = f64::from(byte) / 255.0;
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// Light to sRGB byte, the inverse of [`to_light`].
pub(super) fn to_byte(light: f64) -> u8 {
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
    fn lightness_runs_evenly() {
        // CIE lightness L* from luminance
        let lightness = |map: Map, i: i32| {
            let [r, g, b] = map.colour(f64::from(i) / 20.0).map(to_light);
            let y: f64 = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            if y > 0.008_856 {
                116.0 * y.cbrt() - 16.0
            } else {
                903.3 * y
            }
        };
        for (map, direction) in [(Map::Viridis, 1.0), (Map::Pale, -1.0)] {
            for i in 0..20 {
                let step = direction * (lightness(map, i + 1) - lightness(map, i));
                assert!((2.5..5.5).contains(&step), "{map:?} from {i}/20: {step}");
            }
        }
    }

    #[test]
    fn ends_and_missing() {
        assert_eq!(colour(f64::NEG_INFINITY), [0x44, 0x01, 0x54]);
        assert_eq!(colour(2.0), [0xFD, 0xE7, 0x25]);
        assert_eq!(colour(f64::NAN), MISSING);
    }

    #[test]
    fn light_round_trip() {
        assert!((0..=255).all(|byte| to_byte(to_light(byte)) == byte));
    }
}
