//! From glTF's materials to the renderer's paints.

use gltf::material::AlphaMode;
use kernel::ops;
use render::SemanticTag;
use render::mesh::{CODE_BRAKE, CODE_HEAD, CODE_LACQUER, CODE_LEFT, CODE_RIGHT, CODE_STREET, Paint};

use super::document::Document;
use super::list::Model;
use super::texture::Texture;

/// What is seen through panes.
const BEHIND_GLASS: [f32; 3] = [0.02, 0.024, 0.03];

/// How a primitive is painted.
pub(super) struct Material<'a> {
    paint: Paint,
    /// Red, green and blue, linear, and alpha.
    factor: [f32; 4],
    texture: Option<&'a Texture>,
    /// Which of its texture coordinates.
    pub(super) coordinates: u32,
    /// Below this alpha nothing is there.
    pub(super) cutoff: Option<f32>,
    is_pane: bool,
    double_sided: bool,
}

impl<'a> Material<'a> {
    pub(super) fn of(document: &'a Document, material: &gltf::Material<'_>, said: &Model, tag: SemanticTag) -> Self {
        let metal = material.pbr_metallic_roughness();
        let smooth = 1.0 - metal.roughness_factor().clamp(0.0, 1.0);
        let gloss = smooth * (0.5 + 0.5 * metal.metallic_factor().clamp(0.0, 1.0));
        let (is_pane, cutoff) = match material.alpha_mode() {
            AlphaMode::Opaque => (false, None),
            AlphaMode::Blend => (true, None),
            AlphaMode::Mask => (false, Some(material.alpha_cutoff().unwrap_or(0.5))),
        };
        let gloss = if is_pane { 1.0 } else { gloss };
        let code = code(said, material.name().unwrap_or_default());
        let paint = Paint::plain(tag, [0; 3]).glossy((255.0 * gloss) as u8).coded(code);
        let texture = material.index().and_then(|index| document.texture_of(index));
        let coordinates = metal.base_color_texture().map_or(0, |texture| texture.tex_coord());
        let (factor, double_sided) = (metal.base_color_factor(), material.double_sided());
        Self { paint, factor, texture, coordinates, cutoff, is_pane, double_sided }
    }

    /// Colour (linear) and alpha at texture coordinates, where a vertex has a colour of its own (linear).
    pub(super) fn colour(&self, at: [f32; 2], own: [f32; 4]) -> [f32; 4] {
        let texel = self.texture.map_or([1.0; 4], |texture| {
            let [r, g, b, a] = texture.at(at);
            [linear(r), linear(g), linear(b), a]
        });
        core::array::from_fn(|i| self.factor[i] * texel[i] * own[i])
    }

    /// Whether its colour changes from place to place by more than vertices know.
    pub(super) fn is_textured(&self) -> bool {
        self.texture.is_some()
    }

    /// Which way its triangles face, as they do or the other way too.
    pub(super) fn sides(&self) -> &'static [f32] {
        if self.double_sided { &[1.0, -1.0] } else { &[1.0] }
    }

    /// The paint of that colour.
    pub(super) fn paint(&self, [r, g, b, a]: [f32; 4]) -> Paint {
        let shown = |i: usize, c: f32| {
            let a = if self.is_pane { a.clamp(0.0, 1.0) } else { 1.0 };
            encoded(c * a + BEHIND_GLASS[i] * (1.0 - a))
        };
        self.paint.colour([shown(0, r), shown(1, g), shown(2, b)])
    }
}

fn code(said: &Model, name: &str) -> u8 {
    let lamps = &said.lamps;
    let codes = [
        (&lamps.head, CODE_HEAD),
        (&lamps.brake, CODE_BRAKE),
        (&lamps.left, CODE_LEFT),
        (&lamps.right, CODE_RIGHT),
        (&lamps.street, CODE_STREET),
        (&said.lacquer, CODE_LACQUER),
    ];
    codes.iter().find(|(names, _)| names.iter().any(|known| known == name)).map_or(0, |(_, code)| *code)
}

/// From sRGB, both 0 to 1.
fn linear(c: f32) -> f32 {
    if c <= 0.04045 { c / 12.92 } else { ops::pow((c + 0.055) / 1.055, 2.4) }
}

/// To sRGB, 0 to 255.
fn encoded(c: f32) -> u8 {
    let c = c.clamp(0.0, 1.0);
    let c = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * ops::pow(c, 1.0 / 2.4) - 0.055 };
    (255.0 * c).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_encoded_as_they_are_decoded() {
        assert!((0..=255u8).all(|c| encoded(linear(f32::from(c) / 255.0)) == c));
        assert_eq!((encoded(f32::NAN), encoded(7.0), encoded(-1.0)), (0, 255, 0));
    }
}
