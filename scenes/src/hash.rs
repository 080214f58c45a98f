//! Hashes of a scene's content and of its path, for provenance.

use assign::{DepthMapping, LightShape};
use blake3::Hasher;
use glam::Vec3;

use crate::{Dielectric, Encoding, Framing, Lens, Material, Pose, Scene, TextureRef};

/// Increases whenever the values in the hash, or their order, change.
const VERSION: u32 = 1;

/// The number of poses of a path in its hash: more than a fitted loop has knots.
const PATH_POSES: u32 = 1_024;

/// Feeds values to the hash. The length precedes each list, so no two scenes give the same stream.
struct Feed(Hasher);

impl Feed {
    fn bytes(&mut self, bytes: &[u8]) {
        self.int(bytes.len() as u64);
        self.0.update(bytes);
    }

    fn int(&mut self, value: u64) {
        self.0.update(&value.to_le_bytes());
    }

    fn floats(&mut self, values: &[f32]) {
        for value in values {
            // Which NaN arithmetic returns depends on the platform.
            let value = if value.is_nan() { f32::NAN } else { *value };
            self.0.update(&value.to_le_bytes());
        }
    }

    /// Adds the eye, a point looked at, and the up vector.
    fn pose(&mut self, marks: [Vec3; 3]) {
        for v in marks {
            self.floats(&v.to_array());
        }
    }

    fn texture(&mut self, texture: Option<&TextureRef>) {
        let Some(texture) = texture else {
            return self.int(0);
        };
        let sampler = &texture.sampler;
        self.int(1);
        self.int(u64::from(texture.image));
        for setting in [
            sampler.wrap_s as u64,
            sampler.wrap_t as u64,
            sampler.mag as u64,
            sampler.min as u64,
            sampler.mip.map_or(2, |filter| filter as u64),
        ] {
            self.int(setting);
        }
        self.floats(&texture.uv_transform.to_cols_array());
    }
}

impl Scene {
    /// BLAKE3 over geometry, transforms, materials, images, lights with their animation, suns and
    /// cameras, as 64 hexadecimal digits. Names, warnings and the path ([`path_hash`](Self::path_hash)) are not
    /// part of it. Procedural scenes may differ in the last bit between platforms whose `sin` and
    /// `cos` differ.
    pub fn hash(&self) -> String {
        let mut feed = Feed(Hasher::new());
        feed.int(u64::from(VERSION));
        self.hash_geometry(&mut feed);
        self.hash_materials(&mut feed);
        self.hash_lights(&mut feed);
        self.hash_cameras(&mut feed);
        self.hash_additions(&mut feed);
        feed.0.finalize().to_hex().to_string()
    }

    /// BLAKE3 over poses along the path, as 64 hexadecimal digits. It differs between two versions
    /// of a path even if their first poses are the same.
    pub fn path_hash(&self) -> String {
        let mut feed = Feed(Hasher::new());
        feed.int(u64::from(VERSION));
        for frame in 0..PATH_POSES {
            feed.pose(self.path.marks(frame, PATH_POSES));
        }
        feed.0.finalize().to_hex().to_string()
    }

    fn hash_geometry(&self, feed: &mut Feed) {
        feed.int(self.meshes.len() as u64);
        for mesh in &self.meshes {
            feed.bytes(bytemuck::cast_slice(&mesh.vertices));
            feed.bytes(bytemuck::cast_slice(&mesh.indices));
            feed.int(u64::from(mesh.material));
        }
        feed.int(self.models.len() as u64);
        for model in &self.models {
            feed.floats(&model.object_to_world.to_cols_array());
        }
        feed.int(self.instances.len() as u64);
        for instance in &self.instances {
            feed.int(u64::from(instance.mesh) << 32 | u64::from(instance.model));
        }
    }

    fn hash_materials(&self, feed: &mut Feed) {
        feed.int(self.materials.len() as u64);
        for material in &self.materials {
            feed.floats(&material.base_color.to_array());
            feed.floats(&material.emissive.to_array());
            feed.floats(&[material.metallic, material.roughness, material.normal_scale]);
            feed.floats(&[material.alpha_cutoff.unwrap_or(-1.0)]);
            feed.int(u64::from(material.double_sided));
            for texture in material.textures() {
                feed.texture(texture);
            }
        }
        feed.int(self.images.len() as u64);
        for image in &self.images {
            feed.int(u64::from(image.width) << 32 | u64::from(image.height));
            feed.int(u64::from(image.encoding == Encoding::Srgb));
            feed.bytes(&image.rgba);
        }
    }

    fn hash_lights(&self, feed: &mut Feed) {
        feed.int(self.lights.len() as u64);
        for light in &self.lights {
            let (kind, direction, angles) = match light.shape {
                LightShape::Spot { direction, inner_angle, outer_angle } => {
                    (1, direction, [inner_angle, outer_angle])
                }
                LightShape::Point => (0, Vec3::ZERO, [0.0; 2]),
                LightShape::Area(emitter) if emitter.outline().is_curved() => {
                    let [half_x, half_y] = emitter.half_axes();
                    // A disc's half axes are its normal's, and a sphere has none.
                    let along = if emitter.is_solid() { half_x } else { half_x.cross(half_y) };
                    (light.kind() as u64, along, [emitter.radius_m(), 0.0])
                }
                LightShape::Area(_) => (2, Vec3::ZERO, [0.0; 2]),
                LightShape::Vpl { normal, min_distance_m } => (4, normal, [min_distance_m, 0.0]),
            };
            feed.int(kind);
            feed.floats(&light.position.to_array());
            feed.floats(&light.intensity.to_array());
            feed.floats(&direction.to_array());
            feed.floats(&[light.range_m, angles[0], angles[1]]);
            if let LightShape::Area(emitter) = &light.shape {
                feed.int(u64::from(emitter.two_sided));
                feed.floats(&[emitter.diffuse_share]);
                for vertex in emitter.vertices() {
                    feed.floats(&vertex.to_array());
                }
            }
        }
    }

    /// Adds features that few scenes have. Scenes without them keep the hash of earlier versions.
    fn hash_additions(&self, feed: &mut Feed) {
        if self.meshes.iter().any(|mesh| !mesh.colors.is_empty()) {
            feed.int(COLORS);
            for mesh in &self.meshes {
                feed.bytes(bytemuck::cast_slice(&mesh.colors));
            }
        }
        let plain = Dielectric::default();
        if self.materials.iter().any(|m| m.unlit || m.dielectric != plain) {
            feed.int(REFLECTANCES);
            for material in &self.materials {
                feed.int(u64::from(material.unlit));
                feed.floats(&material.dielectric.f0.to_array());
                feed.floats(&[material.dielectric.f90]);
            }
        }
        if self.materials.iter().any(Material::is_transparent) {
            feed.int(TRANSPARENT);
            for material in &self.materials {
                feed.int(u64::from(material.is_blended));
                feed.floats(&[material.transmission]);
            }
        }
        if !self.suns.is_empty() {
            feed.int(SUNS);
        }
        for sun in &self.suns {
            feed.floats(&sun.direction.to_array());
            feed.floats(&sun.irradiance.to_array());
        }
        if let Some(animation) = &self.light_animation {
            feed.int(LIGHT_ANIMATION);
            animation.feed(|values| feed.floats(values));
        }
        if self.cameras.iter().any(|camera| camera.framing != Framing::PLAIN) {
            feed.int(FRAMINGS);
            for camera in &self.cameras {
                let Framing { shift, jitter_px, before_px, after_px, less_px, .. } = camera.framing;
                feed.floats(&[shift.x, shift.y, jitter_px.x, jitter_px.y]);
                for [x, y] in [before_px, after_px, less_px] {
                    feed.int(u64::from(x) << 32 | u64::from(y));
                }
                let is_standard = camera.framing.depth == DepthMapping::Standard;
                for flag in [camera.framing.is_mirrored, camera.framing.is_endless, is_standard] {
                    feed.int(u64::from(flag));
                }
            }
        }
        if self.cameras.iter().any(|camera| camera.framing.clip_plane.is_some()) {
            feed.int(CLIP_PLANES);
            for camera in &self.cameras {
                feed.floats(&camera.framing.clip_plane.unwrap_or_default().to_array());
            }
        }
    }

    fn hash_cameras(&self, feed: &mut Feed) {
        feed.int(self.cameras.len() as u64);
        for camera in &self.cameras {
            let Pose { eye, up, .. } = camera.pose;
            feed.pose([eye, eye + camera.pose.forward(), up]);
            feed.floats(&match camera.lens {
                Lens::Perspective { fov_y } => [0.0, fov_y, 0.0],
                Lens::Orthographic { half_width, half_height } => [1.0, half_width, half_height],
            });
            feed.floats(&[camera.near_m, camera.far_m.unwrap_or(f32::INFINITY)]);
        }
    }
}

/// Each marks the start of a feature that few scenes have.
const COLORS: u64 = 0x636f_6c6f_7273;
const SUNS: u64 = 0x7375_6e73;
const LIGHT_ANIMATION: u64 = 0x616e_696d_6174_6564;
const REFLECTANCES: u64 = 0x0066_3066_3930;
const FRAMINGS: u64 = 0x6672_616d_696e_6773;
const CLIP_PLANES: u64 = 0x0063_6c69_7070_6564;
const TRANSPARENT: u64 = 0x0067_6c61_7373;

#[cfg(test)]
mod tests {
    use crate::{CameraPath, atrium};

    /// The first pose, where every path of a scene starts, cannot distinguish paths.
    #[test]
    fn paths_of_the_same_first_pose_have_different_hashes() {
        let scene = atrium(1);
        let mut other = scene.clone();
        let first = scene.path.pose(0, 1);
        other.path = CameraPath::still(first);
        assert_eq!(other.path.pose(0, 1).eye, first.eye);
        assert_eq!(scene.hash(), other.hash());
        assert_ne!(scene.path_hash(), other.path_hash());
        assert_eq!(scene.path_hash(), atrium(1).path_hash());
    }
}
