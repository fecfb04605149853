//! What was recorded when.

use super::*;
use crate::rig::readings::Readings;

fn chronicle(text: &str) -> Vec<Entry> {
    let readings = Readings::from_text("f", text).unwrap();
    Chronicle::of(&readings.rows, readings.header.driven).rows
}

fn column<T>(text: &str, value: impl Fn(&Entry) -> T) -> Vec<T> {
    chronicle(text).iter().map(value).collect()
}

#[test]
fn turns_are_seen_through_a_trembling_load() {
    let values = [1.0, 2.0, 3.0, 2.99, 3.0, 2.0, 1.0, 1.01, 0.0, 0.005, 1.0, 2.0];
    let found = turns(&values);
    let directions: Vec<f64> = found.iter().map(|turn| turn.0).collect();
    assert_eq!(directions, [1.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0]);
    let cycles: Vec<usize> = found.iter().map(|turn| turn.1).collect();
    assert_eq!(cycles, [0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1]);
    // nothing has moved yet
    assert_eq!(turns(&[0.0, 0.0, -4.0])[..2], [(0.0, 0), (0.0, 0)]);
    assert_eq!(turns(&[]), []);
}

#[test]
fn a_load_that_goes_up_and_down_is_one_run_with_phases() {
    let loads = [5, 10, 15, 10, 5, 0, 5, 10, 15, 10, 5];
    let text = |more: &str| {
        let rows = loads.map(|load| format!("y,{load},{more}0\n")).concat();
        format!("axis,load_n,{}dy_um\n{rows}", if more.is_empty() { "" } else { "phase," })
    };
    let phases = column(&text(""), |entry| entry.motion.map(|motion| motion.phase));
    let (up, down) = (Some(Phase::Load), Some(Phase::Unload));
    assert_eq!(phases, [up, up, up, down, down, down, up, up, up, down, down]);
    assert_eq!(column(&text(""), |entry| entry.run), [0; 11]);
    assert_eq!(column(&text(""), |entry| entry.motion.map_or(9, |motion| motion.cycle))[5..8], [0, 1, 1]);
    // what is stated is not found out
    assert!(column(&text("load,"), |entry| entry.motion).iter().all(Option::is_none));
}

#[test]
fn loads_that_jump_back_begin_anew() {
    for loads in
        [vec![5, 10, 15, 5, 10, 15, 5, 10, 15], vec![15, 5, 10, 10, 5, 15, 10, 15, 5], vec![5, 0, 10, 0]]
    {
        let rows: String = loads.iter().map(|load| format!("y,{load},0\n")).collect();
        let found = chronicle(&format!("axis,load_n,dy_um\n{rows}"));
        assert!(found.iter().all(|entry| entry.motion.is_none()), "{loads:?}");
        assert!(found.iter().any(|entry| entry.run > 0) || loads.len() == 4, "{loads:?}");
    }
    // the same loads the other way are no way down
    let rows: String = [5, 10, 15].map(|load| format!("y,{load},0\n")).concat()
        + &[5, 10, 15].map(|load| format!("-y,{load},0\n")).concat();
    assert!(chronicle(&format!("axis,load_n,dy_um\n{rows}")).iter().all(|entry| entry.motion.is_none()));
}

/// Loads in any order: the one that a run ends with may be the first of the next.
#[test]
fn a_load_that_another_axis_comes_before_is_not_read_once_more() {
    let run = |axis: char, loads: [u32; 4]| loads.map(|load| format!("{axis},{load},0\n")).concat();
    let own = [7, 3, 9, 5];
    let rows = run('z', own) + &run('y', own) + &run('z', [5, 9, 3, 7]) + &run('y', own);
    let runs = column(&format!("axis,load_n,dy_um\n{rows}"), |entry| entry.run);
    assert_eq!(runs, [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3]);
    // the display once more
    let rows = run('z', [7, 3, 3, 5]) + &run('z', [7, 3, 3, 5]);
    let runs = column(&format!("axis,load_n,dy_um\n{rows}"), |entry| entry.run);
    assert_eq!(runs, [0, 0, 0, 0, 1, 1, 1, 1]);
}

#[test]
fn a_trial_of_another_session_is_another_trial() {
    let text = "session,trial,axis,load_n,dy_um\na,1,y,5,0\na,1,y,6,0\nb,1,y,5,0\nb,1,y,6,0\na,2,y,5,0\n";
    assert_eq!(column(text, |entry| entry.session), [0, 0, 1, 1, 0]);
    assert_eq!(column(text, |entry| entry.trial), [0, 0, 1, 1, 2]);
    assert_eq!(column(text, |entry| entry.run), [0, 0, 1, 1, 2]);
}

#[test]
fn times_order_the_rows_unless_the_clock_begins_anew() {
    let head = "axis,load_n,time_s,trial,dy_um\n";
    let shuffled = format!("{head}y,9,30,1,0\ny,5,10,1,0\ny,5,10,1,0\ny,7,20,1,0\n");
    assert_eq!(column(&shuffled, |entry| entry.place), [2, 0, 0, 1]);
    // the second trial was the first one
    let later = format!("{head}y,5,100,1,0\ny,7,110,1,0\ny,5,10,2,0\ny,7,20,2,0\n");
    assert_eq!(column(&later, |entry| entry.trial), [1, 1, 0, 0]);
    // trials of one name along two axes
    let axes = format!("{head}y,5,0,1,0\ny,6,20,2,0\nz,5,40,1,0\nz,6,60,2,0\n");
    assert_eq!(column(&axes, |entry| entry.place), [0, 1, 2, 3]);
    // each trial by a clock of its own: as in the file
    let anew = format!("{head}y,5,0,1,0\ny,7,20,1,0\ny,5,0,2,0\ny,7,20,2,0\n");
    assert_eq!(column(&anew, |entry| entry.trial), [0, 0, 1, 1]);
    assert!(begins_anew(&[0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0]));
    assert!(!begins_anew(&[3.0, 1.0, 0.0, 2.0, 4.0]) && !begins_anew(&[0.0, 1.0, 2.0]));
}

#[test]
fn without_times_stations_in_blocks_or_side_by_side_are_the_same_instants() {
    let row = |load: i32, station: i32| format!("y,{load},1,{station},0\n");
    let head = "axis,load_n,trial,read_station_mm,dy_um\n";
    let beside: String = [5, 7, 9].map(|load| row(load, 200) + &row(load, 400)).concat();
    let blocks = [200, 400].map(|station| [5, 7, 9].map(|load| row(load, station)).concat()).concat();
    assert_eq!(column(&(head.to_owned() + &beside), |entry| entry.place), [0, 0, 2, 2, 4, 4]);
    assert_eq!(column(&(head.to_owned() + &blocks), |entry| entry.place), [0, 1, 2, 0, 1, 2]);
}

/// Three readings at rest are no three ways.
#[test]
fn a_displacement_that_is_held_keeps_the_way_that_it_came() {
    let cycle = [10, 20, 10, 0, 0, 0, -10, -20, -10, 0, 0, 0];
    let rows = cycle.map(|um| format!("y,{},{um}\n", um + 30)).concat().repeat(2);
    let text = format!("# driven = \"displacement\"\naxis,load_n,dy_um\n{rows}");
    let (up, down) = (Some(Phase::Load), Some(Phase::Unload));
    let phases = column(&text, |entry| entry.motion.map(|motion| motion.phase));
    assert_eq!(phases[..9], [up, up, down, down, down, down, up, up, down]);
    // nothing is unloaded before anything has moved
    let at_rest = text.replace("dy_um\n", "dy_um\ny,30,0\ny,30,0\n");
    let phases = column(&at_rest, |entry| entry.motion.map(|motion| motion.phase));
    assert_eq!(phases[..6], [up, up, up, up, down, down]);
}
