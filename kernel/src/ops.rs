//! The only floating-point functions beyond `+ - * /` and `sqrt` that the kernel may use.
//!
//! The standard library's transcendental functions depend on the platform's libm; the crate `libm`
//! gives the same bits everywhere.

pub use libm::{
    acosf as acos, asinf as asin, atan2f as atan2, cosf as cos, expf as exp, floorf as floor, fmodf as fmod,
    hypotf as hypot, logf as ln, powf as pow, roundf as round, sinf as sin, sqrtf as sqrt, tanf as tan,
};

/// The angle in (-pi, pi] that equals `angle_rad` up to full turns.
pub fn wrap_angle(angle_rad: f32) -> f32 {
    use core::f32::consts::{PI, TAU};
    let r = angle_rad - TAU * floor((angle_rad + PI) / TAU);
    if r <= -PI { r + TAU } else { r }
}
