//! Handles on a square of two triangles whose second corner is doubled (vertices 1 and 4 are one point).

use super::*;

fn square() -> MeshFile {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]];
    let positions = corners.map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
    MeshFile::from_triangles("square", positions, vec![[0, 1, 2], [0, 2, 3]])
}

/// A square whose vertices 1 and 4 are welded, whatever the file layer itself welds.
fn welded_square() -> MeshFile {
    let mut mesh = square();
    mesh.weld.point_of_vertex = vec![0, 1, 2, 3, 1];
    mesh.weld.vertex_of_point = vec![0, 1, 2, 3];
    mesh
}

fn check(json: &str) -> Result<Vec<(u32, [f64; 3])>, String> {
    let handles = parse(json.as_bytes(), &welded_square()).map_err(|problem| problem.to_string())?;
    let pairs = handles.held.iter().zip(&handles.targets);
    Ok(pairs.map(|(vertex, target)| (vertex.0, target.to_array())).collect())
}

#[track_caller]
fn refused(json: &str, words: &[&str]) {
    let message = check(json).expect_err(json);
    for word in words {
        assert!(message.contains(word), "{json}\nsays: {message}\nwithout: {word}");
    }
}

#[test]
fn each_kind_of_handle_reaches_its_target() {
    let json = r#"{"fixed": [0], "moved": [{"vertex": 4, "to": [5, 6, 7]}],
        "groups": [{"vertices": [2, 3], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 10,20,30,1]}]}"#;
    let expected = vec![(0, [0.0, 0.0, 0.0]), (1, [5.0, 6.0, 7.0]), (2, [11.0, 21.0, 30.0]), (3, [10.0, 21.0, 30.0])];
    assert_eq!(check(json), Ok(expected));
}

#[test]
fn a_matrix_is_read_column_by_column() {
    // A quarter turn about z sends x to y: the first column is (0, 1, 0).
    let json = r#"{"groups": [{"vertices": [1], "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 0,0,0,1]}]}"#;
    assert_eq!(check(json), Ok(vec![(1, [0.0, 1.0, 0.0])]));
}

#[test]
fn naming_a_point_twice_with_one_target_is_fine() {
    let json = r#"{"fixed": [1, 4, 1], "moved": [{"vertex": 4, "to": [1, 0, 0]}]}"#;
    assert_eq!(check(json), Ok(vec![(1, [1.0, 0.0, 0.0])]));
}

#[test]
fn two_targets_for_one_point_are_refused_with_both_places() {
    refused(
        r#"{"fixed": [1], "moved": [{"vertex": 4, "to": [1, 0, 0.5]}]}"#,
        &["moved[0].vertex (vertex 4)", "fixed[0] (vertex 1)", "two places"],
    );
}

#[test]
fn vertices_past_the_end_are_refused_with_their_place() {
    refused(r#"{"fixed": [0, 5]}"#, &["fixed[1] is 5", "5 vertices (0 to 4)"]);
    refused(r#"{"moved": [{"vertex": 9000, "to": [0, 0, 0]}]}"#, &["moved[0].vertex is 9000"]);
    let huge = r#"{"groups": [{"vertices": [0, 18446744073709551615], "matrix": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]}"#;
    refused(huge, &["groups[0].vertices[1] is 18446744073709551615"]);
}

#[test]
fn malformed_files_are_refused_with_a_line_number() {
    for json in ["", "{", "[]", "7", "{\"fixed\": 3}", "{\"fixed\": [-1]}", "{\"fixed\": [1.5]}", "{\"fixed\": [0]} x"]
    {
        refused(json, &["not a handles file", "line 1"]);
    }
    refused(r#"{"moved": [{"vertex": 1, "to": [0, 0]}]}"#, &["line 1"]);
    refused(r#"{"moved": [{"vertex": 1, "to": [0, 0, 1e999]}]}"#, &["out of range"]);
    refused(r#"{"moved": [[1, [0, 0, 0]]]}"#, &["an object with keys", "line 1"]);
    refused(r#"{"moved": [{"vertex": 1}]}"#, &["missing field `to`"]);
}

#[test]
fn unknown_keys_are_refused_at_every_level() {
    refused(r#"{"fixed": [0], "pinned": []}"#, &["unknown field `pinned`"]);
    refused(r#"{"moved": [{"vertex": 1, "to": [0, 0, 0], "weight": 1}]}"#, &["unknown field `weight`"]);
    refused(r#"{"groups": [{"vertices": [], "matrix": [], "name": ""}]}"#, &["unknown field `name`"]);
}

#[test]
fn matrices_that_are_not_affine_are_refused() {
    refused(r#"{"groups": [{"vertices": [0], "matrix": [1, 2, 3]}]}"#, &["groups[0].matrix", "3 numbers", "16"]);
    let row_major = r#"{"groups": [{"vertices": [0], "matrix": [1,0,0,5, 0,1,0,6, 0,0,1,7, 0,0,0,1]}]}"#;
    refused(row_major, &["last row", "column by column"]);
    let huge = r#"{"groups": [{"vertices": [1], "matrix": [1e308,0,0,0, 0,1,0,0, 0,0,1,0, 1e308,0,0,1]}]}"#;
    refused(huge, &["groups[0].vertices[0] is 1", "not a number up to 1e100"]);
}

#[test]
fn targets_too_far_away_to_be_squared_are_refused_with_their_place() {
    refused(r#"{"moved": [{"vertex": 2, "to": [0, -2e100, 0]}]}"#, &["moved[0].vertex is 2", "1e100"]);
    assert_eq!(check(r#"{"moved": [{"vertex": 2, "to": [0, -1e100, 0]}]}"#), Ok(vec![(2, [0.0, -1e100, 0.0])]));
}

#[test]
fn no_handles_at_all_are_refused() {
    for json in ["{}", r#"{"fixed": []}"#, r#"{"fixed": [], "moved": [], "groups": []}"#] {
        refused(json, &["no handles at all"]);
    }
}
