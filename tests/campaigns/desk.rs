//! A campaign whose files lie on a desk instead of a disk, so that a test can spoil any of them.

#![allow(dead_code)] // each test uses its part

use rodcal::calibration::Campaign;
use rodcal::error::{Error, Place, Result};

/// Turns, turns, slides.
const ROBOT: &str = r#"
name = "SCARA"
[[joint]]
d_mm = 300
a_mm = 250
alpha_deg = 0
limits_deg = [-130, 130]
[[joint]]
d_mm = 0
a_mm = 200
alpha_deg = 180
[[joint]]
type = "prismatic"
d_mm = 0
a_mm = 0
alpha_deg = 0
limits_mm = [-10, 150]
"#;

const ROD: &str = r#"
[geometry]
l1_mm = 150
l2_mm = 525
[material.steel]
youngs_modulus_gpa = 193
shear_modulus_gpa = 74.8
density_kg_m3 = 7930
[pipe1]
material = "steel"
outer_diameter_mm = 16
inner_diameter_mm = 12
[pipe2]
material = "steel"
outer_diameter_mm = 16
inner_diameter_mm = 12
"#;

const RIG: &str = "axis,load_n,dz_um\nz,5,600\nz,10,1200\n";

/// Two clamps, the second turned by a quarter about z.
const CLAMPS: &str = r#"robot = "robot.toml"
rod = "rod.toml"
rig = "rig.csv"
contact_force_n = [1.1, 1.25, 1.05]
measurements = "measurements.csv"
validation = "validation.csv"
[base]
xyz_mm = [10, 20, 30]
rpy_deg = [0, 0, 90]
[[clamp]]
id = "1"
xyz_mm = [400, 0, 100]
[[clamp]]
id = "2"
xyz_mm = [0, 400, 100]
rpy_deg = [0, 0, 90]
[noise]
position_um = 5
[parameters]
fix = ["d2", "theta1_deg"]
free = ["c1_urad_per_nm"]
[[prior]]
parameter = "a1_mm"
value = 250.5
sd = 0.1
"#;

const CLAMPED: &str = "\
pose,clamp,q1_deg,q2_deg,q3_mm,x_mm,y_mm,z_mm,time_s,temperature_c
1,1,10,20,30,0.1,0.2,0.3,0,20.5
2,1,20,40,50,0.2,0.1,0.3,60,
1,2,-30,-60,70,1,2,3,120,21
";

const VALIDATION: &str = "\
pose,q1_deg,q2_deg,q3_mm,x_mm,y_mm,z_mm
a,15,25,35,400,100,200
b,25,45,55,300,200,180
";

const TRACKER: &str = "robot = \"robot.toml\"\nmeasurements = \"measurements.csv\"\n";

const SOCKETS: &str = r#"robot = "robot.toml"
measurements = "measurements.csv"
[sockets]
distance_mm = 50
"#;

const SOCKETED: &str = "\
pose,placement,socket,q1_deg,q2_deg,q3_mm
1,front,0,10,20,30
2,front,0,20,40,50
3,front,1,30,60,70
4,left,1,40,80,90
5,left,0,50,70,95
6,back,0,60,75,99
";

/// The files of a campaign by name.
#[derive(Debug, Clone)]
pub struct Desk(Vec<(&'static str, String)>);

impl Desk {
    /// Everything that a campaign can have.
    pub fn with_clamps() -> Desk {
        Desk::of(&[
            ("campaign.toml", CLAMPS),
            ("robot.toml", ROBOT),
            ("rod.toml", ROD),
            ("rig.csv", RIG),
            ("measurements.csv", CLAMPED),
            ("validation.csv", VALIDATION),
        ])
    }

    /// As little as a campaign can have.
    pub fn with_tracker() -> Desk {
        Desk::of(&[("campaign.toml", TRACKER), ("robot.toml", ROBOT), ("measurements.csv", VALIDATION)])
    }

    /// Joint angles only.
    pub fn with_sockets() -> Desk {
        Desk::of(&[("campaign.toml", SOCKETS), ("robot.toml", ROBOT), ("measurements.csv", SOCKETED)])
    }

    fn of(files: &[(&'static str, &str)]) -> Desk {
        Desk(files.iter().map(|&(name, text)| (name, text.to_owned())).collect())
    }

    /// With the first `piece` of a file replaced.
    pub fn but(mut self, file: &str, piece: &str, other: &str) -> Desk {
        let text = self.text(file);
        assert!(text.contains(piece), "{file} has no {piece:?}");
        *text = text.replacen(piece, other, 1);
        self
    }

    /// With the file of the fully equipped campaign added, should it not be there.
    pub fn beside(mut self, file: &str) -> Desk {
        if self.0.iter().all(|(name, _)| *name != file) {
            self.0.extend(Desk::with_clamps().0.into_iter().filter(|(name, _)| *name == file));
        }
        self
    }

    /// The text of a file.
    pub fn text(&mut self, file: &str) -> &mut String {
        self.try_text(file).unwrap_or_else(|| panic!("there is no {file}"))
    }

    /// The text of a file, if there is one.
    pub fn try_text(&mut self, file: &str) -> Option<&mut String> {
        self.0.iter_mut().find(|(name, _)| *name == file).map(|(_, text)| text)
    }

    /// Reads the campaign.
    pub fn read(&self) -> Result<Campaign> {
        let open = |name: &str| match self.0.iter().find(|(known, _)| *known == name) {
            Some((_, text)) => Ok(text.clone()),
            None => Err(Error::Input {
                at: Place::whole_file(name),
                found: "no such file".to_owned(),
                expected: "one on the desk".to_owned(),
                hint: None,
            }),
        };
        Campaign::from_texts("campaign.toml", &self.0[0].1, &open)
    }

    /// The message, and the hint after an arrow.
    pub fn refusal(&self) -> String {
        let error = self.read().expect_err(&format!("{self:?}"));
        match error.hint() {
            Some(hint) => format!("{error} -> {hint}"),
            None => error.to_string(),
        }
    }

    /// What the campaign is warned about.
    pub fn warnings(&self) -> Vec<String> {
        let campaign = self.read().unwrap_or_else(|error| panic!("{error}: {self:?}"));
        campaign.warnings.iter().map(ToString::to_string).collect()
    }
}
