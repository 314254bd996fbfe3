//! Files that name other files: outside their folder, through links, pipes, devices, or without end.
//!
//! Whatever lies outside is made so that following it would show: the buffer there is the right one, the material there
//! has a color of its own, the picture there has a content that is looked for in what is saved.

use crate::crafted::{Expected, sound_document};
use crate::exercise::{self, Outcome};
use rustix::fs::{CWD, Mode, mkfifoat};
use serde_json::{Value, json};
use std::fs::{self, File};
use std::io::Result;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Red, green and blue of the material outside.
const SECRET_COLOR: [f32; 3] = [0.125, 0.875, 0.375];
/// What the pictures outside hold again and again.
const SECRET: &str = "SECRET";
/// The same in base64; its length is a multiple of three.
const SECRET_BASE64: &str = "U0VDUkVU";

/// A folder with models and traps, beside a folder that none may read.
#[derive(Debug)]
pub struct Traps {
    root: TempDir,
    /// Name of a model in the folder, what it does, and what must become of it.
    cases: Vec<(PathBuf, String, Expected)>,
}

impl Traps {
    /// Lays everything out.
    pub fn new() -> Result<Traps> {
        let root = exercise::scratch()?;
        let mut traps = Traps { root, cases: Vec::new() };
        traps.outside()?;
        traps.links()?;
        traps.buffers()?;
        traps.libraries()?;
        traps.pictures()?;
        traps.sidecars()?;
        traps.models()?;
        Ok(traps)
    }

    /// How many models there are.
    pub fn n(&self) -> usize {
        self.cases.len()
    }

    /// The folder of the models.
    pub fn folder(&self) -> PathBuf {
        self.root.path().join("inside")
    }

    /// What model `index` does, and what must become of it.
    pub fn case(&self, index: usize) -> (&str, &Expected) {
        let (_, name, expected) = &self.cases[index];
        (name, expected)
    }

    /// Opens and saves model `index`.
    ///
    /// # Panics
    ///
    /// When something from outside shows.
    pub fn try_one(&self, index: usize, scratch: &Path) -> Outcome {
        let path = &self.cases[index].0;
        exercise::on_disk(path, scratch, &|file, saved| {
            let colors = file.parts.iter().map(|part| part.base_color);
            assert!(!colors.into_iter().any(|color| color[..3] == SECRET_COLOR), "the color of a file outside shows");
            let text = String::from_utf8_lossy(saved);
            let leaks = [SECRET, SECRET_BASE64].iter().any(|secret| text.contains(secret));
            assert!(!leaks, "what was saved holds a file outside");
        })
    }

    fn outside(&self) -> Result<()> {
        let outside = self.root.path().join("outside");
        fs::create_dir_all(self.folder().join("sub"))?;
        fs::create_dir(&outside)?;
        fs::write(outside.join("data.bin"), sound_document().1)?;
        fs::write(outside.join("data.mtl"), material())?;
        fs::write(outside.join("data.png"), SECRET.repeat(100))?;
        fs::write(outside.join("r.json"), "[7,7,7]")?;
        fs::write(outside.join("model.obj"), OBJ)
    }

    /// Links, pipes and folders by the names of data, one of each for each kind of file.
    fn links(&self) -> Result<()> {
        let (inside, outside) = (self.folder(), self.root.path().join("outside"));
        symlink("../outside", inside.join("linked"))?;
        symlink("..", inside.join("up"))?;
        for ending in ["bin", "mtl", "png"] {
            let at = |name: &str| inside.join(format!("{name}.{ending}"));
            let data = format!("data.{ending}");
            symlink(outside.join(&data), at("absolute"))?;
            symlink(Path::new("../outside").join(&data), at("relative"))?;
            symlink(at("relative"), at("twice"))?;
            symlink(at("circle"), at("circle"))?;
            symlink(at("there"), at("back"))?;
            symlink(at("back"), at("there"))?;
            symlink("/dev/zero", at("zero"))?;
            symlink("/proc/self/environ", at("environ"))?;
            symlink(inside.join("none"), at("dangling"))?;
            mkfifoat(CWD, at("pipe"), Mode::RUSR | Mode::WUSR)?;
            fs::create_dir(at("folder"))?;
            File::create(at("huge"))?.set_len(1 << 40)?;
        }
        fs::write(inside.join("sub/inner.bin"), sound_document().1)
    }

    fn buffers(&mut self) -> Result<()> {
        for uri in names("bin") {
            let expected = "buffer 0: its ";
            self.gltf(
                &format!("buffer {uri}"),
                |document| document["buffers"][0]["uri"] = uri.into(),
                expected.into(),
            )?;
        }
        for uri in ["sub/inner.bin", "sub/../sub/inner.bin", "./sub/inner.bin", "%73ub/inner.bin"] {
            // A way through `..` is refused even where it ends inside.
            let expected = if uri.contains("..") { "outside the folder".into() } else { 6.into() };
            self.gltf(&format!("buffer {uri}"), |document| document["buffers"][0]["uri"] = uri.into(), expected)?;
        }
        Ok(())
    }

    fn libraries(&mut self) -> Result<()> {
        for name in names("mtl") {
            let name = name.replace("%00", "\0");
            self.obj(&format!("library {name}"), &format!("mtllib {name}\n{OBJ}"), 3.into())?;
        }
        let many = names("mtl").join(" ");
        self.obj("all libraries on one line", &format!("mtllib {many}\n{OBJ}"), 3.into())
    }

    fn pictures(&mut self) -> Result<()> {
        let data = crate::crafted::gltf_of(&sound_document().0, &sound_document().1);
        let data: Value = serde_json::from_slice(&data)?;
        for uri in names("png") {
            let name = format!("picture {uri}");
            self.gltf(
                &name,
                |document| {
                    *document = data.clone();
                    document["images"] = json!([{ "uri": uri }]);
                },
                6.into(),
            )?;
        }
        Ok(())
    }

    /// Files of r by the name of the model, which no model chooses: what lies there may still be a trap.
    fn sidecars(&mut self) -> Result<()> {
        let outside = self.root.path().join("outside/r.json");
        for (trap, target) in [
            ("outside", outside.as_path()),
            ("a device", Path::new("/dev/zero")),
            ("a process", Path::new("/proc/self/environ")),
            ("nothing", Path::new("none")),
        ] {
            let sidecar = self.obj_path().with_extension("rigidity.json");
            symlink(target, sidecar)?;
            self.obj(&format!("sidecar that links to {trap}"), OBJ, "rigidity.json: ".into())?;
        }
        mkfifoat(CWD, self.obj_path().with_extension("rigidity.json"), Mode::RUSR | Mode::WUSR)?;
        self.obj("sidecar that is a pipe", OBJ, "rigidity.json: ".into())?;
        fs::create_dir(self.obj_path().with_extension("rigidity.json"))?;
        self.obj("sidecar that is a folder", OBJ, "rigidity.json: ".into())?;
        File::create(self.obj_path().with_extension("rigidity.json"))?.set_len(1 << 40)?;
        self.obj("sidecar that is huge", OBJ, "rigidity.json: ".into())
    }

    /// Models that are no files themselves. (A model that is a link was chosen by a person and is followed.)
    fn models(&mut self) -> Result<()> {
        let inside = self.folder();
        for ending in ["obj", "gltf", "glb", "ply", "stl", "off"] {
            let at = |name: &str| inside.join(format!("{name}.{ending}"));
            mkfifoat(CWD, at("pipe"), Mode::RUSR | Mode::WUSR)?;
            fs::create_dir(at("folder"))?;
            symlink("/dev/zero", at("zero"))?;
            symlink(at("circle"), at("circle"))?;
            File::create(at("huge"))?.set_len(1 << 40)?;
            for (name, expected) in [
                ("pipe", "is not a regular file"),
                ("folder", "is not a regular file"),
                ("zero", "is not a regular file"),
                ("circle", "cannot be read"),
                ("huge", "bytes in the file are more than the limit"),
            ] {
                self.cases.push((at(name), format!("{ending} that is a {name}"), expected.into()));
            }
        }
        Ok(())
    }

    fn gltf(&mut self, name: &str, change: impl FnOnce(&mut Value), expected: Expected) -> Result<()> {
        let (mut document, _) = sound_document();
        change(&mut document);
        let path = self.folder().join(format!("{}.gltf", self.n()));
        fs::write(&path, document.to_string())?;
        self.cases.push((path, name.to_owned(), expected));
        Ok(())
    }

    fn obj_path(&self) -> PathBuf {
        self.folder().join(format!("{}.obj", self.n()))
    }

    fn obj(&mut self, name: &str, text: &str, expected: Expected) -> Result<()> {
        let path = self.obj_path();
        fs::write(&path, text)?;
        self.cases.push((path, name.to_owned(), expected));
        Ok(())
    }
}

const OBJ: &str = "usemtl secret\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn material() -> String {
    let [r, g, b] = SECRET_COLOR;
    format!("newmtl secret\nKd {r} {g} {b}\n")
}

/// Ways to name a file of an ending that must not be read.
fn names(ending: &str) -> Vec<String> {
    let long = "x".repeat(300);
    let deep = "sub/".repeat(2_000);
    let plain = [
        "../outside/data",
        "sub/../../outside/data",
        "./../outside/data",
        "..//outside/data",
        "linked/data",
        "up/outside/data",
        "%2e%2e/outside/data",
        "%2E%2E%2Foutside%2Fdata",
        "..%2foutside%2fdata",
        "%252e%252e/outside/data",
        "..\\outside\\data",
        "..%5coutside%5cdata",
        "sub\\..\\..\\outside\\data",
        "file:../outside/data",
        "file:///outside/data",
        "FILE:///outside/data",
        "http://localhost/data",
        "https://localhost/data",
        "ftp://localhost/data",
        "\\\\localhost\\share\\data",
        "//localhost/share/data",
        "%5c%5clocalhost%5cshare%5cdata",
        "\\\\?\\C:\\data",
        "\\\\.\\pipe\\data",
        "C:\\data",
        "C:/data",
        "c:data",
        "data:../outside/data",
        "~/data",
        "$HOME/data",
        "absolute",
        "relative",
        "twice",
        "circle",
        "there",
        "dangling",
        "zero",
        "environ",
        "pipe",
        "folder",
        "huge",
        "absolute%00",
        "ABSOLUTE",
        "Absolute",
        "absolute ",
        " absolute",
        "%e2%80%a6/outside/data",
        "．．/outside/data",
        "..%c0%af..%c0%afoutside/data",
        "%u002e%u002e/outside/data",
    ];
    let mut names: Vec<String> = plain.iter().map(|name| format!("{name}.{ending}")).collect();
    names.extend([&long, &deep].map(|name| format!("{name}.{ending}")));
    let whole = [
        "/dev/zero",
        "/dev/stdin",
        "/dev/tty",
        "/proc/self/mem",
        "/proc/self/environ",
        "/proc/self/fd/0",
        "/etc/passwd",
        "..",
        ".",
        "/",
        "./",
        "sub",
        "sub/",
        "%00",
        "%2e%2e",
        "CON",
        "NUL",
        "",
    ];
    names.extend(whole.map(str::to_owned));
    names
}
