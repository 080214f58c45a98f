//! Lists that leave out lights which shadow maps hide: the same image, fewer lights, and none that a ray sees.

use assign::{
    Assignment, Bounds, CullSettings, ENTRY_LIGHT, Emitter, Everything, Gpu, Light, LightBuffer,
    LightSource, Storage, View,
};
use assign_clustered::{Clustered, Occupancy};
use assign_model::PerModel;
use glam::Vec3;
use scenes::{Instance, Material, Mesh, Model, Scene};
use shading::{
    Cut, HdrImage, HiddenPairs, LightBvh, Lighting, LightingOptions, ListCheck, Mode,
    OCCLUSION_TEST, OccluderDepth, Renderer, ShadowModel,
    traced::{GBufferSamples, TracedScene},
    visit_lists,
};

use crate::{
    common::{
        self,
        quads::{grey, scene_of},
    },
    draw, lamp, maps, spot,
    walls::walls_of,
};

const SIZE: [u32; 2] = [96, 64];

/// Settings that leave hidden lights out.
const OCC: CullSettings = CullSettings {
    tests: assign::FrustumTests { hs: true, sat_e: false, sat_n: true, sat_p: false, sat_v: false },
    source: LightSource::Linear,
    area_bounds: assign::AreaBounds::Outline,
    storage: Storage::Lists,
    screen_rectangle: false,
    occlusion: Some(OCCLUSION_TEST),
};

/// The light that stands alone behind the wall, and cannot shine around it.
const BEHIND: u32 = 0;

/// Two rooms that a wall with a door divides, with a pillar in the front one. Each wall is a model, so that models have
/// lists of their own.
fn rooms() -> Scene {
    let mut quads = walls_of(Vec3::new(-4.0, 0.0, -3.0), Vec3::new(4.0, 3.0, 3.0), true);
    quads.extend(walls_of(Vec3::new(-0.1, 0.0, -3.0), Vec3::new(0.1, 3.0, 1.8), false));
    quads.extend(walls_of(Vec3::new(1.5, 0.0, -0.4), Vec3::new(2.1, 2.0, 0.2), false));
    let scene = scene_of(&quads, Material { double_sided: true, ..grey(0.5) }, vec![]);
    let bounds = |mesh: &Mesh| {
        let mut corners = mesh.vertices.iter().map(|vertex| Vec3::from(vertex.position));
        let first = corners.next().unwrap();
        corners.fold((first, first), |(low, high), at| (low.min(at), high.max(at)))
    };
    let models = scene.meshes.iter().map(|mesh| {
        let (low, high) = bounds(mesh);
        Model { bounds_object: scenes::Aabb::new(low, high), ..scene.models[0].clone() }
    });
    let models = models.collect();
    let instances = (0..quads.len() as u32).map(|ix| Instance { mesh: ix, model: ix });
    Scene { models, instances: instances.collect(), ..scene }
}

/// Lights of all kinds in both rooms.
fn lights() -> Vec<Light> {
    let white = Vec3::splat(3.0);
    let both = Emitter::rectangle(Vec3::X * 0.3, Vec3::Y * 0.3).two_sided();
    let corners =
        [(-0.4, 0.0), (0.1, -0.4), (0.5, 0.1), (0.0, 0.4)].map(|(x, z)| Vec3::new(x, 0.0, z));
    let (polygon, middle) = Emitter::polygon(&corners).unwrap();
    vec![
        Light::point(Vec3::new(-1.0, 1.5, -2.2), 4.0, white),
        Light::point(Vec3::new(2.0, 2.6, 1.5), 9.0, white),
        Light::point(Vec3::new(-3.5, 0.4, 2.5), 9.0, white),
        Light::point(Vec3::new(3.7, 0.3, -2.7), 5.0, white),
        spot(Vec3::new(-1.6, 2.8, 0.3), 0.8),
        spot(Vec3::new(-2.0, 2.5, -1.5), 1.5),
        spot(Vec3::new(1.0, 2.8, -1.0), 0.7),
        spot(Vec3::new(2.9, 1.0, 0.0), 2.2),
        lamp(Vec3::new(-2.0, 2.7, -1.0)),
        lamp(Vec3::new(2.2, 2.7, -1.8)),
        Light::area(both, Vec3::new(-2.5, 1.2, 0.5), 6.0, white),
        Light::area(polygon, Vec3::new(-1.2, 2.5, -2.0) + middle, 6.0, white),
    ]
}

/// From the front room towards the wall and the door.
fn view() -> View {
    View::look_at(Vec3::new(3.6, 1.7, 2.6), Vec3::new(0.0, 1.0, -0.6), 1.2, 0.05, SIZE)
}

/// A stage with shadow maps and what hides lights.
struct Rooms {
    gpu: Gpu,
    scene: Scene,
    lights: LightBuffer,
    renderer: Renderer,
    model: ShadowModel,
}

impl Rooms {
    fn new(model: ShadowModel, kept: OccluderDepth) -> Self {
        let gpu = common::gpu();
        let scene = rooms();
        let lights = LightBuffer::new(&gpu, &lights()).unwrap();
        let mut renderer = Renderer::new(&gpu, &scene, &view()).unwrap();
        renderer.cast_shadows(&lights, model).unwrap();
        let figures = renderer.find_occluders(kept).unwrap();
        assert!(3 * figures.atlas_bytes() - 8 * figures.occluder_bytes < 4096, "{figures:?}");
        renderer.prepare(&view(), &lights).unwrap();
        Self { gpu, scene, lights, renderer, model }
    }

    /// The image of a strategy, after its pool has grown.
    fn image(&self, strategy: &mut dyn Assignment, mode: Mode) -> HdrImage {
        draw(&self.renderer, &view(), &self.lights, strategy, mode, self.model);
        draw(&self.renderer, &view(), &self.lights, strategy, mode, self.model)
    }

    fn without_culling(&self, mode: Mode) -> HdrImage {
        self.image(&mut Everything::new(&self.gpu).unwrap(), mode)
    }

    fn clusters(
        &self,
        size: &str,
        kind: (Bounds, Occupancy),
        settings: CullSettings,
    ) -> Box<dyn Assignment> {
        Box::new(
            Clustered::new(&self.gpu, size.parse().unwrap(), kind.0, kind.1, settings).unwrap(),
        )
    }

    fn models(&self, settings: CullSettings) -> Box<dyn Assignment> {
        Box::new(PerModel::new(&self.gpu, Some(1.0), settings).unwrap())
    }

    /// (Light, sample) pairs of the last image's lists, those of [`BEHIND`] with samples behind the wall, and hidden pairs.
    fn pairs(&self, strategy: &dyn Assignment) -> (u64, usize, HiddenPairs) {
        let bvh = LightBvh::new(self.lights.lights());
        let traced = TracedScene::new(&self.scene);
        let mut check = ListCheck::new(&bvh).in_scene(Some(&traced));
        check.ignore_hidden(strategy.needs().occluders);
        let surfaces = GBufferSamples::read(&self.renderer, &view()).unwrap();
        let frame_view = view();
        let frame = self.renderer.frame(&frame_view, &self.lights);
        let snapshot = strategy.lists().snapshot(&self.gpu).unwrap();
        let (mut listed, mut holds, mut hidden) = (0, 0, HiddenPairs::default());
        let mut visit = |samples: &shading::Samples, lists: &assign::ListsSnapshot| {
            let truth = check.check(samples, lists, false);
            assert_eq!(truth.missed, 0, "{}", strategy.id());
            listed += truth.listed;
            hidden += check.hidden(samples, lists, &surfaces, false).unwrap();
            let behind =
                samples.groups.iter().zip(&samples.positions).filter(|(group, position)| {
                    let entries = lists.entries_of(**group).unwrap_or_default();
                    // In the front room, away from the door.
                    let is_behind = position[0] > 1.0 && position[2] < 1.0;
                    is_behind && entries.iter().any(|entry| entry & ENTRY_LIGHT == BEHIND)
                });
            holds += behind.count();
        };
        visit_lists(&self.renderer, strategy, &frame, &snapshot, false, &mut visit).unwrap();
        (listed, holds, hidden)
    }
}

const KINDS: [(Bounds, Occupancy); 6] = [
    (Bounds::Implicit, Occupancy::Dense),
    (Bounds::Explicit, Occupancy::Dense),
    (Bounds::Implicit, Occupancy::Sparse),
    (Bounds::Explicit, Occupancy::Sparse),
    (Bounds::Implicit, Occupancy::DepthAware),
    (Bounds::Explicit, Occupancy::DepthAware),
];

/// The place of SC-E among them.
const SPARSE_BOXES: usize = 3;

/// All strategies show the image of no culling, with shorter lists that lack the light behind the wall. All lights that
/// they leave out are hidden from rays too.
#[test]
fn lists_lack_hidden_lights_and_images_keep_their_bits() {
    let rooms = Rooms::new(maps(9, 128, 1), OccluderDepth::Farthest);
    let none = rooms.without_culling(Mode::Deferred);
    let make = |ix: usize, settings| match KINDS.get(ix) {
        Some(kind) => rooms.clusters("12x12x16", *kind, settings),
        None => rooms.models(settings),
    };
    let mut all = make(SPARSE_BOXES, CullSettings { occlusion: None, ..OCC });
    let image = rooms.image(&mut *all, Mode::Deferred);
    assert_eq!(image.difference(&none).unwrap().differing_channels, 0);
    let (listed, holds, nothing) = rooms.pairs(&*all);
    assert!(holds > 20 && nothing == HiddenPairs::default(), "{holds}, {nothing:?}");
    for ix in 0..=KINDS.len() {
        let mut strategy = make(ix, OCC);
        assert!(strategy.needs().occluders && strategy.id().ends_with("/occ"));
        let difference = rooms.image(&mut *strategy, Mode::Deferred).difference(&none).unwrap();
        assert_eq!(difference.differing_channels, 0, "{}: {difference:?}", strategy.id());
        let (left, still_holds, hidden) = rooms.pairs(&*strategy);
        println!("{}: {left} pairs, {still_holds} behind the wall, {hidden:?}", strategy.id());
        assert!(hidden.removed > 1000, "{}: {hidden:?}", strategy.id());
        assert_eq!((hidden.seen, hidden.seen_areas), (0, 0), "{}: {hidden:?}", strategy.id());
        if ix == SPARSE_BOXES {
            assert!(5 * left < 4 * listed, "{left} of {listed} pairs are left");
            assert!(5 * still_holds < holds, "{still_holds} of {holds} behind the wall");
        }
    }
}

/// Neither small and odd maps, nor filters, nor masks and the hierarchy, nor forward shading change a bit.
#[test]
fn images_keep_their_bits_for_any_map_filter_and_storage() {
    for (ix, model) in
        [maps(1, 32, 1), maps(4, 50, 9), maps(4, 64, 25), maps(1, 300, 4)].into_iter().enumerate()
    {
        let rooms = Rooms::new(model, OccluderDepth::Farthest);
        let mode = [Mode::Deferred, Mode::Forward][ix % 2];
        let none = rooms.without_culling(mode);
        let storage = [Storage::Lists, Storage::Masks, Storage::Trees, Storage::Lists][ix];
        let settings = CullSettings { source: LightSource::Hierarchy, storage, ..OCC };
        let mut strategy = match ix {
            1 => rooms.models(settings),
            _ => rooms.clusters("8x8x24", KINDS[[3, 0, 0, 5][ix]], settings),
        };
        let image = rooms.image(&mut *strategy, mode);
        let difference = image.difference(&none).unwrap();
        assert_eq!(difference.differing_channels, 0, "{} {model}: {difference:?}", strategy.id());
    }
}

/// The same test finds a pyramid that keeps the nearest depths: it hides lights that are seen.
#[test]
fn a_pyramid_of_nearest_depths_is_found() {
    let rooms = Rooms::new(maps(9, 128, 1), OccluderDepth::Nearest);
    let none = rooms.without_culling(Mode::Deferred);
    let mut strategy = rooms.clusters("12x12x16", KINDS[3], OCC);
    let image = rooms.image(&mut *strategy, Mode::Deferred);
    assert!(image.difference(&none).unwrap().differing_channels > 100);
    let (.., hidden) = rooms.pairs(&*strategy);
    assert!(hidden.seen > 100 && hidden.seen_areas > 20, "{hidden:?}");
}

#[test]
fn what_hides_lights_needs_maps_and_strategies_need_it() {
    let gpu = common::gpu();
    let lights = LightBuffer::new(&gpu, &lights()).unwrap();
    let mut renderer = Renderer::new(&gpu, &rooms(), &view()).unwrap();
    let error = renderer.find_occluders(OccluderDepth::Farthest).unwrap_err().to_string();
    assert!(error.starts_with("shadow model is none: it must be a model with maps"), "{error}");
    renderer.cast_shadows(&lights, maps(1, 64, 1)).unwrap();
    renderer.prepare(&view(), &lights).unwrap();
    let size = "16x16x16".parse().unwrap();
    let mut strategy =
        Clustered::new(&gpu, size, Bounds::Explicit, Occupancy::Sparse, OCC).unwrap();
    let at = view();
    let error = strategy.prepare(&gpu, &renderer.frame(&at, &lights)).unwrap_err().to_string();
    assert!(error.contains("needs occluders, which the frame lacks"), "{error}");
    renderer.find_occluders(OccluderDepth::Farthest).unwrap();
    strategy.prepare(&gpu, &renderer.frame(&at, &lights)).unwrap();
    // Soft filters read beside what the test looks at.
    let soft = ShadowModel::Pcss { maps: 1, px: 64, taps: 4 };
    let mut other = Renderer::new(&gpu, &rooms(), &view()).unwrap();
    other.cast_shadows(&lights, soft).unwrap();
    let error = other.find_occluders(OccluderDepth::Farthest).unwrap_err().to_string();
    assert!(error.contains("cannot serve shadow model maps:1,64,pcss4"), "{error}");
    // New maps have none.
    renderer.cast_shadows(&lights, maps(1, 64, 1)).unwrap();
    assert!(renderer.frame(&at, &lights).occluders.is_none());
}

/// Maps that leave out what lies beyond the ranges of their lights give the same image. Lighting that reaches farther
/// refuses them.
#[test]
fn what_lies_beyond_the_range_of_a_light_changes_no_bit() {
    let gpu = common::gpu();
    let lights = LightBuffer::new(&gpu, &lights()).unwrap();
    let mut renderer = Renderer::new(&gpu, &rooms(), &view()).unwrap();
    let mut strategy = Everything::new(&gpu).unwrap();
    for model in [maps(1, 32, 25), maps(4, 64, 1)] {
        let mut image = |ranges| {
            renderer.cast_shadows_within(ranges);
            renderer.cast_shadows(&lights, model).unwrap();
            renderer.prepare(&view(), &lights).unwrap();
            draw(&renderer, &view(), &lights, &mut strategy, Mode::Deferred, model)
        };
        let [near, all] = [1.0, f32::INFINITY].map(&mut image);
        assert_eq!(near.difference(&all).unwrap().differing_channels, 0, "{model}");
        image(1.0);
        for options in [
            LightingOptions { cut: Cut::Never, ..LightingOptions::default() },
            LightingOptions { specular_reach: Some(8.0), ..LightingOptions::default() },
        ] {
            let options = LightingOptions { kinds: lights.kinds(), shadows: model, ..options };
            let refused = Lighting::new(&renderer, &strategy, Mode::Deferred, options);
            let error = refused.unwrap_err().to_string();
            assert!(error.contains("Renderer::cast_shadows_within"), "{error}");
        }
    }
}
