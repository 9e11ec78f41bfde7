//! The Minkowski difference of two shapes.

use std::cmp::Ordering;

use glam::DVec3;

use super::cso_vertex::CsoVertex;
use super::mapping::Support;
use super::polytope::Polytope;
use crate::ids::VertexId;
use crate::pose::RelativePose;
use crate::stats::Cost;

/// The Minkowski difference of shape 1 and shape 2 (the configuration space obstacle). It is never built, and
/// only its extreme points are computed. Everything is in frame 1.
pub struct Cso<'a, A, B> {
    /// Shape 1.
    pub shape_1: &'a A,
    /// Shape 2.
    pub shape_2: &'a B,
    /// The pose of shape 2.
    pub pose: &'a RelativePose,
}

impl<A: Support, B: Support> Cso<'_, A, B> {
    /// Whether one of the shapes rolls over the other if their outward normals, each in its own frame, turn.
    #[inline]
    pub fn rolls(&self, from: [DVec3; 2], to: [DVec3; 2]) -> bool {
        self.shape_1.rolls(from[0], to[0]) || self.shape_2.rolls(from[1], to[1])
    }

    /// Whether [`rolls`](Self::rolls) is worth a question.
    #[inline]
    pub fn may_roll(&self) -> bool {
        self.shape_1.may_roll() || self.shape_2.may_roll()
    }

    /// A point that is extreme in direction `dir`. The two climbs begin at `start`.
    #[inline(always)]
    pub fn support(&self, dir: DVec3, start: [VertexId; 2], cost: &mut Cost) -> CsoVertex {
        let (on_1, id_1) = self.shape_1.support(dir, start[0], cost);
        let (on_2, id_2) = self.support_2(dir, start[1], cost);
        CsoVertex {
            w: on_1 - on_2,
            on_1,
            ids: [id_1, id_2],
        }
    }

    /// The point of shape 2 that makes the difference extreme in direction `dir`, in frame 1.
    #[inline(always)]
    pub fn support_2(&self, dir: DVec3, start: VertexId, cost: &mut Cost) -> (DVec3, VertexId) {
        let dir = -self.pose.direction_to_2(dir);
        let (on_2, id_2) = self.shape_2.support(dir, start, cost);
        (self.pose.point_to_1(on_2), id_2)
    }

    /// The difference of two vertices.
    #[inline(always)]
    pub fn vertex(&self, ids: [VertexId; 2]) -> CsoVertex
    where
        A: Polytope,
        B: Polytope,
    {
        let on_1 = self.shape_1.vertex(ids[0]);
        CsoVertex {
            w: on_1 - self.pose.point_to_1(self.shape_2.vertex(ids[1])),
            on_1,
            ids,
        }
    }

    /// Start vertices for direction `dir` if no similar query is known.
    pub fn start_vertices(&self, dir: DVec3) -> [VertexId; 2] {
        [
            self.shape_1.start_vertex(dir),
            self.shape_2.start_vertex(-self.pose.direction_to_2(dir)),
        ]
    }

    /// The vertices if the shapes have them, and others if not.
    #[inline]
    pub fn clamp_vertices(&self, [id_1, id_2]: [VertexId; 2]) -> [VertexId; 2] {
        [
            self.shape_1.clamp_vertex(id_1),
            self.shape_2.clamp_vertex(id_2),
        ]
    }

    /// The extreme vertex from the centre towards the origin: the first vertex of a cold search. If the
    /// shapes are round, they are nearest there.
    pub fn vertex_towards_origin(&self, cost: &mut Cost) -> CsoVertex {
        let dir = self.towards_origin();
        self.support(dir, self.start_vertices(dir), cost)
    }

    /// The unit direction from the centre to the origin, that is, from the centre of shape 1 to the centre of
    /// shape 2; some direction if these coincide.
    pub fn towards_origin(&self) -> DVec3 {
        (-self.center()).normalize_or(DVec3::X)
    }

    /// The centre as a CSO vertex. It is no real vertex: `ids` are only hints for where climbs may start.
    pub fn center_as_vertex(&self, ids: [VertexId; 2]) -> CsoVertex {
        CsoVertex {
            w: self.center(),
            on_1: self.shape_1.center(),
            ids,
        }
    }

    /// A point inside: the difference of the two centres, in frame 1.
    #[inline]
    pub fn center(&self) -> DVec3 {
        self.shape_1.center() - self.pose.point_to_1(self.shape_2.center())
    }

    /// The direction between the centres and the distance of the bounding spheres, if that is more than
    /// `beyond`.
    #[inline(always)]
    pub fn spheres_apart(&self, beyond: f64) -> Option<(DVec3, f64)> {
        self.are_spheres_apart(beyond).then(|| {
            let offset = -self.center();
            let distance = offset.length();
            (offset / distance, distance - self.size())
        })
    }

    /// Whether the bounding spheres are apart by more than `beyond`.
    #[inline(always)]
    pub fn are_spheres_apart(&self, beyond: f64) -> bool {
        let reach = self.size() + beyond;
        let squared = self.center().length_squared();
        reach >= 0.0 && squared.partial_cmp(&(reach * reach)) == Some(Ordering::Greater)
    }

    /// The length to which tolerances of the whole pair are relative.
    #[inline]
    pub fn size(&self) -> f64 {
        self.shape_1.radius() + self.shape_2.radius()
    }

    /// The length to which tolerances are relative where the accuracy of the smaller shape matters.
    #[inline]
    pub fn min_radius(&self) -> f64 {
        self.shape_1.radius().min(self.shape_2.radius())
    }
}
