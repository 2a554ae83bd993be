//! Friction of the wall with itself: forces and tangent against differences, balance, rigid motions.

use super::MeridianContact;
use super::friction::SelfFriction;
use super::tests::{contact, hairpin, moved};

/// Largest elastic slip with which some pairs slide.
const ELASTIC: f64 = 2e-4;

/// Returns the friction of a step to a hairpin, with slips from a step before.
fn stepped(contact: &MeridianContact, u: &[f64], elastic: f64) -> SelfFriction {
    let [first, start, lag] = [-3e-4, -1e-4, 2e-4].map(|t| moved(u, t));
    let friction = contact.friction((&first, &[]), &start, elastic);
    let slips = contact.elastic_slips(&friction, &start);
    assert!(slips.len() > 40);
    contact.friction((&start, &slips), &lag, elastic)
}

#[test]
fn forces_are_the_derivative_of_the_potential_and_the_tangent_that_of_the_forces() {
    let (tube, u) = hairpin(0.01);
    let contact = contact(&tube).with_friction(0.3);
    let direction = moved(&vec![0.0; u.len()], 1.0);
    // All stick; some slide.
    for elastic in [4e-3, ELASTIC] {
        let friction = stepped(&contact, &u, elastic);
        let at = |t: f64| {
            let mut residual = vec![0.0; u.len()];
            let forces = contact.add_friction(&friction, &moved(&u, t), &mut residual);
            (forces.energy, residual)
        };
        let (energy, residual) = at(0.0);
        assert!(energy > 0.0);
        let slope: f64 = residual.iter().zip(&direction).map(|(r, d)| r * d).sum();
        let error = |h: f64| ((at(h).0 - at(-h).0) / (2.0 * h) - slope).abs() / slope.abs();
        if elastic > ELASTIC {
            let order = (error(4e-5) / error(2e-5)).log2();
            assert!((order - 2.0).abs() < 0.2, "order {order}");
        }
        assert!(error(1e-7) < 1e-6, "{}", error(1e-7));
        let mut product = vec![0.0; u.len()];
        contact.add_friction_tangent(&friction, &u, |i, j, value| {
            assert!(i >= j);
            product[i] += value * direction[j];
            if i != j {
                product[j] += value * direction[i];
            }
        });
        let size = product.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
        let h = 1e-8;
        let (low, high) = (at(-h).1, at(h).1);
        for (i, p) in product.iter().enumerate() {
            let slope = (high[i] - low[i]) / (2.0 * h);
            assert!((slope - p).abs() < 1e-5 * size, "{i}: {slope} {p}");
        }
    }
}

#[test]
fn forces_of_both_sides_balance_and_stay_below_their_limit() {
    let (tube, u) = hairpin(0.01);
    let contact = contact(&tube).with_friction(0.3);
    let friction = stepped(&contact, &u, ELASTIC);
    let mut residual = vec![0.0; u.len()];
    contact.add_friction(&friction, &u, &mut residual);
    for i in 0..2 {
        let components = residual.iter().skip(i).step_by(3);
        let (sum, size) = components.fold((0.0, 0.0), |(sum, size), r| (sum + r, size + r.abs()));
        assert!(
            size > 0.0 && f64::abs(sum) < 1e-12 * size,
            "{i}: {sum} of {size}"
        );
    }
    let lag = moved(&u, 2e-4);
    let normal: f64 = contact
        .at(&lag)
        .0
        .iter()
        .flatten()
        .map(|pair| -0.5 * pair.area * pair.barrier.slope)
        .sum();
    let on = contact.friction_on_faces(&friction, &u);
    let force = on[0].force + on[1].force;
    assert!(0.0 < force && force <= 0.3 * normal * contact.repeats);
    assert!(on[0].dissipated > 0.0 && on[1].dissipated >= 0.0);
}

#[test]
fn a_rigid_motion_has_no_slip() {
    let (tube, u) = hairpin(0.01);
    let contact = contact(&tube).with_friction(0.3);
    // A turn of the meridian about a point, and a shift along z; not a motion of a tube, but one of the pairs.
    let greville = tube.axial.greville();
    let scale = 1.0 / tube.circle.control_radius;
    let (sin, cos) = 0.2_f64.sin_cos();
    let mut turned = u.clone();
    for (row, values) in turned.chunks_exact_mut(tube.row_size()).enumerate() {
        for (point, radius) in [
            (0, tube.tube.inner_radius()),
            (tube.wall.functions() - 1, 0.5),
        ] {
            let at = &mut values[3 * point..3 * point + 2];
            let [z, r] = [greville[row] + at[0], radius + scale * at[1]];
            let (z, r) = (
                cos * z - sin * (r - 0.4) + 0.3,
                sin * z + cos * (r - 0.4) + 0.4,
            );
            (at[0], at[1]) = (z - greville[row], (r - radius) / scale);
        }
    }
    let friction = contact.friction((&u, &[]), &turned, ELASTIC);
    let mut residual = vec![0.0; u.len()];
    contact.add_friction(&friction, &turned, &mut residual);
    let size = residual.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let limit = friction.largest_limit();
    assert!(limit > 0.0 && size < 1e-9 * limit, "{size} {limit}");
}
