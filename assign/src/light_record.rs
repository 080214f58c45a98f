//! A light's record on the GPU: its kind, the part that culling reads, and the part that shading
//! reads.

use bytemuck::{Pod, Zeroable};

use crate::{
    emitter::Outline,
    light::{Light, LightShape},
    spot_ramp::SpotRamp,
};

/// The kinds of light, as stored in the top four bits of [`LightEmission::kind_and_shape`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum LightKind {
    /// [`LightShape::Point`].
    Point = 0,
    /// [`LightShape::Spot`].
    Spot = 1,
    /// [`LightShape::Area`] with a rectangle.
    Rectangle = 2,
    /// [`LightShape::Area`] with a polygon.
    Polygon = 3,
    /// [`LightShape::Vpl`].
    Vpl = 4,
    /// [`LightShape::Area`] with a disc.
    Disc = 5,
    /// [`LightShape::Area`] with a sphere.
    Sphere = 6,
    /// [`LightShape::Area`] with a line.
    Line = 7,
}

/// The kinds besides points that occur among some lights. Shaders are compiled for exactly these.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct LightKinds {
    /// Spots or virtual point lights, whose supports are cut by cones: the flag `spots`.
    pub spots: bool,
    /// Emitters: the flag `areas`.
    pub areas: bool,
    /// Discs, spheres or lines among them: the flag `curved`, only together with `areas`.
    pub curved: bool,
}

impl LightKinds {
    /// Every combination.
    pub const ALL: [Self; 6] = [
        Self { spots: false, areas: false, curved: false },
        Self { spots: true, areas: false, curved: false },
        Self { spots: false, areas: true, curved: false },
        Self { spots: true, areas: true, curved: false },
        Self { spots: false, areas: true, curved: true },
        Self { spots: true, areas: true, curved: true },
    ];

    /// All kinds at once.
    pub const EVERY: Self = Self { spots: true, areas: true, curved: true };

    /// The kinds that occur among `lights`.
    pub fn among(lights: &[Light]) -> Self {
        lights.iter().fold(Self::default(), Self::including)
    }

    /// These kinds and that of a light.
    pub(crate) fn including(self, light: &Light) -> Self {
        let is_cut = matches!(light.shape, LightShape::Spot { .. } | LightShape::Vpl { .. });
        let (is_area, is_curved) = match &light.shape {
            LightShape::Area(emitter) => (true, emitter.outline().is_curved()),
            _ => (false, false),
        };
        Self {
            spots: self.spots || is_cut,
            areas: self.areas || is_area,
            curved: self.curved || is_curved,
        }
    }

    /// Whether a shader compiled for these kinds can shade all lights of `others`.
    pub fn cover(self, others: Self) -> bool {
        self.spots >= others.spots && self.areas >= others.areas && self.curved >= others.curved
    }
}

/// What culling kernels are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LightTraits {
    /// The kinds of lights.
    pub kinds: LightKinds,
    /// Levels of the light hierarchy, 1 to 3: the flags `parents` and `grandparents`.
    pub levels: u32,
}

impl From<LightKinds> for LightTraits {
    /// A hierarchy of one level, as few lights have it.
    fn from(kinds: LightKinds) -> Self {
        Self { kinds, levels: 1 }
    }
}

/// The part of a light that culling reads: its bounding sphere. 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct LightSphere {
    /// World-space position, metres.
    pub position_world: [f32; 3],
    /// Radius of a ball that contains the support, metres: the range plus the emitter's radius.
    pub radius_m: f32,
}

/// The part of a light that only shading reads. 16 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct LightEmission {
    /// Radiant intensity, linear RGB.
    pub intensity: [f32; 3],
    /// [`LightKind`] in the top 4 bits; the index of the light's first shape vector in the low 28.
    pub kind_and_shape: u32,
}

impl Light {
    /// The light's kind.
    pub fn kind(&self) -> LightKind {
        match self.shape {
            LightShape::Point => LightKind::Point,
            LightShape::Spot { .. } => LightKind::Spot,
            LightShape::Vpl { .. } => LightKind::Vpl,
            LightShape::Area(emitter) => match emitter.outline() {
                Outline::Rectangle => LightKind::Rectangle,
                Outline::Polygon => LightKind::Polygon,
                Outline::Disc => LightKind::Disc,
                Outline::Sphere => LightKind::Sphere,
                Outline::Line => LightKind::Line,
            },
        }
    }

    /// The part of the light's record that culling reads.
    pub fn sphere(&self) -> LightSphere {
        LightSphere { position_world: self.position.to_array(), radius_m: self.radius_m() }
    }

    /// The light's record for shading. Appends the vectors of its kind to `shapes`.
    ///
    /// Shape vectors by kind:
    ///
    /// - A point light has none.
    /// - A spot has `(direction, cos outer)` and `(scale, sin outer, squared chord, 0)` of its
    ///   [`SpotRamp`].
    /// - A virtual point light has `(normal, cos outer = 0)` and `(0, sin outer = 1, least distance
    ///   squared, 0)`.
    /// - An area light has `(normal, range)`, `(half x, diffuse range)`, `(half y, vertex count)`,
    ///   `(area, radius, 0, 0)` and one `(vertex, 0)` per vertex. The count is negative if the emitter
    ///   shines to all sides; vertices are relative to the light's position. Discs, spheres and lines have no
    ///   vertices and a count of 1 or -1; all others have a radius of 0.
    pub fn emission(&self, shapes: &mut Vec<[f32; 4]>) -> LightEmission {
        let first_shape = shapes.len() as u32;
        if let LightShape::Spot { direction, inner_angle, outer_angle } = self.shape {
            let direction = direction.normalize();
            let ramp = SpotRamp::new(inner_angle, outer_angle);
            shapes.push([direction.x, direction.y, direction.z, outer_angle.cos()]);
            shapes.push([ramp.scale, outer_angle.sin().max(0.0), ramp.outer_chord_2, 0.0]);
        }
        if let LightShape::Vpl { normal, min_distance_m } = self.shape {
            let normal = normal.normalize();
            shapes.push([normal.x, normal.y, normal.z, 0.0]);
            shapes.push([0.0, 1.0, min_distance_m * min_distance_m, 0.0]);
        }
        if let LightShape::Area(emitter) = &self.shape {
            let [half_x, half_y] = emitter.half_axes();
            let count = emitter.vertices().len().max(1) as f32;
            let count = if emitter.shines_all_around() { -count } else { count };
            shapes.push(emitter.normal().extend(self.range_m).to_array());
            shapes.push(half_x.extend(self.diffuse_range_m()).to_array());
            shapes.push(half_y.extend(count).to_array());
            shapes.push([emitter.area(), emitter.radius_m(), 0.0, 0.0]);
            shapes.extend(emitter.vertices().iter().map(|v| v.extend(0.0).to_array()));
        }
        LightEmission {
            intensity: self.intensity.to_array(),
            kind_and_shape: (self.kind() as u32) << 28 | first_shape,
        }
    }
}
