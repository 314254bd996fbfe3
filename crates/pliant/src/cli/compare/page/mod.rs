//! The report: one HTML file that needs nothing else, no network and no scripts.
//!
//! It goes from what was asked to what came out: the rest shape with its handles, a table with the best of every row marked,
//! pictures, curves, histograms, what the measures mean, and how to make it again. It follows the reader's dark or light
//! setting, and can be printed.

mod measures;
mod plots;
mod words;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::drawing::{ANCHOR, MOVED, Pictures};
use super::facts::{EntryFacts, Facts};
use super::names::Names;
use crate::comparing::PICTURE_PX;
use measures::{Better, MEASURES, Measure};
use plots::{Histogram, convergence};
use words::{count, number, title};

const STYLE: &str = include_str!("style.css");

/// Colors of curves, bars and swatches; see the style sheet. From here on they come again, dashed.
const COLORS: usize = 8;

/// The whole file.
pub(super) fn write(facts: &Facts, names: &Names, pictures: &Pictures) -> String {
    let page = Page { facts, names, pictures };
    page.whole().into_string()
}

struct Page<'a> {
    facts: &'a Facts,
    names: &'a Names,
    pictures: &'a Pictures,
}

impl Page<'_> {
    fn whole(&self) -> Markup {
        let name = &self.names.mesh;
        html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    meta name="generator" content=(concat!("pliant ", env!("CARGO_PKG_VERSION")));
                    title { "Comparison of methods: " (name) }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    header {
                        h1 { "Comparison of methods" }
                        p.lead {
                            "The mesh " b { (name) } ", bent by the same handles in "
                            (count(self.facts.entries.len(), "way", "ways")) "."
                        }
                    }
                    main {
                        (self.start())
                        (self.table())
                        (self.shapes())
                        (self.strain())
                        (self.curves())
                        (self.histograms())
                        (self.meanings())
                        (self.origin())
                    }
                    footer { "Made by pliant " (env!("CARGO_PKG_VERSION")) "." }
                }
            }
        }
    }

    /// What was asked: the rest shape with its handles, and how rigid it is where that was painted.
    fn start(&self) -> Markup {
        html! {
            section id="start" {
                h2 { "The task" }
                div.task {
                    figure {
                        (picture(&self.pictures.rest, "The mesh at rest, with its handles"))
                        figcaption {
                            (dot(ANCHOR)) " held in place, " (dot(MOVED)) " moved along the lines. "
                            "All pictures are seen from here."
                        }
                    }
                    div {
                        (self.setting())
                        @if self.pictures.entries.iter().any(|pictures| pictures.painted.is_some()) { (self.painted()) }
                    }
                }
            }
        }
    }

    fn setting(&self) -> Markup {
        let Facts { mesh, handles, rest, .. } = self.facts;
        html! {
            dl.facts {
                dt { "Mesh" }
                dd {
                    (count(mesh.surface_points(), "vertex", "vertices")) ", "
                    (count(mesh.faces(), "triangle", "triangles"))
                    @if mesh.components() > 1 { ", " (mesh.components()) " separate parts" }
                }
                dt { "Handles" }
                dd {
                    (count(handles.held, "vertex is held", "vertices are held")) ", "
                    (if handles.moved == handles.held { "all".to_owned() } else { words::whole(handles.moved) })
                    " of them away from rest"
                }
                dt { "Volume" }
                dd { @match &rest.no_volume { Some(why) => { "none: " (why) }, None => "the surface is closed" } }
                dt { "Self-intersections at rest" }
                dd { @if rest.self_intersections == 0 { "none" } @else { (count(rest.self_intersections, "pair of triangles", "pairs of triangles")) } }
                dt { "Edge weights" }
                dd { (words::weights(self.facts.weights)) }
                dt { "Search" }
                dd { (words::solver(self.facts.solver)) }
                dt { "Start" }
                dd { (words::start(self.facts.start)) }
                dt { "End" }
                dd { (words::end(self.facts)) }
            }
        }
    }

    fn painted(&self) -> Markup {
        html! {
            h3 { "Rigidity" }
            p { "How many rings of edges around each vertex move as one piece." }
            div.grid.small {
                @for (k, png) in self.each(|pictures| pictures.painted.as_ref()) {
                    figure {
                        (picture(png, &format!("Rigidity on the rest shape: {}", self.title(k))))
                        figcaption { (self.label(k)) }
                    }
                }
            }
            (plots::rigidity_legend(self.pictures.ramp_max))
        }
    }

    fn table(&self) -> Markup {
        html! {
            section id="figures" {
                h2 { "Figures" }
                p {
                    "An arrow tells which direction is better: " span.direction { "↓" } " less, " span.direction { "→1" }
                    " near one. The best of a row is " span.best { "marked" } ". What the rows mean is told "
                    a href="#meanings" { "below" } "."
                }
                div.scroll tabindex="0" role="region" aria-label="Figures of all entries" {
                    table {
                        thead {
                            tr {
                                th scope="col" { "Measure" }
                                @for k in 0..self.facts.entries.len() { th scope="col" { (self.label(k)) } }
                            }
                        }
                        tbody { @for measure in MEASURES { (self.row(measure)) } }
                    }
                }
                @for (entry, why) in self.facts.entries.iter().filter_map(|e| Some((e, e.failed.as_ref()?))) {
                    p.failed { b { (entry.entry) } " has no result: " (self.names.shorten(why)) }
                }
            }
        }
    }

    fn row(&self, measure: &Measure) -> Markup {
        let values: Vec<Option<f64>> =
            self.facts.entries.iter().map(|entry| (measure.value)(entry.result.as_ref()?)).collect();
        let best = measure.best(&values);
        html! {
            tr data-measure=(measure.id) {
                th scope="row" {
                    (measure.name) " "
                    @match measure.better {
                        Better::Less => span.direction title="less is better" { "↓" },
                        Better::NearOne => span.direction title="near one is better" { "→1" },
                        Better::Neither => "",
                    }
                }
                @for (k, value) in values.iter().enumerate() {
                    @match value {
                        Some(value) => {
                            td.best[best[k]] data-value=(format!("{value:e}")) {
                                ((measure.show)(*value))
                                @if measure.id == "iterations" && !self.converged(k) { span.note { " not converged" } }
                            }
                        }
                        None => td.none title=(self.why_not(k)) { "–" },
                    }
                }
            }
        }
    }

    fn why_not(&self, k: usize) -> &str {
        let failed = self.facts.entries[k].failed.as_deref();
        failed.or(self.facts.rest.no_volume.as_deref()).unwrap_or("not known")
    }

    fn converged(&self, k: usize) -> bool {
        self.facts.entries[k].result.as_ref().is_some_and(|result| result.converged)
    }

    fn shapes(&self) -> Markup {
        html! {
            section id="shapes" {
                h2 { "Shapes" }
                p {
                    "What is held has the colors from above; dots are where it should be. Triangles that pass through others, and do not at rest, are "
                    span.crossing { "red" } "."
                }
                div.grid {
                    @for (k, [shape, _]) in self.each(|pictures| pictures.bent.as_ref()) {
                        figure {
                            (picture(shape, &format!("Bent: {}", self.title(k))))
                            figcaption { (self.label(k)) br; span.small { (self.in_short(k)) } }
                        }
                    }
                }
            }
        }
    }

    fn in_short(&self, k: usize) -> String {
        let Some(result) = &self.facts.entries[k].result else { return String::new() };
        let crossings = match result.self_intersections {
            0 => "crosses itself nowhere".to_owned(),
            n => format!("crosses itself: {}", count(n, "pair of triangles", "pairs of triangles")),
        };
        let seconds = words::time(result.times_ms.set_up + result.times_ms.iterate);
        format!("{} in {seconds}, {crossings}", count(result.iterations, "iteration", "iterations"))
    }

    fn strain(&self) -> Markup {
        html! {
            section id="strain" {
                h2 { "Where it is strained" }
                p {
                    "The common energy of each vertex, on one scale for all: the lighter, the further its surroundings are from "
                    "being only moved and turned. Colors follow the square root of the energy, as lengths do."
                }
                div.grid {
                    @for (k, [_, strain]) in self.each(|pictures| pictures.bent.as_ref()) {
                        figure {
                            (picture(strain, &format!("Strain: {}", self.title(k))))
                            figcaption {
                                (self.label(k)) br;
                                span.small { "in all " (self.result(k).map(|result| number(result.common_energy)).unwrap_or_default()) }
                            }
                        }
                    }
                }
                (plots::energy_legend(self.pictures.energy_end))
            }
        }
    }

    fn curves(&self) -> Markup {
        let results = self.facts.entries.iter().enumerate().filter_map(|(k, entry)| Some((k, entry.result.as_ref()?)));
        let curves: Vec<(usize, &[f64])> = results.map(|(k, result)| (k, result.energies.as_slice())).collect();
        html! {
            section id="convergence" {
                h2 { "How fast they get there" }
                p {
                    "How far the energy that each method lowers is above where it ended, after each iteration. Iterations of "
                    "different methods cost different times: see the table."
                    @if self.facts.start == "auto" { " The first iteration is the one after the search for a good start." }
                }
                figure.wide {
                    (convergence(&curves))
                    figcaption.legend { @for &(k, _) in &curves { span { (self.label(k)) } } }
                }
            }
        }
    }

    fn histograms(&self) -> Markup {
        let axes = &self.facts.axes;
        let grid = |shares: fn(&super::facts::Measured) -> &[f64], histogram: &Histogram| {
            html! {
                div.grid {
                    @for (k, result) in (0..self.facts.entries.len()).filter_map(|k| Some((k, self.result(k)?))) {
                        figure {
                            (histogram.draw(k, shares(result), &self.title(k)))
                            figcaption { (self.label(k)) }
                        }
                    }
                }
            }
        };
        html! {
            section id="stretch" {
                h2 { "How edges are stretched" }
                p {
                    "How many edges are how much longer or shorter than at rest. A narrow peak in the middle is better. Heights are on a "
                    "logarithmic scale, so that few edges are seen too; the outermost bars hold everything beyond."
                }
                (grid(|result| &result.stretch.histogram, &Histogram::stretch(axes.stretch)))
            }
            section id="bending" {
                h2 { "How neighboring faces are bent" }
                p {
                    "By how many degrees the angle between two neighboring triangles changed. Something must bend; bars far to the "
                    "right are creases."
                }
                (grid(|result| &result.bending.histogram, &Histogram::bending(axes.bending)))
            }
        }
    }

    fn meanings(&self) -> Markup {
        html! {
            section id="meanings" {
                h2 { "What the measures mean" }
                dl.meanings {
                    @for measure in MEASURES {
                        dt { (measure.name) }
                        dd { (measure.meaning) " " b { (measure.better.in_words()) } }
                    }
                }
                p {
                    "Methods: rigid neighborhoods of r rings (rring), with r the same everywhere or painted; ARAP (Sorkine and "
                    "Alexa 2007), which is r = 1; SR-ARAP (Levi and Gotsman 2015), whose neighbors turn alike; embedded deformation "
                    "(Sumner, Schmid and Pauly 2007), in which a few hundred nodes carry the surface."
                }
            }
        }
    }

    fn origin(&self) -> Markup {
        let facts = self.facts;
        html! {
            section id="origin" {
                h2 { "How to make it again" }
                p { "This report:" }
                pre { code { (self.names.command()) } }
                p { "The meshes, one by one:" }
                pre { code { @for k in 0..facts.entries.len() { (self.names.deform(k)) "\n" } } }
                p.small {
                    "Times were taken with " (count(facts.threads, "thread", "threads")) "; analyzing the mesh took "
                    (words::time(facts.times_ms.order)) " once for all entries, reading the files " (words::time(facts.times_ms.load)) ", everything "
                    (words::time(facts.times_ms.total)) ". Figures but for the times are the same for any number of threads."
                }
                @if !facts.warnings.is_empty() {
                    p { "What was said on the way:" }
                    ul { @for warning in &facts.warnings { li { (self.names.shorten(warning)) } } }
                }
            }
        }
    }

    /// The entries that have such pictures.
    fn each<'p, T>(&'p self, of: impl Fn(&'p super::drawing::EntryPictures) -> Option<T>) -> Vec<(usize, T)> {
        self.pictures.entries.iter().enumerate().filter_map(|(k, pictures)| Some((k, of(pictures)?))).collect()
    }

    fn result(&self, k: usize) -> Option<&super::facts::Measured> {
        self.facts.entries[k].result.as_ref()
    }

    fn title(&self, k: usize) -> String {
        let entry: &EntryFacts = &self.facts.entries[k];
        title(entry, self.names.rigidity(k))
    }

    /// Its color and what it is called.
    fn label(&self, k: usize) -> Markup {
        html! { (plots::swatch(k)) (self.title(k)) }
    }
}

fn picture(png: &[u8], of: &str) -> Markup {
    let [width, height] = PICTURE_PX;
    html! { img src={ "data:image/png;base64," (STANDARD.encode(png)) } width=(width) height=(height) alt=(of); }
}

fn dot([r, g, b]: [u8; 3]) -> Markup {
    html! { span.dot style=(format!("background: rgb({r}, {g}, {b})")) {} }
}
