//! `pliant render`: one picture of a mesh, drawn without a window.

use std::io::Cursor;
use std::sync::Arc;

use glam::Vec3;
use image::ImageFormat;

use crate::document::Model;
use crate::viewport::{Camera, Coloring, SurfaceFrame, ViewScene, picture};

use super::args::{ColorChoice, RenderOptions};
use super::console::Console;
use super::failure::Failure;
use super::rigidity;
use super::staged::{Staged, check_target, same_file};
use super::surface;

/// Larger pictures than any adapter is sure to draw (the limit every WebGPU implementation guarantees).
const MAX_SIDE_PX: u32 = 8192;

/// End of the rigidity ramp unless the mesh is stiffer: the largest r in the paper's pictures.
const RAMP_MAX: u16 = 6;

pub(super) fn run(options: &RenderOptions, console: &mut Console<'_>) -> Result<(), Failure> {
    check_options(options)?;
    let file = surface::read(&options.mesh, options.weld, console)?;
    let chosen = rigidity::choose(options.rigidity.as_deref(), &file)?;
    let warnings = file.warnings.iter().map(ToString::to_string).chain(chosen.warning);
    let mut warnings: Vec<String> = warnings.collect();
    let mut model = Model::from_file(file)?;
    let n_known = model.warnings.len();
    model.load_textures();
    warnings.extend(model.warnings.split_off(n_known));
    let scene = scene(&model, chosen.rigidity.as_slice(), options.color);
    console.progress(|| "drawing".to_owned());
    let drawn = picture(&scene, options.size)?;
    check_size(options.size, drawn.dimensions().into())?;
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

/// Refuses a picture that the device drew smaller than asked.
fn check_size(asked: [u32; 2], drawn: [u32; 2]) -> Result<(), Failure> {
    if drawn == asked { Ok(()) } else { Err(Failure::PictureSize { asked, drawn }) }
}

/// The model as the editor shows it on opening, seen from the camera's three-quarter view.
fn scene(model: &Model, rigidity: &[u16], color: ColorChoice) -> ViewScene {
    let positions: Vec<Vec3> = model.mesh.positions().iter().map(|&point| model.to_view(point)).collect();
    let triangles = &model.triangles;
    let mut normals = Vec::new();
    pliant_geometry::VertexNormals::new(positions.len(), triangles).compute(&positions, triangles, &mut normals);
    let coloring = match color {
        ColorChoice::None => Coloring::Plain,
        ColorChoice::Rigidity => Coloring::Rigidity,
        ColorChoice::Energy => Coloring::Energy,
    };
    let camera = Camera::framing(model.bounds.0, model.bounds.1);
    ViewScene {
        base_colors: model.base_colors.clone(),
        textures: model.textures.clone(),
        values: Some(vec![0.0; positions.len()].into()),
        rigidity: rigidity.into(),
        coloring,
        ramp_max: rigidity.iter().copied().max().unwrap_or(RAMP_MAX).max(RAMP_MAX),
        grid: true,
        ..ViewScene::plain(triangles.clone(), Arc::new(SurfaceFrame { positions, normals }), camera, model.bounds)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use pliant_meshfile::MeshFile;

    use super::*;

    fn triangle_at(place: f64) -> ViewScene {
        let positions = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|corner| corner + place).to_vec();
        let file = MeshFile::from_triangles("triangle", positions, vec![[0, 1, 2]]);
        scene(&Model::from_file(file).expect("a sound triangle"), &[1, 1, 1], ColorChoice::None)
    }

    #[test]
    fn a_mesh_far_from_the_origin_is_drawn_as_finely_as_one_at_the_origin() {
        // 2^30: a 32-bit float there is a multiple of 64, and the triangle would shrink to a point.
        let (near, far) = (triangle_at(0.0), triangle_at(1_073_741_824.0));
        assert_eq!(far.frame.positions, near.frame.positions);
        assert_eq!(far.bounds, near.bounds);
    }

    #[test]
    fn a_picture_smaller_than_asked_is_refused() {
        assert!(check_size([640, 480], [640, 480]).is_ok());
        let said = check_size([8192, 480], [4096, 480]).expect_err("clamped").to_string();
        assert!(said.contains("8192x480") && said.contains("4096x480"), "{said}");
    }
}
