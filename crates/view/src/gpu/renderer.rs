//! Renders shots of a scene.

mod culling;
mod labels;
mod readback;
mod static_cells;

use super::device::Gpu;
use super::lru_cache::LruCache;
use super::pass::{GpuMesh, MeshInstances, begin, begin_depth, texture, uniform, upload};
use super::pipelines::{DEPTH_FORMAT, LabelPipelines, MaterialPipelines, OCCLUSION_FORMAT, OcclusionPipelines, Pipelines};
use super::targets::{RenderTargets, bind_occlusion, noise_texture, photo_texture, tile_texture};
use super::uniforms::{DevelopUniforms, Globals, MAX_SHADOW_MAPS, ShadowMaps};
use crate::cells::{self, CellBounds, Frustum};
use crate::ground_photo::GroundColors;
use crate::quality::Quality;
use crate::scene::defects::{STAIN_CODES, defect_drawings};
use crate::scene::{DefectPatch, Instance, MoverModel, Scene};
use crate::shadows::{self, ShadowMap};
use crate::shot::Shot;
use crate::tiles;
use crate::visible_weather::LAYER_DISTANCES_M;
use culling::ShotView;
use spandrel_model::frames::{Enu, Vec3};
use static_cells::{StaticCell, fixed};

/// Cosine of a quarter of a degree. If the sun moves farther than that, the whole-site shadow map is redrawn.
const MIN_SUN_COSINE: f64 = 0.999_990_5;

/// Draw statistics of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DrawCounts {
    /// Number of triangles.
    pub triangles: u64,
    /// Number of draw calls.
    pub draw_calls: u32,
}

impl DrawCounts {
    /// Returns the sum of both statistics.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self { triangles: self.triangles + other.triangles, draw_calls: self.draw_calls + other.draw_calls }
    }
}

/// A scene on the GPU with its pipelines.
pub struct Renderer {
    quality: Quality,
    pipelines: Pipelines,
    /// If the preset has ambient occlusion.
    occlusion: Option<OcclusionPipelines>,
    /// Compiled on first use of labels.
    labels: Option<LabelPipelines>,
    fixed: Vec<StaticCell>,
    models: Vec<Option<GpuMesh>>,
    /// Distance from each model's origin to its farthest vertex, m.
    model_radii_m: Vec<f64>,
    water: Vec<(GpuMesh, CellBounds)>,
    patches: Vec<(u32, wgpu::Buffer, u32)>,
    bounds_m: (Vec3<Enu>, f64),
    water_m: f64,
    /// Half the side of the photograph on the ground, m; 0 without one.
    photo_half_m: f64,
    globals: wgpu::Buffer,
    globals_mirrored: wgpu::Buffer,
    bound: wgpu::BindGroup,
    bound_mirrored: wgpu::BindGroup,
    /// Bound where surfaces read no ambient occlusion.
    not_occluded: wgpu::BindGroup,
    maps: Vec<(wgpu::TextureView, wgpu::Buffer, wgpu::BindGroup)>,
    site_map_sun_direction: Option<Vec3<Enu>>,
    targets: LruCache<(u32, u32), RenderTargets>,
    counts: DrawCounts,
}

impl Renderer {
    /// Uploads a scene.
    #[must_use]
    pub fn new(gpu: &Gpu, quality: Quality, scene: &Scene) -> Self {
        let pipelines = Pipelines::new(gpu, &quality, scene.is_weathered);
        let maps_texture = shadow_map_texture(gpu, &quality);
        let all = maps_texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let noise = noise_texture(gpu);
        // Only lean presets read tiles; other presets bind the noise texture instead.
        let tile = |levels: fn() -> tiles::MipLevels| if quality.lean { tile_texture(gpu, &levels()) } else { noise.clone() };
        let (ground, concrete) = (tile(tiles::ground), tile(tiles::concrete));
        let photo = photo_texture(gpu, scene.ground_colors.as_ref());
        let bind = |data: &wgpu::Buffer| {
            let view = wgpu::BindingResource::TextureView;
            let sampler = wgpu::BindingResource::Sampler;
            let bound = [
                data.as_entire_binding(),
                view(&all),
                sampler(&pipelines.compare),
                view(&noise),
                sampler(&pipelines.tiled),
                view(&ground),
                view(&concrete),
                view(&photo),
            ];
            let entries: Vec<wgpu::BindGroupEntry> =
                bound.into_iter().enumerate().map(|(k, resource)| wgpu::BindGroupEntry { binding: k as u32, resource }).collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipelines.globals_layout,
                entries: &entries,
            })
        };
        let (globals, globals_mirrored) = (uniform(gpu, size_of::<Globals>()), uniform(gpu, size_of::<Globals>()));
        let (bound, bound_mirrored) = (bind(&globals), bind(&globals_mirrored));
        let layers = 0..maps_texture.depth_or_array_layers();
        Self {
            fixed: fixed(gpu, scene),
            models: scene.models.iter().map(|mesh| GpuMesh::new(gpu, mesh)).collect(),
            model_radii_m: scene.models.iter().map(cells::max_vertex_distance_m).collect(),
            water: cells::split_into_cells(&scene.water, false)
                .iter()
                .filter_map(|cell| Some((GpuMesh::new(gpu, cell)?, CellBounds::of(cell))))
                .collect(),
            patches: patches(gpu, &scene.patches),
            bounds_m: scene.bounds_m,
            water_m: scene.water_m(),
            photo_half_m: scene.ground_colors.as_ref().map_or(0.0, GroundColors::half_m),
            bound,
            bound_mirrored,
            not_occluded: bind_occlusion(gpu, &pipelines, &texture(gpu, (1, 1), OCCLUSION_FORMAT, 1)),
            maps: layers.map(|k| layer(gpu, &pipelines, &maps_texture, k)).collect(),
            globals,
            globals_mirrored,
            site_map_sun_direction: None,
            targets: LruCache::new(),
            counts: DrawCounts::default(),
            labels: None,
            occlusion: (quality.occlusion_directions > 0)
                .then(|| OcclusionPipelines::new(gpu, &pipelines.globals_layout, quality.occlusion_directions)),
            quality,
            pipelines,
        }
    }

    /// Returns the draw statistics of the last picture.
    #[must_use]
    pub fn counts(&self) -> DrawCounts {
        self.counts
    }

    /// Replaces the defects of the scene.
    pub fn set_patches(&mut self, gpu: &Gpu, all: &[DefectPatch]) {
        self.patches = patches(gpu, all);
    }

    /// Draws a shot into `target` (a [`wgpu::TextureFormat::Rgba8Unorm`] texture of the shot's size).
    pub fn draw(&mut self, gpu: &Gpu, shot: &Shot, target: &wgpu::TextureView) {
        self.counts = DrawCounts::default();
        let sun_maps = shadows::sun_maps(&self.quality, &shot.eye, self.bounds_m, shot.sky.sun);
        let lamp_map = shot
            .beam
            .filter(|_| self.quality.lamp_shadow && sun_maps.len() < self.maps.len())
            .map(|beam| shadows::lamp_map(&beam, self.quality.shadow_px));
        let maps = ShadowMaps { sun: &sun_maps, lamp: lamp_map.as_ref() };
        for (buffer, mirrored) in [(&self.globals, false), (&self.globals_mirrored, true)] {
            let globals = Globals::new(shot, (self.water_m, self.photo_half_m), &maps, mirrored);
            gpu.queue.write_buffer(buffer, 0, bytemuck::bytes_of(&globals));
        }
        let view = ShotView::of(shot, self.water_m);
        let casts = self.quality.cascades > 1 || lamp_map.is_some();
        let moving = if casts {
            self.moving(gpu, &shot.moving)
        } else {
            self.moving(gpu, &view.visible_objects(&shot.moving, &self.model_radii_m))
        };
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.draw_maps(gpu, &mut encoder, shot, (&sun_maps, lamp_map.as_ref()), &moving);
        let targets = self
            .targets
            .take(&shot.size_px)
            .unwrap_or_else(|| RenderTargets::new(gpu, (&self.pipelines, self.occlusion.as_ref()), &self.quality, shot.size_px));
        if self.quality.reflection > 0.0 && view.lake {
            let mirrored = self.draw_mirror(&mut encoder, &targets, &moving, &view);
            self.counts = self.counts.and(mirrored);
        }
        let still = self.visible_cells(&view.direct_view(), (false, view.eye_m));
        let mut shapes = DrawCounts::default();
        if let (Some(pipelines), Some(occlusion)) = (&self.occlusion, &targets.occlusion) {
            let draw_solids = |pass: &mut wgpu::RenderPass| self.draw_shapes(pass, (&moving, &still), &mut shapes);
            occlusion.draw(gpu, &mut encoder, pipelines, shot, draw_solids);
        }
        let lit = self.draw_scene(&mut encoder, &targets, (&moving, &still), &view);
        self.counts = self.counts.and(shapes).and(lit);
        let develop = DevelopUniforms::new(shot, &self.quality);
        gpu.queue.write_buffer(&targets.develop_data, 0, bytemuck::bytes_of(&develop));
        for (pipeline, (target, input)) in self.pipelines.adapt.iter().zip(&targets.adapt) {
            let mut pass = begin(&mut encoder, target, None, None);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, input, &[]);
            pass.draw(0..3, 0..1);
        }
        {
            let mut pass = begin(&mut encoder, target, None, None);
            let variant = usize::from(shot.finish.is_camera()) + usize::from(shot.finish.has_lost_blocks());
            pass.set_pipeline(&self.pipelines.develop[variant]);
            pass.set_bind_group(0, &targets.develop, &[]);
            pass.draw(0..3, 0..1);
        }
        self.targets.put(shot.size_px, targets);
        gpu.queue.submit([encoder.finish()]);
    }

    fn moving(&self, gpu: &Gpu, moving: &[(MoverModel, Instance)]) -> Vec<(MoverModel, MeshInstances)> {
        let of = |model: MoverModel| {
            let copies: Vec<Instance> = moving.iter().filter(|m| m.0 == model).map(|m| m.1).collect();
            MeshInstances::new(gpu, &copies).map(|copies| (model, copies))
        };
        MoverModel::all(self.models.len()).filter_map(of).collect()
    }

    fn draw_maps(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        shot: &Shot,
        (sun, lamp): (&[ShadowMap], Option<&ShadowMap>),
        moving: &[(MoverModel, MeshInstances)],
    ) {
        // A single whole-site map contains only static objects and is reused until the sun moves.
        let whole = self.quality.cascades <= 1;
        let kept = whole && self.site_map_sun_direction.is_some_and(|was| was.dot(shot.sky.sun) > MIN_SUN_COSINE);
        for (k, map) in sun.iter().chain(lamp).enumerate() {
            let of_sun = k < sun.len();
            if of_sun && (kept || shot.sky.direct_lux <= 0.0) {
                continue;
            }
            let Some((view, data, group)) = self.maps.get(k) else { continue };
            gpu.queue.write_buffer(data, 0, bytemuck::bytes_of(&map.projection.columns()));
            let mut pass = begin_depth(encoder, view);
            pass.set_pipeline(&self.pipelines.shadow);
            pass.set_bind_group(0, group, &[]);
            let lit = Frustum::of(&map.projection);
            // A map that is kept does not depend on the viewpoint.
            let is_shown = |fixed: &&StaticCell| {
                whole || fixed.visible_range.shows(false, fixed.bounds.sphere.distance_to_m(shot.eye.position_m))
            };
            let casts = |fixed: &&StaticCell| fixed.casts_shadows && lit.cell_may_be_visible(&fixed.bounds);
            for fixed in self.fixed.iter().filter(casts).filter(is_shown) {
                count(&mut self.counts, fixed.solid.triangles(), &fixed.copies);
                fixed.solid.draw(&mut pass, &fixed.copies);
            }
            if !(of_sun && whole) {
                for (solid, copies) in solids(&self.models, moving) {
                    count(&mut self.counts, solid.triangles(), copies);
                    solid.draw(&mut pass, copies);
                }
            }
        }
        if whole && shot.sky.direct_lux > 0.0 {
            self.site_map_sun_direction = if kept { self.site_map_sun_direction } else { Some(shot.sky.sun) };
        }
    }

    fn draw_mirror(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &RenderTargets,
        moving: &[(MoverModel, MeshInstances)],
        view: &ShotView,
    ) -> DrawCounts {
        let mut counts = DrawCounts::default();
        let mut pass = begin(encoder, &targets.mirror, None, Some(&targets.mirror_depth));
        pass.set_bind_group(0, &self.bound_mirrored, &[]);
        pass.set_bind_group(1, &self.not_occluded, &[]);
        self.draw_solids(
            &mut pass,
            &self.pipelines.surfaces_mirrored[view.lamp],
            (moving, &self.visible_cells(&view.mirrored(), (true, view.eye_m))),
            &mut counts,
        );
        pass.set_pipeline(&self.pipelines.sky_mirrored);
        pass.draw(0..3, 0..1);
        counts.draw_calls += 1;
        counts
    }

    /// Draws all solids, one material group at a time.
    fn draw_solids(
        &self,
        pass: &mut wgpu::RenderPass,
        pipelines: &MaterialPipelines,
        (moving, still): (&[(MoverModel, MeshInstances)], &[&StaticCell]),
        counts: &mut DrawCounts,
    ) {
        for (look, pipeline) in pipelines {
            pass.set_pipeline(pipeline);
            let still = still.iter().map(|fixed| (&*fixed.solid, &fixed.copies));
            for (solid, copies) in solids(&self.models, moving).chain(still) {
                if let Some(triangles) = solid.draw_group(pass, copies, *look) {
                    count(counts, triangles, copies);
                }
            }
        }
    }

    /// Draws the shapes of all solids that are in the picture.
    fn draw_shapes(
        &self,
        pass: &mut wgpu::RenderPass,
        (moving, still): (&[(MoverModel, MeshInstances)], &[&StaticCell]),
        counts: &mut DrawCounts,
    ) {
        pass.set_bind_group(0, &self.bound, &[]);
        let still = still.iter().map(|fixed| (&*fixed.solid, &fixed.copies));
        for (solid, copies) in solids(&self.models, moving).chain(still) {
            count(counts, solid.triangles(), copies);
            solid.draw(pass, copies);
        }
    }

    /// Returns the static cells that may be visible, front to back, so that hidden surfaces are not shaded.
    fn visible_cells(&self, shown: &Frustum, (in_lake, eye_m): (bool, Vec3<Enu>)) -> Vec<&StaticCell> {
        let distance_m = |fixed: &StaticCell| fixed.bounds.sphere.distance_to_m(eye_m);
        let shows = |fixed: &&StaticCell| {
            shown.cell_may_be_visible(&fixed.bounds) && fixed.visible_range.shows(in_lake, distance_m(fixed))
        };
        let mut visible: Vec<&StaticCell> = self.fixed.iter().filter(shows).collect();
        visible.sort_by(|a, b| distance_m(a).total_cmp(&distance_m(b)));
        visible
    }

    /// Draws the defects, each with the pipeline for its kind.
    fn draw_patches(&self, pass: &mut wgpu::RenderPass, pipelines: &[(u32, wgpu::RenderPipeline)]) -> DrawCounts {
        let mut counts = DrawCounts::default();
        for (kind, buffer, patches) in &self.patches {
            let Some((_, pipeline)) = pipelines.iter().find(|of| of.0 == *kind) else { continue };
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..6, 0..*patches);
            counts.draw_calls += 1;
            counts.triangles += 2 * u64::from(*patches);
        }
        counts
    }

    fn draw_scene(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &RenderTargets,
        (moving, still): (&[(MoverModel, MeshInstances)], &[&StaticCell]),
        view: &ShotView,
    ) -> DrawCounts {
        let shown = view.direct_view();
        let mut counts = DrawCounts::default();
        let occluded = targets.occluded.as_ref().unwrap_or(&self.not_occluded);
        let mut pass = begin(encoder, &targets.light, targets.resolved.as_ref(), Some(&targets.depth));
        pass.set_bind_group(0, &self.bound, &[]);
        pass.set_bind_group(1, occluded, &[]);
        self.draw_solids(&mut pass, &self.pipelines.surfaces[view.lamp], (moving, still), &mut counts);
        let patches = self.draw_patches(&mut pass, &self.pipelines.defects);
        counts = counts.and(patches);
        pass.set_pipeline(&self.pipelines.water[view.breaking][view.lamp]);
        pass.set_bind_group(1, &targets.water, &[]);
        for (water, _) in self.water.iter().filter(|(_, bounds)| view.lake && shown.cell_may_be_visible(bounds)) {
            water.draw_without_instances(&mut pass);
            counts.draw_calls += 1;
            counts.triangles += u64::from(water.triangles());
        }
        // The lake has written its depth, so no sky is shaded behind it.
        pass.set_pipeline(&self.pipelines.sky);
        pass.draw(0..3, 0..1);
        counts.draw_calls += 1;
        pass.set_pipeline(&self.pipelines.translucent);
        pass.set_bind_group(1, &self.not_occluded, &[]);
        for (model, copies) in moving.iter().filter(|(model, _)| model.is_translucent()) {
            let Some(Some(solid)) = self.models.get(model.index()) else { continue };
            count(&mut counts, solid.triangles(), copies);
            solid.draw(&mut pass, copies);
        }
        if view.falling {
            pass.set_pipeline(&self.pipelines.precipitation);
            pass.draw(0..3, 0..LAYER_DISTANCES_M.len() as u32);
            counts.draw_calls += 1;
        }
        counts
    }
}

/// Uploads defects grouped by drawing, stains first.
fn patches(gpu: &Gpu, all: &[DefectPatch]) -> Vec<(u32, wgpu::Buffer, u32)> {
    let of = |kind: &u32| {
        let same: Vec<DefectPatch> = all.iter().filter(|patch| patch.center[3] as u32 == *kind).copied().collect();
        let buffer = (!same.is_empty()).then(|| upload(gpu, bytemuck::cast_slice(&same), wgpu::BufferUsages::VERTEX))?;
        Some((*kind, buffer, same.len() as u32))
    };
    let drawings: Vec<u32> = STAIN_CODES.into_iter().chain(defect_drawings()).collect();
    drawings.iter().filter_map(of).collect()
}

/// Returns the opaque moving objects.
fn solids<'a>(
    models: &'a [Option<GpuMesh>],
    moving: &'a [(MoverModel, MeshInstances)],
) -> impl Iterator<Item = (&'a GpuMesh, &'a MeshInstances)> {
    let of = |(model, copies): &'a (MoverModel, MeshInstances)| Some((models.get(model.index())?.as_ref()?, copies));
    moving.iter().filter(|(model, _)| !model.is_translucent()).filter_map(of)
}

/// Creates the shadow map array, with at least two layers because some drivers do not treat a single layer as an array.
fn shadow_map_texture(gpu: &Gpu, quality: &Quality) -> wgpu::Texture {
    let layers = (quality.cascades + u32::from(quality.lamp_shadow)).clamp(2, MAX_SHADOW_MAPS as u32);
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadows"),
        size: wgpu::Extent3d { width: quality.shadow_px, height: quality.shadow_px, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// Returns the view, projection buffer, and bind group of a shadow map layer.
fn layer(gpu: &Gpu, pipelines: &Pipelines, maps: &wgpu::Texture, k: u32) -> (wgpu::TextureView, wgpu::Buffer, wgpu::BindGroup) {
    let view = maps.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_array_layer: k,
        array_layer_count: Some(1),
        ..Default::default()
    });
    let data = uniform(gpu, 64);
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipelines.map_layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: data.as_entire_binding() }],
    });
    (view, data, group)
}

fn count(counts: &mut DrawCounts, triangles: u32, copies: &MeshInstances) {
    counts.draw_calls += 1;
    counts.triangles += u64::from(triangles) * u64::from(copies.count());
}
