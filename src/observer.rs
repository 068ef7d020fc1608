//! How a long computation tells what it is doing, and how it is stopped.

/// Hears the progress of a long computation and may stop it.
pub trait Observer {
    /// Called often, with the name of the stage and the share of the whole that is done (0 to 1, never falling).
    /// Returning `false` asks the computation to stop; it then returns its `Cancelled` error.
    fn progress(&mut self, stage: &'static str, done: f64) -> bool;
}

/// An observer that hears nothing and never stops anything.
pub struct Silent;

impl Observer for Silent {
    fn progress(&mut self, _stage: &'static str, _done: f64) -> bool {
        true
    }
}

impl<F: FnMut(&'static str, f64) -> bool> Observer for F {
    fn progress(&mut self, stage: &'static str, done: f64) -> bool {
        self(stage, done)
    }
}
