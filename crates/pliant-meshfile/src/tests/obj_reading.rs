//! What OBJ text means, where readers get it wrong.

use super::support::obj;
use crate::open;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn names_without_faces_make_no_part() {
    let text = format!("{TRIANGLE}{}g last\nf 1 2 3\ng last\nf 1 2 3\n", "g none\nusemtl none\n".repeat(1000));
    let file = obj(&text);
    let parts: Vec<_> = file.parts.iter().map(|part| (part.name.as_str(), part.triangles.clone())).collect();
    assert_eq!(parts, [("last", 0..2)]);
}

#[test]
fn one_long_name_does_not_fill_the_memory() {
    let mut text = format!("{TRIANGLE}o {}\n", "é".repeat(1 << 20));
    for i in 0..1000 {
        text += &format!("usemtl m{i}\nf 1 2 3\n");
    }
    let file = obj(&text);
    assert_eq!(file.parts.len(), 1000);
    assert!(file.parts.iter().all(|part| part.name.len() <= 1024), "names are cut");
}

#[test]
fn numbers_for_display_are_always_finite() {
    let text = "v 0 0 0 nan 1 inf\nv 1 0 0 1e99 0 0\nv 0 1 0 0 0 1\nvt nan -inf\nvt 1e99\nvt 0.5 0.5\n\
                vn nan 0 1e99\nf 1/1/1 2/2/1 3/3/1\n";
    let file = obj(text);
    let uvs = file.uvs.as_ref().expect("coordinates");
    assert!(uvs.iter().all(|uv| uv.is_finite()), "{uvs:?}");
    let colors = file.colors.as_ref().expect("colors");
    assert!(colors.iter().flatten().all(|x| x.is_finite()), "{colors:?}");
    super::support::saved(&file, "finite.glb", &file.points(), None);
}

#[test]
fn material_libraries_are_found_by_whole_line_or_by_word() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("m.obj");
    let library = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    library("a.mtl", "newmtl red\r\nKd 1 0 0\r\nd 0.5\r\nnewmtl red\r\nKd 0 0 0\r\n");
    library("b.mtl", "Kd 9 9 9\nnewmtl my blue # 2\nKd 0 0 1\nKd spectral x.rfl\n");
    library("c d.mtl", "newmtl green\nKd 0 1 0\n");
    let text = "mtllib a.mtl b.mtl lost.mtl\nmtllib c d.mtl\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n\
                usemtl red\nf 1 2 3\nusemtl my blue # 2\nf 1 2 3\nusemtl green\nf 1 2 3\nusemtl none\nf 1 2 3\n";
    std::fs::write(&path, text).expect("a file");
    let file = open(&path).expect("a mesh");
    let colors: Vec<_> = file.parts.iter().map(|part| part.base_color).collect();
    let expected = [[1.0, 0.0, 0.0, 0.5], [0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.8, 0.8, 0.8, 1.0]];
    assert_eq!(colors, expected);
    let skipped: Vec<_> = file.warnings.iter().map(|w| w.0.split(" skipped").next().unwrap_or_default()).collect();
    assert_eq!(skipped, ["material library lost.mtl", "material library gone.mtl"]);
}
