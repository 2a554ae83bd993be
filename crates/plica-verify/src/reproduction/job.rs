//! A run that figures look at: a case of the house, with keys changed.

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

/// A case, what is changed in it, and how it is run.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// Its name, and that of its directory.
    pub name: String,
    /// The name of its case: that of the file in `cases/`, without the ending.
    pub case: &'static str,
    /// Keys that are changed, and to what.
    pub changes: Vec<(String, String)>,
    /// Whether it is worth all threads: a tube of many rings. Others run side by side.
    pub large: bool,
}

impl Job {
    /// A case as it stands, under its own name.
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

    /// Under another name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// With a key changed.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl ToString) -> Self {
        self.changes.push((key.into(), value.to_string()));
        self
    }

    /// On a mesh: control points along, around, through the wall.
    #[must_use]
    pub fn on(self, [axial, around, thickness]: [usize; 3]) -> Self {
        let points = format!("{{ axial = {axial}, around = {around}, thickness = {thickness} }}");
        self.with("mesh.control_points", points)
    }

    /// From a state of another run.
    #[must_use]
    pub fn from(self, run: &str, state: usize) -> Self {
        let file = plica::run_directory::RunDirectory::name_of_state(state);
        self.with("start.state", format!("\"../{run}/{file}\""))
    }

    /// The name of the run that it starts from, if it starts from one.
    pub fn parent(&self) -> Option<String> {
        let start = self.changes.iter().find(|(key, _)| key == "start.state")?;
        Some(start.1.split('/').nth(1)?.to_owned())
    }

    /// Of which only the history is kept.
    #[must_use]
    pub fn bare(self) -> Self {
        let kept = self.with("output.states_every", 0);
        kept.with("output.profiles_every", 0)
    }

    /// With all threads.
    #[must_use]
    pub fn large(mut self) -> Self {
        self.large = true;
        self
    }

    /// The text of the case with its changes.
    pub fn text(&self) -> String {
        let known = CASES.iter().find(|(name, _)| *name == self.case);
        let Some((_, text)) = known else {
            unreachable!("a job is of a case that is there")
        };
        match plica::case::edited(text, &self.changes) {
            Ok(text) => text,
            Err(error) => unreachable!("{}: {error}", self.name),
        }
    }
}
