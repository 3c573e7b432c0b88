//! Shader sources. Each has a common part and a specific part. Tests parse and validate all sources without a GPU.

/// Structures, noise, shadows, and shading shared by the shaders.
const COMMON: &str = include_str!("shaders/common.wgsl");

/// Ambient occlusion in shaders of surfaces.
const OCCLUDED: &str = include_str!("shaders/occluded.wgsl");

/// Name of the `develop` variant for multisampled targets.
pub const DEVELOP_MULTISAMPLED: &str = "develop, sampled";

/// A shader with its name and source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ShaderSource {
    /// Name for error messages.
    pub name: &'static str,
    /// WGSL source.
    pub text: String,
}

/// Returns all shaders.
#[must_use]
pub fn all() -> Vec<ShaderSource> {
    let surface = [COMMON, OCCLUDED, include_str!("shaders/surface.wgsl")].join("\n");
    let drawn = [
        ("water", include_str!("shaders/water.wgsl")),
        ("precipitation", include_str!("shaders/precipitation.wgsl")),
        ("sky", include_str!("shaders/sky.wgsl")),
    ];
    let mut sources: Vec<ShaderSource> =
        drawn.iter().map(|(name, own)| ShaderSource { name, text: format!("{COMMON}\n{own}") }).collect();
    sources.push(ShaderSource { name: "lean", text: format!("{surface}\n{}", include_str!("shaders/lean.wgsl")) });
    sources.push(ShaderSource { name: "surface", text: surface });
    sources.push(ShaderSource { name: "defect", text: [COMMON, OCCLUDED, include_str!("shaders/defect.wgsl")].join("\n") });
    sources.push(ShaderSource { name: "shadow", text: include_str!("shaders/shadow.wgsl").to_owned() });
    sources.push(ShaderSource { name: "painter", text: include_str!("shaders/painter.wgsl").to_owned() });
    let developing = |own: &str| format!("{}\n{own}", include_str!("shaders/full_screen.wgsl"));
    sources.push(ShaderSource { name: "adapt", text: developing(include_str!("shaders/adapt.wgsl")) });
    sources.push(ShaderSource { name: "occlusion", text: developing(include_str!("shaders/occlusion.wgsl")) });
    let develop = developing(include_str!("shaders/develop.wgsl"));
    sources.push(ShaderSource { name: "develop", text: develop.clone() });
    let sampled = develop.replace("texture_depth_2d;", "texture_depth_multisampled_2d;");
    sources.push(ShaderSource { name: DEVELOP_MULTISAMPLED, text: sampled });
    sources
}

/// Returns the source of a shader, or an empty string if the name is unknown.
#[must_use]
pub fn source(name: &str) -> String {
    all().into_iter().find(|source| source.name == name).map_or_else(String::new, |source| source.text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    #[test]
    fn exact_every_shader_is_valid() {
        for source in all() {
            let module = naga::front::wgsl::parse_str(&source.text)
                .unwrap_or_else(|error| panic!("{}: {}", source.name, error.emit_to_string(&source.text)));
            Validator::new(ValidationFlags::all(), Capabilities::empty())
                .validate(&module)
                .unwrap_or_else(|error| panic!("{}: {}", source.name, error.emit_to_string(&source.text)));
            assert!(!module.entry_points.is_empty(), "{}: no entry point", source.name);
        }
    }

    #[test]
    fn exact_multisampling_has_its_own_shader_variant() {
        assert_ne!(source(DEVELOP_MULTISAMPLED), source("develop"));
    }

    #[test]
    fn exact_validation_rejects_an_invalid_shader() {
        assert!(
            naga::front::wgsl::parse_str("fn f() -> f32 { return 1u; }").is_err_and(|e| !e.message().is_empty()) || {
                let module = naga::front::wgsl::parse_str("fn f() -> f32 { return 1u; }").unwrap();
                Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).is_err()
            }
        );
    }
}
