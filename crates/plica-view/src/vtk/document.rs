//! A file of VTK's: a head in XML, then columns of raw bytes.

use super::{Cells, Column, Number};
use std::fmt::Write;

/// A file, as it grows.
#[derive(Clone, Debug)]
pub struct Document {
    kind: &'static str,
    points: usize,
    cells: usize,
    values: String,
    of_points: String,
    of_cells: String,
    mesh: String,
    columns: Vec<Column>,
    length: usize,
}

impl Document {
    /// An unstructured grid (`.vtu`) of cells of one kind.
    pub fn grid(points: &[[f64; 3]], cells: &Cells) -> Self {
        let mut file = Self::new("UnstructuredGrid", points, cells);
        file.mesh += "   <Cells>\n";
        let count = file.cells;
        file.connect(cells);
        let kinds = std::iter::repeat_n(cells.kind, count);
        let kinds = file.array("types", &[], Column::of(kinds));
        file.mesh += &kinds;
        file.mesh += "   </Cells>\n";
        file
    }

    /// A surface (`.vtp`) of polygons.
    pub fn surface(points: &[[f64; 3]], polygons: &Cells) -> Self {
        let mut file = Self::new("PolyData", points, polygons);
        file.mesh += "   <Polys>\n";
        file.connect(polygons);
        file.mesh += "   </Polys>\n";
        file
    }

    fn new(kind: &'static str, points: &[[f64; 3]], cells: &Cells) -> Self {
        let mut file = Self {
            kind,
            points: points.len(),
            cells: cells.points.len() / cells.each.max(1),
            values: String::new(),
            of_points: String::new(),
            of_cells: String::new(),
            mesh: String::new(),
            columns: vec![],
            length: 0,
        };
        let column = Column::of(points.iter().flatten().copied());
        let array = file.array("Points", &["x", "y", "z"], column);
        file.mesh = format!("   <Points>\n{array}   </Points>\n");
        file
    }

    fn connect(&mut self, cells: &Cells) {
        let ends = (1..=self.cells).map(|cell| (cell * cells.each) as i64);
        for (name, column) in [
            ("connectivity", Column::of(cells.points.iter().copied())),
            ("offsets", Column::of(ends)),
        ] {
            let array = self.array(name, &[], column);
            self.mesh += &array;
        }
    }

    /// A number that the whole file has.
    pub fn value(&mut self, name: &str, value: f64) {
        let array = self.array(name, &[], Column::of([value].into_iter()));
        self.values += &array.replace("<DataArray", "<DataArray NumberOfTuples=\"1\"");
    }

    /// A field that points have: a column of numbers, or of as many side by side as there are names of components.
    pub fn point_data(&mut self, name: &str, components: &[&str], column: Column) {
        let array = self.array(name, components, column);
        self.of_points += &array;
    }

    /// A field that cells have.
    pub fn cell_data<N: Number>(&mut self, name: &str, values: impl Iterator<Item = N>) {
        let array = self.array(name, &[], Column::of(values));
        self.of_cells += &array;
    }

    /// Takes a column along, and says where it will stand.
    fn array(&mut self, name: &str, components: &[&str], column: Column) -> String {
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

    /// The bytes of the file.
    pub fn bytes(&self) -> Vec<u8> {
        let Self {
            kind,
            points,
            cells,
            values,
            of_points,
            of_cells,
            mesh,
            ..
        } = self;
        let number = match *kind {
            "PolyData" => format!("NumberOfPolys=\"{cells}\""),
            _ => format!("NumberOfCells=\"{cells}\""),
        };
        let head = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"{kind}\" version=\"2.2\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
             compressor=\"vtkZLibDataCompressor\">\n \
             <{kind}>\n  \
             <FieldData>\n{values}  </FieldData>\n  \
             <Piece NumberOfPoints=\"{points}\" {number}>\n   \
             <PointData>\n{of_points}   </PointData>\n   \
             <CellData>\n{of_cells}   </CellData>\n\
             {mesh}  </Piece>\n \
             </{kind}>\n \
             <AppendedData encoding=\"raw\">\n_"
        );
        let mut bytes = Vec::with_capacity(head.len() + self.length + 64);
        bytes.extend_from_slice(head.as_bytes());
        for column in &self.columns {
            bytes.extend_from_slice(&column.bytes);
        }
        bytes.extend_from_slice(b"\n </AppendedData>\n</VTKFile>\n");
        bytes
    }
}
