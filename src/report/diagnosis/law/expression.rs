//! A law in symbols.

use crate::inference::law::{Form, Memory, Site};
use crate::units::significant;

/// A law as plain text and as LaTeX.
pub struct Expression {
    pub text: String,
    pub latex: String,
}

/// `Δu = a·(F/14 N)^p` and `\Delta u = a\,(F/14\,\mathrm{N})^{p}`.
pub fn expression(site: &Site, form: Form, memory: Memory) -> Expression {
    let (result, variable) = (site.result.symbol, site.variable.symbol);
    let argument = match memory {
        Memory::Stop => format!("({variable} − P_r[{variable}])"),
        Memory::Play => format!("P_r[{variable}]"),
        Memory::Stops(_) => format!("S[{variable}]"),
        Memory::BoucWen(_) => "z".to_owned(),
        Memory::Lag => format!("({variable} − {variable}_lag)"),
        Memory::Lagged => format!("({variable}_lag − {variable}_start)"),
        _ => variable.to_owned(),
    };
    let x = &argument;
    let largest = significant(site.largest() / site.variable.si, 3);
    let (unit, corner) = (site.variable.unit, format!("{variable}_0"));
    let scale = if unit.is_empty() { largest.clone() } else { format!("{largest} {unit}") };
    // of a variable with two signs what grows from zero is odd
    let is_signed = site.range().0 < 0.0;
    let (sign, size) =
        if is_signed { (format!("sgn({x})·"), format!("|{x}|")) } else { (String::new(), x.clone()) };
    let text = match form {
        Form::Power => format!("a·{sign}({size}/{scale})^p"),
        Form::PowerAfterGap if is_signed => format!("{sign}(a·({size}/{scale})^p + g)"),
        Form::PowerAfterGap => format!("a·({size}/{scale})^p + g"),
        Form::Saturation => format!("a·{sign}min({size}/{corner}, 1)"),
        Form::Rounded => format!("a·tanh({x}/{corner})"),
        Form::Pull if is_signed => format!("{sign}k·(1/({corner} − {size})² − 1/{corner}²)"),
        Form::Pull => format!("k·(1/({corner} − {x})² − 1/{corner}²)"),
        Form::PullBelow | Form::PullAbove => format!("k/({x} − {corner})²"),
        Form::Threshold => format!("k·max({x} − {corner}, 0)"),
        Form::PowerBeyond(_) => format!("a·(max({x} − {corner}, 0)/({scale} − {corner}))^p"),
        Form::Rough(_) => format!("k·v·(ln(1 + exp(({x} − {corner})/v)) − ln(1 + exp(−{corner}/v)))"),
        Form::Step => format!("a·[{x} > {corner}]"),
        Form::Approach => format!("a·{sign}(1 − exp(−{size}/{corner}))"),
        Form::Decay => format!("a·{sign}exp(−{size}/{corner})"),
        Form::Settling if is_signed => format!("{sign}(a·exp(−{size}/{corner}) + b)"),
        Form::Settling => format!("a·exp(−{size}/{corner}) + b"),
        Form::Logarithm => format!("a·{sign}ln(1 + {size}/{corner})"),
        Form::Harmonic => format!("a·(cos(2π·{x}/P) − 1) + b·sin(2π·{x}/P)"),
        Form::Chirp(_) => {
            let turns = format!("2π·{x}/P·(1 + q·({x}/{scale} − 1))");
            format!("a·(cos({turns}) − 1) + b·sin({turns})")
        }
        Form::Swell(_) => {
            let grown = format!("(1 + g·{size}/{scale})");
            format!("a·({grown}·cos(2π·{x}/P) − 1) + b·{grown}·sin(2π·{x}/P)")
        }
        Form::Oscillation => format!("a·cos(2π·{x}/P) + b·sin(2π·{x}/P) + c"),
        Form::Polynomial(1) => format!("c1·{x}"),
        Form::Polynomial(2) => format!("c1·{x} + c2·{x}²"),
        _ => format!("c1·{x} + c2·{x}² + c3·{x}³"),
    };
    let side = if memory == Memory::Side { ("±", r"\pm ") } else { ("", "") };
    let latex_of = |symbol: &str| {
        let greek = [("Δ", r"\Delta "), ("θ", r"\theta"), ("φ", r"\varphi"), ("τ", r"\tau")];
        let symbol =
            greek.iter().fold(symbol.to_owned(), |symbol, (letter, command)| symbol.replace(letter, command));
        symbol.replace('\'', r"^{\prime}")
    };
    let x = match memory {
        Memory::Stop => format!(r"\left({0} - \mathcal{{P}}_r[{0}]\right)", latex_of(variable)),
        Memory::Play => format!(r"\mathcal{{P}}_r[{}]", latex_of(variable)),
        Memory::Stops(_) => format!(r"\mathcal{{S}}[{}]", latex_of(variable)),
        Memory::BoucWen(_) => "z".to_owned(),
        Memory::Lag => format!(r"\left({0} - \tilde{{{0}}}_{{\tau}}\right)", latex_of(variable)),
        Memory::Lagged => {
            format!(r"\left(\tilde{{{0}}}_{{\tau}} - {0}_\mathrm{{start}}\right)", latex_of(variable))
        }
        _ => latex_of(variable),
    };
    let corner = format!("{}_0", latex_of(variable));
    let unit = unit.replace('·', r"{\cdot}").replace('µ', r"\mu ");
    let scale = if unit.is_empty() { largest } else { format!(r"{largest}\,\mathrm{{{unit}}}") };
    let (sign, size) = match is_signed {
        true => (format!(r"\,\operatorname{{sgn}}\left({x}\right)"), format!(r"\left|{x}\right|")),
        false => (String::new(), x.clone()),
    };
    let latex = match form {
        Form::Power => format!(r"a{sign}\left(\frac{{{size}}}{{{scale}}}\right)^{{p}}"),
        Form::PowerAfterGap => {
            let power = format!(r"a\left(\frac{{{size}}}{{{scale}}}\right)^{{p}} + g");
            if is_signed { format!(r"{sign}\left({power}\right)") } else { power }
        }
        Form::Saturation => format!(r"a{sign}\,\min\left(\frac{{{size}}}{{{corner}}}, 1\right)"),
        Form::Rounded => format!(r"a\,\tanh\frac{{{x}}}{{{corner}}}"),
        Form::Pull => {
            let pull = format!(
                r"\frac{{1}}{{\left({corner} - {size}\right)^2}} - \frac{{1}}{{\left({corner}\right)^2}}"
            );
            format!(r"k{sign}\left({pull}\right)")
        }
        Form::PullBelow | Form::PullAbove => {
            format!(r"\frac{{k}}{{\left({x} - {corner}\right)^2}}")
        }
        Form::Threshold => format!(r"k\,\max({x} - {corner}, 0)"),
        Form::PowerBeyond(_) => {
            format!(r"a\left(\frac{{\max({x} - {corner}, 0)}}{{{scale} - {corner}}}\right)^{{p}}")
        }
        Form::Rough(_) => format!(r"k\,v\,\ln\frac{{1 + e^{{({x} - {corner})/v}}}}{{1 + e^{{-{corner}/v}}}}"),
        Form::Step => format!(r"a\,[{x} > {corner}]"),
        Form::Approach => format!(r"a{sign}\left(1 - e^{{-{size}/{corner}}}\right)"),
        Form::Decay => format!(r"a{sign}\,e^{{-{size}/{corner}}}"),
        Form::Settling if is_signed => format!(r"{sign}\left(a\,e^{{-{size}/{corner}}} + b\right)"),
        Form::Settling => format!(r"a\,e^{{-{size}/{corner}}} + b"),
        Form::Logarithm => format!(r"a{sign}\,\ln\left(1 + \frac{{{size}}}{{{corner}}}\right)"),
        Form::Chirp(_) => {
            let faster = format!(r"\left(1 + q\left(\frac{{{x}}}{{{scale}}} - 1\right)\right)");
            let turns = format!(r"\left(\frac{{2\pi {x}}}{{P}}{faster}\right)");
            format!(r"a\left(\cos{turns} - 1\right) + b\sin{turns}")
        }
        Form::Swell(_) => {
            let grown = format!(r"\left(1 + g\frac{{{size}}}{{{scale}}}\right)");
            let turns = format!(r"\frac{{2\pi {x}}}{{P}}");
            format!(r"a\left({grown}\cos{turns} - 1\right) + b{grown}\sin{turns}")
        }
        Form::Oscillation => {
            format!(r"a\cos\frac{{2\pi {x}}}{{P}} + b\sin\frac{{2\pi {x}}}{{P}} + c")
        }
        Form::Harmonic => {
            format!(r"a\left(\cos\frac{{2\pi {x}}}{{P}} - 1\right) + b\sin\frac{{2\pi {x}}}{{P}}")
        }
        Form::Polynomial(1) => format!("c_1 {x}"),
        Form::Polynomial(2) => format!("c_1 {x} + c_2 {x}^2"),
        _ => format!("c_1 {x} + c_2 {x}^2 + c_3 {x}^3"),
    };
    let bracketed = |side: &str, inner: String| match side.is_empty() {
        true => inner,
        false => format!("{side}[{inner}]"),
    };
    let (where_text, where_latex) = match memory {
        Memory::BoucWen(_) => (
            format!(", dz/d{variable} = 1 − (s·sgn(z·d{variable}) + 1 − s)·|z/r|^n"),
            format!(
                r",\quad \frac{{dz}}{{d{0}}} = 1 - \left(s\,\operatorname{{sgn}}(z\,d{0}) + 1 - s\right)\left|\frac{{z}}{{r}}\right|^{{n}}",
                latex_of(variable)
            ),
        ),
        Memory::Stops(stops) => side_by_side(stops.count(), variable, &latex_of(variable)),
        Memory::None | Memory::Side | Memory::Stop | Memory::Play | Memory::Lag | Memory::Lagged => {
            (String::new(), String::new())
        }
    };
    Expression {
        text: format!("{result} = {}{where_text}", bracketed(side.0, text)),
        latex: format!("{} = {}{where_latex}", latex_of(result), bracketed(side.1, latex)),
    }
}

/// What S is, as text and as LaTeX: `, S[F] = w1·(F − P_r1[F]) + (1 − w1)·(F − P_r[F])`.
fn side_by_side(count: usize, variable: &str, x: &str) -> (String, String) {
    let narrower = || 1..count;
    let stops = narrower().map(|k| format!("w{k}·({variable} − P_r{k}[{variable}]) + ")).collect::<String>();
    let rest = narrower().map(|k| format!(" − w{k}")).collect::<String>();
    let text = format!(", S[{variable}] = {stops}(1{rest})·({variable} − P_r[{variable}])");
    let stop = |r: &str| format!(r"\left({x} - \mathcal{{P}}_{{{r}}}[{x}]\right)");
    let stops = narrower().map(|k| format!("w_{k} {} + ", stop(&format!("r_{k}")))).collect::<String>();
    let rest = narrower().map(|k| format!(" - w_{k}")).collect::<String>();
    let latex = format!(r",\quad \mathcal{{S}}[{x}] = {stops}\left(1{rest}\right) {}", stop("r"));
    (text, latex)
}
