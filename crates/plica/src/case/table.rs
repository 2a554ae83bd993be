//! Every key of the case file, once: the checker takes types, defaults and ranges from here, and
//! so does the reference page.

use super::keys::Given::{self, Always, Or, OrElse};
use super::keys::Kind::{self, Choice, Count, Number, Points, Switch, Tables, Text, Word, Zone};
use super::keys::Limit::{At, Beyond};
use super::keys::{Key, Limit, Range};

/// Every key, in the order of the reference page.
#[rustfmt::skip] // One key a paragraph reads best.
pub const KEYS: &[Key] = &[
    key("title", Text, "", OrElse("the name of the file", "\"case\""), ANY,
        "What the case is, in one line; it heads tables and pictures."),
    key("symmetry", Word(&["axisymmetric", "none"]), "", Or("\"axisymmetric\""), ANY,
        "What repeats around the tube. `\"axisymmetric\"`: every cross-section stays a circle, and may twist. \
         `\"none\"`: the full three-dimensional tube."),
    key("symmetry.fold", Count, "", OrElse("", "2"), from(2.0).to(4096.0),
        "`symmetry = { fold = m }`: the tube repeats m times around; m divides `mesh.control_points.around`."),

    key("units.length", Word(&["m", "cm", "mm", "um"]), "", Always("\"mm\""), ANY,
        "Unit of every length in the file and in the results."),
    key("units.stress", Word(&["Pa", "kPa", "MPa"]), "", Always("\"kPa\""), ANY,
        "Unit of every stress in the file and in the results."),

    key("tube.diameter", Number, "length", Or("1.0"), from(1e-9).to(1e9),
        "Outer diameter D at rest."),
    key("tube.length", Number, "length", OrElse("3 diameters", "3.0"), above(0.0),
        "Length L at rest; the colon end is at 0, the ileum end at L."),
    key("tube.thickness", Number, "length", OrElse("0.06 diameters", "0.06"), above(0.0),
        "Thickness H of the wall at rest; below half the diameter."),

    key("material.neo-hookean.youngs_modulus", Number, "stress", Or("1.0"), from(1e-12).to(1e15),
        "Young's modulus E."),
    key("material.neo-hookean.poisson_ratio", Number, "", Or("0.495"),
        above(-1.0).below(0.5).because("the law is compressible"),
        "Poisson's ratio ν."),
    key("material.neo-hookean.volumetric", Word(&["logarithmic", "quadratic"]), "", Or("\"logarithmic\""), ANY,
        "What resists a change of volume: λ/2 (ln J)², the paper's, or λ/4 (J² − 1 − 2 ln J), which stays elliptic where the wall expands strongly and needs ν ≥ 0."),

    key("muscles.<name>.direction", Word(&["circular", "longitudinal"]), "", Always("\"circular\""), ANY,
        "Whether it shortens the wall around the tube or lengthens it along the tube."),
    key("muscles.<name>.zone", Zone, "length", Always("[0.5, 1.0]"), ANY,
        "Where it begins and ends, from the colon end. Zones of muscles of one direction do not overlap."),
    key("muscles.<name>.profile", Word(&["raised-cosine", "half-sine"]), "", Or("\"raised-cosine\""), ANY,
        "How its activity is spread over the zone: ½(1 − cos 2πx), or sin πx, which has kinks at the edges of the zone."),
    key("muscles.<name>.profile.smooth-box.edge", Number, "", Always("0.25"), above(0.0).to(0.5),
        "`profile = { smooth-box = { edge = 0.25 } }`: one, with a smooth rise and fall over this fraction of the zone at either end."),
    key("muscles.<name>.profile.table", Points, "", OrElse("", "[[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]"), ANY,
        "`profile = { table = [[0.0, 0.0], …] }`: straight lines between points (position in the zone, activity). \
         Positions rise from 0 to 1; activities lie between 0 and 1."),

    key("ends.colon", Word(&["fixed", "sliding", "free"]), "", Or("\"fixed\""), ANY,
        "How the end at 0 is held. `\"fixed\"`: no point of the end face moves. `\"sliding\"`: it slides on its plane. `\"free\"`: not at all."),
    key("ends.ileum", Word(&["fixed", "sliding", "free"]), "", Or("\"fixed\""), ANY,
        "How the end at L is held."),

    key("mesh.control_points.axial", Count, "", Or("305"), from(2.0).to(20000.0),
        "Control points along the tube; more than the degree."),
    key("mesh.control_points.around", Count, "", Or("60"), from(4.0).to(4096.0),
        "Control points around the whole tube, whatever the symmetry; at least twice the degree and two."),
    key("mesh.control_points.thickness", Count, "", Or("8"), from(2.0).to(64.0),
        "Control points through the wall; more than the degree."),
    key("mesh.degree", Count, "", Or("3"), from(1.0).to(5.0),
        "Degree of the splines, in every direction."),
    key("mesh.volumetric_integration", Word(&["full", "reduced"]), "", Or("\"full\""), ANY,
        "At how many points the wall's resistance to a change of volume is integrated: at all, as the paper does; or at about one to an \
         element through the wall, so that a nearly incompressible wall does not lock where few elements are that thick; needs degree 3 or 5."),
    key("mesh.refine", Tables, "", OrElse("the zones of the muscles, factor 3", "[{ zone = [0.5, 1.0], factor = 3.0 }]"), ANY,
        "Where elements along the tube are denser; `refine = []` for a uniform mesh. Where entries overlap the densest counts."),
    key("mesh.refine[].zone", Zone, "length", Always("[0.5, 1.0]"), ANY,
        "Where it begins and ends."),
    key("mesh.refine[].factor", Number, "", Or("3.0"), from(1.0).to(100.0),
        "How many times as dense as elsewhere."),

    key("start.state", Text, "", Always("\"runs/tube/states/state-0015.safetensors\""), ANY,
        "Path of a saved state, from the folder of the case file on: the run begins there, and the first stage at its load. The file lies in \
         that folder or in the one that plica runs in (or below), or in one that `--within DIR` names."),

    key("stages", Tables, "", Always("[{ drive.circular.diameter_ratio = 0.5 }]"), ANY,
        "What happens, one stage after the other; each begins where the one before ends, the first at rest or at `start`."),
    key("stages[].name", Text, "", OrElse("stage-1, stage-2, …", "\"stage-1\""), ANY,
        "Its name in tables."),
    key("stages[].steps", Count, "", Or("20"), from(1.0).to(100000.0),
        "Equal steps from its beginning to its end; each ends in a state of the history."),
    key("stages[].drive.<name>.diameter_ratio", Number, "", OrElse(BEFORE_1, "1.0"), above(0.0).to(10.0),
        "Target of a circular muscle: its narrowest (or widest) stress-free diameter over the diameter, Dmin/D."),
    key("stages[].drive.<name>.length_ratio", Number, "", OrElse(BEFORE_1, "1.0"), above(0.0).to(10.0),
        "Target of a longitudinal muscle: the stress-free length of the whole tube over its length, Lmax/L."),
    key("stages[].drive.<name>.displacement", Number, "length", OrElse(BEFORE_0, "0.0"), ANY,
        "For `colon` or `ileum`: where along the axis the end is brought, from its place at rest. The end is fixed or sliding."),
    key("stages[].drive.<name>.twist_degrees", Number, "degrees", OrElse(BEFORE_0, "0.0"), from(-3600.0).to(3600.0),
        "For `colon` or `ileum`: how far the end is turned about the axis. The end is fixed."),
    key("stages[].drive.<name>.pressure", Number, "stress", OrElse(BEFORE_0, "0.0"), ANY,
        "For `inner-wall`, which it pushes outwards, or `outer-wall`, which it pushes inwards: true pressure, per area as it is and \
         normal to the wall as it is. Needs both ends held (fixed or sliding)."),
    key("stages[].drive.<name>.dead_load", Number, "stress", OrElse(BEFORE_0, "0.0"), ANY,
        "For `inner-wall` or `outer-wall`: a dead load, per area at rest and normal to the wall at rest."),

    key("imperfections", Tables, "", Or("[]"), ANY,
        "What is not as round or as even as it should be."),
    key("imperfections[].of", Word(&["colon-end", "ileum-end", "geometry"]), "", Always("\"colon-end\""), ANY,
        "What is imperfect: where an end is held; the shape in which the wall is free of stress; or a muscle, as below."),
    key("imperfections[].of.muscle", Text, "", OrElse("", "\"circular\""), ANY,
        "`of = { muscle = \"circular\" }`: how strong a muscle is. Its stress-free stretch θ becomes 1 + (θ − 1)(1 + amplitude · shape)."),
    key("imperfections[].amplitude", Number, "length", Always("1e-4"), ANY,
        "Size of the displacement where the shape is 1, or where a mode is largest; of a muscle not a length, but a fraction of its activity."),
    key("imperfections[].direction", Word(&["across", "axial"]), "", OrElse("across", "\"across\""), ANY,
        "For an end: `\"across\"` in its plane, normal to the wall and around it so that no ring changes length; harmonic 1 shifts \
         the end sideways. `\"axial\"` along the axis; harmonic 1 tilts it."),
    key("imperfections[].shape", Choice, "", Always("{ wave = { mode = 1 } }"), ANY,
        "How it is spread: `shape = { wave = { mode = 2 } }`, `shape = { random = { seed = 7 } }` or, of the geometry, \
         `shape = { mode = \"…\" }`."),
    key("imperfections[].shape.wave.mode", Count, "", Always("1"), from(0.0).to(1024.0),
        "Waves around the tube, n in cos n(φ − φ₀). 0 is the same all around, 1 goes sideways, 2 is oval."),
    key("imperfections[].shape.wave.phase_degrees", Number, "degrees", Or("0.0"), from(-360.0).to(360.0),
        "φ₀, the angle of a crest."),
    key("imperfections[].shape.wave.axial", Word(&["uniform", "half-sine"]), "", OrElse("uniform; of the geometry half-sine", "\"uniform\""), ANY,
        "Factor along the zone of the muscle, or the tube: one, or sin πx. Not for an end."),
    key("imperfections[].shape.wave.axial.zone", Zone, "length", OrElse("", "[0.5, 1.0]"), ANY,
        "`axial = { zone = [0.5, 1.0] }`: ½(1 − cos 2πx) over a zone, and nothing elsewhere."),
    key("imperfections[].shape.random.seed", Count, "", Always("7"), from(0.0).to(1e9),
        "Any number; the same seed gives the same shape for ever, another seed another one."),
    key("imperfections[].shape.random.modes", Count, "", OrElse("4, or as many as the rings tell apart", "4"), from(0.0).to(50.0),
        "Harmonics 0 to this around the tube, of those that the symmetry allows; all are as likely to be large."),
    key("imperfections[].shape.random.half_waves", Count, "", Or("4"), from(1.0).to(50.0),
        "1 to this half-waves along the zone of the muscle, or the tube. Not for an end."),
    key("imperfections[].shape.mode", Text, "", OrElse("", "\"runs/tube/modes/mode-01-harmonic-2.safetensors\""), ANY,
        "Path of a mode that `plica stability` has left in an axisymmetric run, from the folder of the case file on, lying as `start.state` does; for \
         the geometry only. A mode of harmonic n has a crest at angle zero."),

    key("solver.scheme", Word(&["static", "newmark", "backward-euler"]), "", Or("\"static\""), ANY,
        "`\"static\"`: equilibrium after equilibrium, with relaxation where the path breaks off. `\"newmark\"`: the pseudo-time of \
         Okino et al. (2025). `\"dragged\"`: pseudo-time by backward Euler."),
    key("solver.tolerance", Number, "", Or("1e-8"), above(0.0).to(1e-6).because("a looser state is not an equilibrium"),
        "A state is accepted when its residual, without drag and over the forces in play, is at most this (or at most 1e-6 where rounding allows no better)."),
    key("solver.newton_iterations", Count, "", Or("12"), from(1.0).to(1000.0),
        "Newton iterations before a step is given to relaxation."),
    key("solver.relaxation_steps", Count, "", Or("200"), from(1.0).to(1e6),
        "Relaxation steps before a step is halved."),
    key("solver.relaxation_damping", Number, "E/D²", Or("1.0"), above(0.0).to(1e6),
        "Drag at which relaxation starts, per unit volume."),
    key("solver.max_step_halvings", Count, "", Or("8"), from(0.0).to(20.0),
        "How often a step may be halved before the run stops."),

    key("solver.pseudo_time.damping", Number, "", OrElse("100 for newmark, 5 for dragged", "100.0"), above(0.0).to(1e9),
        "ηD/(EΔτ), the drag per pseudo-time step. The side to which a tube folds can depend on it, and on `ramp`."),
    key("solver.pseudo_time.ramp", Count, "", Or("10"), from(1.0).to(100000.0),
        "Pseudo-time steps over which each step of a stage is ramped."),
    key("solver.pseudo_time.tolerance", Number, "D", Or("1e-5"), above(0.0).to(0.01),
        "After the ramp, pseudo-time goes on until no control point moves more than this in a step."),
    key("solver.pseudo_time.max_steps", Count, "", Or("2000"), from(1.0).to(1e7),
        "Pseudo-time steps after the ramp before the run stops."),
    key("solver.pseudo_time.equilibrate", Switch, "", Or("true"), ANY,
        "Whether each state is then taken to equilibrium without drag. If not, states are accepted as in the paper, and say how far from equilibrium they are."),

    key("output.pictures", Switch, "", Or("true"), ANY,
        "Whether pictures are drawn."),
    key("output.profiles_every", Count, "", Or("1"), from(0.0).to(100000.0),
        "Wall profiles are written for every n-th state and for the last of a stage; 0 for none."),
    key("output.states_every", Count, "", Or("1"), from(0.0).to(100000.0),
        "Every n-th state and the last of a stage are saved in full; 0 for none. `plica stability` and cases that start from a state need them."),
    key("output.stability_modes", Count, "", Or("4"), from(0.0).to(100.0),
        "Circumferential harmonics that each axisymmetric state is tested for stability against: 0 to this. 1 tilts or shifts sideways, 2 turns oval, and so on."),
    key("output.wall_points", Count, "", Or("601"), from(51.0).to(20001.0),
        "Points along the tube at which a wall is sampled for profiles and pictures."),
];

const BEFORE_1: &str = "as in the stage before, or at the start; 1 at rest";
const BEFORE_0: &str = "as in the stage before, or at the start; 0 at rest";

const ANY: Range = Range {
    low: Limit::None,
    high: Limit::None,
    reason: "",
};

const fn from(low: f64) -> Range {
    Range {
        low: At(low),
        ..ANY
    }
}

const fn above(low: f64) -> Range {
    Range {
        low: Beyond(low),
        ..ANY
    }
}

impl Range {
    const fn to(self, high: f64) -> Self {
        Self {
            high: At(high),
            ..self
        }
    }

    const fn below(self, high: f64) -> Self {
        Self {
            high: Beyond(high),
            ..self
        }
    }

    const fn because(self, reason: &'static str) -> Self {
        Self { reason, ..self }
    }
}

const fn key(
    path: &'static str,
    kind: Kind,
    unit: &'static str,
    given: Given,
    range: Range,
    meaning: &'static str,
) -> Key {
    Key {
        path,
        kind,
        unit,
        given,
        range,
        meaning,
    }
}
