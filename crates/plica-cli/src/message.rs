//! Problems of a case, shown in its text.

use crate::console;
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use plica::case::{CaseError, Problem};
use std::path::Path;

/// All problems of a case, and their number.
pub fn render(path: &Path, text: &str, error: &CaseError) -> String {
    let renderer = match console::is_coloured() {
        true => Renderer::styled(),
        false => Renderer::plain(),
    };
    let path = path.display().to_string();
    let mut lines: Vec<String> = Vec::new();
    for problem in &error.problems {
        lines.push(show(&renderer, &path, text, problem));
        lines.push(String::new());
    }
    let count = match error.problems.len() {
        1 => "one problem".to_owned(),
        n => format!("{n} problems"),
    };
    lines.push(format!("{path}: {count}"));
    lines.join("\n")
}

fn show(renderer: &Renderer, path: &str, text: &str, problem: &Problem) -> String {
    let title = match problem.key.as_str() {
        "" => problem.rule.clone(),
        key => format!("{key}: {}", problem.rule),
    };
    // A problem of the whole file is shown at its end.
    let span = problem.span.clone().unwrap_or(text.len()..text.len());
    let snippet = Snippet::source(text)
        .path(path)
        .annotation(AnnotationKind::Primary.span(span));
    let mut group = Level::ERROR.primary_title(title).element(snippet);
    if let Some(cure) = &problem.cure {
        group = group.element(Level::HELP.message(cure.as_str()));
    }
    renderer.render(&[group])
}
