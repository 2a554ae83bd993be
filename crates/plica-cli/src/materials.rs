//! `plica materials`.

use crate::args::CaseArguments;
use crate::existing_run::check_out;
use crate::failure::Failure;
use crate::law_text::{law_name, number, parameters};
use crate::render::failure;
use crate::{case_file, console};
use clap::{Args, Subcommand};
use plica::case::{self, LibraryMaterial};
use plica::fit::{Fit, FittedLaw, Measurements, ParameterUnit, fit};
use plica::homogeneous::{Volume, scaled};
use plica::run_directory::write_file;
use plica_view::law_chart::{LawChart, NamedLaw, law_chart, law_table};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Arguments of `plica materials`.
#[derive(Args, Debug)]
pub struct MaterialsArguments {
    /// A library of your own, instead of that of Plica
    #[arg(long, value_name = "FILE", global = true)]
    file: Option<PathBuf>,
    /// The action [default: list the materials]
    #[command(subcommand)]
    command: Option<MaterialsCommand>,
}

/// The commands of `plica materials`.
#[derive(Debug, Subcommand)]
enum MaterialsCommand {
    /// Print a material: its source, its range, and the law as written in a case
    Show {
        /// Name of the material
        #[arg(value_name = "NAME")]
        name: String,
    },
    /// Draw the curves of a material, or of the layers of a case, in tension or inflation
    Plot(PlotArguments),
    /// Fit a law to tension tests
    Fit(FitArguments),
}

/// Arguments of `plica materials plot`.
#[derive(Args, Debug)]
struct PlotArguments {
    /// Name of a material, or a case file
    #[arg(value_name = "NAME|CASE")]
    what: String,
    /// File to write to, ending in .svg or .png
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Write the numbers of all curves to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draw the pressure of a thin tube of constant length instead: p R/H over the stretch around
    #[arg(long)]
    inflation: bool,
    /// Keep the volume constant, instead of the volumetric energy of the law
    #[arg(long)]
    incompressible: bool,
    /// Smallest stretch
    #[arg(long, value_name = "X", default_value = "0.8", value_parser = stretch)]
    from: f64,
    /// Largest stretch; a curve ends before where its stress rises steeply
    #[arg(long, value_name = "X", default_value = "1.6", value_parser = stretch)]
    to: f64,
    /// Width of the PNG in pixels, from 600 to 8000
    #[arg(long, value_name = "PX", default_value = "1800", value_parser = clap::value_parser!(u16).range(600..=8000))]
    width: u16,
}

/// Arguments of `plica materials fit`.
#[derive(Args, Debug)]
struct FitArguments {
    /// Table of tests with the columns stretch_along, stretch_around and nominal_stress_along_kPa, nominal_stress_around_kPa
    /// (or cauchy_…; Pa, kPa, MPa or no unit). An empty stretch is a direction without stress
    #[arg(value_name = "DATA.csv")]
    data: PathBuf,
    /// Law to fit; hgo and goh are a neo-Hookean matrix with a pair of families of fibres
    #[arg(long, value_name = "LAW", value_parser = law_names())]
    law: String,
}

fn law_names() -> clap::builder::PossibleValuesParser {
    FittedLaw::ALL.map(FittedLaw::name).into()
}

fn stretch(text: &str) -> Result<f64, String> {
    let x: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    match (0.1..=10.0).contains(&x) {
        true => Ok(x),
        false => Err("must be from 0.1 to 10".into()),
    }
}

/// Lists, shows, draws or fits materials.
pub fn materials(arguments: &MaterialsArguments) -> Result<(), Failure> {
    let file = arguments.file.as_deref();
    match &arguments.command {
        None => list(&library(file)?),
        Some(MaterialsCommand::Show { name }) => show(file, &library(file)?, name),
        Some(MaterialsCommand::Plot(arguments)) => plot(&library(file)?, arguments),
        Some(MaterialsCommand::Fit(arguments)) => fit_law(arguments),
    }
}

/// Reads a library.
fn library(file: Option<&Path>) -> Result<Vec<LibraryMaterial>, Failure> {
    let Some(path) = file else {
        return Ok(case::library());
    };
    let text = read(path)?;
    case::materials(&text).map_err(|error| Failure::Case {
        path: path.to_owned(),
        text,
        error,
    })
}

fn read(path: &Path) -> Result<String, Failure> {
    let text = std::fs::read_to_string(path);
    text.map_err(|error| Failure::Files(format!("{}: {error}", path.display())))
}

fn list(library: &[LibraryMaterial]) -> Result<(), Failure> {
    let mut rows = vec![["name", "tissue", "species", "law", "source"].map(String::from)];
    for material in library {
        let or_none = |text: &Option<String>| text.clone().unwrap_or_else(|| "–".into());
        rows.push([
            material.name.clone(),
            or_none(&material.tissue),
            or_none(&material.species),
            law_name(&material.material),
            match &material.doi {
                Some(doi) => format!("doi:{doi}"),
                None => or_none(&material.source),
            },
        ]);
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths = [0, 1, 2, 3, 4].map(|column| width(column).unwrap_or(0));
    let mut text = String::new();
    for row in &rows {
        let cells = row.iter().zip(widths);
        let cells: Vec<String> = cells
            .map(|(cell, width)| format!("{cell:<width$}"))
            .collect();
        text += &(cells.join("  ").trim_end().to_owned() + "\n");
    }
    console::print(&text)
}

fn show(file: Option<&Path>, library: &[LibraryMaterial], name: &str) -> Result<(), Failure> {
    let material = find(library, name)?;
    let mut text = format!("{name}\n");
    let law = law_name(&material.material);
    let unit = material.unit.map(|unit| unit.to_string());
    for (title, value) in [
        ("tissue", &material.tissue),
        ("species", &material.species),
        ("law", &Some(law)),
        ("source", &material.source),
        ("doi", &material.doi),
        ("valid", &material.valid),
        ("note", &material.note),
        ("stresses", &unit),
    ] {
        if let Some(value) = value {
            let _ = writeln!(text, "  {title:<9} {value}");
        }
    }
    let _ = writeln!(text, "\n{}", parameters(&material.material));
    let _ = match file {
        None => writeln!(
            text,
            "In a case with units, or in one of its layers:\n\nmaterial.from = \"{name}\""
        ),
        Some(file) => writeln!(
            text,
            "In a case, or in one of its layers:\n\nmaterial = {{ from = \"{name}\", file = \"{}\" }}",
            file.display()
        ),
    };
    console::print(&text)
}

fn find<'a>(library: &'a [LibraryMaterial], name: &str) -> Result<&'a LibraryMaterial, Failure> {
    let found = library.iter().find(|material| material.name == name);
    found.ok_or_else(|| {
        let names: Vec<&str> = library.iter().map(|m| m.name.as_str()).collect();
        let names = names.join(", ");
        Failure::Usage(format!(
            "{name}: no material has this name; the materials are {names}"
        ))
    })
}

fn plot(library: &[LibraryMaterial], arguments: &PlotArguments) -> Result<(), Failure> {
    if arguments.out.is_none() && arguments.csv.is_none() {
        return Err(Failure::Usage("name a file with --out or --csv".into()));
    }
    if arguments.from >= 1.0 || arguments.to <= 1.0 {
        let what = "--from must be below 1, and --to above it: 1 is the length at rest";
        return Err(Failure::Usage(what.into()));
    }
    if let Some(out) = &arguments.out {
        check_out(out, &["svg", "png"])?;
    }
    let (laws, unit) = laws(library, &arguments.what)?;
    let range = [arguments.from, arguments.to];
    let volume = match arguments.incompressible {
        true => Volume::Constant,
        false => Volume::Free,
    };
    if let Some(path) = &arguments.csv {
        let rows = law_table(&laws, range, volume, &unit);
        let lines: Vec<String> = rows.iter().map(|row| row.join(",")).collect();
        write(path, (lines.join("\n") + "\n").as_bytes())?;
    }
    let Some(out) = &arguments.out else {
        return Ok(());
    };
    let what = match arguments.inflation {
        true => LawChart::Inflation,
        false => LawChart::Tension,
    };
    let chart = law_chart(what, &laws, range, volume, &unit);
    let is_svg = out
        .extension()
        .is_some_and(|x| x.eq_ignore_ascii_case("svg"));
    match is_svg {
        true => write(out, chart.svg().map_err(failure)?.as_bytes()),
        false => write(
            out,
            &chart.png(usize::from(arguments.width)).map_err(failure)?,
        ),
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let written = write_file(path, bytes);
    written.map_err(|error| Failure::Files(format!("{}: {error}", path.display())))?;
    console::message(&format!("written: {}", path.display()));
    Ok(())
}

/// Returns the law of a material, or those of the layers of a case, and the unit of their stresses.
fn laws(library: &[LibraryMaterial], what: &str) -> Result<(Vec<NamedLaw>, String), Failure> {
    let path = Path::new(what);
    if !path.is_file() {
        let material = find(library, what)?;
        let law = NamedLaw {
            name: String::new(),
            material: material.material.clone(),
        };
        let unit = material.unit.map_or("E".into(), |unit| unit.to_string());
        return Ok((vec![law], unit));
    }
    let arguments = CaseArguments {
        file: path.to_owned(),
        set: vec![],
        within: None,
    };
    let (_, plan) = case_file::open(&arguments)?;
    let (unit, modulus) = match &plan.units {
        Some(units) => (units.stress.to_string(), units.youngs_modulus),
        None => ("E".into(), 1.0),
    };
    let several = plan.tube.layers.len() > 1;
    let mut laws = vec![];
    for layer in &plan.tube.layers {
        laws.push(NamedLaw {
            name: if several {
                layer.name.clone()
            } else {
                String::new()
            },
            material: scaled(&layer.material, modulus),
        });
    }
    Ok((laws, unit))
}

fn fit_law(arguments: &FitArguments) -> Result<(), Failure> {
    let text = read(&arguments.data)?;
    let about = |error: plica::fit::FitError| {
        Failure::Usage(format!("{}: {error}", arguments.data.display()))
    };
    let table = Measurements::read(&text).map_err(about)?;
    let named = FittedLaw::ALL
        .into_iter()
        .find(|law| law.name() == arguments.law);
    let Some(law) = named else {
        return Err(Failure::Usage(format!(
            "{}: no law that can be fitted",
            arguments.law
        )));
    };
    let found = fit(law, &table.all).map_err(about)?;
    let unit = table.unit.map_or(String::new(), |unit| unit.to_string());
    console::print(&report(law, &found, &unit))
}

fn report(law: FittedLaw, found: &Fit, unit: &str) -> String {
    let mut text = format!("{} fitted to {} stresses\n\n", law.name(), found.stresses);
    for parameter in &found.parameters {
        let unit = match parameter.unit {
            ParameterUnit::Stress => unit,
            ParameterUnit::Degrees => "degrees",
            ParameterUnit::None => "",
        };
        let error = match parameter.standard_error {
            Some(error) => format!("± {}", number(error)),
            None => "not determined by these tests".into(),
        };
        let value = number(parameter.value);
        let line = format!("  {:<14} {value:>12} {error:<14} {unit}", parameter.name);
        text += &(line.trim_end().to_owned() + "\n");
    }
    let deviation = format!("{} {unit}", number(found.deviation));
    let _ = writeln!(text, "\n  R²             {:.6}", found.determination);
    let _ = writeln!(text, "  rms deviation  {}", deviation.trim_end());
    text += "\nValues ± standard errors. The volume is constant in the fit; bulk is a hundred times the shear modulus.\n\n";
    text + &parameters(&found.material)
}
