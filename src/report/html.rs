//! The report as one page that needs nothing but itself.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::chart::Figure;
use super::document::{Block, Card, Report, Section, Tone};
use super::draw::{Medium, draw};
use super::file_name::{file_name, page_name};
use super::switch::UNITS;
use super::table::Table;
use super::unbroken::unbroken;

/// The whole page: style sheet, pictures and what little script there is are inside it, and it may
/// fetch nothing.
///
/// ```
/// use rodcal::report::{Report, html};
///
/// let report = Report::new("Stiffness of rod 5#", "It is 1.5 % softer.");
/// let page = html::page(&report);
/// assert!(page.starts_with("<!DOCTYPE html>") && page.contains("<h1>Stiffness of rod 5#</h1>"));
/// ```
pub fn page(report: &Report) -> String {
    let (mut figures, mut tables) = (0, 0);
    let sections: Vec<Markup> = report
        .sections
        .iter()
        .enumerate()
        .map(|(i, section)| {
            section_markup(Beside::Files(&report.page), section, Some(i), &mut figures, &mut tables)
        })
        .collect();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(NOTHING_FETCHED);
                meta name="generator" content=(GENERATOR);
                title { (report.title) }
                style { (PreEscaped(include_str!("html/page.css"))) }
            }
            body data-units=(units()) {
                a.skip href="#result" { "To the result" }
                header {
                    h1 { (report.title) }
                    @if !report.headline.is_empty() { p.headline #result { (unbroken(&report.headline)) } }
                }
                main {
                    @if !report.pages.is_empty() { (pages(report)) }
                    @if !report.cards.is_empty() { (cards(&report.cards)) }
                    @if !report.warnings.is_empty() {
                        (warnings(&report.warnings))
                    }
                    @if report.sections.len() > 1 { (contents(report)) }
                    @for section in sections { (section) }
                    @if !report.method.is_empty() { (method(&report.method)) }
                    @if !report.provenance.is_empty() || !report.result_file.is_empty() { (provenance(report)) }
                }
                footer { p { "Written by rodcal " (env!("CARGO_PKG_VERSION")) "." } }
                script { (PreEscaped(include_str!("html/page.js"))) }
            }
        }
    };
    page.into_string()
}

/// The same without a page around it, for a notebook: overview, words, pictures and tables, with
/// their own style and nothing outside. It holds no ids and no links, for there may be many.
///
/// ```
/// use rodcal::report::{Report, html};
///
/// let report = Report::new("Stiffness of rod 5#", "Rod 5# is 1.5 % softer.");
/// assert!(html::fragment(&report).starts_with("<div class=\"rodcal\">"));
/// ```
pub fn fragment(report: &Report) -> String {
    let (mut figures, mut tables) = (0, 0);
    let part = |section: &Section| section_markup(Beside::Nothing, section, None, &mut figures, &mut tables);
    let sections: Vec<Markup> = report.sections.iter().map(part).collect();
    let fragment = html! {
        div.rodcal {
            style { (PreEscaped(fragment_style())) }
            h1 { (report.title) }
            @if !report.headline.is_empty() { p.headline { (unbroken(&report.headline)) } }
            @if !report.cards.is_empty() { (cards(&report.cards)) }
            @if !report.warnings.is_empty() { (warnings(&report.warnings)) }
            @for section in sections { (section) }
        }
    };
    fragment.into_string()
}

/// The page's style sheet, nested below the fragment, which stands for the page there.
fn fragment_style() -> String {
    let page = include_str!("html/page.css").replace(":root {", "& {").replace("body {", "& {");
    format!(".rodcal {{\n{page}}}\n")
}

/// What a page may load: nothing but what stands in it.
const NOTHING_FETCHED: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";
/// By which the program knows its own pages.
pub const GENERATOR: &str = "rodcal";

/// The units that the script switches between, as JSON.
fn units() -> String {
    let units = UNITS.iter().map(|(unit, all)| ((*unit).to_owned(), serde_json::json!(all)));
    serde_json::Value::Object(units.collect()).to_string()
}

fn cards(cards: &[Card]) -> Markup {
    let class = |tone: Tone| match tone {
        Tone::Neutral => "neutral",
        Tone::Good => "good",
        Tone::Attention => "attention",
        Tone::Bad => "bad",
    };
    html! {
        ul.cards aria-label="Overview" {
            @for card in cards {
                li class=(class(card.tone)) {
                    span.label { (card.label) }
                    // a card is narrow: its uncertainty may stand on a line of its own
                    span.value { (unbroken(&card.value).replace("\u{a0}±", " ±")) }
                    @if !card.detail.is_empty() { span.detail { (unbroken(&card.detail)) } }
                }
            }
        }
    }
}

fn warnings(warnings: &[String]) -> Markup {
    html! {
        aside.warnings aria-label="Warnings" {
            h2 { @if warnings.len() == 1 { "Warning" } @else { "Warnings" } }
            ul { @for warning in warnings { li { (with_code(warning)) } } }
        }
    }
}

/// Words between backticks, which a terminal shows, as code.
fn with_code(text: &str) -> Markup {
    let text = unbroken(text);
    let parts: Vec<&str> = text.split('`').collect();
    // an odd one stands for itself
    if parts.len().is_multiple_of(2) {
        return html! { (text) };
    }
    html! {
        @for (k, part) in parts.into_iter().enumerate() {
            @if k % 2 == 1 { code { (part) } } @else { (part) }
        }
    }
}

fn pages(report: &Report) -> Markup {
    let own = page_name(&report.page);
    html! {
        nav aria-label="Pages" {
            ol.pages { @for page in &report.pages {
                li {
                    @if page.file == own { b aria-current="page" { (page.title) } }
                    @else { a href=(page.file) { (page.title) } }
                    @if report.page.is_empty() { span.detail { (page.answer) } }
                }
            } }
        }
    }
}

fn contents(report: &Report) -> Markup {
    html! {
        nav aria-label="Contents" {
            ol { @for (i, section) in report.sections.iter().enumerate() {
                li { a href=(format!("#{}", anchor(i))) { (section.heading) } }
            } }
        }
    }
}

fn method(paragraphs: &[String]) -> Markup {
    html! {
        section.method {
            h2 { "Method" }
            @for paragraph in paragraphs { p { (with_code(paragraph)) } }
        }
    }
}

fn provenance(report: &Report) -> Markup {
    let list = html! {
        dl { @for (name, value) in &report.provenance { dt { (name) } dd { (value) } } }
    };
    html! {
        section.provenance {
            // a page beside others has the same as they
            @if report.page.is_empty() { h2 { "Where this comes from" } (list) } @else {
                details { summary { "Where this comes from: the command, and every input with its SHA-256" } div { (list) } }
            }
            @if !report.result_file.is_empty() {
                p.files { "All numbers: " a href=(report.result_file) { (report.result_file) } }
            }
        }
    }
}

/// Whether the figures and tables of a report stand beside it as files.
#[derive(Clone, Copy)]
enum Beside<'a> {
    /// They do, by the name of its page.
    Files(&'a str),
    Nothing,
}

/// People look before they read: the words, then the pictures side by side where there is room,
/// then the tables.
fn section_markup(
    beside: Beside,
    section: &Section,
    number: Option<usize>,
    figures: &mut usize,
    tables: &mut usize,
) -> Markup {
    let (mut words, mut pictures, mut folded) = (Vec::new(), Vec::new(), Vec::new());
    for block in &section.blocks {
        match block {
            Block::Paragraph(text) => words.push(html! { p { (with_code(text)) } }),
            Block::List(points) => {
                words.push(html! { ul { @for point in points { li { (with_code(point)) } } } })
            }
            Block::Figure(figure) => {
                *figures += 1;
                pictures.push(figure_markup(beside, figure, *figures));
            }
            Block::Table(table) => {
                *tables += 1;
                folded.push(table_markup(beside, table, *tables));
            }
        }
    }
    html! {
        section id=[number.map(anchor)] {
            h2 { (section.heading) }
            @for words in words { (words) }
            @if !pictures.is_empty() { div.figures { @for picture in pictures { (picture) } } }
            @for table in folded { (table) }
        }
    }
}

fn figure_markup(beside: Beside, figure: &Figure, number: usize) -> Markup {
    let wide = draw(figure, Medium::Page);
    html! {
        figure {
            // Our own SVG: its texts are escaped where it is drawn, and it holds no ids. One of the
            // two is seen.
            div.picture.high[wide.is_high] role="group" aria-label=(format!("Figure {number}")) {
                @if let Beside::Files(_) = beside {
                    (PreEscaped(wide.svg))
                    (PreEscaped(draw(figure, Medium::Telephone).svg))
                } @else {
                    (PreEscaped(figure.svg()))
                }
            }
            figcaption {
                b { "Figure " (number) } ". " (unbroken(&figure.caption)) " "
                @if let Beside::Files(page) = beside {
                    @let file = format!("{}.svg", file_name(page, "figure", number, &figure.name));
                    span.files { a href=(file) { "SVG" } }
                    output {}
                }
            }
        }
    }
}

/// Tables of so many rows stand open.
const FEW_ROWS: usize = 8;

fn table_markup(beside: Beside, table: &Table, number: usize) -> Markup {
    let file = |page: &str, kind: &str| format!("{}.{kind}", file_name(page, "table", number, &table.name));
    let where_else = match beside {
        Beside::Files(_) => "the files below hold all",
        Beside::Nothing => "they are not shown here",
    };
    html! {
        details open[table.rows.len() <= FEW_ROWS && !table.is_folded] {
            summary { b { "Table " (number) } ". " (unbroken(&table.caption)) }
            div {
                (table.shortened(where_else).html(number))
                @if let Beside::Files(page) = beside {
                    p.files { a href=(file(page, "csv")) { "CSV" } " · " a href=(file(page, "md")) { "Markdown" } }
                }
            }
        }
    }
}

fn anchor(section: usize) -> String {
    format!("section-{}", section + 1)
}

#[cfg(test)]
mod tests {
    use super::super::chart::{Bar, Chart, Direction, Mark, Style};
    use super::super::{Report, Section};
    use super::*;

    #[test]
    fn what_comes_from_outside_is_escaped() {
        let evil = || "<script>&\"'".to_owned();
        let note = Mark::Note { at: [0.0, 0.0], text: evil() };
        let figure = Figure::from(Chart::new(evil(), evil(), evil()).with(note)).captioned(evil());
        let report = Report {
            title: evil(),
            headline: evil(),
            cards: vec![Card::new(evil(), evil(), evil())],
            warnings: vec![evil()],
            sections: vec![Section::new(
                evil(),
                vec![Block::Paragraph(evil()), Block::List(vec![evil()]), Block::Figure(figure)],
            )],
            provenance: vec![(evil(), evil())],
            ..Report::default()
        };
        // the only script is the page's own
        let page = page(&report);
        assert_eq!(page.matches("<script").count(), 1);
        assert!(page.ends_with("</script></body></html>"), "{}", &page[page.len() - 80..]);
    }

    #[test]
    fn nobody_sees_a_backtick() {
        let html = |text: &str| with_code(text).into_string();
        assert_eq!(html("no column `time_s` <x>"), "no column <code>time_s</code> &lt;x&gt;");
        assert_eq!(html("a ` b"), "a ` b");
    }

    #[test]
    fn a_number_is_not_parted_from_its_unit() {
        assert_eq!(unbroken("748 µm → 46.1 µm"), "748\u{a0}µm → 46.1\u{a0}µm");
        assert_eq!(unbroken("402 ± 14 µm"), "402\u{a0}±\u{a0}14\u{a0}µm");
        assert_eq!(unbroken("not evaluated"), "not evaluated");
    }

    #[test]
    fn a_fragment_stands_in_any_page() {
        let figure = Figure::from(Chart::new("<i>", "x", "y"));
        let mut table = Table::new("t", "Two & two", vec![super::super::table::Column::number("n", "")]);
        table.row(["4"]);
        let report = Report {
            title: "<u>".into(),
            cards: vec![Card::new("c", "1", "")],
            warnings: vec!["<w>".into()],
            sections: vec![Section::new("S", vec![Block::Figure(figure), Block::Table(table)])],
            provenance: vec![("file".into(), "x".into())],
            ..Report::default()
        };
        let fragment = fragment(&report);
        for foreign in [" id=", "href=", "<script", "<html", "<u>", "<w>", ":root", "body {"] {
            assert!(!fragment.contains(foreign), "{foreign} in {fragment}");
        }
        assert!(fragment.starts_with("<div class=\"rodcal\">") && fragment.ends_with("</div>"));
        assert!(fragment.contains("<svg") && fragment.contains("Table 1"));
    }

    #[test]
    fn a_page_has_its_pictures_in_every_unit_and_its_files_in_one() {
        let bar = Bar { from: 0.0, to: 1.0, value: 30.0, text: "30.0".into(), ..Bar::default() };
        let mark = Mark::Bars {
            label: "b".into(),
            bars: vec![bar],
            direction: Direction::Right,
            style: Style::nth(0),
        };
        let figure = Figure::from(Chart::new("t", "deflection / µm", "row").with(mark));
        let file = figure.svg();
        let section = Section::new("S", vec![Block::Figure(figure)]);
        let page = page(&Report { sections: vec![section], ..Report::default() });
        let label = |unit: &str| format!(">\ndeflection / {unit}\n");
        for unit in ["mm", "mil"] {
            assert!(page.contains(&label(unit)) && !file.contains(&label(unit)), "{unit}");
            let hidden = format!("<g data-of=\"µm\" data-unit=\"{unit}\" display=\"none\">");
            // grid and ticks, wide and narrow
            assert_eq!(page.matches(&hidden).count(), 4);
        }
        assert!(page.contains("<g data-number=\"µm\">") && !file.contains("<g "));
        assert!(page.contains("data-units=\"{&quot;µm&quot;:[[&quot;µm&quot;,1.0]"));
    }

    #[test]
    fn ids_are_unique_and_nothing_is_fetched() {
        let figure = || Block::Figure(Figure::from(Chart::new("t", "x", "y")));
        let report = Report {
            sections: vec![Section::new("Same", vec![figure(), figure()]), Section::new("Same", vec![])],
            ..Report::default()
        };
        let page = page(&report);
        let mut ids: Vec<&str> =
            page.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        let all = ids.len();
        ids.dedup();
        assert_eq!((ids.len(), all), (2, 2));
        let page = page.replace("http://www.w3.org/2000/svg", "").replace("http-equiv", "");
        assert!(!page.contains("http") && !page.contains("url(") && !page.contains("@import"));
        assert!(page.contains("Figure 2"));
    }
}
