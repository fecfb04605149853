//! Formulas that people write: `a*(F/10)^p`, read once, evaluated often, without side effects.
//!
//! ```text
//! sum     = product { (+|−) product }        product = sign { (*|/) sign }
//! sign    = { − } power                      power   = atom [ ^ sign ]
//! atom    = number | name | name ( sum { , sum } ) | ( sum )
//! ```
//!
//! `^` binds first and to the right: −2^2 is −4. Names that are no function are variables. The
//! functions are those of [`FUNCTIONS`], and `pi`.

use std::fmt;

/// Functions of one number, and those of two.
pub const FUNCTIONS: &str =
    "abs, sign, step, sqrt, exp, ln, log10, sin, cos, tan, atan, tanh of one number, min and max of two";

/// Longest formula, and deepest nesting.
const MOST_BYTES: usize = 1000;
const DEEPEST: usize = 40;

/// A formula in its variables, in the order in which they were named.
#[derive(Debug, Clone)]
pub struct Expression {
    root: Node,
}

#[derive(Debug, Clone)]
enum Node {
    Number(f64),
    Variable(usize),
    Of(fn(f64) -> f64, Box<Node>),
    With(fn(f64, f64) -> f64, Box<Node>, Box<Node>),
}

/// True for a name that a formula reads as something else than a variable.
pub fn is_reserved(name: &str) -> bool {
    one(name).is_some() || matches!(name, "pi" | "min" | "max")
}

/// What is wrong with a formula, and where: bytes from its beginning.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Where, from 0.
    pub at: usize,
    /// What stands there.
    pub found: String,
    /// What would be right.
    pub expected: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} instead of {}, at character {}", self.found, self.expected, self.at + 1)
    }
}

impl Expression {
    /// Reads a formula in `variables`.
    ///
    /// ```
    /// use rodcal_base::expression::Expression;
    ///
    /// let law = Expression::new("a*(F/10)^p", &["F", "a", "p"]).unwrap();
    /// assert_eq!(law.at(&[5.0, 12.0, 2.0]), 3.0);
    /// assert_eq!(Expression::new("a*(F/10", &["F", "a"]).unwrap_err().at, 7);
    /// ```
    ///
    /// # Errors
    /// A [`Fault`] with its place.
    pub fn new(text: &str, variables: &[&str]) -> Result<Expression, Fault> {
        if text.len() > MOST_BYTES {
            let found = format!("a formula of {} bytes", text.len());
            return Err(Fault { at: 0, found, expected: format!("at most {MOST_BYTES}") });
        }
        let mut reader = Reader { text, at: 0, depth: 0, variables };
        let root = reader.sum()?;
        match reader.peek() {
            None => Ok(Expression { root }),
            Some(_) => Err(reader.fault("an operator or the end")),
        }
    }

    /// The value where the variables have these values; those that are missing count as not a
    /// number.
    pub fn at(&self, values: &[f64]) -> f64 {
        self.root.at(values)
    }
}

impl Node {
    fn at(&self, values: &[f64]) -> f64 {
        match self {
            Node::Number(value) => *value,
            Node::Variable(k) => values.get(*k).copied().unwrap_or(f64::NAN),
            Node::Of(function, x) => function(x.at(values)),
            Node::With(function, x, y) => function(x.at(values), y.at(values)),
        }
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    variables: &'a [&'a str],
}

impl Reader<'_> {
    /// The next character that is no blank.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, any: &[char]) -> Option<char> {
        let found = self.peek().filter(|c| any.contains(c))?;
        self.at += found.len_utf8();
        Some(found)
    }

    fn fault(&mut self, expected: &str) -> Fault {
        let found = self.peek().map_or_else(|| "the end".to_owned(), |c| format!("\"{c}\""));
        Fault { at: self.at, found, expected: expected.into() }
    }

    fn deeper<T>(&mut self, parse: impl FnOnce(&mut Self) -> Result<T, Fault>) -> Result<T, Fault> {
        if self.depth == DEEPEST {
            return Err(self.fault("fewer brackets and signs inside each other"));
        }
        self.depth += 1;
        let result = parse(self);
        self.depth -= 1;
        result
    }

    fn sum(&mut self) -> Result<Node, Fault> {
        let mut left = self.product()?;
        while let Some(sign) = self.take(&['+', '-', '−']) {
            let right = Box::new(self.product()?);
            let operation: fn(f64, f64) -> f64 = if sign == '+' { |a, b| a + b } else { |a, b| a - b };
            left = Node::With(operation, Box::new(left), right);
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Node, Fault> {
        let mut left = self.sign()?;
        while let Some(sign) = self.take(&['*', '·', '/']) {
            let right = Box::new(self.sign()?);
            let operation: fn(f64, f64) -> f64 = if sign == '/' { |a, b| a / b } else { |a, b| a * b };
            left = Node::With(operation, Box::new(left), right);
        }
        Ok(left)
    }

    fn sign(&mut self) -> Result<Node, Fault> {
        match self.take(&['-', '−']) {
            Some(_) => Ok(Node::Of(|x| -x, Box::new(self.deeper(Self::sign)?))),
            None => self.power(),
        }
    }

    fn power(&mut self) -> Result<Node, Fault> {
        let base = self.atom()?;
        match self.take(&['^']) {
            Some(_) => Ok(Node::With(f64::powf, Box::new(base), Box::new(self.deeper(Self::sign)?))),
            None => Ok(base),
        }
    }

    fn atom(&mut self) -> Result<Node, Fault> {
        match self.peek() {
            Some('(') => {
                self.take(&['(']);
                let inner = self.deeper(Self::sum)?;
                self.closed()?;
                Ok(inner)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.named(),
            _ => Err(self.fault("a number, a name or \"(\"")),
        }
    }

    fn closed(&mut self) -> Result<(), Fault> {
        self.take(&[')']).map(|_| ()).ok_or_else(|| self.fault("\")\""))
    }

    fn number(&mut self) -> Result<Node, Fault> {
        let rest = &self.text.as_bytes()[self.at..];
        let mut end = 0;
        while let Some(&byte) = rest.get(end) {
            let is_exponent_sign =
                matches!(byte, b'+' | b'-') && end > 0 && matches!(rest[end - 1], b'e' | b'E');
            // an e that no number follows belongs to no number
            let is_exponent = matches!(byte, b'e' | b'E')
                && rest[end + 1..].iter().find(|b| !matches!(b, b'+' | b'-')).is_some_and(u8::is_ascii_digit);
            if !(byte.is_ascii_digit() || byte == b'.' || is_exponent || is_exponent_sign) {
                break;
            }
            end += 1;
        }
        let text = &self.text[self.at..self.at + end];
        let fault = |at| Fault { at, found: format!("\"{text}\""), expected: "a number".into() };
        let value: f64 = text.parse().map_err(|_| fault(self.at))?;
        self.at += end;
        Ok(Node::Number(value))
    }

    fn named(&mut self) -> Result<Node, Fault> {
        let start = self.at;
        let rest = &self.text[start..];
        let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '\'';
        let end = rest.find(|c: char| !is_part(c)).unwrap_or(rest.len());
        let name = &rest[..end];
        self.at += end;
        if let Some(k) = self.variables.iter().position(|known| *known == name) {
            return Ok(Node::Variable(k));
        }
        if name == "pi" {
            return Ok(Node::Number(std::f64::consts::PI));
        }
        let one = one(name);
        let two: Option<fn(f64, f64) -> f64> = match name {
            "min" => Some(f64::min),
            "max" => Some(f64::max),
            _ => None,
        };
        if one.is_none() && two.is_none() {
            let known = self.variables.join(", ");
            let expected = format!("one of {known}, or a function ({FUNCTIONS})");
            return Err(Fault { at: start, found: format!("\"{name}\""), expected });
        }
        if self.take(&['(']).is_none() {
            return Err(self.fault(&format!("\"(\" after {name}")));
        }
        let first = Box::new(self.deeper(Self::sum)?);
        let node = match (one, two) {
            (_, Some(two)) => {
                if self.take(&[',']).is_none() {
                    return Err(self.fault(&format!("\",\": {name} is of two numbers")));
                }
                Node::With(two, first, Box::new(self.deeper(Self::sum)?))
            }
            (Some(one), _) => Node::Of(one, first),
            (None, None) => *first,
        };
        self.closed()?;
        Ok(node)
    }
}

fn one(name: &str) -> Option<fn(f64) -> f64> {
    Some(match name {
        "abs" => f64::abs,
        "sign" => |x| if x == 0.0 { 0.0 } else { x.signum() },
        "step" => |x| if x > 0.0 { 1.0 } else { 0.0 },
        "sqrt" => f64::sqrt,
        "exp" => f64::exp,
        "ln" => f64::ln,
        "log10" => f64::log10,
        "sin" => f64::sin,
        "cos" => f64::cos,
        "tan" => f64::tan,
        "atan" => f64::atan,
        "tanh" => f64::tanh,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        Expression::new(text, &["x", "y"]).unwrap().at(&[2.0, 3.0])
    }

    #[test]
    fn operators_bind_as_in_mathematics() {
        assert_eq!(value("1 + 2*3"), 7.0);
        assert_eq!(value("-x^2"), -4.0);
        assert_eq!(value("2^3^2"), 512.0);
        assert_eq!(value("2^-1"), 0.5);
        assert_eq!(value("8/4/2 - 1 - 1"), -1.0);
        assert_eq!(value("(1 + x)*y"), 9.0);
        assert_eq!(value("2e3*x + 1.5E-1"), 4000.15);
        assert_eq!(value("2·x − 1"), 3.0);
    }

    #[test]
    fn functions_and_names_are_known() {
        assert!((value("sin(pi/2) + exp(0) + ln(1)") - 2.0).abs() < 1e-15);
        assert_eq!(value("max(x, y) - min(x, y)"), 1.0);
        assert_eq!(value("sign(-x)*step(y)*abs(-x)"), -2.0);
        assert!(is_reserved("max") && is_reserved("pi") && is_reserved("ln") && !is_reserved("a"));
    }

    #[test]
    fn a_fault_has_its_place() {
        let fault = |text: &str| Expression::new(text, &["F", "a"]).unwrap_err();
        assert_eq!((fault("a*(F + 1").at, fault("a*(F + 1").found.as_str()), (8, "the end"));
        assert_eq!((fault("a*b").at, fault("a*b").found.as_str()), (2, "\"b\""));
        assert_eq!(fault("a F").at, 2);
        assert_eq!(fault("").expected, "a number, a name or \"(\"");
        assert_eq!(fault("min(a)").at, 5);
        assert_eq!(fault("1.2.3").found, "\"1.2.3\"");
        assert_eq!(fault("a + é").at, 4);
        assert!(fault(&"(".repeat(900)).expected.starts_with("fewer brackets"));
        assert!(fault(&"-".repeat(900)).expected.starts_with("fewer brackets"));
        assert!(fault(&"a+".repeat(900)).expected.starts_with("at most"));
    }
}
