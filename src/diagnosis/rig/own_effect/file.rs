//! The file of a lab's own effects (TOML).

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use serde::Deserialize;
use toml::Spanned;

use super::OwnEffect;
use crate::diagnosis::rig::effects::registry;
use crate::diagnosis::rig::laws::measures::SiteVariable;
use crate::error::{Place, Result};
use crate::expression::{Expression, is_reserved};
use crate::files;
use crate::inference::{Effect, Kind, Location, Parameter, Reported, UNKNOWN, Variable, WrittenTo};
use crate::limits;
use crate::rod::law::SIDE;
use crate::rod::{LawMemory, LawVariable, RodLawPlace};
use crate::toml_text::{Number, Required, TomlText};
use crate::units::Unit;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawFile {
    effect: Vec<RawEffect>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[effect]] with name, words, place, variable, law")]
struct RawEffect {
    name: Spanned<String>,
    words: Spanned<String>,
    place: Spanned<String>,
    variable: Spanned<String>,
    law: Spanned<String>,
    memory: Option<Spanned<String>>,
    parameter: Spanned<Vec<RawParameter>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[effect.parameter]] with name and size")]
struct RawParameter {
    name: Spanned<String>,
    neutral: Option<Number>,
    size: Number,
    low: Option<Number>,
    high: Option<Number>,
}

const REQUIRED: &Required = &[
    ("effect", "one section [[effect]] at least"),
    ("name", "a name in quotes: lower-case letters, digits and _"),
    ("words", "what it is called in a sentence"),
    ("place", "where it acts: rod, clamp, root, slide, a joint of the rod file, dx, dy or dz"),
    ("variable", "what it is a function of"),
    ("law", "a formula in quotes"),
    ("parameter", "one section [[effect.parameter]] at least"),
    ("size", "the standard deviation of its prior about `neutral`"),
];

impl OwnEffect {
    /// Reads the effects of a file.
    ///
    /// # Errors
    /// [`File`](crate::Error::File) where it cannot be read; [`Syntax`](crate::Error::Syntax) or
    /// [`Input`](crate::Error::Input) with line and column otherwise.
    pub fn read(path: &Path) -> Result<Vec<OwnEffect>> {
        OwnEffect::from_toml(&path.display().to_string(), &files::read_text(path)?)
    }

    /// Reads the text of such a file; `file` names it in errors.
    ///
    /// ```
    /// use rodcal::diagnosis::rig::OwnEffect;
    ///
    /// let text = r#"
    /// [[effect]]
    /// name = "rubber_foot"
    /// words = "a rubber foot under the clamp"
    /// place = "clamp"
    /// variable = "load"
    /// law = "a_um*(1 - exp(-F/b_n))"
    /// parameter = [{ name = "a_um", size = 20 }, { name = "b_n", neutral = 5, size = 2, low = 0.5 }]
    /// "#;
    /// assert_eq!(OwnEffect::from_toml("mine.toml", text)?.len(), 1);
    ///
    /// let error = OwnEffect::from_toml("mine.toml", &text.replace("F/b_n", "F/c")).unwrap_err();
    /// assert!(error.to_string().starts_with("mine.toml:7:25: \"c\" in the formula"), "{error}");
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`OwnEffect::read`].
    pub fn from_toml(file: &str, text: &str) -> Result<Vec<OwnEffect>> {
        let toml = TomlText::new(file, text);
        let raw: RawFile = toml.parse(REQUIRED)?;
        limits::check(file, raw.effect.len(), limits::OWN_EFFECTS, "effects")?;
        let mut effects: Vec<OwnEffect> = Vec::new();
        for raw in &raw.effect {
            let effect = of_raw(toml, text, raw)?;
            if effects.iter().any(|other| other.effect == effect.effect) {
                return Err(toml.is("name", &raw.name, "a name that no other effect has"));
            }
            effects.push(effect);
        }
        Ok(effects)
    }
}

fn of_raw(toml: TomlText, text: &str, raw: &RawEffect) -> Result<OwnEffect> {
    let name = raw.name.get_ref();
    let is_word = |name: &str| {
        let mut bytes = name.bytes();
        name.len() <= limits::NAME_BYTES
            && bytes.next().is_some_and(|b| b.is_ascii_lowercase())
            && bytes.all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_')
    };
    if !is_word(name) {
        let most = limits::NAME_BYTES;
        let expected = format!("lower-case letters, digits and _, a letter first, {most} at most");
        return Err(toml.is("name", &raw.name, &expected));
    }
    let known = registry::ALL.iter().map(|known| &known.effect).chain(registry::MISTAKES).chain([&UNKNOWN]);
    if known.into_iter().any(|known| known.name == name) {
        return Err(toml.is("name", &raw.name, "a name that no effect of the library has"));
    }
    let words = raw.words.get_ref().trim();
    if words.is_empty() || words.len() > limits::WORDS_BYTES || words.contains(char::is_control) {
        return Err(toml.is("words", &raw.words, "some words on one line"));
    }
    let is_its = |own: &SiteVariable| own.key() == Some(raw.variable.get_ref().as_str());
    let Some(variable) = SiteVariable::all_of_files().find(is_its) else {
        let keys: Vec<&str> = SiteVariable::all_of_files().filter_map(SiteVariable::key).collect();
        return Err(toml.is("variable", &raw.variable, &format!("one of {}", keys.join(", "))));
    };
    let symbol = variable.measure().symbol;
    let raw_parameters = raw.parameter.get_ref();
    if raw_parameters.is_empty() || raw_parameters.len() > limits::OWN_PARAMETERS {
        let expected = format!("1 to {} parameters", limits::OWN_PARAMETERS);
        return Err(toml.wrong(&raw.parameter, format!("{} parameters", raw_parameters.len()), &expected));
    }
    let mut names: Vec<&str> = vec![symbol, SIDE];
    let mut parameters = Vec::new();
    for own in raw_parameters {
        let name = own.name.get_ref();
        if !is_word(name) || names.contains(&name.as_str()) || is_reserved(name) {
            let expected = "a name of its own: lower-case letters, digits and _, no variable of the law";
            return Err(toml.is("name", &own.name, expected));
        }
        names.push(name);
        parameters.push(parameter(toml, own)?);
    }
    let law = Expression::new(raw.law.get_ref(), &names).map_err(|fault| toml.in_formula(&raw.law, fault))?;
    let memory = raw.memory.as_ref().map(|own| memory(toml, own, &parameters)).transpose()?;
    let seen_along: fn(&Location) -> Vec<Variable> = match variable {
        SiteVariable::Time | SiteVariable::OfFile(LawVariable::SinceChange | LawVariable::LoadingSpeed) => {
            |_| vec![Variable::Time, Variable::TimeInRun]
        }
        SiteVariable::Temperature => |_| vec![Variable::Temperature],
        SiteVariable::OfFile(_) | SiteVariable::Order => |_| vec![Variable::SignedLoad, Variable::Load],
    };
    let at = |value: &Spanned<String>| Place::of_offset(toml.file(), text, value.span().start);
    Ok(OwnEffect {
        effect: kept(name, words, raw.law.get_ref(), raw.variable.get_ref(), seen_along),
        place: RodLawPlace::named(raw.place.get_ref()),
        variable,
        law,
        memory,
        parameters,
        at: (at(&raw.place), at(&raw.law)),
    })
}

fn memory(toml: TomlText, raw: &Spanned<String>, parameters: &[Parameter]) -> Result<LawMemory> {
    let Some(memory) = LawMemory::ALL.into_iter().find(|memory| memory.key() == raw.get_ref()) else {
        return Err(toml.is("memory", raw, &LawMemory::keys()));
    };
    for needed in memory.constants() {
        let own = parameters.iter().find(|own| own.name == needed.name);
        if !own.is_some_and(|own| needed.may_be(own.neutral)) {
            let expected = format!("with it a parameter whose neutral value is {}", needed.description());
            return Err(toml.is("memory", raw, &expected));
        }
    }
    Ok(memory)
}

fn parameter(toml: TomlText, raw: &RawParameter) -> Result<Parameter> {
    let finite = |key: &str, number: &Option<Number>, other: f64| match number {
        Some(number) => toml.finite(key, number),
        None => Ok(other),
    };
    let neutral = finite("neutral", &raw.neutral, 0.0)?;
    let size = toml.positive("size", &raw.size)?;
    let low = finite("low", &raw.low, f64::NEG_INFINITY)?;
    let high = finite("high", &raw.high, f64::INFINITY)?;
    for (key, number, is_wrong) in [("low", &raw.low, low > neutral), ("high", &raw.high, high < neutral)] {
        if let Some(number) = number.as_ref().filter(|_| is_wrong) {
            return Err(toml.is(key, number, &format!("bounds that hold the neutral value {neutral}")));
        }
    }
    if low >= high {
        return Err(toml.is("size", &raw.size, "`low` below `high`"));
    }
    Ok(Parameter { name: raw.name.get_ref().clone(), unit: Unit::NONE, neutral, size, bounds: (low, high) })
}

/// Records of effects are statics. Those of files are kept for as long as the program runs, each
/// once, however often its file is read.
fn kept(
    name: &str,
    words: &str,
    law: &str,
    variable: &str,
    seen_along: fn(&Location) -> Vec<Variable>,
) -> &'static Effect {
    static KEPT: Mutex<Vec<&'static Effect>> = Mutex::new(Vec::new());
    let mut all = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let is_it = |known: &&&Effect| {
        (known.name, known.summary, known.formula, known.needs) == (name, words, law, variable)
    };
    if let Some(known) = all.iter().find(is_it) {
        return known;
    }
    let kept = |text: &str| -> &'static str { String::leak(text.to_owned()) };
    let effect: &'static Effect = Box::leak(Box::new(Effect {
        name: kept(name),
        kind: Kind::Physics,
        summary: kept(words),
        formula: kept(law),
        prior: "as its file states",
        parameters: &[],
        needs: kept(variable),
        cause: kept(words),
        cause_at: |location| location.to_string(),
        written_to: WrittenTo::Nowhere,
        reported: Reported::Alone,
        seen_along,
        direct_check: None,
    }));
    all.push(effect);
    effect
}
