//! Problems of a case, shown in its source text.

use crate::console;
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use plica::case::{CaseError, Problem};
use std::ops::Range;
use std::path::Path;

/// Largest number of problems shown.
const MOST: usize = 200;

/// Formats the problems of a case and their number.
pub fn render(path: &Path, text: &str, error: &CaseError) -> String {
    let renderer = match console::is_coloured() {
        true => Renderer::styled(),
        false => Renderer::plain(),
    };
    let path = path.display().to_string();
    let starts: Vec<usize> = text.match_indices('\n').map(|(at, _)| at + 1).collect();
    let mut lines: Vec<String> = Vec::new();
    for problem in error.problems.iter().take(MOST) {
        let span = problem.span.clone();
        // Show only the lines of the problem, with their numbers.
        let before = starts.partition_point(|start| *start <= span.start);
        let from = before.checked_sub(1).map_or(0, |line| starts[line]);
        let after = starts.partition_point(|start| *start < span.end);
        let to = starts.get(after).copied().unwrap_or(text.len());
        let excerpt = Excerpt {
            text: &text[from..to],
            line: before + 1,
            span: span.start - from..span.end - from,
        };
        lines.push(render_problem(&renderer, &path, excerpt, problem));
        lines.push(String::new());
    }
    let count = match error.problems.len() {
        1 => "one problem".to_owned(),
        n if n > MOST => format!("{n} problems, of which the first {MOST} are shown"),
        n => format!("{n} problems"),
    };
    lines.push(format!("{path}: {count}"));
    lines.join("\n")
}

/// Lines of a text, the number of the first, and the bytes to mark in them.
struct Excerpt<'a> {
    text: &'a str,
    line: usize,
    span: Range<usize>,
}

fn render_problem(
    renderer: &Renderer,
    path: &str,
    excerpt: Excerpt<'_>,
    problem: &Problem,
) -> String {
    let title = match problem.key.as_str() {
        "" => problem.rule.clone(),
        key => format!("{key}: {}", problem.rule),
    };
    let snippet = Snippet::source(excerpt.text)
        .line_start(excerpt.line)
        .path(path)
        .annotation(AnnotationKind::Primary.span(excerpt.span));
    let mut group = Level::ERROR.primary_title(title).element(snippet);
    if let Some(help) = &problem.help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    renderer.render(&[group])
}
