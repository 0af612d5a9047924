//! The picture: every pixel by many lines of sight, tile by tile on all cores.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use glam::{DVec2, DVec3};

use super::lens::Sight;
use super::light::{Arriving, arriving};
use super::lines::{self, Grid, Place};
use super::occlusion::occluded;
use super::sampling::{seed, spread, square_point};
use super::world::{Hit, Surface, World};
use super::{Lens, Material, Occlusion, Optics, Shade, toon};
use crate::effects::focus::Circles;
use crate::effects::outline::OutlineParams;
use crate::scene::Lighting;
use crate::shading::environment::Studio;

/// Side of a tile in pixels.
const TILE_PX: u32 = 32;
/// What is seen through less than this share of light does not change a picture of 16 bits.
const LEAST_LIGHT: f64 = 1.0 / 131_072.0;
/// Rays that a pixel's light, occlusion and environment take in all, at the least.
const SHADOW_RAYS: u32 = 256;
const OCCLUSION_RAYS: u32 = 512;
const ENVIRONMENT_DIRECTIONS: u32 = 1024;
/// Least places of a grid to each side of a pixel.
const LEAST_CELLS: u32 = 3;
/// Samples from which on a draft takes no fewer of them.
const WHOLE_SAMPLES: u32 = 64;

/// What `sampling::seed` is asked for.
const FOR_PLACE: u32 = 0;
const FOR_LENS: u32 = 1;
const FOR_LINES: u32 = 2;
const FOR_ENVIRONMENT: u32 = 3;
const FOR_LIGHTS: u32 = 8;
const FOR_OCCLUSIONS: u32 = 256;

/// What a picture shows, and how.
pub struct Picture<'a> {
    /// What there is.
    pub world: &'a World,
    /// Its materials.
    pub materials: &'a [Material],
    /// Who looks.
    pub optics: Optics,
    /// What shines, in view space.
    pub lighting: &'a Lighting,
    /// Darkening where things are near, one upon the other.
    pub occlusions: &'a [Occlusion],
    /// What is out of focus.
    pub lens: Option<Lens>,
    /// Layers of focus, in whose colours all is drawn instead.
    pub layers: Option<Circles>,
    /// Lines over the picture, the lower ones first.
    pub lines: &'a [OutlineParams],
    /// Premultiplied linear background.
    pub background: [f32; 4],
}

/// How finely, and by how many.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel; a square number is used, the next one up.
    pub samples: u32,
    /// Fewer rays where there are fewer samples: quick, and grainy in soft light.
    pub draft: bool,
    /// Threads; the picture does not depend on them.
    pub threads: usize,
}

/// Whoever follows the progress asked to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BrokenOff;

/// Takes rows of premultiplied linear light, from the top.
pub type RowSink<'a, E> = dyn FnMut(&[[f32; 4]]) -> Result<(), E> + 'a;

/// Draws a picture and gives `sink` its rows from the top, some at a time: premultiplied linear light. `progress` hears the
/// rows that are done.
///
/// # Errors
/// [`BrokenOff`] where `progress` breaks off; `sink`'s own errors are its affair.
pub fn render<E: From<BrokenOff>>(
    picture: &Picture<'_>,
    settings: &Settings,
    progress: &mut dyn FnMut(u32) -> ControlFlow<()>,
    sink: &mut RowSink<'_, E>,
) -> Result<(), E> {
    let [width, height] = settings.size;
    let studio = Studio::neutral();
    let side = (settings.samples.max(1) as f64).sqrt().ceil() as u32;
    let columns = width.div_ceil(TILE_PX);
    for top in (0..height).step_by(TILE_PX as usize) {
        let rows = TILE_PX.min(height - top);
        let band = Mutex::new(vec![[0.0f32; 4]; width as usize * rows as usize]);
        let (next, stopped) = (AtomicU32::new(0), AtomicBool::new(false));
        let work = |goes_on: &mut dyn FnMut() -> bool| {
            loop {
                let column = next.fetch_add(1, Ordering::Relaxed);
                if column >= columns || stopped.load(Ordering::Relaxed) {
                    break;
                }
                if !goes_on() {
                    stopped.store(true, Ordering::Relaxed);
                    break;
                }
                let left = column * TILE_PX;
                let tile_width = TILE_PX.min(width - left);
                let tile = Tile { origin: [left, top], size: [tile_width, rows] };
                let tile = picture.tile(&tile, side, settings.draft, &studio);
                let Ok(mut band) = band.lock() else { break };
                for (row, values) in tile.chunks_exact(tile_width as usize).enumerate() {
                    let start = row * width as usize + left as usize;
                    band[start..start + values.len()].copy_from_slice(values);
                }
            }
        };
        std::thread::scope(|scope| {
            for _ in 1..settings.threads.max(1) {
                scope.spawn(|| work(&mut || true));
            }
            // This thread hears between its tiles whether to stop.
            work(&mut || progress(top).is_continue());
        });
        if stopped.into_inner() || progress(top + rows).is_break() {
            return Err(BrokenOff.into());
        }
        sink(&band.into_inner().unwrap_or_default())?;
    }
    Ok(())
}

/// A rectangle of the picture.
struct Tile {
    origin: [u32; 2],
    size: [u32; 2],
}

impl Tile {
    fn pixels(&self) -> impl Iterator<Item = [u32; 2]> {
        let ([left, top], [width, height]) = (self.origin, self.size);
        (0..height).flat_map(move |y| (0..width).map(move |x| [left + x, top + y]))
    }
}

impl Picture<'_> {
    /// The pixels of a tile over the background: premultiplied linear light.
    fn tile(&self, tile: &Tile, side: u32, draft: bool, studio: &Studio) -> Vec<[f32; 4]> {
        if self.lines.is_empty() {
            tile.pixels().map(|pixel| self.pixel(pixel, side, draft, studio)).collect()
        } else {
            self.lined_tile(tile, side, draft, studio)
        }
    }

    /// The same with lines: samples lie on a grid, in which the lines are found. Through a lens each sample has its place of
    /// the lens, the same for all pixels, and a grid there.
    fn lined_tile(&self, tile: &Tile, side: u32, draft: bool, studio: &Studio) -> Vec<[f32; 4]> {
        // At least three places to each side of a pixel: lines are found between them.
        let cells = if self.lens.is_some() { LEAST_CELLS } else { side.max(LEAST_CELLS) };
        let count = if self.lens.is_some() { side * side } else { cells * cells };
        let shared_by = if draft { count.max(WHOLE_SAMPLES) } else { count };
        let mut sums = vec![(DVec3::ZERO, 0.0); (tile.size[0] * tile.size[1]) as usize];
        let indices: Vec<u32> = (0..count).collect();
        match &self.lens {
            Some(lens) => {
                for index in indices {
                    let point = spread(index, seed([0, 0], 0, FOR_LENS));
                    self.add_lined(tile, cells, &[index], Some((lens, point)), shared_by, studio, &mut sums);
                }
            }
            None => self.add_lined(tile, cells, &indices, None, shared_by, studio, &mut sums),
        }
        sums.into_iter().map(|(light, alpha)| self.over(light, alpha, count)).collect()
    }

    /// Adds samples with lines to the pixels of a tile; they lie in the cells of a grid by their numbers.
    #[allow(clippy::too_many_arguments)]
    fn add_lined(
        &self,
        tile: &Tile,
        side: u32,
        indices: &[u32],
        lens: Option<(&Lens, DVec2)>,
        shared_by: u32,
        studio: &Studio,
        sums: &mut [(DVec3, f64)],
    ) {
        let reach = self.lines.iter().map(|lines| lines::reach_px(lines, self.optics.pixel(self.optics.near)));
        // A pixel beyond lines, since folds are looked for within one.
        let margin = reach.fold(0.0, f64::max).ceil() as usize + 1;
        let (cells, edge) = (side as usize, margin * side as usize);
        let [inner_width, inner_height] = tile.size.map(|length| length as usize * cells);
        // A grid for each sample has its own.
        let dither = indices.first().filter(|_| lens.is_some());
        let dither = dither.map_or(0.0, |index| spread(*index, seed([0, 0], 0, FOR_LINES)).x - 0.5);
        let mut grid = Grid {
            optics: &self.optics,
            lens,
            origin_px: DVec2::new(f64::from(tile.origin[0]), f64::from(tile.origin[1])) - margin as f64,
            side,
            dither,
            size: [inner_width + 2 * edge, inner_height + 2 * edge],
            places: Vec::new(),
        };
        let [width, height] = grid.size;
        grid.places = (0..width * height).map(|index| self.seen(&grid.sight([index % width, index / width]))).collect();
        let covered: Vec<Vec<[f64; 3]>> = self.lines.iter().map(|lines| grid.covered(lines)).collect();
        for ([x, y], (light, alpha)) in tile.pixels().zip(sums) {
            let corner = [(x - tile.origin[0]) as usize * cells + edge, (y - tile.origin[1]) as usize * cells + edge];
            for &index in indices {
                let cell = [index % side, index / side % side];
                let at = [corner[0] + cell[0] as usize, corner[1] + cell[1] as usize];
                let place = DVec2::new(f64::from(x), f64::from(y))
                    + (DVec2::new(f64::from(cell[0]), f64::from(cell[1])) + 0.5) / f64::from(side);
                let sight = Sight::new(&self.optics, place, lens);
                let of = Sample { pixel: [x, y], index, shared_by, footprint_px: 1.0 / f64::from(side) };
                let (mut color, mut share) = self.sample(of, &sight, studio);
                for (lines, covered) in self.lines.iter().zip(&covered) {
                    let colors = [lines.crease_color, lines.boundary_color, lines.silhouette_color];
                    for ([r, g, b, opacity], covered) in colors.into_iter().zip(covered[at[1] * width + at[0]]) {
                        let line = covered * f64::from(opacity);
                        color = color.lerp(DVec3::new(f64::from(r), f64::from(g), f64::from(b)), line);
                        share += line * (1.0 - share);
                    }
                }
                *light += color;
                *alpha += share;
            }
        }
    }

    /// What a line of sight sees first, for lines; a hull outline is one already.
    fn seen(&self, sight: &Sight) -> Option<Place> {
        let near = self.optics.near;
        for piece in sight.pieces() {
            let mut last = Hit::just_before(piece.from);
            let hit = loop {
                let hit = self.world.next(piece.ray, near, Some(last)).filter(|hit| hit.t < piece.until);
                let Some(hit) = hit else { break None };
                let surface = self.world.surface(piece.ray, hit);
                if self.materials[surface.material as usize].opacity > 0.0 {
                    break Some((hit, surface));
                }
                last = hit;
            };
            let end = hit.map_or(piece.until, |(hit, _)| hit.t);
            if let Some(outline) = self.world.first_outline(piece.ray, near, piece.from, end, &[]) {
                let depth = outline.depth;
                return Some(Place { depth, normal: DVec3::Z, facet: DVec3::Z, bend: 0.0, group: 0, id: 0 });
            }
            if let Some((hit, surface)) = hit {
                return Some(Place {
                    depth: hit.t,
                    normal: surface.normal,
                    facet: surface.facet,
                    bend: surface.bend,
                    group: surface.group,
                    id: surface.id,
                });
            }
        }
        None
    }

    /// The mean of a pixel's samples over the background: premultiplied linear light.
    fn pixel(&self, pixel: [u32; 2], side: u32, draft: bool, studio: &Studio) -> [f32; 4] {
        let count = side * side;
        let shared_by = if draft { count.max(WHOLE_SAMPLES) } else { count };
        let (mut light, mut alpha) = (DVec3::ZERO, 0.0);
        for index in 0..count {
            // Once in each cell of a grid.
            let within = if count == 1 { DVec2::splat(0.5) } else { square_point(seed(pixel, index, FOR_PLACE)) };
            let cell = DVec2::new(f64::from(index % side), f64::from(index / side));
            let corner = DVec2::new(f64::from(pixel[0]), f64::from(pixel[1]));
            let place = corner + (cell + within) / f64::from(side);
            // Spread over the pixel's samples, whichever cell each has.
            let lens = self.lens.as_ref().map(|lens| (lens, spread(index, seed(pixel, 0, FOR_LENS))));
            let sight = Sight::new(&self.optics, place, lens);
            let of = Sample { pixel, index, shared_by, footprint_px: 1.0 / f64::from(side) };
            let (color, covered) = self.sample(of, &sight, studio);
            light += color;
            alpha += covered;
        }
        self.over(light, alpha, count)
    }

    /// The mean of samples over the background.
    fn over(&self, light: DVec3, alpha: f64, count: u32) -> [f32; 4] {
        let [r, g, b, a] = self.background.map(f64::from);
        let share = 1.0 / f64::from(count);
        let (light, alpha) = (light * share, alpha * share);
        let open = 1.0 - alpha;
        let over = light + open * DVec3::new(r, g, b);
        [over.x as f32, over.y as f32, over.z as f32, (alpha + open * a) as f32]
    }

    /// Light along one line of sight, and the share of what is behind it that it covers.
    fn sample(&self, of: Sample, sight: &Sight, studio: &Studio) -> (DVec3, f64) {
        let Sample { pixel, index, shared_by, footprint_px } = of;
        let near = self.optics.near;
        let (mut light, mut open) = (DVec3::ZERO, 1.0);
        let mut crossed: Vec<u64> = Vec::new();
        let mut pieces = sight.pieces();
        let Some(mut piece) = pieces.next() else { return (light, 0.0) };
        let mut last = Hit::just_before(piece.from);
        let mut outlines_after = piece.from;
        while open > LEAST_LIGHT {
            let ray = piece.ray;
            let hit = self.world.next(ray, near, Some(last)).filter(|hit| hit.t < piece.until);
            let end = hit.map_or(piece.until, |hit| hit.t);
            if let Some(outline) = self.world.first_outline(ray, near, outlines_after, end, &crossed) {
                let material = &self.materials[outline.material as usize];
                if let Some(hull) = material.hull {
                    light += open * material.opacity * hull.color;
                    open *= 1.0 - material.opacity;
                }
                outlines_after = outline.depth;
                crossed.push(outline.owner);
                continue;
            }
            let Some(hit) = hit else {
                let Some(next) = pieces.next() else { break };
                piece = next;
                (last, outlines_after) = (Hit::just_before(piece.from), piece.from);
                continue;
            };
            let surface = self.world.surface(ray, hit);
            let material = &self.materials[surface.material as usize];
            let bend = material
                .stylist
                .as_ref()
                .map(|stylist| (stylist, stylist.bend(self.world, &self.optics, ray, hit, &surface, footprint_px)));
            let opacity = bend.as_ref().map_or(material.opacity, |(stylist, bend)| stylist.opacity(*bend));
            if opacity > 0.0 {
                let seen = Seen { pixel, index, shared_by, surface: &surface, hit };
                let mut color = self.shaded(&seen, -ray.direction.normalize(), studio);
                if let Some((stylist, bend)) = bend {
                    color = stylist.weighed(color, bend);
                }
                if let Some(circles) = &self.layers {
                    color = circles.layer_color(hit.t, color);
                }
                light += open * opacity * color;
                open *= 1.0 - opacity;
            }
            crossed.push(surface.id);
            last = hit;
        }
        (light, 1.0 - open)
    }

    fn shaded(&self, seen: &Seen<'_>, to_viewer: DVec3, studio: &Studio) -> DVec3 {
        let surface = seen.surface;
        let material = &self.materials[surface.material as usize];
        let base_color = material.base_color.unwrap_or(surface.color);
        let lights = || -> Vec<Arriving> {
            let num_rays = SHADOW_RAYS.div_ceil(seen.shared_by);
            let lights = (0..).zip(&self.lighting.lights);
            lights
                .map(|(number, light)| {
                    let seed = seed(seen.pixel, seen.index, FOR_LIGHTS + number);
                    arriving(self.world, light, surface, seen.hit.object, num_rays, seed)
                })
                .collect()
        };
        let color = match &material.shade {
            Shade::Unlit => base_color,
            Shade::Toon(toon) => toon::shade(toon, base_color, surface.normal, to_viewer, &lights()),
            Shade::Basic(basic) => {
                let num_directions = ENVIRONMENT_DIRECTIONS.div_ceil(seen.shared_by);
                let seed = seed(seen.pixel, seen.index, FOR_ENVIRONMENT);
                let ambient = self.lighting.ambient.as_dvec3();
                let radiance = basic.0.radiance(
                    base_color,
                    surface.normal,
                    to_viewer,
                    &lights(),
                    studio,
                    ambient,
                    num_directions,
                    seed,
                );
                basic.0.tone_mapped(radiance)
            }
        };
        // Occlusion is of what is opaque: layers are blended over it.
        let occlusions = if material.opacity < 1.0 { &[] } else { self.occlusions };
        let occlusions = (0..).zip(occlusions).filter(|(_, occlusion)| occlusion.picks(surface));
        occlusions.fold(color, |color, (number, occlusion)| {
            let num_rays = OCCLUSION_RAYS.div_ceil(seen.shared_by);
            let seed = seed(seen.pixel, seen.index, FOR_OCCLUSIONS + number);
            let occluded = occluded(self.world, surface, seen.hit.object, occlusion.radius, num_rays, seed);
            color * (1.0 - occlusion.intensity * occluded).max(0.0)
        })
    }
}

/// One sample of a pixel.
#[derive(Debug, Clone, Copy)]
struct Sample {
    pixel: [u32; 2],
    index: u32,
    /// How many samples share a pixel's rays.
    shared_by: u32,
    /// Side of the square that it stands for.
    footprint_px: f64,
}

/// A surface as one sample sees it.
struct Seen<'a> {
    pixel: [u32; 2],
    index: u32,
    /// How many samples share a pixel's rays.
    shared_by: u32,
    surface: &'a Surface,
    hit: Hit,
}
