//! Doing what is not done yet, and looking at what is.

use super::job::Job;
use super::{Observer, Trouble};
use plica::assembly::SplineTube;
use plica::case::{self, InputFile};
use plica::measure::{Face, Meridians, Wall};
use plica::monitor::Monitor;
use plica::run_directory::{self, RunDirectory, RunError, Verdict};
use plica::saved_state::SavedState;
use plica::study::{Ending, Plan, Row};
use rayon::ThreadPoolBuilder;
use std::collections::BTreeMap;
use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::thread;

/// Points per element along a wall that is looked at.
const POINTS_PER_ELEMENT: usize = 4;

/// A run that is done.
pub struct Ran {
    /// What was run.
    pub job: Job,
    /// What that means.
    pub plan: Plan,
    /// Its accepted states.
    pub rows: Vec<Row>,
    /// `complete`, or `lost` if the tube could not be followed to the end.
    pub verdict: Verdict,
    tube: SplineTube,
    directory: PathBuf,
}

/// Runs by their names; and why some are not there.
#[derive(Default)]
pub struct Runs {
    done: BTreeMap<String, Ran>,
    failed: BTreeMap<String, String>,
}

impl Runs {
    /// A run.
    ///
    /// # Errors
    /// [`Trouble::Missing`] if it could not be done.
    pub fn get(&self, name: &str) -> Result<&Ran, Trouble> {
        self.done.get(name).ok_or_else(|| Trouble::Missing {
            run: name.into(),
            why: match self.failed.get(name) {
                Some(why) => why.clone(),
                None => "it is none of this figure's".into(),
            },
        })
    }

    /// Opens what is done already in a folder, and does the rest: large ones with all threads, one after the other, in
    /// the order given; the others before, side by side. A job may start from a state of one before it if that is not
    /// one of those that run side by side.
    ///
    /// # Errors
    /// [`Trouble::Stopped`] if the observer asked to stop. A run that fails is missing, and no trouble here.
    pub fn of(
        jobs: &[Job],
        folder: &Path,
        observer: &mut (dyn Observer + Send),
    ) -> Result<Self, Trouble> {
        let mut runs = Self::default();
        let mut waves: Vec<Vec<&Job>> = vec![vec![]; 3];
        let mut anew: Vec<&str> = vec![];
        for job in jobs {
            // What starts from a run that is done again is done again too.
            let parent = job.parent();
            let stale = parent
                .as_ref()
                .is_some_and(|name| anew.contains(&name.as_str()));
            let there = if stale { None } else { opened(job, folder) };
            if there.is_none() {
                anew.push(&job.name);
            }
            match there {
                Some(ran) => {
                    runs.done.insert(job.name.clone(), ran);
                }
                None if job.large => waves[2].push(job),
                None if parent.is_some() => waves[1].push(job),
                None => waves[0].push(job),
            }
        }
        let of: usize = waves.iter().map(Vec::len).sum();
        let queue = Queue {
            folder,
            monitor: Mutex::new(Shared {
                observer,
                done: 0,
                of,
                stopped: false,
            }),
            found: Mutex::new(runs),
        };
        let [first, second, large] = [&waves[0], &waves[1], &waves[2]];
        queue.side_by_side(first);
        queue.side_by_side(second);
        for job in large {
            queue.run(job);
        }
        let stopped = lock(&queue.monitor).stopped;
        if stopped {
            return Err(Trouble::Stopped);
        }
        Ok(queue.found.into_inner().unwrap_or_else(|e| e.into_inner()))
    }

    /// Whether all jobs are done in a folder.
    pub fn are_there(jobs: &[Job], folder: &Path) -> bool {
        jobs.iter().all(|job| opened(job, folder).is_some())
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    // What a thread that panicked left is looked at no more.
    mutex.lock().unwrap_or_else(|e| e.into_inner())
}

/// A run of this very case by this very version that came to its end.
fn opened(job: &Job, folder: &Path) -> Option<Ran> {
    let directory = RunDirectory::open(&folder.join(&job.name)).ok()?;
    let text = job.text();
    let same = directory.case_hash() == blake3::hash(text.as_bytes()).to_string();
    let verdict = directory.verdict();
    let ended = matches!(verdict, Verdict::Complete | Verdict::Lost);
    if !same || !ended || directory.version() != env!("CARGO_PKG_VERSION") {
        return None;
    }
    let plan = plan(job, &text, folder).ok()?;
    let rows = directory.history().ok()?;
    // Nor one of which something is gone.
    let saved = directory.numbered("states", "safetensors").ok()?;
    let every = plan.output.states_every;
    let is_saved =
        |row: &Row| every == 0 || !row.step.is_multiple_of(every) || saved.contains_key(&row.step);
    if directory.state_count() != Some(rows.len()) || !rows.iter().all(is_saved) {
        return None;
    }
    Some(Ran::new(job, plan, rows, verdict, directory.path()))
}

fn plan(job: &Job, text: &str, folder: &Path) -> Result<Plan, case::CaseError> {
    let folder = folder.join(&job.name);
    let open = |wanted: InputFile<'_>| SavedState::read(&folder.join(wanted.path()));
    case::read_with(text, &job.name, &open)
}

/// Jobs that are done, and those who watch and wait.
struct Queue<'a> {
    folder: &'a Path,
    monitor: Mutex<Shared<'a>>,
    found: Mutex<Runs>,
}

/// What threads share of the observer.
struct Shared<'a> {
    observer: &'a mut (dyn Observer + Send),
    done: usize,
    of: usize,
    stopped: bool,
}

impl Queue<'_> {
    /// Each with a thread of its own, as many at a time as there are threads.
    fn side_by_side(&self, jobs: &[&Job]) {
        let next = Mutex::new(jobs.iter());
        let work = || {
            let Ok(pool) = ThreadPoolBuilder::new().num_threads(1).build() else {
                return;
            };
            loop {
                // Not held while it runs.
                let job = lock(&next).next();
                match job {
                    Some(job) => pool.install(|| self.run(job)),
                    None => break,
                }
            }
        };
        let threads = rayon::current_num_threads().min(jobs.len());
        thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(work);
            }
        });
        // Where no pool could be built.
        for job in next.into_inner().unwrap_or_else(|e| e.into_inner()) {
            self.run(job);
        }
    }

    fn run(&self, job: &Job) {
        if lock(&self.monitor).stop() {
            return;
        }
        let outcome = self.attempt(job);
        let mut monitor = lock(&self.monitor);
        monitor.done += 1;
        let (done, of) = (monitor.done, monitor.of);
        let mut found = lock(&self.found);
        match outcome {
            Ok(Some(ran)) => {
                monitor.observer.ran(&ran, done, of);
                found.done.insert(job.name.clone(), ran);
            }
            Ok(None) => monitor.stopped = true,
            Err(why) => {
                monitor.observer.failed(&job.name, &why);
                found.failed.insert(job.name.clone(), why);
            }
        }
    }

    /// The run; none if someone asked to stop.
    fn attempt(&self, job: &Job) -> Result<Option<Ran>, String> {
        let text = job.text();
        // A state of another run is named from here on.
        let own = self.folder.join(&job.name);
        fs::create_dir_all(&own).map_err(|error| format!("{}: {error}", own.display()))?;
        let plan = plan(job, &text, self.folder).map_err(|error| {
            let problems: Vec<String> = error.problems.iter().map(ToString::to_string).collect();
            problems.join("; ")
        })?;
        let path = self.folder.join(&job.name);
        let directory = RunDirectory::create(&path, &text, &plan.title, true);
        let trouble = |error: RunError| error.to_string();
        let mut directory = directory.map_err(trouble)?;
        let mut relay = Relay {
            monitor: &self.monitor,
            job,
        };
        let summary = run_directory::run(&plan, &mut directory, &mut relay).map_err(trouble)?;
        if matches!(summary.ending(), Ending::Stopped) {
            return Ok(None);
        }
        let verdict = match summary.ending() {
            Ending::Complete => Verdict::Complete,
            _ => Verdict::Lost,
        };
        let rows = summary.rows().to_vec();
        Ok(Some(Ran::new(job, plan, rows, verdict, &path)))
    }
}

impl Shared<'_> {
    fn stop(&mut self) -> bool {
        self.stopped = self.stopped || self.observer.stop();
        self.stopped
    }
}

/// Tells the observer of all what one run does.
struct Relay<'a, 'b> {
    monitor: &'a Mutex<Shared<'b>>,
    job: &'a Job,
}

impl Monitor for Relay<'_, '_> {
    fn working(&mut self, activity: &dyn Display, fraction: f64) {
        let mut monitor = lock(self.monitor);
        let all = (monitor.done as f64 + fraction) / monitor.of.max(1) as f64;
        let what = format!("{}: {activity}", self.job.name);
        monitor.observer.working(&what, all);
    }

    fn is_cancelled(&self) -> bool {
        lock(self.monitor).stop()
    }
}

impl Ran {
    fn new(job: &Job, plan: Plan, rows: Vec<Row>, verdict: Verdict, directory: &Path) -> Self {
        let rings = plan.mesh.rings(plan.symmetry);
        Self {
            tube: SplineTube::new(&plan.tube, &plan.mesh, rings),
            job: job.clone(),
            plan,
            rows,
            verdict,
            directory: directory.to_owned(),
        }
    }

    /// The last state.
    ///
    /// # Errors
    /// [`Trouble::State`] if there is none.
    pub fn last(&self) -> Result<&Row, Trouble> {
        self.rows.last().ok_or_else(|| self.lacks("a last state"))
    }

    /// The states of a stage, the one that it begins at before them.
    pub fn stage(&self, name: &str) -> &[Row] {
        let is = |row: &Row| row.stage == name;
        let first = self.rows.iter().position(is).unwrap_or(self.rows.len());
        let last = self.rows.iter().rposition(is).map_or(first, |at| at + 1);
        &self.rows[first.saturating_sub(1)..last]
    }

    /// The state of the stage `relax` at a length ratio.
    ///
    /// # Errors
    /// [`Trouble::State`] if there is none.
    pub fn at(&self, length_ratio: f64) -> Result<&Row, Trouble> {
        let here = |row: &&Row| (row.length_ratio - length_ratio).abs() < 1e-9;
        let found = self.stage("relax").iter().find(here);
        found.ok_or_else(|| self.lacks(&format!("a state at Lmax/L = {length_ratio}")))
    }

    fn lacks(&self, what: &str) -> Trouble {
        Trouble::State(format!("{} has not {what}", self.job.name))
    }

    /// The tube.
    pub fn tube(&self) -> &SplineTube {
        &self.tube
    }

    /// A state in full.
    ///
    /// # Errors
    /// [`Trouble::State`] if it was not saved, or cannot be read.
    pub fn state(&self, row: &Row) -> Result<SavedState, Trouble> {
        let file = self.directory.join(RunDirectory::name_of_state(row.step));
        SavedState::read(&file).map_err(|error| {
            let run = self.directory.display();
            Trouble::State(format!(
                "{}: {error}; remove {run}, and it is done again",
                file.display()
            ))
        })
    }

    /// The meridian of a state's face at an angle.
    ///
    /// # Errors
    /// As [`Ran::state`].
    pub fn wall(&self, row: &Row, face: Face, angle: f64) -> Result<Wall, Trouble> {
        let state = self.state(row)?;
        let z = self
            .tube
            .axial
            .positions(self.tube.axial.elements() * POINTS_PER_ELEMENT + 1);
        let meridians = Meridians::of(&self.tube, &state.load, &state.u);
        Ok(meridians.walls(face, &[angle], &z).remove(0))
    }

    /// Wall time, in seconds.
    pub fn seconds(&self) -> f64 {
        self.rows.iter().map(|row| row.seconds).sum()
    }

    /// Linear solves.
    pub fn solves(&self) -> usize {
        self.rows.iter().map(|row| row.iterations).sum()
    }

    /// Iterations of conjugate gradients.
    pub fn cg_iterations(&self) -> usize {
        self.rows.iter().map(|row| row.cg_iterations).sum()
    }
}
