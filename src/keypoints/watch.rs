//! Progress and seconds, step by step.

use super::KeyPointError;
use crate::clock;
use crate::observer::Observer;

/// Tells the observer how far along a run is, and the seconds of its steps apart.
pub struct Watch<'a> {
    observer: &'a mut dyn Observer,
    seconds: Vec<(&'static str, f64)>,
    stage: &'static str,
    started: f64,
    done: f64,
}

impl<'a> Watch<'a> {
    /// Starts before the first step.
    pub fn new(observer: &'a mut dyn Observer) -> Self {
        Self { observer, seconds: Vec::new(), stage: "", started: clock::seconds(), done: 0.0 }
    }

    /// Ends the step before and begins the next, `done` of the whole (0 to 1) being behind it.
    pub fn begin(&mut self, stage: &'static str, done: f64) -> Result<(), KeyPointError> {
        self.end();
        self.stage = stage;
        self.tell(done)
    }

    /// Says that `done` of the whole (0 to 1) is behind; an error if the observer asks to stop.
    pub fn tell(&mut self, done: f64) -> Result<(), KeyPointError> {
        if self.go_on(done) { Ok(()) } else { Err(KeyPointError::Cancelled) }
    }

    /// Says that `done` of the whole (0 to 1) is behind; whether to go on.
    pub fn go_on(&mut self, done: f64) -> bool {
        self.done = self.done.max(done.min(1.0));
        self.observer.progress(self.stage, self.done)
    }

    /// Ends the last step; the seconds by step.
    pub fn stop(mut self) -> Vec<(&'static str, f64)> {
        self.end();
        self.seconds
    }

    fn end(&mut self) {
        let now = clock::seconds();
        if !self.stage.is_empty() {
            match self.seconds.iter_mut().find(|(stage, _)| *stage == self.stage) {
                Some((_, seconds)) => *seconds += now - self.started,
                None => self.seconds.push((self.stage, now - self.started)),
            }
        }
        self.started = now;
    }
}
