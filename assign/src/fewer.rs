//! A limit on the lights of a frame, as engines have it: the lights beyond it are in no list. **Lossy.**

use glam::Vec4;

use crate::{
    AssignError, Assignment, Frame, Gpu, Light, LightBuffer, LightShape, MIN_RANGE_M, Passes, View,
    leave_to_inner,
};

/// Which lights of a frame have lists if there are too many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kept {
    /// The first ones, as the renderer gave them.
    First,
    /// Those whose centres are nearest to the eye.
    Nearest,
}

impl Kept {
    /// The word in ids: `first`, `nearest`.
    pub fn name(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Nearest => "nearest",
        }
    }
}

/// A strategy that sees only some of a frame's lights, as in engines with a fixed number of lights. Lights whose ball
/// misses the view do not count, because engines leave them out before they count.
///
/// The strategy gets its own copy of the lights, in which the others reach a millionth of a metre. So their places
/// stay, and the lists' indices are those of the renderer's lights.
pub struct Fewer {
    inner: Box<dyn Assignment>,
    most: u32,
    kept: Kept,
    /// The lights that the strategy gets, if there are too many.
    copy: LightBuffer,
    /// Whether the prepared frame uses the copy.
    is_copied: bool,
}

impl Fewer {
    /// Wraps a strategy.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if `most` is 0.
    pub fn new(
        gpu: &Gpu,
        inner: Box<dyn Assignment>,
        kept: Kept,
        most: u32,
    ) -> Result<Self, AssignError> {
        if most == 0 {
            return Err(AssignError::Parameter {
                field: "lights of a frame".into(),
                value: "0".into(),
                accepted: "1 or more".into(),
            });
        }
        let copy = LightBuffer::new(gpu, &[])?;
        Ok(Self { inner, most, kept, copy, is_copied: false })
    }

    /// Copies the lights, and leaves those beyond the limit without a reach.
    fn copy_lights(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        let lights = frame.lights_by_slot(self.id(), "chooses the lights of a frame")?;
        let mut copy = lights.to_vec();
        let planes = sides_of(frame.view);
        let is_seen = |light: &Light| {
            let center = light.position.extend(1.0);
            planes.iter().all(|plane| plane.dot(center) >= -light.radius_m())
        };
        let key = |ix: usize, light: &Light| match self.kept {
            Kept::First => f64::from(frame.lights.given_index(ix as u32).unwrap_or(u32::MAX)),
            Kept::Nearest => f64::from(frame.view.eye().distance(light.position)),
        };
        let seen = copy.iter().enumerate().filter(|(_, light)| is_seen(light));
        let lost = beyond(seen.map(|(ix, light)| (key(ix, light), ix)), self.most as usize);
        for ix in lost {
            copy[ix] = Light { range_m: MIN_RANGE_M, shape: LightShape::Point, ..copy[ix] };
        }
        self.copy.update(gpu, &copy)
    }
}

/// The indices of all lights but the `most` with the smallest keys. Of equal keys the first ones stay.
fn beyond(keys: impl Iterator<Item = (f64, usize)>, most: usize) -> Vec<usize> {
    let mut order: Vec<(f64, usize)> = keys.collect();
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    order.into_iter().skip(most).map(|(_, ix)| ix).collect()
}

/// The four sides of the view and the plane through the eye: unit normals that point inwards, and offsets. An
/// orthographic view has no such plane.
fn sides_of(view: &View) -> Vec<Vec4> {
    let clip = view.world_to_clip();
    let [x, y, w] = [clip.row(0), clip.row(1), clip.row(3)];
    [w + x, w - x, w + y, w - y, w]
        .into_iter()
        .filter(|plane| plane.truncate().length() > 0.0)
        .map(|plane| plane / plane.truncate().length())
        .collect()
}

impl Assignment for Fewer {
    fn id(&self) -> String {
        format!("{}/{}{}", self.inner.id(), self.kept.name(), self.most)
    }

    leave_to_inner!(needs, compile, lookup, bind_group, lists);

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self::new(gpu, self.inner.for_view(gpu)?, self.kept, self.most)?))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        self.is_copied = frame.lights.count() > self.most;
        if !self.is_copied {
            return self.inner.prepare(gpu, frame);
        }
        self.copy_lights(gpu, frame)?;
        self.inner.prepare(gpu, &Frame { lights: &self.copy, ..*frame })
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        match self.is_copied {
            true => self.inner.record(&Frame { lights: &self.copy, ..*frame }, passes),
            false => self.inner.record(frame, passes),
        }
    }

    fn memory_bytes(&self) -> u64 {
        self.inner.memory_bytes() + if self.is_copied { self.copy.memory_bytes() } else { 0 }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{Everything, LightOrder};

    fn lights() -> Vec<Light> {
        // Behind the eye, far, near, in between, and as far as the second.
        let at = |x: f32| Light::point(Vec3::new(x, 0.0, 0.0), 2.0, Vec3::ONE);
        [-3.0, 9.0, 1.0, 5.0, 9.0].map(at).to_vec()
    }

    #[test]
    fn the_nearest_or_the_first_lights_stay() {
        let gpu = Gpu::noop().expect("a device");
        let lights = LightBuffer::new(&gpu, &lights()).expect("lights");
        let view = View::look_at(Vec3::ZERO, Vec3::X, 1.0, 0.1, [64, 48]);
        for (kept, most, reach) in [
            // The light behind the eye does not count.
            (Kept::Nearest, 2, [true, false, true, true, false]),
            (Kept::Nearest, 3, [true, true, true, true, false]),
            (Kept::First, 2, [true, true, true, false, false]),
            (Kept::First, 4, [true; 5]),
        ] {
            let inner = Box::new(Everything::new(&gpu).expect("a strategy"));
            let mut fewer = Fewer::new(&gpu, inner, kept, most).expect("a limit");
            let frame = Frame::new(&view, &lights);
            fewer.prepare(&gpu, &frame).expect("prepares");
            let seen = if fewer.is_copied { &fewer.copy } else { &lights };
            let found: Vec<bool> = seen.lights().iter().map(|light| light.range_m > 1.0).collect();
            assert_eq!(found, reach, "{kept:?} {most}");
            assert_eq!(fewer.id(), format!("None/{}{most}", kept.name()));
        }
    }

    #[test]
    fn no_lights_at_all_are_refused_and_so_is_an_order_of_the_gpu() {
        let gpu = Gpu::noop().expect("a device");
        let everything = || Box::new(Everything::new(&gpu).expect("a strategy"));
        assert!(Fewer::new(&gpu, everything(), Kept::First, 0).is_err());
        let order = LightOrder::Gpu { every: 1 };
        let lights = LightBuffer::ordered(&gpu, &lights(), order).expect("lights");
        let view = View::look_at(Vec3::ZERO, Vec3::X, 1.0, 0.1, [64, 48]);
        let mut fewer = Fewer::new(&gpu, everything(), Kept::First, 2).expect("a limit");
        let error = fewer.prepare(&gpu, &Frame::new(&view, &lights)).expect_err("refuses");
        assert!(error.to_string().contains("lights that the GPU orders or widens"), "{error}");
    }
}
