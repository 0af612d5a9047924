//! A scene in a style, drawn by the reference renderer: without a device.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

use super::{Content, Request, Resolved, resolve, with_effects};
use crate::config::Style;
use crate::effects::EFFECTS;
use crate::effects::focus::Circles;
use crate::effects::outline::OutlineParams;
use crate::frame::objects::DrawList;
use crate::frame::{MAX_LIGHTS, Materials};
use crate::reference::curvature::Stylist;
use crate::reference::{
    self, BrokenOff, Cylinder, HullLook, Lens, Look, Material, Meshes, Occlusion, Optics, Part, Picture, RowSink,
    Settings, Shade, Sphere, World,
};
use crate::scene::{Camera, Image, Pixels, Scene, srgb_from_linear};
use crate::shading::{SHADERS, basic::BasicMaterial, curvature::CurvatureMaterial, toon::ToonMaterial};

/// Draws stills of one scene in one style, on all cores.
pub struct Exact {
    content: Content,
    threads: usize,
    draft: bool,
}

/// Why a picture was not finished.
#[derive(Debug)]
pub enum ExactError {
    /// Whoever follows the progress asked to stop.
    BrokenOff,
    /// Whoever takes the rows.
    Sink(std::io::Error),
}

impl From<BrokenOff> for ExactError {
    fn from(_: BrokenOff) -> ExactError {
        ExactError::BrokenOff
    }
}

impl Exact {
    /// A renderer of this scene in this style. `threads`: as many as there are cores, unless it says.
    pub fn new(scene: Scene, style: Style, threads: Option<usize>) -> Exact {
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        Exact {
            content: Content::new(Arc::new(scene), Arc::new(style)),
            threads: threads.unwrap_or_else(cores),
            draft: false,
        }
    }

    /// Draws with fewer rays where there are fewer samples: quick, and grainy in soft light.
    pub fn as_draft(self) -> Exact {
        Exact { draft: true, ..self }
    }

    /// Threads that it draws on.
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Whether every pixel of the picture covers what is behind it.
    pub fn is_opaque(&self, request: &Request) -> bool {
        !request.transparent && self.content.camera.background(false)[3] >= 1.0
    }

    /// Draws a picture and gives `sink` its rows from the top, some at a time: RGBA, 8 bits a channel, or 16 in native order.
    /// `progress` hears of rows that are done, and may break off.
    ///
    /// # Errors
    /// [`ExactError`] where `progress` breaks off or `sink` fails.
    pub fn draw_rows(
        &self,
        request: &Request,
        progress: &mut dyn FnMut(u32) -> ControlFlow<()>,
        sink: &mut dyn FnMut(&[u8]) -> std::io::Result<()>,
    ) -> Result<(), ExactError> {
        self.light_rows(request, progress, &mut |rows| sink(&encoded(rows, request.wide)).map_err(ExactError::Sink))
    }

    fn light_rows(
        &self,
        request: &Request,
        progress: &mut dyn FnMut(u32) -> ControlFlow<()>,
        sink: &mut RowSink<'_, ExactError>,
    ) -> Result<(), ExactError> {
        let content = &self.content;
        let Resolved { list, materials, drawn } = resolve(content, None, request.size[1]);
        let camera = content.camera.turned(request.size, request.turn_deg.to_radians());
        let mut lighting = drawn.lighting.lighting(&camera);
        lighting.lights.truncate(MAX_LIGHTS);
        let optics = Optics::new(&camera, request.size);
        let center =
            camera.view_from_world.as_dmat4().transform_point3(content.scene.bounding_sphere().center.as_dvec3());
        let materials = shades(&materials, &content.style, &drawn.used, center);
        let world = world(list.unwrap_or_default(), &camera, content, &materials, &optics);
        let (mut occlusions, mut lens, mut layers, mut lines) = (Vec::new(), None, None, Vec::new());
        with_effects(content, &drawn, &camera, request, |effect, values, context| {
            let registered = EFFECTS[effect];
            if registered.changes_nothing(values, context).is_some() {
                return;
            }
            match registered.name() {
                "ssaoPost" => occlusions.push(Occlusion {
                    radius: (context.world)(values.length("radius")),
                    intensity: values.number("intensity"),
                    pick_bits: registered.picks(values).map(|_| context.pick_bits),
                }),
                "dofPost" => {
                    let circles = Circles::new(values, context);
                    match values.choice("show") {
                        "layers" => layers = circles,
                        _ => lens = circles.map(|circles| Lens::new(circles, context.depths.front())),
                    }
                }
                "outlinePost" => {
                    let params: OutlineParams = bytemuck::pod_read_unaligned(&registered.uniform(values, context));
                    lines.push(params);
                }
                _ => {}
            }
        });
        let picture = Picture {
            world: &world,
            materials: &materials,
            optics,
            lighting: &lighting,
            occlusions: &occlusions,
            lens,
            layers,
            lines: &lines,
            background: content.camera.background(request.transparent),
        };
        let settings =
            Settings { size: request.size, samples: request.samples, draft: self.draft, threads: self.threads };
        reference::render(&picture, &settings, progress, sink)
    }

    /// Draws one still.
    ///
    /// # Errors
    /// [`ExactError::BrokenOff`] where `progress` breaks off.
    pub fn still(
        &self,
        request: &Request,
        progress: &mut dyn FnMut(u32) -> ControlFlow<()>,
    ) -> Result<Image, ExactError> {
        let mut bytes = Vec::new();
        self.draw_rows(request, progress, &mut |rows| {
            bytes.extend_from_slice(rows);
            Ok(())
        })?;
        let pixels = if request.wide {
            Pixels::U16(bytes.chunks_exact(2).map(bytemuck::pod_read_unaligned).collect())
        } else {
            Pixels::U8(bytes)
        };
        Ok(Image { size: request.size, pixels, opaque: self.is_opaque(request) })
    }
}

/// Materials as the reference shades them; `center` is the middle of the scene's sphere in view space.
fn shades(materials: &Materials, style: &Style, used: &[super::build::MaterialUse], center: DVec3) -> Vec<Material> {
    let params = |shader: usize, index: u32, size: usize| {
        materials.params.get(&shader).and_then(|bytes| bytes.get(index as usize * size..(index as usize + 1) * size))
    };
    let of = |(material, used): (&crate::frame::objects::Material, &super::build::MaterialUse)| {
        let shader = material.shader as usize;
        let values = &style.shaders[used.shader].values;
        let stylist = material.stylist.checked_sub(1).and_then(|stylist| {
            let bytes = params(stylist as usize, material.stylist_index, size_of::<CurvatureMaterial>())?;
            Some(Box::new(Stylist {
                material: bytemuck::pod_read_unaligned(bytes),
                opacity: values.transfer("opacity_transfer").clone(),
                color: values.transfer("color_transfer").clone(),
                center,
            }))
        });
        let shade = match SHADERS[shader].name() {
            "basic" => params(shader, material.index, size_of::<BasicMaterial>())
                .map(|bytes| Shade::basic(&bytemuck::pod_read_unaligned(bytes))),
            "toon" => params(shader, material.index, size_of::<ToonMaterial>())
                .map(|bytes| Shade::Toon(bytemuck::pod_read_unaligned(bytes))),
            _ => None,
        };
        let [r, g, b, covers] = material.base_color;
        let width = (f64::from(material.hull_px), f64::from(material.hull_world));
        let [hull_r, hull_g, hull_b] = material.hull_color;
        Material {
            base_color: (covers > 0.5).then(|| Vec3::new(r, g, b).as_dvec3()),
            // What is seen through has no hull outline.
            hull: (width.0 + width.1 > 0.0 && material.opacity >= 1.0)
                .then(|| HullLook { color: Vec3::new(hull_r, hull_g, hull_b).as_dvec3(), width }),
            opacity: values.number("opacity").min(f64::from(material.opacity)),
            shade: shade.unwrap_or(Shade::Unlit),
            stylist,
        }
    };
    materials.common.iter().zip(used).map(of).collect()
}

/// Everything that is drawn, in view space.
fn world(list: DrawList, camera: &Camera, content: &Content, materials: &[Material], optics: &Optics) -> World {
    let view_from_world = DAffine3::from_mat4(camera.view_from_world.as_dmat4());
    let place = |at: [f32; 3]| view_from_world.transform_point3(Vec3::from(at).as_dvec3());
    let spheres = list.atoms.iter().map(|atom| Sphere {
        center: place(atom.position_world),
        radius: f64::from(atom.radius),
        look: Look { color: unpacked(atom.color), material: atom.material, group: atom.group(), picks: atom.picks() },
    });
    let cylinders = list.connectors.iter().map(|connector| {
        let look = |color: [u32; 2]| Look {
            color: unpacked(color),
            material: connector.material(),
            group: color[1] >> 16,
            picks: connector.picks(),
        };
        Cylinder {
            ends: [place(connector.a_world), place(connector.b_world)],
            radius: f64::from(connector.radius),
            looks: [look(connector.color_a), look(connector.color_b)],
        }
    });
    let meshes = list.meshes.as_ref().map(|scene| {
        let parts = (0..).zip(&list.parts).filter_map(|(index, part)| {
            let part = part.as_ref()?;
            let look = Look { color: unpacked(part.color), material: part.material(), group: 0, picks: part.picks() };
            Some(Part { part: index, look, has_vertex_colors: part.has_vertex_colors() })
        });
        Meshes { scene: Arc::clone(scene), parts: parts.collect() }
    });
    let center = view_from_world.transform_point3(content.scene.bounding_sphere().center.as_dvec3());
    World::new(center, view_from_world, spheres.collect(), cylinders.collect(), meshes, |world| {
        reference::outlines(world, materials, optics)
    })
    .with_see_through(materials.iter().map(|material| material.opacity < 1.0).collect())
}

/// Linear RGB of two words of half floats.
fn unpacked([rg, b]: [u32; 2]) -> DVec3 {
    let value = |bits: u32| half::f16::from_bits(bits as u16).to_f64();
    DVec3::new(value(rg & 0xffff), value(rg >> 16), value(b & 0xffff))
}

/// Straight-alpha sRGB of premultiplied linear light.
fn encoded(rows: &[[f32; 4]], wide: bool) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(rows.len() * if wide { 8 } else { 4 });
    for [r, g, b, alpha] in rows.iter().map(|pixel| pixel.map(f64::from)) {
        let channels = [r, g, b].map(|light| srgb_from_linear(light / alpha.max(1e-6)));
        for value in channels.into_iter().chain([alpha.clamp(0.0, 1.0)]) {
            if wide {
                bytes.extend(((value * 65535.0).round() as u16).to_ne_bytes());
            } else {
                bytes.push((value * 255.0).round() as u8);
            }
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_knows_every_shader_and_effect() {
        // A new one needs its exact form in `shades` or `light_rows`.
        assert_eq!(
            SHADERS.iter().map(|shader| shader.name()).collect::<Vec<_>>(),
            ["basic", "toon", "unlit", "curvature"]
        );
        assert_eq!(
            EFFECTS.iter().map(|effect| effect.name()).collect::<Vec<_>>(),
            ["ssaoPost", "outlinePost", "dofPost"]
        );
    }

    #[test]
    fn light_is_encoded_as_srgb() {
        let rows = [[1.0, 0.0, 0.214_041_14, 1.0], [0.25, 0.0, 0.0, 0.5], [0.0; 4]];
        assert_eq!(encoded(&rows, false), [255, 0, 128, 255, 188, 0, 0, 128, 0, 0, 0, 0]);
        let wide = encoded(&rows[..1], true);
        assert_eq!(bytemuck::pod_read_unaligned::<[u16; 4]>(&wide), [65535, 0, 32768, 65535]);
    }
}
