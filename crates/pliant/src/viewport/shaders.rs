//! The shader programs, complete as they are compiled: files of the `shaders` folder behind a shared head.

/// Joins files of the `shaders` folder behind the shared head.
macro_rules! program {
    ($($file:literal),+) => {
        concat!(
            include_str!("../../../../shaders/common.wgsl"),
            $("\n", include_str!(concat!("../../../../shaders/", $file))),+
        )
    };
}

/// The gradient behind everything.
pub(super) const BACKGROUND: &str = program!("background.wgsl");
/// The lit surface from indexed vertices.
pub(super) const SURFACE: &str = program!("matcap.wgsl", "lighting.wgsl", "surface.wgsl");
/// The lit surface with its edges or textures, vertices fetched by number.
pub(super) const FETCHED: &str = program!("matcap.wgsl", "lighting.wgsl", "fetched.wgsl");
/// Edges as plain lines.
pub(super) const EDGES: &str = program!("edges.wgsl");
/// The ground grid.
pub(super) const GRID: &str = program!("grid.wgsl");
/// Outlined discs.
pub(super) const DOTS: &str = program!("dots.wgsl");
/// Lines of constant width.
pub(super) const LINES: &str = program!("lines.wgsl");

/// Name and full WGSL text of each program, for validation without a GPU.
pub const SHADERS: &[(&str, &str)] = &[
    ("background", BACKGROUND),
    ("surface", SURFACE),
    ("fetched", FETCHED),
    ("edges", EDGES),
    ("grid", GRID),
    ("dots", DOTS),
    ("lines", LINES),
];
