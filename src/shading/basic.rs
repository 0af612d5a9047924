//! `basic`: Disney diffuse and GGX under lights and a studio environment, tone-mapped at its end.
//!
//! Reads the table of [`super::brdf_table`] and the uniform of [`super::environment`]. Source: [Burley2012 §5], named by
//! [Murray2016 §4.2]. Shader: `shaders/objects/basic.wgsl`. Twin: `tests/twins/basic.rs`.

use super::environment::{Environment, EnvironmentBlur, EnvironmentLobe, Studio};
use super::{BASE_COLOR, MaterialContext, OPACITY, ObjectShader, Resource, ResourceData, brdf_table};
use crate::config::param::{Param, Values};
use crate::gpu::{GpuStruct, StructInfo, Wgsl};
use crate::{gpu_struct, wgsl};

/// The parameters of `basic`.
pub const PARAMS: &[Param] = &[BASE_COLOR, OPACITY, SMOOTHNESS, METALLIC];

/// `smoothness`.
pub const SMOOTHNESS: Param =
    Param::number("smoothness", 0.5).range(0.0, 1.0).doc("0 is matt, 1 a mirror.").examples(&["0", "0.5", "1"]);

/// `metallic`.
pub const METALLIC: Param = Param::number("metallic", 0.0)
    .range(0.0, 1.0)
    .doc("0 is plastic, 1 is metal in the base colour.")
    .examples(&["0", "0.5", "1"]);

gpu_struct! {
    "objects/basic.wgsl",
    /// See `shaders/objects/basic.wgsl`.
    pub struct BasicMaterial {
        /// 1 - perceptual roughness, 0..=1.
        pub smoothness: f32,
        /// 0 is plastic (4 % reflectance), 1 is metal (the base colour is the reflectance).
        pub metallic: f32,
        /// Factor on radiance before tone mapping, 2^stops.
        pub exposure_factor: f32,
        /// Padding.
        pub _pad0: f32,
        /// How far this smoothness blurs the environment.
        pub blur: EnvironmentBlur,
    }
}

impl BasicMaterial {
    /// A material in the neutral studio.
    pub fn new(smoothness: f32, metallic: f32, exposure_factor: f32) -> BasicMaterial {
        let roughness = (1.0 - smoothness).max(brdf_table::ROUGHNESS_MIN);
        BasicMaterial {
            smoothness,
            metallic,
            exposure_factor,
            _pad0: 0.0,
            blur: EnvironmentBlur::new(&Studio::neutral_shape(), roughness),
        }
    }
}

/// The shader's registry entry.
pub struct Basic;

impl ObjectShader for Basic {
    fn name(&self) -> &'static str {
        "basic"
    }
    fn doc(&self) -> &'static str {
        "Plastic to metal in a studio's light."
    }
    fn params(&self) -> &'static [Param] {
        PARAMS
    }
    fn wgsl(&self) -> &'static [Wgsl] {
        const FILES: &[Wgsl] = &[
            wgsl!("lib/brdf.wgsl"),
            wgsl!("lib/environment.wgsl"),
            wgsl!("lib/tone_map.wgsl"),
            wgsl!("objects/basic.wgsl"),
        ];
        FILES
    }
    fn material_info(&self) -> StructInfo {
        BasicMaterial::info()
    }
    fn material(&self, values: &Values, context: &MaterialContext<'_>) -> Vec<u8> {
        let material = BasicMaterial::new(
            values.number("smoothness") as f32,
            values.number("metallic") as f32,
            context.exposure_factor,
        );
        bytemuck::bytes_of(&material).to_vec()
    }
    fn resources(&self) -> &'static [Resource] {
        const RESOURCES: &[Resource] = &[
            Resource {
                declaration: "var brdf_table: texture_2d<f32>;",
                data: || ResourceData::Texture([brdf_table::SIZE; 2], brdf_table::BYTES.to_vec()),
            },
            Resource {
                declaration: "var<uniform> environment: Environment;",
                data: || ResourceData::Uniform(bytemuck::bytes_of(&Studio::neutral().uniform()).to_vec()),
            },
        ];
        RESOURCES
    }
    fn resource_infos(&self) -> Vec<StructInfo> {
        vec![EnvironmentLobe::info(), EnvironmentBlur::info(), Environment::info()]
    }
}
