//! What is allowed but worth a second look.

use super::{changed, read};

fn warnings(changes: &[(&str, &str)]) -> Vec<String> {
    let text = changed(changes);
    read(&text).expect(&text).warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn an_odd_file_is_read_with_a_warning() {
    assert_eq!(warnings(&[]), [""; 0]);
    let cases: [(&[(&str, &str)], &str); _] = [
        (
            &[("gamma_deg = 90.0", "bend_radius_mm = 7")],
            "the bend radius (7.0 mm) is smaller than the tube's own radius (8.0 mm): beam theory does not hold there",
        ),
        (
            &[("gamma_deg = 90.0", "gamma_deg = 180\nbend_radius_mm = 40")],
            "bend_radius_mm has no effect on a straight rod (gamma_deg = 180)",
        ),
        (
            &[("ply_thickness_mm = 0.5", "ply_thickness_mm = 0.25")],
            "the plies of material `carbon` are 1.000 mm thick together but the wall of pipe2 is 2.000 mm: the laminate's moduli are used for the whole wall",
        ),
        (
            &[("45.0, -45.0", "45.0, 45.0")],
            "the laminate of material `carbon` is not balanced (extension–shear coupling 0.19): a beam with E and G alone leaves its bending–twisting out; pair every +θ ply with a −θ ply",
        ),
        (
            &[("poisson_ratio = 0.29", "shear_modulus_gpa = 50")],
            "material `steel` has E/2G − 1 = 0.93, more than an isotropic material can have: it is taken as anisotropic, with Poisson's ratio 0.3 in its shear coefficient; state poisson_ratio if you know it",
        ),
        (
            &[("poisson_ratio = 0.29", "poisson_ratio = 0.2\nshear_modulus_gpa = 74.8")],
            "material `steel` states Poisson's ratio 0.2, and E/2G − 1 = 0.29 were it isotropic: it is taken as anisotropic, with standard uncertainties of 5 % for E and 10 % for G",
        ),
        // units
        (
            &[("youngs_modulus_gpa = 193.0", "youngs_modulus_gpa = 193e3")],
            "`material.steel.youngs_modulus_gpa` is 193000 GPa, where 0.01 to 2000 GPa is usual: is it given in GPa?",
        ),
        (
            &[("youngs_modulus_gpa = 193.0", "youngs_modulus_gpa = 1.93e-4")],
            "`material.steel.youngs_modulus_gpa` is 0.0001930 GPa, where 0.01 to 2000 GPa is usual: is it given in GPa?",
        ),
        (
            &[("ply_g12_gpa = 7.17", "ply_g12_gpa = 7170")],
            "`material.carbon.ply_g12_gpa` is 7170 GPa, where 0.01 to 2000 GPa is usual: is it given in GPa?",
        ),
        (
            &[("density_kg_m3 = 7930.0", "density_kg_m3 = 7.93")],
            "`material.steel.density_kg_m3` is 7.930 kg/m³, where 100 to 25000 kg/m³ is usual: is it given in kg/m³?",
        ),
        (
            &[("density_kg_m3 = 7930.0", "density_kg_m3 = 7.93e6")],
            "`material.steel.density_kg_m3` is 7930000 kg/m³, where 100 to 25000 kg/m³ is usual: is it given in kg/m³?",
        ),
        (
            &[("l1_mm = 150.0", "l1_mm = 150e3")],
            "`geometry.l1_mm` is 150000 mm, where 1 to 20000 mm is usual: is it given in mm?",
        ),
        (
            &[("l1_mm = 150.0", "l1_mm = 0.15")],
            "`geometry.l1_mm` is 0.1500 mm, where 1 to 20000 mm is usual: is it given in mm?",
        ),
        (
            &[("gamma_deg = 90.0", "gamma_deg = 1.5708")],
            "`geometry.gamma_deg` is 1.571 degrees, where 10 to 180 degrees is usual: is it given in degrees?",
        ),
        (
            &[
                ("outer_diameter_mm = 16.0", "outer_diameter_mm = 0.016"),
                ("inner_diameter_mm = 12.0", "inner_diameter_mm = 0.012"),
            ],
            "`pipe1.outer_diameter_mm` is 0.01600 mm, where 1 to 1000 mm is usual: is it given in mm?",
        ),
        (
            &[("mass_g = 55.0", "mass_g = 0.055")],
            "`tip.mass_g` is 0.05500 g, where 0.1 to 20000 g is usual: is it given in g?",
        ),
    ];
    for (changes, expected) in cases {
        assert_eq!(warnings(changes), [expected]);
    }
    // no weight and no load are usual
    assert_eq!(warnings(&[("mass_g = 55.0", "mass_g = 0"), ("7930.0", "0")]), [""; 0]);
}
