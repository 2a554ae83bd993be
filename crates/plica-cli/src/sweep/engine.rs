//! Computes the points of a study on the cores of this machine.

use super::{Study, short};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::ticker::Ticker;
use plica::monitor::Monitor;
use plica::sweep::{Claim, Outcome, Point, StudyFolder, Sweep, SweepError};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// Time between two looks at Ctrl-C, and between two attempts at points that other processes compute.
const PAUSE: Duration = Duration::from_millis(200);

/// Monitor of a point: shows nothing and stops on Ctrl-C.
pub struct Quiet(Interrupt);

impl Quiet {
    pub fn new(interrupt: Interrupt) -> Self {
        Self(interrupt)
    }
}

impl Monitor for Quiet {
    fn is_cancelled(&self) -> bool {
        self.0.is_requested()
    }
}

/// Outcomes that were read from a folder, or computed.
pub struct Known<'a> {
    sweep: &'a Sweep,
    folder: &'a StudyFolder,
    found: HashMap<Point, (String, Outcome)>,
}

impl<'a> Known<'a> {
    pub fn new(sweep: &'a Sweep, folder: &'a StudyFolder) -> Self {
        Self {
            sweep,
            folder,
            found: HashMap::new(),
        }
    }

    fn points(&self) -> Vec<Point> {
        self.sweep.points(&|point| {
            let outcome = self.found.get(point).map(|(_, outcome)| outcome);
            outcome.filter(|outcome| outcome.status.is_final()).cloned()
        })
    }

    /// Reads the outcomes of points that are not final so far.
    fn read(&mut self, points: &[Point]) {
        let is_open = |point: &&Point| {
            let known = self.found.get(*point);
            known.is_none_or(|(_, outcome)| !outcome.status.is_final())
        };
        let open: Vec<&Point> = points.iter().filter(is_open).collect();
        let read = open.into_par_iter();
        let read = read.map(|point| (point.clone(), self.folder.outcome(self.sweep, point)));
        let read: Vec<_> = read.collect();
        self.found.extend(read);
    }

    /// Returns all points with their runs and outcomes so far, those of the refinement included.
    pub fn rows(&mut self) -> Vec<(Point, String, Outcome)> {
        let mut points = self.points();
        loop {
            self.read(&points);
            let more = self.points();
            if more.len() == points.len() {
                break;
            }
            points = more;
        }
        let row = |point: Point| {
            let (name, outcome) = self.found[&point].clone();
            (point, name, outcome)
        };
        points.into_iter().map(row).collect()
    }
}

/// Computes points in threads of this process.
pub struct Engine<'a> {
    pub study: &'a Study,
    pub interrupt: Interrupt,
    /// Points at a time.
    pub jobs: usize,
}

impl Engine<'_> {
    /// Computes all points, round by round of the refinement, and returns them with their outcomes. After Ctrl-C, points are
    /// missing.
    pub fn compute(&self) -> Result<Vec<(Point, String, Outcome)>, Failure> {
        let Study { sweep, folder, .. } = self.study;
        let mut known = Known::new(sweep, folder);
        let mut ticker = Ticker::new(self.interrupt.clone());
        loop {
            let rows = known.rows();
            let open = rows.iter().filter(|row| !row.2.status.is_final());
            let open: Vec<Point> = open.map(|row| row.0.clone()).collect();
            if open.is_empty() || self.interrupt.is_requested() {
                ticker.finish();
                return Ok(rows);
            }
            let finished = rows.len() - open.len();
            let computed = self.round(&open, finished, &mut ticker);
            let is_idle = computed.as_ref().is_ok_and(|count| *count == 0);
            computed.inspect_err(|_| ticker.finish())?;
            if is_idle {
                // Other processes work on the rest.
                std::thread::sleep(PAUSE);
            }
        }
    }

    /// Computes points; returns the number of those that this process has finished.
    fn round(
        &self,
        open: &[Point],
        finished: usize,
        ticker: &mut Ticker,
    ) -> Result<usize, SweepError> {
        let next = AtomicUsize::new(0);
        let (sender, receiver) = channel();
        std::thread::scope(|scope| {
            for _ in 0..self.jobs.min(open.len()) {
                let (sender, next) = (sender.clone(), &next);
                scope.spawn(move || {
                    while let Some(point) = open.get(next.fetch_add(1, Ordering::Relaxed)) {
                        if self.interrupt.is_requested()
                            || sender.send((point, self.point(point))).is_err()
                        {
                            break;
                        }
                    }
                });
            }
            drop(sender);
            let (total, mut count, mut known) = (finished + open.len(), 0, 0);
            let mut failure = None;
            loop {
                match receiver.recv_timeout(PAUSE) {
                    Ok((point, Ok(Claim::Computed(outcome)))) => {
                        count += 1;
                        let name = self.study.describe(point);
                        let number = finished + known + count;
                        ticker.line(&format!("{number:>6}/{total}  {name}: {}", short(&outcome)));
                    }
                    Ok((_, Ok(Claim::Known(_)))) => known += 1,
                    Ok((_, Ok(Claim::Taken | Claim::Cancelled))) => {}
                    Ok((_, Err(error))) => {
                        // The others stop too: the disk may be full.
                        next.store(open.len(), Ordering::Relaxed);
                        failure = Some(error);
                    }
                    Err(RecvTimeoutError::Timeout) => {
                        ticker.stop();
                    }
                    Err(RecvTimeoutError::Disconnected) => break,
                }
                let done = finished + known + count;
                let fraction = done as f64 / total.max(1) as f64;
                ticker.working(&format!("{done} of {total} points"), fraction);
            }
            failure.map_or(Ok(count + known), Err)
        })
    }

    /// Computes a point on one thread.
    fn point(&self, point: &Point) -> Result<Claim, SweepError> {
        let Study { sweep, folder, .. } = self.study;
        let compute = || folder.compute(sweep, point, &mut Quiet::new(self.interrupt.clone()));
        match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
            Ok(pool) => pool.install(compute),
            Err(_) => compute(),
        }
    }
}
