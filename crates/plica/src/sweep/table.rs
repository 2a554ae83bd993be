//! The table of a study: a row for each point.

use super::{Axis, Outcome, Point, Status};

/// Returns the table of a study as CSV: the number of the point from 0, the name of its run (empty for a case that is not valid),
/// the values of the axes, and the outcome. Columns of an outcome are named as the fields of [`Outcome`].
pub fn table(axes: &[Axis], rows: &[(Point, String, Outcome)]) -> String {
    let mut writer = csv::Writer::from_writer(vec![]);
    let mut header = vec!["point".to_owned(), "run".to_owned()];
    header.extend(axes.iter().map(|axis| axis.name.clone()));
    header.extend(records(&Outcome::of_status(Status::Missing))[0].clone());
    // Writing to memory does not fail.
    let _ = writer.write_record(&header);
    for (number, (point, name, outcome)) in rows.iter().enumerate() {
        let mut cells = vec![number.to_string(), name.clone()];
        let values = point.values.iter();
        cells.extend(values.map(|value| value.trim_matches('"').to_owned()));
        cells.extend(records(outcome)[1].clone());
        let _ = writer.write_record(&cells);
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

/// Returns the names of the fields of an outcome, and their values, empty for none.
fn records(outcome: &Outcome) -> [Vec<String>; 2] {
    let mut writer = csv::Writer::from_writer(vec![]);
    let _ = writer.serialize(outcome);
    let text = writer.into_inner().unwrap_or_default();
    let mut reader = csv::ReaderBuilder::new();
    let mut reader = reader.has_headers(false).from_reader(&text[..]);
    let mut records = reader.records().flatten();
    [(); 2].map(|()| {
        let record = records.next().unwrap_or_default();
        record.iter().map(str::to_owned).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_the_values_of_the_axes_and_empty_cells_for_none() {
        let axis = Axis {
            name: "tube.thickness".into(),
            key: "tube.thickness".into(),
            values: vec!["0.05".into()],
            span: 0..0,
        };
        let point = Point {
            values: vec!["0.05".into()],
        };
        let outcome = Outcome {
            states: 3,
            energy: Some(0.25),
            reason: "lost, \"here\"".into(),
            ..Outcome::of_status(Status::Lost)
        };
        let table = table(&[axis], &[(point, "ab".into(), outcome)]);
        let lines: Vec<&str> = table.lines().collect();
        assert!(
            lines[0]
                .starts_with("point,run,tube.thickness,status,states,shape,side,overhang,energy,")
        );
        assert!(
            lines[1].starts_with("0,ab,0.05,lost,3,,,,0.25,"),
            "{}",
            lines[1]
        );
        assert!(lines[1].ends_with("\"lost, \"\"here\"\"\""), "{}", lines[1]);
    }
}
