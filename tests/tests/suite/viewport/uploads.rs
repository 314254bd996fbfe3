//! What a picture costs to bring to the device: only what changed.

use super::*;

/// Uniforms of a picture: two matrices and twenty vectors, with room.
const UNIFORMS: u64 = 600;

#[test]
fn only_what_changed_is_brought_to_the_device() {
    let Headless { device, queue, .. } = headless();
    let mut renderer = Renderer::new(device, queue, 1);
    let scene = ViewScene { coloring: Coloring::Rigidity, ..ball(64, 1.0) };
    let n = scene.frame.positions.len() as u64;
    renderer.render(&scene, SIZE);
    let all = renderer.uploaded_bytes();
    // Corners, and four bits that tell which edges are lines.
    let whole_mesh = n * (12 + 12 + 4) + scene.triangles.len() as u64 * 12 + scene.triangles.len() as u64 / 2;
    assert!((whole_mesh..whole_mesh + UNIFORMS).contains(&all), "the first picture: {all} of {whole_mesh}");

    renderer.render(&scene.clone(), SIZE);
    assert_eq!(renderer.uploaded_bytes(), 0, "the same picture");

    let mut turned = scene.clone();
    turned.camera.orbit(Vec2::new(30.0, 10.0));
    let frame = Arc::new(SurfaceFrame {
        positions: scene.frame.positions.iter().map(|p| *p * 0.9).collect(),
        normals: scene.frame.normals.clone(),
    });
    let painted: Arc<[u16]> = vec![4; n as usize].into();
    let dots: Arc<[Dot]> = [Dot { position: Vec3::Z, color: YELLOW, radius_px: 5.0 }].into();
    for (what, changed, most) in [
        ("the camera", turned.clone(), 0),
        ("the theme", ViewScene { grid: true, ..turned.clone() }, 0),
        ("positions", ViewScene { frame, ..turned.clone() }, n * 24),
        ("colors", ViewScene { rigidity: painted, ..turned.clone() }, n * 4),
        ("a dot", ViewScene { dots, ..turned.clone() }, 20),
        ("shading", ViewScene { shading: Shading::Matcap(Matcap::Clay), ..turned.clone() }, 0),
        ("x-ray", ViewScene { see_through: true, ..turned.clone() }, 0),
        ("lines", ViewScene { wireframe: true, ..turned.clone() }, 0),
    ] {
        renderer.render(&turned, SIZE);
        renderer.render(&changed, SIZE);
        let got = renderer.uploaded_bytes();
        assert!((most..most + UNIFORMS).contains(&got), "{what}: {got} bytes for what takes {most}");
    }
}

#[test]
fn a_second_picture_on_the_device_is_drawn_like_the_first() {
    let Headless { device, queue, .. } = headless();
    let mut first = Renderer::new(device, queue, 1);
    let mut second = first.sibling();
    let (a, b) = (ball(16, 1.0), ViewScene { wireframe: true, ..ball(8, 1.0) });
    first.render(&a, SIZE);
    second.render(&b, SIZE);
    let (one, other) = (first.read_pixels(), second.read_pixels());
    first.render(&b, SIZE);
    second.render(&a, SIZE);
    assert_eq!(differing(&first.read_pixels(), &other, 0), 0);
    assert_eq!(differing(&second.read_pixels(), &one, 0), 0);
}
