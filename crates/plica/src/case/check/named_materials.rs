//! Materials that a case takes from a library.

use super::super::files::{Input, InputFile, OpenInput};
use super::super::keys::{Case, Fibres, Law, Material, NamedMaterial};
use super::super::library::{self, LIBRARY};
use super::super::problem::Problems;
use super::super::spelling::nearest;
use crate::study::{MaterialFile, StressUnit};
use std::collections::BTreeMap;

/// The libraries that a case has named so far.
struct Libraries<'a> {
    open: &'a OpenInput<'a>,
    files: Vec<MaterialFile>,
}

/// Writes the laws and fibres of materials of libraries in the place of their names. Returns the files of users that were
/// read.
pub(super) fn look_up(
    case: &mut Case,
    open: &OpenInput<'_>,
    problems: &mut Problems,
) -> Vec<MaterialFile> {
    let files = vec![];
    let mut libraries = Libraries { open, files };
    let unit = case.units.as_ref().map(|units| units.stress);
    libraries.complete(&mut case.material, "material", unit, problems);
    for (i, layer) in case.layers.iter_mut().enumerate() {
        let path = format!("layers[{}]", i + 1);
        let own = layer.material.as_mut();
        let material = match own {
            Some(own) => {
                libraries.complete(own, &format!("{path}.material"), unit, problems);
                own
            }
            None => &case.material,
        };
        let key = format!("{path}.fibres");
        if !material.fibres.is_empty() && !layer.fibres.is_empty() && problems.are_sound(&[&key]) {
            let name = material.named.as_ref().map_or("", |named| &named.from);
            let rule = format!("{name} has fibres of its own");
            problems.key(&key, rule, "leave them out, or write the law out");
        }
    }
    libraries.files
}

impl Libraries<'_> {
    fn complete(
        &mut self,
        material: &mut Material,
        path: &str,
        unit: Option<StressUnit>,
        problems: &mut Problems,
    ) {
        let Some(named) = material.named.clone() else {
            return;
        };
        if !problems.are_sound(&[path]) {
            return;
        }
        match self.find(&named, path, unit, problems) {
            Some((law, fibres)) => (material.law, material.fibres) = (law, fibres),
            None => problems.replaced(path),
        }
    }

    /// Returns the law and the fibres of a material in the units of the case.
    fn find(
        &mut self,
        named: &NamedMaterial,
        path: &str,
        unit: Option<StressUnit>,
        problems: &mut Problems,
    ) -> Option<(Law, Vec<Fibres>)> {
        let text = match &named.file {
            None => LIBRARY.to_owned(),
            Some(file) => match self.read(file) {
                Ok(text) => text,
                Err(why) => {
                    let help = "give the path of a library of materials, relative to the case file";
                    problems.value(&format!("{path}.file"), why, help);
                    return None;
                }
            },
        };
        let mut rows = match library::rows(&text) {
            Ok(rows) => rows,
            Err(error) => {
                let found: Vec<String> = error.problems.iter().map(ToString::to_string).collect();
                problems.value(&format!("{path}.file"), found.join("; "), "");
                return None;
            }
        };
        let key = format!("{path}.from");
        let Some(mut row) = rows.remove(&named.from) else {
            problems.value(&key, "no material has this name", near(&named.from, &rows));
            return None;
        };
        let factor = match (row.stress, unit) {
            (None, _) => 1.0,
            (Some(from), Some(to)) => 10_f64.powi(from.power() - to.power()),
            // The mistake is in the units.
            (Some(_), None) if !problems.are_sound(&["units"]) => return None,
            (Some(from), None) => {
                let rule = format!("its stresses are in {from}, and the case has no units");
                let help = format!("write units = {{ length = \"mm\", stress = \"{from}\" }}");
                problems.value(&key, rule, help);
                return None;
            }
        };
        scale(&mut row.material, factor);
        for family in &mut row.fibres {
            family.k1 *= factor;
        }
        if let Some(bulk) = named.bulk
            && !set_bulk(&mut row.material, bulk)
        {
            let rule = format!("{} is given by Poisson's ratio", named.from);
            problems.value(&format!("{path}.bulk"), rule, "leave it out");
            return None;
        }
        Some((row.material, row.fibres))
    }

    /// Returns the text of a user's library, or why it cannot be read.
    fn read(&mut self, path: &str) -> Result<String, String> {
        if let Some(known) = self.files.iter().find(|known| known.file == path) {
            return Ok(known.text.clone());
        }
        let wanted = InputFile::Materials(self.files.len() + 1, path);
        let text = (self.open)(wanted).and_then(Input::text);
        let text = text.map_err(|error| error.to_string())?;
        self.files.push(MaterialFile {
            file: path.to_owned(),
            text: text.clone(),
        });
        Ok(text)
    }
}

/// Returns the material that is meant, or all of them.
fn near<T>(name: &str, rows: &BTreeMap<String, T>) -> String {
    let names: Vec<&str> = rows.keys().map(String::as_str).collect();
    match nearest(name, names.iter().copied()) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => format!("the materials are {}", names.join(", ")),
    }
}

/// Multiplies the stresses of a law.
fn scale(law: &mut Law, factor: f64) {
    let stresses: &mut [&mut f64] = match law {
        Law::NeoHookean(law) => {
            law.youngs_modulus *= factor;
            for stress in [&mut law.shear_modulus, &mut law.bulk] {
                *stress = stress.map(|x| x * factor);
            }
            return;
        }
        Law::MooneyRivlin(law) => &mut [&mut law.youngs_modulus],
        Law::Yeoh(law) => &mut [&mut law.c1, &mut law.c2, &mut law.c3, &mut law.bulk],
        Law::Demiray(law) => &mut [&mut law.shear_modulus, &mut law.bulk],
        Law::Gent(law) => &mut [&mut law.shear_modulus, &mut law.bulk],
        Law::Fung(law) => &mut [&mut law.c, &mut law.bulk],
    };
    for stress in stresses {
        **stress *= factor;
    }
}

/// Changes the constant of the volumetric energy of a law, if it has one.
fn set_bulk(law: &mut Law, bulk: f64) -> bool {
    match law {
        Law::NeoHookean(law) if law.bulk.is_some() => law.bulk = Some(bulk),
        Law::NeoHookean(_) | Law::MooneyRivlin(_) => return false,
        Law::Yeoh(law) => law.bulk = bulk,
        Law::Demiray(law) => law.bulk = bulk,
        Law::Gent(law) => law.bulk = bulk,
        Law::Fung(law) => law.bulk = bulk,
    }
    true
}
