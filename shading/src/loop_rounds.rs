//! Counts the rounds of the loops that light a sample, for adapters that limit them.
//!
//! llvmpipe counts the rounds of all loops of an invocation together, and ends the loops silently
//! at its limit. The image would be wrong, so such a scene is refused.

use assign::{
    AssignError, Gpu, Light, LightBuffer, LightKinds, LightReader, LightShape, MAX_VERTICES,
};

use crate::{AreaModel, LightingOptions, ShadingError, ShadowModel};

/// The properties of a set of lights that decide the number of rounds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LightTotals {
    pub(crate) kinds: LightKinds,
    count: u64,
    areas: u64,
    vertices: u64,
    /// The most rounds of a ray through deep images.
    ray_rounds: u64,
}

/// Four corners with two steps each, and the end of every loop: `angle_above` of
/// `area_mrp_published.wesl`.
const PUBLISHED_ROUNDS: u64 = 5 + 4 * 3;

/// `CORNERS` of `area_curved.wesl`.
const CURVED_VERTICES: u64 = 16;

impl LightTotals {
    pub(crate) fn new(lights: &[Light]) -> Self {
        let areas = lights.iter().filter_map(|light| match &light.shape {
            LightShape::Area(emitter) if emitter.outline().is_curved() => Some(CURVED_VERTICES),
            LightShape::Area(emitter) => Some(emitter.vertices().len() as u64),
            LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => None,
        });
        let (areas, vertices) = areas.fold((0, 0), |(areas, sum), n| (areas + 1, sum + n));
        Self {
            kinds: LightKinds::among(lights),
            count: lights.len() as u64,
            areas,
            vertices,
            ray_rounds: 0,
        }
    }

    /// With rays of at most so many rounds in place of shadow maps.
    pub(crate) fn with_rays(self, ray_rounds: u64) -> Self {
        Self { ray_rounds, ..self }
    }

    /// The totals of a buffer. Lights that only the GPU knows count as the kinds that take the most rounds.
    pub(crate) fn of_buffer(lights: &LightBuffer) -> Self {
        if lights.live_count().is_none() {
            return Self::new(lights.lights());
        }
        Self::unknown(lights.kinds(), u64::from(lights.count()))
    }

    /// The totals of each light of a buffer by itself. A light that only the GPU knows counts as the kind that
    /// takes the most rounds.
    pub(crate) fn of_each(lights: &LightBuffer) -> impl Iterator<Item = Self> + '_ {
        // The CPU knows no light of a buffer whose lights the GPU writes.
        let unknown = lights.live_count().map(|_| Self::unknown(lights.kinds(), 1));
        lights.lights().chunks(1).map(Self::new).chain(unknown)
    }

    /// As many lights of the kind that takes the most rounds.
    fn unknown(kinds: LightKinds, count: u64) -> Self {
        let areas = if kinds.areas { count } else { 0 };
        let most = if kinds.curved { CURVED_VERTICES } else { MAX_VERTICES as u64 };
        Self { kinds, count, areas, vertices: areas * most, ray_rounds: 0 }
    }

    /// The rounds of lighting a sample by all of the lights. A light takes one round. An area light
    /// also takes one per vertex for the closest point, one per vertex for the horizon, and those
    /// of its model: a walk around the vertices for each term, one for both terms, a rectangle's
    /// corners twice, or a sample and its test for each term. Every loop takes one more round to
    /// end.
    fn rounds(&self, model: AreaModel) -> u64 {
        let walks = 2 * (self.vertices + self.areas);
        let terms = match model {
            AreaModel::Point => 0,
            AreaModel::Mrp => self.vertices + 2 * self.areas,
            AreaModel::MrpPublished => PUBLISHED_ROUNDS * self.areas,
            AreaModel::MonteCarlo { samples } | AreaModel::MonteCarloReflected { samples } => {
                2 * u64::from(samples) * (self.vertices + 2 * self.areas)
            }
            AreaModel::LtcTable
            | AreaModel::LtcHammon
            | AreaModel::LtcUnsplit
            | AreaModel::LtcPerLight
            | AreaModel::LtcPolynomial
            | AreaModel::LtcPolynomialPerLight => 2 * (self.vertices + 2 * self.areas),
        };
        self.count + walks + terms
    }

    /// The rounds of looking up a sample in all of the shadow maps: one for each map, row and texel, and one to end
    /// each loop. Of casting all rays, one for each ray, and those of the ray.
    fn rounds_of_shadows(&self, shadows: ShadowModel) -> u64 {
        if !shadows.is_on() {
            return 0;
        }
        let taps = u64::from(shadows.taps());
        let side = u64::from(shadows.taps().isqrt());
        let maps = self.areas * u64::from(shadows.maps()) + (self.count - self.areas);
        let look_ups = u64::from(shadows.look_ups());
        // The loops over look-ups of a soft filter end once each.
        let soft = if shadows.is_soft() { 2 + look_ups } else { 0 };
        let each = if shadows.casts_rays() { self.ray_rounds } else { 2 * side + taps };
        self.count + maps.saturating_mul(1 + soft + look_ups * (1 + each))
    }

    /// Checks that an adapter can light a sample by all of the lights, because any list may hold
    /// all of them.
    pub(crate) fn check(
        &self,
        gpu: &Gpu,
        options: LightingOptions,
        reader: LightReader<'_>,
    ) -> Result<(), ShadingError> {
        let rounds = self.rounds(options.area) + rounds_of_suns(options);
        let rounds = rounds + self.rounds_of_shadows(options.shadows);
        self.check_rounds(gpu, rounds + reader.loop_rounds(self.count))
    }

    /// The same for counting light operations, which walks the vertices twice more: for the closest
    /// point and for the horizon.
    pub(crate) fn check_counted(
        &self,
        gpu: &Gpu,
        options: LightingOptions,
        reader: LightReader<'_>,
    ) -> Result<(), ShadingError> {
        let walks = 2 * (self.vertices + self.areas) + reader.loop_rounds(self.count);
        self.check_rounds(gpu, self.rounds(options.area) + rounds_of_suns(options) + walks)
    }

    fn check_rounds(&self, gpu: &Gpu, rounds: u64) -> Result<(), ShadingError> {
        match gpu.max_loop_rounds() {
            Some(most) if rounds > u64::from(most) => Err(AssignError::Parameter {
                field: "lights".into(),
                value: format!("{}, which takes {rounds} rounds of loops per sample", self.count),
                accepted: format!(
                    "so few that these are at most {most}, because {} ends longer loops and would lose light: use fewer \
                     lights, fewer area lights, fewer samples, shadow maps or rays, or a GPU",
                    gpu.info.name
                ),
            }
            .into()),
            _ => Ok(()),
        }
    }
}

/// One round for each sun and one to end, if there are suns.
fn rounds_of_suns(options: LightingOptions) -> u64 {
    let taps = u64::from(options.shadows.taps());
    // One for each row and texel of a map, and one to end each loop.
    let of_map = if taps > 0 { 1 + 2 * taps.isqrt() + taps } else { 0 };
    match options.suns.as_slice().len() as u64 {
        0 => 0,
        count => count * (1 + of_map) + 1,
    }
}

#[cfg(test)]
mod tests {
    use assign::Emitter;
    use glam::Vec3;

    use super::*;

    #[test]
    fn lights_that_only_the_gpu_knows_take_the_most_rounds() {
        let gpu = Gpu::noop().expect("the noop device");
        let storage = |bytes| gpu.storage("own lights", bytes).expect("fits");
        let (records, shapes, count) = (storage(7 * 16), storage(16), storage(4));
        for (areas, rounds) in [(false, 1), (true, 1 + 22 + 2 * 4096 * 12)] {
            let given = assign::GpuLights {
                spheres: &records,
                emissions: &records,
                shapes: &shapes,
                count: &count,
                count_offset: 0,
                capacity: 7,
                kinds: LightKinds { spots: true, areas, curved: false },
                bounds: (Vec3::ZERO, Vec3::ONE),
                radius_max_m: 1.0,
                step_max_m: None,
            };
            let buffer = LightBuffer::from_gpu(&gpu, &given, 1).expect("valid");
            let model = AreaModel::MonteCarlo { samples: 4096 };
            let each: Vec<u64> =
                LightTotals::of_each(&buffer).map(|one| one.rounds(model)).collect();
            assert_eq!(each, [rounds]);
            assert_eq!(LightTotals::of_buffer(&buffer).rounds(model), 7 * rounds);
        }
    }

    #[test]
    fn area_lights_take_more_rounds_than_points() {
        let point = Light::point(Vec3::ZERO, 1.0, Vec3::ONE);
        let square = Emitter::rectangle(Vec3::X, Vec3::Y);
        let area = Light::area(square, Vec3::ZERO, 1.0, Vec3::ONE);
        let rounds = |lights: &[Light], model| LightTotals::new(lights).rounds(model);
        assert_eq!(rounds(&[point; 7], AreaModel::LtcTable), 7);
        assert_eq!(rounds(&[point, area], AreaModel::Point), 2 + 10);
        assert_eq!(rounds(&[area], AreaModel::LtcTable), 1 + 10 + 12);
        assert_eq!(rounds(&[area], AreaModel::Mrp), 1 + 10 + 6);
        assert_eq!(rounds(&[area], AreaModel::MonteCarlo { samples: 10 }), 1 + 10 + 120);
        let totals = LightTotals::new(&[point, area]);
        assert_eq!(totals.rounds_of_shadows(ShadowModel::None), 0);
        // Ten maps of three rows of three texels.
        let shadows = ShadowModel::Maps { maps: 9, px: 64, taps: 9 };
        assert_eq!(totals.rounds_of_shadows(shadows), 2 + 10 * (1 + 4 + 3 * 4));
        // 17 rays of 40 rounds.
        let rays = ShadowModel::Cdi { rays: 16 };
        assert_eq!(totals.with_rays(40).rounds_of_shadows(rays), 2 + 17 * (2 + 40));
        // 4 look-ups for blockers and 4 of the filter.
        let soft = ShadowModel::Pcss { maps: 9, px: 64, taps: 4 };
        assert_eq!(totals.rounds_of_shadows(soft), 2 + 10 * (1 + 2 + 8 + 8 * 4));
    }
}
