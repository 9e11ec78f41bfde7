//! Two abstract classes of PhysX, implemented here: an object begins with a pointer to its virtual
//! functions, in the order of their declaration, then the two kinds of destructor (Itanium C++ ABI).

use parry3d::math::Real;
use physx_sys::PxContactPoint;

/// PhysX never destroys these objects: whoever made them does.
unsafe extern "C" fn destroy<T>(_: *mut T) {}

type Destructor<T> = unsafe extern "C" fn(*mut T);

/// A `PxContactRecorder` that keeps the least distance.
#[repr(C)]
pub struct DeepestContact {
    functions: &'static RecorderFunctions,
    deepest: Option<Real>,
}

#[repr(C)]
struct RecorderFunctions {
    record: unsafe extern "C" fn(*mut DeepestContact, *const PxContactPoint, u32, u32) -> bool,
    destructors: [Destructor<DeepestContact>; 2],
}

impl DeepestContact {
    pub fn new() -> Self {
        Self {
            functions: &RecorderFunctions {
                record,
                destructors: [destroy; 2],
            },
            deepest: None,
        }
    }

    pub fn forget(&mut self) {
        self.deepest = None;
    }

    pub fn get(&self) -> Option<Real> {
        self.deepest
    }
}

unsafe extern "C" fn record(
    this: *mut DeepestContact,
    points: *const PxContactPoint,
    count: u32,
    _pair: u32,
) -> bool {
    // SAFETY: PhysX hands back the object that it was given, with so many points, for this call.
    let (this, points) = unsafe {
        (
            &mut *this,
            std::slice::from_raw_parts(points, count as usize),
        )
    };
    let distances = points.iter().map(|point| point.separation);
    this.deepest = distances.chain(this.deepest).reduce(Real::min);
    true
}

/// What PhysX keeps of one pair takes less than this.
const CAPACITY: usize = 4096;

/// A `PxCacheAllocator` for one pair. Each update copies the last one's data into new memory, so two pieces
/// in turn are enough.
#[repr(C)]
pub struct CacheMemory {
    functions: &'static AllocatorFunctions,
    pieces: Box<[Piece; 2]>,
    next: usize,
}

#[repr(C)]
struct AllocatorFunctions {
    allocate: unsafe extern "C" fn(*mut CacheMemory, u32) -> *mut u8,
    destructors: [Destructor<CacheMemory>; 2],
}

/// Aligned as PhysX asks.
#[repr(C, align(16))]
struct Piece([u8; CAPACITY]);

impl CacheMemory {
    pub fn new() -> Self {
        Self {
            functions: &AllocatorFunctions {
                allocate,
                destructors: [destroy; 2],
            },
            pieces: Box::new([const { Piece([0; CAPACITY]) }; 2]),
            next: 0,
        }
    }
}

unsafe extern "C" fn allocate(this: *mut CacheMemory, bytes: u32) -> *mut u8 {
    assert!(bytes as usize <= CAPACITY, "{bytes} bytes for one pair");
    // SAFETY: PhysX hands back the object that it was given, for this call.
    let this = unsafe { &mut *this };
    this.next = 1 - this.next;
    this.pieces[this.next].0.as_mut_ptr()
}
