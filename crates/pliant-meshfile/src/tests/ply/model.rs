//! PLY files made of tables, by a writer that shares nothing with the crate.

use crate::{Format, MeshFile, from_bytes};

/// A declared element and its rows. A row holds the numbers of its scalars in order; a list is its length, then its items.
pub(super) struct Table {
    pub(super) name: &'static str,
    /// `float x` or `list uchar int vertex_indices`.
    pub(super) properties: Vec<&'static str>,
    pub(super) rows: Vec<Vec<f64>>,
}

pub(super) fn table(name: &'static str, properties: &[&'static str], rows: &[&[f64]]) -> Table {
    Table { name, properties: properties.to_vec(), rows: rows.iter().map(|row| row.to_vec()).collect() }
}

/// A quad and a triangle over five vertices, in a file with more than that.
pub(super) fn tables() -> Vec<Table> {
    let vertex = table(
        "vertex",
        &["uchar kind", "double y", "float x", "list uchar short tags", "float z", "float nx", "float ny", "float nz"],
        &[
            &[7.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
            &[8.0, 0.0, 1.5, 2.0, -5.0, 300.0, 0.0, 0.0, 0.0, 1.0],
            &[9.0, 1.25, 1.0, 1.0, 4.0, 0.0, 0.0, 0.0, 1.0],
            &[1.0, 1.0, 0.0, 0.0, 0.5, 0.0, 0.0, 1.0],
            &[2.0, 2.0, 0.5, 0.0, 0.0, 0.0, 0.0, 1.0],
        ],
    );
    let range = table("range_grid", &["list uint double values"], &[&[1.0, 0.5], &[0.0]]);
    let faces = &["list ushort uint vertex_indices", "uchar quality"];
    let face = table("face", faces, &[&[4.0, 0.0, 1.0, 2.0, 3.0, 77.0], &[3.0, 3.0, 2.0, 4.0, 78.0]]);
    vec![range, face, vertex, table("edge", &["int vertex1", "int vertex2"], &[&[0.0, 1.0]])]
}

/// The file in an encoding, with lines of the header (and of a text) that end as given.
pub(super) fn ply(encoding: &str, end: &str, tables: &[Table]) -> Vec<u8> {
    let mut header = vec!["ply".to_owned(), format!("format {encoding} 1.0"), "comment made  by hand".to_owned()];
    header.push("obj_info 3 cols".to_owned());
    for table in tables {
        header.push(format!("element {} {}", table.name, table.rows.len()));
        header.extend(table.properties.iter().map(|property| format!("property {property}")));
    }
    header.push("end_header".to_owned());
    let mut bytes = (header.join(end) + end).into_bytes();
    for table in tables {
        for row in &table.rows {
            if encoding == "ascii" {
                let words: Vec<String> = row.iter().map(f64::to_string).collect();
                bytes.extend((words.join("  ") + " " + end).bytes());
            } else {
                binary_row(&table.properties, row, encoding == "binary_big_endian", &mut bytes);
            }
        }
    }
    bytes
}

fn binary_row(properties: &[&str], row: &[f64], big: bool, out: &mut Vec<u8>) {
    let mut row = row.iter();
    for property in properties {
        let words: Vec<&str> = property.split(' ').collect();
        if words[0] == "list" {
            let n = row.next().expect("a length");
            number(words[1], *n, big, out);
            (0..*n as usize).for_each(|_| number(words[2], *row.next().expect("an item"), big, out));
        } else {
            number(words[0], *row.next().expect("a number"), big, out);
        }
    }
}

/// Appends one number of a type.
pub(super) fn number(scalar: &str, x: f64, big: bool, out: &mut Vec<u8>) {
    let mut bytes = match scalar {
        "char" | "int8" => vec![x as i8 as u8],
        "uchar" | "uint8" => vec![x as u8],
        "short" | "int16" => (x as i16).to_le_bytes().to_vec(),
        "ushort" | "uint16" => (x as u16).to_le_bytes().to_vec(),
        "int" | "int32" => (x as i32).to_le_bytes().to_vec(),
        "uint" | "uint32" => (x as u32).to_le_bytes().to_vec(),
        "float" | "float32" => (x as f32).to_le_bytes().to_vec(),
        "double" | "float64" => x.to_le_bytes().to_vec(),
        other => panic!("no type {other}"),
    };
    if big {
        bytes.reverse();
    }
    out.extend(bytes);
}

pub(super) const ENCODINGS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

pub(super) fn opened(bytes: &[u8]) -> MeshFile {
    from_bytes(bytes, Format::Ply, "test.ply").unwrap_or_else(|error| panic!("{error}"))
}
