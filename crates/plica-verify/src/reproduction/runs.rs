//! Completed runs, and the execution of missing ones.

use super::ReproductionError;
use super::job::Job;
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

/// Points per element along an evaluated wall.
const POINTS_PER_ELEMENT: usize = 4;

/// A completed run.
pub struct CompletedRun {
    /// The job.
    pub job: Job,
    /// The checked case.
    pub plan: Plan,
    /// Its accepted states.
    pub rows: Vec<Row>,
    /// `complete`, or `lost` if the path ended early.
    pub verdict: Verdict,
    tube: SplineTube,
    directory: PathBuf,
}

/// Completed runs by name, and the errors of failed ones.
#[derive(Default)]
pub struct Runs {
    done: BTreeMap<String, CompletedRun>,
    failed: BTreeMap<String, String>,
}

impl Runs {
    /// Returns a run.
    ///
    /// # Errors
    /// [`ReproductionError::Missing`] if it failed.
    pub fn get(&self, name: &str) -> Result<&CompletedRun, ReproductionError> {
        self.done
            .get(name)
            .ok_or_else(|| ReproductionError::Missing {
                run: name.into(),
                why: match self.failed.get(name) {
                    Some(why) => why.clone(),
                    None => "it is not among the runs of this figure".into(),
                },
            })
    }

    /// Opens the completed runs in a folder and performs the others: first the small ones in parallel, those without a
    /// parent before the rest, then the large ones one after the other in the given order.
    ///
    /// # Errors
    /// [`ReproductionError::Cancelled`] if the monitor cancels. A failed run is recorded as missing.
    pub fn of(
        jobs: &[Job],
        folder: &Path,
        monitor: &mut (dyn Monitor + Send),
    ) -> Result<Self, ReproductionError> {
        let mut runs = Self::default();
        let mut waves: Vec<Vec<&Job>> = vec![vec![]; 3];
        let mut repeated: Vec<&str> = vec![];
        for job in jobs {
            // Runs that start from a repeated run are repeated too.
            let parent = job.parent();
            let stale = parent
                .as_ref()
                .is_some_and(|name| repeated.contains(&name.as_str()));
            let completed = if stale { None } else { opened(job, folder) };
            if completed.is_none() {
                repeated.push(&job.name);
            }
            match completed {
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
            shared: Mutex::new(Shared {
                monitor,
                done: 0,
                of,
                cancelled: false,
            }),
            found: Mutex::new(runs),
        };
        let [first, second, large] = [&waves[0], &waves[1], &waves[2]];
        queue.run_in_parallel(first);
        queue.run_in_parallel(second);
        for job in large {
            queue.run(job);
        }
        let cancelled = lock(&queue.shared).cancelled;
        if cancelled {
            return Err(ReproductionError::Cancelled);
        }
        Ok(queue.found.into_inner().unwrap_or_else(|e| e.into_inner()))
    }

    /// Returns whether all jobs are completed in a folder.
    pub fn are_complete(jobs: &[Job], folder: &Path) -> bool {
        jobs.iter().all(|job| opened(job, folder).is_some())
    }
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    // After a panic of another thread the data are not evaluated.
    mutex.lock().unwrap_or_else(|e| e.into_inner())
}

/// Opens a completed run of the same case by the same version.
fn opened(job: &Job, folder: &Path) -> Option<CompletedRun> {
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
    // Runs with missing states are repeated.
    let saved = directory.numbered("states", "safetensors").ok()?;
    let every = plan.output.states_every;
    let is_saved =
        |row: &Row| every == 0 || !row.step.is_multiple_of(every) || saved.contains_key(&row.step);
    if directory.state_count() != Some(rows.len()) || !rows.iter().all(is_saved) {
        return None;
    }
    Some(CompletedRun::new(
        job,
        plan,
        rows,
        verdict,
        directory.path(),
    ))
}

fn plan(job: &Job, text: &str, folder: &Path) -> Result<Plan, case::CaseError> {
    let folder = folder.join(&job.name);
    let open =
        |wanted: InputFile<'_>| SavedState::read(&folder.join(wanted.path())).map(Into::into);
    case::read_with(text, &job.name, &open)
}

/// Data shared by the threads that perform jobs.
struct Queue<'a> {
    folder: &'a Path,
    shared: Mutex<Shared<'a>>,
    found: Mutex<Runs>,
}

/// The shared monitor and the progress.
struct Shared<'a> {
    monitor: &'a mut (dyn Monitor + Send),
    done: usize,
    of: usize,
    cancelled: bool,
}

impl Queue<'_> {
    /// Performs jobs in parallel, with one thread each.
    fn run_in_parallel(&self, jobs: &[&Job]) {
        let next = Mutex::new(jobs.iter());
        let work = || {
            let Ok(pool) = ThreadPoolBuilder::new().num_threads(1).build() else {
                return;
            };
            loop {
                // The lock is released before the job runs.
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
        // Jobs that are left if no thread pool could be built.
        for job in next.into_inner().unwrap_or_else(|e| e.into_inner()) {
            self.run(job);
        }
    }

    fn run(&self, job: &Job) {
        if lock(&self.shared).is_cancelled() {
            return;
        }
        let outcome = self.attempt(job);
        let mut shared = lock(&self.shared);
        shared.done += 1;
        let (done, of) = (shared.done, shared.of);
        let mut found = lock(&self.found);
        match outcome {
            Ok(Some(ran)) => {
                let progress = format!("{done:>4} of {of}  {}", ran.summary());
                shared.monitor.notice(&progress);
                found.done.insert(job.name.clone(), ran);
            }
            Ok(None) => shared.cancelled = true,
            Err(why) => {
                let failure = format!("            {} FAILED: {why}", job.name);
                shared.monitor.notice(&failure);
                found.failed.insert(job.name.clone(), why);
            }
        }
    }

    /// Performs a run; none if the monitor cancels.
    fn attempt(&self, job: &Job) -> Result<Option<CompletedRun>, String> {
        let text = job.text();
        // Paths of states of other runs are relative to the directory of this run.
        let own = self.folder.join(&job.name);
        fs::create_dir_all(&own).map_err(|error| format!("{}: {error}", own.display()))?;
        let plan = plan(job, &text, self.folder).map_err(|error| {
            let problems: Vec<String> = error.problems.iter().map(ToString::to_string).collect();
            problems.join("; ")
        })?;
        let path = self.folder.join(&job.name);
        let directory = RunDirectory::create(&path, &text, &plan.title, true);
        let message = |error: RunError| error.to_string();
        let mut directory = directory.map_err(message)?;
        let mut relay = Relay {
            shared: &self.shared,
            job,
        };
        let summary = run_directory::run(&plan, &mut directory, &mut relay).map_err(message)?;
        if matches!(summary.ending(), Ending::Stopped) {
            return Ok(None);
        }
        let verdict = match summary.ending() {
            Ending::Complete => Verdict::Complete,
            _ => Verdict::Lost,
        };
        let rows = summary.rows().to_vec();
        Ok(Some(CompletedRun::new(job, plan, rows, verdict, &path)))
    }
}

impl Shared<'_> {
    fn is_cancelled(&mut self) -> bool {
        self.cancelled = self.cancelled || self.monitor.is_cancelled();
        self.cancelled
    }
}

/// Forwards the progress of one run to the shared monitor.
struct Relay<'a, 'b> {
    shared: &'a Mutex<Shared<'b>>,
    job: &'a Job,
}

impl Monitor for Relay<'_, '_> {
    fn working(&mut self, activity: &dyn Display, fraction: f64) {
        let mut shared = lock(self.shared);
        let all = (shared.done as f64 + fraction) / shared.of.max(1) as f64;
        let activity = format_args!("{}: {activity}", self.job.name);
        shared.monitor.working(&activity, all);
    }

    fn is_cancelled(&self) -> bool {
        lock(self.shared).is_cancelled()
    }
}

impl CompletedRun {
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

    /// Describes its size and cost in one line.
    fn summary(&self) -> String {
        let lost = match self.verdict {
            Verdict::Complete => "",
            _ => ", lost",
        };
        format!(
            "{}: {} states, {} solves, {:.1} s{lost}",
            self.job.name,
            self.rows.len(),
            self.solves(),
            self.seconds()
        )
    }

    /// Returns the last state.
    ///
    /// # Errors
    /// [`ReproductionError::State`] if there is none.
    pub fn last(&self) -> Result<&Row, ReproductionError> {
        self.rows.last().ok_or_else(|| self.missing("a last state"))
    }

    /// Returns the states of a stage, preceded by the state that it begins at.
    pub fn stage(&self, name: &str) -> &[Row] {
        let is = |row: &Row| row.stage == name;
        let first = self.rows.iter().position(is).unwrap_or(self.rows.len());
        let last = self.rows.iter().rposition(is).map_or(first, |at| at + 1);
        &self.rows[first.saturating_sub(1)..last]
    }

    /// Returns the state of the stage `relax` at a length ratio.
    ///
    /// # Errors
    /// [`ReproductionError::State`] if there is none.
    pub fn at(&self, length_ratio: f64) -> Result<&Row, ReproductionError> {
        let here = |row: &&Row| (row.length_ratio - length_ratio).abs() < 1e-9;
        let found = self.stage("relax").iter().find(here);
        found.ok_or_else(|| self.missing(&format!("a state at Lmax/L = {length_ratio}")))
    }

    fn missing(&self, item: &str) -> ReproductionError {
        ReproductionError::State(format!("{} does not have {item}", self.job.name))
    }

    /// Returns the tube.
    pub fn tube(&self) -> &SplineTube {
        &self.tube
    }

    /// Reads a saved state.
    ///
    /// # Errors
    /// [`ReproductionError::State`] if it was not saved, or cannot be read.
    pub fn state(&self, row: &Row) -> Result<SavedState, ReproductionError> {
        let file = self.directory.join(RunDirectory::name_of_state(row.step));
        SavedState::read(&file).map_err(|error| {
            let run = self.directory.display();
            ReproductionError::State(format!(
                "{}: {error}; remove {run} to repeat the run",
                file.display()
            ))
        })
    }

    /// Returns the meridian of a face at an angle.
    ///
    /// # Errors
    /// As [`CompletedRun::state`].
    pub fn wall(&self, row: &Row, face: Face, angle: f64) -> Result<Wall, ReproductionError> {
        let state = self.state(row)?;
        let z = self
            .tube
            .axial
            .positions(self.tube.axial.elements() * POINTS_PER_ELEMENT + 1);
        let meridians = Meridians::of(&self.tube, &state.load, &state.u);
        Ok(meridians.walls(face, &[angle], &z).remove(0))
    }

    /// Returns the wall time in seconds.
    pub fn seconds(&self) -> f64 {
        self.rows.iter().map(|row| row.seconds).sum()
    }

    /// Returns the number of linear solves.
    pub fn solves(&self) -> usize {
        self.rows.iter().map(|row| row.iterations).sum()
    }

    /// Returns the number of iterations of conjugate gradients.
    pub fn cg_iterations(&self) -> usize {
        self.rows.iter().map(|row| row.cg_iterations).sum()
    }
}
