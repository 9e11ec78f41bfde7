//! A look at the planes of all faces shows whether a ball is inside a small hull, and which face is where.

use glam::DVec3;
use isa_gjk::Hull;
use isa_gjk::internals::support::{FaceId, Polytope, Support};
use testkit::generate::Rng;

/// The least height of the planes over a point, without that of one face.
fn room(hull: &Hull, point: DVec3, without: usize) -> f64 {
    let others = hull.face_ids().filter(|face| face.index() != without);
    others
        .map(|face| hull.face_offset(face) - hull.face_normal(face).dot(point))
        .fold(f64::INFINITY, f64::min)
}

/// Of hulls at any place, with fewer and more faces than are looked at together.
#[test]
fn balls_are_found_in_small_hulls_exactly_where_there_is_room() {
    let mut rng = Rng::new(5);
    let [mut held, mut refused, mut large] = [0; 3];
    for round in 0..400 {
        let place = rng.direction() * [0.0, 1.0, 10.0][round % 3];
        let points: Vec<_> = (0..rng.count(4, 24))
            .map(|_| (place + rng.direction()).as_vec3())
            .collect();
        let hull = Hull::from_points(&points).expect("points on a ball are their own hull");
        let slack = 4e-6 * (1.0 + place.length());
        for face in hull.face_ids() {
            let center = hull.center() + rng.direction() * rng.range(0.0, 1.0);
            let radius = rng.range(0.0, 0.4);
            let holds =
                (hull.face_planes()).is_some_and(|planes| planes.hold_ball(face, center, radius));
            let room = room(&hull, center, face.index());
            if hull.face_count() > 32 {
                assert!(!holds, "{} faces are too many", hull.face_count());
                large += 1;
            } else if room < radius {
                assert!(!holds, "{room} is less than {radius}");
                refused += 1;
            } else if room > radius + slack {
                assert!(holds, "{room} is enough for {radius}");
                held += 1;
            }
        }
    }
    assert!(
        held.min(refused).min(large) > 300,
        "{held}, {refused}, {large}"
    );
}

/// How far a point of the plane of a face is inside of its sides.
fn inset(hull: &Hull, face: FaceId, p: DVec3) -> f64 {
    let corners: Vec<DVec3> = hull.face_points(face).collect();
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    let inward = |(from, to): (&DVec3, &DVec3)| {
        let inward = hull.face_normal(face).cross(*to - *from).normalize();
        inward.dot(p - *from)
    };
    sides.map(inward).fold(f64::INFINITY, f64::min)
}

/// No point counts as farther inside of a face than it is, and hardly any as less far.
#[test]
fn the_planes_of_faces_tell_insets_and_sides() {
    let mut rng = Rng::new(6);
    let [mut inside, mut outside] = [0; 2];
    for _ in 0..200 {
        let points: Vec<_> = (0..rng.count(4, 18))
            .map(|_| rng.direction().as_vec3())
            .collect();
        let hull = Hull::from_points(&points).expect("points on a ball are their own hull");
        let planes = hull.face_planes().expect("a hull has planes");
        if hull.face_count() > 32 {
            continue;
        }
        for face in hull.face_ids() {
            let normal = hull.face_normal(face);
            let corners: Vec<DVec3> = hull.face_points(face).collect();
            let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
            let aside = rng.direction() * rng.range(0.0, 0.3);
            let p = middle + aside - normal * normal.dot(aside);
            let (exact, found) = (
                inset(&hull, face, p),
                planes.inset(face, p).expect("few faces"),
            );
            assert!(found <= exact.max(0.0), "{found} is more than {exact}");
            let to_others = hull.face_ids().filter(|other| *other != face);
            let sines = to_others.map(|other| hull.face_normal(other).cross(normal).length());
            let are_apart = sines.fold(1.0, f64::min) > 0.11;
            if exact > 0.0 && are_apart {
                assert!(found >= 0.99 * exact - 1e-3, "{found} is less than {exact}");
                let beside = planes.nearest_beside(face, p).expect("few faces");
                let across = hull.face_normal(beside);
                let height = hull.face_offset(beside) - across.dot(p);
                let to_side = height / normal.cross(across).length();
                assert!(to_side <= exact + 1e-3, "{to_side} instead of {exact}");
                inside += 1;
            } else if exact <= 0.0 {
                outside += 1;
            }
            let dir = rng.direction();
            let nearest = planes.face_towards(dir).expect("few faces");
            let along = |face| hull.face_normal(face).dot(dir);
            let most = hull.face_ids().map(along).fold(-1.0, f64::max);
            assert!(
                along(nearest) >= most - 1e-6,
                "{} of {most}",
                along(nearest)
            );
        }
    }
    assert!(inside.min(outside) > 300, "{inside}, {outside}");
}
