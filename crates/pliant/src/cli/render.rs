//! `pliant render`: one picture of a mesh, drawn without a window.

use std::io::Cursor;
use std::sync::Arc;

use glam::Vec3;
use image::ImageFormat;
use pliant_meshfile::MeshFile;

use crate::viewport::{Camera, Coloring, Shading, SurfaceFrame, Theme, ViewScene, picture};

use super::args::{ColorChoice, RenderOptions};
use super::console::Console;
use super::failure::Failure;
use super::handles_file::bounds;
use super::rigidity;
use super::staged::{Staged, check_target, same_file};

/// Larger pictures than any adapter is sure to draw (the limit every WebGPU implementation guarantees).
const MAX_SIDE_PX: u32 = 8192;

/// End of the rigidity ramp unless the mesh is stiffer: the largest r in the paper's pictures.
const RAMP_MAX: u16 = 6;

pub(super) fn run(options: &RenderOptions, console: &mut Console<'_>) -> Result<(), Failure> {
    check_options(options)?;
    console.progress(|| format!("reading {}", options.mesh.display()));
    let file = pliant_meshfile::open(&options.mesh)?;
    let chosen = rigidity::choose(options.rigidity.as_deref(), &file)?;
    let warnings = file.warnings.iter().map(ToString::to_string).chain(chosen.warning);
    let scene = scene(&file, chosen.rigidity.as_slice(), options.color);
    console.progress(|| "drawing".to_owned());
    let drawn = picture(&scene, options.size)?;
    let mut png = Cursor::new(Vec::new());
    drawn.write_to(&mut png, ImageFormat::Png)?;
    let mut staged = Staged::create(&options.output)?;
    staged.write(png.get_ref())?;
    staged.commit()?;
    for warning in warnings {
        console.warn(&warning);
    }
    let [width, height] = options.size;
    console.summarize(&format!("{}: {width} x {height} pixels", options.output.display()));
    Ok(())
}

fn check_options(options: &RenderOptions) -> Result<(), Failure> {
    if options.size.iter().any(|side| !(1..=MAX_SIDE_PX).contains(side)) {
        let [width, height] = options.size;
        return Err(Failure::OutOfRange {
            option: "--size",
            value: format!("{width}x{height}"),
            // MAX_SIDE_PX in words.
            allowed: "between 1x1 and 8192x8192",
        });
    }
    let is_png = options.output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    if !is_png {
        return Err(Failure::NotPng { path: options.output.clone() });
    }
    check_target(&options.output)?;
    if same_file(&options.output, &options.mesh) {
        return Err(Failure::SamePath { path: options.output.clone(), what: "the picture", other: "MESH" });
    }
    Ok(())
}

/// The file as it is, seen from the camera's three-quarter view.
fn scene(file: &MeshFile, rigidity: &[u16], color: ColorChoice) -> ViewScene {
    let points = file.points();
    let triangles = file.point_triangles();
    let (min, max) = bounds(&points);
    let bounds = (min.as_vec3(), max.as_vec3());
    let positions: Vec<Vec3> = points.iter().map(|point| point.as_vec3()).collect();
    let mut normals = Vec::new();
    pliant_geometry::VertexNormals::new(positions.len(), &triangles).compute(&positions, &triangles, &mut normals);
    ViewScene {
        base_colors: base_colors(file, &triangles).map(Into::into),
        triangles: triangles.into(),
        values: Some(vec![0.0; positions.len()].into()),
        frame: Arc::new(SurfaceFrame { positions, normals }),
        rigidity: rigidity.into(),
        selected: None,
        dots: Arc::new([]),
        lines: Arc::new([]),
        coloring: match color {
            ColorChoice::None => Coloring::Plain,
            ColorChoice::Rigidity => Coloring::Rigidity,
            ColorChoice::Energy => Coloring::Energy,
        },
        ramp_max: rigidity.iter().copied().max().unwrap_or(RAMP_MAX).max(RAMP_MAX),
        color_opacity: 1.0,
        shading: Shading::Smooth,
        wireframe: false,
        grid: true,
        theme: Theme::Dark,
        camera: Camera::framing(bounds.0, bounds.1),
        bounds,
        pixels_per_point: 1.0,
    }
}

/// Color of the part each surface point belongs to, the last one where parts meet; none if no part has a color.
fn base_colors(file: &MeshFile, triangles: &[[u32; 3]]) -> Option<Vec<[u8; 4]>> {
    const WHITE: [u8; 4] = [255; 4];
    let mut colors = vec![WHITE; file.weld.n_points()];
    for part in &file.parts {
        let color = part.base_color.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8);
        for &point in triangles[part.triangles.clone()].iter().flatten() {
            colors[point as usize] = color;
        }
    }
    colors.iter().any(|&color| color != WHITE).then_some(colors)
}
