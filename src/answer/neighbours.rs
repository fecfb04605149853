//! Files that stand beside those of a recording: one of them may have been meant.

use std::path::{Path, PathBuf};

use crate::calibration::Campaign;
use crate::diagnosis::calibration::Neighbours;
use crate::files;
use crate::robot::Robot;
use crate::rod::Rod;

/// More files than these in one directory are not compared.
const MOST: usize = 50;

/// The rods and robots in the folders of a campaign's own, by their names relative to the campaign.
///
/// ```
/// use rodcal::answer::neighbours;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let beside = neighbours(&campaign);
/// assert_eq!(beside.rods.len(), 6 - 1); // rods/1.toml to 6.toml, but for its own
/// assert!(beside.robots.is_empty()); // its robot is none of a file
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn neighbours(campaign: &Campaign) -> Neighbours {
    let directory = Path::new(&campaign.file).parent().unwrap_or(Path::new(""));
    let beside = |name: &str| -> Vec<(String, PathBuf)> {
        let own = Path::new(name);
        let paths = files::beside(&directory.join(own)).into_iter().take(MOST);
        let named = |path: PathBuf| {
            let name = own.with_file_name(path.file_name()?).to_string_lossy().into_owned();
            Some((name, path))
        };
        paths.filter_map(named).collect()
    };
    let rod = |(name, path): (String, PathBuf)| Some((name, Rod::read(&path).ok()?));
    let robot = |(name, path): (String, PathBuf)| {
        let text = files::read_text(&path).ok()?;
        let (base, tip) = (campaign.base_link.as_deref(), campaign.tip_link.as_deref());
        let robot = Robot::from_text(&name, &text, base, tip).ok()?;
        Some((name, robot, text))
    };
    let is_file = !campaign.robot_file.starts_with("builtin:");
    Neighbours {
        rods: campaign.rod_file.iter().flat_map(|name| beside(name)).filter_map(rod).collect(),
        robots: match is_file {
            true => beside(&campaign.robot_file).into_iter().filter_map(robot).collect(),
            false => Vec::new(),
        },
    }
}

/// The rods whose files stand beside `file`, by their file names: one of them may have been on the
/// rig.
///
/// ```
/// use rodcal::answer::rods_beside;
///
/// let names: Vec<String> = rods_beside("rods/5.toml".as_ref()).into_iter().map(|(name, _)| name).collect();
/// assert_eq!(names, ["1.toml", "2.toml", "3.toml", "4.toml", "6.toml"]);
/// ```
pub fn rods_beside(file: &Path) -> Vec<(String, Rod)> {
    let named = |path: PathBuf| {
        let name = path.file_name()?.to_string_lossy().into_owned();
        Some((name, Rod::read(&path).ok()?))
    };
    files::beside(file).into_iter().take(MOST).filter_map(named).collect()
}
