//! What a trace tells of itself: the schema of its messages, and the records that the standard asks for
//! (ASAM OSI 3.8, "Multi channel trace file format").

use std::collections::BTreeMap;

use replay::Schema;

use super::messages::InterfaceVersion;

/// The standard's version, which is also that of the trace format.
pub const VERSION: InterfaceVersion = InterfaceVersion { version_major: 3, version_minor: 8, version_patch: 0 };
const VERSION_TEXT: &str = "3.8.0";
/// Version of the protobuf that compiled the standard's files into the schema.
const PROTOBUF: &str = "6.30.2";
/// Topic of the messages.
pub const TOPIC: &str = "ground_truth";
/// Name of the record that makes an MCAP file a trace of OSI.
pub const RECORD: &str = "net.asam.osi.trace";
/// The whole schema, by `schema/make.py`; its licence is in `schema/NOTICE.md`.
const DESCRIPTORS: &[u8] = include_bytes!("schema/ground_truth.binpb");

/// The schema of the messages.
pub fn schema() -> Schema<'static> {
    Schema { name: "osi3.GroundTruth", encoding: "protobuf", data: DESCRIPTORS }
}

/// The record of the file. It has no time of creation, which would be a clock's.
pub fn trace(map: &str) -> BTreeMap<String, String> {
    entries([
        ("version", VERSION_TEXT),
        ("min_osi_version", VERSION_TEXT),
        ("max_osi_version", VERSION_TEXT),
        ("min_protobuf_version", PROTOBUF),
        ("max_protobuf_version", PROTOBUF),
        ("description", &format!("A simulated drive on map {map}")),
        ("data_sources", concat!("A-Eye ", env!("CARGO_PKG_VERSION"))),
    ])
}

/// What the channel tells of itself.
pub fn channel() -> BTreeMap<String, String> {
    entries([
        ("net.asam.osi.trace.channel.osi_version", VERSION_TEXT),
        ("net.asam.osi.trace.channel.protobuf_version", PROTOBUF),
        ("net.asam.osi.trace.channel.description", "The simulated world; what never changes is in the first message"),
    ])
}

fn entries<const N: usize>(pairs: [(&str, &str); N]) -> BTreeMap<String, String> {
    pairs.into_iter().map(|(name, value)| (name.to_owned(), value.to_owned())).collect()
}
