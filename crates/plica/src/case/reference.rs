//! The reference page of the case file, written from the declarations of its keys.

use super::key::{Default, Key, Kind, LENGTH, STIFFNESS, STRESS, visit};
use super::keys::Case;
use super::read::Table;
use std::fmt::Write;

const OPENING: &str = "\
<!-- Written from the declarations of the keys; PLICA_BLESS=1 cargo test rewrites it. -->

# The case file

A case is a [TOML](https://toml.io) file. `plica new` writes one to start from, `plica check` checks one, and `plica run`
runs it. Only `stages` is required; a key that is left out has the default given here. An unknown key is an error.

`plica schema > case.schema.json` writes the same as a JSON schema. With `#:schema ./case.schema.json` in the first line of
a case, editors with support for TOML (taplo, Even Better TOML) complete keys, show their meanings and mark errors.

`<name>` is a name that you choose. In messages, members of a list are counted from one: `stages[2].steps`.
";

/// The rules that concern several keys.
const CLOSING: &str = "
## Rules between keys

- The length is 0.01 to 1000 D, the wall at least 0.001 D thick and thinner than D/2.
- A zone lies within the tube and is at least 0.001 D long. Zones of muscles of the same direction do not overlap.
- Targets keep every stress-free stretch between 0.02 and 100, and the distance of the ends between 0.05 and 10 times
  that at rest. `diameter_ratio` drives a circular muscle, `length_ratio` a longitudinal one, and `tension`, at most 1000 E,
  one with `active_stress`. A displacement needs a fixed or sliding end, a twist a fixed one.
- The layers of a wall are at least a thousandth of it thick, have different names, and add up to `tube.thickness` where
  that is given. With layers, `mesh.control_points.thickness` is not given, and `mesh.grading` is 1 unless there is only
  one. A muscle with a `layer` acts in that layer only; its zone may overlap those of muscles in other layers.
- `shear_modulus` and `bulk` of the neo-Hookean law are given together, without `youngs_modulus` and `poisson_ratio`. A
  pair of families of fibres is not at 0° or 90°, where it would count one family twice. Residual stretches lie between
  0.1 and 10; `around` is not given together with `opening_degrees`. Of a tone and an active stress, `best_stretch` is
  given together with either `least_stretch`, which is below it, or `width`; a `table` is given alone. With `contact`,
  every family of a layer has a mirror image, and fibres of active stresses run around the tube or along it.
- The form Q of Fung's law is positive definite: in the strains along and around if there are no coefficients of the strain
  through the wall, and else in all three.
- `from` is not given together with a law, and `file` and `bulk` only with `from`. A material whose stresses have a unit
  needs a case with `units`. A layer whose material has fibres has none of its own.
- A pressure is at most 10 E. A follower pressure needs both ends held; an axial imperfection of an end then needs that
  end to be fixed. (Where an end moves freely, the work of a follower pressure depends on the path and on the closure of
  the end. A dead load has no such restriction.)
- There are at least p + 1 control points along the tube and through the wall, and 2 p + 2 around it, p being the degree.
  `fold` divides those around. At most 20 million are solved for.
- An imperfection has circumferential modes that the symmetry allows (0 if axisymmetric, multiples of m for `fold = m`)
  and that the mesh resolves (at most a quarter of the control points around). Its amplitude is at most a quarter of the
  thickness, or 0.5 for a muscle. An imperfect end is held; it is displaced across only if it is fixed.
- A mode that is the shape of an imperfect geometry comes from a tube of the same length and thickness in D, on any mesh.
  All imperfections of the geometry together leave a wall that is nowhere folded over.
- A state to start from comes from a tube of the same length and thickness in D. The muscles that it drives are in the
  case, with the same names and directions; other muscles are at rest. It is axisymmetric, or repeats around the tube a
  multiple of as many times as the case does.
- Sectors are not for axisymmetric tubes. An edge is at most half of its zone or its width, and all repetitions of a
  sector, those by a fold too, fit into the circumference. A patch names muscles and a layer that exist; where it makes a
  muscle stronger, stress-free stretches stay above 0.02. `tension_only` needs the direction `normal`, and without
  symmetry a fixed end. Names of patches differ from each other and from those of muscles, ends and obstacles.
- Names of stages differ.
";

/// Returns the text of `docs/case-file.md`.
pub fn reference() -> String {
    let mut page = format!("{OPENING}\n## Keys of the whole case\n\n{HEAD}");
    let is_section = |key: &Key| match key.kind {
        Kind::Choice(words, _) => words.is_empty(),
        _ => !key.kind.keys().is_empty(),
    };
    visit(Case::KEYS, &mut |path, key| {
        if !path.contains('.') && is_section(key) {
            let title = match key.kind {
                Kind::List(_) => format!("[[{path}]]"),
                Kind::Named(_) => format!("[{path}.<name>]"),
                _ => format!("[{path}]"),
            };
            let _ = write!(page, "\n## `{title}`\n\n{}\n\n{HEAD}", key.meaning());
        } else {
            page += &row(path, key);
        }
    });
    page + CLOSING
}

const HEAD: &str = "| key | value | default | meaning |\n|---|---|---|---|\n";

fn row(path: &str, key: &Key) -> String {
    let kind = match key.kind {
        Kind::Text => "text".to_owned(),
        Kind::Texts => "`[\"text\", …]`".to_owned(),
        Kind::Boolean => "`true` or `false`".to_owned(),
        Kind::Integer => "whole number".to_owned(),
        Kind::Number => "number".to_owned(),
        Kind::Zone => "`[from, to]`".to_owned(),
        Kind::Position => "`[x, y, z]`".to_owned(),
        Kind::Points => "`[[x, s], …]`".to_owned(),
        Kind::Numbers => "`{ name = number, … }`".to_owned(),
        Kind::Course => "number, or `[[time, value], …]`".to_owned(),
        Kind::VectorCourse(2) => "`[x, y]`, or `[[time, x, y], …]`".to_owned(),
        Kind::VectorCourse(_) => "`[x, y, z]`, or `[[time, x, y, z], …]`".to_owned(),
        Kind::List(_) => "list of tables".to_owned(),
        Kind::Table(_) | Kind::Named(_) | Kind::Choice([], _) | Kind::Either(..) => {
            "table".to_owned()
        }
        Kind::Choice(words, tables) => {
            let words = words.iter().map(|word| format!("`\"{word}\"`"));
            let tables = tables.iter().map(|key| format!("`{{ {} = … }}`", key.name));
            words.chain(tables).collect::<Vec<_>>().join(", ")
        }
    };
    let mut value = vec![kind];
    match key.rule.unit {
        "" => {}
        unit @ (LENGTH | STRESS | STIFFNESS) => value.push(format!("a {unit}")),
        unit => value.push(format!("in {unit}")),
    }
    let range = key.rule.range.words();
    if !range.is_empty() {
        value.push(range);
    }
    let default = match key.rule.default {
        Default::Required(_) => "required".to_owned(),
        Default::Value("{}") | Default::Described("", _) => "–".to_owned(),
        Default::Value(_) => format!("`{}`", key.example()),
        Default::Described(words, _) => words.to_owned(),
    };
    let (value, meaning) = (value.join("; "), key.meaning());
    format!("| `{path}` | {value} | {default} | {meaning} |\n")
}
