//! Every mistake and the message that it gets.

use std::path::Path;

use rodcal::error::Error;
use rodcal::files::text_of_bytes;
use rodcal::rod::Rod;

use super::{GOOD, changed, read};

/// The message, and the hint after an arrow.
fn in_words(error: &Error) -> String {
    match error.hint() {
        Some(hint) => format!("{error} -> {hint}"),
        None => error.to_string(),
    }
}

/// Every case: the piece of the good file, what stands there instead, and the message that it
/// gives.
fn check(cases: &[(&str, &str, &str)]) {
    for (piece, wrong, expected) in cases {
        let text = changed(&[(piece, wrong)]);
        assert_eq!(in_words(&read(&text).expect_err(&text)), *expected, "{wrong}");
    }
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let missing = Rod::read(Path::new("no/such/rod.toml")).expect_err("there is no such file");
    assert!(missing.to_string().starts_with("cannot read no/such/rod.toml: "), "{missing}");
    let directory = tempfile::tempdir().expect("a directory");
    let error = Rod::read(directory.path()).expect_err("a directory is no file");
    assert!(matches!(error, Error::File { action: "read", .. }), "{error}");

    let latin_1 = text_of_bytes("rod.toml", b"[geometry]\n# \xB5m\n".to_vec()).expect_err("not UTF-8");
    assert_eq!(
        in_words(&latin_1),
        "rod.toml:2:3: byte 0xB5, which is \"µ\" in Latin-1 (Windows-1252), expected UTF-8 text -> save the file as UTF-8 (in Excel: \"CSV UTF-8\")"
    );
}

#[test]
fn a_value_that_is_no_number_says_how_to_write_it() {
    let cases = [
        (
            "l1_mm = 150.0",
            "l1_mm = 5e-324",
            "rod.toml:5:9: `geometry.l1_mm` is 5e-324, expected a number of at least 1e-290",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm = \"150\"",
            "rod.toml:5:9: `geometry.l1_mm` is \"150\", expected a number -> write 150.0",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm = \"long\"",
            "rod.toml:5:9: `geometry.l1_mm` is \"long\", expected a number",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm = 150,5",
            "rod.toml:5:9: `geometry.l1_mm` is 150,5, expected a number -> write 150.5",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm = 1,500",
            "rod.toml:5:9: `geometry.l1_mm` is 1,500, expected a number -> write a decimal point, and nothing between thousands",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm = 150 mm",
            "rod.toml:5:9: `geometry.l1_mm` is 150 mm, expected a number -> write the number alone; its unit stands in the name of the key",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm = .5",
            "rod.toml:5:9: `geometry.l1_mm` is .5, expected a number -> write 0.5",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm = 0150",
            "rod.toml:5:9: `geometry.l1_mm` is 0150, expected a number -> write 150.0",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm =",
            "rod.toml:5:8: `geometry.l1_mm` is blank, expected a value behind the =",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm = # later",
            "rod.toml:5:9: `geometry.l1_mm` is blank, expected a value behind the =",
        ),
        ("l1_mm = 150.0", "l1_mm = true", "rod.toml:5:9: `geometry.l1_mm` is true, expected a number"),
        ("l1_mm = 150.0", "l1_mm = [150.0]", "rod.toml:5:9: `geometry.l1_mm` is [150.0], expected a number"),
        (
            "l1_mm = 150.0",
            "l1_mm = 99999999999999999999999",
            "rod.toml:5:9: `geometry.l1_mm` is 99999999999999999999999, expected a number -> write 1e23",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm = 1e999",
            "rod.toml:5:9: `geometry.l1_mm` is 1e999, expected a finite number",
        ),
        ("l1_mm = 150.0", "l1_mm = NaN", "rod.toml:5:9: `geometry.l1_mm` is NaN, expected a finite number"),
        (
            "ply_angles_deg = [0.0, 45.0, -45.0, 0.0]",
            "ply_angles_deg = [0.0, \"45\"]",
            "rod.toml:21:24: `material.carbon.ply_angles_deg` is \"45\", expected a number -> write 45.0",
        ),
        (
            "ply_angles_deg = [0.0, 45.0, -45.0, 0.0]",
            "ply_angles_deg = 45",
            "rod.toml:21:18: `material.carbon.ply_angles_deg` is 45, expected a list in brackets",
        ),
        (
            "ply_angles_deg = [0.0, 45.0, -45.0, 0.0]",
            "ply_angles_deg = [\n  0.0, # axial\n  x\n]",
            "rod.toml:23:3: x, expected a number, or a text in quotes",
        ),
        ("name = \"5#\"", "name = 5", "rod.toml:1:8: `name` is 5, expected a text in quotes"),
        (
            "material = \"steel\"",
            "material = steel",
            "rod.toml:24:12: `pipe1.material` is steel, expected a number, or a text in quotes",
        ),
        (
            "material = \"steel\"",
            "material = 5",
            "rod.toml:24:12: `pipe1.material` is 5, expected a text in quotes",
        ),
    ];
    check(&cases);
}

#[test]
fn a_key_or_section_that_is_not_known_is_named_with_its_neighbour() {
    let cases = [
        (
            "name = \"5#\"",
            "nmae = \"5#\"",
            "rod.toml:1:1: unknown key `nmae`, expected one of name, source, linear_range_n, geometry, material, pipe1, pipe2, bend, tip, mass, joint, sleeve, law, standard_uncertainty -> if it belongs to a section, write it below that section's [header]",
        ),
        (
            "name = \"5#\"",
            "operator = \"Ann\"",
            "rod.toml:1:1: unknown key `operator`, expected one of name, source, linear_range_n, geometry, material, pipe1, pipe2, bend, tip, mass, joint, sleeve, law, standard_uncertainty -> if it belongs to a section, write it below that section's [header]",
        ),
        (
            "l1_mm = 150.0",
            "l1 = 150.0",
            "rod.toml:5:1: unknown key `l1`, expected one of l1_mm, l2_mm, gamma_deg, bend_radius_mm, bend_flexibility -> did you mean l1_mm?",
        ),
        (
            "l1_mm = 150.0",
            "L1_mm = 150.0",
            "rod.toml:5:1: unknown key `L1_mm`, expected one of l1_mm, l2_mm, gamma_deg, bend_radius_mm, bend_flexibility -> did you mean l1_mm?",
        ),
        (
            "l1_mm = 150.0",
            "l1_m = 0.15",
            "rod.toml:5:1: unknown key `l1_m`, expected one of l1_mm, l2_mm, gamma_deg, bend_radius_mm, bend_flexibility -> did you mean l1_mm?",
        ),
        (
            "gamma_deg = 90.0",
            "angle = 90.0",
            "rod.toml:7:1: unknown key `angle`, expected one of l1_mm, l2_mm, gamma_deg, bend_radius_mm, bend_flexibility",
        ),
        (
            "density_kg_m3 = 7930.0",
            "density_g_cm3 = 7.93",
            "rod.toml:12:1: unknown key `density_g_cm3`, expected one of density_kg_m3, youngs_modulus_gpa, shear_modulus_gpa, poisson_ratio, ply_e1_gpa, ply_e2_gpa, ply_g12_gpa, ply_nu12, ply_thickness_mm, ply_angles_deg, yield_strength_mpa, shear_coefficient_factor, youngs_modulus_percent, shear_modulus_percent, density_percent, shear_coefficient_percent -> did you mean density_kg_m3?",
        ),
        (
            "poisson_ratio = 0.29",
            "poissons_ratio = 0.29",
            "rod.toml:11:1: unknown key `poissons_ratio`, expected one of density_kg_m3, youngs_modulus_gpa, shear_modulus_gpa, poisson_ratio, ply_e1_gpa, ply_e2_gpa, ply_g12_gpa, ply_nu12, ply_thickness_mm, ply_angles_deg, yield_strength_mpa, shear_coefficient_factor, youngs_modulus_percent, shear_modulus_percent, density_percent, shear_coefficient_percent -> did you mean poisson_ratio?",
        ),
        (
            "[geometry]",
            "[geometri]",
            "rod.toml:4:2: unknown section [geometri], expected one of name, source, linear_range_n, geometry, material, pipe1, pipe2, bend, tip, mass, joint, sleeve, law, standard_uncertainty -> did you mean [geometry]?",
        ),
        (
            "[geometry]\n",
            "",
            "rod.toml:6:1: unknown key `gamma_deg`, expected one of name, source, linear_range_n, geometry, material, pipe1, pipe2, bend, tip, mass, joint, sleeve, law, standard_uncertainty -> if it belongs to a section, write it below that section's [header]",
        ),
        (
            "[tip]",
            "[Tip]",
            "rod.toml:33:2: unknown section [Tip], expected one of name, source, linear_range_n, geometry, material, pipe1, pipe2, bend, tip, mass, joint, sleeve, law, standard_uncertainty -> did you mean [tip]?",
        ),
        (
            "[pipe2]",
            "[pipe3]",
            "rod.toml:28:2: unknown section [pipe3], expected one of name, source, linear_range_n, geometry, material, pipe1, pipe2, bend, tip, mass, joint, sleeve, law, standard_uncertainty -> did you mean [pipe1]?",
        ),
        (
            "[material.steel]",
            "[materials.steel]",
            "rod.toml:9:2: unknown section [materials], expected one of name, source, linear_range_n, geometry, material, pipe1, pipe2, bend, tip, mass, joint, sleeve, law, standard_uncertainty -> did you mean [material]?",
        ),
        (
            "station_mm = 300.0",
            "position_mm = 300.0",
            "rod.toml:47:1: unknown key `position_mm`, expected one of name, station_mm, bending_urad_per_nm, torsion_urad_per_nm",
        ),
    ];
    check(&cases);
}

#[test]
fn a_key_or_section_that_is_missing_is_described() {
    let cases = [
        (
            "l1_mm = 150.0",
            "",
            "rod.toml:4:1: there is no l1_mm in [geometry], expected the length from the flange to the corner in mm",
        ),
        (
            "[pipe1]\nmaterial = \"steel\"\nouter_diameter_mm = 16.0\ninner_diameter_mm = 12.0\n",
            "",
            "rod.toml: there is no [pipe1], expected a section [pipe1] (flange to bend) with material, outer_diameter_mm, inner_diameter_mm",
        ),
        (
            "[material.steel]\nyoungs_modulus_gpa = 193.0\npoisson_ratio = 0.29\ndensity_kg_m3 = 7930.0\n",
            "",
            "rod.toml:20:12: `pipe1.material` is \"steel\", expected one of the file's materials: \"carbon\"",
        ),
        (
            "density_kg_m3 = 7930.0",
            "",
            "rod.toml:9:1: there is no density_kg_m3 in [material.steel], expected the density in kg/m³",
        ),
        (
            "youngs_modulus_gpa = 193.0",
            "",
            "rod.toml:9:1: material `steel` has no youngs_modulus_gpa, expected youngs_modulus_gpa, or for a laminate all of ply_e1_gpa, ply_e2_gpa, ply_g12_gpa, ply_nu12, ply_thickness_mm, ply_angles_deg",
        ),
        (
            "outer_diameter_mm = 16.0",
            "",
            "rod.toml:23:1: there is no outer_diameter_mm in [pipe1], expected the outer diameter in mm",
        ),
        ("mass_g = 55.0", "", "rod.toml:33:1: there is no mass_g in [tip], expected the mass in g"),
        ("name = \"ring\"", "", "rod.toml:36:1: there is no name in [[mass]], expected a name in quotes"),
        (
            "station_mm = 300.0",
            "",
            "rod.toml:45:1: there is no station_mm in [[joint]], expected the distance from the flange along the centreline in mm",
        ),
        (
            "name = \"sleeve-b\"",
            "",
            "rod.toml:45:1: there is no name in [[joint]], expected a name in quotes",
        ),
        (
            "[tip]\nmass_g = 55.0",
            "[bend]\nouter_diameter_mm = 16.0",
            "rod.toml:33:1: there is no material in [bend], expected the name of one of the file's materials",
        ),
        (
            "ply_nu12 = 0.28\n",
            "",
            "rod.toml:14:1: laminate `carbon` has no ply_nu12, expected all of ply_e1_gpa, ply_e2_gpa, ply_g12_gpa, ply_nu12, ply_thickness_mm, ply_angles_deg",
        ),
        (
            "ply_angles_deg = [0.0, 45.0, -45.0, 0.0]",
            "",
            "rod.toml:14:1: laminate `carbon` has no ply_angles_deg, expected all of ply_e1_gpa, ply_e2_gpa, ply_g12_gpa, ply_nu12, ply_thickness_mm, ply_angles_deg",
        ),
        (
            "ply_e1_gpa = 181.0\n",
            "",
            "rod.toml:14:1: laminate `carbon` has no ply_e1_gpa, expected all of ply_e1_gpa, ply_e2_gpa, ply_g12_gpa, ply_nu12, ply_thickness_mm, ply_angles_deg",
        ),
    ];
    check(&cases);
}

#[test]
fn a_key_or_section_that_is_misplaced_or_repeated_is_named() {
    let cases = [
        (
            "l1_mm = 150.0",
            "l1_mm = 150.0\nl1_mm = 151.0",
            "rod.toml:6:1: a second `l1_mm`, expected every key once in its section",
        ),
        ("[pipe2]", "[pipe1]", "rod.toml:28:2: a second section [pipe1], expected every section once"),
        (
            "[[mass]]",
            "[mass]",
            "rod.toml:36:1: [mass], expected [[mass]] in double brackets, there may be several",
        ),
        ("[[joint]]", "[joint]", "rod.toml:45:3: a second section [joint], expected every section once"),
        (
            "[tip]",
            "[[tip]]",
            "rod.toml:33:1: [[tip]], expected [tip] in single brackets, there can be only one",
        ),
        (
            "[geometry]",
            "[[geometry]]",
            "rod.toml:4:1: [[geometry]], expected [geometry] in single brackets, there can be only one",
        ),
        (
            "[material.steel]",
            "[[material.steel]]",
            "rod.toml:9:1: [[material.steel]], expected [material.steel] in single brackets, there can be only one",
        ),
        (
            "[material.steel]",
            "[material]",
            "rod.toml:12:17: `material.density_kg_m3` is 7930.0, expected a section [material.NAME], NAME being any name",
        ),
        (
            "[geometry]",
            "geometry = 5\n[geometri]",
            "rod.toml:5:2: unknown section [geometri], expected one of name, source, linear_range_n, geometry, material, pipe1, pipe2, bend, tip, mass, joint, sleeve, law, standard_uncertainty -> did you mean [geometry]?",
        ),
        (
            "[tip]\nmass_g = 55.0",
            "[tip.ball]\nmass_g = 55.0",
            "rod.toml:33:6: unknown section [ball], expected one of mass_g",
        ),
        (
            "linear_range_n = 20",
            "tip = 55.0",
            "rod.toml:33:2: a second section [tip], expected every section once",
        ),
        (
            "name = \"sleeve-b\"",
            "name = \"sleeve-a\"",
            "rod.toml:46:8: a second joint is named \"sleeve-a\", expected a name of its own for each joint",
        ),
    ];
    check(&cases);
}

#[test]
fn a_number_out_of_its_domain_says_which_domain() {
    let cases = [
        (
            "l1_mm = 150.0",
            "l1_mm = -150.0",
            "rod.toml:5:9: `geometry.l1_mm` is -150.0, expected a number > 0",
        ),
        ("l1_mm = 150.0", "l1_mm = 0", "rod.toml:5:9: `geometry.l1_mm` is 0, expected a number > 0"),
        ("l1_mm = 150.0", "l1_mm = nan", "rod.toml:5:9: `geometry.l1_mm` is nan, expected a finite number"),
        ("l1_mm = 150.0", "l1_mm = -inf", "rod.toml:5:9: `geometry.l1_mm` is -inf, expected a finite number"),
        (
            "l1_mm = 150.0",
            "l1_mm = 1e308",
            "rod.toml:5:9: `geometry.l1_mm` is 1e308, expected a number of at most 1e30 in size",
        ),
        (
            "linear_range_n = 20",
            "linear_range_n = 0",
            "rod.toml:2:18: `linear_range_n` is 0, expected a number > 0",
        ),
        (
            "gamma_deg = 90.0",
            "gamma_deg = 0",
            "rod.toml:7:13: `geometry.gamma_deg` is 0, expected the inside angle between the pipes in degrees, 0 < gamma_deg <= 180 (180 is a straight rod)",
        ),
        (
            "gamma_deg = 90.0",
            "gamma_deg = 181",
            "rod.toml:7:13: `geometry.gamma_deg` is 181, expected the inside angle between the pipes in degrees, 0 < gamma_deg <= 180 (180 is a straight rod)",
        ),
        (
            "gamma_deg = 90.0",
            "gamma_deg = -90",
            "rod.toml:7:13: `geometry.gamma_deg` is -90, expected the inside angle between the pipes in degrees, 0 < gamma_deg <= 180 (180 is a straight rod)",
        ),
        (
            "gamma_deg = 90.0",
            "gamma_deg = nan",
            "rod.toml:7:13: `geometry.gamma_deg` is nan, expected a finite number",
        ),
        (
            "gamma_deg = 90.0",
            "bend_radius_mm = -1.0",
            "rod.toml:7:18: `geometry.bend_radius_mm` is -1.0, expected a number >= 0",
        ),
        (
            "gamma_deg = 90.0",
            "bend_radius_mm = 150.001",
            "rod.toml:7:18: `geometry.bend_radius_mm` is 150.001, expected at most 150 mm: the arc is tangent to both pipes and takes 150.0 mm off each, and the shorter one has 150.0 mm",
        ),
        (
            "gamma_deg = 90.0",
            "gamma_deg = 60\nbend_radius_mm = 100",
            "rod.toml:8:18: `geometry.bend_radius_mm` is 100, expected at most 86.602 mm: the arc is tangent to both pipes and takes 173.2 mm off each, and the shorter one has 150.0 mm",
        ),
        (
            "gamma_deg = 90.0",
            "bend_radius_mm = inf",
            "rod.toml:7:18: `geometry.bend_radius_mm` is inf, expected a finite number",
        ),
        (
            "gamma_deg = 90.0",
            "bend_flexibility = \"vonkarman\"",
            "rod.toml:7:20: `geometry.bend_flexibility` is \"vonkarman\", expected \"beam\", \"von-karman\", \"asme-b31.3\" or a factor > 0",
        ),
        (
            "gamma_deg = 90.0",
            "bend_flexibility = -2.0",
            "rod.toml:7:20: `geometry.bend_flexibility` is -2.0, expected a number > 0",
        ),
        (
            "gamma_deg = 90.0",
            "bend_flexibility = 0",
            "rod.toml:7:20: `geometry.bend_flexibility` is 0, expected a number > 0",
        ),
        (
            "gamma_deg = 90.0",
            "bend_flexibility = nan",
            "rod.toml:7:20: `geometry.bend_flexibility` is nan, expected a finite number",
        ),
        (
            "gamma_deg = 90.0",
            "bend_flexibility = false",
            "rod.toml:7:20: `geometry.bend_flexibility` is false, expected \"beam\", \"von-karman\", \"asme-b31.3\" or a factor > 0",
        ),
        (
            "youngs_modulus_gpa = 193.0",
            "youngs_modulus_gpa = 0",
            "rod.toml:10:22: `material.steel.youngs_modulus_gpa` is 0, expected a number > 0",
        ),
        (
            "youngs_modulus_gpa = 193.0",
            "youngs_modulus_gpa = -193.0",
            "rod.toml:10:22: `material.steel.youngs_modulus_gpa` is -193.0, expected a number > 0",
        ),
        (
            "youngs_modulus_gpa = 193.0",
            "youngs_modulus_gpa = 1e308",
            "rod.toml:10:22: `material.steel.youngs_modulus_gpa` is 1e308, expected a number of at most 1e30 in size",
        ),
        (
            "density_kg_m3 = 7930.0",
            "density_kg_m3 = -7930",
            "rod.toml:12:17: `material.steel.density_kg_m3` is -7930, expected a number >= 0",
        ),
        (
            "poisson_ratio = 0.29",
            "poisson_ratio = 0.6",
            "rod.toml:11:17: `material.steel.poisson_ratio` is 0.6, expected a Poisson's ratio, -1 < ν <= 0.5",
        ),
        (
            "poisson_ratio = 0.29",
            "poisson_ratio = -1",
            "rod.toml:11:17: `material.steel.poisson_ratio` is -1, expected a Poisson's ratio, -1 < ν <= 0.5",
        ),
        (
            "poisson_ratio = 0.29",
            "poisson_ratio = nan",
            "rod.toml:11:17: `material.steel.poisson_ratio` is nan, expected a finite number",
        ),
        (
            "poisson_ratio = 0.29",
            "shear_modulus_gpa = 0.0",
            "rod.toml:11:21: `material.steel.shear_modulus_gpa` is 0.0, expected a number > 0",
        ),
        (
            "outer_diameter_mm = 16.0",
            "outer_diameter_mm = 0",
            "rod.toml:25:21: `pipe1.outer_diameter_mm` is 0, expected a number > 0",
        ),
        (
            "inner_diameter_mm = 12.0",
            "inner_diameter_mm = 16.0",
            "rod.toml:26:21: `pipe1.inner_diameter_mm` is 16.0, expected less than the outer diameter, 16.0 mm",
        ),
        (
            "inner_diameter_mm = 12.0",
            "inner_diameter_mm = 17",
            "rod.toml:26:21: `pipe1.inner_diameter_mm` is 17, expected less than the outer diameter, 16.0 mm",
        ),
        (
            "inner_diameter_mm = 12.0",
            "inner_diameter_mm = -12.0",
            "rod.toml:26:21: `pipe1.inner_diameter_mm` is -12.0, expected a number >= 0",
        ),
        ("mass_g = 55.0", "mass_g = -55", "rod.toml:34:10: `tip.mass_g` is -55, expected a number >= 0"),
        ("mass_g = 30.0", "mass_g = inf", "rod.toml:39:10: `mass.mass_g` is inf, expected a finite number"),
        (
            "station_mm = 205.0",
            "station_mm = 675.1",
            "rod.toml:38:14: `mass.station_mm` is 675.1, expected a station on the rod, 0 to 675.000 mm (the tip)",
        ),
        (
            "station_mm = 205.0",
            "station_mm = -1.0",
            "rod.toml:38:14: `mass.station_mm` is -1.0, expected a station on the rod, 0 to 675.000 mm (the tip)",
        ),
        (
            "station_mm = 300.0",
            "station_mm = 3000",
            "rod.toml:47:14: `joint.station_mm` is 3000, expected a station on the rod, 0 to 675.000 mm (the tip)",
        ),
        (
            "station_mm = 300.0",
            "station_mm = 300.0\nbending_urad_per_nm = -1.0",
            "rod.toml:48:23: `joint.bending_urad_per_nm` is -1.0, expected a number >= 0",
        ),
        (
            "station_mm = 300.0",
            "station_mm = 300.0\ntorsion_urad_per_nm = nan",
            "rod.toml:48:23: `joint.torsion_urad_per_nm` is nan, expected a finite number",
        ),
    ];
    check(&cases);
}

#[test]
fn a_material_must_be_stated_in_one_way() {
    let cases = [
        (
            "material = \"steel\"\nouter_diameter_mm = 16.0\ninner_diameter_mm = 12.0\n",
            "material = \"stel\"\nouter_diameter_mm = 16.0\ninner_diameter_mm = 12.0\n",
            "rod.toml:24:12: `pipe1.material` is \"stel\", expected one of the file's materials: \"carbon\", \"steel\" -> did you mean \"steel\"?",
        ),
        (
            "material = \"steel\"\nouter_diameter_mm = 16.0\ninner_diameter_mm = 12.0\n",
            "material = \"titanium\"\nouter_diameter_mm = 16.0\ninner_diameter_mm = 12.0\n",
            "rod.toml:24:12: `pipe1.material` is \"titanium\", expected one of the file's materials: \"carbon\", \"steel\"",
        ),
        (
            "poisson_ratio = 0.29",
            "",
            "rod.toml:9:1: material `steel` has neither shear_modulus_gpa nor poisson_ratio, expected one of the two",
        ),
        (
            "youngs_modulus_gpa = 193.0",
            "shear_modulus_gpa = 74.8",
            "rod.toml:9:1: material `steel` has no youngs_modulus_gpa, expected youngs_modulus_gpa, or for a laminate all of ply_e1_gpa, ply_e2_gpa, ply_g12_gpa, ply_nu12, ply_thickness_mm, ply_angles_deg",
        ),
        (
            "ply_e1_gpa = 181.0",
            "ply_e1_gpa = 181.0\nyoungs_modulus_gpa = 193.0",
            "rod.toml:14:1: material `carbon` has ply_… keys and a modulus or ratio of its own, expected one of the two: the plies alone make E and G",
        ),
        (
            "poisson_ratio = 0.29",
            "poisson_ratio = 0.29\nply_thickness_mm = 0.5",
            "rod.toml:9:1: material `steel` has ply_… keys and a modulus or ratio of its own, expected one of the two: the plies alone make E and G",
        ),
        (
            "ply_angles_deg = [0.0, 45.0, -45.0, 0.0]",
            "ply_angles_deg = []",
            "rod.toml:21:18: `material.carbon.ply_angles_deg` is [], expected one angle for each ply, for example [0, 45, -45, 90]",
        ),
        (
            "ply_angles_deg = [0.0, 45.0, -45.0, 0.0]",
            "ply_angles_deg = [0.0, nan]",
            "rod.toml:21:24: `material.carbon.ply_angles_deg` is nan, expected a finite number",
        ),
        (
            "ply_nu12 = 0.28",
            "ply_nu12 = 4.3",
            "rod.toml:19:12: `material.carbon.ply_nu12` is 4.3, expected less than √(ply_e1_gpa / ply_e2_gpa), 4.192",
        ),
        (
            "ply_nu12 = 0.28",
            "ply_nu12 = 0",
            "rod.toml:19:12: `material.carbon.ply_nu12` is 0, expected a number > 0",
        ),
        (
            "ply_thickness_mm = 0.5",
            "ply_thickness_mm = -0.5",
            "rod.toml:20:20: `material.carbon.ply_thickness_mm` is -0.5, expected a number > 0",
        ),
        (
            "ply_e2_gpa = 10.3",
            "ply_e2_gpa = 0",
            "rod.toml:17:14: `material.carbon.ply_e2_gpa` is 0, expected a number > 0",
        ),
    ];
    check(&cases);
}

#[test]
fn text_that_is_no_rod_file_is_recognised() {
    let cases = [
        (
            "l1_mm = 150.0",
            "l1_mm 150.0",
            "rod.toml:5:7: the line `l1_mm 150.0`, expected key = value, or a [section]",
        ),
        (
            "l1_mm = 150.0",
            "l1_mm = 150.0 # \u{1}",
            "rod.toml:5:17: invalid comment character, expected printable characters",
        ),
        (
            "l1_mm = 150.0",
            "l1_µm = 150000.0",
            "rod.toml:5:4: invalid unquoted key, expected letters, numbers, `-`, `_`",
        ),
        ("[geometry]", "[geometry", "rod.toml:4:10: unclosed table, expected `]`"),
        ("name = \"5#\"", "name = \"5#", "rod.toml:1:11: invalid basic string, expected `\"`"),
        (GOOD, "", "rod.toml: the file is empty, expected a section [geometry] with l1_mm and l2_mm"),
        (
            GOOD,
            "\n# only a comment\n",
            "rod.toml: the file is empty, expected a section [geometry] with l1_mm and l2_mm",
        ),
        (
            GOOD,
            "axis,load_n,dz_um\nz,0,0\nz,5,12.5\n",
            "rod.toml:1:5: the line `axis,load_n,dz_um`, expected key = value, or a [section] -> is this a table of readings (CSV)?",
        ),
        (
            GOOD,
            "axis;load_n;dz_um\nz;0;0\n",
            "rod.toml:1:18: the line `axis;load_n;dz_um`, expected key = value, or a [section] -> is this a table of readings (CSV)?",
        ),
        (
            GOOD,
            "{\"geometry\": {\"l1_mm\": 150}}",
            "rod.toml:1:1: the line `{\"geometry\": {\"l1_mm\": 150}}`, expected key = value, or a [section]",
        ),
        (
            GOOD,
            "\0\0\0\0",
            "rod.toml:1:5: the line `\\x00\\x00\\x00\\x00`, expected key = value, or a [section]",
        ),
        (
            GOOD,
            "geometry:\n  l1_mm: 150\n",
            "rod.toml:1:10: the line `geometry:`, expected key = value, or a [section]",
        ),
    ];
    check(&cases);
}

#[test]
fn a_standard_uncertainty_is_a_number_from_0_on() {
    let cases = [
        (
            "station_mm = 300.0",
            "station_mm = 300.0\n[standard_uncertainty]\ndiameter_mm = -0.1",
            "rod.toml:49:15: `standard_uncertainty.diameter_mm` is -0.1, expected one standard deviation >= 0 (0 is exact)",
        ),
        (
            "station_mm = 300.0",
            "station_mm = 300.0\n[standard_uncertainty]\nshear_modulus_percent = nan",
            "rod.toml:49:25: `standard_uncertainty.shear_modulus_percent` is nan, expected a finite number",
        ),
        (
            "station_mm = 300.0",
            "station_mm = 300.0\n[standard_uncertainty]\nyoungs_modulus = 1",
            "rod.toml:49:1: unknown key `youngs_modulus`, expected one of youngs_modulus_percent, shear_modulus_percent, density_percent, shear_coefficient_percent, diameter_mm, length_mm, tip_mass_g, section_percent -> did you mean youngs_modulus_percent?",
        ),
        (
            "density_kg_m3 = 7930.0",
            "density_kg_m3 = 7930.0\nyoungs_modulus_percent = -1",
            "rod.toml:13:26: `material.steel.youngs_modulus_percent` is -1, expected one standard deviation >= 0 (0 is exact)",
        ),
        (
            "density_kg_m3 = 7930.0",
            "density_kg_m3 = 7930.0\ndensity_percent = 1000",
            "rod.toml:13:19: `material.steel.density_percent` is 1000, expected at most 100 per cent: what is known worse is not known",
        ),
    ];
    check(&cases);
}

#[test]
fn a_cross_section_is_stated_whole_and_in_one_way() {
    const ROUND: &str = "outer_diameter_mm = 20.0\ninner_diameter_mm = 16.0";
    let cases = [
        (
            ROUND,
            "",
            "rod.toml:28:1: [pipe2] has no cross-section, expected outer_diameter_mm and inner_diameter_mm, or width_mm and height_mm (wall_mm: a box), or area_mm2, iy_mm4, iz_mm4, j_mm4 and kappa",
        ),
        (
            ROUND,
            "width_mm = 10.0",
            "rod.toml:28:1: there is no height_mm in [pipe2], expected the side in the rod's plane in mm",
        ),
        (
            ROUND,
            "outer_diameter_mm = 20.0\nwidth_mm = 10.0",
            "rod.toml:28:1: [pipe2] has outer_diameter_mm, width_mm, expected one of the three: outer_diameter_mm and inner_diameter_mm; width_mm and height_mm (wall_mm: a box); area_mm2, iy_mm4, iz_mm4, j_mm4 and kappa",
        ),
        (
            ROUND,
            "width_mm = 10\nheight_mm = 20\nwall_mm = 5",
            "rod.toml:32:11: `pipe2.wall_mm` is 5, expected less than half of the shorter side, 5 mm",
        ),
        (
            ROUND,
            "width_mm = -10\nheight_mm = 20",
            "rod.toml:30:12: `pipe2.width_mm` is -10, expected a number > 0",
        ),
        (
            ROUND,
            "area_mm2 = 200\niy_mm4 = 6000\niz_mm4 = 2000\nkappa = 0.85",
            "rod.toml:28:1: there is no j_mm4 in [pipe2], expected the torsion constant in mm⁴",
        ),
        (
            ROUND,
            "area_mm2 = 200\niy_mm4 = 6000\niz_mm4 = 2000\nj_mm4 = 9000\nkappa = 0.85",
            "rod.toml:33:9: `pipe2.j_mm4` is 9000, expected at most iy_mm4 + iz_mm4 = 8000, the polar moment",
        ),
        (
            ROUND,
            "area_mm2 = 200\niy_mm4 = 6000\niz_mm4 = 2000\nj_mm4 = 4000\nkappa = 85",
            "rod.toml:34:9: `pipe2.kappa` is 85, expected a shear coefficient, 0 < κ <= 1.2 (5/6 for a rectangle)",
        ),
    ];
    check(&cases);
    let text = changed(&[
        ("gamma_deg = 90.0", "bend_radius_mm = 40\nbend_flexibility = \"von-karman\""),
        ("outer_diameter_mm = 16.0\ninner_diameter_mm = 12.0", "width_mm = 10\nheight_mm = 20"),
    ]);
    assert_eq!(
        in_words(&read(&text).expect_err(&text)),
        "rod.toml:8:20: `geometry.bend_flexibility` is \"von-karman\", expected \"beam\" or a factor > 0: \"von-karman\" and \"asme-b31.3\" are for round tubes, and the bend is none"
    );
}

/// A law has its formula, and its mistakes have the place of the formula's own letter.
#[test]
fn a_law_says_what_is_wrong_where_in_its_formula() {
    const LAW: &str = "[[law]]\nplace = \"root\"\nvariable = \"moment\"\nformula = \"k*max(M - M_0, 0)\"\n\
        range = [0.5, 6]\n[[law.constant]]\nname = \"k\"\nvalue = 12\n[[law.constant]]\nname = \"M_0\"\nvalue = 2\n\
        [tip]";
    let with_law = changed(&[("[tip]", LAW)]);
    let rod = read(&with_law).expect(&with_law);
    assert_eq!(
        rod.laws[0].to_string(),
        "Δθ = k*max(M - M_0, 0) in µrad at the root, k = 12.0, M_0 = 2.00, for M from 0.500 to 6.00 N·m"
    );
    for (piece, wrong, expected) in [
        (
            "M - M_0",
            "M - N_0",
            "rod.toml:36:22: \"N_0\" in the formula, expected one of M, side, k, M_0, or a function \
          (abs, sign, step, sqrt, exp, ln, log10, sin, cos, tan, atan, tanh of one number, min and max of two)",
        ),
        (
            "\"root\"",
            "\"foot\"",
            "rod.toml:34:9: `law.place` is \"foot\", expected one of rod, clamp, root, bend, slide, dx, \
          dy, dz, sleeve-a, sleeve-b",
        ),
        (
            "\"moment\"",
            "\"load\"",
            "rod.toml:35:12: `law.variable` is \"load\", expected a variable of root: moment",
        ),
        (
            "[0.5, 6]",
            "[6, 0.5]",
            "rod.toml:37:9: `law.range` is [6, 0.5], expected two numbers, [from, to]: where it was \
          recorded",
        ),
        (
            "name = \"k\"",
            "name = \"ln\"",
            "rod.toml:39:8: `law.constant.name` is \"ln\", expected a name of its own: letters, \
          digits and _, no variable and no function",
        ),
        (
            "k*max",
            "k/max",
            "rod.toml:36:11: `law.formula` is no number at M = 0.5, expected a formula that is defined in \
          its range",
        ),
        (
            "range = ",
            "memory = \"stop\"\nrange = ",
            "rod.toml:37:10: `law.memory` is \"stop\", expected with it a constant \
          r > 0",
        ),
        (
            "range = ",
            "memory = \"slip\"\nrange = ",
            "rod.toml:37:10: `law.memory` is \"slip\", expected \"stop\", \"play\", \"two_stops\", \
          \"three_stops\", \"bouc_wen\" or \"lag\"",
        ),
        (
            "range = [0.5, 6]\n",
            "memory = \"two_stops\"\nrange = [0.5, 6]\n[[law.constant]]\nname = \"r1\"\nvalue = 3\n\
          [[law.constant]]\nname = \"w1\"\nvalue = 0.4\n[[law.constant]]\nname = \"r\"\nvalue = 2\n",
            "rod.toml:37:10: `law.memory` is \"two_stops\", expected with it constants r1 up to r",
        ),
    ] {
        let text = with_law.replacen(piece, wrong, 1);
        assert_eq!(in_words(&read(&text).expect_err(&text)), expected, "{wrong}");
    }
}
