//! How fast files are opened, beside the readers that others use.
//!
//! All read the same bytes from memory, in turn. What they give differs: tobj and the gltf crate give lists of numbers.
//! Pliant also checks every index and number, welds vertices to surface points, and keeps the file for saving.

use super::Failure;
use super::clock::{median, timed};
use super::table::{Table, count, digits, ms};
use glam::DVec3;
use pliant_meshfile::{Format, MeshFile, from_bytes};
use std::fmt::Write as _;
use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

/// Vertices along each side of the sheet: a million in all.
const SIDE: u32 = 1000;
const SIDE_IF_QUICK: u32 = 40;
/// Runs of each reader, of which the median is told.
const RUNS: usize = 5;

/// A reader and its name.
type Reader<'a> = (&'a str, &'a (dyn Fn(&[u8]) + Sync));

/// A file in memory.
struct File {
    name: &'static str,
    format: Format,
    bytes: Vec<u8>,
}

/// A row for every file and reader.
pub(crate) fn table(quick: bool, folder: &Path) -> Result<String, Failure> {
    let sheet = Sheet::new(if quick { SIDE_IF_QUICK } else { SIDE });
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one =
        one.map_err(|source| Failure::Start { program: "a thread".into(), source: std::io::Error::other(source) })?;
    let mut table = Table::new(2, &["file", "reader", "MB", "ms", "MB/s", "million vertices/s", "speed / other's"]);
    for File { name, format, bytes } in sheet.files(folder)? {
        eprintln!("opening: {name}, {} vertices", count(sheet.positions.len()));
        let other: (&str, fn(&[u8])) = match format {
            Format::Obj => ("tobj", with_tobj),
            _ => ("gltf crate", with_gltf),
        };
        let own = |bytes: &[u8]| {
            black_box(from_bytes(bytes, format, name)).expect("made by this program");
        };
        let on_one = |bytes: &[u8]| one.install(|| own(bytes));
        let readers: [Reader<'_>; 3] = [("Pliant", &own), ("Pliant, one thread", &on_one), (other.0, &other.1)];
        let times = in_turn(&readers, &bytes);
        for ((reader, _), time) in readers.iter().zip(&times) {
            let per_second = |amount: f64| digits(amount / 1e6 / time.as_secs_f64());
            let ratio = times[2].as_secs_f64() / time.as_secs_f64();
            table.row([
                name.to_owned(),
                (*reader).to_owned(),
                digits(bytes.len() as f64 / 1e6),
                ms(*time),
                per_second(bytes.len() as f64),
                per_second(sheet.positions.len() as f64),
                format!("{ratio:.2}"),
            ]);
        }
    }
    Ok(format!(
        "A sheet of {} vertices and {} triangles, from memory to a mesh, in turn on the same bytes. tobj and the gltf \
         crate give lists of numbers; Pliant also checks every index, welds vertices that are one place, and keeps the \
         file for saving.\n\n{}",
        count(sheet.positions.len()),
        count(sheet.triangles.len()),
        table.into_text()
    ))
}

/// The median time of each reader.
fn in_turn(readers: &[Reader<'_>], bytes: &[u8]) -> Vec<Duration> {
    let mut times = vec![Vec::new(); readers.len()];
    for _ in 0..RUNS {
        for ((_, read), times) in readers.iter().zip(&mut times) {
            times.push(timed(|| read(bytes)).1);
        }
    }
    times.into_iter().map(median).collect()
}

fn with_tobj(mut bytes: &[u8]) {
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    let no_materials = |_: &Path| Ok((Vec::new(), Default::default()));
    let (models, materials) =
        tobj::load_obj_buf(&mut bytes, &options, no_materials).expect("tobj reads what this program wrote");
    black_box((models, materials.is_ok()));
}

fn with_gltf(bytes: &[u8]) {
    let file = gltf::Gltf::from_slice(bytes).expect("the gltf crate reads what this program wrote");
    let blob = file.blob.as_deref();
    for primitive in file.meshes().flat_map(|mesh| mesh.primitives()) {
        let reader = primitive.reader(|_| blob);
        black_box(reader.read_positions().map(Iterator::collect::<Vec<_>>));
        black_box(reader.read_normals().map(Iterator::collect::<Vec<_>>));
        black_box(reader.read_tex_coords(0).map(|uvs| uvs.into_f32().collect::<Vec<_>>()));
        black_box(reader.read_indices().map(|indices| indices.into_u32().collect::<Vec<_>>()));
    }
}

/// A wavy grid over 3 by 3 units.
struct Sheet {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Sheet {
    fn new(side: u32) -> Sheet {
        let place = |v: u32| {
            let [u, w] = [v % side, v / side].map(|k| f64::from(k) / f64::from(side - 1));
            let y = 0.3 * libm::sin(7.0 * u) * libm::cos(9.0 * w);
            DVec3::new(3.0 * u - 1.5, y, 3.0 * w - 1.5).as_vec3().as_dvec3()
        };
        let cell = |c: u32| {
            let a = c / (side - 1) * side + c % (side - 1);
            let (b, c, d) = (a + 1, a + side + 1, a + side);
            [[a, d, c], [a, c, b]]
        };
        Sheet {
            positions: (0..side * side).map(place).collect(),
            triangles: (0..(side - 1) * (side - 1)).flat_map(cell).collect(),
        }
    }

    /// The same sheet in files of several kinds.
    fn files(&self, folder: &Path) -> Result<[File; 3], Failure> {
        let path = folder.join("sheet.glb");
        let mesh = MeshFile::from_triangles("sheet", self.positions.clone(), self.triangles.clone());
        mesh.save(&path, &mesh.points(), None).map_err(|source| Failure::Sample { name: "sheet", source })?;
        let glb = std::fs::read(&path).map_err(|source| Failure::File { path, source })?;
        let obj = |name, with| File { name, format: Format::Obj, bytes: self.obj(with).into_bytes() };
        Ok([
            obj("OBJ: v, f", false),
            obj("OBJ: v, vt, vn, f", true),
            File { name: "GLB: positions, normals", format: Format::Glb, bytes: glb },
        ])
    }

    /// As most programs write it, six digits behind the point.
    fn obj(&self, with_attributes: bool) -> String {
        let mut text = String::new();
        let mut line = |line: std::fmt::Arguments<'_>| {
            // A string takes whatever is written to it.
            let _ = writeln!(text, "{line}");
        };
        self.positions.iter().for_each(|p| line(format_args!("v {:.6} {:.6} {:.6}", p.x, p.y, p.z)));
        if with_attributes {
            for p in &self.positions {
                line(format_args!("vt {:.6} {:.6}", (p.x + 1.5) / 3.0, (p.z + 1.5) / 3.0));
            }
            for p in &self.positions {
                let n = DVec3::new(-p.z, 2.0, p.x).normalize();
                line(format_args!("vn {:.4} {:.4} {:.4}", n.x, n.y, n.z));
            }
        }
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|v| v + 1);
            if with_attributes {
                line(format_args!("f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}"));
            } else {
                line(format_args!("f {a} {b} {c}"));
            }
        }
        text
    }
}
