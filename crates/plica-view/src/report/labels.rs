//! Labels of states, units and the scale bar.

use plica::study::{Row, Scale};

/// Returns the label of a state.
pub(super) fn state_label(row: &Row) -> String {
    format!(
        "state {}: *L*_{{max}}/*L* = {:.2}, *D*_{{min}}/*D* = {:.2} ({})",
        row.step, row.length_ratio, row.diameter_ratio, row.shape
    )
}

/// Returns the length of the scale bar of a picture in units of D, and its label.
pub(super) fn scale_bar(scale: &Scale) -> (f64, String) {
    if scale.length_name == "D" {
        return (1.0, "*D*".into());
    }
    // The largest round length up to one diameter.
    let ten = 10f64.powf(scale.length.log10().floor());
    let round = [5.0, 2.0, 1.0]
        .into_iter()
        .find(|n| n * ten <= scale.length * (1.0 + 1e-9));
    let length = round.unwrap_or(1.0) * ten;
    (
        length / scale.length,
        format!("{length} {}", unit(&scale.length_name)),
    )
}

/// Returns the label of a unit.
pub(super) fn unit(name: &str) -> String {
    match name {
        "E D^3" => "*E* *D*^{3}".into(),
        "E" | "D" => format!("*{name}*"),
        "E D^2" => "*E* *D*^{2}".into(),
        "D^2" => "*D*^{2}".into(),
        "D^3" => "*D*^{3}".into(),
        other => {
            let name = other.replace('u', "µ");
            match name.split_once('^') {
                Some((base, power)) => format!("{base}^{{{power}}}"),
                None => name,
            }
        }
    }
}
