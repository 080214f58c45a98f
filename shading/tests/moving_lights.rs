//! Lights that the GPU moves are those that the CPU moves, for every law.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    EncoderPasses, Gpu, Light, LightBuffer, LightEmission, LightKind, LightSphere, SlotCounts,
};
use bytemuck::{cast_slice, pod_collect_to_vec};
use glam::{Vec3, Vec4};
use scenes::{Aabb, LightSpec, Motion, MotionLaw, Outlines, scatter_lights};
use shading::MovingLights;

const TIMES: [f32; 4] = [0.0, 0.5, 3.25, 1000.75];
const SPEED_M_S: f32 = 1.5;
const SEED: u64 = 7;

/// How far positions may differ, as a share of the box's diagonal. Also how far all other numbers may
/// differ, relative to their size. A division in the shader may be off by 2.5 units in the last
/// place, which shifts a light by `3e-7 * speed * time`.
const TOLERANCE: f32 = 1e-4;

/// Faulty lights among [`lights`].
const FAULTY: [usize; 2] = [17, 300];

fn bounds() -> Aabb {
    Aabb::new(Vec3::new(-20.0, -1.0, 3.0), Vec3::new(25.0, 14.0, 33.0))
}

/// 500 points, spots, emitters of every outline and virtual point lights. Two are faulty, and one lies
/// outside the box.
fn lights() -> Vec<Light> {
    let outlines = Outlines::All;
    let spec =
        LightSpec { spot_share: 0.3, area_share: 0.4, outlines, ..LightSpec::new(500, bounds()) };
    let mut lights = scatter_lights(&spec).unwrap();
    for light in lights.iter_mut().step_by(10) {
        *light = Light::vpl(light.position, Vec3::Y, light.range_m, light.intensity);
    }
    lights[FAULTY[0]].range_m = f32::NAN;
    lights[FAULTY[1]].intensity = Vec3::splat(-1.0);
    lights[5].position = bounds().max + 3.0;
    lights
}

fn motion(law: MotionLaw, speed_m_s: f32, seed: u64) -> Motion {
    Motion::new(law, speed_m_s, seed, bounds()).unwrap()
}

/// Lights as their records have them.
struct Records {
    spheres: Vec<LightSphere>,
    emissions: Vec<LightEmission>,
    shapes: Vec<Vec4>,
}

impl Records {
    fn read(gpu: &Gpu, count: u32, buffers: [&wgpu::Buffer; 3]) -> Self {
        let [spheres, emissions, shapes] = buffers;
        let bytes = u64::from(count) * 16;
        Self {
            spheres: pod_collect_to_vec(&gpu.read(spheres, bytes).unwrap()),
            emissions: pod_collect_to_vec(&gpu.read(emissions, bytes).unwrap()),
            shapes: pod_collect_to_vec(&gpu.read(shapes, shapes.size()).unwrap()),
        }
    }

    /// The records that the CPU makes of `lights`, in this order.
    fn of(gpu: &Gpu, lights: &[Light]) -> Self {
        let buffer = LightBuffer::new(gpu, lights).unwrap();
        let buffers = [buffer.spheres(), buffer.emissions(), buffer.shapes()];
        Self::read(gpu, buffer.count(), buffers)
    }

    fn bits(&self) -> [&[u8]; 3] {
        [cast_slice(&self.spheres), cast_slice(&self.emissions), cast_slice(&self.shapes)]
    }

    fn kind(&self, light: usize) -> u32 {
        self.emissions[light].kind_and_shape >> 28
    }

    /// The shape vectors of a light.
    fn shape(&self, light: usize) -> &[Vec4] {
        let first = (self.emissions[light].kind_and_shape & 0x0fff_ffff) as usize;
        let kind = self.kind(light);
        let count = if kind == LightKind::Point as u32 {
            0
        } else if kind == LightKind::Spot as u32 || kind == LightKind::Vpl as u32 {
            2
        } else if kind >= LightKind::Disc as u32 {
            4
        } else {
            4 + self.shapes[first + 2].w.abs() as usize
        };
        &self.shapes[first..first + count]
    }

    /// The lights whose intensity is above 0.
    fn alive(&self) -> Vec<usize> {
        let is_lit = |&ix: &usize| self.emissions[ix].intensity != [0.0; 3];
        (0..self.emissions.len()).filter(is_lit).collect()
    }
}

/// Runs the pass `move` and the passes of a light buffer at some times. Returns the moved records at
/// each time, and what the light buffer found.
fn moved(gpu: &Gpu, motion: &Motion, times: &[f32]) -> Vec<(Records, SlotCounts, Vec<Light>)> {
    let moving = MovingLights::new(gpu, motion, &lights()).unwrap();
    let mut buffer = LightBuffer::from_gpu(gpu, &moving.lights(), 1).unwrap();
    let mut frames = Vec::new();
    for &time_s in times {
        moving.prepare(gpu, time_s);
        let lights = moving.lights();
        buffer.update_from_gpu(gpu, &lights).unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        moving.record(&mut passes);
        buffer.record(&mut passes);
        gpu.queue.submit([encoder.finish()]);
        let buffers = [lights.spheres, lights.emissions, lights.shapes];
        let records = Records::read(gpu, lights.capacity, buffers);
        let counts = buffer.read_counts(gpu).unwrap().unwrap();
        frames.push((records, counts, buffer.read(gpu).unwrap()));
    }
    frames
}

/// The sound lights at a time, by the CPU; `None` for dead ones.
fn expected(motion: &Motion, time_s: f32) -> Vec<Option<Light>> {
    let lights = lights();
    let sound = (0..).zip(&lights).filter(|(_, light)| light.check().is_ok());
    sound.map(|(ix, light)| motion.light_at(ix, light, time_s)).collect()
}

/// Whether two vectors differ by little, relative to their length.
fn near(a: Vec3, b: Vec3) -> bool {
    a.distance(b) <= TOLERANCE * b.length()
}

/// The first difference between the GPU's lights and the CPU's.
fn difference(gpu: &Gpu, moved: &Records, lights: &[Option<Light>]) -> Option<String> {
    let alive: Vec<usize> = (0..lights.len()).filter(|&ix| lights[ix].is_some()).collect();
    if moved.alive() != alive {
        return Some(format!("{} lights live: {} expected", moved.alive().len(), alive.len()));
    }
    let living: Vec<Light> = lights.iter().copied().flatten().collect();
    let cpu = Records::of(gpu, &living);
    for (cpu_ix, ix) in alive.into_iter().enumerate() {
        let fail = |what: &str| {
            let pair = (moved.spheres[ix], moved.emissions[ix], moved.shape(ix));
            Some(format!("{what} of light {ix}: {pair:?}, expected {:?}", living[cpu_ix]))
        };
        let (a, b) = (&moved.spheres[ix], &cpu.spheres[cpu_ix]);
        let apart_m = Vec3::from(a.position_world).distance(b.position_world.into());
        if apart_m > TOLERANCE * bounds().diagonal() {
            return fail("position");
        }
        if (a.radius_m - b.radius_m).abs() > 1e-5 * b.radius_m {
            return fail("radius");
        }
        let (a, b) = (moved.emissions[ix].intensity, cpu.emissions[cpu_ix].intensity);
        if !near(a.into(), b.into()) {
            return fail("intensity");
        }
        let (a, b) = (moved.shape(ix), cpu.shape(cpu_ix));
        let same = |(a, b): (&Vec4, &Vec4)| {
            near(a.truncate(), b.truncate()) && (a.w - b.w).abs() <= TOLERANCE * b.w.abs()
        };
        if moved.kind(ix) != cpu.kind(cpu_ix) || a.len() != b.len() {
            return fail("kind");
        }
        if !a.iter().zip(b).all(same) {
            return fail("shape");
        }
    }
    None
}

#[test]
fn the_gpu_moves_lights_as_the_cpu_does() {
    let gpu = Gpu::open(None).unwrap();
    for law in MotionLaw::LIST {
        let law_of_7 = motion(law, SPEED_M_S, SEED);
        let frames = moved(&gpu, &law_of_7, &TIMES);
        for (time_s, (records, counts, slots)) in TIMES.into_iter().zip(&frames) {
            let cpu = expected(&law_of_7, time_s);
            let differs = difference(&gpu, records, &cpu);
            assert_eq!(differs, None, "{law} at {time_s} s");
            // The light buffer takes every light, and knows which are dead.
            let given = (lights().len() - FAULTY.len()) as u32;
            let dark = cpu.iter().filter(|light| light.is_none()).count() as u32;
            let all = SlotCounts { given, slots: given, faulty: 0, dark };
            assert_eq!(*counts, all, "{law} at {time_s} s");
            let mut lit: Vec<_> = slots.iter().filter(|l| l.intensity != Vec3::ZERO).collect();
            lit.iter().for_each(|light| light.check().unwrap());
            let mut own: Vec<_> = records.alive().iter().map(|&ix| records.spheres[ix]).collect();
            lit.sort_by_key(|light| light.position.to_array().map(f32::to_bits));
            own.sort_by_key(|sphere| sphere.position_world.map(f32::to_bits));
            let same = |(a, b): (&&Light, &LightSphere)| a.position.to_array() == b.position_world;
            assert!(lit.len() == own.len() && lit.iter().zip(&own).all(same), "{law} {time_s}");
            // Negative control: another seed gives other lights.
            let other = expected(&motion(law, SPEED_M_S, SEED + 1), time_s);
            assert!(difference(&gpu, records, &other).is_some(), "{law} at {time_s} s");
        }
    }
}

#[test]
fn faulty_lights_are_named() {
    let gpu = Gpu::open(None).unwrap();
    let lights = lights();
    let moving = MovingLights::new(&gpu, &motion(MotionLaw::Drift, 1.0, SEED), &lights).unwrap();
    let named: Vec<_> = moving.rejected().iter().map(|r| (r.index, r.fault.to_string())).collect();
    let faults = FAULTY.map(|ix| (ix, lights[ix].check().unwrap_err().to_string()));
    assert_eq!(named, faults);
}

#[test]
fn a_time_gives_the_same_bits_in_any_order() {
    let gpu = Gpu::open(None).unwrap();
    let backwards: Vec<f32> = TIMES.into_iter().rev().collect();
    for law in MotionLaw::LIST {
        let law = motion(law, SPEED_M_S, SEED);
        let first = moved(&gpu, &law, &TIMES);
        let second = moved(&gpu, &law, &backwards);
        for (a, b) in first.iter().zip(second.iter().rev()) {
            assert_eq!(a.0.bits(), b.0.bits(), "{}", law.law());
            assert_eq!((a.1, &a.2), (b.1, &b.2), "{}", law.law());
        }
        assert_ne!(
            first[1].0.bits(),
            first[2].0.bits(),
            "{}: another time gives other lights",
            law.law()
        );
    }
}

#[test]
fn at_speed_0_lights_stay_bit_for_bit() {
    let gpu = Gpu::open(None).unwrap();
    let at_rest = Records::of(&gpu, &lights());
    for (records, counts, _) in moved(&gpu, &motion(MotionLaw::All, 0.0, SEED), &TIMES) {
        assert_eq!(records.bits(), at_rest.bits());
        assert_eq!((counts.faulty, counts.dark), (0, 0));
    }
}

#[test]
fn turned_area_lights_stay_within_their_half_axes() {
    let gpu = Gpu::open(None).unwrap();
    let turning = motion(MotionLaw::Turn, SPEED_M_S, SEED);
    let (mut rectangles, mut polygons) = (0, 0);
    for (records, ..) in moved(&gpu, &turning, &TIMES) {
        for light in 0..records.spheres.len() {
            let (kind, shape) = (records.kind(light), records.shape(light));
            rectangles += usize::from(kind == LightKind::Rectangle as u32);
            polygons += usize::from(kind == LightKind::Polygon as u32);
            if shape.len() < 4 {
                continue;
            }
            for vertex in &shape[4..] {
                for half in &shape[1..3] {
                    let half = half.truncate().as_dvec3();
                    let along = vertex.truncate().as_dvec3().dot(half).abs();
                    // A vertex is rounded along both half axes, of which one may be longer.
                    assert!(along <= half.length_squared() * (1.0 + 1e-6), "{light}: {shape:?}");
                }
            }
        }
    }
    assert!(rectangles > 0 && polygons > 0, "{rectangles} rectangles, {polygons} polygons");
}

#[test]
fn no_lights_move_too() {
    let gpu = Gpu::open(None).unwrap();
    let moving = MovingLights::new(&gpu, &motion(MotionLaw::All, 1.0, SEED), &[]).unwrap();
    let buffer = LightBuffer::from_gpu(&gpu, &moving.lights(), 1).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    moving.record(&mut passes);
    buffer.record(&mut passes);
    gpu.queue.submit([encoder.finish()]);
    assert_eq!(buffer.read_counts(&gpu).unwrap(), Some(SlotCounts::default()));
    assert!(moving.bytes() > 0);
}
