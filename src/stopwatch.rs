//! Progress and seconds of a long computation, step by step.

use crate::clock;
use crate::observer::Observer;

/// The observer asked to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cancelled;

/// Tells the observer how far along a run is, and the seconds of its steps apart.
///
/// A step is named when it begins ([`Stopwatch::begin`]) or when it ends ([`Stopwatch::end`]); the seconds of steps with
/// one name are added up.
pub struct Stopwatch<'a> {
    observer: &'a mut dyn Observer,
    seconds: Vec<(&'static str, f64)>,
    stage: &'static str,
    started: f64,
    done: f64,
    cancelled: bool,
}

impl<'a> Stopwatch<'a> {
    /// Starts before the first step.
    pub fn new(observer: &'a mut dyn Observer) -> Self {
        Self { observer, seconds: Vec::new(), stage: "", started: clock::seconds(), done: 0.0, cancelled: false }
    }

    /// Ends the step before and begins the next, `done` of the whole (0 to 1) being behind it.
    pub fn begin(&mut self, stage: &'static str, done: f64) -> Result<(), Cancelled> {
        self.note();
        self.stage = stage;
        self.tell(done)
    }

    /// Ends a step that brought the whole to `done`.
    pub fn end(&mut self, stage: &'static str, done: f64) -> Result<(), Cancelled> {
        self.stage = stage;
        self.note();
        self.stage = stage;
        let told = self.tell(done);
        self.stage = "";
        told
    }

    /// Says that `done` of the whole (0 to 1) is behind; an error if the observer asks to stop.
    pub fn tell(&mut self, done: f64) -> Result<(), Cancelled> {
        if self.go_on(done) { Ok(()) } else { Err(Cancelled) }
    }

    /// Says that `done` of the whole (0 to 1) is behind; whether to go on.
    pub fn go_on(&mut self, done: f64) -> bool {
        self.done = self.done.max(done.min(1.0));
        self.cancelled |= !self.observer.progress(self.stage, self.done);
        !self.cancelled
    }

    /// The same within a step that is named when it ends.
    pub fn at(&mut self, stage: &'static str, done: f64) -> bool {
        self.stage = stage;
        self.go_on(done)
    }

    /// Ends the last step, if that was begun; the seconds by step.
    pub fn stop(mut self) -> Vec<(&'static str, f64)> {
        self.note();
        self.seconds
    }

    /// Puts down the time that the stage took.
    fn note(&mut self) {
        let now = clock::seconds();
        if !self.stage.is_empty() {
            match self.seconds.iter_mut().find(|(stage, _)| *stage == self.stage) {
                Some((_, seconds)) => *seconds += now - self.started,
                None => self.seconds.push((self.stage, now - self.started)),
            }
        }
        (self.stage, self.started) = ("", now);
    }
}
