//! What differs between a run and the first one.

use super::run::{Precedence, Quantity, Run};
use crate::error::Result;
use crate::statistics::student_t_two_sided_p;

/// The probability of any significant difference among all numbers where there is none
/// (Bonferroni).
pub const LEVEL: f64 = 0.05;

/// A file in two runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// Its name in the first run and in the other.
    pub files: [Option<String>; 2],
    /// What became of it.
    pub state: State,
}

/// What became of something between two runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// The same content, whatever its name.
    Same,
    /// Another content.
    Changed,
    /// In one run alone.
    Alone,
}

/// A number in two runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// In the first run and in the other, with standard errors.
    pub values: [Option<Quantity>; 2],
    /// Other less first.
    pub difference: Option<f64>,
    /// √(s₁² + s₂²), as of two recordings that have nothing in common.
    pub std_error: Option<f64>,
    /// Difference over its standard error is larger than chance allows; nothing where that cannot
    /// be told.
    pub is_significant: Option<bool>,
    /// Which of several errors counts.
    pub precedence: Precedence,
}

/// A run against the first one.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Input files.
    pub inputs: Vec<Input>,
    /// Options that differ, by name: in the first run and in the other.
    pub options: Vec<(String, [String; 2])>,
    /// Recordings that both runs were made of: their errors are common, and nothing is tested.
    pub shared_recordings: Vec<String>,
    /// Parameters.
    pub parameters: Vec<Change>,
    /// Errors.
    pub errors: Vec<Change>,
    /// Findings, and whether the first run and the other have them.
    pub findings: Vec<(String, [bool; 2])>,
}

impl Difference {
    /// Of two runs.
    ///
    /// # Errors
    /// None that a number could cause.
    pub fn between(first: &Run, other: &Run) -> Result<Difference> {
        let inputs = inputs(first, other);
        let is_recording = |file: &&String| file.to_lowercase().ends_with(".csv");
        let shared = inputs.iter().filter(|input| input.state == State::Same);
        let shared_recordings: Vec<String> =
            shared.filter_map(|input| input.files[0].as_ref()).filter(is_recording).cloned().collect();
        let mut parameters = changes(&first.parameters, &other.parameters);
        // the same data cannot differ by chance, and a difference of what they have in common is no
        // test
        if shared_recordings.is_empty() {
            test(&mut parameters)?;
        }
        let has = |name: &String| [first, other].map(|run| run.findings.contains(name));
        Ok(Difference {
            inputs,
            options: options(first, other),
            shared_recordings,
            parameters,
            errors: changes(&first.errors, &other.errors),
            findings: united(&first.findings, &other.findings)
                .map(|name| (name.clone(), has(name)))
                .collect(),
        })
    }

    /// How many parameters differ significantly.
    pub fn significant(&self) -> usize {
        self.parameters.iter().filter(|change| change.is_significant == Some(true)).count()
    }

    /// How many parameters could be tested.
    pub fn tested(&self) -> usize {
        self.parameters.iter().filter(|change| change.is_significant.is_some()).count()
    }
}

impl Change {
    /// Difference over its standard error.
    pub fn ratio(&self) -> Option<f64> {
        Some(self.difference? / self.std_error.filter(|&error| error > 0.0)?)
    }
}

/// The options that differ; one that a run does not know was not given there.
fn options(first: &Run, other: &Run) -> Vec<(String, [String; 2])> {
    let names = |run: &Run| run.options.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    let value = |run: &Run, name: &String| {
        let found = run.options.iter().find(|(known, _)| known == name);
        found.map_or_else(|| "not given".to_owned(), |(_, value)| value.clone())
    };
    let both = |name: &String| (name.clone(), [first, other].map(|run| value(run, name)));
    let (a, b) = (names(first), names(other));
    united(&a, &b).map(both).filter(|(_, [a, b])| a != b).collect()
}

fn united<'a, T: PartialEq>(first: &'a [T], other: &'a [T]) -> impl Iterator<Item = &'a T> {
    first.iter().chain(other.iter().filter(|item| !first.contains(item)))
}

/// Name and SHA-256.
type File = (String, String);

fn last(file: &File) -> &str {
    file.0.rsplit(['/', '\\']).next().unwrap_or_default()
}

/// What its name ends in: "csv".
fn kind(file: &File) -> &str {
    last(file).rsplit_once('.').map_or("", |(_, kind)| kind)
}

/// The same content first, then the same name, then the same last part of it, then the only ones of
/// a kind.
fn inputs(first: &Run, other: &Run) -> Vec<Input> {
    let mut rest: Vec<&File> = other.inputs.iter().collect();
    let mut partners: Vec<Option<&File>> = vec![None; first.inputs.len()];
    let is_partner: [fn(&File, &File) -> bool; 4] =
        [|a, b| a == b, |a, b| a.1 == b.1, |a, b| a.0 == b.0, |a, b| last(a) == last(b)];
    for is_partner in is_partner {
        for (file, partner) in first.inputs.iter().zip(&mut partners).filter(|(_, partner)| partner.is_none())
        {
            let place = rest.iter().position(|candidate| is_partner(file, candidate));
            *partner = place.map(|place| rest.remove(place));
        }
    }
    // one that is left on either side, of one kind
    let left: Vec<usize> = (0..partners.len()).filter(|&k| partners[k].is_none()).collect();
    for &k in &left {
        let is_only =
            left.iter().filter(|&&other| kind(&first.inputs[other]) == kind(&first.inputs[k])).count() == 1;
        let mut alike = rest.iter().enumerate().filter(|(_, file)| kind(file) == kind(&first.inputs[k]));
        if let (true, Some((place, _)), None) = (is_only, alike.next(), alike.next()) {
            partners[k] = Some(rest.remove(place));
        }
    }
    let pair = |(file, partner): (&File, Option<&File>)| Input {
        files: [Some(file.0.clone()), partner.map(|partner| partner.0.clone())],
        state: match partner {
            Some(partner) if partner.1 == file.1 => State::Same,
            Some(_) => State::Changed,
            None => State::Alone,
        },
    };
    let paired = first.inputs.iter().zip(partners).map(pair);
    let alone =
        rest.into_iter().map(|file| Input { files: [None, Some(file.0.clone())], state: State::Alone });
    paired.chain(alone).collect()
}

fn changes(first: &[Quantity], other: &[Quantity]) -> Vec<Change> {
    let key = |quantity: &Quantity| (quantity.name.clone(), quantity.unit.clone());
    let (keys, more): (Vec<_>, Vec<_>) = (first.iter().map(key).collect(), other.iter().map(key).collect());
    let change = |(name, unit): &(String, String)| {
        let find = |list: &[Quantity]| list.iter().find(|q| q.name == *name && q.unit == *unit).cloned();
        let values = [find(first), find(other)];
        let both = values[0].as_ref().zip(values[1].as_ref());
        let errors = both.and_then(|(a, b)| a.std_error.zip(b.std_error));
        Change {
            name: name.clone(),
            unit: unit.clone(),
            difference: both.map(|(a, b)| b.value - a.value),
            // s² = s₁² + s₂²
            std_error: errors.map(|(a, b)| a.hypot(b)),
            is_significant: None,
            precedence: values.iter().flatten().map(|q| q.precedence).min().unwrap_or(Precedence::Other),
            values,
        }
    };
    united(&keys, &more).map(change).collect()
}

/// Two-sided Student's t at the smaller degrees of freedom, by Bonferroni over all that are tested.
fn test(changes: &mut [Change]) -> Result<()> {
    let tested = changes.iter().filter(|change| change.ratio().is_some()).count();
    for change in changes {
        let dof = change.values.iter().flatten().map(|quantity| quantity.dof).fold(f64::INFINITY, f64::min);
        if let Some(ratio) = change.ratio() {
            change.is_significant = Some(student_t_two_sided_p(ratio, dof)? < LEVEL / tested as f64);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(inputs: &[(&str, &str)], slope: f64) -> Run {
        let inputs: Vec<String> =
            inputs.iter().map(|(f, s)| format!("{{\"file\": \"{f}\", \"sha256\": \"{s}\"}}")).collect();
        let text = format!(
            "{{\"slopes\": [{{\"axis\": \"y\", \"channel\": \"dy\", \"um_per_n\": {slope}, \"std_error\": 0.3, \
             \"dof\": 8}}], \"r_rod\": {}, \"r_rod_std_error\": 0.01, \"r_rod_dof\": 8, \"provenance\": {{\"command\": \
             \"rodcal rig fit a b\", \"program\": \"rodcal 1\", \"inputs\": [{}]}}}}",
            slope / 40.0,
            inputs.join(",")
        );
        Run::from_text("a", "a/result.json", &text).unwrap()
    }

    #[test]
    fn files_are_matched_by_content_then_by_name() {
        let first = run(&[("a/x.toml", "1"), ("a/y.csv", "2"), ("old.csv", "3"), ("base.urdf", "5")], 1.0);
        let other = run(&[("b/renamed.toml", "1"), ("b/y.csv", "9"), ("new.csv", "4"), ("c.stl", "6")], 1.0);
        let found = inputs(&first, &other);
        let states: Vec<State> = found.iter().map(|input| input.state).collect();
        assert_eq!(states, [State::Same, State::Changed, State::Changed, State::Alone, State::Alone]);
        assert_eq!(found[2].files, [Some("old.csv".into()), Some("new.csv".into())]);
        assert_eq!(found[4].files, [None, Some("c.stl".into())]);
    }

    #[test]
    fn options_that_differ_are_listed_and_no_others() {
        let with = |options: &[(&str, &str)]| {
            let options = options.iter().map(|(name, value)| ((*name).into(), (*value).into())).collect();
            Run { options, ..run(&[], 1.0) }
        };
        let first = with(&[("--mode", "meas"), ("--draws", "20")]);
        let other = with(&[("--mode", "none"), ("--draws", "20"), ("--robust", "huber")]);
        let found = Difference::between(&first, &other).unwrap().options;
        let expected = [("--mode", ["meas", "none"]), ("--robust", ["not given", "huber"])];
        assert_eq!(found, expected.map(|(name, values)| (name.to_owned(), values.map(str::to_owned))));
    }

    /// t = 1.5/(0.3·√2) = 3.536; with 8 degrees of freedom P = 0.0077, below 0.05/2; 1.0/(0.3·√2)
    /// has P = 0.046.
    #[test]
    fn significance_is_that_of_student_and_of_all_numbers_together() {
        let of_slope = |slope: f64, file: &str| {
            let other = run(&[("b.csv", file)], slope);
            Difference::between(&run(&[("a.csv", "1")], 40.0), &other).unwrap()
        };
        let far = of_slope(41.5, "2");
        assert!((far.parameters[0].ratio().unwrap() - 3.5355).abs() < 1e-4);
        assert_eq!((far.significant(), far.tested()), (1, 2));
        assert_eq!((of_slope(41.0, "2").significant(), of_slope(40.0, "2").significant()), (0, 0));
        // the same recording: there is a ratio and no test
        let same = of_slope(41.5, "1");
        assert_eq!((same.significant(), same.tested()), (0, 0));
        assert_eq!(same.shared_recordings, ["a.csv"]);
    }
}
