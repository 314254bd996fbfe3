//! What an export writes, and where.

use std::path::{Path, PathBuf};

use pliant_meshfile::Format;

/// What kept poses are written as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// One glTF file with morph targets and an animation.
    #[default]
    Animation,
    /// A mesh file a frame.
    Meshes,
    /// A picture a frame.
    Pictures,
}

impl Kind {
    /// All, in the order of menus.
    pub const ALL: [Kind; 3] = [Kind::Animation, Kind::Meshes, Kind::Pictures];

    /// Its name.
    pub fn label(self) -> &'static str {
        match self {
            Kind::Animation => "Animated glTF",
            Kind::Meshes => "Mesh sequence",
            Kind::Pictures => "Picture sequence",
        }
    }

    /// One sentence more.
    pub fn tooltip(self) -> &'static str {
        match self {
            Kind::Animation => {
                "One .glb or .gltf with every pose as a morph target, and an animation that goes through them"
            }
            Kind::Meshes => "Every frame as a mesh file of its own, numbered: .obj, .glb, .gltf, .ply, .stl or .off",
            Kind::Pictures => "Every frame as it looks in the viewport, numbered: .png",
        }
    }

    /// The ending it is proposed with.
    pub fn ending(self) -> &'static str {
        match self {
            Kind::Animation => "glb",
            Kind::Meshes => "obj",
            Kind::Pictures => "png",
        }
    }
}

/// What an export writes, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// As what.
    pub kind: Kind,
    /// The file; in sequences a number goes before its ending.
    pub to: PathBuf,
    /// Frames between two poses.
    pub between: usize,
    /// From one pose to the next.
    pub seconds: f64,
    /// Whether a pose stays until the next comes, instead of turning into it.
    pub stepped: bool,
    /// Whether the last pose goes on to the first.
    pub closed: bool,
    /// Width and height of pictures.
    pub size: [u32; 2],
}

/// Largest side of pictures, which every adapter can draw (the limit that WebGPU promises).
pub const MAX_SIDE_PX: u32 = 8192;
/// Frames between two poses at most: a minute of film.
pub const MAX_BETWEEN: usize = 1439;

impl Plan {
    /// Frames of so many poses. In a loop the first one comes again behind the last; it is counted once.
    pub fn n_frames(&self, n_poses: usize) -> usize {
        n_poses + n_ways(n_poses, self.closed) * self.between
    }

    /// The pose that comes behind another of so many.
    pub fn next(&self, pose: usize, n_poses: usize) -> Option<usize> {
        (pose < n_ways(n_poses, self.closed)).then(|| (pose + 1) % n_poses)
    }

    /// The files it writes, in order; those that a format writes beside them not counted.
    pub fn files(&self, n_poses: usize) -> Vec<PathBuf> {
        match self.kind {
            Kind::Animation => vec![self.to.clone()],
            Kind::Meshes | Kind::Pictures => {
                let n = self.n_frames(n_poses);
                (1..=n).map(|number| numbered(&self.to, number, n)).collect()
            }
        }
    }

    /// When each frame comes, in seconds; in a loop, when the first comes again at last.
    pub fn times(&self, n_poses: usize) -> impl Iterator<Item = f64> + use<> {
        let step = self.seconds / (self.between + 1) as f64;
        let n = self.n_frames(n_poses) + usize::from(self.closed && n_poses > 1);
        (0..n).map(move |frame| frame as f64 * step)
    }

    /// Why nothing can be written there, if so. `opened` is the file that must not be overwritten.
    pub fn obstacle(&self, n_poses: usize, opened: Option<&Path>) -> Option<String> {
        let ending = self.to.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        let format = Format::of(&self.to);
        let folder = self.to.parent().filter(|folder| !folder.as_os_str().is_empty());
        match self.kind {
            _ if n_poses == 0 => return Some("Keep a pose first".into()),
            Kind::Animation if !matches!(format, Some(Format::Glb | Format::Gltf)) => {
                return Some("Type a path that ends with .glb or .gltf".into());
            }
            Kind::Meshes if format.is_none() => {
                return Some("Type a path that ends with .obj, .gltf, .glb, .ply, .stl or .off".into());
            }
            Kind::Pictures if ending != "png" => return Some("Type a path that ends with .png".into()),
            _ => {}
        }
        if folder.is_some_and(|folder| !folder.is_dir()) {
            return Some("This folder does not exist".into());
        }
        let opened = opened.filter(|opened| self.files(n_poses).iter().any(|file| is_same(file, opened)));
        opened.map(|opened| format!("This would overwrite the opened file {}", opened.display()))
    }

    /// How many of its files are there already.
    pub fn n_existing(&self, n_poses: usize) -> usize {
        self.files(n_poses).iter().filter(|file| file.exists()).count()
    }
}

/// Ways from one of so many poses to the next; of a loop, the one from the last to the first too.
pub(super) fn n_ways(n_poses: usize, closed: bool) -> usize {
    n_poses.saturating_sub(usize::from(!closed || n_poses < 2))
}

fn is_same(a: &Path, b: &Path) -> bool {
    a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// `walk.obj` and 7 of 120 make `walk.0007.obj`: four digits, or as many as the last one needs.
pub fn numbered(path: &Path, number: usize, last: usize) -> PathBuf {
    let digits = last.to_string().len().max(4);
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!(".{number:0digits$}"));
    if let Some(ending) = path.extension() {
        name.push(".");
        name.push(ending);
    }
    path.with_file_name(name)
}
