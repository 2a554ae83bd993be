//! Reads case files and the files that they name from disk.

use crate::args::{CaseArguments, Setting};
use crate::failure::Failure;
use plica::case::{self, EditError, Input, InputFile, OpenInput};
use plica::run_directory::{RunDirectory, RunError};
use plica::saved_state::{SavedState, SavedStateError};
use plica::study::{ModeShape, Plan};
use plica_view::draw::missing_glyphs;
use std::io::{Error, ErrorKind, Read};
use std::path::Path;

/// Largest size of a case file, in bytes.
const LARGEST: u64 = 1 << 20;

/// Reads a case file with the keys of `--set` changed, and returns its text and its plan. Paths in it are relative to its
/// folder; the files lie in that folder, in the current one, or in the one that `--within` names.
pub fn open(arguments: &CaseArguments) -> Result<(String, Plan), Failure> {
    let folders = Folders::of(arguments)?;
    open_with(&arguments.file, &arguments.set, &|file| folders.read(file))
}

/// Returns advice on a case that is allowed but perhaps not meant, a sentence each.
pub fn advice(plan: &Plan) -> Vec<String> {
    let mut advice = case::advice(plan);
    let names = plan.stages.iter().map(|stage| &stage.name[..]);
    let drawn: String = std::iter::once(&plan.title[..]).chain(names).collect();
    let missing: String = missing_glyphs(&drawn).into_iter().collect();
    if !missing.is_empty() {
        advice.push(format!(
            "the fonts of pictures have no glyphs for {missing} in the title or a name: PNGs show boxes (SVGs and reports use the reader's fonts)"
        ));
    }
    advice
}

/// The folders from which files that a case names may be read.
struct Folders<'a> {
    case: &'a Path,
    within: Option<&'a Path>,
}

impl<'a> Folders<'a> {
    fn of(arguments: &'a CaseArguments) -> Result<Self, Failure> {
        let case = match arguments.file.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let within = arguments.within.as_deref();
        if let Some(within) = within.filter(|within| !within.is_dir()) {
            let what = format!("--within {}: there is no such folder", within.display());
            return Err(Failure::Usage(what));
        }
        Ok(Self { case, within })
    }

    /// Reads a file in one of the folders. Symbolic links are resolved before.
    fn read(&self, wanted: InputFile<'_>) -> Result<Input, SavedStateError> {
        let file = self.case.join(wanted.path()).canonicalize()?;
        let folders = [Some(self.case), Some(Path::new(".")), self.within];
        let contains = |folder: &Path| {
            let folder = folder.canonicalize();
            folder.is_ok_and(|folder| file.starts_with(folder))
        };
        if !folders.into_iter().flatten().any(contains) {
            let why = "the file is neither in the folder of the case nor in the current one; \
                use --within DIR to allow another folder";
            return Err(Error::new(ErrorKind::PermissionDenied, why).into());
        }
        Input::read(wanted, &file)
    }
}

/// Reads a case file with keys changed; `open` reads the files that it names.
fn open_with(
    path: &Path,
    changes: &[Setting],
    open: &OpenInput<'_>,
) -> Result<(String, Plan), Failure> {
    let failure = |error| Failure::Files(format!("{}: {error}", path.display()));
    let too_large = || {
        let what = format!("{} is too large for a case", path.display());
        Failure::Usage(what)
    };
    if std::fs::metadata(path).map_err(failure)?.len() > LARGEST {
        return Err(too_large());
    }
    // A device or a pipe has no size.
    let mut bytes = vec![];
    let file = std::fs::File::open(path).map_err(failure)?;
    file.take(LARGEST + 1)
        .read_to_end(&mut bytes)
        .map_err(failure)?;
    if bytes.len() as u64 > LARGEST {
        return Err(too_large());
    }
    let Ok(text) = String::from_utf8(bytes) else {
        let what = format!("{} is not text (a case is TOML, in UTF-8)", path.display());
        return Err(Failure::Usage(what));
    };
    let text = match changes {
        [] => text,
        changes => changed(path, text, changes)?,
    };
    match case::read_with(&text, &stem(path), open) {
        Ok(plan) => Ok((text, plan)),
        Err(error) => Err(Failure::Case {
            path: path.to_owned(),
            text,
            error,
        }),
    }
}

/// Returns the text of a case with keys changed. A word without quotes that is no value is a text.
fn changed(path: &Path, text: String, changes: &[Setting]) -> Result<String, Failure> {
    // Mistakes of the file are reported as such.
    if let Err(error) = case::check_syntax(&text) {
        return Err(Failure::Case {
            path: path.to_owned(),
            text,
            error,
        });
    }
    changes.iter().try_fold(text, |text, (key, value)| {
        let quoted = format!("\"{value}\"");
        let is_word = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
        let edited = case::edited(&text, &[(key, value)]);
        let edited = match edited {
            Err(EditError::Syntax { .. }) if value.chars().all(is_word) => {
                case::edited(&text, &[(key, &quoted)])
            }
            edited => edited,
        };
        edited.map_err(|error| match error {
            EditError::Syntax { .. } => Failure::Usage(format!(
                "--set {key}={value}: not a key and a value as in a case file"
            )),
            error => Failure::Usage(format!("--set {error}")),
        })
    })
}

/// Returns the plan of a run directory, with the start state and the modes that it keeps.
///
/// # Errors
/// If one of the files that it keeps is damaged, or its case is not valid.
pub fn of_run(directory: &RunDirectory) -> Result<Plan, Failure> {
    for path in directory.inputs() {
        let read = SavedState::read(&path);
        read.map_err(|source| Failure::Run(RunError::State { path, source }))?;
    }
    let case = directory.path().join("case.toml");
    let (_, mut plan) = open_with(&case, &[], &|file| Input::kept(file, directory))?;
    // Without a title of its own, a case has the name of its file, which is another one here.
    let manifest = directory.manifest();
    let titled = manifest["title"].as_str().filter(|title| !title.is_empty());
    if let Some(title) = titled.filter(|_| plan.title == stem(&case)) {
        plan.title = title.to_owned();
    }
    Ok(plan)
}

/// Reads the case file of a run that is resumed, whose plan was `old`. Files with the same paths as
/// before are read from the run directory.
pub fn open_again(
    arguments: &CaseArguments,
    directory: &RunDirectory,
    old: &Plan,
) -> Result<(String, Plan), Failure> {
    let folders = Folders::of(arguments)?;
    open_with(&arguments.file, &arguments.set, &|wanted| {
        let is_same = match wanted {
            InputFile::State(file) => old.start.iter().any(|start| start.file == file),
            InputFile::Mode(number, file) => {
                let is_same = |mode: &ModeShape| mode.imperfection == number && mode.file == file;
                old.modes.iter().any(is_same)
            }
            InputFile::Materials(number, file) => {
                let same = old.materials.get(number - 1);
                same.is_some_and(|library| library.file == file)
            }
        };
        match is_same {
            true => Input::kept(wanted, directory),
            false => folders.read(wanted),
        }
    })
}

/// Returns the name of a case: that of its file, without the extension.
pub fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    stem.to_string_lossy().into_owned()
}
