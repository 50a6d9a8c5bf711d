//! The bytes that a map's digest is taken over.
//!
//! A type declared with `digested!` gets [`Digested`] from its field list, so that a field cannot be
//! in the map but not in its digest. The layout is older than that of [`crate::state`] and must stay:
//! fields in their order, numbers as four bytes little-endian, floats as their bits, codes of enums as
//! numbers, lists and texts with their length before them, an absent number as 2^32 - 1. What came later
//! is appended only where it says something, so that maps of which it says nothing keep their digest.

use glam::Vec3;

/// Data with a place in the digest of a map.
pub(super) trait Digested {
    /// Appends its bytes.
    fn digest(&self, out: &mut Vec<u8>);
}

/// Declares a struct whose fields are all [`Digested`], and implements that for it.
macro_rules! digested {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[$fmeta:meta])* $fvis:vis $field:ident : $ty:ty,)*
    }) => {
        $(#[$meta])*
        $vis struct $name { $($(#[$fmeta])* $fvis $field: $ty,)* }

        impl $crate::map_data::digest::Digested for $name {
            fn digest(&self, out: &mut Vec<u8>) {
                $($crate::map_data::digest::Digested::digest(&self.$field, out);)*
            }
        }
    };
}

/// Implements [`Digested`] for enums by their codes.
macro_rules! digested_codes {
    ($($name:ident)*) => {$(
        impl $crate::map_data::digest::Digested for $name {
            fn digest(&self, out: &mut Vec<u8>) {
                $crate::map_data::digest::Digested::digest(&(*self as u32), out);
            }
        }
    )*};
}

pub(super) use {digested, digested_codes};

impl Digested for u32 {
    fn digest(&self, out: &mut Vec<u8>) {
        out.extend(self.to_le_bytes());
    }
}

impl Digested for f32 {
    fn digest(&self, out: &mut Vec<u8>) {
        self.to_bits().digest(out);
    }
}

impl Digested for bool {
    fn digest(&self, out: &mut Vec<u8>) {
        u32::from(*self).digest(out);
    }
}

impl Digested for Vec3 {
    fn digest(&self, out: &mut Vec<u8>) {
        self.to_array().digest(out);
    }
}

impl Digested for Option<u32> {
    fn digest(&self, out: &mut Vec<u8>) {
        self.unwrap_or(u32::MAX).digest(out);
    }
}

impl Digested for String {
    fn digest(&self, out: &mut Vec<u8>) {
        (self.len() as u32).digest(out);
        out.extend(self.bytes());
    }
}

impl<A: Digested, B: Digested> Digested for (A, B) {
    fn digest(&self, out: &mut Vec<u8>) {
        self.0.digest(out);
        self.1.digest(out);
    }
}

impl<T: Digested, const N: usize> Digested for [T; N] {
    fn digest(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|item| item.digest(out));
    }
}

impl<T: Digested> Digested for Vec<T> {
    fn digest(&self, out: &mut Vec<u8>) {
        (self.len() as u32).digest(out);
        self.iter().for_each(|item| item.digest(out));
    }
}
