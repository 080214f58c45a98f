//! The images of a frame, checked before a strategy binds them.
//!
//! wgpu would answer a wrong image with a validation panic, or a kernel would read zeros outside a small one and lose
//! light. So every strategy takes its images from here.

use crate::{
    AssignError, Frame, SampleDomain, View, entries::texture,
    kept_bind_group::is_whole_depth_stencil,
};

/// The depth buffer of a frame, with one or several samples per pixel. It fits the view.
#[derive(Clone, Debug)]
pub struct DepthImage {
    view: wgpu::TextureView,
    strategy: String,
}

impl DepthImage {
    /// Whether it has several samples per pixel: a shader then reads it as a `texture_depth_multisampled_2d`.
    pub fn is_multisampled(&self) -> bool {
        self.view.texture().sample_count() > 1
    }

    /// Refuses several samples per pixel. `reason` says why the strategy reads only one.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] with several samples.
    pub fn with_one_sample(self, reason: &str) -> Result<Self, AssignError> {
        if !self.is_multisampled() {
            return Ok(self);
        }
        let count = self.view.texture().sample_count();
        Err(AssignError::Unsupported {
            strategy: self.strategy,
            asked: format!("a depth buffer of {count} samples per pixel"),
            reason: reason.into(),
        })
    }

    /// A bind group entry.
    pub fn entry(&self, binding: u32) -> wgpu::BindGroupEntry<'_> {
        texture(binding, &self.view)
    }

    /// A layout entry for such an image.
    pub fn layout(
        binding: u32,
        visibility: wgpu::ShaderStages,
        multisampled: bool,
    ) -> wgpu::BindGroupLayoutEntry {
        let ty = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled,
        };
        wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
    }
}

impl<'a> Frame<'a> {
    /// The depth buffer, for a strategy whose groups are found from it. They serve all look-ups but those at any
    /// depth. `strategy` is its id.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] if shading looks lists up at any depth, and the errors of
    /// [`depth_image`](Self::depth_image).
    pub fn surface_depth(&self, strategy: &str) -> Result<DepthImage, AssignError> {
        let served =
            [SampleDomain::OpaqueSurfaces, SampleDomain::NearSurfaces, SampleDomain::InFront];
        let reason = "its groups are found from the depth buffer, and behind surfaces most look-ups would read all lights";
        self.check_domain(strategy, &served, reason)?;
        self.depth_image(strategy)
    }

    /// The depth buffer. `strategy` is the id of what reads it.
    ///
    /// # Errors
    ///
    /// [`AssignError::Missing`] without one, and [`AssignError::Image`] if it cannot be read or does not hold the
    /// viewport.
    pub fn depth_image(&self, strategy: &str) -> Result<DepthImage, AssignError> {
        let view = self.depth.ok_or_else(|| missing(strategy, "depth"))?;
        self.checked_depth(strategy, "depth", view)
    }

    /// The depth buffer, and then the depths of layers, all with as many samples per pixel. `strategy` is the id of
    /// what reads them.
    ///
    /// # Errors
    ///
    /// As [`surface_depth`](Self::surface_depth).
    pub fn surface_and_layer_depths(&self, strategy: &str) -> Result<Vec<DepthImage>, AssignError> {
        let mut depths = vec![self.surface_depth(strategy)?];
        let samples = depths[0].view.texture().sample_count();
        for view in self.layer_depths {
            let image = "the depth of a layer";
            let depth = self.checked_depth(strategy, image, view)?;
            let check = ImageCheck { strategy, image, view: self.view, texture: view.texture() };
            let found = check.texture.sample_count();
            if found != samples {
                let accepted = format!("{samples}, as in the depth buffer");
                return check.fail("sample count", found.to_string(), accepted);
            }
            depths.push(depth);
        }
        Ok(depths)
    }

    fn checked_depth(
        &self,
        strategy: &str,
        image: &'static str,
        view: &wgpu::TextureView,
    ) -> Result<DepthImage, AssignError> {
        let check = ImageCheck { strategy, image, view: self.view, texture: view.texture() };
        check.shape()?;
        let format = check.texture.format();
        if !format.has_depth_aspect() {
            return check.fail("format", format!("{format:?}"), "a depth format".into());
        }
        // A view of depth and stencil cannot be bound, and nobody can ask a view for its aspect.
        let view = match is_whole_depth_stencil(check.texture) {
            true => check.texture.create_view(&wgpu::TextureViewDescriptor {
                label: Some("depth"),
                aspect: wgpu::TextureAspect::DepthOnly,
                ..Default::default()
            }),
            false => view.clone(),
        };
        Ok(DepthImage { view, strategy: strategy.into() })
    }

    /// The shading normals. `strategy` is the id of what reads them.
    ///
    /// # Errors
    ///
    /// As [`depth_image`](Self::depth_image).
    pub fn normal_image(&self, strategy: &str) -> Result<&'a wgpu::TextureView, AssignError> {
        self.color_image(strategy, "normals", self.normals, Formats::Signed)
    }

    /// The base colours. `strategy` is the id of what reads them.
    ///
    /// # Errors
    ///
    /// As [`depth_image`](Self::depth_image).
    pub fn base_color_image(&self, strategy: &str) -> Result<&'a wgpu::TextureView, AssignError> {
        self.color_image(strategy, "base colours", self.base_color, Formats::Colors)
    }

    fn color_image(
        &self,
        strategy: &str,
        image: &'static str,
        view: Option<&'a wgpu::TextureView>,
        formats: Formats,
    ) -> Result<&'a wgpu::TextureView, AssignError> {
        let view = view.ok_or_else(|| missing(strategy, image))?;
        let check = ImageCheck { strategy, image, view: self.view, texture: view.texture() };
        check.shape()?;
        let samples = check.texture.sample_count();
        if samples != 1 {
            return check.fail("sample count", samples.to_string(), "1".into());
        }
        let format = check.texture.format();
        match formats.accepts(format) {
            true => Ok(view),
            false => check.fail("format", format!("{format:?}"), formats.accepted().into()),
        }
    }
}

fn missing(strategy: &str, missing: &'static str) -> AssignError {
    AssignError::Missing { strategy: strategy.into(), missing }
}

/// What an image must be able to hold.
#[derive(Clone, Copy)]
enum Formats {
    /// Three signed components and one more, to 11 bits at least: unit vectors.
    Signed,
    /// Four components from 0 to 1.
    Colors,
}

impl Formats {
    fn accepts(self, format: wgpu::TextureFormat) -> bool {
        use wgpu::TextureFormat::{Rgba16Float, Rgba16Snorm, Rgba32Float};
        let is_float =
            matches!(format.sample_type(None, None), Some(wgpu::TextureSampleType::Float { .. }));
        match self {
            Self::Signed => matches!(format, Rgba16Float | Rgba16Snorm | Rgba32Float),
            Self::Colors => is_float && format.components() == 4,
        }
    }

    fn accepted(self) -> &'static str {
        match self {
            Self::Signed => "Rgba16Float, Rgba32Float or Rgba16Snorm",
            Self::Colors => "a format of four floats",
        }
    }
}

/// Checks one image of a frame.
#[derive(Clone, Copy)]
struct ImageCheck<'a> {
    strategy: &'a str,
    image: &'static str,
    view: &'a View,
    texture: &'a wgpu::Texture,
}

impl ImageCheck<'_> {
    fn fail<T>(
        &self,
        field: &'static str,
        value: String,
        accepted: String,
    ) -> Result<T, AssignError> {
        let (strategy, image) = (self.strategy.into(), self.image);
        Err(AssignError::Image { strategy, image, field, value, accepted })
    }

    /// Checks what every image must be.
    fn shape(&self) -> Result<(), AssignError> {
        let texture = self.texture;
        if texture.dimension() != wgpu::TextureDimension::D2 {
            return self.fail("dimension", format!("{:?}", texture.dimension()), "D2".into());
        }
        let (has, port) = (texture.size(), self.view.viewport);
        let ends = [port.x.saturating_add(port.width), port.y.saturating_add(port.height)];
        if has.width < ends[0] || has.height < ends[1] {
            let accepted = format!("at least {}x{}, where the viewport ends", ends[0], ends[1]);
            return self.fail("size", format!("{}x{}", has.width, has.height), accepted);
        }
        // Nobody can ask a view which level or layers it shows.
        let single = [
            ("mip levels", texture.mip_level_count()),
            ("array layers", texture.depth_or_array_layers()),
        ];
        if let Some((field, count)) = single.into_iter().find(|(_, count)| *count != 1) {
            return self.fail(field, count.to_string(), "1".into());
        }
        if !texture.usage().contains(wgpu::TextureUsages::TEXTURE_BINDING) {
            let accepted = "one with TEXTURE_BINDING".into();
            return self.fail("usage", format!("{:?}", texture.usage()), accepted);
        }
        Ok(())
    }
}
