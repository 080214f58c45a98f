//! Images that a strategy cannot read are refused with the field, the value and what would be accepted.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    AssignError, DepthImage, Frame, Gpu, KeptBindGroup, LightBuffer, SampleDomain, View, Viewport,
};
use glam::Vec3;

const SIZE: [u32; 2] = [64, 48];

/// A texture that a strategy can read as depth.
fn depth_texture() -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    }
}

fn colors() -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor { format: wgpu::TextureFormat::Rgba16Float, ..depth_texture() }
}

fn size(width: u32, height: u32) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}

/// A view that ends at pixel 64 x 48 of its target.
fn view() -> View {
    let mut view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [60, 40]);
    view.viewport = Viewport { x: 4, y: 8, ..view.viewport };
    view
}

fn texture(gpu: &Gpu, descriptor: &wgpu::TextureDescriptor<'_>) -> wgpu::TextureView {
    gpu.device.create_texture(descriptor).create_view(&Default::default())
}

/// Asks a frame with changes for its images.
fn ask<T>(
    gpu: &Gpu,
    change: impl for<'a> Fn(Frame<'a>) -> Result<T, AssignError>,
) -> Result<T, AssignError> {
    let (view, lights) = (view(), LightBuffer::new(gpu, &[]).unwrap());
    change(Frame::new(&view, &lights))
}

fn ask_depth(
    gpu: &Gpu,
    descriptor: &wgpu::TextureDescriptor<'_>,
) -> Result<DepthImage, AssignError> {
    let depth = texture(gpu, descriptor);
    ask(gpu, |frame| frame.with_depth(&depth).surface_depth("X"))
}

#[test]
fn wrong_depth_is_refused() {
    let gpu = Gpu::noop().unwrap();
    let plain = depth_texture();
    assert!(!ask_depth(&gpu, &plain).unwrap().is_multisampled());
    let several = wgpu::TextureDescriptor { sample_count: 4, ..plain.clone() };
    let several = ask_depth(&gpu, &several).unwrap();
    assert!(several.is_multisampled());
    let error = several.with_one_sample("it reads one").unwrap_err().to_string();
    assert_eq!(error, "X cannot serve a depth buffer of 4 samples per pixel: it reads one");
    for (wrong, message) in [
        (
            wgpu::TextureDescriptor { size: size(63, 48), ..plain.clone() },
            "size is 63x48: it must be at least 64x48, where the viewport ends",
        ),
        (
            wgpu::TextureDescriptor { size: size(64, 47), ..plain.clone() },
            "size is 64x47: it must be at least 64x48, where the viewport ends",
        ),
        (
            wgpu::TextureDescriptor { format: wgpu::TextureFormat::R32Float, ..plain.clone() },
            "format is R32Float: it must be a depth format",
        ),
        (
            wgpu::TextureDescriptor { format: wgpu::TextureFormat::Stencil8, ..plain.clone() },
            "format is Stencil8: it must be a depth format",
        ),
        (
            wgpu::TextureDescriptor {
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                ..plain.clone()
            },
            "it must be one with TEXTURE_BINDING",
        ),
        (
            wgpu::TextureDescriptor {
                dimension: wgpu::TextureDimension::D3,
                format: wgpu::TextureFormat::R32Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                ..plain.clone()
            },
            "dimension is D3: it must be D2",
        ),
    ] {
        let error = ask_depth(&gpu, &wrong).unwrap_err();
        assert!(matches!(error, AssignError::Image { image: "depth", .. }), "{error:?}");
        let error = error.to_string();
        assert!(error.starts_with("X reads depth from a texture whose "), "{error}");
        assert!(error.contains(message), "{error}");
    }
    let missing = ask(&gpu, |frame| frame.surface_depth("X")).unwrap_err().to_string();
    assert_eq!(
        missing,
        "X needs depth, which the frame lacks: give it to the frame, as `Frame::with_depth` does for depth"
    );
    let depth = texture(&gpu, &plain);
    let any = |frame: Frame<'_>| {
        frame.sampled_at(SampleDomain::AnyDepth).with_depth(&depth).surface_depth("X").map(|_| ())
    };
    assert!(matches!(ask(&gpu, any), Err(AssignError::Unsupported { .. })));
}

/// A view of both aspects cannot be bound as depth, and one of them can be made from its texture. Each frame makes it
/// anew, and keeps the bind group.
#[test]
fn a_view_of_depth_and_stencil_is_bound_as_depth() {
    let gpu = Gpu::open(None).unwrap();
    let format = wgpu::TextureFormat::Depth24PlusStencil8;
    let descriptor = wgpu::TextureDescriptor { format, ..depth_texture() };
    let [one, other] = [0, 1].map(|_| texture(&gpu, &descriptor));
    let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
    let stages = wgpu::ShaderStages::COMPUTE;
    let layout = gpu.bind_group_layout("depth", &[DepthImage::layout(0, stages, false)]);
    let mut kept = KeptBindGroup::default();
    let before = gpu.hitches();
    for (view, made) in [(&one, 1), (&one, 1), (&other, 2), (&one, 2)] {
        let depth = ask(&gpu, |frame| frame.with_depth(view).surface_depth("X")).unwrap();
        kept.bind(&gpu, "depth", &layout, &[depth.entry(0)]);
        assert_eq!(gpu.hitches().since(before).bind_groups, made);
    }
    assert!(pollster::block_on(scope.pop()).is_none());
}

#[test]
fn wrong_layers_are_refused() {
    let gpu = Gpu::noop().unwrap();
    let plain = depth_texture();
    let [one, four] = [1, 4].map(|sample_count| {
        texture(&gpu, &wgpu::TextureDescriptor { sample_count, ..plain.clone() })
    });
    let small = texture(&gpu, &wgpu::TextureDescriptor { size: size(9, 9), ..plain.clone() });
    let with = |layers: &[&wgpu::TextureView]| {
        ask(&gpu, |frame| {
            frame.with_depth(&one).with_layer_depths(layers).surface_and_layer_depths("X")
        })
    };
    assert_eq!(with(&[&one, &one]).unwrap().len(), 3);
    let error = with(&[&one, &four]).unwrap_err().to_string();
    let message = "the depth of a layer from a texture whose sample count is 4: it must be 1, as in the depth buffer";
    assert!(error.contains(message), "{error}");
    let error = with(&[&small]).unwrap_err().to_string();
    assert!(error.contains("the depth of a layer from a texture whose size is 9x9"), "{error}");
}

#[test]
fn wrong_normals_and_colors_are_refused() {
    let gpu = Gpu::noop().unwrap();
    let right = texture(&gpu, &colors());
    ask(&gpu, |frame| frame.with_normals(&right).normal_image("X").map(|_| ())).unwrap();
    let of_format = |format| wgpu::TextureDescriptor { format, ..colors() };
    let signed = "it must be Rgba16Float, Rgba32Float or Rgba16Snorm";
    let four = "it must be a format of four floats";
    let both = |message: &str| [message.to_owned(), message.to_owned()];
    let formats =
        |format: &str| [signed, four].map(|message| format!("format is {format}: {message}"));
    for (wrong, message) in [
        (
            wgpu::TextureDescriptor { size: size(64, 40), ..colors() },
            both("size is 64x40: it must be at least 64x48"),
        ),
        (
            wgpu::TextureDescriptor { sample_count: 4, ..colors() },
            both("sample count is 4: it must be 1"),
        ),
        (
            wgpu::TextureDescriptor { mip_level_count: 2, ..colors() },
            both("mip levels is 2: it must be 1"),
        ),
        (of_format(wgpu::TextureFormat::R32Uint), formats("R32Uint")),
        (of_format(wgpu::TextureFormat::Rg16Float), formats("Rg16Float")),
        (depth_texture(), formats("Depth32Float")),
    ] {
        let wrong = texture(&gpu, &wrong);
        let normals = |frame: Frame<'_>| Ok(frame.with_normals(&wrong).normal_image("X").err());
        let colors =
            |frame: Frame<'_>| Ok(frame.with_base_color(&wrong).base_color_image("X").err());
        let asked = [(ask(&gpu, normals), "normals"), (ask(&gpu, colors), "base colours")];
        for ((error, image), message) in asked.into_iter().zip(message) {
            let error = error.unwrap().unwrap().to_string();
            assert!(error.contains(&message) && error.contains(image), "{error}");
        }
    }
    // Unit vectors have signs, base colours need none.
    let unsigned = texture(&gpu, &of_format(wgpu::TextureFormat::Rgba8Unorm));
    ask(&gpu, |frame| frame.with_base_color(&unsigned).base_color_image("X").map(|_| ())).unwrap();
    let error = ask(&gpu, |frame| frame.with_normals(&unsigned).normal_image("X").map(|_| ()));
    assert!(error.unwrap_err().to_string().contains(signed));
}
