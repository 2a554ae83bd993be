//! Time series of a surface as a VTKHDF 2.0 file (PolyData with steps). This is the only file that uses hdf5-pure.
//!
//! Cells are stored once; points and their fields are stored for every step.

use super::Cells;
use hdf5_pure::{AttrValue, FileBuilder, GroupBuilder};

/// Maximum number of rows per compressed chunk.
const CHUNK: usize = 1 << 14;

/// A surface that moves, as a time series.
#[derive(Clone, Debug)]
pub struct Series {
    cells: Cells,
    /// Name and values of a field of the cells, the same in every step.
    cell_data: (String, Vec<u8>),
    points: Vec<f32>,
    point_count: usize,
    times: Vec<f64>,
    /// Name, number of components, and values at the points of all steps so far.
    fields: Vec<(String, usize, Vec<f32>)>,
    /// Name, and one value per step so far.
    values: Vec<(String, Vec<f64>)>,
}

impl Series {
    /// Creates an empty series of polygons with a named field of the cells and `point_count` points.
    pub fn new(cells: Cells, (name, values): (&str, Vec<u8>), point_count: usize) -> Self {
        Self {
            cells,
            cell_data: (name.to_owned(), values),
            point_count,
            points: vec![],
            times: vec![],
            fields: vec![],
            values: vec![],
        }
    }

    /// Adds a step: its time, named values of the step, its points, and fields at the points as (name, number of components,
    /// values). Names and their order must be the same in every step.
    pub fn push(
        &mut self,
        time: f64,
        values: impl IntoIterator<Item = (&'static str, f64)>,
        points: impl Iterator<Item = [f64; 3]>,
        fields: Vec<(&str, usize, Vec<f32>)>,
    ) {
        self.times.push(time);
        for (i, (name, value)) in values.into_iter().enumerate() {
            if self.values.len() == i {
                self.values.push((name.to_owned(), vec![]));
            }
            self.values[i].1.push(value);
        }
        self.points.extend(points.flatten().map(|x| x as f32));
        for (i, (name, components, numbers)) in fields.into_iter().enumerate() {
            if self.fields.len() == i {
                self.fields.push((name.to_owned(), components, vec![]));
            }
            self.fields[i].2.extend(numbers);
        }
    }

    /// Returns the bytes of the file.
    ///
    /// # Errors
    /// The message of hdf5-pure.
    pub fn bytes(&self) -> Result<Vec<u8>, String> {
        let steps = self.times.len();
        let cells = self.cells.points.len() / self.cells.points_per_cell;
        let mut file = FileBuilder::new();
        let mut root = file.create_group("VTKHDF");
        root.set_attr("Version", AttrValue::I64Array(vec![2, 0]));
        root.set_attr("Type", AttrValue::AsciiString("PolyData".into()));
        integers(
            &mut root,
            "NumberOfPoints",
            &vec![self.point_count as i64; steps],
        );
        floats(&mut root, "Points", &self.points, 3);
        let offsets: Vec<i64> = (0..=cells)
            .map(|cell| (cell * self.cells.points_per_cell) as i64)
            .collect();
        for kind in ["Vertices", "Lines", "Polygons", "Strips"] {
            let mut group = root.create_group(kind);
            let (count, offsets, points) = match kind {
                "Polygons" => (cells, &offsets[..], &self.cells.points[..]),
                _ => (0, &[0][..], &[][..]),
            };
            integers(&mut group, "NumberOfCells", &vec![count as i64; steps]);
            let ids = (count * self.cells.points_per_cell) as i64;
            integers(&mut group, "NumberOfConnectivityIds", &vec![ids; steps]);
            integers(&mut group, "Offsets", offsets);
            integers(&mut group, "Connectivity", points);
            root.add_group(group.finish());
        }
        let mut data = root.create_group("PointData");
        for (name, components, numbers) in &self.fields {
            floats(&mut data, name, numbers, *components);
        }
        root.add_group(data.finish());
        let (name, numbers) = &self.cell_data;
        let mut data = root.create_group("CellData");
        data.create_dataset(name).with_u8_data(numbers);
        root.add_group(data.finish());
        let mut data = root.create_group("FieldData");
        for (name, numbers) in &self.values {
            data.create_dataset(name).with_f64_data(numbers);
        }
        root.add_group(data.finish());

        let mut group = root.create_group("Steps");
        group.set_attr("NSteps", AttrValue::I64(steps as i64));
        let values = group.create_dataset("Values");
        values.with_f64_data(&self.times);
        let first = |n: usize| -> Vec<i64> { (0..steps).map(|step| (step * n) as i64).collect() };
        integers(&mut group, "PartOffsets", &first(1));
        integers(&mut group, "NumberOfParts", &vec![1; steps]);
        integers(&mut group, "PointOffsets", &first(self.point_count));
        for name in ["CellOffsets", "ConnectivityIdOffsets"] {
            // For vertices, lines, polygons and strips.
            let zeros = vec![0; 4 * steps];
            let dataset = group.create_dataset(name);
            dataset.with_i64_data(&zeros).with_shape(&[steps as u64, 4]);
        }
        let mut offsets = group.create_group("PointDataOffsets");
        for (name, ..) in &self.fields {
            integers(&mut offsets, name, &first(self.point_count));
        }
        group.add_group(offsets.finish());
        let mut offsets = group.create_group("CellDataOffsets");
        integers(&mut offsets, &self.cell_data.0, &vec![0; steps]);
        group.add_group(offsets.finish());
        let mut offsets = group.create_group("FieldDataOffsets");
        let mut sizes = group.create_group("FieldDataSizes");
        for (name, _) in &self.values {
            integers(&mut offsets, name, &first(1));
            // One tuple with one component.
            let ones = vec![1; 2 * steps];
            let dataset = sizes.create_dataset(name);
            dataset.with_i64_data(&ones).with_shape(&[steps as u64, 2]);
        }
        group.add_group(offsets.finish());
        group.add_group(sizes.finish());
        root.add_group(group.finish());
        file.add_group(root.finish());
        file.finish().map_err(|error| error.to_string())
    }
}

fn integers(group: &mut GroupBuilder, name: &str, numbers: &[i64]) {
    group
        .create_dataset(name)
        .with_i64_data(numbers)
        .with_shape(&[numbers.len() as u64]);
}

/// Writes numbers in rows of `columns` with compression.
fn floats(group: &mut GroupBuilder, name: &str, numbers: &[f32], columns: usize) {
    let rows = numbers.len() / columns;
    let (mut shape, mut chunk) = (vec![rows as u64], vec![rows.clamp(1, CHUNK) as u64]);
    if columns > 1 {
        shape.push(columns as u64);
        chunk.push(columns as u64);
    }
    let dataset = group.create_dataset(name);
    dataset.with_f32_data(numbers).with_shape(&shape);
    dataset.with_chunks(&chunk).with_deflate(4);
}
