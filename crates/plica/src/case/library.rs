//! Libraries of materials: that of Plica, and those of users.

use super::check::law;
use super::key::{Key, Kind, default, described, required};
use super::keys::{Fibres, Law};
use super::problem::{CaseError, Problems};
use super::read::{Fields, Read, Table, Value, table};
use super::syntax;
use crate::material::Material;
use crate::study::StressUnit;
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::DeValue;

/// The library of Plica.
pub(super) const LIBRARY: &str = include_str!("materials.toml");

table! {
    Row {
        /// The tissue.
        tissue: Option<String> = described("not given", "media of the carotid artery");
        /// The species.
        species: Option<String> = described("not given", "rabbit");
        /// The publication.
        source: Option<String> = described("not given", "Holzapfel, Gasser and Ogden (2000)");
        /// Its digital object identifier.
        doi: Option<String> = described("not given", "10.1023/A:1010835316564");
        /// The range of the data that the numbers are fitted to.
        valid: Option<String> = described("not given", "stretches up to 1.4");
        /// A remark for users.
        note: Option<String> = described("none", "passive");
        /// The unit of its stresses.
        stress: Option<StressUnit> = described("that of the case", "kPa");
        /// Its law, as in a case.
        material: Law = required("{ neo-hookean = {} }");
        /// Its fibres, as in a layer of a case.
        fibres: Vec<Fibres> = default("[]");
    }
}

/// A material of a library.
#[derive(Clone, Debug)]
pub struct LibraryMaterial {
    /// Its name.
    pub name: String,
    /// The tissue.
    pub tissue: Option<String>,
    /// The species.
    pub species: Option<String>,
    /// The publication.
    pub source: Option<String>,
    /// Its digital object identifier.
    pub doi: Option<String>,
    /// The range of the data that the numbers are fitted to.
    pub valid: Option<String>,
    /// A remark for users.
    pub note: Option<String>,
    /// The unit of its stresses; none for that of the case.
    pub unit: Option<StressUnit>,
    /// Its law with its fibres, stresses in that unit.
    pub material: Material,
}

/// Returns the materials of the library of Plica, by their names.
pub fn library() -> Vec<LibraryMaterial> {
    match materials(LIBRARY) {
        Ok(materials) => materials,
        Err(error) => unreachable!("the library is valid: {error}"),
    }
}

/// Returns the materials of the text of a library, by their names.
///
/// # Errors
/// All problems that were found, as for a case.
pub fn materials(text: &str) -> Result<Vec<LibraryMaterial>, CaseError> {
    let material = |(name, row): (String, Row)| {
        let material = law::material(
            &row.material,
            &row.fibres,
            &name,
            1.0,
            &mut Problems::default(),
        );
        LibraryMaterial {
            name,
            tissue: row.tissue,
            species: row.species,
            source: row.source,
            doi: row.doi,
            valid: row.valid,
            note: row.note,
            unit: row.stress,
            material,
        }
    };
    Ok(rows(text)?.into_iter().map(material).collect())
}

/// Reads and checks the rows of a library.
pub(super) fn rows(text: &str) -> Result<BTreeMap<String, Row>, CaseError> {
    let mut problems = Problems::of(text, Row::KEYS);
    let Some(table) = syntax::parse(text, &mut problems) else {
        problems.into_result()?;
        return Ok(BTreeMap::new());
    };
    let root = Key {
        name: "",
        doc: "",
        kind: Kind::Named(Row::KEYS),
        rule: default("{}"),
    };
    let value: Value = Spanned::new(0..0, DeValue::Table(table));
    let rows = BTreeMap::<String, Row>::read(&mut problems, &root, "", &value).unwrap_or_default();
    for (name, row) in &rows {
        let path = super::key::join("", name);
        law::material(&row.material, &row.fibres, &path, 1.0, &mut problems);
    }
    problems.into_result().map(|()| rows)
}
