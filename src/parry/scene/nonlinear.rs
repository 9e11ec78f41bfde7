//! When shapes that move and turn meet, by conservative advancement (Mirtich, *Impulse-based dynamic
//! simulation of rigid body systems*, 1996): time goes on for as long as the normal between the nearest points
//! proves the shapes to be apart.

use glam::DVec3;
use parry3d::math::Real;
use parry3d::query::{ShapeCastHit, ShapeCastStatus, Unsupported};

use super::motion::{Course, Motion};
use crate::curved::SurfacePieces;
use crate::gjk::SeparatingAxis;
use crate::parry::composite::scene::MovingShape;
use crate::parry::pair::{Pair, PairVisitor};
use crate::parry::scene::caller::{CallerProximity, KernelFrame};
use crate::parry::scene::cast::{hit, no_half_space};
use crate::parry::scene::convex;
use crate::parry::visit;
use crate::parry::workspace::Workspace;
use crate::pose::RelativePose;
use crate::query::{Distance, PairMemory, Proximity, Query, Sink};
use crate::stats::Cost;
use crate::support::{Polytope, Support, VertexId};
use crate::tolerance::{AT_START, GJK_GAP_OF_SIZE, IMPACT_GAP};
use crate::tuning::{CURVED_IMPACT_GAP, ROUGH_GAP};

/// A body that spins over another within a thousandth of its size takes a few hundred.
const MAX_ADVANCES: usize = 4096;

/// Not supported are shapes that touch at the start, unless the cast is to stop there: what is met then is
/// parry's to say.
pub(crate) fn cast_shapes(
    movers: [MovingShape<'_>; 2],
    times: [Real; 2],
    stop_at_penetration: bool,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let [shape_1, shape_2] = movers.map(|mover| mover.shape);
    no_half_space([shape_1, shape_2])?;
    let cast = NonlinearCast {
        motions: movers.map(|mover| Motion::new(mover.motion)),
        times,
        stop_at_penetration,
    };
    visit::shapes(shape_1, shape_2, cast).or_else(|_| {
        convex::visit([shape_1, shape_2], |pair, workspace| {
            cast.run(pair, CURVED_IMPACT_GAP, workspace)
        })
    })
}

#[derive(Clone, Copy)]
struct NonlinearCast {
    motions: [Option<Motion>; 2],
    times: [Real; 2],
    stop_at_penetration: bool,
}

impl PairVisitor for NonlinearCast {
    type Answer = Option<ShapeCastHit>;

    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.run(pair, GJK_GAP_OF_SIZE, workspace)
    }

    fn visit_curved<B: SurfacePieces>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.run(pair, CURVED_IMPACT_GAP, workspace)
    }
}

impl NonlinearCast {
    /// `gap` is GJK's, relative to the smaller shape.
    fn run<A: Support, B: Support>(
        &self,
        pair: &Pair<'_, B, A>,
        gap: f64,
        workspace: &mut Workspace,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let [Some(first), Some(second)] = self.motions else {
            return Ok(None);
        };
        let course = Course::new(pair, pair.order.to_kernel([first, second]));
        match self.span(&course) {
            Some(span) => self.advance(pair, &course, span, gap, workspace),
            None => Ok(None),
        }
    }

    /// Goes on from the time `enter` while the shapes are apart.
    fn advance<A: Support, B: Support>(
        &self,
        pair: &Pair<'_, B, A>,
        course: &Course<'_, A, B>,
        [start, enter, end]: [f64; 3],
        gap: f64,
        workspace: &mut Workspace,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let [radius_1, radius_2] = pair.radii();
        let smaller = radius_1.min(radius_2);
        let [touching, fine_gap] = [IMPACT_GAP, gap].map(|share| share * smaller);
        let mut search = Search {
            axis: None,
            gap: fine_gap,
        };
        let mut time = enter;
        for advance in 0..=MAX_ADVANCES {
            let pose = course.pose_at(time);
            let near = search.run(pair, &pose, workspace).ok_or(Unsupported)?;
            let moment = course.moment(time, near.normal);
            let separation = course.separation(&moment);
            search.axis = Some(near.normal);
            if separation > touching {
                search.gap = fine_gap.max(ROUGH_GAP * separation);
                let Some(ahead) = course.free_time(&moment, end - time, touching) else {
                    return Ok(None);
                };
                if time + ahead > time && advance < MAX_ADVANCES {
                    time += ahead;
                    continue;
                }
            } else if search.gap > fine_gap {
                search.gap = fine_gap;
                continue;
            }
            let frame = KernelFrame::new(pair, &pose);
            return self.impact(&near, &frame, [start, time], status(separation, touching));
        }
        Err(Unsupported)
    }

    /// Not supported at the start, unless the cast is to stop there.
    fn impact(
        &self,
        near: &Proximity,
        frame: &KernelFrame<'_>,
        [start, time]: [f64; 2],
        status: ShapeCastStatus,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        if time - start < AT_START && !self.stop_at_penetration {
            return Err(Unsupported);
        }
        let near = CallerProximity::of_proximity(near, frame);
        Ok(Some(ShapeCastHit {
            time_of_impact: not_after(time).max(self.times[0]),
            ..hit(time, &near.contact(), status)
        }))
    }

    /// The start, and from when to when the shapes are within reach. `None` if they never are, also where a time
    /// is no number.
    fn span<A: Support, B: Support>(&self, course: &Course<'_, A, B>) -> Option<[f64; 3]> {
        let [start, end] = self.times.map(|time| f64::from(time.min(Real::MAX)));
        let [enter, leave] = course.within_reach()?;
        let [enter, end] = [start.max(enter), end.min(leave).max(start)];
        (start.is_finite() && enter <= end).then_some([start, enter, end])
    }
}

/// How a cast ended at a separation.
fn status(separation: f64, touching: f64) -> ShapeCastStatus {
    if separation > touching {
        ShapeCastStatus::OutOfIterations
    } else if separation < 0.0 {
        ShapeCastStatus::PenetratingOrWithinTargetDist
    } else {
        ShapeCastStatus::Converged
    }
}

/// For the nearest points of both cores.
struct Search {
    /// Where it begins.
    axis: Option<DVec3>,
    /// GJK's.
    gap: f64,
}

impl Search {
    /// `None` if the cores overlap.
    fn run<A: Support, B: Support>(
        &self,
        pair: &Pair<'_, B, A>,
        pose: &RelativePose,
        workspace: &mut Workspace,
    ) -> Option<Proximity> {
        let cso = pair.cso(pose);
        let gap = self.gap / cso.size();
        let mut sink = NearestCores {
            axis: self.axis,
            found: None,
        };
        Query::new(
            &cso,
            f64::INFINITY,
            &mut workspace.epa,
            &mut Cost::default(),
        )
        .run_into(Distance { gap }, &mut sink)?;
        sink.found
    }
}

struct NearestCores {
    axis: Option<DVec3>,
    found: Option<Proximity>,
}

impl Sink for NearestCores {
    fn memory(&mut self) -> PairMemory {
        match self.axis {
            Some(axis) => PairMemory::Axis(axis, [VertexId::default(); 2]),
            None => PairMemory::None,
        }
    }

    fn spheres_apart(&mut self) {}

    fn separated(&mut self, _: &SeparatingAxis) {}

    fn near(&mut self, near: &Proximity) {
        self.found = Some(*near);
    }
}

/// The largest number of f32 that is not greater.
fn not_after(time: f64) -> Real {
    let rounded = time as Real;
    if f64::from(rounded) > time {
        rounded.next_down()
    } else {
        rounded
    }
}
