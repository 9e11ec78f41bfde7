//! Contacts of parts that meet the other shape in one plane, of which rapier's solver takes four.

use isa_gjk::IsaGjkDispatcher;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::QueryDispatcher;
use parry3d::shape::{Shape, SharedShape};
use testkit::memory::{Manifold, UpdateManifolds};
use testkit::scenes::hulls::{cuboid, upturned_table};

const HALF: Real = 0.1;
const PREDICTION: Real = 0.05;

/// Cubes in a row, with gaps between them.
fn row(cubes: usize) -> SharedShape {
    let cube = cuboid(Vector::splat(HALF)).expect("a cube");
    let middle = (cubes - 1) as Real / 2.0;
    let place = |i: usize| Pose::translation(2.4 * HALF * (i as Real - middle), 0.0, 0.0);
    SharedShape::compound((0..cubes).map(|i| (place(i), cube.clone())).collect())
}

fn floor() -> SharedShape {
    cuboid(Vector::new(3.0, 0.5, 3.0)).expect("a slab")
}

/// A row over the floor: its end, or all of it, sinks in by a millimetre; tilted by so many radians.
fn pose(cubes: usize, tilt: Real) -> Pose {
    let reach = 1.2 * (cubes - 1) as Real * HALF + HALF;
    let height = 0.5 + HALF * tilt.cos() + reach * tilt.sin() - 0.001;
    Pose::new(Vector::new(0.3, height, 0.2), Vector::Z * tilt)
}

fn manifolds(pos12: &Pose, [first, second]: [&dyn Shape; 2]) -> Vec<Manifold> {
    let (mut manifolds, mut workspace) = (Vec::new(), None);
    IsaGjkDispatcher::default()
        .update_manifolds(
            pos12,
            [first, second],
            PREDICTION,
            &mut manifolds,
            &mut workspace,
        )
        .expect("shapes that we know");
    manifolds
}

fn distances(manifolds: &[Manifold]) -> Vec<Real> {
    let points = manifolds.iter().flat_map(|manifold| &manifold.points);
    points.map(|point| point.dist).collect()
}

/// Where all contacts are about equally high, any four of them are good.
#[test]
fn a_level_row_keeps_all_contacts() {
    let manifolds = manifolds(&pose(2, 0.0), [&*floor(), &*row(2)]);
    assert_eq!(distances(&manifolds).len(), 8);
}

/// Of a tilted row, the far end is too high to bear anything, but far from the contacts that touch.
#[test]
fn a_tilted_row_stands_on_its_low_end() {
    for tilt in [0.12, 0.2] {
        let manifolds = manifolds(&pose(2, tilt), [&*floor(), &*row(2)]);
        let all = distances(&manifolds);
        assert_eq!(all.len(), 4, "{tilt}: {all:?}");
        let touching = all.iter().filter(|distance| **distance < 0.0);
        assert_eq!(touching.count(), 2, "{tilt}: {all:?}");
        let highest = all.iter().copied().fold(0.0, Real::max);
        assert!(highest < 2.5 * HALF * tilt.sin(), "{tilt}: {all:?}");
    }
}

/// All parts that touch have a contact, and it is as deep as their own query says.
#[test]
fn each_part_that_touches_keeps_its_deepest_contact() {
    const CUBES: usize = 7;
    let (floor, row) = (floor(), row(CUBES));
    let compound = row.as_compound().expect("parts");
    let pos12 = pose(CUBES, 0.0005);
    let manifolds = manifolds(&pos12, [&*floor, &*row]);
    let mut touching = 0;
    for (id, (pos, part)) in compound.shapes().iter().enumerate() {
        let query = IsaGjkDispatcher::default()
            .contact(&(pos12 * *pos), &*floor, &**part, PREDICTION)
            .expect("hulls")
            .expect("a contact");
        if query.dist > 0.0 {
            continue;
        }
        touching += 1;
        let manifold = manifolds.iter().find(|m| m.subshape2 == id as u32);
        let deepest = manifold.and_then(Manifold::find_deepest_contact);
        let deepest = deepest.unwrap_or_else(|| panic!("part {id} lost its contacts"));
        assert!((deepest.dist - query.dist).abs() < 1e-6, "part {id}");
    }
    assert!(touching > 4, "only {touching} touch");
}

/// A table upside down: its legs end 6 mm above the floor, and bear nothing. All corners of the top do.
#[test]
fn a_table_lies_on_its_top() {
    const HALF_TOP: Real = 0.06;
    for legs in [2, 4] {
        let (floor, table) = (floor(), upturned_table(legs).expect("a table"));
        for tilt in [0.0, 0.002] {
            let height = 0.5 + HALF_TOP * tilt - 1e-4;
            let pos12 = Pose::new(Vector::new(0.3, height, 0.2), Vector::Z * tilt);
            for manifold in manifolds(&pos12, [&*floor, &*table]) {
                let part = manifold.subshape2;
                let expected = if part == 0 { 4 } else { 1 };
                assert_eq!(
                    manifold.points.len(),
                    expected,
                    "part {part}, {legs} legs, tilt {tilt}"
                );
            }
        }
    }
}

#[test]
fn exchanged_shapes_have_the_same_contacts() {
    for tilt in [0.0, 0.03, 0.2] {
        let (floor, row, pos12) = (floor(), row(3), pose(3, tilt));
        let sorted = |manifolds: Vec<Manifold>| {
            let mut distances = distances(&manifolds);
            distances.sort_by(Real::total_cmp);
            distances
        };
        let there = sorted(manifolds(&pos12, [&*floor, &*row]));
        let back = sorted(manifolds(&pos12.inverse(), [&*row, &*floor]));
        assert_eq!(there.len(), back.len(), "{tilt}: {there:?} {back:?}");
        for (a, b) in there.iter().zip(&back) {
            assert!((a - b).abs() < 1e-5, "{tilt}: {there:?} {back:?}");
        }
    }
}
