//! Modes TRIANGLES and INDICES.
//!
//! Triangles in a good order share an edge with one of the last and mostly bring the next new vertex. So each is one
//! byte that names a recent edge and a recent, the next or some other vertex; what the byte cannot say comes later in the
//! stream.

use super::Stream;

/// Entries of the two memories.
const RECENT: usize = 16;

/// `count` indices of triangles, `stride` bytes each.
pub(super) fn triangles(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, &'static str> {
    if bytes.first() != Some(&0xe1) {
        return Err("is of an unknown version");
    }
    let (body, table) = bytes[1..].split_last_chunk::<16>().ok_or("breaks off")?;
    if table[14..] != [0, 0] || table.iter().any(|pair| pair >> 4 == 15 || pair & 15 == 15) {
        return Err("ends in a table that is none");
    }
    let (codes, extra) = body.split_at_checked(count / 3).ok_or("breaks off")?;
    let mut decoder =
        Triangles { extra: Stream(extra), table, next: 0, last: 0, edges: Recent::new(), vertices: Recent::new() };
    let mut decoded = Vec::with_capacity(count * stride);
    for &code in codes {
        for index in decoder.triangle(code)? {
            decoded.extend_from_slice(&index.to_le_bytes()[..stride]);
        }
    }
    decoder.extra.end()?;
    Ok(decoded)
}

/// `count` indices of anything, `stride` bytes each: differences to one of two earlier ones.
pub(super) fn sequence(bytes: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, &'static str> {
    if bytes.first() != Some(&0xd1) {
        return Err("is of an unknown version");
    }
    let (body, _padding) = bytes[1..].split_last_chunk::<4>().ok_or("breaks off")?;
    if body.len() < count {
        return Err("breaks off");
    }
    let mut body = Stream(body);
    let mut last = [0u32; 2];
    let mut decoded = Vec::with_capacity(count * stride);
    for _ in 0..count {
        let value = body.varint()?;
        let last = &mut last[(value & 1) as usize];
        *last = last.wrapping_add(signed(value >> 1));
        decoded.extend_from_slice(&last.to_le_bytes()[..stride]);
    }
    body.end()?;
    Ok(decoded)
}

/// A difference, its sign in the lowest bit.
fn signed(value: u32) -> u32 {
    if value & 1 == 0 { value >> 1 } else { !(value >> 1) }
}

struct Triangles<'a> {
    extra: Stream<'a>,
    table: &'a [u8; 16],
    /// The next vertex that was not used before.
    next: u32,
    /// The last vertex that was written out.
    last: u32,
    edges: Recent<[u32; 2]>,
    vertices: Recent<u32>,
}

impl Triangles<'_> {
    fn triangle(&mut self, code: u8) -> Result<[u32; 3], &'static str> {
        match (code >> 4, code & 15) {
            (15, y) => self.without_edge(y),
            (x, y) => self.on_edge(x, y),
        }
    }

    fn on_edge(&mut self, x: u8, y: u8) -> Result<[u32; 3], &'static str> {
        let [a, b] = self.edges.get(x)?;
        let c = match y {
            0 => self.fresh(),
            1..13 => self.vertices.get(y)?,
            13 => self.beside(u32::MAX),
            14 => self.beside(1),
            _ => self.explicit()?,
        };
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        if !(1..13).contains(&y) {
            self.vertices.push(c);
        }
        Ok([a, b, c])
    }

    fn without_edge(&mut self, y: u8) -> Result<[u32; 3], &'static str> {
        let pair = match y {
            14 | 15 => self.extra.byte()?,
            _ => self.table[usize::from(y)],
        };
        if y >= 14 && pair == 0 {
            self.next = 0;
        }
        let a = if y == 15 { self.explicit()? } else { self.fresh() };
        let (b, b_is_new) = self.of_pair(pair >> 4)?;
        let (c, c_is_new) = self.of_pair(pair & 15)?;
        self.edges.push([b, a]);
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        self.vertices.push(a);
        if b_is_new {
            self.vertices.push(b);
        }
        if c_is_new {
            self.vertices.push(c);
        }
        Ok([a, b, c])
    }

    /// The vertex that one half of a byte stands for, and whether it is to be remembered.
    fn of_pair(&mut self, half: u8) -> Result<(u32, bool), &'static str> {
        Ok(match half {
            0 => (self.fresh(), true),
            15 => (self.explicit()?, true),
            _ => (self.vertices.get(half - 1)?, false),
        })
    }

    fn fresh(&mut self) -> u32 {
        let vertex = self.next;
        self.next = self.next.wrapping_add(1);
        vertex
    }

    fn beside(&mut self, step: u32) -> u32 {
        self.last = self.last.wrapping_add(step);
        self.last
    }

    fn explicit(&mut self) -> Result<u32, &'static str> {
        let delta = signed(self.extra.varint()?);
        Ok(self.beside(delta))
    }
}

/// The last entries, the newest first.
struct Recent<T> {
    entries: [Option<T>; RECENT],
    n: usize,
}

impl<T: Copy> Recent<T> {
    fn new() -> Self {
        Recent { entries: [None; RECENT], n: 0 }
    }

    fn push(&mut self, entry: T) {
        self.entries[self.n % RECENT] = Some(entry);
        self.n = (self.n + 1) % RECENT;
    }

    fn get(&self, back: u8) -> Result<T, &'static str> {
        let at = (self.n + 2 * RECENT - 1 - usize::from(back)) % RECENT;
        self.entries[at].ok_or("goes back to what was not there")
    }
}
