//! Conditions at which a run stops, as `shape = invaginated` or `overhang > 0.1`.

use super::{Plan, Quantity, Row};
use crate::measure::Shape;
use crate::tube::Symmetry;
use std::fmt;

/// A condition on an accepted state.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    text: String,
    test: Test,
}

#[derive(Clone, Debug, PartialEq)]
enum Test {
    /// The outer wall runs back along the axis.
    Overhangs,
    /// The state is unstable to a tested mode.
    Unstable,
    /// The cell of a column of texts is a word.
    Is(String, String),
    /// The cell of a column of numbers is, for example, less than a number: column, sign and number.
    Number(String, &'static str, f64),
}

/// The signs of comparisons; one that contains another comes before it.
const SIGNS: [&str; 5] = ["<=", ">=", "<", ">", "="];

/// Returns whether a comparison holds.
fn compares(a: f64, sign: &str, b: f64) -> bool {
    match sign {
        "<=" => a <= b,
        ">=" => a >= b,
        "<" => a < b,
        ">" => a > b,
        _ => a == b,
    }
}

impl Condition {
    /// Reads a condition on the states of a plan: `overhangs`, `unstable`, or the name of a column of the history, one of
    /// `=`, `<`, `<=`, `>`, `>=`, and a number or, after `=` only, a word.
    ///
    /// # Errors
    /// A sentence that names the mistake in the text.
    pub fn parse(text: &str, plan: &Plan) -> Result<Self, String> {
        let with = |test| Self {
            text: text.trim().to_owned(),
            test,
        };
        match text.trim() {
            "overhangs" => return Ok(with(Test::Overhangs)),
            "unstable" => return Ok(with(Test::Unstable)),
            _ => {}
        }
        let parts = SIGNS.into_iter().find_map(|sign| {
            let (name, value) = text.split_once(sign)?;
            Some((name.trim(), sign, value.trim()))
        });
        let Some((name, sign, value)) = parts else {
            let rule = "must be overhangs, unstable, or a column compared with a value";
            return Err(format!(
                "{rule}, as in \"shape = invaginated\" or \"overhang > 0.1\""
            ));
        };
        let cells = zero(plan).cells();
        let Some(cell) = cells.iter().find(|cell| cell.name == name) else {
            let names: Vec<&str> = cells.iter().map(|cell| cell.name.as_str()).collect();
            return Err(format!(
                "`{name}` is not a column of this run; choose overhangs, unstable, or one of {}",
                names.join(", ")
            ));
        };
        if cell.quantity != Quantity::Text {
            let number = value.parse().ok().filter(|x: &f64| x.is_finite());
            let number = number.ok_or_else(|| format!("`{value}` is not a number"))?;
            return Ok(with(Test::Number(name.to_owned(), sign, number)));
        }
        if sign != "=" {
            return Err(format!("`{name}` is a word; write {name} = {value}"));
        }
        check_word(name, value, plan)?;
        Ok(with(Test::Is(name.to_owned(), value.to_owned())))
    }

    /// Returns whether a state fulfils the condition; its numbers are in the units of the history.
    pub fn holds(&self, row: &Row) -> bool {
        let cell = |name: &str| row.cells().into_iter().find(|cell| cell.name == name);
        match &self.test {
            Test::Overhangs => row.overhangs(),
            Test::Unstable => row.stability.is_unstable(),
            Test::Is(name, word) => cell(name).is_some_and(|cell| cell.text == *word),
            Test::Number(name, sign, number) => {
                let value = cell(name).and_then(|cell| cell.number());
                value.is_some_and(|value| compares(value, sign, *number))
            }
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// Returns a row with the columns of a plan.
fn zero(plan: &Plan) -> Row {
    let muscles = plan.tube.muscles.iter();
    let muscles: Vec<&str> = muscles.map(|muscle| muscle.name.as_str()).collect();
    let active = plan.tube.muscles.iter().filter(|muscle| !muscle.grows());
    let active: Vec<&str> = active.map(|muscle| muscle.name.as_str()).collect();
    let mut row = Row::zero(&muscles, plan.end_names.each_ref().map(String::as_str))
        .with_active_stresses(&active);
    if plan.contact {
        row = row.with_contact();
    }
    let obstacles = plan.tube.obstacles.iter();
    let obstacles: Vec<&str> = obstacles.map(|obstacle| obstacle.name.as_str()).collect();
    let patches = plan.tube.patches.iter();
    let patches: Vec<&str> = patches.map(|patch| patch.name.as_str()).collect();
    row = row.with_obstacles(&obstacles).with_patches(&patches);
    if plan.symmetry != Symmetry::Axisymmetric {
        row = row.with_contact_angles();
    }
    if !plan.tube.foundations.is_empty() {
        row = row.with_foundations();
    }
    if plan.has_pressures() {
        row = row.with_pressures();
    }
    if plan.has_sideways_ends() {
        row = row.with_sideways_ends();
    }
    match plan.drives_lumen() {
        true => row.with_lumen_pressure(),
        false => row,
    }
}

/// Refuses words that a column never has.
fn check_word(name: &str, word: &str, plan: &Plan) -> Result<(), String> {
    let words: Vec<String> = match name {
        "shape" => Shape::ALL.iter().map(ToString::to_string).collect(),
        "side" => [&plan.end_names[..], &["none".to_owned()]].concat(),
        "stage" => plan.stages.iter().map(|stage| stage.name.clone()).collect(),
        "equilibrium" => ["yes", "no"].map(String::from).to_vec(),
        _ => return Ok(()),
    };
    if words.iter().any(|own| own == word) {
        return Ok(());
    }
    Err(format!(
        "{name} is never `{word}`; choose one of {}",
        words.join(", ")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fixture;
    use crate::tube::Symmetry;

    fn holds(text: &str, change: impl Fn(&mut Row)) -> bool {
        let plan = fixture::plan(Symmetry::Axisymmetric);
        let mut row = zero(&plan);
        change(&mut row);
        Condition::parse(text, &plan).unwrap().holds(&row)
    }

    #[test]
    fn conditions_compare_words_and_numbers_of_a_state() {
        assert!(holds("shape = invaginated", |row| row.shape = Shape::Invaginated));
        assert!(!holds("shape = invaginated", |row| row.shape = Shape::Square));
        assert!(holds(" overhang >0.1", |row| row.overhang = 0.11));
        assert!(!holds("overhang > 0.1", |row| row.overhang = 0.1));
        assert!(holds("overhang>=0.1", |row| row.overhang = 0.1));
        assert!(holds("lumen < 1e-2", |row| row.lumen = -1.0));
        assert!(!holds("lumen <= -2", |row| row.lumen = -1.0));
        assert!(holds("step = 3", |row| row.step = 3));
        let unstable = |row: &mut Row| row.stability = "1:2".parse().unwrap();
        assert!(holds("unstable", unstable) && !holds("unstable", |_| {}));
        let overhangs = |row: &mut Row| {
            (row.overhang, row.max_wall_angle_deg) = (0.3, 150.0);
        };
        assert!(holds("overhangs", overhangs) && !holds("overhangs", |_| {}));
    }

    #[test]
    fn columns_of_contact_exist_in_runs_with_contact_only() {
        let mut plan = fixture::plan(Symmetry::Axisymmetric);
        let text = "contact_force_outer-wall > 0";
        assert!(Condition::parse(text, &plan).is_err());
        plan.contact = true;
        let condition = Condition::parse(text, &plan).unwrap();
        let mut row = zero(&plan);
        assert!(!condition.holds(&row));
        row.contact.walls[1].force = Some(0.1);
        assert!(condition.holds(&row));
    }

    #[test]
    fn a_condition_that_never_holds_is_refused_with_the_reason() {
        let plan = fixture::plan(Symmetry::Axisymmetric);
        for (text, reason) in [
            ("invaginated", "as in \"shape = invaginated\""),
            ("beauty > 1", "`beauty` is not a column of this run"),
            ("overhang > large", "`large` is not a number"),
            ("overhang > nan", "`nan` is not a number"),
            ("shape > V", "write shape = V"),
            ("shape = W", "shape is never `W`; choose one of straight, V"),
            ("side = right", "choose one of colon, ileum, none"),
        ] {
            let error = Condition::parse(text, &plan).unwrap_err();
            assert!(error.contains(reason), "{text}: {error}");
        }
    }
}
