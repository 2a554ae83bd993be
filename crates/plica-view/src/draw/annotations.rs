//! Legend, vertical lines and labelled markers of a chart.

use super::canvas::{Anchor, Canvas, Pen, Position};
use super::colour::line_colour;
use super::frame::{Frame, Interval};
use super::label::parse;
use super::text::{CAP_HEIGHT, HALF_CAP, ROW_HEIGHT, TEXT_SIZE, text_width};
use super::{Curve, Marker, VerticalLine};

/// Arranges the labelled curves in rows that fit the page, each with its offset from the start of the row.
pub(super) fn legend_rows(curves: &[Curve], width_pt: f64) -> Vec<Vec<(&Curve, f64)>> {
    let mut rows: Vec<Vec<(&Curve, f64)>> = Vec::new();
    let mut used = f64::INFINITY;
    for curve in curves.iter().filter(|c| !parse(&c.label).is_empty()) {
        let width = 22.0 + text_width(&curve.label, TEXT_SIZE) + 14.0;
        if used + width > width_pt - 50.0 {
            rows.push(Vec::new());
            used = 0.0;
        }
        if let Some(row) = rows.last_mut() {
            row.push((curve, used));
        }
        used += width;
    }
    rows
}

pub(super) fn draw_legend(
    canvas: &mut Canvas,
    frame: &Frame,
    rows: &[Vec<(&Curve, f64)>],
    below_title: bool,
) {
    let top = if below_title {
        10.0 + 1.3 * ROW_HEIGHT
    } else {
        10.0
    };
    for (number, row) in rows.iter().enumerate() {
        let middle = top + 1.1 * ROW_HEIGHT * number as f64;
        for (curve, offset) in row {
            let left = frame.left + offset;
            canvas.polyline(&[(left, middle), (left + 17.0, middle)], curve.pen());
            if curve.dots {
                canvas.disc((left + 8.5, middle), 1.7, line_colour(curve.colour), 0.0);
            }
            let baseline = middle + HALF_CAP;
            canvas.text((left + 22.0, baseline), &curve.label, Anchor::Start);
        }
    }
}

/// Assigns to each vertical line within `x` a row above the frame: the lowest in which its label overlaps no other.
pub(super) fn label_rows(
    lines: &[VerticalLine],
    x: Interval,
    width_pt: f64,
) -> Vec<(&VerticalLine, usize)> {
    let mut taken: Vec<(usize, f64, f64)> = Vec::new();
    let mut placed = Vec::new();
    for line in lines.iter().filter(|l| (x.0..=x.1).contains(&l.at)) {
        let half = text_width(&line.label, TEXT_SIZE) / 2.0 + 4.0;
        let at = (line.at - x.0) / (x.1 - x.0) * (width_pt - 60.0);
        let overlaps = |row: &usize| {
            taken
                .iter()
                .any(|&(r, a, b)| r == *row && a < at + half && at - half < b)
        };
        let row = (0..).find(|row| !overlaps(row)).unwrap_or(0);
        taken.push((row, at - half, at + half));
        placed.push((line, row));
    }
    placed
}

pub(super) fn draw_vertical_lines(
    canvas: &mut Canvas,
    frame: &Frame,
    lines: &[(&VerticalLine, usize)],
) {
    let pen = Pen {
        colour: [130; 3],
        width: 0.6,
        dash: (2.5, 2.0),
    };
    for (line, row) in lines {
        let (across, _) = frame.position((line.at, frame.y.0));
        let baseline = frame.top - ROW_HEIGHT * *row as f64;
        canvas.line((across, frame.bottom()), (across, frame.top), pen);
        // Extend the line up to its label, except across the labels of other lines.
        for below in 0..*row {
            let crosses = |(other, at): &(&VerticalLine, usize)| {
                let x = frame.position((other.at, 0.0)).0;
                let (middle, half) = label_span(canvas, &other.label, x);
                *at == below && (across - middle).abs() < half + 2.0
            };
            if !lines.iter().any(crosses) {
                let [start, end] = [below, below + 1].map(|r| frame.top - ROW_HEIGHT * r as f64);
                canvas.line((across, start), (across, end), pen);
            }
        }
        let (middle, _) = label_span(canvas, &line.label, across);
        canvas.text_with(
            (middle, baseline - 3.0),
            &line.label,
            TEXT_SIZE,
            Anchor::Middle,
            [90; 3],
        );
    }
}

pub(super) fn draw_markers(
    markers: &[Marker],
    curves: &[Curve],
    lines: &[VerticalLine],
    canvas: &mut Canvas,
    frame: &Frame,
) {
    let mut obstacles = obstacles(markers, curves, lines, frame);
    for marker in markers {
        let (x, y) = frame.position(marker.at);
        if !frame.contains((x, y)) {
            continue;
        }
        canvas.disc((x, y), 2.6, line_colour(marker.colour), 0.9);
        let width = text_width(&marker.label, TEXT_SIZE);
        let height = TEXT_SIZE * CAP_HEIGHT;
        // Candidates for the left end of the baseline: above, right, left, below, then the corners.
        let (near, right, before) = (x - width / 2.0, x + 6.0, x - 6.0 - width);
        let (over, level, under) = (y - 7.0, y + height / 2.0, y + 7.0 + height);
        let candidates = [
            (near, over),
            (right, level),
            (before, level),
            (near, under),
            (right, over),
            (before, over),
            (right, under),
            (before, under),
        ];
        let cost = |&(left, base): &Position| {
            let box_x = left - 2.0..=left + width + 2.0;
            let box_y = base - height - 2.0..=base + 3.0;
            let covered = obstacles
                .iter()
                .filter(|(a, b)| box_x.contains(a) && box_y.contains(b))
                .count();
            let inside =
                frame.contains((left, base)) && frame.contains((left + width, base - height));
            covered + if inside { 0 } else { 1000 }
        };
        let best = candidates.into_iter().min_by_key(cost);
        let (left, base) = best.unwrap_or(candidates[0]);
        canvas.text((left, base), &marker.label, Anchor::Start);
        for i in 0..=(width as usize) {
            obstacles.push((left + i as f64, base - height / 2.0));
        }
    }
}

/// Returns positions about two points apart along everything that a label should not cover.
fn obstacles(
    markers: &[Marker],
    curves: &[Curve],
    lines: &[VerticalLine],
    frame: &Frame,
) -> Vec<Position> {
    let of_curve = |c: &Curve| c.points.iter().map(|&p| frame.position(p)).collect();
    let mut polylines: Vec<Vec<Position>> = curves.iter().map(of_curve).collect();
    for line in lines {
        let (across, _) = frame.position((line.at, frame.y.0));
        polylines.push(vec![(across, frame.top), (across, frame.bottom())]);
    }
    let mut obstacles: Vec<Position> = markers.iter().map(|m| frame.position(m.at)).collect();
    for ends in polylines.iter().flat_map(|l| l.windows(2)) {
        let ((x0, y0), (x1, y1)) = (ends[0], ends[1]);
        let length = (x1 - x0).hypot(y1 - y0);
        if !length.is_finite() || length > 1e4 {
            continue;
        }
        let steps = (length / 2.0).ceil().max(1.0);
        for i in 0..=steps as usize {
            let t = i as f64 / steps;
            obstacles.push((x0 + t * (x1 - x0), y0 + t * (y1 - y0)));
        }
    }
    obstacles
}

/// Returns the centre of the label of a vertical line, moved onto the page if necessary, and half its width.
fn label_span(canvas: &Canvas, label: &str, across: f64) -> (f64, f64) {
    let half = text_width(label, TEXT_SIZE) / 2.0;
    (across.min(canvas.size.0 - half - 2.0).max(half + 2.0), half)
}
