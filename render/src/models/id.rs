//! Digests of models.

use core::fmt;
use core::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

/// The digest of a folder of models: 16 bytes, in hexadecimal digits where it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ModelsId(u128);

impl From<[u8; 16]> for ModelsId {
    fn from(digest: [u8; 16]) -> Self {
        Self(u128::from_be_bytes(digest))
    }
}

impl fmt::Display for ModelsId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

impl FromStr for ModelsId {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_digest = text.len() == 32 && text.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'));
        let digest = u128::from_str_radix(text, 16).ok().filter(|_| is_digest);
        digest.map(Self).ok_or_else(|| "expected the digest of models, 32 hexadecimal digits".into())
    }
}

impl Serialize for ModelsId {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for ModelsId {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digest_is_read_as_it_is_said() {
        let id = ModelsId::from([0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 255]);
        assert_eq!(id.to_string(), "000102030405060708090a0b0c0d0eff");
        assert_eq!(id.to_string().parse(), Ok(id));
        for wrong in ["", "0", "000102030405060708090a0b0c0d0efF", "+00102030405060708090a0b0c0d0eff"] {
            assert!(wrong.parse::<ModelsId>().is_err(), "{wrong}");
        }
    }
}
