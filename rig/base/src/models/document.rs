//! A glTF file with all that belongs to it, bounds checked.

use anyhow::{Context, anyhow, bail};
use gltf::accessor::{DataType, Dimensions};
use gltf::json::validation::Checked;
use gltf::{Gltf, json};

use super::files::Folder;
use super::texture::Texture;

/// Values of an accessor at most.
const MOST_VALUES: usize = 1_000_000;
/// Pictures of a file at most: what is kept of each takes up to a megabyte.
const MOST_IMAGES: usize = 256;
/// Header of a binary file, bytes.
const HEADER: usize = 12;

/// A glTF file with its buffers and the pictures that colour it.
pub(super) struct Document {
    pub(super) gltf: gltf::Document,
    buffers: Vec<Vec<u8>>,
    /// Of each image that is a texture of base colours.
    images: Vec<Option<Texture>>,
}

/// Reads a file and those that it names.
pub(super) fn read(files: &mut Folder, name: &str) -> anyhow::Result<Document> {
    let bytes = files.bytes(name)?;
    if bytes.starts_with(b"glTF") {
        check_length(&bytes)?;
    } else if !bytes.trim_ascii_start().starts_with(b"{") {
        bail!("is no glTF 2.0 file, binary (.glb) or JSON (.gltf)");
    }
    let refused = |error: gltf::Error| anyhow!(sentence(&error));
    let Gltf { document, blob } = Gltf::from_slice_without_validation(&bytes).map_err(refused)?;
    drop(bytes);
    check_version(document.as_json())?;
    check_attributes(document.as_json())?;
    let gltf = gltf::Document::from_json(document.into_json()).map_err(refused)?;
    let mut document = Document { buffers: buffers(files, name, (gltf.as_json(), blob))?, gltf, images: Vec::new() };
    document.images = images(files, name, &document)?;
    Ok(document)
}

/// Refuses a binary file that is not as long as its header says.
fn check_length(bytes: &[u8]) -> anyhow::Result<()> {
    let told = bytes.get(8..HEADER).and_then(|told| told.try_into().ok()).map(u32::from_le_bytes);
    match told.map(|told| told as usize) {
        None => bail!("is cut off: has {} bytes, expected a header of {HEADER} and more", bytes.len()),
        Some(told) if told > bytes.len() => bail!("is cut off: has {} bytes, expected {told}", bytes.len()),
        Some(told) if told < bytes.len() => bail!("has {} bytes, and its header says {told}", bytes.len()),
        Some(_) => Ok(()),
    }
}

fn check_version(root: &json::Root) -> anyhow::Result<()> {
    let json::Asset { version, .. } = &root.asset;
    if version.starts_with("2.") { Ok(()) } else { bail!("is glTF {version}, expected 2.0") }
}

/// Refuses attributes that are nowhere, which the validation of the `gltf` crate (1.4.1) takes to be there.
fn check_attributes(root: &json::Root) -> anyhow::Result<()> {
    for (i, mesh) in root.meshes.iter().enumerate() {
        let attributes = mesh.primitives.iter().flat_map(|primitive| primitive.attributes.values());
        if let Some(beyond) = attributes.map(json::Index::value).find(|index| *index >= root.accessors.len()) {
            bail!("mesh {i} has an attribute at accessor {beyond}, expected one of its {}", root.accessors.len());
        }
    }
    Ok(())
}

/// What is wrong with a file in one sentence.
fn sentence(error: &gltf::Error) -> String {
    match error {
        gltf::Error::Validation(all) => all
            .first()
            .map_or_else(String::new, |(path, error)| format!("{path}: {}", error.to_string().to_lowercase())),
        error => format!("is no glTF 2.0: {error}"),
    }
}

type Content<'a> = (&'a json::Root, Option<Vec<u8>>);

fn buffers(files: &mut Folder, name: &str, (root, mut blob): Content<'_>) -> anyhow::Result<Vec<Vec<u8>>> {
    let mut read = |(i, buffer): (usize, &json::Buffer)| {
        let place = || format!("buffer {i}");
        let bytes = match &buffer.uri {
            Some(uri) => files.resource(name, uri).with_context(place)?,
            None => blob.take().filter(|_| i == 0).ok_or_else(|| anyhow!("{} has no data", place()))?,
        };
        if (bytes.len() as u64) < buffer.byte_length.0 {
            bail!("{} has {} bytes, expected {}", place(), bytes.len(), buffer.byte_length.0);
        }
        Ok(bytes)
    };
    root.buffers.iter().enumerate().map(&mut read).collect()
}

fn images(files: &mut Folder, name: &str, document: &Document) -> anyhow::Result<Vec<Option<Texture>>> {
    let root = document.gltf.as_json();
    if root.images.len() > MOST_IMAGES {
        bail!("has {} images, expected at most {MOST_IMAGES}", root.images.len());
    }
    let mut images: Vec<Option<Texture>> = root.images.iter().map(|_| None).collect();
    for material in &root.materials {
        let Some(at) = document.image_of(material) else { continue };
        let (Some(image), Some(None)) = (root.images.get(at), images.get(at)) else { continue };
        let place = || format!("image {at}");
        let texture = match (&image.buffer_view, &image.uri) {
            (Some(view), _) => Texture::decode(document.view(view.value()).with_context(place)?),
            (None, Some(uri)) => Texture::decode(&files.resource(name, uri).with_context(place)?),
            (None, None) => bail!("{} has no data", place()),
        };
        images[at] = Some(texture.with_context(place)?);
    }
    Ok(images)
}

impl Document {
    fn image_of(&self, material: &json::Material) -> Option<usize> {
        let texture = material.pbr_metallic_roughness.base_color_texture.as_ref()?;
        let texture = self.gltf.as_json().textures.get(texture.index.value())?;
        Some(texture.source.value())
    }

    /// The picture of a material's base colour.
    pub(super) fn texture_of(&self, material: usize) -> Option<&Texture> {
        let at = self.image_of(self.gltf.as_json().materials.get(material)?)?;
        self.images.get(at)?.as_ref()
    }

    /// The bytes of a view.
    fn view(&self, index: usize) -> anyhow::Result<&[u8]> {
        let view = self.gltf.as_json().buffer_views.get(index).ok_or_else(|| anyhow!("no buffer view {index}"))?;
        let from = view.byte_offset.unwrap_or_default().0;
        let range = from.checked_add(view.byte_length.0).map(|to| from as usize..to as usize);
        let buffer = self.buffers.get(view.buffer.value());
        let bytes = buffer.zip(range).and_then(|(buffer, range)| buffer.get(range));
        bytes.ok_or_else(|| anyhow!("buffer view {index} reaches beyond its buffer"))
    }

    /// The values of an accessor, as many components as it has.
    fn values(&self, index: usize) -> anyhow::Result<Values<'_>> {
        let root = self.gltf.as_json();
        let accessor = root.accessors.get(index).ok_or_else(|| anyhow!("no accessor {index}"))?;
        let (Checked::Valid(kind), Checked::Valid(dimensions)) = (accessor.component_type, accessor.type_) else {
            bail!("accessor {index} has no type");
        };
        if accessor.sparse.is_some() {
            bail!("accessor {index} is sparse, expected all of its values");
        }
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        if count > MOST_VALUES {
            bail!("accessor {index} has {count} values, expected at most {MOST_VALUES}");
        }
        let view = accessor.buffer_view.ok_or_else(|| anyhow!("accessor {index} has no data"))?.value();
        let bytes = self.view(view).with_context(|| format!("accessor {index}"))?;
        let size = kind.0.size() * dimensions.multiplicity();
        let stride = root.buffer_views.get(view).and_then(|view| view.byte_stride).map_or(0, |stride| stride.0);
        let stride = if stride == 0 { size } else { stride };
        let from = usize::try_from(accessor.byte_offset.unwrap_or_default().0).unwrap_or(usize::MAX);
        let length =
            stride.checked_mul(count.saturating_sub(1)).and_then(|span| span.checked_add(size)?.checked_add(from));
        if count > 0 && length.is_none_or(|length| length > bytes.len()) {
            bail!("accessor {index} reaches beyond its buffer view: {count} values");
        }
        Ok(Values { bytes, from, stride, count, kind: kind.0, dimensions, normalized: accessor.normalized, index })
    }

    /// Vectors of so many components, whole numbers as shares of their greatest.
    pub(super) fn vectors<const N: usize>(&self, index: usize) -> anyhow::Result<Vec<[f32; N]>> {
        let values = self.values(index)?;
        let is_float = values.kind == DataType::F32;
        if values.dimensions.multiplicity() < N || !(is_float || values.normalized) || is_matrix(values.dimensions) {
            bail!("accessor {index} has values of another kind than expected");
        }
        let of = |at: usize| core::array::from_fn(|i| values.component(at, i));
        Ok((0..values.count).map(of).collect())
    }

    /// Whether colours have an alpha, and whether vectors have so many components.
    pub(super) fn components(&self, index: usize) -> anyhow::Result<usize> {
        Ok(self.values(index)?.dimensions.multiplicity())
    }

    /// Whole numbers.
    pub(super) fn numbers(&self, index: usize) -> anyhow::Result<Vec<u32>> {
        let values = self.values(index)?;
        if values.dimensions != Dimensions::Scalar {
            bail!("accessor {index} has vectors, expected indices");
        }
        (0..values.count).map(|at| values.number(at)).collect()
    }
}

fn is_matrix(dimensions: Dimensions) -> bool {
    matches!(dimensions, Dimensions::Mat2 | Dimensions::Mat3 | Dimensions::Mat4)
}

/// What an accessor shows of a buffer, within its bounds.
struct Values<'a> {
    bytes: &'a [u8],
    from: usize,
    stride: usize,
    count: usize,
    kind: DataType,
    dimensions: Dimensions,
    normalized: bool,
    index: usize,
}

impl Values<'_> {
    fn raw<const N: usize>(&self, at: usize, component: usize) -> [u8; N] {
        let from = self.from + at * self.stride + component * N;
        self.bytes.get(from..from + N).and_then(|bytes| bytes.try_into().ok()).unwrap_or([0; N])
    }

    fn component(&self, at: usize, component: usize) -> f32 {
        match self.kind {
            DataType::F32 => f32::from_le_bytes(self.raw(at, component)),
            DataType::U8 => f32::from(self.raw::<1>(at, component)[0]) / f32::from(u8::MAX),
            DataType::U16 => f32::from(u16::from_le_bytes(self.raw(at, component))) / f32::from(u16::MAX),
            DataType::I8 => f32::from(i8::from_le_bytes(self.raw(at, component))) / f32::from(i8::MAX),
            DataType::I16 => f32::from(i16::from_le_bytes(self.raw(at, component))) / f32::from(i16::MAX),
            DataType::U32 => u32::from_le_bytes(self.raw(at, component)) as f32 / u32::MAX as f32,
        }
    }

    fn number(&self, at: usize) -> anyhow::Result<u32> {
        match self.kind {
            DataType::U8 => Ok(self.raw::<1>(at, 0)[0].into()),
            DataType::U16 => Ok(u16::from_le_bytes(self.raw(at, 0)).into()),
            DataType::U32 => Ok(u32::from_le_bytes(self.raw(at, 0))),
            _ => bail!("accessor {} has no whole numbers, expected indices", self.index),
        }
    }
}
