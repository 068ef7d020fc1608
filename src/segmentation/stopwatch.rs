//! Progress and seconds, step by step.

use super::SegmentationError;
use crate::clock;
use crate::observer::Observer;

/// Tells the observer how far along a run is, and the seconds of its steps apart.
pub struct Stopwatch<'a> {
    observer: &'a mut dyn Observer,
    seconds: Vec<(&'static str, f64)>,
    stage: &'static str,
    started: f64,
}

impl<'a> Stopwatch<'a> {
    /// Starts before the first step.
    pub fn new(observer: &'a mut dyn Observer) -> Self {
        Self { observer, seconds: Vec::new(), stage: "", started: clock::seconds() }
    }

    /// Ends the step before and begins the next, `done` of the whole (0 to 1) being behind it.
    pub fn begin(&mut self, stage: &'static str, done: f64) -> Result<(), SegmentationError> {
        self.end();
        self.stage = stage;
        self.tell(done)
    }

    /// Says that `done` of the whole (0 to 1) is behind; an error if the observer asks to stop.
    pub fn tell(&mut self, done: f64) -> Result<(), SegmentationError> {
        if self.observer.progress(self.stage, done) { Ok(()) } else { Err(SegmentationError::Cancelled) }
    }

    /// Ends the last step; the seconds by step.
    pub fn stop(mut self) -> Vec<(&'static str, f64)> {
        self.end();
        self.seconds
    }

    fn end(&mut self) {
        let now = clock::seconds();
        if !self.stage.is_empty() {
            self.seconds.push((self.stage, now - self.started));
        }
        self.started = now;
    }
}
