//! The weights and constants of a model: each holds as many values as its shape says, and none is no number;
//! those that stand in files beside it become part of it.

use std::path::{Component, Path, PathBuf};

use crate::onnx::pb::{self, tensor_proto::DataLocation, tensor_proto::DataType};

/// Most bytes of weights in files beside a model.
const MOST_BYTES: u64 = intake::most::NETWORK;
/// Most dimensions of a tensor.
const MOST_DIMS: usize = 16;

/// Brings weights that stand in files of the model's folder into it; gives the digest over them, or `None`
/// where there are none. Without a folder such weights are refused.
pub(crate) fn gather(model: &mut pb::ModelProto, dir: Option<&Path>) -> Result<Option<blake3::Hash>, String> {
    let mut files = Files { dir, left: MOST_BYTES };
    let mut digest = blake3::Hasher::new();
    let mut count = 0;
    for_each(model, &mut |tensor| {
        if tensor.data_location == Some(DataLocation::External as i32) {
            files.fetch(tensor).map_err(|reason| of(tensor, &reason))?;
            digest.update(&(tensor.raw_data.len() as u64).to_le_bytes()).update(&tensor.raw_data);
            count += 1;
        }
        check(tensor).map_err(|reason| of(tensor, &reason))
    })?;
    Ok((count > 0).then(|| digest.finalize()))
}

fn of(tensor: &pb::TensorProto, reason: &str) -> String {
    let name: String = tensor.name.chars().take(80).collect();
    format!("weights {name:?}: {reason}")
}

type Visit<'a> = dyn FnMut(&mut pb::TensorProto) -> Result<(), String> + 'a;

/// Visits every tensor of a model in its order. Graphs are nested as deeply as messages can be, which is not far.
pub(crate) fn for_each(model: &mut pb::ModelProto, visit: &mut Visit<'_>) -> Result<(), String> {
    model.graph.as_mut().map_or(Ok(()), |graph| for_each_in(graph, visit))
}

fn for_each_in(graph: &mut pb::GraphProto, visit: &mut Visit<'_>) -> Result<(), String> {
    graph.initializer.iter_mut().try_for_each(&mut *visit)?;
    for attribute in graph.node.iter_mut().flat_map(|node| &mut node.attribute) {
        attribute.t.iter_mut().chain(&mut attribute.tensors).try_for_each(&mut *visit)?;
        attribute.g.iter_mut().chain(&mut attribute.graphs).try_for_each(|graph| for_each_in(graph, visit))?;
    }
    Ok(())
}

/// Files of the model's folder.
struct Files<'a> {
    dir: Option<&'a Path>,
    /// Bytes of weights that may still come.
    left: u64,
}

impl Files<'_> {
    fn fetch(&mut self, tensor: &mut pb::TensorProto) -> Result<(), String> {
        let entry = |key: &str| tensor.external_data.iter().find(|entry| entry.key == key).map(|entry| &entry.value);
        let number = |key: &str| {
            let parse = |text: &String| text.parse::<u64>().map_err(|_| format!("{key} {text:?} is no number"));
            entry(key).map(parse).transpose()
        };
        let location = entry("location").ok_or("stand in a file that is not named")?;
        let say = |error: std::io::Error| format!("{location:?} {error}");
        let from = number("offset")?.unwrap_or(0);
        let path = self.path(location)?;
        let data = intake::read_part(&path, from, number("length")?, self.left).map_err(say)?;
        self.left -= data.len() as u64;
        (tensor.raw_data, tensor.data_location) = (data, None);
        tensor.external_data.clear();
        Ok(())
    }

    /// Where a file of the folder is; links may not lead out of it.
    fn path(&self, location: &str) -> Result<PathBuf, String> {
        let dir = self.dir.ok_or("stand in another file, but the model is in none")?;
        let dir = if dir.as_os_str().is_empty() { Path::new(".") } else { dir };
        let say = |error: std::io::Error| format!("{location:?}: {error}");
        let elsewhere = || Err(format!("{location:?} is not in the model's folder"));
        if !Path::new(location).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
            return elsewhere();
        }
        let path = dir.join(location).canonicalize().map_err(say)?;
        if path.starts_with(dir.canonicalize().map_err(say)?) { Ok(path) } else { elsewhere() }
    }
}

/// Refuses a tensor that holds another number of values than its shape says, or one that is no number.
fn check(tensor: &pb::TensorProto) -> Result<(), String> {
    let count = tensor.dims.iter().try_fold(1u64, |count, &n| count.checked_mul(u64::try_from(n).ok()?));
    let count = count.filter(|_| tensor.dims.len() <= MOST_DIMS).ok_or_else(|| {
        let dims: Vec<_> = tensor.dims.iter().take(MOST_DIMS).map(i64::to_string).collect();
        format!("have the shape {}, which no values can have", dims.join("x"))
    })?;
    let Some((bits, listed)) = form(tensor) else {
        return Err(format!("are of type {}, which is not supported", tensor.data_type));
    };
    let (held, what) = match tensor.raw_data.len() {
        0 => (listed as u64, "values"),
        bytes => (bytes as u64, "bytes"),
    };
    let wanted = if what == "bytes" { count.checked_mul(bits / 8) } else { Some(count) };
    if wanted != Some(held) {
        return Err(format!("hold {held} {what}, but their shape has {count} values"));
    }
    if has_nan(tensor) {
        return Err("hold values that are no numbers (NaN)".into());
    }
    Ok(())
}

/// Bits of a value in raw data, and how many values are listed otherwise.
fn form(tensor: &pb::TensorProto) -> Option<(u64, usize)> {
    let small = tensor.int32_data.len();
    Some(match DataType::try_from(tensor.data_type).ok()? {
        DataType::Float => (32, tensor.float_data.len()),
        DataType::Double => (64, tensor.double_data.len()),
        DataType::Int64 | DataType::Uint64 => (64, tensor.int64_data.len().max(tensor.uint64_data.len())),
        DataType::Int32 | DataType::Uint32 => (32, small.max(tensor.uint64_data.len())),
        DataType::Int16 | DataType::Uint16 | DataType::Float16 | DataType::Bfloat16 => (16, small),
        DataType::Int8 | DataType::Uint8 | DataType::Bool => (8, small),
        DataType::String => (8, tensor.string_data.len()),
        _ => return None,
    })
}

fn has_nan(tensor: &pb::TensorProto) -> bool {
    let raw = tensor.raw_data.as_slice();
    // All bits of the exponent, and one of the fraction.
    let is_nan = |bits: u16, infinite: u16| bits & 0x7fff > infinite;
    let any16 = |infinite: u16| {
        let listed = tensor.int32_data.iter().any(|&bits| is_nan(bits as u16, infinite));
        listed || raw.as_chunks().0.iter().any(|&bytes| is_nan(u16::from_le_bytes(bytes), infinite))
    };
    match DataType::try_from(tensor.data_type) {
        Ok(DataType::Float) => {
            let listed = tensor.float_data.iter().any(|v| v.is_nan());
            listed || raw.as_chunks().0.iter().any(|&bytes| f32::from_le_bytes(bytes).is_nan())
        }
        Ok(DataType::Double) => {
            let listed = tensor.double_data.iter().any(|v| v.is_nan());
            listed || raw.as_chunks().0.iter().any(|&bytes| f64::from_le_bytes(bytes).is_nan())
        }
        Ok(DataType::Float16) => any16(0x7c00),
        Ok(DataType::Bfloat16) => any16(0x7f80),
        _ => false,
    }
}
