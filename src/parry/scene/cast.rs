//! Shape casts of convex shapes, by the GJK ray cast.

use glam::DVec3;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{ShapeCastHit, ShapeCastOptions, ShapeCastStatus, Unsupported};
use parry3d::shape::Shape;

use crate::curved::SurfacePieces;
use crate::parry::pair::{Pair, PairVisitor};
use crate::parry::scene::caller::{CallerProximity, KernelFrame};
use crate::parry::scene::convex;
use crate::parry::visit;
use crate::parry::workspace::Workspace;
use crate::pose::ValidPose;
use crate::query::{Answer, PairMemory, Query};
use crate::ray_cast::{Impact, RayCast, ray_cast};
use crate::simplex::Preferred;
use crate::stats::Cost;
use crate::support::{Cso, Polytope, Support};
use crate::tolerance::{GRAZING, RAY_TOUCHING};

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
    // Where they overlap at the start parry says what happens.
    visit::shapes(shape_1, shape_2, cast).or_else(|_| {
        convex::visit([shape_1, shape_2], |pair, _| {
            cast.cast(pair, |_, _, _| Err(Unsupported))
        })
    })
}

#[derive(Clone, Copy)]
struct Cast<'a> {
    pos12: &'a Pose,
    velocity: Vector,
    options: ShapeCastOptions,
}

impl PairVisitor for Cast<'_> {
    type Answer = Option<ShapeCastHit>;

    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.cast(pair, |cso, velocity, frame| {
            self.overlap(cso, velocity, frame, workspace)
        })
    }

    /// parry answers how deep they overlap.
    fn visit_curved<B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B>,
        _: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.cast(pair, |_, _, _| Err(Unsupported))
    }
}

impl Cast<'_> {
    /// `overlap` answers for shapes that are within the target distance at the start.
    fn cast<A: Support, B: Support>(
        &self,
        pair: &Pair<'_, B, A>,
        overlap: impl FnOnce(
            &Cso<'_, A, B>,
            DVec3,
            &KernelFrame<'_>,
        ) -> Result<Option<ShapeCastHit>, Unsupported>,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let moves = self.velocity.is_finite() && self.velocity != Vector::ZERO;
        let Some(pos12) = ValidPose::new(self.pos12).filter(|_| moves) else {
            return Ok(None);
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
        let impact = ray_cast::<Preferred, _, _>(
            &cso,
            velocity,
            self.options.max_time_of_impact.into(),
            pair.core_distance(self.target_distance(), cso.size()),
            &mut Cost::default(),
        );
        match impact {
            RayCast::Miss => Ok(None),
            RayCast::Hit(impact) => Ok(Some(hit_at(&impact, velocity, &frame))),
            // This is also false for NaN.
            RayCast::Overlap if self.options.max_time_of_impact >= 0.0 => {
                overlap(&cso, velocity, &frame)
            }
            RayCast::Overlap => Ok(None),
        }
    }

    /// Neither negative nor NaN.
    fn target_distance(&self) -> Real {
        self.options.target_distance.max(0.0)
    }

    /// Shapes that touch, or are within the target distance, at the start: they meet at time 0 if they
    /// approach, or if the cast shall stop there in any case. Shapes that separate or slide along each other
    /// meet nothing.
    fn overlap<A: Polytope, B: Polytope>(
        &self,
        cso: &Cso<'_, A, B>,
        velocity: DVec3,
        frame: &KernelFrame<'_>,
        workspace: &mut Workspace,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let mut cost = Cost::default();
        let mut query = Query::new(cso, f64::INFINITY, &mut workspace.epa, &mut cost);
        let (answer, _) = query.run(&PairMemory::None).ok_or(Unsupported)?;
        let Answer::Near(near) = answer else {
            return Ok(None);
        };
        let departs = near.normal.dot(velocity) >= -GRAZING * velocity.length();
        if departs && !self.options.stop_at_penetration {
            return Ok(None);
        }
        let near = CallerProximity::of_proximity(&near, frame);
        let slack = RAY_TOUCHING * cso.size();
        let status = if near.signed_distance < f64::from(self.target_distance()) - slack {
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
    hit(impact.time, &near, ShapeCastStatus::Converged)
}

pub(super) fn hit(time: f64, near: &CallerProximity, status: ShapeCastStatus) -> ShapeCastHit {
    let [witness1, witness2] = near.points.map(|p| p.as_vec3());
    let [normal1, normal2] = near.normals.map(|n| n.as_vec3());
    ShapeCastHit {
        time_of_impact: time as Real,
        witness1,
        witness2,
        normal1,
        normal2,
        status,
        subshape1: 0,
        subshape2: 0,
    }
}
