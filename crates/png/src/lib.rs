//! SVG to PNG, with an embedded font, so that it comes out the same on every machine.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use rodcal_base::error::{Error, Result};

/// Device pixels per CSS pixel.
const SCALE: f32 = 2.0;

/// Names and bytes of a PNG for each SVG among the files of a report.
///
/// # Errors
/// [`Error::Numerical`] where one cannot be rendered.
pub fn beside(files: &[(String, Vec<u8>)]) -> Result<Vec<(String, Vec<u8>)>> {
    let svgs = files.iter().filter_map(|(name, bytes)| Some((name.strip_suffix(".svg")?, bytes)));
    svgs.map(|(name, bytes)| Ok((format!("{name}.png"), png(&String::from_utf8_lossy(bytes))?))).collect()
}

/// Renders an SVG at twice its size; returns the bytes of a PNG file.
///
/// # Errors
/// [`Error::Numerical`] where the SVG is none or too large to hold in memory.
pub fn png(svg: &str) -> Result<Vec<u8>> {
    let failed = |why: String| Error::Numerical { what: "a picture as PNG", why };
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    // For the few signs the first one lacks.
    fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
    let family = fonts.faces().next().and_then(|face| face.families.first()).map(|(name, _)| name.clone());
    fonts.set_sans_serif_family(family.unwrap_or_default());
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|e| failed(e.to_string()))?;
    let size = tree.size();
    let (width, height) = ((size.width() * SCALE).ceil() as u32, (size.height() * SCALE).ceil() as u32);
    let mut pixels = Pixmap::new(width, height)
        .ok_or_else(|| failed(format!("{width} × {height} pixels are too many")))?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| failed(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_svg_of_a_report_has_its_png_and_the_same_bytes_again() {
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"4\" height=\"2\"/>";
        let file = |name: &str, text: &str| (name.to_owned(), text.as_bytes().to_vec());
        let files = [file("index.html", "<p>"), file("figure-1.svg", svg), file("table.csv", "a,b")];
        let pngs = beside(&files).expect("renders");
        assert_eq!(pngs.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["figure-1.png"]);
        assert!(pngs[0].1.starts_with(b"\x89PNG\r\n\x1a\n"));
        assert_eq!(beside(&files).expect("renders"), pngs);
        assert!(beside(&[file("figure-1.svg", "no picture")]).is_err());
    }

    #[test]
    fn a_png_is_twice_as_large_and_shows_text() {
        let svg = |text: &str| {
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 400 200\" width=\"40\" height=\"20\">\
                 <text x=\"0\" y=\"100\" font-family=\"sans-serif\" font-size=\"120\">{text}</text></svg>"
            )
        };
        let bytes = png(&svg("µ")).expect("renders");
        let pixels = Pixmap::decode_png(&bytes).expect("is a PNG");
        assert_eq!((pixels.width(), pixels.height()), (80, 40));
        // Every sign that pictures use is in one of the fonts: it leaves ink.
        for sign in "µ − · × ≈ ± ⁻ ⁷ ² ₂ σ → ° ≤ #".split(' ') {
            let pixels = Pixmap::decode_png(&png(&svg(sign)).expect("renders")).expect("is a PNG");
            assert!(pixels.data().iter().any(|byte| *byte > 0), "{sign}");
        }
    }

    #[test]
    fn what_is_no_svg_is_an_error() {
        assert!(png("<p>").is_err());
    }
}
