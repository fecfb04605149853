//! Clocks of creep and loops of hysteresis, by hand.

use super::*;
use crate::diagnosis::rig::recording::datum;
use crate::rig::readings::Readings;

const TEXT: &str = "axis,load_n,phase,time_s,dy_um
-y,5,load,100,0
-y,10,load,200,0
-y,5,unload,300,0
-y,0,unload,400,0
";

fn data(text: &str) -> Vec<Datum> {
    datum::all(&Readings::from_text("f", text).unwrap().rows)
}

#[test]
fn clocks_start_where_they_say() {
    let data = data(TEXT);
    let second = |clock| creep(&data, clock, 1.0).unwrap().relative[1];
    assert_eq!(second(Clock::FirstReading), 101f64.log10());
    assert_eq!(second(Clock::FirstLoad), 201f64.log10());
    assert_eq!(second(Clock::File), 201f64.log10());
    // 5 N for 200 s, 5 N more for 100 s
    let each = (5.0 * 201f64.log10() + 5.0 * 101f64.log10()) / 10.0;
    assert!((second(Clock::EachLoad(Changed::Early)) - each).abs() < 1e-15);
}

#[test]
fn whoever_waits_as_long_before_every_reading_hung_each_load_so_long_before() {
    // a quarter of 80 s before the readings at 100, 180 and 300 s
    let data = data("axis,load_n,time_s,dy_um\n-y,5,100,0\n-y,10,180,0\n-y,15,300,0\n");
    let third = creep(&data, Clock::EachLoad(Changed::Waited(1)), 1.0).unwrap().relative[2];
    let expected = (221f64.log10() + 141f64.log10() + 21f64.log10()) / 3.0;
    assert!((third - expected).abs() < 1e-15, "{third} {expected}");
}

#[test]
fn an_unloaded_rod_still_recovers() {
    let memory = creep(&data(TEXT), Clock::EachLoad(Changed::Early), 1.0).unwrap();
    let left = 5.0 * (401f64.log10() + 301f64.log10() - 201f64.log10() - 101f64.log10());
    assert!((memory.lingering[3] - left).abs() < 1e-12 && left > 0.0);
    assert_eq!(memory.relative[3], 0.0);
}

#[test]
fn loops_close_at_the_largest_load() {
    let data = data(TEXT);
    let closed = hysteresis(&data, Loop::Closed).unwrap();
    assert_eq!(closed.relative, [0.0, 0.0, 2.0, 4.0]);
    let remanent = hysteresis(&data, Loop::Remanent).unwrap();
    assert_eq!(remanent.lingering, [0.0, 0.0, 10.0, 20.0]);
    let symmetric = hysteresis(&data, Loop::Symmetric).unwrap();
    assert_eq!(symmetric.relative, [-1.0, 0.0, 1.0, 2.0]);
    // the branches of a virgin rod meet at the largest load, and are h·F_max apart at half of
    // it
    let virgin = hysteresis(&data, Loop::Virgin).unwrap();
    let felt = |i: usize| data[i].load * virgin.relative[i] + virgin.lingering[i];
    assert!((felt(2) - felt(0) - 10.0).abs() < 1e-12 && felt(3) > 0.0);
}

#[test]
fn a_new_rod_is_new_once_in_each_direction() {
    let run = |direction: &str, trial: usize| {
        format!(
            "{direction},5,load,{trial},0\n{direction},10,load,{trial},0\n{direction},5,unload,{trial},0\n"
        )
    };
    let text = |runs: &[String]| "axis,load_n,phase,trial,dy_um\n".to_owned() + &runs.concat();
    let mixed = data(&text(&[run("y", 1), run("-y", 2), run("y", 3)]));
    let before = hysteresis(&mixed, Loop::Symmetric).unwrap();
    for (shape, set) in [(Loop::NewByRayleigh, 2.0), (Loop::NewByPlays, 1.0)] {
        let new = hysteresis(&mixed, shape).unwrap();
        let felt = |i: usize| mixed[i].load * new.relative[i] + new.lingering[i];
        // half the largest load, all of it, and half of it again
        for (at, first) in [(0, 0.0), (3, 0.0)] {
            assert_eq!([0, 1, 2].map(|k| felt(at + k)), [first, 10.0 * set, 10.0 * set + 5.0]);
        }
        assert_eq!(
            (&new.relative[6..], &new.lingering[6..]),
            (&before.relative[6..], &before.lingering[6..])
        );
    }
    // where it is new in every run, all are alike, and h wide at half of the load
    let first = hysteresis(&mixed, Loop::FirstByPlays).unwrap();
    for run in [0, 3, 6] {
        let felt = |k: usize| mixed[run + k].load * first.relative[run + k] + first.lingering[run + k];
        assert!((felt(2) - felt(0) - 10.0).abs() < 1e-12 && (felt(1) - 20.0 / 3.0).abs() < 1e-12, "{run}");
    }
}

#[test]
fn what_the_first_run_has_left_stands_in_the_others_of_one_zero() {
    let run = |direction: &str, trial: usize| {
        format!(
            "{direction},5,load,{trial},0\n{direction},10,load,{trial},0\n{direction},5,unload,{trial},0\n"
        )
    };
    let text =
        "axis,load_n,phase,trial,dy_um\n".to_owned() + &[run("y", 1), run("-y", 2), run("y", 3)].concat();
    let data = data(&text);
    for (kept, each, left) in
        [(Loop::KeptByRayleigh, Loop::NewByRayleigh, 20.0), (Loop::KeptByPlays, Loop::NewByPlays, 10.0)]
    {
        let [kept, each] = [kept, each].map(|shape| hysteresis(&data, shape).unwrap());
        assert_eq!(kept.relative, each.relative);
        // of the first run of each direction, then of what follows
        assert_eq!(kept.lingering[..6], each.lingering[..6]);
        assert_eq!([6, 7, 8].map(|i| kept.lingering[i] - each.lingering[i]), [left; 3]);
        // the load goes up to where it was, and comes down to where it was
        let felt = |i: usize| data[i].load * kept.relative[i] + kept.lingering[i];
        assert_eq!([felt(7), felt(8)], [felt(1), felt(2)]);
    }
}

#[test]
fn without_time_or_a_way_down_there_is_no_memory() {
    let data = data("axis,load_n,time_s,dy_um\ny,5,1,0\ny,6,,0\n");
    assert!(creep(&data, Clock::File, 1.0).is_none());
    assert!(hysteresis(&data, Loop::Closed).is_none());
}
