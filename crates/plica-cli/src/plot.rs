//! `plica plot`.

use crate::args::PlotArguments;
use crate::existing_run::{ExistingRun, check_out};
use crate::failure::Failure;
use crate::render::failure;
use plica::study::Scale;
use plica_view::draw::Chart;
use plica_view::report::{self, Column, Shown};

/// Name of the plot of wall profiles.
const WALLS: &str = "walls";

/// Largest number of states with distinct colours.
const MOST: usize = 6;

/// Plots columns of the history, or wall profiles, of a run.
pub fn plot(arguments: &PlotArguments) -> Result<(), Failure> {
    let ending = match &arguments.out {
        None => None,
        Some(_) if arguments.what.len() > 1 => {
            return Err(Failure::Usage(
                "--out names one file for several plots; plot one at a time, or omit --out".into(),
            ));
        }
        Some(path) => {
            check_out(path, &["svg", "png"])?;
            path.extension()
                .map(|ending| ending.to_string_lossy().to_ascii_lowercase())
        }
    };
    let walls = arguments.what.iter().any(|what| what == WALLS);
    let columns = arguments.what.iter().any(|what| what != WALLS);
    if arguments.against.is_some() && !columns {
        return Err(Failure::Usage(
            "--against applies to columns, not to walls".into(),
        ));
    }
    if !arguments.state.is_empty() && !walls {
        return Err(Failure::Usage(
            "--state applies to walls, not to columns".into(),
        ));
    }
    let run = ExistingRun::open(&arguments.run)?;
    run.check_saved(&arguments.state)?;
    let charts: Result<Vec<(String, Chart)>, Failure> = (arguments.what.iter())
        .map(|what| chart(&run, arguments, what))
        .collect();
    for (name, chart) in charts? {
        if ending.as_deref() != Some("png") {
            let svg = chart.svg().map_err(failure)?;
            run.write_picture(
                arguments.out.as_deref(),
                &format!("{name}.svg"),
                svg.as_bytes(),
            )?;
        }
        if ending.as_deref() != Some("svg") {
            let png = chart.png(usize::from(arguments.width)).map_err(failure)?;
            run.write_picture(arguments.out.as_deref(), &format!("{name}.png"), &png)?;
        }
    }
    Ok(())
}

/// Returns the name and the chart of a plot.
fn chart(
    run: &ExistingRun,
    arguments: &PlotArguments,
    what: &str,
) -> Result<(String, Chart), Failure> {
    if what == WALLS {
        if arguments.state.len() > MOST {
            return Err(Failure::Usage(format!(
                "--state: {} states in one plot are too many to distinguish; {MOST} at most",
                arguments.state.len()
            )));
        }
        let numbers = match arguments.state.as_slice() {
            [] => vec![run.last()?],
            states => states.to_vec(),
        };
        let states: Result<Vec<Shown>, Failure> = numbers.iter().map(|&n| run.state(n)).collect();
        let names: Vec<String> = numbers.iter().map(|n| format!("{n:04}")).collect();
        let name = format!("walls-state-{}", names.join("-"));
        return Ok((name, report::plot_walls(&run.plan, &states?)));
    }
    let against = arguments.against.as_deref();
    let chart = report::plot(&run.plan, &run.rows, what, against);
    let chart = chart.ok_or_else(|| {
        let columns = Column::all(&run.rows, &Scale::of(run.plan.units.as_ref()));
        let names: Vec<String> = columns.into_iter().map(|column| column.name).collect();
        let exists = |name: &str| names.iter().any(|n| n == name);
        let unknown = against.filter(|against| exists(what) && !exists(against));
        Failure::Usage(format!(
            "{}: not a column of this run that can be plotted; choose one of {}{}",
            unknown.unwrap_or(what),
            if unknown.is_none() { "walls, " } else { "" },
            names.join(", ")
        ))
    })?;
    let name = match against {
        None => format!("{what}-path"),
        Some(against) => format!("{what}-against-{against}-path"),
    };
    Ok((name, chart))
}
