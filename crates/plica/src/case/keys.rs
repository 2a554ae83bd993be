//! All keys of the case file. A key is declared here, and nowhere else: its doc comment, default, unit
//! and range are what the reference page, the schema and the checks are made of.

use super::course::{Course, VectorCourse};
use super::key::{Key, Kind, LENGTH, STIFFNESS, STRESS, default, described, required};
pub(super) use super::law_keys::{
    ActiveStress, Fibres, Fung, Law, Material, MooneyRivlin, NamedMaterial, NeoHookean, Residual,
    Tone,
};
use super::problem::Problems;
use super::read::{Fields, Read, Table, Value, choice, choose, table};
use super::spelling::target;
use crate::activation::{Direction, Profile};
use crate::study::{LengthUnit, StressUnit};
use crate::tube::{Axial, EndDirection, Integration, SpringDirection, Support, Symmetry};
use std::collections::BTreeMap;

table! {
    /// A case as written, in its own units.
    Case {
        /// One line that describes the case, for the titles of tables and pictures.
        title: Option<String> = described("the name of the file", "case");
        /// The symmetry of the solution. With `"axisymmetric"` every cross-section stays a circle, which
        /// may twist. `"none"` is the full three-dimensional tube.
        symmetry: Symmetry = default("axisymmetric");
        /// The units of the file and of the results. Without this table lengths are in the unit of
        /// `tube.diameter`, and results in diameters D and Young's moduli E.
        units: Option<Units> = described("none", "{ length = \"mm\", stress = \"kPa\" }");
        /// The size of the tube at rest.
        tube: Tube = default("{}");
        /// The constitutive law of the wall, one of the tables below, or a material of a library by its name. Young's modulus
        /// E, in which results without units are given, is `youngs_modulus` of the law, or three times its shear modulus if
        /// it has none; of several layers the largest.
        material: Material = default("{ neo-hookean = {} }");
        /// The layers of the wall, from the inside out. Without them the wall is one layer of `material`. Strains may jump
        /// at an interface; displacements do not.
        layers: Vec<WallLayer> = default("[]");
        /// The muscles of the wall, each with a name that you choose. `colon`, `ileum`, `inner-wall`,
        /// `outer-wall` and `lumen` are taken. A name has at most 40 letters, digits, - and _.
        muscles: BTreeMap<String, Muscle> = default("{}");
        /// The supports of the two ends. A stage can move an end that is held, under the name `colon` or
        /// `ileum`.
        ends: Ends = default("{}");
        /// The control points of the splines, and their degree.
        mesh: Mesh = default("{}");
        /// Contact of the wall with itself: folds touch but do not pass through each other. For degree 2 or more,
        /// and not for axisymmetric tubes that are twisted. `false` is the formulation of the paper.
        contact: bool = default("false");
        /// The coefficient of friction of the wall with itself (Coulomb's law), with `contact = true`, in an axisymmetric
        /// tube. The stability test leaves friction out.
        friction: f64 = default("0.0").from(0.0).to(2.0);
        /// A saved state to begin from, instead of the tube at rest. The state may have another mesh, and
        /// a higher symmetry: it is interpolated and brought to equilibrium first.
        start: Option<Start> = described("at rest", "{ state = \"states/state-0015.safetensors\" }");
        /// The load stages, one after the other. Each begins where the one before ends, the first at rest
        /// or at `start`. Targets that a stage does not name stay as they are.
        stages: Vec<Stage> = required("[{ drive.circular.diameter_ratio = 0.5 }]");
        /// The branch of equilibria that `plica follow` computes, stable or not. A run does not use it.
        continuation: Option<Continuation> =
            described("none", "{ of = \"longitudinal.length_ratio\", between = [1.0, 1.25] }");
        /// Small deviations from the perfect tube, which select the branch that it follows at a
        /// bifurcation. They are present from rest on, and add up. A shape lies between −1 and 1; the
        /// amplitude multiplies it.
        imperfections: Vec<Imperfection> = default("[]");
        /// Rigid obstacles that the walls touch: an instrument in the lumen, a stent, a bolus, a
        /// neighbouring organ. In a tube with an m-fold symmetry an obstacle beside the axis is repeated m times.
        obstacles: Vec<Obstacle> = default("[]");
        /// Patches of the wall that differ from the rest: a scar, a polyp, a lead point.
        patches: Vec<Patch> = default("[]");
        /// Elastic springs between the outer wall and its surroundings, such as a mesentery. They add up.
        foundations: Vec<Foundation> = default("[]");
        /// The settings of the nonlinear solver.
        solver: Solver = default("{}");
        /// The files that a run writes, besides its history.
        output: Output = default("{}");
    }
}

choice! { Symmetry {
    "axisymmetric" => Symmetry::Axisymmetric,
    "none" => Symmetry::None,
    /// `symmetry = { fold = m }`: the tube repeats m times around its axis; m divides
    /// `mesh.control_points.around`.
    "fold": usize = described("", "2").from(2.0).to(4096.0) => Symmetry::Fold,
} }

table! {
    Units {
        /// The unit of every length in the file and in the results.
        length: LengthUnit = required("mm");
        /// The unit of every stress in the file and in the results.
        stress: StressUnit = required("kPa");
    }
}

choice! { LengthUnit {
    "m" => LengthUnit::Metre,
    "cm" => LengthUnit::Centimetre,
    "mm" => LengthUnit::Millimetre,
    "um" => LengthUnit::Micrometre,
} }

choice! { StressUnit {
    "Pa" => StressUnit::Pascal,
    "kPa" => StressUnit::Kilopascal,
    "MPa" => StressUnit::Megapascal,
} }

table! {
    Tube {
        /// Outer diameter D at rest.
        diameter: f64 = default("1.0").unit(LENGTH).from(1e-9).to(1e9);
        /// Length L at rest. The colon end is at 0, the ileum end at L.
        length: Option<f64> = described("3 diameters", "3.0").unit(LENGTH).above(0.0);
        /// Thickness H of the wall at rest, below half the diameter.
        thickness: Option<f64> = described("0.06 diameters", "0.06").unit(LENGTH).above(0.0);
        /// The outer diameter along the tube where it varies: points (position, diameter), linear between them and
        /// constant beyond. The splines round a corner over a few elements. `diameter` is that of everything which is
        /// given in diameters.
        diameter_along: Option<Vec<[f64; 2]>> = described("constant", "[[0.0, 1.0], [1.5, 1.0], [3.0, 0.8]]").unit(LENGTH);
        /// The thickness of the wall along the tube where it varies, likewise. Layers keep their shares of it.
        thickness_along: Option<Vec<[f64; 2]>> = described("constant", "[[0.0, 0.06], [3.0, 0.04]]").unit(LENGTH);
    }
}

table! {
    WallLayer {
        /// Its name, by which a muscle is placed in it. At most 40 letters, digits, - and _.
        name: Option<String> = described("layer-1, layer-2, …", "media");
        /// Its thickness at rest. All of them add up to `tube.thickness`, which need not be given.
        thickness: f64 = required("0.03").unit(LENGTH).above(0.0);
        /// The number of elements through it.
        elements: usize = default("3").from(1.0).to(60.0);
        /// Its constitutive law, as for the whole wall.
        material: Option<Material> = described("that of the whole wall", "{ neo-hookean = {} }");
        /// Families of fibres, which stiffen the law in their directions.
        fibres: Vec<Fibres> = default("[]");
        /// A constant active tension of its muscle cells.
        tone: Option<Tone> = described("none", "{ tension = 0.1 }");
        /// The stretches that make it free of stress when it is cut out of the tube at rest.
        residual: Residual = default("{}");
    }
}

table! {
    Muscle {
        /// The direction of its fibres: around the tube or along it.
        direction: Direction = required("circular");
        /// The part of the tube that it acts on, from the colon end. A stage can move it along the tube. Where zones of
        /// muscles of the same direction overlap, their stretches multiply.
        zone: [f64; 2] = required("[0.5, 1.0]").unit(LENGTH);
        /// The distance after which its zone repeats along the tube, from the start of one zone to the start of the next.
        repeat: Option<f64> = described("one zone", "1.0").unit(LENGTH).above(0.0);
        /// The distribution of its activity over the zone: ½(1 − cos 2πx), or sin πx, which has kinks at
        /// the edges of the zone.
        profile: Profile = default("raised-cosine");
        /// The name of the layer that it acts in.
        layer: Option<String> = described("all layers", "media");
        /// The sector of the circumference that it acts in: half of it, or three taeniae. Its target is that of the middle of
        /// the sector; θ − 1, or the tension, falls to zero at the edges.
        sector: Option<Sector> = described("all around", "{ width_degrees = 180.0 }");
        /// The active stress of its fibres. With it the muscle does not change the stress-free size of the wall; stages drive
        /// the `tension` of its fibres, whose stress depends on their stretch. `{}` is a stress that does not.
        active_stress: Option<ActiveStress> =
            described("none: stages drive a stress-free size", "{ best_stretch = 1.4, least_stretch = 0.8 }");
    }
}

table! {
    Sector {
        /// The angle of its middle about the axis, from x toward y.
        centre_degrees: f64 = default("0.0").unit("degrees").from(-360.0).to(360.0);
        /// Its width, with both edges.
        width_degrees: f64 = required("180.0").unit("degrees").from(1.0).to(360.0);
        /// The width of an edge, over which it rises like half a cosine.
        edge_degrees: Option<f64> = described("a quarter of the width", "20.0").unit("degrees").from(0.1).to(180.0);
        /// The number of times that it repeats around the tube, at equal angles. In a tube with an m-fold symmetry it repeats
        /// with the tube, too.
        repeat: usize = default("1").from(1.0).to(360.0);
    }
}

table! {
    Continuation {
        /// The target that is the parameter of the branch, as a stage would drive it: `longitudinal.length_ratio`,
        /// `inner-wall.pressure`, `ileum.displacement`. Several targets, separated by commas, have the same value. All
        /// others stay as they are where the branch begins.
        of: String = required("longitudinal.length_ratio");
        /// The range of the parameter, in its unit. The branch begins at the value of the state where it begins, leads toward
        /// the second number (and, in another part, toward the first), turns at folds, and ends where it leaves the range.
        between: [f64; 2] = required("[1.0, 1.25]");
        /// The name of the stage at whose end the branch begins.
        after: Option<String> = described("the last one", "contract");
        /// The events whose places are computed: `fold`, an extreme value of the parameter; `modes`, the loss and the recovery
        /// of stability to each circumferential mode up to `output.stability_modes`, with branch points of mode 0;
        /// `contact`, the first touch of the wall with itself; `energy`, an extreme value of the energy; or a column of the
        /// history, or the `parameter`, with a value, such as `max_wall_angle_deg = 90`.
        locate: Vec<String> = default("[\"fold\", \"modes\"]");
        /// The modes to whose branches `plica follow` switches at the points where it finds them.
        switch: Vec<Switch> = default("[]");
        /// The longest step, as a fraction of the range.
        longest_step: f64 = default("0.04").from(1e-4).to(0.5);
        /// The largest number of points of a branch.
        points: usize = default("300").from(2.0).to(100_000.0);
        /// The columns of the history against which the diagram is drawn.
        plot: Vec<String> = default("[\"energy\", \"max_wall_angle_deg\"]");
    }
}

table! {
    Switch {
        /// The circumferential mode: 0 follows both sides of the branch that crosses the first one. Of a mode m from 1 on, a
        /// state with the mode added is written, from which a run with `symmetry = { fold = m }` (for 1: `"none"`) begins.
        mode: usize = default("0").from(0.0).to(100.0);
        /// The amplitude of the mode at the first point of the new branch: its largest displacement.
        amplitude: f64 = default("0.01").unit("D").above(0.0).to(0.2);
    }
}

table! {
    Patch {
        /// Its name in the stages and in the results, as for a muscle.
        name: String = required("scar");
        /// The part of the tube that it covers, with its edges.
        zone: [f64; 2] = required("[0.5, 1.0]").unit(LENGTH);
        /// The length over which its effect rises like half a cosine, and falls again; 0 for a jump.
        edge: Option<f64> = described("a quarter of the zone", "0.1").unit(LENGTH).from(0.0);
        /// The sector of the circumference that it covers.
        sector: Option<Sector> = described("all around", "{ width_degrees = 90.0 }");
        /// The name of the layer that it lies in.
        layer: Option<String> = described("all layers", "media");
        /// The factor on the energy of the law, fibres and tone included, muscles not.
        stiffness: f64 = default("1.0").from(1e-3).to(1e4);
        /// The factor on the activity of muscles, by their names, from 0 to 10: θ − 1, or the tension, is multiplied by it.
        muscles: BTreeMap<String, f64> = default("{}");
    }
}

table! {
    Foundation {
        /// The part of the tube that it covers, with its edges.
        zone: Option<[f64; 2]> = described("the whole tube", "[0.5, 1.0]").unit(LENGTH);
        /// The length over which its stiffness rises like half a cosine, and falls again; 0 for a jump.
        edge: Option<f64> = described("a quarter of the zone; 0 without one", "0.1").unit(LENGTH).from(0.0);
        /// The sector of the circumference that it covers.
        sector: Option<Sector> = described("all around", "{ width_degrees = 90.0 }");
        /// The stress of the springs per displacement.
        stiffness: f64 = required("0.01").unit(STIFFNESS).from(0.0).to(1e15);
        /// The displacements that the springs resist: all, or those normal to the wall at rest.
        direction: SpringDirection = default("all");
        /// True if the springs only pull: they resist motion inwards, and leave motion outwards free. For the direction
        /// `"normal"` only.
        tension_only: bool = default("false");
    }
}

choice! { SpringDirection {
    "all" => SpringDirection::All,
    "normal" => SpringDirection::Normal,
} }

choice! { Direction {
    "circular" => Direction::Circular,
    "longitudinal" => Direction::Longitudinal,
} }

choice! { Profile {
    "raised-cosine" => Profile::RaisedCosine,
    "half-sine" => Profile::HalfSine,
    /// `profile = { smooth-box = { edge = 0.25 } }`: 1, with a smooth rise and fall at the edges.
    "smooth-box": SmoothBox = described("", "{ edge = 0.25 }")
        => |smooth: SmoothBox| Profile::SmoothBox { edge: smooth.edge },
    /// `profile = { table = [[0.0, 0.0], …] }`: linear interpolation between points (position in the
    /// zone, activity). Positions rise from 0 to 1; activities lie between 0 and 1.
    "table": Vec<[f64; 2]> = described("", "[[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]")
        => |points: Vec<[f64; 2]>| Profile::Table(points.iter().map(|&[x, s]| (x, s)).collect()),
} }

table! {
    SmoothBox {
        /// The fraction of the zone over which the activity rises, and again falls.
        edge: f64 = required("0.25").above(0.0).to(0.5);
    }
}

table! {
    Ends {
        /// The support of the end at 0. With `"fixed"` no point of the end face moves; with `"sliding"`
        /// the face slides in its plane; with `"free"` it is not held.
        colon: Support = default("fixed");
        /// The support of the end at L.
        ileum: Support = default("fixed");
        /// The name of the end at 0 in tables and pictures, such as `proximal`. At most 40 letters, digits, - and _. In the
        /// case file itself the end is called `colon`.
        colon_name: String = default("colon");
        /// The name of the end at L, which is called `ileum` in the case file itself.
        ileum_name: String = default("ileum");
    }
}

choice! { Support {
    "fixed" => Support::Fixed,
    "sliding" => Support::Sliding,
    "free" => Support::Free,
} }

table! {
    Mesh {
        /// The number of control points in each direction.
        control_points: ControlPoints = default("{}");
        /// The degree of the splines, in every direction.
        degree: usize = default("3").from(1.0).to(5.0);
        /// The quadrature of the volumetric energy: at all points, as in the paper, or at about one point
        /// per element through the wall, which prevents locking of a nearly incompressible wall with few
        /// elements through it. `"reduced"` needs degree 3 or 5.
        volumetric_integration: Integration = default("full");
        /// Zones with smaller elements along the tube; `refine = []` is a uniform mesh. Where zones
        /// overlap, the largest factor holds.
        refine: Option<Vec<Refine>> =
            described("the zones of the muscles that stay in place, factor 3", "[{ zone = [0.5, 1.0], factor = 3.0 }]");
        /// The thickness of the innermost element of the wall over that of the outermost; those in
        /// between form a geometric sequence. Above 1 the elements become thinner towards the outer
        /// surface, where a fold creases; 1 is uniform. `"reduced"` integration and several layers need 1.
        grading: f64 = default("1.0").from(0.001).to(1000.0);
        /// The range of the law of contact, in smallest axial elements at rest. Half and double the range
        /// show how far the results depend on it.
        contact_range: f64 = default("0.25").from(0.001).to(100.0);
    }
}

table! {
    ControlPoints {
        /// Control points along the tube, more than the degree.
        axial: usize = default("305").from(2.0).to(20000.0);
        /// Control points around the whole tube, whatever the symmetry; at least twice the degree plus
        /// two.
        around: usize = default("60").from(4.0).to(4096.0);
        /// Control points through the wall, more than the degree. A wall with layers has `layers[].elements` instead.
        thickness: Option<usize> = described("8, or as many as the layers need", "8").from(2.0).to(64.0);
    }
}

choice! { Integration {
    "full" => Integration::Full,
    "reduced" => Integration::Reduced,
} }

table! {
    Refine {
        /// The part of the tube that is refined.
        zone: [f64; 2] = required("[0.5, 1.0]").unit(LENGTH);
        /// The density of elements, relative to the rest of the tube.
        factor: f64 = default("3.0").from(1.0).to(100.0);
    }
}

table! {
    Start {
        /// Path of the saved state, relative to the folder of the case file. The file lies in that
        /// folder, in the one that plica runs in, or in one that `--within DIR` names.
        state: String = required("runs/tube/states/state-0015.safetensors");
    }
}

const BEFORE_1: &str = "as in the stage before, or at the start; 1 at rest";
const BEFORE: &str = "as in the stage before, or at the start";
const BEFORE_0: &str = "as in the stage before, or at the start; 0 at rest";

table! {
    Stage {
        /// Its name in tables.
        name: Option<String> = described("stage-1, stage-2, …", "stage-1");
        /// The number of equal load steps. Each ends in a state of the history.
        steps: usize = default("20").from(1.0).to(100_000.0);
        /// Its duration, in any unit of time. If a stage has one, the history has a column `time`.
        duration: Option<f64> = described("1", "12.0").above(0.0).to(1e9);
        /// The targets at its end: of muscles, obstacles and patches, by their names, of the ends `colon` and `ileum`, of
        /// the surfaces `inner-wall` and `outer-wall`, and of the `lumen`. A target that is a number is reached linearly. A
        /// list of points `[time, value]`, or `[time, x, y, z]`, is followed from point to point, with times from the start of
        /// the stage; after its last point the value stays.
        drive: BTreeMap<String, Drive> = default("{}");
    }
}

table! {
    Drive meant by target {
        /// Target of a circular muscle: the smallest (or largest) stress-free diameter over the diameter
        /// at rest, Dmin/D.
        diameter_ratio: Option<Course> = described(BEFORE_1, "1.0").above(0.0).to(10.0);
        /// Target of a longitudinal muscle: the stress-free length of the whole tube over its length at
        /// rest, Lmax/L.
        length_ratio: Option<Course> = described(BEFORE_1, "1.0").above(0.0).to(10.0);
        /// Target of a muscle: the stress-free stretch where its profile is largest. It takes the place of the two above.
        stretch: Option<Course> = described(BEFORE_1, "1.0").above(0.0).to(100.0);
        /// Target of a muscle with `active_stress`: the nominal stress T of its fibres where its profile is largest, and at
        /// their best stretch.
        tension: Option<Course> = described(BEFORE_0, "0.05").unit(STRESS).from(0.0).to(1e15);
        /// Target of a muscle: the shift of its zone along the tube from where it was at rest.
        shift: Option<Course> = described(BEFORE_0, "0.0").unit(LENGTH);
        /// Target of a patch: the stress-free thickness of the wall over its thickness at rest, in the middle of the patch.
        growth_through: Option<Course> = described(BEFORE_1, "1.5").from(0.1).to(10.0);
        /// Target of a fixed or sliding end: its axial displacement from rest.
        displacement: Option<Course> = described(BEFORE_0, "0.0").unit(LENGTH);
        /// Target of a fixed end: its rotation about the axis.
        twist_degrees: Option<Course> =
            described(BEFORE_0, "0.0").unit("degrees").from(-3600.0).to(3600.0);
        /// Target of a surface: follower pressure, per deformed area and normal to the deformed surface.
        /// It pushes the inner wall outwards and the outer wall inwards. Both ends must be held (fixed or
        /// sliding).
        pressure: Option<Course> = described(BEFORE_0, "0.0").unit(STRESS);
        /// Target of `lumen`: the volume between the ends over that at rest. The pressure that holds it is a result, so that
        /// the path goes on past a maximum of the pressure. The pressure is taken over from the stage before, and the other
        /// way round. Both ends must be held.
        volume_ratio: Option<Course> = described(BEFORE, "1.5").from(0.001).to(10_000.0);
        /// Target of `lumen`: the same as a volume.
        volume: Option<Course> = described(BEFORE, "3.0").unit("length³");
        /// Target of a fixed end of a tube without symmetry: its displacement [x, y] across the axis from rest.
        offset: Option<VectorCourse<2>> = described(BEFORE_0, "[0.1, 0.0]").unit(LENGTH);
        /// Target of a fixed end of a tube without symmetry: its rotation about the axis [x, y] through its centre, by the
        /// length of this vector; after that by `twist_degrees`.
        tilt_degrees: Option<VectorCourse<2>> = described(BEFORE_0, "[0.0, 30.0]").unit("degrees");
        /// Target of a surface: a dead load, per area at rest and normal to the surface at rest.
        dead_load: Option<Course> = described(BEFORE_0, "0.0").unit(STRESS);
        /// Target of an obstacle: its radius. Not of a plate.
        radius: Option<Course> = described(BEFORE, "0.3").unit(LENGTH).above(0.0);
        /// Target of an obstacle: its position.
        position: Option<VectorCourse<3>> = described(BEFORE, "[0.0, 0.0, 1.5]").unit(LENGTH);
    }
}

table! {
    Imperfection {
        /// The part that is imperfect: the position of an end face, the stress-free shape of the wall, or
        /// a muscle, as below.
        of: Part = required("colon-end");
        /// The displacement where the shape is 1, or where a mode is largest. Of a muscle, not a length
        /// but a fraction of its activity.
        amplitude: f64 = required("1e-4").unit(LENGTH);
        /// The direction of the displacement of an end. `"across"` is in its plane, normal to the wall
        /// and around it so that no ring changes its length; mode 1 shifts the end sideways. `"axial"` is
        /// along the axis; mode 1 tilts the end.
        direction: Option<EndDirection> = described("across", "across");
        /// The shape: `shape = { wave = { mode = 2 } }`, `shape = { random = { seed = 7 } }` or, of the
        /// geometry, `shape = { mode = "…" }`.
        shape: Shape = required("{ wave = { mode = 1 } }");
    }
}

/// The part that an imperfection is of.
#[derive(Clone, Debug)]
pub(super) enum Part {
    ColonEnd,
    IleumEnd,
    Geometry,
    Muscle(String),
}

choice! { Part {
    "colon-end" => Part::ColonEnd,
    "ileum-end" => Part::IleumEnd,
    "geometry" => Part::Geometry,
    /// `of = { muscle = "circular" }`: the strength of a muscle. Its stress-free stretch θ becomes
    /// 1 + (θ − 1)(1 + amplitude · shape); an active tension is multiplied by 1 + amplitude · shape.
    "muscle": String = described("", "circular") => Part::Muscle,
} }

choice! { EndDirection {
    "across" => EndDirection::Across,
    "axial" => EndDirection::Axial,
} }

/// The shape of an imperfection.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    Wave(Wave),
    Random(Random),
    Mode(String),
}

choice! { Shape {
    /// A single wave around the tube.
    "wave": Wave = described("", "{ mode = 1 }") => Shape::Wave,
    /// A random sum of waves.
    "random": Random = described("", "{ seed = 7 }") => Shape::Random,
    /// Path of a mode that `plica stability` found in an axisymmetric run; its place as for
    /// `start.state`. For the geometry only. A mode n has a crest at angle zero.
    "mode": String = described("", "runs/tube/modes/mode-01-harmonic-2.safetensors") => Shape::Mode,
} }

table! {
    Wave {
        /// Circumferential mode n, the number of waves in cos n(φ − φ₀). Mode 0 is axisymmetric, 1 is a
        /// sideways shift, 2 is oval.
        mode: usize = required("1").from(0.0).to(1024.0);
        /// φ₀, the angle of a crest.
        phase_degrees: f64 = default("0.0").unit("degrees").from(-360.0).to(360.0);
        /// The factor along the zone of the muscle, or along the tube: 1, or sin πx. Not for an end.
        axial: Option<Axial> = described("uniform; of the geometry half-sine", "uniform");
    }
}

choice! { Axial {
    "uniform" => Axial::Uniform,
    "half-sine" => Axial::HalfWaves(1),
    /// `axial = { zone = [0.5, 1.0] }`: ½(1 − cos 2πx) in a zone, and 0 elsewhere.
    "zone": [f64; 2] = described("", "[0.5, 1.0]").unit(LENGTH) => Axial::Zone,
} }

table! {
    Random {
        /// The seed of the generator. The same seed gives the same shape in every version of plica.
        seed: usize = required("7").from(0.0).to(1e9);
        /// The largest circumferential mode, of those that the symmetry allows. All modes have the same
        /// variance.
        modes: Option<usize> = described("4, or as many as the mesh resolves", "4").from(0.0).to(50.0);
        /// The largest number of half-waves along the zone of the muscle, or along the tube. Not for an
        /// end.
        half_waves: Option<usize> = default("4").from(1.0).to(50.0);
    }
}

table! {
    Obstacle {
        /// Its name in the stages and in the results, as for a muscle.
        name: String = required("bolus");
        /// The shape: `shape = { ball = { radius = 0.3, position = [0.0, 0.0, -0.5] } }`, for example. The obstacle does
        /// not touch the tube at rest.
        shape: ObstacleShape = required("{ rod = { radius = 0.2 } }");
        /// The coefficient of friction of the walls on it (Coulomb's law). The stability test leaves friction out.
        friction: f64 = default("0.0").from(0.0).to(2.0);
    }
}

/// The shape of an obstacle.
#[derive(Clone, Debug)]
pub(super) enum ObstacleShape {
    Rod(Rod),
    Sheath(Sheath),
    Ball(Ball),
    Plate(Plate),
}

choice! { ObstacleShape {
    /// A solid cylinder along z.
    "rod": Rod = described("", "{ radius = 0.2 }") => ObstacleShape::Rod,
    /// A rigid body around an endless cylindrical hole along z.
    "sheath": Sheath = described("", "{ radius = 0.6 }") => ObstacleShape::Sheath,
    /// A ball.
    "ball": Ball = described("", "{ radius = 0.3, position = [0.0, 0.0, -0.5] }") => ObstacleShape::Ball,
    /// A half-space with a flat surface.
    "plate": Plate = described("", "{ position = [0.6, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }") => ObstacleShape::Plate,
} }

table! {
    Rod {
        /// Its radius.
        radius: f64 = required("0.2").unit(LENGTH).above(0.0);
        /// The length of its cylinder, which ends in two hemispheres.
        length: Option<f64> = described("endless", "1.0").unit(LENGTH).from(0.0);
        /// The middle of its axis.
        position: [f64; 3] = default("[0.0, 0.0, 0.0]").unit(LENGTH);
    }
}

table! {
    Sheath {
        /// The radius of the hole.
        radius: f64 = required("0.6").unit(LENGTH).above(0.0);
        /// A point of its axis.
        position: [f64; 3] = default("[0.0, 0.0, 0.0]").unit(LENGTH);
    }
}

table! {
    Ball {
        /// Its radius.
        radius: f64 = required("0.3").unit(LENGTH).above(0.0);
        /// Its centre.
        position: [f64; 3] = required("[0.0, 0.0, -0.5]").unit(LENGTH);
    }
}

table! {
    Plate {
        /// A point of its surface.
        position: [f64; 3] = required("[0.6, 0.0, 0.0]").unit(LENGTH);
        /// A vector of any length that is normal to the surface and points out of the plate, toward the tube.
        normal: [f64; 3] = required("[-1.0, 0.0, 0.0]");
    }
}

/// The method by which the tube moves along its path.
#[derive(Clone, Copy, Debug)]
pub(super) enum Scheme {
    Static,
    Newmark,
    BackwardEuler,
}

table! {
    Solver {
        /// `"static"` solves for one equilibrium after the other, with relaxation where the path is
        /// interrupted. `"newmark"` is the pseudo-time of Okino et al. (2025), `"backward-euler"`
        /// pseudo-time with another integrator.
        scheme: Scheme = default("static");
        /// A state is accepted when its residual without damping, relative to the residual scale, is at
        /// most this (or at most 1e-6 where rounding allows no better).
        tolerance: f64 = default("1e-8").above(0.0).to(1e-6)
            .because("a looser state is not an equilibrium");
        /// Newton iterations allowed for a step. If they do not suffice, the step is halved up to five times, then relaxed.
        newton_iterations: usize = default("12").from(1.0).to(1000.0);
        /// Linear solves allowed for a relaxation. If they do not suffice, the load step is halved further.
        relaxation_steps: usize = default("200").from(1.0).to(1e6);
        /// Initial damping of the relaxation, per unit volume.
        relaxation_damping: f64 = default("1.0").unit("E/D²").above(0.0).to(1e6);
        /// The number of times that a load step may be halved before the run stops.
        max_step_halvings: usize = default("8").from(0.0).to(20.0);
        /// For the schemes `"newmark"` and `"backward-euler"` only.
        pseudo_time: Option<PseudoTime> = described("–", "{}");
    }
}

choice! { Scheme {
    "static" => Scheme::Static,
    "newmark" => Scheme::Newmark,
    "backward-euler" => Scheme::BackwardEuler,
} }

table! {
    PseudoTime {
        /// ηD/(EΔτ), the damping per pseudo-time step. The direction of a fold can depend on it, and on
        /// `ramp`.
        damping: Option<f64> = described("100 for newmark, 5 for backward-euler", "100.0").above(0.0).to(1e9);
        /// Pseudo-time steps over which each load step is ramped.
        ramp: usize = default("10").from(1.0).to(100_000.0);
        /// After the ramp, pseudo-time continues until no control point moves farther than this in a
        /// step.
        tolerance: f64 = default("1e-5").unit("D").above(0.0).to(0.01);
        /// Pseudo-time steps after the ramp before the run stops.
        max_steps: usize = default("2000").from(1.0).to(1e7);
        /// Brings each state to equilibrium without damping afterwards. Otherwise states are accepted
        /// as in the paper, and their residual is reported.
        equilibrate: bool = default("true");
    }
}

table! {
    Output {
        /// Draws pictures at the end of a run.
        pictures: bool = default("true");
        /// Wall profiles are written for every n-th state and for the last of a stage; 0 for none.
        profiles_every: usize = default("1").from(0.0).to(100_000.0);
        /// Every n-th state and the last of a stage are saved in full; 0 for none. `plica stability` and
        /// cases that start from a state need them.
        states_every: usize = default("1").from(0.0).to(100_000.0);
        /// The largest circumferential mode that the stability of axisymmetric states is tested against,
        /// beginning at 0. Mode 1 tilts or shifts sideways, mode 2 is oval.
        stability_modes: usize = default("4").from(0.0).to(100.0);
        /// Points along the tube at which the wall is sampled for profiles and pictures.
        wall_points: usize = default("601").from(51.0).to(20001.0);
    }
}
