//! The rules between keys, each once just inside and once just outside its bound.

use super::*;
use crate::material::Material;
use crate::tube::MeshLayer;

/// A case with a value of `@`.
struct Rule {
    /// The key that the problem is reported with.
    key: &'static str,
    text: &'static str,
    inside: &'static [&'static str],
    outside: &'static [&'static str],
}

const fn rule(
    key: &'static str,
    text: &'static str,
    inside: &'static [&'static str],
    outside: &'static [&'static str],
) -> Rule {
    Rule {
        key,
        text,
        inside,
        outside,
    }
}

const RING: &str = "\n[muscles.ring]\ndirection = 'circular'\nzone = [0.5, 1.0]\n\
    [[stages]]\nname = 'first'\ndrive.ring.diameter_ratio = 0.25\n";

const LONG: &str = "\n[muscles.long]\ndirection = 'longitudinal'\nzone = [0.5, 1.0]\n[[stages]]\n";

const MOVED: &str = "\n[[stages]]\ndrive.ileum.displacement = 0.001\n";

/// Rules of cases that end with [`RING`].
const OF_RING: &[Rule] = &[
    rule(
        "tube.thickness",
        "tube.thickness = @",
        &["0.001", "0.49999"],
        &["0.00099999", "0.5"],
    ),
    rule(
        "tube.diameter_along",
        "tube.diameter_along = @",
        &["[[0.0, 1.0], [3.0, 0.8]]", "[[1.0, 0.1201]]"],
        &[
            "[]",
            "[[1.0, 1.0], [0.5, 1.0]]",
            "[[0.0, 1.0], [3.1, 1.0]]",
            "[[0.0, 1.0], [1.0, 0.12]]",
        ],
    ),
    rule(
        "tube.thickness_along",
        "tube.thickness_along = @",
        &["[[0.0, 0.06], [3.0, 0.03]]", "[[1.0, 0.499]]"],
        &["[[-0.1, 0.06]]", "[[0.0, 0.06], [1.0, 0.5]]"],
    ),
    rule(
        "friction",
        "contact = true\nfriction = @",
        &["0.0", "2.0"],
        &["-0.1", "2.1"],
    ),
    rule(
        "friction",
        "contact = false\nfriction = @",
        &["0.0"],
        &["0.1"],
    ),
    rule(
        "patches[1].edge",
        "patches = [{ name = 'scar', zone = [1.0, 2.0], edge = @ }]",
        &["0.0", "0.5"],
        &["0.501"],
    ),
    rule(
        "patches[1].zone",
        "patches = [{ name = 'scar', zone = @ }]",
        &["[0.0, 3.0]"],
        &["[-0.1, 1.0]", "[1.0, 3.1]", "[2.0, 1.0]"],
    ),
    rule(
        "patches[1].name",
        "patches = [{ name = @, zone = [1.0, 2.0] }]",
        &["'scar'"],
        &["'ring'", "'colon'", "'outer-wall'", "'a.b'"],
    ),
    rule(
        "patches[1].layer",
        "patches = [{ name = 'scar', zone = [1.0, 2.0], layer = @ }]\nlayers = [{ thickness = 0.03, name = 'in' }, { thickness = 0.03 }]",
        &["'in'", "'layer-2'"],
        &["'out'"],
    ),
    rule(
        "patches[1].muscles.@",
        "patches = [{ name = 'scar', zone = [1.0, 2.0], muscles.@ = 0.5 }]",
        &["ring"],
        &["rings"],
    ),
    // Dmin/D = 0.25 makes 1 − 0.75 f of the wall.
    rule(
        "patches[1].muscles.ring",
        "patches = [{ name = 'scar', zone = [1.0, 2.0], muscles.ring = @ }]",
        &["0.0", "1.306"],
        &["-0.1", "1.307", "11.0", "'x'"],
    ),
    rule(
        "patches[1].sector",
        "symmetry = @\npatches = [{ name = 'scar', zone = [1.0, 2.0], sector.width_degrees = 90.0 }]",
        &["'none'", "{ fold = 4 }"],
        &["'axisymmetric'"],
    ),
    rule(
        "patches[1].sector.width_degrees",
        "symmetry = 'none'\npatches = [{ name = 'scar', zone = [1.0, 2.0], sector = { width_degrees = @, repeat = 3 } }]",
        &["120.0"],
        &["121.0"],
    ),
    rule(
        "foundations[1].sector.width_degrees",
        "symmetry = { fold = 4 }\nfoundations = [{ stiffness = 1.0, sector = { width_degrees = @, repeat = 6 } }]",
        &["30.0"],
        &["31.0"],
    ),
    rule(
        "foundations[1].sector.edge_degrees",
        "symmetry = 'none'\nfoundations = [{ stiffness = 1.0, sector = { width_degrees = 90.0, edge_degrees = @ } }]",
        &["45.0"],
        &["46.0"],
    ),
    rule(
        "foundations[1].tension_only",
        "foundations = [{ stiffness = 1.0, tension_only = @ }]",
        &["false"],
        &["true"],
    ),
    rule(
        "foundations[1].tension_only",
        "symmetry = 'none'\nends.ileum = 'free'\nends.colon = 'free'\n\
         foundations = [{ stiffness = 1.0, direction = 'normal', tension_only = @ }]",
        &["false"],
        &["true"],
    ),
    rule(
        "obstacles[1].friction",
        "obstacles = [{ name = 'hose', shape = { sheath = { radius = 0.6 } }, friction = @ }]",
        &["0.0", "2.0"],
        &["-0.1", "2.1"],
    ),
    rule(
        "mesh.control_points.axial",
        "mesh.control_points.axial = @",
        &["4"],
        &["3"],
    ),
    rule(
        "mesh.control_points.thickness",
        "mesh.control_points.thickness = @",
        &["4"],
        &["3"],
    ),
    rule(
        "mesh.control_points.around",
        "mesh.control_points.around = @",
        &["8"],
        &["7"],
    ),
    rule(
        "mesh.control_points.around",
        "mesh = { degree = 5, control_points = { around = @ } }",
        &["12"],
        &["11"],
    ),
    rule(
        "mesh.volumetric_integration",
        "mesh = { degree = @, volumetric_integration = 'reduced' }",
        &["3", "5"],
        &["1", "2", "4"],
    ),
    rule(
        "mesh.volumetric_integration",
        "mesh = { grading = @, volumetric_integration = 'reduced' }",
        &["1.0"],
        &["1.5", "0.5"],
    ),
    rule(
        "symmetry.fold",
        "symmetry.fold = @",
        &["6", "60"],
        &["7", "61"],
    ),
    rule(
        "mesh.control_points",
        "symmetry = 'none'\nmesh.control_points = { axial = @, around = 1000, thickness = 4 }",
        &["5000"],
        &["5001"],
    ),
    rule(
        "mesh.refine[1].zone",
        "mesh.refine = [{ zone = @ }]",
        &["[0.0, 3.0]", "[1.0, 1.0011]"],
        &[
            "[-0.0001, 3.0]",
            "[0.0, 3.0001]",
            "[1.0, 1.0009]",
            "[1.0, 1.0]",
            "[1.0, 0.5]",
        ],
    ),
    rule(
        "material.neo-hookean.poisson_ratio",
        "material.neo-hookean = { volumetric = 'quadratic', poisson_ratio = @ }",
        &["0.0"],
        &["-0.0001"],
    ),
    rule(
        "material.mooney-rivlin.i2_share",
        "material.mooney-rivlin = { poisson_ratio = 0.25, i2_share = @ }",
        &["0.5", "0.0"],
        &["0.5001"],
    ),
    rule(
        "tube.thickness",
        "layers = [{ thickness = 0.02 }, { thickness = 0.04 }]\ntube.thickness = @",
        &["0.06", "0.06000001"],
        &["0.0601", "0.0599"],
    ),
    rule(
        "layers[1].thickness",
        "layers = [{ thickness = @ }, { thickness = 0.06 }]",
        &["6.1e-5"],
        &["5.9e-5"],
    ),
    rule(
        "layers[2].name",
        "layers = [{ thickness = 0.03, name = 'a' }, { thickness = 0.03, name = @ }]",
        &["'b'"],
        &["'a'", "'b c'", "'layer/2'"],
    ),
    rule(
        "layers[1].residual.around",
        "layers = [{ thickness = 0.06, residual = { around = @ } }]",
        &["[0.1, 10.0]"],
        &["[0.0999, 1.0]", "[1.0, 10.01]", "[-1.0, 1.0]"],
    ),
    rule(
        "layers[1].tone.best_stretch",
        "layers = [{ thickness = 0.06, tone = { tension = 0.1, least_stretch = 0.8, best_stretch = @ } }]",
        &["0.802", "1.4"],
        &["0.8", "0.7"],
    ),
    rule(
        "layers[1].fibres[1].angle_degrees",
        "layers = [{ thickness = 0.06, fibres = [{ k1 = 1.0, k2 = 1.0, angle_degrees = @ }] }]",
        &["0.1", "-89.9", "45.0"],
        &["0.0", "90.0", "-90.0", "-91.0"],
    ),
    rule(
        "mesh.grading",
        "layers = [{ thickness = 0.03 }, { thickness = 0.03 }]\nmesh.grading = @",
        &["1.0"],
        &["1.5"],
    ),
    rule(
        "mesh.control_points.thickness",
        "layers = [{ thickness = 0.03 }]\nmesh.control_points = { axial = 40 @ }",
        &[""],
        &[", thickness = 8"],
    ),
    rule(
        "contact",
        "layers = [{ thickness = 0.06, fibres = [{ k1 = 1.0, k2 = 1.0, angle_degrees = 30.0, \
         pair = false }] }]\ncontact = @",
        &["false"],
        &["true"],
    ),
    rule(
        "solver.pseudo_time",
        "solver = { scheme = @, pseudo_time = {} }",
        &["'newmark'", "'backward-euler'"],
        &["'static'"],
    ),
    rule(
        "muscles.side.zone",
        "muscles.side = { direction = 'circular', zone = @ }",
        &["[0.0, 3.0]"],
        &["[-0.1, 1.0]", "[2.5, 3.1]"],
    ),
    rule(
        "muscles.side.zone",
        "muscles.side = { direction = 'circular', zone = @, repeat = 1.5 }",
        &["[-0.1, 1.0]", "[2.5, 3.1]"],
        &["[1.0, 1.0]"],
    ),
    rule(
        "muscles.side.repeat",
        "muscles.side = { direction = 'circular', zone = [0.0, 1.0], repeat = @ }",
        &["1.0", "2.5"],
        &["0.999"],
    ),
    rule(
        "muscles.side.profile.table",
        "muscles.side = { direction = 'longitudinal', zone = [0, 1], profile = { table = @ } }",
        &["[[0, 0], [1, 0.001]]", "[[0, 1], [1, 0]]"],
        &[
            "[[0, 1]]",
            "[]",
            "[[0, 0], [1, 0.0009]]",
            "[[0, 1.0001], [1, 0]]",
            "[[0, 1], [1, -0.0001]]",
            "[[0.0001, 1], [1, 0]]",
            "[[0, 1], [0.9999, 0]]",
            "[[0, 1], [0.5, 1], [0.5, 0], [1, 0]]",
        ],
    ),
    rule(
        "imperfections[1].amplitude",
        "@",
        &[
            "imperfections = [{ of = 'geometry', amplitude = 0.015, shape = { wave = { mode = 0 } } }]",
            "imperfections = [{ of = 'geometry', amplitude = -0.015, shape = { wave = { mode = 0 } } }]",
            "imperfections = [{ of = { muscle = 'ring' }, amplitude = 0.3066, shape = { wave = { mode = 0 } } }]",
        ],
        &[
            "imperfections = [{ of = 'geometry', amplitude = 0.01501, shape = { wave = { mode = 0 } } }]",
            "imperfections = [{ of = 'geometry', amplitude = -0.01501, shape = { wave = { mode = 0 } } }]",
            "imperfections = [{ of = { muscle = 'ring' }, amplitude = 0.3067, shape = { wave = { mode = 0 } } }]",
            "imperfections = [{ of = { muscle = 'ring' }, amplitude = 0.5001, shape = { wave = { mode = 0 } } }]",
        ],
    ),
    rule(
        "imperfections[1].direction",
        "imperfections = [{ of = @, direction = 'axial', amplitude = 1e-3, shape = { wave = { mode = 0 } } }]",
        &["'colon-end'"],
        &["'geometry'", "{ muscle = 'ring' }"],
    ),
    rule(
        "imperfections[1].of",
        "ends.colon = @\nimperfections = [{ of = 'colon-end', amplitude = 1e-3, shape = { wave = { mode = 0 } } }]",
        &["'fixed'"],
        &["'sliding'", "'free'"],
    ),
    rule(
        "imperfections[1].of",
        "ends.ileum = @\nimperfections = [{ of = 'ileum-end', direction = 'axial', amplitude = 1e-3, shape = { wave = { mode = 0 } } }]",
        &["'fixed'", "'sliding'"],
        &["'free'"],
    ),
    rule(
        "imperfections[1].shape.wave.mode",
        "@ } } }]",
        &[
            "imperfections = [{ of = 'geometry', amplitude = 1e-3, shape = { wave = { mode = 0",
            "symmetry = 'none'\nimperfections = [{ of = 'geometry', amplitude = 1e-3, shape = { wave = { mode = 15",
            "symmetry.fold = 3\nimperfections = [{ of = 'geometry', amplitude = 1e-3, shape = { wave = { mode = 3",
        ],
        &[
            "imperfections = [{ of = 'geometry', amplitude = 1e-3, shape = { wave = { mode = 1",
            "symmetry = 'none'\nimperfections = [{ of = 'geometry', amplitude = 1e-3, shape = { wave = { mode = 16",
            "symmetry.fold = 3\nimperfections = [{ of = 'geometry', amplitude = 1e-3, shape = { wave = { mode = 4",
        ],
    ),
    rule(
        "imperfections[1].shape.random.modes",
        "symmetry = 'none'\nimperfections = [{ of = 'colon-end', amplitude = 1e-3, shape = { random = { seed = 1, modes = @ } } }]",
        &["15"],
        &["16"],
    ),
    rule(
        "imperfections[1].shape.wave.axial",
        "imperfections = [{ of = @, amplitude = 1e-3, shape = { wave = { mode = 0, axial = 'half-sine' } } }]",
        &["'geometry'", "{ muscle = 'ring' }"],
        &["'colon-end'"],
    ),
    rule(
        "imperfections[1].shape.random.half_waves",
        "imperfections = [{ of = @, amplitude = 1e-3, shape = { random = { seed = 1, half_waves = 1 } } }]",
        &["'geometry'", "{ muscle = 'ring' }"],
        &["'ileum-end'"],
    ),
    // A quarter of one of 302 equal elements: 0.00248.
    rule(
        "obstacles[1].shape",
        "obstacles = [{ name = 'scope', shape = { @ } }]",
        &[
            "rod = { radius = 0.4375 }",
            "sheath = { radius = 0.5025 }",
            "ball = { radius = 0.4375, position = [0.0, 0.0, 1.5] }",
            "plate = { position = [0.0, 0.0, -0.0025], normal = [0.0, 0.0, 1.0] }",
        ],
        &[
            "rod = { radius = 0.4376 }",
            "sheath = { radius = 0.5024 }",
            "ball = { radius = 0.4376, position = [0.0, 0.0, 1.5] }",
            "ball = { radius = 0.1, position = [0.1, 0.0, 1.5] }",
            "plate = { position = [0.0, 0.0, -0.0024], normal = [0.0, 0.0, 1.0] }",
            "plate = { position = [0.7, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }",
        ],
    ),
    rule(
        "obstacles[1].shape",
        "mesh.contact_range = @\nobstacles = [{ name = 'scope', shape.rod.radius = 0.43 }]",
        &["2.0"],
        &["10.0"],
    ),
    rule(
        "obstacles[1].shape",
        "obstacles = [{ name = 'pea', shape.ball = { radius = 0.02, position = @ } }]\nsymmetry = 'none'",
        &["[0.4, 0.0, 1.51]", "[0.0, 0.53, 1.51]"],
        &[
            "[0.425, 0.0, 1.51]",
            "[0.0, 0.47, 1.51]",
            "[0.0, 0.515, 1.51]",
        ],
    ),
    rule(
        "obstacles[1].name",
        "obstacles = [{ name = @, shape.rod.radius = 0.2 }]",
        &["'scope'"],
        &[
            "'ring'",
            "'colon'",
            "'outer-wall'",
            "'at_min'",
            "'a b'",
            "''",
        ],
    ),
    rule(
        "obstacles[1].shape",
        "ends = { colon = @, ileum = 'free' }\nobstacles = [{ name = 'bolus', shape.ball = { radius = 0.2, position = [0.0, 0.0, -0.5] } }]",
        &["'fixed'", "'sliding'"],
        &["'free'"],
    ),
    rule(
        "obstacles[1].shape",
        "symmetry = 'none'\nends = { colon = @, ileum = 'sliding' }\n\
            obstacles = [{ name = 'bone', shape.plate = { position = [0.7, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] } }]",
        &["'fixed'"],
        &["'free'", "'sliding'"],
    ),
    rule(
        "obstacles[1].shape.plate.normal",
        "symmetry = 'none'\nobstacles = [{ name = 'bone', shape.plate = { position = [0.7, 0.0, 0.0], normal = @ } }]",
        &["[-1e-3, 0.0, 0.0]"],
        &["[0.0, 0.0, 0.0]"],
    ),
];

/// Rules of cases that begin with [`RING`].
const AFTER_RING: &[Rule] = &[
    rule(
        "stages[1].drive.ring.shift",
        "drive.ring = { diameter_ratio = 0.5, shift = @ }",
        &["3.0", "-1.5", "[[0.5, 3.0], [1.0, -1.5]]"],
        &[
            "3.01",
            "-1.51",
            "[[0.5, 3.01], [1.0, 0.0]]",
            "[[0.0, 0.1], [1.0, 0.0]]",
        ],
    ),
    rule(
        "stages[1].drive.ring.diameter_ratio",
        "drive.ring.diameter_ratio = @\nduration = 4.0",
        &["[[1.0, 0.5], [4.0, 1.0]]", "[[0.0, 1.0], [2.0, 0.5]]"],
        &[
            "[]",
            "[[2.0, 0.5], [1.0, 1.0]]",
            "[[2.0, 0.5], [4.1, 1.0]]",
            "[[-1.0, 1.0], [4.0, 0.5]]",
            "[[0.0, 0.9], [2.0, 0.5]]",
            "[[1.0, 0.01]]",
        ],
    ),
    rule(
        "stages[1].drive.ring.stretch",
        "drive.ring.stretch = @",
        &["0.02", "[[0.5, 0.3]]"],
        &["0.0199"],
    ),
    rule(
        "stages[1].drive.ring.diameter_ratio",
        "drive.ring.diameter_ratio = @",
        &["0.02"],
        &["0.0199"],
    ),
    rule(
        "stages[2].name",
        "[[stages]]\nname = @",
        &["'second'"],
        &["'first'"],
    ),
    rule(
        "stages[2].drive.inner-wall.pressure",
        "[[stages]]\ndrive.inner-wall.pressure = @\n[material.neo-hookean]\nyoungs_modulus = 2.0",
        &["20.0", "-20.0"],
        &["20.001", "-20.001"],
    ),
    rule(
        "stages[2].drive.outer-wall.dead_load",
        "[[stages]]\ndrive.outer-wall.dead_load = @",
        &["10.0", "-10.0"],
        &["10.001", "-10.001"],
    ),
    rule(
        "stages[2].drive.outer-wall.pressure",
        "[[stages]]\ndrive.outer-wall.pressure = 1e-3\n[ends]\ncolon = @",
        &["'fixed'", "'sliding'"],
        &["'free'"],
    ),
    rule(
        "stages[2].drive.ileum.displacement",
        "[[stages]]\ndrive.ileum.displacement = 0.1\n[ends]\nileum = @",
        &["'fixed'", "'sliding'"],
        &["'free'"],
    ),
    rule(
        "stages[2].drive.ileum.twist_degrees",
        "[[stages]]\ndrive.ileum.twist_degrees = 10\n[ends]\nileum = @",
        &["'fixed'"],
        &["'sliding'", "'free'"],
    ),
    rule(
        "stages[2].drive.lumen.volume_ratio",
        "[[stages]]\ndrive.lumen.volume_ratio = 1.2\n[ends]\nileum = @",
        &["'fixed'", "'sliding'"],
        &["'free'"],
    ),
    rule(
        "stages[2].drive.lumen.volume",
        "[[stages]]\ndrive.lumen.volume = @",
        &["0.002", "18000"],
        &["-1.0", "0.001", "19000"],
    ),
    rule(
        "stages[1].drive.ring.tension",
        "drive.ring.tension = @\nduration = 4.0\n[muscles.ring.active_stress]",
        &[
            "1000.0",
            "[[1.0, 0.5], [4.0, 0.0]]",
            "[[0.0, 0.0], [2.0, 0.5]]",
        ],
        &[
            "1000.1",
            "-0.1",
            "[[2.0, 0.5], [1.0, 1.0]]",
            "[[0.0, 0.1], [2.0, 0.5]]",
        ],
    ),
    rule(
        "stages[3].drive.inner-wall.pressure",
        "[[stages]]\ndrive.lumen.volume_ratio = 1.2\n[[stages]]\ndrive = { @inner-wall.pressure = 0.01 }",
        &[""],
        &["lumen.volume_ratio = 1.5, "],
    ),
    rule(
        "stages[2].drive.ileum.displacement",
        "[[stages]]\ndrive.ileum.displacement = @",
        &["-2.8499", "26.999"],
        &["-2.8501", "27.001"],
    ),
    rule(
        "stages[2].drive.colon.displacement",
        "[[stages]]\ndrive.colon.displacement = @",
        &["2.8499", "-26.999"],
        &["2.8501", "-27.001"],
    ),
    rule(
        "imperfections[1]",
        "[[stages]]\ndrive.inner-wall.pressure = 1e-3\n[ends]\ncolon = @\n[[imperfections]]\nof = 'colon-end'\n\
            direction = 'axial'\namplitude = 1e-3\nshape.wave.mode = 1\n[mesh]\n",
        &["'fixed'"],
        &["'sliding'"],
    ),
    rule(
        "stages[2]",
        "[[obstacles]]\nname = 'bolus'\nshape.ball = { radius = 0.2, position = [0.0, 0.0, -1.0] }\n\
            [[stages]]\nsteps = 100\ndrive.bolus = { position = [0.0, 0.0, 1.5], radius = 1.0 }\n[ends]\ncolon = @",
        &["'sliding'", "'free'"],
        &["'fixed'"],
    ),
    rule(
        "stages[2].steps",
        "[[obstacles]]\nname = 'bolus'\nshape.ball = { radius = 0.2, position = [0.0, 0.0, -1.0] }\n\
            [[stages]]\nsteps = @\ndrive.bolus.position = [0.0, 0.0, 1.5]",
        &["25"],
        &["24"],
    ),
    rule(
        "stages[2].drive.bolus.position",
        "[[obstacles]]\nname = 'bolus'\nshape.ball = { radius = 0.2, position = [0.0, 0.0, -1.0] }\n\
            [[stages]]\nduration = 2.0\ndrive.bolus.position = @",
        &[
            "[0.0, 0.0, -0.9]",
            "[[0.0, 0.0, 0.0, -1.0], [1.5, 0.0, 0.0, -0.9]]",
        ],
        &[
            "[0.0, -0.9]",
            "[[1.0, 0.0, -0.9]]",
            "[[1.5, 0.0, 0.0, -0.9], [1.0, 0.0, 0.0, -1.0]]",
            "[[2.5, 0.0, 0.0, -0.9]]",
            "[[0.0, 0.0, 0.0, -0.9]]",
        ],
    ),
    rule(
        "muscles.@",
        "[muscles.@]\ndirection = 'longitudinal'\nzone = [0, 1]",
        &["a_b-C9", "abcdefghijabcdefghijabcdefghijabcdefghij"],
        &[
            "colon",
            "inner-wall",
            "abcdefghijabcdefghijabcdefghijabcdefghijk",
        ],
    ),
];

/// Checks that one problem is reported for values outside, and none for values inside.
fn check(rule: &Rule, case: impl Fn(&str) -> String) {
    for value in rule.inside {
        let text = case(&rule.text.replace('@', value));
        if let Err(error) = read(&text, "case") {
            panic!("{error}\n{text}");
        }
    }
    for value in rule.outside {
        let text = case(&rule.text.replace('@', value));
        let keys: Vec<String> = problems(&text).into_iter().map(|p| p.key).collect();
        assert_eq!(keys, [rule.key.replace('@', value)], "{text}");
    }
}

#[test]
fn rules_hold_up_to_their_bounds_and_no_further() {
    for rule in OF_RING {
        check(rule, |text| format!("{text}{RING}"));
    }
    for rule in AFTER_RING {
        let first = rule.text.starts_with("drive");
        let ring = RING.replace("drive.ring.diameter_ratio = 0.25\n", "");
        let base = if first { &ring } else { RING };
        let symmetry = if rule.key == "imperfections[1]" {
            "symmetry = 'none'"
        } else {
            ""
        };
        check(rule, |text| format!("{symmetry}{base}{text}"));
    }
    // Of the activity ½(1 − cos 2πx) over 0.5 of a length 3, the mean is a twelfth: the stretch is
    // 1 + 12 (ratio − 1).
    let ratio = "drive.long.length_ratio = @";
    let key = "stages[1].drive.long.length_ratio";
    check(
        &rule(key, ratio, &["0.9184", "9.249"], &["0.9183", "9.251"]),
        |text| format!("{LONG}{text}"),
    );
    let length = rule(
        "tube.length",
        "tube.length = @",
        &["0.01", "1000"],
        &["0.0099", "1000.1"],
    );
    check(&length, |text| format!("{text}{MOVED}"));
    let drive = rule(
        "stages",
        "drive.ileum.displacement = @",
        &["1e-9"],
        &["0.0"],
    );
    check(&drive, |text| format!("[[stages]]\n{text}"));
}

/// Reads a case with a saved state, or mode, that is changed.
fn with_state(text: &str, change: impl Fn(&mut SavedState)) -> Vec<String> {
    let state = |_: InputFile<'_>| {
        let mut state = state();
        change(&mut state);
        Ok(state.into())
    };
    let read = read_with(text, "case", &state);
    let problems = read.map_or_else(|error| error.problems, |_| vec![]);
    problems
        .into_iter()
        .map(|problem| problem.to_string())
        .collect()
}

#[test]
fn muscles_of_a_layer_and_laws_by_their_moduli_are_complete() {
    let layers = "layers = [{ thickness = 0.03, name = 'in' }, { thickness = 0.03 }]\n";
    let two = |first: &str, second: &str| {
        let muscle = |name, layer| {
            format!("[muscles.{name}]\ndirection = 'circular'\nzone = [0.5, 1.0]\n{layer}\n")
        };
        let stage = "[[stages]]\ndrive.a.diameter_ratio = 0.5\n";
        format!(
            "{layers}{}{}{stage}",
            muscle("a", first),
            muscle("b", second)
        )
    };
    let law = |keys: &str| format!("material.neo-hookean = {{ {keys} }}{RING}");
    for (text, problem) in [
        (two("layer = 'in'", "layer = 'layer-2'"), None),
        (two("layer = 'in'", "layer = 'in'"), None),
        (two("layer = 'in'", ""), None),
        (two("", ""), None),
        (
            two("layer = 'in'", "layer = 'out'"),
            Some("muscles.b.layer = 'out': no layer has this name; the layers are in, layer-2"),
        ),
        (law("shear_modulus = 1.0, bulk = 50.0"), None),
        (
            law("shear_modulus = 1.0"),
            Some("material.neo-hookean.shear_modulus: needs bulk"),
        ),
        (
            law("bulk = 1.0"),
            Some("material.neo-hookean.bulk: needs shear_modulus"),
        ),
        (
            law("shear_modulus = 1.0, bulk = 50.0, youngs_modulus = 3.0"),
            Some(
                "material.neo-hookean.youngs_modulus: cannot be given together with shear_modulus",
            ),
        ),
    ] {
        let found = read(&text, "case").map_or_else(|error| error.problems, |_| vec![]);
        let found: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert_eq!(
            found.len(),
            usize::from(problem.is_some()),
            "{found:?}\n{text}"
        );
        assert!(
            found
                .iter()
                .all(|found| found.starts_with(problem.unwrap())),
            "{found:?}"
        );
    }
    // Stresses are measured in the stiffest of the layers.
    let text = "[units]\nlength = 'mm'\nstress = 'kPa'\n[tube]\ndiameter = 2.0\n\
        [[layers]]\nthickness = 0.2\nmaterial.gent = { shear_modulus = 3.0, limit = 2.0, bulk = 90.0 }\n\
        [[layers]]\nthickness = 0.1\nmaterial.neo-hookean = { youngs_modulus = 4.5 }\n\
        fibres = [{ k1 = 18.0, k2 = 1.0, angle_degrees = 30.0 }]\n\
        [[stages]]\ndrive.inner-wall.dead_load = 1.8\n";
    let plan = read(text, "case").unwrap();
    assert_eq!(plan.units.unwrap().youngs_modulus, 9.0);
    assert_eq!(plan.stages[0].load.pressures[0].dead, 0.2);
    let [inner, outer] = &plan.tube.layers[..] else {
        panic!()
    };
    let Material::Composite(law) = &outer.material else {
        panic!()
    };
    assert_eq!((law.fibres.len(), law.fibres[0].k1), (2, 2.0));
    assert!((law.matrix.shear_modulus() - 0.5 / 2.99).abs() < 1e-15);
    let Material::Composite(law) = &inner.material else {
        panic!()
    };
    assert!((law.matrix.shear_modulus() - 1.0 / 3.0).abs() < 1e-15);
    assert!((inner.share - 2.0 / 3.0).abs() < 1e-12 && (plan.tube.thickness - 0.15).abs() < 1e-15);
    assert_eq!(plan.mesh.thickness, 3 + 3 + 3 + 2);
}

#[test]
fn a_state_to_start_from_fits_the_case() {
    let text = format!("start.state = 'x'{RING}");
    let check = |text: &str, change: &dyn Fn(&mut SavedState), rules: &[&str]| {
        let found = with_state(text, change);
        assert_eq!(found.len(), rules.len(), "{found:?}");
        for (found, rule) in found.iter().zip(rules) {
            assert!(
                found.starts_with("start.state = 'x': ") && found.contains(rule),
                "{found}"
            );
        }
    };
    check(&text, &|_| {}, &[]);
    check(&text, &|s| s.layout.length = 3.0 * (1.0 + 1e-13), &[]);
    check(
        &text,
        &|s| s.layout.length = 3.0 * (1.0 + 1e-11),
        &["D long"],
    );
    check(
        &text,
        &|s| s.layout.thickness = 0.07,
        &["its tube is 0.07 D thick"],
    );
    check(
        &text,
        &|s| {
            s.layout.mesh.layers = vec![
                MeshLayer {
                    share: 0.5,
                    elements: 1
                };
                2
            ]
        },
        &["its wall has 2 layers, with [0.5, 0.5] of its thickness, and this one has one layer"],
    );
    check(&text, &|s| s.layout.rings = 8, &["has no symmetry"]);
    let fold = |m: usize| format!("symmetry.fold = {m}\n{text}");
    check(&fold(2), &|s| s.layout.rings = 2, &[]);
    check(&fold(3), &|s| s.layout.rings = 2, &["repeats 4 times"]);
    check(&fold(3), &|s| s.layout.rings = 1, &[]);
    let muscle = |name: &'static str, ratio: f64| {
        move |state: &mut SavedState| {
            state.muscles = vec![(name.into(), crate::activation::MuscleTarget::DiameterRatio)];
            (state.load.muscles, state.load.shifts) = (vec![ratio], vec![0.0]);
        }
    };
    check(&text, &muscle("ring", 0.02), &[]);
    check(&text, &muscle("ring", 0.0199), &["shrinks the wall"]);
    check(&text, &muscle("other", 1.0), &[]);
    check(&text, &muscle("other", 0.9), &["add [muscles.other]"]);
    let free = format!("ends.ileum = 'free'\n{text}");
    check(
        &free,
        &|s| s.load.ends[1].displacement = 0.1,
        &["only a fixed or sliding end"],
    );
    check(
        &free,
        &|s| s.load.ends[1].twist = 0.1,
        &["only a fixed end"],
    );
    check(
        &free,
        &|s| s.load.pressures[0].follower = 0.1,
        &["a follower pressure"],
    );
    check(&free, &|s| s.load.pressures[0].dead = 0.1, &[]);
}

#[test]
fn a_mode_fits_the_tube_and_the_symmetry() {
    let text = |symmetry: &str, around: usize, of: &str| {
        format!(
            "symmetry = {symmetry}\nmesh.control_points.around = {around}\nimperfections = \
            [{{ of = {of}, amplitude = 1e-3, shape = {{ mode = 'x' }} }}]{RING}"
        )
    };
    let geometry = "'geometry'";
    for (case, rule) in [
        (text("'none'", 8, geometry), ""),
        (text("{ fold = 2 }", 8, geometry), ""),
        (
            text("{ fold = 4 }", 8, geometry),
            "is of circumferential mode 2, and the tube repeats 4",
        ),
        (
            text("'axisymmetric'", 8, geometry),
            "an axisymmetric run has mode 0 only",
        ),
        (
            text("'none'", 8, "'colon-end'"),
            "only an imperfect geometry",
        ),
    ] {
        let found = with_state(&case, |_| {});
        match rule {
            "" => assert!(found.is_empty(), "{found:?}"),
            rule => assert!(found.len() == 1 && found[0].contains(rule), "{found:?}"),
        }
    }
    let third = |state: &mut SavedState| state.arrays.get_mut("harmonic").unwrap().values[0] = 3.0;
    let found = with_state(&text("'none'", 8, geometry), third);
    assert!(
        found.len() == 1 && found[0].contains("resolve at most 2"),
        "{found:?}"
    );
    assert!(with_state(&text("'none'", 12, geometry), third).is_empty());
    let longer = with_state(&text("'none'", 8, geometry), |state| {
        state.layout.length = 3.1
    });
    assert!(
        longer.len() == 1 && longer[0].contains("its tube is 3.1 D long"),
        "{longer:?}"
    );
}
