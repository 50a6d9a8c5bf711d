//! Vectors as wide as this machine's, found at run time, behind slices.
//!
//! [`macerator`] owns what is unsafe about them. A sum that is written with [`Vector::mul_add`] is rounded once a step
//! on AVX2, AVX-512 and NEON, whatever the width, so that those machines come to the same bits; x86 without FMA
//! rounds twice.

use macerator::{AutoArch, Scalar, Simd, Vector, WithSimd};

/// Runs a loop with the widest vector instructions of this machine. What it calls must be marked
/// `#[inline(always)]`.
pub(crate) fn vectorised<R>(work: impl FnOnce() -> R) -> R {
    AutoArch::new().dispatch(work)
}

/// The same for work that asks for the vectors by name.
pub(crate) fn dispatch<W: WithSimd>(work: W) -> W::Output {
    AutoArch::new().dispatch(work)
}

/// Floats in a vector of this machine.
pub(crate) fn lanes() -> usize {
    struct Lanes;
    impl WithSimd for Lanes {
        type Output = usize;

        #[inline(always)]
        fn with_simd<S: Simd>(self) -> usize {
            f32::lanes::<S>()
        }
    }
    dispatch(Lanes)
}

/// The first values of a slice, as many as a vector holds.
#[inline(always)]
pub(crate) fn load<S: Simd>(values: &[f32]) -> Vector<S, f32> {
    bytemuck::pod_read_unaligned(bytemuck::cast_slice(&values[..f32::lanes::<S>()]))
}

/// Writes a vector to the start of a slice.
#[inline(always)]
pub(crate) fn store<S: Simd>(vector: Vector<S, f32>, values: &mut [f32]) {
    values[..f32::lanes::<S>()].copy_from_slice(bytemuck::cast_slice(bytemuck::bytes_of(&vector)));
}
