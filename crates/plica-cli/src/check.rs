//! `plica check`.

use crate::args::CaseArguments;
use crate::failure::Failure;
use crate::law_text::law_name;
use crate::{case_file, console};
use plica::activation::{AngularSector, Muscle};
use plica::material::{Material, NeoHookean, Volumetric};
use plica::run_directory::DiskUse;
use plica::spline::Circle;
use plica::study::{Plan, Scale, check_memory, forecast};
use plica::tube::{
    End, Foundation, Imperfection, Integration, Load, Outline, Part, Patch, Region, Shape,
    SpringDirection, Symmetry, Tube, WallLayer,
};

/// Checks a case and prints its size and estimated cost.
pub fn check(arguments: &CaseArguments) -> Result<(), Failure> {
    let (_, plan) = case_file::open(arguments)?;
    let mut text = format!("{} is valid: {}\n\n", arguments.file.display(), plan.title);
    for (name, value) in rows(&plan) {
        text += &format!("  {name:<10} {value}\n");
    }
    for warning in case_file::advice(&plan) {
        text += &format!("\nwarning: {warning}");
    }
    console::print(&(text.trim_end().to_owned() + "\n"))?;
    check_memory(&plan).map_err(|error| Failure::Run(error.into()))
}

/// Returns the names and values of the printed table.
fn rows(plan: &Plan) -> Vec<(&'static str, String)> {
    let (tube, mesh) = (&plan.tube, &plan.mesh);
    let forecast = forecast(plan);
    let [axial, around, thickness] = mesh.elements();
    let symmetry = match plan.symmetry {
        Symmetry::Axisymmetric => "axisymmetric".to_owned(),
        Symmetry::Fold(m) => format!("{m}-fold"),
        Symmetry::None => "none, the full tube".to_owned(),
    };
    let scheme = plan.solver.scheme.name();
    let states = 1 + plan.stages.iter().map(|stage| stage.steps).sum::<usize>();
    let muscles = tube.muscles.iter().map(|muscle| {
        let active = (!muscle.grows()).then(|| "active stress".to_owned());
        let kinds: Vec<String> = muscle.sector.iter().map(sector).chain(active).collect();
        match kinds.is_empty() {
            true => muscle.name.clone(),
            false => format!("{} ({})", muscle.name, kinds.join(", ")),
        }
    });
    let muscles: Vec<String> = muscles.collect();
    let mut rows = vec![
        (
            "tube",
            format!(
                "{} D long, wall {} D thick{}",
                six_decimals(tube.length),
                six_decimals(tube.thickness),
                match tube.layers[0].material {
                    Material::NeoHookean(NeoHookean {
                        volumetric: Volumetric::Quadratic,
                        ..
                    }) => ", quadratic volumetric law",
                    _ => "",
                }
            ),
        ),
        (
            "muscles",
            if muscles.is_empty() {
                "none".into()
            } else {
                muscles.join(", ")
            },
        ),
        ("symmetry", symmetry),
        (
            "mesh",
            format!(
                "{} x {} x {} control points of degree {}{}",
                mesh.axial,
                mesh.around,
                mesh.thickness,
                mesh.degree,
                match mesh.volumetric {
                    Integration::Full => "",
                    Integration::Reduced => ", reduced volumetric integration",
                }
            ),
        ),
        (
            "elements",
            format!(
                "{axial} x {around} x {thickness}, {}",
                grouped(forecast.elements)
            ),
        ),
        (
            "unknowns",
            format!(
                "{} in the whole tube, {} solved for",
                grouped(forecast.unknowns),
                grouped(forecast.unknowns_solved)
            ),
        ),
        (
            "circle",
            format!(
                "relative error of the radius {:.1e}",
                Circle::new(mesh.degree, mesh.around).error
            ),
        ),
        (
            "states",
            format!("{states}, stages: {}, scheme: {scheme}", plan.stages.len()),
        ),
        (
            "memory",
            format!("about {}", memory(forecast.memory_bytes as f64)),
        ),
        ("disk", disk(plan)),
        (
            "time",
            format!(
                "about {}, {} where the tube snaps through, plus pictures",
                duration(forecast.seconds_estimate),
                match (
                    plan.mesh.rings(plan.symmetry),
                    tube.imperfections.is_empty()
                ) {
                    (2.., false) => "many times more",
                    _ => "more",
                }
            ),
        ),
    ];
    if !tube.patches.is_empty() {
        let patches: Vec<String> = tube.patches.iter().map(|own| patch(tube, own)).collect();
        rows.push(("patches", patches.join("; ")));
    }
    if !tube.foundations.is_empty() {
        let all = tube.foundations.iter().map(foundation);
        rows.push(("foundations", all.collect::<Vec<_>>().join("; ")));
    }
    let is_outline = |one: &&Imperfection| matches!(one.shape, Shape::Outline(_));
    let (outlines, imperfections): (Vec<_>, Vec<_>) =
        tube.imperfections.iter().partition(is_outline);
    for (name, those) in [("imperfect", imperfections), ("shape", outlines)] {
        let described: Vec<String> = those.iter().map(|one| imperfection(tube, one)).collect();
        if !described.is_empty() {
            rows.insert(3, (name, described.join("; ")));
        }
    }
    let is_simple = |layer: &WallLayer| {
        let law = &layer.material;
        matches!(law, Material::NeoHookean(_) | Material::MooneyRivlin(_))
            && layer.residual.is_none()
    };
    if tube.layers.len() > 1 || !tube.layers.iter().all(is_simple) {
        let layers = tube.layers.iter().zip(mesh.elements_of_layers());
        for (i, (layer, elements)) in layers.enumerate() {
            rows.insert(1 + i, ("layer", layer_row(tube, layer, elements.len())));
        }
    }
    if let Some(start) = &plan.start {
        let (row, stage) = (start.state.row, &start.state.stage);
        rows.insert(
            3,
            ("start", format!("{}: state {row}, {stage}", start.file)),
        );
    }
    if let Some(units) = &plan.units {
        let (d, e) = (units.diameter, units.youngs_modulus);
        let units = format!("D = {d} {}, E = {e} {}", units.length, units.stress);
        rows.insert(1, ("units", units));
    }
    let muscles = rows.iter().position(|row| row.0 == "muscles");
    let at = muscles.map_or(rows.len(), |at| at + 1);
    for (title, lines) in [("tensions", tensions(plan)), ("stretches", stretches(plan))] {
        for (i, line) in lines.into_iter().enumerate() {
            let name = if i == 0 { title } else { "" };
            rows.insert(at + i, (name, line));
        }
    }
    rows
}

/// Rounds a length to six decimals, which are printed without zeros at the end.
fn six_decimals(x: f64) -> f64 {
    (1e6 * x).round() / 1e6
}

/// Describes a layer: thickness, elements, law, fibres and residual stretches.
fn layer_row(tube: &Tube, layer: &WallLayer, elements: usize) -> String {
    let mut text = format!(
        "{}, {:.4} D thick, {elements} elements, {}",
        layer.name,
        layer.share * tube.thickness,
        law_name(&layer.material)
    );
    if layer.material.has_tone() {
        text += ", an active tension";
    }
    if let Some(opening) = &layer.residual.opening {
        text += &format!(", opens by {:.1}°", 360.0 * (1.0 - opening.fraction));
    }
    for (name, [inner, outer]) in [
        ("around", layer.residual.around),
        ("along", layer.residual.along),
    ] {
        if [inner, outer] != [1.0; 2] {
            text += &format!(", residual stretch {name} {inner} to {outer}");
        }
    }
    text
}

/// Describes the room that the run takes on the disk.
fn disk(plan: &Plan) -> String {
    let forecast = DiskUse::of(plan);
    let mut parts = vec![];
    for (name, bytes) in [
        ("saved states", forecast.states),
        ("profiles", forecast.profiles),
        ("history", forecast.history),
    ] {
        if bytes > 0 {
            parts.push(format!("{name} {}", memory(bytes as f64)));
        }
    }
    let total = memory(forecast.total() as f64);
    format!("about {total}: {}", parts.join(", "))
}

/// Describes the smallest and largest tension of the muscles with active stress in each stage.
fn tensions(plan: &Plan) -> Vec<String> {
    let scale = Scale::of(plan.units.as_ref());
    of_stages(
        plan,
        |muscle| !muscle.grows(),
        |m, loads| {
            let tensions = loads.map(|load| scale.stress * load.muscles[m]);
            let (least, largest) =
                tensions.fold((f64::INFINITY, 0.0), |(a, b), x| (x.min(a), x.max(b)));
            format!("{least:.3} to {largest:.3} {}", scale.stress_name)
        },
    )
}

/// Describes the smallest and largest stress-free stretch of the muscles in each stage.
fn stretches(plan: &Plan) -> Vec<String> {
    let tube = &plan.tube;
    of_stages(plan, Muscle::grows, |m, loads| {
        let muscle = &tube.muscles[m];
        let (mut least, mut largest) = (1.0_f64, 1.0_f64);
        for load in loads {
            let ratio = load.muscles[m];
            least = least.min(muscle.smallest_stretch(ratio, tube.length));
            // The stretch is linear in the ratio, and 1 at 1.
            largest = largest.max(2.0 - muscle.smallest_stretch(2.0 - ratio, tube.length));
        }
        format!("{least:.2} to {largest:.2}")
    })
}

/// Describes muscles in each stage, from the loads of the stage and the one at its begin.
fn of_stages(
    plan: &Plan,
    is_described: impl Fn(&Muscle) -> bool,
    describe: impl Fn(usize, &mut dyn Iterator<Item = &Load>) -> String,
) -> Vec<String> {
    let muscles = plan.tube.muscles.iter().enumerate();
    let muscles: Vec<_> = muscles.filter(|(_, muscle)| is_described(muscle)).collect();
    if muscles.is_empty() {
        return vec![];
    }
    let mut before = plan.first_load();
    let mut lines = vec![];
    for stage in &plan.stages {
        let described = muscles.iter().map(|(m, muscle)| {
            let text = describe(*m, &mut stage.loads().chain([&before]));
            format!("{} {text}", muscle.name)
        });
        let described: Vec<String> = described.collect();
        lines.push(format!("{}: {}", stage.name, described.join(", ")));
        before = stage.load.clone();
    }
    lines
}

/// Describes a patch: name, place and factors.
fn patch(tube: &Tube, patch: &Patch) -> String {
    let mut parts = vec![format!("{} {}", patch.name, region(&patch.region))];
    if patch.stiffness != 1.0 {
        parts.push(format!("stiffness × {}", patch.stiffness));
    }
    for (muscle, factor) in tube.muscles.iter().zip(&patch.muscles) {
        if *factor != 1.0 {
            parts.push(format!("{} × {factor}", muscle.name));
        }
    }
    parts.join(", ")
}

/// Describes a foundation: place, stiffness and direction.
fn foundation(foundation: &Foundation) -> String {
    let direction = match foundation.direction {
        SpringDirection::All => "all directions",
        SpringDirection::Normal => "normal",
        SpringDirection::Inward => "normal, tension only",
    };
    let place = region(&foundation.region);
    format!("{place}, {:.4e} E/D, {direction}", foundation.stiffness)
}

/// Describes a part of the tube.
fn region(region: &Region) -> String {
    let [from, to] = region.zone;
    let around = region
        .sector
        .map_or(String::new(), |own| format!(", {}", sector(&own)));
    format!("{from:.4} to {to:.4} D{around}")
}

/// Describes a sector of the circumference.
fn sector(sector: &AngularSector) -> String {
    let [width, centre] = [sector.width, sector.centre].map(f64::to_degrees);
    match sector.repeats {
        1 => format!("{width:.1}° around {centre:.1}°"),
        n => format!("{n} times {width:.1}° from {centre:.1}°"),
    }
}

/// Describes an imperfection: part, shape and amplitude.
fn imperfection(tube: &Tube, imperfection: &Imperfection) -> String {
    let shape = match &imperfection.shape {
        Shape::Wave(wave) => format!("circumferential mode {}", wave.harmonic),
        Shape::Random(random) => format!("random, seed {}", random.seed()),
        Shape::Mode(mode) => format!("buckling mode, circumferential mode {}", mode.harmonic),
        Shape::Outline(outline) => return outline_of(outline),
    };
    let unit = match imperfection.of {
        Part::Muscle(_) => "",
        Part::End(..) | Part::Geometry => " D",
    };
    let (part, amplitude) = (part(tube, imperfection.of), imperfection.amplitude);
    format!("{part} ({shape}, {amplitude:.1e}{unit})")
}

/// Describes a diameter and a thickness that vary along the tube.
fn outline_of(outline: &Outline) -> String {
    let range = |what: &str, points: &[[f64; 2]]| {
        let values = points.iter().map(|[_, value]| *value);
        let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
        (!points.is_empty()).then(|| format!("{what} {low:.4} to {high:.4} D along the tube"))
    };
    let parts = [
        range("diameter", &outline.diameter),
        range("thickness", &outline.thickness),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Returns the name of an imperfect part.
fn part(tube: &Tube, of: Part) -> String {
    match of {
        Part::End(End::Colon, _) => "colon end".into(),
        Part::End(End::Ileum, _) => "ileum end".into(),
        Part::Geometry => "geometry".into(),
        Part::Muscle(m) => tube.muscles[m].name.clone(),
    }
}

/// Formats 439200 as 439,200.
fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Formats a number of bytes.
fn memory(bytes: f64) -> String {
    match bytes {
        b if b < 1e6 => format!("{:.0} kB", (b / 1e3).ceil()),
        b if b < 1e9 => format!("{:.0} MB", (b / 1e6).ceil()),
        b => format!("{:.1} GB", b / 1e9),
    }
}

/// Formats a time in seconds.
fn duration(seconds: f64) -> String {
    match seconds {
        s if !s.is_finite() => "an unknown time".into(),
        s if s < 90.0 => format!("{:.0} s", s.ceil()),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}
