//! The laws that can be fitted, their parameters, and the maps that keep these in their ranges.

use crate::material::{
    Composite, Demiray, Fibres, Fung, Gent, Material, Matrix, NeoHookean, Volumetric, Yeoh,
};

/// A law that can be fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FittedLaw {
    /// Neo-Hookean.
    NeoHookean,
    /// Yeoh, with three constants.
    Yeoh,
    /// Demiray.
    Demiray,
    /// Gent.
    Gent,
    /// Fung, with coefficients of the strains along and around.
    Fung,
    /// Neo-Hookean with a pair of families of fibres (Holzapfel et al. 2000).
    Hgo,
    /// The same with dispersion (Gasser et al. 2006).
    Goh,
}

/// The unit of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterUnit {
    /// Unit of the stresses.
    Stress,
    /// Degrees.
    Degrees,
    /// None.
    None,
}

/// The map from any number to the range of a parameter.
#[derive(Clone, Copy)]
enum Map {
    /// exp x.
    Positive,
    /// From 0 to this.
    To(f64),
    /// tanh x.
    Correlation,
}

impl Map {
    fn value(self, x: f64) -> f64 {
        match self {
            Self::Positive => x.exp(),
            Self::To(end) => end / (1.0 + (-x).exp()),
            Self::Correlation => x.tanh(),
        }
    }

    fn inverse(self, value: f64) -> f64 {
        match self {
            Self::Positive => value.ln(),
            Self::To(end) => (value / (end - value)).ln(),
            Self::Correlation => value.atanh(),
        }
    }
}

/// Ratio of the constant of the volumetric energy to the shear modulus in a law that was fitted.
const BULK: f64 = 100.0;

impl FittedLaw {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::NeoHookean,
        Self::Yeoh,
        Self::Demiray,
        Self::Gent,
        Self::Fung,
        Self::Hgo,
        Self::Goh,
    ];

    /// Returns its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::NeoHookean => "neo-hookean",
            Self::Yeoh => "yeoh",
            Self::Demiray => "demiray",
            Self::Gent => "gent",
            Self::Fung => "fung",
            Self::Hgo => "hgo",
            Self::Goh => "goh",
        }
    }

    /// Returns the names of its parameters, as keys of a case, and their units.
    pub fn parameters(self) -> &'static [(&'static str, ParameterUnit)] {
        use ParameterUnit::{Degrees, None, Stress};
        match self {
            Self::NeoHookean => &[("shear_modulus", Stress)],
            Self::Yeoh => &[("c1", Stress), ("c2", Stress), ("c3", Stress)],
            Self::Demiray => &[("shear_modulus", Stress), ("stiffening", None)],
            Self::Gent => &[("shear_modulus", Stress), ("limit", None)],
            Self::Fung => &[
                ("c", Stress),
                ("along", None),
                ("around", None),
                ("along_around", None),
            ],
            Self::Hgo => &[
                ("shear_modulus", Stress),
                ("k1", Stress),
                ("k2", None),
                ("angle_degrees", Degrees),
            ],
            Self::Goh => &[
                ("shear_modulus", Stress),
                ("k1", Stress),
                ("k2", None),
                ("angle_degrees", Degrees),
                ("dispersion", None),
            ],
        }
    }

    fn maps(self) -> Vec<Map> {
        let names = self.parameters().iter().map(|parameter| parameter.0);
        let map = |name| match name {
            "angle_degrees" => Map::To(90.0),
            "dispersion" => Map::To(1.0 / 3.0),
            "along_around" => Map::Correlation,
            _ => Map::Positive,
        };
        names.map(map).collect()
    }

    /// Returns the parameters for free numbers x. `largest` is the largest I₁ − 3 of the tests, above which the limit of
    /// Gent's law lies.
    pub(super) fn values(self, x: &[f64], largest: f64) -> Vec<f64> {
        let pairs = self.maps().into_iter().zip(x);
        let mut values: Vec<f64> = pairs.map(|(map, x)| map.value(*x)).collect();
        match self {
            Self::Gent => values[1] += 1.001 * largest,
            // A correlation between −1 and 1 keeps the form positive definite.
            Self::Fung => values[3] *= (values[1] * values[2]).sqrt(),
            _ => {}
        }
        values
    }

    /// Returns the numbers x to start from, given the stiffness in tension at small strains.
    pub(super) fn starts(self, stiffness: f64) -> Vec<Vec<f64>> {
        let mu = stiffness / 3.0;
        let mut starts: Vec<Vec<f64>> = vec![];
        match self {
            Self::NeoHookean => starts.push(vec![mu]),
            Self::Yeoh => {
                for share in [1e-2, 0.3] {
                    starts.push(vec![0.5 * mu, share * mu, share * share * mu]);
                }
            }
            Self::Demiray => starts.extend([0.3, 3.0, 20.0].map(|b| vec![mu, b])),
            Self::Gent => starts.extend([0.3, 3.0, 30.0].map(|j| vec![mu, j])),
            Self::Fung => {
                for a in [0.3, 2.0, 10.0] {
                    starts.push(vec![stiffness / a, a, a, 0.3]);
                }
            }
            Self::Hgo | Self::Goh => {
                for angle in [20.0, 45.0, 70.0] {
                    for k2 in [0.5, 10.0] {
                        let mut start = vec![mu, 0.3 * mu, k2, angle];
                        if self == Self::Goh {
                            start.push(0.1);
                        }
                        starts.push(start);
                    }
                }
            }
        }
        let maps = self.maps();
        let free = |start: Vec<f64>| {
            let pairs = maps.iter().zip(start);
            pairs.map(|(map, value)| map.inverse(value)).collect()
        };
        starts.into_iter().map(free).collect()
    }

    /// Returns the law with some parameters. Its volumetric constant is a hundred times its shear modulus.
    pub fn material(self, values: &[f64]) -> Material {
        let v = values;
        let neo_hookean = || NeoHookean {
            mu: v[0],
            lambda: BULK * v[0],
            volumetric: Volumetric::Quadratic,
        };
        let matrix = match self {
            Self::NeoHookean => return Material::NeoHookean(neo_hookean()),
            Self::Yeoh => Matrix::Yeoh(Yeoh {
                c: [v[0], v[1], v[2]],
                bulk: 2.0 * BULK * v[0],
            }),
            Self::Demiray => Matrix::Demiray(Demiray {
                shear_modulus: v[0],
                stiffening: v[1],
                bulk: BULK * v[0],
            }),
            Self::Gent => Matrix::Gent(Gent {
                shear_modulus: v[0],
                limit: v[1],
                bulk: BULK * v[0],
            }),
            Self::Fung => {
                let a = [[v[1], 0.0, v[3]], [0.0; 3], [v[3], 0.0, v[2]]];
                let mut law = Fung::new(v[0], a, 0.0);
                law.bulk = BULK * law.shear_modulus();
                Matrix::Fung(law)
            }
            Self::Hgo | Self::Goh => Matrix::NeoHookean(neo_hookean()),
        };
        let mut fibres = vec![];
        if let Self::Hgo | Self::Goh = self {
            let dispersion = v.get(4).copied().unwrap_or(0.0);
            let family = Fibres::new([v[1], v[2]], dispersion, v[3].to_radians());
            fibres = vec![family, family.mirrored()];
        }
        Material::Composite(Composite {
            matrix,
            fibres,
            tones: vec![],
        })
    }
}
