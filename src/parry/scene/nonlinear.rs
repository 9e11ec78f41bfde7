//! When shapes that move and turn meet, by conservative advancement (Mirtich, *Impulse-based dynamic
//! simulation of rigid body systems*, 1996): time goes on for as long as the normal between the nearest points
//! proves the shapes to be apart.

use glam::DVec3;
use parry3d::math::Real;
use parry3d::query::{ShapeCastHit, ShapeCastStatus, Unsupported};
use parry3d::shape::PolygonalFeatureMap;

use super::motion::{Course, Motion};
use crate::curved::Body;
use crate::parry::composite::scene::MovingShape;
use crate::parry::pair::{self, Pair, PairVisitor};
use crate::parry::scene::caller::{CallerProximity, KernelFrame};
use crate::parry::scene::cast::hit;
use crate::parry::scene::convex;
use crate::parry::workspace::Workspace;
use crate::pose::RelativePose;
use crate::query::{Distance, PairMemory, Proximity, Query, SeparatingAxis, Sink};
use crate::stats::Cost;
use crate::support::{Polytope, Support, VertexId};
use crate::tolerance::{AT_START, GJK_GAP_OF_SIZE, IMPACT_GAP};

/// A body that spins over another within a thousandth of its size takes a few hundred.
const MAX_ADVANCES: usize = 4096;

/// GJK's while the shapes are far apart, relative to the separation that was proved last: a normal that is off
/// by so little proves nearly as much.
const ROUGH_GAP: f64 = 0.01;

/// GJK's on curved surfaces: of the gap at which an impact ends.
const CURVED_GAP: f64 = IMPACT_GAP / 4.0;

/// Not supported are shapes that touch at the start, unless the cast is to stop there: what is met then is
/// parry's to say.
pub(crate) fn cast_shapes(
    movers: [MovingShape<'_>; 2],
    times: [Real; 2],
    stop_at_penetration: bool,
) -> Result<Option<ShapeCastHit>, Unsupported> {
    let [shape_1, shape_2] = movers.map(|mover| mover.shape);
    let cast = NonlinearCast {
        motions: movers.map(|mover| Motion::new(mover.motion)),
        times,
        stop_at_penetration,
    };
    pair::visit(shape_1, shape_2, cast).or_else(|_| {
        convex::visit([shape_1, shape_2], |pair, workspace| {
            cast.run(pair, CURVED_GAP, workspace)
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

    const CURVED: bool = true;

    fn visit<B: Polytope>(
        &mut self,
        pair: &Pair<'_, B>,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.run(pair, GJK_GAP_OF_SIZE, workspace)
    }

    fn visit_curved<B: Body>(
        &mut self,
        pair: &Pair<'_, B>,
        _: &dyn PolygonalFeatureMap,
        workspace: &mut Workspace,
    ) -> Result<Self::Answer, Unsupported> {
        self.run(pair, CURVED_GAP, workspace)
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
        let [start, end] = self.times.map(|time| f64::from(time.min(Real::MAX)));
        let course = Course::new(pair, pair.order.to_kernel([first, second]));
        let Some([enter, leave]) = course.within_reach() else {
            return Ok(None);
        };
        let end = end.min(leave).max(start);
        let mut time = start.max(enter);
        // Also where a time is no number.
        if !start.is_finite() || time > end {
            return Ok(None);
        }
        let smaller = pair.radii().into_iter().fold(f64::INFINITY, f64::min);
        let touching = IMPACT_GAP * smaller;
        let least_gap = gap * smaller;
        let mut search = Search {
            axis: None,
            gap: least_gap,
        };
        for advance in 0.. {
            let pose = course.pose_at(time);
            let near = search.run(pair, &pose, workspace).ok_or(Unsupported)?;
            let moment = course.moment(time, near.normal);
            let separation = course.separation(&moment);
            let is_rough = search.gap > least_gap;
            search = Search {
                axis: Some(near.normal),
                gap: if separation > touching {
                    least_gap.max(ROUGH_GAP * separation)
                } else {
                    least_gap
                },
            };
            if is_rough && separation <= touching {
                continue;
            }
            let ahead = if separation > touching {
                match course.free_time(&moment, end - time, touching) {
                    Some(ahead) => ahead,
                    None => return Ok(None),
                }
            } else {
                0.0
            };
            if time + ahead > time && advance < MAX_ADVANCES {
                time += ahead;
                continue;
            }
            if time - start < AT_START && !self.stop_at_penetration {
                break;
            }
            let status = match separation {
                _ if separation > touching => ShapeCastStatus::OutOfIterations,
                _ if separation < 0.0 => ShapeCastStatus::PenetratingOrWithinTargetDist,
                _ => ShapeCastStatus::Converged,
            };
            let frame = KernelFrame::new(pair, &pose);
            let near = CallerProximity::of_proximity(&near, &frame);
            let time_of_impact = not_after(time).max(self.times[0]);
            return Ok(Some(ShapeCastHit {
                time_of_impact,
                ..hit(time, &near, status)
            }));
        }
        Err(Unsupported)
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
        let mut sink = Nearest {
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

struct Nearest {
    axis: Option<DVec3>,
    found: Option<Proximity>,
}

impl Sink for Nearest {
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
