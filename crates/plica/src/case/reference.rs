//! The reference page of the case file, written from the table of keys.

use super::keys::{Given, Key, Kind};
use super::table::KEYS;

const OPENING: &str = "\
<!-- Written from the table of keys in the program; PLICA_BLESS=1 cargo test rewrites it. -->

# The case file

A case is a [TOML](https://toml.io) file. `plica new` writes one to start from, `plica check` says
what is wrong with one, `plica run` runs it. Only `stages` must be there; a key that is left out has
the default given here. A misspelt key is an error.

`plica schema > case.schema.json` writes the same as a JSON schema; with `#:schema ./case.schema.json` on a case's first
line, editors that know TOML (taplo, Even Better TOML) complete keys, show what they mean and mark what is wrong.

Without `[units]` a case is in ratios: lengths in the unit of `tube.diameter`, results in diameters D
and Young's moduli E. With it, lengths and stresses are in these units, in the file and in the results.

`<name>` is a name of your own (`colon` and `ileum`, the two ends of the tube, and `inner-wall` and `outer-wall`
are taken). In messages, members of a list are counted from one: `stages[2].steps`.
";

const SECTIONS: &[(&str, &str)] = &[
    ("title", "## The whole case"),
    (
        "units.length",
        "## `[units]`\n\nIf the table is there, both keys are needed.",
    ),
    ("tube.diameter", "## `[tube]`"),
    (
        "material.neo-hookean.youngs_modulus",
        "## `[material.neo-hookean]`",
    ),
    ("muscles.<name>.direction", "## `[muscles.<name>]`"),
    (
        "ends.colon",
        "## `[ends]`\n\nA held end can be moved: drive `colon` or `ileum` in a stage.",
    ),
    ("mesh.control_points.axial", "## `[mesh]`"),
    (
        "start.state",
        "## `[start]`\n\nA run begins at rest, unless this table names a state to begin from. The state may be of another \
         mesh, and of a\nhigher symmetry; it is carried over and brought to equilibrium before it counts.",
    ),
    (
        "stages",
        "## `[[stages]]`\n\nTargets that a stage does not name stay as they are.",
    ),
    (
        "imperfections",
        "## `[[imperfections]]`\n\nSmall deviations from the perfect tube, which decide where it goes where its path branches. \
         They are there from\nrest on, and add up. A shape lies between −1 and 1 and is multiplied by the amplitude.",
    ),
    ("solver.scheme", "## `[solver]`"),
    (
        "solver.pseudo_time.damping",
        "### `[solver.pseudo_time]`\n\nFor the schemes `\"newmark\"` and `\"dragged\"` only.",
    ),
    ("output.pictures", "## `[output]`"),
];

/// The text of `docs/case-file.md`.
pub fn reference() -> String {
    let mut page = OPENING.to_owned();
    for key in KEYS {
        if let Some((_, heading)) = SECTIONS.iter().find(|(first, _)| *first == key.path) {
            page += &format!("\n{heading}\n\n");
            page += "| key | value | default | |\n|---|---|---|---|\n";
        }
        page += &row(key);
    }
    page + CLOSING
}

/// Rules that are not a range of one key.
const CLOSING: &str = "
## Rules between keys

- The length is 0.01 to 1000 D, the wall at least 0.001 D thick and thinner than D/2.
- A zone lies within the tube and is at least 0.001 D long; zones of muscles of one direction do not
  overlap.
- Targets keep every stress-free stretch between 0.02 and 100, and the ends between 0.05 and 10 times
  their distance at rest. `diameter_ratio` drives a circular muscle, `length_ratio` a longitudinal one;
  a displacement needs a fixed or sliding end, a twist a fixed one.
- A pressure is at most 10 E. A true one needs both ends held, and an end that slides in its plane: an imperfection along
  the axis needs a fixed end there. (Where an end moves along the axis, the work of a true pressure depends on the way and on
  what closes the end; a dead pressure knows no such thing.)
- There are at least p + 1 control points along the tube and through the wall, and 2 p + 2 around it;
  `fold` divides those around; at most 20 million are solved for.
- An imperfection has harmonics that the symmetry of the run allows (0 if axisymmetric, multiples of m in a
  fold) and that the mesh draws, at most a quarter of the control points around. Its amplitude is at most a quarter of the
  wall's thickness, or half of a muscle's activity. An end is held, and displaced across only if it is fixed.
- A mode that a geometry has the shape of is of a tube of the same length and thickness in D, on any mesh. All
  imperfections of the geometry together leave a wall that is nowhere folded over.
- A state to start from is of a tube of the same length and thickness in D. Muscles that it drives are there,
  with their names and directions; the others are at rest. It is axisymmetric, or repeats around the
  tube a multiple of as many times as the case does.
- A muscle's name has at most 40 letters, digits, - and _; names of stages differ.
";

fn row(key: &Key) -> String {
    let kind = match key.kind {
        Kind::Text => "text".to_owned(),
        Kind::Switch => "`true` or `false`".to_owned(),
        Kind::Count => "whole number".to_owned(),
        Kind::Number => "number".to_owned(),
        Kind::Word(words) => {
            let quoted: Vec<String> = words.iter().map(|word| format!("`\"{word}\"`")).collect();
            quoted.join(", ")
        }
        Kind::Zone => "`[from, to]`".to_owned(),
        Kind::Points => "`[[x, s], …]`".to_owned(),
        Kind::Tables => "list of tables".to_owned(),
        Kind::Choice => "one of the tables below".to_owned(),
    };
    let mut value = vec![kind];
    if !key.unit.is_empty() {
        value.push(match key.unit {
            "length" | "stress" => format!("a {}", key.unit),
            unit => format!("in {unit}"),
        });
    }
    if !key.range.words().is_empty() {
        value.push(key.range.words());
    }
    let default = match key.given {
        Given::Always(_) => "needed".to_owned(),
        Given::Or(default) => format!("`{default}`"),
        Given::OrElse("", _) => "–".to_owned(),
        Given::OrElse(words, _) => words.to_owned(),
    };
    format!(
        "| `{}` | {} | {default} | {} |\n",
        key.path,
        value.join("; "),
        key.meaning
    )
}
