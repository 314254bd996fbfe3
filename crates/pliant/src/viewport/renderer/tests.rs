//! How the renderer gets by on devices that can do less.

use super::super::test_scenes::sheet;
use super::super::{Camera, Headless, SurfaceFrame, Texture, TextureSet, Wrap};
use super::*;
use glam::{Vec2, Vec3};
use std::sync::Arc;

const SIZE: [u32; 2] = [120, 90];
/// Cells along a side of the test sheet: 2 · 40² triangles, 38,400 bytes of corners.
const CELLS: u32 = 40;

/// A device with these limits and a picture drawn on it; nothing may have been complained about.
fn drawn_within(limits: wgpu::Limits, scene: &ViewScene) -> image::RgbaImage {
    let headless = Headless::with_limits(limits)
        .unwrap_or_else(|error| panic!("{error}; `apt-get install mesa-vulkan-drivers` brings a software adapter"));
    let mut renderer = Renderer::new(&headless.device, &headless.queue, 1);
    renderer.render(scene, SIZE);
    let picture = renderer.try_read_pixels().expect("the picture can be read");
    assert_eq!(headless.take_error(), None, "the device complained");
    picture
}

/// Pixels darker than the sheet's light.
fn n_dark(picture: &image::RgbaImage) -> usize {
    picture.pixels().filter(|px| px.0[1] < 120).count()
}

#[test]
fn edges_are_lines_where_vertices_cannot_be_fetched() {
    let webgl = wgpu::Limits { max_texture_dimension_2d: 1024, ..wgpu::Limits::downlevel_webgl2_defaults() };
    let mut scene = sheet(CELLS);
    // Only some triangles, so that edges are apart.
    scene.triangles = scene.triangles.iter().copied().step_by(9).collect();
    let plain = drawn_within(webgl.clone(), &scene);
    scene.wireframe = true;
    let wired = drawn_within(webgl, &scene);
    let changed = plain.pixels().zip(wired.pixels()).filter(|(a, b)| a.0[1] > b.0[1].saturating_add(20)).count();
    assert!(changed > 200, "{changed} pixels got darker");
}

#[test]
fn textures_that_a_device_cannot_show_are_told_and_the_surface_is_drawn_without() {
    let textured = |cells: u32| {
        let plain = sheet(cells);
        let image =
            Texture::new(image::RgbaImage::from_pixel(2, 2, image::Rgba([250, 10, 10, 255])), [Wrap::Repeat; 2]);
        let n = plain.triangles.len();
        let set = TextureSet { images: vec![image], runs: vec![(0..n as u32, Some(0))], uvs: vec![[Vec2::ZERO; 3]; n] };
        ViewScene { textures: Some(Arc::new(set)), ..plain }
    };
    let webgl = wgpu::Limits { max_texture_dimension_2d: 1024, ..wgpu::Limits::downlevel_webgl2_defaults() };
    let narrow = wgpu::Limits { max_storage_buffer_binding_size: 16_384, ..wgpu::Limits::defaults() };
    for (limits, cells, expected) in [
        (wgpu::Limits::defaults(), CELLS, None),
        (webgl, CELLS, Some("storage buffers")),
        (narrow.clone(), CELLS, Some("too large")),
        (narrow, 8, None),
    ] {
        let headless = Headless::with_limits(limits).unwrap_or_else(|error| panic!("{error}"));
        let mut renderer = Renderer::new(&headless.device, &headless.queue, 1);
        let scene = textured(cells);
        let said = renderer.textures_obstacle(&scene);
        assert_eq!(said.is_some(), expected.is_some(), "{cells} cells: {said:?}");
        assert!(expected.is_none_or(|words| said.is_some_and(|said| said.contains(words))), "{said:?}");
        renderer.render(&scene, SIZE);
        let picture = renderer.try_read_pixels().expect("the picture can be read");
        assert_eq!(headless.take_error(), None, "the device complained");
        let [r, g, _, _] = picture.get_pixel(SIZE[0] / 2, SIZE[1] / 2).0.map(i32::from);
        assert_eq!(r > g + 60, expected.is_none(), "{cells} cells: red {r}, green {g} in the middle");
        assert_eq!(renderer.textures_obstacle(&sheet(cells)), None, "there are none to show");
    }
}

#[test]
fn edges_beyond_one_buffer_are_all_lines() {
    // 2 · 48² triangles: 56,064 bytes of edges.
    let scene = ViewScene { wireframe: true, ..sheet(48) };
    let webgl = wgpu::Limits { max_texture_dimension_2d: 1024, ..wgpu::Limits::downlevel_webgl2_defaults() };
    let whole = drawn_within(webgl.clone(), &scene);
    let parts = drawn_within(wgpu::Limits { max_buffer_size: 46_080, ..webgl }, &scene);
    let differing = parts.pixels().zip(whole.pixels()).filter(|(a, b)| a != b).count();
    assert_eq!(differing, 0);
}

#[test]
fn meshes_beyond_one_buffer_are_drawn_in_parts() {
    let scene = sheet(CELLS);
    let whole = drawn_within(wgpu::Limits::defaults(), &scene);
    // Room for the picture read back (120 x 90 in rows of 512 bytes), but not for all corners.
    let small =
        wgpu::Limits { max_buffer_size: 46_080, max_storage_buffer_binding_size: 24_000, ..wgpu::Limits::defaults() };
    for wireframe in [false, true] {
        let scene = ViewScene { wireframe, ..scene.clone() };
        let parts = drawn_within(small.clone(), &scene);
        let expected = if wireframe { drawn_within(wgpu::Limits::defaults(), &scene) } else { whole.clone() };
        let differing = parts.pixels().zip(expected.pixels()).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "wireframe {wireframe}");
    }
}

#[test]
fn meshes_beyond_the_device_leave_the_background() {
    let tiny =
        wgpu::Limits { max_buffer_size: 16_384, max_storage_buffer_binding_size: 16_384, ..wgpu::Limits::defaults() };
    let headless = Headless::with_limits(tiny).expect("any adapter; `apt-get install mesa-vulkan-drivers`");
    let mut renderer = Renderer::new(&headless.device, &headless.queue, 1);
    renderer.render(&sheet(CELLS), [16, 16]);
    let picture = renderer.try_read_pixels().expect("the picture can be read");
    assert_eq!(headless.take_error(), None, "the device complained");
    assert_eq!(n_dark(&picture), 0, "only the light background");
}

#[test]
fn the_ground_rests_while_the_surface_moves() {
    let headless = Headless::new().unwrap_or_else(|error| panic!("{error}"));
    let mut renderer = Renderer::new(&headless.device, &headless.queue, 1);
    let mut scene = ViewScene { grid: true, ..sheet(CELLS) };
    scene.camera = Camera::framing(scene.bounds.0, scene.bounds.1);
    let mut ground_with = |scene: &ViewScene| {
        renderer.render(scene, SIZE);
        // The lower corners show ground only.
        renderer
            .read_pixels()
            .enumerate_pixels()
            .filter(|(x, y, _)| *y > 80 && *x < 30)
            .map(|(_, _, px)| px.0)
            .collect::<Vec<_>>()
    };
    let before = ground_with(&scene);
    assert!(ground_with(&ViewScene { grid: false, ..scene.clone() }) != before, "there are lines to see");
    let positions = scene.frame.positions.iter().map(|p| Vec3::new(p.x, p.y.max(-0.5), p.z)).collect();
    let moved = ViewScene {
        frame: Arc::new(SurfaceFrame { positions, normals: scene.frame.normals.clone() }),
        bounds: (Vec3::new(-1.0, -0.5, 0.0), scene.bounds.1),
        ..scene.clone()
    };
    assert!(ground_with(&moved) == before, "the ground moved with the surface");
}
