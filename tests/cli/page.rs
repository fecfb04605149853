//! index.html opens anywhere, for it needs nothing but itself.

use std::collections::BTreeSet;

use super::{REPORTS, ran};

/// The values of an attribute, in order.
fn attributes<'a>(page: &'a str, name: &str) -> Vec<&'a str> {
    let start = format!(" {name}=\"");
    page.split(&start).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// What stands between each `<name …>` and its `</name>`; for elements that do not hold their like.
fn elements<'a>(page: &'a str, name: &str) -> Vec<&'a str> {
    let (open, close) = (format!("<{name}"), format!("</{name}>"));
    let starts = page.match_indices(&open).filter(|(at, _)| page[at + open.len()..].starts_with([' ', '>']));
    starts
        .map(|(at, _)| {
            let rest = &page[at..];
            let end = rest.find(&close).unwrap_or_else(|| panic!("<{name}> is not closed"));
            &rest[rest.find('>').unwrap() + 1..end]
        })
        .collect()
}

fn assert_sane(page: &str, beside: &BTreeSet<String>) {
    assert!(page.starts_with("<!DOCTYPE html><html lang=\"en\">") && page.ends_with("</html>"));
    assert_eq!(elements(page, "style").len(), 1, "one style sheet");
    assert!(page.contains("<meta charset=\"utf-8\">"));
    assert_eq!(elements(page, "h1").len(), 1);
    assert_eq!(elements(page, "h1"), elements(&page[..page.find("<body").unwrap()], "title"));

    // nothing is fetched, and the browser is told so; the only script is the page's own, the same
    // on all
    assert!(page.contains("content=\"default-src 'none'; "), "no policy");
    let (page, script) = page.split_once("<script>").unwrap();
    assert!(script.starts_with(include_str!("../../src/report/html/page.js")));
    for tag in ["script", "link", "img", "image", "iframe", "object", "embed", "base", "foreignObject"] {
        assert!(elements_or_void(page, tag) == 0, "<{tag}>");
    }
    for word in ["@import", "@font-face", "url(", "javascript:", " src=", " srcset=", " style=\"background"] {
        assert!(!page.contains(word), "{word}");
    }
    let foreign = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    // a source may be quoted with its address; nothing may be loaded from one
    assert!(!foreign.contains("=\"http"), "a link out of the page");

    // links lead somewhere, ids are unique
    let ids = attributes(page, "id");
    let unique: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(ids.len(), unique.len());
    for target in attributes(page, "href") {
        let is_here = target.strip_prefix('#').is_some_and(|id| unique.contains(id));
        assert!(is_here || beside.contains(target), "{target}");
    }

    // everything is closed, and every figure and table says what it shows
    for tag in [
        "section", "figure", "svg", "g", "text", "table", "thead", "tbody", "tr", "th", "td", "ul", "dl",
        "p", "div",
    ] {
        assert_eq!(elements_or_void(page, tag), page.matches(&format!("</{tag}>")).count(), "<{tag}>");
    }
    let figures = elements(page, "figure");
    // the first of several pages leads to the others
    assert!(!figures.is_empty() || page.contains("aria-label=\"Pages\""));
    for (i, figure) in figures.iter().enumerate() {
        let caption = elements(figure, "figcaption");
        let number = format!("<b>Figure {}</b>. ", i + 1);
        let words = caption.first().and_then(|caption| caption.strip_prefix(&number));
        assert!(caption.len() == 1 && words.is_some_and(|words| words.len() > 10), "{caption:?}");
        // for a desk, and for a telephone
        let drawn = elements(figure, "svg");
        assert_eq!(drawn.len(), 2);
        assert_eq!(elements(drawn[0], "desc"), elements(drawn[1], "desc"));
        let pixels = ["NaN", "inf"].iter().any(|word| figure.contains(&format!("\"{word}")));
        assert!(!pixels, "a mark without a place");
    }
    for (i, table) in elements(page, "table").iter().enumerate() {
        let caption = elements(table, "caption");
        assert!(
            caption.len() == 1 && caption[0].starts_with(&format!("<b>Table {}</b>. ", i + 1)),
            "{caption:?}"
        );
        let columns = elements(elements(table, "thead")[0], "th").len();
        for row in elements(elements(table, "tbody")[0], "tr") {
            assert_eq!(elements(row, "td").len(), columns, "{row}");
        }
    }
}

/// How often a tag is opened (and not closed in itself).
fn elements_or_void(page: &str, tag: &str) -> usize {
    let open = format!("<{tag}");
    let opened = page.match_indices(&open).filter(|(at, _)| {
        let rest = &page[at + open.len()..];
        rest.starts_with([' ', '>']) && !rest[..rest.find('>').unwrap()].ends_with('/')
    });
    opened.count()
}

#[test]
fn every_page_stands_alone_and_is_sound() {
    for line in REPORTS {
        let ran = ran(&format!("{line} --out a/report --json"));
        let page = std::str::from_utf8(&ran.after["a/report/index.html"]).unwrap();
        let beside = ran.after.keys().filter_map(|name| name.strip_prefix("a/report/")).map(str::to_owned);
        let beside: BTreeSet<String> = beside.collect();
        for other in beside.iter().filter(|name| name.ends_with(".html")) {
            assert_sane(std::str::from_utf8(&ran.after[&format!("a/report/{other}")]).unwrap(), &beside);
        }
        // whoever opens the page knows what whoever ran the program was told
        let (page, warnings) = (page.replace('\u{a0}', " "), ran.answer.warnings());
        assert_eq!(page.contains("aria-label=\"Warnings\""), !warnings.is_empty(), "{line}");
        for warning in warnings {
            let escaped = warning.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
            assert!(page.contains(&format!("<li>{escaped}</li>")), "{line}: {warning}");
        }
    }
}
