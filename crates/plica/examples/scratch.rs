use plica::activation::*;
use plica::assembly::*;
use plica::material::*;
use plica::solve::*;
use plica::spline::*;
use plica::study::*;
use plica::tube::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let n: usize = args.get(1).map_or(305, |s| s.parse().unwrap());
    let factor: f64 = args.get(2).map_or(3.0, |s| s.parse().unwrap());
    let csteps: usize = args.get(3).map_or(15, |s| s.parse().unwrap());
    let rsteps: usize = args.get(4).map_or(25, |s| s.parse().unwrap());
    let m = |name: &str, direction| Muscle {
        name: name.into(),
        direction,
        zone: [0.5, 1.0],
        profile: Profile::RaisedCosine,
    };
    let tube = Tube {
        length: 3.0,
        thickness: 0.06,
        material: Material::NeoHookean(NeoHookean::new(1.0, 0.495)),
        muscles: vec![m("c", Direction::Circular), m("l", Direction::Longitudinal)],
        ends: [Support::Fixed; 2],
    };
    let mesh = Mesh {
        axial: n,
        around: 60,
        thickness: 8,
        degree: 3,
        refinements: vec![Refinement {
            from: 0.5,
            to: 1.0,
            factor,
        }],
    };
    let p = TubeProblem::new(SplineTube::new(&tube, &mesh, 1));
    let load0 = tube.rest();
    let t0 = std::time::Instant::now();
    for _ in 0..10 {
        p.tube
            .forces(&load0, &vec![0.0; p.tube.unknowns()])
            .unwrap();
    }
    println!("forces {:?}", t0.elapsed() / 10);
    let t0 = std::time::Instant::now();
    for _ in 0..10 {
        p.tube.tangent(&load0, &vec![0.0; p.tube.unknowns()]);
    }
    println!("tangent {:?}", t0.elapsed() / 10);
    let mut k = p.tube.tangent(&load0, &vec![0.0; p.tube.unknowns()]);
    k.constrain(p.given());
    let t0 = std::time::Instant::now();
    for _ in 0..10 {
        k.clone().factor().unwrap();
    }
    println!("factor {:?}", t0.elapsed() / 10);
    let mut path = Path::begin(
        &p,
        load0.clone(),
        vec![0.0; p.tube.unknowns()],
        Settings::default(),
    )
    .unwrap();
    let t0 = std::time::Instant::now();
    let report = |path: &mut Path<TubeProblem>, load: Load, t: f64| {
        let ti = std::time::Instant::now();
        let s = path.advance(t, &mut ());
        match s {
            Ok(s) => {
                let st = path.state();
                let f = p.tube.forces(&load, &st.u).unwrap();
                let mut rmin = (1.0, 0.0);
                let mut ang = 0.0f64;
                let mut prev: Option<[f64; 3]> = None;
                let mut over = 0.0f64;
                let mut zmax = 0.0f64;
                let mut zat = 0.0;
                for i in 0..=3000 {
                    let s = p.tube.sample(
                        &load,
                        &st.u,
                        Point {
                            z: i as f64 * 0.001,
                            radius: 0.5,
                            angle: 0.0,
                        },
                    );
                    let q = [s.position[0], s.position[1].hypot(s.position[2]), 0.0];
                    if q[1] < rmin.0 {
                        rmin = (q[1], q[0]);
                    }
                    if let Some(pr) = prev {
                        let a = (q[1] - pr[1]).abs().atan2(q[0] - pr[0]).to_degrees();
                        if a > ang {
                            ang = a;
                        }
                    }
                    if q[0] > zmax {
                        zmax = q[0];
                    }
                    if zmax - q[0] > over {
                        over = zmax - q[0];
                        zat = q[0];
                    }
                    prev = Some(q);
                }
                println!(
                    "{:.3} {:.3} W={:.6e} res={:.1e} {} it={} neg={} drag={:.1e} rmin={:.4} z={:.3} ang={:.1} over={:.4}@{:.3} minJ={:.3} t={:.2}",
                    load.muscles[0],
                    load.muscles[1],
                    st.energy,
                    st.imbalance,
                    s.method,
                    s.iterations,
                    st.negative_pivots,
                    s.drag_work,
                    rmin.0,
                    rmin.1,
                    ang,
                    over,
                    zat,
                    f.smallest_jacobian,
                    ti.elapsed().as_secs_f64()
                );
            }
            Err(e) => println!("{:?} FAILED {e}", load.muscles),
        }
    };
    let mut l1 = load0.clone();
    l1.muscles[0] = 0.25;
    path.set_out(l1.clone());
    let mut l1 = load0.clone();
    l1.muscles[0] = 0.25;
    path.set_out(l1.clone());
    for i in 1..=csteps {
        let t = i as f64 / csteps as f64;
        report(&mut path, load0.towards(&l1, t), t);
    }
    let mut l2 = l1.clone();
    l2.muscles[1] = 1.25;
    path.set_out(l2.clone());
    for i in 1..=rsteps {
        let t = i as f64 / rsteps as f64;
        report(&mut path, l1.towards(&l2, t), t);
    }
    println!("{:?}", t0.elapsed());
}
