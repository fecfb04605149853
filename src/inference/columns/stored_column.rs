//! Columns of a linear model as they are stored, and their products with vectors, part by part of
//! the data.
//!
//! Many columns are a number for each block of data times one pattern: a joint that turns by w_i at
//! pose i moves the tip by w_i·J_i. With D the pattern, three data a block, and v a vector,
//!
//! ```text
//! cᵀv = Σᵢ wᵢ·zᵢ,   zᵢ = Dᵢᵀvᵢ
//! ```
//!
//! so that the columns of one pattern need a third of the memory and of the work, and whole blocks
//! of them one product of matrices. What is summed over a part of the data is summed once and for
//! all searches that hold that part.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use nalgebra::DMatrix;

use crate::linalg::transposed_product;
use crate::parallel::in_parallel;

/// Columns whose products are computed at once.
const AT_ONCE: usize = 48;
/// A column that has at most this share of the data is multiplied number by number.
const SHORT: f64 = 0.125;

/// A column, `factor` times what stands in it; zero outside of it.
#[derive(Debug, Clone)]
pub struct StoredColumn<'a> {
    /// What each number counts.
    pub factor: f64,
    /// The first datum; of a pattern the first block.
    pub first: usize,
    /// The numbers; of a pattern one for each block.
    pub values: Cow<'a, [f64]>,
    /// What each block of data is multiplied by.
    pub pattern: Option<&'a Pattern>,
}

/// What the blocks of a column are multiples of.
#[derive(Debug, Clone)]
pub struct Pattern {
    /// Data in a block.
    pub block: usize,
    /// One number for each datum of all blocks.
    pub values: Arc<[f64]>,
}

/// Parts of the data: no datum is in two of them.
#[derive(Debug, Clone)]
pub struct DataParts {
    /// The data of each part, ascending.
    data: Vec<Vec<usize>>,
    /// The part of each datum.
    part: Vec<usize>,
}

impl DataParts {
    /// All data as one.
    pub fn whole(count: usize) -> DataParts {
        DataParts { data: vec![(0..count).collect()], part: vec![0; count] }
    }

    /// By the number of each datum's part, from 0.
    pub fn new(part: Vec<usize>) -> DataParts {
        let mut data = vec![Vec::new(); part.iter().max().map_or(0, |last| last + 1)];
        part.iter().enumerate().for_each(|(datum, &part)| data[part].push(datum));
        DataParts { data, part }
    }

    /// Number of parts.
    pub fn parts(&self) -> usize {
        self.data.len()
    }

    /// How many data they are of.
    pub fn count(&self) -> usize {
        self.part.len()
    }

    /// The part of a datum.
    pub fn part_of(&self, datum: usize) -> usize {
        self.part[datum]
    }

    /// True where the data of every block are in one part.
    fn holds_blocks(&self, block: usize, count: usize) -> bool {
        self.part[..count].chunks(block).all(|own| own.iter().all(|part| *part == own[0]))
    }

    /// The blocks of a part.
    fn blocks(&self, part: usize, pattern: &Pattern) -> Vec<usize> {
        let first = self.data[part].iter().filter(|&&datum| datum < pattern.values.len());
        first.filter(|&&datum| datum % pattern.block == 0).map(|datum| datum / pattern.block).collect()
    }
}

impl StoredColumn<'_> {
    /// Data from the first that is not zero on, and one after the last.
    fn range(&self) -> (usize, usize) {
        let block = self.pattern.map_or(1, |pattern| pattern.block);
        (block * self.first, block * (self.first + self.values.len()))
    }

    /// The number at a datum within the range.
    fn at(&self, datum: usize) -> f64 {
        match self.pattern {
            None => self.factor * self.values[datum - self.first],
            Some(pattern) => {
                self.factor * self.values[datum / pattern.block - self.first] * pattern.values[datum]
            }
        }
    }

    /// |c|².
    pub fn norm_squared(&self) -> f64 {
        let (from, to) = self.range();
        (from..to).map(|datum| self.at(datum).powi(2)).sum()
    }

    /// The numbers at some places (data, of a pattern blocks), which come in `runs`, without
    /// pattern and factor.
    fn gather(&self, runs: &[Range<usize>], target: &mut [f64]) {
        let mut next = 0;
        for run in runs {
            let from = run.start.max(self.first);
            let to = run.end.min(self.first + self.values.len());
            if from < to {
                let own = &self.values[from - self.first..to - self.first];
                target[next + from - run.start..][..own.len()].copy_from_slice(own);
            }
            next += run.len();
        }
    }
}

/// Can columns be multiplied part by part? Not where a block is in two of them.
pub fn fit(columns: &[StoredColumn<'_>], parts: &DataParts) -> bool {
    let patterns = by_pattern(columns, 0).0;
    let mut patterns = patterns.iter().map(|(pattern, _)| pattern);
    patterns.all(|pattern| parts.holds_blocks(pattern.block, pattern.values.len()))
}

/// Ascending places as runs of neighbours.
fn runs(places: &[usize]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for &place in places {
        match runs.last_mut() {
            Some(last) if last.end == place => last.end += 1,
            _ => runs.push(place..place + 1),
        }
    }
    runs
}

/// Columns (by their numbers) of each pattern, in the order in which the patterns are met; plain
/// ones; short ones.
type Sorted<'a> = (Vec<(&'a Pattern, Vec<usize>)>, Vec<usize>, Vec<usize>);

fn by_pattern<'a>(columns: &[StoredColumn<'a>], data: usize) -> Sorted<'a> {
    let (mut patterns, mut plain, mut short) = (Vec::<(&Pattern, Vec<usize>)>::new(), Vec::new(), Vec::new());
    let mut known: HashMap<*const f64, usize> = HashMap::new();
    for (number, column) in columns.iter().enumerate() {
        let (from, to) = column.range();
        if data > 0 && ((to - from) as f64) <= SHORT * data as f64 {
            short.push(number);
            continue;
        }
        let Some(pattern) = column.pattern else {
            plain.push(number);
            continue;
        };
        let next = patterns.len();
        let own = *known.entry(pattern.values.as_ptr()).or_insert(next);
        if own == next {
            patterns.push((pattern, Vec::new()));
        }
        patterns[own].1.push(number);
    }
    (patterns, plain, short)
}

/// vᵀc of all `vectors` (rows) with all columns, summed over each of the parts.
pub fn products(
    columns: &[StoredColumn<'_>],
    vectors: &DMatrix<f64>,
    parts: &DataParts,
) -> Vec<DMatrix<f64>> {
    let mut found = vec![DMatrix::zeros(vectors.ncols(), columns.len()); parts.parts()];
    let (patterns, plain, short) = by_pattern(columns, vectors.nrows());
    let mut multiply = |places: &[Vec<usize>], images: &[DMatrix<f64>], own: &[usize]| {
        let runs: Vec<Vec<Range<usize>>> = places.iter().map(|places| runs(places)).collect();
        let chunks: Vec<&[usize]> = own.chunks(AT_ONCE).collect();
        let of_chunk = |k: usize| -> Vec<DMatrix<f64>> {
            let of_part = |part: usize| {
                let mut numbers = DMatrix::zeros(places[part].len(), chunks[k].len());
                for (&column, mut target) in chunks[k].iter().zip(numbers.column_iter_mut()) {
                    columns[column].gather(&runs[part], target.as_mut_slice());
                }
                transposed_product(&images[part], &numbers)
            };
            (0..places.len()).map(of_part).collect()
        };
        let all = in_parallel(chunks.len(), of_chunk);
        for (chunk, of_parts) in chunks.iter().zip(all) {
            for (found, own) in found.iter_mut().zip(of_parts) {
                for (&number, own) in chunk.iter().zip(own.column_iter()) {
                    found.column_mut(number).axpy(columns[number].factor, &own, 0.0);
                }
            }
        }
    };
    for (pattern, own) in patterns {
        let places: Vec<Vec<usize>> = (0..parts.parts()).map(|part| parts.blocks(part, pattern)).collect();
        let image = |part: usize| {
            DMatrix::from_fn(places[part].len(), vectors.ncols(), |i, j| {
                let first = pattern.block * places[part][i];
                let data = first..first + pattern.block;
                data.map(|datum| pattern.values[datum] * vectors[(datum, j)]).sum::<f64>()
            })
        };
        let images: Vec<DMatrix<f64>> = (0..parts.parts()).map(image).collect();
        multiply(&places, &images, &own);
    }
    if !plain.is_empty() {
        let images: Vec<DMatrix<f64>> = parts.data.iter().map(|data| vectors.select_rows(data)).collect();
        multiply(&parts.data, &images, &plain);
    }
    for number in short {
        let (from, to) = columns[number].range();
        for datum in from..to {
            let value = columns[number].at(datum);
            if value != 0.0 {
                let found = &mut found[parts.part[datum]];
                (0..vectors.ncols()).for_each(|j| found[(j, number)] += value * vectors[(datum, j)]);
            }
        }
    }
    found
}

/// Inner products of some columns with each other, summed over each of the parts.
pub fn grams(columns: &[StoredColumn<'_>], parts: &DataParts) -> Vec<DMatrix<f64>> {
    let from = columns.iter().map(|column| column.range().0).min().unwrap_or(0);
    let to = columns.iter().map(|column| column.range().1).max().unwrap_or(0);
    let of_part = |data: &Vec<usize>| {
        let data = &data[data.partition_point(|&datum| datum < from)..];
        let data = &data[..data.partition_point(|&datum| datum < to)];
        let mut numbers = DMatrix::zeros(data.len(), columns.len());
        for (column, mut target) in columns.iter().zip(numbers.column_iter_mut()) {
            let (from, to) = column.range();
            for (target, &datum) in target.iter_mut().zip(data) {
                if (from..to).contains(&datum) {
                    *target = column.at(datum);
                }
            }
        }
        transposed_product(&numbers, &numbers)
    };
    parts.data.iter().map(of_part).collect()
}

/// The columns whole, of so many data.
pub fn dense(columns: &[StoredColumn<'_>], count: usize) -> DMatrix<f64> {
    let mut dense = DMatrix::zeros(count, columns.len());
    for (column, mut target) in columns.iter().zip(dense.column_iter_mut()) {
        let (from, to) = column.range();
        (from..to).for_each(|datum| target[datum] = column.at(datum));
    }
    dense
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: usize = 31;

    fn number(k: usize) -> f64 {
        (1.7 * k as f64).sin()
    }

    /// 30 data in blocks of three, and one besides; plain, patterned and short columns.
    #[test]
    fn products_and_grams_are_those_of_the_whole_columns_summed_over_the_parts() {
        let pattern = Pattern { block: 3, values: (0..30).map(number).collect() };
        let column = |first: usize, count: usize, pattern| StoredColumn {
            factor: 2.5,
            first,
            values: (0..count).map(|k| number(7 * k + first)).collect::<Vec<_>>().into(),
            pattern,
        };
        let columns = [
            column(0, 31, None),
            column(0, 10, Some(&pattern)),
            column(4, 5, Some(&pattern)),
            column(8, 1, Some(&pattern)),
            column(11, 2, None),
        ];
        // blocks in turn, and what is known besides in a part of its own
        let parts =
            DataParts::new((0..COUNT).map(|datum| if datum == 30 { 3 } else { datum / 3 % 3 }).collect());
        assert!(fit(&columns, &parts));
        assert!(!fit(&columns, &DataParts::new((0..COUNT).map(|datum| datum % 2).collect())));
        let whole = dense(&columns, COUNT);
        assert_eq!(whole[(14, 1)], 2.5 * number(7 * 4) * number(14));
        let vectors = DMatrix::from_fn(COUNT, 2, |i, j| number(5 * i + 3 * j));
        let (found, grams) = (products(&columns, &vectors, &parts), grams(&columns, &parts));
        for part in 0..4 {
            let own = |matrix: &DMatrix<f64>| matrix.select_rows(&parts.data[part]);
            let expected = own(&vectors).tr_mul(&own(&whole));
            assert!((&found[part] - expected).amax() < 1e-12, "{part}");
            let expected = own(&whole).tr_mul(&own(&whole));
            assert!((&grams[part] - expected).amax() < 1e-12, "{part}");
        }
    }
}
