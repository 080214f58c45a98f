//! What makes an emitter faulty. `order/fault.wesl` checks the same on an emitter's record.

use glam::{DVec3, Vec3};

use super::{Emitter, FLATNESS, Outline};
use crate::light_fault::LightFault;

/// The accepted distances of an emitter's farthest vertex from its centre, metres.
const MIN_SIZE_M: f32 = 1e-4;
const MAX_SIZE_M: f32 = 1e5;

/// The smallest ratio of an emitter's area to the square of its size: a strip of 1 : 10,000.
const MIN_AREA_SHARE: f32 = 1e-4;

/// The largest cosine between the half axes.
const MAX_COSINE: f32 = 1e-3;

/// The largest cosine between the half axes of a disc.
const MAX_DISC_COSINE: f64 = 1e-5;

/// The longest half axis of a disc over its radius.
const MAX_DISC_AXIS: f64 = 1.0001;

/// The smallest ratio of a line's radius to its size, and of its length to its radius.
const MIN_LINE_RADIUS: f32 = 1e-4;
const MIN_LINE_LENGTH: f32 = 1e-3;

/// How far rounding may move a vertex beyond the half axes, as a share of the emitter's size.
const OUTLINE_ROUNDING: f32 = 1e-6;

fn out(field: &'static str, value: f32, accepted: &'static str) -> Result<(), LightFault> {
    Err(LightFault::OutOfRange { field, value, accepted })
}

impl Emitter {
    /// Checks every field.
    pub(crate) fn check(&self) -> Result<(), LightFault> {
        if self.outline().is_curved() {
            self.check_curved()?;
            return self.check_diffuse_share();
        }
        let numbers = self.vertices().iter().flat_map(Vec3::to_array);
        if let Some(value) = numbers.into_iter().find(|x| !x.is_finite()) {
            return Err(LightFault::NotFinite { field: "emitter vertex", value });
        }
        let size = self.vertices().iter().map(|v| v.length()).fold(0.0, f32::max);
        if !(MIN_SIZE_M..=MAX_SIZE_M).contains(&size) {
            return out("emitter size", size, "between 1e-4 and 1e5 metres from its middle");
        }
        let share = self.area() / (size * size);
        if share < MIN_AREA_SHARE {
            return out("emitter area over squared size", share, "at least 1e-4");
        }
        let normal = self.area_vector().normalize_or_zero();
        let off_plane = |v: &Vec3| (normal.dot(v.as_dvec3()).abs() / f64::from(size)) as f32;
        if let Some(value) = self.vertices().iter().map(off_plane).find(|off| *off > FLATNESS) {
            return out("emitter vertex off its plane over size", value, "at most 1e-4");
        }
        // Every vertex lies on the inner side of every edge.
        let inner = |(a, b): (DVec3, DVec3)| {
            let edge = (b - a).normalize_or_zero();
            let depth = |v: &Vec3| normal.dot(edge.cross(v.as_dvec3() - a));
            let deepest = self.vertices().iter().map(depth).fold(f64::INFINITY, f64::min);
            (deepest / f64::from(size)) as f32
        };
        if let Some(value) = self.edges().map(inner).find(|depth| *depth < -FLATNESS) {
            return out("emitter vertex outside an edge over size", value, "0: convex");
        }
        let edges: Vec<DVec3> = self.edges().map(|(a, b)| b - a).collect();
        let next = edges.iter().cycle().skip(1);
        let turn = |(a, b): (&DVec3, &DVec3)| normal.dot(a.cross(*b)).atan2(a.dot(*b));
        let turns = (edges.iter().zip(next).map(turn).sum::<f64>() / std::f64::consts::TAU) as f32;
        if turns > 1.5 {
            return out("turns of the emitter's outline", turns, "1");
        }
        self.check_half_axes(normal, size)?;
        self.check_diffuse_share()
    }

    fn check_diffuse_share(&self) -> Result<(), LightFault> {
        if !(self.diffuse_share > 0.0 && self.diffuse_share <= 1.0) {
            return out("diffuse share", self.diffuse_share, "above 0 and at most 1");
        }
        Ok(())
    }

    /// Checks a disc, a sphere or a line.
    fn check_curved(&self) -> Result<(), LightFault> {
        let radius = self.radius_m();
        let axes = self.half_axes().map(Vec3::as_dvec3);
        let numbers = axes.iter().flat_map(|axis| axis.as_vec3().to_array()).chain([radius]);
        if let Some(value) = numbers.into_iter().find(|x| !x.is_finite()) {
            return Err(LightFault::NotFinite { field: "emitter radius or half axis", value });
        }
        let half = axes[0].length() as f32;
        let size = if self.outline() == Outline::Line { half + radius } else { radius };
        if !(MIN_SIZE_M..=MAX_SIZE_M).contains(&size) {
            return out("emitter size", size, "between 1e-4 and 1e5 metres from its middle");
        }
        match self.outline() {
            Outline::Line => {
                if radius < MIN_LINE_RADIUS * size {
                    return out("line radius over size", radius / size, "at least 1e-4");
                }
                if half < MIN_LINE_LENGTH * radius {
                    return out("half line over radius", half / radius, "at least 1e-3");
                }
            }
            Outline::Disc => {
                for axis in axes {
                    let share = axis.length() / f64::from(radius);
                    if !(1.0..=MAX_DISC_AXIS).contains(&share) {
                        let accepted = "1, with a normal of some length";
                        return out("half axis of a disc over radius", share as f32, accepted);
                    }
                }
                let cosine = axes[0].dot(axes[1]) / (axes[0].length() * axes[1].length());
                if cosine.abs() > MAX_DISC_COSINE {
                    return out("cosine between half axes", cosine as f32, "0: a right angle");
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Checks that the half axes are at right angles, lie in the emitter's plane, and hold the
    /// outline. Culling bounds the outline by them.
    fn check_half_axes(&self, normal: DVec3, size: f32) -> Result<(), LightFault> {
        let [x, y] = self.half_axes().map(Vec3::as_dvec3);
        let size = f64::from(size);
        let cosine = x.normalize_or_zero().dot(y.normalize_or_zero()) as f32;
        // A ratio that is not a number is a fault.
        if cosine.is_nan() || cosine.abs() > MAX_COSINE {
            return out("cosine between half axes", cosine, "0: a right angle");
        }
        for axis in [x, y] {
            let off = (normal.dot(axis) / size) as f32;
            if off.is_nan() || off.abs() > FLATNESS {
                return out("half axis off the emitter's plane over size", off, "at most 1e-4");
            }
        }
        // The coordinates of a vertex are shares of the half axes.
        let (xx, yy, xy) = (x.dot(x), y.dot(y), x.dot(y));
        let area_2 = xx * yy - xy * xy;
        for v in self.vertices() {
            let (vx, vy) = (v.as_dvec3().dot(x), v.as_dvec3().dot(y));
            let [along_x, along_y] =
                [vx * yy - vy * xy, vy * xx - vx * xy].map(|t| t.abs() / area_2);
            for (along, axis) in [(along_x, x), (along_y, y)] {
                let beyond = ((along - 1.0) * axis.length() / size) as f32;
                if beyond.is_nan() || beyond > OUTLINE_ROUNDING {
                    return out("emitter vertex beyond the half axes over size", beyond, "0");
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Outline;

    #[test]
    fn faults_name_field_and_value() {
        let fault = |emitter: Emitter| emitter.check().unwrap_err().to_string();
        let fault_of = |vertices: &[Vec3]| fault(Emitter::polygon(vertices).unwrap().0);
        assert_eq!(
            Emitter::polygon(&[Vec3::ZERO, Vec3::X]).unwrap_err().to_string(),
            "polygon vertex count is 2: it must be 3 to 10"
        );
        let bent = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.1), Vec3::Y];
        let fault_of_bent = Emitter::polygon(&bent).unwrap_err().to_string();
        assert!(fault_of_bent.contains("off its plane"), "{fault_of_bent}");
        let arrow = [Vec3::ZERO, Vec3::new(2.0, -1.0, 0.0), Vec3::X, Vec3::new(2.0, 1.0, 0.0)];
        assert!(fault_of(&arrow).contains("convex"), "{}", fault_of(&arrow));
        // A star goes round twice, but every corner turns the right way.
        let star: Vec<Vec3> = (0..5)
            .map(|ix| {
                let angle = 2.0 * std::f32::consts::TAU * ix as f32 / 5.0;
                Vec3::new(angle.cos(), angle.sin(), 0.0)
            })
            .collect();
        assert!(fault_of(&star).contains("convex"), "{}", fault_of(&star));
        let twice = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ZERO, Vec3::X, Vec3::Y];
        assert!(fault_of(&twice).contains("outline is 2"), "{}", fault_of(&twice));
        let skewed = Emitter::rectangle(Vec3::X, Vec3::new(0.1, 1.0, 0.0));
        assert!(fault(skewed).contains("right angle"), "{}", fault(skewed));
        let square = Emitter::rectangle(Vec3::X, Vec3::Y);
        assert!(fault(square.with_diffuse_share(0.0)).contains("diffuse share is 0"));
        assert!(fault(square.scaled(1e9)).contains("emitter size"));
        let hair = Emitter::rectangle(Vec3::X, 1e-6 * Vec3::Y);
        assert!(fault(hair).contains("area"), "{}", fault(hair));
        let bad = Emitter::rectangle(Vec3::X, Vec3::new(0.0, f32::NAN, 0.0));
        assert!(fault(bad).contains("vertex is NaN"), "{}", fault(bad));
        // `turned` takes rotations only.
        let (triangle, _) = Emitter::polygon(&[Vec3::ZERO, Vec3::X, Vec3::Y]).unwrap();
        let shear = glam::Mat3::from_cols(Vec3::X, Vec3::new(0.5, 1.0, 0.0), Vec3::Z);
        let sheared = triangle.turned(&shear);
        assert!(fault(sheared).contains("right angle"), "{}", fault(sheared));
        for (emitter, fault_of_curved) in [
            (Emitter::disc(Vec3::ZERO, 1.0), "half axis of a disc over radius is 0"),
            (Emitter::disc(Vec3::X, 0.0), "emitter size is 0"),
            (Emitter::disc(Vec3::X, -1.0), "emitter size is -1"),
            (Emitter::disc(Vec3::X, 1.0).turned(&shear), "half axis of a disc"),
            (Emitter::sphere(f32::NAN), "is NaN"),
            (Emitter::sphere(1e9), "emitter size"),
            (Emitter::sphere(1.0).with_diffuse_share(2.0), "diffuse share is 2"),
            (Emitter::line(Vec3::ZERO, 1.0), "half line over radius is 0"),
            (Emitter::line(Vec3::X, 1e-5), "line radius over size"),
            (Emitter::line(Vec3::X, -0.5), "line radius over size"),
            (Emitter::line(Vec3::INFINITY, 1.0), "must be finite"),
        ] {
            let fault = fault(emitter);
            assert!(fault.contains(fault_of_curved), "{fault}");
        }
        // Only records may have other half axes.
        let [x, y] = triangle.half_axes();
        let parts =
            |axes| Emitter::from_parts(Outline::Polygon, axes, 0.0, triangle.vertices()).unwrap();
        parts([x, y]).check().unwrap();
        for (axes, fault_of_axes) in [
            ([0.99 * x, y], "beyond the half axes"),
            ([x, y + 0.01 * Vec3::Z], "off the emitter's plane"),
            ([x, Vec3::NAN], "off the emitter's plane"),
            ([x, Vec3::ZERO], "beyond the half axes"),
        ] {
            let fault = fault(parts(axes));
            assert!(fault.contains(fault_of_axes), "{fault}");
        }
    }
}
