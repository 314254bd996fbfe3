//! PLY in, the same PLY out.

mod model;
mod reading;
mod refused;
mod rigidity;
mod saving;
