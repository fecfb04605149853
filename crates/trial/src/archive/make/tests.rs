//! What a trial is made of, and how one that was interrupted goes on.

use super::super::default_key;
use super::*;

fn plan(seed: u128) -> Plan {
    Plan { seed: Some(Seed(seed)), suite: Suite::Rig, residuals: Vec::new(), range: 1..4 }
}

fn sealed(directory: &Path, plan: &Plan) -> Result<Manifest> {
    let staged = make(&directory.join("t"), &directory.join("t.key.jsonl"), plan, || {})?;
    let manifest = staged.manifest.clone();
    staged.seal()?;
    Ok(manifest)
}

fn bytes(directory: &Path) -> Vec<Vec<u8>> {
    let names =
        ["t/manifest.json", "t/rig/case-0001/readings.csv", "t/rig/case-0003/rod.toml", "t.key.jsonl"];
    names.iter().map(|name| files::read_bytes(&directory.join(name)).unwrap()).collect()
}

#[test]
fn the_same_seed_makes_the_same_bytes_and_the_manifest_says_nothing_of_it() {
    let (a, b) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (a, b) = (a.path(), b.path());
    sealed(a, &plan(5)).unwrap();
    sealed(b, &plan(5)).unwrap();
    assert_eq!(bytes(a), bytes(b));
    let manifest = Manifest::read(&a.join("t")).unwrap();
    assert_eq!(manifest.case_names(), ["rig/case-0001", "rig/case-0002", "rig/case-0003"]);
    assert!(!files::read_text(&a.join("t/manifest.json")).unwrap().contains("seed"));
    let (truths, is_sealed) = manifest.read_key(&a.join("t"), &a.join("t.key.jsonl")).unwrap();
    assert!(is_sealed && truths.len() == 3 && truths[0].seed == Some(Seed(5)));
    assert!(matches!(sealed(a, &plan(6)), Err(Error::InTheWay { .. })));
    let key = b.join("u/../new/key");
    assert!(matches!(make(&b.join("new"), &key, &plan(6), || {}), Err(Error::Argument { .. })));
    assert!(default_key(Path::new(".")).is_err());
}

/// Every operation fails once, or is the last one of a run that is killed; the same command
/// then makes the same trial.
#[test]
fn a_fault_at_any_operation_leaves_nothing_or_what_is_gone_on_with() {
    use rodcal_base::files::faults::{Fault, with};
    let plan = Plan { range: 1..2, ..plan(1 << 70) };
    let whole = tempfile::tempdir().unwrap();
    sealed(whole.path(), &plan).unwrap();
    let all = |directory: &Path| -> Vec<Vec<u8>> {
        let names = ["t/manifest.json", "t/rig/case-0001/readings.csv", "t.key.jsonl"];
        names.iter().map(|name| files::read_bytes(&directory.join(name)).unwrap()).collect()
    };
    for kind in [Fault::Once, Fault::From] {
        for count in 1.. {
            let directory = tempfile::tempdir().unwrap();
            let (staged, is_struck) = with(kind(count), || sealed(directory.path(), &plan));
            if kind(count) == Fault::Once(count) && staged.is_err() {
                let left = files::names_in(directory.path());
                assert!(left.is_empty(), "{count}: {left:?}");
            }
            if staged.is_err() {
                // whoever goes on need not know the seed
                let begun = files::names_in(directory.path()).iter().any(|name| name == "t.key.jsonl.part");
                let plan = Plan { seed: plan.seed.filter(|_| !begun), ..plan.clone() };
                sealed(directory.path(), &plan).unwrap();
            }
            assert_eq!(all(directory.path()), all(whole.path()), "{:?}", kind(count));
            // what was left to be swept goes with the refusal
            assert!(matches!(sealed(directory.path(), &plan), Err(Error::InTheWay { .. })));
            assert_eq!(files::names_in(directory.path()), ["t", "t.key.jsonl"], "{:?}", kind(count));
            if !is_struck {
                assert!(count > 20, "only {count} operations");
                break;
            }
        }
    }
}

#[test]
fn a_trial_goes_on_case_by_case_and_no_other_in_its_place() {
    let (whole, directory) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let (whole, directory) = (whole.path(), directory.path());
    sealed(whole, &plan(5)).unwrap();
    // two cases and half of the third
    let staged = make(&directory.join("t"), &directory.join("t.key.jsonl"), &plan(5), || {}).unwrap();
    let kept = files::read_text(&staged.part.truths).unwrap();
    std::mem::forget(staged);
    let cut = kept.rfind("{\"case\"").unwrap() + 30;
    files::write_whole(&directory.join("t.key.jsonl.part"), &kept.as_bytes()[..cut]).unwrap();
    files::write_whole(&directory.join("t.part/rig/case-0003/rod.toml"), b"half").unwrap();
    let refused = sealed(directory, &plan(6)).unwrap_err().to_string();
    assert!(refused.contains("another trial"), "{refused}");
    sealed(directory, &Plan { seed: None, ..plan(0) }).unwrap();
    assert_eq!(bytes(directory), bytes(whole));
}

#[test]
fn what_was_dropped_added_or_changed_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let directory = directory.path();
    let (trial, key) = (directory.join("t"), directory.join("t.key.jsonl"));
    let manifest = sealed(directory, &plan(5)).unwrap();
    let check = |manifest: &Manifest| {
        manifest.check_directory(&trial)?;
        manifest.case_names().iter().try_for_each(|case| manifest.check_case(&trial, case))?;
        manifest.read_key(&trial, &key).map(drop)
    };
    check(&manifest).unwrap();
    let refused = |manifest: &Manifest, says: &str| {
        let error = check(manifest).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    };
    // a manifest without a case, which would fit what is there otherwise
    let whole = files::read_bytes(&trial.join(MANIFEST)).unwrap();
    let mut dropped = manifest.clone();
    dropped.files.retain(|name, _| !name.starts_with("rig/case-0002"));
    dropped.cases = 2;
    files::write_whole(&trial.join(MANIFEST), text_of(&dropped).unwrap().as_bytes()).unwrap();
    refused(&Manifest::read(&trial).unwrap(), "rig/case-0002: it is not in the manifest");
    files::move_to(&trial.join("rig/case-0002"), &directory.join("away")).unwrap();
    refused(&Manifest::read(&trial).unwrap(), "manifest.json: its SHA-256 is");
    files::write_whole(&trial.join(MANIFEST), &whole).unwrap();
    refused(&manifest, "cannot read");
    files::move_to(&directory.join("away"), &trial.join("rig/case-0002")).unwrap();
    // more than was sealed, less, and a link to the same
    let added = trial.join("rig/case-0002/rod-9.toml");
    files::write_whole(&added, b"x").unwrap();
    refused(&manifest, "rod-9.toml: it is not in the manifest");
    files::remove_tree(&added);
    let readings = trial.join("rig/case-0002/readings.csv");
    files::move_to(&readings, &directory.join("readings.csv")).unwrap();
    std::os::unix::fs::symlink(directory.join("readings.csv"), &readings).unwrap();
    refused(&manifest, "readings.csv: this is a link");
    files::remove_tree(&readings);
    files::move_to(&directory.join("readings.csv"), &readings).unwrap();
    check(&manifest).unwrap();
    let text = files::read_text(&key).unwrap();
    let (head, cases) = text.split_once('\n').unwrap();
    let cut: Vec<&str> = cases.lines().take(2).collect();
    // a key is never replaced
    files::remove_tree(&key);
    files::write_whole(&key, format!("{head}\n{}\n", cut.join("\n")).as_bytes()).unwrap();
    refused(&manifest, "key.jsonl: its SHA-256 is");
    // of a former version
    files::remove_tree(&key);
    files::write_whole(&key, cases.as_bytes()).unwrap();
    assert!(!manifest.read_key(&trial, &key).unwrap().1);
}
