//! `plica table`.

use crate::args::TableArguments;
use crate::console;
use crate::existing_run::ExistingRun;
use crate::failure::Failure;
use plica::study::{Findings, Scale};
use serde_json::{Value, json};

/// Prints the findings of runs, as tables or as JSON.
pub fn table(arguments: &TableArguments) -> Result<(), Failure> {
    let several = arguments.runs.len() > 1;
    let mut found: Vec<Value> = vec![];
    for path in &arguments.runs {
        let run = ExistingRun::open(path)?;
        let scale = Scale::of(run.plan.units.as_ref());
        let findings = Findings::of(&run.rows, &scale, run.plan.symmetry);
        let verdict = run.directory.verdict();
        if arguments.json {
            found.push(json!({
                "run": path,
                "title": run.plan.title,
                "verdict": verdict,
                "unphysical_states": findings.unphysical_states(),
                "findings": findings,
            }));
            continue;
        }
        let mut table = String::new();
        if several {
            table += &format!("{}: {}\n", path.display(), run.plan.title);
        }
        for (name, value) in findings.lines() {
            table += &format!("  {name:<22} {value}\n");
        }
        table += &format!("  {:<22} {verdict}\n", "verdict");
        console::print(&table)?;
    }
    if arguments.json {
        console::print(&format!("{:#}\n", Value::Array(found)))?;
    }
    Ok(())
}
