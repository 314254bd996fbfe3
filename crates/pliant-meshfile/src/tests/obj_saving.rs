//! OBJ in, the same OBJ out.

use super::support::{OBJ, bent, obj, saved};
use glam::DVec3;

#[test]
fn saving_an_untouched_obj_gives_the_same_bytes() {
    let ends = ["\n", "\r\n", "\r"];
    for end in ends {
        let text = OBJ.replace('\n', end);
        let file = obj(&text);
        let (bytes, _) = saved(&file, "same.obj", &file.points(), None);
        assert_eq!(String::from_utf8_lossy(&bytes), text);
    }
}

#[test]
fn saving_a_bent_obj_changes_only_numbers_of_v_and_vn_lines() {
    let file = obj(OBJ);
    let points = bent(&file.points());
    let (bytes, again) = saved(&file, "bent.obj", &points, None);
    let text = String::from_utf8(bytes).expect("text");
    assert_eq!(text.lines().count(), OBJ.lines().count());
    for (line, (new, old)) in text.lines().zip(OBJ.lines()).enumerate() {
        let geometry = old.starts_with("v ") || old.starts_with("vn ");
        assert!(geometry || new == old, "line {}: got {new}, expected {old}", line + 1);
    }
    assert!(text.contains(" # keep\n"), "the comment behind a vertex stays");
    assert!(text.contains("v 0 0 0\n"), "a vertex that did not move keeps its digits");
    assert_eq!(again.points(), points, "OBJ holds positions to the bit");
    assert_eq!(again.triangles, file.triangles);
}

#[test]
fn every_way_of_writing_a_face_is_read() {
    let text = "\u{feff}v 0 0 0 1 0 0\nv 1 0 0 0 1 0\r\nv 1 1 \\\n0 0 0 1\rv 0 1 0\nf -4 -3 -2\nf 1 3 4 # end\n";
    let file = obj(text);
    assert_eq!(file.triangles, [[0, 1, 2], [0, 2, 3]]);
    let colors = file.colors.expect("colors");
    assert_eq!(colors[2], [0.0, 0.0, 1.0, 1.0]);
    assert_eq!(colors[3], [1.0; 4]);
}

#[test]
fn names_may_be_of_any_encoding() {
    let mut bytes = b"o caf\xe9\nusemtl \xff\n".to_vec();
    bytes.extend(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let file = crate::from_bytes(&bytes, crate::Format::Obj, "x").expect("a mesh");
    let points: Vec<DVec3> = file.points().iter().map(|p| *p * 2.0).collect();
    let (out, _) = saved(&file, "x.obj", &points, None);
    assert!(out.starts_with(b"o caf\xe9\nusemtl \xff\n"), "names keep their bytes");
}

#[test]
fn normals_that_cannot_follow_all_their_vertices_are_told() {
    // A strip of two quads with one normal for all six corners.
    let text = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nvn 0 0 1\nf 1//1 2//1 5//1 4//1\n\
                f 2//1 3//1 6//1 5//1\n";
    let file = obj(text);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("bent.obj");
    let mut points = file.points();
    let turned: Vec<DVec3> = points.iter().map(|p| DVec3::new(p.x, -p.z, p.y)).collect();
    assert_eq!(file.save(&path, &turned, None).expect("saved"), [], "turned as a whole");
    for point in [2, 5] {
        points[point] = DVec3::new(1.0, points[point].y, 1.0);
    }
    let warnings = file.save(&path, &points, None).expect("saved");
    let expected = "shading is approximate where one vn line serves vertices that turn apart (lines: 1)";
    assert_eq!(warnings.iter().map(|w| w.0.as_str()).collect::<Vec<_>>(), [expected]);
}

#[test]
fn rigidity_lives_in_a_sidecar() {
    let file = obj(OBJ);
    let (_, again) = saved(&file, "r.obj", &file.points(), Some(&[1, 2, 3, 4, 1000]));
    assert_eq!(again.rigidity.as_deref(), Some(&[1, 2, 3, 4, 1000][..]));
}

#[test]
fn a_sidecar_of_another_model_is_not_taken_over() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("out.obj");
    for stale in ["[9,9,9,9,9]", "[9]", "broken"] {
        std::fs::write(folder.path().join("out.rigidity.json"), stale).expect("a file");
        let file = obj(OBJ);
        let said = |warnings: Vec<crate::Warning>| warnings.iter().any(|w| w.0.contains("was another model's"));
        assert!(said(file.save(&path, &file.points(), None).expect("saved")), "{stale}");
        assert!(!said(file.save(&path, &file.points(), None).expect("saved")), "{stale}: said once");
        let again = crate::open(&path).unwrap_or_else(|error| panic!("{stale}: {error}"));
        assert_eq!(again.rigidity.as_deref(), Some(&[1; 5][..]), "{stale}");
    }
}

#[test]
fn a_sidecar_that_does_not_fit_says_why_it_is_read() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("m.obj");
    std::fs::write(&path, OBJ).expect("a file");
    let sidecar = folder.path().join("m.rigidity.json");
    std::fs::write(&sidecar, "[1, 2]").expect("a file");
    let error = crate::open(&path).expect_err("two entries").to_string();
    let expected = format!(
        "{}: holds 2 rigidities, the mesh has 5 vertices: one per vertex is needed; it is read because it lies beside \
         m.obj: correct, rename or delete it",
        sidecar.display()
    );
    assert_eq!(error, expected);
}

#[cfg(unix)]
#[test]
fn a_sidecar_that_leads_out_of_the_folder_is_not_followed() {
    let outer = tempfile::tempdir().expect("a temporary folder");
    let folder = outer.path().join("model");
    std::fs::create_dir(&folder).expect("a folder");
    let secret = "[1, 1, 1, 1, 1]";
    std::fs::write(outer.path().join("secret"), secret).expect("a file");
    std::fs::write(folder.join("m.obj"), OBJ).expect("a file");
    std::os::unix::fs::symlink(outer.path().join("secret"), folder.join("m.rigidity.json")).expect("a link");
    let error = crate::open(&folder.join("m.obj")).expect_err("a link out").to_string();
    assert!(error.contains("cannot be read: outside the folder"), "{error}");
    let file = obj(OBJ);
    file.save(&folder.join("m.obj"), &file.points(), None).expect("saved");
    let kept = std::fs::read_to_string(outer.path().join("secret")).expect("the file outside");
    assert_eq!(kept, secret, "nor is it written through");
    crate::open(&folder.join("m.obj")).expect("the link is replaced");
}

#[cfg(unix)]
#[test]
fn a_mesh_is_saved_through_a_link() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (link, real) = (folder.path().join("link.obj"), folder.path().join("real.obj"));
    std::fs::write(&real, OBJ).expect("a file");
    std::os::unix::fs::symlink(&real, &link).expect("a link");
    let file = crate::open(&link).expect("a mesh");
    file.save(&link, &bent(&file.points()), None).expect("saved");
    assert!(link.is_symlink());
    assert_eq!(crate::open(&real).expect("a mesh").points(), bent(&file.points()));
}

#[test]
fn tobj_reads_the_same_geometry() {
    let file = obj(OBJ);
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    // Material libraries are not looked for here.
    let none = |_: &std::path::Path| Ok((Vec::new(), Default::default()));
    // It takes a comment behind a vertex for a color.
    let text = OBJ.replace(" # keep", "");
    let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, none).expect("tobj reads it");
    let n: usize = models.iter().map(|m| m.mesh.indices.len() / 3).sum();
    assert!(n >= file.triangles.len(), "got {n}, expected {}", file.triangles.len());
    let place = |p: &[f32]| DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]));
    let first = &models[0].mesh;
    for (t, triangle) in file.triangles[..2].iter().enumerate() {
        for (k, &ours) in triangle.iter().enumerate() {
            let vertex = first.indices[3 * t + k] as usize;
            let theirs = place(&first.positions[3 * vertex..]);
            assert_eq!(file.positions[ours as usize], theirs, "triangle {t}, corner {k}");
        }
    }
}

#[test]
fn rounding_is_no_move() {
    let text = "v -0.0 1 2e0\nv 3.000 0 0\nv 0 3 0.5\nf 1 2 3\n";
    let file = obj(text);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let to = folder.path().join("same.obj");
    let mut points = file.points();
    points.iter_mut().for_each(|p| *p += DVec3::splat(3e-16));
    file.save(&to, &points, None).expect("saved");
    assert_eq!(std::fs::read_to_string(&to).expect("read"), text);
    points[1] = file.points()[1] + DVec3::X * 1e-9;
    file.save(&to, &points, None).expect("saved");
    let saved = std::fs::read_to_string(&to).expect("read");
    assert!(saved.starts_with("v -0.0 1 2e0\nv 3.000000001 0 0\n"), "{saved}");
}
