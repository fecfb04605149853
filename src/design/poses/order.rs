//! The order in which poses are measured: from each to the nearest that is left.

/// Sorts the poses of one clamp: it begins with the one nearest to the joints' zeros; a way is as
/// long as the largest change of a joint. Of equally near ones the first comes first.
pub(super) fn sort(poses: &mut [Vec<f64>]) {
    let mut from = vec![0.0; poses.first().map_or(0, Vec::len)];
    for at in 0..poses.len() {
        let way = |q: &Vec<f64>| q.iter().zip(&from).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let next = (at..poses.len()).min_by(|&a, &b| way(&poses[a]).total_cmp(&way(&poses[b])));
        poses.swap(at, next.unwrap_or(at));
        from.clone_from(&poses[at]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_comes_next() {
        let mut poses = vec![vec![3.0, 0.0], vec![1.0, 0.0], vec![1.5, 2.9], vec![1.5, 0.5]];
        sort(&mut poses);
        assert_eq!(poses, [vec![1.0, 0.0], vec![1.5, 0.5], vec![3.0, 0.0], vec![1.5, 2.9]]);
    }
}
