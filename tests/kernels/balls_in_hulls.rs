//! A look at the planes of all faces shows whether a ball is inside a small hull.

use glam::DVec3;
use isa_gjk::Hull;
use isa_gjk::internals::support::{Polytope, Support};
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
            let holds = hull.holds_ball(face, center, radius);
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
