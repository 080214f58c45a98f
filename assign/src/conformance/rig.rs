//! The suite's GPU side: it draws surfaces into a depth buffer and looks up lists with a probe.

use bytemuck::{Pod, Zeroable, bytes_of, cast_slice, pod_collect_to_vec};

use super::stage::{IN_THE_OPEN, Sample, Stage};
use crate::{
    AssignError, Assignment, FrameBindings, Gpu, LightKinds, LightList, SampleDomain, Shader,
    entry, kernel::bind_entries, storage_entry, texture, texture_entry, uniform_entry,
};

/// Bind group of the lists in the probe shader.
pub(super) const LISTS_GROUP: u32 = 1;
const PROBE_GROUP: u32 = 2;
const NORMAL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A sample and what its look-up found: `struct Probe` of `probe.wesl`. 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Probe {
    pub(super) pixel: [f32; 2],
    depth_clip: f32,
    model_ix: u32,
    pub(super) position_world: [f32; 3],
    pub(super) depth_view: f32,
    pub(super) group: u32,
    pub(super) count: u32,
    pub(super) read: u32,
    depth_used: f32,
    /// The normal that was drawn; after the look-up, the normal that the look-up used.
    pub(super) normal_world: [f32; 3],
    pub(super) hash: u32,
}

impl Probe {
    /// Whether the sample is one of the depth buffer.
    pub(super) fn is_on_surface(&self) -> bool {
        self.model_ix != IN_THE_OPEN
    }
}

/// What a case looks up, and what it tells the strategy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Asked {
    /// The samples that are looked up.
    pub(super) samples: SampleDomain,
    /// What the frame says about them.
    pub(super) declared: SampleDomain,
    /// Whether look-ups ask whether their list serves them.
    pub(super) anywhere: bool,
}

impl Asked {
    /// Samples of a domain that the frame states.
    pub(super) fn stated(samples: SampleDomain) -> Self {
        let anywhere = samples != SampleDomain::OpaqueSurfaces;
        Self { samples, declared: samples, anywhere }
    }

    /// Samples at any depth in a frame of opaque surfaces.
    pub(super) fn unstated(anywhere: bool) -> Self {
        let declared = SampleDomain::OpaqueSurfaces;
        Self { samples: SampleDomain::AnyDepth, declared, anywhere }
    }
}

/// A stage's surfaces and samples on the GPU.
pub(super) struct Surfaces {
    pub(super) depth: wgpu::TextureView,
    pub(super) normals: wgpu::TextureView,
    probes: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
    pub(super) count: u32,
    /// Whether look-ups ask whether their list serves them ([`Shader::looks_up_anywhere`]).
    anywhere: bool,
}

/// The device and the pipeline that draws surfaces. All strategies of a process share them.
pub(super) struct Rig {
    pub(super) gpu: Gpu,
    draw: wgpu::RenderPipeline,
    probe_layout: wgpu::BindGroupLayout,
    dump_layout: wgpu::BindGroupLayout,
}

impl Rig {
    pub(super) fn new(gpu: Gpu) -> Self {
        let stages = wgpu::ShaderStages::COMPUTE;
        let entries = [
            storage_entry(0, stages, false),
            texture_entry(1, stages, wgpu::TextureSampleType::Depth),
            texture_entry(2, stages, wgpu::TextureSampleType::Float { filterable: true }),
        ];
        let probe_layout = gpu.bind_group_layout("probe", &entries);
        let more = [storage_entry(3, stages, true), storage_entry(4, stages, false)];
        let dump_layout = gpu.bind_group_layout("dump", &[&entries[..], &more].concat());
        Self { draw: draw_pipeline(&gpu), gpu, probe_layout, dump_layout }
    }

    /// Uploads the samples that are looked up, and draws the surfaces.
    pub(super) fn set_up(&self, stage: &Stage, asked: Asked) -> Result<Surfaces, AssignError> {
        let device = &self.gpu.device;
        let (on_surfaces, open) = stage.samples.split_at(stage.on_surfaces);
        let is_asked = |sample: &&Sample| match asked.samples {
            SampleDomain::OpaqueSurfaces | SampleDomain::NearSurfaces => false,
            SampleDomain::InFront => stage.is_in_front(sample),
            SampleDomain::AnyDepth => true,
        };
        let probes: Vec<Probe> = on_surfaces
            .iter()
            .chain(open.iter().filter(is_asked))
            .map(|s| Probe {
                pixel: s.pixel.map(|p| p as f32 + 0.5),
                depth_clip: s.depth_clip,
                model_ix: s.model_ix,
                normal_world: s.normal_world.to_array(),
                ..Probe::zeroed()
            })
            .collect();
        let buffer = self.gpu.storage("probes", size_of_val(&probes[..]) as u64)?;
        self.gpu.queue.write_buffer(&buffer, 0, cast_slice(&probes));
        let depth = target(device, "depth", DEPTH_FORMAT, stage.target);
        let normals = target(device, "normals", NORMAL_FORMAT, stage.target);
        self.draw(stage, &depth, &normals)?;
        let entries = [entry(0, &buffer), texture(1, &depth), texture(2, &normals)];
        let bind_group = bind_entries(&self.gpu, &self.probe_layout, &entries);
        let count = probes.len() as u32;
        Ok(Surfaces { depth, normals, probes: buffer, bind_group, count, anywhere: asked.anywhere })
    }

    fn draw(
        &self,
        stage: &Stage,
        depth: &wgpu::TextureView,
        normals: &wgpu::TextureView,
    ) -> Result<(), AssignError> {
        let gpu = &self.gpu;
        let texels = gpu.storage("texels", size_of_val(&stage.texels[..]) as u64)?;
        gpu.queue.write_buffer(&texels, 0, cast_slice(&stage.texels));
        let width = gpu.uniform("width", 16);
        gpu.queue.write_buffer(&width, 0, bytes_of(&[stage.target[0], 0, 0, 0]));
        let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("surfaces"),
            layout: &self.draw.get_bind_group_layout(0),
            entries: &[entry(0, &texels), entry(1, &width)],
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("surfaces"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: normals,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(stage.view.depth_clear()),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&self.draw);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.draw(0..3, 0..1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// The pipeline that looks samples up; with `dump` it writes their entries.
    fn probe_pipeline(
        &self,
        strategy: &dyn Assignment,
        frame: &FrameBindings,
        kinds: LightKinds,
        (anywhere, dump): (bool, bool),
    ) -> Result<wgpu::ComputePipeline, AssignError> {
        let lookup = strategy.lookup();
        let module = Shader::new(LISTS_GROUP)
            .module("package::probe", include_str!("probe.wesl"))
            .strategy(lookup.module)
            .flag("dump", dump)
            .flag("anywhere", anywhere)
            .light_kinds(kinds)
            .create(&self.gpu, "package::probe")?;
        let probe = if dump { &self.dump_layout } else { &self.probe_layout };
        let layouts = [Some(frame.layout()), Some(lookup.layout()), Some(probe)];
        Ok(self.gpu.compute_pipeline(&module, "look_up", &layouts, true))
    }

    /// Records the look-up of every sample.
    pub(super) fn record_probe(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        strategy: &dyn Assignment,
        frame: &FrameBindings,
        kinds: LightKinds,
        surfaces: &Surfaces,
    ) -> Result<(), AssignError> {
        if strategy.bind_group().is_none() {
            let id = strategy.id();
            return Err(AssignError::Device(format!("{id} has no bind group after prepare")));
        }
        let pipeline = self.probe_pipeline(strategy, frame, kinds, (surfaces.anywhere, false))?;
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, frame.bind_group(), &[]);
        pass.set_bind_group(LISTS_GROUP, strategy.bind_group(), &[]);
        pass.set_bind_group(PROBE_GROUP, &surfaces.bind_group, &[]);
        pass.dispatch_workgroups(surfaces.count.div_ceil(64), 1, 1);
        Ok(())
    }

    /// Looks every sample up twice more, for strategies whose lists do not say what a sample reads: once to count
    /// the entries, and once to read them. Returns the list of each sample, and all entries. Both runs are of one
    /// shader, so that lanes work together in the same way.
    pub(super) fn dump(
        &self,
        strategy: &dyn Assignment,
        frame: &FrameBindings,
        kinds: LightKinds,
        surfaces: &Surfaces,
    ) -> Result<(Vec<LightList>, Vec<u32>), AssignError> {
        let pipeline = self.probe_pipeline(strategy, frame, kinds, (surfaces.anywhere, true))?;
        let run = |places: &[u32]| -> Result<Vec<u32>, AssignError> {
            self.run_dump(&pipeline, (frame.bind_group(), strategy.bind_group()), surfaces, places)
        };
        // No sample has room for entries.
        run(&vec![0; surfaces.count as usize + 1])?;
        let mut end = 0u32;
        let mut lists = Vec::new();
        for probe in self.read_probes(surfaces)? {
            lists.push(LightList { first: end, count: probe.read });
            end = end.checked_add(probe.read).ok_or_else(|| AssignError::TooLarge {
                what: "the entries of all samples".into(),
                bytes: (u64::from(end) + u64::from(probe.read)) * 4,
                limit: u64::from(u32::MAX) * 4,
            })?;
        }
        let places: Vec<u32> = lists.iter().map(|list| list.first).chain([end]).collect();
        Ok((lists, run(&places)?))
    }

    fn run_dump(
        &self,
        pipeline: &wgpu::ComputePipeline,
        (frame, lists): (Option<&wgpu::BindGroup>, Option<&wgpu::BindGroup>),
        surfaces: &Surfaces,
        places: &[u32],
    ) -> Result<Vec<u32>, AssignError> {
        let gpu = &self.gpu;
        let place_buffer = gpu.storage("places", size_of_val(places) as u64)?;
        gpu.queue.write_buffer(&place_buffer, 0, cast_slice(places));
        let bytes = u64::from(places.last().copied().unwrap_or(0)) * 4;
        let dumped = gpu.storage("dumped entries", bytes)?;
        let entries = [
            entry(0, &surfaces.probes),
            texture(1, &surfaces.depth),
            texture(2, &surfaces.normals),
            entry(3, &place_buffer),
            entry(4, &dumped),
        ];
        let bind_group = bind_entries(gpu, &self.dump_layout, &entries);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(LISTS_GROUP, lists, &[]);
        pass.set_bind_group(PROBE_GROUP, &bind_group, &[]);
        pass.dispatch_workgroups(surfaces.count.div_ceil(64), 1, 1);
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        Ok(pod_collect_to_vec(&gpu.read(&dumped, bytes)?))
    }

    /// Reads the samples back after submission.
    pub(super) fn read_probes(&self, surfaces: &Surfaces) -> Result<Vec<Probe>, AssignError> {
        let bytes = u64::from(surfaces.count) * size_of::<Probe>() as u64;
        let probes: Vec<Probe> = pod_collect_to_vec(&self.gpu.read(&surfaces.probes, bytes)?);
        let wrong = |p: &&Probe| p.depth_used.to_bits() != p.depth_clip.to_bits();
        if let Some(probe) = probes.iter().find(wrong) {
            return Err(AssignError::Device(format!(
                "the depth buffer at pixel {:?} holds {} instead of {}",
                probe.pixel, probe.depth_used, probe.depth_clip
            )));
        }
        Ok(probes)
    }
}

fn target(
    device: &wgpu::Device,
    label: &str,
    format: wgpu::TextureFormat,
    size: [u32; 2],
) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

fn draw_pipeline(gpu: &Gpu) -> wgpu::RenderPipeline {
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("surfaces"),
        source: wgpu::ShaderSource::Wgsl(include_str!("surfaces.wgsl").into()),
    });
    let stages = wgpu::ShaderStages::FRAGMENT;
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("surfaces"),
        entries: &[storage_entry(0, stages, true), uniform_entry(1, stages)],
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("surfaces"),
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("surfaces"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("draw"),
            compilation_options: Default::default(),
            targets: &[Some(NORMAL_FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
