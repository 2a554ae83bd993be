//! `plica sweep check`.

use super::Study;
use crate::console;
use crate::failure::Failure;
use plica::run_directory::DiskUse;
use plica::study::forecast;
use rayon::prelude::*;

/// Points that are not valid of which the reasons are printed.
const LISTED: usize = 10;

/// Checks all points of a study, and estimates time, memory and disk from some of them.
pub fn check(study: &Study) -> Result<(), Failure> {
    let sweep = &study.sweep;
    let size = sweep.size();
    let mut text = format!(
        "{}: {size} points of {}\n\n",
        study.file.display(),
        sweep.base().display()
    );
    for axis in sweep.axes() {
        let values = match &axis.values[..] {
            [first, .., last] if axis.values.len() > 6 => {
                format!("{} values from {first} to {last}", axis.values.len())
            }
            values => values.join(", "),
        };
        text += &format!("  {:<44} {values}\n", axis.name);
    }
    let unsound = |i: usize| {
        let point = sweep.point(i);
        let error = sweep.case(&point).err()?;
        Some((i, study.describe(&point), error.to_string()))
    };
    let unsound: Vec<_> = (0..size).into_par_iter().filter_map(unsound).collect();
    let sound = size - unsound.len();
    if sound > 0 {
        text += &cost(study, sound);
    }
    if sweep.is_refined() {
        text += "  the refinement adds points where neighbours differ\n";
    }
    console::print(&text)?;
    if unsound.is_empty() {
        return Ok(());
    }
    console::message(&format!("\n{} points are not valid cases:", unsound.len()));
    for (i, name, error) in unsound.iter().take(LISTED) {
        console::message(&format!("  point {i}, {name}: {error}"));
    }
    if unsound.len() > LISTED {
        console::message(&format!("  and {} more", unsound.len() - LISTED));
    }
    match sound {
        0 => Err(Failure::Usage(
            "no point of the study can be computed".into(),
        )),
        _ => Ok(()),
    }
}

/// Describes the cost of a study by that of its first, middle and last valid points.
fn cost(study: &Study, sound: usize) -> String {
    let samples = study.samples();
    let all: Vec<_> = samples
        .iter()
        .map(|case| (forecast(&case.plan), DiskUse::of(&case.plan).total()))
        .collect();
    let mean = |of: &dyn Fn(&(plica::study::Forecast, u64)) -> f64| {
        all.iter().map(of).sum::<f64>() / all.len().max(1) as f64
    };
    let hours = mean(&|(forecast, _)| forecast.seconds_estimate) * sound as f64 / 3600.0;
    let disk = mean(&|(_, disk)| *disk as f64) * sound as f64;
    let memory = all.iter().map(|(forecast, _)| forecast.memory_bytes).max();
    format!(
        "\n  {:<44} about {hours:.2} core-hours, more where tubes snap through\n  {:<44} about {:.0} MB a point\n  {:<44} about {:.0} MB\n",
        "time",
        "memory",
        memory.unwrap_or_default() as f64 / 1e6,
        "disk",
        (disk / 1e6).ceil()
    )
}
