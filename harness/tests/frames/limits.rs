//! Strategies on devices with few limits: WebGPU's defaults, and exactly what a strategy says it needs.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, EncoderPasses, Everything, Frame, Gpu,
    LightBuffer, LightSource, Team, Touched,
};
use assign_clustered::{ClusterOptions, Clustered, HybridGrid, Occupancy, Scatter, ZBins};
use assign_grid::{CellCounts, Grid, GridBox, HashedCells};
use assign_model::PerModel;
use assign_tiled::{TileDepths, Tiled};
use assign_walk::Walk;
use shading::Renderer;

use crate::stage::{few, image, lighting, lights, record_frame, scene, truth, view};

/// A device of the first adapter with some limits.
fn device(limits: wgpu::Limits) -> Gpu {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::all() - wgpu::Backends::NOOP;
    let instance = wgpu::Instance::new(descriptor);
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).expect("one");
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_limits: limits,
            ..Default::default()
        }))
        .expect("a device");
    Gpu::new(device, queue, adapter.get_info())
}

/// Every strategy but those that say they need more is exact with WebGPU's default limits.
#[test]
fn strategies_fit_the_default_limits_of_webgpu() {
    let gpu = device(wgpu::Limits {
        // The renderer of the tests has larger pixels than WebGPU promises. Strategies draw none.
        max_color_attachment_bytes_per_sample: 64,
        ..wgpu::Limits::default()
    });
    let scene = scene();
    let view = view(&scene, 0.0, [64, 36]);
    let lights = LightBuffer::new(&gpu, &lights(&scene, 200)).expect("lights");
    let mut renderer = Renderer::new(&gpu, &scene, &view).expect("a renderer");
    renderer.prepare(&view, &lights).expect("prepares");
    let truth = truth(&renderer, &view, &lights);
    let mut fit = Vec::new();
    for mut contender in few(&gpu) {
        let id = harness::strategy::StrategyId::parse(&contender.id).expect("an id");
        if id.is_lossy(200) || id.has_flaw() {
            continue;
        }
        let lighting = lighting(&renderer, &lights, &contender);
        for _ in 0..2 {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let strategy = contender.strategy.as_mut();
            record_frame(&renderer, (&view, &lights), strategy, &lighting, &mut encoder);
            gpu.queue.submit([encoder.finish()]);
        }
        let differing = image(&renderer, &view).difference(&truth).expect("as large");
        assert_eq!(differing.differing_channels, 0, "{}", contender.id);
        fit.push(contender.id);
    }
    // Those that once took nine storage buffers.
    for id in ["SC-E/bvh", "DA-E/bvh", "M/2/bvh", "T-25D/bvh", "HC/bvh"] {
        assert!(fit.iter().any(|fit| fit == id), "{id} does not fit: {fit:?}");
    }
}

type Make = fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError>;

fn boxed<S: Assignment + 'static>(
    made: Result<S, AssignError>,
) -> Result<Box<dyn Assignment>, AssignError> {
    Ok(Box::new(made?))
}

const BVH: CullSettings = CullSettings { source: LightSource::Hierarchy, ..DEFAULT };
const DEFAULT: CullSettings = CullSettings {
    tests: assign::FrustumTests { hs: true, sat_n: true, sat_e: false, sat_p: false, sat_v: false },
    source: LightSource::Linear,
    area_bounds: assign::AreaBounds::Outline,
    storage: assign::Storage::Lists,
    screen_rectangle: false,
    occlusion: None,
};

fn clusters(bounds: Bounds, occupancy: Occupancy, settings: CullSettings) -> ClusterOptions {
    ClusterOptions::new("16x16x8".parse().expect("a size"), bounds, occupancy, settings)
}

/// Each strategy runs on a device with what it says it needs, and refuses one with a storage buffer less.
#[test]
fn what_a_strategy_needs_is_enough_and_no_more_than_enough() {
    let cases: [(&str, wgpu::Limits, Make); 11] = [
        (
            "SC-E/bvh",
            Clustered::required_limits(&clusters(Bounds::Explicit, Occupancy::Sparse, BVH)),
            |gpu| {
                let options = clusters(Bounds::Explicit, Occupancy::Sparse, BVH);
                boxed(Clustered::with_options(gpu, options))
            },
        ),
        (
            "DC-I",
            Clustered::required_limits(&clusters(Bounds::Implicit, Occupancy::Dense, DEFAULT)),
            |gpu| {
                let options = clusters(Bounds::Implicit, Occupancy::Dense, DEFAULT);
                boxed(Clustered::with_options(gpu, options))
            },
        ),
        ("ZB/bvh", ZBins::required_limits(BVH), |gpu| {
            boxed(ZBins::new(gpu, "16x16x8".parse()?, BVH))
        }),
        ("HG", HybridGrid::required_limits(), |gpu| {
            boxed(HybridGrid::new(gpu, "16x16x8".parse()?))
        }),
        ("HG/raster", HybridGrid::required_limits(), |gpu| {
            boxed(HybridGrid::with_scatter(gpu, "16x16x8".parse()?, Scatter::Raster))
        }),
        ("T-25D/bvh", Tiled::required_limits(TileDepths::Sliced, BVH), |gpu| {
            boxed(Tiled::new(gpu, "16x16".parse()?, TileDepths::Sliced, BVH))
        }),
        ("G/visible", Grid::required_limits(DEFAULT), |gpu| {
            boxed(Grid::new(gpu, CellCounts([4, 4, 4]), GridBox::Visible, DEFAULT))
        }),
        ("HC/bvh", HashedCells::required_limits(BVH), |gpu| boxed(HashedCells::new(gpu, 16, BVH))),
        ("M/bvh", PerModel::required_limits(BVH), |gpu| boxed(PerModel::new(gpu, None, BVH))),
        ("W1", Walk::required_limits(Team::Lane, LightSource::Hierarchy), |gpu| {
            boxed(Walk::new(gpu, Team::Lane, LightSource::Hierarchy))
        }),
        ("G/touched", Touched::required_limits(), |gpu| {
            let grid = Grid::new(gpu, CellCounts([4, 4, 4]), GridBox::Positions, BVH)?;
            boxed(Touched::new(gpu, Box::new(grid)))
        }),
    ];
    for (id, limits, make) in cases {
        let needs = limits.max_storage_buffers_per_shader_stage;
        let gpu = device(limits.clone());
        let mut strategy = make(&gpu).unwrap_or_else(|error| panic!("{id}: {error}"));
        draw(&gpu, strategy.as_mut());
        let less = wgpu::Limits { max_storage_buffers_per_shader_stage: needs - 1, ..limits };
        match make(&device(less)) {
            Err(AssignError::Limit { limit, needs: asked, has, .. }) => {
                assert_eq!(limit, "max_storage_buffers_per_shader_stage", "{id}");
                assert_eq!((asked, has), (needs.into(), u64::from(needs) - 1), "{id}");
            }
            Err(other) => panic!("{id}: {other}"),
            Ok(_) => panic!("{id} takes a device with {} storage buffers", needs - 1),
        }
    }
    assert!(Everything::new(&device(wgpu::Limits::default())).is_ok());
}

/// Prepares and records two frames of an empty depth buffer.
fn draw(gpu: &Gpu, strategy: &mut dyn Assignment) {
    let scene = scene();
    let view = view(&scene, 0.0, [64, 36]);
    let lights = LightBuffer::new(gpu, &lights(&scene, 20)).expect("lights");
    let depth = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 64, height: 36, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let depth = depth.create_view(&wgpu::TextureViewDescriptor::default());
    for _ in 0..2 {
        let frame = Frame::new(&view, &lights).with_depth(&depth).with_models(&[]);
        strategy.prepare(gpu, &frame).expect("prepares");
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        strategy.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
        gpu.queue.submit([encoder.finish()]);
    }
    gpu.wait().expect("runs");
}
