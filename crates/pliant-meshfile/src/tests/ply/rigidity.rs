//! r as the vertex property `rigidity`.

use super::model::{ENCODINGS, opened, ply, table, tables};
use crate::tests::support::saved;

#[test]
fn rigidity_is_appended_and_everything_else_stays() {
    let r = [1, 2, 3, 4, 1000];
    for encoding in ENCODINGS {
        let bytes = ply(encoding, "\r\n", &tables());
        let file = opened(&bytes);
        let (out, again) = saved(&file, "r.ply", &file.points(), Some(&r));
        assert_eq!(again.rigidity.as_deref(), Some(&r[..]), "{encoding}");
        assert_eq!(again.positions, file.positions, "{encoding}");
        assert_eq!(again.triangles, file.triangles, "{encoding}");
        let line = b"property ushort rigidity\r\n";
        let more = if encoding == "ascii" { " 1 2 3 4 1000".len() } else { 10 };
        assert_eq!(out.len(), bytes.len() + line.len() + more, "{encoding}");
        let (same, _) = saved(&again, "again.ply", &again.points(), Some(&r));
        assert_eq!(same, out, "{encoding}: the same r changes nothing");
    }
}

#[test]
fn rigidity_is_replaced_in_place_and_widened_where_it_must() {
    for encoding in ENCODINGS {
        for (scalar, r, kept) in
            [("uchar", [1, 2, 255], true), ("uchar", [1, 256, 3], false), ("int", [7, 8, 1000], true)]
        {
            let rigidity: &'static str = format!("{scalar} rigidity").leak();
            let properties = ["float x", rigidity, "float y", "float z"];
            let rows: &[&[f64]] = &[&[0.0, 1.0, 0.0, 0.0], &[1.0, 2.0, 0.0, 0.0], &[0.0, 3.0, 1.0, 0.0]];
            let faces = table("face", &["list uchar int vertex_indices"], &[&[3.0, 0.0, 1.0, 2.0]]);
            let bytes = ply(encoding, "\n", &[table("vertex", &properties, rows), faces]);
            let file = opened(&bytes);
            assert_eq!(file.rigidity.as_deref(), Some(&[1, 2, 3][..]), "{encoding} {scalar}");
            let (out, again) = saved(&file, "r.ply", &file.points(), Some(&r));
            assert_eq!(again.rigidity.as_deref(), Some(&r[..]), "{encoding} {scalar}");
            assert_eq!(again.positions, file.positions, "{encoding} {scalar}");
            let text = String::from_utf8_lossy(&out).into_owned();
            let declared = if kept { scalar } else { "ushort" };
            assert!(
                text.contains(&format!("x\nproperty {declared} rigidity\nproperty float y\n")),
                "{encoding} {scalar}"
            );
            let (kept, _) = saved(&file, "kept.ply", &file.points(), None);
            assert_eq!(kept, bytes, "{encoding} {scalar}: without a new r the old one stays");
        }
    }
}

#[test]
fn a_property_of_that_name_that_means_something_else_is_told() {
    let properties = ["float x", "float y", "float z", "float rigidity"];
    let rows: &[&[f64]] = &[&[0.0, 0.0, 0.0, 0.5], &[1.0, 0.0, 0.0, 1.0], &[0.0, 1.0, 0.0, 1.0]];
    let faces = table("face", &["list uchar int vertex_indices"], &[&[3.0, 0.0, 1.0, 2.0]]);
    let file = opened(&ply("ascii", "\n", &[table("vertex", &properties, rows), faces]));
    assert_eq!(file.rigidity, None);
    let expected = "the property rigidity is 0.5 at vertex 0, not a whole number from 1 to 1000: it is not read";
    assert_eq!(file.warnings.iter().map(|w| w.0.as_str()).collect::<Vec<_>>(), [expected]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let warnings = file.save(&folder.path().join("r.ply"), &file.points(), Some(&[4, 5, 6])).expect("saved");
    assert!(warnings[0].0.contains("the property rigidity, which was not read, was replaced"), "{warnings:?}");
    let again = crate::open(&folder.path().join("r.ply")).expect("a mesh");
    assert_eq!(again.rigidity.as_deref(), Some(&[4, 5, 6][..]));
}
