//! Reads the file of a study.

use super::axis::{number, range};
use super::refine::{Measure, Refinement};
use super::{Axis, Keep, LARGEST, Sweep, SweepError};
use crate::case::{CaseError, Problem};
use std::fs;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Keys of a study file.
const KEYS: [&str; 5] = ["base", "axes", "design", "refine", "keep"];

/// Keys of an axis that is a table.
const OF_AXIS: [&str; 5] = ["values", "from", "to", "points", "scale"];

/// Reads a study file and its base case.
pub(super) fn read(path: &Path) -> Result<Sweep, SweepError> {
    let read = |path: &Path| {
        fs::read_to_string(path).map_err(|source| SweepError::File {
            path: path.to_owned(),
            source,
        })
    };
    let text = read(path)?;
    let mut problems = vec![];
    let found = parse(&text, path, &mut problems);
    match found {
        Some(sweep) if problems.is_empty() => Ok(sweep),
        _ => {
            problems.sort_by_key(|problem: &Problem| problem.span.start);
            Err(SweepError::Study {
                path: path.to_owned(),
                text,
                error: CaseError { problems },
            })
        }
    }
}

fn problem(key: &str, rule: impl Into<String>, help: &str, span: Range<usize>) -> Problem {
    Problem {
        key: key.to_owned(),
        value: None,
        rule: rule.into(),
        help: (!help.is_empty()).then(|| help.to_owned()),
        span,
    }
}

/// Reads a study; none after problems.
fn parse(text: &str, path: &Path, problems: &mut Vec<Problem>) -> Option<Sweep> {
    let root = match DeTable::parse(text) {
        Ok(root) => root,
        Err(error) => {
            let span = error.span().unwrap_or(0..0);
            problems.push(problem("", error.message(), "", span));
            return None;
        }
    };
    let root = root.get_ref();
    unknown(root, "", &KEYS, problems);
    let base = base(root, path, problems);
    let base_text = base.as_ref().map_or("", |(_, text)| text);
    let mut axes = vec![];
    if let Some(table) = table(root, "axes", problems) {
        // In the order of the file; a table has its keys in that of the alphabet.
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(name, _)| name.span().start);
        for (name, value) in entries {
            axes.extend(axis(name.get_ref(), value, text, problems));
        }
    }
    let design = root.get("design").and_then(|file| {
        let (names, rows) = design(file, path, problems)?;
        if let Some(first) = axes.first() {
            let rule = "a study has either axes or a design";
            problems.push(problem("axes", rule, "", first.span.clone()));
        }
        axes = names;
        Some(rows)
    });
    if axes.is_empty() && problems.is_empty() {
        let help = "for example: axes = { \"tube.thickness\" = [0.04, 0.06] }";
        problems.push(problem(
            "axes",
            "a study needs at least one axis",
            help,
            0..0,
        ));
    }
    for axis in &mut axes {
        match key_of(&axis.name, base_text) {
            Ok(key) => axis.key = key,
            Err(rule) => {
                let key = format!("axes.\"{}\"", axis.name);
                problems.push(problem(&key, rule, "", axis.span.clone()));
            }
        }
    }
    let size = axes.iter().map(|axis| axis.values.len() as f64);
    let size: f64 = size.product();
    if design.is_none() && size > LARGEST as f64 {
        let rule = format!("the axes have {size:.0} points; at most {LARGEST} are allowed");
        let help = "refine boundaries ([refine]), or give a design of chosen points";
        problems.push(problem("axes", rule, help, axes[0].span.clone()));
    }
    let refinement = table(root, "refine", problems)
        .and_then(|table| refinement(table, &axes, design.is_some(), problems));
    let keep = table(root, "keep", problems).map_or(Keep::Last, |table| keep(table, problems));
    let (base, text) = base?;
    Some(Sweep {
        base,
        text,
        axes,
        design,
        refinement,
        keep,
    })
}

/// Reports keys that a table does not have.
fn unknown(table: &DeTable, path: &str, keys: &[&str], problems: &mut Vec<Problem>) {
    for (name, _) in table {
        if !keys.contains(&&name.get_ref()[..]) {
            let key = match path {
                "" => name.get_ref().to_string(),
                _ => format!("{path}.{}", name.get_ref()),
            };
            let help = format!("there are {}", keys.join(", "));
            problems.push(problem(&key, "unknown key", &help, name.span()));
        }
    }
}

/// Returns a table of the study, if there is one.
fn table<'a>(
    root: &'a DeTable<'a>,
    name: &str,
    problems: &mut Vec<Problem>,
) -> Option<&'a DeTable<'a>> {
    let value = root.get(name)?;
    let table = value.get_ref().as_table();
    if table.is_none() {
        problems.push(problem(name, "must be a table", "", value.span()));
    }
    table
}

/// Returns the path and the text of the base case.
fn base(
    root: &DeTable,
    path: &Path,
    problems: &mut Vec<Problem>,
) -> Option<(std::path::PathBuf, String)> {
    let Some(value) = root.get("base") else {
        let help = "name a case file, relative to the study file: base = \"tube.toml\"";
        problems.push(problem("base", "is missing", help, 0..0));
        return None;
    };
    let Some(name) = value.get_ref().as_str() else {
        let rule = "must be the path of a case file";
        problems.push(problem("base", rule, "", value.span()));
        return None;
    };
    let file = path.parent().unwrap_or_else(|| "".as_ref()).join(name);
    match fs::read_to_string(&file) {
        Ok(text) => Some((file, text)),
        Err(error) => {
            let rule = format!("{}: {error}", file.display());
            let help = "give the path of a case file, relative to the study file";
            problems.push(problem("base", rule, help, value.span()));
            None
        }
    }
}

/// Returns the key of an axis, with a stage that is given by its name in place of its number.
fn key_of(name: &str, base: &str) -> Result<String, String> {
    let Some((stage, rest)) = name
        .strip_prefix("stages.")
        .and_then(|rest| rest.split_once('.'))
    else {
        return Ok(name.to_owned());
    };
    let root = DeTable::parse(base).map_err(|error| format!("the base case: {error}"))?;
    let stages = root.get_ref().get("stages");
    let stages = stages.and_then(|stages| stages.get_ref().as_array());
    let names = stages.into_iter().flatten().map(|stage| {
        let name = stage
            .get_ref()
            .as_table()
            .and_then(|stage| stage.get("name"));
        name.and_then(|name| name.get_ref().as_str()).unwrap_or("")
    });
    let names: Vec<&str> = names.collect();
    match names.iter().position(|name| *name == stage) {
        Some(place) => Ok(format!("stages[{}].{rest}", place + 1)),
        None => Err(format!(
            "the base case has no stage {stage}; it has {}",
            names.join(", ")
        )),
    }
}

/// Reads an axis: a list of values, or a table with values or a range.
fn axis(
    name: &str,
    value: &Spanned<DeValue>,
    text: &str,
    problems: &mut Vec<Problem>,
) -> Option<Axis> {
    let key = format!("axes.\"{name}\"");
    let mut fail = |rule: &str, help: &str, span: Range<usize>| {
        problems.push(problem(&key, rule, help, span));
        None
    };
    let axis = |values| Axis {
        name: name.to_owned(),
        key: name.to_owned(),
        values,
        span: value.span(),
    };
    let list = |list: &[Spanned<DeValue>]| -> Vec<String> {
        list.iter()
            .map(|value| text[value.span()].to_owned())
            .collect()
    };
    let help = "for example [0.04, 0.06] or { from = 0.04, to = 0.06, points = 3 }";
    let table = match value.get_ref() {
        DeValue::Array(values) if !values.is_empty() => return Some(axis(list(values))),
        DeValue::Table(table) => table,
        _ => return fail("must be a list of values or a range", help, value.span()),
    };
    if let Some((wrong, _)) = table
        .iter()
        .find(|(name, _)| !OF_AXIS.contains(&&name.get_ref()[..]))
    {
        let rule = format!("unknown key {}", wrong.get_ref());
        return fail(
            &rule,
            &format!("there are {}", OF_AXIS.join(", ")),
            wrong.span(),
        );
    }
    if let Some(values) = table.get("values") {
        return match values.get_ref().as_array() {
            Some(values) if !values.is_empty() && table.len() == 1 => Some(axis(list(values))),
            _ => fail("values must be a list, alone", help, values.span()),
        };
    }
    let of = |name: &str| {
        table
            .get(name)
            .and_then(|value| number(&text[value.span()]))
    };
    let (Some(from), Some(to), Some(points)) = (of("from"), of("to"), of("points")) else {
        return fail(
            "a range needs the numbers from, to and points",
            help,
            value.span(),
        );
    };
    if points.fract() != 0.0 || !(1.0..=LARGEST as f64).contains(&points) {
        let rule = format!("points must be a whole number from 1 to {LARGEST}");
        return fail(&rule, "", value.span());
    }
    let scale = table.get("scale").map(|scale| scale.get_ref().as_str());
    let is_logarithmic = match scale {
        None | Some(Some("linear")) => false,
        Some(Some("log")) if from > 0.0 && to > 0.0 => true,
        Some(Some("log")) => return fail("a logarithmic range must be positive", "", value.span()),
        _ => return fail("scale must be \"linear\" or \"log\"", "", value.span()),
    };
    let is_whole = |name: &str| {
        matches!(
            table.get(name).map(Spanned::get_ref),
            Some(DeValue::Integer(_))
        )
    };
    let are_whole = is_whole("from") && is_whole("to");
    Some(axis(range(
        [from, to],
        points as usize,
        is_logarithmic,
        are_whole,
    )))
}

/// Reads a design: a CSV file whose header names the axes, with a row for each point.
fn design(
    file: &Spanned<DeValue>,
    path: &Path,
    problems: &mut Vec<Problem>,
) -> Option<(Vec<Axis>, Vec<Vec<String>>)> {
    let mut fail = |rule: String| {
        problems.push(problem("design", rule, "", file.span()));
        None
    };
    let Some(name) = file.get_ref().as_str() else {
        return fail("must be the path of a CSV file, relative to the study file".into());
    };
    let csv = path.parent().unwrap_or_else(|| "".as_ref()).join(name);
    let mut reader = match csv::Reader::from_path(&csv) {
        Ok(reader) => reader,
        Err(error) => return fail(format!("{}: {error}", csv.display())),
    };
    let header = match reader.headers() {
        Ok(header) if !header.is_empty() => header.clone(),
        _ => {
            return fail(format!(
                "{}: has no header with keys of the case",
                csv.display()
            ));
        }
    };
    let mut rows: Vec<Vec<String>> = vec![];
    for record in reader.records() {
        match record {
            Ok(record) => rows.push(record.iter().map(as_toml).collect()),
            Err(error) => return fail(format!("{}: {error}", csv.display())),
        }
        if rows.len() > LARGEST {
            return fail(format!("{}: more than {LARGEST} points", csv.display()));
        }
    }
    let axes = header.iter().enumerate().map(|(i, name)| {
        let mut values: Vec<String> = rows.iter().map(|row| row[i].clone()).collect();
        values.sort();
        values.dedup();
        Axis {
            name: name.trim().to_owned(),
            key: name.trim().to_owned(),
            values,
            span: file.span(),
        }
    });
    Some((axes.collect(), rows))
}

/// Writes a cell of a design as TOML: as it is if it is a value, and else as a text.
fn as_toml(cell: &str) -> String {
    let cell = cell.trim();
    match DeValue::parse(cell) {
        Ok(_) => cell.to_owned(),
        Err(_) => format!("{cell:?}"),
    }
}

/// Reads the request to refine boundaries.
fn refinement(
    table: &DeTable,
    axes: &[Axis],
    has_design: bool,
    problems: &mut Vec<Problem>,
) -> Option<Refinement> {
    unknown(table, "refine", &["of", "until"], problems);
    let place = |name: &str| table.get(name).map_or(0..0, |value| value.span());
    let names = Measure::ALL.map(|(name, _)| name).join(", ");
    let of = table.get("of").and_then(|of| of.get_ref().as_str());
    let measure = Measure::ALL.into_iter().find(|(name, _)| Some(*name) == of);
    let Some((_, of)) = measure else {
        let rule = format!("of must be one of {names}");
        problems.push(problem("refine.of", rule, "", place("of")));
        return None;
    };
    let help = "for example until = { \"tube.thickness\" = 0.001 }";
    let tolerances = table
        .get("until")
        .and_then(|until| until.get_ref().as_table());
    let Some(tolerances) = tolerances.filter(|table| !table.is_empty()) else {
        let rule = "until must give a tolerance for each axis that is refined";
        problems.push(problem("refine.until", rule, help, place("until")));
        return None;
    };
    if has_design {
        let rule = "a design has no neighbours to refine between; give axes";
        problems.push(problem("refine", rule, "", place("of")));
        return None;
    }
    let mut until = vec![];
    for (name, value) in tolerances {
        let key = format!("refine.until.\"{}\"", name.get_ref());
        let mut fail = |rule: &str| problems.push(problem(&key, rule, "", name.span()));
        let Some(axis) = axes.iter().position(|axis| axis.name == name.get_ref()[..]) else {
            fail("is not an axis of the study");
            continue;
        };
        let tolerance = match value.get_ref() {
            DeValue::Float(x) => number(x.as_str()),
            DeValue::Integer(x) => number(x.as_str()),
            _ => None,
        };
        match (axes[axis].numbers(), tolerance) {
            (None, _) => fail("only an axis of numbers can be refined"),
            (Some(numbers), _) if !is_monotonic(&numbers) => {
                fail("only an axis whose values rise or fall can be refined");
            }
            (_, Some(tolerance)) if tolerance > 0.0 => until.push((axis, tolerance)),
            _ => fail("must be a positive number"),
        }
    }
    Some(Refinement { of, until })
}

fn is_monotonic(numbers: &[f64]) -> bool {
    let rises = |sign: f64| {
        numbers
            .windows(2)
            .all(|pair| sign * (pair[1] - pair[0]) > 0.0)
    };
    rises(1.0) || rises(-1.0)
}

/// Reads which states the runs keep.
fn keep(table: &DeTable, problems: &mut Vec<Problem>) -> Keep {
    unknown(table, "keep", &["states"], problems);
    let Some(states) = table.get("states") else {
        return Keep::Last;
    };
    match states.get_ref().as_str() {
        Some("last") => Keep::Last,
        Some("all") => Keep::All,
        _ => {
            let rule = "must be \"last\" (of every stage) or \"all\" (those of the base case)";
            problems.push(problem("keep.states", rule, "", states.span()));
            Keep::Last
        }
    }
}
