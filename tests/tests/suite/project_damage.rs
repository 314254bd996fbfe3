//! Damaged projects whose checksums are right: each opens sound, or is refused by one clear line.

use std::ops::ControlFlow;
use std::path::Path;

use glam::{DAffine3, DVec3};
use pliant::document::{Command, Document, GroupKind, Model, PoseChange};
use pliant::project::{Contents, MeshChoice, open, save};
use pliant::viewport::Camera;
use pliant_solver::VertexId;
use pliant_tests::shapes;

/// Damaged projects that are tried: some seconds of work.
const N: u64 = 1500;
/// Before the first block of a project: mark, version, number of blocks, checksum.
const HEAD: usize = 20;

/// A project with a handle, rigidity, a selection and a kept pose, as it was saved.
fn project(folder: &Path) -> Vec<u8> {
    let mesh = folder.join("bar.obj");
    std::fs::write(&mesh, shapes::bar([3, 1, 1], [3.0, 1.0, 1.0]).obj()).expect("written");
    let mut document = Document::new(std::sync::Arc::new(Model::open(&mesh).expect("opens")));
    let hold = Command::Hold { kind: GroupKind::Handle, vertices: vec![VertexId(0), VertexId(1)] };
    let motion = DAffine3::from_translation(DVec3::Y);
    for command in [hold, Command::FillAll(3), Command::Poses(PoseChange::Keep)] {
        document.apply(command).expect("a good command");
    }
    let group = document.scene().groups[0].id;
    document.apply(Command::Move { group, motion }).expect("a good command");
    let to = folder.join("bar.pliant");
    let camera = Camera::framing(glam::Vec3::ZERO, glam::Vec3::ONE);
    save(&Contents::of(&document, camera), &to).expect("saved");
    std::fs::read(to).expect("read")
}

/// The blocks of a project.
fn blocks(project: &[u8]) -> Vec<Vec<u8>> {
    let (mut blocks, mut rest) = (Vec::new(), &project[HEAD..]);
    while let Some((length, behind)) = rest.split_first_chunk::<8>() {
        let (block, behind) = behind.split_at(u64::from_le_bytes(*length) as usize);
        blocks.push(block.to_vec());
        rest = &behind[4..];
    }
    blocks
}

/// A project of these blocks, with the checksums that belong to them.
fn sealed(head: &[u8], blocks: &[Vec<u8>]) -> Vec<u8> {
    let mut out = [&head[..12], &(blocks.len() as u32).to_le_bytes()].concat();
    out.extend(crc32fast::hash(&out).to_le_bytes());
    for (number, block) in (0_u32..).zip(blocks) {
        let length = (block.len() as u64).to_le_bytes();
        let told = [&number.to_le_bytes()[..], &length, block].concat();
        out.extend(length);
        out.extend(block);
        out.extend(crc32fast::hash(&told).to_le_bytes());
    }
    out
}

/// Numbers by chance, the same for the same seed.
struct Chance(u64);

impl Chance {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n.max(1) as u64) as usize
    }
}

/// Digits that break what counts with them, for the header; most of it is numbers.
const WORDS: [&[u8]; 8] = [b"0", b"-1", b"4294967295", b"18446744073709551616", b"1e400", b"null", b"[]", b"\"\""];

fn damage(blocks: &mut [Vec<u8>], chance: &mut Chance) {
    let which = if chance.below(2) == 0 { 0 } else { chance.below(blocks.len()) };
    let n = blocks[which].len();
    let at = chance.below(n);
    match chance.below(6) {
        0 if n > 0 => blocks[which][at] ^= 1 << chance.below(8),
        1 if n > 0 => blocks[which][at] = [0, 1, 0x7f, 0x80, 0xff][chance.below(5)],
        2 => blocks[which].truncate(at),
        3 => {
            let copied: Vec<u8> = blocks[which][at..(at + chance.below(64)).min(n)].to_vec();
            blocks[which].splice(at..at, copied);
        }
        4 if which == 0 => {
            // A number of the header becomes another.
            let is_digit = |k: &usize| blocks[0][*k].is_ascii_digit();
            let Some(start) = (at..n).find(is_digit) else { return };
            let end = (start..n).find(|k| !is_digit(k)).unwrap_or(n);
            blocks[0].splice(start..end, WORDS[chance.below(WORDS.len())].iter().copied());
        }
        _ => {
            let other = chance.below(blocks.len());
            blocks.swap(which, other);
        }
    }
}

#[test]
fn damage_behind_right_checksums_is_refused_by_one_line_or_opens_sound() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let whole = project(folder.path());
    let sound = blocks(&whole);
    assert_eq!(sealed(&whole, &sound), whole, "blocks are taken apart otherwise than they were put together");
    let file = folder.path().join("damaged.pliant");
    let (mut opened, mut refused) = (0, 0);
    for index in 0..N {
        let mut chance = Chance(0x9e37_79b9_7f4a_7c15 ^ (index + 1).wrapping_mul(0xd134_2543_de82_ef95));
        let mut blocks = sound.clone();
        for _ in 0..=chance.below(3) {
            damage(&mut blocks, &mut chance);
        }
        std::fs::write(&file, sealed(&whole, &blocks)).expect("written");
        match open(&file, &MeshChoice::Named, &mut |_| ControlFlow::Continue(())) {
            Err(error) => {
                let said = error.to_string();
                let is_clear = !said.is_empty() && !said.contains('\n') && said.chars().count() < 2000;
                assert!(is_clear, "number {index}: {said}");
                refused += 1;
            }
            Ok(loaded) => {
                let n = loaded.model.mesh.n_vertices();
                assert_eq!(loaded.pose.positions.len(), n, "number {index}");
                assert!(loaded.pose.positions.iter().all(|p| p.is_finite()), "number {index}");
                assert!(loaded.scene.groups.iter().all(|group| group.vertices.iter().all(|v| v.index() < n)));
                opened += 1;
            }
        }
    }
    // Damage of a number, of a name or of an order harms nothing.
    assert!(opened > N / 50 && refused > N / 2, "{opened} opened, {refused} refused");
}
