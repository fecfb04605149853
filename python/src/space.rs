//! What a design searches, as Python gives it: a file, or the texts of one.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use rodcal::design::DesignSpace;
use rodcal::files;

use crate::errors::IntoPython;

/// A design file, or the text of one with what it calls its catalogue.
#[derive(FromPyObject)]
pub enum Design {
    File(PathBuf),
    Text(String, Option<String>),
}

impl Design {
    pub fn space(self, py: Python<'_>) -> PyResult<DesignSpace> {
        self.read(py).map(|(space, ..)| space)
    }

    /// What is searched, with the text that says so and that of the catalogue that it names.
    pub fn read(self, py: Python<'_>) -> PyResult<(DesignSpace, String, Option<String>)> {
        let tubes = RefCell::new(None);
        let opened = |path: PathBuf| -> rodcal::Result<(String, String)> {
            let text = files::read_text(&path)?;
            *tubes.borrow_mut() = Some(text.clone());
            Ok((path.display().to_string(), text))
        };
        let (text, space) = match self {
            Design::File(path) => {
                let folder = path.parent().unwrap_or(Path::new(""));
                let text = files::read_text(&path).or_raise(py)?;
                let file = path.display().to_string();
                let space = DesignSpace::from_toml(&file, &text, &|name| opened(folder.join(name)));
                (text, space)
            }
            Design::Text(text, Some(known)) => {
                let named = |_: &str| Ok(("<catalogue>".to_owned(), known.clone()));
                let space = DesignSpace::from_toml("<design>", &text, &named).or_raise(py)?;
                return Ok((space, text, Some(known)));
            }
            Design::Text(text, None) => {
                let space = DesignSpace::from_toml("<design>", &text, &|name| opened(name.into()));
                (text, space)
            }
        };
        Ok((space.or_raise(py)?, text, tubes.into_inner()))
    }
}
