//! Shapes as the kernels see them: extreme points with vertex ids, and the faces of polytopes.

mod cso;
mod cso_vertex;
mod mapping;
mod polytope;

pub use self::cso::Cso;
pub use self::cso_vertex::CsoVertex;
pub use self::mapping::Support;
pub use self::polytope::Polytope;
pub use crate::corners::{FaceCorners, FacePoints};
pub(crate) use crate::ids::ShapeKind;
pub use crate::ids::{EdgeId, FaceId, ShapeId, VertexId};
