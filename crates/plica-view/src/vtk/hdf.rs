//! One VTKHDF file of a surface that moves (VTK file formats, VTKHDF 2.0, PolyData with steps); the one file that names
//! hdf5-pure.
//!
//! Cells stand in it once; points and what they have follow each other, step after step.

use super::Cells;
use hdf5_pure::{AttrValue, FileBuilder, GroupBuilder};

/// Rows of an array that are compressed together, at most.
const CHUNK: usize = 1 << 14;

/// A surface that moves.
#[derive(Clone, Debug)]
pub struct Movie {
    cells: Cells,
    /// A field that cells have, the same in every step: its name and its numbers.
    of_cells: (String, Vec<u8>),
    points: Vec<f32>,
    count: usize,
    times: Vec<f64>,
    /// Name, components, and the numbers of all steps so far.
    fields: Vec<(String, usize, Vec<f32>)>,
    /// Name, and one number of every step so far.
    values: Vec<(String, Vec<f64>)>,
}

impl Movie {
    /// Of polygons, which have a field, over so many points.
    pub fn new(cells: Cells, (name, numbers): (&str, Vec<u8>), count: usize) -> Self {
        Self {
            cells,
            of_cells: (name.to_owned(), numbers),
            count,
            points: vec![],
            times: vec![],
            fields: vec![],
            values: vec![],
        }
    }

    /// Adds a step: its time, single numbers of it, its points, and the fields that these have, each the same in every step.
    pub fn step(
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

    /// The bytes of the file.
    ///
    /// # Errors
    /// What hdf5-pure says, in its words.
    pub fn bytes(&self) -> Result<Vec<u8>, String> {
        let steps = self.times.len();
        let cells = self.cells.points.len() / self.cells.each;
        let mut file = FileBuilder::new();
        let mut root = file.create_group("VTKHDF");
        root.set_attr("Version", AttrValue::I64Array(vec![2, 0]));
        root.set_attr("Type", AttrValue::AsciiString("PolyData".into()));
        integers(&mut root, "NumberOfPoints", &vec![self.count as i64; steps]);
        floats(&mut root, "Points", &self.points, 3);
        let offsets: Vec<i64> = (0..=cells)
            .map(|cell| (cell * self.cells.each) as i64)
            .collect();
        for kind in ["Vertices", "Lines", "Polygons", "Strips"] {
            let mut group = root.create_group(kind);
            let (count, offsets, points) = match kind {
                "Polygons" => (cells, &offsets[..], &self.cells.points[..]),
                _ => (0, &[0][..], &[][..]),
            };
            integers(&mut group, "NumberOfCells", &vec![count as i64; steps]);
            let ids = (count * self.cells.each) as i64;
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
        let (name, numbers) = &self.of_cells;
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
        integers(&mut group, "PointOffsets", &first(self.count));
        for name in ["CellOffsets", "ConnectivityIdOffsets"] {
            // Of vertices, lines, polygons and strips.
            let zeros = vec![0; 4 * steps];
            let dataset = group.create_dataset(name);
            dataset.with_i64_data(&zeros).with_shape(&[steps as u64, 4]);
        }
        let mut offsets = group.create_group("PointDataOffsets");
        for (name, ..) in &self.fields {
            integers(&mut offsets, name, &first(self.count));
        }
        group.add_group(offsets.finish());
        let mut offsets = group.create_group("CellDataOffsets");
        integers(&mut offsets, &self.of_cells.0, &vec![0; steps]);
        group.add_group(offsets.finish());
        let mut offsets = group.create_group("FieldDataOffsets");
        let mut sizes = group.create_group("FieldDataSizes");
        for (name, _) in &self.values {
            integers(&mut offsets, name, &first(1));
            // One component of one tuple.
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

/// Numbers in rows of so many, compressed.
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
