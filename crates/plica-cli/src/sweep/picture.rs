//! `plica sweep picture`: the outcomes of a study over two of its axes.

use super::{Study, StudyArguments, write_named};
use crate::console;
use crate::failure::Failure;
use clap::Args;
use plica::sweep::{Axis, Measure, Outcome, Point};
use plica_view::draw::{Chart, Curve};
use std::path::PathBuf;

/// Arguments of `plica sweep picture`.
#[derive(Args, Debug)]
pub struct PictureArguments {
    /// Axis to draw along [default: the first axis of several values]
    #[arg(short, value_name = "AXIS")]
    x: Option<String>,
    /// Axis to draw upwards [default: the second axis of several values]
    #[arg(short, value_name = "AXIS")]
    y: Option<String>,
    /// Draw only the points with a value of another axis, as AXIS=VALUE; may be repeated
    #[arg(long = "where", value_name = "AXIS=VALUE", value_parser = choice)]
    choices: Vec<(String, String)>,
    /// Colour points by shape, side, invaginates, unstable or status
    #[arg(long, value_name = "OUTCOME", default_value = "shape")]
    of: String,
    /// File to write to, .png or .svg [default: picture.png in the folder of the study]
    #[arg(long, value_name = "FILE")]
    file: Option<PathBuf>,
    /// The study
    #[command(flatten)]
    study: StudyArguments,
}

fn choice(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("give AXIS=VALUE")?;
    Ok((name.trim().to_owned(), value.trim().to_owned()))
}

/// Draws the outcomes.
pub fn picture(arguments: &PictureArguments) -> Result<(), Failure> {
    let study = Study::open(&arguments.study)?;
    let extension = arguments.file.as_ref().and_then(|file| file.extension());
    let has_extension =
        |wanted: &str| extension.is_some_and(|own| own.eq_ignore_ascii_case(wanted));
    let is_svg = has_extension("svg");
    if let Some(file) = arguments
        .file
        .as_ref()
        .filter(|_| !is_svg && !has_extension("png"))
    {
        let what = format!("--file {}: must end in .png or .svg", file.display());
        return Err(Failure::Usage(what));
    }
    let axes = study.sweep.axes();
    let measure = Measure::ALL
        .into_iter()
        .find(|(name, _)| *name == arguments.of);
    let Some((_, measure)) = measure else {
        let names = Measure::ALL.map(|(name, _)| name).join(", ");
        return Err(Failure::Usage(format!(
            "--of {}: there are {names}",
            arguments.of
        )));
    };
    let [x, y] = two_axes(axes, arguments)?;
    let mut chosen = vec![];
    for (name, value) in &arguments.choices {
        chosen.push((place(axes, name)?, value.as_str()));
    }
    let rows = study.rows();
    let is_chosen = |point: &Point| {
        let fits = |&(axis, value): &(usize, &str)| same(&point.values[axis], value);
        chosen.iter().all(fits)
    };
    let points = rows.iter().filter(|row| is_chosen(&row.0));
    let points: Vec<(f64, f64, String)> = points
        .filter_map(|(point, _, outcome)| {
            let at = [x, y].map(|axis| point.values[axis].replace('_', "").parse().ok());
            Some((at[0]?, at[1]?, category(measure, outcome)))
        })
        .collect();
    let chart = Chart {
        x_label: plain(&axes[x].name),
        y_label: plain(&axes[y].name),
        curves: curves(&points),
        proportion: 0.8,
        width_pt: 360.0,
        ..Chart::default()
    };
    let file = arguments.file.clone();
    let drawn = match is_svg {
        true => chart.svg().map(String::into_bytes),
        false => chart.png(1500),
    };
    let bytes = drawn.map_err(|error| Failure::Usage(format!("no picture: {error}")))?;
    let path = match file {
        Some(file) => {
            write_named(&file, &bytes)?;
            file
        }
        None => study.folder.write("picture.png", &bytes)?,
    };
    console::print(&format!("written to {}\n", path.display()))
}

/// Returns the places of the two axes of the picture.
fn two_axes(axes: &[Axis], arguments: &PictureArguments) -> Result<[usize; 2], Failure> {
    let named = [&arguments.x, &arguments.y];
    let mut places = vec![];
    for name in named.into_iter().flatten() {
        places.push(place(axes, name)?);
    }
    let several =
        (0..axes.len()).filter(|&i| axes[i].values.len() > 1 && axes[i].numbers().is_some());
    let others: Vec<usize> = several.filter(|i| !places.contains(i)).collect();
    let mut others = others.into_iter();
    let mut next = |name: &Option<String>| match name {
        Some(_) => Some(places.remove(0)),
        None => others.next(),
    };
    let [x, y] = named.map(&mut next);
    match (x, y) {
        (Some(x), Some(y)) if x != y => Ok([x, y]),
        _ => Err(Failure::Usage(
            "a picture needs two axes with several numbers; `plica plot` draws curves of single runs".into(),
        )),
    }
}

fn place(axes: &[Axis], name: &str) -> Result<usize, Failure> {
    let found = axes.iter().position(|axis| axis.name == name);
    found.ok_or_else(|| {
        let names: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
        Failure::Usage(format!(
            "{name} is not an axis; there are {}",
            names.join(", ")
        ))
    })
}

/// Returns whether two values are the same text or number.
fn same(a: &str, b: &str) -> bool {
    let number = |text: &str| text.replace('_', "").parse::<f64>().ok();
    a.trim_matches('"') == b.trim_matches('"') || (number(a).is_some() && number(a) == number(b))
}

/// Returns the label of an outcome: its measure, or its status if it has none.
fn category(measure: Measure, outcome: &Outcome) -> String {
    measure
        .of(outcome)
        .unwrap_or_else(|| outcome.status.to_string())
}

/// Returns a curve of dots for each label.
fn curves(points: &[(f64, f64, String)]) -> Vec<Curve> {
    let mut labels: Vec<&String> = points.iter().map(|(_, _, label)| label).collect();
    labels.sort();
    labels.dedup();
    let dots = |label: &String| {
        let own = points.iter().filter(|point| point.2 == *label);
        // A point that is not finite interrupts the line between two dots.
        own.flat_map(|(x, y, _)| [(*x, *y), (f64::NAN, f64::NAN)])
            .collect()
    };
    let curve = |(colour, label): (usize, &&String)| Curve {
        label: plain(label),
        points: dots(label),
        colour: colour + 1,
        dots: true,
        ..Curve::default()
    };
    labels.iter().enumerate().map(curve).collect()
}

/// Returns a text without the marks of italics, as a label of a chart.
fn plain(text: &str) -> String {
    text.replace(['*', '{', '}'], "").replace('_', " ")
}
