//! Runs of figures: cases of `cases/` with changed keys.

macro_rules! case {
    ($name:literal) => {
        ($name, include_str!(concat!("../../cases/", $name, ".toml")))
    };
}

/// The cases, by the names of their files.
const CASES: &[(&str, &str)] = &[
    case!("contraction"),
    case!("relaxation"),
    case!("collapse"),
    case!("invagination"),
    case!("paper-scheme"),
    case!("colon-side"),
    case!("ileum-side"),
    case!("push-colon"),
    case!("push-ileum"),
    case!("other-side"),
    case!("perturbed"),
];

/// A run to do: a case with changed keys.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// Name of the run and of its directory.
    pub name: String,
    /// Name of the case file in `cases/`, without the extension.
    pub case: &'static str,
    /// Changed keys with their values.
    pub changes: Vec<(String, String)>,
    /// True if it runs alone, with all threads; others run in parallel, with one thread each.
    pub large: bool,
}

impl Job {
    /// Creates a run of an unchanged case, under the name of the case.
    ///
    /// # Panics
    /// If there is no such case.
    pub fn of(case: &'static str) -> Self {
        assert!(
            CASES.iter().any(|(name, _)| *name == case),
            "no case {case}"
        );
        Self {
            name: case.into(),
            case,
            changes: vec![],
            large: false,
        }
    }

    /// Sets the name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Changes a key.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl ToString) -> Self {
        self.changes.push((key.into(), value.to_string()));
        self
    }

    /// Sets the mesh: control points along, around and through the wall.
    #[must_use]
    pub fn on(self, [axial, around, thickness]: [usize; 3]) -> Self {
        let points = format!("{{ axial = {axial}, around = {around}, thickness = {thickness} }}");
        self.with("mesh.control_points", points)
    }

    /// Starts from a state of another run.
    #[must_use]
    pub fn from(self, run: &str, state: usize) -> Self {
        let file = plica::run_directory::RunDirectory::name_of_state(state);
        self.with("start.state", format!("\"../{run}/{file}\""))
    }

    /// Returns the name of the run that it starts from, if any.
    pub fn parent(&self) -> Option<String> {
        let start = self.changes.iter().find(|(key, _)| key == "start.state")?;
        Some(start.1.split('/').nth(1)?.to_owned())
    }

    /// Saves the history only, without states and profiles.
    #[must_use]
    pub fn history_only(self) -> Self {
        let kept = self.with("output.states_every", 0);
        kept.with("output.profiles_every", 0)
    }

    /// Runs alone, with all threads.
    #[must_use]
    pub fn large(mut self) -> Self {
        self.large = true;
        self
    }

    /// Returns the text of the changed case.
    pub fn text(&self) -> String {
        let known = CASES.iter().find(|(name, _)| *name == self.case);
        let Some((_, text)) = known else {
            unreachable!("the case of a job exists")
        };
        match plica::case::edited(text, &self.changes) {
            Ok(text) => text,
            Err(error) => unreachable!("{}: {error}", self.name),
        }
    }
}
