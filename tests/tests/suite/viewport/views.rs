//! Ways to look at a surface: materials, through it, its own polygons, its textures, its flaws.

use super::*;

#[test]
fn painted_balls_differ_from_each_other_and_take_the_color_of_the_surface() {
    let plain = ball(32, 1.0);
    let at_ball = Vec3::new(-0.2, 0.1, 0.97);
    let mut seen = vec![draw(&plain)];
    for matcap in Matcap::ALL {
        let scene = ViewScene { shading: Shading::Matcap(matcap), ..plain.clone() };
        let picture = draw(&scene);
        for (k, other) in seen.iter().enumerate() {
            let changed = differing(&picture, other, 8);
            assert!(changed > 1500, "{matcap:?} and shading {k}: {changed} pixels differ");
        }
        let reddish: Arc<[[u8; 4]]> = vec![[200, 20, 20, 255]; plain.frame.positions.len()].into();
        let colored = ViewScene { base_colors: Some(reddish), ..scene.clone() };
        // Stripes are dark somewhere: the reddest of a few places.
        let red = |picture: &RgbaImage| {
            let places = (-3..=3).map(|k| at_ball + Vec3::new(k as f32 * 0.08, 0.0, 0.0));
            places.map(|place| at(picture, &scene, place)).map(|[r, _, b]| r - b).fold(f32::MIN, f32::max)
        };
        let (gray, red) = (red(&picture), red(&draw(&colored)));
        assert!(red > gray + 40.0, "{matcap:?}: red over blue {red}, of clay {gray}");
        seen.push(picture);
    }
}

#[test]
fn painted_balls_do_not_depend_on_the_side_one_looks_from() {
    let mut scene = ViewScene { shading: Shading::Matcap(Matcap::Metal), ..ball(48, 1.0) };
    scene.camera.projection = Projection::Orthographic;
    let front = draw(&scene);
    scene.camera.orbit(Vec2::new(170.0, 0.0));
    // Rounding along the edges of stripes of light.
    let changed = differing(&front, &draw(&scene), 24);
    assert!(changed < 150, "{changed} pixels differ");
}

#[test]
fn an_x_ray_shows_what_is_behind_and_keeps_the_outline() {
    let ground = ball(32, 1.0);
    let behind: Arc<[Dot]> = [Dot { position: Vec3::new(0.3, -0.2, -0.93), color: YELLOW, radius_px: 5.0 }].into();
    let scene = ViewScene { dots: behind.clone(), see_through: true, ..ground.clone() };
    let picture = draw(&scene);
    let dot = at(&picture, &scene, behind[0].position);
    assert!(difference(dot, [255.0, 210.0, 40.0]) <= 2.0, "a handle behind the surface: {dot:?}");
    let empty = draw(&ViewScene { triangles: Arc::new([]), ..ground.clone() });
    let opaque = draw(&ground);
    let middle = Vec3::new(-0.2, 0.25, 0.94);
    let [seen, full, back] = [&picture, &opaque, &empty].map(|picture| brightness(at(picture, &ground, middle)));
    assert!(seen > back + 5.0 && seen < full - 25.0, "in the middle: {seen}, opaque {full}, background {back}");
    let rim = Vec3::new(-0.86, 0.48, 0.17);
    let share = |place| {
        let [seen, full, back] = [&picture, &opaque, &empty].map(|picture| brightness(at(picture, &ground, place)));
        (seen - back) / (full - back)
    };
    assert!(share(rim) > share(middle) + 0.15, "outline {}, middle {}", share(rim), share(middle));
}

/// A square of two triangles in front of the camera, filling most of the picture.
fn square() -> ViewScene {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
    let bounds = (Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 0.0));
    let mut camera = Camera::framing(bounds.0, bounds.1);
    camera.look_along(Axis::Front);
    let frame = Arc::new(SurfaceFrame { positions: corners.to_vec(), normals: vec![Vec3::Z; 4] });
    ViewScene::plain([[0, 1, 2], [0, 2, 3]].into(), frame, camera, bounds)
}

#[test]
fn lines_are_drawn_on_the_edges_of_polygons_and_not_where_they_were_cut() {
    let plain = square();
    let all = ViewScene { wireframe: true, ..plain.clone() };
    let own = ViewScene { unmarked_edges: Some([0b010, 0b100].into()), ..all.clone() };
    let (without, all, own) = (draw(&plain), draw(&all), draw(&own));
    let diagonal = |picture: &RgbaImage| brightness(at(picture, &plain, Vec3::new(0.31, 0.31, 0.0)));
    assert!(diagonal(&all) < diagonal(&without) - 20.0, "cut: {} of {}", diagonal(&all), diagonal(&without));
    assert_eq!(diagonal(&own), diagonal(&without), "no line where the polygon was cut");
    // Half a pixel inside the lower side.
    let side = |picture: &RgbaImage| brightness(at(picture, &plain, Vec3::new(0.3, -0.995, 0.0)));
    assert!(side(&own) < side(&without) - 20.0, "the side of the polygon: {} of {}", side(&own), side(&without));
}

#[test]
fn flaws_are_striped_and_shine_faintly_through_the_surface() {
    let plain = ball(24, 1.0);
    let facing = |z: f32| -> Arc<[[u32; 3]]> {
        let there = |t: &&[u32; 3]| t.iter().all(|&v| plain.frame.positions[v as usize].z * z > 0.8);
        plain.triangles.iter().filter(there).copied().collect()
    };
    let without = draw(&plain);
    let reddest =
        |picture: &RgbaImage| (90..112).map(|x| pixel(picture, x, 75)).map(|[r, g, _]| r - g).fold(f32::MIN, f32::max);
    let before = reddest(&without);
    let front = draw(&ViewScene { flaws: Some(facing(1.0)), ..plain.clone() });
    let inside = draw(&ViewScene { flaws: Some(facing(-1.0)), ..plain.clone() });
    assert!(reddest(&front) > before + 90.0, "in front: {} instead of {before}", reddest(&front));
    let faint = reddest(&inside) - before;
    assert!(faint > 15.0 && faint < 90.0, "behind: {faint} more than {before}");
    let row: Vec<f32> = (85..117).map(|x| brightness(pixel(&front, x, 75))).collect();
    let jump = row.windows(2).map(|pair| (pair[0] - pair[1]).abs()).fold(0.0, f32::max);
    assert!(jump > 30.0, "stripes: the largest step is {jump}");
    let xray = draw(&ViewScene { flaws: Some(facing(-1.0)), see_through: true, ..plain.clone() });
    assert!(reddest(&xray) > before + 90.0, "through the surface: {}", reddest(&xray));
}

#[test]
fn twice_the_pixels_show_the_same_picture_twice_as_fine() {
    let Headless { device, queue, .. } = headless();
    let mut renderer = Renderer::new(device, queue, 4);
    let scene = ViewScene { wireframe: true, see_through: true, ..ball(8, 1.0) };
    let mut draw = |scene: &ViewScene, scale: u32| {
        renderer.render(scene, SIZE.map(|side| side * scale));
        renderer.read_pixels()
    };
    let coarse = draw(&scene, 1);
    let fine = draw(&ViewScene { pixels_per_point: 2.0, ..scene }, 2);
    let halved = image::imageops::resize(&fine, SIZE[0], SIZE[1], image::imageops::FilterType::Triangle);
    // Lines are equally wide in points; their edges are smoothed over half as much.
    let changed = differing(&coarse, &halved, 40);
    assert!(changed < 400, "{changed} of {} pixels differ", SIZE[0] * SIZE[1]);
}

/// A texture of two by two fields: red, green above; blue, white below.
fn checker() -> Texture {
    let colors = [[230, 20, 20, 255], [20, 200, 20, 255], [20, 20, 230, 255], [240, 240, 240, 255]];
    let field = |x: u32, y: u32| colors[(x / 8 + 2 * (y / 8)) as usize];
    Texture::new(RgbaImage::from_fn(16, 16, |x, y| image::Rgba(field(x, y))), [Wrap::Repeat; 2])
}

/// The square with its texture upright.
fn textured() -> ViewScene {
    let uv = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    let set = TextureSet {
        images: vec![checker()],
        runs: vec![(0..2, Some(0))],
        uvs: vec![[uv[0], uv[1], uv[2]], [uv[0], uv[2], uv[3]]],
    };
    ViewScene { textures: Some(Arc::new(set)), ..square() }
}

#[test]
fn textures_lie_upright_on_the_surface_under_the_ramp() {
    let scene = textured();
    let place = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    for wireframe in [false, true] {
        let scene = ViewScene { wireframe, ..scene.clone() };
        let picture = draw(&scene);
        for (name, x, y, strongest) in [("red", -0.5, 0.45, 0), ("green", 0.45, 0.5, 1), ("blue", -0.45, -0.5, 2)] {
            let color = at(&picture, &scene, place(x, y));
            let others = (0..3).filter(|c| *c != strongest).map(|c| color[c]).fold(0.0, f32::max);
            assert!(color[strongest] > others + 60.0, "{name}, wireframe {wireframe}: {color:?}");
        }
        let [r, g, b] = at(&picture, &scene, place(0.5, -0.45));
        assert!(r > 150.0 && (r - b).abs() < 25.0 && (r - g).abs() < 25.0, "white: {r} {g} {b}");
    }
    let ramp = ViewScene { coloring: Coloring::Rigidity, ..scene.clone() };
    let covered = draw(&ramp);
    let bare = draw(&ViewScene { textures: None, ..ramp.clone() });
    assert_eq!(differing(&covered, &bare, 2), 0, "an opaque ramp covers the texture");
    let half = ViewScene { color_opacity: 0.5, ..ramp };
    let [r, _, b] = at(&draw(&half), &half, place(-0.5, 0.45));
    let [full_r, _, full_b] = at(&draw(&scene), &scene, place(-0.5, 0.45));
    assert!(r > 60.0 && r - b < full_r - full_b - 40.0, "soft blue over red: red {r}, blue {b}");
}

#[test]
fn what_is_less_than_half_opaque_is_cut_out_of_the_surface_and_of_its_depth() {
    let scene = textured();
    // The left half is cut out; a dot lies behind each half.
    let left = |x: u32, _: u32| image::Rgba([200, 200, 200, if x < 8 { 60 } else { 255 }]);
    let set = TextureSet {
        images: vec![Texture::new(RgbaImage::from_fn(16, 16, left), [Wrap::Clamp; 2])],
        ..TextureSet::clone(scene.textures.as_deref().expect("textures"))
    };
    let dots = [-0.5, 0.5].map(|x| Dot { position: Vec3::new(x, 0.3, -1.0), color: YELLOW, radius_px: 6.0 });
    let empty = draw(&ViewScene { triangles: Arc::new([]), textures: None, ..scene.clone() });
    for (wireframe, see_through) in [(false, false), (true, false), (false, true)] {
        let cut = ViewScene { textures: Some(Arc::new(set.clone())), wireframe, see_through, ..scene.clone() };
        let picture = draw(&cut);
        let (gone, there) = (Vec3::new(-0.4, -0.5, 0.0), Vec3::new(0.4, -0.5, 0.0));
        let far = |place| difference(at(&picture, &cut, place), at(&empty, &cut, place));
        assert!(far(gone) <= 2.0, "something is left of the cut out half: {}", far(gone));
        assert!(far(there) > 20.0, "the other half is gone: {}", far(there));
    }
    let cut = ViewScene { textures: Some(Arc::new(set)), dots: dots.into(), ..scene };
    let picture = draw(&cut);
    let yellow = |dot: &Dot| difference(at(&picture, &cut, dot.position), [255.0, 210.0, 40.0]);
    assert!(yellow(&dots[0]) <= 2.0, "seen through the hole it is dimmed: {}", yellow(&dots[0]));
    assert!(yellow(&dots[1]) > 60.0, "behind the surface it is not: {}", yellow(&dots[1]));
}

#[test]
fn a_texture_belongs_to_its_run_of_triangles_and_is_brought_once() {
    let Headless { device, queue, .. } = headless();
    let mut renderer = Renderer::new(device, queue, 1);
    let mut scene = textured();
    renderer.render(&scene, SIZE);
    let mut turned = scene.clone();
    turned.camera.orbit(Vec2::new(3.0, 0.0));
    renderer.render(&turned, SIZE);
    assert!(renderer.uploaded_bytes() < 600, "{} bytes for a turned camera", renderer.uploaded_bytes());
    let set = TextureSet {
        runs: vec![(0..1, None), (1..2, Some(0))],
        ..TextureSet::clone(scene.textures.as_deref().expect("textures"))
    };
    scene.textures = Some(Arc::new(set));
    let picture = draw(&scene);
    let [r, g, b] = at(&picture, &scene, Vec3::new(0.8, 0.4, 0.0));
    assert!((r - g).abs() < 20.0 && (r - b).abs() < 20.0, "the triangle without texture: {r} {g} {b}");
    let [r, g, _] = at(&picture, &scene, Vec3::new(-0.8, 0.4, 0.0));
    assert!(r > g + 60.0, "the one with it: {r} {g}");
}
