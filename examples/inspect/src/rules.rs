//! The rules by which contacts are chosen, as pictures for `docs/contacts.md`. All contacts are the dispatcher's.

use std::error::Error;
use std::f32::consts::{FRAC_PI_2, TAU};
use std::fs;
use std::path::Path;

use glam::{DVec3, Vec3};
use isa_gjk::HullShape;
use parry3d::shape::SharedShape;
use rapier3d::prelude::{Pose, Real, Rotation};

use crate::rule::Rule;
use crate::seam::seam;

/// Draws all rules into a folder.
pub fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    for rule in rules()? {
        fs::write(folder.join(rule.name), rule.picture()?)?;
    }
    fs::write(folder.join("rule-seam.svg"), seam()?)?;
    Ok(())
}

fn rules() -> Result<Vec<Rule>, Box<dyn Error>> {
    let mut rules = faces_on_a_table()?;
    rules.extend(curved());
    rules.extend(small_motions()?);
    Ok(rules)
}

/// Prisms on a table.
fn faces_on_a_table() -> Result<Vec<Rule>, Box<dyn Error>> {
    let on_table = |body| [SharedShape::cuboid(0.6, 0.05, 0.6), body];
    let small_table = SharedShape::cuboid(0.06, 0.005, 0.06);
    let leaning = Rotation::from_axis_angle(Vec3::new(0.04, 0.0, 1.0).normalize(), 0.23);
    let sunk = Rotation::from_axis_angle(Vec3::new(1.0, 0.0, -2.0).normalize(), 0.004);
    Ok(vec![
        Rule::new(
            "rule-four.svg",
            on_table(prism(&[(0.4, 0.0), (0.4, 0.15)])?),
            Pose::from_parts(Vec3::new(0.45, 0.048, 0.0), sunk * eighth()),
        ),
        Rule::new(
            "rule-low.svg",
            [small_table, prism(&[(0.04, 0.0), (0.04, 0.015)])?],
            Pose::from_parts(Vec3::new(0.0, 0.0128, 0.0), leaning * eighth()),
        ),
        Rule::new(
            "rule-cluster.svg",
            on_table(prism(&[(0.26, 0.0), (0.4, 0.0012), (0.4, 0.15)])?),
            Pose::from_parts(Vec3::new(0.0, 0.049, 0.0), eighth()),
        ),
    ])
}

/// Cylinders and a cone.
fn curved() -> Vec<Rule> {
    let table = SharedShape::cuboid(0.6, 0.05, 0.6);
    let beam = SharedShape::cuboid(0.6, 0.05, 0.3);
    let log = SharedShape::cylinder(0.5, 0.1);
    let lying = Rotation::from_rotation_y(0.3) * Rotation::from_rotation_z(FRAC_PI_2 + 0.002);
    // The cone lies on its slant, which this half-angle brings down.
    let half_angle = 0.25_f32.atan2(0.7);
    let slant = Rotation::from_rotation_y(0.4) * Rotation::from_rotation_z(-FRAC_PI_2 - half_angle);
    let apex = slant * Vec3::new(0.0, 0.35, 0.0);
    let logs = |name, angle, shift| Rule {
        axis: DVec3::NEG_Y,
        ..Rule::new(
            name,
            [log.clone(), log.clone()],
            Pose::from_parts(
                Vec3::new(0.0, shift, 0.198),
                Rotation::from_rotation_z(angle),
            ),
        )
    };
    vec![
        Rule::new(
            "rule-standing.svg",
            [table, SharedShape::cylinder(0.12, 0.35)],
            Pose::from_parts(Vec3::new(0.0, 0.169, 0.0), Rotation::from_rotation_z(0.002)),
        ),
        Rule::new(
            "rule-lying.svg",
            [beam.clone(), log.clone()],
            Pose::from_parts(Vec3::new(0.35, 0.149, 0.0), lying),
        ),
        Rule::new(
            "rule-cone.svg",
            [beam, SharedShape::cone(0.35, 0.25)],
            Pose::from_parts(Vec3::new(0.0, 0.049 - apex.y, 0.0), slant),
        ),
        logs("rule-logs.svg", 0.0, -0.3),
        logs("rule-crossed.svg", 0.6, 0.0),
    ]
}

/// A prism that moves over a table, from one update to the next.
fn small_motions() -> Result<Vec<Rule>, Box<dyn Error>> {
    let shapes = [
        SharedShape::cuboid(0.6, 0.05, 0.6),
        prism(&[(0.4, 0.0), (0.4, 0.15)])?,
    ];
    let at = |x| Pose::from_parts(Vec3::new(x, 0.049, 0.0), eighth());
    let motion = |name, by| Rule {
        poses: vec![at(0.0), at(by)],
        pitch: 1.1,
        yaw: 0.3,
        zoom: 16.0,
        ..Rule::new(name, shapes.clone(), at(by))
    };
    Ok(vec![
        motion("rule-kept.svg", 0.006),
        motion("rule-moved.svg", 0.014),
    ])
}

/// Puts a side of a prism of eight sides in front.
fn eighth() -> Rotation {
    Rotation::from_rotation_y(TAU / 16.0)
}

/// The hull of rings of eight corners, given by radius and height.
fn prism(rings: &[(Real, Real)]) -> Result<SharedShape, Box<dyn Error>> {
    let ring = |&(radius, height): &(Real, Real)| {
        (0..8).map(move |i| {
            let (sin, cos) = (TAU * i as Real / 8.0).sin_cos();
            Vec3::new(radius * cos, height, radius * sin)
        })
    };
    let points: Vec<Vec3> = rings.iter().flat_map(ring).collect();
    Ok(SharedShape::new(HullShape::from_points(&points)?))
}
