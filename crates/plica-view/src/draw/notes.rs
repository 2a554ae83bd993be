//! What is written around and into a chart: legend, names of rules, markers.

use super::DrawError;
use super::canvas::{Anchor, Canvas, INK, Pen, Place};
use super::chart::{Chart, Curve, ROW, Rule, TEXT, pen};
use super::colour::line_colour;
use super::frame::Frame;
use super::label::pieces;
use super::text::{CAPITAL, text_width};

impl Chart {
    /// The named curves, in rows that fit the page, each with its distance from the row's start.
    pub(super) fn legend_rows(&self) -> Vec<Vec<(&Curve, f64)>> {
        let named: Vec<&Curve> = self
            .curves
            .iter()
            .filter(|c| !pieces(&c.label).is_empty())
            .collect();
        let mut rows: Vec<Vec<(&Curve, f64)>> = Vec::new();
        let mut used = f64::INFINITY;
        for curve in named {
            let width = 22.0 + text_width(&curve.label, TEXT) + 14.0;
            if used + width > self.width_pt - 50.0 {
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
        &self,
        canvas: &mut Canvas,
        frame: &Frame,
        rows: &[Vec<(&Curve, f64)>],
    ) {
        let top = if self.title.is_empty() {
            10.0
        } else {
            10.0 + 1.3 * ROW
        };
        for (number, row) in rows.iter().enumerate() {
            let middle = top + 1.1 * ROW * number as f64;
            for (curve, offset) in row {
                let left = frame.left + offset;
                canvas.polyline(&[(left, middle), (left + 17.0, middle)], pen(curve));
                if curve.dots {
                    canvas.disc((left + 8.5, middle), 1.7, line_colour(curve.colour), 0.0);
                }
                let baseline = middle + TEXT * CAPITAL / 2.0;
                canvas.text(
                    (left + 22.0, baseline),
                    &curve.label,
                    TEXT,
                    Anchor::Start,
                    INK,
                );
            }
        }
    }

    /// For each rule in view its row above the frame, the lowest where its name meets no other.
    pub(super) fn rule_rows(&self) -> Result<Vec<(&Rule, usize)>, DrawError> {
        let (x, _) = self.ranges()?;
        let mut taken: Vec<(usize, f64, f64)> = Vec::new();
        let mut placed = Vec::new();
        for rule in self.rules.iter().filter(|r| (x.0..=x.1).contains(&r.at)) {
            let half = text_width(&rule.label, TEXT) / 2.0 + 4.0;
            let at = (rule.at - x.0) / (x.1 - x.0) * (self.width_pt - 60.0);
            let meets = |row: &usize| {
                taken
                    .iter()
                    .any(|&(r, a, b)| r == *row && a < at + half && at - half < b)
            };
            let row = (0..).find(|row| !meets(row)).unwrap_or(0);
            taken.push((row, at - half, at + half));
            placed.push((rule, row));
        }
        Ok(placed)
    }

    pub(super) fn draw_rules(&self, canvas: &mut Canvas, frame: &Frame, names: &[(&Rule, usize)]) {
        let pen = Pen {
            colour: [130; 3],
            width: 0.6,
            dash: (2.5, 2.0),
        };
        for (rule, row) in names {
            let (across, _) = frame.place((rule.at, frame.y.0));
            let foot = frame.top - ROW * *row as f64;
            canvas.line((across, frame.bottom()), (across, frame.top), pen);
            // On to its name, but not through those of others.
            for below in 0..*row {
                let through = |(other, at): &(&Rule, usize)| {
                    let (middle, half) = span(canvas, &other.label, frame.place((other.at, 0.0)).0);
                    *at == below && (across - middle).abs() < half + 2.0
                };
                if !names.iter().any(through) {
                    let [start, end] = [below, below + 1].map(|r| frame.top - ROW * r as f64);
                    canvas.line((across, start), (across, end), pen);
                }
            }
            let (middle, _) = span(canvas, &rule.label, across);
            canvas.text(
                (middle, foot - 3.0),
                &rule.label,
                TEXT,
                Anchor::Middle,
                [90; 3],
            );
        }
    }

    pub(super) fn draw_markers(&self, canvas: &mut Canvas, frame: &Frame) {
        let mut obstacles = self.inked(frame);
        for marker in &self.markers {
            let (x, y) = frame.place(marker.at);
            if !frame.holds((x, y)) {
                continue;
            }
            canvas.disc((x, y), 2.6, line_colour(marker.colour), 0.9);
            let width = text_width(&marker.label, TEXT);
            let height = TEXT * CAPITAL;
            // Left edge and baseline of the label: above, right, left, below, then the corners.
            let (near, right, before) = (x - width / 2.0, x + 6.0, x - 6.0 - width);
            let (over, level, under) = (y - 7.0, y + height / 2.0, y + 7.0 + height);
            let tries = [
                (near, over),
                (right, level),
                (before, level),
                (near, under),
                (right, over),
                (before, over),
                (right, under),
                (before, under),
            ];
            let hidden = |&(left, base): &Place| {
                let box_x = left - 2.0..=left + width + 2.0;
                let box_y = base - height - 2.0..=base + 3.0;
                let ink = obstacles
                    .iter()
                    .filter(|(a, b)| box_x.contains(a) && box_y.contains(b))
                    .count();
                let inside =
                    frame.holds((left, base)) && frame.holds((left + width, base - height));
                ink + if inside { 0 } else { 1000 }
            };
            let (left, base) = tries.into_iter().min_by_key(hidden).unwrap_or(tries[0]);
            canvas.text((left, base), &marker.label, TEXT, Anchor::Start, INK);
            for i in 0..=(width as usize) {
                obstacles.push((left + i as f64, base - height / 2.0));
            }
        }
    }

    /// Places about two points apart along everything that a label must not hide.
    fn inked(&self, frame: &Frame) -> Vec<Place> {
        let mut lines: Vec<Vec<Place>> = Vec::new();
        for curve in &self.curves {
            lines.push(curve.points.iter().map(|&p| frame.place(p)).collect());
        }
        for rule in &self.rules {
            let (across, _) = frame.place((rule.at, frame.y.0));
            lines.push(vec![(across, frame.top), (across, frame.bottom())]);
        }
        let mut inked: Vec<Place> = self.markers.iter().map(|m| frame.place(m.at)).collect();
        for ends in lines.iter().flat_map(|l| l.windows(2)) {
            let ((x0, y0), (x1, y1)) = (ends[0], ends[1]);
            let length = (x1 - x0).hypot(y1 - y0);
            if !length.is_finite() || length > 1e4 {
                continue;
            }
            let steps = (length / 2.0).ceil().max(1.0);
            for i in 0..=steps as usize {
                let t = i as f64 / steps;
                inked.push((x0 + t * (x1 - x0), y0 + t * (y1 - y0)));
            }
        }
        inked
    }
}

/// Where the name of a rule is centred, so that it stays on the page, and half its width.
fn span(canvas: &Canvas, label: &str, across: f64) -> (f64, f64) {
    let half = text_width(label, TEXT) / 2.0;
    (across.min(canvas.size.0 - half - 2.0).max(half + 2.0), half)
}
