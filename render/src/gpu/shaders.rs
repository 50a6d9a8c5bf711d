//! The shader sources.

/// Declarations that all shaders of a frame start with.
const SCENE: &str = include_str!("../shaders/scene.wgsl");

/// The world's surfaces, a fragment shader for each finish.
const WORLD: &str = concat!(
    include_str!("../shaders/leaf.wgsl"),
    include_str!("../shaders/surface.wgsl"),
    include_str!("../shaders/ground.wgsl"),
    include_str!("../shaders/asphalt.wgsl"),
    include_str!("../shaders/paving.wgsl"),
    include_str!("../shaders/wet.wgsl"),
    include_str!("../shaders/masonry.wgsl"),
    include_str!("../shaders/facade.wgsl"),
    include_str!("../shaders/foliage.wgsl")
);

/// Classes and instances alone.
const CLASSES: &str = concat!(include_str!("../shaders/leaf.wgsl"), include_str!("../shaders/classes.wgsl"));

/// The shaders with their names, without the common start.
const SOURCES: [(&str, &str); 7] = [
    ("world", WORLD),
    ("classes", CLASSES),
    ("sky", include_str!("../shaders/sky.wgsl")),
    ("rain", include_str!("../shaders/rain.wgsl")),
    ("glow", include_str!("../shaders/glow.wgsl")),
    ("spray", include_str!("../shaders/spray.wgsl")),
    ("mirror", include_str!("../shaders/mirror.wgsl")),
];

/// The shaders that do not need the scene.
const APART: [(&str, &str); 4] = [
    ("known", include_str!("../shaders/known.wgsl")),
    ("shadow", include_str!("../shaders/shadow.wgsl")),
    ("shadow_copy", include_str!("../shaders/shadow_copy.wgsl")),
    ("resolve", include_str!("../shaders/resolve.wgsl")),
];

/// The whole text of a shader; `None` for a name that is none.
pub(super) fn source(name: &str) -> Option<String> {
    let find = |list: &[(&str, &'static str)]| list.iter().find(|(n, _)| *n == name).map(|(_, text)| *text);
    find(&APART).map(str::to_owned).or_else(|| Some(format!("{SCENE}{}", find(&SOURCES)?)))
}

#[cfg(test)]
mod tests {
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    use super::*;

    #[test]
    fn every_shader_is_valid() {
        for (name, _) in SOURCES.iter().chain(&APART) {
            let text = source(name).unwrap();
            let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&text)));
            let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
            validator.validate(&module).unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string(&text)));
        }
    }
}
