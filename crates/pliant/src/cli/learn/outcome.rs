//! The files that `learn` writes.

use std::io::Write;
use std::time::Instant;

use pliant_meshfile::{MeshFile, Warning};
use pliant_solver::{EnergyTable, Learned, VertexId};

use super::is_array;
use crate::cli::args::LearnOptions;
use crate::cli::failure::Failure;
use crate::cli::report::{LearnReport, ROOM_FOR_NEWS, peak_memory_bytes, to_json};
use crate::cli::solve::milliseconds;
use crate::cli::staged::Staged;

/// What was learned, and where it is to go.
#[derive(Clone, Copy)]
pub(super) struct Outcome<'a> {
    pub(super) options: &'a LearnOptions,
    pub(super) file: &'a MeshFile,
    pub(super) table: &'a EnergyTable,
    pub(super) learned: &'a Learned,
}

impl Outcome<'_> {
    /// Writes OUT, the table and the report. The table and the report's bytes are on the disk under other names before
    /// OUT is touched, so that a full or read-only disk is noticed in time.
    pub(super) fn write(self, clock: Instant, report: &mut LearnReport) -> Result<(), Failure> {
        let out = &self.options.output;
        let staged_table = match &self.options.table {
            Some(path) => {
                let mut staged = Staged::create(path)?;
                staged.stream(|file| self.write_table(file))?;
                Some(staged)
            }
            None => None,
        };
        let mut staged_report = match &self.options.report {
            Some(path) => {
                let mut staged = Staged::create(path)?;
                staged.reserve(&to_json(report), ROOM_FOR_NEWS)?;
                Some(staged)
            }
            None => None,
        };
        let lost = self.write_out()?;
        report.warnings.extend(lost.iter().map(ToString::to_string));
        report.times_ms.total = milliseconds(clock);
        report.peak_memory_bytes = peak_memory_bytes();
        if let Some(staged) = staged_table {
            staged.commit().map_err(|source| Failure::lost("table", out, source))?;
        }
        if let Some(mut staged) = staged_report.take() {
            let written = staged.write(&to_json(report)).and_then(|()| staged.commit());
            written.map_err(|source| Failure::lost("report", out, source))?;
        }
        Ok(())
    }

    /// The array, or the reference with its rigidity; says what the latter's format could not hold.
    fn write_out(self) -> Result<Vec<Warning>, Failure> {
        let (out, r) = (&self.options.output, self.learned.rigidity.as_slice());
        if !is_array(out) {
            return Ok(self.file.save(out, &self.file.points(), Some(r))?);
        }
        let mut staged = Staged::create(out)?;
        let of_vertex = self.file.weld.point_of_vertex.iter().map(|&point| r[point as usize].to_string());
        staged.write(format!("[{}]\n", of_vertex.collect::<Vec<_>>().join(",")).as_bytes())?;
        staged.commit()?;
        Ok(Vec::new())
    }

    /// A header, and a row a file vertex: its number, r, confidence, and the energies for each r.
    fn write_table(self, out: &mut dyn Write) -> std::io::Result<()> {
        write!(out, "vertex,r,confidence")?;
        for r in self.table.r_range() {
            write!(out, ",energy_{r}")?;
        }
        writeln!(out)?;
        let (r, confidence) = (self.learned.rigidity.as_slice(), &self.learned.confidence);
        for (vertex, &point) in self.file.weld.point_of_vertex.iter().enumerate() {
            write!(out, "{vertex},{},{}", r[point as usize], confidence[point as usize])?;
            for energy in self.table.energies(VertexId(point)) {
                // 17 significant digits give every number back to the bit.
                write!(out, ",{energy:.16e}")?;
            }
            writeln!(out)?;
        }
        Ok(())
    }
}
