//! No circles inside a room: the files of one room can be read in an order in which each rests on
//! those before it.
//!
//! **The rule.** File A rests on file B where A's code names something that is defined in B.
//!
//! - A name that a parent module re-exports (`pub use child::Name;`) counts for the child that
//!   defines it. So a parent that only declares its children and re-exports from them rests on
//!   nothing, and nothing rests on it.
//! - A parent that also holds code is a file like any other: it must not rest on a child that rests
//!   on it.
//! - Methods are not imports: `impl Type` may stand in a file above the one that defines `Type`.
//! - Code for tests does not count; nor do comments, and with them links in documentation.

#![allow(clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Crates that are read, whether each is a single room, and how many imports inside rooms it has at
/// least.
const SOURCES: [(&str, bool, usize); 5] = [
    ("src", false, 20),
    ("crates/base/src", false, 20),
    ("crates/trial/src", false, 20),
    ("python/src", true, 20),
    ("crates/png/src", true, 0),
];

/// A module of the crate: `["beam", "solve"]`.
type ModulePath = Vec<String>;

/// One source file as the rule sees it.
#[derive(Default)]
struct File {
    /// Its path below `src`.
    name: String,
    /// Modules that it declares.
    children: BTreeSet<String>,
    /// Names that it takes from elsewhere: what they are called here, and where they come from.
    imports: BTreeMap<String, Vec<String>>,
    /// Paths that its code names, re-exports only if its own code uses them too.
    named: BTreeSet<Vec<String>>,
}

struct Crate(BTreeMap<ModulePath, File>);

#[test]
fn files_of_a_room_form_no_circle() {
    for (source, is_room, least) in SOURCES {
        let edges = Crate::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(source)).edges(is_room);
        let count: usize = edges.values().map(BTreeSet::len).sum();
        assert!(
            count >= least,
            "only {count} imports inside rooms of {source}: does the test still read them?"
        );
        let circles: Vec<String> = circles(&edges).iter().map(|circle| circle.join(", ")).collect();
        assert!(circles.is_empty(), "files of {source} that rest on one another:\n{}", circles.join("\n"));
    }
}

#[test]
fn a_circle_is_found_through_a_re_export_and_in_a_parent_with_code() {
    let read = |files: &[(&str, &str)]| {
        let files = files.iter().map(|(path, text)| {
            let module: ModulePath = path.split('/').map(str::to_owned).collect();
            (module, File::read(&format!("{path}.rs"), text))
        });
        let tree = Crate(files.collect());
        circles(&tree.edges(false))
    };
    // the room itself only points the way
    let room = "mod a; mod b; pub use a::A; pub use b::{B, other};";
    let a = "use super::B; pub struct A(B);";
    assert!(read(&[("room", room), ("room/a", a), ("room/b", "pub struct B;")]).is_empty());
    for b in [
        "fn f(a: crate::room::A) {}",
        "use super::{A as C};",
        "use super::a; fn f() { a::g() }",
        "fn f() { super::a::g(\"//\", 'x') }",
    ] {
        assert_eq!(read(&[("room", room), ("room/a", a), ("room/b", b)]).len(), 1, "{b}");
    }
    for b in [
        "// super::A",
        "/* super::A */",
        "#[cfg(test)] mod tests { use super::super::A; }",
        "// \"\nfn f() {}",
    ] {
        assert!(read(&[("room", room), ("room/a", a), ("room/b", b)]).is_empty(), "{b}");
    }
    let child = ("room/a", "use super::Own;");
    assert_eq!(read(&[("room", "mod a; pub struct Own; fn f() { a::g() }"), child]).len(), 1);
    assert_eq!(read(&[("room", "mod a; pub use a::A; pub struct Own(A);"), child]).len(), 1);
    assert!(read(&[("room", "mod a; pub use a::A; pub struct Own;"), child]).is_empty());
}

impl Crate {
    fn read(source: &Path) -> Crate {
        let mut files = BTreeMap::new();
        for path in sources(source) {
            let inside = path.strip_prefix(source).unwrap();
            let module: ModulePath =
                inside.with_extension("").iter().map(|part| part.to_str().unwrap().to_owned()).collect();
            let name = inside.to_str().unwrap().replace('\\', "/");
            files.insert(module, File::read(&name, &fs::read_to_string(&path).unwrap()));
        }
        // modules for tests only stand in files of their own
        files.retain(|module: &ModulePath, _| !module.iter().any(|part| part == "tests"));
        Crate(files)
    }

    /// For every file the files of its own room that it rests on; the whole crate may be one.
    fn edges(&self, is_room: bool) -> BTreeMap<String, BTreeSet<String>> {
        let mut edges: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (module, file) in &self.0 {
            let targets = edges.entry(file.name.clone()).or_default();
            for path in &file.named {
                let Some(target) = self.home(module, path, 0) else { continue };
                if (is_room || target[0] == module[0]) && target != *module {
                    // the root of a crate names its modules as if they were below it
                    targets.extend(self.0.get(&target).map(|file| file.name.clone()));
                }
            }
        }
        edges
    }

    /// The file that defines what `path` means in `module`.
    fn home(&self, module: &ModulePath, path: &[String], turns: usize) -> Option<ModulePath> {
        let mut at = module.clone();
        for (k, part) in path.iter().enumerate() {
            let file = self.0.get(&at)?;
            match part.as_str() {
                "crate" => at = Vec::new(),
                "self" => {}
                "super" => {
                    at.pop()?;
                }
                child if file.children.contains(child) => at.push(child.to_owned()),
                name => {
                    return match file.imports.get(name) {
                        // a name that goes round in circles has no home
                        Some(from) if turns < 10 => {
                            let whole: Vec<String> = from.iter().chain(&path[k + 1..]).cloned().collect();
                            self.home(&at, &whole, turns + 1)
                        }
                        // of another crate, or of the language
                        _ if k == 0 => None,
                        _ => Some(at),
                    };
                }
            }
            if at.is_empty() {
                // the crate's root: its children are the rooms
                let rest = &path[k + 1..];
                let room = vec![rest.first()?.clone()];
                let inside: Vec<String> =
                    std::iter::once("self".to_owned()).chain(rest[1..].to_vec()).collect();
                return self.0.contains_key(&room).then(|| self.home(&room, &inside, turns))?;
            }
        }
        Some(at)
    }
}

impl File {
    fn read(name: &str, text: &str) -> File {
        let tokens = without_tests(tokens(text));
        let mut file = File { name: name.to_owned(), ..File::default() };
        let mut code = Vec::new();
        let mut re_exports = Vec::new();
        let mut at = 0;
        while at < tokens.len() {
            let end = at + tokens[at..].iter().position(|token| token == ";").unwrap_or(tokens.len() - at);
            match tokens[at].as_str() {
                "use" => {
                    let is_public = at > 0 && (tokens[at - 1] == "pub" || tokens[at - 1] == ")");
                    for (alias, path) in leaves(&tokens[at + 1..end]) {
                        match is_public {
                            true => re_exports.push((alias.clone(), path.clone())),
                            false => _ = file.named.insert(path.clone()),
                        }
                        file.imports.insert(alias, path);
                    }
                    at = end;
                }
                "mod" if end == at + 2 => {
                    file.children.insert(tokens[at + 1].clone());
                    at = end;
                }
                token => code.push(token.to_owned()),
            }
            at += 1;
        }
        for (alias, path) in re_exports {
            if code.contains(&alias) {
                file.named.insert(path);
            }
        }
        for k in 0..code.len() {
            let is_start = k == 0 || (code[k - 1] != "::" && code[k - 1] != ".");
            let is_path = code.get(k + 1).is_some_and(|next| next == "::");
            let first = code[k].as_str();
            if is_start
                && is_path
                && (["crate", "self", "super"].contains(&first) || file.children.contains(first))
            {
                let mut path = vec![code[k].clone()];
                let mut next = k + 1;
                while code.get(next).is_some_and(|t| t == "::")
                    && code.get(next + 1).is_some_and(|t| is_word(t))
                {
                    path.push(code[next + 1].clone());
                    next += 2;
                }
                file.named.insert(path);
            }
        }
        file
    }
}

/// What a `use` brings in: names as they are called here, and their paths.
fn leaves(tokens: &[String]) -> Vec<(String, Vec<String>)> {
    let mut prefix: Vec<String> = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        match tokens[at].as_str() {
            "::" => {}
            "{" => {
                let (mut depth, mut start, mut found) = (0, at + 1, Vec::new());
                for (k, token) in tokens.iter().enumerate().skip(at) {
                    match token.as_str() {
                        "{" => depth += 1,
                        "}" => depth -= 1,
                        _ => {}
                    }
                    if depth == 0 || (depth == 1 && token == ",") {
                        found.extend(leaves(&tokens[start..k]));
                        start = k + 1;
                    }
                    if depth == 0 {
                        break;
                    }
                }
                let with_prefix = |(alias, path): (String, Vec<String>)| {
                    // `{self, …}` is the module itself
                    let path: Vec<String> = prefix.iter().cloned().chain(path).collect();
                    let is_self = path.last().is_some_and(|last| last == "self") && path.len() > 1;
                    match is_self {
                        true => {
                            let alias = if alias == "self" { path[path.len() - 2].clone() } else { alias };
                            (alias, path[..path.len() - 1].to_vec())
                        }
                        false => (alias, path),
                    }
                };
                return found.into_iter().map(with_prefix).collect();
            }
            "as" => return vec![(tokens[at + 1].clone(), prefix)],
            word => prefix.push(word.to_owned()),
        }
        at += 1;
    }
    match prefix.last() {
        Some(last) => vec![(last.clone(), prefix.clone())],
        None => Vec::new(),
    }
}

/// Words, `::` and single signs; no comments, no texts.
pub(crate) fn tokens(text: &str) -> Vec<String> {
    let chars: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let mut at = 0;
    let starts = |at: usize, what: &str| what.chars().enumerate().all(|(k, c)| chars.get(at + k) == Some(&c));
    while at < chars.len() {
        let c = chars[at];
        if starts(at, "//") {
            at += chars[at..].iter().take_while(|&&c| c != '\n').count();
        } else if starts(at, "/*") {
            at += 2;
            while at < chars.len() && !starts(at, "*/") {
                at += 1;
            }
            at += 2;
        } else if c == 'r' && (starts(at, "r\"") || starts(at, "r#\"")) {
            let close = if starts(at, "r\"") { "\"" } else { "\"#" };
            at += 1 + close.len();
            while at < chars.len() && !starts(at, close) {
                at += 1;
            }
            at += close.len();
        } else if c == '"' {
            at += 1;
            while at < chars.len() && chars[at] != '"' {
                at += if chars[at] == '\\' { 2 } else { 1 };
            }
            at += 1;
        } else if c == '\'' {
            // 'x' and '\n' are characters, 'x without an end is a lifetime
            if chars.get(at + 1) == Some(&'\\') {
                at += 3;
                while at < chars.len() && chars[at] != '\'' {
                    at += 1;
                }
                at += 1;
            } else if chars.get(at + 2) == Some(&'\'') {
                at += 3;
            } else {
                at += 1;
            }
        } else if c.is_alphanumeric() || c == '_' {
            let word: String = chars[at..].iter().take_while(|c| c.is_alphanumeric() || **c == '_').collect();
            at += word.chars().count();
            tokens.push(word);
        } else if starts(at, "::") {
            tokens.push("::".to_owned());
            at += 2;
        } else {
            if !c.is_whitespace() {
                tokens.push(c.to_string());
            }
            at += 1;
        }
    }
    tokens
}

fn is_word(token: &str) -> bool {
    token.chars().next().is_some_and(|c| c.is_alphanumeric() || c == '_')
}

/// The same without what stands behind `#[cfg(test)]`.
fn without_tests(tokens: Vec<String>) -> Vec<String> {
    let mark = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if !tokens[at..].iter().map(String::as_str).take(mark.len()).eq(mark) {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        }
        let mut depth = 0;
        while at < tokens.len() {
            match tokens[at].as_str() {
                "{" => depth += 1,
                "}" => depth -= 1,
                _ => {}
            }
            let is_end = depth == 0 && (tokens[at] == "}" || tokens[at] == ";");
            at += 1;
            if is_end {
                break;
            }
        }
    }
    kept
}

fn sources(directory: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Sets of files each of which rests, by others of its set, on itself.
fn circles(edges: &BTreeMap<String, BTreeSet<String>>) -> Vec<Vec<String>> {
    let below = |from: &str| {
        let mut seen: BTreeSet<&str> = BTreeSet::new();
        let mut open: Vec<&str> = edges[from].iter().map(String::as_str).collect();
        while let Some(file) = open.pop() {
            if seen.insert(file) {
                open.extend(edges.get(file).into_iter().flatten().map(String::as_str));
            }
        }
        seen
    };
    let reach: BTreeMap<&str, BTreeSet<&str>> =
        edges.keys().map(|file| (file.as_str(), below(file))).collect();
    let mut circles: BTreeSet<Vec<String>> = BTreeSet::new();
    for (file, seen) in &reach {
        if seen.contains(file) {
            let mut circle: Vec<String> = seen
                .iter()
                .filter(|other| reach[**other].contains(file))
                .map(|other| (*other).to_owned())
                .collect();
            circle.sort();
            circles.insert(circle);
        }
    }
    circles.into_iter().collect()
}
