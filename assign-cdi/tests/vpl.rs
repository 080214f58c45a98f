//! VPLs of maps that are filled by hand: light is conserved, order is fixed, what drops out is counted.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use std::f32::consts::PI;

use assign::{EncoderPasses, Gpu, Light, LightShape, Projection, View};
use assign_cdi::{Large, Rsm, VplBuffer, VplCounts, VplSettings};
use bytemuck::{cast_slice, pod_collect_to_vec};
use glam::{DVec3, Vec2, Vec3, Vec4};

/// A map on the CPU: what a ray from the light through each texel meets.
struct Map {
    gpu: Gpu,
    view: View,
    light: Light,
    depth: wgpu::TextureView,
    normals: wgpu::TextureView,
    base_color: wgpu::TextureView,
}

/// A surface seen through a texel: its view depth, normal, base colour and metallic.
type Hit = (f32, Vec3, Vec4);

fn spot(outer_angle: f32) -> Light {
    Light {
        shape: LightShape::Spot { direction: Vec3::NEG_Y, inner_angle: 0.0, outer_angle },
        ..Light::point(Vec3::new(0.5, 3.0, -0.25), 1e4, Vec3::new(8.0, 4.0, 2.0))
    }
}

impl Map {
    /// Of a light that looks down; `meet` gets each texel's direction in the world, whose step along
    /// the view's axis is 1.
    fn new(size: [u32; 2], light: Light, meet: impl Fn(Vec3) -> Option<Hit>) -> Self {
        let LightShape::Spot { outer_angle, .. } = light.shape else { panic!("not a spot") };
        let gpu = Gpu::open(None).unwrap();
        let target = light.position - Vec3::Y;
        let mut view = View::look_at(light.position, target, 1.0, 0.01, size);
        let reach = Vec2::splat(outer_angle.tan() * 1.001);
        view.projection = Projection::Perspective { min: -reach, max: reach };
        // An offset in larger textures.
        (view.viewport.x, view.viewport.y) = (3, 1);
        let full = [size[0] + 5, size[1] + 2];
        let mut depths = vec![0.0_f32; (full[0] * full[1]) as usize];
        let mut normals = vec![[0.0_f32; 4]; depths.len()];
        let mut colors = vec![[0.0_f32; 4]; depths.len()];
        for y in 0..size[1] {
            for x in 0..size[0] {
                let share = (Vec2::new(x as f32, y as f32) + 0.5)
                    / Vec2::new(size[0] as f32, size[1] as f32);
                let ndc = Vec2::new(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y);
                let ray = (ndc * reach).extend(-1.0);
                let ray_world = view.world_to_view.inverse().transform_vector3(ray);
                if let Some((depth, normal, color)) = meet(ray_world) {
                    let at = ((y + 1) * full[0] + x + 3) as usize;
                    let clip = view.view_to_clip() * (ray * depth).extend(1.0);
                    depths[at] = clip.z / clip.w;
                    normals[at] = normal.extend(0.5).to_array();
                    colors[at] = color.to_array();
                }
            }
        }
        Self {
            depth: depth_texture(&gpu, full, &depths),
            normals: float_texture(&gpu, full, &normals),
            base_color: float_texture(&gpu, full, &colors),
            gpu,
            view,
            light,
        }
    }

    fn rsm(&self) -> Rsm<'_> {
        Rsm {
            depth: &self.depth,
            normals: &self.normals,
            base_color: &self.base_color,
            view: &self.view,
            light: &self.light,
        }
    }

    /// Chooses, gives every VPL the range that `range_m` makes of its index, and keeps.
    fn run(&self, buffer: &mut VplBuffer, range_m: impl Fn(u32) -> f32) {
        let gpu = &self.gpu;
        buffer.prepare(gpu, &self.rsm()).unwrap();
        let ranges: Vec<f32> = (0..buffer.capacity()).map(range_m).collect();
        gpu.queue.write_buffer(buffer.ranges_m(), 0, cast_slice(&ranges));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        buffer.record_choose(&mut passes);
        buffer.record_keep(&mut passes);
        gpu.queue.submit([encoder.finish()]);
    }

    /// Lights of all VPLs, with a range of a metre each.
    fn lights(&self, settings: VplSettings) -> Vec<Light> {
        let mut buffer = VplBuffer::new(&self.gpu, settings).unwrap();
        self.run(&mut buffer, |_| 0.5);
        buffer.read(&self.gpu).unwrap()
    }
}

/// Writes texels by a copy from a buffer whose rows are padded.
fn upload(gpu: &Gpu, texture: &wgpu::Texture, [width, height]: [u32; 2], texels: &[u8]) {
    gpu.queue.write_texture(
        texture.as_image_copy(),
        texels,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(texels.len() as u32 / height),
            rows_per_image: None,
        },
        wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
    );
}

fn texture(gpu: &Gpu, [width, height]: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
    let written = if format.is_depth_stencil_format() {
        wgpu::TextureUsages::RENDER_ATTACHMENT
    } else {
        wgpu::TextureUsages::COPY_DST
    };
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | written,
        view_formats: &[],
    })
}

fn float_texture(gpu: &Gpu, size: [u32; 2], texels: &[[f32; 4]]) -> wgpu::TextureView {
    let texture = texture(gpu, size, wgpu::TextureFormat::Rgba32Float);
    upload(gpu, &texture, size, cast_slice(texels));
    texture.create_view(&Default::default())
}

/// Depths can only be drawn: a triangle over the image that reads them from another texture.
fn depth_texture(gpu: &Gpu, size: [u32; 2], depths: &[f32]) -> wgpu::TextureView {
    const DRAW: &str = "
@group(0) @binding(0) var depths: texture_2d<f32>;
@vertex fn vertex(@builtin(vertex_index) ix: u32) -> @builtin(position) vec4f {
  return vec4f(f32(ix & 1u) * 4.0 - 1.0, f32(ix >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
@fragment fn fragment(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 {
  return textureLoad(depths, vec2u(at.xy), 0).r;
}";
    let source = texture(gpu, size, wgpu::TextureFormat::R32Float);
    upload(gpu, &source, size, cast_slice(depths));
    let depth = texture(gpu, size, wgpu::TextureFormat::Depth32Float);
    let target = depth.create_view(&Default::default());
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(DRAW.into()),
    });
    let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(&source.create_view(&Default::default())),
        }],
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &target,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    target
}

const WHITE: Vec4 = Vec4::new(1.0, 1.0, 1.0, 0.0);
const HALF_WALL_M: f32 = 2.0;

/// A room of walls at +-2 m around the light, its floor at y = 0, coloured by the wall; no ceiling.
fn room(light: &Light) -> impl Fn(Vec3) -> Option<Hit> + use<> {
    let eye = light.position;
    move |ray: Vec3| {
        let to = |axis: usize, at: f32| {
            let t = (at - eye[axis]) / ray[axis];
            (t > 1e-6 && t.is_finite()).then_some(t)
        };
        let walls = [
            (to(1, 0.0), Vec3::Y, Vec4::new(0.8, 0.7, 0.6, 0.0)),
            (to(0, -HALF_WALL_M), Vec3::X, Vec4::new(0.9, 0.1, 0.1, 0.0)),
            // Half a metal; its normal points out of the room.
            (to(0, HALF_WALL_M), Vec3::X, Vec4::new(0.1, 0.9, 0.1, 0.5)),
            (to(2, -HALF_WALL_M), Vec3::Z, Vec4::new(0.5, 0.5, 0.9, 0.0)),
            (to(2, HALF_WALL_M), Vec3::NEG_Z, Vec4::ZERO),
        ];
        walls
            .into_iter()
            .filter_map(|(t, normal, color)| Some((t?, normal, color)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

fn total(lights: &[Light]) -> DVec3 {
    lights.iter().map(|light| light.intensity.as_dvec3()).sum()
}

/// The room's surfaces: which coordinate has which value, and the diffuse albedo.
const SURFACES: [(usize, f32, Vec3); 5] = [
    (1, 0.0, Vec3::new(0.8, 0.7, 0.6)),
    (0, -HALF_WALL_M, Vec3::new(0.9, 0.1, 0.1)),
    (0, HALF_WALL_M, Vec3::new(0.05, 0.45, 0.05)),
    (2, -HALF_WALL_M, Vec3::new(0.5, 0.5, 0.9)),
    (2, HALF_WALL_M, Vec3::ZERO),
];

/// Off the room's surfaces, metres.
fn off_surface(p: Vec3) -> f32 {
    let off = |(axis, at, _): (usize, f32, Vec3)| (p[axis] - at).abs();
    SURFACES.map(off).into_iter().fold(f32::INFINITY, f32::min)
}

/// Of the surface nearest to a point.
fn albedo(p: Vec3) -> Vec3 {
    let off = |(axis, at, _): &(usize, f32, Vec3)| (p[*axis] - at).abs();
    SURFACES.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap().2
}

/// Area of a texel on the plane of view depth 1, square metres.
fn texel_area(map: &Map, size: [u32; 2]) -> f32 {
    let Projection::Perspective { min, max } = map.view.projection else { panic!("perspective") };
    (max - min).element_product() / (size[0] * size[1]) as f32
}

/// Intensity that a texel of the room reflects whose surface is at `position`.
fn reflected(map: &Map, size: [u32; 2], position: Vec3) -> Vec3 {
    let LightShape::Spot { outer_angle, .. } = map.light.shape else { panic!("a spot") };
    let to = position - map.light.position;
    let cos = -to.y / to.length();
    let ramp = (cos - outer_angle.cos()) / (1.0 - outer_angle.cos());
    let solid_angle = texel_area(map, size) * cos.powi(3);
    map.light.intensity * albedo(position) * (ramp * ramp * solid_angle / PI)
}

#[test]
fn the_brightest_texel_stands_for_its_block() {
    let light = spot(0.9);
    let size = [13, 9];
    for lucky in (0..size[0] * size[1]).step_by(11) {
        let texel = std::cell::Cell::new(0);
        let map = Map::new(size, light, |ray| {
            let bright = texel.replace(texel.get() + 1) == lucky;
            let color = Vec3::splat(if bright { 1.0 } else { 1e-6 }).extend(0.0);
            // A slope, so that depths differ.
            Some((light.position.y / (0.2 * ray.x - ray.y), Vec3::new(-0.2, 1.0, 0.0), color))
        });
        let all = map.lights(VplSettings::default());
        let brightest = all.iter().max_by(|a, b| a.intensity.x.total_cmp(&b.intensity.x)).unwrap();
        // In the corners, outside the cone, none is bright.
        if brightest.intensity.x < 1e-3 * light.intensity.x / (size[0] * size[1]) as f32 {
            continue;
        }
        let one = map.lights(VplSettings { spacing_m: 1e3, ..VplSettings::default() });
        assert_eq!(one.len(), 1);
        assert_eq!(
            (one[0].position, one[0].shape),
            (brightest.position, brightest.shape),
            "{lucky}"
        );
    }
}

#[test]
fn choice_conserves_light_and_stays_on_surfaces() {
    for size in [[64, 64], [50, 37]] {
        let light = spot(1.2);
        let map = Map::new(size, light, room(&light));
        let all = map.lights(VplSettings::default());
        for vpl in &all {
            let expected = reflected(&map, size, vpl.position);
            let off = (vpl.intensity - expected).abs().max_element();
            assert!(off < 2e-3 * expected.max_element() + 1e-9, "{vpl:?}, not {expected}");
        }
        let (mut last, texels) = (all.len(), (size[0] * size[1]) as usize);
        // The black wall and what lies outside the cone reflect nothing.
        assert!(last > texels / 2 && last < texels * 4 / 5, "{last} of {texels}");
        for spacing_m in [0.5, 1.0, 2.0, 1e3] {
            let lights = map.lights(VplSettings { spacing_m, ..VplSettings::default() });
            let off = (total(&lights) / total(&all) - DVec3::ONE).abs().max_element();
            assert!(off < 1e-4, "{spacing_m}: {off}");
            assert!(lights.len() < last, "{spacing_m}: {} of {last}", lights.len());
            last = lights.len();
            for light in &lights {
                let LightShape::Vpl { normal, .. } = light.shape else { panic!("not a VPL") };
                let off = off_surface(light.position);
                assert!(off < 1e-3, "{spacing_m}: {off} m at {}", light.position);
                let faces = normal.dot(map.light.position - light.position);
                assert!(faces > 0.0 && (normal.length() - 1.0).abs() < 1e-5, "{normal}");
                assert_eq!(light.check(), Ok(()));
            }
        }
        assert_eq!(last, 1);
    }
}

/// Blocks are no wider than asked, and as wide as they may be: near the light fewer texels suffice.
#[test]
fn spacing_is_even_where_texels_allow_it() {
    let light = spot(0.9);
    let map = Map::new([128, 128], light, |ray| Some((light.position.y / -ray.y, Vec3::Y, WHITE)));
    let widths = |spacing_m| -> Vec<[f32; 4]> {
        let settings = VplSettings { spacing_m, ..VplSettings::default() };
        let mut buffer = VplBuffer::new(&map.gpu, settings).unwrap();
        map.run(&mut buffer, |_| 1.0);
        let count = u64::from(buffer.read_counts(&map.gpu).unwrap().chosen);
        pod_collect_to_vec(&map.gpu.read(buffer.positions(), count * 16).unwrap())
    };
    for [x, y, z, width] in widths(0.0) {
        let to = Vec3::new(x, y, z) - light.position;
        let area = texel_area(&map, [128, 128]) * to.length() * light.position.y;
        assert!((width * width / area - 1.0).abs() < 1e-3, "{width}, not {}", area.sqrt());
    }
    let spacing_m = 0.3;
    let widths: Vec<f32> = widths(spacing_m).iter().map(|position| position[3]).collect();
    let count = widths.len();
    assert!(widths.iter().all(|w| *w > 0.0 && *w <= spacing_m), "{widths:?}");
    // Twice as wide would be too wide for the widest texel of most blocks.
    let wide = widths.iter().filter(|w| **w > 0.4 * spacing_m).count();
    assert!(wide * 10 > count * 9, "{wide} of {count}");
    assert!((300..1500).contains(&count), "{count}");
}

/// A spot of intensity I and half angle a over a white plane: the plane reflects I times the integral
/// of the cone's ramp over solid angle. With the ramp ((cos t - cos a) / (1 - cos a))^2 that is
/// 2 pi (1 - cos a) / 3.
#[test]
fn reflected_flux_is_the_spots() {
    for outer_angle in [0.3, 1.0] {
        let light = spot(outer_angle);
        let plane = |ray: Vec3| Some((light.position.y / -ray.y, Vec3::Y, WHITE));
        // A sphere around the light: the same light whatever the distance and the slope.
        let sphere = |ray: Vec3| Some((1.5 / ray.length(), -ray.normalize(), WHITE));
        let hits: [&dyn Fn(Vec3) -> Option<Hit>; 2] = [&plane, &sphere];
        for hit in hits {
            let map = Map::new([128, 128], light, hit);
            // A Lambertian emitter of intensity I along its normal emits pi I.
            let flux = f64::from(PI) * total(&map.lights(VplSettings::default()));
            let share = 2.0 * std::f64::consts::PI * (1.0 - f64::from(outer_angle).cos()) / 3.0;
            let off = flux / (light.intensity.as_dvec3() * share) - DVec3::ONE;
            assert!(off.abs().max_element() < 0.01, "{outer_angle}: {off}");
        }
    }
}

#[test]
fn order_is_fixed_and_neighbours_are_near() {
    let light = spot(1.2);
    let map = Map::new([64, 64], light, room(&light));
    let settings = VplSettings { spacing_m: 0.2, ..VplSettings::default() };
    let mut buffer = VplBuffer::new(&map.gpu, settings).unwrap();
    map.run(&mut buffer, |_| 1.0);
    let first = buffer.read(&map.gpu).unwrap();
    map.run(&mut buffer, |_| 1.0);
    assert!(first == buffer.read(&map.gpu).unwrap());
    // Sixteen texels of a row are some 2.5 m long.
    let spread = |run: &[Light]| {
        let ends = run.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), light| {
            (low.min(light.position), high.max(light.position))
        });
        ends.0.distance(ends.1)
    };
    let runs: Vec<f32> = first.chunks(16).map(spread).collect();
    let mean = runs.iter().sum::<f32>() / runs.len() as f32;
    assert!(mean < 1.6, "{mean} m");
    let reversed: Vec<Light> = first.iter().rev().copied().collect();
    assert!(first != reversed);
}

#[test]
fn what_drops_out_is_counted() {
    let light = spot(0.9);
    let map = Map::new([32, 32], light, |ray| Some((light.position.y / -ray.y, Vec3::Y, WHITE)));
    let all = map.lights(VplSettings::default());
    let count = all.len() as u32;
    // In turn: kept, too small, too large, unknown.
    let given = |ix: u32| [1.0, 0.1, 50.0, f32::MAX][(ix % 4) as usize];
    let settings = VplSettings {
        min_range_m: 0.5,
        max_range_m: 10.0,
        min_distance_m: 0.25,
        large: Large::Discard,
        ..VplSettings::default()
    };
    let expected =
        |which: &[u32]| -> Vec<u32> { (0..count).filter(|ix| which.contains(&(ix % 4))).collect() };
    for (large, which) in [(Large::Discard, &[0][..]), (Large::Clamp, &[0, 2, 3])] {
        let mut buffer = VplBuffer::new(&map.gpu, VplSettings { large, ..settings }).unwrap();
        map.run(&mut buffer, given);
        let kept = expected(which);
        let counts = buffer.read_counts(&map.gpu).unwrap();
        let (small, huge) = (expected(&[1]).len() as u32, expected(&[2, 3]).len() as u32);
        let wanted =
            VplCounts { chosen: count, kept: kept.len() as u32, too_small: small, too_large: huge };
        assert_eq!(counts, wanted, "{large:?}");
        let lights = buffer.read(&map.gpu).unwrap();
        assert_eq!(lights.len(), kept.len());
        for (light, ix) in lights.iter().zip(kept) {
            let range_m = if ix % 4 == 0 { 2.0 } else { 10.0 };
            let LightShape::Vpl { normal, .. } = all[ix as usize].shape else { panic!("a VPL") };
            let shape = LightShape::Vpl { normal, min_distance_m: 0.25 };
            assert_eq!(*light, Light { range_m, shape, ..all[ix as usize] }, "{ix}");
        }
        buffer.prepare(&map.gpu, &map.rsm()).unwrap();
        map.gpu.wait().unwrap();
        buffer.prepare(&map.gpu, &map.rsm()).unwrap();
        assert_eq!(buffer.latest_counts(), Some(wanted));
    }
}

/// Records of the lights kept are those that `LightBuffer` would upload.
#[test]
fn records_are_those_of_lights() {
    let light = spot(1.2);
    let map = Map::new([32, 32], light, room(&light));
    let settings = VplSettings { min_distance_m: 0.5, min_range_m: 20.0, ..VplSettings::default() };
    let mut buffer = VplBuffer::new(&map.gpu, settings).unwrap();
    map.run(&mut buffer, |ix| 0.1 + ix as f32);
    let lights = buffer.read(&map.gpu).unwrap();
    assert!(buffer.read_counts(&map.gpu).unwrap().too_small > 0);
    let uploaded = assign::LightBuffer::new(&map.gpu, &lights).unwrap();
    let count = lights.len() as u64;
    let same = |a, b, bytes| map.gpu.read(a, bytes).unwrap() == map.gpu.read(b, bytes).unwrap();
    assert!(same(buffer.spheres(), uploaded.spheres(), count * 16));
    assert!(same(buffer.emissions(), uploaded.emissions(), count * 16));
    let floats =
        |buffer| -> Vec<f32> { pod_collect_to_vec(&map.gpu.read(buffer, count * 32).unwrap()) };
    // `Light` makes its normal unit once more.
    let (own, given) = (floats(buffer.shapes()), floats(uploaded.shapes()));
    assert!(own.iter().zip(&given).all(|(a, b)| (a - b).abs() < 1e-6));
}

#[test]
fn a_limit_that_is_passed_is_an_error() {
    let light = spot(0.9);
    let map = Map::new([32, 32], light, |ray| Some((light.position.y / -ray.y, Vec3::Y, WHITE)));
    let all = map.lights(VplSettings::default());
    let limited = |limit| VplSettings { limit: Some(limit), ..VplSettings::default() };
    let mut buffer = VplBuffer::new(&map.gpu, limited(100)).unwrap();
    map.run(&mut buffer, |_| 0.5);
    let error = buffer.read(&map.gpu).unwrap_err().to_string();
    assert_eq!(
        error,
        format!("limit of VPLs is 100: it must be at least {}, the VPLs chosen", all.len())
    );
    buffer.set_settings(limited(all.len() as u32)).unwrap();
    map.run(&mut buffer, |_| 0.5);
    assert!(buffer.read(&map.gpu).unwrap() == all);
}

#[test]
fn normals_behind_the_last_are_zero() {
    let light = spot(0.9);
    let map = Map::new([32, 32], light, |ray| Some((light.position.y / -ray.y, Vec3::Y, WHITE)));
    let mut buffer = VplBuffer::new(&map.gpu, VplSettings::default()).unwrap();
    for spacing_m in [0.0, 0.8] {
        buffer.set_settings(VplSettings { spacing_m, ..VplSettings::default() }).unwrap();
        map.run(&mut buffer, |_| 1.0);
        let count = buffer.read_counts(&map.gpu).unwrap().chosen as usize;
        let bytes = map.gpu.read(buffer.normals(), u64::from(buffer.capacity()) * 16).unwrap();
        let normals: Vec<[f32; 4]> = pod_collect_to_vec(&bytes);
        let used = normals.iter().take_while(|normal| **normal == [0.0, 1.0, 0.0, 0.0]).count();
        assert_eq!(used, count, "{spacing_m}");
        assert!(count < normals.len() && normals[count..].iter().all(|normal| *normal == [0.0; 4]));
    }
}

#[test]
fn maps_that_cannot_be_used_are_refused() {
    let light = spot(0.9);
    let map = Map::new([32, 32], light, |_| None);
    let mut buffer = VplBuffer::new(&map.gpu, VplSettings::default()).unwrap();
    map.run(&mut buffer, |_| 1.0);
    assert_eq!(buffer.read_counts(&map.gpu).unwrap(), VplCounts::default());
    assert_eq!(buffer.read(&map.gpu).unwrap(), []);
    let mut fail = |rsm: Rsm<'_>| buffer.prepare(&map.gpu, &rsm).unwrap_err().to_string();
    let lamp = Light::point(Vec3::ZERO, 1.0, Vec3::ONE);
    assert!(fail(Rsm { light: &lamp, ..map.rsm() }).contains("it must be a spot"));
    let mut view = map.view;
    view.viewport.width = 4096;
    assert!(fail(Rsm { view: &view, ..map.rsm() }).contains("at most 2048x2048 texels"));
    view.viewport.width = 38;
    assert!(fail(Rsm { view: &view, ..map.rsm() }).contains("at least 41x33"));
    let mut view = map.view;
    view.projection = Projection::Orthographic { min: Vec2::NEG_ONE, max: Vec2::ONE };
    view.far_m = Some(10.0);
    assert!(fail(Rsm { view: &view, ..map.rsm() }).contains("must be perspective"));
}
