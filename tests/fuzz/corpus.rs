//! What the mutations begin with: small, and with every key or column that a reader knows.

use std::sync::LazyLock;

use rodcal::design::{DesignSpace, Search, Searched};

pub const ROD: &str = include_str!("../bad_rods/good.toml");
const ROBOT: &str = include_str!("../bad_robots/good.toml");
const URDF: &str = include_str!("../bad_robots/good.urdf");
pub const DESIGN: &str = "[geometry]\nl1_mm = { from = 100, to = 120, step = 10 }\nl2_mm = [300, 400]\n\
    gamma_deg = 90\n[catalogue]\nfile = \"t.csv\"\n[tip]\nmass_g = 20\n[constraints]\nmax_mass_g = 700\n\
    [objectives]\nminimise = [\"c_rod_um\"]\nmaximise = [\"reach_mm\"]\n";
pub const TUBES: &str =
    "name,material,outer_diameter_mm,inner_diameter_mm\na,steel,30,28\nb,aluminium,40,36\n";
pub const READINGS: &str = "# noise_um = 2\naxis,load_n,trial,phase,time_s,temperature_c,dx_um,dy_um,dz_um\n\
    y,5,1,load,0,20,1,200,0\ny,10,1,load,60,20.5,2,401,0\ny,5,1,unload,120,21,1,203,0\n-z,5,2,load,180,21,0,1,-90\n\
    -z,10,2,load,240,21,0,1,-181\n";
pub const CAMPAIGN: &str = "robot = \"builtin:tx90\"\nmeasurements = \"m.csv\"\ncontact_force_n = [1, 1.2, 1]\n\
    rod = \"rod.toml\"\nrig = \"readings.csv\"\n[base]\nxyz_mm = [-620, 30, -160]\nrpy_deg = [0, 0, 0]\n\
    [noise]\nposition_um = 20\n[parameters]\nfix = [\"d2_mm\"]\n";
pub const POSES: &str = "pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,x_mm,y_mm,z_mm\n\
    home,0,0,90,0,0,0,900,-50,350\n=b,10,-20,90,5,6,7,910.5,-60,300\nc,-1e-3,2,3,4,5,6,1,2,3\n";
const CORRECTIONS: &str = "joint,angle_deg,correction_urad\n1,0,5\n1,90,-5\n2,0,1\n2,10,2\n";
const RESULT: &str = "{\"provenance\": {\"command\": \"rodcal rig fit a b\", \"program\": \"rodcal 0.1.0\", \
    \"inputs\": [{\"file\": \"a\", \"sha256\": \"00\"}]}, \"slopes\": [], \"warnings\": []}";
const EFFECTS: &str = "[[effect]]\nname = \"foot\"\nwords = \"a rubber foot\"\nplace = \"clamp\"\nvariable = \"load\"\n\
    law = \"a_um*(1 - exp(-F/b_n))\"\nparameter = [{ name = \"a_um\", size = 20 }, \
    { name = \"b_n\", neutral = 5, size = 2, low = 0.5 }]\n";

/// A search of [`DESIGN`], as it is kept.
static KEPT: LazyLock<String> = LazyLock::new(|| {
    let space = DesignSpace::from_toml("d", DESIGN, &|name| Ok((name.to_owned(), TUBES.to_owned()))).unwrap();
    let mut search = Search::new(&space, Searched::All).unwrap();
    search.go_on(&|_| {}).unwrap();
    search.to_text()
});
const MANIFEST: &str = "{\"made_by\": \"rodcal 0.1.0\", \"cases\": 1, \"key_sha256\": \"00\", \"files\": \
    {\"rig/case-0001/rod.toml\": \"11\", \"rig/case-0001/readings.csv\": \"22\"}}";
const ANSWERS: &str = "{\"case\":\"rig/case-0001\",\"answer\":{\"verdict\":\"consistent\",\"findings\":[]},\
    \"sha256\":{\"rig/case-0001/rod.toml\":\"11\"}}\n";
const RESIDUALS: &str = "row,residual\n1,0.5\n2,-1.25\n3,0\n4,2e-1\n5,3\n6,1\n7,-1\n8,2\n9,-2\n10,0.1\n";

pub static CORPUS: LazyLock<[&str; 15]> = LazyLock::new(|| {
    [
        ROD,
        ROBOT,
        URDF,
        DESIGN,
        TUBES,
        READINGS,
        CAMPAIGN,
        POSES,
        CORRECTIONS,
        RESULT,
        EFFECTS,
        &KEPT,
        MANIFEST,
        ANSWERS,
        RESIDUALS,
    ]
});
