//! Rod files that are wrong are refused with a message that names the place, what stood there and
//! what is right; rod files that are odd are warned about. No text at all makes the reader or the
//! beam model panic.

mod any_text;
mod odd;
mod refused;

use rodcal::error::Error;
use rodcal::files::text_of_bytes;
use rodcal::rod::Rod;

/// A good file, in which a case replaces one piece of text (or all of it).
const GOOD: &str = include_str!("bad_rods/good.toml");

fn read(text: &str) -> Result<Rod, Error> {
    text_of_bytes("rod.toml", text.as_bytes().to_vec()).and_then(|text| Rod::from_toml("rod.toml", &text))
}

/// The good file with pieces replaced.
fn changed(changes: &[(&str, &str)]) -> String {
    changes.iter().fold(GOOD.to_owned(), |text, (piece, other)| {
        assert!(text.contains(piece), "{piece} is not in the good file");
        text.replacen(piece, other, 1)
    })
}
