//! The same pull on the same bar with several rigidities, by the command line.

use std::path::Path;

use pliant::cli::{Console, main_with};

/// As in the dialog that says what rigidity means.
const RIGIDITIES: [u16; 4] = [1, 2, 6, 20];
/// Four columns of a page.
const SIZE: [u32; 2] = [240, 280];
/// Pixels drawn for one that is kept, along a side: takes out the grain and smooths edges.
const FINER: u32 = 4;

/// Writes `rigidity-R.png` for every rigidity.
pub(crate) fn make(folder: &Path) -> Result<(), String> {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets");
    let made = tempfile::tempdir().map_err(|error| error.to_string())?;
    let (bent, drawn) = (made.path().join("bent.glb"), made.path().join("bent.png"));
    let [bent_name, drawn_name] = [&bent, &drawn].map(|path| path.display().to_string());
    let (mesh, handles) = (assets.join("bar.glb"), assets.join("bar.handles.json"));
    let size = SIZE.map(|side| (FINER * side).to_string()).join("x");
    for r in RIGIDITIES.map(|r| r.to_string()) {
        let [mesh, handles] = [&mesh, &handles].map(|path| path.display().to_string());
        pliant(&["deform", &mesh, "--handles", &handles, "--rigidity", &r, "-o", &bent_name])?;
        pliant(&["render", &bent_name, "-o", &drawn_name, "--color", "rigidity", "--rigidity", &r, "--size", &size])?;
        let picture = image::open(&drawn).map_err(|error| error.to_string())?;
        super::stage::keep(&picture.into_rgba8(), FINER, &folder.join(format!("rigidity-{r}.png")))?;
    }
    Ok(())
}

/// A command, in this process.
fn pliant(arguments: &[&str]) -> Result<(), String> {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let code = main_with(["pliant"].iter().chain(arguments), &mut Console::new(&mut out, &mut err, false));
    if code == 0 { Ok(()) } else { Err(String::from_utf8_lossy(&err).into_owned()) }
}
