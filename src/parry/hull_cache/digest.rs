//! A digest by which many points are recognised.
//!
//! Comparing points with a copy reads both; a digest reads only the points. For hulls that are not in the
//! nearest cache, reading is the whole cost: for 1,000 vertices a digest takes two thirds of the time, and
//! uses less of the caches.
//!
//! Sixteen lanes in turn take sixteen bytes each, as the key of a round of AES (FIPS 197), for which
//! processors have an instruction. A round is a bijection of states for any key, and of keys for any state.
//! So if points differ only within some 241 bytes, which are twenty points, the digests differ for certain:
//! each lane sees at most one difference, and nothing cancels it. If a lane sees several differences, the
//! chance that they cancel is about one in 2^128; if all points change, this holds for each of the sixteen
//! lanes. (This assumes that the changes have nothing to do with AES. The digest has no secret, so points
//! that deceive it can be constructed.)

use glam::Vec3;

/// With fewer points, a comparison is no slower.
const FEWEST: usize = 150;

/// A digest of points in their order.
#[derive(Debug)]
pub(crate) struct Digest {
    /// The first bytes.
    start: [u8; ALIGNED],
    /// How many of these no lane takes, so that the rest is aligned.
    skipped: usize,
    /// The states of the lanes after all whole rows.
    lanes: [u128; LANES],
    /// The end of the points, which includes the incomplete row.
    end: [u8; ROW],
    count: usize,
}

impl Digest {
    /// `None` if a comparison is better: for few points, or without the instruction.
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

    /// Whether it is the digest of these points.
    // Inlined, it would slow down the comparison of small hulls.
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

/// The bytes that one lane takes at a time.
const BLOCK: usize = size_of::<u128>();

/// A row of blocks, one for each lane.
const ROW: usize = LANES * BLOCK;

/// Two blocks at once are read in half the time if they do not cross cache lines.
const ALIGNED: usize = 2 * BLOCK;

#[cfg(target_arch = "x86_64")]
mod rounds {
    use std::arch::x86_64::{_mm_aesenc_si128, _mm256_aesenc_epi128};

    use bytemuck::Pod;

    use super::{LANES, ROW};

    /// `None` without the instruction.
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

    /// Without AVX there would be more lanes than registers.
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

    /// The states of all lanes, in `N` registers, after all whole rows.
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
    use oorandom::Rand32;

    use super::*;

    /// Coordinates of every kind, including bit patterns of NaN.
    fn points(rng: &mut Rand32, count: usize) -> Vec<Vec3> {
        let mut coordinate = || f32::from_bits(rng.rand_u32());
        (0..count)
            .map(|_| Vec3::new(coordinate(), coordinate(), coordinate()))
            .collect()
    }

    /// Looks at digests of many points.
    fn for_digests(law: impl Fn(&Digest, Vec<Vec3>, &mut Rand32)) {
        let mut rng = Rand32::new(7);
        for _ in 0..500 {
            let count = below(&mut rng, 400 - FEWEST) + FEWEST;
            let points = points(&mut rng, count);
            if let Some(digest) = Digest::of(&points) {
                law(&digest, points, &mut rng);
            }
        }
    }

    fn below(rng: &mut Rand32, end: usize) -> usize {
        usize::try_from(rng.rand_u32()).expect("32 bits or more") % end
    }

    #[test]
    fn many_points_have_one_where_there_are_rounds() {
        assert!(Digest::of(&[Vec3::ONE; FEWEST - 1]).is_none());
        let many = Digest::of(&[Vec3::ONE; FEWEST]);
        assert_eq!(many.is_some(), rounds::has_rounds());
    }

    #[test]
    fn the_same_points_are_known_again() {
        for_digests(|digest, points, _| assert!(digest.matches(&points.clone())));
    }

    /// This is certain, whatever the change is.
    #[test]
    fn twenty_points_are_not_changed_unnoticed() {
        for_digests(|digest, mut changed, rng| {
            let count = below(rng, 20) + 1;
            let at = below(rng, changed.len() - count + 1);
            changed[at..at + count].copy_from_slice(&points(rng, count));
            assert!(!digest.matches(&changed), "{count} points at {at}");
        });
    }

    /// Users change all points in regular ways.
    #[test]
    fn a_turned_or_scaled_hull_is_another() {
        for_digests(|_, points, rng| {
            let points: Vec<Vec3> = points
                .iter()
                .map(|p| p.map(|x| f32::from_bits(x.to_bits() % (1 << 30)) + 0.1))
                .collect();
            let digest = Digest::of(&points).expect("as many points as before");
            let shift = below(rng, FEWEST - 1) + 1;
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
                assert!(!digest.matches(changed));
            }
        });
    }

    #[test]
    fn another_number_of_points_is_another_hull() {
        for_digests(|digest, points, rng| {
            let mut longer = points.clone();
            longer.extend(vec![Vec3::ZERO; below(rng, 19) + 1]);
            assert!(!digest.matches(&longer));
            assert!(!digest.matches(&points[1..]));
            assert!(!digest.matches(&points[..points.len() - 1]));
        });
    }
}
