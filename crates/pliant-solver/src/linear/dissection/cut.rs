//! Where to cut a piece in two.
//!
//! Every vertex gets a key such that neighbors have similar keys: its coordinate along the longest axis, or its
//! breadth-first level as seen from the end of that axis, which copes with folded and coincident geometry. A sweep over
//! the keys counts the edges that cross each of some values, and the cheapest value not too far from the middle is
//! chosen. Vertices with keys well below it belong to one half, those well above to the other, and within the band
//! between, `flow.rs` finds the fewest vertices that separate the two.

use super::flow::Band;
use super::piece::Piece;

/// Vertices in the band per square root of the vertices of the piece. Measured at 100,000 vertices: 12 takes a quarter
/// longer and fills 2 % less.
const BAND: f32 = 8.0;
/// The band has at most this share of the vertices.
const WIDEST_BAND: f32 = 0.5;
/// Keys in a sample that estimates quantiles and axes.
const SAMPLE: usize = 1024;
/// Values at which crossing edges are counted.
const BINS: usize = 64;
/// Neither half should be smaller than this share of the piece.
const SMALLEST_HALF: f32 = 0.3;

/// A half smaller than this share of the piece is no use: the recursion would become deep.
const TINY_HALF: f32 = 0.14;

/// Sides of all vertices, or `None` if no separator of use was found.
pub(super) fn separate(piece: &Piece) -> Option<Vec<u32>> {
    let axis = longest_axis(piece);
    let along: Vec<f32> = piece.points.iter().map(|p| p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2]).collect();
    let Some(mut by_distance) = levels(piece, farthest(&along)) else {
        return Some(piece.bins_of_components());
    };
    let by_axis = sweep(piece, &along);
    if by_axis.is_none()
        && let Some(from_far) = levels(piece, farthest(&by_distance))
    {
        by_distance = from_far;
    }
    let by_level = sweep(piece, &by_distance);
    // Room for the rounding of keys, which are at most √3.
    let reach = |v: usize| piece.points[v][3] * 1.0001 + 1e-6;
    let cut_by_axis = || by_axis.and_then(|place| separate_at(piece, &along, place.share, reach));
    let cut_by_level = || by_level.and_then(|place| separate_at(piece, &by_distance, place.share, |_| 1.0));
    let cost = |place: Option<Place>| place.map_or(f32::INFINITY, |place| place.cost);
    let cheapest = if cost(by_axis) <= cost(by_level) {
        cut_by_axis().or_else(cut_by_level)
    } else {
        cut_by_level().or_else(cut_by_axis)
    };
    cheapest.or_else(|| separate_at(piece, &by_distance, 0.5, |_| 1.0))
}

/// A value to cut at: the share of the vertices below it, and how bad it is.
#[derive(Clone, Copy)]
struct Place {
    share: f32,
    cost: f32,
}

/// The cheapest place by crossing edges and balance. `None` if all keys are the same.
fn sweep(piece: &Piece, keys: &[f32]) -> Option<Place> {
    let n = keys.len();
    let (low, high) = keys.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), &k| (lo.min(k), hi.max(k)));
    let scale = BINS as f32 / (high - low);
    if !scale.is_finite() {
        return None;
    }
    let bin_of: Vec<u8> = keys.iter().map(|&key| (((key - low) * scale) as usize).min(BINS - 1) as u8).collect();
    let mut vertices = [0u32; BINS];
    let mut begun = [0i32; BINS];
    for (v, &bin) in bin_of.iter().enumerate() {
        vertices[bin as usize] += 1;
        // Every edge is seen from both ends: +1 from the lower bin, −1 from the upper one.
        begun[bin as usize] += piece
            .neighbors(v)
            .iter()
            .map(|&w| i32::from(bin_of[w as usize] > bin) - i32::from(bin_of[w as usize] < bin))
            .sum::<i32>();
    }
    let (mut below, mut crossing) = (0, 0);
    let mut best: Option<Place> = None;
    for bin in 0..BINS - 1 {
        below += vertices[bin];
        crossing += begun[bin];
        let share = below as f32 / n as f32;
        let cost = crossing as f32 * penalty(share);
        // A cut that leaves next to nothing on one side, as at the root of a tail, would be refused.
        let is_of_use = share.min(1.0 - share) > TINY_HALF;
        if is_of_use && best.is_none_or(|best| cost < best.cost) {
            best = Some(Place { share, cost });
        }
    }
    best
}

/// What a lopsided cut costs more than an even one.
fn penalty(share: f32) -> f32 {
    let lopsided = 1.0 - 2.0 * share.min(1.0 - share);
    let excess = if lopsided > 1.0 - 2.0 * SMALLEST_HALF { 100.0 * lopsided } else { 0.0 };
    1.0 + 2.0 * lopsided * lopsided + excess
}

/// Cuts in a band around the key with this share of the keys below. `reach(v)` bounds how far the keys of the neighbors
/// of v are from its own. `None` if the separator is too large or a half too small to be of use.
fn separate_at(piece: &Piece, keys: &[f32], share: f32, reach: impl Fn(usize) -> f32) -> Option<Vec<u32>> {
    let n = keys.len();
    let half_band = 0.5 * (BAND / (n as f32).sqrt()).min(WIDEST_BAND);
    let mut sample: Vec<f32> = keys.iter().step_by(stride(n)).copied().collect();
    sample.sort_unstable_by(f32::total_cmp);
    let at = |share: f32| sample[((sample.len() as f32 * share) as usize).min(sample.len() - 1)];
    let (low, high) = (at(share - half_band), at(share + half_band));
    let mut sides: Vec<u32> = keys.iter().map(|&key| u32::from(key > high)).collect();
    let leaps = |v: usize, key: f32| {
        key < low && key + reach(v) > high && piece.neighbors(v).iter().any(|&w| keys[w as usize] > high)
    };
    let in_band = |&(v, &key): &(usize, &f32)| (key >= low && key <= high) || leaps(v, key);
    let band = keys.iter().enumerate().filter(in_band).map(|(v, _)| v as u32).collect();
    let (below, above) = Band::new(piece, band, &mut sides).cut(&mut sides);
    let separator = n - below - above;
    (4 * separator < n && 8 * below.min(above) > n).then_some(sides)
}

fn stride(n: usize) -> usize {
    n.div_ceil(SAMPLE).max(1)
}

/// Direction of the largest variance of a sample of the points.
fn longest_axis(piece: &Piece) -> [f32; 3] {
    let sample = || piece.points.iter().step_by(stride(piece.len()));
    let n = sample().count() as f32;
    let mean = [0, 1, 2].map(|i| sample().map(|p| p[i]).sum::<f32>() / n);
    let mut c = [[0f32; 3]; 3];
    for p in sample() {
        let d = [p[0] - mean[0], p[1] - mean[1], p[2] - mean[2]];
        for i in 0..3 {
            (0..3).for_each(|j| c[i][j] += d[i] * d[j]);
        }
    }
    // Squaring again and again leaves the direction of the largest eigenvalue.
    for _ in 0..8 {
        let trace = c[0][0] + c[1][1] + c[2][2];
        if trace.is_nan() || trace <= f32::MIN_POSITIVE {
            return [1.0, 0.0, 0.0];
        }
        c.iter_mut().flatten().for_each(|x| *x /= trace);
        c = [0, 1, 2].map(|i| [0, 1, 2].map(|j| c[i][0] * c[0][j] + c[i][1] * c[1][j] + c[i][2] * c[2][j]));
    }
    let best = (0..3).max_by(|&i, &j| c[i][i].total_cmp(&c[j][j])).unwrap_or(0);
    let length = (c[best][0] * c[best][0] + c[best][1] * c[best][1] + c[best][2] * c[best][2]).sqrt();
    c[best].map(|x| x / length)
}

/// The vertex with the largest key.
fn farthest(keys: &[f32]) -> usize {
    (0..keys.len()).max_by(|&v, &w| keys[v].total_cmp(&keys[w])).unwrap_or(0)
}

/// Breadth-first levels; `None` if not all can be reached.
fn levels(piece: &Piece, start: usize) -> Option<Vec<f32>> {
    let mut levels = vec![f32::NAN; piece.len()];
    let mut queue = Vec::with_capacity(piece.len());
    queue.push(start as u32);
    levels[start] = 0.0;
    let mut next = 0;
    while let Some(&v) = queue.get(next) {
        next += 1;
        let level = levels[v as usize] + 1.0;
        for &w in piece.neighbors(v as usize) {
            if levels[w as usize].is_nan() {
                levels[w as usize] = level;
                queue.push(w);
            }
        }
    }
    (queue.len() == piece.len()).then_some(levels)
}
