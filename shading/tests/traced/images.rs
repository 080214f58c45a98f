//! Tests images: seeds, threads, error bars and progress.

use assign::{Emitter, Light, LightShape};
use glam::Vec3;
use shading::{
    HdrImage,
    traced::{TracedScene, Transport, TruthImage, TruthSettings, truth_image},
};

use crate::{common, paths};

/// Points, a spot and two emitters.
fn lights() -> Vec<Light> {
    let mut lights = common::lights(12);
    let [x, z] = [Vec3::X * 0.6, Vec3::Z * 0.4];
    let down = LightShape::Area(Emitter::rectangle(x, z).two_sided());
    lights[0] =
        Light { shape: down, position: Vec3::new(0.5, 2.2, 0.0), range_m: 5.0, ..lights[0] };
    lights[1] = Light { range_m: f32::NAN, ..lights[1] };
    lights
}

fn traced_image(transport: Transport, seed: u64) -> TruthImage {
    let scene = common::showcase();
    let traced = TracedScene::new(&scene);
    let view = common::view([48, 32]);
    let primary = |pixel: usize| traced.primary(&view, [pixel as u32 % 48, pixel as u32 / 48]);
    let settings = TruthSettings { paths: paths(1, 48), seed, ..TruthSettings::new(transport) };
    truth_image(&traced, &lights(), [48, 32], primary, settings, &|_, _| ())
}

#[test]
fn images_depend_on_the_seed_and_not_on_threads() {
    let on = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| traced_image(Transport::Bounce, seed))
    };
    let one = on(1, 1);
    assert!(one.radiance.pixels.iter().flatten().any(|v| *v > 1e-3));
    assert_eq!(one, on(3, 1));
    assert_ne!(one, on(3, 2));
}

#[test]
fn error_bars_cover_the_actual_errors() {
    for transport in [Transport::Direct, Transport::Bounce] {
        let (a, b) = (traced_image(transport, 1), traced_image(transport, 2));
        let channels = |image: &HdrImage| -> Vec<f32> { image.pixels.concat() };
        let values = channels(&a.radiance).into_iter().zip(channels(&b.radiance));
        let errors = channels(&a.standard_error).into_iter().zip(channels(&b.standard_error));
        // Differences in standard errors, where the standard error is above 0.
        let off: Vec<f32> = values
            .zip(errors)
            .map(|((a, b), (ea, eb))| ((a - b).abs(), ea.hypot(eb)))
            .filter(|(difference, error)| *difference > 0.0 || *error > 0.0)
            .map(|(difference, error)| difference / error)
            .collect();
        let within =
            |most: f32| off.iter().filter(|v| **v <= most).count() as f64 / off.len() as f64;
        assert!(off.len() > 150, "{transport:?}: {} channels", off.len());
        assert!(within(4.0) > 0.99, "{transport:?}: {} within 4", within(4.0));
        // It is 0.68 for normal errors, so too long an error bar fails as well.
        assert!((0.5..0.9).contains(&within(1.0)), "{transport:?}: {} within 1", within(1.0));
    }
}

#[test]
fn progress_ends_with_all_rows() {
    let scene = common::showcase();
    let traced = TracedScene::new(&scene);
    let rows = std::sync::Mutex::new(Vec::new());
    let settings = TruthSettings::new(Transport::Direct);
    let progress = |done: u32, of: u32| rows.lock().unwrap().push((done, of));
    let image = truth_image(&traced, &[], [5, 21], |_| None, settings, &progress);
    assert_eq!(image.radiance.pixels, vec![[0.0; 3]; 105]);
    let mut rows = rows.into_inner().unwrap();
    rows.sort_unstable();
    assert_eq!((rows.len(), rows[2]), (3, (21, 21)));
}
