//! Conic distance fields: known values, the published formula, differences, and what moving a pair as
//! a whole must not change.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use glam::{DQuat, DVec3};
use physique_geometry::{ConicField, reference};
use proptest::prelude::*;

type Corners = [DVec3; 3];

/// Millimetre-sized numbers are exact in metres' place here: the unit is 1.
const FIELDS: [ConicField; 3] = [
    ConicField {
        sigma: 0.5,
        unit: 1.0,
    },
    ConicField {
        sigma: 0.3,
        unit: 1.0,
    },
    ConicField {
        sigma: 0.8,
        unit: 0.5,
    },
];

/// An even triangle in the plane z = 0 whose centre is the origin, facing +Z.
fn level(radius: f64) -> Corners {
    [0.0, 1.0, 2.0].map(|third| {
        let angle = third * std::f64::consts::TAU / 3.0;
        radius * DVec3::new(angle.cos(), angle.sin(), 0.0)
    })
}

#[test]
fn a_corner_behind_the_middle_pays_for_its_depth() {
    // 2 mm behind the middle of a large triangle; a triangle without area has no field of its own.
    let field = ConicField::default();
    let cost = field.pair_cost(level(0.05), [DVec3::new(0.0, 0.0, -0.002); 3]);
    let expected = 3.0 * 2.5_f64.powi(4);
    assert!((cost - expected).abs() < 1e-9 * expected, "{cost}");
}

#[test]
fn the_field_ends_at_its_tip_and_at_its_cone() {
    let field = ConicField {
        sigma: 0.5,
        unit: 1.0,
    };
    let wide = level(10.0);
    // A triangle without area has no field of its own.
    let at = |x: f64, z: f64| field.pair_cost(wide, [DVec3::new(x, 0.0, z); 3]) / 3.0;
    assert_eq!(at(0.0, 0.5), 0.0);
    assert!((at(0.0, 0.0) - 0.5_f64.powi(4)).abs() < 1e-12);
    assert!((at(0.0, -0.5) - 1.0).abs() < 1e-12);
    // Half-way to the rim of the circle; one unit behind it the cone is three times as wide.
    assert!((at(5.0, 0.0) - 0.25_f64.powi(4)).abs() < 1e-12);
    assert!((at(15.0, -1.0) - 0.75_f64.powi(4)).abs() < 1e-12);
    assert_eq!(at(10.0, 0.0), 0.0);
    assert_eq!(at(30.1, -1.0), 0.0);
}

fn corners() -> impl Strategy<Value = Corners> {
    let coordinate = || -2.0..2.0_f64;
    let point = || (coordinate(), coordinate(), coordinate()).prop_map(DVec3::from);
    [point(), point(), point()].prop_filter("needs an area", |[a, b, c]| {
        (b - a).cross(c - a).length() > 0.3
    })
}

proptest! {
    #[test]
    fn equals_the_published_formula(first in corners(), second in corners()) {
        for field in FIELDS {
            let found = field.pair_cost(first, second);
            let expected = reference::conic_pair_cost(&field, first, second);
            prop_assert!((found - expected).abs() <= 1e-9 * expected.max(1.0), "{found} {expected}");
            prop_assert_eq!(found, field.pair_gradient(first, second).cost);
        }
    }

    #[test]
    fn gradients_are_differences(first in corners(), second in corners(), way in 0_usize..18) {
        const STEP: f64 = 1e-6;
        let (triangle, corner, axis) = (way / 9, way / 3 % 3, way % 3);
        for field in FIELDS {
            let gradient = field.pair_gradient(first, second);
            let moved = |step: f64| {
                let mut pair = [first, second];
                pair[triangle][corner][axis] += step;
                reference::conic_pair_cost(&field, pair[0], pair[1])
            };
            // On both sides: at the rim of the field, and at height sigma, there is an edge.
            let here = moved(0.0);
            let sides = [(here - moved(-STEP)) / STEP, (moved(STEP) - here) / STEP];
            let scale = 1e-4 * sides[0].abs().max(sides[1].abs()).max(gradient.cost).max(1.0);
            let found = [gradient.first, gradient.second][triangle][corner][axis];
            let (low, high) = (sides[0].min(sides[1]), sides[0].max(sides[1]));
            prop_assert!(low - scale <= found && found <= high + scale, "{found} {sides:?}");
        }
    }

    /// Moving or turning both triangles together costs nothing.
    #[test]
    fn forces_and_torques_cancel(first in corners(), second in corners()) {
        for field in FIELDS {
            let gradient = field.pair_gradient(first, second);
            let forces = gradient.first.into_iter().chain(gradient.second);
            let points = first.into_iter().chain(second);
            let force: DVec3 = forces.clone().sum();
            let torque: DVec3 = points.zip(forces.clone()).map(|(point, by)| point.cross(by)).sum();
            let scale = 1e-9 * forces.map(DVec3::length).sum::<f64>().max(1.0);
            prop_assert!(force.length() <= scale && torque.length() <= scale, "{force} {torque}");
        }
    }

    #[test]
    fn does_not_depend_on_order_or_place(
        first in corners(),
        second in corners(),
        turn in (-3.0..3.0, -3.0..3.0, -3.0..3.0),
    ) {
        let field = ConicField { sigma: 0.5, unit: 1.0 };
        let cost = field.pair_cost(first, second);
        let rotation = DQuat::from_scaled_axis(turn.into());
        let there = |corners: Corners| corners.map(|p| rotation * p + DVec3::new(0.3, -0.4, 5.0));
        let rotated = |[a, b, c]: Corners| [b, c, a];
        for other in [
            field.pair_cost(second, first),
            field.pair_cost(rotated(first), rotated(rotated(second))),
            field.pair_cost(there(first), there(second)),
        ] {
            prop_assert!((cost - other).abs() <= 1e-9 * cost.max(1.0), "{cost} {other}");
        }
    }
}

#[test]
fn triangles_without_area_cost_nothing() {
    let field = ConicField::default();
    let line = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
    let point = [DVec3::ONE; 3];
    let gradient = field.pair_gradient(line, point);
    assert_eq!(gradient.cost, 0.0);
    assert_eq!(
        (gradient.first, gradient.second),
        ([DVec3::ZERO; 3], [DVec3::ZERO; 3])
    );
}
