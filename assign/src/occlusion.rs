//! Lists that leave out hidden lights: what a renderer hands to the culling driver so that it can.
//!
//! # The idea
//!
//! A light whose range reaches a group may still be hidden from every sample in the group's bounds, by surfaces between
//! them. A renderer with shadow maps knows that before it shades. With [`CullSettings::occlusion`](crate::CullSettings),
//! the driver asks the renderer's WESL about each light that passed all other tests, and leaves it out of the list if
//! it is hidden. So shading looks up fewer lights, and adds the same light.
//!
//! The driver knows nothing of shadow maps. A renderer hands over an [`OcclusionTest`], which is compiled into the
//! kernel, and with each frame the [`Occluders`] that it reads. Without the setting, nothing is compiled or bound.
//!
//! # The contract
//!
//! The test is the module `package::occlusion`. It declares two bindings and one function:
//!
//! ```wgsl
//! import package::bounds::group_range;
//! import package::lights::LightVolume;
//!
//! @group(2) @binding(3) var occluder_depths: texture_2d<f32>;
//! @group(2) @binding(4) var<storage, read> occluder_records: array<vec4u>;
//!
//! fn hides(light: u32, volume: LightVolume) -> bool { .. }
//! ```
//!
//! `light` is the light's slot in its [`LightBuffer`](crate::LightBuffer). `volume` bounds where it adds light.
//! `group_range(axis, origin)` is how far the group reaches along a unit vector, from a point, metres: least and greatest
//! coordinate of all of its samples as shaders compute them, rounding included. `hides` returns true only if shading
//! adds exactly 0 for this light at every sample in the group and in `volume`.

/// A renderer's test of whether surfaces hide a light from a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct OcclusionTest {
    wesl: &'static str,
    imports: &'static [(&'static str, &'static str)],
}

impl OcclusionTest {
    /// The test in WESL, as the top of this file demands. `imports` are path and source of each module that it imports,
    /// without the contract's own.
    ///
    /// # Safety
    ///
    /// Every loop must end by itself, whatever the buffers hold: the kernel does not count loops
    /// ([`Shader::create_uncounted`](crate::Shader::create_uncounted)).
    #[allow(unsafe_code, reason = "the author promises it")]
    pub const unsafe fn new(
        wesl: &'static str,
        imports: &'static [(&'static str, &'static str)],
    ) -> Self {
        Self { wesl, imports }
    }

    /// Path and source of its modules.
    pub(crate) fn modules(self) -> impl Iterator<Item = (&'static str, &'static str)> {
        std::iter::once(("package::occlusion", self.wesl)).chain(self.imports.iter().copied())
    }
}

/// What a renderer's [`OcclusionTest`] reads.
#[derive(Clone, Copy, Debug)]
pub struct Occluders<'a> {
    /// Depths of what hides lights: a `texture_2d<f32>` that is not filtered.
    pub depths: &'a wgpu::TextureView,
    /// Records of lights, in the order of their slots: a storage buffer.
    pub records: &'a wgpu::Buffer,
}
