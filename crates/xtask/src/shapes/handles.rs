//! Which vertices are held and where they go, as a file for `pliant deform --handles`.

use super::Shape;
use glam::{DMat4, DVec3};
use serde_json::{Value, json};

/// What an `H.json` holds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Handles {
    /// Vertices held where they are.
    pub(crate) fixed: Vec<u32>,
    /// Vertices with the place they go to.
    pub(crate) moved: Vec<(u32, DVec3)>,
    /// Patches moved by a matrix applied to rest positions.
    pub(crate) groups: Vec<(Vec<u32>, DMat4)>,
}

impl Handles {
    /// Every held vertex with the place it goes to.
    pub(crate) fn targets(&self, shape: &Shape) -> Vec<(u32, DVec3)> {
        let at = |v: u32| shape.positions[v as usize];
        let fixed = self.fixed.iter().map(|&v| (v, at(v)));
        let grouped = self
            .groups
            .iter()
            .flat_map(|(vertices, matrix)| vertices.iter().map(|&v| (v, matrix.transform_point3(at(v)))));
        fixed.chain(self.moved.iter().copied()).chain(grouped).collect()
    }

    /// The file: a line a key, and a line a moved vertex or group, so that differences read well.
    pub(crate) fn to_json(&self) -> String {
        let mut sections = vec![format!("  \"fixed\": {}", json!(self.fixed))];
        if !self.moved.is_empty() {
            let to_line = |(v, to): &(u32, DVec3)| json!({ "vertex": v, "to": to.to_array() });
            sections.push(lines("moved", self.moved.iter().map(to_line)));
        }
        if !self.groups.is_empty() {
            let to_line =
                |(vertices, m): &(Vec<u32>, DMat4)| json!({ "vertices": vertices, "matrix": m.to_cols_array() });
            sections.push(lines("groups", self.groups.iter().map(to_line)));
        }
        format!("{{\n{}\n}}\n", sections.join(",\n"))
    }
}

fn lines(key: &str, values: impl Iterator<Item = Value>) -> String {
    let values: Vec<String> = values.map(|v| format!("    {v}")).collect();
    format!("  \"{key}\": [\n{}\n  ]", values.join(",\n"))
}

/// Turns by `degrees` about the unit vector `axis` through `pivot` (right-handed), then shifts. Rodrigues' formula
/// with the sine and cosine of `libm`, so that every machine writes the same digits.
pub(crate) fn turn_and_shift(pivot: DVec3, axis: DVec3, degrees: f64, shift: DVec3) -> DMat4 {
    let (sin, cos) = sine_and_cosine(degrees);
    let column = |e: DVec3| e * cos + axis.cross(e) * sin + axis * (axis.dot(e) * (1.0 - cos));
    let (x, y, z) = (column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
    let to = pivot + shift - (x * pivot.x + y * pivot.y + z * pivot.z);
    DMat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), to.extend(1.0))
}

/// Sine and cosine of an angle in degrees, the same bits everywhere.
pub(crate) fn sine_and_cosine(degrees: f64) -> (f64, f64) {
    let radians = degrees * (std::f64::consts::PI / 180.0);
    (libm::sin(radians), libm::cos(radians))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_keeps_the_pivot_and_turns_by_the_right_hand() {
        let pivot = DVec3::new(1.0, 2.0, 3.0);
        let m = turn_and_shift(pivot, DVec3::Z, 90.0, DVec3::X);
        assert!(m.transform_point3(pivot).distance(pivot + DVec3::X) < 1e-12);
        assert!(m.transform_point3(pivot + DVec3::X).distance(pivot + DVec3::X + DVec3::Y) < 1e-12);
    }

    #[test]
    fn files_are_json_with_the_documented_keys() {
        let handles = Handles {
            fixed: vec![1, 2],
            moved: vec![(3, DVec3::new(0.1, 2.0, 0.0))],
            groups: vec![(vec![4, 5], DMat4::IDENTITY)],
        };
        let value: Value = serde_json::from_str(&handles.to_json()).expect("valid JSON");
        assert_eq!(value["fixed"], json!([1, 2]));
        assert_eq!(value["moved"], json!([{ "vertex": 3, "to": [0.1, 2.0, 0.0] }]));
        assert_eq!(value["groups"][0]["matrix"][15], json!(1.0));
    }
}
