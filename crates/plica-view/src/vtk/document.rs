//! VTK XML files with appended raw data.

use super::{Cells, Column, Number};
use std::fmt::Write;

/// A VTK XML file under construction.
#[derive(Clone, Debug)]
pub struct Document {
    kind: &'static str,
    points: usize,
    cells: usize,
    field_data: String,
    point_data: String,
    cell_data: String,
    mesh: String,
    columns: Vec<Column>,
    length: usize,
}

impl Document {
    /// Creates an unstructured grid (`.vtu`) with cells of one type.
    pub fn grid(points: &[[f64; 3]], cells: &Cells) -> Self {
        let mut file = Self::new("UnstructuredGrid", points, cells);
        file.mesh += "   <Cells>\n";
        let count = file.cells;
        file.add_connectivity(cells);
        let types = std::iter::repeat_n(cells.cell_type, count);
        let types = file.add_array("types", &[], Column::new(types));
        file.mesh += &types;
        file.mesh += "   </Cells>\n";
        file
    }

    /// Creates a surface (`.vtp`) of polygons.
    pub fn surface(points: &[[f64; 3]], polygons: &Cells) -> Self {
        let mut file = Self::new("PolyData", points, polygons);
        file.mesh += "   <Polys>\n";
        file.add_connectivity(polygons);
        file.mesh += "   </Polys>\n";
        file
    }

    fn new(kind: &'static str, points: &[[f64; 3]], cells: &Cells) -> Self {
        let mut file = Self {
            kind,
            points: points.len(),
            cells: cells.points.len() / cells.points_per_cell.max(1),
            field_data: String::new(),
            point_data: String::new(),
            cell_data: String::new(),
            mesh: String::new(),
            columns: vec![],
            length: 0,
        };
        let column = Column::new(points.iter().flatten().copied());
        let array = file.add_array("Points", &["x", "y", "z"], column);
        file.mesh = format!("   <Points>\n{array}   </Points>\n");
        file
    }

    fn add_connectivity(&mut self, cells: &Cells) {
        let ends = (1..=self.cells).map(|cell| (cell * cells.points_per_cell) as i64);
        for (name, column) in [
            ("connectivity", Column::new(cells.points.iter().copied())),
            ("offsets", Column::new(ends)),
        ] {
            let array = self.add_array(name, &[], column);
            self.mesh += &array;
        }
    }

    /// Adds a number that belongs to the whole file.
    pub fn field_data(&mut self, name: &str, value: f64) {
        let array = self.add_array(name, &[], Column::new([value].into_iter()));
        self.field_data += &array.replace("<DataArray", "<DataArray NumberOfTuples=\"1\"");
    }

    /// Adds a field at the points. `components` are the names of its components, empty for a scalar field.
    pub fn point_data(&mut self, name: &str, components: &[&str], column: Column) {
        let array = self.add_array(name, components, column);
        self.point_data += &array;
    }

    /// Adds a scalar field of the cells.
    pub fn cell_data<N: Number>(&mut self, name: &str, values: impl Iterator<Item = N>) {
        let array = self.add_array(name, &[], Column::new(values));
        self.cell_data += &array;
    }

    /// Appends an array to the data and returns the XML element that refers to it.
    fn add_array(&mut self, name: &str, components: &[&str], column: Column) -> String {
        let mut text = format!(
            "    <DataArray type=\"{}\" Name=\"{name}\" format=\"appended\" offset=\"{}\"",
            column.number, self.length
        );
        if !components.is_empty() {
            let _ = write!(text, " NumberOfComponents=\"{}\"", components.len());
            for (i, component) in components.iter().enumerate() {
                let _ = write!(text, " ComponentName{i}=\"{component}\"");
            }
        }
        self.length += column.bytes.len();
        self.columns.push(column);
        text + "/>\n"
    }

    /// Returns the bytes of the file.
    pub fn bytes(&self) -> Vec<u8> {
        let Self {
            kind,
            points,
            cells,
            field_data,
            point_data,
            cell_data,
            mesh,
            ..
        } = self;
        let cell_count = match *kind {
            "PolyData" => format!("NumberOfPolys=\"{cells}\""),
            _ => format!("NumberOfCells=\"{cells}\""),
        };
        let header = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"{kind}\" version=\"2.2\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
             compressor=\"vtkZLibDataCompressor\">\n \
             <{kind}>\n  \
             <FieldData>\n{field_data}  </FieldData>\n  \
             <Piece NumberOfPoints=\"{points}\" {cell_count}>\n   \
             <PointData>\n{point_data}   </PointData>\n   \
             <CellData>\n{cell_data}   </CellData>\n\
             {mesh}  </Piece>\n \
             </{kind}>\n \
             <AppendedData encoding=\"raw\">\n_"
        );
        let mut bytes = Vec::with_capacity(header.len() + self.length + 64);
        bytes.extend_from_slice(header.as_bytes());
        for column in &self.columns {
            bytes.extend_from_slice(&column.bytes);
        }
        bytes.extend_from_slice(b"\n </AppendedData>\n</VTKFile>\n");
        bytes
    }
}
