//! Shape casts of convex shapes, by the GJK ray cast.

use glam::DVec3;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{Contact, ShapeCastHit, ShapeCastOptions, ShapeCastStatus, Unsupported};
use parry3d::shape::{HalfSpace, Shape};

use crate::curved::SurfacePieces;
use crate::parry::pair::{Pair, PairVisitor};
use crate::parry::scene::caller::KernelFrame;
use crate::parry::scene::contact::contact_of_any;
use crate::parry::scene::convex;
use crate::parry::visit;
use crate::parry::workspace::Workspace;
use crate::pose::ValidPose;
use crate::ray_cast::{Impact, RayCast, ray_cast};
use crate::simplex::Preferred;
use crate::stats::Cost;
use crate::support::{Cso, Polytope, Support};
use crate::tolerance::{GRAZED, GRAZING, NORMAL_ROUNDING, NORMAL_STRETCH};
use crate::tuning::MAY_GRAZE;

/// When shape 2, moving by `velocity` relative to shape 1 (in frame 1), meets shape 1. As with parry, a
/// shape that does not move meets nothing.
pub(crate) fn cast_shapes(
    pos12: &Pose,
    velocity: Vector,
    shape_1: &dyn Shape,
    shape_2: &dyn Shape,
    options: ShapeCastOptions,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let cast = Cast {
        pos12,
        velocity,
        options,
    };
    let shapes = [shape_1, shape_2];
    no_half_space(shapes)?;
    let found = visit::shapes(shape_1, shape_2, cast)
        .or_else(|_| convex::visit(shapes, |pair, _| Ok(cast.cast(pair))))?;
    match found {
        Meeting::Miss => Ok(None),
        Meeting::Hit(hit) => Ok(Some(hit)),
        Meeting::Overlap { size } => cast.overlap(shapes, size),
    }
}

/// Casts at half-spaces are left to the fallback before a hull is looked up, which takes longer than such a cast.
pub(super) fn no_half_space(shapes: [&dyn Shape; 2]) -> Result<(), Unsupported> {
    let is_half_space = |shape: &&dyn Shape| shape.as_shape::<HalfSpace>().is_some();
    if shapes.iter().any(is_half_space) {
        return Err(Unsupported);
    }
    Ok(())
}

#[derive(Clone, Copy)]
struct Cast<'a> {
    pos12: &'a Pose,
    velocity: Vector,
    options: ShapeCastOptions,
}

/// How a cast ends.
enum Meeting {
    Miss,
    Hit(ShapeCastHit),
    /// The shapes touch, or are within the target distance, at the start.
    Overlap {
        /// The size of the pair.
        size: f64,
    },
}

impl PairVisitor for Cast<'_> {
    type Answer = Meeting;

    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        _: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        Ok(self.cast(pair))
    }

    fn visit_curved<B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B>,
        _: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        Ok(self.cast(pair))
    }
}

impl Cast<'_> {
    fn cast<A: Support, B: Support>(&self, pair: &Pair<'_, B, A>) -> Meeting {
        let moves = self.velocity.is_finite() && self.velocity != Vector::ZERO;
        let Some(pos12) = ValidPose::new(self.pos12).filter(|_| moves) else {
            return Meeting::Miss;
        };
        let pose = pair.pose(pos12);
        let cso = pair.cso(&pose);
        let frame = KernelFrame::new(pair, &pose);
        // The velocity of the other shape relative to the hull, in its frame.
        let velocity = self.velocity.as_dvec3();
        let velocity = if pair.order.is_reversed() {
            -pose.direction_to_1(velocity)
        } else {
            velocity
        };
        let reach = pair.core_distance(self.target_distance(), cso.size());
        match self.impact(&cso, velocity, reach) {
            RayCast::Hit(impact) => Meeting::Hit(hit_at(&impact, velocity, &frame)),
            // This is also false for NaN.
            RayCast::Overlap if self.options.max_time_of_impact >= 0.0 => {
                Meeting::Overlap { size: cso.size() }
            }
            RayCast::Miss | RayCast::Overlap => Meeting::Miss,
        }
    }

    /// Where the cores come within `reach` of each other; those that only graze it do not.
    fn impact<A: Support, B: Support>(
        &self,
        cso: &Cso<'_, A, B>,
        velocity: DVec3,
        reach: f64,
    ) -> RayCast {
        let meet_within = |distance: f64| {
            let until = self.options.max_time_of_impact.into();
            ray_cast::<Preferred, _, _>(cso, velocity, until, distance, &mut Cost::default())
        };
        let found = meet_within(reach);
        match found {
            RayCast::Hit(impact) if self.may_graze(&impact, velocity) => {
                match meet_within((reach - GRAZED * cso.size()).max(0.0)) {
                    RayCast::Miss => RayCast::Miss,
                    RayCast::Hit(_) | RayCast::Overlap => found,
                }
            }
            _ => found,
        }
    }

    /// Whether the shapes may come nearer than the target distance by no more than a rounding, as a body does that slides
    /// along a wall at this distance and passes a seam.
    fn may_graze(&self, impact: &Impact, velocity: DVec3) -> bool {
        let approach = impact.normal.dot(velocity).abs();
        self.target_distance() > 0.0 && approach < MAY_GRAZE * velocity.length()
    }

    /// Neither negative nor NaN.
    fn target_distance(&self) -> Real {
        self.options.target_distance.max(0.0)
    }

    /// Shapes that touch, or are within the target distance, at the start: they meet at time 0 if they
    /// approach, or if the cast shall stop there in any case. Shapes that separate or slide along each other
    /// meet nothing.
    fn overlap(
        &self,
        shapes: [&dyn Shape; 2],
        size: f64,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let Some(near) = contact_of_any(self.pos12, shapes)? else {
            return Ok(None);
        };
        let normal = near.normal1.as_dvec3();
        let velocity = self.velocity.as_dvec3();
        let departs = normal.dot(velocity) >= -GRAZING * velocity.length();
        if departs && !self.options.stop_at_penetration {
            return Ok(None);
        }
        // The distance is rounded to f32.
        let slack = f64::from(f32::EPSILON) * size;
        let status = if f64::from(near.dist) < f64::from(self.target_distance()) - slack {
            ShapeCastStatus::PenetratingOrWithinTargetDist
        } else {
            ShapeCastStatus::Converged
        };
        Ok(Some(hit(0.0, &near, status)))
    }
}

fn hit_at(impact: &Impact, velocity: DVec3, frame: &KernelFrame<'_>) -> ShapeCastHit {
    let way = velocity * impact.time;
    let near = frame.near(impact.normal, [impact.on_1, impact.on_2 - way], 0.0);
    hit(impact.time, &near.contact(), ShapeCastStatus::Converged)
}

pub(super) fn hit(time: f64, near: &Contact, status: ShapeCastStatus) -> ShapeCastHit {
    ShapeCastHit {
        time_of_impact: time as Real,
        witness1: near.point1,
        witness2: near.point2,
        normal1: comparable(near.normal1),
        normal2: comparable(near.normal2),
        status,
        subshape1: 0,
        subshape2: 0,
    }
}

/// As callers can compare it: see [`NORMAL_ROUNDING`] and [`NORMAL_STRETCH`].
fn comparable(normal: Vector) -> Vector {
    let is_rounding = |component: Real| f64::from(component.abs()) < NORMAL_ROUNDING;
    let components = normal.to_array();
    let cleared = components.map(|c| if is_rounding(c) { 0.0 } else { c });
    Vector::from_array(cleared) * NORMAL_STRETCH
}
