//! The report as one page that needs nothing but itself.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::chart::Figure;
use super::document::{Block, Report};

/// The whole page: style sheet and pictures are inside it.
pub fn page(report: &Report) -> String {
    let (mut figures, mut tables) = (0, 0);
    let sections: Vec<Markup> = report
        .sections
        .iter()
        .enumerate()
        .map(|(i, section)| {
            html! {
                section id=(anchor(i)) {
                    h2 { (section.heading) }
                    @for block in &section.blocks { (markup(block, &mut figures, &mut tables)) }
                }
            }
        })
        .collect();
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (report.title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { (report.title) }
                    @if !report.headline.is_empty() { p.headline { (report.headline) } }
                }
                main {
                    @if !report.warnings.is_empty() {
                        aside.warnings aria-label="Warnings" {
                            h2 { @if report.warnings.len() == 1 { "Warning" } @else { "Warnings" } }
                            ul { @for warning in &report.warnings { li { (warning) } } }
                        }
                    }
                    @if report.sections.len() > 1 { (contents(report)) }
                    @for section in sections { (section) }
                    @if !report.provenance.is_empty() { (provenance(report)) }
                }
                footer { p { "Written by rodcal " (env!("CARGO_PKG_VERSION")) "." } }
            }
        }
    };
    page.into_string()
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

fn provenance(report: &Report) -> Markup {
    html! {
        section.provenance {
            h2 { "Where this comes from" }
            dl { @for (name, value) in &report.provenance { dt { (name) } dd { (value) } } }
        }
    }
}

fn markup(block: &Block, figures: &mut usize, tables: &mut usize) -> Markup {
    match block {
        Block::Paragraph(text) => html! { p { (text) } },
        Block::List(points) => html! { ul { @for point in points { li { (point) } } } },
        Block::Table(table) => {
            *tables += 1;
            table.html(*tables)
        }
        Block::Figure(figure) => {
            *figures += 1;
            figure_markup(figure, *figures)
        }
    }
}

fn figure_markup(figure: &Figure, number: usize) -> Markup {
    html! {
        figure {
            // Our own SVG: its texts are escaped where it is drawn, and it holds no ids.
            div.wide { (PreEscaped(figure.svg())) }
            figcaption { b { "Figure " (number) } ". " (figure.caption) }
        }
    }
}

fn anchor(section: usize) -> String {
    format!("section-{}", section + 1)
}

const STYLE: &str = "
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 52rem; padding: 2.5rem 1.25rem 4rem; background: #fff; color: #222;
  font: 1rem/1.55 system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .75rem; }
h2 { font-size: 1.3rem; line-height: 1.3; margin: 2.75rem 0 .75rem; }
p, ul, ol { margin: .75rem 0; max-width: 42rem; }
a { color: #0072b2; }
.headline { font-size: 1.15rem; margin: 0 0 1.5rem; padding: .8rem 1.1rem; max-width: none;
  border-left: 4px solid #0072b2; background: #f2f7fb; }
.warnings { margin: 1.5rem 0; padding: .7rem 1.1rem; border: 1px solid #d55e00; border-left-width: 4px;
  background: #fdf5ef; }
.warnings h2 { margin: 0; font-size: 1rem; color: #a34700; }
.warnings ul { margin: .3rem 0; padding-left: 1.2rem; }
nav { margin: 1.5rem 0; font-size: .95rem; }
nav ol { margin: 0; padding-left: 1.3rem; columns: 2; column-gap: 2rem; }
nav li { break-inside: avoid; }
figure { margin: 1.75rem 0; break-inside: avoid; }
figure svg { display: block; width: 100%; height: auto; min-width: 32rem; }
figcaption, caption { font-size: .9rem; line-height: 1.45; color: #444; text-align: left; }
figcaption { margin-top: .5rem; max-width: 44rem; }
caption { caption-side: top; padding-bottom: .5rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; margin: 1.5rem 0 .75rem; font-size: .88rem; break-inside: avoid;
  font-variant-numeric: tabular-nums lining-nums; border-top: 1.5px solid #222; border-bottom: 1.5px solid #222; }
table caption { border: 0; }
th, td { padding: .32rem 1.1rem .32rem 0; vertical-align: baseline; text-align: left; }
th:last-child, td:last-child { padding-right: .4rem; }
th { font-weight: 600; border-bottom: 1px solid #222; vertical-align: bottom; }
.unit { display: block; font-weight: 400; color: #555; }
th:first-child, td:first-child { white-space: nowrap; }
.number { text-align: right; white-space: nowrap; }
tbody tr + tr td { border-top: 1px solid #e6e6e6; }
.note { font-size: .87rem; color: #444; margin: .2rem 0; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .25rem 1.5rem; font-size: .93rem; }
dt { color: #555; }
dd { margin: 0; overflow-wrap: anywhere; font-variant-numeric: tabular-nums; }
footer { margin-top: 3rem; border-top: 1px solid #ddd; font-size: .85rem; color: #555; }
@media (max-width: 36rem) {
  body { padding-top: 1.25rem; }
  nav ol { columns: 1; }
  dl { grid-template-columns: 1fr; gap: 0; }
  dd { margin-bottom: .5rem; }
}
@media print {
  body { max-width: none; padding: 0; font-size: 10.5pt; }
  figure svg { min-width: 0; }
  .wide { overflow: visible; }
  h2 { break-after: avoid; }
  a { color: inherit; text-decoration: none; }
  nav { display: none; }
}
";

#[cfg(test)]
mod tests {
    use super::super::chart::{Chart, Mark};
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
            warnings: vec![evil()],
            sections: vec![Section::new(
                evil(),
                vec![Block::Paragraph(evil()), Block::List(vec![evil()]), Block::Figure(figure)],
            )],
            provenance: vec![(evil(), evil())],
        };
        assert!(!page(&report).contains("<script"));
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
        assert!(!page.replace("http://www.w3.org/2000/svg", "").contains("http"));
        assert!(page.contains("Figure 2"));
    }
}
