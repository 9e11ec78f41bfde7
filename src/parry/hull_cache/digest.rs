//! A digest of many points, by which they are known again.
//!
//! Comparing points with a copy of them reads both; a digest reads the points alone. For hulls that are
//! not in the nearest cache reading is what there is to pay: of 1,000 vertices a digest takes two thirds
//! of the time, and leaves the caches to others.
//!
//! Sixteen lanes take in sixteen bytes each in turn, as the key of a round of AES (FIPS 197), for which
//! processors have an instruction. A round maps states one to one whatever the key, and keys whatever the
//! state. So where points differ within some 241 bytes, which are twenty points, the digests differ for
//! certain: each lane sees one difference at most, and nothing undoes it. A lane that sees more of them
//! ends as it would have without with a chance of about one in 2^128; if all points changed, that goes
//! for each of the sixteen. (This supposes that the changes have nothing to do with AES. Who looks for
//! points that deceive it finds some: it keeps no secret.)

use glam::Vec3;

/// Of fewer points a comparison is no slower.
const FEWEST: usize = 150;

/// A digest of points in their order.
#[derive(Debug)]
pub(crate) struct Digest {
    /// The first bytes.
    start: [u8; ALIGNED],
    /// How many of them no lane takes in, so that those are aligned which are.
    skipped: usize,
    /// What whole rows leave in them.
    lanes: [u128; LANES],
    /// The end of the points, with what is no whole row.
    end: [u8; ROW],
    count: usize,
}

impl Digest {
    /// `None` where a comparison serves better: of few points, and where there is no such instruction.
    #[inline]
    pub fn of(points: &[Vec3]) -> Option<Self> {
        let count = points.len();
        if count < FEWEST {
            return None;
        }
        let bytes: &[u8] = bytemuck::cast_slice(points);
        let skipped = bytes.as_ptr().align_offset(ALIGNED).min(ALIGNED);
        Some(Self {
            start: *bytes.first_chunk()?,
            skipped,
            lanes: rounds::lanes(&bytes[skipped..])?,
            end: *bytes.last_chunk()?,
            count,
        })
    }

    /// Whether it is that of these points.
    // In line it would hold up the comparison of small hulls.
    #[inline(never)]
    pub fn matches(&self, points: &[Vec3]) -> bool {
        let bytes: &[u8] = bytemuck::cast_slice(points);
        self.count == points.len()
            && bytes.first_chunk() == Some(&self.start)
            && bytes.last_chunk() == Some(&self.end)
            && rounds::lanes(&bytes[self.skipped..]) == Some(self.lanes)
    }
}

const LANES: usize = 16;

/// What one lane takes in at a time.
const BLOCK: usize = size_of::<u128>();

/// What all lanes do.
const ROW: usize = LANES * BLOCK;

/// Two blocks at once are read in half the time where they do not cross lines of the cache.
const ALIGNED: usize = 2 * BLOCK;

#[cfg(target_arch = "x86_64")]
mod rounds {
    use std::arch::x86_64::{_mm_aesenc_si128, _mm256_aesenc_epi128};

    use bytemuck::Pod;

    use super::{LANES, ROW};

    /// `None` where there is no instruction for them.
    #[inline]
    pub fn lanes(bytes: &[u8]) -> Option<[u128; LANES]> {
        if !has_rounds() {
            None
        } else if is_x86_feature_detected!("vaes") && is_x86_feature_detected!("avx2") {
            // SAFETY: the features that the function names are there, and `aes` and `avx`, which they
            // imply.
            #[expect(unsafe_code)]
            Some(unsafe { take_in_twos(bytes) })
        } else {
            // SAFETY: the features that the function names are there, as `has_rounds` says.
            #[expect(unsafe_code)]
            Some(unsafe { take_in_ones(bytes) })
        }
    }

    /// Without AVX the lanes would be more than the registers hold.
    #[inline]
    pub fn has_rounds() -> bool {
        is_x86_feature_detected!("aes") && is_x86_feature_detected!("avx")
    }

    /// Two lanes with one instruction.
    #[target_feature(enable = "vaes,avx2")]
    fn take_in_twos(bytes: &[u8]) -> [u128; LANES] {
        let round = |lanes, blocks| _mm256_aesenc_epi128(lanes, blocks);
        bytemuck::cast(take_in::<_, { LANES / 2 }>(bytes, round))
    }

    #[target_feature(enable = "aes,avx")]
    fn take_in_ones(bytes: &[u8]) -> [u128; LANES] {
        let round = |lane, block| _mm_aesenc_si128(lane, block);
        bytemuck::cast(take_in::<_, LANES>(bytes, round))
    }

    /// What whole rows leave in `N` registers, which are all lanes.
    #[inline(always)]
    fn take_in<V: Pod, const N: usize>(bytes: &[u8], round: impl Fn(V, V) -> V) -> [V; N] {
        let mut lanes = [V::zeroed(); N];
        let (rows, _) = bytes.as_chunks::<ROW>();
        for row in rows {
            let blocks = row.chunks_exact(ROW / N).map(bytemuck::pod_read_unaligned);
            for (lane, block) in lanes.iter_mut().zip(blocks) {
                *lane = round(*lane, block);
            }
        }
        lanes
    }
}

#[cfg(not(target_arch = "x86_64"))]
mod rounds {
    pub fn lanes(_: &[u8]) -> Option<[u128; super::LANES]> {
        None
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use glam::Vec3Swizzles;
    use proptest::prelude::*;

    use super::*;

    /// Coordinates of every kind, bit patterns of NaN included.
    fn points(counts: impl Into<prop::collection::SizeRange>) -> impl Strategy<Value = Vec<Vec3>> {
        let coordinate = any::<u32>().prop_map(f32::from_bits);
        prop::collection::vec(
            prop::array::uniform3(coordinate).prop_map(Vec3::from),
            counts,
        )
    }

    #[test]
    fn many_points_have_one_where_there_are_rounds() {
        assert!(Digest::of(&[Vec3::ONE; FEWEST - 1]).is_none());
        let many = Digest::of(&[Vec3::ONE; FEWEST]);
        assert_eq!(many.is_some(), rounds::has_rounds());
    }

    proptest! {
        #[test]
        fn the_same_points_are_known_again(points in points(FEWEST..400)) {
            let Some(digest) = Digest::of(&points) else { return Ok(()) };
            prop_assert!(digest.matches(&points.clone()));
        }

        /// That is certain, whatever the change.
        #[test]
        fn twenty_points_are_not_changed_unnoticed(
            points in points(FEWEST..400),
            new in points(1..=20),
            at in any::<prop::sample::Index>(),
        ) {
            let Some(digest) = Digest::of(&points) else { return Ok(()) };
            let at = at.index(points.len() - new.len());
            let mut changed = points.clone();
            changed[at..at + new.len()].copy_from_slice(&new);
            let bits = |points: &[Vec3]| bytemuck::cast_slice::<_, u32>(points).to_vec();
            prop_assert_eq!(digest.matches(&changed), bits(&changed) == bits(&points));
        }

        /// What users do to hulls changes all of them, in regular ways.
        #[test]
        fn a_turned_or_scaled_hull_is_another(points in points(FEWEST..400), shift in 1_usize..FEWEST) {
            let points: Vec<Vec3> = points
                .iter()
                .map(|p| p.map(|x| f32::from_bits(x.to_bits() % (1 << 30)) + 0.1))
                .collect();
            let Some(digest) = Digest::of(&points) else { return Ok(()) };
            let each = |change: fn(Vec3) -> Vec3| points.iter().copied().map(change).collect();
            let mut moved_on = points.clone();
            moved_on.rotate_left(shift);
            let mut exchanged = points.clone();
            exchanged.swap(0, shift);
            let changes: [Vec<Vec3>; 7] = [
                each(|p| -p),
                each(|p| p * Vec3::new(-1.0, 1.0, 1.0)),
                each(|p| 2.0 * p),
                each(|p| p.map(f32::next_up)),
                each(|p| p.zxy()),
                moved_on,
                exchanged,
            ];
            for changed in changes.iter().filter(|changed| **changed != points) {
                prop_assert!(!digest.matches(changed));
            }
        }

        #[test]
        fn another_number_of_points_is_another_hull(points in points(FEWEST..400), more in 1_usize..20) {
            let Some(digest) = Digest::of(&points) else { return Ok(()) };
            let mut longer = points.clone();
            longer.extend(vec![Vec3::ZERO; more]);
            prop_assert!(!digest.matches(&longer));
            prop_assert!(!digest.matches(&points[1..]));
            prop_assert!(!digest.matches(&points[..points.len() - 1]));
        }
    }
}
