//! What is wrong with a structure: moduli, those of one pipe, the bend, joints, and where these
//! are, numbers of the geometry.

/// What is wrong with a structure.
#[derive(Debug, Clone)]
pub struct Softening {
    /// Factor on the moduli E and G.
    pub stiffness: f64,
    /// Factor on the moduli of pipe 1 and of pipe 2.
    pub pipes: [f64; 2],
    /// Factor on G alone.
    pub shear: f64,
    /// Change of the bend's flexibility factor.
    pub bend: f64,
    /// Joints by number, with the change of their compliance, rad/(N·m).
    pub joints: Vec<(usize, f64)>,
    /// Numbers of the geometry that are others.
    pub variants: Vec<Variant>,
}

/// Another number of the geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// The structure's variation.
    pub variation: usize,
    /// m or rad.
    pub value: f64,
    /// Loads or sensors along which axes are concerned.
    pub axes: [bool; 3],
}

impl Default for Softening {
    fn default() -> Self {
        Softening {
            stiffness: 1.0,
            pipes: [1.0; 2],
            shear: 1.0,
            bend: 0.0,
            joints: Vec::new(),
            variants: Vec::new(),
        }
    }
}

/// A joint that may sit anywhere about its station.
///
/// On a straight piece of the rod the displacement per compliance of a joint is a polynomial of
/// second degree in its station, for the lever arms of the load and of the reading are of first
/// degree: the polynomial through three stations is exact. On an arc of a few degrees it is so to
/// 1e-4.
#[derive(Debug, Clone)]
pub struct Nodes {
    /// Stations before, at and behind, m: the first and the last are as far as it may be.
    pub stations: [f64; 3],
    /// The joints there: bending, torsion.
    pub joints: [[usize; 2]; 3],
}

impl Nodes {
    /// Of the polynomial through the nodes, at `station`.
    fn weights(&self, station: f64) -> [f64; 3] {
        let [before, at, behind] = self.stations;
        // Lagrange's polynomials
        let lagrange = |own: f64, a: f64, b: f64| (station - a) * (station - b) / ((own - a) * (own - b));
        [lagrange(before, at, behind), lagrange(at, before, behind), lagrange(behind, before, at)]
    }

    /// Moves what `softening` has of the joint in the middle to `station`.
    pub fn move_joint(&self, softening: &mut Softening, station: f64) {
        let weights = self.weights(station);
        let moved: Vec<(usize, f64)> = softening
            .joints
            .iter()
            .flat_map(|&(joint, change)| match self.joints[1].iter().position(|&own| own == joint) {
                Some(kind) => (0..3).map(|node| (self.joints[node][kind], change * weights[node])).collect(),
                None => vec![(joint, change)],
            })
            .collect();
        softening.joints = moved;
    }
}
