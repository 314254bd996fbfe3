//! `--rigidity N|FILE`: r of every surface point, from the option, else from the mesh file, else 1.

use std::path::Path;

use pliant_meshfile::{MeshFile, read_rigidity};
use pliant_solver::Rigidity;

use super::failure::Failure;

/// r of every surface point and where it came from.
#[derive(Debug)]
pub(super) struct ChosenRigidity {
    pub(super) rigidity: Rigidity,
    /// Asked for or found in the file, rather than the default: then it belongs into what is written.
    pub(super) is_explicit: bool,
    /// Welded vertices disagreed, and the largest r was taken.
    pub(super) warning: Option<String>,
}

/// Reads what `--rigidity` asks for; a whole number is never taken for a file name.
pub(super) fn choose(wish: Option<&str>, mesh: &MeshFile) -> Result<ChosenRigidity, Failure> {
    choose_by("--rigidity", wish, mesh)
}

/// The same for another option.
pub(super) fn choose_by(option: &'static str, wish: Option<&str>, mesh: &MeshFile) -> Result<ChosenRigidity, Failure> {
    match wish {
        Some(text) => match text.parse::<i128>() {
            Ok(number) => uniform(option, number, mesh),
            Err(_) => from_file(Path::new(text), mesh),
        },
        None => carried(mesh),
    }
}

/// r = 1 everywhere, whatever the file says: plain ARAP.
pub(super) fn ones(mesh: &MeshFile) -> ChosenRigidity {
    let rigidity = Rigidity::uniform(mesh.weld.n_points(), 1);
    ChosenRigidity { rigidity, is_explicit: false, warning: None }
}

fn uniform(option: &'static str, number: i128, mesh: &MeshFile) -> Result<ChosenRigidity, Failure> {
    let r = u16::try_from(number).ok().filter(|r| (1..=Rigidity::MAX).contains(r));
    let r = r.ok_or_else(|| Failure::OutOfRange {
        option,
        value: number.to_string(),
        // Rigidity::MAX in words, checked by a test.
        allowed: "between 1 and 1000",
    })?;
    let rigidity = Rigidity::uniform(mesh.weld.n_points(), r);
    Ok(ChosenRigidity { rigidity, is_explicit: true, warning: None })
}

fn from_file(path: &Path, mesh: &MeshFile) -> Result<ChosenRigidity, Failure> {
    let per_vertex = read_rigidity(path, mesh.positions.len())?;
    // One r a surface point: the largest among its vertices.
    let mut per_point = vec![0_u16; mesh.weld.n_points()];
    for (&point, &r) in mesh.weld.point_of_vertex.iter().zip(&per_vertex) {
        let largest = &mut per_point[point as usize];
        *largest = r.max(*largest);
    }
    let disagree = mesh.weld.point_of_vertex.iter().zip(&per_vertex).any(|(&point, &r)| per_point[point as usize] != r);
    Ok(explicit(per_point, disagree, path))
}

fn carried(mesh: &MeshFile) -> Result<ChosenRigidity, Failure> {
    let Some((per_point, disagree)) = mesh.point_rigidity() else {
        return Ok(ones(mesh));
    };
    Ok(explicit(per_point, disagree, mesh.path.as_deref().unwrap_or(Path::new(""))))
}

fn explicit(per_point: Vec<u16>, disagree: bool, path: &Path) -> ChosenRigidity {
    let warning = disagree.then(|| {
        format!("{}: vertices at one point of the surface disagree on r; the largest was taken", path.display())
    });
    let rigidity = Rigidity::new(per_point).expect("the file layer lets only r from 1 to 1000 through");
    ChosenRigidity { rigidity, is_explicit: true, warning }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn triangle() -> MeshFile {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        MeshFile::from_triangles("triangle", positions, vec![[0, 1, 2]])
    }

    #[test]
    fn a_number_is_rigidity_everywhere() {
        let chosen = choose(Some("7"), &triangle()).expect("in range");
        assert_eq!(chosen.rigidity.as_slice(), [7, 7, 7]);
        assert!(chosen.is_explicit);
    }

    #[test]
    fn without_any_wish_rigidity_is_one_and_is_not_written() {
        let chosen = choose(None, &triangle()).expect("nothing can be wrong");
        assert_eq!(chosen.rigidity.as_slice(), [1, 1, 1]);
        assert!(!chosen.is_explicit);
    }

    #[test]
    fn numbers_out_of_range_are_refused_with_the_range() {
        for wrong in ["0", "-3", "1001", "99999999999999999999"] {
            let message = choose(Some(wrong), &triangle()).expect_err(wrong).to_string();
            assert_eq!(message, format!("--rigidity is {wrong}, but must be between 1 and {}", Rigidity::MAX));
        }
    }
}
