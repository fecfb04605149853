//! A search that stopped, as text: what it is a search of, how far it came, and what it has found
//! so far; and parts of a search, which many machines look at. Numbers are written as their bits,
//! so that a search that goes on is the one that never stopped.

use std::ops::Range;

use super::figure::{Design, Figures};
use super::nearest::{Nearest, Relaxed};
use super::search::{Search, Searched};
use super::space::DesignSpace;
use crate::delimited::quoted;
use crate::error::{Error, Place, Result};

/// First line of the text.
const HEAD: &str = concat!("rodcal search ", env!("CARGO_PKG_VERSION"));
/// What follows is the design file and its catalogue, word for word.
const CONTENT: &str = "of";

impl<'s> Search<'s> {
    /// The search so far.
    pub fn to_text(&self) -> String {
        let total = &self.total;
        let list = |numbers: &[u64]| numbers.iter().map(u64::to_string).collect::<Vec<_>>().join(" ");
        let design = |design: &Design| {
            let bits: Vec<u64> = design.figures.0.iter().map(|figure| figure.to_bits()).collect();
            format!("{} {}", design.index, list(&bits))
        };
        let mut lines = vec![HEAD.to_owned(), self.asked()];
        lines.push(list(&[self.done, total.feasible]));
        lines.push(list(&total.broken));
        lines.push(list(&total.impossible));
        let designs = total.front.sorted();
        lines.push(designs.len().to_string());
        lines.extend(designs.iter().map(design));
        let nearest = &total.nearest;
        lines.push(nearest.one_limit.len().to_string());
        for relaxed in &nearest.one_limit {
            let place = self.space.limits.iter().position(|limit| limit.key == relaxed.limit.key);
            let place = place.unwrap_or(0);
            lines.push(format!("{place} {} {}", relaxed.to.to_bits(), design(&relaxed.design)));
        }
        lines.push(match &nearest.all_limits {
            Some((nearest, worst)) => format!("{} {}", worst.to_bits(), design(nearest)),
            None => "none".into(),
        });
        lines.push(CONTENT.into());
        lines.push(self.space.content.clone());
        lines.join("\n")
    }

    /// Which rods are looked at: `all`, `samples 5000 seed 1`, `all part 0 4096`.
    fn asked(&self) -> String {
        let asked = match self.searched {
            Searched::All => "all".to_owned(),
            Searched::Samples(samples, seed) => format!("samples {samples} seed {seed}"),
        };
        match self.part == (0..self.count()) {
            true => asked,
            false => format!("{asked} part {} {}", self.part.start, self.part.end),
        }
    }

    /// The search that was kept in `file`, whose text this is.
    ///
    /// # Errors
    /// [`Error::Input`] where it is another search (another program, design file, catalogue or
    /// sample), or no search.
    pub fn from_text(
        space: &'s DesignSpace,
        searched: Searched,
        file: &str,
        text: &str,
    ) -> Result<Search<'s>> {
        Search::new(space, searched)?.known(file, text)
    }

    /// The part of a search whose text this is.
    ///
    /// # Errors
    /// As [`Search::from_text`] and [`Search::part`].
    pub fn part_from_text(
        space: &'s DesignSpace,
        searched: Searched,
        part: Range<u64>,
        file: &str,
        text: &str,
    ) -> Result<Search<'s>> {
        Search::part(space, searched, part)?.known(file, text)
    }

    /// This search, which has looked at nothing yet, as a text has it.
    fn known(mut self, file: &str, text: &str) -> Result<Search<'s>> {
        let (space, asked) = (self.space, self.asked());
        let search = &mut self;
        let mut lines = Lines { file, lines: text.lines(), number: 0 };
        let another = |line: usize, found: String, expected: &str| Error::Input {
            at: Place { file: file.to_owned(), line, column: 1 },
            found,
            expected: expected.to_owned(),
            hint: Some("give another file to begin anew".into()),
        };
        let head = lines.next()?;
        if head != HEAD {
            return Err(another(1, quoted(head), &format!("a search kept by this program, {HEAD:?}")));
        }
        let sampled = lines.next()?;
        if sampled != asked {
            let expected = format!("the same rods to look at, {asked:?}");
            return Err(another(2, quoted(sampled), &expected));
        }
        let content = text.split_once(&format!("\n{CONTENT}\n")).map_or("", |(_, content)| content);
        if content != space.content {
            let found = "a search of another design file or catalogue".to_owned();
            return Err(another(1, found, &format!("one of {} as it is now", space.file)));
        }
        let total = &mut search.total;
        let [done, feasible] = lines.numbers()?;
        total.feasible = feasible;
        total.broken = lines.all()?;
        total.impossible = lines.numbers()?;
        let [count] = lines.numbers()?;
        for _ in 0..count {
            let design = design_of(&lines.numbers::<9>()?);
            if design.index >= space.combinations() {
                return Err(lines.error());
            }
            total.front.offer(design);
        }
        let mut nearest = Nearest::default();
        let [count] = lines.numbers()?;
        for _ in 0..count {
            let all = lines.numbers::<11>()?;
            let Some(limit) = space.limits.get(all[0] as usize) else { return Err(lines.error()) };
            let to = f64::from_bits(all[1]);
            nearest.one_limit.push(Relaxed { limit: *limit, to, design: design_of(&all[2..]) });
        }
        let last = lines.next()?;
        if last != "none" {
            let all: [u64; 10] = lines.parsed(last)?.try_into().map_err(|_| lines.error())?;
            nearest.all_limits = Some((design_of(&all[1..]), f64::from_bits(all[0])));
        }
        total.nearest = nearest;
        if total.broken.len() != space.limits.len() || done < search.part.start || done > search.part.end {
            return Err(lines.error());
        }
        search.done = done;
        Ok(self)
    }
}

/// From its number and the bits of its figures.
fn design_of(numbers: &[u64]) -> Design {
    let figure = |k: usize| numbers.get(k + 1).map_or(f64::NAN, |bits| f64::from_bits(*bits));
    Design {
        index: numbers.first().copied().unwrap_or_default(),
        figures: Figures(std::array::from_fn(figure)),
    }
}

/// The lines of a text, with what is wrong where.
struct Lines<'t> {
    file: &'t str,
    lines: std::str::Lines<'t>,
    number: usize,
}

impl<'t> Lines<'t> {
    fn next(&mut self) -> Result<&'t str> {
        self.number += 1;
        self.lines.next().ok_or_else(|| self.error())
    }

    fn all(&mut self) -> Result<Vec<u64>> {
        let line = self.next()?;
        self.parsed(line)
    }

    fn numbers<const N: usize>(&mut self) -> Result<[u64; N]> {
        self.all()?.try_into().map_err(|_| self.error())
    }

    fn parsed(&self, line: &str) -> Result<Vec<u64>> {
        let numbers = line.split_whitespace().map(|word| word.parse().ok());
        numbers.collect::<Option<_>>().ok_or_else(|| self.error())
    }

    fn error(&self) -> Error {
        Error::Input {
            at: Place { file: self.file.to_owned(), line: self.number, column: 1 },
            found: "this is not as the program writes it".into(),
            expected: "a search kept by this program, unchanged".into(),
            hint: Some("give another file to begin anew".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TUBES: &str =
        "name,material,outer_diameter_mm,inner_diameter_mm\na,steel,30,28\nb,aluminium,40,36\n";

    /// More than one block of rods.
    fn space(limit: &str) -> DesignSpace {
        space_in_steps(1, limit)
    }

    fn space_in_steps(step: u32, limit: &str) -> DesignSpace {
        let text = format!(
            "[geometry]\nl1_mm = {{ from = 100, to = 400, step = {step} }}\nl2_mm = {{ from = 300, to = 800, step = {step} }}\n\
             [catalogue]\nfile = \"t.csv\"\n[constraints]\nmax_mass_g = {limit}\nmin_reach_mm = 500\n[objectives]\n\
             minimise = [\"c_rod_um\"]\nmaximise = [\"reach_mm\"]\n"
        );
        DesignSpace::from_toml("d.toml", &text, &|name| Ok((name.to_owned(), TUBES.to_owned()))).unwrap()
    }

    #[test]
    fn a_search_that_was_killed_goes_on_as_if_nothing_had_been() {
        for limit in ["700", "10"] {
            let space = space(limit);
            let mut search = Search::new(&space, Searched::All).unwrap();
            search.go_on(&|_| {}).unwrap();
            assert!(!search.is_done());
            let kept = search.to_text();
            drop(search);
            let mut again = Search::from_text(&space, Searched::All, "kept", &kept).unwrap();
            assert_eq!(again.to_text(), kept);
            while !again.is_done() {
                again.go_on(&|_| {}).unwrap();
            }
            let whole = super::super::search(&space, Searched::All, &|_| {}).unwrap();
            let found = again.found().unwrap();
            assert_eq!((found.evaluated, found.feasible), (whole.evaluated, whole.feasible));
            assert_eq!((&found.front, &found.broken), (&whole.front, &whole.broken));
            assert_eq!(found.nearest, whole.nearest);
        }
    }

    /// Also where the last part is short, where nothing keeps all limits, and of samples.
    #[test]
    fn parts_that_others_looked_at_are_the_search() {
        for (limit, searched) in
            [("700", Searched::All), ("10", Searched::All), ("700", Searched::Samples(12_000, 3))]
        {
            let space = space_in_steps(4, limit);
            let mut all = Search::new(&space, searched).unwrap();
            let (count, size) = (all.count(), 2 * super::super::PART);
            for from in (0..count).step_by(size as usize) {
                let part = from..count.min(from + size);
                let mut one = Search::part(&space, searched, part.clone()).unwrap();
                let unfinished = Search::part(&space, searched, part.clone()).unwrap();
                assert!(all.take_in(unfinished).is_err());
                while !one.is_done() {
                    one.go_on(&|_| {}).unwrap();
                }
                let again =
                    Search::part_from_text(&space, searched, part.clone(), "part", &one.to_text()).unwrap();
                assert_eq!(again.to_text(), one.to_text());
                all.take_in(again).unwrap();
                // once is enough
                assert!(all.take_in(one).is_err());
            }
            let whole = super::super::search(&space, searched, &|_| {}).unwrap();
            let found = all.found().unwrap();
            assert_eq!((found.evaluated, found.feasible), (whole.evaluated, whole.feasible));
            assert_eq!((&found.front, &found.broken), (&whole.front, &whole.broken));
            assert_eq!((&found.impossible, &found.nearest), (&whole.impossible, &whole.nearest));
        }
        let space = space("700");
        for part in [0..0, 1..4096, 0..5000, 0..u64::MAX, 4096..1 << 40] {
            assert!(Search::part(&space, Searched::All, part).is_err());
        }
    }

    #[test]
    fn a_search_of_something_else_is_refused() {
        let (one, other) = (space("700"), space("600"));
        let kept = Search::new(&one, Searched::All).unwrap().to_text();
        let refused = |space: &DesignSpace, searched: Searched, text: &str, expected: &str| {
            let error = Search::from_text(space, searched, "kept", text).err().unwrap().to_string();
            assert!(error.contains(expected), "{error}");
        };
        refused(&other, Searched::All, &kept, "another design file");
        refused(&one, Searched::Samples(5, 1), &kept, "kept:2:1: \"all\"");
        refused(&one, Searched::All, "rodcal search 0.0.0\n", "kept:1:1: \"rodcal search 0.0.0\"");
        refused(&one, Searched::All, "", "kept:1");
        refused(
            &one,
            Searched::All,
            &kept.replacen("0 0", "0 x", 1),
            "kept:3:1: this is not as the program writes it",
        );
    }
}
