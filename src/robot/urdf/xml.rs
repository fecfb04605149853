//! XML whose every error names file, line and column: elements, attributes and the numbers in them.

use roxmltree::{Document, Error as XmlError, Node, ParsingOptions};

use crate::delimited::{message as shortened, visible};
use crate::error::{Error, Place, Result};
use crate::limits;
use crate::spatial::Pose;

/// No robot is larger, and the products of such numbers still fit a double.
const LARGEST: f64 = 1e30;

/// The text of a URDF and the name of its file, to find the line of whatever is wrong.
#[derive(Clone, Copy)]
pub(super) struct Source<'t> {
    pub file: &'t str,
    pub text: &'t str,
}

impl<'t> Source<'t> {
    /// The elements of the text.
    pub fn parse(&self) -> Result<Document<'t>> {
        limits::check(self.file, self.text.len(), limits::URDF_BYTES, "bytes")?;
        limits::check(
            self.file,
            most_attributes(self.text),
            limits::URDF_ATTRIBUTES,
            "attributes in one element",
        )?;
        let namespaces = self.text.matches("xmlns").count();
        limits::check(self.file, namespaces, limits::URDF_NAMESPACES, "namespaces")?;
        let options = ParsingOptions { nodes_limit: limits::URDF_NODES as u32, ..ParsingOptions::default() };
        Document::parse_with_options(self.text, options).map_err(|error| {
            let message = error.to_string();
            let at = match error {
                XmlError::NoRootNode
                | XmlError::UnclosedRootNode
                | XmlError::UnexpectedEndOfStream
                | XmlError::DtdDetected => Place::whole_file(self.file),
                _ => {
                    let (line, column) = (error.pos().row as usize, error.pos().col as usize);
                    Place { file: self.file.to_owned(), line, column }
                }
            };
            // the place stands in front already
            let message = message.replace(&format!(" at {}", error.pos()), "");
            Error::Syntax { at, message: format!("no valid XML: {}", shortened(&message)) }
        })
    }

    /// The error that something is wrong at byte `offset`.
    pub fn wrong(&self, offset: usize, found: String, expected: impl Into<String>) -> Error {
        let at = Place::of_offset(self.file, self.text, offset);
        Error::Input { at, found, expected: expected.into(), hint: None }
    }

    /// The error that attribute `name` has the value it has.
    pub fn is(&self, node: Node, name: &str, expected: &str) -> Error {
        let Some(attribute) = node.attribute_node(name) else {
            let found = format!("{} has no {name}", tag(node));
            return self.wrong(node.range().start, found, expected);
        };
        let value = match attribute.value().trim() {
            "" => "blank".to_owned(),
            value => cut(value),
        };
        let found = format!("`{}.{name}` is {value}", tag_name(node));
        self.wrong(attribute.range_value().start, found, expected)
    }

    /// The attribute `name`, which has to be there and must not be blank; `expected` says what it
    /// is.
    pub fn required<'n>(&self, node: Node<'n, 't>, name: &str, expected: &str) -> Result<&'n str> {
        match node.attribute(name) {
            Some(value) if !value.trim().is_empty() => Ok(value),
            _ => Err(self.is(node, name, expected)),
        }
    }

    /// The `N` numbers of attribute `name`, or `None` where there is no such attribute.
    pub fn numbers<const N: usize>(&self, node: Node, name: &str) -> Result<Option<[f64; N]>> {
        let Some(value) = node.attribute(name) else { return Ok(None) };
        let numbers = value.split_whitespace().map(|word| word.parse().ok().filter(|x: &f64| x.is_finite()));
        let numbers = numbers.collect::<Option<Vec<f64>>>().and_then(|list| <[f64; N]>::try_from(list).ok());
        if let Some(numbers) = numbers {
            if numbers.iter().any(|number| number.abs() > LARGEST) {
                return Err(self.is(node, name, &format!("numbers of at most {LARGEST:e} in size")));
            }
            return Ok(Some(numbers));
        }
        let expected = match N {
            1 => "a number",
            _ => "three numbers with blanks between them",
        };
        let hint = match value {
            _ if value.contains("${") => Some("expand the macros first (xacro)".to_owned()),
            _ if value.contains(',') => Some("write a decimal point, and blanks between numbers".to_owned()),
            _ => None,
        };
        Err(self.is(node, name, expected).with_hint(hint))
    }

    /// The `<origin>` of an element: the identity where there is none. xyz in m, rpy in rad.
    pub fn origin(&self, node: Node) -> Result<Pose> {
        let Some(origin) = child(node, "origin") else { return Ok(Pose::IDENTITY) };
        if origin.has_attribute("quat_xyzw") {
            return Err(self.is(origin, "quat_xyzw", "the rotation as rpy=\"roll pitch yaw\" in radians"));
        }
        let xyz = self.numbers(origin, "xyz")?.unwrap_or_default();
        let rpy = self.numbers(origin, "rpy")?.unwrap_or_default();
        Ok(Pose::from_xyz_rpy(xyz, rpy))
    }
}

/// So many attributes the element with the most of them has, or a few more.
fn most_attributes(text: &str) -> usize {
    let (mut most, mut count, mut quote, mut is_tag) = (0, 0, None, false);
    for byte in text.bytes() {
        match (byte, quote) {
            (_, Some(open)) if byte == open => quote = None,
            (_, Some(_)) => {}
            (b'<', None) => (is_tag, count) = (true, 0),
            (b'>', None) => is_tag = false,
            (b'"' | b'\'', None) if is_tag => quote = Some(byte),
            (b'=', None) if is_tag => {
                count += 1;
                most = most.max(count);
            }
            _ => {}
        }
    }
    most
}

/// The first child element of that name.
pub(super) fn child<'n, 't>(node: Node<'n, 't>, name: &str) -> Option<Node<'n, 't>> {
    node.children().find(|child| child.is_element() && child.has_tag_name(name))
}

/// `<joint name="a2">`, as far as that is known.
pub(super) fn tag(node: Node) -> String {
    match node.attribute("name") {
        Some(name) => format!("<{} name=\"{}\">", tag_name(node), cut(name)),
        None => format!("<{}>", tag_name(node)),
    }
}

/// One line of printable text, of a length that fits a message.
pub(super) fn cut(text: &str) -> String {
    const LONGEST: usize = 40;
    let text = printable(text.trim());
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} …", &text[..end]),
        None => text,
    }
}

fn tag_name(node: Node) -> String {
    cut(node.tag_name().name())
}

fn printable(text: &str) -> String {
    visible(text).into_owned()
}
