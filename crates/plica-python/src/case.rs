//! Cases: their problems, changes of their keys, and what they describe.

use plica::case::{self, CaseError, EditError, Input, InputFile};
use plica::study::Plan;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::path::Path;

/// A problem of a case: key, value, rule, help, and line and column from 1.
type Problem = (String, Option<String>, String, Option<String>, usize, usize);

/// Reads a case whose files lie in a folder.
pub fn read(text: &str, name: &str, folder: &Path) -> Result<Plan, CaseError> {
    case::read_with(text, name, &|file: InputFile<'_>| {
        Input::read(file, &folder.join(file.path()))
    })
}

/// Reads a case that has been checked.
pub fn read_checked(text: &str, name: &str, folder: &Path) -> PyResult<Plan> {
    read(text, name, folder).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Returns the problems of a case; empty if it can be run.
#[pyfunction]
pub fn problems(
    py: Python<'_>,
    text: &str,
    name: &str,
    folder: std::path::PathBuf,
) -> Vec<Problem> {
    let Err(error) = py.detach(|| read(text, name, &folder)) else {
        return vec![];
    };
    let place = |at: usize| {
        let before = text.get(..at).unwrap_or(text);
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        (line, column)
    };
    let describe = |problem: case::Problem| {
        let (line, column) = place(problem.span.start);
        (
            problem.key,
            problem.value,
            problem.rule,
            problem.help,
            line,
            column,
        )
    };
    error.problems.into_iter().map(describe).collect()
}

/// Returns the text of a case with keys changed; values are written as in TOML.
#[pyfunction]
pub fn edited(text: &str, changes: Vec<(String, String)>) -> PyResult<String> {
    let edited = case::edited(text, &changes);
    edited.map_err(|error: EditError| PyValueError::new_err(error.to_string()))
}

/// Returns the title, the advice, and the number of unknowns and states of a case that has been checked.
#[pyfunction]
pub fn about(
    text: &str,
    name: &str,
    folder: std::path::PathBuf,
) -> PyResult<(String, Vec<String>, usize, usize)> {
    let plan = read_checked(text, name, &folder)?;
    let unknowns = plan.layout().unknowns();
    let states = 1 + plan.steps();
    Ok((plan.title.clone(), case::advice(&plan), unknowns, states))
}

/// Returns the JSON schema of cases.
#[pyfunction]
pub fn schema() -> String {
    case::schema().to_string()
}
