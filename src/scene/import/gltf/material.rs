//! Materials: factors only, since textures are not drawn [Gltf2 §3.9].

use glam::Vec3;
use serde_json::Value;

use super::json::{numbers, text};
use crate::scene::mesh::MeshMaterial;

/// Materials of a file, in its order.
pub(super) fn read(values: &[Value]) -> Vec<MeshMaterial> {
    values.iter().map(one).collect()
}

fn one(json: &Value) -> MeshMaterial {
    let name = text(json, "name").to_owned();
    let is_blended = text(json, "alphaMode") == "BLEND";
    let share = |parent: &Value, key: &str, default: f64| {
        parent.get(key).and_then(Value::as_f64).unwrap_or(default).clamp(0.0, 1.0) as f32
    };
    let color = |parent: &Value, key: &str| {
        let factor = numbers::<4>(parent, key).unwrap_or([1.0; 4]).map(|value| value.clamp(0.0, 1.0) as f32);
        (Vec3::new(factor[0], factor[1], factor[2]), if is_blended { factor[3] } else { 1.0 })
    };
    let glossy = json.get("extensions").and_then(|all| all.get("KHR_materials_pbrSpecularGlossiness"));
    let metallic_roughness = json.get("pbrMetallicRoughness");
    let (parent, key, metallic, roughness) = match (metallic_roughness, glossy) {
        // The older model has no metals: its colour is the diffuse one.
        (None, Some(glossy)) => {
            (Some(glossy), "diffuseFactor", Some(0.0), Some(1.0 - share(glossy, "glossinessFactor", 1.0)))
        }
        (Some(parent), _) => {
            let share = |key| Some(share(parent, key, 1.0));
            (Some(parent), "baseColorFactor", share("metallicFactor"), share("roughnessFactor"))
        }
        (None, None) => (None, "", None, None),
    };
    let (base_color, opacity) = parent.map_or((Vec3::ONE, 1.0), |parent| color(parent, key));
    MeshMaterial { name, base_color, metallic, roughness, opacity }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_one(text: &str) -> MeshMaterial {
        one(&serde_json::from_str(text).expect("JSON"))
    }

    #[test]
    fn factors_have_the_defaults_of_the_format() {
        let plain = read_one(r#"{"name": "steel"}"#);
        assert_eq!((plain.name.as_str(), plain.metallic, plain.roughness), ("steel", None, None));
        let empty = read_one(r#"{"pbrMetallicRoughness": {}}"#);
        assert_eq!((empty.base_color, empty.metallic, empty.roughness), (Vec3::ONE, Some(1.0), Some(1.0)));
    }

    #[test]
    fn only_blended_materials_let_light_through() {
        let factors = r#""pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 0.25], "roughnessFactor": 0.5}"#;
        assert_eq!(read_one(&format!("{{{factors}}}")).opacity, 1.0);
        let glass = read_one(&format!(r#"{{"alphaMode": "BLEND", {factors}}}"#));
        assert_eq!((glass.opacity, glass.base_color), (0.25, Vec3::new(1.0, 0.5, 0.0)));
        assert_eq!(glass.roughness, Some(0.5));
    }

    #[test]
    fn the_older_model_gives_its_diffuse_color() {
        let glossy = read_one(
            r#"{"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0, 1, 0, 1], "glossinessFactor": 0.75}}}"#,
        );
        assert_eq!((glossy.base_color, glossy.metallic, glossy.roughness), (Vec3::Y, Some(0.0), Some(0.25)));
    }
}
