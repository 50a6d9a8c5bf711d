//! One list of fields serves the hash, the keyframe and the naming of differences.
//!
//! A type declared with [`state!`](crate::state!) gets [`State`] from its field list, so that a field
//! cannot be hashed but not saved, or saved but not named. All numbers are little-endian and of fixed
//! width; floats are their bits.

use glam::{Quat, Vec2, Vec3};

/// 128 bits over inputs, state and outputs of one tick (xxh3).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct StateHash(pub u128);

impl std::fmt::Debug for StateHash {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

/// Why bytes are not a valid state.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("state at byte {at}: expected {expected}")]
pub struct DecodeError {
    /// Offset in the bytes.
    pub at: usize,
    /// What should have stood there.
    pub expected: &'static str,
}

/// Reads the canonical bytes back, with bounds checked.
pub struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    /// Starts at the first byte.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    /// The next `N` bytes.
    pub fn take<const N: usize>(&mut self, expected: &'static str) -> Result<[u8; N], DecodeError> {
        let rest = &self.bytes[self.at..];
        let head = rest.first_chunk::<N>().ok_or(DecodeError { at: self.at, expected })?;
        self.at += N;
        Ok(*head)
    }

    /// An error at the current position.
    pub fn error(&self, expected: &'static str) -> DecodeError {
        DecodeError { at: self.at, expected }
    }

    /// Bytes not yet read.
    pub fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Fails unless every byte was read.
    pub fn finish(self) -> Result<(), DecodeError> {
        if self.remaining() == 0 { Ok(()) } else { Err(self.error("the end")) }
    }
}

/// One named value of a state, as text, for reports of differences.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedValue {
    /// Path of the field, as in `vehicles[17].s_m`.
    pub path: String,
    /// The value; floats print so that different bits differ.
    pub value: String,
}

/// State with a canonical byte layout.
pub trait State: Sized {
    /// Appends the canonical bytes.
    fn write(&self, out: &mut Vec<u8>);
    /// Reads the canonical bytes.
    fn read(r: &mut Reader<'_>) -> Result<Self, DecodeError>;
    /// Appends every leaf with its path below `path`.
    fn name(&self, path: &str, out: &mut Vec<NamedValue>);

    /// The canonical bytes.
    fn to_bytes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        self.write(&mut out);
        out
    }

    /// The state of exactly these bytes.
    fn from_bytes(bytes: &[u8]) -> Result<Self, DecodeError> {
        let mut r = Reader::new(bytes);
        let state = Self::read(&mut r)?;
        r.finish()?;
        Ok(state)
    }
}

/// The first leaf in which two states differ, as (path, left, right).
pub fn first_difference<T: State>(left: &T, right: &T) -> Option<(String, String, String)> {
    let (mut a, mut b) = (Vec::new(), Vec::new());
    left.name("", &mut a);
    right.name("", &mut b);
    let absent = || String::from("absent");
    for i in 0..a.len().max(b.len()) {
        match (a.get(i), b.get(i)) {
            (Some(x), Some(y)) if x == y => {}
            (Some(x), Some(y)) if x.path == y.path => return Some((x.path.clone(), x.value.clone(), y.value.clone())),
            (Some(x), _) => return Some((x.path.clone(), x.value.clone(), absent())),
            (None, Some(y)) => return Some((y.path.clone(), absent(), y.value.clone())),
            (None, None) => {}
        }
    }
    None
}

macro_rules! numbers {
    ($($t:ty),*) => {$(
        impl State for $t {
            fn write(&self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }
            fn read(r: &mut Reader<'_>) -> Result<Self, DecodeError> {
                Ok(Self::from_le_bytes(r.take(stringify!($t))?))
            }
            fn name(&self, path: &str, out: &mut Vec<NamedValue>) {
                out.push(NamedValue { path: path.to_owned(), value: format!("{self:?}") });
            }
        }
    )*};
}
numbers!(u8, u16, u32, u64, u128, i8, i16, i32, i64);

impl State for f32 {
    fn write(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.to_bits().to_le_bytes());
    }
    fn read(r: &mut Reader<'_>) -> Result<Self, DecodeError> {
        let value = Self::from_bits(u32::from_le_bytes(r.take("f32")?));
        if value.is_finite() { Ok(value) } else { Err(r.error("a finite number")) }
    }
    fn name(&self, path: &str, out: &mut Vec<NamedValue>) {
        out.push(NamedValue { path: path.to_owned(), value: format!("{self:?}") });
    }
}

impl State for bool {
    fn write(&self, out: &mut Vec<u8>) {
        out.push(u8::from(*self));
    }
    fn read(r: &mut Reader<'_>) -> Result<Self, DecodeError> {
        match r.take::<1>("bool")?[0] {
            0 => Ok(false),
            1 => Ok(true),
            _ => Err(r.error("0 or 1")),
        }
    }
    fn name(&self, path: &str, out: &mut Vec<NamedValue>) {
        out.push(NamedValue { path: path.to_owned(), value: self.to_string() });
    }
}

macro_rules! vectors {
    ($($t:ident { $($f:ident),* })*) => {$(
        impl State for $t {
            fn write(&self, out: &mut Vec<u8>) {
                $(self.$f.write(out);)*
            }
            fn read(r: &mut Reader<'_>) -> Result<Self, DecodeError> {
                $(let $f = State::read(r)?;)*
                Ok($t::from_array([$($f),*]))
            }
            fn name(&self, path: &str, out: &mut Vec<NamedValue>) {
                $(self.$f.name(&format!("{path}.{}", stringify!($f)), out);)*
            }
        }
    )*};
}
vectors!(Vec2 { x, y } Vec3 { x, y, z } Quat { x, y, z, w });

impl State for String {
    fn write(&self, out: &mut Vec<u8>) {
        (self.len() as u32).write(out);
        out.extend_from_slice(self.as_bytes());
    }
    fn read(r: &mut Reader<'_>) -> Result<Self, DecodeError> {
        String::from_utf8(State::read(r)?).map_err(|_| r.error("text in UTF-8"))
    }
    fn name(&self, path: &str, out: &mut Vec<NamedValue>) {
        out.push(NamedValue { path: path.to_owned(), value: format!("{self:?}") });
    }
}

impl<T: State> State for Option<T> {
    fn write(&self, out: &mut Vec<u8>) {
        self.is_some().write(out);
        if let Some(value) = self {
            value.write(out);
        }
    }
    fn read(r: &mut Reader<'_>) -> Result<Self, DecodeError> {
        Ok(if bool::read(r)? { Some(T::read(r)?) } else { None })
    }
    fn name(&self, path: &str, out: &mut Vec<NamedValue>) {
        match self {
            Some(value) => value.name(path, out),
            None => out.push(NamedValue { path: path.to_owned(), value: "none".into() }),
        }
    }
}

impl<T: State> State for Vec<T> {
    fn write(&self, out: &mut Vec<u8>) {
        (self.len() as u32).write(out);
        for item in self {
            item.write(out);
        }
    }
    fn read(r: &mut Reader<'_>) -> Result<Self, DecodeError> {
        let len = u32::read(r)? as usize;
        // Every element takes a byte or more, so a length beyond the rest is false.
        if len > r.remaining() {
            return Err(r.error("a length within the data"));
        }
        (0..len).map(|_| T::read(r)).collect()
    }
    fn name(&self, path: &str, out: &mut Vec<NamedValue>) {
        for (i, item) in self.iter().enumerate() {
            item.name(&format!("{path}[{i}]"), out);
        }
    }
}

impl<T: State, const N: usize> State for [T; N] {
    fn write(&self, out: &mut Vec<u8>) {
        for item in self {
            item.write(out);
        }
    }
    fn read(r: &mut Reader<'_>) -> Result<Self, DecodeError> {
        let items: Vec<T> = (0..N).map(|_| T::read(r)).collect::<Result<_, _>>()?;
        items.try_into().map_err(|_| r.error("an item"))
    }
    fn name(&self, path: &str, out: &mut Vec<NamedValue>) {
        for (i, item) in self.iter().enumerate() {
            item.name(&format!("{path}[{i}]"), out);
        }
    }
}

/// Declares a struct whose fields are all [`State`], and implements [`State`] for it.
#[macro_export]
macro_rules! state {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[$fmeta:meta])* $fvis:vis $field:ident : $ty:ty,)*
    }) => {
        $(#[$meta])*
        $vis struct $name { $($(#[$fmeta])* $fvis $field: $ty,)* }

        impl $crate::state::State for $name {
            fn write(&self, out: &mut Vec<u8>) {
                $($crate::state::State::write(&self.$field, out);)*
            }
            fn read(r: &mut $crate::state::Reader<'_>) -> Result<Self, $crate::state::DecodeError> {
                Ok(Self { $($field: $crate::state::State::read(r)?,)* })
            }
            fn name(&self, path: &str, out: &mut Vec<$crate::state::NamedValue>) {
                let dot = if path.is_empty() { "" } else { "." };
                $($crate::state::State::name(&self.$field, &format!("{path}{dot}{}", stringify!($field)), out);)*
            }
        }
    };
}

/// Declares an enum without data whose variants have fixed codes, and implements [`State`] for it.
#[macro_export]
macro_rules! state_enum {
    ($(#[$meta:meta])* $vis:vis enum $name:ident {
        $($(#[$vmeta:meta])* $variant:ident = $code:literal,)*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u8)]
        $vis enum $name { $($(#[$vmeta])* $variant = $code,)* }

        impl $name {
            /// Every variant, in the order of declaration.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];
        }

        impl $crate::state::State for $name {
            fn write(&self, out: &mut Vec<u8>) {
                out.push(*self as u8);
            }
            fn read(r: &mut $crate::state::Reader<'_>) -> Result<Self, $crate::state::DecodeError> {
                match r.take::<1>(stringify!($name))?[0] {
                    $($code => Ok(Self::$variant),)*
                    _ => Err(r.error(concat!("a variant of ", stringify!($name)))),
                }
            }
            fn name(&self, path: &str, out: &mut Vec<$crate::state::NamedValue>) {
                out.push($crate::state::NamedValue { path: path.to_owned(), value: format!("{self:?}") });
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::state! {
        #[derive(Clone, Debug, PartialEq)]
        struct Pair {
            at: Vec3,
            speeds: Vec<f32>,
        }
    }

    #[test]
    fn bytes_come_back_and_differences_are_named() {
        let pair = Pair { at: Vec3::new(1.0, -2.0, 0.5), speeds: vec![3.0, 4.0] };
        assert_eq!(Pair::from_bytes(&pair.to_bytes()), Ok(pair.clone()));
        let mut other = pair.clone();
        other.speeds[1] = 4.5;
        let difference = first_difference(&pair, &other);
        assert_eq!(difference, Some(("speeds[1]".into(), "4.0".into(), "4.5".into())));
    }

    #[test]
    fn false_lengths_and_left_over_bytes_are_refused() {
        assert!(Vec::<u8>::from_bytes(&[255, 255, 255, 255]).is_err());
        assert!(u8::from_bytes(&[1, 2]).is_err());
        assert!(f32::from_bytes(&f32::NAN.to_bits().to_le_bytes()).is_err());
    }
}
