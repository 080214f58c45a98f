//! Shadows that cannot be shown are refused, and without the option nothing is compiled for them.

use assign::{Everything, Light, LightBuffer, LightOrder};
use glam::Vec3;
use shading::{Lighting, LightingOptions, Mode, Renderer, ShadingError, ShadowModel};

use crate::{common, lamp, maps};

fn light() -> Light {
    lamp(Vec3::new(0.0, 3.0, 0.0))
}

#[test]
fn shadows_without_their_maps_are_refused() {
    let gpu = common::gpu();
    let view = common::view([32, 32]);
    let lights = LightBuffer::new(&gpu, &[light()]).unwrap();
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    let strategy = Everything::new(&gpu).unwrap();
    let options =
        |shadows| LightingOptions { kinds: lights.kinds(), shadows, ..LightingOptions::default() };
    let refused = |renderer: &Renderer, options| {
        Lighting::new(renderer, &strategy, Mode::Deferred, options).unwrap_err().to_string()
    };
    let error = refused(&renderer, options(maps(4, 64, 1)));
    assert_eq!(error, "shadow model is maps:4,64: it must be none before Renderer::cast_shadows");
    renderer.cast_shadows(&lights, maps(4, 64, 1)).unwrap();
    let error = refused(&renderer, options(maps(9, 64, 1)));
    assert!(error.starts_with("shadow model is maps:9,64: it must be maps:4,64, "), "{error}");
    let suns = LightingOptions { suns: common::suns(), ..options(maps(4, 64, 1)) };
    let error = refused(&renderer, suns);
    assert!(error.contains("it must be none with other suns than those of"), "{error}");
    renderer.cast_shadows_of_suns(common::suns());
    renderer.cast_shadows(&lights, maps(4, 64, 1)).unwrap();
    assert!(Lighting::new(&renderer, &strategy, Mode::Deferred, suns).is_ok());
    assert!(refused(&renderer, options(maps(4, 64, 1))).contains("other suns than those of"));
    renderer.cast_shadows_of_suns(assign::Suns::default());
    renderer.cast_shadows(&lights, maps(4, 64, 1)).unwrap();
    assert!(Lighting::new(&renderer, &strategy, Mode::Deferred, options(maps(4, 64, 1))).is_ok());
    // Maps that no shader reads do no harm, and `none` removes them.
    assert!(
        Lighting::new(&renderer, &strategy, Mode::Deferred, options(ShadowModel::None)).is_ok()
    );
    assert_eq!(renderer.cast_shadows(&lights, ShadowModel::None).unwrap(), None);
    assert!(refused(&renderer, options(maps(4, 64, 1))).contains("cast_shadows"));
}

#[test]
fn other_lights_than_those_of_the_maps_are_refused() {
    let gpu = common::gpu();
    let view = common::view([32, 32]);
    let lights = LightBuffer::new(&gpu, &[light()]).unwrap();
    let moved = LightBuffer::new(&gpu, &[lamp(Vec3::new(0.1, 3.0, 0.0))]).unwrap();
    let mut renderer = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    renderer.cast_shadows(&lights, maps(4, 64, 1)).unwrap();
    renderer.prepare(&view, &lights).unwrap();
    let error = renderer.prepare(&view, &moved).unwrap_err();
    assert!(matches!(error, ShadingError::StaleShadows), "{error}");
    assert!(error.to_string().contains("Renderer::cast_shadows"), "{error}");
    renderer.cast_shadows(&moved, maps(4, 64, 1)).unwrap();
    renderer.prepare(&view, &moved).unwrap();
    // The GPU would order them otherwise.
    let ordered = LightBuffer::ordered(&gpu, &[light()], LightOrder::Gpu { every: 1 }).unwrap();
    let error = renderer.cast_shadows(&ordered, maps(4, 64, 1)).unwrap_err().to_string();
    assert!(error.contains("shadow model maps:4,64 cannot serve lights that the GPU"), "{error}");
    assert_eq!(renderer.shadow_figures(), None);
    // Too many lights for an atlas of any device.
    let many = LightBuffer::new(&gpu, &vec![light(); 40]).unwrap();
    let error = renderer.cast_shadows(&many, maps(1, 4096, 1)).unwrap_err().to_string();
    assert!(error.starts_with("shadow model is maps:1,4096 for 40 lights: "), "{error}");
    // A scene without lights has no maps, and is drawn.
    let none = LightBuffer::new(&gpu, &[]).unwrap();
    let figures = renderer.cast_shadows(&none, maps(4, 64, 1)).unwrap().unwrap();
    assert_eq!((figures.maps, figures.faces), (0, 0));
    renderer.prepare(&view, &none).unwrap();
}
