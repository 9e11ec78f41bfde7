//! What parry asks one shape: a `HullShape` answers as the plain convex hull that it stands for; and
//! where parry's answers about that are off, as the exact solid.

use glam::{DMat3, DVec3};
use isa_gjk::HullShape;
use isa_gjk::internals::support::Polytope;
use parry3d::math::{Real, Vector};
use parry3d::query::{PointQuery, Ray, RayCast, RayIntersection};
use parry3d::shape::{FeatureId, PolygonalFeature, SharedShape};
use testkit::cases::hulls;
use testkit::generate::{Rng, prepared};
use testkit::oracle::Solid;
use testkit::report::{Finding, Report};
use testkit::twins::{hull_shape, with_twins};

/// What f32 coordinates and answers allow, relative to the numbers they are made of.
const ROUNDING: f64 = 2e-6;

/// Some place in, at or outside of a hull.
fn somewhere(rng: &mut Rng, solid: &Solid) -> Vector {
    let reach = solid.diameter() * rng.range(0.0, 1.5);
    let corner = solid.points[rng.count(0, solid.points.len() - 1)];
    (corner * rng.range(0.0, 1.1) + rng.direction() * reach).as_vec3()
}

#[test]
fn bounds_are_those_of_the_plain_hull() {
    let mut rng = Rng::new(1);
    with_twins(|name, hull, ours| {
        let plain = &hull.shape;
        assert_eq!(ours.compute_local_aabb(), plain.compute_local_aabb());
        assert_eq!(ours.ccd_thickness(), plain.ccd_thickness());
        let size = hull.solid.diameter();
        let limit = ROUNDING as Real * size as Real;
        let [a, b] = [ours, plain].map(|s| s.compute_local_bounding_sphere());
        assert!(a.center.distance(b.center) <= limit, "{name}: {a:?}");
        assert!((a.radius - b.radius).abs() <= limit, "{name}: {a:?}");
        for _ in 0..100 {
            let pose = rng.pose(5.0 * size).to_f32();
            let [a, b] = [ours, plain].map(|s| s.compute_aabb(&pose));
            let error = (a.mins - b.mins).abs().max((a.maxs - b.maxs).abs());
            let limit = ROUNDING as Real * (pose.translation.length() + size as Real);
            assert!(error.max_element() <= limit, "{name}: {error} at {pose:?}");
        }
    });
}

/// Volume, centre of mass, and the trace of the inertia about it for a density of one.
fn exact_mass(solid: &Solid) -> (f64, DVec3, f64) {
    let origin = solid.points[0];
    let (mut volume, mut moment, mut square) = (0.0, DVec3::ZERO, 0.0);
    for face in solid.faces() {
        let [a, b, c] = face.map(|i| solid.points[i as usize] - origin);
        let part = DMat3::from_cols(a, b, c).determinant() / 6.0;
        let sum = a + b + c;
        let squares = a.length_squared() + b.length_squared() + c.length_squared();
        volume += part;
        moment += part * sum / 4.0;
        square += part * (squares + sum.length_squared()) / 20.0;
    }
    let center = moment / volume;
    let inertia = 2.0 * (square - volume * center.length_squared());
    (volume, origin + center, inertia)
}

#[test]
fn mass_properties_are_those_of_the_solid() {
    let mut report = Report::new("mass properties");
    with_twins(|name, hull, ours| {
        let (volume, center, inertia) = exact_mass(&hull.solid);
        for density in [1.0, 700.0] {
            let mass = ours.mass_properties(density);
            let share = |ours: Real, exact: f64| {
                (f64::from(ours) / (exact * f64::from(density)) - 1.0).abs()
            };
            let shift = (mass.local_com.as_dvec3() - center).length() / hull.solid.diameter();
            let trace = mass.principal_inertia().element_sum();
            let mut finding = Finding::default();
            finding.at_most("mass", share(mass.mass(), volume), 1e-4);
            finding.at_most("centre", shift, 1e-5);
            // parry sums in f32 and inverts: thin solids lose digits.
            finding.at_most("inertia", share(trace, inertia), 1e-3);
            report.add("published hulls", name, finding);
        }
    });
    report.conclude();
}

/// The height above the solid where a ray hits it, and what it must be: a hit enters (or leaves,
/// from inside), a miss stays outside.
fn check_ray(solid: &Solid, ray: &Ray, hit: Option<RayIntersection>) -> Finding {
    let mut finding = Finding::default();
    let height = |t: f64| solid.outside(ray.origin.as_dvec3() + t * ray.dir.as_dvec3());
    let size = solid.diameter() + f64::from(ray.origin.length());
    let inside = height(0.0) < 0.0;
    match hit {
        Some(hit) => {
            let t = f64::from(hit.time_of_impact);
            finding.at_most("height of a hit", height(t).abs() / size, 2.0 * ROUNDING);
            let along = hit.normal.dot(ray.dir);
            finding.require(along < 0.0, || format!("normal along the ray: {hit:?}"));
            let before = height(t * 0.999) < height(t);
            finding.require(before == inside, || format!("the other side: {hit:?}"));
        }
        None if inside => {
            let far = height(4.0) / size;
            finding.at_most("height of the end", far, 2.0 * ROUNDING);
        }
        None => {
            // Heights along a line are convex: sections shrink towards the least.
            let (mut low, mut high) = (0.0, 4.0);
            for _ in 0..100 {
                let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                if height(a) < height(b) {
                    high = b;
                } else {
                    low = a;
                }
            }
            let depth = -height(low) / size;
            finding.at_most("depth of a miss", depth, 2.0 * ROUNDING);
        }
    }
    finding
}

#[test]
fn rays_hit_the_solid_where_they_enter_it() {
    let mut rng = Rng::new(2);
    let mut report = Report::new("ray casts");
    let (mut hits, mut agreed) = (0, 0);
    with_twins(|name, hull, ours| {
        for _ in 0..200 {
            let origin = somewhere(&mut rng, &hull.solid);
            let target = somewhere(&mut rng, &hull.solid) * 0.7;
            let ray = Ray::new(origin, (target - origin) * 0.5);
            let hit = ours.cast_local_ray_and_get_normal(&ray, 4.0, false);
            report.add("hollow", name, check_ray(&hull.solid, &ray, hit));
            let solid_hit = ours.cast_local_ray(&ray, 4.0, true);
            let expected = match hull.solid.outside(origin.as_dvec3()) < 0.0 {
                true => Some(0.0),
                false => hit.map(|h| h.time_of_impact),
            };
            assert_eq!(solid_hit, expected, "{name}: {ray:?}");
            if let Some(hit) = hit {
                let near = ours.cast_local_ray(&ray, hit.time_of_impact * 0.99, false);
                assert_eq!(near, None, "{name}: beyond the limit");
                let theirs = hull.shape.cast_local_ray(&ray, 4.0, true);
                let same = |t: Real| (t - solid_hit.unwrap_or(0.0)).abs() < 1e-3;
                agreed += usize::from(theirs.is_some_and(same));
                hits += 1;
            }
        }
    });
    report.conclude();
    // In the other cases parry misses or is inaccurate: the right answer was checked above.
    assert!(
        agreed * 10 > hits * 8,
        "{agreed} of {hits} as on the plain hull"
    );
}

/// Rays without a direction, or that are no numbers.
#[test]
fn rays_that_are_none_hit_nothing() {
    with_twins(|name, hull, ours| {
        let corners = &hull.solid.points;
        let inside = (corners.iter().sum::<DVec3>() / corners.len() as f64).as_vec3();
        let outside = inside + Vector::X * 2.0 * hull.solid.diameter() as Real;
        let nan = Vector::new(Real::NAN, 0.0, 1.0);
        for (origin, dir) in [
            (inside, Vector::ZERO),
            (outside, Vector::ZERO),
            (outside, nan),
            (nan, Vector::X),
            (nan, nan),
        ] {
            let ray = Ray::new(origin, dir);
            let hit = ours.cast_local_ray_and_get_normal(&ray, Real::INFINITY, false);
            assert!(hit.is_none(), "{name}: {ray:?} hits at {hit:?}");
        }
    });
}

#[test]
fn points_project_to_the_nearest_point_of_the_solid() {
    let mut rng = Rng::new(3);
    let mut report = Report::new("point projections");
    with_twins(|name, hull, ours| {
        let solid = &hull.solid;
        for _ in 0..200 {
            let point = somewhere(&mut rng, solid);
            let height = solid.outside(point.as_dvec3());
            let size = solid.diameter() + f64::from(point.length());
            let (projection, feature) = ours.project_local_point_and_get_feature(point);
            let nearest = projection.point.as_dvec3();
            let away = point.as_dvec3() - nearest;
            let mut finding = Finding::default();
            let off = solid.outside(nearest).abs() / size;
            finding.at_most("off the surface", off, 2.0 * ROUNDING);
            let normal = ours
                .feature_normal_at_point(0, feature, projection.point)
                .expect("a projection has a feature");
            if height < 0.0 {
                let depth = (away.length() + height).abs() / size;
                finding.at_most("wrong depth", depth, 2.0 * ROUNDING);
                assert_eq!(ours.project_local_point(point, true).point, point);
            } else if away.length() > 1e-3 * size {
                let beyond = solid.support(away) - away.dot(nearest);
                finding.at_most("not nearest", beyond / away.length() / size, 2.0 * ROUNDING);
                // The mean normal of a vertex may look away from directions of its cone.
                let looks_out = normal.as_dvec3().dot(away) > 0.0;
                let is_vertex = matches!(feature, FeatureId::Vertex(_));
                finding.require(looks_out || is_vertex, || format!("{feature:?}"));
            }
            let sure = height.abs() > ROUNDING * size;
            let sides = [projection.is_inside, ours.contains_local_point(point)];
            finding.require(!sure || sides == [height < 0.0; 2], || "side".to_owned());
            report.add("points", name, finding);
        }
    });
    report.conclude();
}

#[test]
fn features_have_normals_and_missing_ones_have_none() {
    with_twins(|name, _, ours| {
        let hull = hull_shape(ours).hull();
        let normal = |feature| ours.feature_normal_at_point(0, feature, Vector::ZERO);
        for face in hull.face_ids() {
            let expected = Some(hull.face_normal(face).as_vec3());
            assert_eq!(normal(FeatureId::Face(face.into())), expected, "{name}");
            let [a, b] = [0, 1].map(|i| hull.face_vertex(face, i));
            let edge = hull.edge_between(a, b).expect("corners are neighbours");
            let between = normal(FeatureId::Edge(edge.into())).expect("an edge has faces");
            assert!(
                between.as_dvec3().dot(hull.face_normal(face)) > 0.0,
                "{name}"
            );
        }
        for missing in [FeatureId::Face, FeatureId::Edge, FeatureId::Vertex] {
            assert_eq!(normal(missing(u32::MAX)), None, "{name}");
        }
        assert_eq!(normal(FeatureId::Unknown), None, "{name}");
    });
}

#[test]
fn features_for_clipping_hold_the_extreme_corner_and_span_the_face() {
    let mut rng = Rng::new(4);
    with_twins(|name, hull, ours| {
        let size = hull.solid.diameter();
        let (map, border) = ours.as_polygonal_feature_map().expect("a polytope");
        assert_eq!(border, 0.0);
        for _ in 0..100 {
            let dir = rng.direction().as_vec3();
            let mut feature = PolygonalFeature::default();
            map.local_support_feature(dir, &mut feature);
            let corners = &feature.vertices[..feature.num_vertices];
            assert!((3..=4).contains(&corners.len()), "{name}");
            let heights = corners.iter().map(|p| f64::from(p.dot(dir)));
            let missing = hull.solid.support(dir.as_dvec3()) - heights.fold(f64::MIN, f64::max);
            assert!(missing <= ROUNDING * size, "{name}: {missing}");
            let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let normal = ours.feature_normal_at_point(0, feature.fid.unpack(), corners[0]);
            let outward = area.dot(normal.expect("a face"));
            assert!(outward >= 0.0, "{name}: clockwise by {outward}");
        }
    });
    let coin = prepared(&hulls()["prism64_coin"].shape);
    let (map, _) = coin.as_polygonal_feature_map().expect("a polytope");
    let up = (0..3).map(|i| Vector::AXES[i]).min_by(|a, b| {
        let thick = |axis: &Vector| coin.compute_local_aabb().extents().dot(*axis);
        thick(a).total_cmp(&thick(b))
    });
    let mut feature = PolygonalFeature::default();
    map.local_support_feature(up.expect("three axes"), &mut feature);
    let [a, b, c, d] = feature.vertices;
    let radius = coin.compute_local_aabb().half_extents().max_element();
    let area = (c - a).cross(d - b).length() / 2.0;
    assert!(
        area > 1.9 * radius * radius,
        "the corners are not far apart"
    );
}

#[test]
fn scaling_scales_the_hull() {
    with_twins(|name, hull, ours| {
        for scale in [
            Vector::splat(2.0),
            Vector::new(0.5, 1.5, 1.0),
            Vector::new(-1.0, 1.0, 1.0),
        ] {
            let scaled = ours
                .scale_dyn(scale, 0)
                .map(|shape| SharedShape(shape.into()));
            let Some(scaled) = scaled else {
                panic!("{name} cannot be scaled by {scale}");
            };
            assert!(scaled.as_shape::<HullShape>().is_some(), "{name}");
            let exact = hull
                .solid
                .with_points(hull.solid.points.iter().map(|p| *p * scale.as_dvec3()));
            let volume = exact_mass(&exact).0.abs();
            let error = f64::from(scaled.mass_properties(1.0).mass()) / volume - 1.0;
            assert!(
                error.abs() < 1e-3,
                "{name} by {scale}: volume off by {error}"
            );
            let [a, b] = [
                scaled.compute_local_aabb().extents(),
                ours.compute_local_aabb().extents(),
            ];
            assert!(
                (a - b * scale.abs()).length() <= 1e-5 * a.length(),
                "{name}"
            );
        }
        assert!(
            ours.scale_dyn(Vector::new(1.0, 0.0, 1.0), 0).is_none(),
            "{name}"
        );
    });
}

/// Corners a millionth apart leave slivers, and faces that one plane does not hold.
#[test]
fn rays_hit_hulls_of_near_points() {
    let mut rng = Rng::new(7);
    let mut hits = 0;
    for _ in 0..400 {
        let centers = [(); 5].map(|()| rng.direction() * rng.range(0.2, 0.6));
        let around =
            |center: &DVec3| [*center; 3].map(|c| c + rng.direction() * rng.range(0.0, 2e-6));
        let points: Vec<Vector> = centers
            .iter()
            .flat_map(around)
            .map(|p| p.as_vec3())
            .collect();
        let hull = HullShape::from_points(&points).expect("a solid");
        for _ in 0..20 {
            let target =
                centers.iter().sum::<DVec3>() / 5.0 + rng.direction() * rng.range(0.0, 0.3);
            let origin = (rng.direction() * 2.0).as_vec3();
            let ray = Ray::new(origin, target.as_vec3() - origin);
            let Some(hit) = hull.cast_local_ray_and_get_normal(&ray, Real::MAX, true) else {
                continue;
            };
            hits += 1;
            let place = ray.point_at(hit.time_of_impact);
            let off = hull.project_local_point(place, false).point.distance(place);
            assert!(off < 1e-5, "{off} off at {place}: {points:?}");
        }
    }
    assert!(hits > 2_000, "only {hits} hits");
}
