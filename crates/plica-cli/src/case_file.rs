//! Reading a case from disk.

use crate::args::CaseArguments;
use crate::failure::Failure;
use plica::case::{self, Open, Wanted};
use plica::run_directory::{RunDirectory, RunError};
use plica::saved_state::{SavedState, SavedStateError};
use plica::study::{ModeShape, Plan};
use plica_view::draw::missing_glyphs;
use std::io::{Error, ErrorKind, Read};
use std::path::Path;

/// Larger than any case; smaller than the memory of any machine.
const LARGEST: u64 = 1 << 20;

/// The text of a case file and what it means; files that it names are looked for from the folder of the file on. They lie in
/// that folder, in the one that the program runs in, or in one that the user has given.
pub fn open(arguments: &CaseArguments) -> Result<(String, Plan), Failure> {
    let reach = Reach::of(arguments)?;
    open_with(&arguments.file, &|wanted| reach.read(wanted))
}

/// What whoever runs a case should know, a sentence each.
pub fn advice(plan: &Plan) -> Vec<String> {
    let mut advice = case::advice(plan);
    let names = plan.stages.iter().map(|stage| &stage.name[..]);
    let drawn: String = std::iter::once(&plan.title[..]).chain(names).collect();
    let boxes: String = missing_glyphs(&drawn).into_iter().collect();
    if !boxes.is_empty() {
        advice.push(format!(
            "there are no letters for {boxes} of titles and names in the fonts of pictures: PNGs show boxes (SVGs and reports are set in the fonts of whoever reads them)"
        ));
    }
    advice
}

/// Where files may lie that a case names.
struct Reach<'a> {
    folder: &'a Path,
    within: Option<&'a Path>,
}

impl<'a> Reach<'a> {
    fn of(arguments: &'a CaseArguments) -> Result<Self, Failure> {
        let folder = match arguments.file.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let within = arguments.within.as_deref();
        if let Some(within) = within.filter(|within| !within.is_dir()) {
            let what = format!("--within {}: there is no such folder", within.display());
            return Err(Failure::Usage(what));
        }
        Ok(Self { folder, within })
    }

    /// Reads a file, if it lies there.
    fn read(&self, wanted: Wanted<'_>) -> Result<SavedState, SavedStateError> {
        let file = self.folder.join(wanted.path());
        let roots = [Some(self.folder), Some(Path::new(".")), self.within];
        // Links followed, once.
        let file = file.canonicalize()?;
        if !lies_in(&file, roots.into_iter().flatten()) {
            let why = "it lies neither in the folder of the case nor in the one that plica runs in, and a case does not reach further by \
                itself; if it may, name a folder that holds it with --within DIR";
            return Err(Error::new(ErrorKind::PermissionDenied, why).into());
        }
        SavedState::read(&file)
    }
}

/// Whether a file lies in one of some folders, links of those followed.
fn lies_in<'a>(file: &Path, mut folders: impl Iterator<Item = &'a Path>) -> bool {
    folders.any(|folder| {
        let folder = folder.canonicalize();
        folder.is_ok_and(|folder| file.starts_with(folder))
    })
}

/// The same, with another way to the files that it names.
pub fn open_with(path: &Path, named: &Open<'_>) -> Result<(String, Plan), Failure> {
    let trouble = |error| Failure::Files(format!("{}: {error}", path.display()));
    let size = std::fs::metadata(path).map_err(trouble)?.len();
    if size > LARGEST {
        let what = format!("{} is too large for a case ({size} bytes)", path.display());
        return Err(Failure::Usage(what));
    }
    // A device or a pipe has no size; no more than the largest case is read of it.
    let mut bytes = vec![];
    let file = std::fs::File::open(path).map_err(trouble)?;
    file.take(LARGEST + 1)
        .read_to_end(&mut bytes)
        .map_err(trouble)?;
    if bytes.len() as u64 > LARGEST {
        return Err(Failure::Usage(format!(
            "{} is too large for a case",
            path.display()
        )));
    }
    let Ok(text) = String::from_utf8(bytes) else {
        let what = format!("{} is not text (a case is TOML, in UTF-8)", path.display());
        return Err(Failure::Usage(what));
    };
    match case::read_with(&text, &stem(path), named) {
        Ok(plan) => Ok((text, plan)),
        Err(error) => Err(Failure::Case {
            path: path.to_owned(),
            text,
            error,
        }),
    }
}

/// The plan of a run that is there. The state it began from it has kept, and the modes of its imperfections.
///
/// # Errors
/// What it has kept, if that is damaged, and not the case that names it.
pub fn of_run(directory: &RunDirectory) -> Result<Plan, Failure> {
    for path in directory.inputs() {
        let read = SavedState::read(&path);
        read.map_err(|source| Failure::Run(RunError::State { path, source }))?;
    }
    let own = |wanted: Wanted<'_>| kept(directory, wanted);
    let case = directory.path().join("case.toml");
    let (_, mut plan) = open_with(&case, &own)?;
    // A case without a title had that of its file, which was called otherwise then.
    let manifest = directory.manifest();
    let titled = manifest["title"].as_str().filter(|title| !title.is_empty());
    if let Some(title) = titled.filter(|_| plan.title == stem(&case)) {
        plan.title = title.to_owned();
    }
    Ok(plan)
}

/// [`open`] for a run that was begun by a case that meant `old`: a file that is still named as it was then is not asked for again.
pub fn open_again(
    arguments: &CaseArguments,
    directory: &RunDirectory,
    old: &Plan,
) -> Result<(String, Plan), Failure> {
    let reach = Reach::of(arguments)?;
    open_with(&arguments.file, &|wanted| {
        let as_then = match wanted {
            Wanted::State(file) => old.start.iter().any(|start| start.file == file),
            Wanted::Mode(number, file) => {
                let is_it = |mode: &ModeShape| mode.imperfection == number && mode.file == file;
                old.modes.iter().any(is_it)
            }
        };
        if as_then {
            kept(directory, wanted)
        } else {
            reach.read(wanted)
        }
    })
}

/// What a run has kept of a file that its case names.
fn kept(directory: &RunDirectory, wanted: Wanted<'_>) -> Result<SavedState, SavedStateError> {
    match wanted {
        Wanted::State(_) => {
            let kept = directory.start();
            // A run of before that was kept has its own first state.
            let first = directory.path().join(RunDirectory::name_of_state(0));
            SavedState::read(if kept.exists() { &kept } else { &first })
        }
        Wanted::Mode(number, _) => SavedState::read(&directory.imperfection(number)),
    }
}

/// The name of a case: that of its file, without the ending.
pub fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    stem.to_string_lossy().into_owned()
}
