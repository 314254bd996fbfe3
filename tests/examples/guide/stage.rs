//! A window for pictures: opens a sample, takes input, waits, and is drawn.

use std::path::Path;
use std::time::{Duration, Instant};

use color_quant::NeuQuant;
use egui::{Key, Modifiers, Pos2, Vec2};
use egui_kittest::Harness;
use image::RgbaImage;
use image::imageops::{FilterType, resize};
use pliant::editor::{EditorApp, Job, Sample, Session};
use pliant::solving::SolveState;

/// Size of most windows in points.
pub(crate) const COMMON: Vec2 = Vec2::new(960.0, 640.0);
/// Width of the pictures in pixels: a page's.
const WIDTH: f32 = 960.0;
/// Pixels drawn for one that is kept, along a side: enough for the grain to go.
const FINER: u32 = 3;
/// Colors of a picture, the first number that keeps it within so many bytes, and how thoroughly they are chosen (1 is best,
/// 30 quickest): 256 keep a picture to a third of its bytes, and are not told from all.
const COLORS: [usize; 3] = [256, 128, 64];
const BYTES: usize = 120_000;
const SAMPLING: i32 = 3;

/// The window.
pub(crate) struct Stage(Harness<'static, EditorApp>);

impl Stage {
    /// With a sample open, seen from the front.
    pub(crate) fn new(sample: Sample, size: Vec2) -> Stage {
        let pixels_per_point = FINER as f32 * WIDTH / size.x;
        let harness = Harness::builder().with_size(size).with_pixels_per_point(pixels_per_point).wgpu();
        let app = harness.build_eframe(|cc| EditorApp::new(cc, Vec::new()).expect("a graphics adapter"));
        let mut stage = Stage(app);
        stage.until("the start sample is open", |session| session.document().is_some());
        stage.session().start(Job::OpenSample(sample));
        stage.until("the sample is open", |session| {
            session.running_job().is_none() && session.document().is_some_and(|d| d.model().name == sample.name())
        });
        stage.session().dismiss_welcome();
        stage.0.run_steps(4);
        stage
    }

    /// What is behind the window.
    pub(crate) fn session(&mut self) -> &mut Session {
        self.0.state_mut().session()
    }

    /// Steps until `done` says so; ten minutes are a failure on any machine.
    pub(crate) fn until(&mut self, what: &str, done: impl Fn(&Session) -> bool) {
        let start = Instant::now();
        while !done(self.0.state_mut().session()) {
            assert!(start.elapsed() < Duration::from_secs(600), "waited in vain until {what}");
            self.0.step();
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Waits for the surface to come to rest.
    pub(crate) fn settle(&mut self) {
        self.0.run_steps(2);
        self.until("the surface settles", |session| {
            let revision = session.document().map(|document| document.revision());
            session.status.report.as_ref().is_some_and(|report| {
                Some(report.revision) == revision && matches!(report.state, SolveState::Settled | SolveState::Resting)
            })
        });
    }

    /// Presses a key.
    pub(crate) fn key(&mut self, modifiers: Modifiers, key: Key) {
        self.0.key_press_modifiers(modifiers, key);
        self.0.run_steps(3);
    }

    /// Types into the field that has the focus.
    pub(crate) fn type_text(&mut self, text: &str) {
        self.0.event(egui::Event::Text(text.to_owned()));
        self.0.run_steps(3);
    }

    /// Drags with the left button along points of the window.
    pub(crate) fn drag(&mut self, path: &[Pos2]) {
        self.draw(path);
        self.let_go(path[path.len() - 1]);
    }

    /// Presses the left button and moves along points of the window.
    pub(crate) fn draw(&mut self, path: &[Pos2]) {
        self.0.hover_at(path[0]);
        self.0.step();
        self.0.drag_at(path[0]);
        self.0.step();
        for pair in path.windows(2) {
            for k in 1..=8 {
                self.0.hover_at(pair[0].lerp(pair[1], k as f32 / 8.0));
                self.0.step();
            }
        }
    }

    /// Lets the button go.
    pub(crate) fn let_go(&mut self, at: Pos2) {
        self.0.drop_at(at);
        self.0.run_steps(2);
    }

    /// Cards of kept poses get their pictures one after the other, from a thread.
    pub(crate) fn wait_for_thumbnails(&mut self) {
        for _ in 0..30 {
            std::thread::sleep(Duration::from_millis(200));
            self.0.run_steps(2);
        }
    }

    /// Rests the pointer somewhere.
    pub(crate) fn hover(&mut self, at: Pos2) {
        self.0.hover_at(at);
        self.0.run_steps(2);
    }

    /// Keeps what the window looks like now.
    pub(crate) fn keep(&mut self, file: &Path) -> Result<(), String> {
        // Edges are smoothed once nothing has moved for a moment.
        std::thread::sleep(Duration::from_millis(400));
        self.0.run_steps(3);
        keep(&self.0.render()?, FINER, file)
    }
}

/// Writes a picture, made smaller by averaging.
pub(crate) fn keep(drawn: &RgbaImage, finer: u32, file: &Path) -> Result<(), String> {
    let (width, height) = drawn.dimensions();
    let small = resize(drawn, width / finer, height / finer, FilterType::Triangle);
    let mut bytes = Vec::new();
    for colors in COLORS {
        bytes = encoded(&small, colors).map_err(|error| error.to_string())?;
        if bytes.len() <= BYTES {
            break;
        }
    }
    std::fs::write(file, bytes).map_err(|error| format!("{}: {error}", file.display()))
}

/// An opaque picture with a palette.
fn encoded(picture: &RgbaImage, colors: usize) -> Result<Vec<u8>, png::EncodingError> {
    let quantizer = NeuQuant::new(SAMPLING, colors, picture.as_raw());
    let indices: Vec<u8> = picture.pixels().map(|pixel| quantizer.index_of(&pixel.0) as u8).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(quantizer.color_map_rgb());
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&indices)?;
    Ok(bytes)
}
