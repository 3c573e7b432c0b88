//! Places defects where their causes produce them. Each file lists the places that one cause has on the members of the site, whatever the
//! bridge type ([`structure`] derives runs, spans and supports from the members alone); [`sampler`] draws among them.
//! docs/src/reference/defects.md explains the rules and names their sources.

mod beam;
mod bending;
mod cable;
mod drain;
mod edge;
mod fasteners;
mod frame;
mod frost;
mod leaking_joint;
mod measures;
mod place;
mod reinforcement;
mod sampler;
mod seepage;
mod shear;
mod shrinkage;
mod structure;
mod swelling;
mod water_line;
mod weld;

#[cfg(test)]
mod tests;

pub(super) use sampler::place_by_cause;
